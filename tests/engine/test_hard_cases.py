"""Cases in which an engine is easily wrong: borders, plateaus, fast modes beside slow ones, and misuse."""

import math

import numpy as np
import pytest
import scipy.linalg

from engine.systems import ball
from rockflex import InputError, SolverError
from rockflex.engine import Event, LinearPhase, Rest, Run, StateLayout, System

DRIFT = np.array([[0.0, 1.0], [0.0, 0.0]])  # of a place and its speed
HEIGHT = np.array([1.0, 0.0])


def free(phases, outputs=("height",), **settings) -> System:
    """A body that drifts; `phases` gives c, e of the outputs and the events of every key."""

    def phase(key):
        c, e, events = phases[key]
        m = len(outputs)
        C = np.zeros((m, 2)) if any(e) else np.tile(HEIGHT, (m, 1))
        return LinearPhase(DRIFT, np.zeros(2), np.array(c), C, np.zeros(m), np.array(e), events)

    return System(StateLayout(height=1, speed=1), outputs, phase, next(iter(phases)), **settings)


@pytest.mark.parametrize("before", [1e-9, 5e-11, 1e-12, 1e-13, 1e-14, 0.0, -1e-14, -1e-12, -1e-9])
def test_an_impact_at_the_end_of_a_sample_happens_once(before):
    impact = Event("impact", HEIGHT, "flies", jump=np.diag([1.0, -0.5]))  # the place is as rounding leaves it
    time = 0.3 - 0.01 * before
    run = Run(free({"flies": ([0.0, 0.0], [0.0], (impact,))}), 0.01, [time, -1.0])
    run.advance(np.zeros(100))
    assert [t for t, _, _ in run.events] == pytest.approx([time], rel=1e-14)
    assert run.state == pytest.approx([0.5 * (0.99 - time), 0.5])


def test_a_short_flight_that_begins_with_next_to_nothing():
    speed = 0.02
    lands = Event("lands", HEIGHT, None)
    run = Run(free({"flies": ([0.0, -9.81], [0.0], (lands,))}), 0.01, [1e-22, speed])
    run.advance(np.zeros(5))
    assert run.time == pytest.approx(2.0 * speed / 9.81, rel=1e-13)


def test_a_restarted_run_meets_a_phase_with_many_conditions():
    many = tuple(Event(f"falls to {-j}", HEIGHT, None, float(j)) for j in range(100, 0, -1))
    phases = {"few": ([0.0, 0.0], [0.0], (Event("passes", HEIGHT, "many"),)), "many": ([0.0, 0.0], [0.0], many)}
    run, found = Run(free(phases), 0.01, [0.0317, -1.0]), []
    for _ in range(2):
        run.advance(np.zeros(150))
        found.append(run.events)
        run.restart([0.0317, -1.0])
    assert found[0] == found[1]
    assert [name for _, _, name in found[0]] == ["passes", "falls to -1"]


@pytest.mark.parametrize("one_sided", [False, True])
def test_an_output_that_rests_is_no_search_for_a_peak(one_sided):
    force = -5.0 if one_sided else 9.81
    phases = {
        "flies": ([0.0, 0.0], [force * one_sided], (Event("lands", HEIGHT, "lies"),)),
        "lies": ([0.0, 0.0], [force], (Event("leaves", np.zeros(2), None),)),
    }
    run = Run(free(phases, ("force",), one_sided=("force",) * one_sided), 0.01, [0.0317, -1.0])
    run.advance(np.zeros(10))
    assert run.peaks["force"] == (force, 0.0 if one_sided else pytest.approx(0.0317))


def chain(count: int, fast: float) -> System:
    """Equal masses in a row, the first of which is pushed; and one condition that is always at its border."""
    A, f = np.zeros((2 * count, 2 * count)), np.zeros(2 * count)
    A[:count, count:], f[count] = np.eye(count), 1.0
    A[count:, :count] = -(fast**2) * (2.0 * np.eye(count) - np.eye(count, k=1) - np.eye(count, k=-1))
    border = (Event("never", np.zeros(2 * count), None),)
    zeros = np.zeros(count)
    names = [f"mass {k}" for k in range(count)]
    return System(
        StateLayout(place=count, speed=count),
        names,
        lambda _: LinearPhase(A, f, np.zeros(2 * count), np.eye(2 * count)[:count], zeros, zeros, border),
        "all",
    )


def test_peaks_of_outputs_that_begin_with_a_high_power_of_time():
    run = Run(chain(5, 20.0), 0.01)
    run.advance(np.array([0.0, 1.0]))
    leading = [20.0 ** (2 * k) * 0.01 ** (2 * k + 2) / math.factorial(2 * k + 3) for k in range(5)]  # times t³, t⁵, ..
    assert [value for value, _ in run.peaks.values()] == pytest.approx(leading, rel=0.01)


@pytest.mark.parametrize("turns", [1.0, 50.0, 1.5e3, 1e4])
def test_an_event_beside_a_fast_mode_at_rest(turns):
    h, slow, fast = 0.01, 6.0, turns / 0.01
    A = np.zeros((4, 4))
    A[0, 1], A[1, 0], A[2, 3], A[3, 2:] = 1.0, -(slow**2), 1.0, (-(fast**2), -0.1 * fast)
    row = np.array([-1.0, 0.0, -1.0, 0.0])  # both modes
    system = System(
        StateLayout(slow=2, fast=2),
        ("sum",),
        lambda _: LinearPhase(
            A, np.zeros(4), np.zeros(4), row[None], np.zeros(1), np.zeros(1), (Event("hits", row, None, 0.9999),)
        ),
        "swings",
    )
    run = Run(system, h, [-1.0, 0.0, 0.0, 0.0])
    run.advance(np.zeros(200))
    assert run.time == pytest.approx((math.pi - math.acos(0.9999)) / slow, rel=1e-12)


def test_a_motion_without_bound_is_an_error():
    def grows(rate: float) -> Run:
        phase = LinearPhase(rate * np.eye(1), np.zeros(1), np.zeros(1), np.eye(1), np.zeros(1), np.zeros(1))
        return Run(System(StateLayout(x=1), ("x",), lambda _: phase, "all"), 0.01, [1.0])

    with pytest.raises(SolverError, match="'all' grows"):
        grows(5e3).advance(np.zeros(90))
    with pytest.raises(InputError, match=r"'all'.*grows"):
        grows(1e5)


@pytest.mark.parametrize("a", [[], [[0.0]], [0.0, np.nan], [np.inf], ["a"], [1j]])
def test_a_bad_acceleration_is_refused(a):
    with pytest.raises(InputError, match="acceleration"):
        Run(ball(0.5), 0.01).advance(a)


def test_every_array_of_numbers_will_do():
    a, states = np.sin(np.arange(40.0)).astype(np.float32), []
    fixed = a.astype(float)
    fixed.setflags(write=False)
    for given in (fixed, a, a.tolist(), np.repeat(fixed, 2)[::2], fixed.astype(">f8")):
        run = Run(chain(2, 20.0), 0.01)
        run.advance(given)
        states.append(run.state.tobytes())
    assert len(set(states)) == 1


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"state": [0.0]}, ["state", "(2,)"]),
        ({"state": [0.0, np.nan]}, ["state", "finite"]),
        ({"h": 0.0}, ["time step"]),
        ({"h": np.nan}, ["time step"]),
        ({"key": "swims"}, ["'swims'"]),
        ({"key": ["flies"]}, ["'flies'", "hashable"]),
        ({"one_sided": ("depth",)}, ["'depth'", "height"]),
        ({"outputs": ("height", "height")}, ["'height', 'height'"]),
        ({"outputs": [str(k) for k in range(5000)]}, ["'flies'", "5000"]),
        ({"events": None}, ["'flies'", "events"]),
        ({"events": ("lands",)}, ["'flies'", "'lands'"]),
        ({"events": (Event("lands", HEIGHT, None, math.nan),)}, ["'flies'", "'lands'", "constant"]),
        ({"events": (Event("lands", HEIGHT, None, scale=0.0),)}, ["'flies'", "'lands'", "scale"]),
        ({"events": (Event("lands", HEIGHT, None, rest=Rest(np.zeros(3), None)),)}, ["'flies'", "'lands'", "rest"]),
        ({"events": (Event("lands", HEIGHT, None, rest="slow"),)}, ["'lands'", "Rest"]),
        (
            {"events": (Event("lands", HEIGHT, None, jump=lambda y, a: (y, None), rest=Rest(HEIGHT, None)),)},
            ["function"],
        ),
        ({"layout": StateLayout()}, ["states"]),
        ({"layout": StateLayout(x=1001)}, ["1000", "1001"]),
        ({"returned": None}, ["'flies'", "LinearPhase"]),
    ],
)
def test_misuse_is_an_error_that_says_what_is_wrong(changed, words):
    outputs = changed.get("outputs", ("height",))
    flies = [0.0, 0.0], [0.0] * len(outputs), changed.get("events", ())

    def run() -> None:
        system = free({"flies": flies}, outputs, one_sided=changed.get("one_sided", ()))
        phase = (lambda _: None) if "returned" in changed else system.phase
        system = System(changed.get("layout", system.layout), outputs, phase, "flies", system.one_sided)
        Run(system, changed.get("h", 0.01), changed.get("state"), changed.get("key"))

    with pytest.raises(InputError) as caught:
        run()
    assert all(word in str(caught.value) for word in words)


def test_a_run_that_an_error_has_broken_off_must_be_restarted():
    def stops(*_):
        raise KeyboardInterrupt

    impact = Event("impact", HEIGHT, "flies", jump=stops)
    run = Run(free({"flies": ([0.0, 0.0], [0.0], (impact,))}), 0.01, [0.055, -1.0])
    with pytest.raises(KeyboardInterrupt):
        run.advance(np.zeros(100))
    with pytest.raises(SolverError, match="restart"):
        run.advance(np.zeros(2))
    run.restart([2.0, -1.0])
    run.advance(np.zeros(100))
    assert run.state == pytest.approx([2.0 - 0.99, -1.0])


def test_many_bounces_in_one_sample_are_not_taken_for_one():
    # Elastic bounces of a body that is pushed to a stop; |J| of the jump has a norm of 2.
    row, along, push, speed = np.full(4, -0.5), np.array([0.3, -0.3, 0.2, -0.2]), 10.0, 1e-3
    jump, A = np.eye(8), np.zeros((8, 8))
    jump[4:, 4:] -= 2.0 * np.outer(row, row)
    A[:4, 4:] = np.eye(4)
    stop = Event("stop", np.array([*row, 0.0, 0.0, 0.0, 0.0]), "pushed", jump=jump)
    c = np.array([0.0, 0.0, 0.0, 0.0, *(-push * row)])
    phase = LinearPhase(A, np.zeros(8), c, np.eye(1, 8), np.zeros(1), np.zeros(1), (stop,))
    system = System(StateLayout(place=4, speed=4), ("place",), lambda _: phase, "pushed")
    run = Run(system, 0.01, [*along, *(3.0 * along + speed * row)])
    run.advance(np.zeros(20))
    flight = 2.0 * speed / push
    assert [t for t, _, _ in run.events] == pytest.approx(flight * np.arange(1, len(run.events) + 1), rel=1e-5)
    assert len(run.events) == pytest.approx(0.19 / flight, abs=1.5)


@pytest.mark.parametrize("seed", range(3))
def test_what_is_tracked_besides_changes_no_bit(seed):
    rng = np.random.default_rng(seed)
    n = 5
    A = np.zeros((2 * n, 2 * n))
    omega = np.geomspace(3.0, 200.0, n)
    A[:n, n:], A[n:, :n], A[n:, n:] = np.eye(n), -np.diag(omega**2), -0.02 * np.diag(omega)
    f, C = np.repeat([0.0, 1.0], n), rng.normal(size=(60, 2 * n)) * np.repeat([1.0, 0.01], n)
    a = np.cumsum(rng.normal(size=500))

    def found(m: int, *, history: bool) -> tuple[object, ...]:
        zeros = np.zeros(m)
        phase = LinearPhase(A, f, np.zeros(2 * n), C[:m], zeros, zeros)
        run = Run(System(StateLayout(y=2 * n), range(m), lambda _: phase, "all"), 0.01)
        run.advance(a, history=history)
        return run.state.tobytes(), [run.peaks[k] for k in range(3)]

    few = found(3, history=False)
    for m in (20, 60):
        assert found(m, history=True) == found(m, history=False) == few


@pytest.mark.parametrize("roots", [(-1.0, -40.0), (-3.0, -2.0)])
def test_a_motion_that_creeps_to_a_border_comes_to_rest_there(roots):
    A = np.array([[0.0, 1.0], [-roots[0] * roots[1], sum(roots)]])
    zeros = np.zeros(1)

    def run(start: float) -> Run:
        phase = LinearPhase(A, np.zeros(2), np.zeros(2), HEIGHT[None], zeros, zeros, (Event("passes", HEIGHT, None),))
        return Run(System(StateLayout(x=1, v=1), ("x",), lambda _: phase, "creeps"), 0.01, [1.0, start])

    assert run(0.0).settle(10_000)
    passing = run(1.5 * min(roots))  # so fast that it passes the border first
    assert not passing.settle(10_000)
    assert passing.ended


@pytest.mark.slow
@pytest.mark.parametrize(("n", "m", "k"), [(1, 0, 0), (1, 1, 0), (9, 9, 9), (320, 0, 1000), (40, 4000, 96)])
def test_systems_of_every_size_up_to_the_limits(n, m, k):
    rng = np.random.default_rng(n + m)
    row, zeros = rng.normal(size=n), np.zeros(m)
    A = rng.normal(size=(n, n)) / (2.0 * math.sqrt(n)) - 3.0 * np.eye(n)
    events = tuple(Event(f"event {j}", (-1) ** j * row, "all", 100.0 + j) for j in range(k))
    phase = LinearPhase(A, np.ones(n), np.zeros(n), rng.normal(size=(m, n)), zeros, zeros, events)
    run = Run(System(StateLayout(y=n), range(m), lambda _: phase, "all"), 0.01)
    run.advance(np.ones(30), history=True)
    stands = -np.linalg.solve(A, np.ones(n))
    assert run.history[3][29] == pytest.approx(stands - scipy.linalg.expm(0.29 * A) @ stands, rel=1e-9, abs=1e-12)


def test_velocities_that_differ_by_rounding_do_not_open_a_contact():
    """Two masses side by side, one of which is pushed away: the others' velocities are equal but for rounding."""
    A, c = np.zeros((4, 4)), np.array([0.0, 0.0, 1.0, 0.0])
    A[:2, 2:] = np.eye(2)

    def phase(key: str) -> LinearPhase:
        meets = Event("meets", np.array([1.0, -1.0, 0.0, 0.0]), None)
        return LinearPhase(A, np.zeros(4), c, np.eye(4), np.zeros(4), np.zeros(4), (meets,))

    system = System(StateLayout(place=2, velocity=2), ("first", "second", "speed", "other"), phase, "apart")
    run = Run(system, 0.01, [0.0, 0.0, 0.3, 0.1 + 0.2])
    run.advance(np.zeros(101))
    assert run.events == []
    assert run.state[0] - run.state[1] == pytest.approx(0.5, rel=1e-12)


def test_an_output_that_does_not_change_but_by_rounding_is_no_search_for_a_peak():
    """Two equal motions, whose difference is constant; their own magnitudes would allow it to change."""
    C, twice = np.array([[1.0, -1.0, 0.0, 0.0]]), np.zeros((4, 4))
    twice[0, 2] = twice[1, 3] = 1.0
    falls = Event("passes", np.array([1.0, 0.0, 0.0, 0.0]), None)
    phase = LinearPhase(twice, np.zeros(4), np.array([0.0, 0.0, -9.81, -9.81]), C, np.zeros(1), np.ones(1), (falls,))
    system = System(StateLayout(places=2, speeds=2), ("difference",), lambda _: phase, "falls")
    run = Run(system, 0.01, [0.123, 0.123, 0.5, 0.5])
    run.advance(np.zeros(100))
    assert run.ended
    assert run.peaks["difference"][0] == 1.0
