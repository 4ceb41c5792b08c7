"""Peaks of an oscillator in every horizontal direction, from one pass over both components."""

import math

from rockflex._arrays import Array
from rockflex._kernel import kernel, python_kernel
from rockflex.motion._spectrum_kernel import peaks_inside, unit_responses

COARSE = 256  # samples from which the first estimate of the peaks is taken


@kernel
def _smallest(values: Array) -> float:
    least = values[0]
    for value in values:
        least = min(least, value)
    return least


@kernel
def _curvature(omega: float, zeta: float, u: float, v: float, a: float, slope: float) -> float:
    """Bound of the relative acceleration until the next sample, where it is a free vibration."""
    w = -a - 2 * zeta * omega * v - omega * omega * u
    q = (-slope - zeta * omega * w - omega * omega * v) / (omega * math.sqrt(1 - zeta * zeta))
    return math.hypot(w, q)


@kernel
def _march(first: Array, second: Array, dt: float, omega: float, zeta: float, states: Array) -> None:
    """Fill u, v of both components at the samples, and how far out the oscillator can be until the next one."""
    rate, impulse, step, ramp = unit_responses(omega, zeta, dt)
    keep = rate + 2 * zeta * omega * impulse
    u1, v1, u2, v2 = 0.0, 0.0, 0.0, 0.0
    last = first.size - 1
    for k in range(last + 1):
        states[0, k], states[1, k], states[2, k], states[3, k] = u1, v1, u2, v2
        states[4, k] = math.hypot(u1, u2)
        if k == last:
            break
        a1, a2 = first[k], second[k]
        slope1, slope2 = (first[k + 1] - a1) / dt, (second[k + 1] - a2) / dt
        bend1 = _curvature(omega, zeta, u1, v1, a1, slope1)
        bend2 = _curvature(omega, zeta, u2, v2, a2, slope2)
        u1, v1 = (
            keep * u1 + impulse * v1 - a1 * step - slope1 * ramp,
            rate * v1 - omega * omega * impulse * u1 - a1 * impulse - slope1 * step,
        )
        u2, v2 = (
            keep * u2 + impulse * v2 - a2 * step - slope2 * ramp,
            rate * v2 - omega * omega * impulse * u2 - a2 * impulse - slope2 * step,
        )
        # Between two samples u departs from the chord by at most max|u''| dt²/8.
        states[4, k] = max(states[4, k], math.hypot(u1, u2)) + math.hypot(bend1, bend2) * dt * dt / 8


@kernel
def _update(
    first: Array, second: Array, dt: float, omega: float, zeta: float, turns: Array, states: Array, k: int, peaks: Array
) -> None:
    """Raise the peaks to those within the interval from sample k to k + 1."""
    turns_once = omega * math.sqrt(1 - zeta * zeta) * dt < math.pi
    for j in range(peaks.size):
        c, s = turns[j, 0], turns[j, 1]
        u, end_u = c * states[0, k] + s * states[2, k], c * states[0, k + 1] + s * states[2, k + 1]
        reached = max(peaks[j], abs(u), abs(end_u))
        if states[4, k] > reached:
            v, end_v = c * states[1, k] + s * states[3, k], c * states[1, k + 1] + s * states[3, k + 1]
            a, b = c * first[k] + s * second[k], c * first[k + 1] + s * second[k + 1]
            slope = (b - a) / dt
            w = -a - 2 * zeta * omega * v - omega * omega * u
            end_w = -b - 2 * zeta * omega * end_v - omega * omega * end_u
            monotonic = turns_once and w * end_w > 0 and v * end_v > 0
            bend = _curvature(omega, zeta, u, v, a, slope)
            if not monotonic and max(abs(u), abs(end_u)) + bend * dt * dt / 8 > reached:
                # With an infinite velocity only the displacement decides how far the search goes.
                reached, _ = peaks_inside(omega, zeta, u, v, a, slope, dt, reached, math.inf)
        peaks[j] = reached


@python_kernel
def rotated_peaks(
    first: Array, second: Array, dt: float, omega: float, zeta: float, turns: Array, states: Array, peaks: Array
) -> None:
    """Largest |u| of u'' + 2ζω u' + ω² u = -(a₁ cos φ + a₂ sin φ), from rest, over the record, for every φ.

    Parameters
    ----------
    first, second
        Samples of both components, shape (n,).
    dt, omega, zeta
        Sampling step, circular frequency and damping ratio.
    turns
        cos φ and sin φ of each direction, shape (m, 2).
    states
        Room to work in, shape (5, n).
    peaks
        Receives the peaks, shape (m,).
    """
    _march(first, second, dt, omega, zeta, states)
    peaks[:] = 0.0
    for k in range(0, first.size, max(1, first.size // COARSE)):
        for j in range(peaks.size):
            peaks[j] = max(peaks[j], abs(turns[j, 0] * states[0, k] + turns[j, 1] * states[2, k]))
    # Intervals in which the oscillator stays closer than the smallest peak so far raise no peak.
    least = _smallest(peaks)
    for k in range(first.size - 1):
        if states[4, k] > least:
            _update(first, second, dt, omega, zeta, turns, states, k, peaks)
            least = _smallest(peaks)
