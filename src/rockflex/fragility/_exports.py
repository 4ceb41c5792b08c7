"""Fragility models for OpenQuake (NRML 0.5) and Pelicun 3."""

import csv
import io
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, TypeAlias
from xml.etree import ElementTree as ET

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import check_all_positive, checked_finite_vector, checked_positive
from rockflex.foundation.csv import guarded_text
from rockflex.foundation.errors import InputError
from rockflex.foundation.files import checked_file_path, write_given_file
from rockflex.foundation.shown import shown
from rockflex.fragility._arguments import Curve, FragilityCurve, checked_fragility_curve
from rockflex.fragility._hazard import HAZARD_DAMPING, damping_text, openquake_kind_and_period, openquake_unit_in_si
from rockflex.fragility._lognormal import LognormalFragility
from rockflex.fragility._outcomes import OutcomeFragility

States: TypeAlias = OutcomeFragility | Mapping[str, FragilityCurve | Curve]
"""Fits of the three outcomes, or a curve for each limit state by its name, from the mildest to the most severe."""

_LIMIT_STATE, _STRUCTURE = re.compile(r"[A-Za-z0-9_-]+"), re.compile(r"[A-Za-z0-9_.:+-]+")  # names
_N_CHECKED, _CROSSING_TOLERANCE = 200, 1e-9
_NAMESPACE = "http://openquake.org/xmlns/nrml/0.5"
_PELICUN_DEMANDS = {
    "PGA": ("Peak Ground Acceleration", "mps2"),
    "PGV": ("Peak Ground Velocity", "mps"),
    "SA": ("Spectral Acceleration", "mps2"),
}
_STATE_COLUMNS = ("Family", "Theta_0", "Theta_1", "DamageStateWeights")
_MIN_RISE = 1e-6  # Pelicun rounds the points of a curve to six digits, and refuses two that are the same
_CLOSING_FACTOR = 1e6  # times the last level: where a curve that does not reach one is closed


@dataclass(frozen=True)
class FragilityFunction:
    """The probability of exceeding each limit state of one structure, from the mildest to the most severe."""

    name: str
    curves: Mapping[str, Curve]
    lognormal: Mapping[str, LognormalFragility] | None  # the same curves; None unless all are lognormal


def fragility_functions(
    curves: Mapping[str, States], levels: ArrayLike, rotations: Mapping[str, float] | None, measure: str
) -> tuple[list[FragilityFunction], Array]:
    """Return the limit states of each structure, and the levels of the measure, both checked."""
    im = checked_finite_vector("levels", levels, "the SI unit of the measure")
    check_all_positive("levels", im, "in SI units")
    if im.size < 2 or (np.diff(im) <= 0.0).any():
        raise InputError(
            f"levels must be two or more measures that rise, but {shown(levels)} was given.", field="levels"
        )
    if not isinstance(curves, Mapping) or not curves:  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(
            'curves must be a dictionary with the limit states of each structure, such as {"pier": outcomes}, but '
            f"{shown(curves)} was given.",
            field="curves",
        )
    limits = {name: checked_positive(f"rotations[{name!r}]", value, "rad") for name, value in (rotations or {}).items()}
    if limits and not any(isinstance(states, OutcomeFragility) for states in curves.values()):
        raise InputError("rotations are limits of fitted outcomes, but curves has none.", field="rotations")
    if list(limits.values()) != sorted(set(limits.values())):
        raise InputError(
            f"rotations must rise from the mildest limit state to the most severe, but they are "
            f"{', '.join(f'{value:g}' for value in limits.values())} rad.",
            field="rotations",
        )
    taken = [name for name in ("rocking", "overturning") if name in limits]
    if taken:
        raise InputError(f"{taken[0]} is a limit state of its own: give this rotation another name.", field="rotations")
    found = [_structure_fragility_function(name, states, limits) for name, states in curves.items()]
    for name, states in curves.items():
        _check_exported_damping(name, states, measure)
    for each in found:
        if list(each.curves) != list(found[0].curves):
            raise InputError(
                f"All structures must have the same limit states in the same order, but {found[0].name} has "
                f"{', '.join(found[0].curves)} and {each.name} has {', '.join(each.curves)}. Write several files.",
                field="curves",
            )
    for each in found:
        _check_limit_state_order(each, im)
    return found, im


def _structure_fragility_function(name: Any, states: Any, rotations: Mapping[str, float]) -> FragilityFunction:
    if not isinstance(name, str) or not _STRUCTURE.fullmatch(name):
        raise InputError(
            f"The name of a structure may contain letters of the English alphabet, digits and _ . : + -, but "
            f"{shown(name)} was given.",
            field="curves",
        )
    if isinstance(states, OutcomeFragility):

        def rocks(im: Array) -> Array:  # or overturns
            return 1.0 - states.probabilities(im).no_rocking

        given: Mapping[Any, Any] = {
            "rocking": rocks,
            **{limit: partial(states.exceedance, limit=rotation) for limit, rotation in rotations.items()},
            "overturning": states.overturning,
        }
    elif isinstance(states, Mapping) and states:
        given = states
    else:
        raise InputError(
            f"curves[{name!r}] must be an OutcomeFragility or a dictionary of curves by limit state, but "
            f"{shown(states)} was given.",
            field="curves",
        )
    for limit in given:
        if not isinstance(limit, str) or not _LIMIT_STATE.fullmatch(limit):
            raise InputError(
                f"The name of a limit state may contain letters of the English alphabet, digits, _ and -, but "
                f"{shown(limit)} was given.",
                field="curves",
            )
    checked = {limit: checked_fragility_curve(curve, f"curves[{name!r}][{limit!r}]") for limit, curve in given.items()}
    fits = {limit: curve for limit, curve in given.items() if isinstance(curve, LognormalFragility)}
    return FragilityFunction(name, checked, fits if len(fits) == len(given) else None)


def _check_exported_damping(name: str, states: States, measure: str) -> None:
    """Raise an InputError if a spectral measure is known not to be at the 5 % of risk programs."""
    for fit in states.values() if isinstance(states, Mapping) else [states]:
        damping = getattr(fit, "damping", None)
        if damping is not None and not math.isclose(damping, HAZARD_DAMPING, rel_tol=1e-6):
            raise InputError(
                f"measure: {measure} of risk programs is at {damping_text(HAZARD_DAMPING)}, but the curves of {name} "
                f"are in a spectral measure at {damping_text(damping)}. Fit the runs to sa_t1_5, Sa(T₁) at 5 %.",
                field="measure",
            )


def _check_limit_state_order(function: FragilityFunction, levels: Array) -> None:
    """A run that exceeds a limit state exceeds all milder ones, so that curves cannot cross."""
    at = np.union1d(levels, np.geomspace(levels[0], levels[-1], _N_CHECKED)[1:-1])
    milder, before = np.ones(at.size), ""
    for limit, curve in function.curves.items():
        p = curve(at)
        worst = int(np.argmax(p - milder))
        if p[worst] > milder[worst] + _CROSSING_TOLERANCE:
            raise InputError(
                f"{function.name}: at {at[worst]:.4g} the probability of {limit} is {p[worst]:.4g}, more than the "
                f"{milder[worst]:.4g} of {before}, which comes before it. Give limit states from the mildest to the "
                "most severe; curves with different dispersions cross somewhere, so give levels on one side of that, "
                "or curves with a common dispersion.",
                field="curves",
            )
        milder, before = p, limit


def write_nrml(
    path: str | Path,
    curves: Mapping[str, States],
    measure: str,
    levels: ArrayLike,
    *,
    rotations: Mapping[str, float] | None = None,
    no_damage_limit: float | None = None,
    description: str = "Fragility of rocking structures",
    asset_category: str = "buildings",
    loss_category: str = "structural",
) -> Path:
    """Write a fragility model for OpenQuake (NRML 0.5).

    A structure whose limit states are all lognormal gets a continuous function, any other a discrete one: its
    probabilities at `levels`, between which OpenQuake interpolates linearly. Measures are converted from SI units to
    OpenQuake's: g for PGA and SA, cm/s for PGV, with g = 9.81 m/s².

    OpenQuake keeps a curve constant above its last level. Below the first, a continuous one is constant and a discrete
    one falls linearly to zero at no shaking.

    Parameters
    ----------
    path
        Path of the file, such as ``fragility.xml``; an existing one is replaced.
    curves
        The limit states of each structure by its name, which is its taxonomy in OpenQuake: an `OutcomeFragility`, or a
        dictionary of curves by limit state from the mildest to the most severe. A curve is a fit with `probability`,
        or a function of an array of measures. All structures have the same limit states.
    measure
        OpenQuake's name of the intensity measure: PGA, PGV, PGD, IA, CAV, RSD, AvgSA, or SA(T), AvgSA(T) with the
        period in s.
    levels : array_like, shape (n,)
        Measures in SI units (m/s² for PGA and SA, m/s for PGV), rising, at least two: the points of discrete functions;
        the first and the last are the ends of continuous ones.
    rotations : dict, optional
        Limit states of each `OutcomeFragility` between "rocking" and "overturning": names, and rotations in rad.
    no_damage_limit
        Measure in SI units below which OpenQuake takes all probabilities as zero. Default: none.
    description, asset_category, loss_category
        Texts about the model in the file.

    Raises
    ------
    InputError
        If the measure is unknown, the levels do not rise, a name cannot be written, limit states differ between
        structures or cross, a probability is missing, or `no_damage_limit` is not below the first level.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> import rockflex as rf
    >>> path = Path(tempfile.mkdtemp()) / "fragility.xml"
    >>> pier = {"tilted": rf.LognormalFragility(0.2, 0.5),
    ...     "overturned": rf.LognormalFragility(0.5, 0.5)}
    >>> rf.write_nrml(path, {"pier": pier}, "PGV", levels=[0.05, 2.0]).name
    'fragility.xml'
    >>> print(path.read_text().splitlines()[6].strip())
    <imls imt="PGV" minIML="5.0" maxIML="200.0" />
    """
    target = checked_file_path("path", path)
    unit = openquake_unit_in_si(measure)
    functions, im = fragility_functions(curves, levels, rotations, measure)
    texts = {"description": description, "asset_category": asset_category, "loss_category": loss_category}
    for name, text in texts.items():
        if not isinstance(text, str) or not text.strip() or not text.isprintable():  # pyright: ignore[reportUnnecessaryIsInstance]
            raise InputError(f"{name} must be a line of text, but {shown(text)} was given.", field=name)
    shared = {"imt": measure}
    if no_damage_limit is not None:
        limit = checked_positive("no_damage_limit", no_damage_limit, "the SI unit of the measure")
        if limit >= im[0]:
            raise InputError(
                f"no_damage_limit must be below the first level, {im[0]:g}, but {limit:g} was given.",
                field="no_damage_limit",
            )
        shared["noDamageLimit"] = _nrml_number_text(limit / unit)

    root = ET.Element("nrml", {"xmlns": _NAMESPACE})
    kind = {"id": "rockflex", "assetCategory": asset_category, "lossCategory": loss_category}
    model = ET.SubElement(root, "fragilityModel", kind)
    ET.SubElement(model, "description").text = description
    ET.SubElement(model, "limitStates").text = " ".join(functions[0].curves)
    for function in functions:
        if function.lognormal is None:
            _add_discrete_nrml_function(model, function, shared, im, unit)
        else:
            _add_continuous_nrml_function(model, function.name, function.lognormal, shared, im, unit)
    ET.indent(root)
    return write_given_file(target, ET.tostring(root, encoding="utf-8", xml_declaration=True) + b"\n")


def _add_discrete_nrml_function(
    model: ET.Element, function: FragilityFunction, shared: dict[str, str], im: Array, unit: float
) -> None:
    element = ET.SubElement(model, "fragilityFunction", {"id": function.name, "format": "discrete"})
    ET.SubElement(element, "imls", shared).text = " ".join(map(_nrml_number_text, im / unit))
    for limit, curve in function.curves.items():
        ET.SubElement(element, "poes", {"ls": limit}).text = " ".join(map(_nrml_number_text, curve(im)))


def _add_continuous_nrml_function(
    model: ET.Element,
    name: str,
    curves: Mapping[str, LognormalFragility],
    shared: dict[str, str],
    im: Array,
    unit: float,
) -> None:
    """OpenQuake takes the mean and the standard deviation of the capacity itself, not of its logarithm."""
    element = ET.SubElement(model, "fragilityFunction", {"id": name, "format": "continuous", "shape": "logncdf"})
    least, most = map(_nrml_number_text, (im / unit)[[0, -1]])
    ET.SubElement(element, "imls", {**shared, "minIML": least, "maxIML": most})
    for limit, curve in curves.items():
        try:
            mean = curve.median / unit * math.exp(0.5 * curve.beta**2)
            spread = mean * math.sqrt(math.expm1(curve.beta**2))
        except OverflowError:
            mean = spread = math.inf
        if not (math.isfinite(mean) and math.isfinite(spread) and spread > 0.0):
            raise InputError(
                f"{name}: the capacity of {limit}, with median {curve.median:g} and beta {curve.beta:g}, has no mean "
                "and standard deviation in double precision.",
                field="curves",
            )
        numbers = {"mean": _nrml_number_text(mean), "stddev": _nrml_number_text(spread)}
        ET.SubElement(element, "params", {"ls": limit, **numbers})


def _nrml_number_text(value: float) -> str:
    return repr(float(value))


def write_pelicun(
    path: str | Path,
    curves: Mapping[str, States],
    measure: str,
    levels: ArrayLike,
    *,
    rotations: Mapping[str, float] | None = None,
) -> Path:
    """Write a table of damage parameters for Pelicun 3 (its ``fragility.csv``).

    Lognormal curves are written as such. Any other becomes a piecewise linear distribution through its values at
    `levels` (Pelicun's ``multilinear_CDF``), which Pelicun rounds to six digits: from zero at no shaking to the first
    level; beyond the last one, the remaining probability is spread over a million times this level. Limit states become
    LS1, LS2, ... in their order. Units are SI units, which Pelicun converts. The demand is directional: in the
    component's own direction. Pelicun would multiply one that is not by 1.2.

    Parameters
    ----------
    path
        Path of the file, such as ``fragility.csv``; an existing one is replaced.
    curves
        The limit states of each structure, as in `write_nrml`; its name is its ID in Pelicun, behind an
        apostrophe if it begins with a sign, which a spreadsheet would compute.
    measure
        The intensity measure: PGA, PGV, or SA(T) with the period in s. The demand of Pelicun's assessment is then
        "PGA", "PGV", or "SA_T" with the period as it is written here.
    levels : array_like, shape (n,)
        Measures in SI units (m/s² for PGA and SA, m/s for PGV), rising, at least two: the points of piecewise linear
        distributions.
    rotations : dict, optional
        Limit states of each `OutcomeFragility` between "rocking" and "overturning": names, and rotations in rad.

    Raises
    ------
    InputError
        As `write_nrml` does, if Pelicun has no such demand, or if a curve falls between two levels.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> import rockflex as rf
    >>> path = Path(tempfile.mkdtemp()) / "fragility.csv"
    >>> pier = {"tilted": rf.LognormalFragility(2.0, 0.5),
    ...     "overturned": rf.LognormalFragility(5.0, 0.5)}
    >>> rf.write_pelicun(path, {"pier": pier}, "PGA", levels=[0.5, 20.0]).name
    'fragility.csv'
    >>> print(path.read_text().splitlines()[1])
    pier,0,Peak Ground Acceleration,mps2,0,1,lognormal,2.0,0.5,,lognormal,5.0,0.5,
    """
    target = checked_file_path("path", path)
    kind, period = openquake_kind_and_period(measure)
    if kind not in _PELICUN_DEMANDS:
        raise InputError(
            f"measure must be PGA, PGV or SA(T), the demands that Pelicun knows, but {measure} was given.",
            field="measure",
        )
    name, unit = _PELICUN_DEMANDS[kind]
    demand = f"{name}|{period}" if period else name
    functions, im = fragility_functions(curves, levels, rotations, measure)
    states = range(1, len(functions[0].curves) + 1)
    head = ["ID", "Incomplete", "Demand-Type", "Demand-Unit", "Demand-Offset", "Demand-Directional"]
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow([*head, *(f"LS{number}-{column}" for number in states for column in _STATE_COLUMNS)])
    for function in functions:
        cells = [cell for limit in function.curves for cell in _pelicun_state_cells(function, limit, im)]
        table.writerow([guarded_text(function.name), 0, demand, unit, 0, 1, *cells])
    return write_given_file(target, text.getvalue().encode())


def _pelicun_state_cells(function: FragilityFunction, limit: str, im: Array) -> tuple[str, str, str, str]:
    """Family, two parameters and no weights of damage states."""
    if function.lognormal is not None:
        fit = function.lognormal[limit]
        return "lognormal", repr(float(fit.median)), repr(float(fit.beta)), ""
    x, y = _pelicun_distribution_points(f"{function.name}: the probability of {limit}", im, function.curves[limit](im))
    points = ",".join(f"{value:.6g}" for value in x), ",".join(f"{value:.6g}" for value in y)
    return "multilinear_CDF", "|".join(points), "", ""


def _pelicun_distribution_points(what: str, im: Array, p: Array) -> tuple[list[float], list[float]]:
    """Points of a distribution that rises from 0 to 1, as Pelicun rounds them."""
    falls = np.flatnonzero(np.diff(p) < -_MIN_RISE)
    if falls.size:
        i = int(falls[0])
        raise InputError(
            f"{what} falls from {p[i]:.4g} at {im[i]:.4g} to {p[i + 1]:.4g} at {im[i + 1]:.4g}, but the "
            "distribution of a capacity rises. Leave out these levels.",
            field="curves",
        )
    x, y = [0.0], [0.0]
    for level, value in zip(im, p, strict=True):
        x.append(_rounded_to_six_digits(level))
        y.append(_rounded_to_six_digits(max(value, y[-1] + _MIN_RISE)))
        if x[-1] <= x[-2]:
            raise InputError(f"levels must differ in their first six digits, but two are {x[-1]:g}.", field="levels")
        if y[-1] > 1.0 - _MIN_RISE:
            return x, [*y[:-1], 1.0]
    return [*x, _CLOSING_FACTOR * x[-1]], [*y, 1.0]


def _rounded_to_six_digits(value: float) -> float:
    return float(f"{value:.6g}")
