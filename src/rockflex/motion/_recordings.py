"""Components of one recording: which belong together, and response spectra in all directions."""

import math
import re
from collections import Counter, defaultdict
from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from rockflex.engine.oscillator import rotated_peaks
from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_instance, checked_instances, real_or_nan
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import first_texts_shown, shown
from rockflex.foundation.values import Value
from rockflex.motion._ground_motion import GroundMotion, is_vertical_component, record_info_of
from rockflex.motion._record_info import (
    SEPARATORS,
    RecordInfo,
    component_azimuth,
    is_horizontal_component_name,
    station_of_vertical_file,
)
from rockflex.motion._spectra import checked_spectrum_damping, checked_spectrum_periods

Key: TypeAlias = tuple[str | int | None, ...]

MAX_SKEW_DEG = 10.0  # degrees by which components may differ from a right angle
ANGLES: Array = np.radians(np.arange(180.0))
Combination = Literal["component", "geometric mean", "rotd50", "rotd100"]
GroupKey: TypeAlias = tuple[Hashable, ...] | None


def pair_vertical_records(
    horizontal: Mapping[Path, GroundMotion], vertical: Mapping[Path, GroundMotion]
) -> tuple[dict[Path, GroundMotion], dict[Path, str], list[Path]]:
    """Give each horizontal record without a vertical component the vertical one of its station.

    Returns all horizontal records; the reasons why some remain without one, empty where there is no vertical record of
    the station; and the vertical records that were not used.
    """
    both: dict[Path, GroundMotion] = {}
    without: dict[Path, str] = {}
    used: set[Path] = set()
    index = _vertical_records_by_key(vertical)
    for file, motion in horizontal.items():
        both[file] = motion
        if motion.vertical is not None:
            continue
        found = next((index[key] for key in _vertical_record_keys(file, motion.metadata) if key in index), [])
        used.update(found)
        if len(found) == 1:
            try:
                both[file] = motion.with_vertical(vertical[found[0]])
            except InputError as error:
                without[file] = f"{found[0].name}: {error}"
        else:
            without[file] = f"{file_names_text(found)} could each belong to it" if found else ""
    return both, without, [file for file in vertical if file not in used]


def station_names(motions: Sequence[GroundMotion]) -> list[str]:
    """Return the name of the recording of each component, the same for all components of a recording."""
    stems = [_possible_station_names(motion) for motion in motions]
    counts = Counter(stem.casefold() for options in stems for stem in options)
    first: dict[str, str] = {}
    found: list[str] = []
    for motion, options in zip(motions, stems, strict=True):
        shared = next((stem for stem in options if counts[stem.casefold()] > 1), None)
        in_names = first.setdefault(shared.casefold(), shared) if shared else Path(motion.name).name
        found.append(_recording_name_in_header(motion.metadata) or in_names)
    return found


def recording_names(names: Sequence[str]) -> list[str]:
    """Return the common part of the names of the two components of each recording; the whole name of a single one.

    A recording has two horizontal components, at right angles: ABC000 and ABC090, or A-H1 and A-H2. Records that are
    merely numbered, such as GM1 and GM2, do not belong together.
    """
    files = [Path(f"{name}.x") for name in names]
    words = [{key: word for key, word in _component_names_in_file_name(file).items() if key[1]} for file in files]
    members: dict[Key, list[int]] = defaultdict(list)
    for place, each in enumerate(words):
        for key in each:
            members[key].append(place)
    found = list(names)
    for place, each in enumerate(words):
        pair = next(
            (key for key in each if _are_perpendicular_components([words[other][key] for other in members[key]])), None
        )
        if pair is not None:
            first = members[pair][0]
            found[place] = names[first][: len(names[first]) - len(files[first].stem) + len(str(pair[1]))]
    return found


def _are_perpendicular_components(components: Sequence[str]) -> bool:
    """Return whether words name the two horizontal components of a recording."""
    angles = [component_azimuth(word) for word in components]
    if len(angles) != 2 or angles == [None, None]:
        return len(angles) == 2
    one, other = angles
    return one is not None and other is not None and abs((one - other) % 180.0 - 90.0) <= MAX_SKEW_DEG


def _recording_name_in_header(info: RecordInfo | None) -> str | None:
    for key in _station_header_keys(info):
        if len(key) == 1:
            return f"RSN{key[0]}"
        event, _, station, network, location = key
        return " ".join(str(part) for part in (network, station, location, event) if part is not None)
    return None


def _possible_station_names(motion: GroundMotion) -> list[str]:
    """Return the names of the station that the name of a motion may contain, the most likely first."""
    file = Path(f"{Path(motion.name)}.x")
    upright = station_of_vertical_file(file)
    if is_vertical_component(motion):
        return [] if upright is None else [upright]
    return [file.stem[: len(str(key[1]))] for key in _vertical_record_keys(file, None) if key[1]]


def are_different_components(file: Path, info: RecordInfo | None, other: Path, known: RecordInfo | None) -> bool:
    """Return whether two files are of different recordings by their numbers, or of different components."""
    for fact in ("rsn", "azimuth"):
        if len({getattr(info, fact, None), getattr(known, fact, None)} - {None}) > 1:
            return True
    first, second = _component_names_in_file_name(file), _component_names_in_file_name(other)
    return any(first[station] != second[station] for station in first.keys() & second.keys())


def _component_names_in_file_name(file: Path) -> dict[Key, str]:
    """Return the possible names of the component in the name of a file, by the key of the station in the rest of it."""
    return {
        key: file.stem[len(str(key[1])) :].lstrip(SEPARATORS).casefold() for key in _vertical_record_keys(file, None)
    }


def file_names_text(files: Iterable[Path]) -> str:
    """Return the names of files, of the first ones if they are many."""
    return first_texts_shown([file.name for file in files])


def _vertical_records_by_key(vertical: Mapping[Path, GroundMotion]) -> dict[Key, list[Path]]:
    """Return the vertical records by each key that a horizontal record of the same station has."""
    found: dict[Key, list[Path]] = defaultdict(list)
    for file, motion in vertical.items():
        station = station_of_vertical_file(file)
        if station is not None:
            found[_station_name_key(file, station)].append(file)
        for key in _station_header_keys(motion.metadata):
            found[key].append(file)
    return dict(found)


def _vertical_record_keys(file: Path, info: RecordInfo | None) -> Iterator[Key]:
    """Yield the keys under which the vertical record of a horizontal one may be, the surest ones first."""
    splits = [(file.stem[:end], file.stem[end:]) for end in reversed(range(len(file.stem)))]
    possible = [(station, word) for station, word in splits if _is_horizontal_component(word)]
    # In G1230 the azimuth is 230, although 30 or 0 would also do.
    for station, _ in sorted(
        possible, key=lambda each: not (each[1][0] in SEPARATORS or re.fullmatch(r"\d{3}", each[1]))
    ):
        yield _station_name_key(file, station.rstrip(SEPARATORS))
    yield from _station_header_keys(info)


def _is_horizontal_component(word: str) -> bool:
    """Return whether the end of a name is a horizontal component; a small x or y only if it is set apart."""
    name = word.lstrip(SEPARATORS)
    return is_horizontal_component_name(name) or (name != word and name in ("x", "y"))


def _station_name_key(file: Path, station: str) -> Key:
    return str(file.parent), station.casefold()


def _station_header_keys(info: RecordInfo | None) -> list[Key]:
    """Return the record sequence number, else event, year and station, if they are known."""
    if info is None or (info.rsn is None and None in (info.event, info.year, info.station)):
        return []
    if info.rsn is not None:
        return [(info.rsn,)]
    return [(info.event, info.year, info.station, info.network, info.location)]


@dataclass(frozen=True, eq=False)
class StationRecord(Value):
    """The components that an instrument recorded of one earthquake.

    Parameters
    ----------
    name : str
        Name of the recording: the record sequence number as in RSN953, else the station with its network and
        earthquake, else the common part of the names of its components.
    horizontal : tuple of GroundMotion
        The horizontal components, in the order given; two for most instruments.
    vertical : GroundMotion, optional
        The vertical component.

    Examples
    --------
    >>> import rockflex as rf
    >>> station = rf.group_stations(rf.load_suite("fema-p695-far-field"))[0]
    >>> station.name, [motion.name
    ...     for motion in station.horizontal], station.vertical
    ('RSN953', ['FF-1-a', 'FF-1-b'], None)
    """

    name: str
    horizontal: tuple[GroundMotion, ...]
    vertical: GroundMotion | None = None

    @property
    def pair(self) -> tuple[GroundMotion, GroundMotion]:
        """The two horizontal components.

        Raises
        ------
        InputError
            If there are not two.
        """
        if len(self.horizontal) != 2:
            names = ", ".join(repr(motion.name) for motion in self.horizontal) or "none"
            raise InputError(
                f"A pair of horizontal components is expected, but the record {self.name} has {len(self.horizontal)}: "
                f"{names}."
            )
        return self.horizontal[0], self.horizontal[1]


def group_stations(motions: Iterable[GroundMotion]) -> tuple[StationRecord, ...]:
    """Group the components of each recording.

    Components belong together if they have the same record sequence number; else if their headers name the same
    earthquake, year, network, station and location; else if their names differ only in the component (ABC090, ABC180
    and ABC-UP).

    Parameters
    ----------
    motions : iterable of GroundMotion
        Components, such as a suite, or those of `read_components`. A vertical component that belongs to a
        horizontal one becomes the vertical component of the station.

    Returns
    -------
    tuple of StationRecord
        In the order of their first components.

    Raises
    ------
    InputError
        If an element is not a motion.

    Examples
    --------
    >>> import rockflex as rf
    >>> stations = rf.group_stations(rf.load_suite("fema-p695-far-field"))
    >>> len(stations), {len(station.horizontal) for station in stations}
    (22, {2})
    """
    members = checked_instances("motions", motions, GroundMotion)
    groups: dict[str, list[GroundMotion]] = defaultdict(list)
    for name, each in zip(station_names(members), members, strict=True):
        groups[name].append(each)
    stations: list[StationRecord] = []
    for name, group in groups.items():
        upright = [each for each in group if is_vertical_component(each)]
        upright += [each.vertical_motion for each in group if each.vertical is not None]
        along = tuple(each for each in group if not is_vertical_component(each))
        stations.append(StationRecord(name, along, upright[0] if upright else None))
    return tuple(stations)


@dataclass(frozen=True, eq=False)
class RotatedSpectrum(Value):
    """Pseudo-acceleration of two horizontal components in every direction (Boore 2010).

    In the direction φ from the first component the ground moves by a₁ cos φ + a₂ sin φ. RotDnn is the nn-th percentile,
    over directions of 0°, 1°, ... 179°, of the spectral ordinates; unlike the geometric mean of the two components it
    does not depend on how the instrument was placed.

    Parameters
    ----------
    period : ndarray, shape (m,)
        Natural periods in s.
    damping_ratio : float
        Fraction of critical damping.
    angle : ndarray, shape (180,)
        Directions φ in rad.
    sa : ndarray, shape (m, 180)
        Pseudo-acceleration in m/s² at each period and in each direction.

    References
    ----------
    Boore DM. Orientation-independent, nongeometric-mean measures of seismic intensity from two horizontal components of
    motion. *Bull Seismol Soc Am* 2010;100(4):1830–1835. https://doi.org/10.1785/0120090400

    Examples
    --------
    >>> import rockflex as rf
    >>> suite = rf.load_suite("fema-p695-far-field")
    >>> spectrum = rf.rotated_spectrum(suite["FF-1-a"], suite["FF-1-b"],
    ...     [0.5, 1.0])
    >>> spectrum.sa.shape
    (2, 180)
    >>> bool((spectrum.rotd50 < spectrum.rotd100).all())
    True
    """

    period: Array
    damping_ratio: float
    angle: Array
    sa: Array

    def rotd(self, percentile: float) -> Array:
        """Return a percentile, 0 to 100, of the ordinates over all directions, in m/s², shape (m,).

        Raises
        ------
        InputError
            If the percentile is out of range.
        """
        share = real_or_nan(percentile)
        if not 0.0 <= share <= 100.0:
            raise InputError(
                f"percentile must be a number from 0 to 100, but {shown(percentile)} was given. RotD50 is the 50th.",
                field="percentile",
            )
        return np.percentile(self.sa, share, axis=1)

    @property
    def rotd50(self) -> Array:
        """The median over all directions, in m/s², shape (m,)."""
        return np.median(self.sa, axis=1)

    @property
    def rotd100(self) -> Array:
        """The largest over all directions, in m/s², shape (m,)."""
        return np.max(self.sa, axis=1)

    @property
    def geometric_mean(self) -> Array:
        """Geometric mean of the two components as recorded, in m/s², shape (m,)."""
        return np.sqrt(self.sa[:, 0] * self.sa[:, 90])


def rotated_spectrum(
    first: GroundMotion, second: GroundMotion, periods: ArrayLike, damping_ratio: float = 0.05
) -> RotatedSpectrum:
    """Response spectrum of two horizontal components in 180 directions, for RotD50 and RotD100.

    Each of the 180 peaks is exact, as in `ResponseSpectrum`: peaks between samples are included.

    Parameters
    ----------
    first, second : GroundMotion
        Horizontal components of one recording, at right angles. They start at the same instant; zeros are appended to
        the shorter one.
    periods : array_like, shape (m,)
        Natural periods in s: zero, or at least 1e-6 s.
    damping_ratio : float
        Fraction of critical damping, 0 <= ζ < 1.

    Raises
    ------
    InputError
        If the time steps of the components differ, a period is negative or not finite, or the damping ratio is out of
        range.

    Examples
    --------
    >>> import rockflex as rf
    >>> suite = rf.load_suite("fema-p695-far-field")
    >>> spectrum = rf.rotated_spectrum(suite["FF-1-a"], suite["FF-1-b"], [1.0])
    >>> found = spectrum.rotd50, spectrum.rotd100, spectrum.geometric_mean
    >>> tuple(each.round(2) for each in found)
    (array([9.58]), array([13.06]), array([9.61]))
    """
    one, other = checked_instance("first", first, GroundMotion), checked_instance("second", second, GroundMotion)
    if abs(one.dt - other.dt) > 1e-9 * one.dt:
        raise InputError(
            f"first and second need the same time step, but {one.dt:g} s and {other.dt:g} s were given. Resample the "
            f"coarser one, for example with motion.resampled({min(one.dt, other.dt):g})."
        )
    period = checked_spectrum_periods(periods)
    zeta = checked_spectrum_damping(damping_ratio)
    size = max(one.acceleration.size, other.acceleration.size)
    a1, a2 = (np.pad(each.acceleration, (0, size - each.acceleration.size)) for each in (one, other))
    moves, sa = period > 0, np.empty((period.size, ANGLES.size))
    if not moves.all():
        sa[~moves] = [np.max(np.abs(math.cos(angle) * a1 + math.sin(angle) * a2)) for angle in ANGLES]
    omega = 2 * np.pi / period[moves]
    sa[moves] = rotated_peaks(a1, a2, one.dt, omega, zeta, ANGLES)
    with np.errstate(over="ignore"):
        sa[moves] *= omega[:, None] ** 2
    return RotatedSpectrum(period, zeta, ANGLES, sa)


@dataclass(frozen=True, eq=False)
class Recording:
    """One motion, or the two horizontal components of a recording."""

    motions: tuple[GroundMotion, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the motions."""
        return tuple(motion.name for motion in self.motions)

    @property
    def event(self) -> GroupKey:
        """Key of the earthquake; None if it is not known."""
        info = record_info_of(self.motions[0])
        return None if info.event is None else (info.event.casefold(), info.year)

    @property
    def station(self) -> GroupKey:
        """Key of the station; None if it is not known."""
        station = record_info_of(self.motions[0]).station
        return None if station is None else (station.casefold(),)

    def sa(self, periods: ArrayLike, measure: Combination, damping_ratio: float) -> Array:
        """Pseudo-acceleration in m/s², shape (m,), of the only component, or of two combined."""
        if measure in ("rotd50", "rotd100"):
            first, second = self.motions
            rotated = rotated_spectrum(first, second, periods, damping_ratio)
            return rotated.rotd50 if measure == "rotd50" else rotated.rotd100
        spectra = [motion.spectrum(periods, damping_ratio).sa for motion in self.motions]
        return np.prod(spectra, axis=0) ** (1.0 / len(spectra))


def horizontal_pairs(motions: Iterable[GroundMotion]) -> tuple[list[Recording], list[str]]:
    """Join motions that are the two horizontal components of a recording, as `group_stations` finds them.

    Also returns the names of the motions that are not one of exactly two with the same time step.
    """
    pairs: list[Recording] = []
    single: list[str] = []
    for group in (station.horizontal for station in group_stations(motions)):
        if len(group) == 2 and abs(group[0].dt - group[1].dt) <= 1e-9 * group[0].dt:
            pairs.append(Recording(group))
        else:
            single += [motion.name for motion in group]
    return pairs, single
