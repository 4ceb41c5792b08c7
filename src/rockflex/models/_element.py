"""What an element between the base and the ground is, and elements without memory: elastic tendons and dashpots."""

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array

ELASTIC, UP, DOWN, SLACK, BROKEN = range(5)  # branches of a bar; UP and DOWN: it yields as it is stretched or shortened
BORDER = 1e-12  # relative: an elongation this close to the end of a branch still belongs to it


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


class WithoutMemory:
    """What is common to elements without memory, most of which have one branch."""

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
class Spring(WithoutMemory):
    """A tendon that stays elastic and cannot push: F = max(0, F_0 + k δ)."""

    stiffness: float
    initial_force: float
    position: float

    @property
    def branches(self) -> tuple[int, ...]:
        return (ELASTIC, SLACK) if self.stiffness > 0.0 else (ELASTIC,)

    def pull(self, branch: int) -> Pull:
        return Pull() if branch == SLACK else Pull(self.stiffness, 0.0, self.initial_force)

    def stops(self, branch: int) -> tuple[Stop, ...]:
        if self.stiffness == 0.0:
            return ()
        slack = branch == SLACK
        return (Stop(slack, -self.initial_force / self.stiffness, 0.0, ELASTIC if slack else SLACK),)

    def branch_at(self, elongation: Array, memory: Array) -> NDArray[np.int64]:
        del memory
        more = self.stiffness * elongation
        return np.where(self.initial_force + more < -BORDER * np.abs(more), SLACK, ELASTIC)


@dataclass(frozen=True)
class Dashpot(WithoutMemory):
    """A viscous damper: F = c δ'."""

    coefficient: float
    position: float

    def pull(self, branch: int) -> Pull:
        del branch
        return Pull(damping=self.coefficient)
