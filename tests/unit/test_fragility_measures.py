"""The table of intensity measures against single fits, statsmodels, and what was built into the data."""

import math

import numpy as np
import pandas as pd
import pytest
import statsmodels.api as sm

from rockflex import InputError
from rockflex.fragility import compare_measures, fit_cloud

RNG = np.random.default_rng(2)
N = 200
PGV = np.exp(RNG.normal(-1.0, 0.7, N))
MAGNITUDE = RNG.normal(7.0, 0.4, N)
MEASURES = pd.DataFrame(
    {"PGA": PGV * np.exp(0.6 * RNG.normal(size=N)), "PGV": PGV, "other": np.exp(RNG.normal(size=N))}
)
RESPONSE = 0.02 * PGV**1.2 * np.exp(0.3 * RNG.normal(size=N))
COVARIATES = pd.DataFrame({"magnitude": MAGNITUDE, "log_distance": RNG.normal(3.0, 0.5, N), "scale": 1.0})


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
