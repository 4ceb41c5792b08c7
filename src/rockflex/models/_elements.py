"""The elements of a base together: their branches in a phase, the forces on the base, and what ends the phase."""

import math
from itertools import accumulate

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.foundation.constants import GRAVITY
from rockflex.models._phase import BaseEquations, Key
from rockflex.models._state_layout import StateLayout
from rockflex.structure._base_element import BaseElement
from rockflex.structure._branches import HELD, BranchLimit, Element, YieldingStoryElement
from rockflex.structure._rocking import RockingProperties

CLOSED, RIGHT, LEFT = 0, 1, -1  # branches of the base: in contact, or rotating about one pivot; the sign of θ
QUARTER_TURN = 0.5 * np.pi  # rad: a base that has rotated so far has overturned

# Indices in the sums: Σ f r, Σ k r², Σ c r² for the moment; Σ f, Σ k r, Σ c r for the force. Those with f also have a
# share g of every internal variable. The last is 1 if friction dampers hold the base, otherwise 0.
MOMENT, STIFFNESS, DAMPING, FORCE, PULL, DRAG, HOLD = range(7)
SUMS = 7


def weight_equations(
    properties: RockingProperties, side: int, n_internal: int, gravity: float = GRAVITY
) -> BaseEquations:
    """Return the inertia about the pivot and the weight, -s m_tot g B + L_0^r (g θ - a): Eq. 23 without the modes."""
    pivot = properties.pivot(side)
    return BaseEquations.on_rotation(
        inertia=pivot.i_theta,
        stiffness=-properties.l0r * gravity,
        constant=-side * (properties.m_tot * gravity * pivot.arm),
        ground=-properties.l0r,
        internal_factor=np.zeros(n_internal),
    )


def arm_of_element(properties: RockingProperties, element: Element, side: int) -> float:
    """Return the distance r of an element from a pivot in m; negative beyond the pivot, zero if attached to floors."""
    return 0.0 if element.position is None else properties.pivot(side).arm - side * element.position


def first_branches(properties: RockingProperties, elements: tuple[Element, ...], side: int) -> Key:
    """Return the branches at the start of a run in contact, or as the base begins to rotate about a pivot."""
    return branches_of_moving_elements(properties, elements, (side, *(each.branches[0] for each in elements)), side)


def branches_of_moving_elements(
    properties: RockingProperties, elements: tuple[Element, ...], key: Key, turn: int
) -> Key:
    """Return the branches as the base begins to rotate, with the sign `turn` of θ'; 0 as it stops.

    Attached elements go on as they were.
    """
    side, found = key[0], list[int]()
    for each, branch in zip(elements, key[1:], strict=True):
        if each.position is None:
            found.append(branch)
            continue
        reach = side * turn * arm_of_element(properties, each, side) if side != CLOSED else 0.0
        stopped = each.branch_at_rest(branch)
        found.append(each.moving(stopped, int(np.sign(reach))) if turn else stopped)
    return (side, *found)


def is_held_by_dampers(properties: RockingProperties, elements: tuple[Element, ...], key: Key) -> bool:
    """Return whether friction dampers hold the base at a rotation."""
    return key[0] != CLOSED and any(
        each.friction and branch == HELD and arm_of_element(properties, each, key[0]) != 0.0
        for each, branch in zip(elements, key[1:], strict=True)
    )


def friction_damper_shares(properties: RockingProperties, elements: tuple[Element, ...], side: int) -> Array:
    """Return the tension of each element per N m that friction dampers balance while they hold the base, in 1/m, (E,).

    Each takes a part in proportion to its force F_0, as at the instant in which they slide; zero for other elements.
    """
    arms = np.array([arm_of_element(properties, each, side) for each in elements])
    forces = np.array([each.friction for each in elements])
    return side * np.sign(arms) * forces / float(forces @ np.abs(arms))


def internal_places(elements: tuple[Element, ...]) -> dict[int, int]:
    """Return the index of the first internal variable of each element that has some, by its place."""
    ends = accumulate(each.n_internal for each in elements)
    return {
        place: end - each.n_internal
        for place, (each, end) in enumerate(zip(elements, ends, strict=True))
        if each.n_internal
    }


def internal_count(elements: tuple[Element, ...]) -> int:
    """Return the number of internal variables of all elements."""
    return sum(each.n_internal for each in elements)


def base_equations_of(
    properties: RockingProperties, elements: tuple[Element, ...], key: Key, gravity: float = GRAVITY
) -> BaseEquations:
    """Return the sum of the equations of the base and of all elements on their branches, about a pivot.

    An element adds the moment -s F r: -k r² θ - c r² θ' - s r (force + internal_factor m).
    """
    side, known, count = key[0], internal_places(elements), internal_count(elements)
    total = weight_equations(properties, side, count, gravity)
    for place, (each, branch) in enumerate(zip(elements, key[1:], strict=True)):
        r = arm_of_element(properties, each, side)
        if r == 0.0:
            continue
        pull, internal_factor = each.tension(branch), np.zeros(count)
        if place in known:
            internal_factor[known[place]] = -side * pull.internal_factor * r
        total = total + BaseEquations.on_rotation(
            damping=pull.damping * r**2,
            stiffness=pull.stiffness * r**2,
            constant=-side * pull.force * r,
            internal_factor=internal_factor,
        )
    return total


def element_force_sums(properties: RockingProperties, elements: tuple[Element, ...], key: Key) -> Array:
    """Return the sums over the elements on their branches, with a column for each internal variable, (7, 1 + M).

    An element at the distance r from the pivot is stretched by δ = 2 r sin(|θ|/2). Its tension
    F = k δ + c δ' + f + g m, with an internal variable m, adds the moment -s F r cos(θ/2). For small rotations these
    are δ = r |θ| and -s F r.
    """
    known = internal_places(elements)
    total = np.zeros((SUMS, 1 + internal_count(elements)))
    terms: list[tuple[float, ...]] = []
    for place, (each, branch) in enumerate(zip(elements, key[1:], strict=True)):
        r = arm_of_element(properties, each, key[0]) if key[0] != CLOSED else 0.0
        k, c, f, g = each.tension(branch)
        terms.append((f * r, k * r**2, c * r**2, f, k * r, c * r))
        if place in known:
            total[MOMENT, 1 + known[place]], total[FORCE, 1 + known[place]] = g * r, g
    # Exactly rounded, so that mirrored bases have the same sums to the last digit.
    total[:HOLD, 0] = [math.fsum(values) for values in zip(*terms, strict=True)] or 0.0
    total[HOLD, 0] = is_held_by_dampers(properties, elements, key)
    total.setflags(write=False)
    return total


def is_in_reach(stop: BranchLimit, arm: float) -> bool:
    """Return whether some rotation about a pivot can bring an element at the distance `arm` to the end of a branch.

    None makes a tendon between the pivots slack that has not yielded: the base lands first.
    """
    outer = stop.upper == (arm > 0.0)
    return arm != 0.0 and (stop.internal_factor != 0.0 or stop.place / arm > 0.0 or (outer and stop.place == 0.0))


def direction_of_yielding(properties: RockingProperties, elements: tuple[Element, ...], key: Key) -> int:
    """Return the sign of |θ|' while elements yield or slide, which ends where it vanishes; 0 if none does."""
    ways = (
        each.direction(branch) * int(np.sign(arm_of_element(properties, each, key[0])))
        for each, branch in zip(reversed(elements), reversed(key[1:]), strict=True)
    )
    return next((way for way in ways if way), 0)


def internal_variables_of_branches(elements: tuple[Element, ...], key: Key) -> tuple[tuple[int, float], ...]:
    """Return the memories that have a value of their own on the branches, by index."""
    known = internal_places(elements)
    last = {place: first + elements[place].n_internal - 1 for place, first in known.items()}
    marks = ((index, elements[place].branch_code(key[1 + place])) for place, index in last.items())
    return tuple((index, mark) for index, mark in marks if mark is not None)


def stiffness_of_fuses(properties: RockingProperties, side: int) -> float:
    """Return the largest Σ k r² of all but tendons, which belong to `rocking_stiffness`, in N m/rad."""
    arm = properties.pivot(side).arm
    more = ((each.largest_stiffness - each.restoring_stiffness, each.arm(arm, side)) for each in properties.elements)
    return sum((stiffness * r**2 for stiffness, r in more), 0.0)


def elements_of(properties: RockingProperties) -> tuple[Element, ...]:
    """Return the elements of a structure, in its order, and then its stories that yield."""
    stories = (
        YieldingStoryElement(each.stiffness, each.yield_force, each.post_yield_ratio, None)
        for each in properties.stories
    )
    return (*(each.branched() for each in properties.elements), *stories)


def elongation_rows_of_attached(properties: RockingProperties, layout: StateLayout) -> dict[int, Array]:
    """Return the elongations of attached elements and stories in m by their places, as rows, shape (C,)."""
    found, stories = dict[int, Array](), len(properties.elements)
    places = [k for k, each in enumerate(properties.elements) if each.attached]
    places += range(stories, stories + len(properties.stories))
    if not places:
        return found
    floors = properties.floors
    n = layout.modes
    shapes = np.zeros((1, n)) if floors is None else np.vstack((np.zeros(n), floors.displacement))
    for place in places:
        row = np.zeros(layout.columns)
        if place >= stories:
            floor = properties.stories[place - stories].floor
            row[:n] = shapes[floor] - shapes[floor - 1]
        else:
            row[:] = _row_of(properties.elements[place], layout, shapes, properties)
        found[place] = row
    return found


def _row_of(element: BaseElement, layout: StateLayout, shapes: Array, properties: RockingProperties) -> Array:
    row, floors = np.zeros(layout.columns), properties.floors
    if element.between is not None:
        lower, upper = element.between
        if layout.modes:
            row[: layout.modes] = element.cosine * (shapes[upper] - shapes[lower])
        return row
    assert element.height is not None
    if floors is not None and layout.modes:
        order = np.argsort(floors.heights)
        heights = np.append(0.0, floors.heights[order])
        shares = [np.interp(element.height, heights, shapes[np.append(0, 1 + order), k]) for k in range(layout.modes)]
        row[: layout.modes] = element.cosine * np.array(shares)
    row[layout.rotation] = element.cosine * float(properties.turning_heights(element.height))
    for place, joint in zip(layout.rotations[1:], properties.joints, strict=False):
        row[place] = element.cosine * max(element.height - joint.height, 0.0)
    if layout.slip >= 0:
        row[layout.slip] = element.cosine
    return row


def rate_of_elongation_row(row: Array, layout: StateLayout) -> Array:
    """Return the rate of a row over displacements, the rotation, the slip and the heave."""
    found, n = np.zeros_like(row), layout.modes
    found[n : 2 * n] = row[:n]
    found[layout.rotation + 1 : layout.core : 2] = row[layout.rotation : layout.core : 2]
    return found
