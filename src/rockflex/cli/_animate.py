"""``rockflex animate``: one structure under one ground motion, by several models side by side, as GIF or MP4."""

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from rockflex.cli import _console as console
from rockflex.cli import _options as options
from rockflex.cli import _output as output
from rockflex.foundation.errors import InputError
from rockflex.studies.progress import progress_bar

EPILOG = """[bold]Examples[/bold]

rockflex animate structure.toml el-centro-1940 --out run.gif

rockflex animate structure.toml fema-p695-far-field/FF-2-a --model MDOF-S,fixed --scale 1.5 --out run.mp4

rockflex animate structure.toml el-centro-1940 --model 2DOF-S --speed 0.5 --start 2 --stop 8 --out slow.gif

rockflex animate structure.toml --model 2DOF-C --initial-rotation 0.05 --free-vibration 10 --out released.gif"""

_picture = partial(options.option, rich_help_panel="Picture")
FLAGS = {
    "speed": "--speed",
    "frames_per_second": "--fps",
    "amplification": "--amplification",
    "start": "--start",
    "stop": "--stop",
    "panels": "--panels",
    "width": "--width",
    "path": "--out",
}


def animate(
    context: typer.Context,
    arguments: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="STRUCTURE.toml MOTION",
            help="The structure file, then the ground motion: a record (suite/name), a suite of one record, or a file.",
            show_default=False,
        ),
    ] = None,
    structure: options.StructureFile = None,
    motion: Annotated[
        list[str] | None, options.option("--motion -m", "MOTION", "The ground motion.", show_default=False)
    ] = None,
    model: options.Models = None,
    scale: Annotated[float, options.option("--scale", "FACTOR", "Factor on the acceleration.")] = 1.0,
    free_vibration: options.FreeVibration = "0",
    work_limit: options.WorkLimit = None,
    out: Annotated[
        Path | None, options.option("--out -o", "FILE.gif|.mp4", "The file to write; its suffix tells the format.")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace the file if it exists.")] = False,
    speed: Annotated[float, _picture("--speed", "X", "Seconds of the response per second of the animation.")] = 1.0,
    frames_per_second: Annotated[float, _picture("--fps", "N", "Frames per second.")] = 25.0,
    amplification: Annotated[
        float | None,
        _picture("--amplification", "X", "Factor on what moves in the picture. Default: large enough to be seen."),
    ] = None,
    start: Annotated[float | None, _picture("--start", "S", "Time at which it begins.")] = None,
    stop: Annotated[float | None, _picture("--stop", "S", "Time at which it ends.")] = None,
    panels: Annotated[
        str | None,
        _picture(
            "--panels",
            "NAME,...",
            "Histories, separated by commas: rotation, top_displacement, total_top_displacement, base_moment, "
            "base_shear, horizontal_reaction, joint_rotation, slip, edge_uplift, ground_acceleration.",
        ),
    ] = None,
    width: Annotated[int, _picture("--width", "PX", "Width in pixels.")] = 960,
    units: options.Units = None,
    dt: options.Dt = None,
    vertical: options.Vertical = None,
) -> None:
    """Show a structure rocking under a ground motion, beside its histories, as GIF or MP4.

    Several models move side by side.
    """
    if out is None:
        raise InputError("An animation is a file. Give its path by --out, such as --out run.gif or --out run.mp4.")
    from rockflex.cli._batch import RunArguments, prepare_batch, run_batch
    from rockflex.cli._options import naming_flags_in_errors
    from rockflex.cli._run_results import print_failed_runs, print_run_warnings
    from rockflex.plot._figures import literal_text
    from rockflex.plot.animation._animate import animate as draw
    from rockflex.plot.animation._files import animation_path_and_suffix

    with naming_flags_in_errors(FLAGS):
        target, _ = animation_path_and_suffix(out)
    if target.exists() and not force:
        raise InputError(f"The file {target} exists. Give another one by --out, or --force to replace it.")
    asked = RunArguments(
        arguments=arguments or [], structure=structure, motion=motion, model=model, scale=[repr(scale)],
        free_vibration=free_vibration, work_limit=work_limit, units=units, dt=dt, vertical=vertical
    )  # fmt: skip
    prepared = prepare_batch(context, asked, histories=1)
    loaded, batch = prepared.loaded, prepared.batch
    if not batch.history:
        first = prepared.found[0]
        raise InputError(
            f"An animation shows one ground motion, but {len(batch.motions)} were given. Name one of them, such as "
            f"{first.motion.name} of {first.origin}."
        )
    runs = run_batch(batch)
    responses = [run.response for run in runs if run.response is not None]
    title = None if scale == 1.0 else f"{literal_text(batch.motions[0].name)} × {scale:g}"
    told = output.written_remark(target)
    with naming_flags_in_errors(FLAGS), progress_bar("Frames", transient=True) as show:
        draw(
            responses, target, [response.model for response in responses], structure=loaded.built, speed=speed,
            frames_per_second=frames_per_second, amplification=amplification, start=start, stop=stop,
            panels=None if panels is None else [name.strip() for name in panels.split(",")], title=title, width=width,
            progress=lambda done, total: show(done, total, "")
        )  # fmt: skip
    console.print_remark(told)
    console.print_warnings(loaded.warnings)
    print_run_warnings(runs)
    if print_failed_runs(runs):
        raise typer.Exit(1)
