"""Filtered incremental velocity, an intensity measure of long pulses and of pulses in a row."""

import math

import numpy as np

from rockflex.engine.oscillator import states
from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_positive
from rockflex.motion._signal import refine_samples, velocity_from_acceleration

BUTTERWORTH = math.sqrt(0.5)  # damping ratio of an oscillator that filters like a Butterworth low-pass of order two
N_SUMMED = 3  # peaks
PER_PERIOD, MAX_PARTS = 20, 20  # points in a period, for peaks to about 1e-5; parts of an interval between samples
FLAT = 1e-10  # of the largest derivative: less is rounding


def filtered_incremental_velocity(
    acceleration: Array, dt: float, period: float, alpha: float = 0.7, beta: float = 0.85
) -> float:
    """Return FIV3 in m/s; see `GroundMotion.fiv3`.

    The filter is an oscillator: with u'' + 2ζω u' + ω² u = -a the filtered acceleration is -ω² u, and its integral
    ∫a dt + u' + 2ζω u, both of which are exact for an acceleration that is linear between samples. Peaks between points
    are those of a cubic.
    """
    t, share = checked_positive("period", period, "s"), checked_positive("alpha", alpha, "")
    cut = checked_positive("beta", beta, "")
    omega, window = 2.0 * math.pi * cut / t, share * t
    parts = max(1, min(MAX_PARTS, math.ceil(PER_PERIOD * dt / t)))
    dt, samples = dt / parts, refine_samples(acceleration, parts)
    whole = math.ceil(window / dt) - 1  # the window ends inside an interval or at its end
    a = np.concatenate((samples, np.zeros(whole + 2)))
    inside = window - whole * dt
    u, v, u_after, v_after = states(a, dt, omega, BUTTERWORTH, inside)
    ground, slope = velocity_from_acceleration(a, dt)[:-1], np.diff(a) / dt
    ground_after = ground + inside * (a[:-1] + 0.5 * inside * slope)
    drag, n = 2.0 * BUTTERWORTH * omega, samples.size
    gained = (ground_after + v_after + drag * u_after)[whole : whole + n] - (ground + v + drag * u)[:n]
    rate = omega**2 * (u[:n] - u_after[whole : whole + n])
    return max(_sum_of_highest(gained, rate, dt), _sum_of_highest(-gained, -rate, dt))


def _sum_of_highest(values: Array, rates: Array, dt: float) -> float:
    """Sum of the highest positive peaks of a curve, ends included, from its values and derivatives at samples.

    Between samples it is the cubic of both, at the zero of the line between the derivatives. Where it is flat but for
    rounding, as while a window holds all of a pulse, it has one peak.
    """
    moving = np.flatnonzero(np.abs(rates) > FLAT * np.max(np.abs(rates)))
    if not moving.size:
        return 0.0
    turns = np.flatnonzero((rates[moving[:-1]] > 0.0) & (rates[moving[1:]] < 0.0))
    before, after = moving[turns], moving[turns + 1]
    first, last = rates[before] * dt, rates[after] * dt
    x = np.where(after == before + 1, first / (first - last), 1.0)
    rise = values[before + 1] - values[before]
    last = rates[before + 1] * dt
    inside = values[before] + x * (first + x * (3.0 * rise - 2.0 * first - last + x * (first + last - 2.0 * rise)))
    ends = values[[0, -1]][[rates[moving[0]] < 0.0, rates[moving[-1]] > 0.0]]
    peaks = np.maximum(np.concatenate((inside, ends)), 0.0)
    return float(np.sort(peaks)[-N_SUMMED:].sum())
