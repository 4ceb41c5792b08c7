"""Whether the stiffness of the elements can balance the weight, on any combination of their branches."""

from collections.abc import Sequence

import numpy as np

from rockflex._arrays import Array
from rockflex.modal import RockingProperties
from rockflex.models._element import Element
from rockflex.models._elements import arm_of, is_in_reach

FINE = 1e-3  # of the margin: sums this close to each other count as one


def stiffnesses_of(properties: RockingProperties, elements: tuple[Element, ...], side: int) -> list[Array]:
    """Return the possible values of k r² of every element about a pivot, in N m/rad."""
    arms = [arm_of(properties, each, side) for each in elements]
    return [
        np.unique([each.pull(branch).stiffness * r**2 for branch in _reached(each, r)])
        for each, r in zip(elements, arms, strict=True)
    ]


def _reached(element: Element, arm: float) -> set[int]:
    """Return the branches that an element can reach from its first, to which it also returns as it turns back."""
    reached: set[int] = set()
    ahead = {element.branches[0]}
    while ahead:
        reached |= ahead
        ahead = {stop.branch for each in ahead for stop in element.stops(each) if is_in_reach(stop, arm)} - reached
    return reached


def meets(choices: Sequence[Array], target: float, margin: float) -> bool:
    """Return whether a sum of one value of each of `choices`, none negative, comes within `margin` of a target."""
    sums = np.zeros(1)
    for values in choices:
        sums = np.add.outer(sums, values).ravel()
        sums = np.unique(sums[sums < target + margin])
        # Many elements have far more combinations than there are different sums.
        sums = sums[np.unique(np.floor(sums / (FINE * margin)), return_index=True)[1]]
    return bool((np.abs(sums - target) < margin).any())
