"""Vector operations in the code of kernels."""

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils

WIDE = 8  # numbers in a vector, unless a whole block of samples is one


def padded(size: int) -> int:
    """Return a size rounded up to a multiple of `WIDE`."""
    return -(-size // WIDE) * WIDE


def index(value: int) -> ir.Constant:
    """Return an index as a constant."""
    return ir.Constant(ir.IntType(64), value)


def contiguous(*arguments: Any) -> bool:
    """Return whether all arrays are contiguous; otherwise numba reports that it knows no such function."""
    return all(each.layout == "C" for each in arguments if isinstance(each, types.Array))


class Builder:
    """Operations on vectors of `lanes` numbers in the code of a kernel."""

    def __init__(self, context: Any, builder: Any, lanes: int) -> None:
        self.context, self.builder = context, builder
        self.vector, self.lanes = ir.VectorType(ir.DoubleType(), lanes), ir.VectorType(ir.IntType(32), lanes)

    def data(self, kind: Any, value: Any) -> ir.Value:
        return self.context.make_array(kind)(self.context, self.builder, value).data

    def size(self, kind: Any, value: Any, axis: int) -> ir.Value:
        array = self.context.make_array(kind)(self.context, self.builder, value)
        return self.builder.extract_value(array.shape, axis)

    def same(self, value: ir.Value) -> ir.Value:
        """Return a vector with the same value in all lanes."""
        nothing = ir.Constant(self.vector, ir.Undefined)
        one = self.builder.insert_element(nothing, value, ir.Constant(ir.IntType(32), 0))
        return self.builder.shuffle_vector(one, nothing, ir.Constant(self.lanes, [0] * self.lanes.count))

    def zero(self) -> ir.Value:
        return ir.Constant(self.vector, [0.0] * self.vector.count)

    def place(self, data: ir.Value, offset: ir.Value) -> ir.Value:
        return self.builder.bitcast(self.builder.gep(data, [offset]), self.vector.as_pointer())

    def load(self, data: ir.Value, offset: ir.Value) -> ir.Value:
        return self.builder.load(self.place(data, offset), align=8)

    def number(self, data: ir.Value, offset: ir.Value) -> ir.Value:
        return self.builder.load(self.builder.gep(data, [offset]))

    def store(self, value: ir.Value, data: ir.Value, offset: ir.Value) -> None:
        self.builder.store(value, self.place(data, offset), align=8)

    def plus(self, total: ir.Value, factor: ir.Value, vector: ir.Value) -> ir.Value:
        """Return total + factor * vector, fused where the processor can."""
        return self.plus_vector(total, self.same(factor), vector)

    def plus_vector(self, total: ir.Value, one: ir.Value, other: ir.Value) -> ir.Value:
        """Return total + one * other, lane by lane."""
        return self.builder.fadd(total, self.builder.fmul(one, other, flags=("contract",)), flags=("contract",))

    def magnitude(self, vector: ir.Value) -> ir.Value:
        return self._apply("fabs", vector)

    def root(self, vector: ir.Value) -> ir.Value:
        return self._apply("sqrt", vector)

    def _apply(self, name: str, vector: ir.Value) -> ir.Value:
        kind = ir.FunctionType(self.vector, [self.vector])
        name = f"llvm.{name}.v{self.vector.count}f64"
        return self.builder.call(cgutils.get_or_insert_function(self.builder.module, kind, name), [vector])

    def sum(self, vector: ir.Value) -> ir.Value:
        """Return the sum of the lanes, in any order."""
        number = ir.DoubleType()
        kind = ir.FunctionType(number, [number, self.vector])
        name = f"llvm.vector.reduce.fadd.v{self.vector.count}f64"
        function = cgutils.get_or_insert_function(self.builder.module, kind, name)
        return self.builder.call(function, [ir.Constant(number, -0.0), vector], fastmath=("reassoc",))

    def over(self, width: ir.Value) -> Any:
        """Return a loop over the vectors of an array as wide as that."""
        return cgutils.for_range(self.builder, self.builder.udiv(width, index(self.vector.count)))
