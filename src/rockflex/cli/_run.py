"""``rockflex run``: one structure under ground motions, by several models side by side."""

from typing import Annotated, Any, Literal

import typer

from rockflex.cli import _console as console
from rockflex.cli import _options as options
from rockflex.cli import _output as output
from rockflex.foundation.errors import InputError
from rockflex.foundation.schema import ReportKeys
from rockflex.foundation.units import UnitSystem

EPILOG = """[bold]Examples[/bold]

rockflex run structure.toml el-centro-1940

rockflex run structure.toml fema-p695-far-field --model MDOF-S,fixed --out results

rockflex run case.toml --out results

rockflex run structure.toml el-centro-1940 --friction 0.5 --report run.html

rockflex run structure.toml record.csv --units g --free-vibration settle --times

rockflex run structure.toml RSN6-180.AT2 --vertical RSN6-UP.AT2

rockflex run structure.toml el-centro-1940 --model 2DOF-C,MDOF-C,rigid --friction 0.5

rockflex run structure.toml el-centro-1940 --model 2DOF-S,2DOF-S-BW,1DOF-fixed-BW --yield-displacement 0.075

rockflex run structure.toml --model 2DOF-C --initial-rotation 0.05 --free-vibration 20 --impact restitution \
--restitution 0.9

rockflex run structure.toml el-centro-1940 --model MDOF-S --ground-friction 0.3

rockflex run structure.toml el-centro-1940 --model MDOF-S --subgrade-modulus 40e6 --breadth 3 \
--heave-damping-ratio 0.3 --mat-mass 40e3

rockflex run --stories 5 --story-height 3 --story-mass 40e3 --base-mass 40e3 --stiffness-ratio inf \
--period 1 --aspect-ratio 10 --damping-ratio 0.02 fema-p695-far-field/FF-2-a --scale 1 --scale 1.5 --json"""


def run(
    context: typer.Context,
    arguments: options.Arguments = None,
    structure: options.StructureFile = None,
    motion: options.Motions = None,
    model: options.Models = None,
    scale: options.Scales = ["1"],  # noqa: B006
    free_vibration: options.FreeVibration = "0",
    times: Annotated[bool, typer.Option("--times", help="Also print the times of the peaks.")] = False,
    workers: Annotated[
        int | None, typer.Option(min=1, metavar="N", help="Threads. Default: one per core; only one for up to 64 runs.")
    ] = None,
    work_limit: options.WorkLimit = None,
    strict: Annotated[bool, typer.Option("--strict", help="Exit with 1 if any run could not be solved.")] = False,
    output_units: options.OutputUnits = None,
    language: options.ReportLanguage = None,
    decimal_comma: options.DecimalComma = False,
    json: options.Json = False,
    out: options.Out = None,
    figures: options.Figures = 4,
    form: Annotated[
        Literal["csv", "mat", "nc"],
        typer.Option("--format", help="Histories in --out: CSV, MATLAB, or NetCDF (needs the extra xarray)."),
    ] = "csv",
    force: options.ForceBoth = False,
    report: options.Report = None,
    report_appendix: Annotated[
        bool, typer.Option("--report-appendix", help="Add cross-sections and loops of elements to the report.")
    ] = False,
    friction: options.Friction = None,
    units: options.Units = None,
    dt: options.Dt = None,
    on_error: options.OnError = "raise",
    vertical: options.Vertical = None,
) -> None:
    """Simulate a structure under ground motions and print the peaks of each run.

    A case, a file with structures, records, models and options, is run as it stands.

    Peaks are those of the continuous motion, also between samples. All inputs are in kg, m, s, N and rad.
    """
    from time import perf_counter

    from rockflex.cli._batch import FLAGS, RunArguments, output_folders, prepare_batches, run_batch
    from rockflex.cli._options import flag_values, naming_flags_in_errors
    from rockflex.cli._run_results import (
        UNITS,
        check_one_run_for_report,
        checked_path_of_report,
        print_failed_runs,
        print_run_peaks,
        print_run_warnings,
        write_report_of_run,
        write_run_results,
    )
    from rockflex.cli._structures import describe_rocking_properties

    output.check_output_folder(out, force=force and (out is not None or report is None))
    head = flag_values(context, ReportKeys) | ({"appendix": True} if report_appendix else {})
    if head and report is None:
        raise InputError(f"The {', '.join(head)} of a report was given without --report FILE.")
    page = None if report is None else checked_path_of_report(report, force=force)
    written = options.report_format(page, output_units, language, comma=decimal_comma)
    asked = RunArguments(
        arguments=arguments or [], structure=structure, motion=motion, model=model, scale=scale,
        free_vibration=free_vibration, work_limit=work_limit, workers=workers, friction=friction, units=units, dt=dt,
        on_error=on_error, vertical=vertical
    )  # fmt: skip
    drawn = 0 if out is None else figures
    prepared = prepare_batches(context, asked, histories=drawn if page is None else max(drawn, 1))
    if page is not None:
        check_one_run_for_report([each.batch for each in prepared])
    documents, failed = list[dict[str, Any]](), 0
    for (loaded, found, batch), folder in zip(prepared, output_folders(out, prepared), strict=True):
        start = perf_counter()
        with naming_flags_in_errors(FLAGS):
            runs = run_batch(batch)
        elapsed = perf_counter() - start
        document: dict[str, Any] = {
            "versions": output.versions(),
            "structure": loaded.describe(),
            "properties": describe_rocking_properties(batch.properties),
            "motions": [item.describe() for item in found],
            "options": batch.describe(),
            "units": UNITS,
            "elapsed": elapsed,
            "warnings": list(loaded.warnings),
            "runs": [{**item.row(), "run_time": item.run_time, "warnings": list(item.warnings)} for item in runs],
        }
        documents.append(document)
        if folder is not None:
            write_run_results(folder, document, batch, runs, figures=figures, form=form, force=force)
        if not json:
            if len(documents) > 1:
                console.print_line()
            print_run_peaks(loaded.title, batch, runs, elapsed, times=times, units=UnitSystem(output_units or "kN"))
        console.print_warnings(document["warnings"])
        print_run_warnings(runs)
        failed += print_failed_runs(runs)
        if page is not None:
            write_report_of_run(page, loaded, batch, runs, head | written)
    if json:
        typer.echo(output.to_json(documents[0] if len(documents) == 1 else {"structures": documents}))
    if failed and strict:
        raise typer.Exit(1)
