"""The page as a whole in a real Chromium: downloads, links, visitors, keyboard, phones, colours."""

import re

import pytest

from rockflex.web import _animation
from rockflex.web._presets import PRESETS

pytestmark = pytest.mark.web

TABS = ("structure", "earthquake", "response", "fragility", "design")
CONTROLS = "button, input, select, textarea, summary, .chart, .stage canvas"


@pytest.mark.parametrize("tab", TABS)
def test_downloads_of_each_tab(visitor, tab, monkeypatch) -> None:
    monkeypatch.setattr(_animation, "RATES", ((60.0, 2.0),))  # an animation of few frames
    page = visitor.page
    visitor.tab(tab)
    if tab == "design":
        visitor.fill("design.widths", "3")
    if tab in ("fragility", "design"):
        visitor.run_study()
    for button in page.locator(".downloads button:visible").all():
        with page.expect_download() as got:
            button.click()
        assert got.value.path().stat().st_size > 50
        assert got.value.suggested_filename.rsplit(".")[-1] in ("svg", "html", "csv", "toml", "py", "gif")


def test_a_link_reopens_the_page(visitor, visit) -> None:
    visitor.fill("structure.frame.period", "0.7")
    visitor.tab("earthquake")
    visitor.fill("scale", "1.5")
    visitor.tab("response")
    visitor.page.get_by_label("2DOF-S", exact=True).uncheck()
    visitor.shown(1.5, ["MDOF-S", "fixed"])
    seen = visitor.peak("MDOF-S", "max_rotation")
    address = visitor.page.evaluate("location.hash")
    visitor.page.reload()
    visitor.shown(1.5, ["MDOF-S", "fixed"])
    assert visitor.peak("MDOF-S", "max_rotation") == seen
    other = visit(f"/{address}")
    other.shown(1.5, ["MDOF-S", "fixed"])
    assert other.peak("MDOF-S", "max_rotation") == seen
    assert other.state() == visitor.state()


@pytest.mark.parametrize(
    ("hash_", "text"),
    [
        ("/#s=%%%", "does not hold a state"),
        ("/#elsewhere", None),
        ("/#s=AAAA", "it is damaged"),
        ({"structure": {"frame": {"n_stories": 10**6}}}, "structure.frame.story_height: it is missing"),
        (7, "The link does not hold a state of the page."),
        ({"structure": PRESETS[1]["structure"], "models": ["<img src=x onerror=alert(1)>"]}, "Unknown model"),
    ],
)
def test_a_damaged_link_is_told(visit, link, hash_, text) -> None:
    visitor = visit(hash_ if isinstance(hash_, str) else link(hash_))
    banner = visitor.page.locator("#banner")
    if text is None:
        assert banner.is_hidden()
    else:
        assert "The link cannot be opened" in banner.inner_text()
        assert text in banner.inner_text()
    visitor.page.wait_for_selector("#adequacy")


def test_two_visitors_do_not_see_each_other(visit) -> None:
    one, other = visit(), visit()
    one.fill("structure.name", "<b>Mine</b>")
    one.page.wait_for_function("() => document.querySelector('.results h2').textContent === '<b>Mine</b>'")
    one.tab("earthquake")
    one.fill("scale", "3")
    other.page.reload()
    other.page.wait_for_selector("#adequacy")
    assert other.state()["structure"]["name"] == "Structure #1 of Table 1"
    assert other.state()["scale"] == 1.0
    assert "Mine" not in other.page.content()


def test_tabs_and_buttons_by_the_keyboard(visitor) -> None:
    page = visitor.page
    page.locator('[data-tab="structure"]').focus()
    for tab in (*TABS[1:], TABS[0]):
        page.keyboard.press("ArrowRight")
        page.wait_for_selector(f'[data-tab="{tab}"][aria-selected="true"]')
    page.keyboard.press("End")
    page.wait_for_selector('#view[data-shown="design"]')
    page.keyboard.press("Home")
    page.wait_for_selector('#view[data-shown="structure"]')
    for _ in range(3):
        page.keyboard.press("ArrowLeft")
    page.wait_for_selector('#view[data-shown="response"]')
    assert page.evaluate("document.activeElement.dataset.tab") == "response"
    assert page.get_by_role("tabpanel", name="Response").is_visible()
    visitor.shown(1, ["MDOF-S", "2DOF-S", "fixed"])
    page.locator("#play").focus()
    page.keyboard.press("Enter")
    page.wait_for_function("() => rockflexStage.playing()")
    page.keyboard.press("Space")
    page.wait_for_function("() => !rockflexStage.playing()")


def test_skipping_to_the_content_keeps_the_state(visitor) -> None:
    page = visitor.page
    visitor.tab("earthquake")
    visitor.fill("scale", "2.5")
    address = page.evaluate("location.hash")
    page.locator("#skip").focus()
    page.keyboard.press("Enter")
    assert page.evaluate("document.activeElement.id") == "main"
    assert page.evaluate("location.hash") == address
    assert visitor.state()["scale"] == 2.5


@pytest.mark.parametrize("tab", TABS)
def test_every_control_has_a_name_and_is_reached_by_tab(visitor, tab) -> None:
    page = visitor.page
    visitor.tab(tab)
    if tab == "structure":
        page.get_by_role("button", name="Add an element").click()
    if tab == "response":
        visitor.shown(1, ["MDOF-S", "2DOF-S", "fixed"])
        page.get_by_label("The superstructure yields").check()
        visitor.shown(1, ["2DOF-S", "2DOF-S-BW", "1DOF-fixed-BW"])
        page.get_by_label("Impact law").select_option("restitution")
    page.wait_for_load_state("networkidle")
    page.evaluate("document.body.tabIndex = -1; document.body.focus()")
    unseen = []
    for _ in range(200):
        page.keyboard.press("Tab")
        at = page.evaluate(
            """() => {
              const e = document.activeElement;
              if (e === document.body || "reached" in e.dataset) return null;
              e.dataset.reached = "";
              const { outlineStyle, outlineWidth } = getComputedStyle(e);
              const seen = outlineStyle !== "none" && parseFloat(outlineWidth) >= 1;
              return [e.outerHTML.slice(0, 80), seen];
            }"""
        )
        if at is None:
            break
        unseen += [at[0]] if not at[1] else []
    assert unseen == []
    left = page.evaluate(
        "c => [...document.querySelectorAll(c)].filter(e => e.checkVisibility() && !e.disabled"
        " && !e.matches('[role=tab][aria-selected=false]') && !('reached' in e.dataset))"
        ".map(e => e.outerHTML.slice(0, 80))",
        CONTROLS,
    )
    assert left == []
    nameless = page.evaluate(
        "[...document.querySelectorAll('main input, main select, main textarea')]"
        ".filter(e => !e.labels?.length && !e.getAttribute('aria-label')).map(e => e.outerHTML.slice(0, 80))"
    )
    assert nameless == []


@pytest.mark.parametrize("tab", TABS)
def test_a_phone_needs_no_sideways_scrolling(visit, tab) -> None:
    visitor = visit(viewport={"width": 390, "height": 844}, has_touch=True)
    page = visitor.page
    visitor.tab(tab)
    page.wait_for_load_state("networkidle")
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    small = page.evaluate(
        """() => [...document.querySelectorAll("button, select, input, textarea, summary")]
          .map((e) => (e.type === "checkbox" && e.closest("label")) || e)
          .filter((e) => e.checkVisibility())
          .filter((e) => e.type !== "checkbox" && e.getBoundingClientRect().height < 32)
          .map((e) => e.outerHTML.slice(0, 80))"""
    )
    assert small == []


def test_dark_and_light(visit) -> None:
    visitor = visit(color_scheme="dark")
    page = visitor.page
    theme = "document.documentElement.dataset.theme"
    page.wait_for_selector("#adequacy")
    assert page.evaluate(theme) == "dark"
    dark = page.evaluate("getComputedStyle(document.body).backgroundColor")
    stroke = "getComputedStyle(document.querySelector('.modes polyline')).stroke"
    line = page.evaluate(stroke)
    page.click("#theme")
    assert page.evaluate(theme) == "light"
    assert page.evaluate("getComputedStyle(document.body).backgroundColor") != dark
    page.wait_for_function(f"c => {stroke} !== c", arg=line)
    page.reload()  # it is kept, though not in the link
    page.wait_for_selector("#adequacy")
    assert page.evaluate(theme) == "light"


def luminance(color: str) -> float:
    """Relative luminance (WCAG 2.2)."""
    assert re.fullmatch("#[0-9a-f]{6}", color), color
    parts = [int(color[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [p / 12.92 if p <= 0.04045 else ((p + 0.055) / 1.055) ** 2.4 for p in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one: str, other: str) -> float:
    """Contrast ratio, from 1 to 21 (WCAG 2.2)."""
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_texts_and_lines_can_be_told_from_their_ground(visit, scheme) -> None:
    visitor = visit(color_scheme=scheme)
    names = ["bg", "panel", "shade", "text", "muted", "error", "accent", "control", "focus", "structure"]
    models = ["c0", "c1", "c2", "c3", "fixed", "fixed2"]
    energies = ["kinetic", "strain", "gravity", "tendons", "damped", "yielded", "lost", "fuse", "damper", "friction"]
    energies += ["soil", "clay"]
    value = visitor.page.evaluate(
        "names => Object.fromEntries(names.map((n) =>"
        " [n, getComputedStyle(document.documentElement).getPropertyValue(`--${n}`).trim()]))",
        names + models + energies,
    )
    assert contrast("#ffffff", "#000000") == pytest.approx(21.0)
    texts = [(name, ground) for name in ("text", "muted", "error") for ground in ("bg", "panel")]
    texts += [(name, "bg") for name in (*models, "lost", "accent")]  # labels on charts; accent: that of a button
    lines = [(name, "bg") for name in (*energies, "structure", "focus", "control")]
    lines += [(name, "panel") for name in ("control", "focus")]
    lines += [(name, "shade") for name in models]
    poor = {pair: contrast(*(value[name] for name in pair)) for pair in texts + lines}
    least = dict.fromkeys(lines, 3.0) | dict.fromkeys(texts, 4.5)
    assert {pair: ratio for pair, ratio in poor.items() if ratio < least[pair]} == {}
