"""The commands that run studies from a TOML file, one for each kind of study."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypeVar

import typer

from rockflex._errors import InputError
from rockflex._shown import counted
from rockflex.cli import _options as options
from rockflex.kinds import StudyKind

if TYPE_CHECKING:
    from rockflex.progress import Progress
    from rockflex.study.plan import Spec

Result = TypeVar("Result")


def epilog(command: str) -> str:
    """Examples of a command."""
    return f"""[bold]Examples[/bold]

rockflex {command} study.toml --dry-run

rockflex {command} study.toml --out results

rockflex {command} study.toml --out results --dask tcp://10.0.0.1:8786

The same command resumes a study that was stopped. pandas, Polars and DuckDB read the folder's parts/*.parquet;
rockflex figures draws them."""


StudyFile = Annotated[Path, typer.Argument(metavar="STUDY.toml", help="The study's file.", show_default=False)]
Folder = Annotated[
    Path | None,
    typer.Option("--out", "-o", metavar="DIR", help="Store the study here, and resume it if it is there."),
]
DryRun = Annotated[bool, typer.Option("--dry-run", help="Count the runs and estimate the time; run nothing.")]
Dask = Annotated[
    str | None,
    typer.Option("--dask", metavar="ADDRESS", help="Scheduler of a Dask cluster, such as tcp://10.0.0.1:8786."),
]
Workers = Annotated[int | None, typer.Option(min=1, metavar="N", help="Threads. Default: one a core.")]
AnyVersion = Annotated[
    bool, typer.Option("--any-version", help="Resume a study that was started with other versions of the libraries.")
]
Share = Annotated[
    str | None,
    typer.Option(
        "--share",
        metavar="K/N",
        help="Only store share K of N of the study, each in a folder of its own; report nothing. For job arrays.",
    ),
]
Strict = Annotated[bool, typer.Option("--strict", help="Exit with 1 if a run or a fit failed.")]


def command_of(kind: StudyKind) -> Callable[..., None]:
    """Return the command that runs studies of a kind: all take the same arguments."""

    def command(
        file: StudyFile,
        out: Folder = None,
        dry_run: DryRun = False,
        dask: Dask = None,
        workers: Workers = None,
        share: Share = None,
        any_version: AnyVersion = False,
        work_limit: options.WorkLimit = None,
        json: options.Json = False,
        strict: Strict = False,
    ) -> None:
        study = _load(kind, file, work_limit)
        if share is not None:
            if out is None or dry_run or json or strict:
                raise InputError("--share only stores runs: it needs --out, and no --dry-run, --json or --strict.")
            _store_share(study, file, out, share, dask, workers, any_version=any_version)
            return
        if dry_run:
            _announce(study, file, workers, json=json)
            return
        from rockflex.kinds import run_study

        table, seconds = _watched(
            study,
            file,
            out,
            lambda progress: run_study(
                study, out, workers=workers, dask=dask, any_version=any_version, progress=progress
            ),
        )
        from rockflex.cli._study_summary import summarise

        if out is not None:
            from rockflex.cli._console import note

            note(f"Stored in {out}; rockflex figures {out} draws it")
        failed, unfitted = summarise(kind, study, table, seconds, json=json)
        if strict and (failed or unfitted):
            raise typer.Exit(1)

    command.__name__, command.__doc__ = kind.command, kind.summary
    return command


def _load(kind: StudyKind, file: Path, work_limit: str | None) -> "Spec":
    from rockflex.kinds import KINDS, load_study

    study = load_study(file)
    if study.kind != kind.name:
        right = KINDS[study.kind].command
        raise InputError(f'The file {file} has study = "{study.kind}". Use rockflex {right} {file}.')
    if work_limit is None:
        return study
    from rockflex.cli._choices import parse_work_limit

    return study.model_copy(update={"work_limit": parse_work_limit(work_limit) or "none"})


def _announce(study: "Spec", file: Path, workers: int | None, *, json: bool) -> None:
    """Print how many runs a study has and about how long it takes."""
    from rockflex.cli._output import to_json
    from rockflex.kinds import estimate_time
    from rockflex.progress import duration

    plan = study.plan()
    seconds = estimate_time(study, workers)
    at_most = "" if plan.exact_count else "at most "
    document = {
        "study": study.kind,
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
        f"{file}: {at_most}{counted(plan.n_runs, 'run')} in {counted(plan.n_chunks, 'part')}, "
        f"{counted(len(plan.motions), 'record')}; "
        f"about {at_most}{duration(seconds)} here"
    )


def _store_share(
    study: "Spec", file: Path, out: Path, share: str, dask: str | None, workers: int | None, *, any_version: bool
) -> None:
    """Store one share of a study."""
    from rockflex.cli._console import note
    from rockflex.kinds import fill_study

    place, stroke, count = share.partition("/")
    if not (stroke and place.isdecimal() and count.isdecimal()):
        raise InputError(f'--share must be K/N, such as 3/10, but "{share}" was given.')
    folder, _ = _watched(
        study,
        file,
        out,
        lambda progress: fill_study(
            study,
            out,
            share=(int(place), int(count)),
            workers=workers,
            dask=dask,
            any_version=any_version,
            progress=progress,
        ),
    )
    note(f"Share {share} is stored in {out}: {folder.n_chunks - len(folder.missing())} of {folder.n_chunks} parts")


def _watched(
    study: "Spec", file: Path, out: Path | None, work: "Callable[[Callable[[Progress], None]], Result]"
) -> tuple[Result, float]:
    """Return the result of `work` and the time that it took in s; a terminal shows a progress bar."""
    from time import perf_counter

    from rockflex.cli._console import note
    from rockflex.parallel import ClusterError
    from rockflex.progress import bar, pace

    last: list[Progress] = []
    start = perf_counter()
    try:
        with bar(study.name or file.stem, transient=True) as show:

            def progress(now: "Progress") -> None:
                if not last and now.kept:
                    note(f"{now.kept} of {now.parts} parts are already in {out}")
                last[:] = [now]
                show(now.done, now.parts, pace(now, perf_counter() - start))

            result = work(progress)
    except KeyboardInterrupt as stop:
        done = f"{last[0].done} of {last[0].parts} parts are stored in {out}" if last and out else "Nothing was stored"
        note(f"Stopped. {done}{'; the same command resumes it' if out else ', because no --out was given'}.")
        raise typer.Exit(130) from stop
    except ClusterError as error:
        from rockflex.cli._console import complain

        complain(str(error))
        raise typer.Exit(1) from error
    return result, perf_counter() - start
