"""``rockflex run``: one structure under ground motions, by several models side by side."""

from typing import Annotated, Any

import typer

from rockflex._schema import BedKeys, BoucWenKeys, FrameFlags, GroundKeys, ImpactKeys, InitialKeys
from rockflex.cli import _options as options
from rockflex.cli._flags import given, naming

EPILOG = """[bold]Examples[/bold]

rockflex run structure.toml el-centro-1940

rockflex run structure.toml fema-p695-far-field --model MDOF-S,fixed --out results

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


FLAGS = {"free_vibration": "--free-vibration", "scales": "--scale", "mu": "--friction"}


def run(
    context: typer.Context,
    arguments: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="STRUCTURE.toml MOTION",
            help="The structure file, then ground motions: suites, records (suite/name), files or directories.",
            show_default=False,
        ),
    ] = None,
    structure: options.StructureFile = None,
    motion: Annotated[
        list[str] | None,
        typer.Option("--motion", "-m", metavar="MOTION", help="A ground motion; may be repeated.", show_default=False),
    ] = None,
    model: Annotated[
        list[str] | None,
        typer.Option(
            "--model",
            metavar="LABEL",
            help="Labels, separated by commas. Simplified: 2DOF-S, 3DOF-S, ... MDOF-S; complete: 2DOF-C, 2DOF-C-SI, "
            "MDOF-C, 3DOF-C-SI, 3DOF-C-E, ...; without flexure: rigid, rigid-C; fixed base: fixed, 5DOF-fixed; one "
            "mode that yields: 2DOF-S-BW, 2DOF-C-BW, 1DOF-fixed-BW; with the mass of omitted modes in V_b and M_b: "
            "2DOF-S-R, 5DOF-fixed-R, ... Default: 2DOF-S,MDOF-S,fixed; with a hysteresis "
            "2DOF-S,2DOF-S-BW,1DOF-fixed-BW; with an initial rotation, those of these that rock; on springs or with "
            "--ground-friction, those that are simplified and elastic and rock.",
            show_default=False,
        ),
    ] = None,
    scale: Annotated[
        list[str],
        typer.Option(
            "--scale",
            metavar="FACTOR",
            help="Factor on the acceleration, or smallest:largest:step such as 0.5:3:0.25; may be repeated.",
        ),
    ] = ["1"],  # noqa: B006
    free_vibration: Annotated[
        str,
        typer.Option(metavar="S|settle", help="Seconds after the record, or settle: until at rest or overturned."),
    ] = "0",
    times: Annotated[bool, typer.Option("--times", help="Also print the times of the peaks.")] = False,
    workers: Annotated[
        int | None,
        typer.Option(min=1, metavar="N", help="Threads. Default: one per core; only one for up to 64 runs."),
    ] = None,
    work_limit: options.WorkLimit = None,
    strict: Annotated[bool, typer.Option("--strict", help="Exit with 1 if any run could not be solved.")] = False,
    json: options.Json = False,
    out: options.Out = None,
    figures: options.Figures = 4,
    force: options.Force = False,
    friction: options.Friction = None,
    units: options.Units = None,
    dt: options.Dt = None,
    on_error: options.OnError = "raise",
    vertical: options.Vertical = None,
) -> None:
    """Simulate a structure under ground motions and print the peaks of each run.

    Peaks are those of the continuous motion, also between samples. All values are in kg, m, s, N and rad.
    """
    from time import perf_counter

    from rockflex.cli._choices import choose_models, make_assumptions, number_or_word, parse_work_limit
    from rockflex.cli._console import note, warn
    from rockflex.cli._motions import find_motions, quiet_ground
    from rockflex.cli._output import check_folder, to_json, versions
    from rockflex.cli._run_output import UNITS, write_runs
    from rockflex.cli._run_tables import print_failures, print_runs, print_warnings
    from rockflex.cli._simulations import Batch, perform, warm_up
    from rockflex.cli._structures import describe_properties, load_structure, split_arguments
    from rockflex.response import friction_coefficient
    from rockflex.study._arguments import factors_of, free_vibration_time
    from rockflex.study._ranges import parsed
    from rockflex.study._yielding import yielding

    check_folder(out, force=force)
    file, names = split_arguments(structure, arguments or [])
    loaded = load_structure(file, given(context, FrameFlags))
    law, bouc_wen, initial = (given(context, table) for table in (ImpactKeys, BoucWenKeys, InitialKeys))
    ground = given(context, GroundKeys) | given(context, BedKeys)
    assumptions = make_assumptions(file, loaded.assumed, law, bouc_wen, initial, ground, loaded.properties)
    models = choose_models(model, loaded.properties, assumptions, by_flag=bool(bouc_wen))
    if assumptions.bouc_wen is not None and not yielding(models):
        note(f"[bouc_wen] of {file} is for models that end in -BW, such as 2DOF-S-BW; none was given")
    names += motion or []
    with naming(FLAGS):
        free = number_or_word(free_vibration)
        free_vibration_time(free)
        mu = None if friction is None else friction_coefficient(friction)
        if names or vertical or not initial:
            found = find_motions(names, units, dt, on_error, vertical)
        else:
            found, free = quiet_ground(free)
        given_scales = [factor for text in scale for factor in parsed(text)]
        strongest = max((each.motion for each in found), key=lambda it: it.pga)
        scales = list(dict.fromkeys(factors_of(given_scales, strongest)))
        batch = Batch(
            properties=loaded.properties,
            motions=[each.motion for each in found],
            scales=scales,
            models=models,
            free_vibration=free,
            history=out is not None and len(found) * len(scales) <= figures,
            workers=workers,
            assumptions=assumptions,
            friction=mu,
            work_limit=parse_work_limit(work_limit),
        )
        warm_up(batch)
    start = perf_counter()
    runs = perform(batch)
    elapsed = perf_counter() - start
    document: dict[str, Any] = {
        "versions": versions(),
        "structure": loaded.describe(),
        "properties": describe_properties(batch.properties),
        "motions": [item.describe() for item in found],
        "options": batch.describe(),
        "units": UNITS,
        "elapsed": elapsed,
        "warnings": list(loaded.warnings),
        "runs": [{**item.row(), "run_time": item.run_time, "warnings": list(item.warnings)} for item in runs],
    }
    if out is not None:
        write_runs(out, document, batch, runs, force=force)
    if json:
        typer.echo(to_json(document))
    else:
        print_runs(loaded.title, batch, runs, elapsed, times=times)
    warn(document["warnings"])
    print_warnings(runs)
    if print_failures(runs) and strict:
        raise typer.Exit(1)
