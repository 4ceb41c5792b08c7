"""Which vertical record belongs to which horizontal one."""

import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TypeAlias

from rockflex._errors import InputError
from rockflex.motion._direction import APART, azimuth_of, is_horizontal_name, station_of_vertical
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._record_info import RecordInfo

Key: TypeAlias = tuple[str | int | None, ...]

ASKEW = 10.0  # degrees by which components may differ from a right angle
REPORTED = 10  # records that are named in a message; of more, the number is told


def paired(
    horizontal: Mapping[Path, GroundMotion], vertical: Mapping[Path, GroundMotion]
) -> tuple[dict[Path, GroundMotion], dict[Path, str], list[Path]]:
    """Give each horizontal record the vertical one of its station.

    Records that have a vertical component already keep it.

    Returns
    -------
    tuple
        All horizontal records; for those that remain without a vertical component, the reason, which is empty if no
        vertical record belongs to them; the vertical records that belong to none.
    """
    both: dict[Path, GroundMotion] = {}
    without: dict[Path, str] = {}
    used: set[Path] = set()
    index = _index(vertical)
    for file, motion in horizontal.items():
        both[file] = motion
        if motion.vertical is not None:
            continue
        found = next((index[key] for key in _keys(file, motion.metadata) if key in index), [])
        used.update(found)
        if len(found) == 1:
            try:
                both[file] = motion.with_vertical(vertical[found[0]])
            except InputError as error:
                without[file] = f"{found[0].name}: {error}"
        else:
            without[file] = f"{named(found)} could each belong to it" if found else ""
    return both, without, [file for file in vertical if file not in used]


def station_names(motions: Sequence[tuple[Path, GroundMotion]]) -> list[str]:
    """Return the name of the recording of each component, the same for those that belong together.

    `motions` are the components with paths whose stems are their names; see `group_stations`.
    """
    known = [_header_name(motion.metadata) for _, motion in motions]
    stems = [_stems(Path(f"{file}.x"), motion) for file, motion in motions]
    counts = Counter(stem.casefold() for options in stems for stem in options)
    first: dict[str, str] = {}
    found: list[str] = []
    for name, options, (file, _) in zip(known, stems, motions, strict=True):
        shared = next((stem for stem in options if counts[stem.casefold()] > 1), None)
        found.append(name or (first.setdefault(shared.casefold(), shared) if shared else file.name))
    return found


def recording_names(names: Sequence[str]) -> list[str]:
    """Return what the name of each component shares with that of the other one of its recording, else the whole name.

    A recording has two horizontal components, at right angles: ABC000 and ABC090, or A-H1 and A-H2. Records that are
    merely numbered, such as GM1 and GM2, do not belong together.
    """
    files = [Path(f"{name}.x") for name in names]
    words = [{key: word for key, word in _components(file).items() if key[1]} for file in files]
    members: dict[Key, list[int]] = defaultdict(list)
    for place, each in enumerate(words):
        for key in each:
            members[key].append(place)
    found = list(names)
    for place, each in enumerate(words):
        pair = next((key for key in each if _are_across([words[other][key] for other in members[key]])), None)
        if pair is not None:
            first = members[pair][0]
            found[place] = names[first][: len(names[first]) - len(files[first].stem) + len(str(pair[1]))]
    return found


def _are_across(components: Sequence[str]) -> bool:
    """Return whether words name the two horizontal components of a recording."""
    angles = [azimuth_of(word) for word in components]
    if len(angles) != 2 or angles == [None, None]:
        return len(angles) == 2
    one, other = angles
    return one is not None and other is not None and abs((one - other) % 180.0 - 90.0) <= ASKEW


def _header_name(info: RecordInfo | None) -> str | None:
    for key in _by_header(info):
        if len(key) == 1:
            return f"RSN{key[0]}"
        event, _, station, network, location = key
        return " ".join(str(part) for part in (network, station, location, event) if part is not None)
    return None


def _stems(file: Path, motion: GroundMotion) -> list[str]:
    """Return what a name may be without its component, the surest first."""
    upright = station_of_vertical(file)
    if motion.metadata is not None and motion.metadata.is_vertical:
        return [] if upright is None else [upright]
    return [file.stem[: len(str(key[1]))] for key in _keys(file, None) if key[1]]


def are_apart(file: Path, info: RecordInfo | None, other: Path, known: RecordInfo | None) -> bool:
    """Return whether two files are of different recordings by their numbers, or of different components."""
    one, two = info or RecordInfo(), known or RecordInfo()
    for fact in ("rsn", "azimuth"):
        values = {getattr(one, fact), getattr(two, fact)} - {None}
        if len(values) > 1:
            return True
    first, second = _components(file), _components(other)
    return any(first[station] != second[station] for station in first.keys() & second.keys())


def _components(file: Path) -> dict[Key, str]:
    """Return what the name of a file may say of its component, by the station that the rest of it then is."""
    return {key: file.stem[len(str(key[1])) :].lstrip(APART).casefold() for key in _keys(file, None)}


def named(files: Iterable[Path]) -> str:
    """Return the names of files, of the first ones if they are many."""
    names = [file.name for file in files]
    more = f" and {len(names) - REPORTED} more" if len(names) > REPORTED else ""
    return ", ".join(names[:REPORTED]) + more


def _index(vertical: Mapping[Path, GroundMotion]) -> dict[Key, list[Path]]:
    """Return the vertical records by each key that a horizontal record of the same station has."""
    found: dict[Key, list[Path]] = defaultdict(list)
    for file, motion in vertical.items():
        station = station_of_vertical(file)
        if station is not None:
            found[_by_name(file, station)].append(file)
        for key in _by_header(motion.metadata):
            found[key].append(file)
    return dict(found)


def _keys(file: Path, info: RecordInfo | None) -> Iterator[Key]:
    """Yield the keys under which the vertical record of a horizontal one may be, the surest ones first."""
    splits = [(file.stem[:end], file.stem[end:]) for end in reversed(range(len(file.stem)))]
    possible = [(station, word) for station, word in splits if _is_component(word)]
    # In G1230 the azimuth is 230, although 30 or 0 would also do.
    for station, _ in sorted(possible, key=lambda each: not (each[1][0] in APART or re.fullmatch(r"\d{3}", each[1]))):
        yield _by_name(file, station.rstrip(APART))
    yield from _by_header(info)


def _is_component(word: str) -> bool:
    """Return whether the end of a name is a horizontal component; a small x or y only if it is set apart."""
    name = word.lstrip(APART)
    return is_horizontal_name(name) or (name != word and name in ("x", "y"))


def _by_name(file: Path, station: str) -> Key:
    return str(file.parent), station.casefold()


def _by_header(info: RecordInfo | None) -> list[Key]:
    """Return the record sequence number, else event, year and station, if they are known."""
    if info is None:
        return []
    if info.rsn is not None:
        return [(info.rsn,)]
    if None in (info.event, info.year, info.station):
        return []
    return [(info.event, info.year, info.station, info.network, info.location)]
