"""The tables of phases, made by the loops of `prepare.h`, for stacks of systems."""

import cython
import numpy as np
from cython.cimports.rockflex.engine.levels import LOOPS, Shape

from rockflex.engine import tables as preparing
from rockflex.engine.levels import GROUP
from rockflex.engine.system import LinearPhase


def tables_of_phase(found, h, more):
    """The tables of a stack of phases, each system's in a row, and more parts; their places; the halvings.

    Last the numbers of rows, of `shift`, of parts, and whether there are caps, as in `march.h`.
    """
    rows = preparing.rows_of(found)
    count, shift = rows.shape[1], found.C.shape[2]
    if not isinstance(found, LinearPhase):
        content, offsets = preparing.laid(preparing.tables_of_nonlinear_phase(rows, found.d.shape[1]), GROUP, more)
        return content, offsets, np.zeros(1, dtype=np.intc), (count, shift, 0, 0)
    rates = preparing.rates_of(found)
    shape: Shape
    shape.n, shape.outputs, shape.rows, shape.shift = shift, found.d.shape[1], count, preparing.shift_of(rates)
    shape.h, shape.inputs = h, 1
    tables = prepared(np.ascontiguousarray(found.A), rates, rows, cython.address(shape), more)
    return *tables, (count, shape.shift, shape.parts, shape.capped)


@cython.cfunc
def parted(A: cython.const[cython.double][:, :, ::1], shape: cython.pointer(Shape)):
    """The modes of a stack of systems that are parted for bounds, each system's in a row, and their numbers."""
    systems: cython.int = A.shape[0]
    n: cython.int = shape.n
    k: cython.int
    place: cython.Py_ssize_t
    most: cython.int = 0
    least: cython.int = n
    shape.parts = shape.slow = n + n % 2
    memory: cython.double[::1] = np.empty(LOOPS.room(shape))
    turns: cython.double[::1] = np.empty(systems)
    numbers = np.zeros(systems, dtype=np.intc)
    counts: cython.int[::1] = numbers
    for k in range(systems):
        turns[k] = LOOPS.turn(shape, cython.address(A[k, 0, 0]), cython.address(memory[0]))
    shape.capped = np.asarray(turns).max() > preparing.FAST
    chosen = np.flatnonzero(np.asarray(turns) > preparing.PARTED)
    found = np.zeros((systems if chosen.size else 1, n * (2 + 4 * n)))
    if chosen.size:
        modes: cython.double[:, ::1] = found
        roots: cython.double[:, ::1]
        vectors: cython.double[:, :, ::1]
        roots, vectors = preparing.roots_and_vectors(np.asarray(A)[chosen])
        places: cython.Py_ssize_t[::1] = chosen
        with cython.nogil:
            for k in range(places.shape[0]):
                place = places[k]
                counts[place] = LOOPS.modes_of(
                    shape,
                    cython.address(A[place, 0, 0]),
                    cython.address(roots[k, 0]),
                    cython.address(vectors[k, 0, 0]),
                    cython.address(memory[0]),
                    cython.address(modes[place, 0]),
                )
            for k in range(systems):
                place = LOOPS.amplitudes(n, cython.address(modes[k, 0]), counts[k])
                most, least = max(most, cython.cast(cython.int, place)), min(least, cython.cast(cython.int, place))
        if least == n:  # nothing is left
            shape.slow = 0
        shape.parts = shape.slow + most
    return found, numbers


def bounds_of(A, rates, rows, outputs, h):
    """By what `Shaken` bounds rows, of a stack: the parts of y', and `prepare.h`'s bounds, see `shaken`."""
    shape: Shape
    S, n, columns = rates.shape
    shape.n, shape.outputs, shape.rows, shape.shift, shape.h = n, outputs, rows.shape[1], 0, h
    shape.inputs = columns - n - 1
    modes, counts = parted(np.ascontiguousarray(A), cython.address(shape))
    some: cython.double[:, ::1] = modes
    numbers: cython.int[::1] = counts
    first: cython.const[cython.double][:, :, ::1] = np.ascontiguousarray(rates)
    seen: cython.const[cython.double][:, :, ::1] = np.ascontiguousarray(rows)
    moves = np.zeros((S, shape.parts, columns))
    count = 3 * rows.shape[1] - outputs + shape.inputs - 2
    bounds = np.zeros((S, count, 2 * shape.inputs + shape.parts))
    to: cython.double[:, :, ::1] = moves
    also: cython.double[:, :, ::1] = bounds
    memory: cython.double[::1] = np.empty(LOOPS.room(cython.address(shape)))
    k: cython.int
    for k in range(S):
        LOOPS.bound(
            cython.address(shape),
            cython.address(first[k, 0, 0]),
            cython.address(seen[k, 0, 0]),
            numbers[k],
            cython.address(some[k if some.shape[0] > 1 else 0, 0]),
            cython.address(memory[0]),
            cython.address(to[k, 0, 0]),
            cython.address(also[k, 0, 0]),
        )
    return moves, bounds


@cython.cfunc
def prepared(
    A,
    rates: cython.const[cython.double][:, :, ::1],
    rows: cython.const[cython.double][:, :, ::1],
    shape: cython.pointer(Shape),
    more,
):
    """The tables of a stack of linear phases, from A, [A f c] and the rows [C d e]."""
    systems: cython.int = rates.shape[0]
    n: cython.int = shape.n
    k: cython.int
    first: cython.p_double
    here: cython.p_double
    given: cython.p_const_double = cython.address(rates[0, 0, 0])
    seen: cython.p_const_double = cython.address(rows[0, 0, 0]) if rows.shape[1] else given
    wide: cython.Py_ssize_t = n * (n + 2)
    tall: cython.Py_ssize_t = shape.rows * (n + 2)
    some, numbers = parted(A, shape)
    modes: cython.double[:, ::1] = some
    counts: cython.int[::1] = numbers
    memory: cython.double[::1] = np.empty(LOOPS.room(shape))
    room: cython.p_double = cython.address(memory[0])
    content, offsets = preparing.room_of_tables(
        systems, n, shape.outputs, shape.rows, shape.shift, shape.parts, shape.capped, more
    )
    halvings = np.zeros(systems, dtype=np.intc)
    found: cython.int[::1] = halvings
    tables: cython.double[:, ::1] = content
    places: cython.Py_ssize_t[::1] = offsets
    with cython.nogil:
        for k in range(systems):
            first, here = cython.address(modes[k if modes.shape[0] > 1 else 0, 0]), cython.address(tables[k, 0])
            found[k] = LOOPS.prepare(
                shape, given + k * wide, seen + k * tall, counts[k], first, room, cython.address(places[0]), here
            )
    return content, offsets, halvings
