"""Limits of a design, and the intensity measures that suit all bases."""

import math
from typing import Any

from rockflex._checks import real_or_nan
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.fragility import LIMIT_STATES, NOMINAL, OVERTURNED, OVERTURNING, ROCKED, LimitState, beyond
from rockflex.motion import intensity
from rockflex.study._results import RESULTS


def check_limit(limit: float | str) -> None:
    """Raise an InputError unless a limit is one of those that `state_of` knows."""
    state_of(limit, 0.1)


def check_same_for_all(measure: str) -> None:
    """Raise an InputError unless the measure exists and does not depend on the base."""
    if intensity(measure).of_what == "base":
        raise InputError(
            f"measure must not depend on the base, as a level of {measure} does. Give pgv, pga or sa_t1_5."
        )


def state_of(limit: float | str, nominal: float) -> LimitState:
    """Limit state of a limit, where `nominal` is 0.7 atan(B/h*_1) of the design.

    A rotation in rad; a multiple of the nominal one; the name of a limit state; or a result with its bound, such as
    ``"max_base_moment > 5e6"``, which an overturned run exceeds too.

    Raises
    ------
    InputError
        If it is none of these, or a rotation is not from 1e-4 rad to below π/2.
    """
    words = limit.split() if isinstance(limit, str) else []
    if words == [OVERTURNING.name]:
        return OVERTURNING
    if len(words) == 1 and words[0] in LIMIT_STATES and words[0] != NOMINAL.name:
        return LIMIT_STATES[words[0]]
    if len(words) == 3 and words[1] == ">" and RESULTS.get(words[0]) in (float, int):
        return _above(words[0], words[2], limit)
    return beyond(_rotation(limit, nominal, words))


def is_rotation(state: LimitState) -> bool:
    """Whether a state is a rotation whose probability `fit_outcomes` gives."""
    return ROCKED <= state.threshold <= OVERTURNED


def _above(column: str, given: str, limit: Any) -> LimitState:
    try:
        bound = float(given)
    except ValueError:
        bound = math.nan
    if not (math.isfinite(bound) and bound >= 0.0):
        raise InputError(
            f"limit: the bound of {column} must be zero or a positive number, but {shown(limit)} was given."
        )
    if column == "max_rotation":
        return beyond(_rotation(bound, math.nan, []))

    def exceeded(runs: Any) -> Any:
        return (runs[column] > bound) | OVERTURNING.exceeded(runs)

    return LimitState(name=column, label=f"{column} > {bound:g}", symbol=f"{column} above {bound:g}", exceeded=exceeded)


def _rotation(limit: float | str, nominal: float, words: list[str]) -> float:
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
            f'"nominal" or "0.5 nominal" in the same range, a limit state ({", ".join(LIMIT_STATES)}), or a result '
            f'with its bound, such as "max_base_moment > 5e6", but {shown(limit)}{is_of} was given.'
        )
    return rotation
