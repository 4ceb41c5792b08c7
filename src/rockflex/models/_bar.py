"""Bars that yield: fuses, and tendons with a post-yield stiffness."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array
from rockflex.models._element import BORDER, BROKEN, DOWN, ELASTIC, SLACK, UP, Pull, Stop

BROKEN_FOR_GOOD = 1e30  # the memory of an element that has broken, m


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
            return (Stop(False, empty / self.ratio * reach - e0, 0.0, SLACK),)
        return breaks if branch == UP else ()

    def direction(self, branch: int) -> int:
        return 1 if branch == UP else -1 if branch == DOWN else 0

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
            pulls = self.ratio * e >= (1.0 - self.ratio) * reach - room  # while it yields back
            found[(e < empty - room) & ~((found == DOWN) & pulls)] = SLACK
        found[memory == BROKEN_FOR_GOOD] = BROKEN
        return found
