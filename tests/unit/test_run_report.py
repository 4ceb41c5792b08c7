"""The report of a run: its numbers are those of the responses, and the page needs nothing else."""

import dataclasses
import datetime as dt
import math
import re

import numpy as np
import pytest

import rockflex as rf
from report_case import FRAME, HELD, PIER, PULSE, SPRINGS, runs
from report_page import number, read
from rockflex._numbers import rounded
from rockflex.report.run import _checks

MODELS = ("2DOF-S", "MDOF-S", "fixed")
SIZES = {
    "max_rotation": 1e-3,
    "max_top_displacement": 1e-3,
    "max_total_top_displacement": 1e-3,
    "max_base_shear": 1e3,
    "max_base_moment": 1e3,
    "max_horizontal_reaction": 1e3,
    "min_vertical_reaction": 1e3,
}


@pytest.fixture(scope="module")
def three():
    return runs(FRAME, PULSE, MODELS, free_vibration=3.0)


@pytest.fixture(scope="module")
def page(three, tmp_path_factory):
    path = tmp_path_factory.mktemp("report") / "run.html"
    assert rf.write_report(three, path, structure=FRAME, motion=PULSE, friction=0.5, date="2030-01-02") == path
    return path


def test_the_peaks_are_those_of_the_responses(page, three):
    _, *rows = read(page).tables["peaks"]
    assert [row[0][0] for row in rows] == list(MODELS)
    for row, response in zip(rows, three, strict=True):
        cells = {name: (text, value) for text, name, value in row}
        for name, size in SIZES.items():
            text, value = cells[name]
            assert value == getattr(response, name)
            assert number(text) == pytest.approx(value / size, rel=5.1e-3)
        assert int(cells["n_uplifts"][0]) == response.n_uplifts
        assert cells["floor_acceleration"][1] == response.floors.floor_acceleration.max()
        assert number(cells["floor_acceleration"][0]) == pytest.approx(cells["floor_acceleration"][1] / 9.81, rel=6e-3)


def test_the_checks_follow_from_the_responses(page, three):
    head, *rows = read(page).tables["checks"]
    assert [cell[0] for cell in head] == ["model", "uplift", "overturning", "contact", "friction", "energy balance"]
    limit = FRAME.rocking().nominal_overturning_rotation
    for row, response in zip(rows, three, strict=True):
        cells = {name: (text, value) for text, name, value in row}
        text, needed = cells["required_friction"]
        assert needed == response.required_friction_excluding_impacts()
        assert ("> 0.5" in text) == (needed > 0.5)
        assert cells["closing_error"][1] == response.energy.closing_error
        if response.model != "fixed":
            assert cells["overturning_margin"][1] == pytest.approx(limit / response.max_rotation)
            assert cells["first_uplift"][1] == response.uplift_times[0]


def test_the_structure_and_the_record(page):
    reader, p = read(page), FRAME.rocking()
    assert number(reader.facts["m_tot"][0]) == pytest.approx(p.m_tot / 1e3)
    assert number(reader.facts["uplift_acceleration"][0]) == pytest.approx(p.uplift_acceleration / 9.80665, rel=5e-3)
    # α is the rotation at which the static moment vanishes, here as in the nomenclature and on the page.
    assert reader.facts["alpha"][2] == pytest.approx(p.m_tot * p.half_width / p.l0r, rel=1e-12)
    assert number(reader.facts["nominal"][0]) == pytest.approx(
        0.7e3 * math.atan(p.half_width / p.effective_height[0]), 5e-3
    )
    assert number(reader.facts["pga"][0]) == pytest.approx(PULSE.pga / 9.80665, rel=5e-3)
    assert number(reader.facts["pgv"][0]) == pytest.approx(PULSE.pgv, rel=5e-3)
    _, *modes = reader.tables["modes"]
    beyond = rf.uplifted_modes(p).omega
    for n in range(2):
        assert modes[n][1][2] == pytest.approx(2.0 * np.pi / p.omega[n])
        assert modes[n][2][2] == pytest.approx(2.0 * np.pi / beyond[n])
    assert modes[-1][3][2] == pytest.approx(1.0)  # all of the mass above the base
    assert "2030-01-02" in reader.text


def test_the_page_needs_nothing_else(page):
    text = page.read_text("utf-8")
    assert "http" not in text
    assert "<script" not in text
    assert not re.search(r"url\((?!#)|@import|<link|<img", text)
    assert text.count("<svg") == 2
    assert "@page { size: A4;" in text
    assert re.search(r"rockflex [\d.]+\S*, numpy [\d.]+, Python [\d.]+", text)


def test_equal_inputs_give_equal_pages(page, three, tmp_path):
    again = rf.write_report(three, tmp_path / "a.html", structure=FRAME, motion=PULSE, friction=0.5, date="2030-01-02")
    assert again.read_bytes() == page.read_bytes()


def test_the_scale_is_found(tmp_path):
    found = runs(FRAME, PULSE.scaled(1.3), ["2DOF-S"])
    for motion in (PULSE, PULSE.scaled(1.3)):
        facts = read(rf.write_report(found, tmp_path / "r.html", motion=motion)).facts
        assert facts["scale"][2] == pytest.approx(1.3)
        assert facts["pga"][2] == pytest.approx(1.3 * PULSE.pga)


def test_without_motion_and_structure_the_history_tells(three, tmp_path):
    facts = read(rf.write_report(three[0], tmp_path / "r.html", date=dt.date(2030, 1, 2))).facts
    assert facts["pga"][2] == pytest.approx(PULSE.pga, rel=1e-6)
    assert facts["pgv"][2] == pytest.approx(PULSE.pgv, rel=1e-6)
    assert facts["n_modes"][2] == 1


def test_a_page_of_elements_springs_and_slip(tmp_path):
    found = runs(HELD, PULSE.scaled(2.0), ["2DOF-S"], ground=SPRINGS)
    reader = read(rf.write_report(found, tmp_path / "r.html", structure=HELD, motion=PULSE))
    _, *rows = reader.tables["elements"]
    assert [row[0][0] for row in rows][-1] == "and 1 more"
    for k, row in enumerate(rows[:-1]):
        assert row[3][2] == found[0].max_element_force[k]
        assert row[4][2] == found[0].max_element_elongation[k]
    assert "12 springs without tension" in reader.text
    assert "the base slides at μ = 0.4" in reader.text
    head, cells = reader.tables["peaks"]
    assert {"slipmm", "edge up"} & {cell[0].split("[")[0] for cell in head}
    assert {name: value for _, name, value in cells}["max_edge_settlement"] == found[0].max_edge_settlement


def test_what_would_take_minutes_is_left_out(tmp_path, monkeypatch):
    found = runs(HELD, PULSE, ["2DOF-S"], ground=rf.Ground(springs=SPRINGS.springs, base_inertia=5e5))
    text = read(rf.write_report(found, tmp_path / "r.html")).text
    assert "not computed" not in text
    monkeypatch.setattr(_checks, "MAX_WORK", found[0].time.size * SPRINGS.springs.n - 1)
    monkeypatch.setattr(rf.History, "required_friction", property(lambda _: pytest.fail("computed")))
    reader = read(rf.write_report(found, tmp_path / "r.html"))
    assert [cell[0] for cell in reader.tables["checks"][1]].count("not computed") == 2
    assert "Not computed: energies and friction of a run that would take too long here." in reader.text


def test_a_run_that_overturns_says_so(tmp_path):
    (fell,) = runs(FRAME, rf.one_sine_pulse(8.0, 2.5), ["2DOF-S"], free_vibration=10.0)
    assert fell.status == "overturned"
    reader = read(rf.write_report(fell, tmp_path / "r.html"))
    assert "overturned †" in reader.tables["peaks"][1][1][0]
    assert "include its fall" in reader.text
    assert f"overturned at {fell.end_time:.2f} s" in reader.tables["checks"][1][2][0]


def test_warnings_and_notes_are_on_the_page(tmp_path):
    tonnes = dataclasses.replace(PIER, tip_mass=60.0)
    found = runs(tonnes, PULSE, ["2DOF-S"])
    text = read(rf.write_report(found, tmp_path / "r.html", structure=tonnes, notes=["Note <1>.", "Note 2."])).text
    assert rf.structure_warnings(tonnes)[0] in text
    assert "Note <1>." in text
    assert "Note 2." in text


def test_of_many_warnings_the_first_are_listed(tmp_path):
    forces = [1e3 * (801 + k) for k in range(6)]
    held = [rf.Restrained(PIER, rf.Tendon(800e3, 20e6, yield_force=force)) for force in forces]
    pulled = [run for each in held for run in runs(each, PULSE.scaled(2.0), ["2DOF-S"])]
    assert len({text for run in pulled for text in run.warnings}) == 6
    text = read(rf.write_report(pulled, tmp_path / "r.html")).text
    assert f"2DOF-S (4): {pulled[3].warnings[0]}" in text
    assert f"F/Fy = {rounded(pulled[0].tendon_utilisation)} > 1" in text
    assert "and 2 more warnings; see the responses" in text
    alike = read(rf.write_report(pulled[:1] * 2, tmp_path / "r.html")).text
    assert f"2DOF-S (1), 2DOF-S (2): {pulled[0].warnings[0]}" in alike


def test_many_notes_are_run_together(tmp_path, three):
    text = read(rf.write_report(three, tmp_path / "r.html", notes=[f"n{k}\n" for k in range(60)])).text
    assert "n0 • n1 • n2" in text
    assert "n58 • n59" in text


def test_a_rigid_block(tmp_path):
    block = rf.rigid_block(0.2, 3.0, 20e3)
    reader = read(rf.write_report(runs(block, PULSE, ["rigid"]), tmp_path / "r.html", structure=block))
    assert "Rigid block under Ricker" in reader.text
    assert reader.facts["nominal"][2] == pytest.approx(0.7 * 0.2)
    assert reader.facts["alpha"][2] == pytest.approx(math.tan(0.2))
    assert "modes" not in reader.tables


def test_names_that_are_markup_and_models_that_occur_twice(tmp_path):
    odd = rf.GroundMotion(PULSE.acceleration, PULSE.dt, name="<b>a_b</b> & $x$")
    found = runs(FRAME, odd, ["2DOF-S"]) + runs(FRAME, odd, ["2DOF-S"], impact=rf.Restitution(0.8))
    reader = read(rf.write_report(found, tmp_path / "r.html", title="<i>"))
    assert odd.name in reader.text
    assert [row[0][0] for row in reader.tables["peaks"][1:]] == ["2DOF-S (1)", "2DOF-S (2)"]
    assert "VVELSimplified (2DOF-S (1)); Restitution, e = 0.800 (2DOF-S (2))" in reader.text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (12347.0, "12\u202f300"), (1234.5, "1230"), (0.02, "0.0200"), (20.04, "20.0"), (-3.14159, "−3.14"), (0.0, "0"),
        (999.6, "1000"), (9.9996, "10.0"), (math.nan, "–"), (None, "–"), (math.inf, "∞"), (-math.inf, "−∞"),
        (1.2345e-7, "1.23e−07"),
    ],
)  # fmt: skip
def test_numbers_have_three_digits(value, text):
    assert rounded(value) == text


def test_re_centring_is_that_of_a_base_at_rest(tmp_path):
    """A record that ends in the middle of a vibration says nothing of what remains."""
    fused = rf.Restrained(PIER, [rf.YieldingDissipator(60e6, 150e3, 0.02, x) for x in (-1.5, 1.5)])
    p, strong = fused.rocking(), PULSE.scaled(3.0)
    (run,) = runs(fused, strong, ["2DOF-S"])
    assert abs(run.residual_rotation) > 1e-4
    (row,) = read(rf.write_report(run, tmp_path / "r.html", structure=fused)).tables["checks"][1:]
    text, value = next((text, value) for text, name, value in row if name == "settled_rotation")
    assert value == 0.0
    assert text.startswith("closes")
    ratios = [rounded(p.recentring_ratio), rounded(p.recentring_ratio_at(run.max_rotation))]
    assert all(each in text for each in ratios)
    assert ratios[0] != ratios[1]
    # A stronger fuse holds it open.
    kept = rf.Restrained(PIER, rf.FrictionDamper(9e6))
    (run,) = runs(kept, strong.scaled(3.0), ["2DOF-S"])
    (settled,) = runs(kept, strong.scaled(3.0), ["2DOF-S"], free_vibration="settle")
    (row,) = read(rf.write_report(run, tmp_path / "s.html", structure=kept)).tables["checks"][1:]
    (value,) = (value for _, name, value in row if name == "settled_rotation")
    assert value == pytest.approx(settled.residual_rotation, rel=1e-6)
    assert abs(value) > 1e-4


def test_the_static_bearing_pressure_stands_beside_that_of_a_spring(tmp_path):
    bed = rf.winkler_bed(1.8, 4.0, 60e6, n=8).damped(0.3, 500e3)
    (run,) = runs(PIER, PULSE, ["2DOF-S"], ground=rf.Ground(springs=bed, base_inertia=5e5))
    (row,) = read(rf.write_report(run, tmp_path / "r.html", structure=PIER)).tables["checks"][1:]
    text, value = next((text, value) for text, name, value in row if name == "bearing_pressure")
    assert value == run.bearing_pressure.max()
    assert rounded(run.soil_pressure.max() / 1e3) in text


def test_the_page_says_what_forces_with_an_impact_law_leave_out(page, tmp_path):
    """On springs, and on a fixed base, no law acts and nothing is said."""
    assert "without the impulse of impacts" in page.read_text("utf-8")
    for frame, model, options in ((PIER, "2DOF-S", {"ground": SPRINGS}), (FRAME, "fixed", {})):
        path = rf.write_report(runs(frame, PULSE, (model,), **options), tmp_path / f"{model}.html", structure=frame)
        assert "impulse of impacts" not in path.read_text("utf-8")
