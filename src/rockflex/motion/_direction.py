"""Whether a record is a horizontal or a vertical component, according to its header and file name."""

import re
from pathlib import Path
from typing import Literal

from rockflex._errors import InputError
from rockflex.motion._ground_motion import GroundMotion

Direction = Literal["horizontal", "vertical", "down"]

CHANNEL = "[A-Z][HLNG]"  # band and instrument codes of a seismological channel; the third letter is the direction
APART = "-_. "  # between the station and the component in the name of a file
DOWN = "DN|DWN|DOWN"  # positive downwards
UPRIGHT = f"UP|UD|U-D|VER|VRT|VERT|VERTICAL|{CHANNEL}Z|{DOWN}"
COMPASS = "[NSEW]|NS|EW|N-S|E-W|NORTH|SOUTH|EAST|WEST|SOU|EAS"
# Directions in which a component is positive, in degrees from north.
AZIMUTHS = {
    **dict.fromkeys(("N", "NS", "N-S", "NORTH"), 0.0),
    **dict.fromkeys(("E", "EW", "E-W", "EAST"), 90.0),
    **dict.fromkeys(("S", "SOUTH"), 180.0),
    **dict.fromkeys(("W", "WEST"), 270.0),
}
BEARING = re.compile(r"([NS])\s*(\d{1,2}(?:\.\d+)?)\s*([EW])", re.IGNORECASE)
VERTICAL = re.compile(rf"{UPRIGHT}|U|V|Z|V[12]", re.IGNORECASE)
HORIZONTAL = re.compile(
    rf"[NS]?\s*\d+(?:\.\d+)?\s*[EW]?|{COMPASS}|[LTH][12]?|LONG?|TRAN?S?|{CHANNEL}[NE12]", re.IGNORECASE
)
SET_APART = re.compile(rf"(.*)(?:[-_. ](?:{UPRIGHT})|[-_.][VZ])", re.IGNORECASE)
DOWNWARDS = re.compile(rf".*(?:{DOWN})", re.IGNORECASE)
COPY = re.compile(r"(?: \(\d+\)| - copy)+$", re.IGNORECASE)  # what browsers and desktops add to a name
RUN_TOGETHER = re.compile(rf"(.*?)(?:{UPRIGHT}|(?<=\d)V|-V[12])", re.IGNORECASE)


def direction_of(file: Path, component: str | None = None) -> Direction | None:
    """Return the direction of a component, or None if it is not stated; "down" is vertical, but positive downwards.

    A component is vertical if the header calls it UP, DWN, V, UD and the like, or if the file name ends in such a word
    after a hyphen or an underscore. PEER files may also join station and component, as in TCU078V.AT2; this is accepted
    unless the header names a horizontal component, for example an azimuth.

    Parameters
    ----------
    file
        The file; only its name is used.
    component
        Name of the component in the header.
    """
    stated = (component or "").strip()
    if VERTICAL.fullmatch(stated):
        return _upright(stated)
    stem = COPY.sub("", file.stem)
    if SET_APART.fullmatch(stem):
        return _upright(stem)
    if HORIZONTAL.fullmatch(stated):
        return "horizontal"
    from_peer = file.suffix.lower() == ".at2" or re.match(r"RSN\d", file.name, re.IGNORECASE)
    return _upright(stem) if from_peer and RUN_TOGETHER.fullmatch(stem) else None


def azimuth_of(component: str | None) -> float | None:
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


def _upright(text: str) -> Direction:
    return "down" if DOWNWARDS.fullmatch(text) else "vertical"


def station_of_vertical(file: Path) -> str | None:
    """Return the name of a file without the word that makes it vertical, or None if there is no such word."""
    stem = COPY.sub("", file.stem)
    named = SET_APART.fullmatch(stem) or RUN_TOGETHER.fullmatch(stem)
    return named and named[1].rstrip(APART)


def is_horizontal_name(component: str) -> bool:
    """Return whether a word, such as 090, NS or H1, names a horizontal component."""
    return bool(HORIZONTAL.fullmatch(component)) or component in ("X", "Y")


def is_vertical(motion: GroundMotion) -> bool:
    """Return whether a motion is known to be a vertical component."""
    return motion.metadata is not None and motion.metadata.is_vertical


def check_horizontal(*motions: GroundMotion) -> None:
    """Raise an InputError if a vertical component would be applied horizontally."""
    vertical = [motion.name for motion in motions if is_vertical(motion)]
    if vertical:
        more = f" and {len(vertical) - 3} more" if len(vertical) > 3 else ""
        raise InputError(
            f"A horizontal ground motion is expected, but {', '.join(map(repr, vertical[:3]))}{more} "
            f"{'is a vertical component' if len(vertical) == 1 else 'are vertical components'} according to the header "
            "or name of the file. Give a horizontal component. If it is one, declare it: dataclasses.replace(motion, "
            'metadata=RecordInfo(direction="horizontal")), or rename the file.'
        )


def told_apart(names: list[str]) -> list[str]:
    """Return names that differ, those that occur twice with their place among the equal ones."""
    return [name if names.count(name) == 1 else f"{name}-{names[: i + 1].count(name)}" for i, name in enumerate(names)]
