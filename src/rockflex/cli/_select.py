"""``rockflex select``: records chosen and scaled for a target spectrum."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from rockflex.cli import _console as console
from rockflex.cli import _options as options
from rockflex.cli import _output as output
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import number_with_noun, shown

if TYPE_CHECKING:
    from rockflex.motion._recordings import Combination
    from rockflex.motion._spectra import TargetSpectrum
    from rockflex.motion._suite import Selection


WORDS = {"yes": True, "no": False}


def parse_target_spectrum(text: str, damping: float | None) -> "TargetSpectrum":
    """Return the target of ``ec8:ag=0.25g,ground=C``, ``ec8-2024:...``, ``asce7:...``, ``cs:...`` or of a file.

    `damping` is the damping ratio of a target from a file; None means 5 %.
    """
    from rockflex.motion._target_files import read_conditional_spectrum, read_target
    from rockflex.motion._targets import asce7_site_spectrum, asce7_spectrum, ec8_second_spectrum, ec8_spectrum

    code, colon, rest = text.partition(":")
    if not colon or code not in ("ec8", "ec8-2024", "asce7", "cs"):
        if not Path(text).exists():
            raise InputError(
                f"--target {shown(text)} is neither a file nor a code. Write ec8:ag=0.25g,ground=C, or "
                "ec8-2024:s_alpha=0.6g,s_beta=0.2g,site=C, or asce7:sds=1g,sd1=0.6g,tl=8, or "
                "asce7:ss=1.5g,s1=0.6g,site=D,tl=8, or cs:file=model.csv,period=1,epsilon=1.5, "
                'or name a file with the columns "period (s), sa (g)".'
            )
        return read_target(text, damping_ratio=0.05 if damping is None else damping)
    if damping is not None:
        raise InputError(
            "--damping is for a target from a file. Write ec8:...,damping=0.02; ASCE 7 has 5 %: leave --damping out."
        )
    items = _target_flag_items(code, rest)
    if code == "cs":
        given = _read_target_items(code, items, "file period", "sa epsilon damping")
        return read_conditional_spectrum(given.pop("file"), **given)
    if code == "ec8":
        return ec8_spectrum(**_read_target_items(code, items, "ag", "ground type importance damping"))
    if code == "ec8-2024":
        given = _read_target_items(code, items, "s_alpha s_beta", "site f_alpha f_beta topography damping")
        factors = [given.pop(key, None) for key in ("f_alpha", "f_beta")]
        if (factors[0] is None) != (factors[1] is None):
            raise InputError(f"--target {code}:...: give both f_alpha and f_beta, or neither.")
        return ec8_second_spectrum(**given, amplification=None if factors[0] is None else tuple(factors))
    if "ss" in items or "s1" in items or "site" in items:
        return asce7_site_spectrum(**_read_target_items(code, items, "ss s1 site tl", "mce"))
    return asce7_spectrum(**_read_target_items(code, items, "sds sd1 tl", "mce"))


def parse_comma_separated_numbers(flag: str, text: str, least: int, most: int | None = None) -> list[float]:
    """Return numbers separated by commas."""
    values = [_target_flag_number(flag, part.strip()) for part in text.split(",")]
    if len(values) < least or (most is not None and len(values) > most):
        count = f"{least}" if most == least else f"at least {least}"
        raise InputError(f"{flag} needs {count} numbers separated by commas, but {shown(text)} was given.")
    return values


def _target_flag_items(code: str, rest: str) -> dict[str, str]:
    items: dict[str, str] = {}
    for part in filter(None, (part.strip() for part in rest.split(","))):
        key, equals, value = (each.strip() for each in part.partition("="))
        if not equals or not value or key in items:
            reason = "occurs twice" if key in items else "has no value"
            raise InputError(
                f"--target {code}:...: {shown(key)} {reason}. Write each key once, as in {code}:key=value,..."
            )
        items[key] = value
    return items


def _read_target_items(code: str, items: dict[str, str], needed: str, optional: str) -> dict[str, Any]:
    """Return the values of the items of a code by argument; blanks separate the keys that it needs and may have."""
    known = [*needed.split(), *optional.split()]
    unknown, missing = [key for key in items if key not in known], [key for key in needed.split() if key not in items]
    if unknown or missing:
        what = f"{shown(unknown[0])} is not known" if unknown else f"{missing[0]} is missing"
        raise InputError(
            f"--target {code}:...: {what}. The keys are {', '.join(needed.split())}, and "
            f"{', '.join(optional.split())} if wanted."
        )
    values = (
        (key, READERS.get(key, _target_flag_number)(f"--target {code}: {key}", text)) for key, text in items.items()
    )
    return {ARGUMENTS.get(key, key): value for key, value in values}


def _target_flag_acceleration(name: str, text: str) -> float:
    from rockflex.motion._units import UNITS, acceleration_in_text

    value = acceleration_in_text(text)
    if value is None:
        raise InputError(
            f"{name} must be a number with its unit, such as 0.25g or 2.45m/s2, but {shown(text)} was given. The units "
            f"are {', '.join(UNITS)}."
        )
    return value


def _target_flag_number(name: str, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InputError(f"{name} must be a number, but {shown(text)} was given.") from None


def _target_flag_yes_or_no(name: str, text: str) -> bool:
    if text not in WORDS:
        raise InputError(f"{name} must be yes or no, but {shown(text)} was given.")
    return WORDS[text]


ARGUMENTS = {"type": "kind", "damping": "damping_ratio"}  # of the functions, where they are not the keys
READERS: dict[str, Callable[[str, str], Any]] = {  # of the keys that are not plain numbers
    **dict.fromkeys(("ag", "s_alpha", "s_beta", "ss", "s1", "sds", "sd1", "sa"), _target_flag_acceleration),
    **dict.fromkeys(("ground", "site", "file"), lambda _, text: text),
    "mce": _target_flag_yes_or_no,
}


EPILOG = """[bold]Examples[/bold]

rockflex select fema-p695-far-field --target ec8:ag=0.25g,ground=C --count 7 --periods 0.2,2 --out choice

rockflex select folder --target ec8:ag=2.5m/s2,ground=B,type=2,importance=1.2 -n 7 --periods 0.1,1 --per-event 1

rockflex select folder --target asce7:sds=1g,sd1=0.6g,tl=8 -n 11 --periods 0.2,2 --measure rotd100 --least 0.9

rockflex select folder --target cs:file=model.csv,period=1,sa=0.5g -n 30 --periods 0.1,3 --limits 0.25,5 --per-event 3

rockflex select folder --target site.csv --count 7 --periods 0.2,2 --records scaled

[bold]Targets[/bold]

ec8:ag=A,ground=A..E,type=1|2,importance=I,damping=ZETA: EN 1998-1:2004, 3.2.2.2. Only ag is needed.

ec8-2024:s_alpha=A,s_beta=A,site=A..D,f_alpha=F,f_beta=F,topography=F,damping=ZETA: EN 1998-1-1:2024, 5.2.2.2, on \
sites A to D or with the factors of the site. Only s_alpha and s_beta are needed.

asce7:sds=A,sd1=A,tl=S,mce=yes|no: ASCE 7-16, 11.4.6; or from the maps: asce7:ss=A,s1=A,site=A..E|default,tl=S.

cs:file=PATH,period=S,sa=A,epsilon=E,damping=ZETA: the conditional spectrum of a file with the columns "period (s), \
median (g), sigma", given sa or epsilon at the period.

A file with the columns "period (s), sa (g)".

Accelerations A are written with their unit, such as 0.25g or 2.45m/s2."""

_choice = partial(options.option, rich_help_panel="Choice")
FLAGS = {
    "n": "--count",
    "periods": "--periods",
    "scale_limits": "--limits",
    "per_event": "--per-event",
    "per_station": "--per-station",
    "record_weight": "--record-weight",
    "least_ratio": "--least",
}
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
        str, options.option("--target", "TARGET", "ec8:KEY=VALUE,..., asce7:..., cs:... or a file; see below.")
    ],
    count: Annotated[int, options.option("--count -n", "N", "Number of records; of pairs, if combined.")],
    periods: Annotated[
        str, options.option("--periods", "S,S", "The ends of the range of periods, or three and more periods.")
    ],
    measure: Annotated[
        Literal["component", "geometric-mean", "rotd50", "rotd100"],
        typer.Option(
            "--measure",
            help="The ordinate of a record: of each component, or of the two of a recording.",
            rich_help_panel="Choice",
        ),
    ] = "component",
    limits: Annotated[str, _choice("--limits", "F,F", "Smallest and largest factor.")] = "0.25,4",
    per_event: Annotated[int | None, _choice("--per-event", "N", "Most records of one earthquake.")] = None,
    per_station: Annotated[int | None, _choice("--per-station", "N", "Most records at one station.")] = None,
    record_weight: Annotated[
        float, _choice("--record-weight", "W", "0: only the misfit of the mean counts; 1: only those of the records.")
    ] = 0.0,
    least: Annotated[
        float | None,
        _choice(
            "--least", "R", "Raise all factors together until the mean is at least R times the target, such as 0.9."
        ),
    ] = None,
    damping: Annotated[
        float | None, options.option("--damping", "ZETA", "Damping ratio of a target from a file. Default: 0.05.")
    ] = None,
    json: options.Json = False,
    out: options.Out = None,
    records: Annotated[
        Path | None, options.option("--records", "DIR", "Write the scaled records to a folder, as CSV files.")
    ] = None,
    force: options.Force = False,
    units: options.Units = None,
    dt: options.Dt = None,
    on_error: options.OnError = "raise",
    vertical: options.Vertical = None,
) -> None:
    """Choose the records whose spectra fit a target best, in their mean or their mean and spread, and scale each."""
    from rockflex.cli._find_motions import find_motions
    from rockflex.motion._suite import Suite

    if out is not None or records is None:
        output.check_output_folder(out, force=force)
    if records is not None:
        _check_selected_records_folder(records, out, force=force)
    wanted = parse_target_spectrum(target, damping)
    low, high = parse_comma_separated_numbers("--limits", limits, 2, 2)
    found = find_motions(names, units, dt, on_error, vertical)
    with options.naming_flags_in_errors(FLAGS):
        chosen = Suite(item.motion for item in found).select(
            wanted,
            count,
            parse_comma_separated_numbers("--periods", periods, 1),
            measure=_MEASURES[measure],
            scale_limits=(low, high),
            per_event=per_event,
            per_station=per_station,
            record_weight=record_weight,
            least_ratio=least,
        )
    document: dict[str, Any] = {
        "versions": output.versions(),
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
        "records": _selected_record_rows(chosen),
        "motions": [item.describe() for item in found if item.motion.name in chosen.suite],
        "misfit": chosen.misfit,
        "spread_misfit": chosen.spread_misfit,
        "least_ratio": chosen.least_ratio,
        "zero_period_ratio": chosen.zero_period_ratio,
        "spectra": chosen.spectra().to_dict("list"),
    }
    if out is not None:
        _write_selection(out, document, chosen, force=force)
    if records is not None:
        _write_selected_records(records, document, chosen, force=force)
    if json:
        typer.echo(output.to_json(document))
    else:
        _print_selection(chosen)


def _check_selected_records_folder(folder: Path, out: Path | None, *, force: bool) -> None:
    if out is not None and folder.absolute() == out.absolute():
        raise InputError(
            f"--records {folder} is the folder of --out, too. Give it one of its own: every CSV file in it is a record."
        )
    try:
        output.check_output_folder(folder, force=force)
    except InputError as error:
        raise InputError(str(error).replace("--out", "--records")) from error


def _selected_record_rows(chosen: "Selection") -> list[dict[str, Any]]:
    """One row for each record, as in the table, with None for what is not known."""
    table = chosen.table().astype(object)
    return [
        {str(key): value for key, value in row.items()} for row in table.where(table.notna(), None).to_dict("records")
    ]


def _print_selection(chosen: "Selection") -> None:
    from rockflex.motion._conditional import ConditionalSpectrum

    rows = [
        [
            row["record"],
            row["event"] or "-",
            str(row["year"] or "-"),
            "-" if row["magnitude"] is None else f"{row['magnitude']:g}",
            "-" if row["distance_km"] is None else f"{row['distance_km']:g}",
            console.number(row["factor"]),
            console.number(row["misfit"], 3),
            f"{row['least_ratio']:.2f} ... {row['largest_ratio']:.2f}",
        ]
        for row in _selected_record_rows(chosen)
    ]
    console.print_rows(("record", "event", "year", "M", "R [km]", "factor", "misfit", "Sa/target"), rows, 2)
    target = chosen.target
    lines = [
        f"\nTarget: {target.name}, damping {target.damping_ratio:g}, {chosen.periods[0]:g} to {chosen.periods[-1]:g} s",
    ]
    if isinstance(target, ConditionalSpectrum):
        lines.append(
            f"Median: misfit {console.number(chosen.misfit, 3)}; standard deviation of ln Sa: "
            f"misfit {console.number(chosen.spread_misfit, 3)}"
        )
    else:
        lines.append(
            f"Mean: misfit {console.number(chosen.misfit, 3)}, at least {chosen.least_ratio:.3f} of the target"
        )
    if len(chosen.names) > 1:
        spread = chosen.dispersion
        lines.append(f"Standard deviation of ln Sa: {spread.min():.2f} to {spread.max():.2f}")
    if target.periods[0] == 0.0:
        lines.append(f"At a period of zero the mean is {chosen.zero_period_ratio:.3f} of the target")
    console.print_line("\n".join(lines))


def _write_selection(folder: Path, document: dict[str, Any], chosen: "Selection", *, force: bool) -> None:
    from rockflex.plot._figures import save_figure
    from rockflex.plot._motion import plot_selection

    with output.staged_output_folder(folder, document, force=force) as stage:
        output.write_table(chosen.table(), stage / "selection.csv")
        output.write_table(chosen.spectra(), stage / "spectra.csv")
        save_figure(plot_selection(chosen), stage / "selection.png")
    console.print_remark(f"Written to {folder}")


def _write_selected_records(folder: Path, document: dict[str, Any], chosen: "Selection", *, force: bool) -> None:
    from rockflex.motion._columns import record_csv

    with output.staged_output_folder(folder, document, force=force) as stage:
        for stem, motion in zip(
            output.output_file_stems(motion.name for motion in chosen.suite), chosen.suite, strict=True
        ):
            (stage / f"{stem}.csv").write_text(record_csv(motion), "utf-8", newline="\n")
    console.print_remark(f"{number_with_noun(len(chosen.suite), 'scaled record')} written to {folder}")
