"""Bootstrap bands: seeds, blocks, resamples that fail, and speed."""

import time

import numpy as np
import pandas as pd
import pytest
from scipy.special import expit

from rockflex import InputError
from rockflex.fragility import bootstrap_band, fit_capacities, fit_cloud, fit_logistic, fit_outcomes

RNG = np.random.default_rng(3)
IM = np.exp(RNG.normal(-1.0, 0.8, 144))
OUTCOME = RNG.random(144) < expit(2.0 + 2.5 * np.log(IM))
Y = 0.02 * IM * np.exp(0.4 * RNG.normal(size=144))
GROUPS = np.repeat([f"record {i}" for i in range(36)], 4)
AT = [0.1, 0.4, 1.0]


def test_the_seed_decides():
    one, two, other = (bootstrap_band(fit_cloud, IM, Y, at=AT, n=50, seed=s) for s in (1, 1, 2))
    np.testing.assert_array_equal(one.low, two.low)
    assert (one.low != other.low).all()


def test_the_band_of_independent_runs_is_that_of_least_squares():
    band, fit = bootstrap_band(fit_cloud, IM, Y, at=AT, n=2000), fit_cloud(IM, Y)
    np.testing.assert_array_equal(band.estimate, fit.median(AT))
    np.testing.assert_allclose(np.log([band.low, band.high]), np.log(fit.band(AT)), atol=0.02)
    assert (band.n, band.n_failed, band.n_groups, band.note) == (2000, 0, 144, "")


def test_runs_repeated_under_a_group_add_no_knowledge():
    """Each run four times: as one block each, the band is that of the single runs."""
    single = bootstrap_band(fit_cloud, IM, Y, at=AT, n=400, seed=5)
    for spread in (np.repeat, np.tile):  # the rows of a group side by side, and far apart
        im, y, groups = (spread(column, 4) for column in (IM, Y, np.arange(144)))
        again = bootstrap_band(fit_cloud, im, y, groups, at=AT, n=400, seed=5)
        np.testing.assert_allclose([again.low, again.high], [single.low, single.high], rtol=1e-9)
    blind = bootstrap_band(fit_cloud, np.repeat(IM, 4), np.repeat(Y, 4), at=AT, n=400, seed=5)
    assert np.log(blind.high / blind.low) == pytest.approx(np.log(single.high / single.low) / 2, rel=0.25)


def test_groups_stay_together_whatever_their_type_and_order():
    shuffled = RNG.permutation(144)
    plain = bootstrap_band(fit_cloud, IM, Y, GROUPS, at=AT, n=300)
    for groups in (pd.Series(GROUPS), pd.Categorical(GROUPS), np.repeat(np.arange(36), 4)):
        np.testing.assert_array_equal(bootstrap_band(fit_cloud, IM, Y, groups, at=AT, n=300).low, plain.low)
    mixed = bootstrap_band(fit_cloud, IM[shuffled], Y[shuffled], GROUPS[shuffled], at=AT, n=300)
    np.testing.assert_allclose(np.log(mixed.low), np.log(plain.low), atol=0.05)
    assert plain.n_groups == mixed.n_groups == 36


def test_resamples_that_cannot_be_fitted_are_counted():
    outcome = np.zeros(30, dtype=bool)
    outcome[[20, 28]] = True  # (28/30)^30 = 13 % of the resamples have no event
    im = np.linspace(0.1, 1.0, 30)
    band = bootstrap_band(fit_logistic, im, outcome, at=AT, n=400)
    assert 0.08 < band.n_failed / 400 < 0.18
    assert band.n_separated > 0
    assert f"{band.n_failed} of 400 resamples could not be fitted" in band.note
    assert "outcome is False in all 30 runs" in band.note
    assert f"{band.n_separated} of 400 resamples were separated" in band.note


def test_a_thousand_resamples_take_seconds():
    start = time.perf_counter()
    band = bootstrap_band(fit_logistic, IM, OUTCOME, GROUPS, at=np.linspace(0.05, 2.0, 50))
    assert time.perf_counter() - start < 10.0
    assert ((band.low <= band.estimate) & (band.estimate <= band.high)).all()


def test_any_function_of_two_columns_serves():
    band = bootstrap_band(fit_capacities, IM, OUTCOME, at=AT, n=20)
    assert ((band.low > 0.0) & (band.high < 1.0)).all()
    table = np.column_stack((np.where(OUTCOME, 1.57, Y), OUTCOME))
    band = bootstrap_band(
        lambda im, y: fit_outcomes(im, y[:, 0], y[:, 1]),
        IM, table, GROUPS, at=AT, n=30, curve=lambda fit, at: fit.exceedance(at, 0.01),
    )  # fmt: skip
    assert (band.low < band.estimate).all()


def test_a_few_blocks_are_told():
    for count in (4, 22):
        band = bootstrap_band(fit_cloud, IM, Y, np.arange(144) % count, at=AT, n=20)
        assert f"from {count} blocks may be too narrow" in band.note


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"n": 5}, "n must be a whole number from 20 to 1000000, but 5"),
        ({"confidence": 1.0}, r"confidence must lie in \[0, 1\)"),
        ({"at": [0.0, 1.0]}, "im must be positive and finite, but 0"),
        ({"groups": [1, 2]}, "im has 144, outcome_or_response has 144, groups has 2"),
        ({"groups": np.ones(144)}, "at least two groups, but all 144 runs belong to 1"),
        ({"groups": np.where(IM > 0.5, np.nan, 1.0)}, r"groups must name the recording of every run, but \d+ names"),
        ({"outcome_or_response": np.zeros(144)}, "response must be positive"),
        ({"curve": lambda fit, at: np.where(np.array(at) > 0.2, np.nan, 1.0)}, "Only 0 of 30 .* 20 are needed.*finite"),
    ],
)
def test_arguments_out_of_range_are_refused(change, text):
    arguments = {"im": IM, "outcome_or_response": Y, "at": AT, "n": 30} | change
    with pytest.raises(InputError, match=text):
        bootstrap_band(fit_cloud, **arguments)
