"""Power series of all coordinates at once, in vector registers, as in `_vectors`.

Row k of a series (n, K') contains the k-th coefficients of all coordinates, K' a multiple of `WIDE`.
"""

from typing import Any, cast

import numpy as np
from llvmlite import ir
from numba import config, types
from numba.core import cgutils
from numba.extending import intrinsic

from rockflex._arrays import Array
from rockflex._numba_vectors import WIDE, Builder, contiguous, index


def _plain_oscillators(
    restoring: Array, series: Array, k: int, modes: Array, by_value: float, by_rate: float, drive: float, pair: float
) -> None:
    """Set the coefficients k + 2 of oscillators that nothing but an acceleration drives, and their restoring forces.

    `modes` (3, K') contains the factors of D and of D', and 1 for a coordinate that is driven, otherwise 0.
    """
    restoring[:] = modes[1] * by_rate * series[k + 1] + modes[0] * by_value * series[k]
    series[k + 2] = -(restoring + drive * modes[2]) * pair


def _plain_dot(one: Array, other: Array) -> float:
    """Return the sum of the products of two rows (K',)."""
    return float(one @ other)


def _plain_reach(reach: Array, series: Array, terms: int, step: float) -> None:
    """Set bounds over a step, for each coordinate: of its size, of its rate, and of how much either changes."""
    order = np.arange(2.0, terms)[:, None]
    sizes = np.abs(series[:terms])
    reach[2] = sizes[1:].sum(axis=0)
    reach[0] = reach[2] + sizes[0]
    reach[3] = (order * sizes[2:]).sum(axis=0) / step
    reach[1] = reach[3] + sizes[1] / step


def _plain_values(values: Array, rates: Array, series: Array, u: float) -> None:
    """Set the values (K',) of the series at u, and their derivatives (Horner)."""
    values[:], rates[:] = series[-1], 0.0
    for k in range(series.shape[0] - 2, -1, -1):
        rates[:] = rates * u + values
        values[:] = values * u + series[k]


def _plain_polynomial(poly: Array, series: Array, weights: Array, terms: int) -> None:
    """Set the coefficients of a sum of the coordinates and of their rates, by their weights (2, K')."""
    order = np.arange(1.0, terms)
    poly[:terms] = series[:terms] @ weights[0]
    poly[: terms - 1] += order * (series[1:terms] @ weights[1])


class _Rows:
    """The rows of an array, vector by vector."""

    def __init__(self, make: Builder, kind: Any, value: Any) -> None:
        self.make, self.data, self.axis = make, make.data(kind, value), kind.ndim - 1
        self.width = make.size(kind, value, self.axis)

    def _place(self, row: ir.Value, start: ir.Value) -> ir.Value:
        return self.make.builder.add(self.make.builder.mul(row, self.width), start)

    def load(self, row: ir.Value, start: ir.Value) -> ir.Value:
        return self.make.load(self.data, self._place(row, start))

    def store(self, value: ir.Value, row: ir.Value, start: ir.Value) -> None:
        self.make.store(value, self.data, self._place(row, start))


def _oscillators(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    make, one = Builder(context, builder, WIDE), index(1)
    restoring, series, modes = (_Rows(make, signature.args[i], arguments[i]) for i in (0, 1, 3))
    k, by_value, by_rate, drive, pair = (arguments[i] for i in (2, 4, 5, 6, 7))
    by_value, by_rate, drive, pair = (make.same(each) for each in (by_value, by_rate, drive, pair))
    with make.over(series.width) as loop:
        start = builder.mul(loop.index, index(WIDE))
        force = builder.fmul(builder.fmul(modes.load(one, start), by_rate), series.load(builder.add(k, one), start))
        force = make.plus_vector(force, builder.fmul(modes.load(index(0), start), by_value), series.load(k, start))
        restoring.store(force, index(0), start)
        whole = make.plus_vector(force, drive, modes.load(index(2), start))
        series.store(builder.fneg(builder.fmul(whole, pair)), builder.add(k, index(2)), start)
    return context.get_dummy_value()


def _dot(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    make = Builder(context, builder, WIDE)
    one, other = (_Rows(make, kind, each) for kind, each in zip(signature.args, arguments, strict=True))
    total = cgutils.alloca_once_value(builder, make.zero())
    with make.over(one.width) as loop:
        start = builder.mul(loop.index, index(WIDE))
        products = make.plus_vector(builder.load(total), one.load(index(0), start), other.load(index(0), start))
        builder.store(products, total)
    return make.sum(builder.load(total))


def _reach(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    make = Builder(context, builder, WIDE)
    reach, series = (_Rows(make, signature.args[i], arguments[i]) for i in range(2))
    terms, step = arguments[2], make.same(arguments[3])
    moves, turns = (cgutils.alloca_once(builder, make.vector) for _ in range(2))
    with make.over(series.width) as loop:
        start = builder.mul(loop.index, index(WIDE))
        for each in (moves, turns):
            builder.store(make.zero(), each)
        with cgutils.for_range(builder, builder.sub(terms, index(2))) as inner:
            k = builder.add(inner.index, index(2))
            size = make.magnitude(series.load(k, start))
            builder.store(builder.fadd(builder.load(moves), size), moves)
            builder.store(make.plus(builder.load(turns), builder.sitofp(k, ir.DoubleType()), size), turns)
        first = make.magnitude(series.load(index(1), start))
        moved = builder.fadd(first, builder.load(moves))
        turned = builder.fdiv(builder.load(turns), step)
        reach.store(builder.fadd(make.magnitude(series.load(index(0), start)), moved), index(0), start)
        reach.store(builder.fadd(builder.fdiv(first, step), turned), index(1), start)
        reach.store(moved, index(2), start)
        reach.store(turned, index(3), start)
    return context.get_dummy_value()


def _values(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    make = Builder(context, builder, WIDE)
    values, rates, series = (_Rows(make, signature.args[i], arguments[i]) for i in range(3))
    u = make.same(arguments[3])
    last = builder.sub(make.size(signature.args[2], arguments[2], 0), index(1))
    value, rate = (cgutils.alloca_once(builder, make.vector) for _ in range(2))
    with make.over(series.width) as loop:
        start = builder.mul(loop.index, index(WIDE))
        builder.store(series.load(last, start), value)
        builder.store(make.zero(), rate)
        with cgutils.for_range(builder, last) as inner:
            k, before = builder.sub(builder.sub(last, index(1)), inner.index), builder.load(value)
            builder.store(make.plus_vector(before, builder.load(rate), u), rate)
            builder.store(make.plus_vector(series.load(k, start), before, u), value)
        values.store(builder.load(value), index(0), start)
        rates.store(builder.load(rate), index(0), start)
    return context.get_dummy_value()


def _polynomial(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    make, number = Builder(context, builder, WIDE), ir.DoubleType()
    poly = make.data(signature.args[0], arguments[0])
    series, weights = (_Rows(make, signature.args[i], arguments[i]) for i in (1, 2))
    last = builder.sub(arguments[3], index(1))
    total = cgutils.alloca_once(builder, make.vector)

    def coefficient(k: ir.Value, following: ir.Value) -> None:
        """Set coefficient k, with the rates from row `following`, which is k at the last one: it has none."""
        builder.store(make.zero(), total)
        order = builder.sitofp(following, number)
        order = builder.select(builder.icmp_signed("==", k, following), ir.Constant(number, 0.0), order)
        with make.over(series.width) as loop:
            start = builder.mul(loop.index, index(WIDE))
            rates = builder.fmul(weights.load(index(1), start), make.same(order))
            found = make.plus_vector(builder.load(total), rates, series.load(following, start))
            builder.store(make.plus_vector(found, weights.load(index(0), start), series.load(k, start)), total)
        builder.store(make.sum(builder.load(total)), builder.gep(poly, [k]))

    with cgutils.for_range(builder, last) as outer:
        coefficient(outer.index, builder.add(outer.index, index(1)))
    coefficient(last, last)
    return context.get_dummy_value()


@intrinsic
def _compiled_oscillators(
    _: Any,
    restoring: Any,
    series: Any,
    k: Any,
    modes: Any,
    by_value: Any,
    by_rate: Any,
    drive: Any,
    pair: Any,
) -> Any:
    numbers = (types.float64 for _ in (by_value, by_rate, drive, pair))
    signature = types.none(restoring, series, k, modes, *numbers)
    return (signature, _oscillators) if contiguous(*signature.args) else None


@intrinsic
def _compiled_dot(_: Any, one: Any, other: Any) -> Any:
    return (types.float64(one, other), _dot) if contiguous(one, other) else None


@intrinsic
def _compiled_reach(_: Any, reach: Any, series: Any, terms: Any, step: Any) -> Any:
    signature = types.none(reach, series, terms, step)
    return (signature, _reach) if contiguous(*signature.args) else None


@intrinsic
def _compiled_values(_: Any, values: Any, rates: Any, series: Any, u: Any) -> Any:
    signature = types.none(values, rates, series, u)
    return (signature, _values) if contiguous(*signature.args) else None


@intrinsic
def _compiled_polynomial(_: Any, poly: Any, series: Any, weights: Any, terms: Any) -> Any:
    signature = types.none(poly, series, weights, terms)
    return (signature, _polynomial) if contiguous(*signature.args) else None


_interpreted = cast("Any", config).DISABLE_JIT
set_oscillators = _plain_oscillators if _interpreted else cast("Any", _compiled_oscillators)
dot = _plain_dot if _interpreted else cast("Any", _compiled_dot)
set_reach = _plain_reach if _interpreted else cast("Any", _compiled_reach)
set_values = _plain_values if _interpreted else cast("Any", _compiled_values)
set_polynomial = _plain_polynomial if _interpreted else cast("Any", _compiled_polynomial)
