"""``rockflex motion``: contents and measures of records and suites; ``rockflex survey``: the records in a folder."""

import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rockflex.cli import _console as console
from rockflex.cli import _options as options
from rockflex.cli import _output as output
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import few_texts_shown, first_texts_shown, number_with_noun

if TYPE_CHECKING:
    from rockflex.cli._find_motions import FoundMotion
    from rockflex.motion._findings import Finding
    from rockflex.motion._record_info import RecordInfo
    from rockflex.motion._survey import RecordSurvey, SurveyEntry

EPILOG = """[bold]Examples[/bold]

rockflex motion

rockflex motion fema-p695-far-field --period 0.5 --period 1 --damping 0.02

rockflex motion fema-p695-far-field/FF-12-a --out record

rockflex motion RSN6-180.AT2 --vertical RSN6-UP.AT2

rockflex motion folder --vertical pair

rockflex motion record.csv --units g --dt 0.01 --json"""

MAX_FOUND = 8  # kinds of files whose findings are printed
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
        options.option("--period", "S", "Period of Sa in s; may be repeated. Default: 1.", show_default=False),
    ] = None,
    damping: Annotated[float, options.option("--damping", "ZETA", "Damping ratio of Sa.")] = 0.05,
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

    output.check_output_folder(out, force=force)
    # With a folder or a unit, motions are expected, and an empty list of names is an error.
    about_files = units is not None or dt is not None or vertical is not None or on_error != "raise"
    if not names and out is None and period is None and not about_files:
        suites = embedded_suite_facts()
        if json:
            typer.echo(output.to_json({"versions": output.versions(), "suites": suites}))
        else:
            _print_embedded_suites(suites)
        return
    found = find_motions(names or [], units, dt, on_error, vertical)
    periods = list(dict.fromkeys(period or [1.0]))
    rows = [{**item.describe(), **_measures_of_motion(item, periods, damping)} for item in found]
    document: dict[str, Any] = {
        "versions": output.versions(),
        "options": {"periods": periods, "damping_ratio": damping},
        "units": _units_of_measures(),
        "motions": rows,
    }
    if out is not None:
        _write_motion_measures(out, document, found, figures, force=force)
    if json:
        typer.echo(output.to_json(document))
    else:
        _print_motion_measures(rows, periods, damping)
        _print_findings(found)


def _units_of_measures() -> dict[str, str]:
    from rockflex.motion._measures import record_measures, vertical_measures

    return {
        "dt": "s",
        "duration": "s",
        **{measure.name: measure.unit for measure in (*record_measures(), *vertical_measures())},
        "sa_*": "m/s², at the period in s",
        "sa_avg_*": "m/s², from 0.2 to 3 times the period in s",
        "fiv3_*": "m/s, for the period in s",
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
    from rockflex.motion._measures import MeasureInput, record_measures, vertical_measures

    motion, shaking = item.motion, MeasureInput(item.motion)
    spectral: dict[str, Iterable[float]] = {
        "sa": motion.spectrum(periods, damping).sa,
        "sa_avg": (motion.sa_avg(period, damping) if period else math.nan for period in periods),
        "fiv3": (motion.fiv3(period) if period else math.nan for period in periods),
    }
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
    spans = [" ... ".join(dict.fromkeys((row["first"], row["last"]))) for row in suites]
    rows = [[row["suite"], span, str(row["motions"])] for row, span in zip(suites, spans, strict=True)]
    console.print_rows(("suite", "records", "motions"), rows, 2)
    console.print_line("\nDetails: rockflex motion SUITE, or SUITE/RECORD")


def _print_motion_measures(rows: Sequence[dict[str, Any]], periods: Sequence[float], damping: float) -> None:
    from rockflex.foundation.constants import GRAVITY
    from rockflex.motion._measures import record_measures

    chosen = [(measure, measure.unit == "m/s²") for measure in record_measures()]
    records: list[list[str]] = []
    measures: list[list[str]] = []
    for row in rows:
        info = row["metadata"]
        facts = [None, None, None] if info is None else [info.magnitude, info.distance_km, info.vs30]
        words = ["-", "-"] if info is None else [info.event or "-", str(info.year or "-")]
        samples = [f"{row['dt']:g}", str(row["npts"]), console.number(row["duration"])]
        records.append([row["name"], *words, *("-" if fact is None else f"{fact:g}" for fact in facts), *samples])
        spectral = [console.number(row[f"sa_{period:g}"] / GRAVITY) for period in periods]
        own = [console.number(row[measure.name] / (GRAVITY if in_g else 1.0)) for measure, in_g in chosen]
        measures.append([row["name"], *own, *spectral])
    head = ("name", "event", "year", "M", "R [km]", "Vs30 [m/s]", "dt [s]", "npts", "length [s]")
    table = console.table(head, records, 2)
    if not console.table_fits(table):
        table = console.table(head, [[name, fill(event, 12), *rest] for name, event, *rest in records], 2)
    console.print_table(table)
    console.print_line()
    heads = [f"{measure.head} [g]" if in_g else measure.with_unit(measure.head) for measure, in_g in chosen]
    spectral = (f"Sa({period:g} s) [g]" for period in periods)
    console.print_rows(("name", *(head.translate(PLAIN) for head in heads), *spectral), measures)
    if any("pva" in row for row in rows):
        console.print_line("\nVertical component")
        _print_vertical_measures(rows, periods)
    console.print_line(f"\nSa: pseudo-acceleration with {damping:g} damping; g = {GRAVITY} m/s²")


def _print_findings(found: Sequence["FoundMotion"]) -> None:
    """Print what the readers of files found, and where; motions of which the same was found share their lines."""
    names: dict[tuple[Finding, ...], list[str]] = {}
    for item in found:
        info = item.motion.metadata
        if info is not None and info.findings:
            names.setdefault(info.findings, []).append(item.motion.name)
    for findings, of in list(names.items())[:MAX_FOUND]:
        console.print_line(f"\n{few_texts_shown(of)}, as read:")
        console.print_rows(("what", "value", "by"), [[each.what, each.value, each.evidence] for each in findings], 3)
    if len(names) > MAX_FOUND:
        console.print_line(f"\nWhat was found in the other {len(names) - MAX_FOUND} kinds of files: --json")


def _print_vertical_measures(rows: Sequence[dict[str, Any]], periods: Sequence[float]) -> None:
    from rockflex.foundation.constants import GRAVITY

    cells: list[list[str]] = []
    for row in rows:
        keys = [("pva", GRAVITY), ("pva_pga", 1.0)]
        for period in periods:
            keys += [(f"sa_vertical_{period:g}", GRAVITY), (f"v_h_{period:g}", 1.0)]
        cells.append([row["name"], *(console.number(row[key] / unit) if key in row else "-" for key, unit in keys)])
    spectral = [head for period in periods for head in (f"Sa,v({period:g} s) [g]", f"V/H({period:g} s)")]
    console.print_rows(("name", "PVA [g]", "PVA/PGA", *spectral), cells)


def _facts(info: "RecordInfo") -> dict[str, Any]:
    """Return the metadata of a record for a row of a table."""
    from dataclasses import asdict

    return asdict(info) | {"findings": "; ".join(map(str, info.findings))}


def _write_motion_measures(
    folder: Path, document: dict[str, Any], found: Sequence["FoundMotion"], figures: int, *, force: bool
) -> None:
    import pandas as pd

    few = len(found) <= figures
    with output.staged_output_folder(folder, document, force=force) as stage:
        rows = [
            {**row, "metadata": None} | (_facts(row["metadata"]) if row["metadata"] else {})
            for row in document["motions"]
        ]
        table = pd.DataFrame(rows).drop(columns="metadata")
        output.write_table(table, stage / "motions.csv")
        if few:
            from rockflex.plot._figures import save_figure
            from rockflex.plot._motion import plot_motion

            for stem, item in zip(
                output.output_file_stems(f"motion-{item.motion.name}" for item in found), found, strict=True
            ):
                series = {
                    name: getattr(item.motion, name) for name in ("time", "acceleration", "velocity", "displacement")
                }
                if item.motion.vertical is not None:
                    series["vertical"] = item.motion.vertical
                pd.DataFrame(series).to_csv(stage / f"{stem}.csv", index=False, lineterminator="\n")
                save_figure(plot_motion(item.motion), stage / f"{stem}.png")
    console.print_remark(
        f"Written to {folder}"
        + ("" if few else f"; series and figures only of up to {number_with_noun(figures, 'motion')}, by --figures")
    )


SURVEY_EPILOG = """[bold]Examples[/bold]

rockflex survey records

rockflex survey records --vertical pair --json

rockflex survey *.AT2 flatfile.csv"""

MAX_NAMED_FILES = 6  # files that share a reason and are named; of more, the number is told
MAX_FINDINGS = 8  # of one kind, such as time steps, that are told


def survey(
    paths: Annotated[
        list[Path], typer.Argument(metavar="FOLDER|FILES", help="A folder of records, or files.", show_default=False)
    ],
    json: options.Json = False,
    units: options.Units = None,
    dt: options.Dt = None,
    vertical: Annotated[
        str | None,
        options.option(
            "--vertical",
            "pair",
            "pair: take the vertical component of each station too.",
            rich_help_panel=options.RECORD_FILES,
        ),
    ] = None,
) -> None:
    """Say of each record file what it holds, whether it is taken, and why not."""
    from rockflex.motion._survey import survey_records

    folders = [path for path in paths if path.is_dir()]
    if folders and len(paths) > 1:
        raise InputError(
            f"One folder or several files are expected, but {folders[0]} is a folder among {len(paths)} paths. Survey "
            "one folder at a time."
        )
    single = len(paths) == 1 and not paths[0].is_file()
    found = survey_records(paths[0] if single else paths, units, dt, vertical, None)  # pyright: ignore[reportArgumentType]
    if json:
        stations = [
            {
                "name": each.name,
                "horizontal": [motion.name for motion in each.horizontal],
                "vertical": None if each.vertical is None else each.vertical.name,
            }
            for each in found.stations
        ]
        document: dict[str, Any] = {
            "versions": output.versions(),
            "units": {"dt": "s", "pga": "m/s²", "stated_pga": "m/s²", "distance_km": "km", "vs30": "m/s"},
            "entries": found.entries,
            "stations": stations,
        }
        typer.echo(output.to_json(document))
    else:
        _print_record_survey(found)


def _print_record_survey(found: "RecordSurvey") -> None:
    from rockflex.foundation.constants import GRAVITY

    def cells(entry: "SurveyEntry") -> list[str]:
        unit = next((each.value for each in entry.findings if each.what == "unit"), None)
        words = [entry.file, entry.format, entry.station, entry.component, unit]
        facts = [entry.magnitude, entry.distance_km, entry.vs30]
        samples = ["-" if value is None else f"{value:g}" for value in (entry.dt, entry.n_samples)]
        peak = "-" if entry.pga is None else console.number(entry.pga / GRAVITY)
        return [
            *(word or "-" for word in words),
            "yes" if entry.taken else "no",
            *samples,
            peak,
            *("-" if fact is None else f"{fact:g}" for fact in facts),
        ]

    head = ("file", "format", "station", "component", "unit", "taken", "dt [s]", "npts", "PGA [g]")
    console.print_rows((*head, "M", "R [km]", "Vs30 [m/s]"), map(cells, found.entries), 6)
    taken, left = len(found.taken), len(found.left_out)
    console.print_line(f"\n{taken} taken, {left} left out; {_station_count_text(found)}")
    for title, entries in (("Left out", found.left_out), ("Taken, but", [each for each in found.taken if each.reason])):
        if entries:
            console.print_line(f"\n{title}:")
        for reason in dict.fromkeys(entry.reason for entry in entries):
            names = list(dict.fromkeys(entry.file for entry in entries if entry.reason == reason))
            console.print_line(f"  {first_texts_shown(names, MAX_NAMED_FILES)}: {reason}")
    if found.findings:
        console.print_line("\nAs read:")
        console.print_rows(("what", "value", "by", "files"), _rows_of_findings(found), 4)


def _rows_of_findings(found: "RecordSurvey") -> list[list[str]]:
    """Return what the readers found, each with the files that share it; of many that differ, the first ones."""
    read = len({entry.file for entry in found.entries if entry.findings})
    rows: list[list[str]] = []
    for kind in dict.fromkeys(each.what for each in found.findings):
        shared = [(each, names) for each, names in found.findings.items() if each.what == kind]
        for each, names in shared[:MAX_FINDINGS]:
            whole = len(names) == read > 1
            files = f"all {read}" if whole else first_texts_shown(names, MAX_NAMED_FILES)
            rows.append([kind, each.value, each.evidence, files])
        if len(shared) > MAX_FINDINGS:
            rows.append([kind, f"{len(shared) - MAX_FINDINGS} more: --json", "", ""])
    return rows


def _station_count_text(found: "RecordSurvey") -> str:
    pairs = [len(each.horizontal) == 2 for each in found.stations]
    upright = [each.vertical is not None for each in found.stations]
    both = sum(pair and vertical for pair, vertical in zip(pairs, upright, strict=True))
    return (
        f"{number_with_noun(len(pairs), 'recording')}: {sum(pairs)} with a horizontal pair, {sum(upright)} with a "
        f"vertical component, {both} with both"
    )
