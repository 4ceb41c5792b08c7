"""Which motions are components of one recording, and which recordings share an earthquake or a station."""

import re
from collections import defaultdict
from collections.abc import Hashable, Iterable
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex.motion._direction import APART, is_horizontal_name
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._rotation import rotated_spectrum

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
    """Join motions that are the two horizontal components of a recording.

    They belong together if they have the same record sequence number; else if event, year and station are the same;
    else if their names differ only in the component, as ABC000 and ABC090, or ABC-NS and ABC-EW.

    Returns
    -------
    tuple
        The pairs, and the names of the motions that are not one of exactly two with the same time step.
    """
    groups: dict[Hashable, list[GroundMotion]] = defaultdict(list)
    for motion in motions:
        groups[_recording(motion) or motion.name].append(motion)
    pairs = [Recording(tuple(group)) for group in groups.values() if _is_pair(group)]
    return pairs, [motion.name for group in groups.values() if not _is_pair(group) for motion in group]


def _is_pair(group: list[GroundMotion]) -> bool:
    return len(group) == 2 and abs(group[0].dt - group[1].dt) <= 1e-9 * group[0].dt


def _recording(motion: GroundMotion) -> Key:
    info = motion.metadata
    if info is not None and info.rsn is not None:
        return ("rsn", info.rsn)
    if info is not None and None not in (info.event, info.year, info.station):
        return (info.event, info.year, info.station)
    splits = [(motion.name[:end], motion.name[end:].lstrip(APART)) for end in range(1, len(motion.name))]
    words = [(station, word) for station, word in splits if is_horizontal_name(word)]
    # In G1230 the azimuth is 230, although 1230 or 30 would also do.
    words.sort(key=lambda each: not (each[0][-1] in APART or re.fullmatch(r"\d{3}", each[1])))
    return ("name", words[0][0].rstrip(APART).casefold()) if words else None
