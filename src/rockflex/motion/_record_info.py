"""Information about a record besides its samples."""

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True, kw_only=True)
class RecordInfo:
    """Information about a recorded motion; None if unknown.

    Parameters
    ----------
    event : str, optional
        Name of the earthquake.
    year : int, optional
        Year of the earthquake.
    magnitude : float, optional
        Moment magnitude.
    distance_km : float, optional
        Closest distance from the site to the fault plane, in km.
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

    Examples
    --------
    >>> import rockflex as rf
    >>> info = rf.RecordInfo(event="Imperial Valley", year=1940, station="El Centro")
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

    @property
    def is_vertical(self) -> bool:
        """Whether the component is known to be vertical."""
        return self.direction in ("vertical", "down")
