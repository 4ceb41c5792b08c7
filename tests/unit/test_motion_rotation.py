"""Spectra in all directions: every direction against the spectrum of the rotated record."""

import math

import numpy as np
import pytest
from scipy.signal import StateSpace, lsim

import rockflex as rf

SUITE = rf.load_suite("fema-p695-far-field")
FIRST, SECOND = SUITE["FF-1-a"], SUITE["FF-1-b"]
PERIODS = np.geomspace(0.015, 6.0, 12)


def rotated(first, second, degrees):
    angle = math.radians(degrees)
    return rf.GroundMotion(math.cos(angle) * first.acceleration + math.sin(angle) * second.acceleration, first.dt)


@pytest.mark.parametrize("zeta", [0.0, 0.05, 0.7])
def test_every_direction_is_the_spectrum_of_the_rotated_record(zeta):
    spectrum = rf.rotated_spectrum(FIRST, SECOND, PERIODS, zeta)
    for degrees in range(0, 180, 11):
        alone = rotated(FIRST, SECOND, degrees).spectrum(PERIODS, zeta).sa
        # The same recurrence, combined after instead of before: some thousand rounding errors apart.
        np.testing.assert_allclose(spectrum.sa[:, degrees], alone, rtol=1e-10)


def test_against_a_simulation_on_a_fine_grid():
    # SciPy holds the input linear between samples too; on this grid peaks between its samples do not count.
    period, zeta, fine = 0.35, 0.05, 20
    omega = 2 * math.pi / period
    system = StateSpace([[0.0, 1.0], [-(omega**2), -2 * zeta * omega]], [[0.0], [-1.0]], [[1.0, 0.0]], [[0.0]])
    dt = FIRST.dt / fine
    inputs = [motion.refined(fine).acceleration for motion in (FIRST, SECOND)]
    histories = [lsim(system, a, dt * np.arange(a.size))[1] for a in inputs]
    angles = np.radians(np.arange(180))
    peaks = [np.max(np.abs(math.cos(a) * histories[0] + math.sin(a) * histories[1])) for a in angles]
    spectrum = rf.rotated_spectrum(FIRST, SECOND, [period], zeta)
    # Between samples of the grid u falls short of its peak by at most |u''| dt²/8, about (ω dt)²/8 of it.
    np.testing.assert_allclose(spectrum.sa[0], omega**2 * np.array(peaks), rtol=1.5 * (omega * dt) ** 2 / 8)
    assert spectrum.rotd50[0] == pytest.approx(omega**2 * np.median(peaks), rel=1e-4)
    assert spectrum.rotd100[0] == pytest.approx(omega**2 * np.max(peaks), rel=1e-4)


def test_percentiles_and_components():
    spectrum = rf.rotated_spectrum(FIRST, SECOND, PERIODS)
    assert spectrum.sa.shape == (12, 180)
    np.testing.assert_array_equal(spectrum.rotd50, np.percentile(spectrum.sa, 50, axis=1))
    np.testing.assert_array_equal(spectrum.rotd(100), spectrum.rotd100)
    np.testing.assert_array_equal(spectrum.rotd(0), spectrum.sa.min(axis=1))
    both = np.sqrt(FIRST.spectrum(PERIODS).sa * SECOND.spectrum(PERIODS).sa)
    np.testing.assert_allclose(spectrum.geometric_mean, both, rtol=1e-10)
    # Boore 2010: RotD50 lies near the geometric mean, RotD100 above it and at most √2 times the larger component.
    assert (spectrum.rotd100 >= both * (1 - 1e-10)).all()
    larger = np.maximum(FIRST.spectrum(PERIODS).sa, SECOND.spectrum(PERIODS).sa)
    assert (spectrum.rotd100 <= math.sqrt(2) * larger).all()


def test_one_direction_only_is_a_cosine():
    quiet = rf.GroundMotion(np.zeros(FIRST.acceleration.size), FIRST.dt)
    spectrum = rf.rotated_spectrum(FIRST, quiet, [0.5])
    np.testing.assert_allclose(
        spectrum.sa[0], FIRST.sa(0.5) * np.abs(np.cos(np.radians(np.arange(180)))), rtol=1e-10, atol=1e-12
    )
    assert spectrum.rotd50[0] == pytest.approx(FIRST.sa(0.5) / math.sqrt(2), rel=1e-10)  # the median of |cos|


def test_rotating_the_instrument_changes_nothing():
    turned = rf.rotated_spectrum(rotated(FIRST, SECOND, 30), rotated(FIRST, SECOND, 120), PERIODS)
    spectrum = rf.rotated_spectrum(FIRST, SECOND, PERIODS)
    np.testing.assert_allclose(turned.rotd50, spectrum.rotd50, rtol=1e-10)
    np.testing.assert_allclose(turned.sa, np.roll(spectrum.sa, -30, axis=1), rtol=1e-10)


def test_period_zero_is_the_peak_ground_acceleration():
    spectrum = rf.rotated_spectrum(FIRST, SECOND, [0.0])
    assert spectrum.sa[0, 0] == FIRST.pga
    assert spectrum.sa[0, 45] == pytest.approx(rotated(FIRST, SECOND, 45).pga, rel=1e-12)


def test_zeros_are_appended_to_the_shorter_component():
    short = rf.GroundMotion(SECOND.acceleration[:500], SECOND.dt)
    padded = rf.GroundMotion(np.append(SECOND.acceleration[:500], np.zeros(FIRST.acceleration.size - 500)), SECOND.dt)
    np.testing.assert_array_equal(
        rf.rotated_spectrum(FIRST, short, [0.3]).sa, rf.rotated_spectrum(FIRST, padded, [0.3]).sa
    )


def test_a_spectrum_does_not_depend_on_what_else_is_asked():
    spectrum = rf.rotated_spectrum(FIRST, SECOND, PERIODS)
    backwards = rf.rotated_spectrum(FIRST, SECOND, PERIODS[::-1])
    np.testing.assert_array_equal(backwards.sa[::-1], spectrum.sa)
    np.testing.assert_array_equal(rf.rotated_spectrum(FIRST, SECOND, PERIODS[[3]]).sa[0], spectrum.sa[3])
    mirrored = [rf.GroundMotion(-motion.acceleration, motion.dt) for motion in (FIRST, SECOND)]
    np.testing.assert_array_equal(rf.rotated_spectrum(*mirrored, PERIODS).sa, spectrum.sa)


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        ((FIRST, SECOND.refined(2), [1.0]), r"first and second need the same time step, but 0\.01 s and 0\.005 s"),
        ((FIRST, 3, [1.0]), "second must be of type GroundMotion, but int was given"),
        ((FIRST, SECOND, [-1.0]), "periods must be zero or at least 1e-6 s"),
        ((FIRST, SECOND, [1.0], 5), r"damping_ratio must lie in \[0, 1\), but 5 was given"),
    ],
)
def test_refuses(arguments, text):
    with pytest.raises(rf.InputError, match=text):
        rf.rotated_spectrum(*arguments)


@pytest.mark.parametrize("percentile", [-1, 100.1, math.nan, "50"])
def test_refuses_percentiles(percentile):
    with pytest.raises(rf.InputError, match=r"percentile must be a number from 0 to 100, but .* RotD50 is the 50th"):
        rf.rotated_spectrum(FIRST, SECOND, [1.0]).rotd(percentile)
