"""The power series and the first root on them, against scipy's exponential and numpy's roots."""

import numpy as np
import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st
from numpy.polynomial import polynomial
from scipy.linalg import expm

from builders import frame_values
from rockflex import Frame
from rockflex.models import Model
from rockflex.response import asked_of
from rockflex.solve import Engine
from rockflex.solve.exact.series import advance, expand, row_series
from rockflex.solve.layout import Span, motion_of
from rockflex.solve.memory import recollect
from rockflex.solve.polynomials import bend, evaluate, first_descent
from twins.exact import Exact
from twins.frame import frame_properties

DT = 0.01
GIVEN = frame_values(
    n_stories=4, base_mass=60e3, stiffness_ratio=0.125, period=0.6, aspect_ratio=9.0, damping_ratio=0.03
)


def prepared(n):
    """The engine's coefficients, and the generators of its twin, whose state is [θ, D, θ', D', s, a, a'].

    And the places of the phases by side.
    """
    tied = Model(n).of(Frame(**GIVEN).rocking())
    phases = Engine(tied, asked_of(tied))._phases
    places = {side: phases.place(tied.start(int(side))) for side in (0.0, 1.0, -1.0)}
    return phases.system(DT, 0.0), places, Exact(**frame_properties(**GIVEN, n_modes=n).kwargs(), dt=DT, substeps=1)


def draw(n, *, rocking, seed=3):
    rng = np.random.default_rng(seed)
    state = np.concatenate((0.05 * rng.standard_normal(n), rng.standard_normal(n), [0.02, -0.1]))
    if not rocking:
        state[-2:] = 0.0
    return state, 2.0, -150.0, -1.0 if rocking else 0.0


def room(system, state):
    terms = int(system.phases["terms"].max())
    return motion_of(state.copy(), system.layout, system.plain_rows.shape[1], terms)


def to_twin(state, n, side, acceleration, slope):
    d, v, turn = state[:n], state[n : 2 * n], state[2 * n :]
    return np.concatenate((turn[:1], d, turn[1:], v, [side, acceleration, slope]))


def from_twin(z, n):
    return np.concatenate((z[1 : n + 1], z[n + 2 : 2 * n + 2], z[[0, n + 1]]))


@pytest.mark.parametrize("n", [1, 2, 4])
@pytest.mark.parametrize("rocking", [False, True])
@pytest.mark.parametrize("u", [0.0, 0.3, 1.0])
def test_series_is_the_exponential(n, rocking, u):
    system, places, twin = prepared(n)
    state, acceleration, slope, side = draw(n, rocking=rocking)
    step = 0.9 / twin.fastest  # as a unit of the grid: no mode turns by more than a radian
    motion = room(system, state)
    recollect(system, places[side], motion)
    expand(system, places[side], motion, Span(0.0, step, acceleration, slope, step, 0.0, 0.0), np.nan, np.nan)
    advance(system, motion, u, step)
    moved = motion.state
    z = to_twin(state, n, side, acceleration, slope)
    expected = from_twin(expm(twin.generator[rocking] * step * u) @ z, n)
    np.testing.assert_allclose(moved, expected, rtol=1e-12, atol=1e-14)
    if not rocking:
        assert not moved[-2:].any()


@pytest.mark.parametrize("rocking", [False, True])
def test_a_row_along_the_series(rocking):
    n = 3
    system, places, twin = prepared(n)
    state, acceleration, slope, side = draw(n, rocking=rocking)
    phase, step = places[side], 0.9 / twin.fastest
    rows = np.random.default_rng(8).standard_normal((2, 2 * n + 4))
    rows[1, ::2] = 0.0
    system.plain_rows[phase, :2] = rows
    motion, span = room(system, state), Span(0.0, step, acceleration, slope, step, 0.0, 0.0)
    expand(system, phase, motion, span, np.nan, np.nan)
    for row in (0, 1):
        row_series(system, phase, row, motion, span)
        for u in (0.0, 0.4, 1.0):
            advance(system, motion, u, step)
            whole = np.concatenate((motion.state, [acceleration + slope * step * u, 1.0]))
            assert evaluate(motion.polys, row, u)[0] == pytest.approx(rows[row] @ whole, rel=1e-12)


def test_a_lift_that_is_known_replaces_the_equation_of_motion():
    n = 2
    system, places, twin = prepared(n)
    state, acceleration, slope, _ = draw(n, rocking=False)
    step = 0.9 / twin.fastest

    def series(side, lift):
        motion = room(system, state)
        expand(system, places[side], motion, Span(0.0, step, acceleration, slope, step, 0.0, 0.0), lift, np.nan)
        return motion.series

    free = series(1.0, np.nan)
    told = series(1.0, 2.0 * free[2, n] / step**2)
    np.testing.assert_allclose(told, free, rtol=1e-12)
    none = series(1.0, 0.0)
    assert not none[:3, n].any()  # the rotation starts with the cube of time, without any rounding
    assert none[3, n] != 0.0
    # D'' then is that of contact.
    contact = series(0.0, np.nan)
    np.testing.assert_allclose(none[:3, :n], contact[:3, :n], rtol=1e-14)


coefficients = st.lists(st.floats(-10, 10).map(lambda x: round(x, 3)), min_size=2, max_size=14)
unit = st.floats(0.0, 1.0)


@given(coefficients, unit)
def test_horner(poly, u):
    value, slope = evaluate(np.array([poly]), 0, u)
    size = np.abs(poly).sum() + 1e-300
    assert value == pytest.approx(polynomial.polyval(u, poly), abs=1e-14 * size)
    assert slope == pytest.approx(polynomial.polyval(u, polynomial.polyder(poly)), abs=1e-13 * size * len(poly))


@given(coefficients, st.floats(0.01, 1.0))
def test_bend_bounds_the_curvature(poly, reach):
    curvature = np.abs(polynomial.polyval(np.linspace(0, reach, 101), polynomial.polyder(poly, 2)))
    bound = bend(np.array([poly]), 0, reach)
    assert bound >= curvature.max() * (1 - 1e-12)
    if min(poly) >= 0.0:
        assert bound == pytest.approx(curvature[-1])


def least(poly, start, stop):
    """Smallest value on an interval, from the ends and the roots of the derivative."""
    slope = polynomial.polytrim(polynomial.polyder(poly))
    inside = polynomial.polyroots(slope).real if slope.size > 1 else np.array([])
    points = np.concatenate(([start, stop], np.clip(inside, start, stop)))
    return polynomial.polyval(points, poly).min()


def check_descent(poly, start, stop):
    poly = np.array(poly)
    size = np.abs(poly).sum()
    u = first_descent(poly[None].copy(), 0, start, stop)
    if np.isinf(u):
        assert least(poly, start, stop) >= -1e-13 * size
        return u
    assert start <= u <= stop
    assert least(poly, start, u) >= -1e-13 * size  # none was passed over
    assert abs(polynomial.polyval(u, poly)) <= 1e-13 * size  # and this is one
    return u


@given(coefficients, unit, unit)
def test_first_descent_of_any_polynomial(poly, one, other):
    start, stop = min(one, other), max(one, other)
    assume(polynomial.polyval(start, poly) >= 0.0)
    check_descent(poly, start, stop)


@given(
    st.lists(st.floats(-1.5, 2.5).map(lambda x: round(x, 4)), min_size=1, max_size=7, unique=True),
    st.sampled_from([0.0, 1e-14, 1e-12, 1e-9, 1e-6, -1e-13, -1e-10, -1e-7]),
    st.floats(0.0, 1.0),
)
@example([0.5], 0.0, 0.5)
def test_first_descent_by_a_near_tangent(roots, gap, touch):
    """A parabola that touches zero, or misses it or dips below it by a little, times a polynomial of known roots."""
    poly = polynomial.polymul(polynomial.polyfromroots(roots), [touch * touch + gap, -2.0 * touch, 1.0])
    if polynomial.polyval(0.0, poly) < 0.0:
        poly = -poly
    check_descent(poly, 0.0, 1.0)


@given(st.lists(st.integers(1, 99), min_size=1, max_size=6, unique=True), st.sampled_from([1e-100, 1.0, 1e100]))
def test_first_descent_finds_simple_roots_to_the_last_digits(hundredths, scale):
    roots = np.sort(np.array(hundredths) / 100.0)
    poly = polynomial.polyfromroots(roots)
    poly *= np.sign(poly[0])
    slope = np.abs(polynomial.polyval(roots[0], polynomial.polyder(poly)))
    found = first_descent(scale * poly[None], 0, 0.0, 1.0)
    assert found == pytest.approx(roots[0], abs=1e-15 + 1e-15 * np.abs(poly).sum() / slope)


@pytest.mark.parametrize(
    ("poly", "start", "stop", "expected"),
    [
        ([0.0, 1.0, -1.0], 0.0, 2.0, 1.0),  # starts at a root, and rises
        ([0.0, -1.0], 0.0, 1.0, 0.0),  # starts at a root, and falls
        ([0.0, 0.0, 0.0], 0.0, 1.0, 0.0),  # zero throughout
        ([1.0, 0.0, 0.0], 0.0, 1.0, np.inf),
        ([1.0, -1.0, 0.0], 0.0, 1.0, np.inf),  # the root is the end itself, which belongs to what follows
        ([1.0, -1.0, 0.0], 0.0, 1.0 + 1e-9, 1.0),
        ([1.0 - 1e-6, -4.0, 4.0], 0.0, 1.0, 0.5 - 0.5e-3),
        ([1.0 + 1e-6, -4.0, 4.0], 0.0, 1.0, np.inf),
        ([0.0, 0.0, 0.0, 1.0, -2.0], 0.0, 1.0, 0.0),  # does not rise at the start: the caller divides zeros out
        ([1.0, -2.0, 0.0], 0.25, 1.0, 0.5),
        ([1.0, -2.0, 0.0], 0.0, 0.25, np.inf),
    ],
)
def test_first_descent_by_hand(poly, start, stop, expected):
    found = first_descent(np.array([poly]), 0, start, stop)
    assert found == pytest.approx(expected, abs=1e-12)
