"""Devices at the base that take energy out of the rocking: fuses, viscous dampers and friction dampers."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from rockflex._checks import finite, instance, positive
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.modal._tendons import Tendon, checked_ratio, checked_rupture


@dataclass(frozen=True)
class YieldingDissipator:
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
            stiffness=positive("stiffness", self.stiffness, "N/m"),
            yield_force=positive("yield_force", self.yield_force, "N"),
            post_yield_ratio=checked_ratio(self.post_yield_ratio),
            position=finite("position", self.position, "m"),
            tension_only=instance("tension_only", self.tension_only, bool),
            rupture_elongation=checked_rupture(self.rupture_elongation, self.yield_force / self.stiffness),
        )


@dataclass(frozen=True)
class ViscousDamper:
    """A linear viscous damper between the base and the ground: F = c δ'.

    Attributes
    ----------
    coefficient : float
        c in N s/m, zero or positive.
    position : float
        Distance in m from the axis of the masses, positive to the right.

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
            coefficient=positive("coefficient", self.coefficient, "N s/m", zero=True),
            position=finite("position", self.position, "m"),
        )


@dataclass(frozen=True)
class FrictionDamper:
    """A friction damper between the base and the ground: F = ± F_0 while it slides; it sticks in between.

    Attributes
    ----------
    force : float
        F_0 in N, zero or positive.
    position : float
        Distance in m from the axis of the masses, positive to the right.

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
            force=positive("force", self.force, "N", zero=True),
            position=finite("position", self.position, "m"),
        )


BaseElement = Tendon | YieldingDissipator | ViscousDamper | FrictionDamper
"""What may act between a base and the ground."""


def element_set(given: Any) -> tuple[BaseElement, ...]:
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
                "elements must be Tendon, YieldingDissipator, ViscousDamper or FrictionDamper objects, but "
                f"{shown(item)} was given. Write Tendon(initial_force, stiffness), for example.",
                field="elements",
            )
    return items


def locked_force(element: BaseElement) -> float:
    """Return the largest force in N with which an element can keep a base from closing.

    A fuse that has yielded returns to δ = 0 with z = - F_y, so its force there is -(1 - α) F_y. One that cannot push, a
    tendon or a viscous damper locks nothing in.
    """
    if isinstance(element, YieldingDissipator) and not element.tension_only:
        return (1.0 - element.post_yield_ratio) * element.yield_force
    return element.force if isinstance(element, FrictionDamper) else 0.0


def pushed_force(element: BaseElement, elongation: float) -> float:
    """Return the force in N of an element as built that is stretched slowly by an elongation in m, or shortened."""
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


def mirrored(elements: Sequence[BaseElement]) -> bool:
    """Return whether every off-centre element has a mirror image: the same at the same distance on the other side."""
    left = sorted(_values(each, -each.position) for each in elements if each.position < 0.0)
    right = sorted(_values(each, each.position) for each in elements if each.position > 0.0)
    return len(left) == len(right) and all(
        one[0] == other[0] and all(math.isclose(a, b, rel_tol=1e-9) for a, b in zip(one[1], other[1], strict=True))
        for one, other in zip(left, right, strict=True)
    )


def _values(element: BaseElement, distance: float) -> tuple[str, tuple[float, ...]]:
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
    rest = {**vars(element), "position": distance}
    return type(element).__name__, tuple(float(value or 0.0) for value in rest.values())
