"""``rockflex project``: structures, records, limits and results in one file; made, run, reported and shown."""

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import typer

from rockflex.cli import _console as console
from rockflex.cli import _options as options
from rockflex.cli import _output as output
from rockflex.cli._compare import CompareCommand
from rockflex.foundation.errors import InputError
from rockflex.foundation.schema import ReportKeys
from rockflex.foundation.units import KN

if TYPE_CHECKING:
    from rockflex.report.project._project import Project

NEW_EPILOG = """[bold]Examples[/bold]

rockflex project new pier.rockflex free.toml tied.toml chosen --rule ec8 --periods 0.2,2 --limits limits.toml

rockflex project new pier.rockflex pier.toml el-centro-1940 --scale 1.5 --report-author "A. Engineer" """

RUN_EPILOG = """[bold]Examples[/bold]

rockflex project run pier.rockflex"""

REPORT_EPILOG = """[bold]Examples[/bold]

rockflex project report pier.rockflex compared.html

rockflex project report pier.rockflex tied.pdf --structure tied"""

SHOW_EPILOG = """[bold]Examples[/bold]

rockflex project show pier.rockflex

The file is a ZIP: any program that unpacks one finds the structures and options as TOML, the records as CSV, and the
results as Parquet."""

File = Annotated[Path, typer.Argument(metavar="FILE.rockflex", help="The project.", show_default=False)]
Workers = Annotated[int | None, typer.Option(min=1, metavar="N", help="Threads. Default: one per core.")]

app = typer.Typer(no_args_is_help=True, rich_markup_mode="rich", help="Structures, records and results in one file.")


class NewCommand(CompareCommand):
    """A command with the options of all alternatives, and the head of their reports."""

    panels: ClassVar[dict[str, tuple[type, ...]]] = {"Head of the reports": (ReportKeys,), **CompareCommand.panels}


@app.command("new", cls=NewCommand, epilog=NEW_EPILOG, no_args_is_help=True)
def new(
    context: typer.Context,
    file: File,
    arguments: Annotated[
        list[str],
        typer.Argument(
            metavar="A.toml ... MOTION...",
            help="The structure files, then the ground motions: suites, suite/record, folders or files.",
            show_default=False,
        ),
    ],
    model: Annotated[str, options.option("--model", "LABEL", "The model of all structures.")] = "MDOF-S",
    scale: Annotated[float, options.option("--scale", "FACTOR", "Factor on the acceleration.")] = 1.0,
    rule: Annotated[
        str | None, options.option("--rule", "ec8|asce7|asce7-ii", "The value for design, as in rockflex check.")
    ] = None,
    limits: Annotated[
        Path | None, options.option("--limits", "FILE.toml", "Limits of checks, as in rockflex check.")
    ] = None,
    periods: Annotated[
        str | None, options.option("--periods", "S,S", "The range of periods for which the records were chosen.")
    ] = None,
    free_vibration: options.FreeVibration = "0",
    force: Annotated[bool, typer.Option("--force", help="Replace an earlier file.")] = False,
    units: options.Units = None,
    dt: options.Dt = None,
    on_error: options.OnError = "raise",
    vertical: options.Vertical = None,
) -> None:
    """Put structures, records, options and limits into one file.

    Impact law, hysteresis, ground, initial state and head are those of each structure file, unless given by options.
    """
    from rockflex.cli._check import read_limits
    from rockflex.cli._compare import load_alternatives
    from rockflex.cli._find_motions import find_motions
    from rockflex.cli._options import flag_values, naming_flags_in_errors
    from rockflex.cli._run_options import number_or_word
    from rockflex.cli._select import parse_comma_separated_numbers
    from rockflex.report.project._project import SUFFIX, Project

    target = file if file.suffix == SUFFIX else file.with_name(file.name + SUFFIX)
    if target.exists() and not force:
        raise InputError(f"{target} exists. Give another name, or --force to replace it.")
    loaded, given, rest = load_alternatives(context, arguments, model)
    if not loaded:
        raise InputError("No structure was given. Give structure files, such as pier.toml, before the ground motions.")
    found = find_motions(rest, units, dt, on_error, vertical)
    head = {key: str(value) for each in reversed(loaded.values()) for key, value in each.report.items()}
    head = {key: head[key] for key in head if key in ReportKeys.__annotations__} | flag_values(context, ReportKeys)
    flags = {"rule": "--rule", "periods": "--periods", "free_vibration": "--free-vibration", "model": "--model"}
    with naming_flags_in_errors(flags):
        span: Any = None if periods is None else parse_comma_separated_numbers("--periods", periods, 2, 2)
        project = Project(
            {name: each.built for name, each in loaded.items()},
            [each.motion.scaled(scale) if scale != 1.0 else each.motion for each in found],
            model,
            rule=rule,  # pyright: ignore[reportArgumentType]
            periods=span,
            free_vibration=number_or_word(free_vibration),
            limits=read_limits(limits),
            head=head,
            **given,
        )
    console.print_warnings([f"{name}: {text}" for name, each in loaded.items() for text in each.warnings])
    told = output.written_remark(target)
    project.save(target)
    console.print_remark(f"{told}; rockflex project run computes its results")


@app.command("run", epilog=RUN_EPILOG, no_args_is_help=True)
def run(
    file: File,
    workers: Workers = None,
    strict: Annotated[bool, typer.Option("--strict", help="Exit with 1 if a limit is exceeded.")] = False,
    json: options.Json = False,
) -> None:
    """Run all structures under all records, print values for design and checks, and keep the results in the file."""
    from rockflex.report.project._project import read_project

    project = read_project(file).run(workers)
    project.save(file)
    _print_project(project, json=json)
    if strict and project.results is not None and project.results.n_failed:
        raise typer.Exit(1)


@app.command("report", epilog=REPORT_EPILOG, no_args_is_help=True)
def report(
    file: File,
    out: Annotated[Path, typer.Argument(metavar="OUT.html|pdf|docx", help="The report.", show_default=False)],
    structure: Annotated[
        str | None,
        options.option("--structure -s", "NAME", "Report this one, with its checks. Default: compare all."),
    ] = None,
    workers: Workers = None,
    output_units: options.OutputUnits = None,
    language: options.ReportLanguage = None,
    decimal_comma: options.DecimalComma = False,
    force: Annotated[bool, typer.Option("--force", help="Replace an earlier report.")] = False,
) -> None:
    """Write the report of all structures side by side, or of one with its values for design and checks."""
    from rockflex.cli._run_results import checked_path_of_report
    from rockflex.report.project._project import read_project

    page = checked_path_of_report(out, force=force, flag="The report")
    written = options.report_format(page, output_units, language, comma=decimal_comma)
    told = output.written_remark(page)
    read_project(file).report(page, structure, workers, **written)
    console.print_remark(told)


@app.command("show", epilog=SHOW_EPILOG, no_args_is_help=True)
def show(file: File, json: options.Json = False) -> None:
    """Show what a project holds, and its results."""
    from rockflex.report.project._project import read_project

    _print_project(read_project(file), json=json)


def _print_project(project: "Project", *, json: bool) -> None:
    """Print the contents of a project, and its results."""
    from rockflex.response._outputs import OUTPUTS

    results = project.results
    if json:
        tables = {} if results is None else {name: getattr(results, name) for name in ("runs", "statistics", "checks")}
        document: dict[str, Any] = {
            "versions": output.versions(),
            "head": project.head,
            "structures": project.model,
            "motions": [{"name": each.name, "pga": each.pga, "metadata": each.metadata} for each in project.motions],
            "options": {key: getattr(project, key) for key in ("rule", "periods", "free_vibration", "limits")},
            "results": None if results is None else {key: each.to_dict("records") for key, each in tables.items()},
        }
        typer.echo(output.to_json(document))
        return
    for key, text in project.head.items():
        console.print_line(f"{key}: {text}")
    console.print_rows(
        ("structure", "model", "ground", "kind"),
        [
            (name, project.model[name], "own" if name in project.ground else "rigid", type(each).__name__)
            for name, each in project.structures.items()
        ],
        4,
    )
    console.print_line()
    scales = [None if each.metadata is None else each.metadata.scale for each in project.motions]
    rows = [
        (each.name, console.number(each.pga), console.number(1.0 if scale is None else scale))
        for each, scale in zip(project.motions, scales, strict=True)
    ]
    console.print_rows(("record", "PGA [m/s²]", "factor"), rows, 1)
    console.print_line()
    if results is None:
        console.print_line("no results: rockflex project run computes them")
        return
    design = _by_structure(results.statistics, "demand", "design")
    shown = {name: OUTPUTS[name].unit_in(KN) for name in design}
    rows = [
        (
            unit.heading(OUTPUTS[name].symbol),
            *(console.number(design[name].get(each, math.nan) / unit.size) for each in project.structures),
        )
        for name, unit in shown.items()
    ]
    console.print_rows(("for design", *project.structures), rows, 1)
    for reason in dict.fromkeys(results.statistics["reason"]):
        console.print_line(f"design: {reason}")
    console.print_line()
    ratios = _by_structure(results.checks[results.checks["limit"].notna()], "name", "ratio")
    rows = [
        (name, *(console.number(row.get(each, math.nan), 3) for each in project.structures))
        for name, row in ratios.items()
    ]
    console.print_rows(("demand over limit", *project.structures), rows, 1)
    console.print_line(f"{results.n_failed} of {sum(map(len, ratios.values()))} limits exceeded")


def _by_structure(table: Any, name: str, value: str) -> dict[str, dict[str, float]]:
    """Return a column of a table by the texts of another one, then by structure."""
    found: dict[str, dict[str, float]] = {}
    for row in table.to_dict("records"):
        found.setdefault(row[name], {})[row["structure"]] = row[value]
    return found
