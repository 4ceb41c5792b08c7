"""``rockflex select``: records chosen and scaled for a target spectrum."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from rockflex._errors import InputError
from rockflex._shown import counted
from rockflex.cli import _options as options

if TYPE_CHECKING:
    from rockflex.motion import Combination, Selection

EPILOG = """[bold]Examples[/bold]

rockflex select fema-p695-far-field --target ec8:ag=0.25g,ground=C --count 7 --periods 0.2,2 --out chosen

rockflex select folder --target ec8:ag=2.5m/s2,ground=B,type=2,importance=1.2 -n 7 --periods 0.1,1 --per-event 1

rockflex select folder --target asce7:sds=1g,sd1=0.6g,tl=8 -n 11 --periods 0.2,2 --measure rotd100 --least 0.9

rockflex select folder --target site.csv --count 7 --periods 0.2,2 --records scaled

[bold]Targets[/bold]

ec8:ag=A,ground=A..E,type=1|2,importance=I,damping=ZETA: EN 1998-1:2004, 3.2.2.2. Only ag is needed.

ec8-2024:s_alpha=A,s_beta=A,site=A..D,f_alpha=F,f_beta=F,topography=F,damping=ZETA: EN 1998-1-1:2024, 5.2.2.2, on \
sites A to D or with the factors of the site. Only s_alpha and s_beta are needed.

asce7:sds=A,sd1=A,tl=S,mce=yes|no: ASCE 7-16, 11.4.6; or from the maps: asce7:ss=A,s1=A,site=A..E|default,tl=S.

A file with the columns "period (s), sa (g)".

Accelerations A are written with their unit, such as 0.25g or 2.45m/s2."""

CHOICE, WRITTEN = "Choice", "Results"
_MEASURES: "dict[str, Combination]" = {
    "component": "component",
    "geometric-mean": "geometric mean",
    "rotd50": "rotd50",
    "rotd100": "rotd100",
}


def select(
    names: Annotated[
        list[str],
        typer.Argument(metavar="MOTION", help="Suites, records (suite/name), files or directories to choose from."),
    ],
    target: Annotated[
        str,
        typer.Option("--target", metavar="TARGET", help="ec8:KEY=VALUE,..., asce7:KEY=VALUE,... or a file; see below."),
    ],
    count: Annotated[int, typer.Option("--count", "-n", metavar="N", help="Number of records; of pairs, if combined.")],
    periods: Annotated[
        str,
        typer.Option("--periods", metavar="S,S", help="The ends of the range of periods, or three and more periods."),
    ],
    measure: Annotated[
        Literal["component", "geometric-mean", "rotd50", "rotd100"],
        typer.Option(
            "--measure",
            help="The ordinate of a record: of each component, or of the two of a recording.",
            rich_help_panel=CHOICE,
        ),
    ] = "component",
    limits: Annotated[
        str, typer.Option("--limits", metavar="F,F", help="Smallest and largest factor.", rich_help_panel=CHOICE)
    ] = "0.25,4",
    per_event: Annotated[
        int | None,
        typer.Option("--per-event", metavar="N", help="Most records of one earthquake.", rich_help_panel=CHOICE),
    ] = None,
    per_station: Annotated[
        int | None,
        typer.Option("--per-station", metavar="N", help="Most records at one station.", rich_help_panel=CHOICE),
    ] = None,
    record_weight: Annotated[
        float,
        typer.Option(
            "--record-weight",
            metavar="W",
            help="0: only the misfit of the mean counts; 1: only those of the records.",
            rich_help_panel=CHOICE,
        ),
    ] = 0.0,
    least: Annotated[
        float | None,
        typer.Option(
            "--least",
            metavar="R",
            help="Raise all factors together until the mean is at least R times the target, such as 0.9.",
            rich_help_panel=CHOICE,
        ),
    ] = None,
    damping: Annotated[
        float | None,
        typer.Option("--damping", metavar="ZETA", help="Damping ratio of a target from a file. Default: 0.05."),
    ] = None,
    json: options.Json = False,
    out: options.Out = None,
    records: Annotated[
        Path | None,
        typer.Option("--records", metavar="DIR", help="Write the scaled records to a folder, as CSV files."),
    ] = None,
    force: options.Force = False,
    units: options.Units = None,
    dt: options.Dt = None,
    on_error: options.OnError = "raise",
    vertical: options.Vertical = None,
) -> None:
    """Choose the records whose mean spectrum fits a target best, and scale each by one factor."""
    from rockflex.cli._motions import find_motions
    from rockflex.cli._output import check_folder, to_json, versions
    from rockflex.cli._targets import numbers, parse_target
    from rockflex.motion import Suite

    if out is not None or records is None:
        check_folder(out, force=force)
    if records is not None:
        _check_records(records, out, force=force)
    wanted = parse_target(target, damping)
    low, high = numbers("--limits", limits, 2, 2)
    found = find_motions(names, units, dt, on_error, vertical)
    chosen = Suite(item.motion for item in found).select(
        wanted,
        count,
        numbers("--periods", periods, 1),
        measure=_MEASURES[measure],
        scale_limits=(low, high),
        per_event=per_event,
        per_station=per_station,
        record_weight=record_weight,
        least_ratio=least,
    )
    document: dict[str, Any] = {
        "versions": versions(),
        "options": {
            "measure": measure,
            "scale_limits": [low, high],
            "per_event": per_event,
            "per_station": per_station,
            "record_weight": record_weight,
            "least_ratio": least,
        },
        "target": wanted,
        "units": {"sa": "m/s²", "period": "s", "distance_km": "km", "vs30": "m/s"},
        "records": _records(chosen),
        "motions": [item.describe() for item in found if item.motion.name in chosen.suite],
        "misfit": chosen.misfit,
        "least_ratio": chosen.least_ratio,
        "zero_period_ratio": chosen.zero_period_ratio,
        "spectra": chosen.spectra().to_dict("list"),
    }
    if out is not None:
        _write(out, document, chosen, force=force)
    if records is not None:
        _write_records(records, document, chosen, force=force)
    if json:
        typer.echo(to_json(document))
    else:
        _print(chosen)


def _check_records(folder: Path, out: Path | None, *, force: bool) -> None:
    from rockflex.cli._output import check_folder

    if out is not None and folder.absolute() == out.absolute():
        raise InputError(
            f"--records {folder} is the folder of --out, too. Give it one of its own: every CSV file in it is a record."
        )
    try:
        check_folder(folder, force=force)
    except InputError as error:
        raise InputError(str(error).replace("--out", "--records")) from error


def _records(chosen: "Selection[Any]") -> list[dict[str, Any]]:
    """One row for each record, as in the table, with None for what is not known."""
    table = chosen.table().astype(object)
    return [
        {str(key): value for key, value in row.items()} for row in table.where(table.notna(), None).to_dict("records")
    ]


def _print(chosen: "Selection[Any]") -> None:
    from rockflex.cli._console import grid, number, output, show

    console = output()
    rows = [
        [
            row["record"],
            row["event"] or "-",
            str(row["year"] or "-"),
            "-" if row["magnitude"] is None else f"{row['magnitude']:g}",
            "-" if row["distance_km"] is None else f"{row['distance_km']:g}",
            number(row["factor"]),
            number(row["misfit"], 3),
            f"{row['least_ratio']:.2f} ... {row['largest_ratio']:.2f}",
        ]
        for row in _records(chosen)
    ]
    show(console, grid(("record", "event", "year", "M", "R [km]", "factor", "misfit", "Sa/target"), rows, 2))
    target = chosen.target
    lines = [
        f"\nTarget: {target.name}, damping {target.damping_ratio:g}, {chosen.periods[0]:g} to {chosen.periods[-1]:g} s",
        f"Mean: misfit {number(chosen.misfit, 3)}, at least {chosen.least_ratio:.3f} of the target",
    ]
    if len(chosen.names) > 1:
        spread = chosen.dispersion
        lines.append(f"Standard deviation of ln Sa: {spread.min():.2f} to {spread.max():.2f}")
    if target.periods[0] == 0.0:
        lines.append(f"At a period of zero the mean is {chosen.zero_period_ratio:.3f} of the target")
    console.print("\n".join(lines), markup=False, soft_wrap=True)


def _write(folder: Path, document: dict[str, Any], chosen: "Selection[Any]", *, force: bool) -> None:
    from rockflex.cli._console import note
    from rockflex.cli._output import staged
    from rockflex.plot import plot_selection, save_figure

    with staged(folder, document, force=force) as stage:
        chosen.table().to_csv(stage / "selection.csv", index=False, lineterminator="\n")
        chosen.spectra().to_csv(stage / "spectra.csv", index=False, lineterminator="\n")
        save_figure(plot_selection(chosen), stage / "selection.png")
    note(f"Written to {folder}")


def _write_records(folder: Path, document: dict[str, Any], chosen: "Selection[Any]", *, force: bool) -> None:
    from rockflex.cli._console import note
    from rockflex.cli._output import file_stems, staged
    from rockflex.motion import record_csv

    with staged(folder, document, force=force) as stage:
        for stem, motion in zip(file_stems(motion.name for motion in chosen.suite), chosen.suite, strict=True):
            (stage / f"{stem}.csv").write_text(record_csv(motion), "utf-8", newline="\n")
    note(f"{counted(len(chosen.suite), 'scaled record')} written to {folder}")
