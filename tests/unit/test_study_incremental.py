"""Incremental studies: the ladder on outcomes made up by hand, then against single runs; stripes and their counts."""

import math
import pickle
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

import rockflex as rf
from builders import frame_values
from rockflex.studies._run_plan import run_plan
from rockflex.studies.incremental import (
    IncrementalStudy,
    ScaleLadder,
    incremental_capacities,
    max_bisections_below_scales,
    max_bisections_between_scales,
    rising_scales,
    run_incremental,
)
from rockflex.studies.stripes import StripeStudy, stripe_counts

BLOCK = rf.rigid_block(0.2, 1.5)
PULSE = rf.one_sine_pulse(2.0, 1.0, dt=0.01)
FRAME = frame_values(n_stories=2, period=0.5, aspect_ratio=8.0)
STRUCTURES = [{"name": "one", "frame": FRAME}]
RECORDS = {"suites": ["fema-p695-far-field"], "include": ["FF-1-*", "FF-3-a"]}


GRID = rising_scales(1.0, 8.0, 2.0)


def ladder(outcome, scales=GRID):
    """The outcomes of a ladder by rising scale, and its summary."""
    made = ScaleLadder(outcome, growth=2.0, tolerance=0.01)
    made.search(scales)
    assert list(made.outcomes) == sorted(made.outcomes)
    return made.outcomes, SimpleNamespace(**made.summary())


def test_rising_scales():
    assert rising_scales(1.0, 8.0, 2.0) == [1.0, 2.0, 4.0, 8.0]
    assert rising_scales(1.0, 9.0, 2.0) == [1.0, 2.0, 4.0, 8.0, 9.0]
    assert rising_scales(0.1, 20.0, 1.15)[-1] == 20.0
    assert rising_scales(1.0, 1.5, 2.0) == [1.0, 1.5]


def test_one_boundary():
    outcomes, found = ladder(lambda scale: scale > 3.1, rising_scales(1.0, 16.0, 2.0))
    assert found.first_overturning_scale == pytest.approx(3.1, rel=0.01)
    assert found.last_survival_scale == pytest.approx(3.1, rel=0.01)
    assert found.last_survival_scale <= 3.1 < found.first_overturning_scale
    assert (found.resurrections, found.right_censored) == (0, False)
    assert 5 < len(outcomes) <= 5 + max_bisections_between_scales(2.0, 0.01)


def test_resurrections_are_kept():
    grid = rising_scales(1.0, 32.0, 2.0)
    _, found = ladder(lambda scale: 2.5 < scale < 5.0 or scale > 11.0, grid)
    assert found.first_overturning_scale == pytest.approx(2.5, rel=0.01)
    assert found.last_survival_scale == pytest.approx(11.0, rel=0.01)
    assert found.resurrections == 1
    _, found = ladder(lambda scale: 2.5 < scale < 5.0, grid)
    assert (found.last_survival_scale, found.resurrections, found.right_censored) == (32.0, 1, False)


def test_nothing_or_everything_overturns():
    outcomes, found = ladder(lambda scale: False)
    assert len(outcomes) == 4
    assert found.first_overturning_scale is None
    assert (found.last_survival_scale, found.right_censored, found.resurrections) == (8.0, True, 0)
    outcomes, found = ladder(lambda scale: True)
    assert len(outcomes) == 4 + max_bisections_below_scales(0.01)
    assert found.last_survival_scale is None


@pytest.mark.parametrize("boundary", [0.3, 0.9, 0.01])
def test_all_scales_of_the_grid_overturn(boundary):
    outcomes, found = ladder(lambda scale: scale > boundary)
    assert found.first_overturning_scale == pytest.approx(boundary, rel=0.0101)
    assert len(outcomes) <= 4 + max_bisections_below_scales(0.01)


def test_unsolved_runs_say_nothing():
    outcomes, found = ladder(lambda scale: None if scale == 4.0 else scale > 5.0)
    assert found.first_overturning_scale == pytest.approx(5.0, rel=0.01)
    assert [*outcomes.values()].count(None) == 1
    assert ladder(lambda scale: None)[1].right_censored is None
    outcomes, found = ladder(lambda scale: scale > 5.0 if scale in GRID else None)
    assert (len(outcomes), found.first_overturning_scale) == (5, 8.0)


@pytest.mark.filterwarnings("ignore:rigid is for small rotations")
def test_ladder_of_a_block_is_what_overturning_scales_finds():
    runs = run_incremental(BLOCK, PULSE, "rigid", 0.5, 8.0, 1.05, 1e-4)
    found = rf.overturning_scales(BLOCK, PULSE, rising_scales(0.5, 8.0, 1.05), "rigid", tolerance=1e-4)
    assert runs["first_overturning_scale"].unique() == pytest.approx([found.lowest], rel=2e-4)
    if math.isfinite(found.highest_standing):
        assert runs["last_survival_scale"].unique() == pytest.approx([found.highest_standing], rel=2e-4)
    for row in runs.itertuples():
        run = rf.simulate(BLOCK, PULSE.scaled(row.scale), "rigid", "peaks", free_vibration="settle")
        assert (row.status, row.max_rotation) == (run.status, run.max_rotation)
        assert row.overturned == (run.status == "overturned")
        assert row.pga == pytest.approx(2.0 * row.scale, rel=1e-3)


def study(**changes):
    content = {
        "structures": STRUCTURES,
        "records": RECORDS,
        "models": ["2DOF-S", "rigid"],
        "smallest_scale": 1.0,
        "largest_scale": 12.0,
        "growth": 1.5,
        "tolerance": 0.05,
    }
    return IncrementalStudy(**content | changes)


def test_chunks_and_their_sizes_change_nothing():
    small, large = study(runs_per_chunk=1).plan(), study(runs_per_chunk=10_000).plan()
    assert (small.n_chunks, large.n_chunks) == (6, 1)
    runs = run_plan(small)
    assert len(runs) <= small.n_runs
    assert run_plan(large, workers=1).equals(runs)
    copied = pickle.loads(pickle.dumps(small))
    assert copied.chunk(4).equals(small.chunk(4))
    assert {str(small.chunk(n).schema) for n in range(6)} == {str(large.chunk(0).schema)}
    suite = rf.load_suite("fema-p695-far-field")
    motions = [suite[name] for name in ("FF-1-a", "FF-1-b", "FF-3-a")]
    twin = run_incremental({"one": rf.Frame(**FRAME)}, motions, ["2DOF-S", "rigid"], 1.0, 12.0, 1.5, 0.05)
    assert twin.equals(runs)


def test_nominal_limit():
    runs = run_plan(study(limit="nominal", models=["2DOF-S"]).plan())
    assert (runs["overturned"] == (runs["max_rotation"] > runs["nominal_limit"])).all()
    assert (runs["nominal_overturning"] & (runs["status"] != "overturned")).any()
    whole = run_plan(study(models=["2DOF-S"]).plan())
    firsts = [table.groupby("motion", observed=True)["first_overturning_scale"].first() for table in (runs, whole)]
    assert (firsts[0] <= firsts[1] * 1.05).all()


def test_capacities():
    runs = run_plan(study().plan())
    capacities = incremental_capacities(runs, "pgv")
    assert len(capacities) == 6
    assert capacities["group"].nunique() == 2
    assert not capacities["censored"].any()
    assert (capacities["failed"] == 0).all()
    suite = rf.load_suite("fema-p695-far-field")
    for row in capacities.itertuples():
        assert row.capacity == pytest.approx(suite[row.motion].pgv * row.first_overturning_scale, rel=1e-12)
    low = incremental_capacities(run_plan(study(largest_scale=1.1).plan()), "pga")
    assert low["censored"].all()
    for row in low.itertuples():
        assert row.capacity == pytest.approx(suite[row.motion].pga * 1.1, rel=1e-12)
        assert row.last_survival_scale == 1.1
    failed = incremental_capacities(run_incremental(BLOCK, PULSE, "2DOF-S", 1.0, 2.0, 2.0))
    assert (failed["failed"].tolist(), failed["capacity"].isna().tolist()) == ([2], [True])


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"smallest_scale": 0.0}, "smallest_scale must be a positive, finite number in times the record, but 0.0 was"),
        ({"largest_scale": 0.05}, "largest_scale must be above smallest_scale, 0.1, but 0.05 was given."),
        ({"growth": 1.0}, "growth must lie in [1.0001, 100), but 1.0 was given. It is the factor from one scale to"),
        ({"tolerance": 0.5}, "tolerance must lie in [1e-09, 0.5), but 0.5 was given."),
        ({"limit": "half"}, 'limit must be one of "uplift", '),
        ({"models": "fixed"}, "models: fixed has a base that cannot lift, so nothing overturns it. Leave it out."),
    ],
)
def test_messages(arguments, message):
    with pytest.raises(rf.InputError) as caught:
        run_incremental(rf.Frame(**FRAME), PULSE, **arguments)
    assert str(caught.value).startswith(message)
    if arguments == {"largest_scale": 0.05}:
        with pytest.raises(rf.InputError) as caught:
            study(smallest_scale=0.1, **arguments)
        assert str(caught.value) == message


def test_unknown_measure():
    with pytest.raises(rf.InputError, match=r"measure must be one of pga, pgv, .* but 'pgx' was given\."):
        incremental_capacities(pd.DataFrame(), "pgx")
    with pytest.raises(rf.InputError, match=r"measure must be one of pga, pgv, .* but 'pgx' was given\."):
        stripes(measure="pgx").plan()


def stripes(**changes):
    content = {"structures": STRUCTURES, "records": RECORDS, "models": ["2DOF-S"], "levels": [0.2, 0.8, 2.0]}
    return StripeStudy(**content | changes)


@pytest.mark.parametrize("measure", ["pga", "pgv", "pgd", "arias", "cav", "sa_t1", "sd_t1", "relative_pga"])
def test_stripes_reach_their_levels(measure):
    runs = run_plan(stripes(measure=measure).plan())
    assert runs[measure].to_numpy() == pytest.approx(runs["level"].to_numpy(), rel=1e-12)
    assert len(runs) == 9


def test_stripes_are_single_runs_and_counted():
    plan = stripes(free_vibration="settle", runs_per_chunk=2).plan()
    runs = run_plan(plan)
    assert (plan.n_runs, plan.n_chunks) == (9, 5)
    suite = rf.load_suite("fema-p695-far-field")
    for row in runs.itertuples():
        motion = suite[row.motion]
        assert row.scale == pytest.approx(row.level / motion.pgv)
        run = rf.simulate(rf.Frame(**FRAME), motion.scaled(row.scale), "2DOF-S", "peaks", free_vibration="settle")
        assert (row.status, row.max_rotation) == (run.status, run.max_rotation)
    assert run_plan(pickle.loads(pickle.dumps(plan)), workers=1).equals(runs)
    for limit, exceeds in (
        ("overturning", runs["status"] == "overturned"),
        ("nominal", runs["max_rotation"] > runs["nominal_limit"]),
        ("uplift", runs["n_uplifts"] > 0),
        (1e-3, runs["max_rotation"] > 1e-3),
    ):
        counts = stripe_counts(runs, limit)
        assert counts["level"].tolist() == [0.2, 0.8, 2.0]
        assert counts["n_total"].tolist() == [3, 3, 3]
        expected = [int(exceeds[runs["level"] == level].sum()) for level in (0.2, 0.8, 2.0)]
        assert counts["n_exceeding"].tolist() == expected
    assert stripe_counts(runs, "uplift")["n_exceeding"].iloc[-1] == 3
    damaged = runs.assign(status=runs["status"].where(np.arange(9) > 0))
    assert stripe_counts(damaged)["n_total"].tolist() == [2, 3, 3]


def test_stripe_messages():
    with pytest.raises(rf.InputError, match="levels must be one or more positive numbers, but"):
        stripes(levels=[1.0, -1.0]).plan()
    with pytest.raises(rf.InputError, match=r'limit must be one of "uplift", .*, a LimitState or a rotation'):
        stripe_counts(run_plan(stripes().plan()), "far")
    with pytest.raises(rf.InputError, match="limit must be a positive, finite number in rad"):
        stripe_counts(run_plan(stripes().plan()), -1.0)
    study = rf.StripeStudy(
        structures=rf.Frame(**FRAME), records=rf.quiet_motion(1.0), models="2DOF-S", measure="pgv", levels=[1.0]
    )
    with pytest.raises(rf.InputError, match=r"has no pgv for 'S1', so no scale takes it to a level\."):
        study.plan()


def test_a_ladder_beyond_double_precision():
    with pytest.raises(rf.InputError, match=r"largest_scale must be at most 1e\+12 times smallest_scale, 1e-300, but"):
        rf.run_incremental(rf.rigid_block(0.2, 2.0), rf.ricker_pulse(1.0, 1.0), "rigid", 1e-300, 1e300)
