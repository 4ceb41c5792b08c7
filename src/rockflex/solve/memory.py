"""What the memories of the elements do in a phase: its limits and its constants are computed when it is entered."""

import math

import numpy as np

from rockflex._kernel import kernel
from rockflex.models import PULLS, pivot_at
from rockflex.solve.layout import (
    ARM,
    CONSTANT,
    FLEXIBILITY,
    GUARD,
    HIGH,
    LOW,
    LOWER,
    MEMORY,
    OFFSET,
    OUTER,
    PLACE,
    RECALL,
    UPPER,
    Array,
    Motion,
    System,
    slip_in,
)

CLOSE = 1e-13  # of the terms of a limit: this close to the rotation, it is the one at which the phase was entered
ULP = 4e-16  # relative: how far such a limit is moved away, so that rounding does not end the phase at once


@kernel
def recollect(system: System, phase: int, motion: Motion) -> None:
    """Set the limits and the constants of a phase that is entered in the present state."""
    first, count = system.layout.memory, system.layout.remembered
    for m in range(count):
        if not math.isnan(system.marks[phase, m]):
            motion.state[first + m] = system.marks[phase, m]
    for bound in range(2):
        motion.limits[bound] = recalled(system, system.limits[phase, bound], motion.state)
        motion.owners[bound] = -1
    if system.phases[phase].free:
        nearest_changes(system, phase, motion)
    for k in range(motion.still.size):
        motion.still[k] = system.forced[phase, 2, k]
        for m in range(count):
            motion.still[k] += system.forced[phase, 3 + m, k] * motion.state[first + m]
    for f in range(motion.offset.size):
        motion.offset[f] = system.row_forcing[phase, f, 2]
        for m in range(count):
            motion.offset[f] += system.row_forcing[phase, f, 3 + m] * motion.state[first + m]
    slip = slip_in(system)
    if slip >= 0 and system.base[phase, FLEXIBILITY, slip, slip] == 0.0:  # held where it is
        place = system.layout.slip
        for f in range(motion.offset.size):
            motion.offset[f] += system.plain_rows[phase, f, place] * motion.state[place]
    for j in range(motion.load.size):
        motion.load[j] = load_in(system, phase, j, motion.state)
    gather(system, phase, motion)
    set_limits(system, phase, motion)


@kernel
def set_limits(system: System, phase: int, motion: Motion) -> None:
    """Set the limits beyond which the guard, the row of θ' or a fence means an event; other rows have none."""
    for f in range(motion.offset.size):
        motion.values[LOWER, f] = 0.0 if f >= system.fences else -np.inf
        motion.values[UPPER, f] = np.inf
    motion.values[LOWER, GUARD] = motion.limits[LOW]
    motion.values[UPPER, GUARD] = motion.limits[HIGH]
    sign = system.phases[phase].turns * system.phases[phase].side
    if system.turning_row >= 0 and sign > 0.0:
        motion.values[LOWER, system.turning_row] = 0.0
    if system.turning_row >= 0 and sign < 0.0:
        motion.values[UPPER, system.turning_row] = 0.0


@kernel
def gather(system: System, phase: int, motion: Motion) -> None:
    """Set the sums over the elements of a phase, for its vector field."""
    pivot = pivot_at(system.phases[phase].side)
    for k in range(system.pulls.shape[1]):
        total = system.pulls[phase, k, 0]
        for m in range(system.layout.remembered):
            total += system.pulls[phase, k, 1 + m] * motion.state[system.layout.memory + m]
        motion.pivots[pivot, PULLS + k] = total


@kernel
def recalled(system: System, factors: Array, state: Array) -> float:
    """Return a limit with what the rotation and the memories add to it."""
    value = factors[0]
    if factors[1] != 0.0:
        value += factors[1] * state[system.layout.rotation]
    for m in range(system.layout.remembered):
        value += factors[2 + m] * state[system.layout.memory + m]
    return value


@kernel
def load_in(system: System, phase: int, freedom: int, state: Array) -> float:
    """Return the constant force on a degree of freedom of the base in a phase."""
    force = system.push[phase, CONSTANT, freedom]
    for m in range(system.layout.remembered):
        force += system.recall[phase, freedom, m] * state[system.layout.memory + m]
    return force


@kernel
def nearest_changes(system: System, phase: int, motion: Motion) -> None:
    """Narrow the limits of the rotation to the nearest ones at which an element changes its branch."""
    side, size = system.phases[phase].side, abs(motion.state[system.layout.rotation])
    inner, outer = (LOW, HIGH) if side > 0.0 else (HIGH, LOW)
    for x in range(system.change_kinds.shape[1]):
        kind = system.change_kinds[phase, x, OUTER]
        if kind < 0:
            continue
        index = system.change_kinds[phase, x, MEMORY]
        memory = motion.state[system.layout.memory + index] if index >= 0 else 0.0
        place, recall = system.changes[phase, x, PLACE], system.changes[phase, x, RECALL]
        limit, rounding = turned(system, place + recall * memory), CLOSE * (abs(place) + abs(recall * memory))
        if kind == 0 and limit <= rounding:
            continue  # the base lands first, or at the same instant
        if abs(limit - size) <= rounding:
            limit = size * (1.0 + ULP) if kind == 1 else size * (1.0 - ULP)
        if kind == 1 and limit < side * motion.limits[outer]:
            motion.limits[outer], motion.owners[outer] = side * limit, x
        elif kind == 0 and limit > side * motion.limits[inner]:
            motion.limits[inner], motion.owners[inner] = side * limit, x


@kernel
def turned(system: System, stretch: float) -> float:
    """Return |θ| at which elements are stretched by `stretch` per unit distance from the pivot."""
    if not system.chords:
        return stretch
    return 2.0 * math.asin(max(0.5 * stretch, -1.0)) if stretch < 2.0 else np.inf


@kernel
def remember(system: System, phase: int, motion: Motion) -> None:
    """Set the memories of the elements whose yielding ends at the present rotation."""
    size = abs(motion.state[system.layout.rotation])
    stretch = 2.0 * math.sin(0.5 * size) if system.chords else size
    for m in range(system.layout.remembered):
        arm = system.turnings[phase, m, ARM]
        if not math.isnan(arm):
            motion.state[system.layout.memory + m] = arm * stretch - system.turnings[phase, m, OFFSET]
