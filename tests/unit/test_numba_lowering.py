"""Kernels that are lowered tersely compute what numba's own lowering computes, and are much shorter."""

from typing import NamedTuple

import numba
import numpy as np
import pytest
from numba.core.codegen import JITCodeLibrary

from rockflex import _numba

pytestmark = pytest.mark.skipif(not _numba.PIPELINE, reason="this numba has no pipeline to change")
PLACE = np.dtype([("index", np.int64), ("value", np.float64), ("free", np.bool_)], align=True)


class Room(NamedTuple):
    table: np.ndarray
    sums: np.ndarray
    step: float
    steps: int


class House(NamedTuple):
    rooms: Room
    places: np.ndarray


@pytest.fixture(autouse=True)
def _a_cache_of_its_own(monkeypatch, tmp_path):
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))


def within(function):
    return _numba.compiled_within(function, inlined=False)


def plain(function):
    return numba.njit(error_model="numpy")(function)


def house():
    table = np.linspace(-1.0, 2.0, 24).reshape(2, 3, 4)
    places = np.zeros(2, dtype=PLACE).view(np.recarray)  # whose records have attributes in Python, too
    return House(Room(table, np.zeros((2, 4)), 0.25, 3), places)


def program(compiled):
    """Calls, views, records, values with several sources, early ends, and an argument that may be missing."""

    def largest(row, least):
        place, best = -1, least
        for i in range(row.size):
            if row[i] > best:
                place, best = i, row[i]
        return place, best

    largest = compiled(largest)

    def visit(house, spare, k, at):
        room = house.rooms
        if k > 2:
            room = Room(room.table, room.sums, 0.5 * room.step, room.steps - 1)
        row = room.table[k % 2, k % 3]
        place, best = largest(row, 0.1 * k)
        if place < 0:
            at.free = not at.free
            return -1.0
        at.index += place
        at.value = best if at.free else at.value - best
        first, second = room.sums[0], room.sums[1]
        first[place] += room.step
        for i in range(row.size):
            second[i] += row[i] * first[i]
        first, second = second, first
        if spare is not None:
            first[place] -= spare[place]
        else:
            second[-1] += 1.0
        return first[place] + room.steps

    visit = compiled(visit)

    def tour(house, spare, calls):
        total, k = 0.0, 0
        while k < calls:
            at = house.places[k % 2]
            found = visit(house, spare, k, at)
            if found < 0.0:
                k += 2
                continue
            for _ in range(3):
                total += found
                if total > 40.0:
                    return total
            k += 1
        return total

    return tour


@pytest.mark.parametrize("spare", [np.linspace(0.0, 1.0, 4), None])
@pytest.mark.parametrize("calls", [1, 4, 7, 60])
def test_terse_kernels_compute_the_same(spare, calls):
    ours, theirs, pure = house(), house(), house()
    terse = _numba.compiled(program(within), "terse")
    found = [
        terse(ours, spare, calls),
        plain(program(plain))(theirs, spare, calls),
        program(lambda function: function)(pure, spare, calls),
    ]
    assert found == pytest.approx([found[-1]] * 3, rel=1e-14)
    for each in (ours, theirs):
        np.testing.assert_allclose(each.rooms.sums, pure.rooms.sums, rtol=1e-14)
        for name in PLACE.names:
            np.testing.assert_allclose(each.places[name], pure.places[name], rtol=1e-14)


def instructions(text):
    return sum(line.startswith("  ") for line in text.splitlines())


def test_terse_kernels_are_a_fraction_as_long(monkeypatch):
    """As long as they are before LLVM sees them: its work is what a compilation costs."""
    written: list[int] = []
    original = JITCodeLibrary.add_ir_module

    def counting(self, module):
        written.append(instructions(str(module)))
        original(self, module)

    monkeypatch.setattr(JITCodeLibrary, "add_ir_module", counting)
    _numba.compiled(program(within), "terse")(house(), None, 4)
    terse = sum(written)
    written.clear()
    plain(program(plain))(house(), None, 4)
    assert terse < 0.5 * sum(written)
