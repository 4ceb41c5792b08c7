"""Peaks of oscillators against fifty digits, through the compiled module and through the same code run as Python."""

from typing import Any

import mpmath
import numpy as np
import pytest
from scipy.linalg import expm

from engine import loops_twin
from engine.as_python import as_python
from rockflex.engine import oscillator as compiled

RECORD = np.random.default_rng(8).normal(size=30)


@pytest.fixture(scope="module", params=["compiled", "Python"])
def module(request):
    if request.param == "compiled":
        return compiled
    found: Any = as_python("oscillator", instead={"loops": loops_twin})["oscillator"]
    found.Oscillator.march, found.look_together = march_one_by_one, look_everywhere
    return found


def march_one_by_one(_, a, factors, motion):
    """Samples from the two before them; peaks from all of them."""
    uu, uv, u0, u1, vu, vv, v0, v1 = factors[:8]
    for k in range(len(a) - 1):
        u, v = motion[:, k]
        motion[0, k + 1] = u + uv * v - uu * u - (u0 * a[k] + u1 * a[k + 1])
        motion[1, k + 1] = v - vv * v - vu * u - (v0 * a[k] + v1 * a[k + 1])
    factors[-2:] = np.maximum(factors[-2:], np.abs(motion).max(axis=1, initial=0.0))


def look_everywhere(a, h, factors, motion, first, last, places):
    """No sample is left out, whatever the bounds of the compiled loops."""
    places[:, 0], places[:, 1 : 1 + last - first] = last - first, np.arange(first, last)


@pytest.mark.parametrize("zeta", [0.0, 0.05, 0.9])
@pytest.mark.parametrize("x", [1e-8, 1e-3, 0.1, 0.4999, 0.5, 0.6, 3.0, 40.0])
def test_one_interval_against_fifty_digits(module, x, zeta):
    """A step has its peaks at ω_d t = π and at arctan(√(1 - ζ²)/ζ); a ramp has the velocity of a step."""
    omega, h = 2.5, x / 2.5
    step = module.peaks([1.0, 1.0], h, [omega], zeta)[0]
    ramp = module.peaks([0.0, h], h, [omega], zeta)[0]
    with mpmath.workdps(50):
        w, z, end = mpmath.mpf(omega), mpmath.mpf(zeta), mpmath.mpf(h)
        damped = w * mpmath.sqrt(1 - z * z)

        def impulse_at(t):
            return mpmath.exp(-z * w * t) * mpmath.sin(damped * t) / damped

        def step_at(t):
            return (1 - mpmath.exp(-z * w * t) * mpmath.cos(damped * t) - z * w * impulse_at(t)) / w**2

        fastest, farthest = min(end, mpmath.acos(z) / damped), min(end, mpmath.pi / damped)
        expected = [
            [float(step_at(farthest)), float(impulse_at(fastest))],
            [float((end - 2 * z * w * step_at(end) - impulse_at(end)) / w**2), float(step_at(farthest))],
        ]
    np.testing.assert_allclose([step, ramp], expected, rtol=2e-14)


def motion_between(a, h, omega, zeta, fine):
    """States at so many points in every interval, by the exponential of a matrix; shape (n - 1, fine + 1, 2)."""
    A = np.zeros((4, 4))  # of u, u', the acceleration and its slope
    A[0, 1] = A[2, 3] = 1.0
    A[1, :3] = -(omega**2), -2 * zeta * omega, -1.0
    step, steps = expm(h / fine * A), [np.eye(4)]
    for _ in range(fine):
        steps.append(step @ steps[-1])
    y, found = np.zeros(2), []
    for start, slope in zip(a[:-1], np.diff(a) / h, strict=True):
        found.append(np.array(steps)[:, :2] @ [*y, start, slope])
        y = found[-1][-1]
    return np.array(found)


@pytest.mark.parametrize("omega", [0.3, 90.0, 600.0])
@pytest.mark.parametrize("zeta", [0.0, 0.05, 0.8])
def test_peaks_are_those_of_all_points(module, omega, zeta):
    """Points between samples come as close to the peaks as their distance allows, and never above them."""
    h, fine, angles = 0.02, 500, np.radians([0.0, 50.0, 90.0, 140.0])
    pair = np.stack((RECORD, RECORD[::-1]))
    motions = [motion_between(each, h, omega, zeta, fine) for each in pair]
    found = np.array([module.peaks(each, h, [omega], zeta)[0] for each in pair])
    rotated = module.rotated_peaks(*pair, h, [omega], zeta, angles)[0]
    highest = np.array([np.abs(each).max(axis=(0, 1)) for each in motions])
    turned = np.array([np.abs(np.cos(t) * motions[0] + np.sin(t) * motions[1])[..., 0].max() for t in angles])
    missed = np.array([np.abs(np.diff(each, n=2, axis=1)).max(axis=(0, 1)) / 8 for each in motions])
    for reached, peaks, least in (
        (highest, found, found - 1.1 * missed),
        (turned, rotated, rotated - 1.1 * missed[:, 0].sum()),
    ):
        assert (reached <= peaks * (1 + 1e-11)).all()
        assert (reached >= least * (1 - 1e-11)).all()


def test_the_same_bits_however_it_is_asked(module):
    frequencies, angles = np.geomspace(0.1, 1e4, 9), np.radians([0.0, 33.0, 120.0])
    together = module.peaks(RECORD, 0.02, frequencies, 0.05)
    rotated = module.rotated_peaks(RECORD, RECORD[::-1], 0.02, frequencies, 0.05, angles)
    np.testing.assert_array_equal(module.peaks(-RECORD, 0.02, frequencies, 0.05), together)
    np.testing.assert_array_equal(
        module.rotated_peaks(-RECORD, -RECORD[::-1], 0.02, frequencies, 0.05, angles), rotated
    )
    for each, alone, directions in zip(frequencies, together, rotated, strict=True):
        assert module.peaks(RECORD, 0.02, [each], 0.05)[0].tolist() == alone.tolist()
        found = module.rotated_peaks(RECORD, RECORD[::-1], 0.02, [each], 0.05, angles)[0]
        assert found.tolist() == directions.tolist()


def test_a_direction_does_not_depend_on_the_others(module):
    angles = np.radians(np.arange(0.0, 180.0, 20.0))
    together = module.rotated_peaks(RECORD, RECORD[::-1], 0.02, [20.0], 0.05, angles)[0]
    alone = [module.rotated_peaks(RECORD, RECORD[::-1], 0.02, [20.0], 0.05, [angle])[0, 0] for angle in angles]
    np.testing.assert_allclose(alone, together, rtol=1e-15)


@pytest.mark.parametrize("size", [0, 1])
def test_a_record_without_an_interval_has_no_motion(module, size):
    assert module.peaks(np.ones(size), 0.01, [5.0], 0.05).tolist() == [[0.0, 0.0]]
    assert module.rotated_peaks(np.ones(size), np.ones(size), 0.01, [5.0], 0.05, [0.0, 1.0]).tolist() == [[0.0, 0.0]]
    assert module.peaks(np.ones(3), 0.01, [], 0.05).shape == (0, 2)


def test_records_of_different_lengths_are_refused(module):
    with pytest.raises(ValueError, match="shape"):
        module.rotated_peaks(np.ones(3), np.ones(4), 0.01, [5.0], 0.05, [0.0])


@pytest.mark.parametrize("rest", [1, 2**14 - 10, 2**14 - 1, 2**14])
def test_rest_before_a_record_changes_no_peak(rest):
    """A long record is examined in pieces; where the cut falls does not matter."""
    omegas = np.geomspace(0.01, 300.0, 11)
    record = np.concatenate(([0.0], RECORD))
    later = compiled.peaks(np.concatenate((np.zeros(rest), record)), 0.1, omegas, 0.05)
    np.testing.assert_array_equal(later, compiled.peaks(record, 0.1, omegas, 0.05))
