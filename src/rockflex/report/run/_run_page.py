"""The page of runs of one structure under one record: its contents put together, and laid out on one sheet."""

import dataclasses
import hashlib
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from rockflex.foundation.errors import InputError
from rockflex.foundation.language import translated
from rockflex.foundation.shown import shortened
from rockflex.foundation.units import UnitSystem
from rockflex.motion._ground_motion import GroundMotion
from rockflex.report.run import _report_tables
from rockflex.report.run._report_appendix import ReportAppendix, report_appendix
from rockflex.report.run._report_tables import ReportedRecord, ReportFact, ReportTable
from rockflex.report.run._reported_runs import ReportedRuns, checked_reported_runs
from rockflex.report.run._run_checks import labels_of_long_runs, limit_check_table, run_check_legend, run_check_table
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
    line_count_of_table,
    line_count_of_text,
)
from rockflex.response._friction import friction_coefficient
from rockflex.response._limit_checks import CheckLimits, check
from rockflex.response._outputs import legend
from rockflex.response._response import (
    Response,
    warnings_of_response,
    warnings_of_run,
    warnings_of_sensitivity,
)
from rockflex.structure._structure import structure_warnings

_FEW = 4  # elements, whose loops are readable in half a sheet


@dataclass(frozen=True, eq=False, kw_only=True)
class RunPage(OneSheet):
    """The page of a run."""

    template: ClassVar[str] = "run.html.jinja"

    kind: str
    facts: Sequence[ReportFact]
    modes: ReportTable | None
    record: ReportedRecord
    lines: Sequence[tuple[str, str]]
    elements: ReportTable | None
    peaks: ReportTable
    checks: ReportTable
    legend: Sequence[str]
    limits: ReportTable | None
    appendix: ReportAppendix

    @property
    def height(self) -> float:
        """About the height in mm of all but the figure."""
        structure = len(self.facts) / 2 + (0 if self.modes is None else 2 + len(self.modes.rows))
        record = 8 + len(self.record.facts)
        lines = sum(line_count_of_text(f"{head} {text}") for head, text in self.lines)
        tables = sum(map(line_count_of_table, (self.elements, self.peaks, self.checks, self.limits)))
        texts = line_count_of_text(" ".join(self.legend))
        texts += sum(map(line_count_of_text, (*self.warnings, *self.texts.notes)))
        head = 8 + bool(self.texts.heads) + line_count_of_text(self.title)
        return ROW * (head + max(structure, record) + lines + tables + texts)

    @property
    def sections(self) -> list[tuple[str, Sequence[Block]]]:
        """The contents with their headings, one below the other as in a document."""
        ground = [(translated("Base and ground"), [self.lines, self.elements])] if self.lines or self.elements else []
        more = [Drawing(f"loops{place}") for place in range(len(self.appendix.loops))]
        return [
            (translated("Structure: {kind}", kind=self.kind), [self.facts, self.modes]),
            (translated("Record: {name}", name=self.record.name), [Drawing("strip", 0.5), self.record.facts]),
            *ground,
            (translated("Largest values"), [Drawing("sheet"), self.peaks]),
            (translated("Checks"), [self.checks, *self.legend, self.limits]),
            *([(translated("Appendix"), [self.appendix.sections, *more])] if self.appendix else []),
        ]


def run_page(
    responses: Response | Iterable[Response],
    texts: ReportTexts,
    units: UnitSystem,
    *,
    structure: Any = None,
    motion: GroundMotion | None = None,
    friction: float | None = None,
    omitted: Collection[str] = (),
    limits: CheckLimits | None = None,
    appendix: bool = False,
) -> tuple[RunPage, Figures]:
    """Return the page of runs, and its figures; no energies and no friction of the models in `omitted`."""
    coefficient = None if friction is None else _checked_friction_coefficient(friction)
    report = checked_reported_runs(responses, structure, motion, units)
    known = report.properties if structure is None else structure
    record, kind = _report_tables.reported_record(report), _report_tables.structure_kind_text(known)
    left_out = labels_of_long_runs(report).union(omitted)
    moves = _report_tables.outputs_of_base(report)
    fell = any(run.status == "overturned" for run in report.responses)
    page = RunPage(
        title=shortened(texts.title or _report_tables.title_text(kind, record.name), MAX_LETTERS["title"]),
        texts=texts,
        kind=kind,
        facts=_report_tables.structure_facts(report.properties, units),
        modes=_report_tables.mode_table(report.properties, units),
        record=record,
        lines=_report_tables.assumption_lines(report),
        elements=_report_tables.element_table(report),
        peaks=_report_tables.peak_table(report),
        checks=run_check_table(report, coefficient, left_out),
        legend=[
            *[translated("† The values of a run that overturned include its fall.")] * fell,
            *["; ".join(legend(moves))] * bool(moves),
            *run_check_legend(report, coefficient, omitted=bool(left_out)),
        ],
        limits=None if limits is None else _limits_of_runs(report, limits, left_out),
        warnings=first_warnings([*structure_warnings(known), *warnings_of_runs(report, left_out)]),
        inputs=report_fingerprint(report, record),
        appendix=report_appendix(report) if appendix else ReportAppendix(None, ()),
    )
    return page, figures_of_runs(page, record, report) | _figures_of_appendix(page, report)


def figures_of_runs(page: OneSheet, record: ReportedRecord, report: ReportedRuns) -> dict[str, tuple[str, Any]]:
    """Return the figures of the record and of the runs."""
    from rockflex.plot._run_sheet import draw_record_strip, draw_run_sheet

    strip = draw_record_strip(record.time, record.acceleration, width=STRIP[0], height=STRIP[1])
    sheet = draw_run_sheet(
        report.responses, report.labels, report.structure, width=WIDTH / page.scale, height=page.figure_height
    )
    return {
        "strip": (translated("Ground acceleration"), strip),
        "sheet": (translated("Histories and loops of all models"), sheet),
    }


def _figures_of_appendix(page: RunPage, report: ReportedRuns) -> dict[str, tuple[str, Any]]:
    from rockflex.plot._loops import plot_loops

    size: Any = "page" if len(report.properties.elements) > _FEW else (7.2, 4.2)  # of which a sheet has room for two
    return {
        f"loops{place}": (
            translated("Loops of base and elements, {label}", label=label),
            plot_loops(run, title="", size=size),
        )
        for place, (label, run) in enumerate(page.appendix.loops)
    }


def _limits_of_runs(report: ReportedRuns, limits: CheckLimits, omitted: Collection[str]) -> ReportTable:
    """Return the checks of runs against limits, without the friction of the models in `omitted`."""
    tables = [
        check(run, dataclasses.replace(limits, friction=None) if label in omitted else limits)
        for label, run in zip(report.labels, report.responses, strict=True)
    ]
    return limit_check_table(report.labels, tables, report.units)


def warnings_of_runs(report: ReportedRuns, omitted: Collection[str]) -> list[str]:
    """Return the warnings of the runs, each with its models; of the peaks only for the labels in `omitted`."""
    found: dict[str, list[str]] = {}
    for label, run in zip(report.labels, report.responses, strict=True):
        for text in (
            warnings_of_response(run.model, run.peaks(), report.units)
            if label in omitted
            else (*warnings_of_run(run, report.units), *warnings_of_sensitivity(run))
        ):
            found.setdefault(text, []).append(label)
    return [f"{', '.join(labels)}: {text}" for text, labels in found.items()]


def _checked_friction_coefficient(friction: float) -> float:
    try:
        return friction_coefficient(friction)
    except InputError as error:
        raise InputError(str(error).replace("mu must", "friction must"), field="friction") from None


def report_fingerprint(report: ReportedRuns, record: ReportedRecord) -> str:
    """Return a hash of structure, ground and record, and of the assumptions and the initial state of each run."""
    p = report.properties
    numbers: list[Any] = [record.time, record.acceleration, record.vertical]
    numbers += [p.omega, p.effective_mass, p.effective_height, p.zeta, p.top_ordinate]
    numbers.append([p.i_theta, p.l0r, p.m_tot, p.half_width, p.translational_inertia, p.eccentricity])
    texts = [repr((p.elements, report.labels))]
    for history in report.histories:
        model = history.model
        # Initial states that follow from the input, such as rest on springs, have rounding errors.
        numbers += [[float(f"{value:.6g}") for value in history.states[0].tolist()], *_fingerprint_of_ground(model)]
        texts += [_fingerprint_of_impact_law(model), repr(model.bouc_wen), f"{float(history.time[-1]):.6g}"]
    content = b"".join(np.asarray(each, dtype=np.float64).tobytes() for each in numbers)
    return hashlib.sha256(content + "\n".join(texts).encode()).hexdigest()[:12]


def _fingerprint_of_ground(model: Any) -> list[Any]:
    friction = getattr(model, "friction", None)
    known = [] if friction is None else [friction]
    springs = model.springs
    return known if springs is None else [*known, springs.positions, springs.stiffness, springs.damping, model.inertia]


def _fingerprint_of_impact_law(model: Any) -> str:
    # An object that is no dataclass is written with its address, which no two sessions share.
    law = model.law
    return repr(law) if dataclasses.is_dataclass(law) else type(law).__name__
