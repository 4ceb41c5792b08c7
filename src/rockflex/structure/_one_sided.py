"""Structures that open to one side: façades on transverse walls, and walls in front of stiffer ones."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, Any, Literal

from rockflex.foundation.checks import checked_in_range, is_one_of
from rockflex.foundation.descriptions import PLAIN, Described, described
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.structure._rocking import RockingProperties
from rockflex.structure._structure import InFile, ModifiedStructure, Structure, checked_structure


def _back_from_base_wall_and_base(alpha: float) -> float:
    on_base = 1.0 - 1.5 * math.sin(alpha) ** 2
    return max(-(on_base**2) * (1.0 - 1.5 * math.cos(alpha) ** 2), 0.0)


def _of_both_sides(alpha: float) -> float:
    return max(1.0 - 1.5 * math.sin(alpha) ** 2, 0.0)


PUBLISHED: dict[str, Callable[[float], float]] = {
    "sorrentino": _back_from_base_wall_and_base,
    "housner": _of_both_sides,
}
"""Published restitutions of homogeneous blocks over the angle α whose tangent is b/h."""


@described
@dataclass(frozen=True, init=False)
class OneSided(ModifiedStructure):
    """A structure that opens to one side, such as a façade on transverse walls or a wall in front of a stiffer one.

    It rotates about one edge of its base. When it comes back it hits what stands behind it, and turns back with a share
    e of its velocity, θ' → -e θ', while every floor keeps its horizontal velocity apart from that. With e = 0 it stays
    closed until it is lifted again; otherwise it bounces, until an excursion would be shorter than 0.1 ms. While it is
    closed, what stands behind holds any moment to that side.

    Raises
    ------
    InputError
        If `structure` is not a structure, or a value is none of those given above.

    Notes
    -----
    "sorrentino" is the restitution of a homogeneous block that hits, one after the other, its base, the transverse wall
    with its upper edge, and its base again, and keeps its angular momentum about the point that is hit each time:
    e = -(1 - 1.5 sin² α)² (1 - 1.5 cos² α), with tan α = B m_tot/L_0^r, so about one half for a slender wall
    (Sorrentino, AlShawa & Decanini 2011, Bull. Earthquake Eng. 9, 1617-1642). "housner" is the coefficient of a block
    that rocks to both sides, 1 - 1.5 sin² α, turned back: hardly any loss, and an upper bound.

    Floors of a flexible structure may pass the wall behind it: only the rotation is held. It stands on rigid ground.

    Examples
    --------
    >>> import rockflex as rf
    >>> wall = rf.rigid_block(width=0.6, height=6.0, mass=7e3)
    >>> facade = rf.OneSided(wall, restitution="sorrentino")
    >>> round(facade.rocking().restitution, 3)
    0.471
    >>> pulse = rf.one_sine_pulse(amplitude=2.0, period=0.8)
    >>> for each in (wall, facade):
    ...     run = rf.simulate(each, pulse, "rigid", free_vibration=3.0)
    ...     print(round(run.max_rotation, 4))
    0.0649
    0.0124
    """

    in_file = InFile(
        key="one_sided",
        words=Described(
            "a table", label="One-sided", form=PLAIN, page="the wall behind it, so that it opens to one side"
        ),
    )

    structure: Annotated[
        Structure | RockingProperties,
        Described("a structure", in_file=False, note="Any: a `rigid_block`, a `Restrained` wall, a `Frame` ..."),
    ]
    restitution: Annotated[
        float | Literal["sorrentino", "housner"],
        Described(
            'the share of its velocity with which it turns back, or "sorrentino" or "housner"',
            note="From 0 to 1, or a published one of a block of the same slenderness.",
            form="{}, a number from 0 to 1 or a text in quotes",
            low=0.0,
            high=1.0,
            page="the share of its velocity with which it turns back from the wall behind it",
        ),
    ] = 0.0
    side: Annotated[
        Literal["right", "left"],
        Described(
            'the side to which it opens, "right" or "left"',
            note="About that edge of the base: θ > 0 on the right.",
            page="the side to which it opens",
        ),
    ] = "right"

    def __init__(
        self,
        structure: Structure | RockingProperties,
        restitution: float | Literal["sorrentino", "housner"] = 0.0,
        side: Literal["right", "left"] = "right",
    ) -> None:
        if not is_one_of(side, ("right", "left")):
            raise InputError(f'side must be "right" or "left", but {shown(side)} was given.', field="side")
        if not is_one_of(restitution, tuple(PUBLISHED)):
            if isinstance(restitution, str):
                raise InputError(
                    f"restitution must be a number from 0 to 1, or {' or '.join(map(repr, PUBLISHED))}, but "
                    f"{shown(restitution)} was given.",
                    field="restitution",
                )
            restitution = checked_in_range("restitution", restitution, 0.0, 1.0, closed=True)
        vars(self).update(structure=checked_structure(structure), restitution=restitution, side=side)
        self.check()

    def _changes(self, base: RockingProperties) -> dict[str, Any]:
        found = self.restitution
        if isinstance(found, str):
            pivot = base.pivot(1 if self.side == "right" else -1)
            found = PUBLISHED[found](math.atan2(pivot.arm, base.l0r / base.m_tot))
        return {"opens": self.side, "restitution": found}
