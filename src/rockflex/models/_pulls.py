"""The pull of all elements together about a pivot, in one phase.

An element at the distance r from the pivot is stretched by δ = 2 r sin(|θ|/2). Its tension F = k δ + c δ' + f + g m,
with its memory m, adds the moment -s F r cos(θ/2). For small rotations these are δ = r |θ| and -s F r.
"""

import math

import numpy as np

from rockflex._arrays import Array
from rockflex.modal import RockingProperties
from rockflex.models._element import Element
from rockflex.models._elements import CLOSED, arm_of, is_held, memories
from rockflex.models._phase import Key

# Indices in the sums: Σ f r, Σ k r², Σ c r² for the moment; Σ f, Σ k r, Σ c r for the force. Those with f also have a
# share g of every memory. The last is 1 if friction dampers hold the base, otherwise 0.
MOMENT, STIFFNESS, DAMPING, FORCE, PULL, DRAG, HOLD = range(7)
SUMS = 7


def pulls_of(properties: RockingProperties, elements: tuple[Element, ...], key: Key) -> Array:
    """Return the sums over the elements on their branches, and what each memory adds to them, shape (7, 1 + M)."""
    known = memories(elements)
    total = np.zeros((SUMS, 1 + len(known)))
    terms: list[tuple[float, ...]] = []
    for place, (each, branch) in enumerate(zip(elements, key[1:], strict=True)):
        r = arm_of(properties, each, key[0]) if key[0] != CLOSED else 0.0
        k, c, f, g = each.pull(branch)
        terms.append((f * r, k * r**2, c * r**2, f, k * r, c * r))
        if place in known:
            total[MOMENT, 1 + known[place]], total[FORCE, 1 + known[place]] = g * r, g
    # Exactly rounded, so that mirrored bases have the same sums to the last digit.
    total[:HOLD, 0] = [math.fsum(values) for values in zip(*terms, strict=True)] or 0.0
    total[HOLD, 0] = is_held(properties, elements, key)
    total.setflags(write=False)
    return total
