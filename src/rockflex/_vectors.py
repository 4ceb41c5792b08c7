"""Arithmetic on all samples of a block, or on all rows, at once, in vector registers.

The loops that numba compiles are not turned into vector instructions here: for all that the compiler knows, the arrays
could overlap. The intrinsics state the operations on vectors themselves; on any processor they become the
instructions that it has.
"""

from collections.abc import Callable
from functools import partial
from typing import Any, cast

import numpy as np
from llvmlite import ir
from numba import config, types
from numba.core import cgutils
from numba.extending import intrinsic

from rockflex._arrays import Array
from rockflex._numba_vectors import WIDE, Builder, contiguous, index

BLOCK = 16  # samples in a block
FEW = 4  # numbers in the vectors of loops that end anywhere
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
    slope at their starts, without the first one, which `begun` contains. `table` has shape (2 K, BLOCK), of whose K
    pairs of coordinates the first are `active`; `kicked` (2 BLOCK,) is zero in its first half.
    """
    pairs = table.shape[0] // 2
    for m in range(BLOCK):
        value = constant + by_ground * course[0, m] + by_slope * course[1, m]
        for k in range(active):
            value += table[k, m] * begun[k] + table[pairs + k, m] * begun[pairs + k]
        for j in range(1, m + 1):
            value += kicked[BLOCK + m - j] * course[2, j]
        values[m] = value


def _plain_outside(values: Array, lower: float, upper: float) -> int:
    """Return the samples, as bits, in which a row is less than `lower` or greater than `upper`."""
    return sum(1 << m for m in range(BLOCK) if values[m] < lower or values[m] > upper)


def _plain_sums(sums: Array, table: Array, factors: Array, count: int, parts: int) -> None:
    """Set the sums (n,) to ``factors @ table``, over the first `count` rows of each of the `parts` of `table` (m, n).

    n is a multiple of `WIDE`. Numbers that have just been written one by one are slow to read as a vector.
    """
    sums[:] = 0.0
    _plain_further_sums(sums, table, factors, count, parts)


def _plain_further_sums(sums: Array, table: Array, factors: Array, count: int, parts: int) -> None:
    """Add the same to the sums."""
    size = table.shape[0] // parts
    for first in range(0, parts * size, size):
        sums += factors[first : first + count] @ table[first : first + count]


def _plain_pairs(ends: Array, blocks: Array, now: Array, active: int) -> None:
    """Advance the first `active` of K pairs of coordinates (2 K,), from `now` to `ends`, by their `blocks` (4, K)."""
    pairs = blocks.shape[1]
    x, y = now[:active], now[pairs : pairs + active]
    ends[:active] = blocks[0, :active] * x + blocks[1, :active] * y
    ends[pairs : pairs + active] = blocks[2, :active] * x + blocks[3, :active] * y


def _plain_norms(norms: Array, w: Array, active: int) -> None:
    """Set the norms (K,) of the first `active` pairs of coordinates (2 K,)."""
    x, y = w[:active], w[norms.size : norms.size + active]
    norms[:active] = np.sqrt(x * x + y * y)


def _plain_less(out: Array, one: Array, other: Array, factor: float) -> None:
    """Set an array to ``one - factor * other``; it is neither of the two."""
    out[:] = one - factor * other


def _row(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    make = Builder(context, builder, BLOCK)
    kinds = dict(enumerate(signature.args))
    values, course, table, begun, kicked = (make.data(kinds[i], arguments[i]) for i in (0, 4, 5, 6, 8))
    constant, by_ground, by_slope, active = (arguments[i] for i in (1, 2, 3, 7))
    pairs = builder.lshr(make.size(kinds[5], arguments[5], 0), index(1))
    total = make.plus(make.same(constant), by_ground, make.load(course, index(0)))
    total = make.plus(total, by_slope, make.load(course, index(BLOCK)))
    totals = [total, _answer_to_jumps(context, builder, course, kicked)]  # neither waits for the other
    sums = [cgutils.alloca_once_value(builder, each) for each in totals]
    with cgutils.for_range(builder, active) as loop:
        for each, k in zip(sums, (loop.index, builder.add(pairs, loop.index)), strict=True):
            place = builder.mul(k, index(BLOCK))
            builder.store(make.plus(builder.load(each), make.number(begun, k), make.load(table, place)), each)
    make.store(builder.fadd(builder.load(sums[0]), builder.load(sums[1])), values, index(0))
    return context.get_dummy_value()


def _answer_to_jumps(context: Any, builder: Any, course: ir.Value, kicked: ir.Value) -> ir.Value:
    """Return the sum of the responses to jumps; those in the second half of the block leave the first as it is."""
    half, whole = Builder(context, builder, BLOCK // 2), []
    for start in (0, BLOCK // 2):
        sums = [half.zero(), half.zero()]
        for j in range(1, start + BLOCK // 2):
            jump, response = half.number(course, index(2 * BLOCK + j)), half.load(kicked, index(BLOCK + start - j))
            sums[j % 2] = half.plus(sums[j % 2], jump, response)
        whole.append(builder.fadd(*sums))
    lanes = ir.Constant(ir.VectorType(ir.IntType(32), BLOCK), list(range(BLOCK)))
    return builder.shuffle_vector(*whole, lanes)


def _outside(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    make = Builder(context, builder, BLOCK)
    values = make.load(make.data(signature.args[0], arguments[0]), index(0))
    below = builder.fcmp_ordered("<", values, make.same(arguments[1]))
    above = builder.fcmp_ordered(">", values, make.same(arguments[2]))
    return builder.zext(builder.bitcast(builder.or_(below, above), ir.IntType(BLOCK)), ir.IntType(64))


def _each(context: Any, builder: Any, size: ir.Value, step: Callable[[Builder, ir.Value], None]) -> None:
    """Do a step at the starts of vectors that cover some numbers; the last two may overlap. Few are done one by one."""
    lanes = index(FEW)
    with builder.if_else(builder.icmp_signed("<", size, lanes)) as (few, many):
        with few, cgutils.for_range(builder, size) as loop:
            step(Builder(context, builder, 1), loop.index)
        with many:
            last = builder.sub(size, lanes)
            with cgutils.for_range(builder, builder.udiv(builder.add(size, index(FEW - 1)), lanes)) as loop:
                start = builder.mul(loop.index, lanes)
                step(
                    Builder(context, builder, FEW),
                    builder.select(builder.icmp_signed("<", start, last), start, last),
                )


def _pairs(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    make, kinds = Builder(context, builder, FEW), signature.args
    ends, blocks, now = (make.data(kinds[i], arguments[i]) for i in range(3))
    size = make.size(kinds[1], arguments[1], 1)

    def step(make: Builder, start: ir.Value) -> None:
        second = builder.add(size, start)
        x, y = make.load(now, start), make.load(now, second)
        one, two, three, four = (make.load(blocks, builder.add(builder.mul(size, index(i)), start)) for i in range(4))
        make.store(make.plus_vector(builder.fmul(two, y), one, x), ends, start)
        make.store(make.plus_vector(builder.fmul(four, y), three, x), ends, second)

    _each(context, builder, arguments[3], step)
    return context.get_dummy_value()


def _norms(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    make, kinds = Builder(context, builder, FEW), signature.args
    norms, w = (make.data(kinds[i], arguments[i]) for i in range(2))
    size = make.size(kinds[0], arguments[0], 0)

    def step(make: Builder, start: ir.Value) -> None:
        x, y = make.load(w, start), make.load(w, builder.add(size, start))
        make.store(make.root(make.plus_vector(builder.fmul(y, y), x, x)), norms, start)

    _each(context, builder, arguments[2], step)
    return context.get_dummy_value()


def _less(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    make, kinds = Builder(context, builder, FEW), signature.args
    out, one, other = (make.data(kinds[i], arguments[i]) for i in range(3))
    factor = builder.fneg(arguments[3])

    def step(make: Builder, start: ir.Value) -> None:
        make.store(make.plus(make.load(one, start), factor, make.load(other, start)), out, start)

    _each(context, builder, make.size(kinds[0], arguments[0], 0), step)
    return context.get_dummy_value()


def _sums(context: Any, builder: Any, signature: Any, arguments: Any, *, further: bool = False) -> Any:
    make = Builder(context, builder, WIDE)
    kinds = dict(enumerate(signature.args))
    sums, table, factors = (make.data(kinds[i], arguments[i]) for i in range(3))
    count, parts = arguments[3], arguments[4]
    size, width = builder.udiv(make.size(kinds[1], arguments[1], 0), parts), make.size(kinds[1], arguments[1], 1)
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
        with cgutils.for_range(builder, parts) as part:
            first = builder.mul(part.index, size)
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
def _compiled_sums(_: Any, sums: Any, table: Any, factors: Any, count: Any, parts: Any) -> Any:
    signature = _signature_of_sums(sums, table, factors, count, parts)
    return signature and (signature, _sums)


@intrinsic
def _compiled_further_sums(_: Any, sums: Any, table: Any, factors: Any, count: Any, parts: Any) -> Any:
    signature = _signature_of_sums(sums, table, factors, count, parts)
    return signature and (signature, partial(_sums, further=True))


@intrinsic
def _compiled_pairs(_: Any, ends: Any, blocks: Any, now: Any, active: Any) -> Any:
    return (types.none(ends, blocks, now, active), _pairs) if contiguous(ends, blocks, now) else None


@intrinsic
def _compiled_norms(_: Any, norms: Any, w: Any, active: Any) -> Any:
    return (types.none(norms, w, active), _norms) if contiguous(norms, w) else None


@intrinsic
def _compiled_less(_: Any, out: Any, one: Any, other: Any, factor: Any) -> Any:
    return (types.none(out, one, other, factor), _less) if contiguous(out, one, other) else None


_interpreted = cast("Any", config).DISABLE_JIT
row_over_block = _plain_row if _interpreted else cast("Any", _compiled_row)
outside = _plain_outside if _interpreted else cast("Any", _compiled_outside)
set_products = _plain_sums if _interpreted else cast("Any", _compiled_sums)
add_products = _plain_further_sums if _interpreted else cast("Any", _compiled_further_sums)
step_pairs = _plain_pairs if _interpreted else cast("Any", _compiled_pairs)
set_norms = _plain_norms if _interpreted else cast("Any", _compiled_norms)
set_less = _plain_less if _interpreted else cast("Any", _compiled_less)
