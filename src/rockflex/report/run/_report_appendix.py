"""The appendix of a report, if asked for: cross-sections with their material, and loops of elements."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from rockflex.foundation.language import translated
from rockflex.foundation.units import UnitSystem
from rockflex.report.run._report_tables import ReportCell, ReportTable, value_cell
from rockflex.report.run._reported_runs import ReportedRuns
from rockflex.response._response import Response
from rockflex.structure._cross_section import Section
from rockflex.structure._towers import TaperedTower


@dataclass(frozen=True, eq=False)
class ReportAppendix:
    """The table of cross-sections, None if none is known, and the runs whose elements have loops, by their labels."""

    sections: ReportTable | None
    loops: Sequence[tuple[str, Response]]

    def __bool__(self) -> bool:
        return self.sections is not None or bool(self.loops)


def report_appendix(report: ReportedRuns) -> ReportAppendix:
    """Return the appendix of a report; empty where there is nothing to show."""
    runs = zip(report.labels, report.responses, report.histories, strict=True)
    loops = [(label, run) for label, run, history in runs if history.model.lifts and history.model.properties.elements]
    return ReportAppendix(_section_table(report.structure, report.units), loops)


def _sections_of(structure: Any) -> list[tuple[str, Section]]:
    """Return the cross-sections of a structure, each with its place."""
    while hasattr(structure, "structure"):  # what stands on an eccentric base, is restrained, ...
        structure = structure.structure
    if isinstance(structure, TaperedTower):
        material = {"elastic_modulus": structure.elastic_modulus, "density": structure.density}
        radii = {translated("base"): structure.base_radius, translated("top"): structure.top_radius}
        return [(place, Section.tube(2.0 * r, structure.wall, **material)) for place, r in radii.items()]
    section = getattr(structure, "section", None)
    return [] if section is None else [(translated("whole height"), section)]


def _section_table(structure: Any, units: UnitSystem) -> ReportTable | None:
    found = _sections_of(structure)
    columns = {
        "area": ("A", units.of("area")),
        "second_moment": ("I", units.of("second moment of area")),
        "elastic_modulus": ("E", units.of("elastic modulus")),
        "density": ("ρ", units.of("density")),
        "stiffness_factor": (translated("factor on EI"), units.of("ratio")),
        "bending_stiffness": (translated("EI effective"), units.of("bending stiffness")),
        "mass_per_length": ("m", units.of("mass per length")),
    }
    rows = [
        [
            ReportCell(place),
            *(value_cell(float(getattr(each, of)), of, unit.size, 4) for of, (_, unit) in columns.items()),
        ]
        for place, each in found
    ]
    heads = [(translated("section"), ""), *((name, unit.name) for name, unit in columns.values())]
    return ReportTable(heads, rows) if rows else None
