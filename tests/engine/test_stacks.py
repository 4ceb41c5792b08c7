"""Stacks of systems, the work of a run, threads, and fast modes."""

from concurrent.futures import ThreadPoolExecutor
from itertools import product

import numpy as np
import pytest

from engine.systems import bilinear
from rockflex import InputError, SolverError
from rockflex.engine import Event, LinearPhase, Run, StateLayout, System


def stack_of(systems: list[System]) -> System:
    """The same systems in one stack."""

    def phase(key: object) -> LinearPhase:
        each = [system.phase(key) for system in systems]
        arrays = {name: np.array([getattr(one, name) for one in each]) for name in ("A", "f", "c", "C", "d", "e")}
        events = [
            Event(
                some[0].name,
                np.array([one.row for one in some]),
                some[0].target,
                np.array([one.constant for one in some]),
                scale=np.array([one.scale for one in some]),
            )
            for some in zip(*(one.events for one in each), strict=True)
        ]
        return LinearPhase(**arrays, events=tuple(events))

    first = systems[0]
    return System(first.layout, first.outputs, phase, first.start, first.one_sided, len(systems))


def shaking(seed: int, size: int = 3000) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return np.convolve(rng.normal(size=size), np.ones(10) / 3.0, "same")


def outcome(run: Run) -> tuple[object, ...]:
    return run.events, run.peaks, run.state.tolist(), run.work


SYSTEMS = [(4.0, 0.02, 0.1, 0.02), (40.0, 0.02, 0.3, 1e-3), (400.0, 0.05, 0.2, 1e-5), (2000.0, 0.02, 0.1, 4e-7)]


def test_a_system_of_a_stack_has_the_bits_that_it_has_alone():
    systems, a = [bilinear(*each) for each in SYSTEMS], shaking(1)
    stack = Run(stack_of(systems), 0.005)
    for which in (2, 0, 3, 1, 0):
        stack.restart(which=which)
        stack.advance(a)
        alone = Run(systems[which], 0.005)
        alone.advance(a)
        assert outcome(stack) == outcome(alone)
        assert len(alone.events) > 20


def test_a_number_beyond_the_stack_is_refused():
    with pytest.raises(InputError, match="4 systems"):
        Run(stack_of([bilinear(*each) for each in SYSTEMS]), 0.005, which=4)


def test_a_stack_of_the_wrong_size_is_refused():
    few = stack_of([bilinear(*each) for each in SYSTEMS])
    more = System(few.layout, few.outputs, few.phase, few.start, count=5)
    with pytest.raises(InputError, match=r"A must have the shape \(5, 3, 3\)"):
        Run(more, 0.005)


def test_threads_get_the_same_bits():
    system, records = bilinear(*SYSTEMS[1]), [shaking(seed) for seed in range(12)]

    def run(a: np.ndarray) -> tuple[object, ...]:
        solver = Run(system, 0.005)
        solver.advance(a)
        return outcome(solver)

    with ThreadPoolExecutor(8) as pool:
        assert [*pool.map(run, records)] == [run(a) for a in records]


def test_work_is_the_same_whatever_has_run_before():
    a, fresh = shaking(3), Run(bilinear(*SYSTEMS[0]), 0.005)
    fresh.advance(a)
    used = Run(bilinear(*SYSTEMS[0]), 0.005)
    used.advance(shaking(4))
    used.restart()
    used.advance(a, history=True)
    assert used.work == fresh.work > a.size
    limited = Run(bilinear(*SYSTEMS[0]), 0.005)
    limited.limit = fresh.work
    limited.advance(a)
    limited.restart()
    limited.limit = 2000
    with pytest.raises(SolverError, match="limit"):
        limited.advance(a)
    assert limited.failure == "work"
    assert 0.0 <= limited.time < 0.005 * a.size


def test_an_exception_of_the_watch_ends_a_run():
    class StopError(Exception):
        pass

    def stop() -> None:
        raise StopError

    run = Run(bilinear(*SYSTEMS[0]), 0.005)
    run.watch = stop
    with pytest.raises(StopError):
        run.advance(shaking(5))
    run.restart()
    run.watch = None
    run.advance(shaking(5))
    assert run.peaks["force"][0] > 0.0


@pytest.mark.slow
@pytest.mark.parametrize(("turns", "damping"), [*product((4.0, 30.0, 300.0), (0.0, 0.02)), (30.0, 3.0), (300.0, 3.0)])
def test_fast_modes_cost_little_and_hide_no_peak(turns, damping):
    # Coupled oscillators, one fast; the force in the spring between them is an output.
    h, fast = 0.01, turns / 0.01
    k, c = np.array([[25.0 + 0.01 * fast**2, -0.01 * fast**2], [-(fast**2), fast**2]]), 2.0 * damping * fast
    A = np.zeros((4, 4))
    A[:2, 2:] = np.eye(2)
    A[2:, :2], A[2:, 2:] = -k, -np.array([[0.2 + 0.01 * c, -0.01 * c], [-c, c]])
    f, C = np.array([0.0, 0.0, -1.0, -1.0]), np.array([[1.0, 0, 0, 0], [0, 1.0, 0, 0], [-(fast**2), fast**2, 0, 0]])
    layout = StateLayout(place=2, velocity=2)
    phase = LinearPhase(A, f, np.zeros(4), C, np.zeros(3), np.zeros(3))
    a = shaking(6, 1500)
    run = Run(System(layout, ("slow", "fast", "force"), lambda _key: phase, 0), h)
    run.advance(a)
    fine = round(16 * turns)  # samples in each sample of the record, of an own run each
    places = np.arange(0.0, a.size - 1 + 0.5 / fine, 1.0 / fine)[: 100 * fine + 1]
    near = np.interp(places, np.arange(a.size), a)
    rounding = 1e-12 + 1e-13 * fast**2 / 25.0  # the slow frequency is a small difference of stiff terms
    dense, part = Run(run.system, h / fine), Run(run.system, h)
    dense.advance(near, history=True)
    part.advance(a[:101])
    for row, name in zip(C @ dense.history[3].T, run.system.outputs, strict=True):
        assert part.peaks[name][0] >= np.abs(row).max() * (1.0 - rounding)
        assert part.peaks[name][0] == pytest.approx(np.abs(row).max(), rel=3e-3)
    assert run.counts[1] < 0.1 * a.size
