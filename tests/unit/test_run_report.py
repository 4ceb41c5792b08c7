"""The report of a run: its numbers are those of the responses, and the page needs nothing else."""

import dataclasses
import datetime as dt
import math
import re

import numpy as np
import pytest

import rockflex as rf
import rockflex.foundation.files
from report_case import FRAME, HELD, PIER, PULSE, SPRINGS, runs
from report_page import number, read
from rockflex.foundation.number_format import rounded_number
from rockflex.foundation.units import KN
from rockflex.report.run import _report_page, _run_checks
from rockflex.response._response import warnings_of_run

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
PERIOD = 0.6
JUMPS = {
    "cosine": rf.one_cosine_pulse(4.0, PERIOD),
    "rectangular": rf.rectangular_pulse(4.0, PERIOD),
    "cut off": rf.GroundMotion(PULSE.acceleration[: PULSE.acceleration.size // 2 + 3], PULSE.dt, name="cut"),
}
pytestmark = pytest.mark.usefixtures("undrawn")
BLOCK = rf.rigid_block(0.2, 3.0, 20e3)
SOFT = rf.Ground(0.4, rf.Springs([-0.8, 0.8], stiffness=2e8, damping=3e5), base_inertia=4e4)
LIGHT = rf.Ground(springs=rf.Springs([-0.4, 0.0, 0.5], stiffness=2e8, damping=3e5), base_inertia=4e4)


@pytest.fixture(scope="module")
def three():
    return runs(FRAME, PULSE, MODELS, free_vibration=3.0)


@pytest.fixture
def report(tmp_path):
    """What a report of some runs says."""
    return lambda found, **options: read(rf.write_report(found, tmp_path / "r.html", **options))


def cells(row):
    """Text and value of the cells of a row, by the names of the values."""
    return {name: (text, value) for text, name, value in row}


@pytest.fixture(scope="module")
def page(three, tmp_path_factory):
    path = tmp_path_factory.mktemp("report") / "run.html"
    assert rf.write_report(three, path, structure=FRAME, motion=PULSE, friction=0.5, date="2030-01-02") == path
    return path


@pytest.mark.slow
def test_the_peaks_are_those_of_the_responses(page, three):
    _, *rows = read(page).tables["peaks"]
    assert [row[0][0] for row in rows] == list(MODELS)
    for row, response in zip(rows, three, strict=True):
        found = cells(row)
        for name, size in SIZES.items():
            text, value = found[name]
            assert value == getattr(response, name)
            assert number(text) == pytest.approx(value / size, rel=5.1e-3)
        assert int(found["n_uplifts"][0]) == response.n_uplifts
        text, value = found["max_floor_acceleration"]
        assert value == response.floors.floor_acceleration.max()
        assert number(text) == pytest.approx(value, rel=6e-3)


def test_the_checks_follow_from_the_responses(page, three):
    head, *rows = read(page).tables["checks"]
    assert [cell[0] for cell in head] == ["model", "uplift", "overturning", "contact", "friction", "energy balance"]
    limit = FRAME.rocking().nominal_overturning_rotation
    for row, response in zip(rows, three, strict=True):
        found = cells(row)
        text, needed = found["required_friction"]
        assert needed == response.required_friction_excluding_impacts()
        assert ("> 0.5" in text) == (needed > 0.5)
        assert found["closing_error"][1] == response.energy.closing_error
        if response.model != "fixed":
            assert found["overturning_margin"][1] == pytest.approx(limit / response.max_rotation)
            assert found["first_uplift"][1] == response.uplift_times[0]


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
    assert re.search(r"inputs [0-9a-f]{12}<", text)


@pytest.mark.slow
def test_the_scale_is_found(report):
    found = runs(FRAME, PULSE.scaled(1.3), ["2DOF-S"])
    for motion in (PULSE, PULSE.scaled(1.3)):
        facts = report(found, motion=motion).facts
        assert facts["scale"][2] == pytest.approx(1.3)
        assert facts["pga"][2] == pytest.approx(1.3 * PULSE.pga)


def test_without_motion_and_structure_the_history_tells(three, report):
    facts = report(three[0], date=dt.date(2030, 1, 2)).facts
    assert facts["pga"][2] == pytest.approx(PULSE.pga, rel=1e-6)
    assert facts["pgv"][2] == pytest.approx(PULSE.pgv, rel=1e-6)
    assert facts["n_modes"][2] == 1


@pytest.mark.slow
def test_a_page_of_elements_springs_and_slip(report):
    found = runs(HELD, PULSE.scaled(2.0), ["2DOF-S"], ground=SPRINGS)
    reader = report(found, structure=HELD, motion=PULSE)
    _, *rows = reader.tables["elements"]
    assert [row[0][0] for row in rows][-1] == "and 1 more"
    for k, row in enumerate(rows[:-1]):
        assert row[3][2] == found[0].max_element_force[k]
        assert row[4][2] == found[0].max_element_elongation[k]
    assert "12 springs without tension" in reader.text
    assert "the base slides at μ = 0.4" in reader.text
    _, row = reader.tables["peaks"]
    assert cells(row)["max_edge_settlement"][1] == found[0].max_edge_settlement


@pytest.mark.slow
def test_what_would_take_minutes_is_left_out(monkeypatch, report):
    found = runs(HELD, PULSE, ["2DOF-S"], ground=rf.Ground(springs=SPRINGS.springs, base_inertia=5e5))
    text = report(found).text
    assert "not computed" not in text
    monkeypatch.setattr(_run_checks, "MAX_WORK", found[0].time.size * SPRINGS.springs.n - 1)
    monkeypatch.setattr(rf.History, "required_friction", property(lambda _: pytest.fail("computed")))
    reader = report(found)
    assert [cell[0] for cell in reader.tables["checks"][1]].count("not computed") == 2
    assert "Not computed: energies and friction of a run that would take too long here." in reader.text


def test_a_run_that_overturns_says_so(report):
    (fell,) = runs(FRAME, rf.one_sine_pulse(8.0, 2.5), ["2DOF-S"], free_vibration=10.0)
    assert fell.status == "overturned"
    reader = report(fell)
    assert "overturned †" in reader.tables["peaks"][1][1][0]
    assert "include its fall" in reader.text
    assert f"overturned at {fell.end_time:.2f} s" in reader.tables["checks"][1][2][0]


def test_warnings_and_notes_are_on_the_page(report):
    tonnes = dataclasses.replace(PIER, tip_mass=60.0)
    found = runs(tonnes, PULSE, ["2DOF-S"])
    text = report(found, structure=tonnes, notes=["Note <1>.", "Note 2."]).text
    assert rf.structure_warnings(tonnes)[0] in text
    assert "Note <1>." in text
    assert "Note 2." in text


@pytest.mark.slow
def test_of_many_warnings_the_first_are_listed(report):
    forces = [1e3 * (801 + k) for k in range(6)]
    held = [rf.Restrained(PIER, rf.Tendon(800e3, 20e6, yield_force=force)) for force in forces]
    pulled = [run for each in held for run in runs(each, PULSE.scaled(2.0), ["2DOF-S"])]
    assert len({text for run in pulled for text in run.warnings}) == 6
    text = report(pulled).text
    assert f"2DOF-S (4): {warnings_of_run(pulled[3], KN)[0]}" in text
    assert f"F/Fy = {rounded_number(pulled[0].tendon_utilisation)} > 1" in text
    assert "and 2 more warnings; see the responses" in text
    alike = report(pulled[:1] * 2).text
    assert f"2DOF-S (1), 2DOF-S (2): {warnings_of_run(pulled[0], KN)[0]}" in alike


@pytest.mark.slow
def test_many_notes_are_run_together(three, report):
    text = report(three, notes=[f"n{k}\n" for k in range(60)]).text
    assert "n0 • n1 • n2" in text
    assert "n58 • n59" in text


@pytest.mark.slow
def test_a_rigid_block(report):
    block = rf.rigid_block(0.2, 3.0, 20e3)
    reader = report(runs(block, PULSE, ["rigid"]), structure=block)
    assert "Rigid block under Ricker" in reader.text
    assert reader.facts["nominal"][2] == pytest.approx(0.7 * 0.2)
    assert reader.facts["alpha"][2] == pytest.approx(math.tan(0.2))
    assert "modes" not in reader.tables


@pytest.mark.slow
def test_names_that_are_markup_and_models_that_occur_twice(report):
    odd = rf.GroundMotion(PULSE.acceleration, PULSE.dt, name="<b>a_b</b> & $x$")
    found = runs(FRAME, odd, ["2DOF-S"]) + runs(FRAME, odd, ["2DOF-S"], impact=rf.Restitution(0.8))
    reader = report(found, title="<i>")
    assert odd.name in reader.text
    assert [row[0][0] for row in reader.tables["peaks"][1:]] == ["2DOF-S (1)", "2DOF-S (2)"]
    assert "Eq. 25) (2DOF-S (1)); Restitution, e = 0.800" in reader.text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (12347.0, "12\u202f300"), (1234.5, "1230"), (0.02, "0.0200"), (20.04, "20.0"), (-3.14159, "−3.14"), (0.0, "0"),
        (999.6, "1000"), (9.9996, "10.0"), (math.nan, "–"), (None, "–"), (math.inf, "∞"), (-math.inf, "−∞"),
        (1.2345e-7, "1.23e−07"),
    ],
)  # fmt: skip
def test_numbers_have_three_digits(value, text):
    assert rounded_number(value) == text


@pytest.mark.slow
def test_re_centring_is_that_of_a_base_at_rest(report):
    """A record that ends in the middle of a vibration says nothing of what remains."""
    fused = rf.Restrained(PIER, [rf.YieldingDissipator(60e6, 150e3, 0.02, x) for x in (-1.5, 1.5)])
    p, strong = fused.rocking(), PULSE.scaled(3.0)
    (run,) = runs(fused, strong, ["2DOF-S"])
    assert abs(run.residual_rotation) > 1e-4
    text, value = cells(report(run, structure=fused).tables["checks"][1])["settled_rotation"]
    assert value == 0.0
    assert text.startswith("closes")
    ratios = [rounded_number(p.recentring_ratio), rounded_number(p.recentring_ratio_at(run.max_rotation))]
    assert all(each in text for each in ratios)
    assert ratios[0] != ratios[1]
    # A stronger fuse holds it open.
    kept = rf.Restrained(PIER, rf.FrictionDamper(9e6))
    (run,) = runs(kept, strong.scaled(3.0), ["2DOF-S"])
    (settled,) = runs(kept, strong.scaled(3.0), ["2DOF-S"], free_vibration="settle")
    _, value = cells(report(run, structure=kept).tables["checks"][1])["settled_rotation"]
    assert value == pytest.approx(settled.residual_rotation, rel=1e-6)
    assert abs(value) > 1e-4


@pytest.mark.slow
def test_the_static_bearing_pressure_stands_beside_that_of_a_spring(report):
    bed = rf.winkler_bed(1.8, 4.0, 60e6, n=8).damped(0.3, 500e3)
    (run,) = runs(PIER, PULSE, ["2DOF-S"], ground=rf.Ground(springs=bed, base_inertia=5e5))
    text, value = cells(report(run, structure=PIER).tables["checks"][1])["bearing_pressure"]
    assert value == run.bearing_pressure.max()
    assert rounded_number(run.soil_pressure.max() / 1e3) in text


@pytest.mark.slow
def test_the_page_says_what_forces_with_an_impact_law_leave_out(page, tmp_path):
    """On springs, and on a fixed base, no law acts and nothing is said."""
    assert "without the impulse of impacts" in page.read_text("utf-8")
    for frame, model, options in ((PIER, "2DOF-S", {"ground": SPRINGS}), (FRAME, "fixed", {})):
        path = rf.write_report(runs(frame, PULSE, (model,), **options), tmp_path / f"{model}.html", structure=frame)
        assert "impulse of impacts" not in path.read_text("utf-8")


@pytest.fixture(scope="module")
def one():
    return runs(FRAME, PULSE, ["2DOF-S"])


OTHER = rf.Frame(2, 3.0, 40e3, 40e3, 1e9, period=0.6, aspect_ratio=5.0, damping_ratio=0.02)


def refused(field, word, responses, path, **options):
    with pytest.raises(rf.InputError) as error:
        rf.write_report(responses, path, **options)
    assert error.value.field == field
    assert word in str(error.value)
    assert not path.is_file()


def test_responses_that_cannot_be_reported(one, tmp_path):
    path = tmp_path / "r.html"
    peaks = rf.simulate(FRAME, PULSE, "2DOF-S", output="peaks")
    refused("responses", 'output="history"', [peaks], path)
    refused("responses", "no response", [], path)
    refused("responses", "'x'", "x", path)
    refused("responses", "responses[1]", [*one, 3], path)
    refused("responses", "6 runs", one * 7, path)
    scaled = runs(FRAME, PULSE.scaled(2.0), ["2DOF-S"])
    refused("responses", "several scales", one + scaled, path)
    named = runs(FRAME, rf.GroundMotion(PULSE.acceleration, PULSE.dt, name="b"), ["2DOF-S"])
    refused("responses", "2 records", one + named, path)
    refused("responses", "one structure", one + runs(OTHER, PULSE, ["2DOF-S"]), path)
    assert list(tmp_path.iterdir()) == []


def test_a_structure_or_a_motion_of_other_runs(one, tmp_path):
    path = tmp_path / "r.html"
    refused("structure", "half_width", one, path, structure=OTHER)
    refused("structure", "Frame", one, path, structure=3)
    refused("motion", "Ricker", one, path, motion=rf.one_sine_pulse(1.0, 0.5))
    refused("motion", "GroundMotion", one, path, motion="el-centro-1940")


def test_values_out_of_range(one, tmp_path):
    path = tmp_path / "r.html"
    refused("friction", "above zero", one, path, friction=-0.1)
    refused("title", "text", one, path, title=3)
    refused("date", "datetime.date", one, path, date=3)
    refused("notes", "800", one, path, notes="a" * 900)
    refused("notes", "texts", one, path, notes=[3])


@pytest.mark.slow
def test_paths_that_are_no_page(one, tmp_path):
    refused("path", "folder", one, tmp_path)
    refused("path", ".html", one, tmp_path / "r.txt")
    refused("path", ".html", one, tmp_path / "r")
    (tmp_path / "file").write_text("x")
    refused("path", "Cannot write to", one, tmp_path / "file" / "r.html")


@pytest.mark.slow
def test_folders_are_made_and_files_replaced(one, tmp_path):
    path = tmp_path / "a" / "b" / "r.HTML"
    rf.write_report(one, path, date="1")
    first = path.read_bytes()
    rf.write_report(one, path, date="2")
    assert path.read_bytes() != first
    assert [each.name for each in path.parent.iterdir()] == ["r.HTML"]


@pytest.mark.slow
def test_an_earlier_page_survives_an_error(one, tmp_path, monkeypatch):
    path = rf.write_report(one, tmp_path / "r.html")
    before = path.read_bytes()

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(rockflex.foundation.files, "writing_atomically", full)
    with pytest.raises(rf.InputError, match=r"Cannot write to .*: No space left on device"):
        rf.write_report(one, path)
    assert path.read_bytes() == before


@pytest.mark.slow
@pytest.mark.parametrize("free", [0.0, 3.0, "settle"])
@pytest.mark.parametrize("name", JUMPS)
def test_a_record_may_end_with_a_jump(name, free, report):
    motion = JUMPS[name]
    assert motion.acceleration[-1] != 0.0
    found = runs(FRAME, motion.scaled(0.7), ["2DOF-S", "MDOF-S", "fixed"], free_vibration=free)
    facts = report(found, motion=motion).facts
    assert facts["scale"][2] == pytest.approx(0.7)


def test_a_run_that_settles_at_the_jump(report):
    weak = JUMPS["cosine"].scaled(0.01)
    still, long = (rf.simulate(FRAME, weak, "2DOF-S", output="history", free_vibration=how) for how in ("settle", 1.0))
    for pair in ([still, long], [long, still]):
        assert report(pair, motion=weak).facts["scale"][2] == pytest.approx(0.01)


def with_vertical(motion, factor):
    return rf.GroundMotion(motion.acceleration, motion.dt, name="named", vertical=factor * motion.acceleration)


@pytest.mark.slow
def test_the_vertical_component_is_compared(tmp_path):
    path = tmp_path / "r.html"
    plain, *shaken = (rf.simulate(FRAME, with_vertical(PULSE, k), "2DOF-S", output="history") for k in (0.0, 0.4, 0.5))
    for pair in ([plain, shaken[0]], shaken):
        for each in (pair, pair[::-1]):
            with pytest.raises(rf.InputError, match=r"differ in the vertical acceleration of the ground\. Write"):
                rf.write_report(each, path)
    for factor, run, words in (
        (0.0, shaken[0], "run with vertical acceleration, but 'named' is without it"),
        (0.4, plain, "run without vertical acceleration, but 'named' is with it"),
        (0.4, shaken[1], "with it, or with another"),
    ):
        refused("motion", words, run, path, motion=with_vertical(PULSE, factor))
    twice = runs(FRAME, with_vertical(PULSE, 0.4).scaled(2.0), ["2DOF-S", "MDOF-C", "fixed"])
    facts = read(rf.write_report(twice, path, motion=with_vertical(PULSE, 0.4))).facts
    assert facts["pva"][2] == pytest.approx(0.8 * PULSE.pga, rel=1e-3)


@pytest.mark.slow
def test_the_margin_of_an_eccentric_base_is_that_of_the_side_it_moves_to(report):
    whole = FRAME.rocking()
    tipped = rf.Eccentric(FRAME, 0.3 * whole.half_width)
    height = whole.effective_height[0]
    for motion in (PULSE.scaled(1.4), PULSE.scaled(-1.4)):
        (run,) = runs(tipped, motion, ["2DOF-S"], free_vibration=3.0)
        reader = report(run, structure=tipped)
        checks = cells(reader.tables["checks"][1])
        arms = {1: 0.7 * whole.half_width, -1: 1.3 * whole.half_width}
        shares = [np.max(side * run.rotation) / math.atan2(arm, height) for side, arm in arms.items()]
        text, margin = checks["overturning_margin"]
        assert margin == pytest.approx(0.7 / max(shares), rel=1e-3)
        assert ("<" in text) == (margin < 1.0)
        assert cells(reader.tables["peaks"][1])["nominal_share"][1] == pytest.approx(max(shares) / 0.7, rel=1e-3)
        assert reader.facts["nominal_right"][2] == pytest.approx(0.7 * math.atan2(arms[1], height))
        assert reader.facts["alpha_right"][2] == pytest.approx(whole.m_tot * arms[1] / whole.l0r)
        words = reader.text.replace("θmax", "θ_max").replace("θnom", "θ_nom")
        assert "θ_nom over θ_max, to the side that is nearer to it" in words


def test_an_empty_title_is_no_title(report):
    (run,) = runs(FRAME, PULSE, ["2DOF-S"])
    assert "Frame under Ricker" in report(run, structure=FRAME, title="").text


def lines(path):
    """The headed lines of a page."""
    return dict(re.findall(r"<p><b>(.+?)\.</b> (.*?)</p>", re.sub(r"</?su[bp]>", "", path.read_text("utf-8"))))


def response_of(*arguments, **options):
    return rf.simulate(*arguments, output="history", **options)


def test_inputs_of_some_runs_have_their_labels(tmp_path):
    yields = [response_of(FRAME, PULSE, "2DOF-S-BW", bouc_wen=rf.BoucWen(d)) for d in (0.02, 0.08)]
    grounds = [response_of(FRAME, PULSE, "2DOF-S", ground=g) for g in (rf.Ground(friction=0.1), SOFT)]
    found = lines(rf.write_report([*yields, *grounds, response_of(FRAME, PULSE, "2DOF-S")], tmp_path / "r.html"))
    bouc_wen, soft = found["Hysteresis"].split("; ")
    assert bouc_wen.startswith("Bouc–Wen, Dy = 20.0 mm, post-yield ratio 0.01, γ")
    assert bouc_wen.endswith(" (2DOF-S-BW (1))")
    assert "Dy = 80.0 mm" in soft
    assert soft.endswith(" (2DOF-S-BW (2))")
    assert found["Ground"].endswith(" (2DOF-S (2))")
    assert found["Friction"] == ("the base slides at μ = 0.1 (2DOF-S (1)); the base slides at μ = 0.4 (2DOF-S (2))")
    assert found["Impact law"].endswith(("Eq. 25) (2DOF-S (1), 2DOF-S (3))", "Eq. 25)"))


@pytest.mark.slow
def test_inputs_of_all_runs_have_none(tmp_path):
    found = lines(rf.write_report(runs(PIER, PULSE, ["2DOF-S", "MDOF-S"], ground=SPRINGS), tmp_path / "r.html"))
    assert found["Friction"] == "the base slides at μ = 0.4"
    assert found["Ground"].startswith("12 springs without tension, x = −1.80 to 1.80 m, Σk = 1440 MN/m")
    assert found["Ground"].endswith(" in heave), Ib = 500 t m²")
    assert "Initial state" not in found


@pytest.mark.slow
def test_the_start_is_on_the_page(tmp_path):
    quiet, starts = rf.quiet_motion(6.0), (rf.InitialState(0.05), rf.InitialState(rotation_velocity=-0.1), None)
    found = [response_of(FRAME, quiet, "2DOF-S", initial=start) for start in starts]
    path = rf.write_report(found, tmp_path / "r.html")
    assert lines(path)["Initial state"] == "θ = 50.0 mrad (2DOF-S (1)); θ′ = −0.100 rad/s (2DOF-S (2))"
    checks = [row[1] for row in read(path).tables["checks"][1:]]
    for (text, _, value), run in zip(checks[:2], found[:2], strict=True):
        assert run.n_uplifts > 0
        assert value == run.uplift_times[0]
        assert re.fullmatch(rf"starts uplifted; {run.n_uplifts}×, next at [\d.]+ s", text)
    assert checks[2][0] == "none"
    block = response_of(BLOCK, quiet, "rigid", initial=starts[0])
    assert block.n_uplifts == 0  # it passes from one edge to the other
    assert read(rf.write_report(block, path)).tables["checks"][1][1][0] == "starts uplifted"


@pytest.mark.slow
def test_the_start_on_springs_counts_from_rest(tmp_path):
    still = response_of(FRAME, PULSE, "2DOF-S", ground=LIGHT)
    assert abs(still.rotation[0]) > 1e-6  # the springs are not symmetric
    tipped = response_of(FRAME, PULSE, "2DOF-S", ground=LIGHT, initial=rf.InitialState(0.002, [0.003]))
    found = lines(rf.write_report([still, tipped], tmp_path / "r.html"))
    assert found["Initial state"] == "θ = 2.00 mrad, D1 = 3.00 mm (2DOF-S (2))"


@pytest.mark.slow
def test_the_hash_tells_inputs_apart(monkeypatch):
    quick = rf.quiet_motion(0.2)
    shaken = rf.GroundMotion(PULSE.acceleration[:40], PULSE.dt, vertical=PULSE.acceleration[:40])
    plain = rf.GroundMotion(shaken.acceleration, shaken.dt)
    other = rf.Ground(springs=rf.Springs([-0.4, 0.0, 0.6], stiffness=2e8, damping=3e5), base_inertia=4e4)
    cases = [
        *((quick, {"ground": ground}) for ground in (None, rf.Ground(friction=0.1), rf.Ground(friction=0.2))),
        *((quick, {"ground": ground}) for ground in (LIGHT, other, rf.Ground(springs=LIGHT.springs, base_inertia=5e4))),
        *((quick, {"impact": rf.Restitution(e)}) for e in (0.5, 0.6)),
        *((quick, {"initial": rf.InitialState(angle)}) for angle in (0.02, 0.021)),
        (quick, {"free_vibration": 0.3}),
        (plain, {}),
        (shaken, {}),
    ]

    # Figures, which are the same whatever the hash is, take the time.
    monkeypatch.setattr(_report_page, "page_as_html", lambda page, _: page.inputs)

    def hashes(run, motion):
        return [_report_page.run_report_as_html(run, motion=each) for each in (None, motion)]

    found = [hashes(response_of(FRAME, motion, "2DOF-S", **options), motion) for motion, options in cases]
    for column in zip(*found, strict=True):
        assert len(set(column)) == len(cases)
    assert hashes(response_of(FRAME, quick, "2DOF-S", impact=rf.Restitution(0.5)), quick) == found[6]


@pytest.mark.slow
def test_peaks_of_ground_motion_are_those_of_the_run_if_all_overturn(tmp_path):
    late = np.concatenate([rf.one_sine_pulse(8.0, 2.5).acceleration, [0.0, 30.0, 0.0, 0.0]])
    motion = rf.GroundMotion(late, rf.one_sine_pulse(8.0, 2.5).dt)
    fell = response_of(FRAME, motion, "2DOF-S")
    assert fell.status == "overturned"
    path = tmp_path / "r.html"
    for found, record, words in (
        (fell, None, True), (fell, motion, False), ([fell, response_of(FRAME, motion, "fixed")], None, False),
    ):  # fmt: skip
        reader = read(rf.write_report(found, path, motion=record))
        names = re.findall(r"PGA( during the run)?", reader.text)
        assert [bool(each) for each in names] == [words]
        assert (reader.facts["pga"][2] == pytest.approx(30.0)) == (not words)


def test_impact_laws_in_words(tmp_path):
    tipped = rf.Eccentric(FRAME, 0.2)
    run = response_of(tipped, PULSE, "rigid")
    found = lines(rf.write_report(run, tmp_path / "r.html"))
    law = run.history.model.law
    right, left = map(float, re.findall(r"0\.\d{3}", found["Impact law"]))
    assert right != left
    assert right == pytest.approx(law.right.e, abs=1e-3)
    assert left == pytest.approx(law.left.e, abs=1e-3)
