"""A history as a table: which columns, and in which units."""

import math
from collections.abc import Iterable, Sequence
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import is_one_of
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.response._outputs import COLUMNS, HISTORY

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

History = Any  # rockflex.response.History, which imports this module


def history_to_dataframe(history: History, quantities: Sequence[str] | None) -> "pd.DataFrame":
    """Return a history as a table; see `History.to_frame`."""
    import pandas as pd

    if quantities is None:
        columns = history_columns(history, ("yielding",) if history.model.bouc_wen is not None else ())
    else:
        columns = {"time": history.time} | _chosen(history, quantities)
    return pd.DataFrame(columns).set_index("time")


def history_to_dataset(history: History, quantities: Sequence[str] | None) -> "xr.Dataset":
    """Return a history as a labelled data set; see `History.to_xarray`."""
    xr = import_xarray("to_xarray", "to_frame")
    variables: dict[str, Any] = {}
    labels: dict[str, Any] = {"time": ("time", history.time, {"units": "s"})}
    for name, values in history_values(history, quantities).items():
        dims = ("time",)
        if values.ndim > 1:
            dims = ("time", HISTORY[name].across)
            labels[dims[1]] = ["left", "right"] if dims[1] == "edge" else np.arange(values.shape[1]) + 1
        variables[name] = (dims, values, {"units": unit} if (unit := HISTORY[name].si) else {})
    return xr.Dataset(variables, labels, {"model": history.model.label})


def history_values(history: History, quantities: Sequence[str] | None) -> dict[str, Array]:
    """Return quantities of a history at its states, but for the time; None: all that are not empty."""
    names = [name for name in HISTORY if hasattr(history, name)] if quantities is None else quantities
    check_quantities(names)
    found = {name: getattr(history, name) for name in names if name != "time"}
    return {name: values for name, values in found.items() if values.size or quantities is not None}


def import_xarray(what: str, instead: str) -> Any:
    """Return the module, for the function `what`; `instead` is one that needs only pandas and SciPy.

    Raises
    ------
    InputError
        If it is not installed.
    """
    try:
        import xarray
    except ImportError as error:
        raise InputError(
            f"{what} needs xarray, which is not installed. Install it, or rockflex with its extra: pip install "
            f'"rockflex[xarray]"; or use {instead}.'
        ) from error
    return xarray


def history_columns(history: History, more: Iterable[str] = ()) -> dict[str, Array]:
    """Return the columns of a history and `more` of its quantities by their names, each of shape (n_states,).

    These are `COLUMNS`, the quantities of `more`, and `ground_columns`. The total displacement is NaN where
    the height of the top is not history.
    """
    missing = np.full(history.states.shape[0], math.nan)
    found = {name: getattr(history, name, missing) for name in COLUMNS}
    return found | {name: getattr(history, name) for name in more} | ground_columns(history)


def ground_columns(history: History) -> dict[str, Array]:
    """Return what a history has beyond that of a base that stands on rigid ground, each of shape (n_states,).

    The vertical acceleration of the ground if there is any, the rotation of every joint above the base, the slip if the
    base can slide, and on springs the heave, the rise of the edges and the force of every spring.
    """
    columns: dict[str, Array] = {}
    if history.vertical_ground_acceleration.any():
        columns["vertical_ground_acceleration"] = history.vertical_ground_acceleration
    columns |= {f"joint_rotation_{k}": each for k, each in enumerate(history.joint_rotation.T, 1)}
    if history.model.layout.slip >= 0:
        columns |= {"slip": history.slip, "slip_velocity": history.slip_velocity}
    if history.model.springs is not None:
        left, right = history.edge_uplift.T
        columns |= {"heave": history.heave, "left_edge_uplift": left, "right_edge_uplift": right}
        columns |= {f"spring_force_{k}": force for k, force in enumerate(history.spring_force.T, 1)}
        settled = history.permanent_settlement
        columns |= {f"permanent_settlement_{k}": each for k, each in enumerate(settled.T, 1) if settled.any()}
    return columns


def check_quantities(names: Any) -> None:
    """Raise an InputError unless these are names of quantities at the states of a history, each once."""
    listed = isinstance(names, list | tuple)
    wrong = [name for name in names if not is_one_of(name, HISTORY)] if listed else [names]
    if wrong or len(set(names)) < len(names):
        what = f"{shown(wrong[0])} was" if wrong else f"{shown(list(names))} were"
        near = get_close_matches(str(wrong[0]), HISTORY, 1) if wrong and listed else []
        hint = f" Did you mean {near[0]!r}?" if near else ""
        raise InputError(
            f"quantities must be a list of different names of quantities, such as ['rotation', 'base_moment'], but "
            f"{what} given.{hint} There are: {', '.join(HISTORY)}.",
            field="quantities",
        )


def _chosen(history: History, names: Sequence[str]) -> dict[str, Array]:
    """Return chosen quantities as columns; those of several values are numbered from 1."""
    check_quantities(names)
    columns: dict[str, Array] = {}
    for name in names:
        values = getattr(history, name)
        if name == "time":
            continue
        if values.ndim == 1:
            columns[name] = values
        else:
            columns |= {f"{name}_{k}": column for k, column in enumerate(values.T, 1)}
    return columns
