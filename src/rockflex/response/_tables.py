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

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

History = Any  # rockflex.response.History, which imports this module

UNITS_OF_HISTORY = {
    "time": "s",
    "side": "",
    "ground_acceleration": "m/s2",
    "rotation": "rad",
    "rotation_velocity": "rad/s",
    "top_displacement": "m",
    "total_top_displacement": "m",
    "base_moment": "N m",
    "base_shear": "N",
    "horizontal_reaction": "N",
    "vertical_reaction": "N",
}
"""The columns of every history, with their units."""
UNITS_OF_GROUND = {
    "vertical_ground_acceleration": "m/s2",
    "slip": "m",
    "slip_velocity": "m/s",
    "heave": "m",
    "left_edge_uplift": "m",
    "right_edge_uplift": "m",
    "spring_force": "N",
}
"""Units of further columns; those of the springs have a number, from 1, at the end of their names."""
OTHERS = {
    "rotation_acceleration": "rad/s2",
    "modal_displacement": "m",
    "modal_velocity": "m/s",
    "modal_acceleration": "m/s2",
    "story_drift": "m",
    "story_shear": "N",
    "floor_acceleration": "m/s2",
    "total_floor_displacement": "m",
    "element_force": "N",
    "element_elongation": "m",
    "tendon_force": "N",
    "edge_uplift": "m",
    "soil_pressure": "Pa",
    "bearing_pressure": "Pa",
    "friction_demand": "",
    "yielding": "",
    "uplifted": "",
}
QUANTITIES = UNITS_OF_HISTORY | {name: unit for name, unit in UNITS_OF_GROUND.items() if "_edge_" not in name} | OTHERS
"""Every quantity of a history at its states, with its unit."""
RESULT_UNITS = {
    "duration": "s",
    "end_time": "s",
    "time_of_max_*": "s",
    "time_of_min_*": "s",
    "max_rotation": "rad",
    "max_top_displacement": "m",
    "max_total_top_displacement": "m",
    "max_base_moment": "N m",
    "max_base_shear": "N",
    "max_horizontal_reaction": "N",
    "min_vertical_reaction": "N",
    "max_tendon_force": "N",
    "max_element_force_*": "N",
    "max_element_elongation_*": "m",
    "element_energy_*": "J",
    "residual_drift_*": "m",
    "residual_rotation": "rad",
    "max_slip": "m",
    "residual_slip": "m",
    "max_edge_uplift": "m",
    "max_edge_settlement": "m",
    "sliding_time": "s",
    "nominal_limit": "rad",
    "distance_km": "km",
}
"""Units of the columns of runs; a star stands for any letters."""
DIMENSIONS = {
    **dict.fromkeys(("modal_displacement", "modal_velocity", "modal_acceleration"), "mode"),
    **dict.fromkeys(("story_drift", "story_shear", "floor_acceleration", "total_floor_displacement"), "floor"),
    **dict.fromkeys(("element_force", "element_elongation"), "element"),
    **dict.fromkeys(("spring_force", "soil_pressure"), "spring"),
    "tendon_force": "tendon",
    "edge_uplift": "edge",
}
"""The second dimension of quantities with several values."""


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
            dims = ("time", DIMENSIONS[name])
            labels[dims[1]] = ["left", "right"] if dims[1] == "edge" else np.arange(values.shape[1]) + 1
        variables[name] = (dims, values, {"units": QUANTITIES[name]} if QUANTITIES[name] else {})
    return xr.Dataset(variables, labels, {"model": history.model.label})


def history_values(history: History, quantities: Sequence[str] | None) -> dict[str, Array]:
    """Return quantities of a history at its states, but for the time; None: all that are not empty."""
    names = [name for name in QUANTITIES if hasattr(history, name)] if quantities is None else quantities
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

    These are `UNITS_OF_HISTORY`, the quantities of `more`, and `ground_columns`. The total displacement is NaN where
    the height of the top is not history.
    """
    missing = np.full(history.states.shape[0], math.nan)
    found = {name: getattr(history, name, missing) for name in UNITS_OF_HISTORY}
    return found | {name: getattr(history, name) for name in more} | ground_columns(history)


def ground_columns(history: History) -> dict[str, Array]:
    """Return what a history has beyond that of a base that stands on rigid ground, each of shape (n_states,).

    The vertical acceleration of the ground if there is any, the slip if the base can slide, and on springs the heave,
    the rise of the edges and the force of every spring.
    """
    columns: dict[str, Array] = {}
    if history.vertical_ground_acceleration.any():
        columns["vertical_ground_acceleration"] = history.vertical_ground_acceleration
    if history.model.layout.slip >= 0:
        columns |= {"slip": history.slip, "slip_velocity": history.slip_velocity}
    if history.model.springs is not None:
        left, right = history.edge_uplift.T
        columns |= {"heave": history.heave, "left_edge_uplift": left, "right_edge_uplift": right}
        columns |= {f"spring_force_{k}": force for k, force in enumerate(history.spring_force.T, 1)}
    return columns


def check_quantities(names: Any) -> None:
    """Raise an InputError unless these are names of quantities at the states of a history, each once."""
    listed = isinstance(names, list | tuple)
    wrong = [name for name in names if not is_one_of(name, QUANTITIES)] if listed else [names]
    if wrong or len(set(names)) < len(names):
        what = f"{shown(wrong[0])} was" if wrong else f"{shown(list(names))} were"
        near = get_close_matches(str(wrong[0]), QUANTITIES, 1) if wrong and listed else []
        hint = f" Did you mean {near[0]!r}?" if near else ""
        raise InputError(
            f"quantities must be a list of different names of quantities, such as ['rotation', 'base_moment'], but "
            f"{what} given.{hint} There are: {', '.join(QUANTITIES)}.",
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
