"""Friction dampers."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array
from rockflex.models._element import DOWN, ELASTIC, UP, Pull, Stop

HELD, OUTWARD, INWARD = ELASTIC, UP, DOWN  # branches of a friction damper


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
