"""What a notebook shows of a ground motion."""

from collections.abc import Mapping
from typing import Any

from rockflex._arrays import Array
from rockflex._html import HtmlTable
from rockflex.motion._record_info import RecordInfo

KNOWN = ("event", "year", "magnitude", "distance_km", "vs30", "station", "component", "source", "scale")


class ShownMotion(HtmlTable):
    """A motion as a table of its name, its sampling, its peaks, and what is known of the record."""

    name: str
    acceleration: Array
    dt: float
    metadata: RecordInfo | None
    vertical: Array | None

    def _shown_as(self) -> Mapping[str, Any]:
        shaking: Any = self
        return {
            "name": self.name or None,
            "samples": f"{self.acceleration.size}, every {self.dt:g} s",
            "duration": f"{shaking.duration:g} s",
            "pga": f"{shaking.pga:.4g} m/s²",
            "pgv": f"{shaking.pgv:.4g} m/s",
            "pgd": f"{shaking.pgd:.4g} m",
            "pva": None if self.vertical is None else f"{shaking.pva:.4g} m/s²",
            **{fact: getattr(self.metadata, fact, None) for fact in KNOWN},
        }
