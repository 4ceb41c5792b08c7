"""``rockflex motion``: the contents and measures of records and suites."""

from collections.abc import Sequence
from textwrap import fill
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rockflex._shown import number_with_noun
from rockflex.cli import _options as options
from rockflex.cli._console import (
    console_table,
    number_for_console,
    print_console_table,
    print_remark,
    stdout_console,
    table_fits_console,
)
from rockflex.cli._output import (
    check_output_folder,
    document_to_json,
    file_stems,
    staged_output_folder,
    versions_in_results,
)

if TYPE_CHECKING:
    from pathlib import Path

    from rich.table import Table

    from rockflex.cli._find_motions import FoundMotion

EPILOG = """[bold]Examples[/bold]

rockflex motion

rockflex motion fema-p695-far-field --period 0.5 --period 1 --damping 0.02

rockflex motion fema-p695-far-field/FF-12-a --out record

rockflex motion RSN6-180.AT2 --vertical RSN6-UP.AT2

rockflex motion folder --vertical pair

rockflex motion record.csv --units g --dt 0.01 --json"""

PLAIN = str.maketrans("₀₁₂₃₄₅₆₇₈₉₋", "0123456789-")  # a terminal may lack subscripts


def motion(
    names: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="MOTION",
            help="Suites, records (suite/name), files or directories. Without any: list the embedded suites.",
            show_default=False,
        ),
    ] = None,
    period: Annotated[
        list[float] | None,
        typer.Option(
            "--period", metavar="S", help="Period of Sa in s; may be repeated. Default: 1.", show_default=False
        ),
    ] = None,
    damping: Annotated[float, typer.Option("--damping", metavar="ZETA", help="Damping ratio of Sa.")] = 0.05,
    json: options.Json = False,
    out: options.Out = None,
    figures: options.Figures = 4,
    force: options.Force = False,
    units: options.Units = None,
    dt: options.Dt = None,
    on_error: options.OnError = "raise",
    vertical: options.Vertical = None,
) -> None:
    """Print the data and the intensity measures of ground motions; without a name, list the embedded suites."""
    from rockflex.cli._find_motions import embedded_suite_facts, find_motions

    check_output_folder(out, force=force)
    # With a folder or a unit, motions are expected, and an empty list of names is an error.
    about_files = units is not None or dt is not None or vertical is not None or on_error != "raise"
    if not names and out is None and period is None and not about_files:
        suites = embedded_suite_facts()
        if json:
            typer.echo(document_to_json({"versions": versions_in_results(), "suites": suites}))
        else:
            _print_embedded_suites(suites)
        return
    found = find_motions(names or [], units, dt, on_error, vertical)
    periods = list(dict.fromkeys(period or [1.0]))
    rows = [{**item.describe(), **_measures_of_motion(item, periods, damping)} for item in found]
    document: dict[str, Any] = {
        "versions": versions_in_results(),
        "options": {"periods": periods, "damping_ratio": damping},
        "units": _units_of_measures(),
        "motions": rows,
    }
    if out is not None:
        _write_motion_measures(out, document, found, figures, force=force)
    if json:
        typer.echo(document_to_json(document))
    else:
        _print_motion_measures(rows, periods, damping)


def _units_of_measures() -> dict[str, str]:
    from rockflex.motion import record_measures, vertical_measures

    return {
        "dt": "s",
        "duration": "s",
        **{measure.name: measure.unit for measure in (*record_measures(), *vertical_measures())},
        "sa_*": "m/s², at the period in s",
        "sa_vertical_*": "m/s², at the period in s",
        "v_h_*": "",
        "metadata.distance_km": "km",
        "metadata.distance_jb_km": "km",
        "metadata.epicentral_km": "km",
        "metadata.vs30": "m/s",
        "metadata.azimuth": "degrees from north",
        "metadata.stated_pga": "m/s²",
    }


def _measures_of_motion(item: "FoundMotion", periods: Sequence[float], damping: float) -> dict[str, float]:
    from rockflex.motion import MeasureInput, record_measures, vertical_measures

    motion, shaking = item.motion, MeasureInput(item.motion)
    spectral = {"sa": motion.spectrum(periods, damping).sa}
    measures = record_measures()
    if motion.vertical is not None:
        measures += vertical_measures()
        spectral["sa_vertical"] = motion.vertical_motion.spectrum(periods, damping).sa
        spectral["v_h"] = motion.vertical_ratio(periods, damping)
    at_periods = {
        f"{name}_{period:g}": float(value)
        for name, values in spectral.items()
        for period, value in zip(periods, values, strict=True)
    }
    return {**{measure.name: measure.of(shaking) for measure in measures}, **at_periods}


def _print_embedded_suites(suites: Sequence[dict[str, Any]]) -> None:

    console = stdout_console()
    spans = [" ... ".join(dict.fromkeys((row["first"], row["last"]))) for row in suites]
    rows = [[row["suite"], span, str(row["motions"])] for row, span in zip(suites, spans, strict=True)]
    print_console_table(console, console_table(("suite", "records", "motions"), rows, 2))
    console.print("\nDetails: rockflex motion SUITE, or SUITE/RECORD", markup=False, soft_wrap=True)


def _print_motion_measures(rows: Sequence[dict[str, Any]], periods: Sequence[float], damping: float) -> None:
    from rockflex._constants import GRAVITY
    from rockflex.motion import record_measures

    console = stdout_console()
    chosen = [(measure, measure.unit == "m/s²") for measure in record_measures()]
    records: list[list[str]] = []
    measures: list[list[str]] = []
    for row in rows:
        info = row["metadata"]
        facts = [None, None, None] if info is None else [info.magnitude, info.distance_km, info.vs30]
        words = ["-", "-"] if info is None else [info.event or "-", str(info.year or "-")]
        samples = [f"{row['dt']:g}", str(row["npts"]), number_for_console(row["duration"])]
        records.append([row["name"], *words, *("-" if fact is None else f"{fact:g}" for fact in facts), *samples])
        spectral = [number_for_console(row[f"sa_{period:g}"] / GRAVITY) for period in periods]
        own = [number_for_console(row[measure.name] / (GRAVITY if in_g else 1.0)) for measure, in_g in chosen]
        measures.append([row["name"], *own, *spectral])
    head = ("name", "event", "year", "M", "R [km]", "Vs30 [m/s]", "dt [s]", "npts", "length [s]")
    table = console_table(head, records, 2)
    if not table_fits_console(console, table):
        table = console_table(head, [[name, fill(event, 12), *rest] for name, event, *rest in records], 2)
    print_console_table(console, table)
    console.print()
    heads = [f"{measure.head} [g]" if in_g else measure.with_unit(measure.head) for measure, in_g in chosen]
    spectral = (f"Sa({period:g} s) [g]" for period in periods)
    print_console_table(
        console, console_table(("name", *(head.translate(PLAIN) for head in heads), *spectral), measures)
    )
    if any("pva" in row for row in rows):
        console.print("\nVertical component", markup=False)
        print_console_table(console, _vertical_measures_table(rows, periods))
    console.print(f"\nSa: pseudo-acceleration with {damping:g} damping; g = {GRAVITY} m/s²", markup=False)


def _vertical_measures_table(rows: Sequence[dict[str, Any]], periods: Sequence[float]) -> "Table":
    from rockflex._constants import GRAVITY

    cells: list[list[str]] = []
    for row in rows:
        keys = [("pva", GRAVITY), ("pva_pga", 1.0)]
        for period in periods:
            keys += [(f"sa_vertical_{period:g}", GRAVITY), (f"v_h_{period:g}", 1.0)]
        cells.append([row["name"], *(number_for_console(row[key] / unit) if key in row else "-" for key, unit in keys)])
    spectral = [head for period in periods for head in (f"Sa,v({period:g} s) [g]", f"V/H({period:g} s)")]
    return console_table(("name", "PVA [g]", "PVA/PGA", *spectral), cells)


def _write_motion_measures(
    folder: "Path", document: dict[str, Any], found: Sequence["FoundMotion"], figures: int, *, force: bool
) -> None:
    from dataclasses import asdict

    import pandas as pd

    few = len(found) <= figures
    with staged_output_folder(folder, document, force=force) as stage:
        rows = [
            {**row, "metadata": None} | (asdict(row["metadata"]) if row["metadata"] else {})
            for row in document["motions"]
        ]
        table = pd.DataFrame(rows).drop(columns="metadata")
        table.to_csv(stage / "motions.csv", index=False, lineterminator="\n")
        if few:
            from rockflex.plot import plot_motion, save_figure

            for stem, item in zip(file_stems(f"motion-{item.motion.name}" for item in found), found, strict=True):
                series = {
                    name: getattr(item.motion, name) for name in ("time", "acceleration", "velocity", "displacement")
                }
                if item.motion.vertical is not None:
                    series["vertical"] = item.motion.vertical
                pd.DataFrame(series).to_csv(stage / f"{stem}.csv", index=False, lineterminator="\n")
                save_figure(plot_motion(item.motion), stage / f"{stem}.png")
    print_remark(
        f"Written to {folder}"
        + ("" if few else f"; series and figures only of up to {number_with_noun(figures, 'motion')}, by --figures")
    )
