"""Information about a record besides its samples."""

from dataclasses import dataclass, fields, replace
from typing import Literal


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
        What was done to the samples when they were read, such as "mean subtracted".
    event_id : str, optional
        Identifier of the earthquake in the catalogue of the source, such as "EMSC-20161030_0000029".
    scale : float, optional
        Factor by which the samples of the source were multiplied, as by `GroundMotion.scaled`; None if they were not.

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

    @property
    def is_vertical(self) -> bool:
        """Whether the component is known to be vertical."""
        return self.direction in ("vertical", "down")

    def completed(self, other: "RecordInfo") -> "RecordInfo":
        """Return this information, with what is unknown taken from another source.

        Examples
        --------
        >>> import rockflex as rf
        >>> header = rf.RecordInfo(rsn=953, station="Beverly Hills")
        >>> header.completed(rf.RecordInfo(rsn=953, magnitude=6.69)).magnitude
        6.69
        """
        names = [field.name for field in fields(self)]
        found = {name: getattr(other, name) for name in names if getattr(self, name) is None}
        return replace(self, **found)
