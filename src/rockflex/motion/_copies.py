"""Components that several files hold: copies, and uncorrected records beside corrected ones."""

import re
from collections.abc import Mapping
from datetime import datetime
from pathlib import Path

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.motion._ground_motion import GroundMotion, is_vertical_component, record_info_of
from rockflex.motion._record_info import RecordInfo
from rockflex.motion._recordings import are_different_components

MIN_COPY_SAMPLES = 50  # samples; fewer may be the same by chance
COPY_TOLERANCE = 1e-3  # of the peak: two formats of one record round, or take another value of g
UNCORRECTED_SUFFIX = re.compile(r"\.(?:v[01][a-z]?|raw)", re.IGNORECASE)
MAX_START_DIFFERENCE = 60.0  # s; corrected records are often cut
MAX_AZIMUTH_DIFFERENCE = 1.0  # degrees, as headers round them


def duplicate_components(motions: Mapping[Path, GroundMotion], files: Mapping[Path, Path]) -> dict[Path, Path]:
    """Return the components that another file holds too, and which of both is kept: the one of which more is known.

    Components that their record sequence numbers, azimuths or names tell apart are no copies, whatever their samples.
    """
    found: dict[Path, Path] = {}
    kept: dict[int, list[tuple[float, Path]]] = {}
    for path in sorted(motions, key=lambda path: _duplicate_rank(path, motions[path])):
        motion = motions[path]
        if motion.acceleration.size < MIN_COPY_SAMPLES:
            continue
        others = kept.setdefault(motion.acceleration.size, [])
        for pga, other in others:
            if (
                files[path] != files[other]
                and abs(pga - motion.pga) <= COPY_TOLERANCE * pga
                and _are_duplicate_components(path, motion, other, motions[other])
            ):
                found[path] = other
                break
        else:
            others.append((motion.pga, path))
    return {path: found[path] for path in motions if path in found}


def _duplicate_rank(path: Path, motion: GroundMotion) -> tuple[object, ...]:
    """Return a key by which the first of some copies is the one to keep."""
    known = sum(value is not None for value in vars(record_info_of(motion)).values())
    return motion.vertical is None, -known, len(path.name), path.name, str(path)


def _are_duplicate_components(path: Path, motion: GroundMotion, other: Path, kept: GroundMotion) -> bool:
    if (
        abs(motion.dt - kept.dt) > COPY_TOLERANCE * kept.dt
        or is_vertical_component(motion) != is_vertical_component(kept)
        or are_different_components(path, motion.metadata, other, kept.metadata)
        or not _equal_samples(motion.acceleration, kept.acceleration)
    ):
        return False
    return motion.vertical is None or kept.vertical is None or _equal_samples(motion.vertical, kept.vertical)


def _equal_samples(one: Array, other: Array) -> bool:
    """Return whether samples are the same but for rounding; two records at rest do not count as the same."""
    peak = float(np.max(np.abs(other)))
    return peak > 0.0 and bool(np.max(np.abs(one - other)) <= COPY_TOLERANCE * peak)


def uncorrected_components(motions: Mapping[Path, GroundMotion], files: Mapping[Path, Path]) -> dict[Path, Path]:
    """Return the uncorrected components of which a corrected one is there too, and that one.

    A component is uncorrected if its reader or the suffix of its file (.V1, .V0, .RAW) says so. Both are of one
    recording if network, station, place, component and the start, else the event, are the same as far as they are
    known; where no header says so, the names of the files must be the same but for the suffix.
    """
    raw = [path for path, motion in motions.items() if _is_uncorrected(files[path], record_info_of(motion))]
    others = [path for path in motions if path not in set(raw)]
    found: dict[Path, Path] = {}
    for path in raw:
        motion = motions[path]
        corrected = (
            other
            for other in others
            if is_vertical_component(motions[other]) == is_vertical_component(motion)
            and _is_same_component(files[path], record_info_of(motion), files[other], record_info_of(motions[other]))
        )
        first = next(corrected, None)
        if first is not None:
            found[path] = first
    return found


def _is_uncorrected(file: Path, info: RecordInfo) -> bool:
    return (info.processing or "").casefold().startswith("uncorrected") or bool(
        UNCORRECTED_SUFFIX.fullmatch(file.suffix)
    )


def _is_same_component(file: Path, info: RecordInfo, other: Path, known: RecordInfo) -> bool:
    facts = [_same_text(getattr(info, name), getattr(known, name)) for name in ("network", "station", "location")]
    component = _same_text(info.component, known.component)
    if info.azimuth is not None and known.azimuth is not None:
        away = abs(info.azimuth - known.azimuth) % 360.0
        component = min(away, 360.0 - away) <= MAX_AZIMUTH_DIFFERENCE
    if False in facts or component is False:
        return False
    when = _same_time(info, known)
    if when is None or facts[1] is None or component is None:
        return when is not False and file.parent == other.parent and file.stem.casefold() == other.stem.casefold()
    return when


def _same_text(one: str | None, other: str | None) -> bool | None:
    """Return whether two facts are the same, None where one is not known."""
    return None if one is None or other is None else one.casefold() == other.casefold()


def _same_time(info: RecordInfo, known: RecordInfo) -> bool | None:
    """Return whether two records begin at the same time, or else are of the same event; None where nobody knows."""
    starts = [_time(each.start_time) for each in (info, known)]
    if starts[0] is not None and starts[1] is not None and len({each.tzinfo is None for each in starts if each}) == 1:
        return abs((starts[0] - starts[1]).total_seconds()) <= MAX_START_DIFFERENCE
    by_number = _same_text(info.event_id, known.event_id)
    return _same_text(info.event, known.event) if by_number is None else by_number


def _time(text: str | None) -> datetime | None:
    try:
        return None if text is None else datetime.fromisoformat(text)
    except ValueError:
        return None
