"""One element of the base along a prescribed path of its elongation, branch by branch."""

import math
from typing import NamedTuple

from rockflex.models import BROKEN, Bar, Element, Slider


class Place(NamedTuple):
    """The branch of an element, its memory at the start of the branch, and its elongation δ in m."""

    branch: int
    memory: float
    elongation: float


def at_rest(element: Element) -> Place:
    """Return the place at which every path starts."""
    return Place(element.branches[0], 0.0, 0.0)


def tension(element: Element, place: Place) -> float:
    """Return the force in N while the elongation changes slowly."""
    pull = element.pull(place.branch)
    return pull.stiffness * place.elongation + pull.force + pull.recall * place.memory


def memory_at(element: Element, place: Place) -> float:
    """Return the memory if the branch ended here: on a branch that yields it follows the elongation."""
    offset = element.turning(place.branch)
    return place.memory if offset is None else place.elongation - offset


def set_off(element: Element, place: Place, direction: int) -> Place:
    """Return the place as the elongation begins to change, with the sign of δ'; 0 if it does not change."""
    if element.direction(place.branch) == direction:
        return place
    branch = element.moving(element.stopped(place.branch), direction)
    return Place(branch, memory_at(element, place), place.elongation)


def next_stop(element: Element, place: Place, direction: int) -> tuple[float, int] | None:
    """Return the elongation at which the branch ends if it keeps its direction, and the next branch; None if never."""
    ahead = [
        (max(direction * (stop.place + stop.recall * place.memory), direction * place.elongation), stop.branch)
        for stop in element.stops(place.branch)
        if stop.upper == (direction > 0)
    ]
    if direction == 0 or not ahead:
        return None
    reached, branch = min(ahead)
    return direction * reached, branch


def passed(element: Element, place: Place, branch: int) -> Place:
    """Return the same place on the branch that follows."""
    return Place(branch, memory_at(element, place), place.elongation)


def jumps(element: Element, before: Place, after: Place) -> bool:
    """Return whether the force jumps between two branches."""
    return before.branch != after.branch and (after.branch == BROKEN or isinstance(element, Slider))


def plastic_stretch(element: Element, place: Place) -> float:
    """Return the plastic part of the elongation in m; NaN once the element is broken."""
    if not isinstance(element, Bar):
        return 0.0
    return math.nan if place.branch == BROKEN else memory_at(element, place)
