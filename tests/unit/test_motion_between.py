"""The motion between states against SciPy's exponential and integration, and one way through it against another."""

from functools import partial

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.linalg import expm

import rockflex as rf
from builders import make_frame
from rockflex.models import Model
from rockflex.models._motion_between_states import MotionBetween
from rockflex.models._rocking_model import RockingModel
from rockflex.models._state_layout import GROUND, HEADER, RISE, SIDE, TIME
from rockflex.models._values_at_states import _codes, accelerations_at_states
from twins.exact import Exact
from twins.frame import frame_properties

DT = 0.02
PLACES = [0.0, 0.05, 0.31, 0.5, 0.77, 1.0]
FRAME = {
    "n_stories": 4,
    "story_height": 3.0,
    "story_mass": 40e3,
    "base_mass": 60e3,
    "stiffness_ratio": 0.125,
    "aspect_ratio": 9.0,
}
# Rocking modes are damped far more than ζ: at 0.3 some are overdamped, at 0.9 most.
FRAMES = {
    "undamped": (4, {"damping_ratio": 0.0, "period": 0.6}),
    "usual": (4, {"damping_ratio": 0.03, "period": 0.6}),
    "overdamped": (3, {"damping_ratio": 0.9, "period": 0.6}),
    "fast": (4, {"damping_ratio": 0.02, "period": 0.001}),
}


def spring_ground(frame, **more):
    p = frame.rocking()
    stiffness = p.m_tot * 9.81 / 5 / 2e-3
    springs = rf.Springs(np.linspace(-p.half_width, p.half_width, 5), stiffness, 0.01 * stiffness)
    return rf.Ground(springs=springs, base_inertia=60e3, **more)


GROUNDS = {
    "rigid": lambda frame: None,
    "sliding": lambda frame: rf.Ground(friction=0.1),
    "springs": spring_ground,
    "sliding springs": partial(spring_ground, friction=0.2),
}


def history(ground, *, vertical):
    frame = make_frame()
    shaking = rf.load_suite("el-centro-1940")[0].scaled(1.5)
    rise = 0.4 * shaking.acceleration[300:700] if vertical else None
    motion = rf.GroundMotion(shaking.acceleration[:400], shaking.dt, vertical=rise)
    return rf.simulate(frame, motion, "MDOF-S", output="history", ground=GROUNDS[ground](frame)).history


def twin_of(name, side):
    """The model and independent rates of [D, D', θ, θ', a, a', s]."""
    n, changes = FRAMES[name]
    twin = Exact(**frame_properties(**FRAME, **changes, n_modes=n), dt=DT, substeps=1)
    order = [*range(1, n + 1), *range(n + 2, 2 * n + 2), 0, n + 1, twin.a, twin.slope, twin.side]
    matrix = twin.generator[int(side != 0)][np.ix_(order, order)]
    return Model(n).of(rf.Frame(**FRAME, **changes).rocking()), matrix


@pytest.mark.parametrize("name", FRAMES)
@pytest.mark.parametrize("side", [0, 1, -1])
def test_against_exponentials_of_independent_equations(name, side):
    n, (model, matrix) = FRAMES[name][0], twin_of(name, side)
    states = np.zeros((60, HEADER + 2 * n + 2))
    states[:, TIME] = DT * np.arange(60)
    states[-5:, TIME] -= 0.61803 * DT  # two intervals unlike all others
    states[:, SIDE] = side
    states[:, GROUND] = np.random.default_rng(n).standard_normal(60)
    states[:, HEADER:] = 0.02 * np.random.default_rng(side + 1).standard_normal((60, 2 * n + 2))
    if side == 0:
        states[:, -2:] = 0.0
    steps = np.diff(states[:, TIME])
    start = np.column_stack((states[:-1, HEADER:], states[:-1, GROUND], np.diff(states[:, GROUND]) / steps))
    start = np.column_stack((start, np.full(59, side)))
    bound = max(1e-10, np.finfo(float).eps * np.linalg.norm(matrix * DT, 2))
    for place, found in zip(PLACES, MotionBetween(model).intervals(states).along(PLACES), strict=True):
        expected = np.stack([expm(matrix * step * place) @ z for z, step in zip(start, steps, strict=True)])
        scale = np.abs(expected[:, : 2 * n + 2]).max(axis=0) + 1e-30
        assert (np.abs(found - expected[:, : 2 * n + 2]) / scale).max() < bound


@pytest.mark.parametrize("vertical", [False, True])
@pytest.mark.parametrize("ground", GROUNDS)
def test_intervals_end_with_the_next_state(ground, vertical):
    """That is how the engine, which this does not use, has found it."""
    known = history(ground, vertical=vertical)
    states = known.states
    lasting = np.diff(states[:, TIME]) > 0.0
    found = MotionBetween(known.model).intervals(states).at(1.0)
    core = known.model.layout.core
    size = np.abs(states[:, HEADER : HEADER + core]).max(axis=0) + 1e-9
    off = np.abs(found - states[1:, HEADER:])[lasting, :core] / size
    assert off.max() < 1e-9
    assert np.median(off) < 1e-14


@pytest.mark.parametrize("ground", GROUNDS)
def test_vertical_motion_against_integration(ground):
    known = history(ground, vertical=True)
    model, states, n = known.model, known.states, known.model.layout.modes
    layout, lasting = model.layout, np.flatnonzero(np.diff(states[:, TIME]) > 0.0)
    inside = MotionBetween(model).intervals(states).at(0.7)
    base = layout.rotation + 2 * np.arange(layout.freedoms)
    for k in lasting[:: lasting.size // 5]:
        before, step = states[k : k + 1], states[k + 1, TIME] - states[k, TIME]

        def rate(t, y, before=before, step=step, after=states[k + 1]):
            row = before.copy()
            row[0, [GROUND, RISE]] += t / step * (after - before[0])[[GROUND, RISE]]
            row[0, HEADER : HEADER + layout.core] = y
            found, moved = np.zeros(layout.core), accelerations_at_states(model, row)[0]
            found[:n], found[n : 2 * n] = y[n : 2 * n], moved[:n]
            found[base], found[base + 1] = y[base + 1], moved[n:]
            return found

        start = before[0, HEADER : HEADER + layout.core]
        if before[0, SIDE] == 0.0 and layout.heave < 0 and not start[layout.rotation + 1 :].any():
            continue
        with np.errstate(all="ignore"):
            expected = solve_ivp(rate, (0.0, 0.7 * step), start, "DOP853", rtol=1e-12, atol=1e-15).y[:, -1]
        scale = np.abs(states[:, HEADER : HEADER + layout.core]).max(axis=0) + 1e-9
        assert (np.abs(inside[k, : layout.core] - expected) / scale).max() < 1e-9


@pytest.mark.parametrize("vertical", [False, True])
@pytest.mark.parametrize("ground", ["rigid", "sliding"])
def test_places_one_after_the_other(ground, vertical):
    known = history(ground, vertical=vertical)
    states, intervals = known.states, MotionBetween(known.model).intervals(known.states)
    assert any(part.shaking is not None for part in intervals.parts) == vertical
    whole, steps = np.arange(states.shape[0] - 1), np.diff(states[:, TIME])
    size = np.abs(states[:, HEADER:]).max(axis=0) + 1e-12
    for place, found in zip(PLACES, intervals.along(PLACES), strict=True):
        assert np.abs((found - intervals.after(whole, place * steps)) / size).max() < 1e-11
        assert np.abs((found - intervals.at(place)) / size).max() < 1e-11


def test_between_the_two_sides_of_an_event_nothing_moves():
    model = Model(2).of(make_frame().rocking())
    states = np.full((2, HEADER + 6), 0.01)
    states[:, :HEADER] = [[3.0, 0.0, 1.0, 0.0], [3.0, 0.0, 0.0, 0.0]]  # a jump of the acceleration
    states[:, -2:] = 0.0
    assert np.array_equal(MotionBetween(model).intervals(states).at(0.5)[0], states[0, HEADER:])


@pytest.mark.parametrize("name", FRAMES)
def test_the_fastest_of_all_phases(name):
    """In full contact or rocking; complete models have those of small rotations."""
    size, (model, contact), (_, rocking) = 2 * FRAMES[name][0] + 2, twin_of(name, 0), twin_of(name, 1)
    expected = max(np.abs(np.linalg.eigvals(each[:size, :size])).max() for each in (contact, rocking))
    assert MotionBetween(model).fastest == pytest.approx(expected, rel=1e-9)
    complete = RockingModel(model.label, model.properties, complete=True)
    assert MotionBetween(complete).fastest == pytest.approx(expected, rel=1e-9)


@given(st.integers(1, 60), st.integers(1, 70), st.integers(0, 2**32 - 1))
def test_codes_tell_rows_apart(rows, columns, seed):
    branches = np.random.default_rng(seed).integers(-2, 5, (rows, columns))
    branches[rows // 2] = branches[0]
    _, expected = np.unique(branches, axis=0, return_inverse=True)
    _, found = np.unique(_codes(branches), return_inverse=True)
    assert np.array_equal(found, expected.ravel())
    assert _codes(np.zeros((0, 3), dtype=np.int64)).size == 0
