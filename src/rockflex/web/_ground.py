"""The ground of the page: what it is under a structure, what the drawing needs of it, and how a base moves on it."""

import math
from typing import Any

import numpy as np

from rockflex._arrays import Array
from rockflex._errors import InputError
from rockflex.modal import Ground, RockingProperties
from rockflex.response import History
from rockflex.study._ground_table import GroundTable
from rockflex.web._refusal import Refusal

DRAWN = 9  # springs of a drawing, at most


def ground_of(table: GroundTable | None, p: RockingProperties) -> Ground | None:
    """Return the ground under a structure, None if it is rigid and the base cannot slide.

    Raises
    ------
    Refusal
        If its values contradict each other, at the field at fault.
    """
    try:
        return None if table is None else table.under(p)
    except InputError as error:
        raise Refusal({error.field or "ground": error.said}) from error


def ground_view(ground: Ground | None, p: RockingProperties) -> dict[str, Any] | None:
    """Return where the springs of a drawing are, how far the base settles, and the ground's stiffness and damping."""
    if ground is None:
        return None
    view: dict[str, Any] = {"slides": ground.slides, "springs": [], "facts": []}
    if ground.springs is None:
        return view
    springs = ground.springs
    kept = np.unique(np.linspace(0, springs.n - 1, min(springs.n, DRAWN)).round().astype(int))
    settlement = p.resting_reaction / springs.total_stiffness
    ratio = 0.5 * springs.total_damping / math.sqrt(springs.total_stiffness * p.m_tot)
    return view | {
        "springs": springs.positions[kept],
        "settlement": settlement,
        "facts": [
            _fact("w", 1e3 * settlement, "mm", "settlement of the axis under the weight"),
            _fact("Σk", springs.total_stiffness, "N/m", "vertical stiffness of all springs"),
            _fact("Σkx²", springs.rotational_stiffness, "N m/rad", "rotational stiffness of all springs"),
            _fact("ζ_z", ratio, "", "damping of the heave mode, as a share of critical"),
            _fact("I_b", ground.base_inertia, "kg m²", "rotary inertia of base and floors"),
        ],
    }


def _fact(symbol: str, value: float | None, unit: str, said: str) -> dict[str, Any]:
    return {"symbol": symbol, "value": value, "unit": unit, "help": said}


def base_curves(history: History) -> dict[str, Array]:
    """Return how the base of a history moves on its ground, in m, shapes (n_states,); none on rigid ground.

    The slip if it can slide, and on springs the heave and the rise of the edges.
    """
    curves: dict[str, Array] = {}
    layout = history.model.layout
    if layout.slip >= 0:
        curves["slip"] = history.slip
    if layout.heave >= 0:
        left, right = history.edge_uplift.T
        curves |= {"heave": history.heave, "left_edge": left, "right_edge": right}
    return curves
