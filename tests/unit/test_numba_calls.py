"""Kernels that pass tuples by pointer, and do not check calls that cannot fail, compute what Python computes."""

import gc
import math
from typing import NamedTuple

import numba
import numpy as np
import pytest

from rockflex import _numba

if not _numba.PIPELINE:
    pytest.skip("this numba has no pipeline to change", allow_module_level=True)

from rockflex import _numba_lowering, _numba_typing


class Pair(NamedTuple):
    low: float
    high: float


class Tools(NamedTuple):
    table: np.ndarray
    limits: Pair
    open: bool
    count: int


class Shop(NamedTuple):
    tools: Tools
    sums: np.ndarray
    scale: float


@pytest.fixture(autouse=True)
def _a_cache_of_its_own(monkeypatch, tmp_path):
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))


def within(function):
    return _numba.compiled_within(function, inlined=False)


def inlined(function):
    return _numba.compiled_within(function, inlined=True)


def itself(function):
    return function


def shop():
    return Shop(Tools(np.linspace(-1.0, 2.0, 12).reshape(3, 4), Pair(-0.5, 1.5), True, 3), np.zeros(4), 0.25)


def program(compiled):
    """Tuples passed on, in part, changed, chosen from two, kept in a variable, and returned."""

    def clipped(tools, i, k):
        return min(max(tools.table[i, k], tools.limits.low), tools.limits.high) if tools.open else tools.limits.low

    clipped = compiled(clipped)

    def narrower(tools, by):
        return Tools(tools.table, Pair(tools.limits.low + by, tools.limits.high - by), not tools.open, tools.count - 1)

    narrower = compiled(narrower)

    def add(shop, factor):
        tools = shop.tools
        for i in range(tools.count):
            for k in range(shop.sums.size):
                shop.sums[k] += factor * shop.scale * clipped(tools, i, k)

    add = compiled(add)

    def twice(one, other, k):
        return one.tools.table[0, k] + other.tools.table[2, k] + one.sums[k] * other.scale

    twice = compiled(twice)

    def tour(shop, other, calls):
        total, now = 0.0, shop
        for call in range(calls):
            add(now, 1.0 + call)
            tools = narrower(now.tools, 0.125)
            now = Shop(tools, now.sums, 0.5 * now.scale) if call % 2 == 0 else other
            chosen = now if call % 3 == 0 else shop
            total += chosen.tools.limits.high + twice(now, chosen, call % 4) + twice(chosen, chosen, 0)
        return total, now.tools.count

    return tour


@pytest.mark.parametrize("calls", [0, 1, 2, 9])
@pytest.mark.parametrize("compiled", [within, inlined])
def test_tuples_are_the_same_by_pointer(compiled, calls):
    ours, others, pure, others_pure = shop(), shop(), shop(), shop()
    found = _numba.compiled(program(compiled), "tour")(ours, others, calls)
    assert found == pytest.approx(program(itself)(pure, others_pure, calls), rel=1e-14)
    np.testing.assert_allclose(ours.sums, pure.sums, rtol=1e-14)
    np.testing.assert_allclose(others.sums, others_pure.sums, rtol=1e-14)


@pytest.mark.parametrize("compiled", [within, inlined])
def test_a_function_that_numba_compiles_in_its_own_way_can_call_kernels(compiled):
    @compiled
    def total(shop, factor):
        sums = 0.0
        for k in range(shop.sums.size):
            sums += factor * shop.sums[k] + shop.tools.limits.high
        return sums if shop.tools.open else -sums

    plain = numba.njit(lambda shop: total(shop, shop.scale) + total(shop, 1.0))
    given = shop()
    given.sums[:] = (1.0, 2.0, 3.0, 4.0)
    assert plain(given) == total(given, 0.25) + total(given, 1.0) == 0.25 * 10.0 + 10.0 + 2 * 4 * 1.5


def large(x, scale):
    """Too large to become part of its callers."""
    total = 0.0
    for i in range(x.size):
        for power in range(1, 4):
            total += math.sin(x[i]) ** power + math.cos(x[i]) * math.exp(-scale) + math.log(1.0 + scale * x[i] * x[i])
            total -= math.atan2(x[i], scale) + math.sinh(0.1 * x[i]) * math.cosh(scale) - math.tanh(x[i] / scale)
            if total > 10.0:
                total = math.sqrt(total) + math.atan(x[i]) + math.log10(total) + math.exp(1.0 / total)
            elif total < -10.0:
                total = math.sqrt(-total) - math.asinh(x[i]) - math.log2(-total) + math.erf(1.0 / total)
            x[i] += math.floor(total) + math.hypot(scale, total) * math.sin(power * scale)
    return total


@pytest.mark.parametrize("callable_by_python", [itself, lambda kernel: numba.njit(lambda *given: kernel(*given))])
def test_a_kernel_is_called_after_another_that_contains_it(callable_by_python):
    """In the machine code of the other it takes fewer arguments: called by mistake, it would crash the process."""
    inner = within(large)
    outer = within(lambda x, y: inner(x, 0.5) + inner(y, 0.25) + inner(x, 0.125) + inner(y, 2.0))
    callable_by_python(outer)(np.ones(3), np.ones(4))
    assert callable_by_python(inner)(np.ones(3), 0.5) == pytest.approx(large(np.ones(3), 0.5), rel=1e-12)


def written(monkeypatch, call):
    """The text of all functions that a call compiles."""
    texts: list[str] = []
    finish = _numba_lowering.TerseLower.lower_normal_function

    def keep(self, described):
        finish(self, described)
        texts.append(str(self.module))

    monkeypatch.setattr(_numba_lowering.TerseLower, "lower_normal_function", keep)
    call()
    return texts


def head(texts, name):
    (line,) = {line for text in texts for line in text.splitlines() if line.startswith("define") and name in line}
    return line


def test_a_large_tuple_is_one_argument(monkeypatch):
    texts = written(monkeypatch, lambda: _numba.compiled(program(within), "tour")(shop(), shop(), 3))
    assert head(texts, "clipped").count('%"') == 5  # result, error, tuple and two numbers


def fails(compiled):
    def last(values, k):
        if k >= values.size:
            raise IndexError
        return values[k]

    last = compiled(last)

    def before(values, k):
        return 2.0 * last(values, k)

    return compiled(before)


@pytest.mark.parametrize("entry", [_numba.compiled, lambda function, _: numba.njit(function)])
@pytest.mark.parametrize("compiled", [within, inlined])
def test_an_exception_arrives_through_all_kernels(compiled, entry):
    inner = fails(compiled)
    kernel = entry(lambda values, k: inner(values, k), "outer")
    assert kernel(np.ones(2), 1) == 2.0
    with pytest.raises(IndexError):
        kernel(np.ones(2), 2)
    assert kernel(np.ones(2), 0) == 2.0


def perhaps(compiled):
    def root(x):
        return x**0.5 if x >= 0.0 else None

    root = compiled(root)

    def rooted(x):
        found = root(x)
        return -1.0 if found is None else found

    return compiled(rooted)


def test_a_result_may_be_missing():
    inner = perhaps(within)
    kernel = _numba.compiled(lambda x: inner(x), "outer")
    assert (kernel(4.0), kernel(-4.0)) == (2.0, -1.0)


def test_a_kernel_cannot_call_itself():
    @within
    def factorial(n):
        if n < 2:
            return 1
        return n * factorial(n - 1)

    kernel = _numba.compiled(lambda n: factorial(n), "outer")
    with pytest.raises(Exception, match="factorial calls itself, which kernels cannot do; write a loop"):
        kernel(4)


def test_garbage_is_collected_again_after_a_compilation():
    assert gc.isenabled()
    _numba.compiled(lambda x: x + 1.0, "entry")(1.0)
    assert gc.isenabled()


def test_what_was_remembered_is_forgotten():
    _numba.compiled(program(within), "tour")(shop(), shop(), 1)
    assert not _numba_typing.MEMORIES
