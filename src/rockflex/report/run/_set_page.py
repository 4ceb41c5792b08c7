"""The report of a set of records: peaks by record, statistics, values for design, and checks against limits."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from rockflex.foundation.checks import checked_instance
from rockflex.foundation.language import translated
from rockflex.foundation.shown import shortened
from rockflex.foundation.units import UnitSystem
from rockflex.motion._suite import Selection
from rockflex.report.run import _report_tables
from rockflex.report.run._report_tables import (
    DAGGER,
    STATUS,
    ReportCell,
    ReportTable,
    title_of_several_text,
    value_cell,
)
from rockflex.report.run._reported_runs import checked_reported_runs
from rockflex.report.run._run_checks import limit_check_table, missing_checks_text
from rockflex.report.run._sheet import MAX_LETTERS, Block, Drawing, Figures, ReportPage, ReportTexts
from rockflex.response._limit_checks import CheckLimits, check
from rockflex.response._outputs import DEMANDS_BY_RECORD, OUTPUTS, legend
from rockflex.response._record_set import RecordSet
from rockflex.structure._rocking import RockingProperties
from rockflex.structure._structure import structure_warnings

TARGET_SIZE = (7.2, 3.6)  # in
STATISTIC_HEADS = {"mean": "mean", "worst": "worst", "median": "median", "fractile_84": "84 %", "design": "for design"}


@dataclass(frozen=True, eq=False, kw_only=True)
class SetPage(ReportPage):
    """The page of a set of records, on as many sheets as it takes."""

    template: ClassVar[str] = "set.html.jinja"

    kind: str
    facts: Sequence[_report_tables.ReportFact]
    modes: ReportTable | None
    lines: Sequence[tuple[str, str]]
    model: str
    records: ReportTable
    fell: str
    statistics: ReportTable
    reasons: Sequence[str]
    limits: ReportTable
    missing: str
    with_target: bool

    @property
    def drawn(self) -> list[Drawing]:
        """The places of the figures."""
        return [*([Drawing("target")] if self.with_target else []), Drawing("peaks")]

    @property
    def sections(self) -> list[tuple[str, Sequence[Block]]]:
        """The contents with their headings, one below the other as in a document."""
        ground = [(translated("Base and ground"), [self.lines])] if self.lines else []
        return [
            (translated("Structure: {kind}", kind=self.kind), [self.facts, self.modes]),
            *ground,
            (translated("Records: {model}", model=self.model), [self.records, self.fell or None, *self.drawn]),
            (translated("Values for design"), [self.statistics, *self.reasons]),
            (translated("Checks"), [self.limits, self.missing]),
        ]


def set_page(
    found: RecordSet,
    texts: ReportTexts,
    units: UnitSystem,
    *,
    structure: Any = None,
    limits: CheckLimits | None = None,
    selection: Selection | None = None,
) -> tuple[SetPage, Figures]:
    """Return the page of a set of records, and its figures; with `selection` that of the target, too."""
    from rockflex.plot._record_set import plot_set

    first = checked_reported_runs(found.responses[0], structure, None, units)
    known = found.properties if structure is None else structure
    kind, n = _report_tables.structure_kind_text(known), len(found.responses)
    records = translated("{n} record" if n == 1 else "{n} records", n=n)
    checks, elements = check(found, limits), _report_tables.elements_text(found.properties, units)
    page = SetPage(
        title=shortened(texts.title or title_of_several_text(kind, n), MAX_LETTERS["title"]),
        texts=texts,
        kind=kind,
        facts=_report_tables.structure_facts(found.properties, units),
        modes=_report_tables.mode_table(found.properties, units),
        lines=[*_report_tables.assumption_lines(first), *([(translated("Elements"), elements)] if elements else [])],
        model=f"{found.responses[0].model}, {records}",
        records=_record_table(found, units),
        fell=translated("† The values of a record that overturns include its fall.") if found.n_overturned else "",
        statistics=_statistics_table(found, units),
        reasons=[
            *legend(map(str, found.statistics.index), of_few=True),
            *(translated("For design: {reason}.", reason=each) for each in dict.fromkeys(found.statistics["reason"])),
        ],
        limits=limit_check_table(
            [translated("demand" if found.rule is None else "demand for design")], [checks], units
        ),
        missing=missing_checks_text(checks),
        with_target=selection is not None,
        warnings=[*structure_warnings(known), *found.warnings],
    )
    figures: dict[str, tuple[str, Any]] = {
        "peaks": (translated("Peaks of each record, and their statistics"), plot_set(found))
    }
    if selection is not None:
        figures["target"] = _target_figure(checked_instance("selection", selection, Selection), found.properties)
    return page, figures


def _target_figure(selection: Selection, p: RockingProperties) -> tuple[str, Any]:
    """Return the spectra of the records with their target and the first period, and what they show."""
    from rockflex.plot._motion import plot_selection

    first = 2.0 * math.pi / float(p.omega[0]) if p.n_modes else None
    said = translated("Spectra of the records as chosen for their target")
    return said, plot_selection(selection, period=first, size=TARGET_SIZE)


def _record_table(found: RecordSet, units: UnitSystem) -> ReportTable:
    shown = {name: OUTPUTS[name].unit_in(units) for name in DEMANDS_BY_RECORD if name in found.statistics.index}
    pga = units.of("acceleration", "m/s²")
    heads = [(translated("record"), ""), ("", ""), ("PGA", pga.name), (translated("factor"), "")]
    heads += [(translated(OUTPUTS[name].symbol), unit.name) for name, unit in shown.items()]
    rows: list[list[ReportCell]] = []
    for motion, (_, row) in zip(found.motions, found.peaks.iterrows(), strict=True):
        fell = row["status"] == "overturned"
        scale = None if motion.metadata is None else motion.metadata.scale
        rows.append(
            [
                ReportCell(motion.name),
                ReportCell(translated(STATUS[row["status"]]) + (f" {DAGGER}" if fell else ""), None, "status", fell),
                value_cell(motion.pga, "pga", pga.size),
                value_cell(scale, "scale"),
                *(value_cell(float(row[name]), name, unit.size) for name, unit in shown.items()),
            ]
        )
    return ReportTable(heads, rows)


def _statistics_table(found: RecordSet, units: UnitSystem) -> ReportTable:
    heads = [(translated("demand"), ""), (translated("unit"), "")]
    heads += [(translated(words), "") for words in STATISTIC_HEADS.values()]
    rows = [
        [
            ReportCell(translated(OUTPUTS[str(name)].symbol)),
            ReportCell(unit),
            *(value_cell(float(row[each]), each, size) for each in STATISTIC_HEADS),
        ]
        for name, row in found.statistics.iterrows()
        for size, unit in (OUTPUTS[str(name)].unit_in(units),)
    ]
    return ReportTable(heads, rows)
