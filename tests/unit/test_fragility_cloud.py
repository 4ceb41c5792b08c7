"""Lines through clouds, and the comparison of intensity measures."""

import math

import numpy as np
import pandas as pd
import pytest
import statsmodels.api as sm
from scipy import stats

from rockflex import InputError
from rockflex.fragility import compare_measures, fit_cloud

RNG = np.random.default_rng(7)
IM = np.exp(RNG.normal(-1.0, 0.8, 60))
Y = 0.02 * IM**1.3 * np.exp(0.4 * RNG.normal(size=60))
AT = np.array([0.05, 0.4, 2.0])
MEASURES_RNG = np.random.default_rng(2)
N = 200
PGV = np.exp(MEASURES_RNG.normal(-1.0, 0.7, N))
MAGNITUDE = MEASURES_RNG.normal(7.0, 0.4, N)
MEASURES = pd.DataFrame(
    {"PGA": PGV * np.exp(0.6 * MEASURES_RNG.normal(size=N)), "PGV": PGV, "other": np.exp(MEASURES_RNG.normal(size=N))}
)
RESPONSE = 0.02 * PGV**1.2 * np.exp(0.3 * MEASURES_RNG.normal(size=N))
COVARIATES = pd.DataFrame({"magnitude": MAGNITUDE, "log_distance": MEASURES_RNG.normal(3.0, 0.5, N), "scale": 1.0})


def test_the_line_is_that_of_statsmodels_and_scipy():
    fit = fit_cloud(IM, Y)
    line = stats.linregress(np.log(IM), np.log(Y))
    assert (fit.c1, fit.c2) == pytest.approx((line.intercept, line.slope), rel=1e-12)
    assert fit.r2 == pytest.approx(line.rvalue**2, rel=1e-12)
    residuals = np.log(Y) - line.intercept - line.slope * np.log(IM)
    assert fit.dispersion == pytest.approx(math.sqrt(np.sum(residuals**2) / 58), rel=1e-12)
    result = sm.OLS(np.log(Y), sm.add_constant(np.log(IM))).fit()
    np.testing.assert_allclose(fit.covariance, result.cov_params(), rtol=1e-12)
    low, high = np.exp(result.get_prediction(sm.add_constant(np.log(AT))).conf_int(alpha=0.2)).T
    np.testing.assert_allclose(fit.band(AT, 0.8), (low, high), rtol=1e-12)
    assert fit.n == 60


def test_quantiles_and_exceedance_are_of_one_lognormal():
    fit = fit_cloud(IM, Y)
    scipys = stats.lognorm(fit.dispersion, scale=fit.median(AT))
    np.testing.assert_allclose(fit.quantile(AT, 0.84), scipys.ppf(0.84), rtol=1e-12)
    np.testing.assert_allclose(fit.exceedance(AT, 0.01), scipys.sf(0.01), rtol=1e-10)
    np.testing.assert_allclose(fit.quantile(AT, 0.5), fit.median(AT))
    assert fit.exceedance(AT[:, None], [0.01, 0.02]).shape == (3, 2)
    assert fit.median(0.4) == pytest.approx(math.exp(fit.c1) * 0.4**fit.c2)


def test_points_on_a_line_have_no_scatter():
    im = np.array([1.0, 2.0, 4.0, 8.0])
    fit = fit_cloud(im, im)
    assert (fit.c2, fit.r2) == pytest.approx((1.0, 1.0))
    assert fit.dispersion < 1e-14
    assert fit.exceedance([1.0, 3.0], 2.0) == pytest.approx([0.0, 1.0])


def test_units_shift_the_line_only():
    fit, other = fit_cloud(IM, Y), fit_cloud(100.0 * IM, 1000.0 * Y)
    assert (other.c2, other.dispersion, other.r2) == pytest.approx((fit.c2, fit.dispersion, fit.r2))
    np.testing.assert_allclose(other.median(100.0 * AT), 1000.0 * fit.median(AT))


def test_columns_of_pandas_serve():
    table = pd.DataFrame({"im": IM, "y": Y}, index=np.arange(60)[::-1])
    assert fit_cloud(table["im"], table["y"]).c2 == fit_cloud(IM, Y).c2
    assert fit_cloud(table["im"].astype("Float64"), table["y"]).c2 == fit_cloud(IM, Y).c2


@pytest.mark.parametrize(
    ("im", "response", "text"),
    [
        (
            [0.1, 0.0, -1.0],
            [1, 2, 3],
            r"im must be positive.* 2 of 3 .* first \(0\) in row 1\. .*keep the rows with im",
        ),
        ([0.1, 0.2, 0.3], [1, 0, 3], r"response must be positive.* 1 of 3 .* row 1\. .*see fit_outcomes"),
        ([0.1, 0.2, 0.3], [1, 2], r"one row per run, but im has 3, response has 2"),
        ([0.1, 0.2], [1, 2], r"at least 3 runs with different responses, but 2 runs with 2 different"),
        ([0.1, 0.2, 0.3], [1, 1, 1], r"3 runs with 1 different"),
        ([0.2, 0.2, 0.2], [1, 2, 3], r"at least two different values, but 1 were given in 3 runs"),
    ],
)
def test_columns_that_cannot_be_fitted_are_refused(im, response, text):
    with pytest.raises(InputError, match=text):
        fit_cloud(im, response)


@pytest.mark.parametrize(
    ("call", "text"),
    [
        (lambda fit: fit.median([0.0, 1.0]), "im must be positive and finite, but 0 .* Start a grid above zero"),
        (lambda fit: fit.exceedance(1.0, -0.1), "limit must be positive and finite, but -0.1"),
        (lambda fit: fit.quantile(1.0, 84), "p must lie between 0 and 1, but 84 .* p=0.84"),
        (lambda fit: fit.band(1.0, 90), r"confidence must lie in \[0, 1\), but 90 .* confidence=0.9"),
    ],
)
def test_places_that_cannot_be_evaluated_are_refused(call, text):
    with pytest.raises(InputError, match=text):
        call(fit_cloud(IM, Y))


def test_rows_are_single_fits_ranked_by_dispersion():
    table = compare_measures(MEASURES, RESPONSE)
    assert table.index.tolist() == ["PGV", "PGA", "other"]
    assert table.columns.tolist() == ["c2", "dispersion", "proficiency", "r2", "n"]
    for name, row in table.iterrows():
        fit = fit_cloud(MEASURES[name], RESPONSE)
        assert (row.c2, row.dispersion, row.r2, row.n) == (fit.c2, fit.dispersion, fit.r2, N)
    assert table.loc["PGV", "proficiency"] == table.loc["PGV", "dispersion"] / table.loc["PGV", "c2"]
    assert table["n"].dtype == np.int64


def test_a_measure_that_does_not_rise_has_no_proficiency():
    table = compare_measures(1.0 / MEASURES[["PGV"]], RESPONSE)
    assert table.loc["PGV", "proficiency"] == math.inf


def test_p_values_are_those_of_the_regressed_residuals():
    response = RESPONSE * np.exp(0.3 * (MAGNITUDE - 7.0))
    table = compare_measures(MEASURES, response, COVARIATES)
    line = sm.OLS(np.log(response), sm.add_constant(np.log(PGV))).fit()
    result = sm.OLS(line.resid, sm.add_constant(MAGNITUDE)).fit()
    assert table.loc["PGV", "p_magnitude"] == pytest.approx(result.pvalues[1], rel=1e-9)
    assert table.loc["PGV", "p_magnitude"] < 1e-4 < table.loc["PGV", "p_log_distance"]
    assert table["p_scale"].isna().all()


def test_missing_covariates_are_left_out_of_their_test_with_a_count():
    gaps = COVARIATES.copy()
    gaps.loc[:9, "magnitude"] = np.nan
    gaps["few"] = [1.0, 2.0, *[np.nan] * (N - 2)]
    gaps["nullable"] = gaps["magnitude"].astype("Float64")
    table = compare_measures(MEASURES, RESPONSE, gaps)
    assert table.loc["PGV", ["left_out_magnitude", "left_out_nullable", "left_out_few"]].tolist() == [10, 10, N - 2]
    assert (table["left_out_log_distance"] == 0).all()
    assert table["n"].eq(N).all()
    line = sm.OLS(np.log(RESPONSE), sm.add_constant(np.log(PGV))).fit()
    result = sm.OLS(line.resid[10:], sm.add_constant(MAGNITUDE[10:])).fit()
    assert table.loc["PGV", "p_magnitude"] == pytest.approx(result.pvalues[1], rel=1e-9)
    assert table.loc["PGV", "p_nullable"] == table.loc["PGV", "p_magnitude"]
    assert table["p_few"].isna().all()


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"measures": PGV}, "measures must be a pandas DataFrame with one column or more, but ndarray"),
        ({"measures": MEASURES[[]]}, "one column or more, but DataFrame"),
        ({"measures": MEASURES.assign(PGA=0.0)}, r"measures\['PGA'\] must be positive.*keep the rows with measures"),
        ({"response": -RESPONSE}, "response must be positive.*out of all tables"),
        ({"response": RESPONSE[:-1]}, "measures has 200, response has 199"),
        ({"response": pd.Series(RESPONSE).iloc[::-1]}, "response must have the same row labels as measures"),
        ({"covariates": COVARIATES[5:]}, "covariates must have the same row labels.*reset_index"),
        ({"covariates": MAGNITUDE}, "covariates must be a pandas DataFrame"),
        ({"covariates": COVARIATES.assign(site="B")}, r"covariates\['site'\] must hold numbers.*Leave the column out"),
    ],
)
def test_tables_that_do_not_fit_are_refused(change, text):
    with pytest.raises(InputError, match=text):
        compare_measures(**({"measures": MEASURES, "response": RESPONSE, "covariates": COVARIATES} | change))
