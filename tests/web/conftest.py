"""A server on a port of its own, and a real Chromium before it."""

import base64
import functools
import json
import os
import shutil
import threading
import time
import urllib.error
import urllib.parse
import urllib.request
from collections import defaultdict
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import rockflex as rf
from builders import make_frame

TASKS = [
    "structure",
    "optional",
    "optional-device",
    "devices",
    "ground",
    "runs",
    "import",
    "project",
    "modes",
]  # the forms, unfolded
MODELS = ("MDOF-S", "2DOF-S", "fixed")  # with which the page begins
WINDOW = {"width": 1280, "height": 900}
POLL = 0.02  # s between two looks at work in the background
THROTTLE = float(os.environ.get("ROCKFLEX_THROTTLE", "1"))  # how many times slower every page of the browser is
# Counts the requests whose answers the page has not read yet: `Visitor.settle` waits for their end.
COUNT = """
globalThis.pendingAnswers = 0;
const asked = globalThis.fetch;
globalThis.fetch = async (...given) => {
  const over = () => setTimeout(() => pendingAnswers--);
  pendingAnswers++;
  try {
    const answer = await asked(...given);
    answer.clone().arrayBuffer().then(over, over);
    return answer;
  } catch (error) {
    over();
    throw error;
  }
};
"""


def pytest_configure(config):
    config.addinivalue_line("markers", "web: drives a real Chromium; skipped, with the reason, where there is none")


class Client:
    """Requests to the server, and what it answers."""

    def __init__(self, url: str) -> None:
        self.url = url

    @functools.cached_property
    def first(self) -> str:
        """The first state of the page with a frame of Table 1."""
        about = json.loads(self.request("/api/about")[2])
        return json.dumps(about["state"] | {"structure": about["presets"][0]["structure"]})

    def request(self, path: str, data: bytes | None = None, method: str | None = None, **headers: str):
        names = {name.replace("_", "-"): value for name, value in headers.items()}
        request = urllib.request.Request(self.url + path, data, names, method=method)
        try:
            with urllib.request.urlopen(request, timeout=300) as answer:
                return answer.status, dict(answer.headers), answer.read()
        except urllib.error.HTTPError as error:
            with error:
                return error.code, dict(error.headers), error.read()

    def post(self, path: str, content: Any) -> tuple[int, Any]:
        data = content if isinstance(content, bytes) else json.dumps(content).encode()
        status, _, body = self.request(path, data, Content_Type="application/json")
        return status, json.loads(body)

    def ask(self, path: str, state: dict[str, Any], **extra: Any) -> Any:
        status, answer = self.post(path, {"state": state, **extra})
        assert status == 200, answer
        return answer

    def refused(self, path: str, state: Any) -> dict[str, str]:
        status, answer = self.post(path, {"state": state})
        assert 400 <= status < 500, (status, answer)
        return answer["errors"]

    def download(self, path: str, state: dict[str, Any]) -> tuple[str, bytes]:
        """The name and the content of a file."""
        made = self.made(path.removeprefix("/api/file/"), state)
        assert made["status"] == "done", made
        return made["name"], made["content"]

    def program(self, what: str, state: dict[str, Any]) -> dict[str, Any]:
        """What a downloaded program leaves."""
        space: dict[str, Any] = {}
        exec(compile(self.download(f"/api/file/{what}", state)[1], f"{what}.py", "exec"), space)
        return space

    def study(self, kind: str, state: dict[str, Any], seconds: float = 60.0) -> tuple[str, Any]:
        """Run a study; return its token and what the page knows at its end."""
        token = self.ask(f"/api/study/{kind}", state)["token"]
        return token, self.wait(kind, token, state, seconds)

    @staticmethod
    def unpack(text: str) -> NDArray[np.float32]:
        """The values of a curve."""
        return np.frombuffer(base64.b64decode(text), "<f4")

    def make(self, what: str, state: dict[str, Any]) -> str:
        """Start to make a file, or one of a study by its whole path, and return its token."""
        return self.ask(what if what.startswith("/") else f"/api/file/{what}", state)["token"]

    def made(self, what: str, state: dict[str, Any], seconds: float = 120.0) -> Any:
        """How the making of a file ended, with the file itself if there is one."""
        path = f"/api/file/{self.make(what, state)}"
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            answer = json.loads(self.request(path)[2])
            if answer["status"] not in ("waiting", "running"):
                if answer["status"] == "done":
                    _, headers, body = self.request(f"{path}/content")
                    name = urllib.parse.unquote(headers["content-disposition"].split("UTF-8''")[1])
                    answer |= {"name": name, "content": body}
                return answer
            time.sleep(POLL)
        pytest.fail(f"The file took more than {seconds} s.")

    def state(self, **changes: Any) -> dict[str, Any]:
        """The first state of the page with a frame of Table 1, in SI units, changed."""
        first = json.loads(self.first)
        return first | {"scale": 1.0, "units": "SI"} | changes

    def wait(self, kind: str, token: str, state: dict[str, Any], seconds: float = 60.0) -> Any:
        """Progress of a study once it is over."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            answer = self.ask(f"/api/study/{kind}/{token}", state)
            if answer["status"] not in ("waiting", "running"):
                return answer
            time.sleep(POLL)
        pytest.fail(f"The study took more than {seconds} s.")


@pytest.fixture(scope="session")
def server() -> Iterator[str]:
    import uvicorn

    from rockflex.web import make_app

    running = uvicorn.Server(uvicorn.Config(make_app(), port=0, log_level="error"))
    thread = threading.Thread(target=running.run, daemon=True)
    thread.start()
    while not running.started:
        assert thread.is_alive(), "the server did not start"
        time.sleep(0.02)
    port = running.servers[0].sockets[0].getsockname()[1]
    yield f"http://127.0.0.1:{port}"
    running.should_exit = True
    thread.join(10)


@pytest.fixture(scope="session")
def client(server: str) -> Client:
    return Client(server)


def chromium() -> str | None:
    given = os.environ.get("ROCKFLEX_CHROMIUM")
    names = (given,) if given else ("chromium", "chromium-browser", "google-chrome")
    return next((found for name in names if (found := shutil.which(name))), None)


def throttled(page: Any) -> Any:
    """A page that is as much slower as ROCKFLEX_THROTTLE asks for."""
    if THROTTLE > 1:
        page.context.new_cdp_session(page).send("Emulation.setCPUThrottlingRate", {"rate": THROTTLE})
    return page


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    sync_api = pytest.importorskip("playwright.sync_api", reason="no Playwright: pip install playwright")
    with sync_api.sync_playwright() as playwright:
        path = chromium()
        if path is None and not os.path.exists(playwright.chromium.executable_path):  # noqa: PTH110
            pytest.skip("no Chromium on this machine: run scripts/install_browser.sh")
        launched = playwright.chromium.launch(executable_path=path, args=["--no-sandbox"])
        yield launched
        launched.close()


class Visitor:
    """A page of one visitor in a context of its own, with what its console said."""

    def __init__(self, browser: Any, url: str, folded: bool, options: dict[str, Any]) -> None:
        self.url, self.said = url, list[str]()
        self.context = browser.new_context(viewport=WINDOW, **options)
        unfold = f"for (const task of {TASKS}) localStorage.setItem('rockflex-open-' + task, true)"
        self.context.add_init_script(f"if (location.protocol === 'http:') {{ {COUNT} {'' if folded else unfold} }}")
        self.page = page = throttled(self.context.new_page())
        page.set_default_timeout(180_000)
        # A refusal is an answer, which Chromium writes to its console all the same.
        page.on("console", lambda m: self.said.append(f"{m.type}: {m.text}") if self._matters(m) else None)
        page.on("pageerror", lambda error: self.said.append(f"uncaught: {error}"))
        page.on("request", lambda r: None if r.url.startswith((url, "blob:", "data:")) else self.said.append(r.url))

    @staticmethod
    def _matters(message: Any) -> bool:
        return message.type in ("error", "warning") and "Failed to load resource" not in message.text

    def look(self, size: Any = None, color_scheme: Any = "light", reduced_motion: Any = "reduce") -> None:
        """Look at the page in a window of this size, and with these wishes."""
        self.page.set_viewport_size(size or WINDOW)
        self.page.emulate_media(media="null", color_scheme=color_scheme, reduced_motion=reduced_motion)

    def leave(self) -> list[str]:
        """Leave the page as a new one to the next visitor; return what its console said."""
        page = self.page
        page.unroute_all(behavior="ignoreErrors")
        page.evaluate("localStorage.clear()")
        page.mouse.move(0, 0)
        page.goto("about:blank")
        said, self.said = [*self.said], list[str]()
        return said

    def open(self, link: str = "/") -> "Visitor":
        self.page.goto(self.url + link)
        self.page.wait_for_selector("#view > .columns")
        return self

    def follow(self, link: str) -> "Visitor":
        """Follow a link on the open page, which makes all of its tabs anew."""
        self.page.evaluate(
            """link => {
              document.getElementById("view").dataset.shown = "";
              location.hash = link;
            }""",
            link.removeprefix("/"),
        )
        self.page.wait_for_selector('#view:not([data-shown=""])')
        return self

    def tab(self, name: str) -> None:
        self.page.click(f'[data-tab="{name}"]')
        self.page.wait_for_selector(f'#view[data-shown="{name}"]')

    def state(self) -> dict[str, Any]:
        return self.page.evaluate("rockflexPage.state")

    def settle(self) -> None:
        """Wait until every answer is there and shown: for three pictures nothing is awaited, and no study runs."""
        self.page.evaluate(
            """async () => {
              for (let still = 0; still < 3; await new Promise(requestAnimationFrame))
                still = pendingAnswers || document.querySelector(".wait, #cancel:enabled") ? 0 : still + 1;
            }"""
        )

    def pictures(self, count: int = 5) -> None:
        """Wait for a few pictures of the page: what moves or reacts has done so."""
        frames = "async (count) => { while (count-- > 0) await new Promise(requestAnimationFrame); }"
        self.page.evaluate(frames, count)

    def fill(self, path: str, value: str) -> None:
        box = self.page.locator(f'[data-path="{path}"] input[type="text"]').first
        box.evaluate("e => { for (let d = e; (d = d.parentElement?.closest('details')); ) d.open = true; }")
        box.fill(value)
        box.press("Enter")
        box.blur()

    def wait_for_error(self, path: str, words: str = "") -> None:
        """Wait until a field's error has these words; that of the value before may still be shown."""
        error = self.page.locator(f'[data-path="{path}"] > .error').filter(has_text=words)
        error.first.wait_for(state="visible")

    def value(self, selector: str) -> float:
        return float(self.page.locator(selector).first.get_attribute("data-value"))

    def shown(self, scale: float = 1, models: Sequence[str] = MODELS) -> None:
        """Wait until the Response tab shows this."""
        wanted = json.dumps([scale, list(models)], separators=(",", ":"))
        self.page.wait_for_function("w => document.querySelector('[data-shows]')?.dataset.shows === w", arg=wanted)

    def respond(self, scale: float = 1, models: Sequence[str] = MODELS) -> Any:
        """Open the Response tab, wait until it shows this, and return the page."""
        self.tab("response")
        self.shown(scale, models)
        return self.page

    def peak(self, model: str, name: str) -> float:
        return self.value(f'#peaks tr[data-model="{model}"] [data-name="{name}"]')

    def wait_for(self, selector: str, value: float, rel: float = 0.0) -> None:
        """Wait until an element holds a number, to its last bit, or to a relative difference."""
        self.page.wait_for_function(
            "([s, v, rel]) => { const x = Number(document.querySelector(s)?.dataset.value);"
            " return x === v || Math.abs(x / v - 1) < rel; }",
            arg=[selector, value, rel],
        )

    def wait_for_results(self) -> None:
        """Wait until the results are those of the form."""
        self.page.wait_for_function("() => !document.querySelector('.results.stale')")

    def wait_for_peak(self, model: str, name: str, value: float) -> None:
        self.wait_for(f'#peaks tr[data-model="{model}"] [data-name="{name}"]', value)

    def run_study(self) -> None:
        """Start the study of the tab, and wait until it is done."""
        self.page.locator("#run").click()
        self.page.wait_for_function("() => document.querySelector('#status').textContent.startsWith('Done: ')")

    def upload(self, label: str, name: str, content: bytes) -> None:
        file: Any = {"name": name, "mimeType": "text/plain", "buffer": content}
        self.page.get_by_label(label, exact=True).set_input_files(file)


def link_to(state: Any) -> str:
    """Address of a state, in SI units where it names no others."""
    state = {"units": "SI"} | state if isinstance(state, dict) else state
    text = base64.urlsafe_b64encode(json.dumps(state).encode()).decode().rstrip("=")
    return f"/#s={text}"


@pytest.fixture(scope="session")
def link() -> Any:
    return link_to


@pytest.fixture(scope="session")
def frame() -> Any:
    """The structure of a visitor."""
    return make_frame()


@pytest.fixture(scope="session")
def el_centro() -> Any:
    """The record that the page begins with."""
    return rf.load_suite("el-centro-1940")[0]


@pytest.fixture(scope="session")
def pier() -> rf.Restrained:
    """The preset "Pier with fuses"."""
    fuses = [rf.YieldingDissipator(2e8, 5e5, 0.02, position=x) for x in (-1.3, 1.3)]
    tendon = rf.Tendon(2.5e6, 25e6, yield_force=6e6, post_yield_ratio=0.02)
    from rockflex.web._forms import PRESETS

    (given,) = (each["structure"] for each in PRESETS if each["structure"]["name"] == "Pier with fuses")
    return rf.Restrained(rf.CantileverWithTipMass(**given["cantilever"]), [tendon, *fuses])


@pytest.fixture(scope="session")
def pier_run(pier: rf.Restrained, el_centro: rf.GroundMotion) -> rf.Response:
    """The pier under El Centro times 2."""
    return rf.simulate(pier, el_centro.scaled(2.0), "MDOF-S", free_vibration=5.0, output="history")


@pytest.fixture(scope="session")
def sheet(browser: Any) -> Any:
    """A page for files, which a server does not know."""
    return throttled(browser.new_page())


@pytest.fixture(scope="session")
def axe() -> Any:
    """What axe finds on a page: all of its rules, or those about colours alone."""
    found = pytest.importorskip("axe_playwright_python.sync_playwright", reason="no axe: install rockflex[dev]").Axe()

    def violations(page: Any, *rules: str) -> list[Any]:
        options = {"resultTypes": ["violations"]} | ({"runOnly": [*rules]} if rules else {})
        faults = found.run(page, options=options).response["violations"]
        return [(each["id"], [node["html"][:120] for node in each["nodes"]]) for each in faults]

    return violations


@pytest.fixture(scope="session")
def left() -> dict[str, list[Visitor]]:
    """Visitors that have left, by the options of their contexts: the next one takes their page, which opens sooner."""
    return defaultdict(list)


@pytest.fixture
def visit(browser: Any, server: str, left: dict[str, list[Visitor]]) -> Iterator[Any]:
    here: list[tuple[str, Visitor]] = []

    def new(link: str | None = "/", folded: bool = False, viewport: Any = None, **options: Any) -> Visitor:
        wishes = {name: options.pop(name) for name in ("color_scheme", "reduced_motion") if name in options}
        key = json.dumps([folded, options])
        visitor = left[key].pop() if left[key] else Visitor(browser, server, folded, options)
        here.append((key, visitor))
        visitor.look(viewport, **wishes)
        return visitor if link is None else visitor.open(link)

    yield new
    said = list[str]()
    for key, visitor in here:
        try:
            said += visitor.leave()
            left[key].append(visitor)
        except Exception:  # such as that of a page that a failed test left closed
            said += visitor.said
            visitor.context.close()
    assert said == []


@pytest.fixture
def visitor(visit: Any, client: Client) -> Visitor:
    """A visitor with a frame of Table 1."""
    return visit(link_to(client.state()))
