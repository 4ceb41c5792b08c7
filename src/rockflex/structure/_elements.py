"""Tendons, yielding dissipators, viscous and friction dampers: under the base, between floors or from a height."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

from rockflex.foundation.descriptions import Described, described
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.structure._attachment import PLACE, Attachment, Position, element_parameters
from rockflex.structure._element_law import ElementLaw

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


@described
@dataclass(frozen=True, repr=False)
class Tendon(Attachment):
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
            "the elongation at which a tendon that yields breaks",
            "m",
            rule="positive",
            note="For good, counted from the base in contact. Default: it never does.",
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
        if self.rupture_elongation is not None:
            if self.yield_force is None or self.post_yield_ratio is None:
                raise InputError(
                    "rupture_elongation is for a tendon that yields. Give yield_force and post_yield_ratio as well.",
                    field="rupture_elongation",
                )
            yields_at = (self.yield_force - self.initial_force) / self.stiffness
            _check_rupture_elongation(self.rupture_elongation, yields_at)


def _check_rupture_elongation(limit: float, yields_at: float) -> None:
    if limit <= yields_at:
        raise InputError(
            f"rupture_elongation must be beyond the elongation at yield, {yields_at:.4g} m, but {limit:g} m was given. "
            "Check the units: stiffness is in N/m, forces are in N and elongations in m.",
            field="rupture_elongation",
        )


@described
@dataclass(frozen=True, repr=False)
class YieldingDissipator(Attachment):
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

    title: ClassVar[str] = "Yielding dissipator"
    symbol: ClassVar[str] = "fuse"

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


@described
@dataclass(frozen=True, repr=False)
class ViscousDamper(Attachment):
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

    coefficient: Annotated[float, Described("the force over the velocity", "N s/m", rule="zero or positive")]
    position: Position = 0.0


@described
@dataclass(frozen=True, repr=False)
class FrictionDamper(Attachment):
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


BaseElement = Tendon | YieldingDissipator | ViscousDamper | FrictionDamper | ElementLaw
"""Any element between a base and the ground."""


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
            raise InputError(
                "elements must be Tendon, YieldingDissipator, ViscousDamper or FrictionDamper objects, or have an "
                f"ElementLaw, but {shown(item)} was given. Write Tendon(initial_force, stiffness), for example.",
                field="elements",
            )
    return items


def element_locking_force(element: BaseElement) -> float:
    """Return the largest force in N with which an element can keep a base from closing.

    A fuse that has yielded returns to δ = 0 with z = - F_y, so its force there is -(1 - α) F_y. One that cannot push, a
    tendon or a viscous damper locks nothing in.
    """
    if isinstance(element, ElementLaw):
        return element.locked_force
    if isinstance(element, YieldingDissipator) and not element.tension_only:
        return (1.0 - element.post_yield_ratio) * element.yield_force
    return element.force if isinstance(element, FrictionDamper) else 0.0


def element_pushover_force(element: BaseElement, elongation: float) -> float:
    """Return the force in N of an element as built that is stretched slowly by an elongation in m, or shortened."""
    if isinstance(element, ElementLaw):
        return element.slow_force(elongation)
    if isinstance(element, FrictionDamper):
        return math.copysign(element.force, elongation)
    if isinstance(element, ViscousDamper) or elongation >= (element.rupture_elongation or math.inf):
        return 0.0
    pull = element.stiffness * elongation + (element.initial_force if isinstance(element, Tendon) else 0.0)
    if element.post_yield_ratio is not None and element.yield_force is not None and abs(pull) > element.yield_force:
        beyond = element.post_yield_ratio * (abs(pull) - element.yield_force)
        pull = math.copysign(element.yield_force + beyond, pull)
    pushes = isinstance(element, YieldingDissipator) and not element.tension_only
    return pull if pushes else max(pull, 0.0)


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
    if isinstance(element, Tendon):  # its yield force is only compared with, unless it yields
        yields = element.post_yield_ratio is not None
        beyond = (element.yield_force or 0.0, element.post_yield_ratio or 0.0) if yields else (0.0, 0.0)
        return "Tendon", (
            distance,
            element.initial_force,
            element.stiffness,
            *beyond,
            element.rupture_elongation or 0.0,
        )
    rest = {name: value for name, value in element_parameters(element).items() if name not in PLACE}
    words = [f"{key}={value!r}" for key, value in rest.items() if not isinstance(value, float | None)]
    numbers = (float(value or 0.0) for value in rest.values() if isinstance(value, float | None))
    return " ".join([type(element).__name__, *words]), (distance, *numbers)


def closes(element: BaseElement) -> bool:
    """Return whether an element helps to close the base, and is no dissipator that can keep it open."""
    return element.locked_force == 0.0 if isinstance(element, ElementLaw) else isinstance(element, Tendon)


def initial_force(element: BaseElement) -> float:
    """Return the force in N of an element as built while the base is in contact."""
    return element.initial_force if isinstance(element, Tendon | ElementLaw) else 0.0
