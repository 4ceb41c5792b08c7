"""``rockflex tornado``: how a demand changes with each parameter of a structure at the ends of its range."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rockflex.cli import _console as console
from rockflex.cli import _options as options
from rockflex.cli import _output as output
from rockflex.foundation.errors import InputError
from rockflex.foundation.units import UnitSystem

if TYPE_CHECKING:
    from rockflex.cli._batch import PreparedBatch
    from rockflex.studies._tornado import Range, Tornado

EPILOG = """[bold]Examples[/bold]

rockflex tornado structure.toml el-centro-1940

rockflex tornado structure.toml fema-p695-far-field --parameter period=0.2 --parameter damping_ratio=0.5:2 --out bars

rockflex tornado structure.toml fema-p695-far-field --demand max_base_moment --free-vibration settle --json"""

USUAL = 0.1  # relative range
FLAGS = {"demand": "--demand", "parameters": "--parameter", "free_vibration": "--free-vibration"}


def tornado(
    context: typer.Context,
    arguments: options.Arguments = None,
    structure: options.StructureFile = None,
    motion: options.Motions = None,
    parameter: Annotated[
        list[str] | None,
        options.option(
            "--parameter",
            "NAME=RANGE",
            "A number of the structure, its ground or its impact law by the name of the argument, such as "
            "elements[0].stiffness, or scale, and its range: 0.2 for ±20 %, or the factors at its ends, 0.5:2. Without "
            "a range: ±10 %. May be repeated. Default: all numbers.",
            show_default=False,
        ),
    ] = None,
    demand: Annotated[str, options.option("--demand", "NAME", "The demand: a number of a response.")] = "max_rotation",
    model: Annotated[str, options.option("--model", "LABEL", "The model.")] = "MDOF-S",
    scale: Annotated[float, options.option("--scale", "FACTOR", "Factor on the acceleration.")] = 1.0,
    free_vibration: options.FreeVibration = "0",
    workers: Annotated[int | None, typer.Option(min=1, metavar="N", help="Threads. Default: one per core.")] = None,
    work_limit: options.WorkLimit = None,
    output_units: options.OutputUnits = None,
    decimal_comma: options.DecimalComma = False,  # noqa: ARG001  its callback tells the console
    json: options.Json = False,
    out: options.Out = None,
    force: options.Force = False,
    units: options.Units = None,
    dt: options.Dt = None,
    on_error: options.OnError = "raise",
    vertical: options.Vertical = None,
) -> None:
    """Run a structure with each parameter at both ends of its range, and print how the demand changes, most first.

    Of several records the medians are compared.
    """
    from rockflex.cli._batch import RunArguments, prepare_batch
    from rockflex.studies._arguments import free_vibration_argument
    from rockflex.studies._tornado import tornado as run

    output.check_output_folder(out, force=force)
    if "," in model:
        raise InputError(f"tornado takes one model, but --model names {model}. Choose one of them.")
    ranges = parameter_ranges(parameter)
    asked = RunArguments(
        arguments=arguments or [], structure=structure, motion=motion, model=[model], scale=[repr(scale)],
        free_vibration=free_vibration, work_limit=work_limit, workers=workers, units=units, dt=dt, on_error=on_error,
        vertical=vertical
    )  # fmt: skip
    prepared = prepare_batch(context, asked, histories=0)
    batch, given = prepared.batch, prepared.batch.options
    (factor,) = batch.scales
    with options.naming_flags_in_errors(FLAGS):
        found = run(
            prepared.loaded.built, [each if factor == 1.0 else each.scaled(factor) for each in batch.motions], model,
            ranges, demand=demand, free_vibration=free_vibration_argument(given.free_vibration), impact=given.impact,
            bouc_wen=given.bouc_wen, ground=given.ground, initial=given.initial, work_limit=given.work_limit,
            workers=workers
        )  # fmt: skip
    document = _document(prepared, found)
    if out is not None:
        _write(out, document, found, force=force)
    if json:
        typer.echo(output.to_json(document))
    else:
        _print(prepared, found, UnitSystem(output_units or "kN"))
    console.print_warnings(prepared.loaded.warnings)


def parameter_ranges(given: Sequence[str] | None) -> "dict[str, Range] | float":
    """Return the ranges that options such as ``period=0.2``, ``damping_ratio=0.5:2`` or ``scale`` give by name.

    Raises
    ------
    InputError
        If a range is no number, or a name was given twice.
    """
    if given is None:
        return USUAL
    found = dict[str, Any]()
    for text in given:
        name, equals, ends = (part.strip() for part in text.partition("="))
        try:
            numbers = tuple(map(float, ends.split(":"))) if equals else (USUAL,)
        except ValueError:
            numbers = ()
        if not 1 <= len(numbers) <= 2:
            raise InputError(
                f"--parameter {text} has no range. Expected one such as {name or 'period'}=0.2 for ±20 %, or the "
                f"factors at its ends, {name or 'period'}=0.5:2."
            )
        if name in found:
            raise InputError(f"--parameter {name} was given twice. Give each parameter once.")
        found[name] = numbers[0] if len(numbers) == 1 else numbers
    return found


def _document(prepared: "PreparedBatch", found: "Tornado") -> dict[str, Any]:
    from rockflex.response._outputs import OUTPUTS

    table = found.to_frame().reset_index()
    return {
        "versions": output.versions(),
        "structure": prepared.loaded.describe(),
        "motions": [each.describe() for each in prepared.found],
        "options": prepared.batch.describe(),
        "demand": found.demand,
        "units": {found.demand: OUTPUTS[found.demand].si, "change_low": "%", "change_high": "%"},
        "median": found.base,
        "warnings": list(prepared.loaded.warnings),
        "parameters": table.to_dict("records"),
    }


def _write(folder: Path, document: dict[str, Any], found: "Tornado", *, force: bool) -> None:
    """Write tornado.csv, its figure and summary.json."""
    from rockflex.plot._figures import save_figure
    from rockflex.plot._tornado import plot_tornado

    with output.staged_output_folder(folder, document, force=force) as stage:
        output.write_table(found.to_frame().reset_index(), stage / "tornado.csv")
        save_figure(plot_tornado(found), stage / "tornado.png")
    console.print_remark(f"Written to {folder}")


def _print(prepared: "PreparedBatch", found: "Tornado", units: UnitSystem) -> None:
    from rockflex.cli._run_options import lines_about_run_options
    from rockflex.response._outputs import OUTPUTS, legend

    batch, known = prepared.batch, OUTPUTS[found.demand]
    largest = max(abs(found.base), float(abs(found.values).max()))
    size, unit = known.unit_in(units, largest=largest)
    for line in (prepared.loaded.title, *lines_about_run_options(batch.options, batch.properties, units)):
        console.print_line(line)
    several = found.n_records > 1
    among = f"median of {found.n_records} records" if several else batch.motions[0].name
    times = "" if batch.scales == [1.0] else f" × {batch.scales[0]:g}"
    base = f"{console.number(found.base / size)} {unit}".rstrip()
    console.print_line(f"{batch.models[0]}, {among}{times}: {known.symbol} = {base}\n")
    fell = ["overturned"] * bool(found.overturned.any())
    head = ["parameter"]
    for end in ("low", "high"):
        head += [end, f"{known.symbol} [{unit or '-'}]", "change [%]", *fell]
    rows = [
        [
            str(name),
            *(
                cell
                for end in ("low", "high")
                for cell in (
                    f"× {row[f'factor_{end}']:.4g}",
                    console.number(row[end] / size),
                    console.number(row[f"change_{end}"], 3),
                    *([str(int(row[f"overturned_{end}"]))] if fell else []),
                )
            ),
        ]
        for name, row in found.to_frame().iterrows()
    ]
    console.print_rows(head, rows)
    for line in legend([found.demand], of_few=True):
        console.print_line(line)
