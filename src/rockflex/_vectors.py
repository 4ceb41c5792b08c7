"""Arithmetic on all samples of a block, or on all rows, at once, in vector registers.

The loops that numba compiles are not turned into vector instructions here: for all that the compiler knows, the arrays
could overlap. The intrinsics state the operations on vectors themselves; on any processor they become the
instructions that it has.
"""

from functools import partial
from typing import Any, cast

from llvmlite import ir
from numba import config, types
from numba.core import cgutils
from numba.extending import intrinsic

from rockflex._arrays import Array
from rockflex._numba_vectors import WIDE, Builder, contiguous, index

BLOCK = 16  # samples in a block
CHAINS = 4  # sums at a time, none of which waits for another


def _plain_row(
    values: Array,
    constant: float,
    by_ground: float,
    by_slope: float,
    course: Array,
    table: Array,
    begun: Array,
    active: int,
    kicked: Array,
) -> None:
    """Set the values of a row at the ends of the samples of a block.

    They are ``constant + by_ground * ground + by_slope * slope + begun @ table + kicked * jumps``, where `course`
    (3, BLOCK) contains the ground acceleration at the ends of the samples, its slope in them, and the jumps of the
    slope at their starts. `table` has shape (2 K, BLOCK), of whose K pairs of coordinates the first are `active`;
    `kicked` (2 BLOCK,) is zero in its first half.
    """
    pairs = table.shape[0] // 2
    for m in range(BLOCK):
        value = constant + by_ground * course[0, m] + by_slope * course[1, m]
        for k in range(active):
            value += table[k, m] * begun[k] + table[pairs + k, m] * begun[pairs + k]
        for j in range(m + 1):
            value += kicked[BLOCK + m - j] * course[2, j]
        values[m] = value


def _plain_outside(values: Array, lower: float, upper: float) -> int:
    """Return the samples, as bits, in which a row is less than `lower` or greater than `upper`."""
    return sum(1 << m for m in range(BLOCK) if values[m] < lower or values[m] > upper)


def _plain_sums(sums: Array, table: Array, factors: Array, first: int, count: int) -> None:
    """Set the sums (n,) to ``factors @ table``, over `count` rows of `table` (m, n) from `first` on.

    n is a multiple of `WIDE`. Numbers that have just been written one by one are slow to read as a vector.
    """
    sums[:] = 0.0
    _plain_further_sums(sums, table, factors, first, count)


def _plain_further_sums(sums: Array, table: Array, factors: Array, first: int, count: int) -> None:
    """Add the same to the sums."""
    sums += factors[first : first + count] @ table[first : first + count]


def _row(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    make = Builder(context, builder, BLOCK)
    kinds = dict(enumerate(signature.args))
    values, course, table, begun, kicked = (make.data(kinds[i], arguments[i]) for i in (0, 4, 5, 6, 8))
    constant, by_ground, by_slope, active = (arguments[i] for i in (1, 2, 3, 7))
    pairs = builder.lshr(make.size(kinds[5], arguments[5], 0), index(1))
    total = make.plus(make.same(constant), by_ground, make.load(course, index(0)))
    total = make.plus(total, by_slope, make.load(course, index(BLOCK)))
    totals = [total, make.zero()]  # neither waits for the other
    for j in range(BLOCK):
        jump, response = make.number(course, index(2 * BLOCK + j)), make.load(kicked, index(BLOCK - j))
        totals[j % 2] = make.plus(totals[j % 2], jump, response)
    sums = [cgutils.alloca_once_value(builder, each) for each in totals]
    with cgutils.for_range(builder, active) as loop:
        for each, k in zip(sums, (loop.index, builder.add(pairs, loop.index)), strict=True):
            place = builder.mul(k, index(BLOCK))
            builder.store(make.plus(builder.load(each), make.number(begun, k), make.load(table, place)), each)
    make.store(builder.fadd(builder.load(sums[0]), builder.load(sums[1])), values, index(0))
    return context.get_dummy_value()


def _outside(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    make = Builder(context, builder, BLOCK)
    values = make.load(make.data(signature.args[0], arguments[0]), index(0))
    below = builder.fcmp_ordered("<", values, make.same(arguments[1]))
    above = builder.fcmp_ordered(">", values, make.same(arguments[2]))
    return builder.zext(builder.bitcast(builder.or_(below, above), ir.IntType(BLOCK)), ir.IntType(64))


def _sums(context: Any, builder: Any, signature: Any, arguments: Any, *, further: bool = False) -> Any:
    make = Builder(context, builder, WIDE)
    kinds = dict(enumerate(signature.args))
    sums, table, factors = (make.data(kinds[i], arguments[i]) for i in range(3))
    first, count = arguments[3], arguments[4]
    width = make.size(kinds[1], arguments[1], 1)
    chains = [cgutils.alloca_once(builder, make.vector) for _ in range(CHAINS)]

    def add(chain: Any, place: ir.Value, j: ir.Value) -> None:
        row = make.load(table, builder.add(place, builder.mul(width, j)))
        builder.store(make.plus(builder.load(chain), make.number(factors, j), row), chain)

    rounds = builder.udiv(count, index(CHAINS))
    together = builder.mul(rounds, index(CHAINS))
    with cgutils.for_range(builder, builder.udiv(width, index(WIDE))) as loop:
        place = builder.mul(loop.index, index(WIDE))
        for chain in chains:
            builder.store(make.load(sums, place) if further and chain is chains[0] else make.zero(), chain)
        with cgutils.for_range(builder, rounds) as inner:
            start = builder.add(first, builder.mul(inner.index, index(CHAINS)))
            for i, chain in enumerate(chains):
                add(chain, place, builder.add(start, index(i)))
        with cgutils.for_range(builder, builder.sub(count, together)) as rest:
            add(chains[0], place, builder.add(builder.add(first, together), rest.index))
        one, two, three, four = (builder.load(chain) for chain in chains)
        make.store(builder.fadd(builder.fadd(one, two), builder.fadd(three, four)), sums, place)
    return context.get_dummy_value()


@intrinsic
def _compiled_row(
    _: Any,
    values: Any,
    constant: Any,
    by_ground: Any,
    by_slope: Any,
    course: Any,
    table: Any,
    begun: Any,
    active: Any,
    kicked: Any,
) -> Any:
    given = (values, constant, by_ground, by_slope, course, table, begun, active, kicked)
    return (types.none(*given), _row) if contiguous(*given) else None


@intrinsic
def _compiled_outside(_: Any, values: Any, lower: Any, upper: Any) -> Any:
    return (types.int64(values, lower, upper), _outside) if contiguous(values) else None


def _signature_of_sums(sums: Any, table: Any, factors: Any, *counts: Any) -> Any:
    if not contiguous(sums, table, factors):
        return None
    return types.none(sums, table, factors, *(types.int64 for _ in counts))


@intrinsic
def _compiled_sums(_: Any, sums: Any, table: Any, factors: Any, first: Any, count: Any) -> Any:
    signature = _signature_of_sums(sums, table, factors, first, count)
    return signature and (signature, _sums)


@intrinsic
def _compiled_further_sums(_: Any, sums: Any, table: Any, factors: Any, first: Any, count: Any) -> Any:
    signature = _signature_of_sums(sums, table, factors, first, count)
    return signature and (signature, partial(_sums, further=True))


_interpreted = cast("Any", config).DISABLE_JIT
row_over_block = _plain_row if _interpreted else cast("Any", _compiled_row)
outside = _plain_outside if _interpreted else cast("Any", _compiled_outside)
set_products = _plain_sums if _interpreted else cast("Any", _compiled_sums)
add_products = _plain_further_sums if _interpreted else cast("Any", _compiled_further_sums)
