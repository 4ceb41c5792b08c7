"""Which motions are components of one recording, and which recordings share an earthquake or a station."""

from collections.abc import Hashable, Iterable, Sequence
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._rotation import rotated_spectrum
from rockflex.motion._stations import group_stations

Combination = Literal["component", "geometric mean", "rotd50", "rotd100"]

Key: TypeAlias = tuple[Hashable, ...] | None


@dataclass(frozen=True, eq=False)
class Recording:
    """One motion, or the two horizontal components of a recording."""

    motions: tuple[GroundMotion, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the motions."""
        return tuple(motion.name for motion in self.motions)

    @property
    def event(self) -> Key:
        """What recordings of one earthquake share; None if it is not known."""
        info = self.motions[0].metadata
        return None if info is None or info.event is None else (info.event.casefold(), info.year)

    @property
    def station(self) -> Key:
        """What recordings at one station share; None if it is not known."""
        info = self.motions[0].metadata
        return None if info is None or info.station is None else (info.station.casefold(),)

    def sa(self, periods: ArrayLike, measure: Combination, damping_ratio: float) -> Array:
        """Pseudo-acceleration in m/s², shape (m,), of the only component, or of two combined."""
        if measure in ("rotd50", "rotd100"):
            first, second = self.motions
            rotated = rotated_spectrum(first, second, periods, damping_ratio)
            return rotated.rotd50 if measure == "rotd50" else rotated.rotd100
        spectra = [motion.spectrum(periods, damping_ratio).sa for motion in self.motions]
        return np.prod(spectra, axis=0) ** (1.0 / len(spectra))


def paired(motions: Iterable[GroundMotion]) -> tuple[list[Recording], list[str]]:
    """Join motions that are the two horizontal components of a recording, as `group_stations` finds them.

    Returns
    -------
    tuple
        The pairs, and the names of the motions that are not one of exactly two with the same time step.
    """
    groups = [station.horizontal for station in group_stations(motions)]
    pairs = [Recording(group) for group in groups if _is_pair(group)]
    return pairs, [motion.name for group in groups if not _is_pair(group) for motion in group]


def _is_pair(group: Sequence[GroundMotion]) -> bool:
    return len(group) == 2 and abs(group[0].dt - group[1].dt) <= 1e-9 * group[0].dt
