"""The definition of a phase of the motion: free degrees of freedom of the base, forces, and end conditions."""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from rockflex._arrays import Array, Bools

Key = tuple[int, ...]  # the branch of every element, the base first

# Events that end a phase. RELEASES: a base that friction dampers held begins to rotate. CHANGES: an element takes
# another branch. TURNS: the rotation turns back while an element yields or slides. SLIPS and STICKS: the base begins
# and ends to slide, or turns back without friction. OPENS and CLOSES: an edge of a base leaves its spring, and comes
# back to it.
LIFTS, LANDS, OVERTURNS, RELEASES, CHANGES, TURNS, SLIPS, STICKS, OPENS, CLOSES = range(10)


@dataclass(frozen=True, eq=False)
class Border:
    """Contribution to the equations of the base, M q'' + .. + C q' + K q = f + a g + H m, with b unknowns q.

    Attributes
    ----------
    inertia, damping, stiffness : ndarray, shape (b, b)
        M, C and K.
    constant, ground : ndarray, shape (b,)
        f, and the factor g of the ground acceleration.
    recall : ndarray, shape (b, M)
        H, the factor of the memories m of the elements.
    """

    inertia: Array
    damping: Array
    stiffness: Array
    constant: Array
    ground: Array
    recall: Array

    @classmethod
    def on_rotation(
        cls,
        *,
        inertia: float = 0.0,
        damping: float = 0.0,
        stiffness: float = 0.0,
        constant: float = 0.0,
        ground: float = 0.0,
        recall: Array | None = None,
    ) -> "Border":
        """Return the border of an element that acts only on the rotation."""
        squares, columns = np.zeros((3, 1, 1)), np.zeros((2, 1))
        squares[:, 0, 0] = inertia, damping, stiffness
        columns[:, 0] = constant, ground
        factors = np.zeros((1, 0 if recall is None else recall.size))
        if recall is not None:
            factors[0] = recall
        return cls(squares[0], squares[1], squares[2], columns[0], columns[1], factors)

    def __add__(self, other: "Border") -> "Border":
        return Border(
            self.inertia + other.inertia,
            self.damping + other.damping,
            self.stiffness + other.stiffness,
            self.constant + other.constant,
            self.ground + other.ground,
            self.recall + other.recall,
        )


@dataclass(frozen=True, eq=False)
class Arrow:
    """The equations of motion of one phase: N oscillators bordered by the b degrees of freedom q of the base.

        D''_n + 2 ζ_n ω_n D'_n + ω_n² D_n + c_n · q'' = -a
        M q'' + Σ_n m*_n c_n D''_n + C q' + K q = f + a g + H m

    With D'' eliminated, (M - Σ m* c cᵀ) q'' = f + H m + a (g + Σ m* c) + Σ m* c (2ζω D' + ω² D) - C q' - K q.

    Attributes
    ----------
    coupling : ndarray, shape (b, N)
        c: h* for the rotation.
    leverage : ndarray, shape (b, N)
        m* c.
    flexibility : ndarray, shape (b, b)
        (M - Σ m* c cᵀ)⁻¹ of the free degrees of freedom; zero in the rows and columns of fixed ones.
    damping, stiffness : ndarray, shape (b, b)
        C and K.
    constant, drive : ndarray, shape (b,)
        f, and g + Σ m* c.
    recall : ndarray, shape (b, M)
        H, the factor of the memories m of the elements, which are constant during a phase.
    freed : ndarray of bool, shape (b,)
        Which are free.
    """

    coupling: Array
    leverage: Array
    flexibility: Array
    damping: Array
    stiffness: Array
    constant: Array
    drive: Array
    recall: Array
    freed: Bools

    @property
    def free(self) -> bool:
        """Whether any degree of freedom of the base is free."""
        return bool(self.freed.any())

    @property
    def drifts(self) -> bool:
        """Whether some free degree of freedom of the base has neither stiffness nor damping: a slip, or free flight."""
        return bool((self.freed & ~self.stiffness.any(axis=0) & ~self.damping.any(axis=0)).any())

    def alike(self, other: "Arrow") -> bool:
        """Return whether both have the same eigenvectors, that is, differ at most in the constant forces."""
        return self.likeness == other.likeness

    @cached_property
    def likeness(self) -> bytes:
        """All numbers that the eigenvectors depend on."""
        parts = (self.freed, self.flexibility, self.stiffness, self.damping, self.drive, self.coupling)
        return b"".join((part + 0.0).tobytes() for part in parts)  # 0.0 has the bytes of -0.0 then


@dataclass(frozen=True)
class Exit:
    """The event at which a guard leaves its band, and the phase that follows."""

    event: int
    key: Key


@dataclass(frozen=True, eq=False)
class Guard:
    """A row that stays between two limits during the phase.

    Attributes
    ----------
    row : ndarray, shape (C,)
        Multiplies the moving entries of the state, the ground acceleration and 1.
    low, high
        Its limits; infinite if there is no limit.
    below, above
        What happens at each limit; None if there is no limit.
    recall : ndarray, shape (2, M)
        What the memories add to the lower and to the upper limit.
    turn
        What the rotation adds to both limits, per rad; zero unless the base is held at a rotation.
    """

    row: Array
    low: float
    high: float
    below: Exit | None
    above: Exit | None
    recall: Array
    turn: float = 0.0


class Change(NamedTuple):
    """A limit of δ/r, place + recall m with the memory m of one element, at which this element changes its branch.

    δ/r, the elongation per unit distance from the pivot, is |θ|, and 2 sin(|θ|/2) in complete models.

    The limit is reached from below if `outer`. `memory` is the index of m, -1 for an element without memory, and `key`
    the following phase.
    """

    outer: bool
    place: float
    recall: float
    memory: int
    key: Key


class Fence(NamedTuple):
    """A row that is not negative during a phase. Where it falls below zero, an event leads to the next phase.

    `row` multiplies the moving entries of the state, the horizontal acceleration of the ground and 1, shape (C,). A
    memory with an index not below zero then becomes `value`, a row too.
    """

    row: Array
    event: int
    key: Key
    memory: int = -1
    value: Array | None = None


class Turning(NamedTuple):
    """A memory that is set where the rotation turns back: m = arm δ/r - offset, with the index `memory`."""

    memory: int
    arm: float
    offset: float


@dataclass(frozen=True, eq=False)
class Phase:
    """A combination of branches, one for every element of a model.

    Attributes
    ----------
    key
        The branches.
    side
        Pivot about which the base rotates: 1 right, -1 left, 0 in contact.
    arrow
        The equations of motion; None if they are not linear, in which case a vector field is used.
    guard
        The condition that ends the phase: on the rotation while the base rocks, on the overturning moment in contact.
    changes
        Rotations at which an element changes its branch.
    free
        Whether the base rotates: it neither rests on the ground nor is held by friction dampers.
    fences
        Further rows that end the phase where they become negative.
    turns
        Sign of the velocity |θ|' while an element yields or slides, whose branch ends at zero velocity; 0 if none does.
    turnings
        The memories of the elements that yield, as their branches end.
    marks
        The memories that have a value of their own in this phase, by index.
    turned
        The phase that follows at zero velocity.
    beside
        The phases after a landing: in contact, about the right pivot and about the left pivot.
    pulls : ndarray, shape (7, 1 + M)
        Sums over the elements for phases that are not linear, and what the memories add to them; see `pulls_of`.
    """

    key: Key
    side: int
    arrow: Arrow | None
    guard: Guard
    pulls: Array
    changes: tuple[Change, ...]
    turned: Key
    beside: tuple[Key, Key, Key]
    free: bool = False
    fences: tuple[Fence, ...] = ()
    turns: int = 0
    turnings: tuple[Turning, ...] = ()
    marks: tuple[tuple[int, float], ...] = ()
