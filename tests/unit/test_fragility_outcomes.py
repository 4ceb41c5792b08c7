"""Three outcomes: their parts against single fits, the total probability, and groups that are empty or small."""

import math
import pickle

import numpy as np
import pytest
from scipy.special import expit

from rockflex import InputError
from rockflex.fragility import UnanimousOutcome, fit_cloud, fit_logistic, fit_outcomes

RNG = np.random.default_rng(5)
N = 300
IM = np.exp(RNG.normal(-1.0, 0.8, N))
FALLS = RNG.random(N) < expit(-1.0 + 3.0 * np.log(IM))
ROCKS = FALLS | (RNG.random(N) < expit(4.0 + 3.0 * np.log(IM)))
ROTATION = np.where(FALLS, math.pi / 2, np.where(ROCKS, 0.01 * IM * np.exp(0.4 * RNG.normal(size=N)) + 1e-4, 2e-5))
AT = np.array([0.05, 0.3, 1.0, 3.0])


def test_every_part_is_the_fit_of_its_group():
    fit = fit_outcomes(IM, ROTATION, FALLS)
    stands, rocked = ~FALLS, ROCKS & ~FALLS
    assert fit.overturning.b1 == fit_logistic(IM, FALLS).b1
    assert fit.rocking.b1 == fit_logistic(IM[stands], ROCKS[stands]).b1
    assert fit.initiation.b1 == fit_logistic(IM, ROCKS).b1
    assert fit.rotation.c2 == fit_cloud(IM[rocked], ROTATION[rocked]).c2
    assert (fit.n_no_rocking, fit.n_rocking, fit.n_overturned) == ((~ROCKS).sum(), rocked.sum(), FALLS.sum())
    assert fit.highest_limit == math.pi / 2
    assert fit.notes == ()


def test_probabilities_sum_to_one_and_none_is_negative():
    grid = np.geomspace(1e-6, 1e6, 500)
    parts = fit_outcomes(IM, ROTATION, FALLS).probabilities(grid)
    np.testing.assert_allclose(sum(parts), 1.0, atol=1e-15)
    assert min(part.min() for part in parts) >= 0.0
    assert parts.overturning[-1] == pytest.approx(1.0)
    assert parts.no_rocking[0] == pytest.approx(1.0)


def test_exceedance_is_the_total_probability():
    fit = fit_outcomes(IM, ROTATION, FALLS)
    falls, rocks = fit.overturning.probability(AT), fit.rocking.probability(AT)
    expected = falls + (1 - falls) * rocks * fit.rotation.exceedance(AT, 0.01)
    np.testing.assert_allclose(fit.exceedance(AT, 0.01), expected, rtol=1e-13)
    table = fit.exceedance(AT[:, None], [0.001, 0.01, 0.1])
    assert table.shape == (4, 3)
    assert (np.diff(table, axis=1) < 0.0).all()
    assert (table >= falls[:, None]).all()
    assert 0.0 < fit.exceedance(0.3, 0.01) < 1.0


def test_exceedance_follows_the_fractions_of_the_runs():
    fit = fit_outcomes(IM, ROTATION, FALLS)
    for limit in (0.002, 0.01):
        assert fit.exceedance(IM, limit).mean() == pytest.approx((limit < ROTATION).mean(), abs=0.02)


def test_no_overturning_at_all_leaves_a_one_sided_bound():
    stands = ~FALLS
    fit = fit_outcomes(IM[stands], ROTATION[stands], FALLS[stands])
    n = int(stands.sum())
    assert fit.overturning == UnanimousOutcome(False, n)
    assert fit.overturning.bound(0.95) == pytest.approx(1 - 0.05 ** (1 / n))
    np.testing.assert_array_equal(fit.probabilities(AT).overturning, 0.0)
    low, high = fit.overturning.band(AT, 0.95)
    assert (low == 0.0).all()
    assert (high == fit.overturning.bound(0.95)).all()
    assert any(note.startswith(f"overturning: none of {n} runs. This gives only a bound") for note in fit.notes)
    assert np.isfinite(fit.exceedance(AT, 0.01)).all()


def test_overturning_of_every_run_needs_no_other_fit():
    fit = fit_outcomes(IM, np.full(N, math.pi / 2), np.ones(N, dtype=bool))
    np.testing.assert_array_equal(fit.probabilities(AT), [np.zeros(4), np.zeros(4), np.ones(4)])
    np.testing.assert_array_equal(fit.exceedance(AT, 0.01), 1.0)
    assert fit.overturning.band(AT, 0.95)[0][0] == pytest.approx(0.05 ** (1 / N))
    assert "rocking: all runs overturned, so there is nothing to fit." in fit.notes


def test_no_rocking_at_all_exceeds_nothing():
    fit = fit_outcomes(IM, np.zeros(N), np.zeros(N, dtype=bool))
    np.testing.assert_array_equal(fit.probabilities(AT), [np.ones(4), np.zeros(4), np.zeros(4)])
    np.testing.assert_array_equal(fit.exceedance(AT, 0.01), 0.0)
    assert fit.rotation is None


def test_two_rocking_runs_are_told_and_give_nan_where_they_count():
    rotation = np.zeros(40)
    rotation[[38, 39]] = 0.01, 0.02
    fit = fit_outcomes(np.linspace(0.1, 2.0, 40), rotation, np.zeros(40))
    assert np.isnan(fit.exceedance(1.0, 0.01))
    assert sum(fit.probabilities(1.0)) == pytest.approx(1.0)
    assert any("Only 2 of 40 runs rock without overturning" in note for note in fit.notes)
    assert any(note.startswith("rotation: A cloud needs at least 3 runs") for note in fit.notes)
    assert any(note.startswith("rocking: Separated between") for note in fit.notes)
    kinds = [note.kind for note in fit.notes]
    assert set(kinds) == {"runs", "overturning", "rocking", "initiation", "rotation"}
    assert all(kind == "runs" or note.startswith(f"{kind}: ") for kind, note in zip(kinds, fit.notes, strict=True))
    assert [note.kind for note in pickle.loads(pickle.dumps(fit)).notes] == kinds


def test_standing_runs_of_one_measure_leave_their_part_out():
    im, falls = np.array([0.2, 0.2, 0.2, 0.2, 0.5]), np.array([0, 0, 0, 0, 1])
    fit = fit_outcomes(im, [0.0, 0.01, 0.0, 0.02, 1.57], falls)
    assert fit.rocking is None
    assert any(note.startswith("rocking: im must hold at least two different values") for note in fit.notes)
    assert np.isnan(fit.exceedance(0.2, 0.001))
    assert fit.probabilities(0.2).overturning == fit.overturning.probability(0.2)


def test_limits_reach_up_to_the_nominal_definition_of_overturning():
    rotation = np.where(FALLS, 0.08 + 0.1 * IM, ROTATION)
    fit = fit_outcomes(IM, rotation, FALLS)
    assert fit.highest_limit == rotation[FALLS].min()
    fit.exceedance(AT, 0.08)
    text = r"limit must lie in \[0\.0001, 0\..*\) rad, but {} was given\. Below, .*; above, an overturned"
    for limit in (0.5, 5e-5):
        with pytest.raises(InputError, match=text.format(limit)):
            fit.exceedance(AT, limit)
    assert fit.exceedance(1.0, 1e-4) <= fit.probabilities(1.0).rocking + fit.probabilities(1.0).overturning


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"rotation": -ROTATION}, r"rotation must be zero or positive, but 300 of 300 .* row 0\. .*magnitude"),
        ({"rotation": ROTATION[:5]}, "im has 300, rotation has 5, overturned has 300"),
        ({"rotation": np.zeros(N)}, r"\d+ overturned runs have a rotation of at most the threshold 0.0001 rad"),
        ({"overturned": ROTATION}, "overturned must hold True or False .*overturned > limit"),
        ({"im": np.ones(N)}, "im must hold at least two different values"),
    ],
)
def test_columns_that_contradict_each_other_are_refused(change, text):
    with pytest.raises(InputError, match=text):
        fit_outcomes(**({"im": IM, "rotation": ROTATION, "overturned": FALLS} | change))


def test_rotations_without_uplift_are_no_rocking():
    lifts = FALLS | (ROCKS & (ROTATION > 0.003))
    fit = fit_outcomes(IM, ROTATION, FALLS, uplifted=lifts)
    stands = ~FALLS
    assert (fit.n_no_rocking, fit.n_rocking) == ((~lifts).sum(), (lifts & stands).sum())
    assert fit.initiation.b1 == fit_logistic(IM, lifts).b1
    assert fit.rotation.c2 == fit_cloud(IM[lifts & stands], ROTATION[lifts & stands]).c2
    # A limit that runs without uplift exceed too is none of the rocking runs alone.
    assert fit.lowest_limit == ROTATION[~lifts].max()
    assert np.isfinite(fit.exceedance(AT, 0.01)).all()
    with pytest.raises(InputError, match=r"limit must lie in \[0\.00.*fit_outcomes without uplifted"):
        fit.exceedance(AT, 0.002)
    with pytest.raises(InputError, match="uplifted has 5"):
        fit_outcomes(IM, ROTATION, FALLS, uplifted=lifts[:5])
