"""Sampled accelerations: exact integrals, peaks and durations, finer sampling, baseline correction, filtering."""

import math

import numpy as np
from numpy.polynomial import legendre

from rockflex._arrays import Array
from rockflex._checks import checked_positive, checked_whole_number, real_or_nan
from rockflex._constants import GRAVITY
from rockflex._errors import InputError
from rockflex._shown import shown

MAX_REFINEMENT = 10_000  # largest number of new steps per old step


def velocity_from_acceleration(a: Array, dt: float) -> Array:
    """Velocity at the samples, from rest: the trapezoidal rule, exact for a linear acceleration."""
    return _cumulative_sum(0.5 * dt * (a[:-1] + a[1:]))


def displacement_from_acceleration(a: Array, dt: float) -> Array:
    """Displacement at the samples, from rest: Δd = v₀ dt + (2 a₀ + a₁) dt²/6."""
    v = velocity_from_acceleration(a, dt)
    return _cumulative_sum(dt * v[:-1] + dt**2 / 6 * (2 * a[:-1] + a[1:]))


def peak_velocity(a: Array, dt: float) -> float:
    """Return the largest |v|; between samples v has an extreme where a crosses zero."""
    v = velocity_from_acceleration(a, dt)
    k = np.flatnonzero(np.sign(a[:-1]) * np.sign(a[1:]) < 0)
    inside = v[k] + 0.5 * dt * a[k] * (a[k] / (a[k] - a[k + 1]))
    return float(np.max(np.abs(np.concatenate((v, inside)))))


def peak_displacement(a: Array, dt: float) -> float:
    """Return the largest |d|; between samples d has an extreme at the zeros of the quadratic v."""
    v, d = velocity_from_acceleration(a, dt), displacement_from_acceleration(a, dt)
    # With x = t/dt in [0, 1]: v = c + b x + q x².
    c, b, q = v[:-1], dt * a[:-1], 0.5 * dt * np.diff(a)
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        w = -0.5 * (b + np.copysign(np.sqrt(b**2 - 4 * q * c), b))
        roots = np.stack((w / q, c / w))
        inside = (roots > 0) & (roots < 1)
    x = np.where(inside, roots, 0.0)
    extremes = d[:-1] + dt * x * (c + x * (b / 2 + x * q / 3))
    return float(max(np.max(np.abs(d)), np.max(np.abs(extremes))))


def arias_intensity(a: Array, dt: float) -> float:
    """Return π/(2g) ∫a² dt over the record (Arias 1970)."""
    return math.pi / (2 * GRAVITY) * float(np.sum(_arias_energies(a, dt)))


def cumulative_absolute_velocity(a: Array, dt: float) -> float:
    """Return ∫|a| dt over the record; an interval in which `a` changes sign is split at the zero."""
    left, right = a[:-1], a[1:]
    total = np.abs(left) + np.abs(right)
    crossing = np.sign(left) * np.sign(right) < 0
    # Two triangles of heights |left| and |right| divide the interval in proportion to these heights.
    ratio = np.divide(left**2 + right**2, total, out=total.copy(), where=crossing)
    return float(np.sum(0.5 * dt * ratio))


def significant_duration(a: Array, dt: float, low: float, high: float) -> float:
    """Time between the first instants at which the fractions `low` and `high` of ∫a² dt are reached."""
    if not 0 <= real_or_nan(low) < real_or_nan(high) <= 1:
        raise InputError(
            f"low and high must be fractions with 0 <= low < high <= 1, but low={shown(low)} and high={shown(high)} "
            "were given. Significant duration D5-95 is low=0.05, high=0.95."
        )
    energy = _cumulative_sum(_arias_energies(a, dt))
    if energy[-1] == 0:
        return 0.0
    return _time_of_energy(high * energy[-1], energy, a, dt) - _time_of_energy(low * energy[-1], energy, a, dt)


def _time_of_energy(target: float, energy: Array, a: Array, dt: float) -> float:
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


def _arias_energies(a: Array, dt: float) -> Array:
    left, right = a[:-1], a[1:]
    return dt / 3 * (left**2 + left * right + right**2)


def _cumulative_sum(increments: Array) -> Array:
    return np.concatenate((np.zeros(1), np.cumsum(increments)))


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
