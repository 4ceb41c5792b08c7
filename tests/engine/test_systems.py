"""Hybrid systems with closed forms, through the compiled engine and through the same code run as plain Python."""

import math
import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from engine import loops_twin
from engine.as_python import as_python
from engine.systems import GRAVITY, ball, bilinear, blocks
from rockflex import InputError, SolverError
from rockflex.engine import Event, LinearPhase, Run, StateLayout, System


def uncompiled() -> SimpleNamespace:
    """The modules of a run as Python, with the loops in NumPy."""
    made = as_python("batch", "rest", "field", "flow", "series", "run", instead={"loops": loops_twin})
    return SimpleNamespace(Run=made["run"].Run, Batch=made["batch"].Batch)


@pytest.fixture(scope="module", params=["compiled", "Python"])
def run_of(request):
    return Run if request.param == "compiled" else uncompiled().Run


@pytest.mark.parametrize("restitution", [0.0, 0.3, 0.9])
def test_a_ball_bounces_until_it_rests(run_of, restitution):
    height, slow = 1.3, 1e-6
    run = run_of(ball(restitution, slow), 0.01, [height, 0.0])
    run.advance(np.zeros(2001))
    speed, times = math.sqrt(2.0 * GRAVITY * height), [math.sqrt(2.0 * height / GRAVITY)]
    while restitution * speed > slow:
        speed *= restitution
        times.append(times[-1] + 2.0 * speed / GRAVITY)
    assert run.key == "rests"
    np.testing.assert_allclose([t for t, _, _ in run.events], times, rtol=1e-12)
    assert run.peaks["speed"][0] == pytest.approx(math.sqrt(2.0 * GRAVITY * height), rel=1e-13)
    assert run.peaks["height"] == (height, 0.0)


def test_bounces_without_end_are_an_error(run_of):
    run = run_of(ball(0.3), 0.01, [1.0, 0.0])
    with pytest.raises(SolverError, match="bounce"):
        run.advance(np.zeros(2001))


def test_a_bilinear_oscillator_in_an_earthquake(run_of):
    rng = np.random.default_rng(1)
    a, dt = 0.5 * np.cumsum(rng.normal(size=200)), 0.02
    a -= np.linspace(a[0], a[-1], a.size)
    omega, zeta, ratio, limit = 6.0, 0.03, 0.1, 0.02
    run = run_of(bilinear(omega, zeta, ratio, limit), dt)
    run.advance(a)

    y, key, times, peak = np.zeros(3), 0, [], 0.0
    for i in range(a.size - 1):
        t = i * dt
        while t < (i + 1) * dt:

            def rates(at, y, key=key, i=i):
                ground = a[i] + (a[i + 1] - a[i]) * (at / dt - i)
                pull = omega**2 * (y[0] - (1.0 - ratio) * y[2])
                return [y[1], -ground - 2.0 * zeta * omega * y[1] - pull, y[1] * abs(key)]

            ends = (
                [lambda _, y, key=key: key * y[1]]
                if key
                else [lambda _, y, s=s: limit - s * (y[0] - y[2]) for s in (1, -1)]
            )
            for end in ends:
                end.terminal, end.direction = True, -1
            found = solve_ivp(rates, (t, (i + 1) * dt), y, "DOP853", rtol=1e-12, atol=1e-15, events=ends)
            t, y = found.t[-1], found.y[:, -1]
            peak = max(peak, np.abs(found.y[0]).max())
            if found.status == 1:
                times.append(t)
                key = 0 if key else (1, -1)[int(found.t_events[1].size > 0)]
    assert len(times) > 4
    np.testing.assert_allclose([t for t, _, _ in run.events], times, atol=1e-8)
    np.testing.assert_allclose(run.state, y, atol=1e-10)
    assert run.peaks["displacement"][0] == pytest.approx(peak, rel=1e-9)


def test_two_blocks_in_a_row(run_of):
    gap, size, e, (m1, m2), speed = 0.5, 0.2, 0.4, (0.3, 0.2), 2.5
    run = run_of(blocks(gap, size, e, (m1, m2)), 0.01, [0.0, gap + size, speed, 0.0])
    run.advance(np.zeros(401), history=True)
    before = math.sqrt(speed**2 - 2.0 * m1 * GRAVITY * gap)
    meets = (speed - before) / (m1 * GRAVITY)
    first, second = 0.5 * (1.0 - e) * before, 0.5 * (1.0 + e) * before
    stops = meets + first / (m1 * GRAVITY), meets + second / (m2 * GRAVITY)
    assert [name for _, _, name in run.events] == ["impact", "stop", "stop"]
    np.testing.assert_allclose([t for t, _, _ in run.events], (meets, *stops), rtol=1e-12)
    ends = gap + first**2 / (2.0 * m1 * GRAVITY), gap + size + second**2 / (2.0 * m2 * GRAVITY)
    np.testing.assert_allclose(run.state, (*ends, 0.0, 0.0), rtol=1e-12, atol=1e-14)
    times, places, _, states, _ = run.history
    keys = [run.keys[place] for place in places]
    at = np.flatnonzero(times == times[keys.index((True, True))])  # the impact: its state before and after
    np.testing.assert_allclose(states[at, 2:], [(before, 0.0), (first, second)], rtol=1e-12, atol=1e-14)


@pytest.mark.slow
def test_an_oscillator_comes_to_rest(run_of):
    run = run_of(bilinear(6.0, 0.05, 0.1, 0.02), 0.01, [0.0, 0.3, 0.0])
    assert run.settle()
    longer = run_of(bilinear(6.0, 0.05, 0.1, 0.02), 0.01, [0.0, 0.3, 0.0])
    longer.advance(np.zeros(20_001))
    assert [(key, name) for _, key, name in longer.events] == [(key, name) for _, key, name in run.events]
    np.testing.assert_allclose([t for t, _, _ in longer.events], [t for t, _, _ in run.events], rtol=1e-12)
    np.testing.assert_allclose([*longer.peaks.values()], [*run.peaks.values()], rtol=1e-12)
    undamped = run_of(bilinear(6.0, 0.0, 0.1, 0.02), 0.01, [0.0, 0.3, 0.0])
    assert undamped.settle(2000)  # it swings for ever, as far as it has been, and does not yield any more
    assert undamped.events


def test_what_is_logged_changes_no_bit():
    rng = np.random.default_rng(2)
    a = np.cumsum(rng.normal(size=2000)) * 0.1

    def result(*, history: bool) -> tuple[object, ...]:
        run = Run(bilinear(9.0, 0.02, 0.1, 0.01), 0.01)
        run.advance(a, history=history)
        return run.state.tobytes(), run.peaks, run.events

    assert result(history=False) == result(history=True) == result(history=False)


@pytest.mark.slow
@pytest.mark.parametrize("level", ["baseline", "v3", "v4"])
def test_levels_of_vector_instructions_agree(level):
    script = (
        "import numpy as np, sys; from engine.systems import bilinear; from rockflex.engine import Run\n"
        "run = Run(bilinear(9.0, 0.02, 0.1, 0.01), 0.01)\n"
        "run.advance(np.cumsum(np.random.default_rng(2).normal(size=2000)) * 0.1)\n"
        "print(len(run.events), run.peaks['displacement'][0])"
    )

    def found(asked: str) -> subprocess.CompletedProcess[str]:
        folders = os.pathsep.join([str(Path(__file__).parents[1]), os.environ.get("PYTHONPATH", "")])
        env = {**os.environ, "ROCKFLEX_SIMD": asked, "PYTHONPATH": folders}
        return subprocess.run([sys.executable, "-c", script], env=env, capture_output=True, text=True, check=False)

    result = found(level)
    if "ROCKFLEX_SIMD" in result.stderr:
        pytest.skip(f"this processor has not {level}")
    events, peak = result.stdout.split()
    others, best = found("").stdout.split()
    assert int(events) == int(others)
    assert float(peak) == pytest.approx(float(best), rel=1e-10)


def phase_of(**changed) -> LinearPhase:
    given = {name: np.zeros(2) for name in "fcde"} | {"A": np.zeros((2, 2)), "C": np.eye(2)}
    return LinearPhase(**{**given, **changed})


@pytest.mark.parametrize(
    ("bad", "words"),
    [
        (phase_of(A=np.zeros((2, 3))), ["'flies'", "A", "(2, 2)", "(2, 3)"]),
        (phase_of(f=np.array([0.0, np.nan])), ["'flies'", "f"]),
        (phase_of(C=np.array([[1.0, 0.0], [np.inf, 0.0]])), ["'flies'", "speed"]),
        (phase_of(events=(Event("lands", np.zeros(3), None),)), ["'flies'", "lands", "(3,)"]),
        (phase_of(events=(Event("lands", np.zeros(2), None, jump=np.eye(3)),)), ["'flies'", "lands", "(3, 3)"]),
    ],
)
def test_a_bad_phase_is_refused(bad, words):
    system = System(StateLayout(height=1, speed=1), ("height", "speed"), lambda _: bad, "flies")
    with pytest.raises(InputError) as caught:
        Run(system, 0.01)
    assert all(word in str(caught.value) for word in words)


def test_a_jump_of_the_wrong_length_is_refused():
    system = ball(0.5)

    def phase(key: str) -> LinearPhase:
        given = system.phase(key)
        event = Event("bounce", given.events[0].row, "flies", jump=lambda state, _: (state[:1], "flies"))
        return LinearPhase(given.A, given.f, given.c, given.C, given.d, given.e, (event,))

    run = Run(System(system.layout, system.outputs, phase, "flies"), 0.01, [0.01, 0.0])
    with pytest.raises(InputError, match="bounce"):
        run.advance(np.zeros(100))


def test_a_linear_phase_that_a_run_holds_serves_others_of_the_system():
    """As those for another time step; once no run holds it, it is asked for again."""
    asked = list[object]()

    def phase(key):
        asked.append(key)
        return LinearPhase(-np.eye(1), np.ones(1), np.zeros(1), np.eye(1), np.zeros(1), np.zeros(1))

    system = System(StateLayout(place=1), ("place",), phase, "only")
    runs = [Run(system, h) for h in (0.01, 0.02, 0.02)]
    assert asked == ["only"]
    for run in runs:
        run.advance(np.ones(3))
    assert runs[0].state[0] < runs[1].state[0] == runs[2].state[0]
    del run, runs
    Run(system, 0.01)
    assert asked == 2 * ["only"]
