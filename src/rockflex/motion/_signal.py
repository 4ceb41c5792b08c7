"""Changes of sampled accelerations: finer sampling, baseline correction, filtering; and their exact integrals."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.polynomial import legendre

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_positive, checked_whole_number, real_or_nan
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown

MAX_REFINEMENT = 10_000  # largest number of new steps per old step


def velocity_from_acceleration(a: Array, dt: float) -> Array:
    """Velocity at the samples, from rest: the trapezoidal rule, exact for a linear acceleration."""
    return cumulative_sum(0.5 * dt * (a[:-1] + a[1:]))


def cumulative_sum(increments: Array) -> Array:
    """Sums of the increments, from zero."""
    return np.concatenate((np.zeros(1), np.cumsum(increments)))


def squares_between_samples(a: Array, dt: float) -> Array:
    """∫a² dt over each interval, shape (n - 1,)."""
    left, right = a[:-1], a[1:]
    return dt / 3 * (left**2 + left * right + right**2)


def times_of_energy_shares(a: Array, dt: float, shares: Sequence[float]) -> list[float]:
    """First instants at which ∫a² dt reaches shares of its final value; zeros if that is zero."""
    energy = cumulative_sum(squares_between_samples(a, dt))
    return [_time_of_energy(a, dt, energy, share * energy[-1]) if energy[-1] else 0.0 for share in shares]


def _time_of_energy(a: Array, dt: float, energy: Array, target: float) -> float:
    """First instant at which ∫a² dt, `energy` at the samples, reaches a target."""
    k = int(np.searchsorted(energy, target))
    if k == 0:
        return 0.0
    left, right = float(a[k - 1]), float(a[k])
    missing = target - float(energy[k - 1])
    slope = (right - left) / dt
    # ∫(left + slope τ)² dτ = (r³ - left³) / (3 slope) with r = a(τ).
    # Solved for τ without dividing by the slope, which may be zero.
    reached = math.cbrt(left**3 + 3 * slope * missing)
    step = 3 * missing / (reached**2 + reached * left + left**2)
    return (k - 1) * dt + min(step, dt)


def refine_samples(a: Array, k: int) -> Array:
    """Split every interval into `k` collinear ones."""
    k = checked_whole_number("k", k, 1, MAX_REFINEMENT)
    inside = a[:-1, None] + np.diff(a)[:, None] * (np.arange(k) / k)
    return np.append(inside.ravel(), a[-1])


def refinement_factor(old: float, new: float) -> int:
    """Return the whole number old/new, or raise an error that suggests valid steps."""
    checked_positive("dt", new, "s")
    ratio = min(old / new, MAX_REFINEMENT)
    k = round(ratio)
    if k >= 1 and abs(ratio - k) <= 1e-9:
        return k
    nearest = sorted({max(int(ratio), 1), max(int(ratio), 1) + (ratio > 1)})
    steps = " or ".join(f"{old / n:.12g} s" for n in nearest)
    raise InputError(
        f"A record with dt = {old:g} s cannot be resampled exactly to dt = {shown(new)} s: only a whole fraction "
        f"of its step leaves it unchanged between samples. Use {steps}."
    )


def correct_baseline(a: Array, dt: float, degree: int) -> Array:
    """Remove the polynomial whose exact integral fits the velocity best (least squares at the samples)."""
    degree = checked_whole_number("degree", degree, 0)
    if degree > a.size - 2:
        raise InputError(
            f"degree must be at most {a.size - 2} for {a.size} samples, but {degree} was given: "
            "a fit needs more values than coefficients."
        )
    # Legendre polynomials keep the fit well conditioned; they span the same space as powers of t.
    basis = legendre.legvander(np.linspace(-1, 1, a.size), degree)
    drift = np.stack([velocity_from_acceleration(column, dt) for column in basis.T], axis=1)
    weights, *_ = np.linalg.lstsq(drift, velocity_from_acceleration(a, dt), rcond=None)
    return a - basis @ weights


def band_pass_filter(a: Array, dt: float, low: float, high: float, order: int) -> Array:
    """Butterworth filter run forwards and backwards: no phase shift, twice the order."""
    from scipy.signal import butter, sosfiltfilt

    nyquist = 0.5 / dt
    if not 0 < real_or_nan(low) < real_or_nan(high) < nyquist:
        raise InputError(
            f"The corner frequencies must satisfy 0 < low < high < {nyquist:g} Hz, the Nyquist frequency "
            f"of dt = {dt:g} s, but low={shown(low)} and high={shown(high)} were given."
        )
    order = checked_whole_number("order", order, 1, 100)
    try:
        sections = butter(order, (low, high), btype="bandpass", output="sos", fs=1 / dt)
    except ValueError as error:
        raise InputError(
            f"No filter of order {order} has the corners low={low:g} Hz and high={high:g} Hz: {error}."
        ) from error
    padding = 3 * (2 * len(sections) + 1)
    if a.size <= padding:
        raise InputError(
            f"A band-pass filter of order {order} needs more than {padding} samples, but the record has "
            f"{a.size}. Use a lower order or a longer record."
        )
    return np.asarray(sosfiltfilt(sections, a, padlen=padding), dtype=np.float64)
