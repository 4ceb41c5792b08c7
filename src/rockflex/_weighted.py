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

LANES, LINE = 4, 8  # numbers in a vector, and in a cache line

_VECTOR = ir.VectorType(ir.DoubleType(), LANES)
_SAME = ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES)


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

    def array(i: int) -> Any:
        return context.make_array(kinds[i])(context, builder, arguments[i])

    def vector(data: Any, offset: Any) -> Any:
        return builder.bitcast(builder.gep(data, [offset]), _VECTOR.as_pointer())

    def same(number: Any) -> Any:
        one = builder.insert_element(ir.Constant(_VECTOR, ir.Undefined), number, ir.Constant(ir.IntType(32), 0))
        return builder.shuffle_vector(one, ir.Constant(_VECTOR, ir.Undefined), _SAME)

    def index(value: int) -> Any:
        return ir.Constant(ir.IntType(64), value)

    def times(number: Any, values: Any, total: Any = None) -> Any:
        product = builder.fmul(number, values, flags=("contract",))
        return product if total is None else builder.fadd(total, product, flags=("contract",))

    out, weights, table = array(0), array(start + 2), array(start + 4)
    factor, row, first, last, count = (arguments[start + i] for i in (1, 3, 5, 6, 7))
    width = builder.extract_value(table.shape, 1)
    weight = builder.gep(weights.data, [builder.mul(row, builder.extract_value(weights.shape, 1))])

    def sum_vectors(place: Any, number: int) -> None:
        """Sum vectors that follow one another, in one loop over the rows."""
        places = [builder.add(place, index(LANES * i)) for i in range(number)]
        sums = [cgutils.alloca_once(builder, _VECTOR) for _ in places]

        def add(k: Any, totals: list[Any]) -> None:
            factor, begin = same(builder.load(builder.gep(weight, [k]))), builder.mul(k, width)
            for each, total, kept in zip(places, totals, sums, strict=True):
                values = builder.load(vector(table.data, builder.add(each, begin)), align=8)
                builder.store(times(factor, values, total), kept)

        add(index(0), [None] * number)
        with cgutils.for_range(builder, last, start=first, intp=last.type) as loop:
            add(loop.index, [builder.load(each) for each in sums])
        for each, total in zip(places, sums, strict=True):
            given = builder.load(vector(array(1).data, each), align=8) if start else None
            builder.store(times(same(factor), builder.load(total), given), vector(out.data, each), align=8)

    # Pairs of vectors, and one more if their number is odd.
    vectors = builder.udiv(builder.add(count, index(LANES - 1)), index(LANES))
    pairs = builder.lshr(vectors, index(1))
    with cgutils.for_range(builder, pairs) as loop:
        sum_vectors(builder.mul(loop.index, index(2 * LANES)), 2)
    with builder.if_then(builder.trunc(vectors, ir.IntType(1))):
        sum_vectors(builder.mul(pairs, index(2 * LANES)), 1)
    return context.get_dummy_value()


def _contiguous(*arguments: Any) -> bool:
    return all(each.layout == "C" for each in arguments if isinstance(each, types.Array))


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
    return (types.none(*given), _weigh) if _contiguous(*given) else None


@intrinsic
def _compiled_place(
    _: Any, out: Any, start: Any, factor: Any, weights: Any, row: Any, table: Any, first: Any, last: Any, count: Any
) -> Any:
    del factor, row, first, last, count
    whole = types.int64
    given = (out, start, types.float64, weights, whole, table, whole, whole, whole)
    return (types.none(*given), _place) if _contiguous(*given) else None


_interpreted = cast("Any", config).DISABLE_JIT
weigh = _plain_weigh if _interpreted else cast("Any", _compiled_weigh)
place_by = _plain_place if _interpreted else cast("Any", _compiled_place)
