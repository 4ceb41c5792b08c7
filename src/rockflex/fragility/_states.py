"""The limit states of structures in the order of their severity, as risk programs take them."""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._checks import all_positive, finite_vector, positive
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.fragility._curve import Curve, Fragility, checked_curve
from rockflex.fragility._hazard import DAMPING, damping_words
from rockflex.fragility._lognormal import LognormalFragility
from rockflex.fragility._outcomes import OutcomeFragility

States: TypeAlias = OutcomeFragility | Mapping[str, Fragility | Curve]
"""Fits of the three outcomes, or a curve for each limit state by its name, from the mildest to the most severe."""

_NAME = re.compile(r"[A-Za-z0-9_-]+")
_IDENTIFIER = re.compile(r"[A-Za-z0-9_.:+-]+")
_LOOKS, _CROSSING = 200, 1e-9


@dataclass(frozen=True)
class Function:
    """The limit states of one structure.

    Attributes
    ----------
    name : str
        Name of the structure.
    curves : dict
        The probability of exceeding each limit state, from the mildest to the most severe.
    lognormal : dict or None
        The same as lognormal curves; None unless all of them are.
    """

    name: str
    curves: Mapping[str, Curve]
    lognormal: Mapping[str, LognormalFragility] | None


def functions_of(
    curves: Mapping[str, States], levels: ArrayLike, rotations: Mapping[str, float] | None, measure: str
) -> tuple[list[Function], Array]:
    """Return the limit states of each structure, and the levels of the measure, both checked.

    Raises
    ------
    InputError
        If a name cannot be written, a spectral measure is not at 5 % damping, the levels do not rise, structures have
        different limit states, a probability is not one, or a more severe limit state is more probable than a milder
        one.
    """
    im = finite_vector("levels", levels, "the SI unit of the measure")
    all_positive("levels", im, "in SI units")
    if im.size < 2 or (np.diff(im) <= 0.0).any():
        raise InputError(
            f"levels must be two or more measures that rise, but {shown(levels)} was given.", field="levels"
        )
    if not isinstance(curves, Mapping) or not curves:  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(
            'curves must be a dictionary with the limit states of each structure, such as {"pier": outcomes}, but '
            f"{shown(curves)} was given.",
            field="curves",
        )
    limits = {name: positive(f"rotations[{name!r}]", value, "rad") for name, value in (rotations or {}).items()}
    if limits and not any(isinstance(states, OutcomeFragility) for states in curves.values()):
        raise InputError("rotations are limits of fitted outcomes, but curves has none.", field="rotations")
    if list(limits.values()) != sorted(set(limits.values())):
        raise InputError(
            f"rotations must rise from the mildest limit state to the most severe, but they are "
            f"{', '.join(f'{value:g}' for value in limits.values())} rad.",
            field="rotations",
        )
    taken = [name for name in ("rocking", "overturning") if name in limits]
    if taken:
        raise InputError(f"{taken[0]} is a limit state of its own: give this rotation another name.", field="rotations")
    found = [_function(name, states, limits) for name, states in curves.items()]
    for name, states in curves.items():
        _check_damping(name, states, measure)
    _same_states(found)
    for each in found:
        _ordered(each, im)
    return found, im


def _function(name: Any, states: Any, rotations: Mapping[str, float]) -> Function:
    if not isinstance(name, str) or not _IDENTIFIER.fullmatch(name):
        raise InputError(
            f"The name of a structure may contain letters of the English alphabet, digits and _ . : + -, but "
            f"{shown(name)} was given.",
            field="curves",
        )
    if isinstance(states, OutcomeFragility):
        given: Mapping[Any, Any] = {
            "rocking": partial(_rocking, states),
            **{limit: partial(states.exceedance, limit=rotation) for limit, rotation in rotations.items()},
            "overturning": states.overturning,
        }
    elif isinstance(states, Mapping) and states:
        given = states
    else:
        raise InputError(
            f"curves[{name!r}] must be an OutcomeFragility or a dictionary of curves by limit state, but "
            f"{shown(states)} was given.",
            field="curves",
        )
    for limit in given:
        if not isinstance(limit, str) or not _NAME.fullmatch(limit):
            raise InputError(
                f"The name of a limit state may contain letters of the English alphabet, digits, _ and -, but "
                f"{shown(limit)} was given.",
                field="curves",
            )
    checked = {limit: checked_curve(curve, f"curves[{name!r}][{limit!r}]") for limit, curve in given.items()}
    fits = {limit: curve for limit, curve in given.items() if isinstance(curve, LognormalFragility)}
    return Function(name, checked, fits if len(fits) == len(given) else None)


def _check_damping(name: str, states: States, measure: str) -> None:
    """Raise an InputError if a spectral measure is known not to be at the 5 % of risk programs."""
    for fit in states.values() if isinstance(states, Mapping) else [states]:
        damping = getattr(fit, "damping", None)
        if damping is not None and not math.isclose(damping, DAMPING, rel_tol=1e-6):
            raise InputError(
                f"measure: {measure} of risk programs is at {damping_words(DAMPING)}, but the curves of {name} are in "
                f"a spectral measure at {damping_words(damping)}. Fit the runs to sa_t1_5, Sa(T₁) at 5 %.",
                field="measure",
            )


def _rocking(outcomes: OutcomeFragility, im: Array) -> Array:
    """Probability of rocking or overturning."""
    return 1.0 - outcomes.probabilities(im).no_rocking


def _same_states(found: list[Function]) -> None:
    first = found[0]
    for other in found[1:]:
        if list(other.curves) != list(first.curves):
            raise InputError(
                f"All structures must have the same limit states in the same order, but {first.name} has "
                f"{', '.join(first.curves)} and {other.name} has {', '.join(other.curves)}. Write several files.",
                field="curves",
            )


def _ordered(function: Function, levels: Array) -> None:
    """A run that exceeds a limit state exceeds all milder ones, so that curves cannot cross."""
    at = np.union1d(levels, np.geomspace(levels[0], levels[-1], _LOOKS)[1:-1])
    milder, before = np.ones(at.size), ""
    for limit, curve in function.curves.items():
        p = curve(at)
        worst = int(np.argmax(p - milder))
        if p[worst] > milder[worst] + _CROSSING:
            raise InputError(
                f"{function.name}: at {at[worst]:.4g} the probability of {limit} is {p[worst]:.4g}, more than the "
                f"{milder[worst]:.4g} of {before}, which comes before it. Give limit states from the mildest to the "
                "most severe; curves with different dispersions cross somewhere, so give levels on one side of that, "
                "or curves with a common dispersion.",
                field="curves",
            )
        milder, before = p, limit
