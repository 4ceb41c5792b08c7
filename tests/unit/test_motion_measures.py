import math

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss
from scipy.interpolate import PPoly
from scipy.optimize import brentq

from rockflex._constants import GRAVITY
from rockflex._errors import InputError
from rockflex.motion import GroundMotion, quiet_motion

RECORDS = [GroundMotion(np.random.default_rng(seed).normal(size=n), dt) for seed, n, dt in [(1, 40, 0.3), (2, 7, 0.02)]]


def polynomial(motion):
    """Acceleration as SciPy's piecewise polynomial: integrals and roots by independent code."""
    a = motion.acceleration
    return PPoly(np.array([np.diff(a) / motion.dt, a[:-1]]), motion.time, extrapolate=False)


def largest(function, motion):
    stops = np.concatenate((motion.time, function.derivative().roots(discontinuity=False)))
    return np.nanmax(np.abs(function(stops)))


@pytest.mark.parametrize("motion", RECORDS)
def test_integrals_and_their_peaks(motion):
    velocity = polynomial(motion).antiderivative()
    displacement = velocity.antiderivative()
    assert motion.velocity == pytest.approx(velocity(motion.time), rel=1e-12, abs=1e-14)
    assert motion.displacement == pytest.approx(displacement(motion.time), rel=1e-12, abs=1e-14)
    assert motion.pgv == pytest.approx(largest(velocity, motion), rel=1e-13)
    assert motion.pgd == pytest.approx(largest(displacement, motion), rel=1e-13)
    assert motion.pgv > np.max(np.abs(motion.velocity))


def test_peaks_hidden_between_samples():
    # v = t - t² returns to zero at the second sample.
    swing = GroundMotion([1.0, -1.0, 1.0], 1.0)
    assert np.max(np.abs(swing.velocity)) < 1e-15
    assert swing.pgv == pytest.approx(0.25)
    # v = t - 1.05 t² passes through zero at t = 1/1.05, just before the second sample.
    turn = GroundMotion([1.0, -1.1, 1.2], 1.0)
    assert turn.pgd == pytest.approx(1 / (6 * 1.05**2))
    assert turn.pgd > 1.007 * np.max(np.abs(turn.displacement))


@pytest.mark.parametrize("motion", RECORDS)
def test_arias_and_cav(motion):
    a = polynomial(motion)
    nodes, weights = leggauss(2)  # exact for cubics
    t = motion.time[:-1, None] + motion.dt * (nodes + 1) / 2
    energy = np.sum(a(t) ** 2 * weights) * motion.dt / 2
    assert motion.arias == pytest.approx(math.pi / (2 * GRAVITY) * energy, rel=1e-13)
    v = a.antiderivative()
    stops = np.sort(np.concatenate((motion.time, a.roots(discontinuity=False))))
    assert motion.cav == pytest.approx(np.nansum(np.abs(np.diff(v(stops)))), rel=1e-12)


@pytest.mark.parametrize("motion", RECORDS)
@pytest.mark.parametrize(("low", "high"), [(0.05, 0.95), (0.2, 0.21), (0.0, 1.0), (0.0, 0.75)])
def test_significant_duration(motion, low, high):
    a = polynomial(motion)
    nodes, weights = leggauss(2)

    def energy(t):
        stops = np.append(motion.time[motion.time < t], t)
        left, width = stops[:-1, None], np.diff(stops)[:, None]
        return float(np.sum(a(left + width * (nodes + 1) / 2) ** 2 * weights * width / 2))

    total = energy(motion.duration)
    ends = [
        motion.duration * x if x in (0, 1) else brentq(lambda t, x=x: energy(t) - x * total, 0, motion.duration)
        for x in (low, high)
    ]
    assert motion.significant_duration(low, high) == pytest.approx(ends[1] - ends[0], abs=1e-10)


def test_significant_duration_of_simple_shapes():
    assert GroundMotion(np.ones(11), 0.1).d5_95 == pytest.approx(0.9)
    # ∫t² dt grows like t³.
    ramp = GroundMotion(np.linspace(0, 1, 11), 0.1)
    assert ramp.significant_duration(0.125, 0.512) == pytest.approx(0.3)
    assert quiet_motion(1.0).d5_95 == 0.0


@pytest.mark.parametrize(("low", "high"), [(0.9, 0.1), (-0.1, 0.5), (0.5, 0.5), (0.5, 1.1), (math.nan, 1)])
def test_significant_duration_refuses(low, high):
    with pytest.raises(InputError, match="fractions with 0 <= low < high <= 1"):
        RECORDS[0].significant_duration(low, high)


def test_simple_closed_forms():
    motion = GroundMotion([0.0, 2.0, 0.0], 0.5)
    assert motion.velocity.tolist() == [0.0, 0.5, 1.0]
    assert motion.pgv == motion.cav == pytest.approx(1.0)
    assert motion.arias == pytest.approx(math.pi / (2 * GRAVITY) * 4 / 3)
    # Equal and opposite values: two triangles, and no net velocity.
    swing = GroundMotion([1.0, -1.0, 1.0], 1.0)
    assert swing.cav == pytest.approx(1.0)
    assert swing.velocity == pytest.approx([0.0, 0.0, 0.0])
    assert swing.pgv == pytest.approx(0.25)


def test_quiet_motion_has_no_measure():
    quiet = quiet_motion(1.0)
    assert (quiet.pga, quiet.pgv, quiet.pgd, quiet.arias, quiet.cav) == (0, 0, 0, 0, 0)
