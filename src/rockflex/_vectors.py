"""Arithmetic on all samples of a block at once, in vector registers.

The loops that numba compiles are not turned into vector instructions here: for all that the compiler knows, the arrays
could overlap. The intrinsics state the operations on vectors themselves; on any processor they become the
instructions that it has.
"""

from typing import Any, cast

from llvmlite import ir
from numba import config, types
from numba.core import cgutils
from numba.extending import intrinsic

from rockflex._arrays import Array

BLOCK = 16  # samples in a block

_VECTOR = ir.VectorType(ir.DoubleType(), BLOCK)
_LANES = ir.VectorType(ir.IntType(32), BLOCK)


def padded(size: int) -> int:
    """Return a size rounded up to a multiple of `BLOCK`."""
    return -(-size // BLOCK) * BLOCK


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


def _plain_sums(sums: Array, table: Array, factors: Array) -> None:
    """Add ``factors @ table`` to the sums; `table` has shape (BLOCK, n) with n a multiple of BLOCK."""
    sums += factors @ table


class _Builder:
    """Vector operations in the code of a kernel."""

    def __init__(self, context: Any, builder: Any) -> None:
        self.context, self.builder = context, builder

    def data(self, kind: Any, value: Any) -> ir.Value:
        return self.context.make_array(kind)(self.context, self.builder, value).data

    def size(self, kind: Any, value: Any, axis: int) -> ir.Value:
        array = self.context.make_array(kind)(self.context, self.builder, value)
        return self.builder.extract_value(array.shape, axis)

    def same(self, value: ir.Value) -> ir.Value:
        """Return a vector with the same value in all lanes."""
        one = self.builder.insert_element(ir.Constant(_VECTOR, ir.Undefined), value, ir.Constant(ir.IntType(32), 0))
        return self.builder.shuffle_vector(one, ir.Constant(_VECTOR, ir.Undefined), ir.Constant(_LANES, [0] * BLOCK))

    def place(self, data: ir.Value, offset: ir.Value) -> ir.Value:
        return self.builder.bitcast(self.builder.gep(data, [offset]), _VECTOR.as_pointer())

    def load(self, data: ir.Value, offset: ir.Value) -> ir.Value:
        return self.builder.load(self.place(data, offset), align=8)

    def number(self, data: ir.Value, offset: ir.Value) -> ir.Value:
        return self.builder.load(self.builder.gep(data, [offset]))

    def store(self, value: ir.Value, data: ir.Value, offset: ir.Value) -> None:
        self.builder.store(value, self.place(data, offset), align=8)

    def plus(self, total: ir.Value, factor: ir.Value, vector: ir.Value) -> ir.Value:
        """Return total + factor * vector, fused where the processor can."""
        product = self.builder.fmul(self.same(factor), vector, flags=("contract",))
        return self.builder.fadd(total, product, flags=("contract",))


def _index(value: int) -> ir.Constant:
    return ir.Constant(ir.IntType(64), value)


def _row(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    make = _Builder(context, builder)
    kinds = dict(enumerate(signature.args))
    values, course, table, begun, kicked = (make.data(kinds[i], arguments[i]) for i in (0, 4, 5, 6, 8))
    constant, by_ground, by_slope, active = (arguments[i] for i in (1, 2, 3, 7))
    pairs = builder.lshr(make.size(kinds[5], arguments[5], 0), _index(1))
    total = make.plus(make.same(constant), by_ground, make.load(course, _index(0)))
    total = make.plus(total, by_slope, make.load(course, _index(BLOCK)))
    for j in range(BLOCK):
        total = make.plus(total, make.number(course, _index(2 * BLOCK + j)), make.load(kicked, _index(BLOCK - j)))
    sums = cgutils.alloca_once_value(builder, total)
    with cgutils.for_range(builder, active) as loop:
        found = builder.load(sums)
        for k in (loop.index, builder.add(pairs, loop.index)):
            found = make.plus(found, make.number(begun, k), make.load(table, builder.mul(k, _index(BLOCK))))
        builder.store(found, sums)
    make.store(builder.load(sums), values, _index(0))
    return context.get_dummy_value()


def _outside(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    make = _Builder(context, builder)
    values = make.load(make.data(signature.args[0], arguments[0]), _index(0))
    below = builder.fcmp_ordered("<", values, make.same(arguments[1]))
    above = builder.fcmp_ordered(">", values, make.same(arguments[2]))
    return builder.zext(builder.bitcast(builder.or_(below, above), ir.IntType(BLOCK)), ir.IntType(64))


def _sums(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    make = _Builder(context, builder)
    sums, table, factors = (make.data(kind, each) for kind, each in zip(signature.args, arguments, strict=True))
    width = make.size(signature.args[1], arguments[1], 1)
    with cgutils.for_range(builder, builder.udiv(width, _index(BLOCK))) as loop:
        place = builder.mul(loop.index, _index(BLOCK))
        total = make.load(sums, place)
        for j in range(BLOCK):
            row = builder.add(place, builder.mul(width, _index(j)))
            total = make.plus(total, make.number(factors, _index(j)), make.load(table, row))
        make.store(total, sums, place)
    return context.get_dummy_value()


def _contiguous(*arguments: Any) -> bool:
    """Return whether all arrays are contiguous; otherwise numba reports that it knows no such function."""
    return all(each.layout == "C" for each in arguments if isinstance(each, types.Array))


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
    return (types.none(*given), _row) if _contiguous(*given) else None


@intrinsic
def _compiled_outside(_: Any, values: Any, lower: Any, upper: Any) -> Any:
    return (types.int64(values, lower, upper), _outside) if _contiguous(values) else None


@intrinsic
def _compiled_sums(_: Any, sums: Any, table: Any, factors: Any) -> Any:
    return (types.none(sums, table, factors), _sums) if _contiguous(sums, table, factors) else None


_interpreted = cast("Any", config).DISABLE_JIT
row_over_block = _plain_row if _interpreted else cast("Any", _compiled_row)
outside = _plain_outside if _interpreted else cast("Any", _compiled_outside)
add_products = _plain_sums if _interpreted else cast("Any", _compiled_sums)
