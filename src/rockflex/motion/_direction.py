"""Whether a record is of a horizontal or of a vertical component, by its header and its file's name."""

import re
from pathlib import Path
from typing import Literal

from rockflex._errors import InputError
from rockflex.motion._ground_motion import GroundMotion

Direction = Literal["horizontal", "vertical"]

CHANNEL = "[A-Z][HLNG]"  # band and instrument of a seismological channel, whose third letter is the direction
UPWARDS = f"UP|DN|UD|DWN|DOWN|VER|VRT|VERT|VERTICAL|{CHANNEL}Z"
COMPASS = "[NSEW]|NS|EW|NORTH|SOUTH|EAST|WEST|SOU|EAS"
VERTICAL = re.compile(rf"{UPWARDS}|U|V|Z|V[12]", re.IGNORECASE)
HORIZONTAL = re.compile(
    rf"[NS]?\s*\d+(?:\.\d+)?\s*[EW]?|{COMPASS}|[LTH][12]?|LONG?|TRAN?S?|{CHANNEL}[NE12]", re.IGNORECASE
)
SET_APART = re.compile(rf".*(?:[-_. ](?:{UPWARDS})|[-_.][VZ])", re.IGNORECASE)
RUN_TOGETHER = re.compile(rf".*(?:{UPWARDS}|\dV|-V[12])", re.IGNORECASE)


def direction_of(file: Path, component: str | None = None) -> Direction | None:
    """Tell the direction of a component, or None where nothing says it.

    Vertical is what a header calls UP, DWN, V, UD and the like, or what a file's name ends in after a hyphen or an
    underscore. PEER files also run station and component together, as TCU078V.AT2; that is believed unless the header
    names a horizontal component, an azimuth for instance.

    Parameters
    ----------
    file
        The file, of which only the name counts.
    component
        Component as the header names it.
    """
    stated = (component or "").strip()
    if VERTICAL.fullmatch(stated) or SET_APART.fullmatch(file.stem):
        return "vertical"
    if HORIZONTAL.fullmatch(stated):
        return "horizontal"
    from_peer = file.suffix.lower() == ".at2" or re.match(r"RSN\d", file.name, re.IGNORECASE)
    return "vertical" if from_peer and RUN_TOGETHER.fullmatch(file.stem) else None


def is_vertical(motion: GroundMotion) -> bool:
    """Tell whether a motion is known to be of a vertical component."""
    return motion.metadata is not None and motion.metadata.direction == "vertical"


def check_horizontal(*motions: GroundMotion) -> None:
    """Raise an InputError where a vertical component would shake a structure sideways."""
    vertical = [motion.name for motion in motions if is_vertical(motion)]
    if vertical:
        more = f" and {len(vertical) - 3} more" if len(vertical) > 3 else ""
        raise InputError(
            f"The ground moves horizontally here, but {', '.join(map(repr, vertical[:3]))}{more} "
            f"{'is a vertical component' if len(vertical) == 1 else 'are vertical components'} by the file's header "
            "or name. Give a horizontal component. If it is one, say so: dataclasses.replace(motion, "
            'metadata=RecordInfo(direction="horizontal")), or rename the file.'
        )
