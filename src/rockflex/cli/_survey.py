"""``rockflex survey``: the records in a folder, and which of them are taken."""

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rockflex._errors import InputError
from rockflex._shown import number_with_noun
from rockflex.cli import _options as options
from rockflex.cli._console import console_table, number_for_console, print_console_table, stdout_console
from rockflex.cli._output import document_to_json, versions_in_results

if TYPE_CHECKING:
    from rockflex.motion import RecordSurvey, SurveyEntry

EPILOG = """[bold]Examples[/bold]

rockflex survey records

rockflex survey records --vertical pair --json

rockflex survey *.AT2 flatfile.csv"""

MAX_NAMED_FILES = 6  # files that share a reason and are named; of more, the number is told


def survey(
    paths: Annotated[
        list[Path], typer.Argument(metavar="FOLDER|FILES", help="A folder of records, or files.", show_default=False)
    ],
    json: options.Json = False,
    units: options.Units = None,
    dt: options.Dt = None,
    vertical: Annotated[
        str | None,
        typer.Option(
            "--vertical",
            metavar="pair",
            help="pair: take the vertical component of each station too.",
            rich_help_panel=options.RECORD_FILES,
        ),
    ] = None,
) -> None:
    """Say of each record file what it holds, whether it is taken, and why not."""
    from rockflex.motion import survey_records

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
            "versions": versions_in_results(),
            "units": {"dt": "s", "pga": "m/s²", "stated_pga": "m/s²", "distance_km": "km", "vs30": "m/s"},
            "entries": found.entries,
            "stations": stations,
        }
        typer.echo(document_to_json(document))
    else:
        _print_record_survey(found)


def _print_record_survey(found: "RecordSurvey") -> None:
    from rockflex._constants import GRAVITY

    def cells(entry: "SurveyEntry") -> list[str]:
        words = [entry.file, entry.format, entry.station, entry.component]
        facts = [entry.magnitude, entry.distance_km, entry.vs30]
        samples = ["-" if value is None else f"{value:g}" for value in (entry.dt, entry.n_samples)]
        peak = "-" if entry.pga is None else number_for_console(entry.pga / GRAVITY)
        return [
            *(word or "-" for word in words),
            "yes" if entry.taken else "no",
            *samples,
            peak,
            *("-" if fact is None else f"{fact:g}" for fact in facts),
        ]

    console = stdout_console()
    head = ("file", "format", "station", "component", "taken", "dt [s]", "npts", "PGA [g]", "M", "R [km]", "Vs30 [m/s]")
    print_console_table(console, console_table(head, map(cells, found.entries), 5))
    taken, left = len(found.taken), len(found.left_out)
    print_line = f"\n{taken} taken, {left} left out; {_station_count_text(found)}"
    console.print(print_line, markup=False, soft_wrap=True)
    for title, entries in (("Left out", found.left_out), ("Taken, but", [each for each in found.taken if each.reason])):
        if entries:
            console.print(f"\n{title}:", markup=False)
        for reason, names in _files_by_survey_reason(entries).items():
            console.print(f"  {_named_files_text(names)}: {reason}", markup=False, soft_wrap=True)


def _station_count_text(found: "RecordSurvey") -> str:
    pairs = [len(each.horizontal) == 2 for each in found.stations]
    upright = [each.vertical is not None for each in found.stations]
    both = sum(pair and vertical for pair, vertical in zip(pairs, upright, strict=True))
    return (
        f"{number_with_noun(len(pairs), 'recording')}: {sum(pairs)} with a horizontal pair, {sum(upright)} with a "
        f"vertical component, {both} with both"
    )


def _files_by_survey_reason(entries: "Iterable[SurveyEntry]") -> dict[str, list[str]]:
    found: dict[str, list[str]] = {}
    for entry in entries:
        names = found.setdefault(entry.reason, [])
        if entry.file not in names:
            names.append(entry.file)
    return found


def _named_files_text(names: list[str]) -> str:
    more = f" and {len(names) - MAX_NAMED_FILES} more" if len(names) > MAX_NAMED_FILES else ""
    return ", ".join(names[:MAX_NAMED_FILES]) + more
