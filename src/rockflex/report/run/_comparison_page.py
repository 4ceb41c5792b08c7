"""The page of a comparison: the alternatives as they rock, and their demands with the differences."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import ClassVar

from rockflex.foundation.language import translated
from rockflex.foundation.shown import shortened
from rockflex.foundation.units import UnitSystem
from rockflex.report.run import _report_tables
from rockflex.report.run._report_tables import ReportCell, ReportedRecord, ReportTable, value_cell
from rockflex.report.run._reported_runs import ReportedRuns
from rockflex.report.run._run_checks import limit_check_table
from rockflex.report.run._run_page import figures_of_runs, warnings_of_runs
from rockflex.report.run._sheet import (
    MAX_LETTERS,
    ROW,
    STRIP,
    WIDTH,
    Block,
    Drawing,
    Figures,
    OneSheet,
    ReportTexts,
    first_warnings,
    line_count_of_text,
)
from rockflex.response._comparison import STATISTICS, Comparison
from rockflex.response._history import History
from rockflex.response._limit_checks import CheckTable
from rockflex.response._outputs import DEMANDS_OF_SET, OUTPUTS, legend
from rockflex.response._record_set import RecordSet
from rockflex.structure._rocking import RockingProperties

SHOWN = ("median", "p84")  # of the statistics, under several records
_OUTLINES = 48.0  # height in mm of the structures
_CELL_LETTERS = 60  # in a line of their elements


@dataclass(frozen=True, eq=False, kw_only=True)
class ComparisonPage(OneSheet):
    """The page of a comparison."""

    template: ClassVar[str] = "comparison.html.jinja"

    several: bool  # records
    records: str
    alternatives: ReportTable
    lines: Sequence[tuple[str, str]]
    demands: ReportTable
    limits: ReportTable | None
    record: ReportedRecord

    @property
    def height(self) -> float:
        """About the height in mm of all but the figure."""
        lines = sum(line_count_of_text(f"{head} {text}") for head, text in self.lines)
        rows = sum(max(math.ceil(len(cell.text) / _CELL_LETTERS) for cell in row) for row in self.alternatives.rows)
        texts = bool(self.texts.heads) + sum(map(line_count_of_text, (*self.warnings, *self.texts.notes)))
        checks = 2 + len(self.limits.rows) if self.limits else 0
        return _OUTLINES + STRIP[1] + ROW * (15 + rows + lines + 1.2 * len(self.demands.rows) + texts + checks)

    @property
    def sections(self) -> list[tuple[str, Sequence[Block]]]:
        """The contents with their headings, one below the other as in a document."""
        return [
            (translated("Alternatives"), [Drawing("outlines"), self.alternatives, self.lines]),
            (" ".join((translated("Demands"), self.records)).strip(), [self.demands]),
            *([(translated("Checks"), [self.limits])] if self.limits else []),
            (
                translated("Governing record: {name}" if self.several else "Record: {name}", name=self.record.name),
                [Drawing("strip", 0.5), self.record.facts, Drawing("sheet")],
            ),
        ]


def comparison_page(
    comparison: Comparison,
    texts: ReportTexts,
    units: UnitSystem,
    sets: Sequence[RecordSet] = (),
    checks: Sequence[CheckTable] = (),
) -> tuple[ComparisonPage, Figures]:
    """Return the page of a comparison, and its figures.

    With the `sets` of the alternatives under the same records, the demands are the values for design of their rule;
    with their `checks` it has these as well.
    """
    from rockflex.plot._comparison import draw_alternatives

    report = reported_alternatives(comparison, units)
    record = _report_tables.reported_record(report)
    total, several = comparison.n_records, comparison.n_records > 1
    names, tables = ", ".join(comparison.names), _report_tables
    usual = tables.title_of_several_text(names, total) if several else tables.title_text(names, record.name)
    statistics = translated("for design") if sets else " / ".join(translated(STATISTICS[each]) for each in SHOWN)
    fell = [
        translated(
            "{name} overturned under {n} of {total} records" if several else "{name} overturned",
            name=name,
            n=n,
            total=total,
        )
        for name, n in zip(comparison.names, comparison.overturned, strict=True)
        if n
    ]
    page = ComparisonPage(
        title=shortened(texts.title or usual, MAX_LETTERS["title"]),
        texts=texts,
        several=several,
        records=translated("of {n} records: {statistics}", n=total, statistics=statistics) if several else "",
        alternatives=alternatives_table(comparison, units),
        lines=[model_line(comparison), *_report_tables.assumption_lines(report), *_explained_demands(comparison)],
        demands=design_value_table(comparison, sets, units) if sets else demand_table(comparison, units),
        limits=limit_check_table(list(comparison.names), checks, units) if checks else None,
        record=record,
        warnings=first_warnings([*fell, *warnings_of_runs(report, ())]),
    )
    outlines = draw_alternatives(comparison, width=WIDTH, height=_OUTLINES)
    return page, {
        "outlines": (translated("The alternatives as they rock"), outlines),
        **figures_of_runs(page, record, report),
    }


def reported_alternatives(comparison: Comparison, units: UnitSystem) -> ReportedRuns:
    """Return the responses of the alternatives to the governing record, as the parts of a page take them."""
    runs = comparison.responses
    histories = tuple(run.history for run in runs if isinstance(run.history, History))
    first = histories[0].model.properties
    return ReportedRuns(runs, histories, comparison.names, first, None, comparison.motion, 1.0, units)


def alternatives_table(comparison: Comparison, units: UnitSystem) -> ReportTable:
    """Return a row for each alternative: its kind, what decides its response, and its elements."""
    mass, length, moment = units.of("mass"), units.of("length"), units.of("moment", "MN m")
    heads = [
        (translated("alternative"), ""),
        (translated("structure"), ""),
        ("m_tot", mass.name),
        ("B", length.name),
        ("T_1", "s"),
    ]
    heads += [("M_r", moment.name), (translated("elements"), "")]
    rows: list[Sequence[ReportCell]] = []
    for name, structure in zip(comparison.names, comparison.structures, strict=True):
        p: RockingProperties = structure.rocking()
        rows.append(
            [
                ReportCell(name),
                ReportCell(_report_tables.structure_kind_text(structure)),
                value_cell(p.m_tot, "m_tot", mass.size, 4),
                value_cell(p.half_width, "half_width", length.size),
                value_cell(2.0 * math.pi / float(p.omega[0]) if p.n_modes else None, "period"),
                value_cell(p.resisting_moment, "resisting_moment", moment.size),
                ReportCell(_report_tables.elements_text(p, units) or "–"),
            ]
        )
    return ReportTable(heads, rows)


def model_line(comparison: Comparison) -> tuple[str, str]:
    """Return the models as a headed line: one for all, or that of each alternative."""
    labels = [run.model for run in comparison.responses]
    own = ", ".join(f"{name}: {label}" for name, label in zip(comparison.names, labels, strict=True))
    return translated("Model"), labels[0] if len(set(labels)) == 1 else own


def demand_table(comparison: Comparison, units: UnitSystem) -> ReportTable:
    """Return a row for each demand: its value for each alternative, and the differences in %.

    Under several records each cell has the statistics `SHOWN`.
    """
    first, *others = comparison.names
    shown = SHOWN if comparison.n_records > 1 else ("max",)
    heads = [(translated("demand"), ""), *((name, "") for name in comparison.names)]
    heads += [(translated("{name} to {first}", name=name, first=first), "%") for name in others]
    values = [comparison.demands(each).to_dict("index") for each in shown]
    differences = [comparison.differences(each).to_dict("index") for each in shown]
    rows: list[Sequence[ReportCell]] = []
    for demand in map(str, values[0]):
        known = OUTPUTS[demand]
        unit = known.unit_in(units, largest=float(comparison.runs[demand].max()))
        cells = [ReportCell(unit.heading(translated(known.symbol)))]
        cells += [
            _joined([value_cell(each[demand][name], demand, unit.size) for each in values]) for name in comparison.names
        ]
        cells += [_joined([difference_cell(each[demand][name]) for each in differences]) for name in others]
        rows.append(cells)
    return ReportTable(heads, rows)


def design_value_table(comparison: Comparison, sets: Sequence[RecordSet], units: UnitSystem) -> ReportTable:
    """Return a row for each demand: its value for design of each alternative, and the differences in %."""
    first, *others = comparison.names
    heads = [(translated("demand"), ""), *((name, "") for name in comparison.names)]
    heads += [(translated("{name} to {first}", name=name, first=first), "%") for name in others]
    values = [found.statistics["design"].to_dict() for found in sets]
    rows: list[Sequence[ReportCell]] = []
    for demand in DEMANDS_OF_SET:
        known = [float(each.get(demand, math.nan)) for each in values]
        finite = [each for each in known if math.isfinite(each)]
        if not finite:
            continue
        unit = OUTPUTS[demand].unit_in(units, largest=max(finite))
        cells = [ReportCell(unit.heading(translated(OUTPUTS[demand].symbol)))]
        cells += [value_cell(each if math.isfinite(each) else None, demand, unit.size) for each in known]
        cells += [difference_cell(100.0 * (each / known[0] - 1.0) if known[0] else math.nan) for each in known[1:]]
        rows.append(cells)
    return ReportTable(heads, rows)


def _explained_demands(comparison: Comparison) -> list[tuple[str, str]]:
    """Return what the demands are that not all runs have, as a headed line; none if there are none."""
    few = legend(map(str, comparison.demands().index), of_few=True)
    return [(translated("Demands"), "; ".join(few))] if few else []


def _joined(cells: Sequence[ReportCell]) -> ReportCell:
    """Return one cell with the texts of several, and the value of the first."""
    return replace(cells[0], text=" / ".join(cell.text for cell in cells))


def difference_cell(percent: float) -> ReportCell:
    """Return the cell of a difference in %, with its sign."""
    if not math.isfinite(percent):
        return ReportCell("∞" if percent > 0.0 else "–")
    text = "0" if abs(percent) < 0.5 else f"{percent:+.0f}".replace("-", "−")
    return ReportCell(text, percent, "difference")
