"""Bands over recordings against the jackknife written out with single fits, and rates in Sa(T1) at 5 % damping."""

import math

import numpy as np
import pandas as pd
import pytest
from scipy import stats
from scipy.special import expit

import rockflex as rf

G, AT = 22, np.array([0.15, 0.4, 1.0])
RNG = np.random.default_rng(12)
GROUPS = np.repeat(np.arange(G), 8)
SHARED = np.repeat(RNG.normal(size=G), 8)
IM = 0.3 * np.exp(np.repeat(RNG.normal(scale=0.5, size=G), 8)) * np.tile([0.5, 1.0, 2.0, 4.0, 0.6, 1.2, 2.4, 4.8], G)
SCORE = (SHARED + RNG.normal(size=IM.size)) / math.sqrt(2.0)
FALLS = stats.norm.cdf(SCORE) < expit(-1.0 + 2.5 * np.log(IM))
STILL = 0.12 * np.exp(0.5 * RNG.normal(size=IM.size)) > IM
ROTATION = np.where(
    FALLS, 1.6, np.where(STILL, 0.0, 0.03 * IM**1.3 * np.exp(0.5 * SHARED + 0.3 * RNG.normal(size=IM.size)))
)
EXCEEDS = np.log(IM / 0.5) / 0.6 > SCORE
CAPACITY = 0.5 * np.exp(0.5 * SCORE[::4])
HAZARD = rf.HazardCurve([0.05, 0.1, 0.2, 0.4, 0.8, 1.6], [6e-2, 2e-2, 5e-3, 9e-4, 1.2e-4, 8e-6])
T = stats.t.ppf(0.95, G - 1)


def logistic(kept, groups=None):
    return rf.fit_logistic(IM[kept], FALLS[kept], groups)


def cloud(kept, groups=None):
    return rf.fit_cloud(IM[kept], 0.03 * IM[kept] * np.exp(SCORE[kept]), groups)


def stripes(kept, groups=None):
    return rf.fit_stripes(np.tile([0.2, 0.4, 0.8, 1.6], G * 2)[kept], EXCEEDS[kept], np.ones(kept.sum()), groups)


def capacities(kept, groups=None):
    return rf.fit_capacities(CAPACITY[kept], None, groups)


def censored(kept, groups=None):
    return rf.fit_capacities(np.minimum(CAPACITY, 0.7)[kept], (CAPACITY > 0.7)[kept], groups)


LINES = {  # the straight line of every fit, in which its band is that of Student's t
    logistic: lambda fit: (fit.b0, fit.b1),
    cloud: lambda fit: (fit.c1, fit.c2),
    stripes: lambda fit: (-math.log(fit.median) / fit.beta, 1.0 / fit.beta),
    capacities: lambda fit: (-math.log(fit.median) / fit.beta, 1.0 / fit.beta),
    censored: lambda fit: (-math.log(fit.median) / fit.beta, 1.0 / fit.beta),
}
SCALES = {logistic: stats.logistic.ppf, cloud: np.log}


@pytest.mark.parametrize("fit", LINES, ids=lambda fit: fit.__name__)
def test_bands_are_the_jackknife_over_recordings(fit):
    groups = GROUPS if fit in (logistic, cloud, stripes) else np.repeat(np.arange(G), 2)
    whole = fit(np.ones(groups.size, dtype=bool), groups)
    left = np.array([LINES[fit](fit(groups != number)) for number in range(G)])
    covariance = np.cov(left.T, ddof=0) * (G - 1)
    grid = np.column_stack((np.ones(AT.size), np.log(AT)))
    half = T * np.sqrt(np.einsum("mi,ij,mj->m", grid, covariance, grid))
    low, high = SCALES.get(fit, stats.norm.ppf)(np.array(whole.band(AT)))
    np.testing.assert_allclose((high - low) / 2.0, half, rtol=1e-5)
    np.testing.assert_allclose((high + low) / 2.0, grid @ LINES[fit](whole), rtol=1e-6, atol=1e-6)
    assert whole.n_groups == G


@pytest.mark.parametrize("spread", [np.repeat, np.tile])
def test_runs_repeated_under_a_recording_add_no_knowledge(spread):
    """Each run four times under its recording, side by side or far apart; as independent runs they halve the band."""
    im, falls, groups = (spread(column, 4) for column in (IM, FALLS, GROUPS))
    names = pd.Series([f"record {number}" for number in groups])
    for of in (groups, names, pd.Categorical(names), names.to_list()):
        np.testing.assert_allclose(
            rf.fit_logistic(im, falls, of).band(AT), rf.fit_logistic(IM, FALLS, GROUPS).band(AT), rtol=1e-6
        )
    blind, single = (rf.fit_logistic(*each).covariance[0, 0] for each in ((im, falls), (IM, FALLS)))
    assert blind == pytest.approx(single / 4.0)


def test_the_total_probability_has_the_joint_jackknife():
    """The delta method on the logit with numerical derivatives, where the band is narrow."""
    fit = rf.fit_outcomes(IM, ROTATION, FALLS, GROUPS)
    left = [rf.fit_outcomes(*(column[number != GROUPS] for column in (IM, ROTATION, FALLS))) for number in range(G)]
    logits = np.array([stats.logistic.ppf(each.exceedance(AT, 0.02)) for each in left])
    half = T * np.sqrt((G - 1) * logits.var(axis=0))
    low, high = stats.logistic.ppf(np.array(fit.curve(0.02).band(AT)))
    np.testing.assert_allclose((high - low) / 2.0, half, rtol=0.15)
    assert (fit.curve(0.02).probability(AT) == fit.exceedance(AT, 0.02)).all()
    assert (
        (low < stats.logistic.ppf(fit.exceedance(AT, 0.02))) & (stats.logistic.ppf(fit.exceedance(AT, 0.02)) < high)
    ).all()


def test_the_band_of_a_rate_is_that_of_parameters_drawn_from_t():
    fit = rf.fit_logistic(IM, FALLS, GROUPS)
    found = rf.annual_rate(HAZARD, fit, confidence=0.8)
    drawn = stats.multivariate_t.rvs((fit.b0, fit.b1), fit.covariance, df=G - 1, size=4000, random_state=3)
    grid = np.geomspace(0.05, 1.6, 2001)
    middle, falls = np.sqrt(grid[1:] * grid[:-1]), -np.diff(HAZARD.rate_at(grid))
    rates = expit(drawn[:, :1] + drawn[:, 1:] * np.log(middle)) @ falls
    np.testing.assert_allclose(np.log((found.low, found.high)), np.log(np.quantile(rates, (0.1, 0.9))), atol=0.15)
    assert found.rate == rf.annual_rate(HAZARD, fit).rate
    with pytest.raises(rf.InputError, match="knows its scatter") as caught:
        rf.annual_rate(HAZARD, fit.probability, confidence=0.8)
    assert caught.value.field == "confidence"


@pytest.mark.slow
def test_one_recording_gives_no_band():
    one = np.zeros(IM.size)
    for fit in (rf.fit_logistic(IM, FALLS, one), rf.fit_cloud(IM, IM * np.exp(SCORE), one)):
        assert np.isnan(fit.band(AT)).all()
    outcomes = rf.fit_outcomes(IM, ROTATION, FALLS, one)
    assert np.isnan(outcomes.curve(0.02).band(AT)).all()
    assert any("one recording" in note for note in outcomes.notes)
    with pytest.raises(rf.InputError, match="one recording"):
        rf.fit_capacities(CAPACITY, None, np.zeros(CAPACITY.size)).band(AT)


def test_an_outcome_of_all_runs_counts_recordings():
    never = rf.fit_outcomes(IM, np.minimum(ROTATION, 0.1), np.zeros(IM.size), GROUPS).overturning
    assert (never.n, never.n_groups) == (176, G)
    assert never.bound(0.95) == pytest.approx(1.0 - 0.05 ** (1.0 / G))
    found = rf.annual_rate(HAZARD, never, confidence=0.9)
    assert (found.rate, math.isnan(found.low), math.isnan(found.high)) == (0.0, True, True)


def test_what_is_extrapolated_of_a_rate_is_told():
    fit = rf.fit_logistic(IM, FALLS, GROUPS)
    assert fit.measured == (pytest.approx(IM.min()), pytest.approx(IM.max()))
    wide = rf.HazardCurve([0.01, IM.min(), 1.0], [1.0, 1e-2, 1e-4])
    low = rf.HazardCurve([0.01, IM.min()], [1.0, 1e-2])
    assert rf.annual_rate(wide, fit).extrapolated == pytest.approx(rf.annual_rate(low, fit).rate, rel=1e-6)
    assert math.isnan(rf.annual_rate(wide, fit.probability).extrapolated)


@pytest.mark.parametrize("groups", [[None, *GROUPS[1:]], [GROUPS], 5.0, [[1], [1, 2]]])
def test_a_recording_without_a_name_is_refused(groups):
    with pytest.raises(rf.InputError) as caught:
        rf.fit_logistic(IM, FALLS, groups)
    assert caught.value.field == "groups"


@pytest.fixture(scope="module")
def runs():
    frame = rf.Frame(3, 3.0, 40e3, 40e3, 1.0, period=0.6, aspect_ratio=8.0, damping_ratio=0.02)
    return rf.run_cloud(
        {"frame": frame},
        rf.load_suite("fema-p695-far-field")[:16],
        "2DOF-S",
        [0.5, 1.0, 2.0, 4.0],
        free_vibration="settle",
    )


def test_clouds_take_the_recordings_of_the_table(runs):
    (fit,) = rf.fit_clouds(runs, "pgv")
    count = runs["group"].nunique()
    assert count < runs["motion"].nunique()
    assert {fit.outcomes.n_groups, fit.outcomes.initiation.n_groups, fit.top_displacement.n_groups} == {count}
    (ungrouped,) = rf.fit_clouds(runs.drop(columns="group"), "pgv")  # scales of one motion are dependent, too
    assert ungrouped.outcomes.n_groups == runs["motion"].nunique()
    (blind,) = rf.fit_clouds(runs.drop(columns=["group", "motion"]), "pgv")
    assert blind.outcomes.n_groups == 0
    assert blind.outcomes.rotation.c1 == fit.outcomes.rotation.c1


@pytest.mark.slow
def test_a_rate_in_sa_at_5_percent_is_that_of_an_own_integral(runs):
    """Sa(T1) from a step-by-step integration of the oscillator, a logistic curve by SciPy, and the trapezoidal rule."""
    from scipy.optimize import minimize
    from scipy.signal import lsim

    suite, omega = rf.load_suite("fema-p695-far-field")[:16], 2.0 * math.pi / 0.6
    own = {}
    for motion in suite:
        time = np.arange(0.0, motion.duration, motion.dt / 8.0)
        oscillator = [-1.0], [1.0, 2.0 * 0.05 * omega, omega**2]
        _, u, _ = lsim(oscillator, np.interp(time, motion.time, motion.acceleration), time)
        own[motion.name] = omega**2 * np.abs(u).max()
    sa = runs["motion"].astype(str).map(own).to_numpy() * runs["scale"].to_numpy()
    np.testing.assert_allclose(runs["sa_t1_5"], sa, rtol=0.01)
    fell = (runs["status"] == "overturned").to_numpy(bool)

    def cost(b):
        return np.logaddexp(0.0, np.where(fell, -1.0, 1.0) * (b[0] + b[1] * np.log(sa))).sum()

    b = minimize(cost, (0.0, 1.0), method="BFGS").x
    im, rate = np.array([0.5, 2.0, 8.0, 30.0]), np.array([0.1, 1e-2, 6e-4, 2e-5])
    grid = np.geomspace(0.5, 30.0, 4001)
    hazard = np.exp(np.interp(np.log(grid), np.log(im), np.log(rate)))
    expected = np.sum(expit(b[0] + b[1] * np.log(np.sqrt(grid[1:] * grid[:-1]))) * -np.diff(hazard))
    (fit,) = rf.fit_clouds(runs, "sa_t1_5")
    assert rf.annual_rate(rf.HazardCurve(im, rate), fit.outcomes.overturning).rate == pytest.approx(expected, rel=0.02)
    (other,) = rf.fit_clouds(runs, "sa_t1")
    wrong = rf.annual_rate(rf.HazardCurve(im, rate, damping=0.02), other.outcomes.overturning).rate
    assert wrong < 0.8 * expected  # what a curve at 5 % would have given for a measure at 2 %


def test_a_measure_of_another_damping_is_refused(runs, tmp_path):
    hazard = rf.HazardCurve([1.0, 10.0], [1e-2, 1e-4])
    (fit,) = rf.fit_clouds(runs, "sa_t1")
    for curve in (fit.outcomes.overturning, fit.outcomes.curve(0.02)):
        with pytest.raises(rf.InputError, match="sa_t1_5") as caught:
            rf.annual_rate(hazard, curve)
        assert caught.value.field == "damping"
        assert rf.annual_rate(rf.HazardCurve(hazard.im, hazard.rate, damping=0.02), curve).rate > 0.0
    for write in (rf.write_nrml, rf.write_pelicun):
        with pytest.raises(rf.InputError, match="sa_t1_5") as caught:
            write(tmp_path / "file", {"frame": fit.outcomes}, "SA(0.6)", [1.0, 10.0])
        assert caught.value.field == "measure"
    outcome = runs["status"] == "overturned"
    for fit in (
        rf.fit_logistic(runs["sa_t1"], outcome),
        rf.fit_outcomes(runs["sa_t1"], runs["max_rotation"], outcome).overturning,
    ):
        with pytest.raises(rf.InputError, match="unknown"):
            rf.annual_rate(hazard, fit)
    rf.annual_rate(
        rf.HazardCurve(hazard.im, hazard.rate, damping=0.02), rf.fit_logistic(runs["sa_t1"], outcome, damping=0.02)
    )
    assert rf.fit_logistic(runs["sa_t1_5"], outcome).damping == 0.05
    (unknown,) = rf.fit_clouds(runs.drop(columns="zeta_1"), "sa_t1")  # a study stored before it was told
    with pytest.raises(rf.InputError, match="unknown"):
        rf.annual_rate(hazard, unknown.outcomes.overturning)
    for name in ("pgv", "sa_t1_5"):
        rf.annual_rate(hazard, rf.fit_clouds(runs, name)[0].outcomes.overturning)
    with pytest.raises(rf.InputError, match="damping must lie"):
        rf.HazardCurve([1.0, 10.0], [1e-2, 1e-4], damping=5.0)
