"""Weighted sums of the rows of a table, a few numbers at a time, in vector registers: the stages of a Runge-Kutta step.

See `rockflex._vectors` for why the operations on vectors are stated.
"""

from typing import Any, cast

import numpy as np
from llvmlite import ir
from numba import config, types
from numba.core import cgutils
from numba.extending import intrinsic

from rockflex._arrays import Array
from rockflex._numba_vectors import Builder, contiguous, index

LANES, LINE = 4, 8  # numbers in a vector, and in a cache line


def whole_vectors(size: int) -> int:
    """Return a size rounded up to a multiple of `LANES`."""
    return -(-size // LANES) * LANES


def aligned(rows: int, columns: int) -> Array:
    """Return an array of zeros that starts at a cache line, so that few vectors extend over two of them."""
    room = np.zeros(rows * columns + LINE)
    begin = -(room.ctypes.data // room.itemsize) % LINE
    return room[begin : begin + rows * columns].reshape(rows, columns)


def _plain_weigh(
    out: Array, factor: float, weights: Array, row: int, table: Array, first: int, last: int, count: int
) -> None:
    """Set `out` to `factor` times the sum of the rows 0 and `first` to `last` - 1 of the table times their weights.

    The weights are in one row of `weights`. Entries are computed up to `count` rounded up to whole vectors, which all
    rows must have.
    """
    end = whole_vectors(count)
    out[:end] = factor * (weights[row, 0] * table[0, :end] + weights[row, first:last] @ table[first:last, :end])


def _plain_place(
    out: Array,
    start: Array,
    factor: float,
    weights: Array,
    row: int,
    table: Array,
    first: int,
    last: int,
    count: int,
) -> None:
    """Set `out` to the same sum added to `start`."""
    end = whole_vectors(count)
    _plain_weigh(out, factor, weights, row, table, first, last, count)
    out[:end] += start[:end]


def _sum(context: Any, builder: Any, signature: Any, arguments: Any, start: int) -> Any:
    """Write the loops; `start` is 1 if the second argument is an array to add to, otherwise 0."""
    kinds = signature.args

    make = Builder(context, builder, LANES)
    out, weights, table = (make.data(kinds[i], arguments[i]) for i in (0, start + 2, start + 4))
    given = make.data(kinds[1], arguments[1]) if start else None
    factor, row, first, last, count = (arguments[start + i] for i in (1, 3, 5, 6, 7))
    width = make.size(kinds[start + 4], arguments[start + 4], 1)
    weight = builder.gep(weights, [builder.mul(row, make.size(kinds[start + 2], arguments[start + 2], 1))])

    def times(number: Any, values: Any) -> Any:
        return builder.fmul(make.same(number), values, flags=("contract",))

    def sum_vectors(place: Any, number: int) -> None:
        """Sum vectors that follow one another, in one loop over the rows."""
        places = [builder.add(place, index(LANES * i)) for i in range(number)]
        sums = [cgutils.alloca_once(builder, make.vector) for _ in places]

        def add(k: Any, totals: list[Any]) -> None:
            factor, begin = make.number(weight, k), builder.mul(k, width)
            for each, total, kept in zip(places, totals, sums, strict=True):
                values = make.load(table, builder.add(each, begin))
                builder.store(times(factor, values) if total is None else make.plus(total, factor, values), kept)

        add(index(0), [None] * number)
        with cgutils.for_range(builder, last, start=first, intp=last.type) as loop:
            add(loop.index, [builder.load(each) for each in sums])
        for each, total in zip(places, sums, strict=True):
            whole = builder.load(total)
            found = times(factor, whole) if given is None else make.plus(make.load(given, each), factor, whole)
            make.store(found, out, each)

    # Pairs of vectors, and one more if their number is odd.
    vectors = builder.udiv(builder.add(count, index(LANES - 1)), index(LANES))
    pairs = builder.lshr(vectors, index(1))
    with cgutils.for_range(builder, pairs) as loop:
        sum_vectors(builder.mul(loop.index, index(2 * LANES)), 2)
    with builder.if_then(builder.trunc(vectors, ir.IntType(1))):
        sum_vectors(builder.mul(pairs, index(2 * LANES)), 1)
    return context.get_dummy_value()


def _weigh(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    return _sum(context, builder, signature, arguments, 0)


def _place(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    return _sum(context, builder, signature, arguments, 1)


@intrinsic
def _compiled_weigh(
    _: Any, out: Any, factor: Any, weights: Any, row: Any, table: Any, first: Any, last: Any, count: Any
) -> Any:
    del factor, row, first, last, count  # numba converts them
    whole = types.int64
    given = (out, types.float64, weights, whole, table, whole, whole, whole)
    return (types.none(*given), _weigh) if contiguous(*given) else None


@intrinsic
def _compiled_place(
    _: Any, out: Any, start: Any, factor: Any, weights: Any, row: Any, table: Any, first: Any, last: Any, count: Any
) -> Any:
    del factor, row, first, last, count
    whole = types.int64
    given = (out, start, types.float64, weights, whole, table, whole, whole, whole)
    return (types.none(*given), _place) if contiguous(*given) else None


_interpreted = cast("Any", config).DISABLE_JIT
weigh = _plain_weigh if _interpreted else cast("Any", _compiled_weigh)
place_by = _plain_place if _interpreted else cast("Any", _compiled_place)
