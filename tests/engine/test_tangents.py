"""Derivatives of runs of small hybrid systems: closed forms, and the same pass as plain Python."""

import math

import numpy as np
import pytest

from engine.as_python import as_python
from engine.systems import GRAVITY, ball, bilinear
from rockflex.engine import Event, LinearPhase, Run, StateLayout, System
from rockflex.engine.phase_tangent import CENTRAL, Neighbours, brought_to_rest, crossing_of_event, motion_of_phase
from rockflex.engine.tangent import Trace, follow_tangents

STEP = 2e-3


@pytest.fixture(scope="module", params=["compiled", "Python"])
def engine(request):
    """The functions of the pass, compiled or run as Python."""
    if request.param == "compiled":
        return motion_of_phase, crossing_of_event, follow_tangents
    made = as_python("tangent_steps", "tangent_pass", "phase_tangent", "tangent")
    of_phase = made["phase_tangent"]
    return of_phase.motion_of_phase, of_phase.crossing_of_event, made["tangent"].follow_tangents


def derived(engine, system_of, h, record, *, start=None, vertical=None, free=False, quiet=0):
    """A run of `system_of(1.0)`, and its derivatives by the scale of the record and, unless `free`, by that factor."""
    motion_of_phase, crossing_of_event, follow_tangents = engine
    system, others = system_of(1.0), {step: system_of(math.exp(step * STEP)) for step in CENTRAL}
    run = Run(system, h, start)
    run.marks = True
    run.advance(record, vertical)
    run.coast(quiet)
    trace = Trace.of(run, record, vertical)
    places = [(np.array([k]), np.array([0])) for k in range(len(others))]
    weights = np.array([list(CENTRAL.values())]) / STEP

    def around(key):
        return (
            None
            if free
            else Neighbours([each.checked(key) for each in others.values()], places, weights, 0.0 * weights)
        )

    found = follow_tangents(
        trace,
        lambda key: motion_of_phase(system.checked(key), 0, h, around(key), free=free, upward=8),
        lambda key, event, target: crossing_of_event(system.checked(key), 0, event, target, around(key)),
        np.zeros((1 if free else 2, system.layout.size)),
        np.zeros(len(system.outputs), dtype=np.bool_),
        free=free,
    )
    return run, found, trace, around


def test_a_ball_that_bounces(engine):
    """After k bounces its speed is e^k v_0, and the next bounce comes 2 e^k v_0/g later."""
    height, e = 1.3, 0.8

    def system(factor):
        return ball(e * factor, 1e-6)

    run, found, *_ = derived(engine, system, 0.01, np.zeros(211), start=[height, 0.0])
    count, v, fall = len(run.events), math.sqrt(2.0 * GRAVITY * height), math.sqrt(2.0 * height / GRAVITY)
    now = fall + 2.0 * v / GRAVITY * sum(e**k for k in range(1, count))
    moved = 2.0 * v / GRAVITY * sum(k * e**k for k in range(1, count))
    flown, up = 2.1 - now, e**count * v
    assert run.state[0] == pytest.approx(up * flown - 0.5 * GRAVITY * flown**2, rel=1e-11)
    speed = count * up + GRAVITY * moved
    place = count * up * flown - up * moved + GRAVITY * flown * moved
    np.testing.assert_allclose(found.final[1], [place, speed], rtol=1e-9)
    assert not found.final[0].any()


def driven(factor, lift=0.0):
    """x'' + 2 ζ ω x' + ω² (1 + a_v lift) x = -a, whose ω has a factor; past a place it is pushed back."""
    layout, omega = StateLayout(displacement=1, velocity=1), 7.0 * factor
    A = np.array([[0.0, 1.0], [-(omega**2), -0.1 * omega]])
    A_v = np.array([[0.0, 0.0], [-lift * omega**2, 0.0]])
    back = np.array([[1.0, 0.0], [0.0, -0.7 * factor]])

    def phase(key):
        place = Event("stop", np.array([-1.0, 0.0]), "moves", 0.1, jump=back)
        rows = np.array([[1.0, 0.0], [-(omega**2), 0.0]])
        return LinearPhase(
            A, np.array([0.0, -1.0]), np.zeros(2), rows, np.zeros(2), np.zeros(2), (place,), A_v, None, None, None
        )

    return System(layout, ("displacement", "pull"), phase, "moves")


@pytest.mark.parametrize("lift", [0.0, 0.2])
def test_an_oscillator_with_a_stop_as_differences_of_runs(engine, lift):
    rng = np.random.default_rng(3)
    record, rise = np.cumsum(rng.normal(size=150)), np.cumsum(rng.normal(size=150)) * 0.2
    vertical = rise if lift else None
    run, found, *_ = derived(engine, lambda f: driven(f, lift), 0.02, record, vertical=vertical, quiet=40)
    assert len(run.events) > 1

    def peaks(scale, factor):
        other = Run(driven(factor, lift), 0.02)
        other.advance(scale * record, None if vertical is None else scale * rise)
        other.coast(40)
        return np.concatenate((other.highest[0], other.state))

    for k in range(2):
        ends = {step: peaks(*((math.exp(2e-5 * step), 1.0)[:: 1 if k == 0 else -1])) for step in CENTRAL}
        expected = sum(weight * ends[step] for step, weight in CENTRAL.items()) / 2e-5
        size = np.abs(expected).max()
        np.testing.assert_allclose(found.peaks[k], expected[:2], atol=1e-8 * size, rtol=1e-8)
        np.testing.assert_allclose(found.final[k], expected[2:], atol=1e-8 * size, rtol=1e-8)


def test_the_motion_without_excitation_has_the_same_derivatives(engine):
    record = 2.0 * np.sin(0.12 * np.arange(300)) ** 3
    for system in (lambda f: driven(f), lambda f: bilinear(6.0 * f, 0.03, 0.1, 0.02)):
        _, free, *_ = derived(engine, system, 0.02, record, free=True, quiet=100)
        _, found, *_ = derived(engine, system, 0.02, record, quiet=100)
        np.testing.assert_allclose(free.peaks[0], found.peaks[0], rtol=1e-10)
        np.testing.assert_allclose(free.final[0], found.final[0], rtol=1e-9, atol=1e-10 * np.abs(found.final[0]).max())


def test_a_system_at_rest_for_ever():
    """Past its limit an oscillator keeps a plastic displacement, about which it ends."""
    record = 4.0 * np.sin(0.12 * np.arange(80))

    def system(factor):
        return bilinear(6.0, 0.05, 0.2 * factor, 0.02)

    _, found, trace, around = derived(
        (motion_of_phase, crossing_of_event, follow_tangents), system, 0.02, record, quiet=100
    )
    key = trace.keys[int(trace.places[-1])]
    y, s = brought_to_rest(system(1.0).checked(key), 0, around(key), trace.states[-1], found.final)
    plastic, slope = trace.states[-1][2], found.final[1][2]
    np.testing.assert_allclose(y, [0.8 * plastic, 0.0, plastic], atol=1e-12)
    np.testing.assert_allclose(s[1], [0.8 * slope - 0.2 * plastic, 0.0, slope], rtol=1e-9, atol=1e-12)
