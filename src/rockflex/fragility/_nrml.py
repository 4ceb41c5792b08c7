"""Fragility models for OpenQuake, in its format NRML 0.5."""

import math
from collections.abc import Mapping
from pathlib import Path
from xml.etree import ElementTree as ET

from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._checks import positive
from rockflex._errors import InputError
from rockflex._files import path_of, write_whole
from rockflex._shown import shown
from rockflex.fragility._lognormal import LognormalFragility
from rockflex.fragility._states import Function, States, functions_of
from rockflex.fragility._units import unit_of

_NAMESPACE = "http://openquake.org/xmlns/nrml/0.5"


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
        What the file says of the model.

    Returns
    -------
    Path
        The file written.

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
    >>> pier = {"tilted": rf.LognormalFragility(0.2, 0.5), "overturned": rf.LognormalFragility(0.5, 0.5)}
    >>> rf.write_nrml(path, {"pier": pier}, "PGV", levels=[0.05, 2.0]).name
    'fragility.xml'
    >>> print(path.read_text().splitlines()[6].strip())
    <imls imt="PGV" minIML="5.0" maxIML="200.0" />
    """
    target = path_of("path", path)
    _, unit = unit_of(measure)
    functions, im = functions_of(curves, levels, rotations, measure)
    texts = {"description": description, "asset_category": asset_category, "loss_category": loss_category}
    for name, text in texts.items():
        if not isinstance(text, str) or not text.strip() or not text.isprintable():  # pyright: ignore[reportUnnecessaryIsInstance]
            raise InputError(f"{name} must be a line of text, but {shown(text)} was given.", field=name)
    shared = {"imt": measure}
    if no_damage_limit is not None:
        limit = positive("no_damage_limit", no_damage_limit, "the SI unit of the measure")
        if limit >= im[0]:
            raise InputError(
                f"no_damage_limit must be below the first level, {im[0]:g}, but {limit:g} was given.",
                field="no_damage_limit",
            )
        shared["noDamageLimit"] = _text(limit / unit)

    root = ET.Element("nrml", {"xmlns": _NAMESPACE})
    kind = {"id": "rockflex", "assetCategory": asset_category, "lossCategory": loss_category}
    model = ET.SubElement(root, "fragilityModel", kind)
    ET.SubElement(model, "description").text = description
    ET.SubElement(model, "limitStates").text = " ".join(functions[0].curves)
    for function in functions:
        if function.lognormal is None:
            _discrete(model, function, shared, im, unit)
        else:
            _continuous(model, function.name, function.lognormal, shared, (im / unit)[[0, -1]], unit)
    ET.indent(root)
    return write_whole(target, ET.tostring(root, encoding="utf-8", xml_declaration=True) + b"\n")


def _discrete(model: ET.Element, function: Function, shared: dict[str, str], im: Array, unit: float) -> None:
    element = ET.SubElement(model, "fragilityFunction", {"id": function.name, "format": "discrete"})
    ET.SubElement(element, "imls", shared).text = " ".join(_text(value) for value in im / unit)
    for limit, curve in function.curves.items():
        values = " ".join(_text(value) for value in curve(im))
        ET.SubElement(element, "poes", {"ls": limit}).text = values


def _continuous(
    model: ET.Element,
    name: str,
    curves: Mapping[str, LognormalFragility],
    shared: dict[str, str],
    ends: Array,
    unit: float,
) -> None:
    """OpenQuake takes the mean and the standard deviation of the capacity itself, not of its logarithm."""
    kind = {"id": name, "format": "continuous", "shape": "logncdf"}
    element = ET.SubElement(model, "fragilityFunction", kind)
    ET.SubElement(element, "imls", {**shared, "minIML": _text(ends[0]), "maxIML": _text(ends[1])})
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
        ET.SubElement(element, "params", {"ls": limit, "mean": _text(mean), "stddev": _text(spread)})


def _text(value: float) -> str:
    return repr(float(value))
