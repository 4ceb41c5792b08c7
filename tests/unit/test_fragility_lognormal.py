"""Lognormal curves from stripes and from capacities against statsmodels, SciPy and likelihoods written out."""

import math

import numpy as np
import pytest
import statsmodels.api as sm
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats
from scipy.optimize import minimize
from statsmodels.tools.numdiff import approx_hess

from rockflex import InputError
from rockflex.fragility import LognormalFragility, fit_capacities, fit_stripes

LEVELS = np.array([0.1, 0.2, 0.3, 0.4, 0.6])
EVENTS = np.array([0, 2, 7, 12, 19])
TOTAL = np.array([20, 20, 22, 20, 20])
AT = np.array([0.15, 0.35, 0.9])


def log_likelihood(parameters):
    p = stats.norm.cdf((np.log(LEVELS) - parameters[0]) / parameters[1])
    return stats.binom.logpmf(EVENTS, TOTAL, p).sum()


def test_stripes_reach_the_largest_likelihood():
    fit = fit_stripes(LEVELS, EVENTS, TOTAL)
    best = minimize(lambda p: -log_likelihood(p), [-1.0, 0.5], method="Nelder-Mead", options={"xatol": 1e-9}).x
    assert (math.log(fit.median), fit.beta) == pytest.approx(best, rel=1e-5)
    assert fit.n == 102
    assert fit.method == "binomial counts, maximum likelihood"


def test_the_band_of_stripes_is_that_of_statsmodels():
    fit = fit_stripes(LEVELS, EVENTS, TOTAL)
    family = sm.families.Binomial(link=sm.families.links.Probit())
    model = sm.GLM(np.c_[EVENTS, TOTAL - EVENTS], sm.add_constant(np.log(LEVELS)), family=family).fit()
    a, b = model.params
    assert (fit.median, fit.beta) == pytest.approx((math.exp(-a / b), 1 / b), rel=1e-8)
    prediction = model.get_prediction(sm.add_constant(np.log(AT)))
    np.testing.assert_allclose(fit.probability(AT), prediction.predicted, rtol=1e-7)
    np.testing.assert_allclose(fit.band(AT, 0.8), prediction.conf_int(alpha=0.2).T, rtol=1e-6)


def test_stripes_may_repeat_and_come_in_any_order():
    fit = fit_stripes(LEVELS, EVENTS, TOTAL)
    order = [3, 1, 4, 0, 2]
    assert fit_stripes(LEVELS[order], EVENTS[order], TOTAL[order]).median == pytest.approx(fit.median, rel=1e-9)
    singles = np.repeat(LEVELS, TOTAL), np.concatenate([np.arange(t) < e for e, t in zip(EVENTS, TOTAL, strict=True)])
    single = fit_stripes(*singles, np.ones(102))
    assert (single.median, single.beta) == pytest.approx((fit.median, fit.beta), rel=1e-6)


def test_capacities_without_censoring_are_their_moments():
    im = np.array([0.3, 0.4, 0.5, 0.9])
    fit = fit_capacities(im)
    assert fit.median == pytest.approx(stats.gmean(im))
    assert fit.beta == pytest.approx(np.std(np.log(im), ddof=1))
    assert np.sqrt(fit.covariance[0, 0]) == pytest.approx(fit.beta / 2)
    assert fit_capacities(im, np.zeros(4)).beta == fit.beta


@pytest.mark.slow
@settings(max_examples=40)
@given(
    st.lists(st.floats(-3.0, 3.0), min_size=3, max_size=15).filter(lambda x: np.std(x) > 0.05),
    st.lists(st.floats(0.0, 3.0), min_size=1, max_size=8),
)
def test_censored_capacities_reach_the_largest_likelihood(known, beyond):
    known, above = np.array(known), np.array(known).mean() + np.array(beyond)
    fit = fit_capacities(np.exp(np.r_[known, above]), np.r_[np.zeros(known.size), np.ones(above.size)])
    mean, beta = math.log(fit.median), fit.beta

    def log_likelihood(p):
        return stats.norm.logpdf(known, *p).sum() + stats.norm.logsf(above, *p).sum()

    assert fit.n == known.size + above.size
    for step in (1e-3, -1e-3):
        assert log_likelihood([mean, beta]) > log_likelihood([mean + step * beta, beta])
        assert log_likelihood([mean, beta]) > log_likelihood([mean, beta * (1 + step)])
    hessian = approx_hess(np.array([mean, beta]), log_likelihood)
    np.testing.assert_allclose(fit.covariance @ -hessian, np.eye(2), atol=2e-3)


def test_censored_records_move_the_median_up():
    im = np.array([0.3, 0.4, 0.5, 0.9, 1.0, 1.0])
    fit = fit_capacities(im, [0, 0, 0, 0, 1, 1])
    assert fit.median > fit_capacities(im).median > fit_capacities(im[:4]).median
    assert fit.method == "censored capacities, maximum likelihood"


def test_quantiles_invert_the_curve():
    curve = LognormalFragility(0.5, 0.4)
    np.testing.assert_allclose(curve.probability(curve.quantile([0.05, 0.5, 0.95])), [0.05, 0.5, 0.95])
    assert curve.quantile(0.5) == 0.5
    assert (curve.n, curve.method) == (0, "given")


def test_a_given_covariance_widens_the_band():
    curve = LognormalFragility(0.5, 0.4, [[0.01, 0.0], [0.0, 0.004]])
    low, high = curve.band([0.5, 1.0])
    spread = 1.6448536269514722 * 0.1 / 0.4
    assert (low[0], high[0]) == pytest.approx(stats.norm.cdf([-spread, spread]))


@pytest.mark.parametrize(
    ("levels", "events", "total", "text"),
    [
        ([0.1, 0.2, 0.3], [0, 0, 0], [5, 5, 5], "No run exceeds the limit at any level.*Add stripes at larger"),
        ([0.1, 0.2, 0.3], [5, 5, 5], [5, 5, 5], "All runs exceed the limit at any level.*Add stripes at smaller"),
        ([0.1, 0.2, 0.3], [0, 0, 5], [5, 5, 5], "separated between 0.2 and 0.3: .*dispersion is zero.*fit_logistic"),
        ([0.1, 0.2, 0.3], [0, 2, 5], [5, 5, 5], "separated at 0.2"),
        ([0.1, 0.2, 0.3], [4, 2, 1], [5, 5, 5], r"does not rise with im_levels \(slope -"),
        ([0.1, 0.2, 0.3], [4, 6, 1], [5, 5, 5], "at most n_total, but stripe 1 has 6 of 5"),
        ([0.1, 0.2, 0.3], [0.1, 0.2, 1], [5, 5, 5], "n_exceeding must hold whole numbers of at least 0, but row 0"),
        ([0.1, 0.2, 0.3], [0, 0, 1], [5, 0, 5], "n_total must hold whole numbers of at least 1, but row 1 holds 0"),
        ([0.1, 0.2, 0.3], [0, 1], [5, 5, 5], "im_levels has 3, n_exceeding has 2, n_total has 3"),
        ([0.0, 0.2, 0.3], [0, 1, 2], [5, 5, 5], "im_levels must be positive"),
    ],
)
def test_stripes_that_give_no_curve_are_refused(levels, events, total, text):
    with pytest.raises(InputError, match=text):
        fit_stripes(levels, events, total)


@pytest.mark.parametrize(
    ("call", "text"),
    [
        (lambda: fit_capacities([0.5, 1, 1], [0, 1, 1]), "two different capacities .* 1 were given besides 2 censored"),
        (lambda: fit_capacities([1.0, 1.0], [1, 1]), "but 0 were given besides 2 censored records. Scale"),
        (lambda: fit_capacities([0.5, 0.5]), "1 were given besides 0"),
        (lambda: fit_capacities([0.5, -1.0]), "im must be positive.*Leave those records out"),
        (lambda: fit_capacities([0.5, 0.6], [0]), "im has 2, censored has 1"),
        (lambda: LognormalFragility(0.5, 0.4, np.eye(3)), r"covariance must have the shape \(2, 2\)"),
        (lambda: LognormalFragility(0.5, 0.4).band(1.0), "A band needs the covariance"),
        (lambda: LognormalFragility(0.5, 0.4).quantile(0.0), "p must lie between 0 and 1"),
    ],
)
def test_curves_that_cannot_be_are_refused(call, text):
    with pytest.raises(InputError, match=text):
        call()
