"""List what is cut in the built documentation: text that is wider than its place, on a wide and on a narrow screen.

Opens every page of a folder (default: build/docs) in a Chromium, see install_browser.sh. A page that scrolls sideways
is cut; code, outputs, tables and formulas may scroll inside themselves, and are counted.
"""

import argparse
import shutil
import sys
from collections import Counter
from pathlib import Path

from playwright.sync_api import sync_playwright

WIDTHS = 1280, 420  # pixels
LEFT_OUT = {"genindex.html", "search.html", "py-modindex.html"}
# Parts that are wider than their place: they are cut if they, or what is around them, hide what does not fit. A page is
# cut if it scrolls sideways.
MEASURE = """() => {
  const root = document.scrollingElement;
  const over = root.scrollWidth - root.clientWidth;
  const found = over > 1 ? [["page cut", over, document.title]] : [];
  for (const each of document.querySelectorAll("pre, table, dt.sig, img, div.math, .katex-display")) {
    if (each.offsetParent === null) continue;
    let box = each, state = "cut", wide = 0;
    for (; box && box !== document.body; box = box.parentElement) {
      const style = getComputedStyle(box).overflowX;
      if (box.scrollWidth > box.clientWidth + 1 && box.clientWidth > 0 && style !== "visible") {
        wide = box.scrollWidth - box.clientWidth;
        state = style === "hidden" || style === "clip" ? "cut" : "scrolls";
        break;
      }
    }
    const kind = `${each.tagName.toLowerCase()} ${state}`;
    if (wide > 0) found.push([kind, wide, each.textContent.trim().slice(0, 60)]);
  }
  return found;
}"""


def main() -> int:
    """Print a line for each kind of part that is cut or scrolls, and the pages that are cut; 1 if any is."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", nargs="?", type=Path, default=Path(__file__).parents[1] / "build" / "docs")
    parser.add_argument("--list", action="store_true", help="name every part that scrolls as well")
    given = parser.parse_args()
    pages = sorted(page for page in given.folder.rglob("*.html") if "_static" not in page.parts)
    pages = [page for page in pages if page.name not in LEFT_OUT and "_modules" not in page.parts]
    cut = 0
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        tab = browser.new_page()
        for width in WIDTHS:
            tab.set_viewport_size({"width": width, "height": 900})
            parts, places = Counter[str](), dict[str, set[str]]()
            for page in pages:
                tab.goto(page.resolve().as_uri(), wait_until="load")
                tab.wait_for_timeout(50)
                name = str(page.relative_to(given.folder))
                for kind, over, text in tab.evaluate(MEASURE):
                    parts[kind] += 1
                    places.setdefault(kind, set()).add(name)
                    if kind.endswith("cut") or given.list:
                        print(f"  {width} {name}: {kind} by {over:.0f} px: {text!r}")
            print(f"{width} px, {len(pages)} pages")
            for kind, count in sorted(parts.items()):
                print(f"  {kind}: {count} on {len(places[kind])} pages")
            cut += sum(count for kind, count in parts.items() if kind.endswith("cut"))
        browser.close()
    return int(cut > 0)


if __name__ == "__main__":
    sys.exit(main())
