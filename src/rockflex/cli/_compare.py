"""``rockflex compare``: alternatives under the same records, and how their demands differ from those of the first."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import typer

from rockflex.cli import _console as console
from rockflex.cli import _options as options
from rockflex.cli import _output as output
from rockflex.foundation.errors import InputError
from rockflex.foundation.schema import GroundSchema, ImpactSchema, InitialStateSchema, SpringBedSchema
from rockflex.foundation.units import UnitSystem

if TYPE_CHECKING:
    from rockflex.cli._structures import LoadedStructure

EPILOG = """[bold]Examples[/bold]

rockflex compare free.toml tied.toml el-centro-1940

rockflex compare a.toml b.toml c.toml fema-p695-far-field --model MDOF-S --free-vibration settle --report compared.html

rockflex compare a.toml b.toml record.csv --units g --scale 1.5 --json"""


SHOWN = ("median", "p84")  # of the statistics, in the terminal


class CompareCommand(options.FrameCommand):
    """A command with the options of runs that hold for all alternatives."""

    panels: ClassVar[dict[str, tuple[type, ...]]] = {
        options.ASSUMPTIONS: (ImpactSchema, InitialStateSchema),
        options.GROUND: (GroundSchema, SpringBedSchema),
    }


def compare(
    context: typer.Context,
    arguments: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="A.toml B.toml ... MOTION...",
            help="The structure files, then the ground motions: suites, suite/record, or files.",
            show_default=False,
        ),
    ] = None,
    model: Annotated[str, options.option("--model", "LABEL", "The model of all alternatives.")] = "MDOF-S",
    scale: Annotated[float, options.option("--scale", "FACTOR", "Factor on the acceleration.")] = 1.0,
    free_vibration: options.FreeVibration = "0",
    workers: Annotated[int | None, typer.Option(min=1, metavar="N", help="Threads. Default: one per core.")] = None,
    work_limit: options.WorkLimit = None,
    output_units: options.OutputUnits = None,
    language: options.ReportLanguage = None,
    decimal_comma: options.DecimalComma = False,
    json: options.Json = False,
    report: Annotated[
        Path | None, options.option("--report", "FILE.html", "Write a report on one sheet of A4.", show_default=False)
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace an earlier report.")] = False,
    units: options.Units = None,
    dt: options.Dt = None,
    on_error: options.OnError = "raise",
    vertical: options.Vertical = None,
) -> None:
    """Compare alternatives: their demands under the same records, and the differences from the first one in %.

    Impact law, hysteresis and ground are those of each file, unless given by options.
    """
    from rockflex.cli._find_motions import find_motions
    from rockflex.cli._options import naming_flags_in_errors
    from rockflex.cli._run_options import number_or_word, parse_work_limit
    from rockflex.cli._run_results import checked_path_of_report
    from rockflex.report.run._report_page import write_report
    from rockflex.response._comparison import STATISTICS
    from rockflex.response._outputs import OUTPUTS, legend
    from rockflex.studies._compare import compare as run

    if "," in model:
        raise InputError(f"compare takes one model, but --model names {model}. Choose one of them.")
    page = None if report is None else checked_path_of_report(report, force=force)
    written = options.report_format(page, output_units, language, comma=decimal_comma)
    loaded, given, rest = load_alternatives(context, arguments or [], model)
    names = list(loaded)
    found = find_motions(rest, units, dt, on_error, vertical)
    flags = {"scales": "--scale", "free_vibration": "--free-vibration", "model": "--model"}
    with naming_flags_in_errors(flags):
        comparison = run(
            {name: each.built for name, each in loaded.items()}, [each.motion for each in found], model,
            scale=scale, free_vibration=number_or_word(free_vibration), workers=workers,
            work_limit=parse_work_limit(work_limit), **given
        )  # fmt: skip
    several = comparison.n_records > 1
    shown = tuple(STATISTICS) if json else SHOWN if several else ("max",)
    tables = {each: (comparison.demands(each), comparison.differences(each)) for each in shown}
    if json:
        document: dict[str, Any] = {
            "versions": output.versions(),
            "alternatives": {name: each.describe() for name, each in loaded.items()},
            "model": model,
            "scale": scale,
            "motions": [each.describe() for each in found],
            "governing_motion": comparison.motion.name,
            "overturned": dict(zip(names, comparison.overturned, strict=True)),
            "demands": {each: values.to_dict("index") for each, (values, _) in tables.items()},
            "differences": {each: table.to_dict("index") for each, (_, table) in tables.items()},
        }
        typer.echo(output.to_json(document))
    else:
        first, *others = names
        head = ["demand", *(["records"] if several else []), *names, *(f"{name} to {first} [%]" for name in others)]
        units_shown = UnitSystem(output_units or "kN")
        rows = [
            [
                f"{known.symbol} [{unit or '-'}]",
                *([STATISTICS[each]] if several else []),
                *(console.number(float(value) / size) for value in values.loc[demand]),
                *(console.number(float(value), 3) for value in differences.loc[demand]),
            ]
            for demand in tables[shown[0]][0].index
            for known in (OUTPUTS[str(demand)],)
            for size, unit in (known.unit_in(units_shown),)
            for each, (values, differences) in tables.items()
        ]
        among = f"; {comparison.motion.name} governs" if several else f": {comparison.motion.name}"
        console.print_line(f"{model}, {comparison.n_records} record{'s' if several else ''}{among}")
        console.print_rows(head, rows, 2 if several else 1)
        for line in legend(map(str, tables[shown[0]][0].index), of_few=True):
            console.print_line(line)
    console.print_warnings([f"{name}: {text}" for name, each in loaded.items() for text in each.warnings])
    counts = zip(names, comparison.overturned, strict=True)
    console.print_warnings(f"{name} overturned under {n} of {len(found)} records" for name, n in counts if n)
    if page is not None:
        told = output.written_remark(page)
        write_report(comparison, page, **written)
        console.print_remark(f"{told}; any browser prints it on one sheet of A4")


def load_alternatives(
    context: typer.Context, words: Sequence[str], model: str
) -> tuple[dict[str, "LoadedStructure"], dict[str, Any], list[str]]:
    """Return the structures of the files among some words by name, the options of each by option, and the other words.

    Raises
    ------
    InputError
        If a file cannot be read, or was given twice.
    """
    from rockflex.cli._run_options import make_run_options
    from rockflex.cli._structures import load_structure

    files = [Path(word) for word in words if word.lower().endswith(".toml")]
    loaded = [load_structure(file, {}) for file in files]
    names = [each.name for each in loaded]
    if len(set(names)) < len(names):
        names = [str(file.with_suffix("")) for file in files]
    if len(set(names)) < len(names):
        twice = next(file for file in files if files.count(file) > 1)
        raise InputError(f"The file {twice} was given twice. Give each alternative once.")
    own = {name: make_run_options(context, each)[0] for name, each in zip(names, loaded, strict=True)}
    options_of = ["impact", "initial", "ground", *(["bouc_wen"] if model.endswith("-BW") else [])]
    given: dict[str, Any] = {each: {name: getattr(own[name], each) for name in names} for each in options_of}
    return dict(zip(names, loaded, strict=True)), given, [word for word in words if Path(word) not in files]
