"""Exact integrals of an acceleration that is linear between samples, and their peaks and durations."""

import math

import numpy as np

from rockflex._arrays import Array
from rockflex._checks import real_or_nan
from rockflex._constants import GRAVITY
from rockflex._errors import InputError
from rockflex._shown import shown


def velocity(a: Array, dt: float) -> Array:
    """Velocity at the samples, from rest: the trapezoidal rule, exact for a linear acceleration."""
    return _cumulative(0.5 * dt * (a[:-1] + a[1:]))


def displacement(a: Array, dt: float) -> Array:
    """Displacement at the samples, from rest: Δd = v₀ dt + (2 a₀ + a₁) dt²/6."""
    v = velocity(a, dt)
    return _cumulative(dt * v[:-1] + dt**2 / 6 * (2 * a[:-1] + a[1:]))


def peak_velocity(a: Array, dt: float) -> float:
    """Return the largest |v|; between samples v has an extreme where a crosses zero."""
    v = velocity(a, dt)
    k = np.flatnonzero(np.sign(a[:-1]) * np.sign(a[1:]) < 0)
    inside = v[k] + 0.5 * dt * a[k] * (a[k] / (a[k] - a[k + 1]))
    return float(np.max(np.abs(np.concatenate((v, inside)))))


def peak_displacement(a: Array, dt: float) -> float:
    """Return the largest |d|; between samples d has an extreme at the zeros of the quadratic v."""
    v, d = velocity(a, dt), displacement(a, dt)
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
    return math.pi / (2 * GRAVITY) * float(np.sum(_energies(a, dt)))


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
    energy = _cumulative(_energies(a, dt))
    if energy[-1] == 0:
        return 0.0
    return _time_of(high * energy[-1], energy, a, dt) - _time_of(low * energy[-1], energy, a, dt)


def _time_of(target: float, energy: Array, a: Array, dt: float) -> float:
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


def _energies(a: Array, dt: float) -> Array:
    left, right = a[:-1], a[1:]
    return dt / 3 * (left**2 + left * right + right**2)


def _cumulative(increments: Array) -> Array:
    return np.concatenate((np.zeros(1), np.cumsum(increments)))
