"""The largest magnitude of a row over a unit, against numpy's roots of its derivative."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.polynomial import polynomial

from rockflex.solve.layout import Log, Span
from rockflex.solve.peaks import raise_peak, raise_peaks

coefficients = st.lists(st.floats(-10, 10).map(lambda x: round(x, 2)), min_size=3, max_size=12)


def log(*peaks):
    """Peaks of rows, and of the loss of support, which is the last."""
    times, work = np.full(len(peaks) + 1, -1.0), np.full(5, np.inf)
    return Log(np.array([*peaks, -np.inf]), times, np.zeros(4, dtype=np.int64), work, np.zeros((0, 5)), len(peaks))


def raised(poly, stop, before=0.0):
    """Peak and time of a polynomial in units of 0.5 s from t = 3 s on."""
    book = log(before)
    raise_peak(np.array([poly, np.zeros(len(poly))]), 0, stop, Span(3.0, 3.5, 0.0, 0.0, 0.5, 0.0, 0.0), book)
    return float(book.peaks[0]), float(book.times[0])


def largest(poly, stop):
    slope = polynomial.polytrim(polynomial.polyder(poly))
    turns = polynomial.polyroots(slope) if slope.size > 1 else np.array([])
    points = np.concatenate(([0.0, stop], np.clip(turns.real, 0.0, stop)))
    return np.abs(polynomial.polyval(points, poly)).max()


@given(coefficients, st.floats(0.05, 1.0))
def test_any_polynomial(poly, stop):
    peak, time = raised(poly, stop)
    size = np.abs(poly).sum()
    assert peak == pytest.approx(largest(poly, stop), abs=1e-13 * size)
    if peak > 0.0:
        assert 3.0 <= time <= 3.0 + 0.5 * stop
        assert abs(polynomial.polyval((time - 3.0) / 0.5, poly)) == pytest.approx(peak, abs=1e-12 * size)


@given(
    st.lists(st.integers(1, 99), min_size=2, max_size=5, unique=True),
    st.sampled_from([None, 0.0, 1e-12, 1e-9, 1e-6]),
    st.sampled_from([1.0, -1.0]),
)
def test_rows_that_turn_several_times(hundredths, gap, sign):
    """And that nearly turn: two turns close together, or one on the other."""
    turns = [k / 100.0 for k in hundredths]
    turns += [] if gap is None else [turns[0] + gap]
    poly = sign * polynomial.polyint(polynomial.polyfromroots(turns))
    crowded = gap is not None and np.diff(np.sort(hundredths)).min() < 3
    # On a plateau of turns crowded about a double one the search may give up; nothing on it stands out by more.
    assert raised(poly, 1.0)[0] == pytest.approx(largest(poly, 1.0), abs=1e-10 if crowded else 1e-14)


@given(coefficients, st.floats(0.05, 1.0), st.floats(0.0, 50.0))
def test_a_peak_is_only_ever_raised(poly, stop, before):
    peak, time = raised(poly, stop, before)
    alone, when = raised(poly, stop)
    if alone > before:
        assert (peak, time) == (pytest.approx(alone, rel=1e-12), pytest.approx(when, abs=1e-6))
    else:
        assert (peak, time) == (before, -1.0)


@pytest.mark.parametrize("power", [2, 3, 4, 7])
def test_growth_from_rest(power):
    """A row that starts like a power of time, as at an uplift, turns later."""
    poly = np.zeros(power + 3)
    poly[power], poly[power + 1] = 1.0, -1.5
    top = power / (1.5 * (power + 1.0))
    peak, time = raised(poly, 1.0)
    assert peak == pytest.approx(max(top**power * (1.0 - 1.5 * top), 0.5), rel=1e-13)
    poly[power + 1] = -1.0
    top = power / (power + 1.0)
    peak, time = raised(poly, 1.0)
    assert peak == pytest.approx(top**power * (1.0 - top), rel=1e-13)
    assert time == pytest.approx(3.0 + 0.5 * top, abs=1e-6)


def test_ends_of_a_step():
    book = log(1.0, 2.0, 3.0)
    raise_peaks(np.array([5.0, -4.0, 2.0, 0.0]), 0.0, 7.0, book)  # in contact the first row is the moment, no rotation
    assert book.peaks.tolist() == [1.0, 4.0, 3.0, 0.0]
    assert book.times.tolist() == [-1.0, 7.0, -1.0, 7.0]
    raise_peaks(np.array([-5.0, 4.0, 2.0, 0.5]), -1.0, 8.0, book)
    assert book.peaks.tolist() == [5.0, 4.0, 3.0, 0.5]
    assert book.times.tolist() == [8.0, 7.0, -1.0, 8.0]
    raise_peaks(np.array([-5.0, 4.0, 2.0, -0.7]), -1.0, 9.0, book)  # support is gained
    assert book.peaks.tolist() == [5.0, 4.0, 3.0, 0.5]
