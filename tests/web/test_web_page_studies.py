"""The Fragility and the Design tab in a browser."""

import re
from typing import Any

import pytest

import rockflex as rf
from builders import make_frame
from rockflex.web._state import parse_page_state
from rockflex.web._structure import build_page_structure

pytestmark = pytest.mark.web

LONG = ", ".join(f"{0.25 * k:g}" for k in range(1, 21))  # scales: the study takes longer than it takes to cancel it


def test_fragility_runs_refits_and_cancels(visitor, frame) -> None:
    page = visitor.page
    visitor.tab("fragility")
    page.get_by_text("A quick look, with fewer runs. Done: 88 runs.").wait_for()  # with two of the three scales
    assert page.locator("#fits tbody tr").count() == 1
    assert page.get_by_role("button", name="Rocking and overturning (SVG)").is_disabled()
    held: list[Any] = []  # until the server has taken the study, what is shown is the quick look
    page.route("**/api/study/cloud", lambda route: held.append(route), times=1)
    with page.expect_request("**/api/study/cloud"):
        page.locator("#run").click()
    with page.expect_response("**/api/study/cloud/*"):
        page.get_by_label("Intensity measure").select_option("pga")
    with page.expect_response("**/api/study/cloud/*"):
        page.get_by_label("Intensity measure").select_option("pgv")
    visitor.pictures()
    assert page.locator("#status").inner_text().startswith("A quick look")
    held[0].continue_()
    page.wait_for_function("() => document.querySelector('#status').textContent.startsWith('Done: ')")
    assert page.locator("#status").inner_text() == "Done: 132 runs."
    assert page.get_by_role("button", name="Rocking and overturning (SVG)").is_enabled()
    runs = rf.run_cloud(frame, rf.load_suite("fema-p695-far-field"), "MDOF-S", [0.5, 1.0, 2.0], free_vibration="settle")
    (fit,) = rf.fit_clouds(runs, "pgv")
    page.get_by_label("Limit state").select_option("rocking")
    visitor.wait_for('#fits [data-name="median"]', fit.outcomes.initiation.median, 1e-9)
    page.get_by_label("Intensity measure").select_option("sa_t1")
    page.get_by_label("Limit state").select_option("nominal")
    (fit,) = rf.fit_clouds(runs, "sa_t1", nominal=True)
    visitor.wait_for("#fits [data-name=median]", fit.outcomes.overturning.median, 1e-9)
    page.get_by_label("Limit state").select_option("rotation")
    visitor.fill("cloud.rotation", "7")
    visitor.wait_for_error("cloud.rotation", "a rotation in rad, from 0.0001 to 1.5, but 7 was given")
    visitor.fill("cloud.rotation", "0.02")
    page.get_by_label("MDOF-C-SI").check()
    visitor.fill("cloud.scales", LONG)
    visitor.tab("structure")
    visitor.fill("structure.frame.n_stories", "15")
    visitor.tab("fragility")
    page.locator("#run").click()
    page.wait_for_function("() => /^[1-9]\\d* of/.test(document.querySelector('#status').textContent)")
    # It goes on while another tab is looked at.
    visitor.tab("structure")
    visitor.tab("fragility")
    page.get_by_role("button", name="Cancel").click()
    page.wait_for_function("() => document.querySelector('#status').textContent.startsWith('Cancelled after')")
    assert page.locator("#cancel").is_disabled()


@pytest.mark.slow
def test_a_change_asks_for_a_new_run_and_a_new_one_takes_the_place_of_the_old(visitor) -> None:
    page = visitor.page
    visitor.tab("fragility")
    visitor.run_study()
    visitor.fill("cloud.scales", "0.5, 1, 2, 3")
    stale = page.get_by_text("The input has changed: run again.")
    stale.wait_for()
    visitor.fill("cloud.scales", "0.5, 1, 2")
    stale.wait_for(state="detached")
    page.get_by_label("MDOF-C-SI").check()
    visitor.fill("cloud.scales", LONG)
    page.locator("#run").click()
    page.wait_for_function("() => /^[1-9]\\d* of/.test(document.querySelector('#status').textContent)")
    page.get_by_label("MDOF-C-SI").uncheck()
    visitor.fill("cloud.scales", "1, 2")
    page.get_by_role("button", name="Run again").click()
    page.wait_for_function("() => document.querySelector('#status').textContent === 'Done: 88 runs.'")
    assert page.locator("#fits tbody tr").count() == 1


@pytest.mark.slow
def test_a_cloud_that_yields(visitor, frame) -> None:
    page = visitor.respond()
    page.get_by_label("The superstructure yields").check()
    visitor.fill("bouc_wen.yield_displacement", "0.05")
    visitor.tab("fragility")
    page.get_by_label("2DOF-S-BW").check()
    visitor.fill("cloud.scales", "1")
    page.get_by_label("near-field-pulse").check()
    page.get_by_label("far-field", exact=True).uncheck()
    visitor.run_study()
    suite, labels = rf.load_suite("fema-p695-near-field-pulse"), ["MDOF-S", "2DOF-S-BW"]
    runs = rf.run_cloud(frame, suite, labels, [1.0], free_vibration=10.0, bouc_wen=rf.BoucWen(0.05))
    page.get_by_label("Limit state").select_option("rotation")
    visitor.fill("cloud.rotation", "0.02")
    beyond = (runs["status"] == "overturned") | (runs["max_rotation"] > 0.02)
    assert beyond[runs["model"] == "MDOF-S"].sum() != beyond[runs["model"] == "2DOF-S-BW"].sum()
    for label in labels:
        cell = page.locator(f'#fits [data-model="{label}"] [data-name="n_exceeding"]')
        cell.get_by_text(str(beyond[runs["model"] == label].sum()), exact=True).wait_for()
    # The hysteresis matters to what ran.
    visitor.tab("response")
    visitor.fill("bouc_wen.yield_displacement", "0.06")
    visitor.tab("fragility")
    page.get_by_text("The input has changed: run again.").wait_for()
    visitor.tab("design")
    page.get_by_label("Model").select_option("2DOF-S-BW")
    visitor.fill("design.widths", "3")
    visitor.run_study()
    assert page.locator("#designs tbody tr").count() == 6


@pytest.mark.slow
def test_design_answers_how_wide(visitor) -> None:
    page = visitor.page
    visitor.tab("design")
    visitor.fill("design.widths", "4")
    page.get_by_text("A quick look, with fewer runs. Done: ").wait_for()
    assert page.locator("#designs tbody tr").count() == 4
    visitor.run_study()
    answers = page.locator("#width p")
    assert answers.count() == 2
    assert re.search(
        r"no tendon: a base [\d.]+ m wide \(B = [\d.]+ m\) is enough \(now 2\.11 m", answers.first.inner_text()
    )
    free, held = (visitor.value(f'#width p[data-tendon="{name}"]') for name in ("no tendon", "F₀ = 0.2 W"))
    assert held < free
    before = visitor.state()["structure"]
    page.get_by_role("button", name="Use it").last.click()
    page.wait_for_selector('#view[data-shown="structure"]')
    built = build_page_structure(parse_page_state(visitor.state()).structure).properties
    assert built.half_width == pytest.approx(held, rel=1e-5)
    level = rf.TendonLevel(0.2, 0.5).held(
        make_frame(aspect_ratio=10.0 * make_frame().rocking().half_width / held).rocking()
    )
    assert built.tendons[0].initial_force == pytest.approx(level.tendons[0].initial_force, rel=1e-9)
    assert built.tendons[0].stiffness == pytest.approx(level.tendons[0].stiffness, rel=1e-6)
    page.locator("#undo").click()
    page.wait_for_function("() => !rockflexPage.state.structure.elements")
    assert visitor.state()["structure"] == before
    visitor.tab("design")
    visitor.fill("design.target", "0.0001")
    page.wait_for_selector("text=no base tried is wide enough")
    visitor.fill("design.widest", "999")
    visitor.wait_for_error("design.widest", "from 1 to 10, but 999 was given")


@pytest.mark.slow
def test_a_search_is_cancelled_and_told_of_changes(visitor) -> None:
    page = visitor.page
    visitor.fill("structure.frame.n_stories", "15")
    visitor.tab("design")
    page.get_by_label("Model").select_option("MDOF-S")
    visitor.fill("design.widths", "20")  # takes longer than it takes to cancel it
    page.get_by_role("button", name="Search", exact=True).click()
    page.wait_for_function("() => /^[1-9]\\d* of/.test(document.querySelector('#status').textContent)")
    assert "not decided" in page.locator("#width").inner_text()
    page.wait_for_function("() => / left/.test(document.querySelector('#status').textContent)")
    page.get_by_role("button", name="Cancel").click()
    page.wait_for_function("() => document.querySelector('#status').textContent.startsWith('Cancelled after')")
    assert "not decided" in page.locator("#width").inner_text()
    assert page.locator("#width p").count() == 0
    visitor.fill("design.widths", "5")
    page.get_by_text("The input has changed: search again.").wait_for()
    visitor.fill("design.target", "0.5")  # a question, for which nothing runs again
    assert page.locator("#cancel").is_disabled()
