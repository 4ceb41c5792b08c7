"""Checks of the arguments of studies: structures, motions, models, scales, the initial state, and options."""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches
from inspect import signature
from numbers import Real
from typing import Any, Literal, Protocol, TypeAlias, cast, get_args

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_finite_vector, checked_magnitude, is_one_of, real_or_nan
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import number_with_noun, shown
from rockflex.foundation.values import Value
from rockflex.models._bouc_wen import BoucWen
from rockflex.models._impact import LAWS, ImpactLaw, RuledLaw
from rockflex.models._label import Model, parse_model
from rockflex.models._rocking_model import RockingModel
from rockflex.motion._ground_motion import GroundMotion, check_horizontal_component
from rockflex.motion._suite import Selection
from rockflex.structure._ground import Ground
from rockflex.structure._rocking import RockingProperties

Output = Literal["history", "peaks"]

MAX_FREE_VIBRATION = 1e9  # s of free vibration

GroundChoice: TypeAlias = Ground | Callable[[RockingProperties], Ground] | None
"""The ground of all structures, or a function that returns the ground of each; None: rigid, without sliding."""


def check_keywords(given: Mapping[str, Any], known: type) -> None:
    """Raise a TypeError, as Python does, if no option that is `known`, a TypedDict, has a name."""
    names = list(known.__annotations__)
    for name in given:
        if name not in names:
            near = get_close_matches(name, names, n=1)
            hint = f"Did you mean {near[0]!r}?" if near else f"Known are {', '.join(names)}."
            raise TypeError(f"There is no option {name!r}. {hint}")


class RockingStructure(Protocol):
    """Anything with rocking properties, such as a `Frame` or a `LumpedStructure`."""

    def rocking(self, n_modes: int | None = None) -> RockingProperties:
        """Return the properties of the first `n_modes` modes, or of all."""
        ...


def rocking_properties_of(structure: RockingStructure | RockingProperties) -> RockingProperties:
    """Return the properties of a structure, or the properties themselves if they are given."""
    if not is_structure_or_properties(structure):
        raise InputError(
            "structure must be a structure such as a Frame or a TaperedTower, or RockingProperties, but "
            f"{type_description(structure)} was given."
        )
    return structure.rocking()


def is_structure_or_properties(given: object) -> bool:
    """Return whether `given` is a structure or its properties; a class is not."""
    return hasattr(given, "rocking") and not isinstance(given, type)


def type_description(given: Any) -> str:
    """Describe the type of an object, for a message."""
    return f"the class {given.__name__}" if isinstance(given, type) else type(given).__name__


def free_vibration_time(value: float | Literal["settle"]) -> float | None:
    """Return the seconds of free vibration; None means until settled."""
    if isinstance(value, str) and value == "settle":
        return None
    seconds = real_or_nan(value)
    if not 0.0 <= seconds <= MAX_FREE_VIBRATION:
        raise InputError(
            f'free_vibration must be zero or more seconds (at most {MAX_FREE_VIBRATION:g}), or "settle", but '
            f"{shown(value)} was given.",
            field="free_vibration",
        )
    return seconds


def free_vibration_argument(time: float | None) -> float | Literal["settle"]:
    """Return the argument that says so many seconds of free vibration; None means until settled."""
    return "settle" if time is None else time


def _law_call(law: type[RuledLaw]) -> str:
    """Return how a law is made, with its restitution if it needs one."""
    needed = [each.name for each in signature(law).parameters.values() if each.default is each.empty]
    return f"{law.__name__}({', '.join(needed)})"


def check_run_options(bouc_wen: BoucWen | None, impact: ImpactLaw | None, ground: GroundChoice = None) -> None:
    """Raise an InputError unless `bouc_wen` is a BoucWen, `impact` an impact law and `ground` a ground, or None."""
    if not isinstance(bouc_wen, BoucWen | None):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(
            f"bouc_wen must be a BoucWen or None, but {shown(bouc_wen)} was given. "
            "Write BoucWen(yield_displacement=...)."
        )
    if impact is not None and (isinstance(impact, type) or not isinstance(impact, ImpactLaw)):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(
            f"impact must be an impact law, but {type_description(impact)} was given. Give "
            f"{', '.join(_law_call(each) for each in LAWS.values())}, or an object with `keeps`, `loses` and "
            "`after(properties, modal_velocity, rotation_velocity, modal_displacement)`."
        )
    if ground is not None and (isinstance(ground, type) or not (isinstance(ground, Ground) or callable(ground))):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(
            f"ground must be a Ground, a function of RockingProperties that returns one, or None, but "
            f"{type_description(ground)} was given. Write Ground(friction=0.4), for example.",
            field="ground",
        )


def ground_under_structure(properties: RockingProperties, ground: GroundChoice) -> Ground | None:
    """Return the ground under a structure."""
    if not callable(ground):
        return ground
    found = ground(properties)
    if not isinstance(found, Ground):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(
            "ground must return a Ground for the properties of a structure, but it returned "
            f"{type_description(found)}.",
            field="ground",
        )
    return found


def wants_history(output: str) -> bool:
    """Return whether a run keeps its history; raise an InputError if `output` is neither "history" nor "peaks"."""
    if not is_one_of(output, get_args(Output)):
        raise InputError(f'output must be "history" or "peaks", but {shown(output)} was given.')
    return output == "history"


def check_motion_argument(motion: GroundMotion) -> None:
    """Raise an InputError unless `motion` is a horizontal ground motion."""
    if not isinstance(motion, GroundMotion):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(
            f"motion must be a GroundMotion, but {type_description(motion)} was given. Read or build one first."
        )
    check_horizontal_component(motion)


def checked_sequence(name: str, given: Any, accepts: Callable[[Any], bool], wanted: str) -> list[Any]:
    """Return one object, or a sequence of objects, as a list that is not empty."""
    if accepts(given):
        return [given]
    items = _sequence_items(given)
    if items is None:
        raise InputError(f"{name} must be {wanted}, or a sequence of them, but {type_description(given)} was given.")
    if not items:
        raise InputError(f"{name} is empty. Give at least one.")
    for place, item in enumerate(items):
        if not accepts(item):
            raise InputError(f"{name}[{place}] is {type_description(item)}. Expected {wanted}.")
    return items


def checked_positive_numbers(name: str, values: Sequence[float], unit: str) -> list[float]:
    """Return one or more positive numbers as a list."""
    numbers = checked_finite_vector(name, values, unit)
    if numbers.min(initial=math.inf) <= 0.0 or numbers.size == 0:
        raise InputError(
            f"{name} must be one or more positive numbers{unit and f' in {unit}'}, but {shown(values)} was given."
        )
    return numbers.tolist()


def checked_scale_factors(scales: float | Sequence[float], strongest: GroundMotion) -> list[float]:
    """Return one or more factors as a list; they must be finite, and so must the strongest motion times each."""
    given = [scales] if isinstance(scales, Real) else _sequence_items(scales)
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


def _sequence_items(given: Any) -> list[Any] | None:
    """Return the items of a sequence; None if `given` is not a sequence."""
    if isinstance(given, str | bytes):
        return None
    try:
        items = iter(given)
    except TypeError:
        return None
    return list(items)


Structures: TypeAlias = (
    RockingStructure
    | RockingProperties
    | Iterable[RockingStructure | RockingProperties]
    | Mapping[str, RockingStructure]
    | Mapping[str, RockingProperties]
    | Mapping[str, RockingStructure | RockingProperties]
)
Motions: TypeAlias = GroundMotion | Iterable[GroundMotion] | Mapping[str, GroundMotion] | Selection
Models: TypeAlias = str | Model | Iterable[str | Model]


def checked_structures(given: Structures) -> tuple[list[RockingStructure | RockingProperties], list[str] | None]:
    """Return the structures, and their names if they are given by name."""
    names, several = _named_entries("structures", given)
    return checked_sequence(
        "structures", several, is_structure_or_properties, "a structure such as a Frame, or RockingProperties"
    ), names


def checked_motions(given: Motions) -> list[GroundMotion]:
    """Return the motions, of a selection the scaled ones; a name in the mapping replaces the name of the motion."""
    names, several = _named_entries("motions", given.suite if isinstance(given, Selection) else given)
    motions = checked_sequence("motions", several, lambda each: isinstance(each, GroundMotion), "a GroundMotion")
    if names is None:
        return motions
    return [replace(motion, name=name) for name, motion in zip(names, motions, strict=True)]


def checked_models(given: Models) -> list[Model]:
    """Return the models of labels."""
    wanted = 'a label such as "2DOF-S", or a Model'
    labels = checked_sequence("models", given, lambda each: isinstance(each, str | Model), wanted)
    return [parse_model(each) for each in labels]


def _named_entries(what: str, given: Any) -> tuple[list[str] | None, Any]:
    """Return the names and values of a mapping; None and `given` itself if it is not a mapping."""
    if not isinstance(given, Mapping):
        return None, given
    entries = cast("Mapping[Any, Any]", given)
    for name in entries:
        if not isinstance(name, str):
            raise InputError(
                f"The names of {what} must be texts, but {name!r} was given. Write {{{str(name)!r}: ...}}."
            )
    return list(entries), list(entries.values())


MAX_FACTORS = 1000
ROUNDING = 1e-9  # of a step: the largest factor is met in spite of rounding
_EXAMPLES = (
    "{smallest = 0.5, largest = 3.0, step = 0.25}, or with a count in place of the step, and then perhaps with "
    'spacing = "logarithmic"'
)


def expand_scale_range(given: Any) -> Any:
    """Return the factors of a mapping with `smallest`, `largest` and `step` or `count`; anything else unchanged.

    Both ends are included, the largest one if a whole number of steps leads there.
    """
    if not isinstance(given, Mapping):
        return given
    values: dict[Any, Any] = {**given}
    spacing = values.pop("spacing", "linear")
    keys = set(values)
    logarithmic = spacing == "logarithmic"
    known = is_one_of(spacing, ("linear", "logarithmic")) and not (logarithmic and "step" in keys)
    smallest, largest = real_or_nan(values.get("smallest")), real_or_nan(values.get("largest"))
    if known and keys == {"smallest", "largest", "step"}:
        return stepped_scale_factors(smallest, largest, real_or_nan(values["step"]))
    if known and keys == {"smallest", "largest", "count"} and type(values["count"]) is int:
        count = values["count"]
        if (
            _is_rising_scale_range(smallest, largest)
            and 2 <= count <= MAX_FACTORS
            and not (logarithmic and smallest <= 0.0)
        ):
            spaced = np.geomspace if logarithmic else np.linspace
            return [_tidy_scale_factor(factor) for factor in spaced(smallest, largest, count)]
    raise InputError(
        f"scales must be a list, or a range such as {_EXAMPLES}, of at most {MAX_FACTORS} factors, but "
        f"{shown(given)} was given.",
        field="scales",
    )


def parse_scale_range(text: str) -> list[float]:
    """Return the factors of a text: a number, or a range such as ``0.5:3.0:0.25`` of smallest, largest and step."""
    numbers = [_number_in_text(part) for part in text.split(":")]
    if None in numbers or len(numbers) not in (1, 3):
        raise InputError(
            f"scales must be numbers, or ranges such as 0.5:3.0:0.25, but {shown(text)} was given.", field="scales"
        )
    found = [number for number in numbers if number is not None]
    return found if len(found) == 1 else stepped_scale_factors(*found)


def stepped_scale_factors(smallest: float, largest: float, step: float) -> list[float]:
    """Return the factors from the smallest in steps up to the largest."""
    if _is_rising_scale_range(smallest, largest) and 0.0 < step < math.inf:
        steps = (largest - smallest) / step + ROUNDING
        if 1.0 <= steps < MAX_FACTORS:
            return [_tidy_scale_factor(smallest + place * step) for place in range(int(steps) + 1)]
    raise InputError(
        f"scales must rise in 1 to {MAX_FACTORS - 1} steps, but a range from {smallest:g} to {largest:g} in steps of "
        f"{step:g} was given.",
        field="scales",
    )


def _is_rising_scale_range(smallest: float, largest: float) -> bool:
    return -math.inf < smallest < largest < math.inf


def _number_in_text(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


def _tidy_scale_factor(factor: float) -> float:
    """The factor without the rounding of its sum, such as 0.3 in place of 0.30000000000000004."""
    return float(f"{factor:.12g}")


MAX_STATE = 1e9  # m, m/s or rad/s: beyond any structure, and far from where numbers overflow


@dataclass(frozen=True, eq=False, init=False)
class InitialState(Value):
    """The state at t = 0, if the structure does not start at rest.

    The base starts uplifted if `rotation` is not zero; its sign gives the side. If only `rotation_velocity` is not
    zero, the base also starts uplifted, and the sign of the velocity gives the side.

    Parameters
    ----------
    rotation
        θ in rad, below π/2 in magnitude.
    modal_displacement, modal_velocity
        D_n in m and D'_n in m/s of the modes of the model, shape (N,) or fewer (the others are zero); None for zero.
        Stored as read-only copies.
    rotation_velocity
        θ' in rad/s; outward (the sign of θ) or, with θ ≠ 0, inward.

    Raises
    ------
    InputError
        If a value is not a finite number, |θ| is not below π/2, or another value is not below 1e9 in magnitude.

    Examples
    --------
    >>> import rockflex as rf
    >>> block = rf.rigid_block(slenderness=0.2, half_diagonal=2.0)
    >>> start = rf.InitialState(rotation=0.1)
    >>> response = rf.simulate(block, rf.quiet_motion(5.0), "rigid",
    ...     initial=start)
    >>> round(response.max_rotation, 3)
    0.1
    """

    rotation: float
    modal_displacement: Array | None
    modal_velocity: Array | None
    rotation_velocity: float

    def __init__(
        self,
        rotation: float = 0.0,
        modal_displacement: ArrayLike | None = None,
        modal_velocity: ArrayLike | None = None,
        rotation_velocity: float = 0.0,
    ) -> None:
        vars(self).update(
            rotation=checked_magnitude("rotation", rotation, 0.5 * math.pi, "rad"),
            modal_displacement=_checked_modal_values("modal_displacement", modal_displacement, "m"),
            modal_velocity=_checked_modal_values("modal_velocity", modal_velocity, "m/s"),
            rotation_velocity=checked_magnitude("rotation_velocity", rotation_velocity, MAX_STATE, "rad/s"),
        )

    def state(self, model: RockingModel) -> Array:
        """Return the state [D.., D'.., θ, θ'] for a model.

        Raises
        ------
        InputError
            If there are more values than modes, or a base would rotate that is fixed, or to a side where it cannot.
        """
        n = model.properties.n_modes
        state = np.zeros(2 * n + 2)
        for name, values, first in (
            ("modal_displacement", self.modal_displacement, 0),
            ("modal_velocity", self.modal_velocity, n),
        ):
            if values is None:
                continue
            if values.size > n:
                raise InputError(
                    f"{name} has {number_with_noun(values.size, 'value')}, but {model.label} has "
                    f"{number_with_noun(n, 'mode')}. Give at "
                    f"most {n}."
                )
            state[first : first + values.size] = values
        state[-2:] = self.rotation, self.rotation_velocity
        side = float(np.sign(self.rotation or self.rotation_velocity))
        if side not in (0.0, *model.properties.sides):
            raise InputError(
                f"The structure opens to the {model.properties.opens} alone, but rotation={shown(self.rotation)} and "
                f"rotation_velocity={shown(self.rotation_velocity)} were given. Give "
                f"{'positive' if side < 0.0 else 'negative'} ones.",
                field="initial",
            )
        if not model.lifts and np.any(state[-2:] != 0.0):
            raise InputError(
                f"{model.label} has a base that cannot lift, but rotation={shown(self.rotation)} and "
                f"rotation_velocity={shown(self.rotation_velocity)} were given. Give zero, or a model that rocks."
            )
        return state


def _checked_modal_values(name: str, values: ArrayLike | None, unit: str) -> Array | None:
    if values is None:
        return None
    vector = checked_finite_vector(name, values, unit)
    for place, value in enumerate(vector.tolist()):
        checked_magnitude(f"{name}[{place}]", value, MAX_STATE, unit)
    return vector
