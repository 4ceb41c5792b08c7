"""Elements between the base and the ground: their branches, and the tension of each on every branch."""

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array
from rockflex._constants import GRAVITY
from rockflex.modal import BaseElement, FrictionDamper, RockingProperties, ViscousDamper, YieldingDissipator
from rockflex.models._phase import Border, Change, Key, Turning

CLOSED, RIGHT, LEFT = 0, 1, -1  # branches of the base: in contact, or rotating about one pivot; the sign of θ
ELASTIC, UP, DOWN, SLACK, BROKEN = range(5)  # branches of a bar; UP and DOWN: it yields as it is stretched or shortened
HELD, OUTWARD, INWARD = ELASTIC, UP, DOWN  # branches of a friction damper
BORDER = 1e-12  # relative: an elongation this close to the end of a branch still belongs to it
BROKEN_FOR_GOOD = 1e30  # the memory of an element that has broken, m


class Pull(NamedTuple):
    """Tension of an element on one branch: F = stiffness δ + damping δ' + force + recall m, with its memory m."""

    stiffness: float = 0.0
    damping: float = 0.0
    force: float = 0.0
    recall: float = 0.0


class Stop(NamedTuple):
    """An elongation δ = place + recall m that ends a branch, reached from below if `upper`, and the next branch."""

    upper: bool
    place: float
    recall: float
    branch: int


class Element(Protocol):
    """An element that is stretched by δ = r |θ| at the distance r from the pivot, and pulls the base down."""

    @property
    def position(self) -> float:
        """Distance from the axis of the masses in m, positive to the right."""
        ...

    @property
    def remembers(self) -> bool:
        """Whether its force depends on a memory: its plastic stretch."""
        ...

    @property
    def branches(self) -> tuple[int, ...]:
        """Its branches; a run starts on the first."""
        ...

    def pull(self, branch: int) -> Pull:
        """Return the tension on a branch."""
        ...

    def stops(self, branch: int) -> tuple[Stop, ...]:
        """Return the elongations that end a branch."""
        ...

    def direction(self, branch: int) -> int:
        """Return the sign of δ' on a branch that ends where δ' vanishes; 0 on others."""
        ...

    def turning(self, branch: int) -> float | None:
        """Return δ - m where the elongation turns back on a branch that yields, which ends it; None on others."""
        ...

    def stopped(self, branch: int) -> int:
        """Return the branch after the elongation has stopped."""
        ...

    def moving(self, branch: int, direction: int) -> int:
        """Return the branch after the elongation has begun to change, with the sign of δ'; 0 if it does not."""
        ...

    def mark(self, branch: int) -> float | None:
        """Return the memory that tells a branch; None if its memory is free."""
        ...

    def memory_at(self, elongation: float) -> float:
        """Return the memory after an element as built has been brought to an elongation δ in m."""
        ...

    def branch_at(self, elongation: Array, memory: Array) -> NDArray[np.int64]:
        """Return the branch at elongations δ in m with the memories at the start of the branch, shape (n,)."""
        ...


class OneBranch:
    """What is common to elements with one branch and without memory."""

    @property
    def remembers(self) -> bool:
        return False

    @property
    def branches(self) -> tuple[int, ...]:
        return (ELASTIC,)

    def stops(self, branch: int) -> tuple[Stop, ...]:
        del branch
        return ()

    def direction(self, branch: int) -> int:
        del branch
        return 0

    def turning(self, branch: int) -> float | None:
        del branch

    def stopped(self, branch: int) -> int:
        return branch

    def moving(self, branch: int, direction: int) -> int:
        del direction
        return branch

    def mark(self, branch: int) -> float | None:
        del branch

    def memory_at(self, elongation: float) -> float:
        del elongation
        return 0.0

    def branch_at(self, elongation: Array, memory: Array) -> NDArray[np.int64]:
        del memory
        return np.zeros(elongation.size, dtype=np.int64)


@dataclass(frozen=True)
class Spring(OneBranch):
    """A tendon that stays elastic: F = F_0 + k δ."""

    stiffness: float
    initial_force: float
    position: float

    def pull(self, branch: int) -> Pull:
        del branch
        return Pull(self.stiffness, 0.0, self.initial_force)


@dataclass(frozen=True)
class Dashpot(OneBranch):
    """A viscous damper: F = c δ'."""

    coefficient: float
    position: float

    def pull(self, branch: int) -> Pull:
        del branch
        return Pull(damping=self.coefficient)


@dataclass(frozen=True)
class Bar:
    """A fuse, or a tendon that yields: F = α k e + (1 - α) z, z = k (e - m) within ± F_y, e = δ + e_0.

    The memory m is the plastic stretch. A bar that cannot push has no compression: F = max(0, ·).
    """

    stiffness: float
    yield_force: float
    ratio: float
    position: float
    stretched: float = 0.0  # e_0
    pulls_only: bool = False
    rupture: float = np.inf  # elongation δ at which it breaks

    @property
    def remembers(self) -> bool:
        return True

    @property
    def branches(self) -> tuple[int, ...]:
        return (ELASTIC, UP, DOWN, SLACK, BROKEN)

    def pull(self, branch: int) -> Pull:
        k, a, e0 = self.stiffness, self.ratio, self.stretched
        if branch == ELASTIC:
            return Pull(k, 0.0, k * e0, -(1.0 - a) * k)
        if branch in (UP, DOWN):
            sign = 1.0 if branch == UP else -1.0
            return Pull(a * k, 0.0, a * k * e0 + sign * (1.0 - a) * self.yield_force)
        return Pull()

    def stops(self, branch: int) -> tuple[Stop, ...]:
        reach, e0 = self.yield_force / self.stiffness, self.stretched
        breaks = () if np.isinf(self.rupture) else (Stop(True, self.rupture, 0.0, BROKEN),)
        empty = 1.0 - self.ratio
        if branch == ELASTIC:
            slackens = (Stop(False, -e0, empty, SLACK),) if self.pulls_only else ()
            return (Stop(True, reach - e0, 1.0, UP), Stop(False, -reach - e0, 1.0, DOWN), *slackens, *breaks)
        if branch == SLACK:
            return (Stop(True, -e0, empty, ELASTIC), *breaks)
        if branch == DOWN and self.pulls_only and self.ratio > 0.0:
            return (Stop(False, self._emptied - e0, 0.0, SLACK),)
        return breaks if branch == UP else ()

    def direction(self, branch: int) -> int:
        return 1 if branch == UP else -1 if branch == DOWN else 0

    @property
    def _emptied(self) -> float:
        """Return e at which the force vanishes while a bar that has hardened yields downwards."""
        return (1.0 - self.ratio) / self.ratio * self.yield_force / self.stiffness if self.ratio > 0.0 else np.inf

    def turning(self, branch: int) -> float | None:
        sign = self.direction(branch)
        return None if sign == 0 else sign * self.yield_force / self.stiffness - self.stretched

    def stopped(self, branch: int) -> int:
        return ELASTIC if branch in (UP, DOWN) else branch

    def moving(self, branch: int, direction: int) -> int:
        del direction
        return branch

    def mark(self, branch: int) -> float | None:
        return BROKEN_FOR_GOOD if branch == BROKEN else None

    def memory_at(self, elongation: float) -> float:
        if elongation >= self.rupture:
            return BROKEN_FOR_GOOD
        stretch, reach = elongation + self.stretched, self.yield_force / self.stiffness
        if self.pulls_only:
            return max(stretch - reach, 0.0)
        return stretch - min(max(stretch, -reach), reach)

    def branch_at(self, elongation: Array, memory: Array) -> NDArray[np.int64]:
        reach, e = self.yield_force / self.stiffness, elongation + self.stretched
        found = np.full(e.size, ELASTIC, dtype=np.int64)
        room = BORDER * (reach + np.abs(e) + np.abs(memory))
        found[e - memory > reach + room] = UP
        found[e - memory < -reach - room] = DOWN
        if self.pulls_only:
            empty = (1.0 - self.ratio) * memory
            found[(e < empty - room) & ((found != DOWN) | (e < self._emptied))] = SLACK
        found[memory == BROKEN_FOR_GOOD] = BROKEN
        return found


@dataclass(frozen=True)
class Slider:
    """A friction damper: F = ± F_0 while it slides, less while it sticks. Its memory is its direction, 1, 0 or -1."""

    force: float
    position: float

    @property
    def remembers(self) -> bool:
        return True

    @property
    def branches(self) -> tuple[int, ...]:
        return (HELD, OUTWARD, INWARD)

    def pull(self, branch: int) -> Pull:
        return Pull(force=self.direction(branch) * self.force)

    def stops(self, branch: int) -> tuple[Stop, ...]:
        del branch
        return ()

    def direction(self, branch: int) -> int:
        return 1 if branch == OUTWARD else -1 if branch == INWARD else 0

    def turning(self, branch: int) -> float | None:
        del branch

    def stopped(self, branch: int) -> int:
        del branch
        return HELD

    def moving(self, branch: int, direction: int) -> int:
        del branch
        return OUTWARD if direction > 0 else INWARD if direction < 0 else HELD

    def mark(self, branch: int) -> float | None:
        return float(self.direction(branch))

    def memory_at(self, elongation: float) -> float:
        del elongation
        return 0.0

    def branch_at(self, elongation: Array, memory: Array) -> NDArray[np.int64]:
        found = np.full(elongation.size, HELD, dtype=np.int64)
        found[memory > 0.0] = OUTWARD
        found[memory < 0.0] = INWARD
        return found


def base_border(properties: RockingProperties, side: int, memories: int) -> Border:
    """Return the inertia about the pivot and the weight, -s m_tot g B + L_0^r (g θ - a): Eq. 23 without the modes."""
    pivot = properties.pivot(side)
    return Border.on_rotation(
        inertia=pivot.i_theta,
        stiffness=-properties.l0r * GRAVITY,
        constant=-side * pivot.weight_moment,
        ground=-properties.l0r,
        recall=np.zeros(memories),
    )


def arm_of(properties: RockingProperties, element: Element, side: int) -> float:
    """Return the distance r of an element from a pivot in m; negative beyond the pivot."""
    return properties.pivot(side).arm - side * element.position


def first_key(properties: RockingProperties, elements: tuple[Element, ...], side: int) -> Key:
    """Return the branches at the start of a run in contact, or as the base begins to rotate about a pivot."""
    return set_off(properties, elements, (side, *(each.branches[0] for each in elements)), side)


def set_off(properties: RockingProperties, elements: tuple[Element, ...], key: Key, turn: int) -> Key:
    """Return the branches as the base begins to rotate, with the sign `turn` of θ'; 0 as it stops."""
    side, found = key[0], list[int]()
    for each, branch in zip(elements, key[1:], strict=True):
        reach = side * turn * arm_of(properties, each, side) if side != CLOSED else 0.0
        stopped = each.stopped(branch)
        found.append(each.moving(stopped, int(np.sign(reach))) if turn else stopped)
    return (side, *found)


def is_held(properties: RockingProperties, elements: tuple[Element, ...], key: Key) -> bool:
    """Return whether friction dampers hold the base at a rotation."""
    return key[0] != CLOSED and any(
        isinstance(each, Slider) and branch == HELD and arm_of(properties, each, key[0]) != 0.0
        for each, branch in zip(elements, key[1:], strict=True)
    )


def memories(elements: tuple[Element, ...]) -> dict[int, int]:
    """Return the index of each memory by the place of its element."""
    return {place: index for index, place in enumerate(k for k, each in enumerate(elements) if each.remembers)}


def border_of(properties: RockingProperties, elements: tuple[Element, ...], key: Key) -> Border:
    """Return the sum of the borders of the base and of all elements on their branches, about a pivot.

    An element adds the moment -s F r: -k r² θ - c r² θ' - s r (force + recall m).
    """
    side, known = key[0], memories(elements)
    total = base_border(properties, side, len(known))
    for place, (each, branch) in enumerate(zip(elements, key[1:], strict=True)):
        r, pull = arm_of(properties, each, side), each.pull(branch)
        recall = np.zeros(len(known))
        if each.remembers:
            recall[known[place]] = -side * pull.recall * r
        total = total + Border.on_rotation(
            damping=pull.damping * r**2, stiffness=pull.stiffness * r**2, constant=-side * pull.force * r, recall=recall
        )
    return total


def changes_of(properties: RockingProperties, elements: tuple[Element, ...], key: Key) -> tuple[Change, ...]:
    """Return the limits of |θ| at which elements change their branches, while the base rocks."""
    found: list[Change] = []
    known = memories(elements)
    for place, (each, branch) in enumerate(zip(elements, key[1:], strict=True)):
        r = arm_of(properties, each, key[0])
        if r == 0.0:
            continue
        for stop in each.stops(branch):
            following = (*key[: place + 1], stop.branch, *key[place + 2 :])
            found.append(Change(stop.upper == (r > 0.0), stop.place / r, stop.recall / r, known[place], following))
    return tuple(found)


def turnings_of(
    properties: RockingProperties, elements: tuple[Element, ...], key: Key
) -> tuple[int, tuple[Turning, ...]]:
    """Return the sign of |θ|' on branches that end where it vanishes (0: there are none), and what memories become."""
    sign, found = 0, list[Turning]()
    known = memories(elements)
    for place, (each, branch) in enumerate(zip(elements, key[1:], strict=True)):
        offset, r = each.turning(branch), arm_of(properties, each, key[0])
        if offset is not None:
            found.append(Turning(known[place], r, offset))
        sign = each.direction(branch) * int(np.sign(r)) or sign
    return sign, tuple(found)


def marks_of(elements: tuple[Element, ...], key: Key) -> tuple[tuple[int, float], ...]:
    """Return the memories that have a value of their own on the branches, by index."""
    known = memories(elements)
    marks = ((known[place], each.mark(key[1 + place])) for place, each in enumerate(elements) if place in known)
    return tuple((index, mark) for index, mark in marks if mark is not None)


def elements_of(properties: RockingProperties) -> tuple[Element, ...]:
    """Return the elements of a structure, in its order."""
    return tuple(_element_of(each) for each in properties.elements)


def _element_of(given: BaseElement) -> Element:
    if isinstance(given, ViscousDamper):
        return Dashpot(given.coefficient, given.position)
    if isinstance(given, FrictionDamper):
        # Without force there is nothing to stick or slide.
        return Slider(given.force, given.position) if given.force > 0.0 else Dashpot(0.0, given.position)
    rupture = np.inf if given.rupture_elongation is None else given.rupture_elongation
    if isinstance(given, YieldingDissipator):
        return Bar(
            given.stiffness, given.yield_force, given.post_yield_ratio, given.position, 0.0, given.tension_only, rupture
        )
    if given.post_yield_ratio is None or given.yield_force is None:
        return Spring(given.stiffness, given.initial_force, given.position)
    stretched = given.initial_force / given.stiffness
    return Bar(given.stiffness, given.yield_force, given.post_yield_ratio, given.position, stretched, True, rupture)
