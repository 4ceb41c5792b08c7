"""Take the picture of the web page that the README shows; needs a Chromium, see install_browser.sh."""

import shutil
import threading
import time
from pathlib import Path

import uvicorn
from playwright.sync_api import sync_playwright

from rockflex.web import make_app

TARGET = Path(__file__).parents[1] / "docs" / "_static" / "page.png"
PORT = 18_321


def main() -> None:
    server = uvicorn.Server(uvicorn.Config(make_app(), port=PORT, log_level="error"))
    threading.Thread(target=server.run, daemon=True).start()
    while not server.started:
        time.sleep(0.05)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": 1180, "height": 860})
        page.goto(f"http://127.0.0.1:{PORT}/")
        page.wait_for_selector(".handle")
        page.click("button:has-text('Largest rotation')")
        page.wait_for_timeout(500)
        page.screenshot(path=TARGET)
        browser.close()
    server.should_exit = True
    print(f"written to {TARGET}")


if __name__ == "__main__":
    main()
