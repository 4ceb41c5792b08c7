"""Where an element acts: under the base, between floors, or from a height to the ground; and stories that yield."""

from dataclasses import dataclass, fields
from functools import cache
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

from rockflex.foundation.checks import real_or_nan
from rockflex.foundation.descriptions import Described, described, described_arguments
from rockflex.foundation.errors import InputError
from rockflex.foundation.language import translated
from rockflex.foundation.number_format import short_number
from rockflex.foundation.shown import shown
from rockflex.foundation.units import Unit, named_unit

PLACE = ("position", "between", "cosine", "height")  # the fields that say where an element acts
Position = Annotated[
    float,
    Described(
        "the distance to the right of the axis of the masses",
        "m",
        rule="finite",
        note="Unless the base is eccentric, this axis passes through its middle.",
    ),
]
Between = Annotated[
    tuple[int, int] | None,
    Described(
        "the two floors that it connects, in place of a position",
        form="{}, such as [0, 2]; 0 is the base",
        note="They count from 1 at the bottom; 0 is the base.",
    ),
]
Cosine = Annotated[
    float,
    Described(
        "the cosine of its inclination between floors or from a height, negative to the other side",
        rule="finite",
        note="From -1 to 1 but not zero; positive if the element is stretched as the structure moves to the right.",
    ),
]
TieHeight = Annotated[
    float | None,
    Described(
        "the height of a tie to the ground, in place of a position",
        "m",
        rule="positive",
        label="Tie at height",
        note="It counts from the base; between floors their displacements are interpolated.",
    ),
]


@described
@dataclass(frozen=True, kw_only=True, repr=False)
class Attachment:
    """The two ends of an element that is not between base and ground.

    The elongation δ of an attached element is horizontal and counts from the structure at rest. Between floors i and j
    it is δ = c (u_j - u_i), with the displacements u of the floors relative to the rotated base; a rotation of the base
    turns the element with the structure. A tie from a height z to the ground has δ = c (u(z) + z θ), and on a base that
    slides c times the slip as well. Its force joins the horizontal forces on floors and ground.

    Examples
    --------
    >>> import rockflex as rf
    >>> brace = rf.YieldingDissipator(stiffness=50e6, yield_force=200e3,
    ...     between=(0, 1), cosine=0.8)
    >>> brace.attached, brace.where
    (True, 'floors 0 to 1')
    """

    title: ClassVar[str] = ""  # name in a list; that of the class, if empty
    if TYPE_CHECKING:
        position: float  # a field of every element
    between: Between = None
    cosine: Cosine = 1.0
    height: TieHeight = None

    def __post_init__(self) -> None:
        self.check_attachment()

    def check_attachment(self) -> None:
        """Check where the element acts.

        Raises
        ------
        InputError
            If it acts at two places, or a floor, a height or a direction is none.
        """
        named = [name for name in ("between", "height") if getattr(self, name) is not None]
        if len(named) == 2 or (named and self.position != 0.0):
            raise InputError(
                "An element acts at a position of the base, between two floors or from a height to the ground, but "
                f"{', '.join(f'{name} = {shown(getattr(self, name))}' for name in ('position', *named))} were given. "
                "Give one of them.",
                field=named[0],
            )
        if not 0.0 < abs(self.cosine) <= 1.0 or (not named and self.cosine != 1.0):
            raise InputError(
                f"cosine must be from -1 to 1 and not zero, but {shown(self.cosine)} was given. It is that of the "
                "inclination of an element between floors or from a height; one under the base has none.",
                field="cosine",
            )
        if self.between is not None:
            vars(self).update(between=_checked_floors(self.between))

    @property
    def attached(self) -> bool:
        """Whether the element acts between floors or from a height, and not under the base."""
        return self.between is not None or self.height is not None

    @property
    def place(self) -> float | None:
        """Its position under the base in m; None if it is attached."""
        return None if self.attached else self.position

    @property
    def where(self) -> str:
        """Where the element acts, in words."""
        return self.where_in(named_unit("m"))

    def where_in(self, length: Unit) -> str:
        """Where the element acts, in words and in a unit of length."""
        if self.between is not None:
            return translated("floors {lower} to {upper}", lower=self.between[0], upper=self.between[1])
        axis, place = ("x", self.position) if self.height is None else ("z", self.height)
        return f"{axis} = {short_number(place / length.size)} {length.name}"

    @property
    def main_numbers(self) -> list[tuple[float, str]]:
        """The first two numbers that describe what it does, each with its SI unit: a tendon's force and stiffness."""
        units = _units_of_numbers(type(self))
        given = [(value, unit) for name, unit in units.items() if (value := getattr(self, name)) is not None]
        return [(float(value), unit) for value, unit in given if isinstance(value, int | float)][:2]

    def arm(self, pivot: float, side: int) -> float:
        """Return the distance in m from a pivot on a side, itself at `pivot` from the axis; zero if attached."""
        return 0.0 if self.attached else pivot - side * self.position

    def __repr__(self) -> str:
        given = element_parameters(self).items()
        return f"{type(self).__name__}({', '.join(f'{name}={value!r}' for name, value in given)})"


@cache
def _units_of_numbers(kind: type[Attachment]) -> dict[str, str]:
    """Return the units of the numbers of a kind of element by their names, without those of its place."""
    known = described_arguments(kind).items()
    return {name: told.unit for name, told in known if told.unit and name not in PLACE}


def element_parameters(element: Attachment) -> dict[str, Any]:
    """Return the parameters of an element by name; `between`, `cosine` and `height` only if it is attached."""
    names = [each.name for each in fields(element)]
    found = {name: getattr(element, name) for name in names if name not in PLACE[1:]}
    return found | {name: getattr(element, name) for name in PLACE[1:] if element.attached}


def _checked_floors(given: Any) -> tuple[int, int]:
    found = tuple(given) if isinstance(given, list | tuple) else ()
    numbers = [real_or_nan(each) for each in found]
    if len(numbers) != 2 or numbers[0] == numbers[1] or not all(each >= 0 and each % 1 == 0 for each in numbers):
        raise InputError(
            f"between must be two floors, such as (0, 1), but {shown(given)} was given. Floors count from 1 at the "
            "bottom; 0 is the base.",
            field="between",
        )
    return int(numbers[0]), int(numbers[1])


@dataclass(frozen=True)
class YieldingStory:
    """A story whose shear follows F = α k u + (1 - α) z of its drift u, with z elastic up to the strength.

    Attributes
    ----------
    floor : int
        The floor above it, from 1.
    stiffness : float
        k in N/m.
    yield_force : float
        Shear in N at which the story yields first.
    post_yield_ratio : float
        α, the stiffness after yielding over k, from 0 to below 1.
    """

    floor: int
    stiffness: float
    yield_force: float
    post_yield_ratio: float
