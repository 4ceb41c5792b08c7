"""The interface of every structure, structures known by their modes, and changes of the base of a structure."""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Protocol, SupportsIndex

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_finite
from rockflex.foundation.descriptions import Described
from rockflex.foundation.errors import InputError
from rockflex.foundation.language import translated
from rockflex.foundation.schema import ECCENTRICITY
from rockflex.foundation.shown import shown
from rockflex.foundation.values import Value
from rockflex.structure._analysis import ModalProperties
from rockflex.structure._base_element import BaseElement
from rockflex.structure._elements import Tendon, base_element_tuple, tendons_among
from rockflex.structure._outline import DrawnStructure, Kind, Masses, has_shapes, innermost_structure
from rockflex.structure._participation import MassNormalisedModes
from rockflex.structure._rocking import RockingProperties

MAX_PERIOD = 10.0  # s


class Structure(Protocol):
    """Any structure on a base that can rock."""

    def modal(self, n_modes: SupportsIndex | None = None) -> ModalProperties: ...

    def rocking(self, n_modes: SupportsIndex | None = None) -> RockingProperties: ...


class AssembledStructure(DrawnStructure, ABC):
    """A structure whose description is turned into another one, which has its modes and rocking properties."""

    @property
    @abstractmethod
    def assembled(self) -> Structure:
        """The structure that this one assembles."""

    def modal(self, n_modes: SupportsIndex | None = None) -> ModalProperties:
        """Return the first `n_modes` modes on a fixed base, or all that the structure has.

        Raises
        ------
        InputError
            If `n_modes` is not from 1 to the number that the structure has.
        """
        return self.assembled.modal(n_modes)

    def rocking(self, n_modes: SupportsIndex | None = None) -> RockingProperties:
        """Return the parameters of the rocking structure with its first `n_modes` modes, or with all.

        Raises
        ------
        InputError
            If `n_modes` is not from 1 to the number that the structure has.
        """
        return self.assembled.rocking(n_modes)

    def unit_warnings(self) -> tuple[str, ...]:
        """Return texts about arguments that look like another unit; see `structure_warnings`."""
        return ()


@dataclass(frozen=True, kw_only=True)
class InFile:
    """What a wrapper is in a file, and in all that reads one: a key beside the table of the structure it goes around.

    Attributes
    ----------
    key
        The key.
    words
        What it is.
    value
        The type of its value; None for a table.
    argument
        The argument that the value is, or that `makes` makes of it; empty for a table of the wrapper's own arguments.
    makes, taken
        The function whose arguments the table has, where these are not the wrapper's own, and the one that returns them
        for what this made.
    floors
        Whether it needs floors, which a rigid block and `RockingProperties` do not have.
    nothing
        A value that changes nothing, as None does.
    """

    key: str
    words: Described
    value: Any = None
    argument: str = ""
    makes: Callable[..., Any] | None = None
    taken: Callable[[Any], Any] | None = None
    floors: bool = False
    nothing: Any = None

    def arguments(self, value: Any) -> dict[str, Any]:
        """Return the arguments of the wrapper for a value, or the content of a table."""
        made = value if self.makes is None else self.makes(**value)
        return {self.argument: made} if self.argument else dict(value)

    def content(self, arguments: Mapping[str, Any]) -> Any:
        """Return the value, or the content of the table, for arguments of the wrapper as files have them."""
        given = arguments[self.argument] if self.argument else dict(arguments)
        return given if self.taken is None else self.taken(given)


class ModifiedStructure(DrawnStructure):
    """A structure that has the modes of another one, and some other properties: a wrapper."""

    in_file: ClassVar[InFile | None] = None  # None if it is not a key of its own
    of_properties: ClassVar[bool] = False  # whether `RockingProperties` have its arguments themselves
    structure: Any  # a structure, or RockingProperties where the change needs no more

    @classmethod
    def around(cls, structure: Structure | RockingProperties, **given: Any) -> Structure | RockingProperties:
        """Return a structure with a change; of properties that have such values themselves, the changed properties."""
        made: Any = cls
        if cls.of_properties and isinstance(structure, RockingProperties):
            return replace(structure, **given)
        return made(structure, **given)

    def outline_kind(self) -> Kind:
        return self.structure.outline_kind() if isinstance(self.structure, DrawnStructure) else "column"

    def concentrated_masses(self) -> Masses:
        return self.structure.concentrated_masses() if isinstance(self.structure, DrawnStructure) else ()

    def modal(self, n_modes: SupportsIndex | None = None) -> ModalProperties:
        """Return the first `n_modes` modes on a fixed base (default: all).

        Raises
        ------
        InputError
            If `n_modes` is not from 1 to the number that the structure has, or it is a rigid block or given by its
            `RockingProperties`.
        """
        if isinstance(self.structure, RockingProperties):
            raise InputError(
                "A structure given by its RockingProperties has no shapes of modes. Give a structure with floors, such "
                "as a Frame, or use rocking().",
                field="structure",
            )
        return self.structure.modal(n_modes)

    def rocking(self, n_modes: SupportsIndex | None = None) -> RockingProperties:
        """Return the parameters of the rocking structure with its first `n_modes` modes (default: all)."""
        base = self.structure.rocking(n_modes)
        if n_modes is not None:
            return replace(base, **self._changes(base))
        known = vars(self).get("_known")
        if known is None or known[0] is not base:  # the same object each time, so that runs can share prepared matrices
            known = vars(self)["_known"] = base, replace(base, **self._changes(base))
        return known[1]

    def check(self) -> None:
        """Check that the properties fit those of the structure; one of its modes is enough for that."""
        self.rocking(1 if has_shapes(self.structure) else None)

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in vars(self).items() if name != "_known"}

    def _changes(self, base: RockingProperties) -> dict[str, Any]:
        """Return the properties that differ from those of the structure."""
        raise NotImplementedError


def is_structure(given: object) -> bool:
    """Tell whether something has modes and can rock; a class of structures does not."""
    return not isinstance(given, type) and hasattr(given, "rocking") and hasattr(given, "modal")


def checked_structure(given: Structure | RockingProperties) -> Structure | RockingProperties:
    """Return a structure, or the properties of one.

    Raises
    ------
    InputError
        If it is neither.
    """
    if not is_structure(given) and not isinstance(given, RockingProperties):
        raise InputError(
            "structure must be a structure such as a Frame, a rigid_block or RockingProperties, but "
            f"{shown(given)} was given.",
            field="structure",
        )
    return given


@dataclass(frozen=True, eq=False)
class ModalStructure(DrawnStructure, Value):
    """A structure given by its modes, as returned by `from_matrices` and `from_modes`.

    Attributes
    ----------
    modes : MassNormalisedModes
        Its modes, except those excited neither by the ground nor by the rotation of the base.
    base_mass : float
        Mass m_0 of the base in kg.
    half_width : float
        Half-width B of the base in m.
    damping_ratio : ndarray, shape (n,)
        Damping ratio of each mode.

    Examples
    --------
    >>> import rockflex as rf
    >>> structure = rf.from_matrices(
    ...     mass=[20e3], stiffness=[[4e6]], heights=[3.0], base_mass=20e3,
    ...     half_width=0.6, damping_ratio=0.02
    ... )
    >>> isinstance(structure, rf.ModalStructure)
    True
    >>> structure.modes.omega.round(3)
    array([14.142])
    """

    modes: MassNormalisedModes
    base_mass: float
    half_width: float
    damping_ratio: Array

    def modal(self, n_modes: SupportsIndex | None = None) -> ModalProperties:
        """Return the first `n_modes` modes on a fixed base (default: all).

        Raises
        ------
        InputError
            If `n_modes` is not from 1 to the structure's number of modes.
        """
        modes = self.modes.modal()
        return modes if n_modes is None else modes.truncated(n_modes)

    def rocking(self, n_modes: SupportsIndex | None = None) -> RockingProperties:
        """Return the parameters of the rocking structure with its first `n_modes` modes (default: all).

        Raises
        ------
        InputError
            If the structure has fewer modes than `n_modes`.
        """
        return self.modes.rocking(self.base_mass, self.half_width, self.damping_ratio, n_modes)


@dataclass(frozen=True, init=False)
class Eccentric(ModifiedStructure):
    """A structure whose masses lie on a vertical axis off the middle of its base.

    It rotates about the right edge of the base, at a distance B - e from the axis, or about the left edge, at B + e.
    Inertia and resisting moment differ between the two sides, and the base lifts sooner about the nearer edge. The
    modes on a fixed base do not change.

    Attributes
    ----------
    structure
        Any structure: a `Frame`, a `rigid_block`, a `Restrained` one ...
    eccentricity : float
        Distance e of the axis to the right of the middle of the base in m; negative to the left. Its magnitude is
        smaller than B.

    Raises
    ------
    InputError
        If the eccentricity is not a number or not within the base, or `structure` is not a structure.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(
    ...     n_stories=5, story_height=3.0, story_mass=40e3, base_mass=40e3,
    ...     stiffness_ratio=float("inf"),
    ...     period=1.0, aspect_ratio=8.0, damping_ratio=0.02,
    ... )
    >>> props = rf.Eccentric(frame, eccentricity=0.2).rocking()
    >>> round(props.pivot(1).arm, 3), round(props.pivot(-1).arm, 3)
    (1.118, 1.518)
    """

    in_file = InFile(key="eccentricity", words=ECCENTRICITY, value=float, argument="eccentricity", nothing=0.0)
    of_properties = True

    structure: Structure | RockingProperties
    eccentricity: float

    def __init__(self, structure: Structure | RockingProperties, eccentricity: float) -> None:
        e = checked_finite("eccentricity", eccentricity, "m")
        vars(self).update(structure=checked_structure(structure), eccentricity=e)
        self.check()  # whether the axis and the tendons are within the base

    def _changes(self, base: RockingProperties) -> dict[str, Any]:
        del base
        return {"eccentricity": self.eccentricity}


@dataclass(frozen=True, init=False)
class Restrained(ModifiedStructure):
    """A structure with elements between its base and the ground: tendons, dissipators, viscous and friction dampers.

    Unbonded post-tensioned tendons increase the resisting moment and add a restoring rotational stiffness (Silva &
    Stojadinović 2024, Section 4.1); the other elements take energy out of the rocking. The modes on a fixed base do
    not change.

    Attributes
    ----------
    structure
        Any structure: a `Frame`, a `rigid_block`, an `Eccentric` one ...
    elements : tuple of elements
        Any number, such as a `Tendon` or a `YieldingDissipator`, at any positions within the base; of a rigid block
        also ties from any height.

    Raises
    ------
    InputError
        If an element is outside the base, or `structure` is not a structure.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(
    ...     n_stories=5, story_height=3.0, story_mass=40e3, base_mass=40e3,
    ...     stiffness_ratio=float("inf"),
    ...     period=1.0, aspect_ratio=8.0, damping_ratio=0.02,
    ... )
    >>> restrained = rf.Restrained(frame,
    ...     rf.Tendon(initial_force=500e3, stiffness=20e6))
    >>> held, free = (each.rocking() for each in (restrained, frame))
    >>> ratio = held.resisting_moment / free.resisting_moment
    >>> round(ratio, 3)
    1.212
    """

    of_properties = True

    structure: Structure | RockingProperties
    elements: tuple[BaseElement, ...]

    def __init__(self, structure: Structure | RockingProperties, elements: BaseElement | Iterable[BaseElement]) -> None:
        vars(self).update(structure=checked_structure(structure), elements=base_element_tuple(elements))
        self.check()  # whether they are within the base

    @property
    def tendons(self) -> tuple[Tendon, ...]:
        """The tendons among the elements."""
        return tendons_among(self.elements)

    def _changes(self, base: RockingProperties) -> dict[str, Any]:
        del base
        return {"elements": self.elements}


def structure_warnings(structure: Any) -> tuple[str, ...]:
    """Return a text about each value of a structure that looks like a wrong unit; nothing is refused.

    A first period on a fixed base beyond 10 s, and a mass at the tip of less than a tenth of its column's,
    such as one given in tonnes. `rockflex modes` and `rockflex run` print these texts.

    Parameters
    ----------
    structure
        Any structure, such as a `Frame`, or a `RockingProperties`.

    Raises
    ------
    InputError
        If it is neither.

    Examples
    --------
    >>> import rockflex as rf
    >>> column = rf.CantileverWithTipMass(
    ...     height=12.0, tip_mass=60.0, mass_per_length=4e3,
    ...     bending_stiffness=2e9, base_mass=50e3, half_width=1.5,
    ...     damping_ratio=0.02,
    ... )
    >>> for warning in rf.structure_warnings(column):
    ...     print(warning)
    The tip has a mass of 60 kg, less than a tenth of the 48000 kg of its column. Masses are in kg: a tonne is 1000 kg.
    """
    found, inner = _period_warnings(checked_structure(structure).rocking()), innermost_structure(structure)
    return found + (inner.unit_warnings() if isinstance(inner, AssembledStructure) else ())


def _period_warnings(properties: RockingProperties) -> tuple[str, ...]:
    if properties.n_modes == 0:
        return ()
    period = 2.0 * math.pi / float(properties.omega[0])
    if period <= MAX_PERIOD:
        return ()
    return (
        translated(
            "The first period on a fixed base is {period:.4g} s, longer than usual for buildings, towers and bridges, "
            "which stay below {usual:g} s. Check the units: kg, m, s and N, so EI in N m² and no kN.",
            period=period,
            usual=MAX_PERIOD,
        ),
    )
