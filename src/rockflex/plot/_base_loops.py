"""What a base went through: its resisting moment over the rotation, and the force and elongation of its elements."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from rockflex._arrays import Array
from rockflex._constants import GRAVITY
from rockflex._errors import InputError
from rockflex.modal import BaseElement, FrictionDamper, RockingProperties, Tendon, ViscousDamper, YieldingDissipator
from rockflex.plot._curves import curves_of, title_of
from rockflex.plot._style import GREEN, ORANGE, PURPLE, RED, SKY
from rockflex.plot._units import short
from rockflex.response import (
    History,
    MomentRotation,
    MomentRotationOnSprings,
    Response,
    element_resistance,
    large_resistance,
    resistance_on_springs,
    weight_resistance,
)

COLORS = (SKY, ORANGE, PURPLE, GREEN, RED, "#7a5195")  # of elements, in their order
_KINDS: dict[type[BaseElement], str] = {
    Tendon: "tendon",
    YieldingDissipator: "fuse",
    ViscousDamper: "viscous damper",
    FrictionDamper: "friction damper",
}


@dataclass(frozen=True, eq=False)
class BaseLoops:
    """The path of a base, without the states in contact, and that of its elements.

    Attributes
    ----------
    title
        Name of the motion; empty for a quasi-static path.
    elements
        The elements, in their order.
    rotation
        θ in rad, shape (n,).
    weight, parts
        Contributions to the resisting moment in N m: of the weight, shape (n,), and of the elements, shape (n, E).
    elongation, force
        δ in m and F in N of the elements, also in contact, shape (m, E).
    springs
        Contribution of the springs under the base in N m, shape (n,); None on rigid ground.
    edges
        Rise of the left and of the right edge of a base on springs in m, shape (n, 2); None on rigid ground.
    """

    title: str
    elements: tuple[BaseElement, ...]
    rotation: Array
    weight: Array
    parts: Array
    elongation: Array
    force: Array
    springs: Array | None = None
    edges: Array | None = None

    @property
    def moment(self) -> Array:
        """Resisting moment in N m, shape (n,)."""
        held = self.weight + self.parts.sum(axis=1)
        return held if self.springs is None else held + self.springs


def base_loops(result: MomentRotation | MomentRotationOnSprings | Response) -> BaseLoops:
    """Return the path of a base from a cyclic pushover, or from the history of a run.

    Raises
    ------
    InputError
        If `result` is neither, has no history, or is of a base that cannot lift.
    """
    if isinstance(result, MomentRotation | MomentRotationOnSprings):
        on_springs = isinstance(result, MomentRotationOnSprings)
        return BaseLoops(
            title="",
            elements=result.elements,
            rotation=result.rotation,
            weight=result.weight_moment,
            parts=result.element_moment,
            elongation=result.element_elongation,
            force=result.element_force,
            springs=result.spring_moment if on_springs else None,
            edges=result.edge_uplift if on_springs else None,
        )
    given: Any = result
    if not hasattr(given, "history"):
        raise InputError(
            f"result must be a Response or a MomentRotation, but {type(given).__name__} was given. Give what simulate "
            "or moment_rotation returned."
        )
    (curve,) = curves = curves_of(result)
    if not curve.lifts:
        raise InputError(
            "The base of this response cannot lift, so it has no loops. Give the response of a model that rocks, such "
            'as "2DOF-S".'
        )
    history, kept = curve.history, curve.before_fall
    title, elements = title_of(curves, None), history.model.properties.elements
    resistance = resistance_on_springs(history)
    if resistance is not None:
        return BaseLoops(
            title=title,
            elements=elements,
            rotation=history.rotation[kept],
            weight=resistance.weight[kept],
            parts=resistance.elements[kept],
            elongation=history.element_elongation[kept],
            force=history.element_force[kept],
            springs=resistance.springs[kept],
            edges=history.edge_uplift[kept],
        )
    rocking = np.flatnonzero(history.side[kept] != 0.0)
    weight, parts = resistance_of(history)
    return BaseLoops(
        title=title,
        elements=elements,
        rotation=history.rotation[rocking],
        weight=weight[rocking],
        parts=parts[rocking],
        elongation=history.element_elongation[kept],
        force=history.element_force[kept],
    )


def resistance_of(history: History) -> tuple[Array, Array]:
    """Return what the weight (n,) and the elements (n, E) add to the resisting moment in N m; zero in contact."""
    p, side = history.model.properties, history.side.astype(np.int64)
    heavier = 1.0 + history.vertical_ground_acceleration / GRAVITY
    if history.model.complete:
        weight, parts = large_resistance(p, side, history.rotation, history.element_force)
        return heavier * weight, parts
    weight = weight_resistance(p, side, history.rotation)
    return heavier * weight, element_resistance(p, side, history.element_force)


def follows_a_line(properties: RockingProperties) -> bool:
    """Whether the resisting moment depends on the rotation alone: all elements are tendons that stay elastic."""
    return all(isinstance(each, Tendon) and each.post_yield_ratio is None for each in properties.elements)


def name_of(element: BaseElement, number: int) -> str:
    """Name of an element in a figure, with its number, counted from 1, and its position."""
    return f"{number} {_KINDS[type(element)]}, x = {short(element.position)} m"
