"""How a structure looks: its lines and what holds it, at rest, how each of their points moves, and a small drawing."""

import math
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple, TypeAlias

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.foundation.html import html_table, svg_picture
from rockflex.foundation.number_format import rounded_number, unit_with_prefix
from rockflex.structure._analysis import ModalProperties
from rockflex.structure._base_element import BaseElement
from rockflex.structure._rocking import RockingProperties

Kind = Literal["block", "frame", "column", "mast"]
GROUND, UPRIGHT, BODY = 0.0, 1.0, 2.0
"""How a point moves: not at all, sideways with its floor, or with the structure, which turns and bends."""

MAX_HEIGHTS = 40  # heights of a structure that are drawn, besides the base
_MAX_THICK_FLOORS = 25
_MAX_COLUMNS = 12  # columns of a podium that are drawn
_HTML_HEIGHT, _HTML_WIDTH, _HTML_EDGE = 170.0, 260.0, 8.0  # pixels of the drawing in a notebook
_COLUMN, _LEANING, _BRACE = 0.82, 1.8, 0.6  # x over the distance from the axis to the nearer edge
_MASS, _BRACKET, _MAX_BRACKET, _TENDON, _SUNK = 0.06, 0.16, 0.4, 0.6, 0.02  # lengths over the height

_FUSE = [(3.5, 0.0), (3.5, 0.26), (1.2, 0.36), (1.2, 0.64), (3.5, 0.74), (3.5, 1.0)]
Symbol: TypeAlias = list[tuple[list[tuple[float, float]], float, bool]]
SYMBOLS: dict[str, Symbol] = {
    "tendons": [([(0.0, 0.0), (0.0, 1.0)], 1.5, False)],
    "fuse": [([(-x, y) for x, y in _FUSE] + _FUSE[::-1], 1.0, True)],  # thick where held, narrow where it yields
    "damper": [  # a piston in a cylinder
        ([(0.0, 0.0), (0.0, 0.2)], 1.8, False),
        ([(-5.0, 0.75), (-5.0, 0.2), (5.0, 0.2), (5.0, 0.75)], 1.8, False),
        ([(-3.2, 0.5), (3.2, 0.5)], 2.6, False),
        ([(0.0, 0.5), (0.0, 1.0)], 1.8, False),
    ],
    "friction": [  # two plates with the bolt that clamps them
        ([(-1.7, 0.0), (-1.7, 0.68)], 3.0, False),
        ([(1.7, 0.32), (1.7, 1.0)], 3.0, False),
        ([(-6.0, 0.5), (6.0, 0.5)], 1.8, False),
    ],
    "law": [([(0.0, 0.0), (0.0, 1.0)], 1.5, False)],  # an element given by its branches
    "spring": [([(0, 0), (0, 0.12), (1, 0.24), (-1, 0.4), (1, 0.56), (-1, 0.72), (0, 0.88), (0, 1)], 1.4, False)],
}
"""Lines of what holds a base: points (pixels across, share of the length), width in pixels, and whether it is filled.

A spring is 1 wide to either side. The others are named after their colours on the page.
"""

ELEMENT_COLORS = {"tendons": "#b5558a", "fuse": "#6b7a00", "damper": "#0f7f8c", "friction": "#7d5a30", "law": "#5b4b8a"}
DARK_ELEMENT_COLORS = {
    "tendons": "#de9cc4",
    "fuse": "#b9c94a",
    "damper": "#4cc3cf",
    "friction": "#d0a875",
    "law": "#b3a4ee",
}
"""Colours of the symbols on a light and on a dark background, in figures and on the page."""

Masses: TypeAlias = tuple[tuple[float, float], ...]
"""Heights in m and masses in kg, from the bottom to the top."""


class DrawnStructure:
    """A structure that says how it looks; notebooks show it as a small drawing with five of its parameters."""

    def outline_kind(self) -> Kind:
        """Return what its drawing shows above the base."""
        return "column"

    def concentrated_masses(self) -> Masses:
        """Return the masses that it carries at single heights, without the base and what leans."""
        return ()

    def half_widths(self, heights: Array) -> Array | None:
        """Return half of its width in m at some heights above the base; None if it is drawn as a line."""
        del heights
        return None

    def _repr_html_(self) -> str:
        return _structure_html(self)


def innermost_structure(structure: Any) -> Any:
    """Return what stands on an eccentric base, is restrained, or is modified in another way."""
    while hasattr(structure, "structure"):
        structure = structure.structure
    return structure


def has_shapes(structure: Any) -> bool:
    """Tell whether the shapes of the modes of a structure are known; its `RockingProperties` have none."""
    return structure is not None and not isinstance(innermost_structure(structure), RockingProperties)


class Stroke(NamedTuple):
    """A line of a drawing: x and z in m and how it moves of each point, shape (k, 3); width in pixels; if filled."""

    points: Array
    width: float
    filled: bool = False


@dataclass(frozen=True, eq=False)
class StructureOutline:
    """Lines of a structure at rest, in m from the axis of its masses and from the base.

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
    strokes
        Lines of the structure, from the back to the front; the last is the base.
    elements
        The symbol of each element, and both ends as the points of a stroke, shape (2, 3); the ground comes first.
    masses
        Height in m and mass in kg of what is concentrated on the structure, without the base and what leans; none where
        the mass is distributed or not known.
    joints
        Heights of the joints above the base.
    turning
        Height in m up to which points move by a unit of θ as far as they are high; others move as far as this one.
    """

    kind: Kind
    heights: Array
    shapes: Array
    left: float
    right: float
    strokes: tuple[Stroke, ...]
    elements: tuple[tuple[str, Array], ...]
    masses: Masses = ()
    joints: tuple[float, ...] = ()
    turning: float = math.inf

    def sway(self, displacement: Array, joint_rotation: Array) -> Array:
        """Return how far the points at `heights` move relative to the turned base in m, shape (k, m).

        By the displacements of the modes in m, (k, n), and the rotations of the joints above the base in rad, (k, J).
        """
        levers = np.maximum(self.heights[:, None] - np.array(self.joints), 0.0)
        return (
            displacement @ self.shapes[:, : displacement.shape[1]].T
            + joint_rotation @ levers.T[: joint_rotation.shape[1]]
        )

    @property
    def top(self) -> float:
        """Height of the top above the base in m."""
        return float(self.heights[-1])

    @property
    def size(self) -> float:
        """The larger of height and width in m."""
        return max(self.top, self.right - self.left)


def structure_outline(p: RockingProperties, structure: Any | RockingProperties | None) -> StructureOutline:
    """Return the outline of a structure with some properties.

    Without the structure itself, floors are drawn where the properties have them, and otherwise a straight line to the
    top, or a block as high as its centre of mass is twice. The structure has at least as many modes as `p`.
    """
    modes = None
    if not p.n_modes:
        kind: Kind = "block"
    elif has_shapes(structure):
        modes = structure.modal()  # pyright: ignore[reportOptionalMemberAccess, reportAttributeAccessIssue]
        kind = structure.outline_kind() if isinstance(structure, DrawnStructure) else "column"
    elif p.floors is not None:
        kind = "frame" if p.floors.heights.size > 1 else "mast"
    else:
        kind = "column"
    heights, shapes = _heights_and_shapes(p, modes)
    if p.columns is not None:
        return _podium_outline(p, structure, kind, heights, shapes)
    left, right = -p.pivot(-1).arm, p.pivot(1).arm
    top, base = heights[-1], _stroke([left, right], 0.0, 5.0)
    behind = [_stroke(left if side > 0 else right, [0.0, top], 8.0, GROUND) for side in p.sides if len(p.sides) == 1]
    inner = innermost_structure(structure)
    wide = inner.half_widths(heights) if isinstance(inner, DrawnStructure) and kind != "block" else None
    gaps = [_stroke([-each.half_width, each.half_width], each.height, 4.0) for each in p.joints]
    body = _body_strokes(kind, heights, left, right, wide, leaning=p.leaning_mass > 0.0)
    strokes = (*behind, *body, *gaps, base)
    ends = [np.array(_element_ends(each, p, top, left, right)) for each in p.elements]
    held = tuple((each.symbol, end) for each, end in zip(p.elements, ends, strict=True))
    masses, joints = _concentrated_masses(kind, p, structure), tuple(each.height for each in p.joints)
    return StructureOutline(kind, heights, shapes, left, right, strokes, held, masses, joints)


def _podium_outline(
    p: RockingProperties, structure: Any, kind: Kind, heights: Array, shapes: Array
) -> StructureOutline:
    """Return the outline of a building on columns, which stands on their heads and does not turn with them."""
    assert p.columns is not None
    height, given = p.columns.height, structure
    while hasattr(given, "structure") and not hasattr(given, "n_columns"):
        given = given.structure
    number, width = min(getattr(given, "n_columns", 2), _MAX_COLUMNS), getattr(given, "column_width", p.half_width)
    spread = getattr(given, "column_spacing", None) or max(3.0 * width, 0.6 * float(heights[-1]) / max(number - 1, 1))
    places = (spread * (np.arange(number) - 0.5 * (number - 1))).tolist()
    edge, how = places[-1] + 0.5 * width, np.array([GROUND, GROUND, UPRIGHT, UPRIGHT, GROUND])
    around, up = np.array([-0.5, 0.5, 0.5, -0.5, -0.5]) * width, np.array([0.0, 0.0, height, height, 0.0])
    columns = [_stroke(x + around, up, 1.6, how, filled=True) for x in places]
    body = [
        _stroke(each.points[:, 0], each.points[:, 1] + height, each.width, UPRIGHT, filled=each.filled)
        for each in _body_strokes(kind, heights, -edge, edge, None, leaning=False)
    ]
    lifted = np.array([0.0, height, UPRIGHT - BODY])
    held = tuple(
        (each.symbol, np.array(_element_ends(each, p, heights[-1], -edge, edge)) + lifted) for each in p.elements
    )
    masses = tuple((z + height, mass) for z, mass in _concentrated_masses(kind, p, structure))
    slab = _stroke([-edge, edge], height, 5.0, UPRIGHT)
    still = np.zeros((1, shapes.shape[1]))
    return StructureOutline(
        kind,
        np.array([0.0, *(heights + height)]),
        np.vstack((still, shapes)),
        -edge,
        edge,
        (*columns, *body, slab),
        held,
        masses,
        turning=height,
    )


def _concentrated_masses(kind: Kind, p: RockingProperties, structure: Any) -> Masses:
    if kind == "block":
        return ((p.l0r / p.m_tot, p.m_tot),)
    if isinstance(structure, DrawnStructure):
        return structure.concentrated_masses()
    if p.floors is None or p.base_mass is None or p.leaning_mass:
        return ()
    found = p.floors.force @ (1.0 / p.omega**2)  # all of them if all modes are there
    whole = math.isclose(float(found.sum()), p.m_tot - p.base_mass, rel_tol=1e-6)
    return tuple(zip(p.floors.heights.tolist(), found.tolist(), strict=True)) if whole else ()


def _heights_and_shapes(p: RockingProperties, modes: ModalProperties | None) -> tuple[Array, Array]:
    if modes is not None:
        heights, shapes = modes.heights, (modes.shapes * modes.participation)[:, : p.n_modes]
    elif p.floors is not None:
        heights, shapes = p.floors.heights, p.floors.displacement
    else:
        usual = 1.25 * float(np.abs(p.effective_height).max()) if p.n_modes else 2.0 * p.l0r / p.m_tot
        heights, shapes = np.array([p.top_height or usual]), p.top_ordinate[None, :]
    order = np.argsort(heights, kind="stable")  # those of freedoms may come in any order
    kept = order[np.unique(np.linspace(0, order.size - 1, min(MAX_HEIGHTS, order.size)).astype(int))]
    return np.append(0.0, heights[kept]), np.vstack((np.zeros(shapes.shape[1]), shapes[kept]))


def _stroke(x: Any, z: Any, width: float, how: Any = BODY, *, filled: bool = False) -> Stroke:
    return Stroke(np.column_stack(np.broadcast_arrays(x, z, how)), width, filled)


def _body_strokes(
    kind: Kind, heights: Array, left: float, right: float, wide: Array | None, *, leaning: bool
) -> list[Stroke]:
    """Return the lines above the base; a column beside a frame on a hinge, which its floors hold, if some lean."""
    near, top = min(-left, right), heights[-1]
    if kind == "block":
        return [_stroke([left, right, right, left, left], [0.0, 0.0, top, top, 0.0], 2.0, filled=True)]
    if wide is not None:
        around = np.concatenate([heights, heights[::-1], heights[:1]])
        return [_stroke(np.concatenate([-wide, wide[::-1], -wide[:1]]), around, 2.0, filled=True)]
    if kind != "frame":
        mass = [_stroke([-_MASS * top, _MASS * top], top, 12.0)] if kind == "mast" else []
        return [_stroke(0.0, heights, 5.0), *mass]
    x, floors = _COLUMN * near, heights[1:]
    found = [_stroke(side, heights, 2.4) for side in (-x, x)]
    found += [_stroke([-x, x], z, 3.2 if floors.size <= _MAX_THICK_FLOORS else 1.0) for z in floors]
    if leaning:
        beside = _LEANING * near
        found.append(_stroke(beside, heights, 1.6, np.append(GROUND, np.full(floors.size, UPRIGHT))))
        found += [_stroke([x, beside], z, 0.8, [BODY, UPRIGHT]) for z in floors]
    return found


def _element_ends(
    element: BaseElement, p: RockingProperties, top: float, left: float, right: float
) -> list[tuple[float, float, float]]:
    """Return both ends of a brace, of a tie to the ground or an abutment beside it, or of what is under the base."""
    if element.between is not None and p.floors is not None:
        x, heights = _BRACE * min(-left, right), np.append(0.0, p.floors.heights)
        return [(side, float(heights[floor]), BODY) for side, floor in zip((-x, x), element.between, strict=True)]
    if element.height is not None:
        lean = math.sqrt(1.0 - element.cosine**2) / abs(element.cosine)
        reach = min(max(2.5 * max(-left, right), 0.5 * top), element.height / max(lean, 1e-9))
        foot = (-math.copysign(reach, element.cosine), element.height - lean * reach, GROUND)
        return [foot, (0.0, element.height, BODY)]
    x = element.position
    if element.prestressed:
        return [(x, -_SUNK * top, GROUND), (x, _TENDON * top, BODY)]
    return [(x, 0.0, GROUND), (x, min(_BRACKET * max(top, right - left), _MAX_BRACKET * top), BODY)]


def _structure_html(structure: Any) -> str:
    """Return the drawing of a structure and T_1, m*_1, h*_1, I_θ and M_r as HTML."""
    p: RockingProperties = structure.rocking()
    moment = p.resisting_moment
    size, unit = unit_with_prefix(moment, "N m")
    rows = {
        "": svg_picture(_outline_svg(structure_outline(p, structure)), "structure"),
        "T₁": f"{rounded_number(2.0 * math.pi / float(p.omega[0]))} s",
        "m*₁": f"{rounded_number(float(p.effective_mass[0]))} kg",
        "h*₁": f"{rounded_number(float(p.effective_height[0]))} m",
        "I_θ": f"{p.i_theta:.4g} kg m²",
        "M_r": f"{rounded_number(moment / size)} {unit}",
    }
    return html_table(type(structure).__name__, rows)


def _outline_svg(o: StructureOutline) -> tuple[float, float, list[str]]:
    """Return width, height and elements of the drawing of a structure."""
    points = np.concatenate([*(each.points for each in o.strokes), *(ends for _, ends in o.elements)])
    left, right = float(points[:, 0].min()), float(points[:, 0].max())
    zoom = min((_HTML_WIDTH - 2.0 * _HTML_EDGE) / (right - left), (_HTML_HEIGHT - 3.0 * _HTML_EDGE) / o.top)
    width, height = zoom * (right - left) + 4.0 * _HTML_EDGE, zoom * o.top + 3.0 * _HTML_EDGE
    ground = height - 2.0 * _HTML_EDGE

    def at(x: float, z: float) -> tuple[float, float]:
        return 2.0 * _HTML_EDGE + zoom * (x - left), ground - zoom * z

    drawn = [_svg_line([(0.0, ground + 3.0), (width, ground + 3.0)], 1.0, "#8c8c8c")]
    drawn += [
        _svg_line([at(*point[:2]) for point in each.points], 0.75 * each.width, "currentColor", filled=each.filled)
        for each in o.strokes
    ]
    for symbol, ends in o.elements:
        start, end = (np.array(at(*point[:2])) for point in ends)
        along = end - start
        across = np.array([-along[1], along[0]]) / (float(np.hypot(*along)) or 1.0)
        for line, thick, filled in SYMBOLS[symbol]:
            places = [tuple(start + 0.7 * u * across + share * along) for u, share in line]
            drawn.append(_svg_line(places, max(0.6 * thick, 1.0), ELEMENT_COLORS[symbol], filled=filled))
    return width, height, drawn


def _svg_line(points: list[Any], thick: float, color: str, *, filled: bool = False) -> str:
    places = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    fill = f'{color}" fill-opacity="0.15' if filled else "none"
    return f'<polyline points="{places}" fill="{fill}" stroke="{color}" stroke-width="{thick:g}"/>'
