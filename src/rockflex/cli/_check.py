"""``rockflex check``: a structure under a set of records, values for design by a code, and checks against limits."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rockflex.cli import _console as console
from rockflex.cli import _options as options
from rockflex.cli import _output as output
from rockflex.foundation.errors import InputError
from rockflex.foundation.units import UnitSystem

if TYPE_CHECKING:
    from rockflex.response._limit_checks import Check, CheckLimits, CheckTable
    from rockflex.response._record_set import RecordSet

EPILOG = """[bold]Examples[/bold]

rockflex check structure.toml chosen --rule ec8 --limits limits.toml

rockflex check structure.toml fema-p695-far-field --model 2DOF-S --rule asce7 --periods 0.2,3 --report set.html

rockflex check structure.toml el-centro-1940 --scale 1.5 --limits limits.toml --strict

[bold]Limits[/bold]

A TOML file with the arguments of rockflex.CheckLimits in SI units, such as drift_ratio = 0.01, friction = 0.5, \
breadth = 6.0, bearing_pressure = 300e3, contact_ratio = 0.5, seat_width = 0.4, toe_length = 0.3, toe_stress = 20e6."""

DEFAULT_MODELS = ("MDOF-S", "2DOF-S-BW", "rigid")
STATISTICS = {"mean": "mean", "worst": "worst", "median": "median", "fractile_84": "84 %", "design": "design"}
VERDICTS = {True: ("ok", "green"), False: ("fails", "bold red"), None: ("-", "")}


def check(
    context: typer.Context,
    arguments: options.Arguments = None,
    structure: options.StructureFile = None,
    motion: options.Motions = None,
    model: Annotated[
        str | None,
        options.option("--model", "LABEL", "One model. Default: MDOF-S, with a hysteresis 2DOF-S-BW, or rigid."),
    ] = None,
    scale: Annotated[float, options.option("--scale", "FACTOR", "Factor on the acceleration.")] = 1.0,
    rule: Annotated[
        str | None,
        options.option(
            "--rule",
            "ec8|asce7|asce7-ii",
            "The value for design. ec8: the mean of 7 records and more, the worst of 3 to 6. asce7: the mean of 11 and "
            "more, none overturns; asce7-ii: one may (Risk Categories I and II). Default: the worst.",
        ),
    ] = None,
    limits: Annotated[
        Path | None, options.option("--limits", "FILE.toml", "Limits, see below. Default: those that a source gives.")
    ] = None,
    periods: Annotated[
        str | None, options.option("--periods", "S,S", "The range of periods for which the records were chosen.")
    ] = None,
    free_vibration: options.FreeVibration = "0",
    workers: Annotated[int | None, typer.Option(min=1, metavar="N", help="Threads. Default: one per core.")] = None,
    work_limit: options.WorkLimit = None,
    strict: Annotated[bool, typer.Option("--strict", help="Exit with 1 if a limit is exceeded.")] = False,
    output_units: options.OutputUnits = None,
    language: options.ReportLanguage = None,
    decimal_comma: options.DecimalComma = False,
    json: options.Json = False,
    report: Annotated[Path | None, options.option("--report", "FILE.html", "Write a report of the set.")] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace an earlier report.")] = False,
    units: options.Units = None,
    dt: options.Dt = None,
    on_error: options.OnError = "raise",
    vertical: options.Vertical = None,
) -> None:
    """Check a structure under a set of records: peaks by record, statistics, values for design, and limits.

    Its records are those of a suite, a folder or files, such as rockflex select --records writes.
    """
    from rockflex.cli._batch import FLAGS, RunArguments, prepare_batch
    from rockflex.cli._options import naming_flags_in_errors
    from rockflex.cli._run_results import checked_path_of_report
    from rockflex.cli._select import parse_comma_separated_numbers
    from rockflex.report.run._report_page import write_report
    from rockflex.response._limit_checks import check as check_limits
    from rockflex.studies._arguments import free_vibration_argument
    from rockflex.studies._simulate import simulate_set

    page = None if report is None else checked_path_of_report(report, force=force)
    written = options.report_format(page, output_units, language, comma=decimal_comma)
    given = read_limits(limits)
    asked = RunArguments(
        arguments=arguments or [], structure=structure, motion=motion, model=None if model is None else [model],
        scale=[repr(scale)], free_vibration=free_vibration, work_limit=work_limit, units=units, dt=dt,
        on_error=on_error, vertical=vertical
    )  # fmt: skip
    prepared = prepare_batch(context, asked, histories=0)
    loaded, batch, run = prepared.loaded, prepared.batch, prepared.batch.options
    labels = batch.models if model else [label for label in DEFAULT_MODELS if label in batch.models]
    if len(labels) != 1:
        raise InputError(f"check takes one model, but --model names {', '.join(labels)}. Choose one of them.")
    with naming_flags_in_errors(FLAGS | {"rule": "--rule", "periods": "--periods"}):
        span: Any = None if periods is None else parse_comma_separated_numbers("--periods", periods, 2, 2)
        found = simulate_set(
            *(loaded.built, [each.scaled(scale) if scale != 1.0 else each for each in batch.motions], labels[0]),
            rule=rule,  # pyright: ignore[reportArgumentType]
            periods=span,
            free_vibration=free_vibration_argument(run.free_vibration),
            bouc_wen=run.bouc_wen if "-BW" in labels[0] else None,
            impact=run.impact,
            initial=run.initial,
            work_limit=run.work_limit,
            ground=run.ground,
            workers=workers,
        )
    table = check_limits(found, given)
    if json:
        document: dict[str, Any] = {
            "versions": output.versions(),
            "structure": loaded.describe(),
            "motions": [each.describe() for each in prepared.found],
            "options": batch.describe() | {"models": labels, "rule": rule, "periods": span, "limits": given},
            "records": found.peaks.reset_index().to_dict("records"),
            "statistics": found.statistics.to_dict("index"),
            "rocking_period": found.rocking_period,
            "checks": table.to_frame().reset_index().to_dict("records"),
            "missing": dict(table.missing),
            "warnings": [*loaded.warnings, *found.warnings],
        }
        typer.echo(output.to_json(document))
    else:
        console.print_line(loaded.title)
        shown = UnitSystem(output_units or "kN")
        _print_set(found, shown)
        _print_checks(table, shown)
    console.print_warnings((*loaded.warnings, *found.warnings))
    if page is not None:
        told = output.written_remark(page)
        write_report(found, page, structure=loaded.built, title=loaded.name, limits=given, **written)
        console.print_remark(told)
    if strict and not table.ok:
        raise typer.Exit(1)


def read_limits(file: Path | None) -> "CheckLimits":
    """Return the limits in a TOML file, whose keys are the arguments of `CheckLimits`; the usual ones without a file.

    Raises
    ------
    InputError
        If the file cannot be read, or a key or a value is none of a limit.
    """
    from dataclasses import fields

    from rockflex.response._limit_checks import CheckLimits
    from rockflex.structure.file._structure_file import read_toml_file

    content: Mapping[str, Any] = {} if file is None else read_toml_file(file, "limits")
    known = [each.name for each in fields(CheckLimits)]
    unknown = [key for key in content if key not in known]
    if unknown:
        raise InputError(f"{file}: {', '.join(unknown)} is not known; there are {', '.join(known)}.", field=unknown[0])
    try:
        return CheckLimits(**content)
    except InputError as error:
        raise InputError(str(error), field=error.field, place=str(file)) from error


def _print_set(found: "RecordSet", units: UnitSystem) -> None:
    from rockflex.response._outputs import DEMANDS_BY_RECORD, OUTPUTS, legend

    peaks, statistics = found.peaks, found.statistics
    shown = {name: OUTPUTS[name].unit_in(units) for name in DEMANDS_BY_RECORD if name in statistics.index}
    rows = [
        [
            str(motion),
            str(row["status"]).replace("_", " "),
            *(console.number(row[name] / unit.size) for name, unit in shown.items()),
        ]
        for motion, row in peaks.iterrows()
    ]
    console.print_line()
    heads = [unit.heading(OUTPUTS[name].symbol) for name, unit in shown.items()]
    console.print_rows(("record", "status", *heads), rows, 2)
    console.print_line()
    rows = [
        [OUTPUTS[name].symbol, unit, *(console.number(row[column] / size) for column in STATISTICS)]
        for name, row in zip(map(str, statistics.index), statistics.to_dict("records"), strict=True)
        for size, unit in (OUTPUTS[name].unit_in(units),)
    ]
    console.print_rows(("demand", "unit", *STATISTICS.values()), rows, 2)
    for line in legend(map(str, statistics.index), of_few=True):
        console.print_line(line)
    for reason in dict.fromkeys(statistics["reason"]):
        console.print_line(f"design: {reason}")


def _print_checks(table: "CheckTable", units: UnitSystem) -> None:
    from rockflex.response._limit_checks import NO_LIMIT

    console.print_line()
    heads = ("check", "", "demand", "limit", "unit", "ratio", "source of the limit")
    console.print_rows(heads, [_check_cells(row, units) for row in table.rows], 2)
    for name, lacks in table.missing:
        if not lacks.startswith(NO_LIMIT):
            console.print_line(f"not checked: {name}: {lacks}")
    unlimited = [f"{name} ({lacks.split()[-1]})" for name, lacks in table.missing if lacks.startswith(NO_LIMIT)]
    if unlimited:
        console.print_line(f"without a limit: {', '.join(unlimited)}", wrap=True)


def _check_cells(row: "Check", units: UnitSystem) -> list[str]:
    from rockflex.response._limit_checks import check_in_units

    demand, limit, unit = check_in_units(row, units)
    verdict = console.StyledCell(*VERDICTS[row.ok])
    sign = "≥ " if row.at_least else ""
    return [row.name, verdict, console.number(demand), sign + console.number(limit), unit, console.number(row.ratio, 3),
            row.source or row.note]  # fmt: skip
