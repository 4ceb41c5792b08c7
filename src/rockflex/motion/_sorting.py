"""Which components of many files are taken as horizontal motions, and why the others are left out."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rockflex._arrays import Array
from rockflex.motion._collect import FileRead
from rockflex.motion._direction import is_vertical
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._pairs import are_apart, paired
from rockflex.motion._record_info import RecordInfo

BELOW = "borehole"
FEWEST = 50  # samples; fewer may be the same by chance
ALIKE = 1e-3  # of the peak, by which samples of one record may differ: two formats round, or take another value of g


@dataclass(frozen=True)
class Sorted:
    """Components by their paths: those taken, and those left out.

    `without` gives the reason why a record that is to be paired has no vertical component, empty if none was found;
    `upwards` are the vertical components that were paired; `copies` give the component that each repeats.
    """

    taken: Mapping[Path, GroundMotion]
    vertical: Sequence[Path]
    below: Sequence[Path]
    without: Mapping[Path, str]
    upwards: Sequence[Path]
    copies: Mapping[Path, Path]


def sort_out(found: Sequence[FileRead], *, pair: bool) -> Sorted:
    """Take the horizontal components, with the vertical ones if `pair`.

    Copies of other components are left out, and boreholes beneath surface records.
    """
    motions = {path: motion for each in found for path, motion in each.motions.items()}
    copies = _copies(motions, {path: each.file for each in found for path in each.motions})
    motions = {path: motion for path, motion in motions.items() if path not in copies}
    surface = {_place(motion) for motion in motions.values() if _location(motion) == "surface"}
    below = [path for path, each in motions.items() if _location(each) == BELOW and _place(each) in surface]
    kept = {path: motion for path, motion in motions.items() if path not in set(below)}
    upright = {path: motion for path, motion in kept.items() if is_vertical(motion)}
    taken = {path: motion for path, motion in kept.items() if path not in upright}
    if not pair or not taken:
        return Sorted(taken, list(upright), below, {}, [], copies)
    both, without, left = paired(taken, upright)
    return Sorted(both, left, below, without, [path for path in upright if path not in left], copies)


def _copies(motions: Mapping[Path, GroundMotion], files: Mapping[Path, Path]) -> dict[Path, Path]:
    """Return the components that another file holds too, and which of both is kept: the one of which more is known.

    Components that their record sequence numbers, azimuths or names tell apart are no copies, whatever their samples.
    """
    found: dict[Path, Path] = {}
    kept: dict[int, list[tuple[float, Path]]] = {}
    for path in sorted(motions, key=lambda path: _rank(path, motions[path])):
        motion = motions[path]
        if motion.acceleration.size < FEWEST:
            continue
        others = kept.setdefault(motion.acceleration.size, [])
        for pga, other in others:
            if (
                files[path] != files[other]
                and abs(pga - motion.pga) <= ALIKE * pga
                and _same(path, motion, other, motions[other])
            ):
                found[path] = other
                break
        else:
            others.append((motion.pga, path))
    return {path: found[path] for path in motions if path in found}


def _rank(path: Path, motion: GroundMotion) -> tuple[object, ...]:
    """Return a key by which the first of some copies is the one to keep."""
    known = sum(value is not None for value in vars(motion.metadata or RecordInfo()).values())
    return motion.vertical is None, -known, len(path.name), path.name, str(path)


def _same(path: Path, motion: GroundMotion, other: Path, kept: GroundMotion) -> bool:
    if abs(motion.dt - kept.dt) > ALIKE * kept.dt or is_vertical(motion) != is_vertical(kept):
        return False
    if are_apart(path, motion.metadata, other, kept.metadata) or not _alike(motion.acceleration, kept.acceleration):
        return False
    return motion.vertical is None or kept.vertical is None or _alike(motion.vertical, kept.vertical)


def _alike(one: Array, other: Array) -> bool:
    """Return whether samples are the same but for rounding; those at rest say nothing."""
    peak = float(np.max(np.abs(other)))
    return peak > 0.0 and bool(np.max(np.abs(one - other)) <= ALIKE * peak)


def _location(motion: GroundMotion) -> str | None:
    return None if motion.metadata is None else motion.metadata.location


def _place(motion: GroundMotion) -> tuple[object, ...]:
    info = motion.metadata
    return () if info is None else (info.event, info.network, info.station)
