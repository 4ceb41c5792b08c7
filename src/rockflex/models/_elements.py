"""The elements that act on the base: the branches of each, and its contribution to the equations on each branch.

To add an element (a damper, a fuse), add a class here or in another file, and an entry in `elements_of`.
"""

from dataclasses import dataclass
from typing import Protocol

from rockflex._constants import GRAVITY
from rockflex.modal import RockingProperties, Tendon
from rockflex.models._phase import Border, Key

CLOSED, RIGHT, LEFT = 0, 1, -1  # branches of the base: in contact, or rotating about one pivot; the sign of θ


class Element(Protocol):
    """An element that acts on the base."""

    @property
    def branches(self) -> tuple[int, ...]:
        """The branches; a run starts on the first."""
        ...

    def border(self, branch: int, side: int) -> Border:
        """Return the contribution on a branch while the base rotates about the pivot of a side."""
        ...


@dataclass(frozen=True)
class Base:
    """The base on rigid ground with the weight of the structure: Eq. 23 without the terms of the modes."""

    properties: RockingProperties

    @property
    def branches(self) -> tuple[int, ...]:
        """Contact, and rocking about either pivot."""
        return CLOSED, RIGHT, LEFT

    def border(self, branch: int, side: int) -> Border:
        """Return the inertia about the pivot, and the moment of the weight: -s m_tot g B + L_0^r (g θ - a)."""
        del branch
        p = self.properties
        pivot = p.pivot(side)
        return Border.on_rotation(
            inertia=pivot.i_theta, stiffness=-p.l0r * GRAVITY, constant=-side * pivot.weight_moment, ground=-p.l0r
        )


@dataclass(frozen=True)
class ElasticTendon:
    """An elastic tendon: its force is F_0 + k r |θ| at the distance r from the pivot."""

    tendon: Tendon
    properties: RockingProperties

    @property
    def branches(self) -> tuple[int, ...]:
        """A single branch: every rotation stretches the tendon."""
        return (0,)

    def border(self, branch: int, side: int) -> Border:
        """Return the moment -s F_0 r - k r² θ."""
        del branch
        arm = self.properties.pivot(side).arm - side * self.tendon.position
        return Border.on_rotation(
            stiffness=self.tendon.stiffness * arm**2, constant=-side * self.tendon.initial_force * arm
        )


def elements_of(properties: RockingProperties) -> tuple[Element, ...]:
    """Return all elements of a structure, the base first."""
    return (Base(properties), *(ElasticTendon(each, properties) for each in properties.tendons))


def first_key(elements: tuple[Element, ...], side: int) -> Key:
    """Return the branches on which a run starts with the base on a side."""
    return (side, *(each.branches[0] for each in elements[1:]))


def border_of(elements: tuple[Element, ...], key: Key) -> Border:
    """Return the sum of the contributions of all elements on their branches, while the base rotates about a pivot."""
    parts = [each.border(branch, key[0]) for each, branch in zip(elements, key, strict=True)]
    total = parts[0]
    for part in parts[1:]:
        total = total + part
    return total
