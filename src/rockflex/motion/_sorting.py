"""Which components of many files are taken as horizontal motions, and why the others are left out."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from rockflex.motion._collect import FileRead
from rockflex.motion._direction import is_vertical
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._pairs import paired

BELOW = "borehole"


@dataclass(frozen=True)
class Sorted:
    """Components by their paths: those taken, and those left out.

    `without` gives the reason why a record that is to be paired has no vertical component, empty if none was found;
    `upwards` are the vertical components that were paired.
    """

    taken: Mapping[Path, GroundMotion]
    vertical: Sequence[Path]
    below: Sequence[Path]
    without: Mapping[Path, str]
    upwards: Sequence[Path]


def sort_out(found: Sequence[FileRead], *, pair: bool) -> Sorted:
    """Take the horizontal components, with the vertical ones if `pair`; leave out boreholes beneath surface records."""
    motions = {path: motion for each in found for path, motion in each.motions.items()}
    surface = {_place(motion) for motion in motions.values() if _location(motion) == "surface"}
    below = [path for path, each in motions.items() if _location(each) == BELOW and _place(each) in surface]
    kept = {path: motion for path, motion in motions.items() if path not in set(below)}
    upright = {path: motion for path, motion in kept.items() if is_vertical(motion)}
    taken = {path: motion for path, motion in kept.items() if path not in upright}
    if not pair or not taken:
        return Sorted(taken, list(upright), below, {}, [])
    both, without, left = paired(taken, upright)
    return Sorted(both, left, below, without, [path for path in upright if path not in left])


def _location(motion: GroundMotion) -> str | None:
    return None if motion.metadata is None else motion.metadata.location


def _place(motion: GroundMotion) -> tuple[object, ...]:
    info = motion.metadata
    return () if info is None else (info.event, info.network, info.station)
