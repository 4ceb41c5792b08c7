"""Batches of runs, and what the order of the states leaves unchanged."""

from dataclasses import replace

import numpy as np
import pytest

from engine.systems import GRAVITY, ball, bilinear
from engine.test_systems import uncompiled
from rockflex import InputError, SolverError
from rockflex.engine import Event, LinearPhase, Run, StateLayout, System
from rockflex.engine.batch import Batch


@pytest.fixture(scope="module", params=["compiled", "Python"])
def engine(request):
    return (Run, Batch) if request.param == "compiled" else (lambda m: (m.Run, m.Batch))(uncompiled())


def records(count: int, size: int = 300) -> list[np.ndarray]:
    rng = np.random.default_rng(3)
    return [np.convolve(rng.normal(size=size), np.ones(10) / 3.0, "same") for _ in range(count)]


def shaken() -> System:
    return bilinear(6.0, 0.05, 0.1, 0.01)


@pytest.mark.slow
@pytest.mark.parametrize(("free", "settles"), [(0, False), (100, False), (10_000, True)])
def test_a_batch_has_the_bits_of_runs_one_by_one(engine, free, settles):
    run_of, batch_of = engine
    system, (first, second) = shaken(), records(2)
    shakes, scales = [first, second, first], [1.0, 0.5, 2.0]
    batch = batch_of(system, shakes, scales, free, settles, ("yielding", "unloading", "nothing"))
    run_of(system, 0.02).follow(batch)
    for r, (a, scale) in enumerate(zip(shakes, scales, strict=True)):
        run = run_of(system, 0.02)
        run.advance(a * scale)
        rested = run.settle(free) if settles else run.coast(free)
        assert batch.outcomes[r] == (2 if rested else 0)
        assert batch.times[r] == run.time
        assert [batch.high[r].tolist(), batch.when[r].tolist()] == run.highest.tolist()
        assert batch.counts[r].tolist() == run.tally("yielding", "unloading", "nothing")
        if rested:  # the state is that which the motion approaches
            run.coast(10_000)
            assert batch.states[r] == pytest.approx(run.state, rel=1e-12, abs=1e-12)
        else:
            assert batch.states[r].tolist() == run.state.tolist()
    assert batch.counts[:, 0].min() > 0
    assert batch.place == batch.count == 3


def stack() -> tuple[System, list[System]]:
    """Two bilinear oscillators as one stack, and each by itself."""
    alone = [bilinear(frequency, 0.05, 0.1, 0.01) for frequency in (6.0, 9.0)]

    def phase(key):
        both = [each.phase(key) for each in alone]
        A, C = (np.stack([getattr(each, name) for each in both]) for name in "AC")
        return replace(both[0], A=A, C=C)

    return replace(alone[0], phase=phase, count=2), alone


def test_each_run_has_its_own_system_and_start(engine):
    run_of, batch_of = engine
    (together, alone), (a,) = stack(), records(1)
    which, free, starts = [1, 0, 1, 1], [0, 70, 10, 0], np.linspace(-0.004, 0.004, 12).reshape(4, -1)
    batch = batch_of(together, [a] * 4, free=free, start=starts, which=which)
    run_of(together, 0.02).follow(batch)
    for r, (place, start) in enumerate(zip(which, starts, strict=True)):
        run = run_of(alone[place], 0.02, start)
        run.advance(a)
        run.coast(free[r])
        assert batch.states[r].tolist() == run.state.tolist()
        assert [batch.high[r].tolist(), batch.when[r].tolist()] == run.highest.tolist()
        assert batch.times[r] == run.time


def test_a_run_that_fails_leaves_the_others_alone(engine):
    run_of, batch_of = engine
    system, (a,) = shaken(), records(1)
    alone = run_of(system, 0.02)
    alone.advance(a[:100])
    batch, run = batch_of(system, [a, a[:100], a]), run_of(system, 0.02)
    run.limit = alone.work
    failed = []
    while batch.place < batch.count:
        try:
            run.follow(batch)
        except SolverError:
            failed.append((batch.place, run.failure))
            batch.place += 1
    assert failed == [(0, "work"), (2, "work")]
    assert batch.states[1].tolist() == alone.state.tolist()


def test_a_batch_says_how_runs_have_ended(engine):
    run_of, batch_of = engine
    layout = StateLayout(height=1, speed=1)
    lands = Event("lands", np.array([1.0, 0.0]), None)
    fall = LinearPhase(
        np.array([[0.0, 1.0], [0.0, 0.0]]),
        np.array([0.0, 1.0]),
        np.array([0.0, -GRAVITY]),
        np.eye(2),
        np.zeros(2),
        np.zeros(2),
        (lands,),
    )
    system = System(layout, ("height", "speed"), lambda _: fall, "falls")
    held, free = np.full(101, GRAVITY), np.zeros(101)
    batch = batch_of(system, [held, free], names=("lands",), start=[1.0, 0.0])
    run_of(system, 0.01).follow(batch)
    assert batch.outcomes.tolist() == [0, 1]
    assert batch.counts[:, 0].tolist() == [0, 1]
    np.testing.assert_allclose(batch.times, (1.0, np.sqrt(2.0 / GRAVITY)), rtol=1e-12)
    bounces = batch_of(ball(0.3, 1e-6), [free], free=2000, settles=True, start=[1.0, 0.0])
    run_of(ball(0.3, 1e-6), 0.01).follow(bounces)
    assert bounces.outcomes.tolist() == [2]


def test_the_watch_is_asked_during_a_batch():
    class StopError(Exception):
        pass

    def stop() -> None:
        raise StopError

    system, (a,) = shaken(), records(1, 4000)
    run, batch = Run(system, 0.02), Batch(system, [a] * 1000)
    run.watch = stop
    with pytest.raises(StopError):
        run.follow(batch)
    assert batch.place < batch.count


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"scales": [1.0]}, "2 records"),
        ({"scales": [1.0, np.nan]}, "scale is nan"),
        ({"scales": [1.0, 1e308]}, r"scale is 1e\+308"),
        ({"records": [np.zeros(3), np.array([0.0, np.inf])]}, "sample 1 is inf"),
        ({"records": [np.zeros(3), np.zeros((2, 2))]}, r"\(2, 2\)"),
    ],
)
def test_bad_records_are_refused(given, words):
    with pytest.raises(InputError, match=words):
        Batch(shaken(), **{"records": [np.full(3, 20.0)] * 2, **given})


@pytest.mark.parametrize("seed", range(4))
def test_the_order_of_the_states_does_not_matter(seed):
    """Positions before their velocities have a short way through the series; mixed states have not."""
    rng = np.random.default_rng(seed)
    count = 5
    stiffness = np.diag(rng.uniform(20.0, 400.0, count)) + 5.0 * np.eye(count, k=1) + 5.0 * np.eye(count, k=-1)
    A = np.block([[np.zeros((count, count)), np.eye(count)], [-stiffness, -0.5 * np.eye(count)]])
    f, C = np.concatenate((np.zeros(count), -np.ones(count))), rng.normal(size=(3, 2 * count))
    row, a = rng.normal(size=2 * count), 3.0 * records(1, 600)[0]

    def run(order: np.ndarray) -> Run:
        def phase(key: int) -> LinearPhase:
            event = Event("turns", key * row[order], -key, 0.05)
            softer = A.copy()
            softer[count:, :count] *= 1.0 if key > 0 else 0.7
            mixed = softer[np.ix_(order, order)]
            return LinearPhase(mixed, f[order], np.zeros(2 * count), C[:, order], np.ones(3), np.zeros(3), (event,))

        found = Run(System(StateLayout(y=2 * count), ("p", "q", "r"), phase, 1), 0.01)
        found.advance(a)
        return found

    plain, mixed = run(np.arange(2 * count)), run(rng.permutation(2 * count))
    assert [e[1:] for e in mixed.events] == [e[1:] for e in plain.events]
    assert len(plain.events) > 5
    np.testing.assert_allclose([e[0] for e in mixed.events], [e[0] for e in plain.events], rtol=1e-9)
    np.testing.assert_allclose(mixed.highest, plain.highest, rtol=1e-9)


@pytest.mark.parametrize("history", [False, True])
def test_forgetting_phases_changes_no_bit(engine, history):
    """With no memory for tables at all, every phase is prepared whenever it is met."""
    run_of, batch_of = engine
    system, found = shaken(), []
    asked = dict.fromkeys([2**40, 0], 0)
    for memory in asked:

        def phase(key, memory=memory):
            asked[memory] += 1
            return system.phase(key)

        run = run_of(replace(system, phase=phase), 0.02)
        run.memory = memory
        batch = batch_of(system, records(3), None, 10_000, True, ("yielding", "unloading"))
        run.follow(batch, history=history)
        size = run.size
        run.restart()
        run.advance(records(1)[0], records(1)[0][::-1])
        ends = batch.states.tolist(), batch.high.tolist(), batch.places.tolist()
        found.append((*ends, run.events, run.state.tolist()))
        assert min(run.size, size) > 0
    assert found[0] == found[1]
    assert asked[0] > 5 * asked[2**40]
