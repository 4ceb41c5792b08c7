"""Stripes with records of their own: which runs they are, files that have them, and the capacities that they tell."""

import math
import pickle

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.stats import binom, norm

import rockflex as rf
from rockflex.studies import load_study
from rockflex.studies._run_plan import run_plan

FRAME = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0, damping_ratio=0.02)
SUITE = rf.load_suite("fema-p695-far-field")[:12]
TARGET = rf.conditional_spectrum([0.1, 0.5, 2.0], [6.0, 5.0, 1.2], [0.6, 0.65, 0.7], 0.5, epsilon=0.7)


def study(**changes):
    given = {"structures": {"a": FRAME, "b": FRAME}, "records": SUITE, "models": ["2DOF-S", "fixed"]} | changes
    return rf.StripeStudy(**given)


def test_every_stripe_has_its_records_and_their_factors():
    chosen = SUITE.select(TARGET, 4, (0.2, 1.5), scale_limits=(0.1, 10.0))
    own = study(stripes={0.3: chosen, 0.5: list(SUITE[:3]), 0.9: {"FF-2-b": -1.5}})
    plan = own.plan()
    runs = run_plan(plan)
    assert plan.n_runs == len(runs) == 2 * 2 * (4 + 3 + 1)
    assert runs.groupby("level")["motion"].nunique().to_dict() == {0.3: 4, 0.5: 3, 0.9: 1}
    first = runs[(runs["structure"] == "a") & (runs["model"] == "2DOF-S")]
    assert first["motion"].tolist() == [*chosen.suite.names, *SUITE[:3].names, "FF-2-b"]
    np.testing.assert_array_equal(first["scale"][:4], chosen.factors)
    assert first["pgv"][first["level"] == 0.5].tolist() == pytest.approx([0.5] * 3)
    assert first["scale"].iloc[-1] == -1.5
    for row in runs.itertuples():
        alone = rf.simulate(FRAME, SUITE[row.motion].scaled(row.scale), row.model, "peaks")
        assert row.max_top_displacement == alone.max_top_displacement
    assert run_plan(pickle.loads(pickle.dumps(plan)), workers=1).equals(runs)
    counts = rf.stripe_counts(runs, "uplift")
    assert counts[counts["structure"] == "a"]["n_total"].tolist() == [4, 3, 1] * 2


def test_stripes_of_all_records_are_those_of_levels():
    levels = run_plan(study(levels=[0.2, 0.6]).plan())
    own = run_plan(study(stripes=dict.fromkeys((0.2, 0.6), SUITE.names)).plan())
    keys = ["structure", "motion", "model", "level"]
    same = own.sort_values(keys, ignore_index=True)[levels.columns]
    assert same.equals(levels.sort_values(keys, ignore_index=True))


def test_stripes_are_written_read_and_resumed(tmp_path):
    given = study(
        records={"suites": ["fema-p695-far-field"]},
        structures={"a": FRAME},
        models=["2DOF-S"],
        stripes={0.3: {"FF-1-a": 1.5, "FF-2-b": 0.7}, 0.6: ["FF-3-a"]},
        runs_per_chunk=2,
    )
    text = given.write(tmp_path / "stripes.toml").read_text("utf-8")
    assert "[[stripes]]" in text
    again = load_study(tmp_path / "stripes.toml")
    runs = rf.run_study(again, tmp_path / "out")
    assert runs["scale"].tolist()[:2] == [1.5, 0.7]
    assert rf.run_study(given).equals(runs)
    next((tmp_path / "out" / "parts").glob("*1.parquet")).unlink()
    assert rf.run_study(again, tmp_path / "out").equals(runs)


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({}, "needs levels, .* or stripes"),
        ({"levels": [1.0], "stripes": {1.0: ["FF-1-a"]}}, "needs levels, .* or stripes"),
        ({"stripes": {0.5: ["FF-1-c"]}}, r"level 0.5: 'FF-1-c' is not among .* nearest names are 'FF-1-b'"),
        ({"stripes": {0.5: ["FF-1-a", "FF-1-a"]}}, "'FF-1-a' occurs more than once"),
        ({"stripes": {0.5: []}}, "no record is named"),
        ({"stripes": {0.5: {"FF-1-a": math.inf}}}, "scales must be one or more finite factors"),
        ({"stripes": {-0.5: ["FF-1-a"]}}, "levels must be one or more positive numbers"),
        ({"stripes": {0.5: 3.0}}, "a list of names among the records"),
        ({"stripes": [{"level": 1.0, "records": ["FF-1-a"]}] * 2}, "the levels of stripes: '1' occurs more than once"),
    ],
)
def test_stripes_that_are_wrong_are_refused(change, text):
    with pytest.raises(rf.InputError, match=text):
        study(**change).plan()


def test_stripes_of_unequal_numbers_recover_a_capacity_in_closed_form():
    """A pulse of the period T scaled to the velocity v has the acceleration π v/T: it lifts a block if g tan α is less.

    With lognormal periods the capacity in v is lognormal, too: its median is g tan α T_m/π.
    """
    block, middle, beta = rf.rigid_block(0.2, 2.0), 0.6, 0.45
    median, counts = block.rocking().uplift_acceleration * middle / math.pi, (15, 60, 40, 25)
    levels = median * np.exp(beta * np.array([-1.0, -0.2, 0.5, 1.3]))
    pulses, stripes = [], {}
    for level, n in zip(levels, counts, strict=True):
        scores = norm.ppf((np.arange(n) + 0.5) / n)  # a set of its own, of its own size
        names = [f"{n} pulses, no. {k}" for k in range(n)]
        for period, name in zip(middle * np.exp(beta * scores), names, strict=True):
            pulse = rf.one_sine_pulse(amplitude=1.0, period=float(period))
            pulses.append(rf.GroundMotion(pulse.acceleration, pulse.dt, name))
        stripes[float(level)] = names
    runs = rf.run_study(rf.StripeStudy(structures=block, records=pulses, models=["rigid"], stripes=stripes))
    found = rf.stripe_counts(runs, "uplift")
    assert found["n_total"].tolist() == list(counts)
    expected = norm.cdf(np.log(levels / median) / beta) * counts
    assert np.abs(found["n_exceeding"] - expected).max() <= 0.6  # the next whole number
    fit = rf.fit_stripes(found["level"], found["n_exceeding"], found["n_total"])
    assert fit.median == pytest.approx(median, rel=0.04)
    assert fit.beta == pytest.approx(beta, rel=0.12)  # half a pulse of 15 in the flattest tail
    best = minimize(
        lambda p: -binom.logpmf(found["n_exceeding"], counts, norm.cdf((np.log(levels) - p[0]) / p[1])).sum(),
        [math.log(median), beta],
        method="Nelder-Mead",
        options={"xatol": 1e-9, "fatol": 1e-12},
    ).x
    assert (math.log(fit.median), fit.beta) == pytest.approx(best, rel=1e-5)


def test_many_sets_of_unequal_stripes_scatter_as_the_fit_says():
    rng, levels, totals = np.random.default_rng(7), np.array([0.25, 0.4, 0.6, 1.0]), np.array([12, 45, 30, 20])
    p = norm.cdf(np.log(levels / 0.5) / 0.4)
    fits = [rf.fit_stripes(levels, rng.binomial(totals, p), totals) for _ in range(300)]
    away = np.array([[math.log(fit.median / 0.5), fit.beta - 0.4] for fit in fits])
    said = np.mean([fit.covariance for fit in fits], axis=0)
    np.testing.assert_allclose(away.std(axis=0), np.sqrt(np.diag(said)), rtol=0.15)
    assert (np.abs(away.mean(axis=0)) < 3.5 * away.std(axis=0) / math.sqrt(300) + [0.0, 0.02]).all()
