"""Variables with their units and descriptions as files of MATLAB and NetCDF."""

import io
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from rockflex.foundation.errors import InputError
from rockflex.foundation.files import checked_file_path, write_given_file
from rockflex.foundation.shown import shown
from rockflex.response._outputs import HISTORY
from rockflex.response._tables import history_values, import_xarray

History = Any  # rockflex.response.History, which imports this module

_LONGEST = 63  # letters of a name in MATLAB
_KEYWORDS = (
    "break case catch classdef continue else elseif end for function global if otherwise parfor persistent return"
)
_RESERVED = {*_KEYWORDS.split(), "spmd", "switch", "try", "while", "units", "descriptions", "names", "model"}


@dataclass(frozen=True, eq=False)
class Variable:
    """Values of numbers, flags or texts, whose rows are the instants or the runs."""

    name: str
    values: np.ndarray[Any, Any]
    unit: str
    description: str
    across: str = ""  # what the columns are of


def history_variables(history: History, quantities: Sequence[str] | None) -> list[Variable]:
    """Return the time and quantities of a history; None: all that it has."""
    return [
        Variable(name, values, known.si, known.words, known.across if values.ndim > 1 else "")
        for name, values in ({"time": history.time} | history_values(history, quantities)).items()
        for known in (HISTORY[name],)
    ]


def write_matlab(path: str | Path, model: str | None, variables: Sequence[Variable]) -> Path:
    """Write a file of `rockflex.to_matlab`; `model` is the label of the model of a history."""
    from scipy.io import savemat

    target = _checked_export_path(path, ".mat")
    content: dict[str, Any] = {} if model is None else {"model": model}
    names = _valid_names(each.name for each in variables)
    content |= {name: each.values for name, each in zip(names, variables, strict=True)}
    told: dict[str, Callable[[Variable], str]] = {
        "units": lambda each: each.unit,
        "descriptions": lambda each: each.description,
        "names": lambda each: each.name,
    }
    for what, of in told.items():
        content[what] = {name: of(each) for name, each in zip(names, variables, strict=True)}
    file = io.BytesIO()
    to: Any = file  # its annotation has paths only
    savemat(to, content, long_field_names=True, do_compression=True, oned_as="column")
    # The header of 116 bytes tells the time and the machine, for which equal results would differ.
    head = b"MATLAB 5.0 MAT-file, written by rockflex".ljust(116)
    return write_given_file(target, head + file.getvalue()[116:])


def write_netcdf(path: str | Path, model: str | None, variables: Sequence[Variable]) -> Path:
    """Write a file of `rockflex.to_netcdf`; `model` is the label of the model of a history."""
    xr = import_xarray("to_netcdf", "to_matlab")
    target = _checked_export_path(path, ".nc")
    rows = "run" if model is None else "time"
    labels: dict[str, Any] = {}
    found: dict[str, Any] = {}
    for name, each in zip(_valid_names(each.name for each in variables), variables, strict=True):
        known = {"units": each.unit, "long_name": each.description, "column": each.name if model is None else ""}
        dims = (rows, each.across) if each.across else (rows,)
        if each.across:
            labels[each.across] = ["left", "right"] if each.across == "edge" else np.arange(each.values.shape[1]) + 1
        found[name] = (dims, each.values, {key: value for key, value in known.items() if value})
    data = xr.Dataset(found, labels, {"source": "rockflex"} | ({} if model is None else {"model": model}))
    # SciPy writes version 3, which every program reads and which needs no other library.
    return write_given_file(target, bytes(data.to_netcdf(engine="scipy")))


def _checked_export_path(path: Any, suffix: str) -> Path:
    target = checked_file_path("path", path)
    if target.suffix.lower() != suffix:
        raise InputError(f"The file must end in {suffix}, but {shown(str(path))} was given.", field="path")
    return target


def _valid_names(names: Iterable[str]) -> list[str]:
    """Return names of letters, digits and underscores that MATLAB takes, all different."""
    found: list[str] = []
    for name in names:
        plain = re.sub(r"\W", "_", name, flags=re.ASCII)
        plain = plain if plain[:1].isalpha() and plain not in _RESERVED else f"x_{plain}"
        valid, count = plain[:_LONGEST], 1
        while valid in found:
            count += 1
            end = f"_{count}"
            valid = plain[: _LONGEST - len(end)] + end
        found.append(valid)
    return found
