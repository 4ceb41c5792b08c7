"""Where scatter comes from, how rare an event is, and whether two distributions agree: against closed forms."""

import math
from statistics import NormalDist

import numpy as np
import pytest
from scipy import stats

import rockflex as rf


@pytest.mark.parametrize("beta", [2.0, 3.5, 4.7534])  # P of 0.023, 2.3e-4, 1e-6
def test_subset_simulation_of_a_plane(beta):
    found = [
        rf.subset_simulation(lambda u: u.sum(axis=1) / math.sqrt(10.0), 10, beta, n=500, seed=seed)
        for seed in range(30)
    ]
    exact = NormalDist().cdf(-beta)
    estimates = np.array([each.probability for each in found])
    spread = estimates.std(ddof=1) / exact
    assert abs(estimates.mean() / exact - 1.0) < 3.0 * spread / math.sqrt(30)
    stated = np.mean([each.variation for each in found])
    assert 0.5 * spread < stated < 1.6 * spread
    assert np.prod(found[0].shares) == pytest.approx(found[0].probability, rel=1e-12)
    assert found[0].levels[-1] == beta


def test_subset_simulation_of_overturning_as_plain_sampling():
    block = rf.rigid_block(slenderness=0.25, half_diagonal=3.0)

    def rotations(u):  # two pulses, whose sizes are random
        found = []
        wave = np.sin(2.0 * math.pi * np.arange(0.0, 1.0, 0.02))
        for first, second in 3.5 * np.exp(0.25 * u):
            pulse = rf.GroundMotion(np.concatenate((first * wave, np.zeros(20), second * wave)), 0.02)
            found.append(rf.simulate(block, pulse, "rigid", output="peaks", free_vibration=2.0).max_rotation)
        return np.array(found)

    expected, error = 80 / 8000, math.sqrt(80) / 8000  # of as many runs, drawn with the seed 5
    found = [rf.subset_simulation(rotations, 2, 0.5661617198254562, n=200, seed=seed) for seed in range(4)]
    estimates = np.array([each.probability for each in found])
    assert abs(estimates.mean() - expected) < 3.0 * math.hypot(error, estimates.std(ddof=1) / 2.0)


def test_what_is_never_exceeded_is_told():
    with pytest.raises(rf.SolverError, match="not reached"):
        rf.subset_simulation(lambda u: np.tanh(u[:, 0]), 1, 2.0, n=100)


@pytest.mark.parametrize(
    ("changes", "field"),
    [({"share": 0.3}, "share"), ({"n": 105}, "share"), ({"demand": lambda u: u}, "demand"), ({"n": 3}, "n")],
)
def test_impossible_subsets_are_told(changes, field):
    given = {"demand": lambda u: u[:, 0], "n_variables": 2, "threshold": 2.0, "n": 100} | changes
    with pytest.raises(rf.InputError) as caught:
        rf.subset_simulation(given.pop("demand"), given.pop("n_variables"), given.pop("threshold"), **given)
    assert caught.value.field == field


def test_shares_of_a_known_variance():
    rng, found = np.random.default_rng(2), []
    for _ in range(30):
        records, structures = rng.normal(0.0, 0.6, 40), rng.normal(0.0, 0.3, 20)
        y = records[:, None] + structures + rng.normal(0.0, 0.2, (40, 20))
        names = np.array([f"r{k}" for k in range(40)])
        labels = {"records": np.repeat(names, 20), "structure": np.tile(np.arange(20), 40)}
        found.append(rf.variance_shares(y.ravel(), labels)["variance"].to_numpy())
    variances = np.mean(found, axis=0)
    assert variances[:2] == pytest.approx([0.36, 0.09], rel=0.15)
    assert variances[2] == pytest.approx(0.04, rel=0.3)


def test_shares_as_sobol_indices_of_scipy():
    def function(x):  # (3, n): Ishigami
        return np.sin(x[0]) + 7.0 * np.sin(x[1]) ** 2 + 0.1 * x[2] ** 4 * np.sin(x[0])

    spread = [stats.uniform(-math.pi, 2.0 * math.pi)] * 3
    sobol = stats.sobol_indices(func=function, n=4096, dists=spread, rng=np.random.default_rng(0))
    rng = np.random.default_rng(1)
    x = rng.uniform(-math.pi, math.pi, (3, 30_000))
    bins = {f"x{k}": np.floor(x[k] / 0.15) for k in range(3)}
    shares = rf.variance_shares(function(x), bins)["share"].to_numpy()[:3]
    assert shares == pytest.approx(sobol.first_order, abs=0.02)


@pytest.mark.parametrize(
    ("values", "sources"),
    [([1.0, 1.0, 1.0], {"a": [0, 0, 1]}), ([1.0, 2.0, 3.0], {"a": [0, 1, 2]}), ([1.0, 2.0, 3.0], {}),
     ([1.0, 2.0, np.nan], {"a": [0, 0, 1]}), ([1.0, 2.0, 3.0], {"a": [0, 1]})],
)  # fmt: skip
def test_impossible_shares_are_told(values, sources):
    with pytest.raises(rf.InputError):
        rf.variance_shares(values, sources)


def test_equal_distributions_are_seldom_told_apart():
    rng, differs, covered = np.random.default_rng(8), 0, 0
    for seed in range(60):
        measured, computed = rng.lognormal(-4.0, 0.6, 60), rng.lognormal(-4.0, 0.6, 90)
        found = rf.compare_distributions(measured, computed, n_resamples=200, seed=seed)
        differs += found.p_value < 0.1
        covered += found.median_band[0] <= 1.0 <= found.median_band[1]
    assert differs < 14
    assert covered > 46


def test_other_medians_and_dispersions_are_found():
    rng = np.random.default_rng(9)
    measured, computed = rng.lognormal(-4.0, 0.4, 400), rng.lognormal(-4.0 + math.log(1.4), 0.8, 400)
    found = rf.compare_distributions(measured, np.append(computed, [np.inf] * 40))
    assert found.p_value < 1e-6
    assert found.median_band[0] < found.median_ratio < found.median_band[1]
    assert found.dispersion_ratio == pytest.approx(2.0, rel=0.15)
    assert found.overturned == (0.0, pytest.approx(40 / 440))


@pytest.mark.parametrize("measured", [[0.1] * 4, [0.1, -1.0, 0.2, 0.3, 0.4], [np.inf] * 6, ["a"] * 6])
def test_impossible_samples_are_told(measured):
    with pytest.raises(rf.InputError) as caught:
        rf.compare_distributions(measured, [0.1, 0.2, 0.3, 0.4, 0.5])
    assert caught.value.field == "measured"
