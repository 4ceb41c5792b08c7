"""Fragility parameters for Pelicun 3."""

import csv
import io
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._errors import InputError
from rockflex._files import path_of, write_whole
from rockflex.fragility._states import Function, States, functions_of
from rockflex.fragility._units import parts_of

_DEMANDS = {
    "PGA": ("Peak Ground Acceleration", "mps2"),
    "PGV": ("Peak Ground Velocity", "mps"),
    "SA": ("Spectral Acceleration", "mps2"),
}
_PER_STATE = ("Family", "Theta_0", "Theta_1", "DamageStateWeights")
_RISE = 1e-6  # Pelicun rounds the points of a curve to six digits, and refuses two that are the same
_FAR = 1e6  # times the last level: where a curve that does not reach one is closed


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
    level; beyond the last one, what is missing to one is spread over a million times this level. Limit states become
    LS1, LS2, ... in their order. Units are SI units, which Pelicun converts. The demand is directional: that of the
    component's own direction. Pelicun would multiply one that is not by 1.2.

    Parameters
    ----------
    path
        Path of the file, such as ``fragility.csv``; an existing one is replaced.
    curves
        The limit states of each structure, as in `write_nrml`; its name is its ID in Pelicun.
    measure
        The intensity measure: PGA, PGV, or SA(T) with the period in s. The demand of Pelicun's assessment is then
        "PGA", "PGV", or "SA_T" with the period as it is written here.
    levels : array_like, shape (n,)
        Measures in SI units (m/s² for PGA and SA, m/s for PGV), rising, at least two: the points of piecewise linear
        distributions.
    rotations : dict, optional
        Limit states of each `OutcomeFragility` between "rocking" and "overturning": names, and rotations in rad.

    Returns
    -------
    Path
        The file written.

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
    >>> pier = {"tilted": rf.LognormalFragility(2.0, 0.5), "overturned": rf.LognormalFragility(5.0, 0.5)}
    >>> rf.write_pelicun(path, {"pier": pier}, "PGA", levels=[0.5, 20.0]).name
    'fragility.csv'
    >>> print(path.read_text().splitlines()[1])
    pier,0,Peak Ground Acceleration,mps2,0,1,lognormal,2.0,0.5,,lognormal,5.0,0.5,
    """
    target = path_of("path", path)
    kind, period = parts_of(measure)
    if kind not in _DEMANDS:
        raise InputError(
            f"measure must be PGA, PGV or SA(T), the demands that Pelicun knows, but {measure} was given.",
            field="measure",
        )
    name, unit = _DEMANDS[kind]
    demand = f"{name}|{period}" if period else name
    functions, im = functions_of(curves, levels, rotations, measure)
    states = range(1, len(functions[0].curves) + 1)
    head = ["ID", "Incomplete", "Demand-Type", "Demand-Unit", "Demand-Offset", "Demand-Directional"]
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow([*head, *(f"LS{number}-{column}" for number in states for column in _PER_STATE)])
    for function in functions:
        cells = [cell for limit in function.curves for cell in _state(function, limit, im)]
        table.writerow([function.name, 0, demand, unit, 0, 1, *cells])
    return write_whole(target, text.getvalue().encode())


def _state(function: Function, limit: str, im: Array) -> tuple[str, str, str, str]:
    """Family, two parameters and no weights of damage states."""
    if function.lognormal is not None:
        fit = function.lognormal[limit]
        return "lognormal", repr(float(fit.median)), repr(float(fit.beta)), ""
    x, y = _distribution(f"{function.name}: the probability of {limit}", im, function.curves[limit](im))
    points = ",".join(f"{value:.6g}" for value in x), ",".join(f"{value:.6g}" for value in y)
    return "multilinear_CDF", "|".join(points), "", ""


def _distribution(what: str, im: Array, p: Array) -> tuple[list[float], list[float]]:
    """Points of a distribution that rises from 0 to 1, as Pelicun rounds them."""
    falls = np.flatnonzero(np.diff(p) < -_RISE)
    if falls.size:
        i = int(falls[0])
        raise InputError(
            f"{what} falls from {p[i]:.4g} at {im[i]:.4g} to {p[i + 1]:.4g} at {im[i + 1]:.4g}, but that of a capacity "
            "rises. Leave out these levels.",
            field="curves",
        )
    x, y = [0.0], [0.0]
    for level, value in zip(im, p, strict=True):
        x.append(_rounded(level))
        y.append(_rounded(max(value, y[-1] + _RISE)))
        if x[-1] <= x[-2]:
            raise InputError(f"levels must differ in their first six digits, but two are {x[-1]:g}.", field="levels")
        if y[-1] > 1.0 - _RISE:
            return x, [*y[:-1], 1.0]
    return [*x, _FAR * x[-1]], [*y, 1.0]


def _rounded(value: float) -> float:
    return float(f"{value:.6g}")
