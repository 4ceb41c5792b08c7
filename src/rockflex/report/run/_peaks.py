"""The table of largest values, a row for each run."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rockflex._constants import GRAVITY
from rockflex.models import RockingModel
from rockflex.report.run._given import Given
from rockflex.report.run._numbers import moment_unit
from rockflex.report.run._sides import nominal_share
from rockflex.report.run._table import Cell, Table, shows
from rockflex.response import Response

STATUS = {"no_uplift": "no uplift", "rocking": "rocking", "overturned": "overturned"}
FELL = "†"


@dataclass(frozen=True)
class _Column:
    """A column of the table: its heading, its unit and the size of that, and the value of a run."""

    name: str
    unit: str
    size: float
    of: str
    value: Callable[[Response], float | None]


def peak_table(about: Given) -> Table:
    """Return the largest values of every run, with columns for what its base and ground do."""
    columns = _columns(about)
    rows: list[list[Cell]] = []
    for label, run, history in zip(about.labels, about.responses, about.histories, strict=True):
        fell = run.status == "overturned"
        passed = run.nominal_overturning
        words = STATUS[run.status] if history.model.lifts else "fixed base"
        status = Cell(f"{words} {FELL}" if fell else words, None, "status", passed)
        cells = [shows(column.value(run), column.of, column.size) for column in columns]
        rows.append([Cell(label), status, *cells, Cell(str(run.n_uplifts), run.n_uplifts, "n_uplifts")])
    heads = [("model", ""), ("status", ""), *((column.name, column.unit) for column in columns), ("uplifts", "")]
    return Table(heads, rows)


def _columns(about: Given) -> list[_Column]:
    runs = about.responses
    models: list[RockingModel] = [history.model for history in about.histories]
    size, unit = moment_unit(max(run.max_base_moment for run in runs))

    def peak(name: str) -> Callable[[Response], float]:
        return lambda run: float(getattr(run, name))

    columns = [
        _Column("θ_max", "mrad", 1e-3, "max_rotation", peak("max_rotation")),
        _Column(
            "θ_max/θ_nom",
            "%",
            0.01,
            "nominal_share",
            lambda run: _share(about, run),
        ),
        _Column("u_top relative", "mm", 1e-3, "max_top_displacement", peak("max_top_displacement")),
        _Column("u_top total", "mm", 1e-3, "max_total_top_displacement", peak("max_total_top_displacement")),
        _Column("V_b", "kN", 1e3, "max_base_shear", peak("max_base_shear")),
        _Column("M_b", unit, size, "max_base_moment", peak("max_base_moment")),
    ]
    if any(run.floors is not None for run in runs):
        columns.append(_Column("a_floor", "g", GRAVITY, "floor_acceleration", _floor_acceleration))
    columns += [
        _Column("ΣF_x", "kN", 1e3, "max_horizontal_reaction", peak("max_horizontal_reaction")),
        _Column("N_min", "kN", 1e3, "min_vertical_reaction", peak("min_vertical_reaction")),
    ]
    if any(model.layout.slip >= 0 for model in models):
        columns.append(_Column("slip", "mm", 1e-3, "max_slip", peak("max_slip")))
        columns.append(_Column("slip left", "mm", 1e-3, "residual_slip", peak("residual_slip")))
    if any(model.layout.heave >= 0 for model in models):
        columns.append(_Column("edge up", "mm", 1e-3, "max_edge_uplift", peak("max_edge_uplift")))
        columns.append(_Column("edge down", "mm", 1e-3, "max_edge_settlement", peak("max_edge_settlement")))
    return columns


def _share(about: Given, run: Response) -> float | None:
    if run.status == "overturned" or run.history is None:
        return None
    return nominal_share(about.properties, run, run.history)


def _floor_acceleration(run: Response) -> float | None:
    return None if run.floors is None else float(np.max(run.floors.floor_acceleration))
