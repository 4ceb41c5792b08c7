"""Alternatives and projects in a browser: kept, seen, named, edited again, and saved."""

import json
from pathlib import Path
from typing import Any

import pytest

import rockflex as rf
from builders import make_frame

pytestmark = pytest.mark.web

NAMES = "[...document.querySelectorAll('.kept input')].map((each) => each.value)"
HEADS = "[...document.querySelectorAll('#differences thead th')].map((each) => each.textContent)"
GHOSTS = "rockflexDrawn.player.stage.ghosts.map((each) => each.name)"


def wait_for_heads(page, heads: list[str]) -> None:
    page.wait_for_function(f"heads => JSON.stringify({HEADS}) === JSON.stringify(heads)", arg=["demand", *heads])


def keep_and_widen(visitor) -> None:
    """Keep the frame of Table 1, and change it."""
    visitor.page.locator("#keep").press("Enter")
    visitor.fill("structure.frame.aspect_ratio", "8")
    wait_for_heads(visitor.page, ["A", "B", "B to A [%]"])


@pytest.mark.slow
def test_kept_ones_are_compared_named_edited_and_removed(visitor, visit, el_centro) -> None:
    page = visitor.page
    assert not page.locator("#differences").is_visible()
    keep_and_widen(visitor)
    frames = {"A": make_frame(), "B": make_frame(aspect_ratio=8.0)}
    found = rf.compare(frames, el_centro, free_vibration=5.0)
    cells = page.locator("#differences tbody tr:first-child td")
    shown = [float(each.get_attribute("data-value")) for each in cells.all()]
    expected = [*found.demands().loc["max_rotation"], found.differences().loc["max_rotation", "B"]]
    assert shown == pytest.approx(expected, rel=1e-12)
    page.wait_for_function(f"() => {GHOSTS}.join() === 'A'")
    box = page.get_by_label("Name of the alternative")
    box.fill("narrow")
    box.press("Enter")
    wait_for_heads(page, ["narrow", "A", "A to narrow [%]"])
    assert box.evaluate("e => e === document.activeElement")
    assert page.locator("#keep").inner_text() == "Keep as A"
    # A link has them too.
    other = visit(f"/{page.evaluate('location.hash')}")
    wait_for_heads(other.page, ["narrow", "A", "A to narrow [%]"])
    assert other.state() == visitor.state()
    page.locator("#keep").click()
    page.get_by_label("Name of the alternative").last.fill("narrow")
    page.get_by_label("Name of the alternative").last.press("Enter")
    visitor.wait_for_error("alternatives", "A name must not be empty")
    assert page.evaluate(NAMES) == ["narrow", "A"]
    page.get_by_role("button", name="Edit again: narrow").press("Enter")
    page.wait_for_function("() => rockflexPage.state.structure.frame.aspect_ratio === 10")
    ratio = '[data-path="structure.frame.aspect_ratio"] input'  # of the form, which is drawn anew
    page.wait_for_function("ratio => document.querySelector(ratio)?.value === '10'", arg=ratio)
    wait_for_heads(page, ["narrow", "A", "A to narrow [%]"])  # the present one is the first again
    page.get_by_role("button", name="Remove: A").press("Enter")
    assert page.evaluate("document.activeElement.id") == "keep"
    page.wait_for_function("() => document.querySelector('#differences').hidden")
    assert (page.evaluate(NAMES), page.evaluate(GHOSTS)) == (["narrow"], [])


@pytest.mark.slow
def test_charts_and_drawing_of_the_response_have_them(visitor, el_centro) -> None:
    keep_and_widen(visitor)
    page = visitor.respond()
    page.wait_for_function("() => document.querySelector('#keys').textContent.endsWith('fixedA')")
    rotations = (
        "rockflexStage.charts.rotation.data.series.map((each) => [each.label, Math.max(...each.y.map(Math.abs))])"
    )
    found = dict(page.evaluate(rotations))
    assert list(found) == ["MDOF-S", "2DOF-S", "fixed", "A"]
    run = rf.simulate(make_frame(), el_centro, free_vibration=5.0, output="history")
    assert found["A"] == pytest.approx(abs(run.rotation).max(), rel=1e-6)  # in single precision
    assert page.evaluate("rockflexStage.stage.ghosts[0].half_width") == make_frame().rocking().half_width
    visitor.tab("structure")
    with page.expect_download() as got:
        page.get_by_role("button", name="Report of all (HTML)").click()
    assert "B to A" in got.value.path().read_text("utf-8")


@pytest.mark.slow
def test_they_are_compared_under_the_set(visitor) -> None:
    """What makes each another one is said."""
    page = visitor.page
    page.locator("#keep").click()
    visitor.fill("structure.frame.aspect_ratio", "8")
    page.locator("#alternatives").get_by_role("button", name="Set of records").click()
    moments = '#under-set tr[data-demand="max_base_moment"] td'
    page.wait_for_selector(moments)
    assert page.locator(moments).count() == 3  # A, the present one, and the fixed base
    seen = [each.get_attribute("data-value") for each in page.locator(moments).all()]
    assert len(set(seen)) == 3
    assert "10 → 8" in page.locator("#under-set tbody tr").first.inner_text()
    assert page.locator("#under-set [data-check=rotation] td").count() == 3
    assert not page.locator("#differences").is_visible()
    with page.expect_download() as got:
        page.locator('#record-set [data-file="comparison"]:visible').click()
    assert "B to A" in got.value.path().read_text("utf-8")
    visitor.tab("structure")
    page.locator('[aria-label="Remove: A"]').click()
    visitor.tab("response")
    page.wait_for_selector("#under-set", state="hidden")


@pytest.mark.slow
def test_edit_again_changes_the_models_of_another_kind(visitor) -> None:
    keep_and_widen(visitor)
    page = visitor.page
    page.get_by_label("Kind", exact=True).select_option("block")
    wait_for_heads(page, ["A", "B", "B to A [%]"])
    assert visitor.state()["models"] == ["rigid"]
    page.get_by_role("button", name="Edit again: A").click()
    page.wait_for_function("() => 'frame' in rockflexPage.state.structure")
    state = visitor.state()
    assert state["models"] == ["MDOF-S", "2DOF-S", "fixed"]
    assert (state["cloud"]["models"], state["design"]["model"]) == (["MDOF-S"], "MDOF-S")


def test_a_project_is_saved_and_opened(visitor, visit, tmp_path) -> None:
    keep_and_widen(visitor)
    page = visitor.page
    for path, text in {"title": "Two frames", "author": "A. Engineer"}.items():
        visitor.fill(f"head.{path}", text)
    with page.expect_download() as got:
        page.get_by_role("button", name="Save the project").click()
    file = tmp_path / got.value.suggested_filename
    file.write_bytes(Path(got.value.path()).read_bytes())
    assert list(rf.read_project(file).structures) == ["A", "B"]
    other = visit()
    other.wait_for_results()
    held: list[Any] = []  # the answer about the form comes after the one about the file
    other.page.route("**/api/structure", lambda route: held.append(route), times=1)
    with other.page.expect_request("**/api/structure"):
        other.page.evaluate("rockflexPage.change({})")
    other.upload("Open a project", "bad.rockflex", b"no archive")
    other.wait_for_error("project", "not a project file")
    held[0].continue_()
    other.wait_for_results()
    other.wait_for_error("project", "not a project file")
    other.upload("Open a project", file.name, file.read_bytes())
    wait_for_heads(other.page, ["A", "B", "B to A [%]"])
    assert json.dumps(other.state(), sort_keys=True) == json.dumps(visitor.state(), sort_keys=True)
    assert other.page.get_by_label("Author").input_value() == "A. Engineer"
    assert other.page.locator('[data-path="structure.frame.aspect_ratio"] input').input_value() == "8"
    limited = rf.Project({"a": make_frame()}, rf.one_sine_pulse(3.0, 0.8), limits=rf.CheckLimits(friction=0.3))
    limited.save(tmp_path / "limited.rockflex")
    other.upload("Open a project", "limited.rockflex", (tmp_path / "limited.rockflex").read_bytes())
    other.page.wait_for_function("() => !document.querySelector('#differences tr')")
    assert other.state()["limits"]["friction"] == 0.3


@pytest.mark.slow
def test_axe_finds_nothing(visitor, axe) -> None:
    keep_and_widen(visitor)
    for tab, ready in (("structure", "#differences td"), ("response", "#peaks td")):
        visitor.tab(tab)
        visitor.page.wait_for_selector(ready)
        visitor.settle()
        visitor.wait_for_results()
        for rules in ([], ["color-contrast"]):  # in the other theme, only contrast differs
            assert axe(visitor.page, *rules) == []
            visitor.page.click("#theme")
