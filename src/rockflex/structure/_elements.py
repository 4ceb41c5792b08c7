"""Tendons, yielding dissipators, viscous and friction dampers: under the base, between floors or from a height."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from rockflex.foundation.checks import checked_finite, checked_instance, checked_positive, real_or_nan
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.structure._attachment import PLACE, Attachment, element_parameters
from rockflex.structure._element_law import ElementLaw


@dataclass(frozen=True, repr=False)
class Tendon(Attachment):
    """An unbonded, elastic, vertical tendon from the structure through the base into the ground.

    While the base rocks about a pivot at the distance r, the tendon is stretched by the gap that opens at its place,
    2 r sin(|θ|/2), to first order r |θ|, as it is guided without friction on both sides of the joint. Its force
    increases linearly from the initial force (Vassiliou & Makris 2015, doi 10.1061/(ASCE)EM.1943-7889.0000953). It
    pulls and never pushes: it goes slack at zero force. On rigid ground no rotation makes an elastic tendon between the
    edges of the base slack; on springs the base can sink and shorten it.

    Attributes
    ----------
    initial_force : float
        Force in N while the base is in contact with the ground; zero or positive.
    stiffness : float
        Axial stiffness EA/L over the unbonded length in N/m; zero or positive.
    position : float
        Distance in m from the axis of the masses, positive to the right. Unless the base is eccentric, this axis passes
        through its middle.
    yield_force : float or None
        In N, positive. Without `post_yield_ratio` the tendon stays elastic, and its largest force is compared with it.
    post_yield_ratio : float or None
        α in [0, 1): the tendon yields at `yield_force`, with the stiffness α k from there on. It keeps its plastic
        stretch, loses prestress and becomes slack at zero force. Default: it stays elastic.
    rupture_elongation : float or None
        Elongation in m, from the base in contact, at which a yielding tendon breaks for good. Default: it never does.
    between, cosine, height
        In place of a position: the floors that the element connects, or the height of a tie to the ground, and the
        direction; see `Attachment`.

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

    initial_force: float
    stiffness: float
    position: float = 0.0
    yield_force: float | None = None
    post_yield_ratio: float | None = None
    rupture_elongation: float | None = None

    def __post_init__(self) -> None:
        vars(self).update(
            initial_force=checked_positive("initial_force", self.initial_force, "N", zero=True),
            stiffness=checked_positive("stiffness", self.stiffness, "N/m", zero=True),
            position=checked_finite("position", self.position, "m"),
        )
        self.check_attachment()
        if self.yield_force is not None:
            limit = checked_positive("yield_force", self.yield_force, "N")
            vars(self).update(yield_force=limit)
            if self.initial_force > limit:
                raise InputError(
                    f"initial_force must not exceed yield_force, {limit:g} N, but {self.initial_force:g} N was given. "
                    "A tendon that has yielded is not elastic; check the units too.",
                    field="initial_force",
                )
        if self.post_yield_ratio is not None:
            vars(self).update(post_yield_ratio=checked_post_yield_ratio(self.post_yield_ratio))
            if self.yield_force is None or self.stiffness == 0.0:
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
            vars(self).update(rupture_elongation=checked_rupture_elongation(self.rupture_elongation, yields_at))


def checked_post_yield_ratio(value: float) -> float:
    """Return a post-yield stiffness ratio.

    Raises
    ------
    InputError
        If it is not in [0, 1).
    """
    ratio = real_or_nan(value)
    if not 0.0 <= ratio < 1.0:
        raise InputError(
            f"post_yield_ratio must be from 0 to below 1, but {shown(value)} was given. It is the stiffness after "
            "yielding over the elastic stiffness: 2 % is 0.02.",
            field="post_yield_ratio",
        )
    return ratio


def checked_rupture_elongation(value: float | None, yields_at: float) -> float | None:
    """Return the elongation at rupture in m.

    Raises
    ------
    InputError
        If it is not beyond the elongation `yields_at`, in m, at which yielding starts.
    """
    if value is None:
        return None
    limit = checked_positive("rupture_elongation", value, "m")
    if limit <= yields_at:
        raise InputError(
            f"rupture_elongation must be beyond the elongation at yield, {yields_at:.4g} m, but {limit:g} m was given. "
            "Check the units: stiffness is in N/m, forces are in N and elongations in m.",
            field="rupture_elongation",
        )
    return limit


@dataclass(frozen=True, repr=False)
class YieldingDissipator(Attachment):
    """A fuse between the base and the ground that yields in tension and compression, with kinematic hardening.

    At a distance r from the pivot it is stretched by the gap that opens there, δ = 2 r sin(|θ|/2), to first order
    r |θ|, as it is held on both sides of the joint and bends freely. Its force is F = α k δ + (1 - α) z, where z
    follows k δ and is limited to ± F_y. The first yield is therefore at F = F_y. A fuse that has yielded keeps a force
    while the base is closed, which shifts the moment at which the base lifts.

    Attributes
    ----------
    stiffness : float
        Elastic stiffness k in N/m, positive.
    yield_force : float
        F_y in N, positive.
    post_yield_ratio : float
        α, the stiffness after yielding over the elastic one, in [0, 1).
    position : float
        Distance in m from the axis of the masses, positive to the right.
    tension_only : bool
        Whether the fuse buckles or is unhooked, so that it cannot push: F = max(0, ·).
    rupture_elongation : float or None
        Elongation in m at which the fuse breaks, for good. Larger than F_y/k. Default: it never does.
    between, cosine, height
        In place of a position: the floors that the element connects, or the height of a tie to the ground, and the
        direction; see `Attachment`.

    Raises
    ------
    InputError
        If a value is outside its range.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0, damping_ratio=0.02)
    >>> fused = rf.Restrained(frame, rf.YieldingDissipator(stiffness=2e7, yield_force=200e3))
    >>> fused.rocking().self_centring, round(fused.rocking().recentring_ratio, 2)
    (True, 5.89)
    """

    stiffness: float
    yield_force: float
    post_yield_ratio: float = 0.0
    position: float = 0.0
    tension_only: bool = False
    rupture_elongation: float | None = None

    def __post_init__(self) -> None:
        vars(self).update(
            stiffness=checked_positive("stiffness", self.stiffness, "N/m"),
            yield_force=checked_positive("yield_force", self.yield_force, "N"),
            post_yield_ratio=checked_post_yield_ratio(self.post_yield_ratio),
            position=checked_finite("position", self.position, "m"),
            tension_only=checked_instance("tension_only", self.tension_only, bool),
            rupture_elongation=checked_rupture_elongation(self.rupture_elongation, self.yield_force / self.stiffness),
        )
        self.check_attachment()


@dataclass(frozen=True, repr=False)
class ViscousDamper(Attachment):
    """A linear viscous damper between the base and the ground: F = c δ'.

    Attributes
    ----------
    coefficient : float
        c in N s/m, zero or positive.
    position : float
        Distance in m from the axis of the masses, positive to the right.
    between, cosine, height
        In place of a position: the floors that the element connects, or the height of a tie to the ground, and the
        direction; see `Attachment`.

    Raises
    ------
    InputError
        If a value is outside its range.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0, damping_ratio=0.02)
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=0.8)
    >>> damped = rf.Restrained(frame, rf.ViscousDamper(coefficient=500e3))
    >>> [round(rf.simulate(each, pulse, free_vibration=2.0).max_rotation, 4) for each in (frame, damped)]
    [0.056, 0.0529]
    """

    coefficient: float
    position: float = 0.0

    def __post_init__(self) -> None:
        vars(self).update(
            coefficient=checked_positive("coefficient", self.coefficient, "N s/m", zero=True),
            position=checked_finite("position", self.position, "m"),
        )
        self.check_attachment()


@dataclass(frozen=True, repr=False)
class FrictionDamper(Attachment):
    """A friction damper between the base and the ground: F = ± F_0 while it slides; it sticks in between.

    Attributes
    ----------
    force : float
        F_0 in N, zero or positive.
    position : float
        Distance in m from the axis of the masses, positive to the right.
    between, cosine, height
        In place of a position: the floors that the element connects, or the height of a tie to the ground, and the
        direction; see `Attachment`.

    Raises
    ------
    InputError
        If a value is outside its range.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0, damping_ratio=0.02)
    >>> damped = rf.Restrained(frame, rf.FrictionDamper(force=200e3))
    >>> damped.rocking().self_centring, round(damped.rocking().recentring_ratio, 2)
    (True, 5.89)
    """

    force: float
    position: float = 0.0

    def __post_init__(self) -> None:
        vars(self).update(
            force=checked_positive("force", self.force, "N", zero=True),
            position=checked_finite("position", self.position, "m"),
        )
        self.check_attachment()


BaseElement = Tendon | YieldingDissipator | ViscousDamper | FrictionDamper | ElementLaw
"""Any element between a base and the ground."""


def base_element_tuple(given: Any) -> tuple[BaseElement, ...]:
    """Return one or several elements as a tuple.

    Raises
    ------
    InputError
        If something is not an element.
    """
    items: tuple[Any, ...] = tuple(given) if isinstance(given, Iterable) else (given,)
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
