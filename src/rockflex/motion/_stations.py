"""The components of a recording together: horizontal ones and the vertical one."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from rockflex._errors import InputError
from rockflex._values import Value
from rockflex.motion._direction import is_vertical
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._pairs import station_names


@dataclass(frozen=True, eq=False)
class StationRecord(Value):
    """The components that an instrument recorded of one earthquake.

    Parameters
    ----------
    name : str
        Name of the recording: the record sequence number as in RSN953, else the station with its network and
        earthquake, else what the names of its components share.
    horizontal : tuple of GroundMotion
        The horizontal components, in the order given; two for most instruments.
    vertical : GroundMotion, optional
        The vertical component.

    Examples
    --------
    >>> import rockflex as rf
    >>> station = rf.group_stations(rf.load_suite("fema-p695-far-field"))[0]
    >>> station.name, [motion.name for motion in station.horizontal], station.vertical
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
        Components, such as a suite, or those of `read_components`. A vertical component that a horizontal one brings is
        that of the station.

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
    if not isinstance(motions, Iterable):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(f"motions must be a sequence of GroundMotion objects, but {type(motions).__name__} was given.")
    members = list(motions)
    for each in members:
        if not isinstance(each, GroundMotion):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise InputError(f"motions must hold GroundMotion objects, but {type(each).__name__} was given.")
    groups: dict[str, list[GroundMotion]] = {}
    for name, each in zip(station_names([(Path(each.name), each) for each in members]), members, strict=True):
        groups.setdefault(name, []).append(each)
    return tuple(_station(name, group) for name, group in groups.items())


def _station(name: str, group: list[GroundMotion]) -> StationRecord:
    upright = [each for each in group if is_vertical(each)]
    upright += [each.vertical_motion for each in group if each.vertical is not None]
    along = tuple(each for each in group if not is_vertical(each))
    return StationRecord(name, along, upright[0] if upright else None)
