"""How often a drawing follows a handle that is dragged: answers a second and their time, on as many cores as asked.

    taskset -c 0 python benchmarks/page_drag.py

One core then holds the server, the engine and Chromium. Pointer events come 120 times a second.
"""

import shutil
import threading
import time

import uvicorn
from playwright.sync_api import Page, sync_playwright

from rockflex.web import make_app

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
    updates, answer, drawing = page.evaluate(DRAG, [name, across, up, SECONDS])
    told = f"{updates:4.0f} updates/s, answer {answer:5.1f} ms, drawing {drawing:4.1f} ms"
    print(f"{title[:44]:44} {name}: {told}")


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
            drag(page, title + ", tendon, fuses, springs" * held, "B", 60.0, 0.0)
            drag(page, title, "H", 0.0, 60.0)
        browser.close()
    server.should_exit = True


if __name__ == "__main__":
    main()
