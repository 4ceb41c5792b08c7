"""The page stays consistent: many changes at once, two tabs of one browser, and a server that is started again."""

import threading
import time

import pytest

import rockflex as rf
from rockflex.web._forms import FIRST

pytestmark = pytest.mark.web

PIER = FIRST["structure"]["cantilever"]


def serving(port: int = 0):
    """A server of its own, and how to stop it."""
    import uvicorn

    from rockflex.web import make_app

    running = uvicorn.Server(uvicorn.Config(make_app(), port=port, log_level="error"))
    thread = threading.Thread(target=running.run, daemon=True)
    thread.start()
    while not running.started:
        assert thread.is_alive(), "the server did not start"
        time.sleep(0.02)

    def stop() -> None:
        running.should_exit = True
        thread.join(10)

    return running.servers[0].sockets[0].getsockname()[1], stop


def rotation(half_width: float, height: float) -> float:
    pier = rf.CantileverWithTipMass(**PIER | {"half_width": half_width, "height": height})
    record = rf.load_suite("el-centro-1940")[0].scaled(2.0)
    return rf.simulate(pier, record, "MDOF-S", free_vibration=5.0).max_rotation


def test_thirty_rapid_edits_end_with_the_last(visit) -> None:
    visitor = visit()
    page = visitor.page
    page.wait_for_selector(".handle")
    page.evaluate(
        """() => {
          const box = document.querySelector('[data-path="few.B"] input');
          for (let i = 0; i < 30; i++) {
            box.value = String(6 + i / 20);
            box.dispatchEvent(new Event("change"));
          }
        }"""
    )
    visitor.wait_for('[data-three="rotation"]', rotation(3.725, 24.0))
    assert visitor.state()["structure"]["cantilever"]["half_width"] == 3.725
    for _ in range(30):
        page.keyboard.press("Control+z")
    page.wait_for_function("() => rockflexPage.state.structure.cantilever.half_width === 3.5")
    visitor.wait_for('[data-three="rotation"]', rotation(3.5, 24.0))


def test_a_tab_made_anew_keeps_its_request(visit) -> None:
    """The tab before it has changes to show when the last one is undone, and would ask once more."""
    visitor = visit()
    page = visitor.page
    page.wait_for_selector(".handle")
    visitor.wait_for('[data-three="rotation"]', rotation(3.5, 24.0))
    page.evaluate(
        """() => {
          const fetched = window.fetch;
          window.fetch = async (url, options) => { // slow, so that requests meet
            if (String(url).endsWith("/api/response")) await new Promise((go) => setTimeout(go, 300));
            return fetched(url, options);
          };
          const box = document.querySelector('[data-path="few.B"] input');
          for (const width of ["8", "9"]) {
            box.value = width;
            box.dispatchEvent(new Event("change"));
          }
        }"""
    )
    page.keyboard.press("Control+z")
    visitor.wait_for('[data-three="rotation"]', rotation(4.0, 24.0))


def test_two_tabs_of_a_browser_have_a_state_each(visit, server) -> None:
    visitor = visit()
    other = visitor.context.new_page()
    try:
        other.goto(server)
        other.wait_for_selector(".handle")
        visitor.fill("few.B", "8")
        height = other.locator('[data-path="few.H"] input')
        height.fill("20")
        height.press("Enter")
        visitor.wait_for('[data-three="rotation"]', rotation(4.0, 24.0))
        wanted = rotation(3.5, 20.0)
        shown = "Number(document.querySelector('[data-three=rotation]').dataset.value)"
        other.wait_for_function(f"w => {shown} === w", arg=wanted)
    finally:
        other.close()


def test_a_server_that_is_started_again_goes_on(browser) -> None:
    port, stop = serving()
    context = browser.new_context()
    page = context.new_page()
    page.set_default_timeout(60_000)
    try:
        page.goto(f"http://127.0.0.1:{port}/")
        page.wait_for_selector(".handle")
        stop()
        box = page.locator('[data-path="few.B"] input')
        box.fill("8")
        box.press("Enter")
        page.get_by_text("The server does not respond.").first.wait_for()
        assert page.evaluate("rockflexPage.state.structure.cantilever.half_width") == 4.0  # nothing is lost
        _, stop = serving(port)
        box.fill("7.6")
        box.press("Enter")
        shown = "Number(document.querySelector('[data-three=rotation]').dataset.value)"
        page.wait_for_function(f"w => {shown} === w", arg=rotation(3.8, 24.0))
        assert page.get_by_text("The server does not respond.").count() == 0
    finally:
        stop()
        context.close()
