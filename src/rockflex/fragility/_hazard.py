"""Seismic hazard curves, curves exported by OpenQuake, and the units of its intensity measures."""

import csv
import math
import re
import xml.etree.ElementTree as ET
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Self

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_finite_vector, checked_in_range, checked_positive
from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError
from rockflex.foundation.files import check_regular_file, checked_file_path, unicode_text
from rockflex.foundation.shown import number_with_noun, shown
from rockflex.foundation.values import Value
from rockflex.fragility._arguments import log_of_evaluation_points

if TYPE_CHECKING:
    import pandas as pd

# OpenQuake's units of its intensity measure types, in SI units: g, cm/s, cm, m/s, g s, s.
_OPENQUAKE_UNITS = {
    "PGA": GRAVITY,
    "PGV": 0.01,
    "PGD": 0.01,
    "SA": GRAVITY,
    "AvgSA": GRAVITY,
    "IA": 1.0,
    "CAV": GRAVITY,
    "RSD": 1.0,
}
_SPECTRAL_MEASURE = re.compile(r"(?P<kind>SA|AvgSA)\((?P<period>\d+\.?\d*)\)")
Site = tuple[float, float] | str
_SITE_TOLERANCE_DEG = 1e-4  # degrees; the files have five decimals
_LEVEL_PREFIX = "poe-"
HAZARD_DAMPING = 0.05  # of the spectra of hazard analyses, and of OpenQuake's and Pelicun's SA
_AT_HAZARD_DAMPING, _AT_OWN_DAMPING = ("sa_t1_5", "sa_avg"), ("sa_t1", "sd_t1")  # measures of studies


def openquake_kind_and_period(measure: str) -> tuple[str, str]:
    """Return the kind of a measure, such as "PGV" or "SA(1.0)", and its period as written; empty if there is none."""
    if isinstance(measure, str):  # pyright: ignore[reportUnnecessaryIsInstance]
        found = _SPECTRAL_MEASURE.fullmatch(measure)
        if found and 0.0 < float(found["period"]) < math.inf:
            return found["kind"], found["period"]
        if measure in _OPENQUAKE_UNITS and measure != "SA":
            return measure, ""
    names = ", ".join(name for name in _OPENQUAKE_UNITS if name != "SA")
    raise InputError(
        f"measure must be one of {names}, SA(T) and AvgSA(T) with a period T in s, such as SA(1.0), but "
        f"{shown(measure)} was given.",
        field="measure",
    )


def openquake_unit_in_si(measure: str) -> float:
    """Return OpenQuake's unit of a measure in SI units."""
    return _OPENQUAKE_UNITS[openquake_kind_and_period(measure)[0]]


@dataclass(frozen=True)
class HazardTable:
    """The curves of a file: a row for each site under the names of the columns, and what they are about."""

    names: list[str]
    rows: list[list[str]]
    years: float
    measure: str
    damping: float = HAZARD_DAMPING


def read_openquake_hazard_curve(file: Path, site: Site | None) -> tuple[Array, Array, float, float]:
    """Read the curve of one site: levels in SI units, the probabilities of exceeding them, their years, and damping."""
    check_regular_file(file, "path")
    try:
        text = unicode_text(file.read_bytes())
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{file} cannot be read: {error}.", field="path") from error
    table = _nrml_hazard_table(file, text) if text.lstrip().startswith("<") else _csv_hazard_table(file, text)
    columns = [place for place, name in enumerate(table.names) if name.startswith(_LEVEL_PREFIX)]
    if not columns or "lon" not in table.names or "lat" not in table.names:
        raise InputError(
            f"{file} must be a hazard curve that OpenQuake exported, with the columns lon, lat and poe-..., but its "
            f"columns are {shown(', '.join(table.names))}.",
            field="path",
        )
    row = _hazard_row_of_site(file, table.names, table.rows, site)
    unit = openquake_unit_in_si(table.measure)
    levels = [_hazard_number(file, table.names[place].removeprefix(_LEVEL_PREFIX)) * unit for place in columns]
    poe = [_hazard_number(file, row[place]) for place in columns]
    return np.array(levels), np.array(poe), table.years, table.damping


def _csv_hazard_table(file: Path, text: str) -> HazardTable:
    lines = text.splitlines()
    years, measure = _hazard_years_and_measure(file, " ".join(line for line in lines if line.startswith("#")))
    names, *rows = list(csv.reader(line for line in lines if line.strip() and not line.startswith("#"))) or [[]]
    return HazardTable([name.partition(":")[0] for name in names], rows, years, measure)  # lon:float32


def _hazard_years_and_measure(file: Path, comment: str) -> tuple[float, str]:
    """The years and the measure in the comment that such a file begins with; before version 3.1 without quotes."""
    years = re.search(r"investigation_time=([0-9.eE+-]+)", comment)
    measure = re.search(r"""imt=(?:["']+([^"']+)|([^\s,"']+))""", comment)
    if years is None or measure is None:
        raise InputError(
            f"{file} must begin with a comment that states investigation_time and imt, as the hazard curves that "
            "OpenQuake exports do. Otherwise read its columns, and give them to HazardCurve.from_poe.",
            field="path",
        )
    return _hazard_number(file, years[1]), measure[1] or measure[2]


def _nrml_hazard_table(file: Path, text: str) -> HazardTable:
    """Return the hazard curves in a file of NRML, the XML of OpenQuake."""
    if "<!DOCTYPE" in text or "<!ENTITY" in text:
        raise InputError(f"{file} declares entities, which NRML has none of. Export the curves again.", field="path")
    try:
        root = ET.fromstring(text)
    except ET.ParseError as error:
        raise InputError(f"{file} is no valid XML: {error}. Export the curves again, as CSV.", field="path") from error
    sets = root.findall(".//{*}hazardCurves")
    if len(sets) != 1:
        inside = ", ".join(dict.fromkeys(each.tag.rpartition("}")[2] for each in root)) or "nothing"
        raise InputError(
            f"{file} must hold the hazard curves of one intensity measure, one element hazardCurves of NRML, but it "
            f"holds {len(sets)}, in {shown(inside)}. Export the curves of each measure to a file of its own.",
            field="path",
        )
    (curves,) = sets
    levels = curves.findtext(".//{*}IMLs", "").split()
    rows: list[list[str]] = []
    for each in curves.findall("{*}hazardCurve"):
        place = each.findtext(".//{*}pos", "").split()[:2] or ["0", "0"]  # EFEHR gives the only site no place
        if each.findtext("{*}IMLs", curves.findtext("{*}IMLs", "")).split() != levels:
            raise InputError(f"{file} has curves at different levels. Export them as CSV.", field="path")
        rows.append([*place, *each.findtext("{*}poEs", "").split()])
    measure = curves.get("IMT", "")
    if measure in ("SA", "AvgSA"):
        measure += f"({curves.get('saPeriod', '')})"
    return HazardTable(
        ["lon", "lat", *(_LEVEL_PREFIX + level for level in levels)],
        rows,
        _hazard_number(file, curves.get("investigationTime", "")),
        measure,
        _hazard_number(file, curves.get("saDamping", f"{100.0 * HAZARD_DAMPING:g}")) / 100.0,
    )


def _hazard_row_of_site(file: Path, names: Sequence[str], rows: list[list[str]], site: Site | None) -> list[str]:
    whole = [row for row in rows if len(row) == len(names)]
    if len(whole) < len(rows) or not rows:
        wrong = number_with_noun(len(rows) - len(whole), "row differs", "rows differ") if rows else "it has none"
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
    return _hazard_row_nearest_to_site(file, names, rows, site)


def _hazard_row_nearest_to_site(
    file: Path, names: Sequence[str], rows: list[list[str]], site: tuple[float, float]
) -> list[str]:
    try:
        longitude, latitude = (float(value) for value in site)
    except (TypeError, ValueError) as error:
        raise InputError(
            f"site must be (longitude, latitude) in degrees, or a name, but {shown(site)} was given.", field="site"
        ) from error
    at = names.index("lon"), names.index("lat")
    places = [(_hazard_number(file, row[at[0]]), _hazard_number(file, row[at[1]])) for row in rows]
    away = [math.hypot(x - longitude, y - latitude) for x, y in places]
    nearest = min(range(len(rows)), key=away.__getitem__)
    if not away[nearest] <= _SITE_TOLERANCE_DEG:
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


def _hazard_number(file: Path, text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise InputError(f"{file}: {shown(text)} stands where a number is expected.", field="path")
    return number


@dataclass(frozen=True, eq=False, init=False)
class HazardCurve(Value):
    """Mean annual rate at which an intensity measure is exceeded; a power law between two points.

    Parameters
    ----------
    im : array_like, shape (n,)
        Intensity measures, positive and rising, two at least, in the unit of the fragility curve.
    rate : array_like, shape (n,)
        Annual rates λ in 1/year at which they are exceeded, positive and falling.
    damping
        Damping ratio of a spectral measure, by default the 5 % of hazard analyses; other measures have none.

    Raises
    ------
    InputError
        If the columns differ in length, are not positive, or do not rise and fall as they should, or the damping is
        not between 0 and 1.

    Examples
    --------
    >>> import rockflex as rf
    >>> hazard = rf.HazardCurve([0.1, 0.2, 0.4, 0.8], [1e-2, 3e-3, 6e-4, 1e-4])
    >>> print(f"{hazard.rate_at(0.3):.3g}, {hazard.im_at(1e-3):.3g}")
    0.00117, 0.321
    """

    im: Array
    rate: Array
    damping: float

    def __init__(self, im: ArrayLike, rate: ArrayLike, *, damping: float = HAZARD_DAMPING) -> None:
        measures, rates = checked_finite_vector("im", im, "one unit"), checked_finite_vector("rate", rate, "1/year")
        if measures.size != rates.size or measures.size < 2:
            raise InputError(
                f"A hazard curve needs two points or more, a rate for each measure, but {measures.size} measures and "
                f"{rates.size} rates were given."
            )
        if measures[0] <= 0.0 or (np.diff(measures) <= 0.0).any():
            raise InputError(
                "im must be positive and rise from point to point. Sort the curve by im and drop repeated points."
            )
        bad = np.flatnonzero((rates <= 0.0) | (np.diff(rates, prepend=np.inf) >= 0.0))
        if bad.size:
            raise InputError(
                f"rate must be positive and fall from point to point, but rate[{bad[0]}] = {rates[bad[0]]:g} does not. "
                "Give annual rates of exceedance; drop the points at which the rate is zero."
            )
        ratio = checked_in_range("damping", damping, 0.0, 1.0, hint="5 % of critical is damping=0.05.")
        vars(self).update(im=measures, rate=rates, damping=ratio)

    def check_damping(self, damping: float | None) -> None:
        """Raise an InputError if a fragility's spectral measure is of another damping; None is not known, or none."""
        if damping is not None and not math.isclose(damping, self.damping, rel_tol=1e-6):
            raise InputError(
                f"The fragility is in a spectral measure at {damping_text(damping)}, but the hazard curve is at "
                f"{damping_text(self.damping)}. Take sa_t1_5, Sa(T₁) at 5 %, or a hazard curve of the same damping. "
                "Hazard curves, and fits of single columns, state theirs by damping, 0.02 for 2 %.",
                field="damping",
            )

    @classmethod
    def from_poe(cls, im: ArrayLike, poe: ArrayLike, years: float, *, damping: float = HAZARD_DAMPING) -> Self:
        """Return the curve of a Poisson process whose probabilities of exceedance are known for a number of years.

        The annual rate is -ln(1 - poe)/years.

        Parameters
        ----------
        im : array_like, shape (n,)
            Intensity measures, positive and rising, two at least, in the unit of the fragility curve.
        poe : array_like, shape (n,)
            Probabilities that they are exceeded at least once in `years`, between 0 and 1, falling.
        years
            Years that the probabilities refer to, often 1 or 50.
        damping
            Damping ratio of a spectral measure.

        Raises
        ------
        InputError
            If a probability is not between 0 and 1, or the points are no hazard curve.

        Examples
        --------
        >>> import rockflex as rf
        >>> hazard = rf.HazardCurve.from_poe([1.0, 2.0, 4.0], [0.4, 0.1, 0.02],
        ...     years=50)
        >>> print(f"1 in {1 / hazard.rate_at(2.0):.0f} years")
        1 in 475 years
        """
        chances, span = checked_finite_vector("poe", poe, "[0, 1]"), checked_positive("years", years, "years")
        bad = np.flatnonzero((chances <= 0.0) | (chances >= 1.0))
        if bad.size:
            i = int(bad[0])
            why = " Give fractions, not percentages."
            if chances[i] == 0.0:
                why = " The rate is zero there: drop such points."
            elif chances[i] == 1.0:
                why = " No finite rate gives it: drop such points, or give the probabilities for fewer years."
            given = f"poe[{i}] = {chances[i]:g} was given"
            raise InputError(f"poe must lie between 0 and 1, but {given}.{why}", field="poe")
        with np.errstate(over="ignore"):  # rates that are not finite are rejected
            return cls(im, -np.log1p(-chances) / span, damping=damping)

    @classmethod
    def from_openquake_csv(cls, path: str | Path, *, site: tuple[float, float] | str | None = None) -> Self:
        r"""Read the hazard curve of a site from a file that OpenQuake exported, such as hazard_curve-mean-PGA_1.csv.

        Files of all versions that state their ``investigation_time`` and ``imt`` are read, and NRML, the XML that older
        versions and web services such as EFEHR export.

        Measures are converted to SI units: m/s² for PGA and SA, with g = 9.81 m/s², and m/s for PGV. Points with a
        probability of 0 or 1, at which no rate is known, are left out; of several with the same probability, the one
        with the largest measure stays.

        Parameters
        ----------
        path
            Path of the file, of one intensity measure.
        site
            Longitude and latitude in degrees, to 1e-4, or the site's ``custom_site_id``. Not needed if there is one
            site only.

        Raises
        ------
        InputError
            If the file cannot be read or is not such an export, the site is not in it or not chosen, or fewer than two
            points are left.

        Examples
        --------
        >>> import tempfile
        >>> from pathlib import Path
        >>> import rockflex as rf
        >>> path = Path(tempfile.mkdtemp()) / "hazard_curve-mean-PGV_7.csv"
        >>> _ = path.write_text(
        ...     "# investigation_time=50.0, imt='PGV'\n"
        ...     "lon,lat,depth,poe-10.0000000,poe-20.0000000,poe-40.0000000\n"
        ...     "7.59000,47.56000,0.00000,4.000000E-01,1.000000E-01,0.000000E+00\n"
        ... )
        >>> hazard = rf.HazardCurve.from_openquake_csv(path, site=(7.59, 47.56))
        >>> hazard.im, hazard.rate.round(5)
        (array([0.1, 0.2]), array([0.01022, 0.00211]))
        """
        im, poe, years, damping = read_openquake_hazard_curve(checked_file_path("path", path), site)
        if (poe < 0.0).any() or (poe > 1.0).any():
            raise InputError(f"{path} holds probabilities below 0 or above 1.", field="path")
        last = np.append(poe[1:] != poe[:-1], True)
        kept = last & (poe > 0.0) & (poe < 1.0)
        if kept.sum() < 2:
            raise InputError(
                f"{path} must have two different probabilities between 0 and 1 at this site, but it has {kept.sum()}.",
                field="path",
            )
        return cls.from_poe(im[kept], poe[kept], years, damping=damping)

    @property
    def slopes(self) -> Array:
        """Exponent k of λ ∝ IM^-k in each segment, shape (n - 1,)."""
        return -np.diff(np.log(self.rate)) / np.diff(np.log(self.im))

    def rate_at(self, im: ArrayLike) -> Array:
        """Annual rate at which `im` is exceeded, interpolated linearly in logarithms."""
        return np.exp(_interpolated_hazard("im", log_of_evaluation_points(im), np.log(self.im), np.log(self.rate)))

    def im_at(self, rate: ArrayLike) -> Array:
        """Measure that is exceeded at an annual `rate`: the uniform-hazard value (2 % in 50 years is 1/2475)."""
        x = log_of_evaluation_points(rate, "rate")
        return np.exp(_interpolated_hazard("rate", x, np.log(self.rate[::-1]), np.log(self.im[::-1])))


def damping_text(damping: float) -> str:
    """A damping ratio in words, NaN for one that is not known."""
    return "an unknown damping ratio" if math.isnan(damping) else f"a damping ratio of {damping:.4g}"


def measure_damping_of_runs(runs: "pd.DataFrame", measure: str) -> float | None:
    """Return the damping ratio of an intensity measure of a study's runs; None of one that has none.

    NaN if the runs do not state it, or it differs between their structures.
    """
    if measure in _AT_HAZARD_DAMPING:
        return HAZARD_DAMPING
    if measure not in _AT_OWN_DAMPING:
        return None
    found = runs["zeta_1"].dropna().unique() if "zeta_1" in runs else []
    return float(found[0]) if len(found) == 1 else math.nan


def measure_damping_of_column(im: object, damping: float | None) -> float | None:
    """Damping ratio of a column of a study: the one given, else by the column's name; NaN if that does not tell it."""
    name = getattr(im, "name", None)
    if damping is not None or name not in (*_AT_HAZARD_DAMPING, *_AT_OWN_DAMPING):
        return damping
    return HAZARD_DAMPING if name in _AT_HAZARD_DAMPING else math.nan


def _interpolated_hazard(name: str, x: Array, points: Array, values: Array) -> Array:
    margin = 1e-12 * (points[-1] - points[0])
    if (x < points[0] - margin).any() or (x > points[-1] + margin).any():
        raise InputError(
            f"{name} must lie between {np.exp(points[0]):.4g} and {np.exp(points[-1]):.4g}, the ends of the hazard "
            "curve, which is not extrapolated."
        )
    return np.interp(x, points, values)
