"""Hazard curves that OpenQuake exported as CSV."""

import csv
import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from rockflex._errors import InputError
from rockflex._files import check_regular, path_of
from rockflex._shown import counted, shown
from rockflex.fragility._units import unit_of

Site = tuple[float, float] | str
_NEAR = 1e-4  # degrees; the files have five decimals
_LEVEL = "poe-"


class ExportedCurve(NamedTuple):
    """Levels in SI units, the probabilities of exceeding them, and the years that these refer to."""

    im: list[float]
    poe: list[float]
    years: float


def read_exported_curve(path: str | Path, site: Site | None) -> ExportedCurve:
    """Read the curve of one site.

    Raises
    ------
    InputError
        If the file cannot be read, is not such an export, or has no or more than one such site.
    """
    file = path_of("path", path)
    check_regular(file, "path")
    try:
        lines = file.read_text("utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{file} cannot be read: {error}.", field="path") from error
    comments = [line for line in lines if line.startswith("#")]
    years, measure = _stated(file, " ".join(comments))
    rows = list(csv.reader(line for line in lines if line.strip() and not line.startswith("#")))
    names = rows[0] if rows else []
    columns = [place for place, name in enumerate(names) if name.startswith(_LEVEL)]
    if not columns or "lon" not in names or "lat" not in names:
        raise InputError(
            f"{file} must be a hazard curve that OpenQuake exported, with the columns lon, lat and poe-..., but its "
            f"columns are {shown(', '.join(names))}.",
            field="path",
        )
    row = _row(file, names, rows[1:], site)
    _, unit = unit_of(measure)
    levels = [_number(file, names[place].removeprefix(_LEVEL)) * unit for place in columns]
    return ExportedCurve(levels, [_number(file, row[place]) for place in columns], years)


def _stated(file: Path, comment: str) -> tuple[float, str]:
    """The years and the measure in the comment that such a file begins with."""
    years = re.search(r"investigation_time=([0-9.eE+-]+)", comment)
    measure = re.search(r"""imt=["']+([^"']+)""", comment)
    if years is None or measure is None:
        raise InputError(
            f"{file} must begin with a comment that states investigation_time and imt, as the hazard curves that "
            "OpenQuake exports do. Otherwise read its columns, and give them to HazardCurve.from_poe.",
            field="path",
        )
    return _number(file, years[1]), measure[1]


def _row(file: Path, names: Sequence[str], rows: list[list[str]], site: Site | None) -> list[str]:
    whole = [row for row in rows if len(row) == len(names)]
    if len(whole) < len(rows) or not rows:
        wrong = counted(len(rows) - len(whole), "row differs", "rows differ") if rows else "it has none"
        raise InputError(f"{file} must have a row of {len(names)} values for each site, but {wrong}.", field="path")
    if site is None:
        if len(rows) > 1:
            raise InputError(f"{file} has {len(rows)} sites. Choose one with site=(longitude, latitude).", field="site")
        return rows[0]
    if isinstance(site, str):
        if "custom_site_id" not in names:
            raise InputError(f"{file} has no names of sites. Give site=(longitude, latitude).", field="site")
        place = names.index("custom_site_id")
        named = [row for row in rows if row[place] == site]
        if not named:
            raise InputError(f"{file} has no site {shown(site)}, but {shown(rows[0][place])}, ...", field="site")
        return named[0]
    return _nearest(file, names, rows, site)


def _nearest(file: Path, names: Sequence[str], rows: list[list[str]], site: tuple[float, float]) -> list[str]:
    try:
        longitude, latitude = (float(value) for value in site)
    except (TypeError, ValueError) as error:
        raise InputError(
            f"site must be (longitude, latitude) in degrees, or a name, but {shown(site)} was given.", field="site"
        ) from error
    at = names.index("lon"), names.index("lat")
    places = [(_number(file, row[at[0]]), _number(file, row[at[1]])) for row in rows]
    away = [math.hypot(x - longitude, y - latitude) for x, y in places]
    nearest = min(range(len(rows)), key=away.__getitem__)
    if not away[nearest] <= _NEAR:
        x, y = places[nearest]
        raise InputError(
            f"{file} has no site at {longitude:g}, {latitude:g}. The nearest in degrees is at {x:g}, {y:g}.",
            field="site",
        )
    here = [row for row, distance in zip(rows, away, strict=True) if distance <= away[nearest] + 1e-9]
    if len(here) > 1:
        named = "custom_site_id" in names
        hint = f" Choose one by its name, such as {shown(here[0][names.index('custom_site_id')])}." if named else ""
        raise InputError(f"{file} has {len(here)} sites at {longitude:g}, {latitude:g}.{hint}", field="site")
    return rows[nearest]


def _number(file: Path, text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise InputError(f"{file}: {shown(text)} stands where a number is expected.", field="path")
    return number
