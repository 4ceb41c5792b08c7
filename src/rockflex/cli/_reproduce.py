"""``rockflex reproduce``: every table and figure of the paper, with our numbers next to the printed ones."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rockflex.cli import _console as console
from rockflex.cli import _options as options
from rockflex.cli import _output as output

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rockflex.papers.silva_stojadinovic_2024 import PaperRecords
    from rockflex.report import ReproducedResult

EPILOG = """[bold]Examples[/bold]

rockflex reproduce --list

rockflex reproduce --out out/paper

rockflex reproduce table-3 figure-15

rockflex reproduce figure-5 figure-9 --records peer --out mine

The report starts with the meaning of each verdict."""

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
        options.option("--out -o", "DIR", "Write report.html, report.md, numbers.csv and the figures to this folder."),
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
    force: options.Force = False,
) -> None:
    """Recompute the tables and figures of the paper, and report which printed numbers reproduce."""
    from rockflex.papers import silva_stojadinovic_2024 as paper

    if names:
        for target in paper.TARGETS:
            typer.echo(f"{target:10}  {paper.target_title(target)}")
        return

    output.check_output_folder(out, force=force)
    wanted = targets or list(paper.TARGETS)
    for target in wanted:
        paper.target_title(target)
    chosen = {name: value for name, value in (("seeds", seeds), ("seed", seed)) if value is not None}
    given = paper.PaperRecords(records, **chosen)
    console.print_remark(given.description)
    with console.step_bar("Computing", len(set(wanted))) as advance:
        results = paper.reproduce_targets(wanted, given, lambda _: advance(1))
    if out is None:
        _print_reproduced_numbers(results)
    else:
        _write_reproduction(results, given, out, force=force)
    _print_reproduction_counts(results)
    if out is not None:
        console.print_remark(f"Written to {out}: open {out / 'report.html'}")


def _write_reproduction(results: "list[ReproducedResult]", records: "PaperRecords", out: Path, *, force: bool) -> None:
    from rockflex.papers.silva_stojadinovic_2024 import RemarkKind, Verdict
    from rockflex.report import PublicationReport, write_publication_report

    verdicts = {str(verdict): verdict.meaning for verdict in Verdict}
    kinds = {str(kind): kind.meaning for kind in RemarkKind}
    document = PublicationReport(TITLE, SOURCE, records.description, output.versions(), verdicts, kinds, results)
    summary = {
        "versions": output.versions(),
        "records": records.description,
        "targets": [result.name for result in results],
        "numbers": document.counts,
        "checks": document.checks,
    }
    figures = sum(len(result.figures) for result in results)
    with (
        output.staged_output_folder(out, summary, force=force) as stage,
        console.step_bar("Drawing", figures) as advance,
    ):
        write_publication_report(document, stage, lambda _: advance(1))


def _print_reproduced_numbers(results: "Sequence[ReproducedResult]") -> None:
    for result in results:
        typer.echo(f"{result.name}: {result.title}")
        rows = [
            (n.name, n.printed, n.ours_as_text, n.unit, n.difference_as_text, str(n.verdict)) for n in result.numbers
        ]
        if rows:
            console.print_rows(("number", "paper", "rockflex", "unit", "difference", "verdict"), rows)
        checks = [(c.name, c.printed, c.ours_as_text, c.unit, "yes" if c.holds else "no") for c in result.checks]
        if checks:
            console.print_rows(("check of ourselves", "paper", "rockflex", "unit", "holds"), checks)
        typer.echo()


def _print_reproduction_counts(results: "Sequence[ReproducedResult]") -> None:
    from rockflex.papers.silva_stojadinovic_2024 import Verdict

    rows = [(r.name, *(str(r.count(verdict)) for verdict in Verdict)) for r in results]
    rows.append(("all", *(str(sum(r.count(verdict) for r in results)) for verdict in Verdict)))
    console.print_rows(("target", *map(str, Verdict)), rows)
