"""Whether the states of a history can be those of a model: its times, sides, magnitudes and branches."""

from collections.abc import Collection

import numpy as np

from rockflex.foundation.arrays import Array, Bools, Integers
from rockflex.foundation.errors import InputError
from rockflex.models._elements import internal_places
from rockflex.models._rocking_model import RockingModel
from rockflex.models._state_layout import BITS, HEADER, SIDE, TIME

LATEST = 1e12  # s: no run lasts as long
LARGEST = 1e100  # in SI units: the squares of larger numbers may overflow


def check_states(model: RockingModel, states: Array) -> None:
    """Raise an InputError unless the `states` of a `History`, which are finite, can be those of a run of the model."""
    time, sizes = states[:, TIME], np.abs(states)
    _check("value", sizes.max(axis=1), sizes.max(axis=1) <= LARGEST, f"at most {LARGEST:g} is allowed")
    _check("time", time, (time >= 0.0) & (time <= LATEST), f"times must lie from 0 to {LATEST:g} s")
    _check("time", time, np.append(True, np.diff(time) >= 0.0), "times must not decrease")
    _check_one_of("side", states[:, SIDE], model.sides)
    for name, column, allowed in _marks(model):
        _check_one_of(name, states[:, column], allowed)
    for codes in states[:, _codes(model)].T:
        whole = (codes == np.floor(codes)) & (codes >= 0.0) & (codes < 2.0**BITS)
        _check("number of branches", codes, whole, "a whole number is expected")
    branches = model.branches_at(states[:, SIDE], model.layout.of(states, model.layout.rotation), states)
    for column, allowed in zip(branches.T, model.branch_values, strict=False):
        _check_one_of("branch", column, allowed)


def _marks(model: RockingModel) -> list[tuple[str, int, Collection[float]]]:
    """Return what tells a branch by itself: its name, its column of the states, and its values."""
    memory, found = HEADER + model.layout.memory, list[tuple[str, int, Collection[float]]]()
    for place, first in internal_places(model.elements).items():
        each = model.elements[place]
        values = [mark for mark in map(each.branch_code, each.branches) if mark is not None]
        if len(values) == len(each.branches):  # of a bar only the last branch has one
            found.append((f"branch of element {place}", memory + first + each.n_internal - 1, values))
    if model.slip_marks:
        found.append(("slip", memory + model.layout.n_internal - 1, model.slip_marks))
    return found


def _codes(model: RockingModel) -> slice:
    """Return the columns of the numbers whose digits are branches."""
    memory, last = HEADER + model.layout.memory, HEADER + model.layout.memory + model.layout.n_internal
    return slice(memory + model.first_mark, last - bool(model.slip_marks))


def _check_one_of(name: str, values: Array | Integers, allowed: Collection[float]) -> None:
    known = list(allowed)
    _check(name, values, np.isin(values, known), f"{' or '.join(f'{each:g}' for each in known)} is expected")


def _check(name: str, values: Array | Integers, sound: Bools, expected: str) -> None:
    if not sound.all():
        row = int(np.argmin(sound))
        raise InputError(f"states[{row}] has the {name} {values[row]:g}, but {expected}.", field="states")
