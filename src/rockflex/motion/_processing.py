"""Changes of a sampled acceleration: finer sampling, baseline correction, filtering."""

import numpy as np
from numpy.polynomial import legendre

from rockflex._arrays import Array
from rockflex._checks import positive, real_or_nan, whole_number
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.motion._integrals import velocity

FINEST = 10_000  # largest number of new steps per old step


def refine(a: Array, k: int) -> Array:
    """Split every interval into `k` collinear ones."""
    k = whole_number("k", k, 1, FINEST)
    inside = a[:-1, None] + np.diff(a)[:, None] * (np.arange(k) / k)
    return np.append(inside.ravel(), a[-1])


def refinement_of(old: float, new: float) -> int:
    """Return the whole number old/new, or raise an error that suggests valid steps."""
    positive("dt", new, "s")
    ratio = min(old / new, FINEST)
    k = round(ratio)
    if k >= 1 and abs(ratio - k) <= 1e-9:
        return k
    nearest = sorted({max(int(ratio), 1), max(int(ratio), 1) + (ratio > 1)})
    steps = " or ".join(f"{old / n:.12g} s" for n in nearest)
    raise InputError(
        f"A record with dt = {old:g} s cannot be resampled exactly to dt = {shown(new)} s: only a whole fraction "
        f"of its step leaves it unchanged between samples. Use {steps}."
    )


def baseline_correct(a: Array, dt: float, degree: int) -> Array:
    """Remove the polynomial whose exact integral fits the velocity best (least squares at the samples)."""
    degree = whole_number("degree", degree, 0)
    if degree > a.size - 2:
        raise InputError(
            f"degree must be at most {a.size - 2} for {a.size} samples, but {degree} was given: "
            "a fit needs more values than coefficients."
        )
    # Legendre polynomials keep the fit well conditioned; they span the same space as powers of t.
    basis = legendre.legvander(np.linspace(-1, 1, a.size), degree)
    drift = np.stack([velocity(column, dt) for column in basis.T], axis=1)
    weights, *_ = np.linalg.lstsq(drift, velocity(a, dt), rcond=None)
    return a - basis @ weights


def band_pass(a: Array, dt: float, low: float, high: float, order: int) -> Array:
    """Butterworth filter run forwards and backwards: no phase shift, twice the order."""
    from scipy.signal import butter, sosfiltfilt

    nyquist = 0.5 / dt
    if not 0 < real_or_nan(low) < real_or_nan(high) < nyquist:
        raise InputError(
            f"The corner frequencies must satisfy 0 < low < high < {nyquist:g} Hz, the Nyquist frequency "
            f"of dt = {dt:g} s, but low={shown(low)} and high={shown(high)} were given."
        )
    order = whole_number("order", order, 1, 100)
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
