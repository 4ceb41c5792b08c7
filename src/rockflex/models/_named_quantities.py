"""The response quantities by name."""

from collections.abc import Callable, Iterable

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.models._elements import LEFT, RIGHT
from rockflex.models._quantities import (
    CLIMB,
    HORIZONTAL,
    LEFT_OUT,
    LIFT,
    LINEAR,
    SWAY,
    SWING,
    Quantities,
    Share,
    collected_quantities,
    joined_quantities,
)
from rockflex.models._rocking_model import RockingModel
from rockflex.structure._analysis import FloorModes
from rockflex.structure._rocking import RockingProperties


def quantities(model: RockingModel, names: Iterable[str]) -> Quantities:
    """Return scalar quantities of the whole structure by name.

    `top_displacement` (m); `base_moment` (N m) and `base_shear` (N) of the elastic forces, or of those of Eq. 37,
    including the missing mass if the model does; `total_top_displacement` (m), zero if the height of the top is not
    known; `horizontal_reaction` (N), Eq. 21 for small rotations.
    """
    return collected_quantities(model.properties.n_modes, [_WHOLE[name](model) for name in names])


def _top_displacement(model: RockingModel) -> Share:
    return LINEAR, {"displacement": model.properties.top_ordinate}


def _base_moment(model: RockingModel) -> Share:
    p = model.properties
    return _base_force(model, p.effective_mass * p.moment_heights, 1)


def _base_shear(model: RockingModel) -> Share:
    return _base_force(model, model.properties.effective_mass, 0)


def _base_force(model: RockingModel, masses: Array, moment: int) -> Share:
    """Return Σ m* h*^k ω² D minus Σ m_i h_i^k (a + h_i θ'') of the masses left out, which move with the base."""
    if not model.missing_mass:
        return LINEAR, {"restoring": masses}
    left = model.properties.mass_left_out
    return LEFT_OUT, {"restoring": masses, "ground": -left[moment], "turn": -left[moment + 1]}


def _total_top_displacement(model: RockingModel) -> Share:
    p = model.properties
    if not p.top_height:
        return LINEAR, {}
    found = {"displacement": p.top_ordinate, "rotation": p.top_height, "slip": 1.0}
    return SWAY, found | {"joint": levers_of_joints(p, p.top_height)} if p.joints else found


def levers_of_joints(properties: RockingProperties, heights: ArrayLike) -> Array:
    """Return how far each joint above the base moves points at some heights for a unit of its rotation, (.., J)."""
    joints = np.array([each.height for each in properties.joints])
    return np.maximum(np.asarray(heights, dtype=float)[..., None] - joints, 0.0)


def _horizontal_reaction(model: RockingModel) -> Share:
    """ΣF_x = (m_tot + Σ l) a + L_0^r θ'' + Σ m* D'', and what ties from a height pull."""
    p = model.properties
    found = {"acceleration": p.effective_mass, "turn": p.l0r, "ground": p.horizontal_mass, "ties": 1.0}
    return HORIZONTAL, found | {"joint_turn": [each.moment for each in p.joints]} if p.joints else found


def _slip(_model: RockingModel) -> Share:
    return LINEAR, {"slip": 1.0}


_WHOLE: dict[str, Callable[[RockingModel], Share]] = {
    "top_displacement": _top_displacement,
    "base_moment": _base_moment,
    "base_shear": _base_shear,
    "total_top_displacement": _total_top_displacement,
    "horizontal_reaction": _horizontal_reaction,
    "slip": _slip,
}


def floor_quantities(model: RockingModel, floors: FloorModes, names: Iterable[str]) -> Quantities:
    """Return quantities of the floors by name, N_floors each.

    `story_drift` (m): displacement of a floor minus that of the floor below, relative to the rotated base.
    `story_shear` (N): sum of the elastic forces at and above the floor. `total_floor_displacement` (m): horizontal,
    relative to the ground. `floor_acceleration` (m/s²): a + h θ'' + Σ Γ φ D'', for small rotations.
    """
    p = model.properties
    count, n, joints = floors.heights.size, p.n_modes, levers_of_joints(p, floors.heights)
    shapes = {
        "story_drift": {"displacement": np.diff(floors.displacement, axis=0, prepend=0.0)},
        "story_shear": {"restoring": np.cumsum((floors.force / p.omega**2)[::-1], axis=0)[::-1]},
        "total_floor_displacement": {
            "displacement": floors.displacement,
            "rotation": p.turning_heights(floors.heights),
            "slip": 1.0,
            "joint": joints,
        },
        "floor_acceleration": {
            "acceleration": floors.displacement,
            "turn": p.turning_heights(floors.heights),
            "ground": 1.0,
            "joint_turn": joints,
        },
    }
    kinds = {"total_floor_displacement": SWAY}
    return joined_quantities([Quantities.of(count, n, kinds.get(name, LINEAR), **shapes[name]) for name in names])


def modal_displacement(model: RockingModel, mode: int) -> Quantities:
    """Return D in m of one mode, counted from 0."""
    share = np.zeros(model.properties.n_modes)
    share[mode] = 1.0
    return Quantities.of(1, share.size, displacement=share)


def joint_rotations(model: RockingModel) -> Quantities:
    """Return the rotation of each joint above the base in rad."""
    count = len(model.joints)
    return Quantities.of(count, model.properties.n_modes, joint=np.eye(count))


def joint_forces(model: RockingModel) -> Quantities:
    """Return the axial force of each joint above the base in N, positive where it is pressed."""
    count = len(model.joints)
    return Quantities.of(count, model.properties.n_modes, joint_force=np.eye(count))


def rotation_by_side(model: RockingModel) -> Quantities:
    """Return the rotation to the right in rad (zero while rotated to the left), and likewise to the left."""
    return Quantities.of(2, model.properties.n_modes, rotation=[0.0, 1.0], right=[1.0, -1.0])


def tracked_elements(model: RockingModel) -> tuple[int, ...]:
    """Return the places of elements whose elongation does not follow from the rotation: attached ones and stories.

    On springs and of structures with joints that is every element.
    """
    return model.moving_places


def element_moves(model: RockingModel) -> Quantities:
    """Return δ of each of `tracked_elements` and its negative in m, less what it has in the state zero."""
    found = {
        name: np.stack((rows, -rows), axis=1).reshape(2 * len(rows), *rows.shape[1:])
        for name, rows in _elongation_shares(model).items()
    }
    kind = LIFT if model.complete else LINEAR
    return Quantities.of(2 * len(tracked_elements(model)), model.properties.n_modes, kind, **found)


def element_speeds(model: RockingModel) -> Quantities:
    """Return δ' of each of `tracked_elements` in m/s."""
    shares = {_RATES[name]: share for name, share in _elongation_shares(model).items()}
    kind = CLIMB if model.complete else LINEAR
    return Quantities.of(len(tracked_elements(model)), model.properties.n_modes, kind, **shares)


_RATES = {
    "displacement": "velocity",
    "slip": "slipping",
    "heave": "heaving",
    "rotation": "swing",
    "right": "right_swing",
    "joint": "joint_spin",
    "right_joint": "right_joint_spin",
}


def _elongation_shares(model: RockingModel) -> dict[str, Array]:
    """Return the shares of the elongations of `tracked_elements`, which depend on the sides of joints."""
    layout, places = model.layout, tracked_elements(model)
    rows, right = (
        np.array([model.stretch(place, model.stance_on(side)) for place in places]).reshape(len(places), -1)
        for side in (LEFT, RIGHT)
    )
    found = {"displacement": rows[:, : layout.modes], "rotation": rows[:, layout.rotation]}
    found["right"] = right[:, layout.rotation] - rows[:, layout.rotation]
    if layout.n_joints:
        joints = layout.rotations[1:]
        found |= {"joint": rows[:, joints], "right_joint": right[:, joints] - rows[:, joints]}
    shifts = {"slip": layout.slip, "heave": layout.heave}
    return found | {name: rows[:, place] for name, place in shifts.items() if place >= 0}


def rotation_rate_by_side(model: RockingModel) -> Quantities:
    """Return δ'/r, the rate of an element's elongation per unit distance from the pivot, in rad/s, to each side.

    That is θ' for small rotations; zero while rotated to the other side. It is one quantity if the sides do not differ.
    """
    n = model.properties.n_modes
    if not any(each.position for each in model.properties.elements) and model.properties.symmetric:
        return Quantities.of(1, n, SWING, swing=1.0)
    return Quantities.of(2, n, SWING, swing=[0.0, 1.0], right_swing=[1.0, -1.0])
