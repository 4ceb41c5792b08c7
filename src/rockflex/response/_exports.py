"""Histories and tables of runs for MATLAB, and for programs that read NetCDF."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.motion._measures import MEASURES
from rockflex.response._export_files import Variable, history_variables, write_matlab, write_netcdf
from rockflex.response._history import History
from rockflex.response._outputs import described_output
from rockflex.response._response import Response, history_of

_EXACT = 2.0**53  # up to which a double holds every whole number


def to_matlab(result: Any, path: str | Path, quantities: Sequence[str] | None = None) -> Path:
    """Write a history or a table of runs as a file of MATLAB (version 5), in SI units.

    Each quantity, or column, is a variable: numbers as doubles, flags as logicals, texts as a cell array. The structs
    ``units``, ``descriptions`` and ``names`` have a field for each variable, with its unit, what it is, and its name
    before what MATLAB does not take in a name was replaced. Missing numbers are NaN, and flags among which some are
    missing are 0, 1 and NaN.

    Parameters
    ----------
    result
        A `Response` with its history, a `History`, or a pandas table, such as that of a study.
    path
        The file, which ends in .mat; an existing file is replaced. Missing folders are created.
    quantities
        Names of quantities of the history, or of columns of the table. None: all.

    Returns
    -------
    Path
        The file written. It is written completely or not at all.

    Raises
    ------
    InputError
        If the result is another one, or has no history; if there is no such quantity; or the path has another suffix.

    Examples
    --------
    >>> import rockflex as rf
    >>> from scipy.io import loadmat
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
    >>> table = rf.run_cloud(frame, rf.one_sine_pulse(amplitude=3.0, period=0.8),
    ...     "2DOF-S", scales=(0.5, 1.0))
    >>> file = loadmat(rf.to_matlab(table, "runs.mat"), simplify_cells=True)
    >>> file["pga"], file["units"]["pga"]
    (array([1.5, 3. ]), 'm/s2')
    """
    return write_matlab(path, *_model_and_variables(result, quantities))


def to_netcdf(result: Any, path: str | Path, quantities: Sequence[str] | None = None) -> Path:
    """Write a history or a table of runs as a NetCDF file (version 3), in SI units; it needs ``rockflex[xarray]``.

    Each quantity, or column, is a variable with the attributes ``units`` and ``long_name``, which says what it is. The
    dimensions of a history are those of `History.to_xarray`; that of a table is ``run``, and a column has the attribute
    ``column``, its name before what such files do not take in a name was replaced. Missing numbers are NaN, and flags
    among which some are missing are 0, 1 and NaN.

    Parameters
    ----------
    result
        A `Response` with its history, a `History`, or a pandas table, such as that of a study.
    path
        The file, which ends in .nc; an existing file is replaced. Missing folders are created.
    quantities
        Names of quantities of the history, or of columns of the table. None: all.

    Returns
    -------
    Path
        The file written. It is written completely or not at all.

    Raises
    ------
    InputError
        If xarray is not installed, the result is another one, or has no history; if there is no such quantity; or the
        path has another suffix.

    Examples
    --------
    >>> import rockflex as rf
    >>> import xarray
    >>> column = rf.CantileverWithTipMass(
    ...     height=10.0, tip_mass=50e3, bending_stiffness=2e8, base_mass=10e3,
    ...     half_width=1.0, damping_ratio=0.02
    ... )
    >>> response = rf.simulate(column,
    ...     rf.one_sine_pulse(amplitude=3.0, period=1.0), "2DOF-S")
    >>> with xarray.open_dataset(rf.to_netcdf(response, "run.nc")) as file:
    ...     print(file["rotation"].attrs)
    {'units': 'rad', 'long_name': 'rotation of the base'}
    """
    return write_netcdf(path, *_model_and_variables(result, quantities))


def _model_and_variables(result: Any, quantities: Sequence[str] | None) -> tuple[str | None, list[Variable]]:
    """Return the label of the model, None for a table, and what is to be written."""
    import pandas as pd

    if isinstance(result, pd.DataFrame):
        return None, _columns_of_table(result, quantities)
    if isinstance(result, Response):
        result = history_of(result)
    if not isinstance(result, History):
        raise InputError(
            f"result must be a Response, a History or a pandas table, but {type(result).__name__} was given.",
            field="result",
        )
    return result.model.label, history_variables(result, quantities)


def _columns_of_table(table: Any, names: Sequence[str] | None) -> list[Variable]:
    whole = table.reset_index() if any(name is not None for name in table.index.names) else table
    missing = [] if names is None else [name for name in names if name not in whole]
    if missing or (names is not None and isinstance(names, str)):
        raise InputError(
            f"quantities must be a list of columns of the table, but {shown(missing[0] if missing else names)} was "
            f"given. There are: {', '.join(map(str, whole.columns))}.",
            field="quantities",
        )
    return [
        Variable(str(name), _plain_values(whole[name]), unit_of_column(str(name)), _description_of_column(str(name)))
        for name in (whole.columns if names is None else names)
    ]


def _plain_values(column: Any) -> np.ndarray[Any, Any]:
    """Return a column as numbers, flags or texts."""
    from pandas.api import types

    missing = column.isna().to_numpy()
    if types.is_bool_dtype(column.dtype) and not missing.any():
        return column.to_numpy(dtype=bool)
    if types.is_numeric_dtype(column.dtype) and not types.is_complex_dtype(column.dtype):
        numbers = column.to_numpy(dtype=np.float64, na_value=np.nan)
        if not (types.is_integer_dtype(column.dtype) and np.any(np.abs(numbers) > _EXACT)):
            return numbers
    return np.array(["" if gone else str(each) for each, gone in zip(column, missing, strict=True)], dtype=object)


def unit_of_column(name: str) -> str:
    """Return the unit of a column of a table of runs; empty where it has none, or none is known."""
    if name in MEASURES:
        return MEASURES[name].unit.replace("²", "2")  # as the units of a history
    found = described_output(name)
    return found.si if found else ""


def _description_of_column(name: str) -> str:
    if name in MEASURES:
        return MEASURES[name].words or MEASURES[name].label
    found = described_output(name)
    return found.words if found else ""
