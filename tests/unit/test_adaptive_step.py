"""One Runge-Kutta step: its stages, its order, its continuous extension and its error control."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.integrate._ivp import dop853_coefficients as published

from builders import frame_values
from rockflex import BoucWen, Frame
from rockflex.engine import tableau
from rockflex.models import EXTRA, Model, Quantities
from rockflex.solve import Engine
from rockflex.solve.adaptive.layout import TERMS, TRIAL, stages_of
from rockflex.solve.adaptive.step import FAILED, expand_nested, extend, row_poly, settle_on, step_over, take_step
from rockflex.solve.adaptive.sums import place_stage
from rockflex.solve.layout import Span
from rockflex.solve.progress import progress_at_start
from twins import complete_model as twin
from twins.complete import complete_frame

FRAME = frame_values(
    n_stories=2, base_mass=60e3, stiffness_ratio=0.125, period=0.6, aspect_ratio=5.0, damping_ratio=0.04
)
START = np.array([0.02, 0.01, -0.2, 0.3, 0.05, 0.4])  # [D, D', θ, θ']
A, SLOPE = 1.5, -20.0
ENDLESS = np.array([np.inf, 0.0, 0.0, 0.0, 0.0])  # work


def prepared(tolerance=1e30):
    """The engine of a complete model of two modes, whose steps are never refused."""
    model = Model(complete=True).of(Frame(**FRAME).rocking())
    return Engine(model, Quantities.none(2), tolerance=tolerance)


def flow(tolerance=1e30):
    return prepared(tolerance)._flow


def over(step, begun=0.0):
    """What is left of the sample, after some of it is done."""
    return Span(begun, begun + step, A + SLOPE * begun, SLOPE, step, 0.0, 0.0)


def room_of(motion, rows=1):
    """Room for steps from a motion, of which the last three entries count energies."""
    return stages_of(motion, motion.size - EXTRA + 1, rows, ENDLESS, progress_at_start(0)[0])


def started():
    return room_of(np.concatenate((START, np.zeros(EXTRA))))


def exact(time):
    """The state after `time`, by the twin's field and SciPy."""
    model = twin.CompleteModel(twin.Structure.of(**complete_frame(**FRAME)), complete=True)
    start = np.concatenate((START[4:], START[:4]))
    sol = solve_ivp(
        lambda t, y: model.field(y, A + SLOPE * t, 1), (0.0, time), start, method="DOP853", rtol=3e-14, atol=1e-16
    )
    return np.concatenate((sol.y[2:, -1], sol.y[:2, -1]))


def stepped(step, given=None):
    """Room after one step of this length."""
    room = started()
    room.at.step = step
    taken = take_step(given or flow(), 1.0, over(step), room)
    assert taken == step
    return room


def observed(errors, steps):
    return np.diff(np.log(errors)) / np.diff(np.log(steps))


def test_the_coefficients_are_the_published_ones():
    np.testing.assert_allclose(tableau.A, published.A[:16, :16], rtol=1e-14, atol=1e-16)
    np.testing.assert_allclose(tableau.C, published.C[:16], rtol=1e-14)
    np.testing.assert_allclose(tableau.DENSE, published.D, rtol=1e-14)
    np.testing.assert_allclose(tableau.ERROR_5, published.E5, rtol=1e-13, atol=1e-16)
    np.testing.assert_allclose(tableau.ERROR_3, published.E3, rtol=1e-13, atol=1e-16)
    np.testing.assert_allclose(tableau.A.sum(axis=1), tableau.C, atol=1e-14)


@pytest.mark.parametrize("stage", range(1, tableau.STAGES))
def test_stages_are_placed_by_the_table(stage):
    rng = np.random.default_rng(stage)
    start, rates, out = rng.standard_normal(8), rng.standard_normal((tableau.STAGES, 8)), np.full(8, np.nan)
    rates[stage:] = np.nan  # not known yet
    place_stage(stage, 0.3, start, rates, out, 7)
    wanted = start + 0.3 * (tableau.A[stage, :stage] @ rates[:stage])
    np.testing.assert_allclose(out[:7], wanted[:7], rtol=1e-12, atol=1e-13)


def test_nested_products_become_powers():
    rng = np.random.default_rng(0)
    for _ in range(5):
        f = rng.standard_normal(TERMS - 1)
        polys = np.zeros((2, TERMS))
        polys[1, :-1] = f
        expand_nested(polys, 1)
        for u in (0.0, 0.2, 0.5, 0.9, 1.0):
            v = 1.0 - u
            nested = f[5] + u * f[6]
            nested = u * (f[0] + v * (f[1] + u * (f[2] + v * (f[3] + u * (f[4] + v * nested)))))
            assert np.polynomial.polynomial.polyval(u, polys[1]) == pytest.approx(nested, rel=1e-12, abs=1e-13)
        assert not polys[0].any()


def test_the_error_of_a_step_falls_with_its_ninth_power(capsys):
    """Local order 9, so the error over a given time falls with the eighth."""
    steps = np.array([0.02, 0.016, 0.013, 0.01])
    errors = [np.abs(stepped(h).vectors[TRIAL, :6] - exact(h)).max() for h in steps]
    orders = observed(errors, steps)
    with capsys.disabled():
        print(f"\nstep: errors {np.array2string(np.array(errors), precision=2)}, observed orders {orders.round(2)}")
    assert errors[-1] > 1e-12
    assert np.all(np.abs(orders - 9.0) < 0.3)


def test_the_continuous_extension_is_of_order_seven(capsys):
    """Local error of the eighth power inside the step; at its ends those of the step itself."""
    steps, places = np.array([0.013, 0.01, 0.008, 0.0065]), (0.25, 0.5, 0.8)
    errors = []
    for h in steps:
        found = []
        for u in places:
            room = stepped(h)
            extend(flow(), 1.0, over(h), room)
            settle_on(u, room)
            found.append(np.abs(room.motion[:6] - exact(u * h)).max())
        errors.append(max(found))
    orders = observed(errors, steps)
    with capsys.disabled():
        print(f"\ninside: errors {np.array2string(np.array(errors), precision=2)}, observed orders {orders.round(2)}")
    assert np.all(orders > 7.0)
    assert orders[-1] == pytest.approx(8.0, abs=0.6)
    for u, wanted in ((0.0, START), (1.0, stepped(0.01).vectors[TRIAL, :6])):
        room = stepped(0.01)
        extend(flow(), 1.0, over(0.01), room)
        settle_on(u, room)
        np.testing.assert_allclose(room.motion[:6], wanted, rtol=1e-13)


def test_rows_are_polynomials_over_the_step():
    h = 0.1
    engine = prepared()
    phase = engine._phases.place(engine.model.start(1))
    system = engine._phases.system(1.0, 0.0, shaken=False)
    weights = np.random.default_rng(1).standard_normal(9)  # D, D', θ, θ', z, a, 1
    system.plain_rows[phase, 0] = weights
    room = stepped(h)
    extend(flow(), 1.0, over(h), room)
    row_poly(system, phase, 0, over(h), room)
    for u in (0.0, 0.3, 1.0):
        there = stepped(h)
        extend(flow(), 1.0, over(h), there)
        settle_on(u, there)
        value = weights[:7] @ there.motion[:7] + weights[7] * (A + SLOPE * h * u) + weights[8]
        assert np.polynomial.polynomial.polyval(u, room.polys[0]) == pytest.approx(value, rel=1e-12)


def test_steps_follow_one_another():
    """The last stage is the next step's first, and the largest sizes are kept."""
    given = flow()
    room = stepped(0.005, given)
    end, last = room.vectors[TRIAL].copy(), room.rates[tableau.LAST].copy()
    step_over(room)
    assert np.array_equal(room.motion, end[: room.motion.size])
    assert np.array_equal(room.rates[0], last)
    assert np.array_equal(room.size, np.abs(end[:7]))
    room.at.step = 0.005
    take_step(given, 1.0, over(0.005, 0.005), room)
    np.testing.assert_allclose(room.vectors[TRIAL, :6], exact(0.01), rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("tolerance", [1e-6, 1e-10])
def test_the_error_control_keeps_its_tolerance(tolerance):
    given = flow(tolerance)
    room = started()
    time, taken = 0.0, []
    while time < 0.4:
        step = take_step(given, 1.0, over(0.4 - time, time), room)
        assert 0.0 < step <= 0.4 - time
        step_over(room)
        time += step if step < 0.4 - time else 0.4 - time
        taken.append(step)
    assert len(taken) > 2
    scale = np.abs(exact(0.4)).max()
    assert np.abs(room.motion[:6] - exact(0.4)).max() < 100.0 * tolerance * scale


def test_a_motion_that_leaves_all_numbers_cannot_be_followed():
    given = flow(1e-10)
    room = started()
    room.motion[0] = np.nan
    assert take_step(given, 1.0, over(0.1), room) == FAILED
    room = room_of(np.concatenate((np.full(6, 1e200), np.zeros(EXTRA))))
    assert take_step(given, 1.0, over(0.1), room) == FAILED


@pytest.mark.parametrize("velocity", [0.5, -0.5, 0.0])
def test_the_branch_of_the_hysteresis(velocity):
    """By the velocity's sign, or where it stands still by what it will be: under a < 0 it is pushed forward."""
    model = Model(1, lifts=False).of(Frame(**FRAME).rocking(), bouc_wen=BoucWen(0.02))
    given = Engine(model, Quantities.none(1))._flow
    for a in (-2.0, 2.0):
        motion = np.zeros(4 + EXTRA)
        motion[1] = velocity
        room = room_of(motion)
        take_step(given, 0.0, Span(0.0, 0.001, a, 0.0, 0.001, 0.0, 0.0), room)
        assert room.at.branch == (np.sign(velocity) or -np.sign(a))
