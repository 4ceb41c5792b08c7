"""Tendons that hold a base down."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from rockflex._checks import finite, positive
from rockflex._errors import InputError
from rockflex._shown import shown


@dataclass(frozen=True)
class Tendon:
    """An unbonded, elastic, vertical tendon from the structure through the base into the ground.

    While the base rocks about a pivot at the distance r, the tendon is stretched by 2 r sin(|θ|/2), to first order
    r |θ|, and its force increases linearly from the initial force (Vassiliou & Makris 2015, doi
    10.1061/(ASCE)EM.1943-7889.0000953). It never goes slack, because every rotation stretches it.

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
        In N, positive. The largest force is compared with it; the tendon itself stays elastic.

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

    def __post_init__(self) -> None:
        vars(self).update(
            initial_force=positive("initial_force", self.initial_force, "N", zero=True),
            stiffness=positive("stiffness", self.stiffness, "N/m", zero=True),
            position=finite("position", self.position, "m"),
        )
        if self.yield_force is not None:
            limit = positive("yield_force", self.yield_force, "N")
            vars(self).update(yield_force=limit)
            if self.initial_force > limit:
                raise InputError(
                    f"initial_force must not exceed yield_force, {limit:g} N, but {self.initial_force:g} N was given. "
                    "A tendon that has yielded is not elastic; check the units too.",
                    field="initial_force",
                )


def tendon_set(given: Any) -> tuple[Tendon, ...]:
    """Return one or several tendons as a tuple.

    Raises
    ------
    InputError
        If something is not a tendon.
    """
    items = (given,) if isinstance(given, Tendon) else tuple(given) if isinstance(given, Iterable) else (given,)
    for item in items:
        if not isinstance(item, Tendon):
            raise InputError(
                f"tendons must be Tendon objects, but {shown(item)} was given. Write Tendon(initial_force, stiffness).",
                field="tendons",
            )
    return items


def balanced(tendons: Sequence[Tendon]) -> bool:
    """Return whether every off-centre tendon has a mirror image of equal force and stiffness."""
    left = sorted((-t.position, t.initial_force, t.stiffness) for t in tendons if t.position < 0.0)
    right = sorted((t.position, t.initial_force, t.stiffness) for t in tendons if t.position > 0.0)
    pairs = [pair for ours, theirs in zip(left, right, strict=False) for pair in zip(ours, theirs, strict=True)]
    return len(left) == len(right) and all(math.isclose(one, other, rel_tol=1e-9) for one, other in pairs)
