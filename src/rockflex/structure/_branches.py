"""Elements as their branches: tendons, fuses, viscous and friction dampers, and stories that yield."""

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from rockflex.foundation.arrays import Array

ELASTIC, UP, DOWN, SLACK, BROKEN = range(5)  # branches of a bar; UP and DOWN: it yields as it is stretched or shortened
HELD, OUTWARD, INWARD = ELASTIC, UP, DOWN  # branches of a friction damper
BORDER = 1e-12  # relative: an elongation this close to the end of a branch still belongs to it
BARELY = 1e-12  # m: what is without force at rest is this far from slack, so that rounding in contact does not matter
BROKEN_FOR_GOOD = 1e30  # the internal variable of an element that has broken, m


def _barely(position: float | None) -> float:
    return BARELY if position is None else 0.0


class ElementTension(NamedTuple):
    """Tension of an element on one branch: F = stiffness δ + damping δ' + force + internal_factor m; m is internal."""

    stiffness: float = 0.0
    damping: float = 0.0
    force: float = 0.0
    internal_factor: float = 0.0


class BranchLimit(NamedTuple):
    """An elongation δ = place + internal_factor m that ends a branch, and the next branch.

    It is reached from below if `upper`.
    """

    upper: bool
    place: float
    internal_factor: float
    branch: int


class Element(Protocol):
    """An element under the base, stretched by δ = r |θ| at the distance r from the pivot, or attached to floors."""

    @property
    def position(self) -> float | None:
        """Distance from the axis of the masses in m, positive to the right; None if attached to floors."""
        ...

    @property
    def n_internal(self) -> int:
        """How many numbers it remembers: none, its plastic stretch or other internal variable, and its branch."""
        ...

    @property
    def stretches(self) -> float | None:
        """Stretch in m at δ = 0 of an element whose internal variable m follows δ while it yields; None for others."""
        ...

    @property
    def friction(self) -> float:
        """Force in N up to which it sticks, and with which it slides; zero if it does neither."""
        ...

    @property
    def rate_dependent(self) -> bool:
        """Whether its tension follows the velocity δ'."""
        ...

    def yields(self, branch: int) -> bool:
        """Return whether the elastic stretch is constant on a branch, in place of the internal variable."""
        ...

    def broken(self, branch: int) -> bool:
        """Return whether the element is broken on a branch."""
        ...

    @property
    def branches(self) -> tuple[int, ...]:
        """Its branches; a run starts on the first."""
        ...

    def tension(self, branch: int) -> ElementTension:
        """Return the tension on a branch."""
        ...

    def limits(self, branch: int) -> tuple[BranchLimit, ...]:
        """Return the elongations that end a branch."""
        ...

    def direction(self, branch: int) -> int:
        """Return the sign of δ' on a branch that ends where δ' vanishes; 0 on others."""
        ...

    def reversal_offset(self, branch: int) -> float | None:
        """Return δ - m where the elongation turns back on a branch that yields, which ends it; None on others."""
        ...

    def branch_at_rest(self, branch: int) -> int:
        """Return the branch after the elongation has stopped."""
        ...

    def moving(self, branch: int, direction: int) -> int:
        """Return the branch after the elongation has begun to change, with the sign of δ'; 0 if it does not."""
        ...

    def branch_code(self, branch: int) -> float | None:
        """Return the last of its internal variables where that tells the branch; None where it does not."""
        ...

    def state_after_slow_stretch(self, elongation: float) -> tuple[int, tuple[float, ...]]:
        """Return the branch and the internal variables after an element as built has been brought to δ in m."""
        ...

    def branch_at(self, elongation: Array, memory: Array) -> NDArray[np.int64]:
        """Return the branch, (n,), at elongations δ in m with the internal variables at its start, (n, M)."""
        ...

    def stored_energy(self, elongation: Array, force: Array, plastic: Array) -> Array:
        """Return the energy stored in J, relative to the base in contact as built, shape (n,)."""
        ...

    def lost_energy(self, elongation: Array, force: Array, plastic: Array, stored: Array, sweep: Array) -> Array:
        """Return the energy in J that is lost between adjacent states, shape (n - 1,), as ∫ δ'² dt is `sweep`."""
        ...


class ElementDefaults:
    """The answers that most elements share."""

    @property
    def stretches(self) -> float | None:
        return None

    @property
    def friction(self) -> float:
        return 0.0

    @property
    def rate_dependent(self) -> bool:
        return False

    def yields(self, branch: int) -> bool:
        del branch
        return False

    def broken(self, branch: int) -> bool:
        del branch
        return False

    def stored_energy(self, elongation: Array, force: Array, plastic: Array) -> Array:
        del force, plastic
        return np.zeros(elongation.shape)

    def lost_energy(self, elongation: Array, force: Array, plastic: Array, stored: Array, sweep: Array) -> Array:
        del elongation, force, plastic, stored
        return np.zeros(sweep.shape)


class WithoutMemory(ElementDefaults):
    """The answers of elements without an internal variable, most of which have one branch."""

    @property
    def n_internal(self) -> int:
        return 0

    @property
    def branches(self) -> tuple[int, ...]:
        return (ELASTIC,)

    def limits(self, branch: int) -> tuple[BranchLimit, ...]:
        del branch
        return ()

    def direction(self, branch: int) -> int:
        del branch
        return 0

    def reversal_offset(self, branch: int) -> float | None:
        del branch

    def branch_at_rest(self, branch: int) -> int:
        return branch

    def moving(self, branch: int, direction: int) -> int:
        del direction
        return branch

    def branch_code(self, branch: int) -> float | None:
        del branch

    def state_after_slow_stretch(self, elongation: float) -> tuple[int, tuple[float, ...]]:
        return int(self.branch_at(np.array([elongation]), np.zeros((1, 0)))[0]), ()

    def branch_at(self, elongation: Array, memory: Array) -> NDArray[np.int64]:
        del memory
        return np.zeros(elongation.size, dtype=np.int64)


@dataclass(frozen=True)
class ElasticElement(WithoutMemory):
    """A tendon that stays elastic and cannot push: F = max(0, F_0 + k δ)."""

    stiffness: float
    initial_force: float
    position: float | None

    @property
    def branches(self) -> tuple[int, ...]:
        return (ELASTIC, SLACK) if self.stiffness > 0.0 else (ELASTIC,)

    def tension(self, branch: int) -> ElementTension:
        return ElementTension() if branch == SLACK else ElementTension(self.stiffness, 0.0, self.initial_force)

    def limits(self, branch: int) -> tuple[BranchLimit, ...]:
        if self.stiffness == 0.0:
            return ()
        slack = branch == SLACK
        place = -(self.initial_force / self.stiffness or _barely(self.position))
        return (BranchLimit(slack, place, 0.0, ELASTIC if slack else SLACK),)

    def branch_at(self, elongation: Array, memory: Array) -> NDArray[np.int64]:
        del memory
        more = self.stiffness * elongation
        return np.where(self.initial_force + more < -BORDER * np.abs(more), SLACK, ELASTIC)

    def stored_energy(self, elongation: Array, force: Array, plastic: Array) -> Array:
        """F_0 δ + ½ k δ², as far as the tendon is taut."""
        del force, plastic
        slack = -self.initial_force / self.stiffness if self.stiffness > 0.0 else -np.inf
        taut = np.maximum(elongation, slack)
        return (self.initial_force + 0.5 * self.stiffness * taut) * taut


@dataclass(frozen=True)
class ViscousElement(WithoutMemory):
    """A viscous damper: F = c δ'."""

    coefficient: float
    position: float | None

    @property
    def rate_dependent(self) -> bool:
        return True

    def tension(self, branch: int) -> ElementTension:
        del branch
        return ElementTension(damping=self.coefficient)

    def lost_energy(self, elongation: Array, force: Array, plastic: Array, stored: Array, sweep: Array) -> Array:
        """C ∫ δ'² dt."""
        del elongation, force, plastic, stored
        return self.coefficient * sweep


@dataclass(frozen=True)
class YieldingElement(ElementDefaults):
    """A fuse, or a tendon that yields: F = α k e + (1 - α) z, z = k (e - m) within ± F_y, e = δ + e_0.

    The internal variable m is the plastic stretch. A bar that cannot push has no compression: F = max(0, ·).
    """

    stiffness: float
    yield_force: float
    ratio: float
    position: float | None
    stretched: float = 0.0  # e_0
    pulls_only: bool = False
    rupture: float = np.inf  # elongation δ at which it breaks

    @property
    def n_internal(self) -> int:
        return 1

    @property
    def stretches(self) -> float | None:
        return self.stretched

    def yields(self, branch: int) -> bool:
        return branch not in (ELASTIC, SLACK)

    def broken(self, branch: int) -> bool:
        return branch == BROKEN

    @property
    def branches(self) -> tuple[int, ...]:
        return (ELASTIC, UP, DOWN, SLACK, BROKEN)

    def tension(self, branch: int) -> ElementTension:
        k, a, e0 = self.stiffness, self.ratio, self.stretched
        if branch == ELASTIC:
            return ElementTension(k, 0.0, k * e0, -(1.0 - a) * k)
        if branch in (UP, DOWN):
            sign = 1.0 if branch == UP else -1.0
            return ElementTension(a * k, 0.0, a * k * e0 + sign * (1.0 - a) * self.yield_force)
        return ElementTension()

    def limits(self, branch: int) -> tuple[BranchLimit, ...]:
        reach, e0 = self.yield_force / self.stiffness, self.stretched
        breaks = () if np.isinf(self.rupture) else (BranchLimit(True, self.rupture, 0.0, BROKEN),)
        empty, slack = 1.0 - self.ratio, -(e0 or _barely(self.position))
        if branch == ELASTIC:
            slackens = (BranchLimit(False, slack, empty, SLACK),) if self.pulls_only else ()
            return (
                BranchLimit(True, reach - e0, 1.0, UP),
                BranchLimit(False, -reach - e0, 1.0, DOWN),
                *slackens,
                *breaks,
            )
        if branch == SLACK:
            return (BranchLimit(True, slack, empty, ELASTIC), *breaks)
        if branch == DOWN and self.pulls_only and self.ratio > 0.0:
            return (BranchLimit(False, empty / self.ratio * reach - e0, 0.0, SLACK),)
        return breaks if branch == UP else ()

    def direction(self, branch: int) -> int:
        return 1 if branch == UP else -1 if branch == DOWN else 0

    def reversal_offset(self, branch: int) -> float | None:
        sign = self.direction(branch)
        return None if sign == 0 else sign * self.yield_force / self.stiffness - self.stretched

    def branch_at_rest(self, branch: int) -> int:
        return ELASTIC if branch in (UP, DOWN) else branch

    def moving(self, branch: int, direction: int) -> int:
        del direction
        return branch

    def branch_code(self, branch: int) -> float | None:
        return BROKEN_FOR_GOOD if branch == BROKEN else None

    def state_after_slow_stretch(self, elongation: float) -> tuple[int, tuple[float, ...]]:
        stretch, reach = elongation + self.stretched, self.yield_force / self.stiffness
        if elongation >= self.rupture:
            memory = BROKEN_FOR_GOOD
        elif self.pulls_only:
            memory = max(stretch - reach, 0.0)
        else:
            memory = stretch - min(max(stretch, -reach), reach)
        return int(self.branch_at(np.array([elongation]), np.array([[memory]]))[0]), (memory,)

    def branch_at(self, elongation: Array, memory: Array) -> NDArray[np.int64]:
        reach, e, memory = self.yield_force / self.stiffness, elongation + self.stretched, memory[:, 0]
        found = np.full(e.size, ELASTIC, dtype=np.int64)
        room = BORDER * (reach + np.abs(e) + np.abs(memory))
        found[e - memory > reach + room] = UP
        found[e - memory < -reach - room] = DOWN
        if self.pulls_only:
            empty = (1.0 - self.ratio) * memory
            pulls = self.ratio * e >= (1.0 - self.ratio) * reach - room  # while it yields back
            found[(e < empty - room) & ~((found == DOWN) & pulls)] = SLACK
        found[memory == BROKEN_FOR_GOOD] = BROKEN
        return found

    def stored_energy(self, elongation: Array, force: Array, plastic: Array) -> Array:
        """F²/2k + α (1 - α) k m²/2: two springs in parallel, of which one slides.

        The second term stays locked in while the bar is slack. A broken bar, whose m is NaN, stores nothing.
        """
        del elongation
        k, first = self.stiffness, self.stiffness * self.stretched
        locked = 0.5 * self.ratio * (1.0 - self.ratio) * k * plastic**2
        stored = (force - first) * (force + first) / (2.0 * k) + locked
        return np.where(np.isnan(plastic), -(first**2) / (2.0 * k), stored)

    def lost_energy(self, elongation: Array, force: Array, plastic: Array, stored: Array, sweep: Array) -> Array:
        """(1 - α) F_y for every metre that it yields, and whatever it stores when it breaks."""
        del elongation, force, sweep
        broken = np.isnan(plastic)
        yielded = np.where(broken[1:], 0.0, np.abs(np.diff(plastic)))
        lost = (1.0 - self.ratio) * self.yield_force * yielded
        return np.where(broken[1:] & ~broken[:-1], stored[:-1] - stored[1:], lost)


@dataclass(frozen=True)
class YieldingStoryElement(YieldingElement):
    """A story that yields, less its elastic part k δ, which belongs to the modes."""

    def tension(self, branch: int) -> ElementTension:
        whole = super().tension(branch)
        return whole._replace(stiffness=whole.stiffness - self.stiffness)

    def stored_energy(self, elongation: Array, force: Array, plastic: Array) -> Array:
        """The energy that the whole story stores, less ½ k δ²."""
        elastic = self.stiffness * elongation
        return super().stored_energy(elongation, force + elastic, plastic) - 0.5 * elastic * elongation


@dataclass(frozen=True)
class FrictionElement(ElementDefaults):
    """A friction damper: F = ± F_0 while it slides, less while it sticks. It remembers its direction, 1, 0 or -1."""

    force: float
    position: float | None

    @property
    def friction(self) -> float:
        return self.force

    @property
    def n_internal(self) -> int:
        return 1

    @property
    def branches(self) -> tuple[int, ...]:
        return (HELD, OUTWARD, INWARD)

    def tension(self, branch: int) -> ElementTension:
        return ElementTension(force=self.direction(branch) * self.force)

    def limits(self, branch: int) -> tuple[BranchLimit, ...]:
        del branch
        return ()

    def direction(self, branch: int) -> int:
        return 1 if branch == OUTWARD else -1 if branch == INWARD else 0

    def reversal_offset(self, branch: int) -> float | None:
        del branch

    def branch_at_rest(self, branch: int) -> int:
        del branch
        return HELD

    def moving(self, branch: int, direction: int) -> int:
        del branch
        return OUTWARD if direction > 0 else INWARD if direction < 0 else HELD

    def branch_code(self, branch: int) -> float | None:
        return float(self.direction(branch))

    def state_after_slow_stretch(self, elongation: float) -> tuple[int, tuple[float, ...]]:
        del elongation
        return HELD, (0.0,)

    def branch_at(self, elongation: Array, memory: Array) -> NDArray[np.int64]:
        found = np.full(elongation.size, HELD, dtype=np.int64)
        found[memory[:, 0] > 0.0] = OUTWARD
        found[memory[:, 0] < 0.0] = INWARD
        return found

    def lost_energy(self, elongation: Array, force: Array, plastic: Array, stored: Array, sweep: Array) -> Array:
        """F_0 for every metre that it slides."""
        del force, plastic, stored, sweep
        return self.force * np.abs(np.diff(elongation))
