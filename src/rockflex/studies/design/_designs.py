"""Designs of a base: half widths, levels of a tendon, and factors on tendons and dissipators."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import product
from math import prod
from typing import Any, Literal, NamedTuple

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_instance, checked_positive, checked_whole_number, is_one_of, real_or_nan
from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.structure._base_element import BaseElement
from rockflex.structure._elements import Tendon
from rockflex.structure._rocking import RockingProperties
from rockflex.studies._arguments import checked_positive_numbers
from rockflex.studies._run_matrix import check_different_values

RANGE = ("smallest", "largest", "count")
MAX_BASES = 10_000  # bases


@dataclass(frozen=True)
class TendonLevel:
    """A tendon on the axis of the structure, given by ratios that mean the same for every base.

    With W = m_tot g and L_0^r g/B² of the design itself, M_r is (1 + prestress_ratio) W B, and the static moment while
    rocking changes by (stiffness_ratio - 1) L_0^r g a radian: with 0 it falls as without a tendon, with 1 it stays
    constant, above 1 it rises (compare Eqs. 23 and 24 of Silva & Stojadinović 2024). EA/L in N/m is therefore smaller
    for a wider base. Runs with a ratio within 1 % of 1 take longer, because the adaptive engine integrates them. On an
    eccentric base, B is still half the width, and each ratio lies between its values about the two edges.

    Attributes
    ----------
    prestress_ratio : float
        Initial force over W; zero or positive.
    stiffness_ratio : float
        EA/L over L_0^r g/B²; zero or positive.
    yield_ratio : float or None
        Yield force over W, at least `prestress_ratio`; the utilisation of the tendon needs it.
    name : str
        Default: the ratios in words.

    Raises
    ------
    InputError
        If a value is outside its range.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3,
    ...     base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> level = rf.TendonLevel(prestress_ratio=0.2, stiffness_ratio=0.5)
    >>> (tendon,) = level.held(frame.rocking()).tendons
    >>> print(f"{tendon.initial_force:.3g}, {tendon.stiffness:.3g}")
    3.14e+05, 2.8e+06
    """

    prestress_ratio: float = 0.0
    stiffness_ratio: float = 0.0
    yield_ratio: float | None = None
    name: str = ""

    def __post_init__(self) -> None:
        force = checked_positive("prestress_ratio", self.prestress_ratio, "W", zero=True)
        stiffness = checked_positive("stiffness_ratio", self.stiffness_ratio, "L_0^r g/B²", zero=True)
        checked_instance("name", self.name, str)
        words = f"F₀ = {force:.6g} W, k = {stiffness:.6g} L₀ʳg/B²" if force or stiffness else "no tendon"
        vars(self).update(prestress_ratio=force, stiffness_ratio=stiffness, name=self.name or words)
        if self.yield_ratio is not None:
            limit = checked_positive("yield_ratio", self.yield_ratio, "W")
            vars(self).update(yield_ratio=limit)
            if force > limit:
                raise InputError(
                    f"prestress_ratio must not exceed yield_ratio, {limit:g}, but {force:g} was given. A tendon that "
                    "has yielded is not elastic."
                )

    def held(self, properties: RockingProperties) -> RockingProperties:
        """The structure with this tendon in place of any other; without one if both ratios are zero."""
        others = tuple(each for each in properties.elements if each.attached or not each.prestressed)
        if not (self.prestress_ratio or self.stiffness_ratio):
            return replace(properties, elements=others)
        weight = properties.m_tot * GRAVITY
        stiffness = self.stiffness_ratio * properties.l0r * GRAVITY / properties.half_width**2
        limit = None if self.yield_ratio is None else self.yield_ratio * weight
        tendon = Tendon(initial_force=self.prestress_ratio * weight, stiffness=stiffness, yield_force=limit)
        return replace(properties, elements=(tendon, *others))


class BaseDesign(NamedTuple):
    """A structure on one base with one tendon; `tendon` is the name of its level."""

    name: str
    tendon: str
    properties: RockingProperties


def designs_of_structure(
    properties: RockingProperties, half_widths: Any, levels: Sequence[TendonLevel], base_mass_per_width: float
) -> list[BaseDesign]:
    """The structure on every base with every tendon, tendons outermost, the narrowest base first.

    Without levels the structure keeps its own tendons, with their forces in N and stiffnesses in N/m.
    """
    widths = checked_half_widths(half_widths)
    per_width = checked_positive("base_mass_per_width", base_mass_per_width, "kg/m", zero=True)
    check_different_values("tendons", [level.name for level in levels])
    if levels and properties.tendons:
        raise InputError(
            "The structure has its own tendons, and levels of tendons are given too. Leave out one or the other: "
            "levels replace the structure's tendons."
        )
    found: list[BaseDesign] = []
    for level in levels or (None,):
        for width in widths:
            name = f"B = {width:.6g} m" + (f", {level.name}" if level and len(levels) > 1 else "")
            try:
                widened = structure_on_base_width(properties, width, per_width)
                widened = widened if level is None else level.held(widened)
            except InputError as error:
                raise InputError(f"{name}: {error}") from error
            own = "no tendon" if not properties.tendons else "its own tendons"
            found.append(BaseDesign(name, own if level is None else level.name, widened))
    return found


def facts_of_design(p: RockingProperties) -> dict[str, float]:
    """The numbers that describe the base and the tendons of a design, by the names of columns."""
    height = float(p.effective_height[0]) if p.n_modes else p.l0r / p.m_tot
    return {
        "half_width": p.half_width,
        "aspect_ratio": height / p.half_width,
        "prestress_ratio": p.prestress / (p.m_tot * GRAVITY),
        "resisting_moment": p.resisting_moment,
    }


def structure_on_base_width(properties: RockingProperties, half_width: float, per_width: float) -> RockingProperties:
    """The structure on another base, which gains `per_width` in kg for each metre of its width 2 B.

    The mass of the base has no height, so it changes neither L_0^r nor the modes.
    """
    widened = properties.with_half_width(half_width)
    added = 2.0 * per_width * (half_width - properties.half_width)
    base = None if widened.base_mass is None else widened.base_mass + added
    return replace(
        widened, m_tot=widened.m_tot + added, i_theta=widened.i_theta + added * half_width**2, base_mass=base
    )


def checked_half_widths(given: Any) -> list[float]:
    """Half widths in m, rising: a sequence, or a mapping with `smallest`, `largest` and `count`, both ends included."""
    if isinstance(given, dict):
        smallest, largest, count = (real_or_nan(given.get(key)) for key in RANGE)
        sound = 0.0 < smallest < largest < np.inf and 2.0 <= count <= MAX_BASES and count == int(count)
        if set(given) != set(RANGE) or not sound:
            raise InputError(
                "half_widths must be a list in m, or a range {smallest = 1.0, largest = 3.0, count = 9} of "
                f"positive numbers in m, 2 to {MAX_BASES} of them, but {shown(given)} was given."
            )
        given = np.linspace(smallest, largest, int(count))
    widths = sorted(checked_positive_numbers("half_widths", given, "m"))
    check_different_values("half_widths", [f"{width:.6g}" for width in widths])
    return widths


Scaling = Literal["size", "force"]
Point = tuple[int, int, int]  # of the finest grid: numbers of a half width and of both factors

VARIABLES = ("half_width", "tendon_factor", "dissipator_factor")
FACTORS = ("tendon_factors", "dissipator_factors")
MAX_REFINEMENTS, MAX_DESIGNS, MAX_POINTS = 8, 1000, 300_000


@dataclass(frozen=True)
class DesignSearch:
    """The half widths and the factors on the elements among which a search looks, and how many designs it may try.

    The search first runs every combination of the values given. Each refinement then halves the distance between
    neighbouring values and runs at most `designs_per_refinement` more, where the cheapest designs that meet the targets
    are expected.

    A factor multiplies the elements of the structure itself: 1 is the structure as given, 0 takes them away. When the
    width changes, every element keeps its place relative to the edges: one at an edge stays there. Viscous dampers move
    too, but are not scaled.

    Attributes
    ----------
    half_widths : tuple of float
        B in m, or a range as a dictionary of `smallest`, `largest` and `count`.
    tendon_factors, dissipator_factors : tuple of float
        Factors on all tendons, and on all fuses and friction dampers; or a range.
    tendon_scaling : {"size", "force"}
        What `tendon_factors` multiply: ``"size"``, the initial force, stiffness and yield force, as of a larger
        cross-section at the same stress; ``"force"``, the initial force alone.
    dissipator_scaling : {"size", "force"}
        ``"size"``: stiffness and yield force; ``"force"``: the yield force alone. A friction damper has only its force.
    base_mass_per_width : float
        As in `run_design`.
    refinements : int
        Number of refinements, from 0 to 8.
    designs_per_refinement : int
        The largest number of designs that each of them adds.

    Raises
    ------
    InputError
        If a value is out of range or occurs twice, no variable has two values, or the finest grid is too large.

    Examples
    --------
    >>> import rockflex as rf
    >>> search = rf.DesignSearch([1.0, 1.5, 2.0], tendon_factors=[0.5, 1.0, 2.0],
    ...     refinements=2)
    >>> search.n_first, search.n_designs
    (9, 25)
    """

    half_widths: tuple[float, ...]
    tendon_factors: tuple[float, ...] = (1.0,)
    dissipator_factors: tuple[float, ...] = (1.0,)
    tendon_scaling: Scaling = "size"
    dissipator_scaling: Scaling = "size"
    base_mass_per_width: float = 0.0
    refinements: int = 4
    designs_per_refinement: int = 8

    def __post_init__(self) -> None:
        given: Any = self.half_widths
        vars(self).update(
            half_widths=tuple(checked_half_widths(given)),
            tendon_factors=checked_design_factors("tendon_factors", self.tendon_factors),
            dissipator_factors=checked_design_factors("dissipator_factors", self.dissipator_factors),
            base_mass_per_width=checked_positive("base_mass_per_width", self.base_mass_per_width, "kg/m", zero=True),
            refinements=checked_whole_number("refinements", self.refinements, 0, MAX_REFINEMENTS),
            designs_per_refinement=checked_whole_number("designs_per_refinement", self.designs_per_refinement, 1),
        )
        for name in ("tendon_scaling", "dissipator_scaling"):
            if not is_one_of(getattr(self, name), ("size", "force")):
                raise InputError(f'{name} must be "size" or "force", but {shown(getattr(self, name))} was given.')
        if self.n_first == 1:
            raise InputError(
                "There is only one design to look at. Give two values or more of half_widths, tendon_factors or "
                "dissipator_factors."
            )
        if self.n_designs > MAX_DESIGNS:
            raise InputError(
                f"The search would try {self.n_designs} designs, but at most {MAX_DESIGNS} are possible: "
                f"{self.n_first} of the values given, and {self.designs_per_refinement} in each of {self.refinements} "
                "refinements. Give fewer values; refinements find the values in between."
            )
        points = prod((len(values) - 1) * 2**self.refinements + 1 for values in self.values)
        if points > MAX_POINTS:
            raise InputError(
                f"The finest grid would have {points} designs, but at most {MAX_POINTS} are possible. Give fewer "
                f"values or fewer refinements than {self.refinements}."
            )

    @property
    def values(self) -> tuple[tuple[float, ...], tuple[float, ...], tuple[float, ...]]:
        """The values given for each variable."""
        return self.half_widths, self.tendon_factors, self.dissipator_factors

    @property
    def varied(self) -> list[int]:
        """Numbers of the variables that have more than one value."""
        return [axis for axis, values in enumerate(self.values) if len(values) > 1]

    @property
    def n_first(self) -> int:
        """Number of designs that are run first: all combinations of the values given."""
        return prod(map(len, self.values))

    @property
    def n_designs(self) -> int:
        """The largest number of designs in all."""
        return self.n_first + self.refinements * self.designs_per_refinement

    def grid(self, level: int) -> list[list[int]]:
        """Numbers of each variable on the grid of a refinement; 0 is that of the values given."""
        step = 2 ** (self.refinements - level)
        return [list(range(0, (len(values) - 1) * 2**self.refinements + 1, step)) for values in self.values]

    def first(self) -> list[Point]:
        """Points of the values given, dissipators innermost."""
        widths, tendons, dissipators = self.grid(0)
        return [*product(widths, tendons, dissipators)]

    def at(self, points: Any) -> Array:
        """Values of the variables at points of the finest grid, shape (n, 3)."""
        places = np.reshape(points, (-1, 3)) / 2**self.refinements
        columns = [np.interp(places[:, axis], range(len(values)), values) for axis, values in enumerate(self.values)]
        return np.column_stack(columns)

    def points_of(self, values: Array) -> list[Point]:
        """Points of the finest grid with these values of the variables, shape (n, 3)."""
        columns = [
            np.interp(values[:, axis], given, np.arange(len(given))) * 2**self.refinements
            for axis, given in enumerate(self.values)
        ]
        return [(int(b), int(tendon), int(dissipator)) for b, tendon, dissipator in np.rint(columns).T]

    def built(self, properties: RockingProperties, point: Point) -> RockingProperties:
        """The structure as the design of a point.

        Raises
        ------
        InputError
            If the design is impossible; the message names its values.
        """
        width, tendons, dissipators = (float(value) for value in self.at(point)[0])
        try:
            moved = [element_moved_with_base_edges(each, properties, width) for each in properties.elements]
            scaled = [self._scaled(each, tendons, dissipators) for each in moved]
            widened = structure_on_base_width(replace(properties, elements=()), width, self.base_mass_per_width)
            return replace(widened, elements=tuple(each for each in scaled if each is not None))
        except InputError as error:
            raise InputError(
                f"B = {width:.6g} m, tendons times {tendons:.6g}, dissipators times {dissipators:.6g}: {error}"
            ) from error

    def check_elements(self, properties: RockingProperties) -> None:
        """Raise an InputError if factors are given for elements that the structure lacks."""
        tendons = any(each.prestressed for each in properties.elements)
        dissipators = any(each.dissipator_force is not None for each in properties.elements)
        names = {"tendon": tendons, "fuse or friction damper": dissipators}
        for factors, (name, known) in zip(FACTORS, names.items(), strict=True):
            if getattr(self, factors) != (1.0,) and not known:
                raise InputError(
                    f"{factors} were given, but the structure has no {name} that they could multiply. A search varies "
                    "half_widths, tendon_factors and dissipator_factors; strengths of stories and leaning masses stay "
                    "as they are: vary these in a MonteCarloStudy, or search each structure."
                )

    def _scaled(self, element: BaseElement, tendons: float, dissipators: float) -> BaseElement | None:
        if element.prestressed:
            return element.scaled(tendons, size=self.tendon_scaling == "size")
        return element.scaled(dissipators, size=self.dissipator_scaling == "size")


def element_moved_with_base_edges(
    element: BaseElement, properties: RockingProperties, half_width: float
) -> BaseElement:
    """The element at the same place relative to the edges of a base of another width.

    The middle of the base is at -e from the axis of the masses, from which positions are measured.
    """
    e, ratio = properties.eccentricity, half_width / properties.half_width
    return (
        element if ratio == 1.0 or element.attached else replace(element, position=(element.position + e) * ratio - e)
    )


def total_dissipator_force(properties: RockingProperties) -> float:
    """ΣF_y of all fuses and friction dampers in N."""
    return sum(each.dissipator_force or 0.0 for each in properties.elements)


def checked_design_factors(name: str, given: Any) -> tuple[float, ...]:
    """Factors, rising: a sequence, or a mapping with `smallest`, `largest` and `count`, both ends included."""
    if isinstance(given, dict):
        smallest, largest, count = (real_or_nan(given.get(key)) for key in RANGE)
        if set(given) != set(RANGE) or not (0.0 <= smallest < largest < np.inf and count in range(2, 1001)):
            raise InputError(
                f"{name} must be a list of factors, or a range {{smallest = 0.5, largest = 2.0, count = 4}} of two to "
                f"1000 of them, zero or positive, but {shown(given)} was given."
            )
        given = np.linspace(smallest, largest, int(count)).tolist()
    listed = list(given) if isinstance(given, Iterable) and not isinstance(given, str) else [given]
    factors = sorted(real_or_nan(value) for value in listed)
    if not factors or not all(0.0 <= factor < np.inf for factor in factors) or len(set(factors)) < len(factors):
        raise InputError(
            f"{name} must be one or more different factors, zero or positive, on the forces of the structure, but "
            f"{shown(given)} was given."
        )
    return tuple(factors)
