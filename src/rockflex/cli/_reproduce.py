"""``rockflex reproduce``: every table and figure of the paper, with our numbers next to the printed ones."""

from contextlib import closing, contextmanager
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Annotated

import typer

from rockflex.cli import _console as console
from rockflex.cli import _options as options
from rockflex.cli import _output as output
from rockflex.foundation.shown import number_with_noun
from rockflex.studies.progress import duration_text, progress_bar

if TYPE_CHECKING:
    from collections.abc import Generator, Sequence

    from rockflex.cli._reproduction import Done, Job
    from rockflex.papers.silva_stojadinovic_2024._inputs import PaperRecords
    from rockflex.report._document import FinishedResult
    from rockflex.studies.progress import Show

EPILOG = """[bold]Examples[/bold]

rockflex reproduce --list

rockflex reproduce --out out/paper

rockflex reproduce table-3 figure-15

rockflex reproduce figure-5 figure-9 --records peer --out mine

Quick targets come first. Each one is in the report as soon as it is done; after Ctrl-C the same line goes on. The
report starts with the meaning of each verdict."""

MIN_KNOWN_SHARE = 0.05  # of the work, after which the time left can be told

TITLE = "Silva & Stojadinović (2024), reproduced"
SOURCE = (
    "Surrogate models for seismic response analysis of flexible rocking structures. Earthquake Engineering & "
    "Structural Dynamics, doi 10.1002/eqe.4193."
)


def reproduce(
    targets: Annotated[
        list[str] | None,
        typer.Argument(metavar="[TARGET]...", help="Tables and figures. Default: all.", show_default=False),
    ] = None,
    out: Annotated[
        Path | None,
        options.option(
            "--out -o",
            "DIR",
            "Write report.html, report.md, numbers.csv and the figures to this folder, and go on with what it has.",
        ),
    ] = None,
    records: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR", help="Folder of records, such as PEER's AT2 files, to use instead of the embedded records."
        ),
    ] = None,
    seeds: Annotated[
        int | None,
        typer.Option(
            metavar="N",
            help="Number of random populations of 1000 pairs, at least 10, by which Figs. 9 and 13 are judged: fewer "
            "are quicker but less conclusive. Default: 20.",
            show_default=False,
        ),
    ] = None,
    seed: Annotated[
        int | None,
        typer.Option(
            metavar="SEED",
            help="Seed of the first of these populations; the others have the next ones. Default: 2024.",
            show_default=False,
        ),
    ] = None,
    names: Annotated[bool, typer.Option("--list", help="List the targets and run nothing.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Start anew, and replace earlier results in --out.")] = False,
) -> None:
    """Recompute the tables and figures of the paper, and report which printed numbers reproduce."""
    from rockflex.papers.silva_stojadinovic_2024._inputs import SEED, SEEDS, PaperRecords
    from rockflex.papers.silva_stojadinovic_2024._targets import TARGETS, target_title

    if names:
        for target in TARGETS:
            typer.echo(f"{target:10}  {target_title(target)}")
        return

    for target in targets or ():
        target_title(target)
    given = PaperRecords(records, SEEDS if seeds is None else seeds, SEED if seed is None else seed)
    console.print_remark(given.description)
    if out is None:
        output.check_output_folder(out, force=force)
    else:
        from rockflex.cli._kept_work import prepare_folder

        prepare_folder(out, force=force)
    _reproduce_targets(set(targets or TARGETS), given, out)


def _reproduce_targets(wanted: set[str], records: "PaperRecords", out: Path | None) -> None:
    """Compute what is missing of some targets, and write or print each when it is done."""
    from rockflex.cli._kept_work import KeptWork
    from rockflex.cli._reproduction import finished_jobs, planned_jobs
    from rockflex.papers.silva_stojadinovic_2024._targets import TARGETS, target_pieces

    with KeptWork(out, records) as kept:
        results = kept.results()
        missing = [name for name in TARGETS if name in wanted and name not in results]
        records.tables.update(kept.tables([piece for name in missing for piece in target_pieces(name, records)]))
        if results or records.tables:
            pieces = f" and {number_with_noun(len(records.tables), 'piece')} of others" if records.tables else ""
            console.print_remark(f"{number_with_noun(len(results), 'target')}{pieces} are already in {out}")
        if out is not None:
            _write_reproduction(results, missing, records, out)
        jobs = planned_jobs(missing, records, whole=out is not None)
        try:
            with (
                _job_progress(jobs) as progress,
                closing(finished_jobs(jobs, records, kept, progress.running)) as coming,
            ):
                for done in coming:
                    progress.add(done)
                    if done.result is None:
                        continue
                    results[done.result.name] = done.result
                    missing.remove(done.result.name)
                    if out is None:
                        _print_reproduced_numbers(done.result)
                    else:
                        _write_reproduction(results, missing, records, out, only=done.result.name)
                    console.print_remark(progress.line(done))
        except KeyboardInterrupt as stop:
            state = "Nothing is kept, because no --out was given"
            if out is not None:
                state = f"{len(results)} of {len(results) + len(missing)} targets are in {out}; the same line goes on"
            console.print_remark(f"Stopped. {state}.")
            raise typer.Exit(130) from stop
    _print_reproduction_counts([results[name] for name in TARGETS if name in results])
    if out is not None:
        console.print_remark(f"Written to {out}: open {out / 'report.html'}")


class _JobProgress:
    """How much of the work is done, by the cost of its jobs, on a bar or in lines."""

    def __init__(self, total: float, show: "Show") -> None:
        self._total, self._show, self._done = total, show, 0.0
        self._first: tuple[float, float] | None = None

    def running(self, jobs: "Sequence[Job]") -> None:
        """Show what runs."""
        done = self._done if self._left() is not None else 0.0
        self._show(100.0 * done / self._total, 100.0, ", ".join(job.title for job in jobs))

    def add(self, done: "Done") -> None:
        """Count a job."""
        self._done += done.job.cost
        if self._first is None:  # what was before is mostly the start of processes
            self._first = perf_counter(), self._done

    def line(self, done: "Done") -> str:
        """Return the line about a target that is done."""
        left = self._left()
        text = f"{done.job.title}: {duration_text(done.seconds)}; {100.0 * self._done / self._total:.0f} % done"
        return text if left is None else f"{text}, about {duration_text(left)} left"

    def _left(self) -> float | None:
        """Return the time left in s, once enough is done to tell."""
        if self._first is None or not MIN_KNOWN_SHARE * self._total <= self._done < self._total:
            return None
        start, done = self._first
        if self._done <= done:
            return None
        return (perf_counter() - start) * (self._total - self._done) / (self._done - done)


@contextmanager
def _job_progress(jobs: "Sequence[Job]") -> "Generator[_JobProgress]":
    with progress_bar("Reproducing, %", transient=True) as show:
        yield _JobProgress(sum(job.cost for job in jobs), show)


def _write_reproduction(
    found: "dict[str, FinishedResult]",
    missing: "Sequence[str]",
    records: "PaperRecords",
    out: Path,
    *,
    only: str | None = None,
) -> None:
    """Write the report on what there is; with `only`, the figures of the other targets are there already."""
    from rockflex.foundation.files import write_file_atomically
    from rockflex.papers.silva_stojadinovic_2024._comparison import RemarkKind, Verdict
    from rockflex.papers.silva_stojadinovic_2024._targets import TARGETS
    from rockflex.report._document import PublicationReport
    from rockflex.report._publication_files import write_publication_report
    from rockflex.studies.folders._folder import explaining_write_errors

    results = [found[name] for name in TARGETS if name in found]
    verdicts = {str(verdict): verdict.meaning for verdict in Verdict}
    kinds = {str(kind): kind.meaning for kind in RemarkKind}
    document = PublicationReport(
        TITLE, SOURCE, records.description, output.versions(), verdicts, kinds, results, missing
    )
    summary = {
        "versions": output.versions(),
        "records": records.description,
        "targets": [result.name for result in results],
        "missing": list(missing),
        "numbers": document.counts,
        "checks": document.checks,
    }
    with explaining_write_errors(out):
        files = write_publication_report(document, out, only=only)
        names = [*sorted(file.name for file in files), output.SUMMARY]
        text = output.to_json({**summary, "files": names}, ascii_only=False)
        write_file_atomically(out / output.SUMMARY, (text + "\n").encode())


def _print_reproduced_numbers(result: "FinishedResult") -> None:
    typer.echo(f"{result.name}: {result.title}")
    rows = [(n.name, n.printed, n.ours_as_text, n.unit, n.difference_as_text, str(n.verdict)) for n in result.numbers]
    if rows:
        console.print_rows(("number", "paper", "rockflex", "unit", "difference", "verdict"), rows)
    checks = [(c.name, c.printed, c.ours_as_text, c.unit, "yes" if c.holds else "no") for c in result.checks]
    if checks:
        console.print_rows(("check of ourselves", "paper", "rockflex", "unit", "holds"), checks)
    typer.echo()


def _print_reproduction_counts(results: "Sequence[FinishedResult]") -> None:
    from rockflex.papers.silva_stojadinovic_2024._comparison import Verdict

    rows = [(r.name, *(str(r.count(verdict)) for verdict in Verdict)) for r in results]
    rows.append(("all", *(str(sum(r.count(verdict) for r in results)) for verdict in Verdict)))
    console.print_rows(("target", *map(str, Verdict)), rows)
