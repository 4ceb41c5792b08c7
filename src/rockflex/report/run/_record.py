"""The record on the page, as it acted on the structure."""

from dataclasses import dataclass

import numpy as np

from rockflex._arrays import Array
from rockflex._constants import GRAVITY
from rockflex.motion import GroundMotion
from rockflex.report.run._given import Given
from rockflex.report.run._table import Cell, Fact, fact


@dataclass(frozen=True, eq=False)
class Record:
    """The ground acceleration of the runs.

    Attributes
    ----------
    name, source : str
        Name of the record, and what is known of its origin, in a line; empty if nothing is.
    time, acceleration, vertical : ndarray, shape (n,)
        In s and m/s², scaled; the vertical acceleration is zero if there is none.
    facts : list of Fact
        Its measures.
    """

    name: str
    source: str
    time: Array
    acceleration: Array
    vertical: Array
    facts: list[Fact]


def record_of(about: Given) -> Record:
    """Return the record of the runs: from the motion if it is known, otherwise from the longest history."""
    name = about.responses[0].motion
    longest = max(range(len(about.histories)), key=lambda place: float(about.histories[place].time[-1]))
    history, run = about.histories[longest], about.responses[longest]
    ends = fact("Length of the run", float(history.time[-1]), "s", "end_time")
    pva = float(np.max(np.abs(history.vertical_ground_acceleration), initial=0.0))
    vertical = [fact("PVA, vertical", pva, "g", "pva", GRAVITY)] if pva > 0.0 else []
    if about.motion is None:
        time, acceleration = history.time, history.ground_acceleration
        steps = 0.5 * (acceleration[1:] + acceleration[:-1]) * np.diff(time)
        pgv = float(np.max(np.abs(np.cumsum(steps)), initial=0.0))
        pga = float(np.max(np.abs(acceleration)))
        # All runs overturned, and nothing is known of the ground after the last of them did.
        cut = " during the run" if run.status == "overturned" else ""
        facts = [fact(f"PGA{cut}", pga, "g", "pga", GRAVITY), fact(f"PGV{cut}", pgv, "m/s", "pgv"), *vertical, ends]
        return Record(name, "", time, acceleration, history.vertical_ground_acceleration, facts)
    motion = about.motion.scaled(about.scale)
    scale = about.scale if motion.metadata is None or motion.metadata.scale is None else motion.metadata.scale
    facts = [
        Fact("Scale", Cell(f"{scale:.6g}", scale, "scale")),
        fact("PGA", motion.pga, "g", "pga", GRAVITY),
        fact("PGV", motion.pgv, "m/s", "pgv"),
        *vertical,
        fact("Length of the record", motion.duration, "s", "duration"),
        fact("Significant duration D_5–95", motion.d5_95, "s", "d5_95"),
        ends,
    ]
    upwards = np.zeros_like(motion.time) if motion.vertical is None else motion.vertical
    return Record(name, _source(motion), motion.time, motion.acceleration, upwards, facts)


def _source(motion: GroundMotion) -> str:
    """Return event, station and vertical component in a line."""
    info = motion.metadata
    if info is None:
        return ""
    event = " ".join(str(each) for each in (info.event, info.year) if each is not None)
    size = "" if info.magnitude is None else f"M {info.magnitude:g}"
    vertical = "" if motion.vertical is None or not info.vertical_source else f"vertical: {info.vertical_source}"
    return ", ".join(each for each in (event, size, info.station or "", info.component or "", vertical) if each)
