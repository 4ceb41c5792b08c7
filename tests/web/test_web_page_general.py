"""The page as a whole: tabs, links, themes, cursors of charts, and waiting."""

import re

import numpy as np
import pytest

import rockflex as rf
from rockflex.structure.file._structure_entry import StructureEntry
from rockflex.web import _downloads
from rockflex.web._forms import PRESETS
from rockflex.web._structure import build_page_structure

pytestmark = pytest.mark.web

TABS = ("structure", "earthquake", "response", "fragility", "design")
CONTROLS = "button, input, select, textarea, summary, .chart, .stage .pinned canvas, .handle"


@pytest.mark.slow
def test_downloads_of_each_tab(visit, client, link, monkeypatch) -> None:
    monkeypatch.setattr(_downloads, "FRAME_RATES", ((60.0, 2.0),))  # an animation of few frames
    pulse = {"source": "pulse", "pulse": {"shape": "one_sine", "amplitude": 4.0, "period": 0.8}}
    few = {"suites": ["fema-p695-near-field-pulse"], "scales": [1.0]}
    state = client.state(record=pulse, models=["2DOF-S"], cloud=few, design=few | {"widths": 3, "tendons": [0.0]})
    visitor, made = visit(link(state)), set()
    page = visitor.page
    for tab in TABS:
        visitor.tab(tab)
        visitor.settle()
        if tab in ("fragility", "design"):
            visitor.run_study()
        for button in page.locator(".downloads button:visible").all():
            what = button.get_attribute("data-file")
            of = tab if what in ("figure", "table") else ""
            if (of, what) in made:  # on another tab
                continue
            made.add((of, what))
            with page.expect_download() as got:
                button.click()
            assert got.value.path().stat().st_size > 50
            ending = got.value.suggested_filename.rsplit(".")[-1]
            assert ending in ("svg", "html", "pdf", "csv", "toml", "py", "gif", "rockflex")
            assert (ending == "svg") == (what == "figure")
    assert {("", what) for what in ("report", "animation", "record", "cloud-study", "design-python")} <= made
    assert {(tab, "figure") for tab in ("response", "fragility", "design")} <= made


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


@pytest.mark.slow
def test_a_damaged_link_is_told(visit, link) -> None:
    visitor = visit("/#s=%%%")
    banner = visitor.page.locator("#banner")
    for address, text in (
        (None, "does not hold a state"),
        ("/#elsewhere", None),
        ("/#s=AAAA", "it is damaged"),
        (link(7), "The link does not hold a state of the page."),
    ):
        if address:
            visitor.follow(address)
        if text is None:
            assert banner.is_hidden()
        else:
            assert banner.is_visible()
            assert "The link cannot be opened" in banner.inner_text()
            assert text in banner.inner_text()
        visitor.page.wait_for_selector("#adequacy")


def test_a_link_with_bad_values_opens_with_them_in_their_fields(visit, link, client) -> None:
    frame = PRESETS[1]["structure"]
    state = client.state(
        structure=frame,
        head={"title": "Kept"},
        scale=500,
        tab="fragility",
        cloud={"limit": "rotation", "rotation": 9.0},
    )
    visitor = visit(link(state))
    page, banner = visitor.page, visitor.page.locator("#banner")
    assert "scale: it must be" in banner.inner_text()
    visitor.tab("response")
    visitor.wait_for_error("scale", "500")
    scale = page.locator('[data-path="scale"] input[type="text"]')
    assert (scale.input_value(), scale.get_attribute("aria-invalid")) == ("500", "true")
    visitor.tab("fragility")
    visitor.wait_for_error("cloud.rotation", "from 0.0001 to 1.5")
    assert visitor.state()["head"] == {"title": "Kept"}
    assert visitor.state()["structure"]["frame"]["period"] == frame["frame"]["period"]
    visitor.follow(link({"structure": {"frame": {"n_stories": 10**6}}, "head": {"author": "A"}}))
    assert "structure.frame.story_height: it is missing" in banner.inner_text()
    visitor.wait_for_error("structure.frame.story_height", "missing")
    assert visitor.state()["head"] == {"author": "A"}
    visitor.follow(link({"structure": frame, "models": ["<img src=x onerror=alert(1)>"]}))
    assert "Unknown model" in banner.inner_text()
    visitor.wait_for_error("models", "Unknown model")


def test_changes_are_undone_and_done_again(visitor) -> None:
    """Also where the drawing cannot follow: what is typed stays, and the numbers of another structure are dimmed."""
    page, tall = visitor.page, visitor.page.locator('[data-path="few.H"] input')
    first = visitor.state()["structure"]
    visitor.wait_for_results()
    assert page.locator("#undo").is_disabled()
    visitor.fill("few.H", "35000")
    visitor.wait_for_error("few.H", "7000")
    page.wait_for_selector("#three.stale")
    visitor.fill("few.B", "1.2")  # another field shows the state as well, and leaves it as it is
    page.wait_for_function("() => !pendingAnswers")
    assert (tall.input_value(), tall.get_attribute("aria-invalid")) == ("35000", "true")
    assert visitor.state()["structure"]["frame"]["story_height"] == 35000 / 5
    page.keyboard.press("Control+z")
    page.keyboard.press("Control+z")
    page.wait_for_selector("#three:not(.stale) dd")
    assert visitor.state()["structure"] == first
    page.wait_for_function("""() => document.querySelector('[data-path="few.H"] input').value === '15'""")
    page.keyboard.press("Control+y")
    visitor.wait_for_error("few.H", "7000")
    visitor.fill("few.H", "15")  # typing the old one mends it
    page.wait_for_selector("#three:not(.stale) dd")
    ends = [{**each["frame"], "stiffness_ratio": 0} for each in (visitor.state()["structure"], first)]
    assert ends[0] == pytest.approx(ends[1], rel=1e-5)
    assert page.locator('[data-path="few.H"] > .error').inner_text() == ""
    assert page.locator("#redo").is_disabled()
    visitor.fill("few.T", "-1")
    visitor.wait_for_error("few.T", "above 0")
    assert page.locator('[data-path="few.T"] input').input_value() == "-1"
    visitor.tab("earthquake")
    visitor.fill("scale", "3")
    page.locator('[data-path="scale"] input[type="text"]').focus()
    page.keyboard.type("9")  # typed only: the browser's own undo
    page.keyboard.press("Control+z")
    assert visitor.state()["scale"] == 3
    page.locator("#undo").click()
    page.wait_for_function("() => rockflexPage.state.scale === 1 && rockflexPage.state.tab === 'earthquake'")


def test_going_back_leaves_the_state_as_it_was_and_alternatives_survive_another_visit(visitor, client) -> None:
    page = visitor.page
    page.locator("#keep").click()
    visitor.fill("structure.frame.aspect_ratio", "8")
    before = visitor.state()
    page.get_by_role("button", name="Edit again: A").click()
    page.wait_for_function("() => rockflexPage.state.structure.frame.aspect_ratio === 10")
    page.evaluate("() => { rockflexPage.change({ scale: 7 }, true); history.back(); }")  # not written yet
    page.wait_for_function("() => rockflexPage.state.structure.frame.aspect_ratio === 8")
    visitor.pictures(30)
    assert visitor.state() == before
    page.goto("about:blank")
    visitor.open("/")  # without the link
    assert [each["name"] for each in visitor.state()["alternatives"]] == ["A"]
    page.locator('[aria-label="Remove: A"]').click()
    page.goto("about:blank")
    visitor.open("/")
    assert visitor.state()["alternatives"] == []


@pytest.mark.slow
def test_two_visitors_do_not_see_each_other(visit) -> None:
    one, other = visit(), visit()
    one.page.wait_for_selector("#adequacy")
    one.fill("structure.name", "<b>Own</b>")
    one.page.wait_for_function("() => document.querySelector('[data-task=modes] h2').textContent === '<b>Own</b>'")
    one.tab("earthquake")
    one.fill("scale", "3")
    other.page.reload()
    other.page.wait_for_selector("#adequacy")
    assert other.state()["structure"]["name"] == "Bridge pier"
    assert other.state()["scale"] == 2.0
    assert "Own" not in other.page.locator("main").inner_text()


@pytest.mark.slow
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
    visitor.shown()
    page.locator("#play").focus()
    page.keyboard.press("Enter")
    page.wait_for_function("() => rockflexStage.playing()")
    page.keyboard.press("Space")
    page.wait_for_function("() => !rockflexStage.playing()")


@pytest.mark.slow
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


@pytest.mark.slow
def test_every_control_has_a_name_and_is_reached_by_tab(visit, client, link) -> None:
    visitor = visit(link(client.state(models=["2DOF-S"])))
    page = visitor.page
    page.get_by_role("button", name="Add an element").click()
    for tab in TABS:
        visitor.tab(tab)
        if tab == "response":
            visitor.shown(1, ["2DOF-S"])
            page.get_by_label("The superstructure yields").check()
            page.get_by_label("Impact law").select_option("restitution")
        visitor.settle()
        check_controls(page)


def check_controls(page) -> None:
    page.evaluate("document.body.tabIndex = -1; document.body.focus()")
    page.evaluate("document.querySelectorAll('[data-reached]').forEach((e) => delete e.dataset.reached)")
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


@pytest.mark.slow
def test_a_phone_needs_no_sideways_scrolling(visit) -> None:
    visitor = visit(viewport={"width": 390, "height": 844}, has_touch=True)
    page = visitor.page
    for tab in TABS:
        visitor.tab(tab)
        visitor.settle()
        assert page.evaluate("document.documentElement.scrollWidth") <= 390
        small = page.evaluate(
            """() => [...document.querySelectorAll("button, select, input, textarea, summary")]
              .map((e) => (e.type === "checkbox" && e.closest("label")) || e)
              .filter((e) => e.checkVisibility())
              .filter((e) => e.type !== "checkbox" && e.getBoundingClientRect().height < 32)
              .map((e) => e.outerHTML.slice(0, 80))"""
        )
        assert small == []


@pytest.mark.slow
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


def test_texts_and_lines_can_be_told_from_their_ground(visit) -> None:
    page = visit().page
    check_contrasts(page)
    page.click("#theme")
    assert page.evaluate("document.documentElement.dataset.theme") == "dark"
    check_contrasts(page)


def check_contrasts(page) -> None:
    names = ["bg", "panel", "shade", "text", "muted", "error", "accent", "control", "focus", "structure"]
    models = ["c0", "c1", "c2", "c3", "fixed", "fixed2"]
    energies = ["kinetic", "strain", "gravity", "tendons", "damped", "yielded", "lost", "fuse", "damper", "friction"]
    energies += ["soil", "clay"]
    value = page.evaluate(
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


MODELS = ["MDOF-S", "2DOF-S", "fixed"]
ATTRIBUTES = {
    "rotation": "rotation",
    "displacement": "total_top_displacement",
    "base_moment": "base_moment",
    "base_shear": "base_shear",
}
READOUTS = """() => Object.fromEntries(Object.entries(rockflexStage.charts)
  .filter(([, chart]) => chart.element.checkVisibility())
  .map(([name, chart]) => [name, chart.readout.map((row) => row.text)]))"""
# Columns of pixels that are painted from top to bottom of the axes, as shares of the width of each chart; the canvas is
# copied, since reading it several times makes Chromium warn.
COLUMNS = """() => [...document.querySelectorAll(".chart")].filter((chart) => chart.checkVisibility()).map((chart) => {
  const canvas = chart.querySelector(".over");
  const { width, height } = canvas;
  const g = new OffscreenCanvas(width, height).getContext("2d", { willReadFrequently: true });
  g.drawImage(canvas, 0, 0);
  const rows = [0.12, 0.3, 0.4, 0.5, 0.65].map((share) => g.getImageData(0, Math.round(share * height), width, 1).data);
  const painted = Array.from({ length: width }, (_, i) => i).filter((i) => rows.every((row) => row[4 * i + 3] > 0));
  return [chart.getAttribute("aria-label"), painted.map((i) => i / width)];
})"""


def read(text: str) -> float:
    """The number after a name."""
    digits = text.split(": ")[-1].split("= ")[-1].translate(str.maketrans("−⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "--0123456789"))
    return float(digits.replace("·10", "e"))


@pytest.fixture
def shown(visitor):
    visitor.respond(1, MODELS)
    return visitor


def point_at(visitor, name: str, share: float) -> float:
    """Move the pointer over a chart; return where it is as a share of the chart's width."""
    box = visitor.page.get_by_role("application", name=name).bounding_box()
    visitor.page.mouse.move(box["x"] + share * box["width"], box["y"] + box["height"] / 2)
    return share


@pytest.mark.slow
def test_every_history_is_read_where_one_is_pointed_at(shown, frame, el_centro) -> None:
    page = shown.page
    assert set(page.evaluate(READOUTS)) == set(ATTRIBUTES)
    assert not any(page.evaluate(READOUTS).values())
    runs = {model: rf.simulate(frame, el_centro, model, free_vibration=5.0) for model in MODELS}
    for chart, share in (("Base moment over time", 0.4), ("Rotation over time", 0.55)):
        point_at(shown, chart, share)
        found = page.evaluate(READOUTS)
        (time,) = {read(rows[0]) for rows in found.values()}
        exact = page.evaluate("rockflexStage.panel.hover")
        assert time == pytest.approx(exact, rel=1e-3)
        assert all(rows[0].startswith("t [s] = ") for rows in found.values())
        for name, attribute in ATTRIBUTES.items():
            assert [row.split(": ")[0] for row in found[name][1:]] == MODELS
            for model, row in zip(MODELS, found[name][1:], strict=True):
                values = np.asarray(getattr(runs[model], attribute))
                # The page thins histories, so that a value is known to a part of the largest one.
                expected = np.interp(exact, runs[model].time, values)
                assert read(row) == pytest.approx(expected, abs=0.02 * np.abs(values).max() + 1e-12)
    page.mouse.move(5, 5)
    assert not any(page.evaluate(READOUTS).values())
    # A line is drawn in each of them.
    before = dict(page.evaluate(COLUMNS))
    histories = [name for name in before if name.endswith("over time") and not name.startswith("Energy")]
    assert len(histories) == 4
    share = point_at(shown, "Base shear over time", 0.6)
    after = dict(page.evaluate(COLUMNS))
    for name in before:
        new = [place for place in after[name] if place not in before[name]]
        if name in histories:
            assert new
            assert np.array(new) == pytest.approx(share, abs=0.004)
        else:  # the loop and the energy have other axes
            assert new == []
    page.mouse.move(5, 5)
    assert dict(page.evaluate(COLUMNS)) == before


@pytest.mark.slow
def test_the_keys_move_it_everywhere_and_zooming_takes_it_away(shown) -> None:
    page = shown.page
    chart = page.get_by_role("application", name="Rotation over time")
    chart.focus()
    for key in ("Home", "Shift+ArrowRight", "Shift+ArrowRight"):
        page.keyboard.press(key)
    end = page.evaluate("rockflexStage.view().end")
    found = page.evaluate(READOUTS)
    assert [read(rows[0]) for rows in found.values()] == pytest.approx([0.2 * end] * 4, rel=1e-3)
    assert chart.locator("[aria-live]").inner_text() == "; ".join(found["rotation"])  # its own values only
    page.keyboard.press("+")
    assert not any(page.evaluate(READOUTS).values())
    low, high = page.evaluate("rockflexStage.panel.zoom")
    point_at(shown, "Displacement of the top over time", 0.5)
    time = page.evaluate("rockflexStage.charts.base_shear.hover")
    assert low < time < high
    assert all(len(rows) == 4 for rows in page.evaluate(READOUTS).values())
    page.locator("#play").focus()  # the focus has left the chart
    assert not any(page.evaluate(READOUTS).values())
    # Dragging in one chart neither sets the time nor zooms early.
    chart.press("Escape")
    chart.press("Home")
    page.locator("#play").focus()
    point_at(shown, "Base moment over time", 0.3)
    page.mouse.down()
    point_at(shown, "Base moment over time", 0.5)
    assert page.evaluate("rockflexStage.panel.zoom") is None
    assert all(page.evaluate(READOUTS).values())
    page.mouse.up()
    low, high = page.evaluate("rockflexStage.panel.zoom")
    assert 0.0 < low < high < page.evaluate("rockflexStage.view().end")
    assert page.evaluate("rockflexStage.time()") == 0.0
    assert not any(page.evaluate(READOUTS).values())


@pytest.mark.slow
def test_histories_of_the_ground_share_it_as_well(visitor) -> None:
    page = visitor.page
    visitor.tab("earthquake")
    visitor.settle()
    before = dict(page.evaluate(COLUMNS))
    share = point_at(visitor, "Ground velocity over time", 0.5)
    after = dict(page.evaluate(COLUMNS))
    moved = [
        name for name in after if any(abs(place - share) < 0.004 for place in set(after[name]) - set(before[name]))
    ]
    assert moved == [f"Ground {name} over time" for name in ("acceleration", "velocity", "displacement")]


@pytest.mark.slow
def test_on_a_phone_the_values_stay_within_their_chart(visit, client, link) -> None:
    visitor = visit(link(client.state()), viewport={"width": 390, "height": 844}, has_touch=True)
    visitor.respond(1, MODELS)
    visitor.page.locator('[aria-label="Base moment over time"]').scroll_into_view_if_needed()
    point_at(visitor, "Base moment over time", 0.7)
    texts = visitor.page.evaluate(READOUTS)["base_moment"]
    assert len(texts) == 4
    edges = visitor.page.evaluate(
        """() => [...document.querySelectorAll(".chart .over")].filter((each) => each.checkVisibility()).map((each) => {
          const { data } = each.getContext("2d").getImageData(each.width - 1, 0, 1, each.height);
          return data.some((value) => value > 0);
        })"""
    )
    assert len(edges) >= 4
    assert not any(edges)


class Held:
    """Requests, about structures if nothing else is said, which wait for `release`."""

    def __init__(self, page, path: str = "structure") -> None:
        self.routes, self.open = [], False
        page.route(f"**/api/{path}", self.take)

    def take(self, route) -> None:
        if self.open:
            route.continue_()
        else:
            self.routes.append(route)

    def release(self) -> None:
        self.open = True
        for route in self.routes:
            route.continue_()


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["springs", "winkler"])
def test_new_springs_wait_for_the_structure_they_suit(visitor, kind) -> None:
    """Answers that are held back: neither no structure nor the previous one may be taken for the present one."""
    page = visitor.page
    page.wait_for_selector("#view dl.values")
    held = Held(page)
    chimney = next(i for i, each in enumerate(PRESETS) if "chimney" in each["title"].lower())
    page.get_by_label("Start from").select_option(str(chimney))
    page.get_by_label("Ground", exact=True).select_option(kind)
    visitor.pictures()
    assert "ground" not in visitor.state()
    held.release()
    page.wait_for_selector("#springs")
    p = build_page_structure(StructureEntry.model_validate(PRESETS[chimney]["structure"])).properties
    ground = visitor.state()["ground"]
    assert ground["mat_mass"] == float(f"{0.1 * p.m_tot:.2g}")
    stiffness = p.m_tot * 9.81 / 0.005
    if kind == "springs":
        assert ground["springs"]["stiffness"] == float(f"{stiffness / 2:.2g}")
    else:
        breadth = float(f"{2 * p.half_width:.2g}")
        assert ground["bed"]["subgrade_modulus"] == float(f"{stiffness / (2 * p.half_width * breadth):.2g}")


@pytest.mark.slow
def test_the_last_choice_of_a_ground_counts_while_the_structure_is_awaited(visitor) -> None:
    page = visitor.page
    held = Held(page)
    page.reload()
    ground = page.get_by_label("Ground", exact=True)
    ground.select_option("springs")
    ground.select_option("")
    held.release()
    page.wait_for_selector("#view dl.values")
    assert "ground" not in visitor.state()
    visitor.fill("structure.frame.aspect_ratio", "-1")
    page.wait_for_selector(".results.stale")
    ground.select_option("springs")  # of a structure that cannot be built: usual numbers, to be changed
    page.wait_for_function("() => rockflexPage.state.ground !== undefined")
    assert visitor.state()["ground"]["mat_mass"] == 2e4


@pytest.mark.slow
@pytest.mark.parametrize(("linked", "keys"), [(False, True), (True, False)])
def test_a_tab_chosen_before_the_page_knows_its_state_is_shown(visit, link, client, linked, keys) -> None:
    visitor = visit(None)
    page = visitor.page
    about = Held(page, "about")
    page.goto(visitor.url + (link(client.state()) if linked else "/"), wait_until="commit")
    if keys:
        page.locator('[data-tab="structure"]').focus()
        for _ in range(3):
            page.keyboard.press("ArrowRight")
        page.keyboard.press("ArrowLeft")
    else:
        page.locator('[data-tab="fragility"]').click()
        page.locator('[data-tab="response"]').click()
    about.release()
    page.wait_for_selector('#view[data-shown="response"]')
    assert visitor.state()["tab"] == "response"
    page.locator('[data-tab="earthquake"]').click()  # and the next choice is not overruled
    page.wait_for_selector('#view[data-shown="earthquake"]')
