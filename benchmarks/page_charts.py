"""Charts of the web page in Chromium: how long they take to draw and to follow the animation, and what they weigh.

    python benchmarks/page_charts.py [--samples 4000] [--repeat 20] [--instead FOLDER]

Six charts over time with three curves each, spans, triangles and a vertical line, in a page of 1280 by 900:

- first: from nothing to pixels, with the elements of the page;
- again: the same charts with other values;
- cursor: their time cursor and its points are moved, without painting;
- busy: work of the browser's main thread for each of the frames in which the cursor moves, painting included;
- interval: between these frames; a screen allows 16.7 ms at best;
- playing, busy: the same while the whole Response tab plays, with its structure and the loop;
- heap: JavaScript objects of the page when it shows the Response tab.

`--instead` measures another implementation of `static/chart.js` with the same interface: files in this folder are
served in place of the page's files of the same names (`index.html` too).
"""

import argparse
import gzip
import mimetypes
import socket
import statistics
import subprocess
import sys
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table
from web_latency import reach

import rockflex.web

STATIC = Path(rockflex.web.__file__).parent / "static"
OWN = ("chart.js", "axes.js", "marks.js")
FRAMES = 120

# Curves like those of a response: their values differ from draw to draw, their times do not.
CURVES = """
  const times = (n, m) => Float32Array.from({ length: n }, (_, i) => (60 * (i + 0.3 * m * (i % 2))) / n);
  const wave = (v, speed) => Math.exp(-v / 25) * Math.sin(speed * v) * (5 + 1.5 * Math.sin(31 * v));
  const curve = (t, m, k) => t.map((v) => wave(v, 3 + m + 0.01 * k));
  const spans = Array.from({ length: 60 }, (_, i) => [i + 0.2, i + 0.8]);
  const looks = [["c0", []], ["c1", [7, 3]], ["fixed", [4, 3]]];
  const ts = looks.map((_, m) => times(SAMPLES, m));
  const content = (k) => ({
    series: looks.map(([color, dash], m) => (
      { x: ts[m], y: curve(ts[m], m, k), until: Infinity, label: `model ${m}`, color, dash, width: m ? 1.2 : 1.6 })),
    spans, xRange: [0, 60], ticks: spans.map(([a]) => a), vlines: [{ x: 40, color: "error", label: "falls" }],
  });
  // Reading one pixel waits until all of a canvas is painted.
  const painted = (charts) => charts.forEach(({ element }) => element.querySelectorAll("canvas").forEach((canvas) => (
    canvas.width && canvas.getContext("2d").getImageData(0, 0, 1, 1))));
  const made = (overTime) => overTime(Array.from({ length: 6 }, (_, i) => (
    { label: `chart ${i}`, yLabel: "M_b [kN m]", height: 130, firstOnTop: true })));
  const next = () => new Promise((done) => requestAnimationFrame(done));
"""

DRAW = """async () => {
  const { overTime } = await import("/static/chart.js");
  const place = document.querySelector(".results");
  const [first, again, cursor] = [[], [], []];
  for (let k = 0; k < REPEAT; k++) {
    const [one, other] = [content(2 * k), content(2 * k + 1)];
    const host = document.createElement("div");
    place.prepend(host);
    await next();
    const began = performance.now();
    const charts = made(overTime);
    host.append(...charts.map((chart) => chart.element));
    charts.forEach((chart) => chart.set(one));
    await null; // some draw in a microtask
    painted(charts);
    first.push(performance.now() - began);
    await next();
    await next();
    const changed = performance.now();
    charts.forEach((chart) => chart.set(other));
    await null;
    painted(charts);
    again.push(performance.now() - changed);
    const moved = performance.now();
    for (let i = 0; i < 10; i++)
      charts.forEach((chart) => chart.setCursor(3 * i, looks.map(([color]) => ({ x: 3 * i, y: 0, color }))));
    cursor.push((performance.now() - moved) / 10);
    host.remove();
  }
  return { first, again, cursor };
}"""

FOLLOW = """async () => {
  const { overTime } = await import("/static/chart.js");
  const host = document.createElement("div");
  document.querySelector(".results").prepend(host);
  const charts = made(overTime);
  host.append(...charts.map((chart) => chart.element));
  charts.forEach((chart) => chart.set(content(0)));
  host.scrollIntoView();
  for (let i = 0; i < 20; i++) await next();
  globalThis.followed = host;
  globalThis.follow = async (frames) => {
    const at = [performance.now()];
    for (let i = 0; i < frames; i++) {
      const time = (60 * i) / frames;
      charts.forEach((chart) => chart.setCursor(time, looks.map(([color]) => ({ x: time, y: 0, color }))));
      await next();
      at.push(performance.now());
    }
    return at.slice(1).map((each, i) => each - at[i]);
  };
}"""

PLAY = """async (frames) => {
  const end = rockflexStage.view().end;
  for (let i = 0; i < frames; i++) {
    rockflexStage.move((end * i) / frames);
    await new Promise((done) => requestAnimationFrame(done));
  }
}"""


def weight(folder: Path | None) -> tuple[int, int, int]:
    """Own lines, bytes, and bytes after gzip, of all files that charts need."""
    files = [folder / name if folder and (folder / name).exists() else STATIC / name for name in OWN]
    lines = sum(len(file.read_text().splitlines()) for file in files)
    files += sorted((folder / "vendor").glob("*")) if folder else []
    contents = [file.read_bytes() for file in files]
    return lines, sum(map(len, contents)), sum(len(gzip.compress(each)) for each in contents)


def replaced(folder: Path) -> Any:
    """Handler of the page's requests that serves what the folder has."""

    def handle(route: Any) -> None:
        path = route.request.url.split("/", 3)[3].split("#")[0].removeprefix("static/") or "index.html"
        if (folder / path).is_file():
            route.fulfill(body=(folder / path).read_bytes(), content_type=mimetypes.guess_type(path)[0])
        else:
            route.continue_()

    return handle


def opened(browser: Any, url: str, folder: Path | None) -> Any:
    """A page that shows the Response tab."""
    page = browser.new_page(viewport={"width": 1280, "height": 900})
    page.set_default_timeout(60_000)
    if folder:
        page.route("**/*", replaced(folder))
    page.goto(url)
    page.wait_for_selector("#view > .columns")
    page.click('[data-tab="response"]')
    page.wait_for_selector("[data-shows]")
    return page


def busy(page: Any, script: str, frames: int) -> tuple[Any, float]:
    """What the script returns, and the seconds of the main thread for each frame."""
    session = page.context.new_cdp_session(page)
    session.send("Performance.enable")

    def spent() -> float:
        return {each["name"]: each["value"] for each in session.send("Performance.getMetrics")["metrics"]}[
            "TaskDuration"
        ]

    before = spent()
    value = page.evaluate(script, frames)
    return value, (spent() - before) / frames


def measure(browser: Any, url: str, samples: int, repeat: int, folder: Path | None) -> dict[str, float]:
    """Milliseconds, and the megabytes of the heap."""
    with_curves = f"(async () => {{ const SAMPLES = {samples}, REPEAT = {repeat}; {CURVES} return await ({{}})(); }})()"
    page = opened(browser, url, folder)
    session = page.context.new_cdp_session(page)
    session.send("HeapProfiler.collectGarbage")
    heap = session.send("Runtime.getHeapUsage")["usedSize"]
    times = {name: statistics.median(values) for name, values in page.evaluate(with_curves.replace("{}", DRAW)).items()}
    page.evaluate(with_curves.replace("{}", FOLLOW))
    intervals, work = busy(page, "frames => follow(frames)", FRAMES)
    page.evaluate("followed.remove()")
    _, playing = busy(page, PLAY, FRAMES)
    page.close()
    return times | {
        "busy": 1e3 * work,
        "interval": statistics.median(intervals),
        "playing, busy": 1e3 * playing,
        "heap": heap / 1e6,
    }


def serve() -> tuple[subprocess.Popen[bytes], str]:
    """A server of its own, and its address."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    server = subprocess.Popen(
        [sys.executable, "-m", "rockflex", "serve", "--port", str(port)], stderr=subprocess.DEVNULL
    )
    first = reach(port)
    first.post("/api/response", {"state": first.get("/api/about")["state"]})  # compiled, and read from disk
    return server, f"http://127.0.0.1:{port}"


def table(samples: int = 4000, repeat: int = 20, folder: Path | None = None) -> Table:
    """Times and weights of the page's charts, and of others if a folder is given."""
    import shutil

    from playwright.sync_api import sync_playwright

    columns = {"of the page": None} | ({str(folder): folder} if folder else {})
    server, url = serve()
    try:
        with sync_playwright() as playwright:
            path = next((found for name in ("chromium", "google-chrome") if (found := shutil.which(name))), None)
            browser = playwright.chromium.launch(executable_path=path, args=["--no-sandbox"])
            found = [measure(browser, url, samples, repeat, each) for each in columns.values()]
            browser.close()
    finally:
        server.terminate()
        server.wait(20)
    shown = Table("", *columns, title=f"6 charts, 3 curves of {samples} samples each; ms, median of {repeat}")
    for name in found[0]:
        unit = ", MB" if name == "heap" else ", ms"
        shown.add_row(name + unit, *(f"{each[name]:.2f}" for each in found))
    weights = [weight(each) for each in columns.values()]
    for row, name in enumerate(("own lines", "bytes", "bytes, gzip")):
        shown.add_row(name, *(str(each[row]) for each in weights))
    return shown


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--samples", type=int, default=4000)
    parser.add_argument("--repeat", type=int, default=20)
    parser.add_argument("--instead", type=Path, help="folder with other files of the page")
    given = parser.parse_args()
    Console().print(table(given.samples, given.repeat, given.instead))


if __name__ == "__main__":
    main()
