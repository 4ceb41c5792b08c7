"""Power series in vectors, against the same in plain numpy and against numpy's polynomials."""

import numpy as np
import pytest
from numba import njit
from numpy.polynomial import polynomial

from rockflex import _series_vectors as vectors
from rockflex._numba_vectors import WIDE

TERMS = 7
WIDTHS = pytest.mark.parametrize("width", [WIDE, 3 * WIDE])


@njit
def oscillators_in_kernel(restoring, series, k, modes, by_value, by_rate, drive, pair):
    vectors.set_oscillators(restoring, series, k, modes, by_value, by_rate, drive, pair)


@njit
def dot_in_kernel(one, other):
    return vectors.dot(one, other)


@njit
def reach_in_kernel(reach, series, terms, step):
    vectors.set_reach(reach, series, terms, step)


@njit
def values_in_kernel(values, rates, series, u):
    vectors.set_values(values, rates, series, u)


@njit
def polynomial_in_kernel(poly, series, weights, terms):
    vectors.set_polynomial(poly, series, weights, terms)


def drawn(width):
    random = np.random.default_rng(width)
    return random, random.normal(size=(TERMS, width))


@WIDTHS
def test_the_next_coefficients(width):
    random, series = drawn(width)
    modes = np.abs(random.normal(size=(3, width)))
    force = 0.3 * modes[1] * series[3] + 0.2 * modes[0] * series[2]
    for way in (oscillators_in_kernel, vectors._plain_oscillators):
        restoring, found = np.zeros(width), series.copy()
        way(restoring, found, 2, modes, 0.2, 0.3, -0.4, 0.05)
        assert restoring == pytest.approx(force, abs=1e-15)
        assert found[4] == pytest.approx(-(force - 0.4 * modes[2]) * 0.05, abs=1e-16)
        found[4] = series[4]
        assert (found == series).all()


@WIDTHS
def test_products_of_rows(width):
    _, series = drawn(width)
    for way in (dot_in_kernel, vectors._plain_dot):
        assert way(series[0], series[1]) == pytest.approx(sum(series[0] * series[1]), abs=1e-14 * width)


@WIDTHS
@pytest.mark.parametrize("terms", [4, TERMS])
def test_how_far_series_reach(width, terms):
    _, series = drawn(width)
    sizes, step = np.abs(series[:terms]), 0.02
    rates = polynomial.polyder(sizes) / step
    for way in (reach_in_kernel, vectors._plain_reach):
        reach = np.zeros((4, width))
        way(reach, series, terms, step)
        for row, expected in zip(reach, (sizes, rates, sizes[1:], rates[1:]), strict=True):
            assert row == pytest.approx(expected.sum(axis=0), rel=1e-14)


@WIDTHS
def test_values_of_series(width):
    _, series = drawn(width)
    for way in (values_in_kernel, vectors._plain_values):
        values, rates = np.zeros((2, width))
        way(values, rates, series, 0.7)
        assert values == pytest.approx(polynomial.polyval(0.7, series), abs=1e-14)
        assert rates == pytest.approx(polynomial.polyval(0.7, polynomial.polyder(series)), abs=1e-13)


@WIDTHS
@pytest.mark.parametrize("terms", [4, TERMS])
def test_the_polynomial_of_a_row(width, terms):
    random, series = drawn(width)
    weights = random.normal(size=(2, width))
    expected = series[:terms] @ weights[0]
    expected[:-1] += polynomial.polyder(series[:terms]) @ weights[1]
    for way in (polynomial_in_kernel, vectors._plain_polynomial):
        poly = np.full(TERMS, 9.0)
        way(poly, series, weights, terms)
        assert poly[:terms] == pytest.approx(expected, abs=1e-13 * width)
        assert (poly[terms:] == 9.0).all()
