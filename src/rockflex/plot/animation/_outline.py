"""The shape that a structure is drawn with: its heights, how its modes move them, and its kind."""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from rockflex._arrays import Array
from rockflex._errors import InputError
from rockflex.modal import RockingProperties
from rockflex.response import History
from rockflex.structure import CantileverWithTipMass, Eccentric, FishBone, Frame, LumpedStructure, Restrained

Kind = Literal["block", "frame", "column", "mast"]
MOST_POINTS = 60  # heights of a structure that are drawn
_STORIES = (Frame, FishBone, LumpedStructure)
_SAME = 1e-6  # relative difference of two widths of the same base


@dataclass(frozen=True, eq=False)
class Outline:
    """What is drawn of a structure at rest, in m from the axis of its masses and from the base.

    Attributes
    ----------
    kind
        ``"block"`` (rigid), ``"frame"`` (columns and floors), ``"column"`` or ``"mast"`` (a column with a mass on top).
    heights
        From zero at the base to the top, ascending, shape (m,).
    shapes
        Horizontal displacement of these points per unit of each D_n, relative to the base, shape (m, n).
    left, right
        Edges of the base.
    """

    kind: Kind
    heights: Array
    shapes: Array
    left: float
    right: float

    @property
    def top(self) -> float:
        """Height of the top above the base in m."""
        return float(self.heights[-1])

    @property
    def size(self) -> float:
        """The larger of height and width in m."""
        return max(self.top, self.right - self.left)


def outline_of(history: History, structure: Any | None, place: int) -> Outline:
    """Return the outline of the structure of a response, number `place` of those given.

    Without the structure itself, floors are drawn where its properties have them, and otherwise a straight line.

    Raises
    ------
    InputError
        If the structure is none, or not that of the response.
    """
    p = history.model.properties
    edges = -p.pivot(-1).arm, p.pivot(1).arm
    if not p.n_modes:
        heights = np.array([0.0, p.top_height or 2.0 * p.l0r / p.m_tot])
        return Outline("block", heights, np.zeros((2, 0)), *edges)
    if structure is not None and not isinstance(structure, RockingProperties):
        return Outline(_kind(structure), *_modal(structure, p, place), *edges)
    if p.floors is not None:
        stories = p.floors.heights.size > 1
        return Outline("frame" if stories else "mast", *_based(p.floors.heights, p.floors.displacement), *edges)
    top = p.top_height or 1.25 * float(np.abs(p.effective_height).max())
    return Outline("column", *_based(np.array([top]), p.top_ordinate[None, :]), *edges)


def _kind(structure: Any) -> Kind:
    while isinstance(structure, Restrained | Eccentric):
        structure = structure.structure
    if isinstance(structure, CantileverWithTipMass):
        return "mast"
    return "frame" if isinstance(structure, _STORIES) else "column"


def _modal(structure: Any, p: RockingProperties, place: int) -> tuple[Array, Array]:
    """Return heights and shapes from the modes of the structure."""
    if not hasattr(structure, "modal"):
        raise InputError(
            f"structure must be that of responses[{place}], such as a Frame, but {type(structure).__name__} was given. "
            "Give what simulate was given, or leave it out.",
            field="structure",
        )
    modes, own = structure.modal(), structure.rocking()
    if own.n_modes < p.n_modes or abs(own.half_width - p.half_width) > _SAME * p.half_width:
        raise InputError(
            f"structure is not that of responses[{place}]: it has {own.n_modes} modes and B = {own.half_width:g} m, "
            f"and the response {p.n_modes} modes and B = {p.half_width:g} m. Give what simulate was given, one for "
            "each response if they differ, or leave it out.",
            field="structure",
        )
    return _based(modes.heights, (modes.shapes * modes.participation)[:, : p.n_modes])


def _based(heights: Array, shapes: Array) -> tuple[Array, Array]:
    """Add the base, order the points by height, and leave some out where there are very many."""
    order = np.argsort(heights, kind="stable")
    kept = order[np.unique(np.linspace(0, order.size - 1, min(MOST_POINTS, order.size)).astype(int))]
    return np.append(0.0, heights[kept]), np.vstack((np.zeros(shapes.shape[1]), shapes[kept]))
