"""Information about a record besides its samples, and directions of components by their names."""

import re
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Literal

from rockflex.motion._findings import Evidence, Finding, settled

Direction = Literal["horizontal", "vertical", "down"]
CHANNEL = "[A-Z][HLNG]"  # band and instrument codes of a seismological channel; the third letter is the direction
SEPARATORS = "-_. "  # between the station and the component in the name of a file
DOWN_NAMES = "DN|DWN|DOWN"  # positive downwards
UP_NAMES = f"UP|UPX|UD[12]?|U-D|VER|VRT|VERT|VERTICAL|{CHANNEL}Z|{DOWN_NAMES}"  # UPX in names of ITACA's files
COMPASS = "[NSEW]|NS[X12]?|EW[12]?|WEX?|N-S|E-W|NORTH|SOUTH|EAST|WEST|SOU|EAS"
# Directions in which a component is positive, in degrees from north.
AZIMUTHS = {
    **dict.fromkeys(("N", "NS", "N-S", "NORTH"), 0.0),
    **dict.fromkeys(("E", "EW", "E-W", "WE", "EAST"), 90.0),
    **dict.fromkeys(("S", "SOUTH"), 180.0),
    **dict.fromkeys(("W", "WEST"), 270.0),
}
BEARING = re.compile(r"([NS])\s*(\d{1,2}(?:\.\d+)?)\s*([EW])", re.IGNORECASE)
VERTICAL_NAME = re.compile(rf"{UP_NAMES}|U|V|Z|V[12]", re.IGNORECASE)
HORIZONTAL_NAME = re.compile(
    rf"[NS]?\s*\d+(?:\.\d+)?\s*[EW]?|{COMPASS}|[LTH][12]?|LONG?|TRAN?S?|LONGITUDINAL|TRANSVERSE|RADL|TANG|{CHANNEL}[NE12]",
    re.IGNORECASE,
)
SEPARATED_SUFFIX = re.compile(rf"(.*)(?:[-_. ](?:{UP_NAMES})|[-_.][UVZ])", re.IGNORECASE)
CODE_IN_NAME = re.compile(r"[BCEHLS][HLN][ENZ12]")  # of a channel, between dots or underscores
HORIZONTAL_SUFFIX = re.compile(r".*[-_.](?:[NE]|NS[X12]?|EW[12]?|WEX?)", re.IGNORECASE)
DOWN_SUFFIX = re.compile(rf".*(?:{DOWN_NAMES})", re.IGNORECASE)
KNET_SUFFIX = re.compile(r"\.(?:NS|EW|UD)[12]?", re.IGNORECASE)
COPY_SUFFIX = re.compile(r"(?: \(\d+\)| - copy)+$", re.IGNORECASE)  # added to a name by browsers and desktops
JOINED_SUFFIX = re.compile(rf"(.*?)(?:{UP_NAMES}|(?<=\d)V|-V[12])", re.IGNORECASE)


@dataclass(frozen=True, kw_only=True)
class RecordInfo:
    """Information about a recorded motion; None if unknown.

    Parameters
    ----------
    event : str, optional
        Name of the earthquake; the time of origin if the source gives no name.
    year : int, optional
        Year of the earthquake.
    magnitude : float, optional
        Moment magnitude, unless `magnitude_type` is another one.
    distance_km : float, optional
        Closest distance from the site to the fault plane, R_rup, in km.
    vs30 : float, optional
        Time-averaged shear-wave velocity of the upper 30 m, in m/s.
    rsn : int, optional
        Record sequence number of the PEER NGA database.
    component : str, optional
        Name of the component in its source.
    direction : {"horizontal", "vertical", "down"}, optional
        Direction of the component, if its source states it: "vertical" is positive upwards, "down" is vertical and
        positive downwards. Vertical components cannot be used as horizontal motions, nor horizontal ones as vertical.
    station : str, optional
        Recording station.
    source : str, optional
        File or publication from which the samples were taken.
    vertical_source : str, optional
        Record from which the vertical component was taken.
    magnitude_type : str, optional
        Scale of the magnitude, such as "Mw", "ML" or "MJMA".
    distance_jb_km : float, optional
        Closest distance from the site to the vertical projection of the fault plane, R_JB, in km.
    epicentral_km : float, optional
        Distance from the site to the epicentre, in km.
    network : str, optional
        Code of the network that operates the station.
    location : str, optional
        Place of the instrument at its station: "surface" and "borehole" for KiK-net, else the location code.
    azimuth : float, optional
        Direction in which a horizontal component is positive, in degrees clockwise from north.
    start_time : str, optional
        Time of the first sample as in ISO 8601, with the offset from UTC if the source states it.
    source_format : str, optional
        Format of the file, such as "K-NET".
    stated_pga : float, optional
        Peak ground acceleration that the header of the file states, in m/s².
    processing : str, optional
        Change made to the samples when they were read, such as "mean subtracted".
    event_id : str, optional
        Identifier of the earthquake in the catalogue of the source, such as "EMSC-20161030_0000029".
    scale : float, optional
        Factor by which the samples of the source were multiplied, as by `GroundMotion.scaled`; None if they were not.
    findings : tuple of Finding
        What the reader found about quantity, unit, time step and component, and where; empty if nothing was read. It
        is not compared, nor written to files.

    Examples
    --------
    >>> import rockflex as rf
    >>> info = rf.RecordInfo(event="Imperial Valley", year=1940,
    ...     station="El Centro")
    >>> motion = rf.GroundMotion([0.0, 1.0, -1.0, 0.0], dt=0.02, metadata=info)
    >>> motion.metadata.year
    1940
    """

    event: str | None = None
    year: int | None = None
    magnitude: float | None = None
    distance_km: float | None = None
    vs30: float | None = None
    rsn: int | None = None
    component: str | None = None
    direction: Literal["horizontal", "vertical", "down"] | None = None
    station: str | None = None
    source: str | None = None
    vertical_source: str | None = None
    magnitude_type: str | None = None
    distance_jb_km: float | None = None
    epicentral_km: float | None = None
    network: str | None = None
    location: str | None = None
    azimuth: float | None = None
    start_time: str | None = None
    source_format: str | None = None
    stated_pga: float | None = None
    processing: str | None = None
    event_id: str | None = None
    scale: float | None = None
    findings: tuple[Finding, ...] = field(default=(), compare=False)

    @property
    def is_vertical(self) -> bool:
        """Whether the component is known to be vertical."""
        return self.direction in ("vertical", "down")

    def completed(self, other: "RecordInfo") -> "RecordInfo":
        """Return this information, with unknown fields taken from another source.

        Examples
        --------
        >>> import rockflex as rf
        >>> header = rf.RecordInfo(rsn=953, station="Beverly Hills")
        >>> header.completed(rf.RecordInfo(rsn=953, magnitude=6.69)).magnitude
        6.69
        """
        found = {each.name: getattr(other, each.name) for each in fields(self) if getattr(self, each.name) is None}
        return replace(self, **found)


@dataclass(frozen=True)
class FoundComponent:
    """A component by its name in the source, if it has one; its direction and azimuth, and what says so."""

    name: str | None = None
    direction: Direction | None = None
    azimuth: float | None = None
    findings: tuple[Finding, ...] = ()


def found_component(file: Path, *stated: Evidence[str], several: bool = False) -> FoundComponent:
    """Return what is said of a component in its header, the first word being its name, and by the name of its file.

    A component is vertical if the header calls it UP, DWN, V, UD, HNZ and the like, or if the name of the file has such
    a word after a hyphen, a dot or an underscore; the name of a file of `several` components says nothing. PEER files
    may also join station and component, as in TCU078V.AT2; this is accepted unless the header says something else.

    Raises
    ------
    InputError
        If one says that it is vertical, and another that it is horizontal.
    """
    words = [each for each in stated if each.value.strip()]
    ways: list[Evidence[Direction]] = []
    for each in words:
        if (stated_way := _direction_of_word(each.value)) is not None:
            ways.append(Evidence(stated_way, each.said))
    by_name = None if several else _direction_in_name(file) or (None if ways else _joined_direction(file))
    if by_name is not None:
        ways.append(Evidence(by_name, f'name of the file "{file.name}"'))
    way = settled(
        file,
        "component",
        ways,
        None,
        "Correct the header or the name of the file, whichever is wrong.",
        lambda one, other: (one == "horizontal") == (other == "horizontal"),
    )
    way = next((each for each in ways if each.value == "down"), way)
    direction: Direction | None = None if way is None else way.value
    name = words[0].value.strip() if words else None
    azimuths = (component_azimuth(each.value) for each in words)
    azimuth = next((each for each in azimuths if each is not None), None)
    shown = ", ".join(filter(None, (name, direction)))
    said = way.said if way else words[0].said if words else ""
    findings = (Finding("component", shown, said),) if shown else ()
    return FoundComponent(name, direction, azimuth, findings)


def component_direction(file: Path, component: str | None = None) -> Direction | None:
    """Return the direction of a component, or None if it is not stated; "down" is vertical, but positive downwards.

    `component` is its name in a header. It is told as in `found_component`.
    """
    return found_component(
        file, *([] if component is None else [Evidence(component, f'header "{component}"')])
    ).direction


def _direction_of_word(word: str) -> Direction | None:
    text = word.strip()
    if VERTICAL_NAME.fullmatch(text):
        return _vertical_direction(text)
    number = text.isdecimal()  # which may be a code instead of an azimuth
    return (
        "horizontal" if HORIZONTAL_NAME.fullmatch(text) and not (number and component_azimuth(text) is None) else None
    )


def stem_with_component(file: Path) -> str:
    """Return the name of a file without its suffix, unless that is the component, as in K-NET's files."""
    return file.stem + file.suffix.replace(".", "-") if KNET_SUFFIX.fullmatch(file.suffix) else file.stem


def _direction_in_name(file: Path) -> Direction | None:
    stem = COPY_SUFFIX.sub("", stem_with_component(file))
    if SEPARATED_SUFFIX.fullmatch(stem):
        return _vertical_direction(stem)
    codes = [word for word in re.split("[-_. ]", stem)[1:] if CODE_IN_NAME.fullmatch(word)]
    if codes:
        return "vertical" if codes[-1].endswith("Z") else "horizontal"
    return "horizontal" if HORIZONTAL_SUFFIX.fullmatch(stem) else None


def _joined_direction(file: Path) -> Direction | None:
    """Return the direction in the name of a file of PEER, which may join station and component."""
    stem = COPY_SUFFIX.sub("", file.stem)
    from_peer = file.suffix.lower() == ".at2" or re.match(r"RSN\d", file.name, re.IGNORECASE)
    return _vertical_direction(stem) if from_peer and JOINED_SUFFIX.fullmatch(stem) else None


def component_azimuth(component: str | None) -> float | None:
    """Return the direction, in degrees clockwise from north, that the name of a component states, or None.

    Such names are 90, N38E, NS, and the codes of seismological channels that end in N or E, such as HNE.
    """
    name = (component or "").strip().upper()
    if re.fullmatch(r"\d{1,3}(?:\.\d{1,3})?", name):
        return float(name) if float(name) <= 360.0 else None
    bearing = BEARING.fullmatch(name)
    if bearing:
        angle = float(bearing[2]) if bearing[3] == "E" else -float(bearing[2])
        return (angle if bearing[1] == "N" else 180.0 - angle) % 360.0
    return AZIMUTHS.get(name[2:] if re.fullmatch(f"{CHANNEL}[NE]", name) else name)


def _vertical_direction(text: str) -> Direction:
    return "down" if DOWN_SUFFIX.fullmatch(text) else "vertical"


def station_of_vertical_file(file: Path) -> str | None:
    """Return the name of a file without the word that makes it vertical, or None if there is no such word."""
    stem = COPY_SUFFIX.sub("", file.stem)
    named = SEPARATED_SUFFIX.fullmatch(stem) or JOINED_SUFFIX.fullmatch(stem)
    return named and named[1].rstrip(SEPARATORS)


def is_horizontal_component_name(component: str) -> bool:
    """Return whether a word, such as 090, NS or H1, names a horizontal component."""
    return bool(HORIZONTAL_NAME.fullmatch(component)) or component in ("X", "Y")


def unique_record_names(names: list[str]) -> list[str]:
    """Return the names, with a number added to those that occur more than once."""
    return [name if names.count(name) == 1 else f"{name}-{names[: i + 1].count(name)}" for i, name in enumerate(names)]


def component_record_names(stem: str, components: list[str]) -> list[str]:
    """Return the names of the motions in a file: its stem, with the component where it holds several."""
    return [stem] if len(components) == 1 else [f"{stem}-{name}" for name in unique_record_names(components)]
