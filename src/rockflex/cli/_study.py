"""The commands of studies: one that runs each kind from a TOML file, and one that draws its figures."""

import math
from collections.abc import Callable
from functools import partial
from numbers import Integral, Number
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import typer

from rockflex.cli import _console as console
from rockflex.cli import _options as options
from rockflex.cli import _output as output
from rockflex.foundation.errors import InputError, SolverError
from rockflex.foundation.shown import number_with_noun, shown
from rockflex.studies._study_kind import KINDS, StudyFindings, StudyKind, study_kind_named
from rockflex.studies.progress import duration_text, progress_bar, row_rate_text

if TYPE_CHECKING:
    import pandas as pd

    from rockflex.studies.progress import Progress
    from rockflex.studies.spec import StudySpec


Result = TypeVar("Result")


def study_command_epilog(command: str) -> str:
    """Examples of a command."""
    return f"""[bold]Examples[/bold]

rockflex {command} study.toml --dry-run

rockflex {command} study.toml --out results

rockflex {command} study.toml --out results --dask tcp://10.0.0.1:8786

The same command resumes a study that was stopped. pandas, Polars and DuckDB read the folder's parts/*.parquet;
rockflex figures draws them."""


StudyFile = Annotated[Path, typer.Argument(metavar="STUDY.toml", help="The study's file.", show_default=False)]
Folder = Annotated[
    Path | None, options.option("--out -o", "DIR", "Store the study here, and resume it if it is there.")
]
DryRun = Annotated[bool, typer.Option("--dry-run", help="Count the runs and estimate the time; run nothing.")]
Dask = Annotated[
    str | None, options.option("--dask", "ADDRESS", "Scheduler of a Dask cluster, such as tcp://10.0.0.1:8786.")
]
Workers = Annotated[int | None, typer.Option(min=1, metavar="N", help="Threads. Default: one a core.")]
AnyVersion = Annotated[
    bool, typer.Option("--any-version", help="Resume a study that was started with other versions of the libraries.")
]
Share = Annotated[
    str | None,
    options.option(
        "--share",
        "K/N",
        "Only store share K of N of the study, each in a folder of its own; report nothing. For job arrays.",
    ),
]
Strict = Annotated[bool, typer.Option("--strict", help="Exit with 1 if a run or a fit failed.")]


def study_command(kind: StudyKind) -> Callable[..., None]:
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
        study = _load_study_of_kind(kind, file, work_limit)
        how = {"workers": workers, "dask": dask, "any_version": any_version}
        if share is not None:
            if out is None or dry_run or json or strict:
                raise InputError("--share only stores runs: it needs --out, and no --dry-run, --json or --strict.")
            _store_study_share(study, file, out, share, how)
            return
        if dry_run:
            _announce_study(study, file, workers, json=json)
            return
        from rockflex.studies._run_study import run_study

        table, seconds = _study_with_progress(study, file, out, partial(run_study, study, out, **how))
        if out is not None:
            console.print_remark(f"Stored in {out}; rockflex figures {out} draws it")
        failed, unfitted = print_study_summary(kind, study, table, seconds, json=json)
        if strict and (failed or unfitted):
            raise typer.Exit(1)

    command.__name__, command.__doc__ = kind.command, kind.summary
    return command


def _load_study_of_kind(kind: StudyKind, file: Path, work_limit: str | None) -> "StudySpec":
    from rockflex.studies._run_study import load_study

    study = load_study(file)
    if study.kind != kind.name:
        right = KINDS[study.kind].command
        raise InputError(f'The file {file} has study = "{study.kind}". Use rockflex {right} {file}.')
    if work_limit is None:
        return study
    from rockflex.cli._run_options import parse_work_limit

    return study.model_copy(update={"work_limit": parse_work_limit(work_limit) or "none"})


def _announce_study(study: "StudySpec", file: Path, workers: int | None, *, json: bool) -> None:
    """Print how many runs a study has and about how long it takes."""
    from rockflex.studies._run_study import estimate_time

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
        typer.echo(output.to_json(document))
        return
    typer.echo(
        f"{file}: {at_most}{number_with_noun(plan.n_runs, 'run')} in {number_with_noun(plan.n_chunks, 'part')}, "
        f"{number_with_noun(len(plan.motions), 'record')}; "
        f"about {at_most}{duration_text(seconds)} here"
    )


def _store_study_share(study: "StudySpec", file: Path, out: Path, share: str, how: dict[str, Any]) -> None:
    """Store one share of a study."""
    from rockflex.studies._run_study import fill_study

    place, stroke, count = share.partition("/")
    if not (stroke and place.isdecimal() and count.isdecimal()):
        raise InputError(f'--share must be K/N, such as 3/10, but "{share}" was given.')
    folder, _ = _study_with_progress(
        study, file, out, partial(fill_study, study, out, share=(int(place), int(count)), **how)
    )
    console.print_remark(
        f"Share {share} is stored in {out}: {folder.n_chunks - len(folder.missing())} of {folder.n_chunks} parts"
    )


def _study_with_progress(
    study: "StudySpec", file: Path, out: Path | None, work: Callable[..., Result]
) -> tuple[Result, float]:
    """Return the result of `work` and the time that it took in s; a terminal shows a progress bar."""
    from time import perf_counter

    from rockflex.studies.parallel import ClusterError

    last: list[Progress] = []
    start = perf_counter()
    try:
        with progress_bar(study.name or file.stem, transient=True) as show:

            def progress(now: "Progress") -> None:
                if not last and now.kept:
                    console.print_remark(f"{now.kept} of {now.parts} parts are already in {out}")
                last[:] = [now]
                show(now.done, now.parts, row_rate_text(now, perf_counter() - start))

            result = work(progress=progress)
    except KeyboardInterrupt as stop:
        done = f"{last[0].done} of {last[0].parts} parts are stored in {out}" if last and out else "Nothing was stored"
        console.print_remark(
            f"Stopped. {done}{'; the same command resumes it' if out else ', because no --out was given'}."
        )
        raise typer.Exit(130) from stop
    except ClusterError as error:
        console.print_error(str(error))
        raise typer.Exit(1) from error
    return result, perf_counter() - start


Tables = dict[str, list[dict[str, Any]]]


def print_study_summary(
    kind: StudyKind, study: "StudySpec", table: "pd.DataFrame", seconds: float, *, json: bool
) -> tuple[int, int]:
    """Print the summary of a study; return the number of failed runs and of failed fits."""
    from rockflex.studies._result_tables import count_pivot_lifts

    found = StudyFindings()
    try:
        kind.report(study, table, found)
    except (InputError, SolverError) as error:  # the runs are stored, whatever can be derived from them
        found.unfitted.append(str(error))
    tables: Tables = {
        title: [{str(key): _plain_summary_value(value) for key, value in row.items()} for row in rows]
        for title, rows in found.tables.items()
    }
    lifts = count_pivot_lifts(kind.runs(table))
    failed = int(table["error"].notna().sum())
    if json:
        document = {"versions": output.versions(), "study": study.document(), "rows": len(table), "failed": failed}
        document |= {"elapsed": seconds, "unfitted": found.unfitted}
        typer.echo(output.to_json(document | {"pivot_lifts": [each._asdict() for each in lifts], **tables}))
    else:
        _print_summary_tables(tables)
        for text in (text for each in lifts for text in each.warnings):
            typer.echo(f"\n{text}")
        typer.echo(f"\n{number_with_noun(len(table), 'row')} in {duration_text(seconds)}")
    for remark in found.remarks:
        console.print_remark(remark)
    for reason in dict.fromkeys(found.unfitted):
        console.print_remark(f"No fit: {reason}")
    if failed:
        first = table.loc[table["error"].notna(), "error"].iloc[0]
        console.print_remark(f"{number_with_noun(failed, 'row has', 'rows have')} an error, the first: {first}")
    return failed, len(found.unfitted)


def _plain_summary_value(value: Any) -> Any:
    """A number or a text; None for what is missing."""
    if isinstance(value, Number):
        return None if isinstance(value, float) and math.isnan(value) else value
    return None if value is None else str(value)


def _print_summary_tables(tables: Tables) -> None:
    for place, (title, rows) in enumerate(tables.items()):
        if rows:
            console.print_line(("\n" if place else "") + title, style="bold", wrap=True)
            words = sum(isinstance(value, str) for value in rows[0].values())
            console.print_rows(list(rows[0]), ([_summary_cell(value) for value in row.values()] for row in rows), words)


def _summary_cell(value: Any) -> str:
    if isinstance(value, str):
        return value
    if value is None:
        return "-"
    return str(int(value)) if isinstance(value, Integral) else console.number(float(value))


FIGURES_EPILOG = """[bold]Examples[/bold]

rockflex cloud study.toml --out results

rockflex figures results

rockflex figures results --measure sa_t1 --format pdf --theme journal --size column --out manuscript"""

FORMATS = ("png", "svg", "pdf")
*OTHERS, LAST = (kind.name for kind in KINDS.values() if kind.measured)


def figures(
    folder: Annotated[
        Path, typer.Argument(metavar="FOLDER", help="Folder of a study, finished or not.", show_default=False)
    ],
    out: Annotated[Path | None, options.option("--out -o", "DIR", "Where to. Default: FOLDER/figures.")] = None,
    measure: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            help=f"Intensity measure of {', '.join(OTHERS)} or {LAST} studies, such as sa_t1_5. Default: pgv.",
        ),
    ] = None,
    form: Annotated[str, options.option("--format", "|".join(FORMATS), "Format of the files.")] = "png",
    size: Annotated[
        str | None,
        options.option(
            "--size", "SIZE", "column (89 mm wide), page (183 mm), or WxH in mm, such as 85x60. Default: as it suits."
        ),
    ] = None,
    theme: Annotated[str, options.option("--theme", "light|dark|journal", "Colours, grid and letters.")] = "light",
    force: options.Force = False,
) -> None:
    """Draw the results of a study: fragility curves, clouds, capacities, designs, or the agreement of models."""
    if form not in FORMATS:
        raise InputError(f"--format must be one of {', '.join(FORMATS)}, but {shown(form)} was given.")
    from rockflex.studies.folders._folder import StudyFolder

    target = folder / "figures" if out is None else out
    output.check_output_folder(target, force=force)
    study = StudyFolder.load(folder)
    kind = study_kind_named(study.spec.get("study"))
    if measure is not None and not kind.measured:
        raise InputError(
            f"--measure is for {', '.join(OTHERS)} and {LAST} studies, but the study in {folder} is of kind "
            f"{kind.name}. Leave it out."
        )
    missing = len(study.missing())
    table = study.frame(partial=True)
    if missing:
        console.print_remark(f"{missing} of {study.n_chunks} parts are missing: the figures show the others")
    document: dict[str, Any] = {
        "versions": output.versions(),
        "study": study.spec,
        "parts": study.n_chunks,
        "missing_parts": missing,
    }
    from rockflex.plot._figures import figure_style, save_figure

    undrawn: list[str] = []
    style = figure_style(theme, _figure_size(size))  # pyright: ignore[reportArgumentType]
    with style, output.staged_output_folder(target, document, force=force) as stage:
        for stem, draw in kind.figures(study.spec, table, measure or "pgv", console.print_remark):
            try:
                save_figure(draw(), stage / f"{stem}.{form}")
            except (InputError, SolverError) as error:
                undrawn.append(f"{stem}: {error}")
        if not any(stage.iterdir()):
            raise InputError(f"No figure of {folder} can be drawn. {' '.join(undrawn)}")
    for reason in undrawn:
        console.print_remark(f"No figure {reason}")
    console.print_remark(f"Written to {target}")


def _figure_size(given: str | None) -> Any:
    """Return the size of figures as the plot functions take it, in inches."""
    if given is None or given in ("column", "page"):
        return given
    try:
        width, height = (float(each) / 25.4 for each in given.split("x"))
    except ValueError as error:
        raise InputError(
            f"--size must be column, page, or width and height in mm such as 85x60, but {shown(given)} was given."
        ) from error
    return width, height
