"""Take the pictures of the web page, tab by tab, and of a report, for README and guides; needs a Chromium."""

import io
import shutil
import tempfile
import threading
import time
from pathlib import Path

import uvicorn
from PIL import Image
from playwright.sync_api import Page, sync_playwright

import rockflex as rf
from rockflex.web import make_app

FOLDER = Path(__file__).parents[1] / "docs" / "_static"
PORT = 18_321
TABS = "structure", "earthquake", "response", "fragility", "design"
WIDE, PHONE, SHEET = (1180, 860), (420, 860), (794, 1123)  # pixels; the last is A4


def save(page: Page, name: str) -> None:
    """Save what a page shows, with 128 colours."""
    image = Image.open(io.BytesIO(page.screenshot())).convert("RGB").quantize(128, dither=Image.Dither.NONE)
    image.save(FOLDER / f"{name}.png", optimize=True)
    print(f"{name}.png, {(FOLDER / f'{name}.png').stat().st_size / 1e3:.0f} kB")


def report(folder: Path) -> Path:
    """Write the report of a frame on a rocking base."""
    frame = rf.Frame(5, 3.0, 40e3, 40e3, float("inf"), period=1.0, aspect_ratio=8.0, damping_ratio=0.02)
    record = rf.load_suite("el-centro-1940")[0].scaled(1.5)
    runs = [rf.simulate(frame, record, model) for model in ("2DOF-S", "MDOF-S", "fixed")]
    known = {"structure": frame, "motion": record, "friction": 0.5}
    return Path(rf.write_report(runs, folder / "run.html", title="Five stories on a rocking base", **known))


def main() -> None:
    server = uvicorn.Server(uvicorn.Config(make_app(), port=PORT, log_level="error"))
    threading.Thread(target=server.run, daemon=True).start()
    while not server.started:
        time.sleep(0.05)
    with sync_playwright() as playwright, tempfile.TemporaryDirectory() as folder:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        for name, (width, height) in {"page": WIDE, "page-phone": PHONE}.items():
            page = browser.new_page(viewport={"width": width, "height": height})
            page.goto(f"http://127.0.0.1:{PORT}/")
            page.wait_for_selector(".handle")
            page.click("button:has-text('Largest rotation')")
            page.wait_for_timeout(1500)
            save(page, name)
            for tab in TABS[1:] if name == "page" else ():
                page.click(f"#tab-{tab}")
                page.wait_for_timeout(6000)  # the quick looks of the studies
                if tab == "response":
                    page.click("button:has-text('Largest rotation')")
                    page.wait_for_timeout(500)
                save(page, f"{name}-{tab}")
        page = browser.new_page(viewport={"width": SHEET[0], "height": SHEET[1]})
        page.goto(report(Path(folder)).as_uri())
        save(page, "report")
        browser.close()
    server.should_exit = True


if __name__ == "__main__":
    main()
