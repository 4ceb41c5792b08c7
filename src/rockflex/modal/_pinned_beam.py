"""The uniform beam on a rotational spring, a bound for the effect of uplift on the modes."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, SupportsIndex

import numpy as np

from rockflex._arrays import Array
from rockflex._checks import MOST_MODES, one_of, positive, whole_number
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex._values import Value


@dataclass(frozen=True, eq=False)
class PinnedBeam(Value):
    """Frequencies of a pinned beam relative to those of the clamped beam.

    Attributes
    ----------
    rotation_ratio : float
        Frequency of the rotation on the spring divided by the first frequency of the clamped beam; 0 without a spring,
        1 if clamped. An uplifted structure has no corresponding frequency.
    ratio : ndarray, shape (n,)
        ω*_n/ω_n of the higher vibrations, relative to mode n of the clamped beam. Without a spring these are bounds for
        an uplifted structure.
    roots : ndarray, shape (n + 1,)
        λ of the rotation and of the vibrations: ω = λ² √(EI/(m L⁴)) in flexure, λ √(GA/(m L²)) in shear.

    Examples
    --------
    >>> import rockflex as rf
    >>> beam = rf.pinned_beam("shear", spring=1.0)
    >>> round(beam.rotation_ratio, 3), beam.ratio.round(3)
    (0.742, array([2.931, 1.653]))
    """

    rotation_ratio: float
    ratio: Array
    roots: Array


def pinned_beam(behaviour: Literal["flexure", "shear"], spring: float = 0.0, n_modes: SupportsIndex = 2) -> PinnedBeam:
    """Return the frequencies of a uniform cantilever on a rotational spring.

    Parameters
    ----------
    behaviour : {"flexure", "shear"}
        Kind of deformation.
    spring : float
        k_r L/EI in flexure, k_r/(GA L) in shear, zero (pinned) or positive.
    n_modes : int
        Number of vibrations, at most 200.

    Returns
    -------
    PinnedBeam

    Raises
    ------
    InputError
        If the behaviour is unknown, the spring negative or not finite, or `n_modes` not positive.

    References
    ----------
    The limit k_r → 0 is that of Wiebe & Christopoulos, cited in Silva & Stojadinović 2024, Section 3.4 (Fig. 10).

    Examples
    --------
    >>> import rockflex as rf
    >>> beam = rf.pinned_beam("flexure")
    >>> beam.ratio.round(3)
    array([4.385, 2.268])
    """
    if not one_of(behaviour, ("flexure", "shear")):
        raise InputError(
            f'behaviour must be "flexure" or "shear", but {shown(behaviour)} was given.', field="behaviour"
        )
    k = positive("spring", spring, "k_r L/EI (flexure) or k_r/(GA L) (shear)", zero=True)
    n = whole_number("n_modes", n_modes, 1, MOST_MODES)
    flexure = behaviour == "flexure"
    clamp, pin = (_clamped_flexure, _pinned_flexure) if flexure else (math.cos, _pinned_shear)
    pinned, clamped = [0.0], [_bisected(clamp, 0.0, math.pi)]
    for i in range(1, n + 1):
        pinned.append(_bisected(pin, i * math.pi, (i + 1) * math.pi if flexure else (i + 0.5) * math.pi))
        clamped.append(_bisected(clamp, i * math.pi, (i + 1) * math.pi))
    # The roots with a spring lie between those of the pinned and the clamped beam.
    spring_of = _flexure_spring if flexure else _shear_spring
    roots = [
        _bisected(lambda x: spring_of(x, k), low, high) if k else low
        for low, high in zip(pinned, clamped, strict=True)
    ]  # fmt: skip
    found = np.array(roots)
    power = 2 if flexure else 1
    against = np.array(clamped)
    return PinnedBeam(
        rotation_ratio=float((found[0] / against[0]) ** power),
        ratio=(found[1:] / against[:-1]) ** power,
        roots=found,
    )


def _clamped_flexure(x: float) -> float:
    return math.cos(x) + 1.0 / math.cosh(x)


def _pinned_flexure(x: float) -> float:
    return math.sin(x) - math.cos(x) * math.tanh(x)


def _pinned_shear(x: float) -> float:
    return math.sin(x) - x * math.cos(x)


def _flexure_spring(x: float, k: float) -> float:
    return k * _clamped_flexure(x) - x * _pinned_flexure(x)


def _shear_spring(x: float, k: float) -> float:
    return k * x * math.cos(x) - _pinned_shear(x)


def _bisected(function: Callable[[float], float], low: float, high: float) -> float:
    """Return the place of the sign change, to the last bit."""
    above = function(high) > 0.0
    while low < (middle := 0.5 * (low + high)) < high:
        if (function(middle) > 0.0) == above:
            high = middle
        else:
            low = middle
    return middle
