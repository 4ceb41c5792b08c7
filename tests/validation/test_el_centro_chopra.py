"""El Centro, north-south, against numbers printed in Chopra, *Dynamics of Structures*, Chapter 6."""

import numpy as np
import pytest
from scipy.linalg import expm

from rockflex.foundation.constants import GRAVITY
from rockflex.motion import load_suite

INCH = 0.0254
RECORD = load_suite("el-centro-1940")["EL-CENTRO-1940-NS"]


def sampled_peak(period, zeta):
    """Largest displacement at the samples alone, by the matrix exponential of oscillator and forcing."""
    omega, dt = 2 * np.pi / period, RECORD.dt
    system = np.zeros((4, 4))
    system[0, 1], system[1], system[2, 3] = 1, (-(omega**2), -2 * zeta * omega, -1, 0), 1
    step, state, peak = expm(system * dt), np.zeros(4), 0.0
    for left, right in zip(RECORD.acceleration[:-1], RECORD.acceleration[1:], strict=True):
        state[2:] = left, (right - left) / dt
        state = step @ state
        peak = max(peak, abs(state[0]))
    return peak


def test_the_record():
    assert (RECORD.acceleration.size, RECORD.dt) == (1560, 0.02)
    assert RECORD.duration == pytest.approx(31.18)
    assert RECORD.pga / GRAVITY == pytest.approx(0.31882, rel=1e-14)
    assert RECORD.metadata.year == 1940


@pytest.mark.parametrize(("period", "printed"), [(0.5, 2.67), (1.0, 5.97), (2.0, 7.47)])
def test_deformation_response(period, printed):
    # Section 6.4, ζ = 2 %, in inches: peaks at the samples, which miss up to (ω dt/2)²/2 of the true ones.
    sampled = sampled_peak(period, 0.02)
    assert sampled / INCH == pytest.approx(printed, abs=0.011)
    true = RECORD.sd(period, 0.02)
    assert sampled <= true <= sampled * (1 + 1.05 * (np.pi / period * RECORD.dt) ** 2 / 2)


@pytest.mark.parametrize(("period", "printed"), [(0.5, 1.09), (1.0, 0.610), (2.0, 0.191)])
def test_pseudo_acceleration(period, printed):
    # Section 6.6, ζ = 2 %, in units of g.
    assert RECORD.sa(period, 0.02) / GRAVITY == pytest.approx(printed, rel=0.01)


@pytest.mark.parametrize("period", [0.05, 0.3, 1.0, 3.0])
def test_fine_sampling_approaches_the_spectrum_from_below(period):
    fine = RECORD.refined(10)
    omega, zeta = 2 * np.pi / period, 0.05
    system = np.zeros((4, 4))
    system[0, 1], system[1], system[2, 3] = 1, (-(omega**2), -2 * zeta * omega, -1, 0), 1
    step = expm(system * fine.dt)
    state, peaks = np.zeros(4), np.zeros(2)
    for left, right in zip(fine.acceleration[:-1], fine.acceleration[1:], strict=True):
        state[2:] = left, (right - left) / fine.dt
        state = step @ state
        peaks = np.maximum(peaks, np.abs(state[:2]))
    spectrum = RECORD.spectrum([period], zeta)
    assert peaks[0] * (1 - 1e-12) <= spectrum.sd[0] <= peaks[0] * (1 + (omega * fine.dt) ** 2 / 4)
    # The velocity bends with the slope of the ground acceleration as well.
    slope = np.max(np.abs(np.diff(RECORD.acceleration))) / RECORD.dt
    bend = slope + 3 * omega * (RECORD.pga + omega * peaks[1])
    assert peaks[1] * (1 - 1e-12) <= spectrum.sv[0] <= peaks[1] + bend * fine.dt**2 / 8
