"""The line of the pointer in charts over time: all charts of a group show it, with their values there."""

import numpy as np
import pytest

import rockflex as rf

pytestmark = pytest.mark.web

MODELS = ["MDOF-S", "2DOF-S", "fixed"]
ATTRIBUTES = {
    "rotation": ("rotation", 1e3),
    "displacement": ("total_top_displacement", 1.0),
    "base_moment": ("base_moment", 1e-3),
    "base_shear": ("base_shear", 1e-3),
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
    visitor.tab("response")
    visitor.shown(1, MODELS)
    return visitor


def point_at(visitor, name: str, share: float) -> float:
    """Move the pointer over a chart; return where it is as a share of the chart's width."""
    box = visitor.page.get_by_role("application", name=name).bounding_box()
    visitor.page.mouse.move(box["x"] + share * box["width"], box["y"] + box["height"] / 2)
    return share


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
        for name, (attribute, factor) in ATTRIBUTES.items():
            assert [row.split(": ")[0] for row in found[name][1:]] == MODELS
            for model, row in zip(MODELS, found[name][1:], strict=True):
                values = factor * np.asarray(getattr(runs[model], attribute))
                # The page thins histories, so that a value is known to a part of the largest one.
                expected = np.interp(exact, runs[model].time, values)
                assert read(row) == pytest.approx(expected, abs=0.02 * np.abs(values).max() + 1e-12)
    page.mouse.move(5, 5)
    assert not any(page.evaluate(READOUTS).values())


def test_a_line_is_drawn_in_each_of_them(shown) -> None:
    page = shown.page
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


def test_dragging_in_one_chart_does_not_set_the_time_or_zoom_early(shown) -> None:
    page = shown.page
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


def test_histories_of_the_ground_share_it_as_well(visitor) -> None:
    page = visitor.page
    visitor.tab("earthquake")
    page.wait_for_load_state("networkidle")
    before = dict(page.evaluate(COLUMNS))
    share = point_at(visitor, "Ground velocity over time", 0.5)
    after = dict(page.evaluate(COLUMNS))
    moved = [
        name for name in after if any(abs(place - share) < 0.004 for place in set(after[name]) - set(before[name]))
    ]
    assert moved == [f"Ground {name} over time" for name in ("acceleration", "velocity", "displacement")]


def test_on_a_phone_the_values_stay_within_their_chart(visit) -> None:
    visitor = visit(viewport={"width": 390, "height": 844}, has_touch=True)
    visitor.tab("response")
    visitor.shown(1, MODELS)
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
