"""The intensity measures that the page offers."""

from typing import Annotated, Any

from pydantic import AfterValidator
from pydantic_core import PydanticCustomError

from rockflex.motion import Measure, intensities

FIRST = ("pgv", "pga", "pgd", "sa_t1", "sd_t1")  # in the list; the others follow in their own order


def _known(name: str) -> str:
    if name not in (measure.name for measure in intensities()):
        raise PydanticCustomError("unknown_measure", "unknown measure")
    return name


def _same_for_all(name: str) -> str:
    if any(measure.name == name and measure.of_what == "base" for measure in intensities()):
        raise PydanticCustomError("measure_of_base", "measure of a base")
    return name


MeasureName = Annotated[str, AfterValidator(_known)]
SameForAll = Annotated[MeasureName, AfterValidator(_same_for_all)]
"""A measure that does not depend on the base, so that one level means the same motion for every width."""


def measures() -> list[dict[str, Any]]:
    """Return the labels of each measure, and whether a search for a width can use it."""
    return [
        {
            "name": measure.name,
            "title": measure.title,
            "unit": measure.unit,
            "axis": measure.with_unit(measure.label),
            "of_base": measure.of_what == "base",
        }
        for measure in sorted(intensities(), key=_place)
    ]


def _place(measure: Measure) -> int:
    return FIRST.index(measure.name) if measure.name in FIRST else len(FIRST)
