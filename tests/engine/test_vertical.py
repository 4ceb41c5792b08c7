"""Vertical acceleration, which acts on the states and on the conditions: against other integrations."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from engine.test_systems import uncompiled
from rockflex import InputError
from rockflex.engine import Event, LinearPhase, Rest, Run, StateLayout, System
from rockflex.engine.batch import Batch
from rockflex.engine.preparation import bounds_of
from rockflex.engine.shaken import MAX_FED, NODES, shaken_of

OMEGA, GAP, H = 7.0, 0.05, 0.02


@pytest.fixture(scope="module", params=["compiled", "Python"])
def engine(request):
    return (Run, Batch) if request.param == "compiled" else (lambda m: (m.Run, m.Batch))(uncompiled())


def shaking(seed: int, size: int = 200) -> tuple[np.ndarray, np.ndarray]:
    """An acceleration and a vertical one."""
    rng = np.random.default_rng(seed)
    first, second = (np.convolve(rng.normal(size=size), np.ones(10) / 3.0, "same") for _ in range(2))
    return 3.0 * first, 3.0 * second


def oscillator(*, omega: float = OMEGA, stiffer: float = 2.0) -> System:
    """y'' = -(k + a_v) y - 0.2 y' - a + 0.3 a_v; k is larger beyond a place that depends on a_v."""
    layout = StateLayout(place=1, speed=1)

    def phase(key: int) -> LinearPhase:
        A_v, C_v, side = np.zeros((2, 2)), np.zeros((2, 2)), 1.0 - 2.0 * key
        A_v[1, 0], C_v[1, 0] = -1.0, -1.0
        row, row_v = np.array([-side, 0.0]), np.array([0.02 * side, 0.0])
        event = Event("crosses", row, 1 - key, GAP * side, row_v=row_v, direct_v=0.01 * side)
        A = np.array([[0.0, 1.0], [-(omega**2) * stiffer**key, -0.2]])
        return LinearPhase(
            A,
            np.array([0.0, -1.0]),
            np.zeros(2),
            np.stack((layout.unit("place"), A[1])),
            np.array([0.0, -1.0]),
            np.zeros(2),
            (event,),
            A_v=A_v,
            f_v=np.array([0.0, 0.3]),
            C_v=C_v,
            d_v=np.array([0.0, 0.3]),
        )

    return System(layout, ("place", "acceleration"), phase, 0)


def integrated(a, v, h, omega=OMEGA, stiffer=2.0):
    """The same by DOP853: times of events, the last state, and peaks at forty places of a sample."""
    y, times, peaks, key = np.zeros(2), [], np.zeros(2), 0
    for i in range(a.size - 1):

        def at(t, i=i):
            u = t / h - i
            return a[i] + (a[i + 1] - a[i]) * u, v[i] + (v[i + 1] - v[i]) * u

        t = i * h
        while t < (i + 1) * h:

            def rates(t, y, at=at, key=key):
                ground, rise = at(t)
                return [y[1], -(omega**2 * stiffer**key + rise) * y[0] - 0.2 * y[1] - ground + 0.3 * rise]

            def crosses(t, y, at=at, side=1 - 2 * key):
                return side * (GAP - y[0] + at(t)[1] * (0.01 + 0.02 * y[0]))

            crosses.terminal, crosses.direction = True, -1
            found = solve_ivp(
                rates, (t, (i + 1) * h), y, "DOP853", rtol=1e-13, atol=1e-16, events=crosses, dense_output=True
            )
            fine = np.linspace(t, found.t[-1], 40)
            states = found.sol(fine).T
            fast = [rates(*each)[1] for each in zip(fine, states, strict=True)]
            peaks = np.maximum(peaks, (np.abs(states[:, 0]).max(), np.abs(fast).max()))
            t, y = found.t[-1], found.y[:, -1]
            if found.status == 1:
                times.append(t)
                key = 1 - key
    return np.array(times), y, peaks


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_a_parametric_oscillator_with_two_stiffnesses(engine, seed):
    a, v = shaking(seed)
    run = engine[0](oscillator(), H)
    run.advance(a, v)
    times, y, peaks = integrated(a, v, H)
    assert len(times) > 3
    np.testing.assert_allclose([t for t, _, _ in run.events], times, rtol=1e-9)
    np.testing.assert_allclose(run.state, y, atol=1e-10)
    assert run.peaks["place"][0] == pytest.approx(peaks[0], rel=1e-5)
    assert run.peaks["acceleration"][0] == pytest.approx(peaks[1], rel=1e-4)


def mathieu(omega: float, size: int = 1) -> System:
    """Oscillators y'' = -(ω² + a_v) y in a row, each pulled by the one before it as well."""
    layout = StateLayout(place=size, speed=size)
    A, A_v = np.zeros((2, 2 * size, 2 * size))
    A[:size, size:], A[size:, :size] = np.eye(size), -(omega**2) * np.eye(size)
    A_v[size:, :size] = -np.eye(size) + 0.5 * np.eye(size, k=-1)
    f, none = np.concatenate((np.zeros(size), -np.ones(size))), np.zeros(2 * size)
    event = Event("far", -layout.unit("place"), None, 1e30)
    phase = LinearPhase(A, f, none, np.eye(2 * size), none, none, (event,), A_v=A_v)
    return System(layout, tuple(f"y{k}" for k in range(2 * size)), lambda _key: phase, 0)


@pytest.mark.slow
@pytest.mark.parametrize("size", [1, 2, MAX_FED + 1])  # the last one is left to power series
@pytest.mark.parametrize(
    ("omega", "scale"), [(0.0, 1.0), (5.0, 1.0), (60.0, 1.0), (250.0, 1.0), (5.0, 300.0), (600.0, 1.0)]
)
def test_a_parametric_oscillator(size, omega, scale):
    a, v = shaking(5, 60)
    run = Run(mathieu(omega, size), H)
    run.advance(a, scale * v)
    y = np.zeros(2 * size)
    A = run.system.phase(0).A
    A_v = run.system.phase(0).A_v
    for i in range(a.size - 1):

        def rates(t, y, i=i):
            rise = scale * (v[i] + (v[i + 1] - v[i]) * t / H)
            return (A + rise * A_v) @ y + run.system.phase(0).f * (a[i] + (a[i + 1] - a[i]) * t / H)

        y = solve_ivp(rates, (0.0, H), y, "DOP853", rtol=1e-13, atol=1e-18).y[:, -1]
    np.testing.assert_allclose(run.state, y, atol=1e-10 * np.abs(y).max())
    marched = size <= MAX_FED and omega * H < 3.0 and scale == 1.0
    assert (run.work < 5 * a.size) == marched


def test_a_fast_mode_takes_more_nodes():
    slow, fast = (shaken_of(mathieu(omega).checked(0), H, bounds_of) for omega in (5.0, 140.0))
    assert (slow.nodes, fast.nodes) == NODES
    assert min(slow.limit[0, 0, 0], fast.limit[0, 0, 0]) > 30.0


def outcome(run: Run) -> tuple[object, ...]:
    return run.events, run.peaks, run.state.tolist(), run.work


def test_what_is_logged_and_no_vertical_acceleration_change_no_bit(engine):
    a, v = shaking(1)
    runs = [engine[0](oscillator(), H) for _ in range(5)]
    runs[0].advance(a, v)
    runs[1].advance(a, v, history=True)
    assert outcome(runs[0]) == outcome(runs[1])
    runs[2].advance(a)
    runs[3].advance(a, 0.0 * v)
    assert outcome(runs[2]) == outcome(runs[3]) != outcome(runs[0])
    times, _, accelerations, states, verticals = runs[1].history
    np.testing.assert_allclose(verticals, np.interp(times / H, np.arange(v.size), v), rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(accelerations, np.interp(times / H, np.arange(v.size), a), rtol=1e-9, atol=1e-12)
    assert states[-1].tolist() == runs[0].state.tolist()


def test_a_batch_has_the_bits_of_runs_one_by_one(engine):
    run_of, batch_of = engine
    (a, v), (b, w) = shaking(1), shaking(2)
    runs = [(a, v, 1.0), (a, None, 0.7), (b, w, 0.5), (b, v, 1.2)]
    records, verticals, scales = zip(*runs, strict=True)
    batch = batch_of(oscillator(), records, scales, free=50, verticals=verticals)
    run_of(oscillator(), H).follow(batch)
    for r, (ground, rise, scale) in enumerate(runs):
        run = run_of(oscillator(), H)
        run.advance(ground * scale, None if rise is None else rise * scale)
        run.coast(50)
        assert batch.states[r].tolist() == run.state.tolist()
        assert batch.high[r].tolist() == run.highest[0].tolist()


def test_a_system_of_a_stack_has_the_bits_that_it_has_alone():
    """Also where one of them needs more nodes."""
    systems, (a, v) = [oscillator(omega=omega) for omega in (7.0, 120.0, 3.0, 400.0)], shaking(3)

    def phase(key: int) -> LinearPhase:
        each = [system.phase(key) for system in systems]
        names = "A", "f", "c", "C", "d", "e", "A_v", "f_v", "C_v", "d_v"
        arrays = {name: np.array([getattr(one, name) for one in each]) for name in names}
        return LinearPhase(**arrays, events=each[0].events)

    first = systems[0]
    stack = Run(System(first.layout, first.outputs, phase, 0, count=len(systems)), H)
    for which in (1, 0, 2, 3, 1):
        stack.restart(which=which)
        stack.advance(a, v)
        alone = Run(systems[which], H)
        alone.advance(a, v)
        assert outcome(stack) == outcome(alone)


def lands(*, rest: Rest | None = None, jump=None) -> System:
    """A body that falls with gravity 9.81 + a_v; it bounces, or rests."""
    layout, bounce = StateLayout(height=1, speed=1), np.diag([0.0, -0.5])

    def phase(key: str) -> LinearPhase:
        flies = key == "flies"
        A = np.array([[0.0, 1.0], [0.0, 0.0]]) * flies
        event = Event("lands", np.array([1.0, 0.0]), "flies", jump=bounce if jump is None else jump, rest=rest)
        c = np.array([0.0, -9.81 * flies])
        none = np.zeros(2)
        f_v = np.array([0.0, -1.0 * flies])
        return LinearPhase(A, none, c, np.eye(2), none, none, (event,) if flies else (), f_v=f_v)

    return System(layout, ("height", "speed"), phase, "flies")


@pytest.mark.parametrize("rise", [0.0, 2.0])
def test_rest_and_jumps_know_the_vertical_acceleration(engine, rise):
    # With the speed after the jump: rests if speed (1 + 0.5 a_v) + a_v <= 4.
    rest = Rest(np.array([0.0, 1.0]), "rests", -4.0, row_v=np.array([0.0, 0.5]), direct_v=1.0)
    run = engine[0](lands(rest=rest), 0.01, [1.0, 0.0])
    run.advance(np.zeros(60), np.full(60, rise))
    speed = 0.5 * np.sqrt(2.0 * (9.81 + rise))
    assert run.events[0][0] == pytest.approx(np.sqrt(2.0 / (9.81 + rise)), rel=1e-12)
    assert (run.key == "rests") == (speed * (1.0 + 0.5 * rise) + rise <= 4.0)
    seen = []
    told = engine[0](lands(jump=lambda y, a, v: (seen.append((a, v)), (0.0 * y, "rests"))[1]), 0.01, [1.0, 0.0])
    told.advance(np.full(60, 3.0), np.full(60, rise))
    assert seen == [(3.0, rise)]


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"A_v": np.zeros((2, 3))}, ["A_v", "(2, 2)"]),
        ({"f_v": np.array([0.0, np.nan])}, ["f_v", "finite"]),
        ({"C_v": np.array([[0.0, 0.0], [np.nan, 0.0]])}, ["speed"]),
        ({"d_v": np.zeros(3)}, ["d_v", "(2,)"]),
        ({"events": (Event("lands", np.zeros(2), None, row_v=np.zeros(3)),)}, ["lands", "row_v", "(2,)"]),
        ({"events": (Event("lands", np.zeros(2), None, direct_v=np.inf),)}, ["lands", "direct_v", "finite"]),
        ({"events": (Event("lands", np.zeros(2), None, rest=Rest(np.zeros(2), None, row_v=np.ones(1))),)}, ["row_v"]),
    ],
)
def test_bad_terms_are_refused(changed, words):
    given = {name: np.zeros(2) for name in "fcde"} | {"A": np.zeros((2, 2)), "C": np.eye(2)}
    bad = LinearPhase(**{**given, **changed})
    with pytest.raises(InputError) as caught:
        Run(System(StateLayout(height=1, speed=1), ("height", "speed"), lambda _: bad, "flies"), H)
    assert all(word in str(caught.value) for word in ("'flies'", *words))


@pytest.mark.parametrize("vertical", [np.zeros(4), np.array([0.0, np.nan, 0.0]), np.zeros((3, 1))])
def test_bad_vertical_accelerations_are_refused(vertical):
    with pytest.raises(InputError):
        Run(oscillator(), H).advance(np.zeros(3), vertical)
    with pytest.raises(InputError):
        Batch(oscillator(), [np.zeros(3)], verticals=[vertical])
