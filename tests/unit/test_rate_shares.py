"""The variance of an annual rate, split among structure, model, records and hazard: against closed forms."""

import math

import numpy as np
import pytest
from scipy import stats

import rockflex as rf

K0, K, BETA = 1e-4, 2.5, 0.4
IM = np.geomspace(1e-4, 1e4, 120)
MEAN = rf.HazardCurve(IM, K0 * IM**-K)
COVARIANCE = np.diag([0.1**2, 0.0])


def closed_rate(median):
    return K0 * median**-K * math.exp(0.5 * (K * BETA) ** 2)


def test_a_product_of_factors_has_the_sobol_indices_of_its_closed_form():
    structures, models, weights = {"a": 0.8, "b": 1.1, "c": 1.3}, {"M": 1.0, "N": 1.25}, {"M": 3.0, "N": 1.0}
    curves = {
        (s, m): rf.LognormalFragility(first * second, BETA, COVARIANCE)
        for s, first in structures.items()
        for m, second in models.items()
    }
    found = rf.rate_shares(rf.HazardBranches.lognormal(MEAN, 0.6), curves, weights=weights)

    by_structure = np.array(list(structures.values())) ** -K
    by_model, chances = np.array(list(models.values())) ** -K, np.array([0.75, 0.25])
    model = chances @ by_model
    squares = np.array([  # of the coefficients of variation of the four factors
        by_structure.var() / by_structure.mean() ** 2,
        chances @ (by_model - model) ** 2 / model**2,
        math.expm1((0.1 * K) ** 2),
        math.expm1(0.6**2),
    ])  # fmt: skip
    mean = closed_rate(1.0) * by_structure.mean() * model * math.exp(0.5 * (0.1 * K) ** 2)
    whole = np.prod(1.0 + squares) - 1.0
    without = np.array([np.prod(np.delete(1.0 + squares, place)) - 1.0 for place in range(4)])
    assert found.mean == pytest.approx(mean, rel=2e-4)
    assert found.shares["variance"].to_numpy()[:4] == pytest.approx(squares * mean**2, rel=5e-3)
    assert found.shares["share"].to_numpy()[:4] == pytest.approx(squares / whole, rel=5e-3)
    assert found.shares["total"].to_numpy()[:4] == pytest.approx(1.0 - without / whole, rel=5e-3)
    assert found.shares["share"].sum() == pytest.approx(1.0, abs=1e-12)
    assert found.shares["share"]["interactions"] > 0.05


def test_logarithms_of_factors_have_no_interactions_and_the_quantiles_of_a_lognormal():
    curves = {("a", "M"): rf.LognormalFragility(0.7, BETA, COVARIANCE)}
    found = rf.rate_shares(rf.HazardBranches.lognormal(MEAN, 0.5), curves, logarithm=True, confidence=0.8)
    variances = np.array([(0.1 * K) ** 2, 0.25])
    assert found.shares["variance"].to_numpy()[2:4] == pytest.approx(variances, rel=5e-3)
    assert found.shares["total"].to_numpy() == pytest.approx([0.0, 0.0, *variances / variances.sum(), 0.0], abs=2e-3)
    spread = math.sqrt(variances.sum())
    ends = closed_rate(0.7) * stats.lognorm(spread, scale=math.exp(-0.125)).ppf([0.1, 0.9])
    assert [found.low, found.high] == pytest.approx(ends, rel=0.02)


def test_probability_in_years_of_two_branches():
    curves, (low, high) = {("a", "M"): rf.LognormalFragility(0.5, BETA)}, (0.4, 2.5)
    branches = [rf.HazardCurve(IM, factor * MEAN.rate) for factor in (low, high)]
    found = rf.rate_shares(rf.HazardBranches(branches, [3, 1]), curves, years=50)
    chances = 1.0 - np.exp(-50 * closed_rate(0.5) * np.array([low, high]))
    mean = 0.75 * chances[0] + 0.25 * chances[1]
    assert found.mean == pytest.approx(mean, rel=1e-8)
    assert found.shares["variance"]["hazard"] == pytest.approx(0.1875 * (chances[1] - chances[0]) ** 2, rel=1e-8)
    assert found.shares["share"]["hazard"] == found.shares["total"]["hazard"] == pytest.approx(1.0)
    assert [found.low, found.high] == pytest.approx(chances, rel=1e-8)


def test_branches_with_points_of_their_own_are_integrated_on_their_own():
    other = rf.HazardCurve([1e-3, 1e-1, 3.0, 200.0], [0.5, 3e-3, 2e-5, 3e-8])
    curve = rf.LognormalFragility(0.5, BETA)
    found = rf.rate_shares(rf.HazardBranches([MEAN, other]), {("a", "M"): curve})
    rates = [rf.annual_rate(hazard, curve).rate for hazard in (MEAN, other)]
    assert found.mean == pytest.approx(np.mean(rates), rel=1e-4)
    assert found.shares["variance"]["hazard"] == pytest.approx(np.var(rates), rel=1e-3)


def capacities(count=200):
    """Capacities of two models in logarithms: what records have in common, and what each model makes of them."""
    rng = np.random.default_rng(4)
    common = rng.normal(0.0, 0.35, count)
    return {name: common + rng.normal(shift, 0.2, count) for name, shift in {"M": 0.0, "N": 0.3}.items()}


def test_fits_of_the_same_recordings_are_drawn_together():
    drawn = capacities()
    names = [f"r{place}" for place in range(200)]
    shuffled = np.random.default_rng(1).permutation(200)
    curves = {
        ("a", "M"): rf.fit_capacities(np.exp(drawn["M"]), groups=names),
        ("a", "N"): rf.fit_capacities(np.exp(drawn["N"][shuffled]), groups=[names[place] for place in shuffled]),
    }
    found = rf.rate_shares(MEAN, curves, logarithm=True).shares
    # ln λ = ln k0 - k μ + k² β²/2: what each record adds to it
    away = np.array([each - each.mean() for each in drawn.values()])
    added = (-K * away + 0.5 * K**2 * (away**2 - (away**2).mean(axis=1)[:, None])) / 200
    together, apart = added.mean(axis=0), (added[0] - added[1]) / 2
    assert found["variance"]["records"] == pytest.approx((together**2).sum(), rel=0.08)
    assert found["variance"]["interactions"] == pytest.approx((apart**2).sum(), rel=0.08)
    logs = [-K * each.mean() + 0.5 * K**2 * each.var(ddof=1) for each in drawn.values()]
    assert found["variance"]["model"] == pytest.approx(np.var(logs), rel=0.03)


def test_what_all_models_say_alike_is_of_the_records_alone():
    rng, recordings = np.random.default_rng(6), np.repeat(np.arange(24), 6)
    im = np.exp(rng.normal(-0.5, 0.7, 144))
    turned = np.where(im < 0.15, 0.0, 0.02 * im**1.3 * np.exp(rng.normal(0.0, 0.4, 24)[recordings]))
    fallen = im * np.exp(rng.normal(0.0, 0.5, 144)) > 1.6

    def fits(chosen):
        rotation = np.where(fallen, 1.6, turned)[chosen]
        fit = rf.fit_outcomes(im[chosen], rotation, fallen[chosen], recordings[chosen])
        return fit.overturning, fit.curve(0.02)

    # the jackknife by hand: every fit made anew
    without = [[rf.annual_rate(MEAN, curve).rate for curve in fits(recordings != g)] for g in range(24)]
    for curve, rates in zip(fits(recordings >= 0), np.log(without).T, strict=True):
        found = rf.rate_shares(MEAN, {("a", "M"): curve, ("a", "N"): curve}, logarithm=True)
        assert found.shares["total"].to_numpy() == pytest.approx([0.0, 0.0, 1.0, 0.0, 0.0], abs=1e-9)
        assert found.shares["variance"]["records"] == pytest.approx(23 * rates.var(), rel=0.01)


def test_a_mean_curve_stays_the_mean():
    hazard = rf.HazardBranches.lognormal(MEAN, 0.9)
    rates = np.array([curve.rate_at(0.3) for curve in hazard.curves])
    assert hazard.weights @ rates == pytest.approx(MEAN.rate_at(0.3), rel=1e-12)
    deviation = hazard.weights @ (rates / MEAN.rate_at(0.3) - 1.0) ** 2
    assert deviation == pytest.approx(math.expm1(0.81), rel=1e-9)


ONE = rf.LognormalFragility(0.5, BETA)
GROUPED = {n: rf.fit_capacities(np.exp(capacities()["M"][:n]), groups=np.arange(n)) for n in (20, 22)}
BRANCHES = rf.HazardBranches([MEAN, rf.HazardCurve(IM, 2 * MEAN.rate)])


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"curves": {}}, "one fragility curve or more"),
        ({"curves": {"a": ONE}}, "structure, model"),
        ({"curves": [ONE]}, "structure, model"),
        ({"weights": [1.0]}, "mapping"),
        ({"hazard": ONE}, "hazard"),
        ({"curves": {("a", "M"): ONE, ("b", "N"): ONE}}, "every structure with every model"),
        ({"curves": {("a", "M"): GROUPED[20], ("a", "N"): GROUPED[22]}}, "same recordings"),
        ({"curves": {("a", "M"): rf.LognormalFragility(0.5, BETA, damping=0.02)}}, "damping"),
        ({"curves": {("a", "M"): lambda im: 0.0 * im}, "logarithm": True}, "zero"),
        ({"hazard": MEAN}, "nothing uncertain"),
        ({"weights": {"c": 1.0}}, "neither"),
        ({"curves": {("a", "M"): ONE, ("a", "N"): ONE}, "weights": {"M": 1.0}}, "all models"),
        ({"weights": {"M": -1.0}}, "weights"),
        ({"confidence": 1.0}, "confidence"),
    ],
)
def test_impossible_splits_are_told(changes, word):
    with pytest.raises(rf.InputError, match=word):
        rf.rate_shares(**{"hazard": BRANCHES, "curves": {("a", "M"): ONE}} | changes)


@pytest.mark.parametrize(
    ("make", "field"),
    [
        (lambda: rf.HazardBranches([MEAN]), "curves"),
        (lambda: rf.HazardBranches([MEAN, MEAN], [1.0]), "weights"),
        (lambda: rf.HazardBranches([MEAN, MEAN], [1.0, 0.0]), "weights"),
        (lambda: rf.HazardBranches([MEAN, rf.HazardCurve(IM, MEAN.rate, damping=0.02)]), "damping"),
        (lambda: rf.HazardBranches.lognormal(MEAN, 0.0), "dispersion"),
    ],
)
def test_impossible_branches_are_told(make, field):
    with pytest.raises(rf.InputError) as caught:
        make()
    assert caught.value.field == field
