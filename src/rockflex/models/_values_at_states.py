"""Accelerations and values of quantities at the states of a history."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from rockflex.foundation.arrays import Array
from rockflex.models._field_numbers import FieldNumbers, field_numbers
from rockflex.models._fields import RockingField
from rockflex.models._ground_fields import GroundField
from rockflex.models._phase import Key
from rockflex.models._quantities import LINEAR, Quantities, rows_of_quantities
from rockflex.models._rocking_model import RockingModel
from rockflex.models._state_layout import GROUND, HEADER, RISE, SIDE, TIME
from rockflex.models._vector_fields import field_of

Places = NDArray[np.intp]
_MAX_CODES = 2**31  # beyond which they are numbered anew, before they overflow


def acting_side(states: Array) -> Array:
    """Return the side of each state, shape (n,); for a contact of zero duration it is the side that follows."""
    side = states[:, SIDE].copy()
    following = np.append(states[1:, TIME] == states[:-1, TIME], False)
    for node in np.flatnonzero((side[1:] == 0.0) & (side[:-1] != 0.0)) + 1:
        end = int(node)
        while following[end] and side[end] == 0.0:
            end += 1
        if states[end, TIME] == states[node - 1, TIME]:
            side[node:end] = side[end]
    return side


def accelerations_at_states(model: RockingModel, states: Array) -> Array:
    """Return D''_1..D''_N in m/s² and q'' of the base, θ'' in rad/s² first, at every state, shape (n, N + b)."""
    side, layout = acting_side(states), model.layout
    n = layout.modes
    found = np.zeros((states.shape[0], n + layout.freedoms))
    if model.integrated:
        speeds = range(layout.spin, layout.spin + 2 * layout.freedoms, 2)
        for chosen, field in vector_fields_at_states(model, field_numbers(model), states, side):
            motion, shaking = _apart(states[chosen])
            rates = field.rates_along(motion, *shaking, counted=False)
            found[chosen] = rates[:, [*range(n, 2 * n), *speeds]]
        return found
    heavier = under_more_gravity(model) if states[:, RISE].any() else None
    for chosen, key, vector in states_by_phase(model, states, side):
        found[chosen] = vector @ model.accelerations(key).T
        if heavier is not None:
            more = heavier.accelerations(key) - model.accelerations(key)
            found[chosen] += states[chosen, RISE, None] * (vector @ more.T)
    return found


def under_more_gravity(model: RockingModel) -> RockingModel:
    """Return the model under a gravity greater by 1 m/s².

    The rows of a model vary linearly with gravity, and so with the vertical acceleration of the ground.
    """
    return replace(model, gravity=model.gravity + 1.0)


def rates_at_states(model: RockingModel, states: Array, found: Array) -> Array:
    """Return D', D'', θ', θ'' and those of slip and heave in the order of the state, (n, 2N + 2b)."""
    layout = model.layout
    n = layout.modes
    rates = [layout.velocities(states), found[:, :n]]
    for k in range(layout.freedoms):
        rates += [layout.of(states, layout.spin + 2 * k)[:, None], found[:, n + k, None]]
    return np.concatenate(rates, axis=1)


def quantities_at_states(model: RockingModel, quantities: Quantities, states: Array) -> Array:
    """Return the values of quantities at the states of a history (time, side, a, state), shape (n, F)."""
    side = acting_side(states)
    values = np.zeros((states.shape[0], len(quantities)))
    heavier = under_more_gravity(model) if states[:, RISE].any() else None
    for chosen, key, vector in states_by_phase(model, states, side):
        rows = rows_of_quantities(model, quantities, key)
        values[chosen] = vector @ rows.T
        if heavier is not None:
            more = rows_of_quantities(heavier, quantities, key) - rows
            values[chosen] += states[chosen, RISE, None] * (vector @ more.T)
    rocking = model.bends(side)
    if rocking.any() and (quantities.kinds != LINEAR).any():
        rates = rates_at_states(model, states, accelerations_at_states(model, states))
        numbers = field_numbers(model, quantities.kinds.tolist(), quantities.levers)
        values[rocking] = observed(model, numbers, states[rocking], side[rocking], rates[rocking], values[rocking])
    return values


def observed(
    model: RockingModel, numbers: FieldNumbers, states: Array, side: Array, rates: Array, rows: Array
) -> Array:
    """Return outputs at large rotations, (n, F), from their rows and D', D'', θ', θ'': see `rates_at_states`."""
    found = np.zeros(rows.shape)
    for chosen, field in vector_fields_at_states(model, numbers, states, side):
        motion, shaking = _apart(states[chosen])
        values = rows[chosen]
        field.observe_along(motion, rates[chosen], *shaking, values)
        found[chosen] = values
    return found


def vector_fields_at_states(
    model: RockingModel, numbers: FieldNumbers, states: Array, side: Array
) -> Iterator[tuple[Places, RockingField | GroundField]]:
    """Yield the places of the states of each phase, and its vector field."""
    layout = model.layout
    backwards = layout.velocities(states)[:, 0] < 0.0 if numbers.bouc_wen is not None else np.zeros(side.size, bool)
    for chosen, key in phases_at_states(model, side, layout.of(states, layout.rotation), states):
        for branch, part in ((1, chosen[~backwards[chosen]]), (-1, chosen[backwards[chosen]])):
            if part.size:
                yield part, field_of(model, numbers, key, branch)


def held_moment(model: RockingModel, states: Array) -> Array:
    """Return the moment that friction dampers balance while they hold the base at a large rotation, in N m, (n,).

    Over the lever arm factor cos(θ/2) of elements; the states are those of one phase.
    """
    rates = rates_at_states(model, states, accelerations_at_states(model, states))
    motion, (a, a_v) = _apart(states)
    found = np.zeros(len(states))
    for chosen, field in vector_fields_at_states(model, field_numbers(model), states, states[:, SIDE]):
        assert isinstance(field, RockingField)
        found[chosen] = field.imbalance_along(motion[chosen], rates[chosen], a[chosen], a_v[chosen])
    return found / np.cos(0.5 * model.layout.of(states, model.layout.rotation))


def _apart(states: Array) -> tuple[Array, tuple[Array, Array]]:
    """Return the state vectors of a history, and both accelerations of the ground, each contiguous."""
    return np.ascontiguousarray(states[:, HEADER:]), (states[:, GROUND].copy(), states[:, RISE].copy())


def states_by_phase(model: RockingModel, states: Array, side: Array) -> list[tuple[Places, Key, Array]]:
    """Return for each phase the places of its states, its key, and the vectors that its rows multiply."""
    moving = states[:, HEADER : HEADER + model.layout.moving]
    vector = np.column_stack((moving, states[:, GROUND], np.ones(side.size)))
    rotation = model.layout.of(states, model.layout.rotation)
    return [(chosen, key, vector[chosen]) for chosen, key in phases_at_states(model, side, rotation, states)]


def phases_at_states(model: RockingModel, side: Array, rotation: Array, states: Array) -> list[tuple[Places, Key]]:
    """Return for each phase the places of its states, by sides, rotations and internal variables."""
    branches = model.branches_at(side, rotation, states).astype(np.int64)
    _, first, which = np.unique(_codes(branches), return_index=True, return_inverse=True)
    # Divided after one sort: a mask for each phase takes long where a base on many springs has hundreds of them.
    parts = np.split(np.argsort(which, kind="stable"), np.cumsum(np.bincount(which))[:-1])
    return [(part, tuple(branches[place].tolist())) for part, place in zip(parts, first, strict=False)]


def _codes(rows: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return one number for each row of whole numbers, the same for equal rows; sorting these is fast."""
    codes = np.zeros(rows.shape[0], dtype=np.int64)
    for column in rows.T:
        codes = codes * (np.ptp(column) + 1 if column.size else 1) + column - column.min(initial=0)
        if codes.max(initial=0) > _MAX_CODES:
            codes = np.unique(codes, return_inverse=True)[1]
    return codes
