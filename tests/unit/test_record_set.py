"""A set of records as one result: statistics, rules of codes, the period that rocking reaches, figure and report."""

import math
from dataclasses import replace

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from report_page import read
from rockflex.response._outputs import OUTPUTS

FRAME = make_frame(n_stories=2, period=0.5, aspect_ratio=8.0)
BLOCK = rf.rigid_block(slenderness=0.2, half_diagonal=3.0)


def pulses(n: int, amplitude: float = 3.0) -> list[rf.GroundMotion]:
    return [replace(rf.one_sine_pulse(amplitude, 0.5 + 0.05 * k), name=f"pulse {k}") for k in range(n)]


def with_falls(n: int, falls: int) -> list[rf.GroundMotion]:
    """Pulses of which the last few overturn the block."""
    strong = [replace(rf.one_sine_pulse(12.0, 3.0), name=f"fall {k}") for k in range(falls)]
    return [*pulses(n - falls), *strong]


@pytest.mark.parametrize(
    ("rule", "n", "of"),
    [("ec8", 3, np.max), ("ec8", 6, np.max), ("ec8", 7, np.mean), ("asce7", 11, np.mean), ("asce7-ii", 11, np.mean),
     (None, 1, np.max), (None, 11, np.max)],
)  # fmt: skip
def test_the_rule_makes_the_value_for_design(rule, n, of):
    found = rf.simulate_set(FRAME, pulses(n), "2DOF-S", rule=rule)
    single = [rf.simulate(FRAME, motion, "2DOF-S") for motion in pulses(n)]
    for name in ("max_rotation", "max_base_moment", "max_total_top_displacement"):
        values = np.array([getattr(run, name) for run in single])
        assert found.peaks[name].tolist() == values.tolist()
        assert found.statistics.loc[name, "design"] == pytest.approx(of(values), rel=1e-14)
        assert found.statistics.loc[name, "worst"] == values.max()
        assert found.statistics.loc[name, "median"] == pytest.approx(np.quantile(values, 0.5), rel=1e-14)
        assert found.statistics.loc[name, "fractile_84"] == pytest.approx(np.quantile(values, 0.84), rel=1e-14)
    reason = found.statistics.loc["max_rotation", "reason"]
    assert ("mean" in reason) == (of is np.mean)
    assert ("EN 1998-1" in reason, "ASCE 7" in reason) == (rule == "ec8", str(rule).startswith("asce7"))


def test_the_worst_vertical_reaction_is_the_least():
    found = rf.simulate_set(FRAME, pulses(5), "2DOF-S", rule="ec8")
    values = found.peaks["min_vertical_reaction"]
    row = found.statistics.loc["min_vertical_reaction"]
    assert row["worst"] == row["design"] == values.min()
    assert row["fractile_84"] == pytest.approx(np.quantile(values, 0.16), rel=1e-14)
    assert OUTPUTS["min_vertical_reaction"].worst_is_least


@pytest.mark.parametrize(("rule", "n"), [("ec8", 2), ("asce7", 10), ("asce7-ii", 10)])
def test_a_rule_needs_its_records(rule, n):
    with pytest.raises(rf.InputError, match=f"at least .* records, but {n} were given") as caught:
        rf.simulate_set(FRAME, pulses(n), rule=rule)
    assert caught.value.field == "rule"


@pytest.mark.parametrize(
    ("options", "field"),
    [
        ({"rule": "ec9"}, "rule"),
        ({"rule": 8}, "rule"),
        ({"periods": (2.0, 1.0)}, "periods"),
        ({"periods": 1.0}, "periods"),
        ({"periods": (0.1, 1.0, 2.0)}, "periods"),
    ],
)
def test_wrong_arguments_are_refused(options, field):
    with pytest.raises(rf.InputError) as caught:
        rf.simulate_set(FRAME, pulses(3), **options)
    assert caught.value.field == field


@pytest.mark.parametrize("rule", ["ec8", "asce7", None])
def test_with_a_record_that_overturns_no_mean_is_defined(rule):
    found = rf.simulate_set(BLOCK, with_falls(11, 1), "rigid-C", rule=rule)
    assert found.n_overturned == 1
    row = found.statistics.loc["max_rotation"]
    assert math.isnan(row["mean"])
    assert math.isnan(row["design"])
    assert row["worst"] == math.inf
    assert row["median"] == np.sort(found.peaks["max_rotation"])[5]
    assert "not defined" in row["reason"]
    assert "fall 0" in found.warnings[0]


def test_one_of_eleven_may_overturn_by_the_exception_of_asce7():
    one, two = (rf.simulate_set(BLOCK, with_falls(11, k), "rigid-C", rule="asce7-ii") for k in (1, 2))
    values = np.sort(one.peaks["max_rotation"])
    assert one.statistics.loc["max_rotation", "design"] == max(1.2 * values[5], values[:-1].mean())
    assert math.isnan(two.statistics.loc["max_rotation", "design"])


def test_fractiles_beyond_the_ranks_of_those_that_stand_are_infinite():
    found = rf.simulate_set(BLOCK, with_falls(7, 2), "rigid-C", rule="ec8")
    assert found.statistics.loc["max_rotation", "fractile_84"] == math.inf  # between the ranks 6 and 7 of 7
    assert math.isfinite(found.statistics.loc["max_rotation", "median"])


def test_a_selection_gives_its_scaled_records_and_its_periods():
    chosen = rf.load_suite("fema-p695-far-field").select(rf.ec8_spectrum(2.5, "C"), 3, (0.2, 0.6))
    found = rf.simulate_set(FRAME, chosen, "2DOF-S")
    assert found.motions == tuple(chosen.suite)
    assert found.periods == (0.2, pytest.approx(0.6, rel=1e-12))
    assert rf.simulate_set(FRAME, chosen, "2DOF-S", periods=(0.1, 9.0)).periods == (0.1, 9.0)
    assert any("0.6 s" in text for text in found.warnings)


def test_the_period_of_rocking_of_a_block_in_closed_form():
    """M = M_r (1 - θ/α), so T = 2π √(I_θ θ / (M_r (1 - θ/α)))."""
    found = rf.simulate_set(BLOCK, pulses(3, 4.0), "rigid")
    turn, pivot = found.peaks["max_rotation"].max(), BLOCK.pivot(1)
    assert turn > 0.01
    moment = pivot.resisting_moment * (1.0 - turn / pivot.balance_rotation)
    assert found.rocking_period == pytest.approx(2.0 * math.pi * math.sqrt(BLOCK.i_theta * turn / moment), rel=1e-12)


def test_the_period_without_uplift_is_the_first_one():
    assert rf.simulate_set(FRAME, pulses(2, 0.1)).rocking_period == pytest.approx(0.5, rel=1e-12)


@pytest.mark.parametrize(("longest", "told"), [(0.999, True), (1.001, False)])
def test_a_choice_that_ends_below_the_period_of_rocking_is_told(longest, told):
    reached = rf.simulate_set(FRAME, pulses(3), "2DOF-S").rocking_period
    found = rf.simulate_set(FRAME, pulses(3), "2DOF-S", periods=(0.1, longest * reached))
    assert any("periods up to" in text for text in found.warnings) == told


def test_springs_lengthen_the_period_of_rocking():
    bed = rf.Ground(springs=rf.winkler_bed(FRAME.half_width, 3.0, 2e7), base_inertia=1e5)
    found = rf.simulate_set(FRAME, pulses(3), "2DOF-S", ground=bed)
    rigid = replace(found, responses=tuple(
        replace(run, history=rf.simulate(FRAME, pulses(1)[0], "2DOF-S").history) for run in found.responses
    ))  # fmt: skip
    assert found.rocking_period > rigid.rocking_period > 0.5


def test_components_of_one_recording_are_told():
    suite = rf.load_suite("fema-p695-far-field")
    found = rf.simulate_set(FRAME, [suite["FF-1-a"], suite["FF-1-b"], suite["FF-2-a"]], "2DOF-S")
    assert any("2 of 3 records are both components" in text for text in found.warnings)


def test_a_record_that_cannot_be_solved_is_no_smaller_set():
    long = rf.GroundMotion(np.tile(pulses(1)[0].acceleration, 300), 0.005, "long")
    with pytest.raises(rf.SolverError, match="1 of 3 records"):
        rf.simulate_set(FRAME, [*pulses(2), long], "2DOF-C", work_limit=2e-2)


def test_the_figure_has_every_record_and_statistic():
    found = rf.simulate_set(FRAME, pulses(7), "2DOF-S", rule="ec8")
    figure = rf.plot_set(found, ["max_rotation"])
    (axes,) = figure.axes
    lines = {line.get_label(): line for line in axes.get_lines()}
    assert lines["record"].get_xdata() == pytest.approx(1e3 * found.peaks["max_rotation"].to_numpy())
    assert lines["mean"].get_xdata()[0] == pytest.approx(1e3 * found.peaks["max_rotation"].mean())
    assert {"median", "84 % fractile", "for design"} <= lines.keys()
    with pytest.raises(rf.InputError, match="max_slip"):
        rf.plot_set(found, ["max_slip"])


def test_the_report_of_a_set(tmp_path):
    found = rf.simulate_set(BLOCK, with_falls(7, 1), "rigid-C", rule="ec8")
    page = read(rf.write_report(found, tmp_path / "set.html", limits=rf.CheckLimits(rotation_ratio=0.5)))
    assert [row[0][0] for row in page.tables["records"][1:]] == [motion.name for motion in found.motions]
    assert "overturned" in page.tables["records"][7][1][0]
    assert "not defined" in page.text
    assert [row[0][0] for row in page.tables["limits"][1:]] == ["rotation", "rotation over α"]
    with pytest.raises(rf.InputError) as caught:
        rf.write_report(found, tmp_path / "again.html", friction=0.5)
    assert caught.value.field == "friction"


def test_the_report_of_a_set_draws_the_target_of_its_records(tmp_path):
    suite = rf.load_suite("fema-p695-far-field")
    chosen = suite.select(rf.ec8_spectrum(2.5, "C"), 3, (0.2, 1.0))
    found = rf.simulate_set(FRAME, chosen, "2DOF-S", rule="ec8")
    text = rf.write_report(found, tmp_path / "set.html", selection=chosen).read_text("utf-8")
    without = rf.write_report(found, tmp_path / "bare.html").read_text("utf-8")
    assert (text.count("<svg"), without.count("<svg")) == (2, 1)
    period = 2.0 * np.pi / FRAME.rocking().omega[0]
    axes = rf.plot_selection(chosen, period=period).axes
    assert all(any(np.allclose(line.get_xdata(), period) for line in each.get_lines()) for each in axes)
    for given, field in ((found, chosen.target), (found.responses[0], chosen)):
        with pytest.raises(rf.InputError) as caught:
            rf.write_report(given, tmp_path / "wrong.html", selection=field)
        assert caught.value.field == "selection"


def test_a_changed_table_changes_nothing_else():
    found = rf.simulate_set(FRAME, pulses(3), "2DOF-S")
    largest = found.statistics.loc["max_rotation", "worst"]
    peaks, statistics = found.peaks, found.statistics
    peaks["max_rotation"] *= 1000.0
    statistics["worst"] *= 1000.0
    assert found.peaks["max_rotation"].max() == found.statistics.loc["max_rotation", "worst"] == largest
