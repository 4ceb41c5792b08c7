"""Tendons, yielding dissipators, viscous and friction dampers: under the base, between floors or from a height."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any, ClassVar, Self

from rockflex.foundation.descriptions import Described, described
from rockflex.foundation.errors import InputError
from rockflex.foundation.language import translated
from rockflex.foundation.shown import shown
from rockflex.structure._attachment import Position
from rockflex.structure._base_element import BaseElement
from rockflex.structure._branches import (
    ElasticElement,
    Element,
    FrictionElement,
    ViscousElement,
    YieldingElement,
)

_RATIO_REMEDY = "It is the stiffness after yielding over the elastic stiffness: 2 % is 0.02."
PostYieldRatio = Annotated[
    float,
    Described("the stiffness after yielding over the elastic one", rule="from 0 to below 1", remedy=_RATIO_REMEDY),
]
TendonYieldRatio = Annotated[
    float | None,
    Described(
        "the stiffness after yielding over the elastic one (default: the tendon stays elastic)",
        rule="from 0 to below 1",
        remedy=_RATIO_REMEDY,
        note="A tendon that yields keeps its plastic stretch, loses prestress and becomes slack at zero force.",
    ),
]


HAIR = 1e-14  # m: a tendon without prestress is this far from slack, so that rounding at rest does not make it so


@described
@dataclass(frozen=True, repr=False)
class Tendon(BaseElement):
    """An unbonded, elastic, vertical tendon from the structure through the base into the ground.

    While the base rocks about a pivot at the distance r, the tendon is stretched by the gap that opens at its place,
    2 r sin(|θ|/2), to first order r |θ|, as it is guided without friction on both sides of the joint. Its force
    increases linearly from the initial force (Vassiliou & Makris 2015, doi 10.1061/(ASCE)EM.1943-7889.0000953). It
    pulls and never pushes: it goes slack at zero force. On rigid ground no rotation makes an elastic tendon between the
    edges of the base slack; on springs the base can sink and shorten it.

    Raises
    ------
    InputError
        If a value is outside its range.

    Examples
    --------
    >>> import rockflex as rf
    >>> tendon = rf.Tendon(initial_force=500e3, stiffness=20e6, yield_force=900e3)
    >>> round(tendon.initial_force / tendon.yield_force, 3)
    0.556
    """

    title: ClassVar[str] = "Tendon"
    symbol: ClassVar[str] = "tendons"
    prestressed: ClassVar[bool] = True

    initial_force: Annotated[
        float, Described("the force while the base stands on the ground", "N", rule="zero or positive")
    ]
    stiffness: Annotated[float, Described("EA/L over the unbonded length", "N/m", rule="zero or positive")]
    position: Position = 0.0
    yield_force: Annotated[
        float | None,
        Described(
            "the force at which the tendon yields",
            "N",
            rule="positive",
            note="Without `post_yield_ratio` the tendon stays elastic, and its largest force is compared with it.",
        ),
    ] = None
    post_yield_ratio: TendonYieldRatio = None
    rupture_elongation: Annotated[
        float | None,
        Described(
            "the elongation at which the tendon breaks",
            "m",
            rule="positive",
            note="For good, counted from the base in contact; one that does not yield is elastic until it snaps. "
            "Default: it never does.",
        ),
    ] = None

    def __post_init__(self) -> None:
        self.check_attachment()
        if self.yield_force is not None and self.initial_force > self.yield_force:
            raise InputError(
                f"initial_force must not exceed yield_force, {self.yield_force:g} N, but {self.initial_force:g} N was "
                "given. A tendon that has yielded is not elastic; check the units too.",
                field="initial_force",
            )
        if self.post_yield_ratio is not None and (self.yield_force is None or self.stiffness == 0.0):
            raise InputError(
                "post_yield_ratio needs the yield_force in N of a tendon with stiffness, but "
                f"yield_force = {shown(self.yield_force)} and stiffness = {self.stiffness:g} N/m were given.",
                field="yield_force" if self.yield_force is None else "stiffness",
            )
        if self.rupture_elongation is not None and self.stiffness == 0.0:
            raise InputError(
                "rupture_elongation needs a tendon with stiffness, but stiffness = 0 N/m was given. Give EA/L in N/m, "
                "or leave rupture_elongation out.",
                field="stiffness",
            )
        if self.rupture_elongation is not None and self.post_yield_ratio is not None and self.yield_force is not None:
            yields_at = (self.yield_force - self.initial_force) / self.stiffness
            _check_rupture_elongation(self.rupture_elongation, yields_at)

    @property
    def yield_words(self) -> tuple[str, str]:
        """The words of a report for one that did not yield, and for one that did."""
        return translated("elastic"), translated("beyond F_y" if self.post_yield_ratio is None else "yielded")

    def branched(self) -> Element:
        """Return it as its branches: elastic, slack, and those of a bar that yields or breaks."""
        if not self.dissipates:
            return ElasticElement(self.stiffness, self.initial_force, self.place)
        stretched = max(self.initial_force / self.stiffness, HAIR)
        limit, ratio = self.yield_force, self.post_yield_ratio
        if limit is None or ratio is None:  # it snaps before any force at which it would yield
            limit, ratio = 2.0 * self.stiffness * (stretched + self.breaks_at), 0.0
        return YieldingElement(
            self.stiffness,
            limit,
            ratio,
            self.place,
            stretched=stretched,
            pulls_only=True,
            rupture=self.breaks_at,
        )

    def slow_force(self, elongation: float) -> float:
        """Return the force in N as built, stretched slowly by an elongation in m."""
        if elongation >= self.breaks_at:
            return 0.0
        pull = self.stiffness * elongation + self.initial_force
        return max(_force_beyond_yield(pull, self.yield_force, self.post_yield_ratio), 0.0)

    def extremes(self, low: float, high: float, speed: float = 0.0) -> tuple[float, bool]:  # noqa: ARG002
        """Return the largest force in N, and whether it yields; if it stays elastic, whether it exceeds F_y."""
        force = self.initial_force + self.stiffness * min(high, self.breaks_at)
        yields = self.yield_force is not None and force > self.yield_force
        if self.post_yield_ratio is not None:
            stretch = self.initial_force / self.stiffness + min(high, self.breaks_at)
            force = _force_in_first_loading(stretch, self.stiffness, self.yield_force or 0.0, self.post_yield_ratio)
        return force, yields

    def remaining_prestress(self, plastic_stretch: float) -> float:
        """Return the force in N in contact after a plastic stretch in m, which is NaN if it is broken."""
        lost = (1.0 - (self.post_yield_ratio or 0.0)) * self.stiffness * plastic_stretch
        return 0.0 if math.isnan(plastic_stretch) else max(self.initial_force - lost, 0.0)

    @property
    def force_at_rest(self) -> float:
        """F_0 in N."""
        return self.initial_force

    @property
    def dissipates(self) -> bool:
        """Whether it yields or breaks."""
        return self.post_yield_ratio is not None or self.rupture_elongation is not None

    @property
    def recentres(self) -> bool:
        """Whether it helps to close the base: it pulls."""
        return True

    @property
    def largest_stiffness(self) -> float:
        """K in N/m."""
        return self.stiffness

    @property
    def restoring_stiffness(self) -> float:
        """K in N/m."""
        return self.stiffness

    def scaled(self, factor: float, *, size: bool) -> Self | None:
        """Return it with a factor on its size or on its initial force; None where nothing is left of it."""
        force = self.initial_force * factor
        if not size:
            return replace(self, initial_force=force)
        if factor == 0.0:
            return None
        limit = None if self.yield_force is None else self.yield_force * factor
        return replace(self, initial_force=force, stiffness=self.stiffness * factor, yield_force=limit)

    def compared_parameters(self) -> dict[str, Any]:
        """Return its parameters; the yield force is only compared with, unless it yields."""
        found = super().compared_parameters()
        return found | {"yield_force": None} if self.post_yield_ratio is None else found


def _force_beyond_yield(force: float, limit: float | None, ratio: float | None) -> float:
    """Return what is left in N of the force of an elastic bar if it yields at a limit."""
    if ratio is None or limit is None or abs(force) <= limit:
        return force
    return math.copysign(limit + ratio * (abs(force) - limit), force)


def _force_in_first_loading(stretch: float, stiffness: float, limit: float, ratio: float) -> float:
    """Return the force in N of a bar that has never yielded at a stretch in m, counted from zero force."""
    elastic = stiffness * stretch
    return elastic if elastic <= limit else max(ratio * elastic + (1.0 - ratio) * limit, limit)


def _check_rupture_elongation(limit: float, yields_at: float) -> None:
    if limit <= yields_at:
        raise InputError(
            f"rupture_elongation must be beyond the elongation at yield, {yields_at:.4g} m, but {limit:g} m was given. "
            "Check the units: stiffness is in N/m, forces are in N and elongations in m.",
            field="rupture_elongation",
        )


@described
@dataclass(frozen=True, repr=False)
class YieldingDissipator(BaseElement):
    """A fuse between the base and the ground that yields in tension and compression, with kinematic hardening.

    At a distance r from the pivot it is stretched by the gap that opens there, δ = 2 r sin(|θ|/2), to first order
    r |θ|, as it is held on both sides of the joint and bends freely. Its force is F = α k δ + (1 - α) z, where z
    follows k δ and is limited to ± F_y. The first yield is therefore at F = F_y. A fuse that has yielded keeps a force
    while the base is closed, which shifts the moment at which the base lifts.

    Raises
    ------
    InputError
        If a value is outside its range.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
    >>> fused = rf.Restrained(frame,
    ...     rf.YieldingDissipator(stiffness=2e7, yield_force=200e3))
    >>> fused.rocking().self_centring, round(fused.rocking().recentring_ratio, 2)
    (True, 5.89)
    """

    title: ClassVar[str] = "Fuse"
    symbol: ClassVar[str] = "fuse"
    fuse: ClassVar[bool] = True

    stiffness: Annotated[float, Described("the elastic stiffness", "N/m", rule="positive")]
    yield_force: Annotated[float, Described("the force at which the fuse yields", "N", rule="positive")]
    post_yield_ratio: PostYieldRatio = 0.0
    position: Position = 0.0
    tension_only: Annotated[
        bool,
        Described(
            "whether the fuse cannot push",
            rule="flag",
            note="It buckles or is unhooked then, so that F = max(0, ·).",
        ),
    ] = False
    rupture_elongation: Annotated[
        float | None,
        Described(
            "the elongation at which the fuse breaks",
            "m",
            rule="positive",
            note="For good; beyond F_y/k. Default: it never does.",
        ),
    ] = None

    def __post_init__(self) -> None:
        self.check_attachment()
        if self.rupture_elongation is not None:
            _check_rupture_elongation(self.rupture_elongation, self.yield_force / self.stiffness)

    @property
    def words(self) -> str:
        """Its name in a sentence."""
        return "fuse"

    @property
    def yield_words(self) -> tuple[str, str]:
        """The words of a report for one that did not yield, and for one that did."""
        return translated("elastic"), translated("yielded")

    def branched(self) -> Element:
        """Return it as its branches: elastic, yielding to either side, slack and broken."""
        return YieldingElement(
            self.stiffness,
            self.yield_force,
            self.post_yield_ratio,
            self.place,
            pulls_only=self.tension_only,
            rupture=self.breaks_at,
        )

    def slow_force(self, elongation: float) -> float:
        """Return the force in N as built, stretched slowly by an elongation in m."""
        if elongation >= self.breaks_at:
            return 0.0
        pull = _force_beyond_yield(self.stiffness * elongation, self.yield_force, self.post_yield_ratio)
        return max(pull, 0.0) if self.tension_only else pull

    def extremes(self, low: float, high: float, speed: float = 0.0) -> tuple[float, bool]:  # noqa: ARG002
        """Return the largest |F| in N, and whether it yields."""
        pushed = 0.0 if self.tension_only else -low
        k, limit, ratio = self.stiffness, self.yield_force, self.post_yield_ratio
        forces = (_force_in_first_loading(each, k, limit, ratio) for each in (min(high, self.breaks_at), pushed))
        return max(forces), k * max(high, pushed) > limit

    @property
    def dissipates(self) -> bool:
        """Whether it yields: always."""
        return True

    @property
    def locked_force(self) -> float:
        """(1 - α) F_y in N: after yielding it returns to δ = 0 with z = - F_y. Zero if it cannot push."""
        return 0.0 if self.tension_only else (1.0 - self.post_yield_ratio) * self.yield_force

    @property
    def largest_stiffness(self) -> float:
        """K in N/m."""
        return self.stiffness

    @property
    def dissipator_force(self) -> float | None:
        """F_y in N."""
        return self.yield_force

    def scaled(self, factor: float, *, size: bool) -> Self | None:
        """Return it with a factor on its size or on its yield force; None where nothing is left of it."""
        if factor == 0.0:
            return None
        stiffness = self.stiffness * (factor if size else 1.0)
        return replace(self, stiffness=stiffness, yield_force=self.yield_force * factor)


@described
@dataclass(frozen=True, repr=False)
class ViscousDamper(BaseElement):
    """A linear viscous damper between the base and the ground: F = c δ'.

    Raises
    ------
    InputError
        If a value is outside its range.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=0.8)
    >>> damped = rf.Restrained(frame, rf.ViscousDamper(coefficient=500e3))
    >>> [round(rf.simulate(each, pulse, free_vibration=2.0).max_rotation, 4)
    ...     for each in (frame, damped)]
    [0.056, 0.0529]
    """

    title: ClassVar[str] = "Viscous damper"
    symbol: ClassVar[str] = "damper"
    states: ClassVar[tuple[str, str, str]] = ("", "", "")
    rate_dependent: ClassVar[bool] = True

    coefficient: Annotated[float, Described("the force over the velocity", "N s/m", rule="zero or positive")]
    position: Position = 0.0

    @property
    def yield_words(self) -> tuple[str, str]:
        """Nothing: it does not yield."""
        return "", ""

    def branched(self) -> Element:
        """Return it as its only branch."""
        return ViscousElement(self.coefficient, self.place)

    def slow_force(self, elongation: float) -> float:
        """Return the force in N as built, stretched slowly by an elongation in m: zero."""
        del elongation
        return 0.0

    def extremes(self, low: float, high: float, speed: float = 0.0) -> tuple[float, bool]:
        """Return the largest |F| in N, and that it does not yield."""
        del low, high
        return self.coefficient * speed, False

    @property
    def dissipates(self) -> bool:
        """Whether it damps: always."""
        return True

    @property
    def largest_stiffness(self) -> float:
        """Zero."""
        return 0.0


@described
@dataclass(frozen=True, repr=False)
class FrictionDamper(BaseElement):
    """A friction damper between the base and the ground: F = ± F_0 while it slides; it sticks in between.

    Raises
    ------
    InputError
        If a value is outside its range.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
    >>> damped = rf.Restrained(frame, rf.FrictionDamper(force=200e3))
    >>> damped.rocking().self_centring, round(damped.rocking().recentring_ratio,
    ...     2)
    (True, 5.89)
    """

    title: ClassVar[str] = "Friction damper"
    symbol: ClassVar[str] = "friction"
    states: ClassVar[tuple[str, str, str]] = ("held", "sliding", "")

    force: Annotated[float, Described("the force at which the damper slides", "N", rule="zero or positive")]
    position: Position = 0.0

    @property
    def yield_words(self) -> tuple[str, str]:
        """The words of a report for one that did not slide, and for one that did."""
        return translated("did not slide"), translated("slid")

    def branched(self) -> Element:
        """Return it as its branches: held, and sliding to either side; without force it neither sticks nor slides."""
        return FrictionElement(self.force, self.place) if self.sticks else ViscousElement(0.0, self.place)

    def slow_force(self, elongation: float) -> float:
        """Return the force in N as built, stretched slowly by an elongation in m."""
        return math.copysign(self.force, elongation)

    def extremes(self, low: float, high: float, speed: float = 0.0) -> tuple[float, bool]:  # noqa: ARG002
        """Return the largest |F| in N, and whether it slides."""
        slides = low != 0.0 or high != 0.0
        return self.force if slides else 0.0, slides

    @property
    def dissipates(self) -> bool:
        """Whether it slides: always."""
        return True

    @property
    def largest_stiffness(self) -> float:
        """Zero: it sticks, or slides with a constant force."""
        return 0.0

    @property
    def locked_force(self) -> float:
        """F_0 in N."""
        return self.force

    @property
    def sticks(self) -> bool:
        """Whether it has a force."""
        return self.force > 0.0

    @property
    def dissipator_force(self) -> float | None:
        """F_0 in N."""
        return self.force

    def scaled(self, factor: float, *, size: bool) -> Self | None:  # noqa: ARG002
        """Return it with a factor on its force; None where nothing is left of it."""
        return replace(self, force=self.force * factor) if factor else None


ELEMENTS: dict[str, type[BaseElement]] = {
    "tendon": Tendon,
    "yielding_dissipator": YieldingDissipator,
    "viscous_damper": ViscousDamper,
    "friction_damper": FrictionDamper,
}
"""The classes of this module by the names of their kinds in files."""


def base_element_tuple(given: Any) -> tuple[BaseElement, ...]:
    """Return one or several elements as a tuple.

    Raises
    ------
    InputError
        If something is not an element.
    """
    try:
        items: tuple[Any, ...] = tuple(given)
    except TypeError:
        items = (given,)
    for item in items:
        if not isinstance(item, BaseElement):
            known = ", ".join(each.__name__ for each in ELEMENTS.values())
            raise InputError(
                f"elements must be {known} objects, or have an ElementLaw, but {shown(item)} was given. Write "
                "Tendon(initial_force, stiffness), for example.",
                field="elements",
            )
    return items


def tendons_among(elements: Iterable[BaseElement]) -> tuple[Tendon, ...]:
    """Return the tendons among elements: those that are prestressed."""
    return tuple(each for each in elements if isinstance(each, Tendon))


def are_elements_symmetric(elements: Sequence[BaseElement]) -> bool:
    """Return whether every off-centre element has a mirror image: the same at the same distance on the other side.

    Attached elements do not matter: they act alike about both pivots.
    """
    left = sorted(_element_values(each, -each.position) for each in elements if each.position < 0.0)
    right = sorted(_element_values(each, each.position) for each in elements if each.position > 0.0)
    return len(left) == len(right) and all(
        one[0] == other[0] and all(math.isclose(a, b, rel_tol=1e-9) for a, b in zip(one[1], other[1], strict=True))
        for one, other in zip(left, right, strict=True)
    )


def _element_values(element: BaseElement, distance: float) -> tuple[str, tuple[float, ...]]:
    rest = element.compared_parameters()
    words = [f"{key}={value!r}" for key, value in rest.items() if not isinstance(value, float | None)]
    numbers = (float(value or 0.0) for value in rest.values() if isinstance(value, float | None))
    return " ".join([type(element).__name__, *words]), (distance, *numbers)
