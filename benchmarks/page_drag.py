"""How often a drawing follows a handle that is dragged, on as many cores as asked, and what each answer costs.

    taskset -c 0 python benchmarks/page_drag.py

One core then holds the server, the engine and Chromium. Pointer events come once a frame. The time of the processor for
each update, and the ratio of the server's to one run of the library, do not depend on what else the machine does.
"""

import shutil
import threading
import time
from typing import Any

import psutil
import uvicorn
from playwright.sync_api import Page, sync_playwright
from timing import least

import rockflex as rf
from rockflex.web import make_app
from rockflex.web._state import parse_page_state

PORT = 18_322
SECONDS = 3.0  # of a drag
WATCH = """() => {
  window.found = [];
  const { player } = rockflexDrawn;
  const set = player.set.bind(player);
  const asked = window.fetch;
  window.fetch = async (...all) => {
    const begun = performance.now();
    const answer = await asked(...all);
    window.waited = performance.now() - begun;
    return answer;
  };
  player.set = (...all) => {
    const begun = performance.now();
    set(...all);
    window.found.push([begun, window.waited, performance.now() - begun]);
  };
}"""
# Within the page, since every event that Playwright sends takes some milliseconds of its own.
DRAG = """async ([name, across, up, lasts]) => {
  const dot = document.querySelector(`[data-handle="${name}"]`);
  const { x, y, width, height } = dot.getBoundingClientRect();
  const [x0, y0] = [x + width / 2, y + height / 2];
  const tell = (type, share) => dot.dispatchEvent(new PointerEvent(type, {
    pointerId: 1, bubbles: true, clientX: x0 + share * across, clientY: y0 - share * up,
  }));
  dot.setPointerCapture = () => {};
  dot.hasPointerCapture = () => true;
  window.found = [];
  tell("pointerdown", 0);
  const begun = performance.now();
  for (let seconds = 0; seconds < lasts; seconds = (performance.now() - begun) / 1000) {
    tell("pointermove", seconds / lasts);
    await new Promise(requestAnimationFrame); // as browsers align pointers to frames
  }
  const seconds = (performance.now() - begun) / 1000;
  const { found } = window;
  tell("lostpointercapture", 1);
  const middle = (values) => values.sort((a, b) => a - b)[Math.floor(values.length / 2)];
  return [found.length / seconds, middle(found.map((each) => each[1])), middle(found.map((each) => each[2]))];
}"""


CASES = (
    ("Frame #1: shear, 1 s, h*/B = 10", False),
    ("Bridge pier on a footing, 24 m", False),
    ("Bridge pier on a footing, 24 m", True),
)
HELD = """() => rockflexPage.change({
  structure: { ...rockflexPage.state.structure, elements: [
    { kind: "tendon", position: 0, initial_force: 2.5e6, stiffness: 36e6 },
    { kind: "yielding_dissipator", position: -3, stiffness: 790e6, yield_force: 1.6e6 },
    { kind: "yielding_dissipator", position: 3, stiffness: 790e6, yield_force: 1.6e6 },
  ] },
  ground: { mat_mass: 160e3, springs: { stiffness: 790e6, heave_damping_ratio: 0.1 } },
})"""  # as the page's own new elements and springs


def drag(page: Page, title: str, name: str, across: float, up: float) -> None:
    page.wait_for_timeout(3000)
    before = processor_time()
    updates, answer, drawing = page.evaluate(DRAG, [name, across, up, SECONDS])
    server, browser = (1e3 * (now - then) for now, then in zip(processor_time(), before, strict=True))
    count = updates * SECONDS
    alone = 1e3 * one_run(page.evaluate("rockflexPage.state"))
    print(f"{title}, {name}: {updates:.0f} updates/s, answer {answer:.1f} ms, drawing {drawing:.1f} ms")
    ratio = f"{server / count / alone:.2f} runs"
    print(f"    processor: server {server / count:.1f} ms = {ratio}, Chromium {browser / count:.1f} ms")


def processor_time() -> tuple[float, float]:
    """Processor time of the server and of Chromium so far, in s."""
    own = psutil.Process()
    times = [sum(each.cpu_times()[:2]) for each in (own, *own.children(recursive=True))]
    return times[0], sum(times[1:])


def one_run(content: dict[str, Any]) -> float:
    """Processor time of `rf.simulate` with history, of a structure whose modes are known, in s."""
    state = parse_page_state(content)
    motion = rf.load_suite(state.record.suite)[state.record.name].scaled(state.scale)

    def run() -> None:
        p = state.structure.build().rocking()
        ground = None if state.ground is None else state.ground.under(p)
        rf.simulate(p, motion, "2DOF-S", ground=ground, free_vibration=state.free_vibration)

    return least(run, 10, time.process_time)


def main() -> None:
    server = uvicorn.Server(uvicorn.Config(make_app(), port=PORT, log_level="error"))
    threading.Thread(target=server.run, daemon=True).start()
    while not server.started:
        time.sleep(0.05)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": 1280, "height": 900})
        page.goto(f"http://127.0.0.1:{PORT}/")
        page.wait_for_selector(".handle")
        page.evaluate(WATCH)
        for title, held in CASES:
            page.get_by_label("Start from").select_option(label=title)
            if held:
                page.evaluate(HELD)
            for name, across, up in (("B", 60.0, 0.0), ("H", 0.0, 60.0)):
                drag(page, title + ", devices, springs" * held, name, across, up)
        browser.close()
    server.should_exit = True


if __name__ == "__main__":
    main()
