"""``rockflex cloud``, ``ida``, ``stripes``, ``population`` and ``design``: studies from a TOML file."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rockflex._errors import InputError
from rockflex.cli import _options as options

if TYPE_CHECKING:
    import pandas as pd

    from rockflex.study.plans import Study

COMMANDS = {
    "cloud": "cloud",
    "incremental": "ida",
    "stripes": "stripes",
    "population": "population",
    "design": "design",
}


def epilog(command: str) -> str:
    """Examples of a command."""
    return f"""[bold]Examples[/bold]

rockflex {command} study.toml --dry-run

rockflex {command} study.toml --out results

rockflex {command} study.toml --out results --dask tcp://10.0.0.1:8786

A study that was stopped goes on where it was, by the same command. pandas, Polars and DuckDB read the folder's
parts/*.parquet; rockflex figures draws them."""


StudyFile = Annotated[Path, typer.Argument(metavar="STUDY.toml", help="The study's file.", show_default=False)]
Folder = Annotated[
    Path | None,
    typer.Option("--out", "-o", metavar="DIR", help="Keep the study here, and go on with what is kept."),
]
DryRun = Annotated[bool, typer.Option("--dry-run", help="Count the runs and estimate the time; run nothing.")]
Dask = Annotated[
    str | None,
    typer.Option("--dask", metavar="ADDRESS", help="Scheduler of a Dask cluster, such as tcp://10.0.0.1:8786."),
]
Workers = Annotated[int | None, typer.Option(min=1, metavar="N", help="Threads. Default: one a core.")]
AnyVersion = Annotated[
    bool, typer.Option("--any-version", help="Go on with a study begun with other versions of the libraries.")
]
Strict = Annotated[bool, typer.Option("--strict", help="Exit with 1 if a run could not be solved or a fit not made.")]


def _command(name: str, kind: str, summary: str) -> Callable[..., None]:
    """The command of one kind of study: all take the same arguments."""

    def command(
        file: StudyFile,
        out: Folder = None,
        dry_run: DryRun = False,
        dask: Dask = None,
        workers: Workers = None,
        any_version: AnyVersion = False,
        work_limit: options.WorkLimit = None,
        json: options.Json = False,
        strict: Strict = False,
    ) -> None:
        _study(kind, file, out, dry_run, dask, workers, any_version, work_limit, json, strict)

    command.__name__, command.__doc__ = name, summary
    return command


cloud = _command(
    "cloud",
    "cloud",
    "Run every structure under every record at every scale, and fit regressions and fragility curves.",
)
ida = _command(
    "ida",
    "incremental",
    "Scale every record until the structure overturns, and fit the capacities (incremental dynamic analysis).",
)
stripes = _command(
    "stripes", "stripes", "Scale the records to levels of an intensity measure, and fit how many exceed a limit."
)
population = _command(
    "population",
    "population",
    "Run random structures under random records with MDOF-S and 2DOF-S, and compare the two.",
)
design = _command(
    "design",
    "design",
    "Run a structure on bases of many widths and with several tendons, and find how wide the base must be.",
)


def _study(
    kind: str,
    file: Path,
    out: Path | None,
    dry_run: bool,
    dask: str | None,
    workers: int | None,
    any_version: bool,
    work_limit: str | None,
    json: bool,
    strict: bool,
) -> None:
    from rockflex.study.plans import load_study

    study = load_study(file)
    if study.study != kind:
        raise InputError(f'{file} says study = "{study.study}". Use rockflex {COMMANDS[study.study]} {file}.')
    if work_limit is not None:
        from rockflex.cli._choices import parse_work_limit

        study = study.model_copy(update={"work_limit": parse_work_limit(work_limit) or "none"})
    if dry_run:
        _announce(study, file, workers, json=json)
        return
    table, seconds = _run(study, file, out, dask, workers, any_version=any_version)
    from rockflex.cli._study_summary import summarise

    if out is not None:
        from rockflex.cli._console import note

        note(f"Kept in {out}; rockflex figures {out} draws it")
    failed, unfitted = summarise(study, table, seconds, json=json)
    if strict and (failed or unfitted):
        raise typer.Exit(1)


def _announce(study: "Study", file: Path, workers: int | None, *, json: bool) -> None:
    """Say what a study would do."""
    from rockflex.cli._console import duration
    from rockflex.cli._output import to_json
    from rockflex.study import estimate_time

    plan = study.plan()
    seconds = estimate_time(study, workers)
    at_most = "at most " if study.study == "incremental" else ""
    document = {
        "study": study.study,
        "name": study.name,
        "runs": plan.n_runs,
        "parts": plan.n_chunks,
        "records": len(plan.motions),
        "estimated_time": seconds,
    }
    if json:
        typer.echo(to_json(document))
        return
    typer.echo(
        f"{file}: {at_most}{plan.n_runs} runs in {plan.n_chunks} parts, {len(plan.motions)} records; "
        f"about {at_most}{duration(seconds)} here"
    )


def _run(
    study: "Study", file: Path, out: Path | None, dask: str | None, workers: int | None, *, any_version: bool
) -> "tuple[pd.DataFrame, float]":
    """Table of a study and the time that it took in s, with a bar on the terminal."""
    from time import perf_counter

    from rockflex.cli._console import note, study_progress
    from rockflex.parallel import ClusterError
    from rockflex.study import Progress, run_study

    last: list[Progress] = []
    begun = perf_counter()
    try:
        with study_progress(study.name or file.stem) as show:

            def progress(now: Progress) -> None:
                if not last and now.kept:
                    note(f"{now.kept} of {now.parts} parts are in {out} already")
                last[:] = [now]
                show(now.parts, now.done, now.runs)

            table = run_study(study, out, workers=workers, dask=dask, any_version=any_version, progress=progress)
    except KeyboardInterrupt as stop:
        done = f"{last[0].done} of {last[0].parts} parts are kept in {out}" if last and out else "Nothing is kept"
        note(f"Stopped. {done}{'; the same command goes on' if out else ', as no --out was given'}.")
        raise typer.Exit(130) from stop
    except ClusterError as error:
        from rockflex.cli._console import complain

        complain(str(error))
        raise typer.Exit(1) from error
    return table, perf_counter() - begun
