"""Checks of the arguments of studies."""

import math
from collections.abc import Callable, Sequence
from numbers import Real
from typing import Any, Literal, Protocol, TypeAlias, get_args

from rockflex._checks import finite_vector, one_of, real_or_nan
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.modal import Ground, RockingProperties
from rockflex.models import BoucWen, ImpactLaw
from rockflex.motion import GroundMotion, check_horizontal

Output = Literal["history", "peaks"]

LONGEST = 1e9  # s of free vibration

GroundChoice: TypeAlias = Ground | Callable[[RockingProperties], Ground] | None
"""The ground of all structures, or a function that returns the ground of each; None: rigid, without sliding."""

WORK_LIMIT = 30.0
"""Default limit of the work of one run, in s of computing on one core."""


class RockingStructure(Protocol):
    """Anything with rocking properties, such as a `Frame` or a `LumpedStructure`."""

    def rocking(self, n_modes: int | None = None) -> RockingProperties:
        """Return the properties of the first `n_modes` modes, or of all."""
        ...


def properties_of(structure: RockingStructure | RockingProperties) -> RockingProperties:
    """Return the properties of a structure, or the properties themselves if they are given.

    Raises
    ------
    InputError
        If the object is neither.
    """
    if isinstance(structure, RockingProperties):
        return structure
    if not is_structure(structure):
        raise InputError(
            "structure must be a structure such as a Frame or a TaperedTower, or RockingProperties, but "
            f"{described(structure)} was given."
        )
    return structure.rocking()


def is_structure(given: object) -> bool:
    """Return whether `given` is a structure or its properties; a class is not."""
    return isinstance(given, RockingProperties) or (hasattr(given, "rocking") and not isinstance(given, type))


def described(given: Any) -> str:
    """Describe the type of an object, for a message."""
    return f"the class {given.__name__}" if isinstance(given, type) else type(given).__name__


def free_vibration_time(value: float | Literal["settle"]) -> float | None:
    """Return the seconds of free vibration; None means until settled.

    Raises
    ------
    InputError
        If the value is negative, above 1e9 s, not finite, another word, or not a number.
    """
    if isinstance(value, str) and value == "settle":
        return None
    seconds = real_or_nan(value)
    if not 0.0 <= seconds <= LONGEST:
        raise InputError(
            f'free_vibration must be zero or more seconds (at most {LONGEST:g}), or "settle", but {shown(value)} was '
            "given.",
            field="free_vibration",
        )
    return seconds


def work_limit_of(value: float | Literal["none"] | None) -> float | None:
    """Return the seconds of computing that one run may take; None means no limit, which files call "none".

    Raises
    ------
    InputError
        If the value is not positive, another word, or not a number.
    """
    if value is None or (isinstance(value, str) and value == "none"):
        return None
    seconds = real_or_nan(value)
    if not seconds > 0.0:
        raise InputError(
            f"work_limit must be a positive number of seconds of computing for one run, or None for no limit ("
            f'"none" in a file and on the command line), but {shown(value)} was given.',
            field="work_limit",
        )
    return seconds if math.isfinite(seconds) else None


def check_options(bouc_wen: BoucWen | None, impact: ImpactLaw | None, ground: GroundChoice = None) -> None:
    """Raise an InputError unless `bouc_wen` is a BoucWen, `impact` an impact law and `ground` a ground, or None."""
    if not isinstance(bouc_wen, BoucWen | None):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(
            f"bouc_wen must be a BoucWen or None, but {shown(bouc_wen)} was given. "
            "Write BoucWen(yield_displacement=...)."
        )
    if impact is not None and (isinstance(impact, type) or not isinstance(impact, ImpactLaw)):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(
            f"impact must be an impact law, but {described(impact)} was given. Give VVELSimplified(), VVELComplete(), "
            "Restitution(e), or an object with `keeps`, `loses` and `after(properties, modal_velocity, "
            "rotation_velocity)`."
        )
    if ground is not None and (isinstance(ground, type) or not (isinstance(ground, Ground) or callable(ground))):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(
            f"ground must be a Ground, a function of RockingProperties that returns one, or None, but "
            f"{described(ground)} was given. Write Ground(friction=0.4), for example.",
            field="ground",
        )


def ground_under(properties: RockingProperties, ground: GroundChoice) -> Ground | None:
    """Return the ground under a structure.

    Raises
    ------
    InputError
        If the function does not return a ground, or as that function.
    """
    if ground is None or isinstance(ground, Ground):
        return ground
    found = ground(properties)
    if not isinstance(found, Ground):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(
            f"ground must return a Ground for the properties of a structure, but it returned {described(found)}.",
            field="ground",
        )
    return found


def wants_history(output: str) -> bool:
    """Return whether a run keeps its history; raise an InputError if `output` is neither "history" nor "peaks"."""
    if not one_of(output, get_args(Output)):
        raise InputError(f'output must be "history" or "peaks", but {shown(output)} was given.')
    return output == "history"


def check_motion(motion: GroundMotion) -> None:
    """Raise an InputError unless `motion` is a horizontal ground motion."""
    if not isinstance(motion, GroundMotion):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(f"motion must be a GroundMotion, but {described(motion)} was given. Read or build one first.")
    check_horizontal(motion)


def sequence_of(name: str, given: Any, accepts: Callable[[Any], bool], wanted: str) -> list[Any]:
    """Return one object, or a sequence of objects, as a list that is not empty."""
    if accepts(given):
        return [given]
    items = _items(given)
    if items is None:
        raise InputError(f"{name} must be {wanted}, or a sequence of them, but {described(given)} was given.")
    if not items:
        raise InputError(f"{name} is empty. Give at least one.")
    for place, item in enumerate(items):
        if not accepts(item):
            raise InputError(f"{name}[{place}] is {described(item)}. Expected {wanted}.")
    return items


def positive_numbers(name: str, values: Sequence[float], unit: str) -> list[float]:
    """Return one or more positive numbers as a list."""
    numbers = finite_vector(name, values, unit)
    if numbers.min(initial=math.inf) <= 0.0 or numbers.size == 0:
        raise InputError(
            f"{name} must be one or more positive numbers{unit and f' in {unit}'}, but {shown(values)} was given."
        )
    return numbers.tolist()


def factors_of(scales: float | Sequence[float], strongest: GroundMotion) -> list[float]:
    """Return one or more factors as a list; they must be finite, and so must the strongest motion times each."""
    given = [scales] if isinstance(scales, Real) else _items(scales)
    factors = [real_or_nan(factor) for factor in given or ()]
    if not factors or not all(map(math.isfinite, factors)):
        raise InputError(f"scales must be one or more finite factors, but {shown(scales)} was given.")
    largest = max(factors, key=abs)
    if not math.isfinite(largest * strongest.pga):
        raise InputError(
            f"scales must keep the accelerations finite, but the factor {largest:g} was given for "
            f"{shown(strongest.name)} with {strongest.pga:.3g} m/s². Give a smaller factor."
        )
    return factors


def _items(given: Any) -> list[Any] | None:
    """Return the items of a sequence; None if `given` is not a sequence."""
    if isinstance(given, str | bytes):
        return None
    try:
        items = iter(given)
    except TypeError:
        return None
    return list(items)
