"""Weighted sums in vector registers, against NumPy."""

import numpy as np
import pytest

from rockflex import _weighted
from rockflex._kernel import kernel
from rockflex._weighted import LANES, LINE, aligned, whole_vectors


@kernel
def weigh_in_kernel(out, factor, weights, row, table, first, last, count):
    _weighted.weigh(out, factor, weights, row, table, first, last, count)


@kernel
def place_in_kernel(out, start, factor, weights, row, table, first, last, count):
    _weighted.place_by(out, start, factor, weights, row, table, first, last, count)


@pytest.mark.parametrize("count", [1, LANES, LANES + 1, 2 * LANES, 2 * LANES + 1, 15])
@pytest.mark.parametrize(("first", "last"), [(1, 1), (1, 2), (2, 6), (5, 3)])
def test_rows_are_summed_with_their_weights(count, first, last):
    rng = np.random.default_rng(count)
    end = whole_vectors(count)
    table, weights, start = rng.standard_normal((6, 20)), rng.standard_normal((3, 6)), rng.standard_normal(20)
    table[last:] = np.nan  # not known yet
    if last <= 1:
        table[1:] = np.nan
    used = [0, *range(first, last)]
    wanted = 0.3 * (weights[2, used] @ table[used])
    for given in (weigh_in_kernel, _weighted._plain_weigh):
        out = np.full(20, 7.0)
        given(out, 0.3, weights, 2, table, first, last, count)
        np.testing.assert_allclose(out[:end], wanted[:end], rtol=1e-13, atol=1e-14)
        assert np.all(out[end:] == 7.0)
    for given in (place_in_kernel, _weighted._plain_place):
        out = np.full(20, 7.0)
        given(out, start, 0.3, weights, 2, table, first, last, count)
        np.testing.assert_allclose(out[:end], (start + wanted)[:end], rtol=1e-13, atol=1e-14)
        assert np.all(out[end:] == 7.0)


@pytest.mark.parametrize("size", [1, 4, 5, 8])
def test_sizes_are_rounded_up(size):
    assert whole_vectors(size) % LANES == 0
    assert size <= whole_vectors(size) < size + LANES


def test_arrays_start_at_cache_lines():
    for columns in (4, 8, 12):
        array = aligned(5, columns)
        assert array.shape == (5, columns)
        assert array.flags.c_contiguous
        assert array.ctypes.data % (LINE * 8) == 0
        assert not array.any()
