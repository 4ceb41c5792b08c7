"""Conditional spectra against the multivariate normal distribution, and records chosen for their mean and spread."""

import math
import pickle
from itertools import combinations

import mpmath
import numpy as np
import pytest

import rockflex as rf
from rockflex.motion._selection import SelectionProblem, best_record_set

PERIODS = np.geomspace(0.05, 4.0, 25)
MEDIAN = 6.0 * np.exp(-0.5 * (np.log(PERIODS / 0.2) / 1.1) ** 2)
SIGMA = 0.6 + 0.03 * np.log(PERIODS / 0.05)
SUITE = rf.Suite(
    motion
    for name in ("fema-p695-far-field", "fema-p695-near-field-no-pulse", "fema-p695-near-field-pulse")
    for motion in rf.load_suite(name)
)
TARGET = rf.conditional_spectrum(PERIODS, MEDIAN, SIGMA, 1.0, epsilon=1.0)
RANGE = (0.1, 3.0)


def correlation(first, second):
    """The formulas of Baker & Jayaram in thirty digits, written out for one pair of periods."""
    low, high = sorted((mpmath.mpf(str(first)), mpmath.mpf(str(second))))
    corner = mpmath.mpf("0.109")
    c1 = 1 - mpmath.cos(mpmath.pi / 2 - mpmath.log(high / max(low, corner)) * mpmath.mpf("0.366"))
    fall = 1 - 1 / (1 + mpmath.exp(100 * high - 5))
    c2 = 1 - mpmath.mpf("0.105") * fall * (high - low) / (high - mpmath.mpf("0.0099")) if high < 0.2 else mpmath.mpf(0)
    c3 = c2 if high < corner else c1
    c4 = c1 + (mpmath.sqrt(c3) - c3) / 2 * (1 + mpmath.cos(mpmath.pi * low / corner))
    if high <= corner:
        return float(c2)
    if low > corner:
        return float(c1)
    return float(min(c2, c4) if high < 0.2 else c4)


def test_correlation_of_all_branches():
    grid = [0.01, 0.02, 0.05, 0.1, 0.108, 0.11, 0.15, 0.19, 0.21, 0.5, 1.0, 3.0, 10.0]
    with mpmath.workdps(30):
        expected = [[correlation(a, b) for b in grid] for a in grid]
    found = rf.spectral_correlation(np.array(grid)[:, None], grid)
    np.testing.assert_allclose(found, expected, rtol=1e-12)
    np.testing.assert_array_equal(np.diag(found), 1.0)
    assert np.linalg.eigvalsh(found).min() > -0.05  # nearly that of a distribution
    # By hand, above the corner: 1 - sin 0.2537 and 1 - sin 0.8427, the sines of 0.366 ln 2 and 0.366 ln 10.
    assert rf.spectral_correlation([1.0, 0.2], [2.0, 2.0]).tolist() == pytest.approx([0.7490, 0.2535], abs=1e-4)


def test_a_conditional_spectrum_is_the_conditional_normal_distribution():
    """Mean and covariance of all periods given one of them, by the matrices of the joint distribution."""
    rho = rf.spectral_correlation(PERIODS[:, None], PERIODS)
    covariance, place, level = rho * SIGMA[:, None] * SIGMA, 14, 4.0
    away = math.log(level) - math.log(MEDIAN[place])
    mean = np.log(MEDIAN) + covariance[:, place] / covariance[place, place] * away
    variance = np.diag(covariance) - covariance[:, place] ** 2 / covariance[place, place]
    found = rf.conditional_spectrum(PERIODS, MEDIAN, SIGMA, PERIODS[place], sa=level)
    np.testing.assert_allclose(found.at(PERIODS), np.exp(mean), rtol=1e-12)
    np.testing.assert_allclose(found.dispersion_at(PERIODS), np.sqrt(np.maximum(variance, 0.0)), rtol=1e-9, atol=1e-12)
    same = rf.conditional_spectrum(PERIODS, MEDIAN, SIGMA, PERIODS[place], epsilon=away / SIGMA[place])
    np.testing.assert_allclose(found.sa, same.sa, rtol=1e-12)


def test_simulated_spectra_that_have_the_ordinate_scatter_as_the_target():
    rho = rf.spectral_correlation(PERIODS[:, None], PERIODS)
    draws = np.random.default_rng(4).multivariate_normal(np.log(MEDIAN), rho * SIGMA[:, None] * SIGMA, 400_000)
    place = 14
    level = math.log(MEDIAN[place]) + 0.8 * SIGMA[place]
    near = draws[np.abs(draws[:, place] - level) < 0.01]
    found = rf.conditional_spectrum(PERIODS, MEDIAN, SIGMA, PERIODS[place], epsilon=0.8)
    error = SIGMA / math.sqrt(len(near))
    assert (np.abs(near.mean(axis=0) - np.log(found.at(PERIODS))) < 4.5 * error + 0.01).all()
    assert np.abs(near.std(axis=0) - found.dispersion_at(PERIODS)).max() < 0.03


def test_the_period_between_two_of_the_model():
    found = rf.conditional_spectrum([0.1, 1.0, 3.0], [5.0, 2.0, 0.5], [0.6, 0.6, 0.6], 0.4, sa=5.0)
    assert found.at([0.4])[0] == pytest.approx(5.0, rel=1e-14)
    assert found.dispersion_at([0.4])[0] == 0.0
    assert (found.dispersion_at([0.1, 1.0, 3.0]) > 0.0).all()


def test_a_conditional_spectrum_is_a_target_and_a_value():
    found = rf.ConditionalSpectrum([0.2, 1.0, 3.0], [6.0, 3.0, 0.9], [0.5, 0.0, 0.4], 1.0, 0.05, "site")
    assert isinstance(found, rf.TargetSpectrum)
    assert pickle.loads(pickle.dumps(found)) == found != rf.TargetSpectrum([0.2, 1.0, 3.0], [6.0, 3.0, 0.9])
    twice = found.scaled(2.0)
    assert (twice.at([1.0])[0], twice.dispersion.tolist(), twice.period) == (6.0, [0.5, 0.0, 0.4], 1.0)


def test_both_mean_and_spread_of_the_chosen_records_fit():
    chosen = SUITE.select(TARGET, 25, RANGE, per_event=4)
    np.testing.assert_allclose(chosen.at([1.0])[:, 0], TARGET.at([1.0])[0], rtol=1e-12)
    x = np.log(chosen.sa)
    misfit = np.sqrt(np.mean((x.mean(axis=0) - np.log(TARGET.at(chosen.periods))) ** 2))
    spread = np.sqrt(np.mean((x.std(axis=0, ddof=1) - TARGET.dispersion_at(chosen.periods)) ** 2))
    assert (chosen.misfit, chosen.spread_misfit) == pytest.approx((misfit, spread), rel=1e-9)
    assert max(misfit, spread) < 0.1
    assert len(set(chosen.suite.names)) == 25
    assert 0.25 <= chosen.factors.min() <= chosen.factors.max() <= 4.0
    assert chosen == SUITE.select(TARGET, 25, RANGE, per_event=4)
    # A code target of the same ordinates makes the records alike; sets drawn by chance scatter as they happen to.
    smooth = SUITE.select(rf.TargetSpectrum(TARGET.periods, TARGET.sa), 25, RANGE, record_weight=0.5)
    away = np.sqrt(np.mean((smooth.dispersion - TARGET.dispersion_at(smooth.periods)) ** 2))
    assert away > 3.0 * spread
    assert math.isnan(smooth.spread_misfit)
    assert chosen.spectra()["target_dispersion"].to_numpy() == pytest.approx(TARGET.dispersion_at(chosen.periods))


def test_the_search_against_every_set():
    rng, spread = np.random.default_rng(2), np.linspace(0.2, 0.6, 8)
    spectra = np.exp(rng.normal(0.1, 0.5, size=(13, 8)))
    choice = SelectionProblem(spectra, 0.0, (), spread)
    found = best_record_set(choice, 5)

    def cost(rows):
        x = np.log(spectra[list(rows)])
        return np.mean(x.mean(axis=0) ** 2 + (x.std(axis=0, ddof=1) - spread) ** 2)

    assert choice.objective_of(found) == pytest.approx(cost(found), rel=1e-12)
    assert cost(found) == pytest.approx(min(map(cost, combinations(range(13), 5))), rel=1e-12)


def test_a_large_set_recovers_the_distribution_it_is_drawn_for():
    """From spectra of far more scatter, forty are found whose mean and spread are those asked for, to two per cent."""
    rng, rho = np.random.default_rng(5), rf.spectral_correlation(PERIODS[:, None], PERIODS)
    factor = np.linalg.cholesky(rho + 1e-9 * np.eye(PERIODS.size))
    spectra = np.exp(0.3 + 0.9 * rng.normal(size=(400, PERIODS.size)) @ factor.T)
    spread = np.full(PERIODS.size, 0.5)
    x = np.log(spectra[best_record_set(SelectionProblem(spectra, 0.0, (), spread), 40)])
    assert np.sqrt(np.mean(x.mean(axis=0) ** 2)) < 0.02
    assert np.sqrt(np.mean((x.std(axis=0, ddof=1) - spread) ** 2)) < 0.02


@pytest.mark.parametrize(
    ("change", "field", "text"),
    [
        ({"n": 1}, "n", "at least 2 for a conditional spectrum"),
        ({"record_weight": 0.5}, "record_weight", "for targets of codes"),
        ({"least_ratio": 0.9}, "least_ratio", "for targets of codes"),
        ({"scale_limits": (1.0, 1.001)}, "n", r"only \d+ of 100 reach S_a\(1 s\) = "),
    ],
)
def test_a_choice_that_has_no_meaning_is_refused(change, field, text):
    given = {"n": 10, "periods": RANGE} | change
    with pytest.raises(rf.InputError, match=text) as caught:
        SUITE.select(TARGET, **given)
    assert caught.value.field == field


@pytest.mark.parametrize(
    ("change", "field", "text"),
    [
        ({"sa": 3.0}, "sa", "Give sa, in m/s², or epsilon"),
        ({"epsilon": None}, "sa", "Give sa, in m/s², or epsilon"),
        ({"period": 9.0}, "periods", "include period"),
        ({"periods": [0.0, 1.0, 2.0]}, "periods", "ground acceleration at 0.01 s"),
        ({"median": [1.0, -1.0, 1.0]}, "median", "median must be positive"),
        ({"dispersion": [0.5, 0.5]}, "dispersion", "3 standard deviations"),
        ({"dispersion": [0.5, -0.5, 0.5]}, "dispersion", "none negative"),
    ],
)
def test_a_model_that_is_wrong_is_refused(change, field, text):
    given = {"periods": [0.2, 1.0, 2.0], "median": [5.0, 2.0, 1.0], "dispersion": [0.6] * 3, "period": 1.0}
    with pytest.raises(rf.InputError, match=text) as caught:
        rf.conditional_spectrum(**(given | {"epsilon": 1.0} | change))
    assert caught.value.field == field


def test_a_model_from_a_file(tmp_path):
    rows = zip(PERIODS, MEDIAN / 9.81, SIGMA, strict=True)
    text = "".join(f"{t!r};{m!r};{s!r}\n" for t, m, s in (map(float, row) for row in rows))
    file = tmp_path / "model.csv"
    file.write_text(f"period (s);median (g);sigma\n{text}", "utf-8")
    found = rf.read_conditional_spectrum(file, 1.0, epsilon=1.0)
    assert found.name == "model"
    np.testing.assert_allclose(found.sa, TARGET.sa, rtol=1e-12)
    np.testing.assert_allclose(found.dispersion, TARGET.dispersion, rtol=1e-12, atol=1e-15)
    # Frequencies, from the last row to the first.
    rows = zip(1.0 / PERIODS, MEDIAN, SIGMA, strict=True)
    backwards = "".join(f"{f!r};{m!r};{s!r}\n" for f, m, s in (map(float, row) for row in rows))
    file.write_text(f"frequency (Hz);Sa (m/s2);dispersion\n{backwards}", "utf-8")
    found = rf.read_conditional_spectrum(file, 1.0, epsilon=1.0)
    np.testing.assert_allclose(found.at(PERIODS[1:-1]), TARGET.at(PERIODS[1:-1]), rtol=1e-9)
    with pytest.raises(rf.InputError, match="epsilon must be") as caught:
        rf.read_conditional_spectrum(file, 1.0, epsilon=math.inf)
    assert caught.value.field == "epsilon"
    file.write_text("period (s);median (g)\n0.1;1\n1;2\n", "utf-8")
    with pytest.raises(rf.InputError, match=r"model.csv: one label must name the standard deviation"):
        rf.read_conditional_spectrum(file, 1.0, epsilon=1.0)


@pytest.mark.parametrize("first", [0.0, 11.0, math.nan])
def test_periods_beyond_the_correlation_are_refused(first):
    with pytest.raises(rf.InputError, match=r"first must be periods from 0.01 to 10 s") as caught:
        rf.spectral_correlation([first], [1.0])
    assert caught.value.field == "first"
