"""The intensity measures that the page offers."""

from typing import Annotated, Any

from rockflex.motion import Measure, intensities
from rockflex.web._names import among

FIRST = ("pgv", "pga", "pgd", "sa_t1_5", "sa_t1", "sd_t1")  # in the list; the others follow in their own order


MeasureName = Annotated[str, among(lambda: [measure.name for measure in _offered()])]
SameForAll = Annotated[str, among(lambda: [measure.name for measure in _offered() if measure.of_what != "base"])]
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
        for measure in sorted(_offered(), key=_place)
    ]


def _offered() -> list[Measure]:
    """The measures of the suites that the page has, which hold no vertical components."""
    return [measure for measure in intensities() if measure.of_what != "vertical"]


def _place(measure: Measure) -> int:
    return FIRST.index(measure.name) if measure.name in FIRST else len(FIRST)
