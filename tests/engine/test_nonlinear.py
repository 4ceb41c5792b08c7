"""Phases that are not linear: closed forms, SciPy, and a linear phase; compiled, and the same code as plain Python."""

import itertools

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import ellipk

from engine.test_systems import uncompiled
from rockflex import InputError, SolverError
from rockflex.engine import Event, LinearPhase, NonlinearPhase, Run, StateLayout, System
from rockflex.engine.field import Field

GRAVITY, LENGTH = 9.81, 1.7
LAYOUT = StateLayout(place=1, velocity=1)
UNIT, NOTHING = np.eye(2), np.zeros(2)


@pytest.fixture(scope="module", params=["compiled", "Python"])
def run_of(request):
    return Run if request.param == "compiled" else uncompiled().Run


def system(field, events, scale=(1e-3, 1e-3)):
    """A particle whose place and velocity are the outputs."""

    def phase(key):
        return NonlinearPhase(field, UNIT, NOTHING, NOTHING, events(key), np.array(scale), velocities={0: 1})

    return System(LAYOUT, ("place", "velocity"), phase, 1)


def pendulum():
    """A pendulum without damping; its key is the side on which it is."""

    def crossing(side):
        return (Event("crossing", np.array([side, 0.0]), -side),)

    return system(lambda y, _a, _v: np.array([y[1], -GRAVITY / LENGTH * np.sin(y[0])]), crossing)


@pytest.mark.parametrize("start", [0.01, 1.0, 3.0])
def test_a_pendulum_has_the_period_of_its_amplitude(run_of, start):
    run = run_of(pendulum(), 0.02, [start, 0.0])
    run.advance(np.zeros(401))
    quarter = ellipk(np.sin(0.5 * start) ** 2) * np.sqrt(LENGTH / GRAVITY)
    times = [t for t, _, _ in run.events]
    assert len(times) == int(0.5 * (8.0 / quarter + 1.0))
    # The error control allows 1e-10 in each step, and a pendulum near the top falls at a rate of 1/0.4 s.
    np.testing.assert_allclose(times, (2 * np.arange(len(times)) + 1) * quarter, rtol=3e-9 if start < 2.0 else 3e-8)
    assert run.peaks["place"][0] == pytest.approx(start, rel=3e-9)
    highest = 2.0 * np.sqrt(GRAVITY / LENGTH) * np.sin(0.5 * start)
    assert run.peaks["velocity"][0] == pytest.approx(highest, rel=3e-9)


class Bob(Field):
    """A pendulum that rings a bell when its bob passes a height; one says when in terms of the height itself."""

    limit = 0.3  # m

    def rates_at(self, y, a, a_v, counted=True):
        del a, a_v, counted
        return np.array([y[1], -GRAVITY / LENGTH * np.sin(y[0])])

    def sizes_at(self, y, a, a_v):
        return np.abs(self.rates_at(y, a, a_v))

    def enter_at(self, y, more):
        pass

    def conditions_at(self, y, rates, a, a_v, out):
        assert rates[0] == y[1]
        out[0] = self.side * (LENGTH * (1.0 - np.cos(y[0])) - self.limit)


def test_a_condition_that_is_not_linear_is_met_to_rounding():
    """Run as Python: the fields of a user's own are compiled classes, or functions without conditions."""
    nothing, angle = np.zeros(2), np.arccos(1.0 - Bob.limit / LENGTH)

    def phase(key):
        bob = Bob()
        bob.side = -key
        event = Event("rings", nothing, -key, scale=1.0)
        return NonlinearPhase(
            bob, UNIT, NOTHING, NOTHING, (event,), np.array([1e-3, 1e-3]), velocities={0: 1}, curved_events=(0,)
        )

    run = uncompiled().Run(System(LAYOUT, ("place", "velocity"), phase, 1), 0.02, [0.0, 2.0])
    run.advance(np.zeros(151), history=True)
    times, _, _, states, _ = run.history
    rings = np.flatnonzero(np.diff(times) == 0.0)
    assert len(rings) == len(run.events) > 3
    np.testing.assert_allclose(np.abs(states[rings, 0]), angle, rtol=1e-13)


def test_the_numbers_of_conditions_that_are_not_linear_are_checked():
    phase = NonlinearPhase(Bob(), UNIT, NOTHING, NOTHING, (), np.ones(2), curved_events=(0,))
    with pytest.raises(InputError, match="curved_events must be numbers from 0 to -1"):
        Run(System(LAYOUT, ("place", "velocity"), lambda _key: phase, 1), 0.02)


def spring(y, a, _a_v):
    """A spring that stiffens."""
    return np.array([y[1], -0.24 * y[1] - 36.0 * y[0] - 4e3 * y[0] ** 3 - a])


def walled(wall=0.05, restitution=0.8):
    """The same between the ground and a wall."""
    hit = np.diag([1.0, -restitution])
    return system(spring, lambda _key: (Event("hit", np.array([-1.0, 0.0]), 1, wall, jump=hit),), (1e-4, 1e-3))


def test_a_spring_that_hits_a_wall_moves_as_scipy_says(run_of):
    times = np.arange(301) * 0.01
    a = 3.0 * np.sin(4.0 * times)
    run = run_of(walled(), 0.01)
    run.advance(a, history=True)
    state, hits, found = np.zeros(2), [], [np.zeros(2)]

    def touches(_t, y):
        return 0.05 - y[0]

    touches.terminal, touches.direction = True, -1
    for t, until in itertools.pairwise(times):
        now = t
        while now < until:
            moved = solve_ivp(
                lambda t, y: spring(y, np.interp(t, times, a), 0.0), (now, until), state, "DOP853",
                rtol=1e-12, atol=1e-15, events=touches,
            )  # fmt: skip
            now, state = moved.t[-1], moved.y[:, -1].copy()
            if moved.status == 1:
                hits.append(now)
                state = np.array([0.05 * (1.0 - 1e-15), -0.8 * state[1]])
        found.append(state)
    assert len(hits) > 3
    np.testing.assert_allclose([t for t, _, _ in run.events], hits, rtol=1e-9)
    kept, _, _, states, _ = run.history
    at_samples = np.isin(kept, times)
    np.testing.assert_allclose(states[at_samples], np.array(found)[np.isin(times, kept)], rtol=0.0, atol=1e-9)
    # Where it turns back before it reaches the wall, the peak is inside a sample.
    assert run.peaks["place"][0] == pytest.approx(np.abs(found)[:, 0].max(), rel=1e-3)
    assert run.peaks["place"][0] >= np.abs(found)[:, 0].max()


def test_a_peak_inside_a_sample_is_found(run_of):
    """The energy says how far the spring swings from rest at a velocity."""
    run = run_of(system(lambda y, _a, _v: np.array([y[1], -(y[0] ** 3)]), lambda _key: ()), 0.3, [0.0, 1.0])
    run.advance(np.zeros(21))
    assert run.peaks["place"][0] == pytest.approx(2.0**0.25, rel=1e-9)
    assert np.abs(run_of(walled(), 0.01).peaks["place"][0]) == 0.0


def linear_and_not():
    """What lifts off a floor and lands on it, with a linear phase, and with one that is not said to be."""

    def of(*, linear):
        floor, hit = np.array([1.0, 0.0]), np.diag([0.0, 0.0])

        def phase(key):
            A, c = np.array([[0.0, 1.0], [-9.0, -0.1]]), np.array([0.0, -0.5])
            if key == "rests":
                lifts = Event("lifts", NOTHING, "flies", 0.5, 1.0)
                return LinearPhase(np.zeros((2, 2)), NOTHING, NOTHING, UNIT, NOTHING, NOTHING, (lifts,))
            lands = (Event("lands", floor, "rests", jump=hit),)
            if linear:
                return LinearPhase(A, np.array([0.0, -1.0]), c, UNIT, NOTHING, NOTHING, lands)
            field = lambda y, a, _v: A @ y + c + np.array([0.0, -a])  # noqa: E731
            return NonlinearPhase(field, UNIT, NOTHING, NOTHING, lands, np.full(2, 1e-4), velocities={0: 1})

        return System(LAYOUT, ("place", "velocity"), phase, "rests")

    return of(linear=True), of(linear=False)


def test_what_lifts_and_lands_does_so_as_in_a_linear_phase(run_of):
    """The place grows like t³ from the instant at which the force is balanced, and like t² after a sudden push."""
    times = np.arange(801) * 0.01
    for a in (1.5 * np.sin(5.0 * times), np.where((times * 2.0).astype(int) % 2 == 1, -1.0, 0.0)):
        runs = [run_of(each, 0.01) for each in linear_and_not()]
        for run in runs:
            run.advance(a)
            run.coast(100)
        linear, found = ([name for _, _, name in run.events] for run in runs)
        assert len(linear) > 10
        assert linear == found
        times_of = [[t for t, _, _ in run.events] for run in runs]
        np.testing.assert_allclose(*times_of, rtol=1e-9)
        np.testing.assert_allclose(runs[0].highest[0], runs[1].highest[0], rtol=1e-8)


def test_what_is_asked_of_a_run_does_not_change_it():
    a = 3.0 * np.sin(4.0 * np.arange(301) * 0.01)
    one, other = Run(walled(), 0.01), Run(walled(), 0.01)
    one.advance(a, history=True)
    other.advance(a)
    assert one.state.tobytes() == other.state.tobytes()
    other.restart()
    other.advance(a)
    assert one.highest.tobytes() == other.highest.tobytes()


def test_a_field_that_fails_ends_the_run(run_of):
    def fails(y, _a, _v):
        if y[0] > 0.02:
            raise RuntimeError("the material is not known")
        return np.array([1.0, 0.0])

    run = run_of(system(fails, lambda _key: ()), 0.01)
    with pytest.raises(RuntimeError, match="not known"):
        run.advance(np.zeros(11))
    run = run_of(system(lambda _y, _a, _v: np.zeros(3), lambda _key: ()), 0.01)
    with pytest.raises(InputError, match="2 rates"):
        run.advance(np.zeros(11))


@pytest.mark.slow
def test_a_motion_that_explodes_is_an_error(run_of):
    run = run_of(system(lambda y, _a, _v: np.array([y[0] ** 2, 0.0]), lambda _key: ()), 0.01, [1.0, 0.0])
    with pytest.raises(SolverError, match="short enough"):
        run.advance(np.zeros(201))


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"scale": np.zeros(2)}, "positive"),
        ({"counted": 3}, "counted"),
        ({"curved": {2: 0.0}}, "curved"),
        ({"field": 3.0}, "function"),
        ({"C": np.eye(3)}, "shape"),
    ],
)
def test_a_phase_that_is_wrong_is_refused(given, message):
    parts = {"field": spring, "C": UNIT, "d": NOTHING, "e": NOTHING, "events": (), "scale": np.ones(2), **given}
    with pytest.raises(InputError, match=message):
        Run(System(LAYOUT, ("place", "velocity"), lambda _key: NonlinearPhase(**parts), 1), 0.01)
