"""Limits of a design, and the intensity measures that suit all bases."""

import math

from rockflex._checks import real_or_nan
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.fragility import NOMINAL, OVERTURNED, OVERTURNING, ROCKED
from rockflex.motion import intensity


def check_limit(limit: float | str) -> None:
    """Raise an InputError unless a limit is a rotation, "overturning", or a multiple of "nominal"."""
    rotation_of(limit, 0.1)


def check_same_for_all(measure: str) -> None:
    """Raise an InputError unless the measure exists and does not depend on the base."""
    if intensity(measure).of_what == "base":
        raise InputError(f"measure must not depend on the base, as a level of {measure} does. Give pgv, pga or sa_t1.")


def rotation_of(limit: float | str, nominal: float) -> float:
    """Rotation in rad of a limit, where `nominal` is 0.7 atan(B/h*_1) of the design; π/2 for "overturning".

    Raises
    ------
    InputError
        If it is not a limit, or not from 1e-4 rad to below π/2.
    """
    words = limit.split() if isinstance(limit, str) else []
    if words == [OVERTURNING.name]:
        return OVERTURNED
    rotation = real_or_nan(limit)
    if words and words[-1] == NOMINAL.name and len(words) <= 2:
        try:
            rotation = nominal * float(words[0] if len(words) == 2 else 1.0)
        except ValueError:
            rotation = math.nan
    if not ROCKED <= rotation < OVERTURNED:
        is_of = f" ({rotation:.3g} rad)" if words and math.isfinite(rotation) else ""
        raise InputError(
            f"limit must be a rotation from {ROCKED:g} rad to below π/2, a multiple of 0.7 atan(B/h*_1) such as "
            f'"nominal" or "0.5 nominal" in the same range, or "overturning", but {shown(limit)}{is_of} was given.'
        )
    return rotation
