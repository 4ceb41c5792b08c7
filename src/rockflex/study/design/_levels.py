"""Designs of a base: its half width, and the tendon that holds it down."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from rockflex._checks import instance, positive, real_or_nan
from rockflex._constants import GRAVITY
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.modal import RockingProperties, Tendon
from rockflex.study._arguments import described, positive_numbers
from rockflex.study.plan._bench import check_different

RANGE = ("smallest", "largest", "count")
MOST = 10_000  # bases


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
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=1e9,
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
        force = positive("prestress_ratio", self.prestress_ratio, "W", zero=True)
        stiffness = positive("stiffness_ratio", self.stiffness_ratio, "L_0^r g/B²", zero=True)
        instance("name", self.name, str)
        words = f"F₀ = {force:.6g} W, k = {stiffness:.6g} L₀ʳg/B²" if force or stiffness else "no tendon"
        vars(self).update(prestress_ratio=force, stiffness_ratio=stiffness, name=self.name or words)
        if self.yield_ratio is not None:
            limit = positive("yield_ratio", self.yield_ratio, "W")
            vars(self).update(yield_ratio=limit)
            if force > limit:
                raise InputError(
                    f"prestress_ratio must not exceed yield_ratio, {limit:g}, but {force:g} was given. A tendon that "
                    "has yielded is not elastic."
                )

    def held(self, properties: RockingProperties) -> RockingProperties:
        """The structure with this tendon in place of any other; without one if both ratios are zero."""
        others = tuple(each for each in properties.elements if not isinstance(each, Tendon))
        if not (self.prestress_ratio or self.stiffness_ratio):
            return replace(properties, elements=others)
        weight = properties.m_tot * GRAVITY
        stiffness = self.stiffness_ratio * properties.l0r * GRAVITY / properties.half_width**2
        limit = None if self.yield_ratio is None else self.yield_ratio * weight
        tendon = Tendon(self.prestress_ratio * weight, stiffness, yield_force=limit)
        return replace(properties, elements=(tendon, *others))


class Design(NamedTuple):
    """A structure on one base with one tendon; `tendon` is the name of its level."""

    name: str
    tendon: str
    properties: RockingProperties


def designs_of(
    properties: RockingProperties, half_widths: Any, levels: Sequence[TendonLevel], base_mass_per_width: float
) -> list[Design]:
    """The structure on every base with every tendon, tendons outermost, the narrowest base first.

    Without levels the structure keeps its own tendons, with their forces in N and stiffnesses in N/m.

    Raises
    ------
    InputError
        If a half width is not positive or occurs twice, levels share a name or are added to the structure's own
        tendons, a tendon would be outside a base, or a base would have no mass left.
    """
    widths = half_widths_of(half_widths)
    per_width = positive("base_mass_per_width", base_mass_per_width, "kg/m", zero=True)
    for place, level in enumerate(levels):
        if not isinstance(level, TendonLevel):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise InputError(f"tendons[{place}] is {described(level)}. Expected a TendonLevel.")
    check_different("tendons", [level.name for level in levels])
    if levels and properties.tendons:
        raise InputError(
            "The structure has its own tendons, and levels of tendons are given too. Leave out one or the other: "
            "levels replace the structure's tendons."
        )
    found: list[Design] = []
    for level in levels or (None,):
        for width in widths:
            name = f"B = {width:.6g} m" + (f", {level.name}" if level and len(levels) > 1 else "")
            try:
                based = on_base(properties, width, per_width)
                based = based if level is None else level.held(based)
            except InputError as error:
                raise InputError(f"{name}: {error}") from error
            own = "no tendon" if not properties.tendons else "its own tendons"
            found.append(Design(name, own if level is None else level.name, based))
    return found


def on_base(properties: RockingProperties, half_width: float, per_width: float) -> RockingProperties:
    """The structure on another base, which gains `per_width` in kg for each metre of its width 2 B.

    The mass of the base has no height, so it changes neither L_0^r nor the modes.
    """
    based = properties.with_half_width(half_width)
    added = 2.0 * per_width * (half_width - properties.half_width)
    base = None if based.base_mass is None else based.base_mass + added
    return replace(based, m_tot=based.m_tot + added, i_theta=based.i_theta + added * half_width**2, base_mass=base)


def half_widths_of(given: Any) -> list[float]:
    """Half widths in m, rising: a sequence, or a mapping with `smallest`, `largest` and `count`, both ends included.

    Raises
    ------
    InputError
        If one is not positive, or occurs twice.
    """
    import numpy as np

    if isinstance(given, dict):
        smallest, largest, count = (real_or_nan(given.get(key)) for key in RANGE)
        sound = 0.0 < smallest < largest < np.inf and 2.0 <= count <= MOST and count == int(count)
        if set(given) != set(RANGE) or not sound:
            raise InputError(
                "half_widths must be a list in m, or a range {smallest = 1.0, largest = 3.0, count = 9} of "
                f"positive numbers in m, 2 to {MOST} of them, but {shown(given)} was given."
            )
        given = np.linspace(smallest, largest, int(count))
    widths = sorted(positive_numbers("half_widths", given, "m"))
    check_different("half_widths", [f"{width:.6g}" for width in widths])
    return widths
