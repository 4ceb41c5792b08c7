"""Logistic fits against statsmodels and firthmodels called directly; separation against the linear program."""

import math

import numpy as np
import pandas as pd
import pytest
import statsmodels.api as sm
from firthmodels import FirthLogisticRegression, detect_separation
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats
from scipy.optimize import minimize
from scipy.special import expit

from rockflex import InputError
from rockflex.fragility import fit_logistic
from rockflex.fragility._regression import are_outcomes_separated

RNG = np.random.default_rng(11)
IM = np.exp(RNG.normal(-1.0, 0.8, 120))
OUTCOME = RNG.random(120) < expit(2.0 + 2.5 * np.log(IM))
AT = np.array([0.1, 0.45, 2.0])


def test_the_curve_is_that_of_statsmodels():
    fit = fit_logistic(IM, OUTCOME)
    result = sm.Logit(OUTCOME.astype(float), sm.add_constant(np.log(IM))).fit(disp=0)
    assert (fit.b0, fit.b1) == pytest.approx(result.params, rel=1e-7)
    np.testing.assert_allclose(fit.covariance, result.cov_params(), rtol=1e-6)
    model = sm.GLM(OUTCOME.astype(float), sm.add_constant(np.log(IM)), family=sm.families.Binomial()).fit()
    low, high = model.get_prediction(sm.add_constant(np.log(AT))).conf_int(alpha=0.1).T
    np.testing.assert_allclose(fit.band(AT), (low, high), rtol=1e-6)
    np.testing.assert_allclose(fit.probability(AT), result.predict(sm.add_constant(np.log(AT))), rtol=1e-7)
    assert (fit.n, fit.n_events, fit.method, fit.separated, fit.note) == (
        120, int(OUTCOME.sum()), "maximum likelihood", False, "",
    )  # fmt: skip


def test_median_and_dispersion_are_of_the_logistic_distribution_of_log_capacity():
    fit = fit_logistic(IM, OUTCOME)
    assert fit.probability(fit.median) == pytest.approx(0.5)
    capacity = stats.logistic(math.log(fit.median), fit.dispersion)
    np.testing.assert_allclose(fit.probability(AT), capacity.cdf(np.log(AT)), rtol=1e-12)


def test_the_unit_of_the_measure_moves_the_median_only():
    fit, other = fit_logistic(IM, OUTCOME), fit_logistic(1e6 * IM, OUTCOME)
    assert other.b1 == pytest.approx(fit.b1, rel=1e-9)
    assert other.median == pytest.approx(1e6 * fit.median, rel=1e-9)
    np.testing.assert_allclose(other.band(1e6 * AT), fit.band(AT), rtol=1e-9)


@pytest.mark.parametrize("column", [OUTCOME.astype(int), pd.Series(OUTCOME), pd.Series(OUTCOME, dtype="boolean")])
def test_outcomes_may_be_ones_or_columns_of_pandas(column):
    assert fit_logistic(pd.Series(IM), column).b1 == fit_logistic(IM, OUTCOME).b1


def test_separated_outcomes_get_the_finite_curve_of_the_penalised_likelihood():
    im = np.array([0.1, 0.15, 0.2, 0.3, 0.5, 0.7, 0.9, 1.2])
    fit = fit_logistic(im, im > 0.4)
    assert (fit.method, fit.separated) == ("Firth", True)
    assert "Separated between im = 0.3 and 0.5" in fit.note
    assert 0.3 < fit.median < 0.5

    x = sm.add_constant(np.log(im))

    def penalised(beta):
        p = expit(x @ beta)
        likelihood = np.sum(np.where(im > 0.4, np.log(p), np.log1p(-p)))
        return -likelihood - 0.5 * np.linalg.slogdet((x.T * (p * (1 - p))) @ x)[1]

    best = minimize(penalised, [0.0, 1.0], method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-12}).x
    assert (fit.b0, fit.b1) == pytest.approx(best, rel=1e-3)
    information = -sm.Logit((im > 0.4).astype(float), x).hessian(np.array([fit.b0, fit.b1]))
    np.testing.assert_allclose(fit.covariance, np.linalg.inv(information), rtol=1e-6)
    firth = FirthLogisticRegression(backend="numpy").fit(np.log(im)[:, None], im > 0.4)
    assert (fit.b0, fit.b1) == pytest.approx((firth.intercept_, firth.coef_[0]), rel=1e-3)


def test_quasi_separation_is_seen_and_its_curve_finite():
    im, outcome = [0.1, 0.2, 0.3, 0.3, 0.3, 0.5, 0.6], [0, 0, 0, 1, 1, 1, 1]
    fit = fit_logistic(im, outcome)
    assert fit.separated
    assert "between im = 0.3 and 0.3" in fit.note
    assert 0.0 < fit.b1 < 50.0


def test_outcomes_separated_the_wrong_way_round_are_told():
    fit = fit_logistic([0.1, 0.2, 0.3, 0.4], [1, 1, 0, 0])
    assert fit.separated
    assert "does not rise with im (b1 = -" in fit.note
    assert math.isnan(fit.median)
    assert math.isnan(fit.dispersion)


def test_all_but_separated_outcomes_never_get_a_runaway_slope():
    im = np.r_[np.linspace(0.1, 1.0, 50), np.linspace(1.0 - 1e-9, 5.0, 50)]
    fit = fit_logistic(im, np.arange(100) >= 50)
    assert not fit.separated
    assert fit.method == "Firth"
    assert "Nearly separated" in fit.note
    assert np.isfinite(fit.covariance).all()


@given(
    st.lists(st.tuples(st.integers(0, 6), st.booleans()), min_size=2, max_size=12).filter(
        lambda runs: len({x for x, _ in runs}) > 1 and len({y for _, y in runs}) == 2
    )
)
def test_separation_is_what_the_linear_program_finds(runs):
    x, y = np.array([float(x) for x, _ in runs]), np.array([y for _, y in runs])
    assert are_outcomes_separated(x, y, np.ones((1, x.size))) == detect_separation(x[:, None], y).separation


@given(
    st.lists(st.tuples(st.floats(1e-3, 1e3), st.booleans()), min_size=2, max_size=40).filter(
        lambda runs: np.ptp(np.log([x for x, _ in runs])) > 1e-6 and len({y for _, y in runs}) == 2
    )
)
def test_any_outcomes_give_a_finite_curve_within_its_band(runs):
    im, outcome = np.array([x for x, _ in runs]), np.array([y for _, y in runs])
    fit = fit_logistic(im, outcome)
    p, (low, high) = fit.probability(im), fit.band(im)
    assert np.isfinite([fit.b0, fit.b1]).all()
    assert ((low <= p) & (p <= high)).all()
    if fit.method == "maximum likelihood":  # its score equation
        assert p.sum() == pytest.approx(outcome.sum(), abs=1e-4)


@pytest.mark.parametrize(
    ("im", "outcome", "text"),
    [
        ([1, 2, 3], [0, 0, 0], r"outcome is False in all 3 runs.*95 % confidence.*is below 63\.2 %.*fit_outcomes"),
        ([1, 2, 3], [1, 1, 1], r"outcome is True in all 3 runs.*is above 36\.8 %"),
        ([1, 2, 3], [0, 0.5, 1], r"outcome must hold True or False .* 1 of 3 .* \(0\.5\) in row 1\. Compare"),
        ([1, 2, 3], [0, math.nan, 1], r"outcome must hold True or False .* \(nan\) in row 1"),
        ([1, 2, 3], pd.array([True, None, False], dtype="boolean"), r"outcome must hold True or False"),
        ([1, 2, 3], ["yes", "no", "no"], r"outcome must hold True or False for every run\. Leave out"),
        ([1, 2, 3], [[0, 1, 1]], r"outcome must be one-dimensional"),
        ([1, 2, 3], [0, 1], r"im has 3, outcome has 2"),
        ([1, 1, 1], [0, 1, 1], r"im must hold at least two different values"),
    ],
)
def test_columns_that_cannot_be_fitted_are_refused(im, outcome, text):
    with pytest.raises(InputError, match=text):
        fit_logistic(im, outcome)
