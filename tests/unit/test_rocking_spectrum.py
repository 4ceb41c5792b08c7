"""Rocking and overturning spectra against single runs and closed forms; damaged arguments by their messages."""

import math

import numpy as np
import pytest

import rockflex as rf

G = 9.81
RECORD = rf.load_suite("el-centro-1940")[0]
BLOCK = rf.rigid_block(0.2, 1.5)


def full_sine(amplitude, period):
    return rf.one_sine_pulse(amplitude, period, dt=period / 400)


@pytest.mark.filterwarnings("ignore:rigid is for small rotations")
@pytest.mark.parametrize("model", ["rigid", "rigid-C"])
@pytest.mark.parametrize("impact", [None, rf.Restitution(0.8)])
def test_each_row_is_a_run_of_a_block(model, impact):
    alphas, periods = (0.15, 0.25), (1.0, 3.0)
    table = rf.rocking_spectrum(RECORD, alphas, periods, model, impact, free_vibration=2.0, workers=2)
    assert table["slenderness"].tolist() == [0.15, 0.15, 0.25, 0.25]
    assert table["period"].tolist() == [1.0, 3.0, 1.0, 3.0]
    for row in table.itertuples():
        p = 2 * math.pi / row.period
        block = rf.rigid_block(row.slenderness, row.half_diagonal)
        run = rf.simulate(block, RECORD, model, "peaks", free_vibration=2.0, impact=impact)
        assert row.max_rotation == run.max_rotation
        assert row.relative_rotation == run.max_rotation / row.slenderness
        assert (row.status, row.n_impacts) == (run.status, run.n_impacts)
        assert row.overturned == (run.status == "overturned")
        assert row.half_diagonal == pytest.approx(0.75 * G / p**2)
    assert table["overturned"].any()
    assert not table["overturned"].all()
    assert table["error"].isna().all()


def test_threads_change_nothing():
    one, two = (rf.rocking_spectrum(RECORD, (0.2, 0.3), (1.0, 2.0, 4.0), workers=w) for w in (1, 2))
    assert one.equals(two)
    one, two = (rf.overturning_spectrum(BLOCK, full_sine, (2, 4), tolerance=1e-3, workers=w) for w in (1, 2))
    assert one.equals(two)


def test_slender_blocks_alike_in_p_rock_alike_in_proportion():
    """Linearised, θ/tan α depends on p, on a/(g tan α) and on the impact alone."""
    restitution = rf.Restitution(0.9)
    runs = []
    for alpha in (0.1, 0.2):
        radius = 0.75 * G / 2.0**2 * math.cos(alpha)  # so that p² = L g/I is the same
        motion = RECORD.scaled(math.tan(alpha))
        period = 2 * math.pi * math.sqrt(radius / (0.75 * G))
        scale = rf.rocking_spectrum(motion, [alpha], [period], "rigid", restitution)
        runs.append(float(scale["max_rotation"][0]) / math.tan(alpha))
    assert runs[0] == pytest.approx(runs[1], rel=1e-9)


def test_the_boundary_of_a_record_parts_what_stands_from_what_falls():
    block = rf.rigid_block(0.3, 0.5)
    found = rf.overturning_scales(block, RECORD, np.arange(0.8, 4.0, 0.02), tolerance=1e-9)

    def falls(scale):
        run = rf.simulate(block, RECORD.scaled(scale), "rigid-C", "peaks", free_vibration="settle")
        return run.status == "overturned", run.n_impacts

    assert falls(found.lowest) == (True, found.impacts)
    assert not falls(found.lowest * (1 - 2e-9))[0]
    assert found.highest_standing >= found.lowest * (1 - 2e-9)
    assert not falls(found.highest_standing)[0] or found.highest_standing == found.lowest


def test_overturning_is_not_monotone_under_one_sine():
    """With an impact it falls at a lower amplitude than without one; between the two it stands."""
    row = rf.overturning_spectrum(BLOCK, full_sine, [5.0], tolerance=1e-4).iloc[0]
    assert row["lowest"] < 3.0 < 7.0 < row["highest_standing"]
    assert row["impacts"] == 1
    unit = BLOCK.resisting_moment / BLOCK.l0r

    def status(amplitude):
        motion = full_sine(amplitude * unit, row["period"])
        return rf.simulate(BLOCK, motion, "rigid-C", "peaks", free_vibration="settle").status

    assert status(row["highest_standing"]) == "rocking"
    assert status(row["highest_standing"] * (1 + 2e-4)) == "overturned"
    assert status(row["lowest"]) == "overturned"
    assert status(row["lowest"] * (1 - 2e-4)) == "rocking"
    rows = rf.overturning_spectrum(BLOCK, full_sine, [5.0], relative_amplitudes=(1.0, 3.0, 7.0)).iloc[0]
    assert math.isinf(rows["highest_standing"])
    assert row["amplitude"] == pytest.approx(row["lowest"] * unit, rel=1e-12)
    rate = math.sqrt(0.75 * G * math.cos(0.2) / 1.5)
    assert row["period"] == pytest.approx(2 * math.pi / (5.0 * rate), rel=1e-12)


def test_a_model_for_small_rotations_that_decides_a_fall_says_so():
    """The boundaries of the linearised block differ by some per cent from those of the block itself."""
    pulse, scales = full_sine(G * 0.3, 1.0), (1.0, 2.0, 4.0, 8.0)
    block = rf.rigid_block(0.4, 1.5)
    whole = rf.overturning_scales(block, pulse, scales, tolerance=1e-3).lowest
    with pytest.warns(UserWarning, match="such as rigid-C"):
        small = rf.overturning_scales(block, pulse, scales, "rigid", tolerance=1e-3).lowest
    assert 5e-3 < abs(small / whole - 1.0) < 0.2
    with pytest.warns(UserWarning, match="such as rigid-C"):
        rf.overturning_spectrum(BLOCK, full_sine, [3.0], "rigid", None, (1.0, 4.0), 1e-2)
    with pytest.warns(UserWarning, match="such as rigid-C"):
        rf.rocking_spectrum(pulse.scaled(3.0), [0.2], [2.0], "rigid")
    rf.overturning_scales(block, pulse, (0.1, 0.2), "rigid")  # which decides nothing


def test_what_never_falls_is_missing():
    found = rf.overturning_scales(BLOCK, full_sine(G * 0.2, 0.5), (0.1, 0.5, 0.9))
    assert math.isnan(found.lowest)
    assert math.isnan(found.highest_standing)
    assert found.impacts == 0
    table = rf.overturning_spectrum(BLOCK, full_sine, [50.0], relative_amplitudes=(1.0, 2.0))
    assert table["lowest"].isna().all()


def test_where_all_fall_the_boundary_lies_below_the_scan():
    pulse = full_sine(G * 0.2, 3.0)
    low = rf.overturning_scales(BLOCK, pulse, (4.0, 5.0), tolerance=1e-6)
    fine = rf.overturning_scales(BLOCK, pulse, np.arange(1.0, 5.0, 0.05), tolerance=1e-6)
    assert low.lowest == pytest.approx(fine.lowest, rel=3e-6)
    assert low.highest_standing == low.lowest


def test_a_flexible_structure_overturns_too():
    p = rf.equivalent_s1(0.3, 0.02, 0.2, 1.0)
    row = rf.overturning_spectrum(p, full_sine, [3.0], "2DOF-C", None, (1.0, 2.0, 4.0, 8.0), 1e-2).iloc[0]
    assert 1.0 < row["lowest"] < 8.0


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: rf.rocking_spectrum(RECORD, [], [1.0]), "slendernesses must be one or more positive numbers in rad"),
        (lambda: rf.rocking_spectrum(RECORD, [0.1], [1.0, -1.0]), "periods must be one or more positive numbers"),
        (lambda: rf.rocking_spectrum(RECORD, [0.1], [1.0], "2DOF-S"), "Blocks have no modes, but the model 2DOF-S"),
        (lambda: rf.rocking_spectrum(RECORD, [0.1, 1.2], [1.0]), "Housner's coefficient 1 - 2 m_tot B²/I_θ"),
        (lambda: rf.overturning_scales(BLOCK, RECORD, (2.0, 1.0)), "scales must rise, two at least, but (2.0, 1.0)"),
        (lambda: rf.overturning_scales(BLOCK, RECORD, (0.0, 1.0)), "scales must be one or more positive numbers"),
        (lambda: rf.overturning_scales(BLOCK, RECORD, (1.0, 2.0), tolerance=0.5), "tolerance must lie in [1e-12"),
        (lambda: rf.overturning_scales(BLOCK, 3.0, (1.0, 2.0)), "motion must be a GroundMotion, but float was given."),
        (
            lambda: rf.overturning_scales(rf.equivalent_s1(0.3, 0.02, 0.2, 1.0), RECORD, (1.0, 2.0), "fixed"),
            "fixed has a base that cannot lift, so nothing overturns it. Give a model that rocks.",
        ),
        (lambda: rf.overturning_spectrum(BLOCK, lambda a, t: a * t, [2.0]), "pulse must make a GroundMotion"),
        (lambda: rf.overturning_spectrum(BLOCK, full_sine, [0.0]), "frequency_ratios must be one or more positive"),
    ],
)
def test_what_makes_no_spectrum_is_named(call, message):
    with pytest.raises(rf.InputError) as caught:
        call()
    assert str(caught.value).startswith(message)
