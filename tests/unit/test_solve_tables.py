"""Propagators, forced solutions and bounds of the exact engine against scipy's exponential and dense sampling."""

from functools import cache

import numpy as np
import pytest
from rockflex.solve.exact import basis
from rockflex.solve.exact.tables import levels_of, propagate, terms_of
from rockflex.solve.layout import INTO, OUT, RIPPLE, SAG, SLOPES, SWING, VALUES, Log, motion_of
from rockflex.solve.memory import recollect
from rockflex.solve.progress import progress_at_start
from rockflex.solve.run import settled
from scipy.linalg import expm

import rockflex as rf
from builders import make_frame
from rockflex import Frame, GroundMotion, InputError, simulate
from rockflex.models import Model
from rockflex.response import asked_of
from rockflex.solve import Engine
from twins.exact import Exact
from twins.frame import frame_properties

DT = 0.02
CONTACT, ROCKING, LEFT = 0, 1, 2
SIDES = (0, 1, -1)
# Rocking modes are damped far more than ζ: at 0.3 some are overdamped, at 0.9 most.
FRAMES = {
    "one mode": (1, {"damping_ratio": 0.02}),
    "undamped": (4, {"damping_ratio": 0.0}),
    "usual": (4, {"damping_ratio": 0.03}),
    "truncated": (2, {"damping_ratio": 0.05}),
    "overdamped": (3, {"damping_ratio": 0.3}),
    "all overdamped": (4, {"damping_ratio": 0.9}),
    "stiff": (4, {"damping_ratio": 0.02, "period": 0.1}),
}
PHASES = pytest.mark.parametrize("phase", [CONTACT, ROCKING, LEFT])


def given(changes):
    frame = {
        "n_stories": 4,
        "story_height": 3.0,
        "story_mass": 40e3,
        "base_mass": 60e3,
        "stiffness_ratio": 0.125,
        "period": 0.6,
        "aspect_ratio": 9.0,
    }
    return {**frame, **changes}


@cache
def prepared(name, *, dense=False):
    n, changes = FRAMES[name]
    tied = Model(n).of(Frame(**given(changes)).rocking())
    with pytest.MonkeyPatch.context() as patch:
        if dense:
            patch.setattr(basis, "WORST_CONDITION", 0.0)
        engine = Engine(tied, asked_of(tied, floors=True))
        assert [engine._phases.place(tied.start(side)) for side in SIDES] == [CONTACT, ROCKING, LEFT]
    twin = Exact(**frame_properties(**given(changes), n_modes=n).kwargs(), dt=DT, substeps=1)
    return engine, engine._phases.system(DT, 0.0), twin


def generator(twin, n, phase):
    """The twin's matrix for the engine's state [D, D', θ, θ'] and the drive [a, a', s]."""
    order = [*range(1, n + 1), *range(n + 2, 2 * n + 2), 0, n + 1, twin.a, twin.slope, twin.side]
    return twin.generator[phase != CONTACT][np.ix_(order, order)]


def draws(size, count=12):
    return np.random.default_rng(size).standard_normal((count, size))


def bases(system, phase):
    """Return the basis and its inverse, both transposed."""
    size = system.basis.shape[2]
    return system.basis[phase, OUT, :, :size], system.basis[phase, INTO, :, :size]


def blocks_as_matrix(blocks):
    k = blocks.shape[1]
    return np.block([[np.diag(blocks[0]), np.diag(blocks[1])], [np.diag(blocks[2]), np.diag(blocks[3])]]), k


@PHASES
@pytest.mark.parametrize("name", FRAMES)
def test_a_step_is_the_exponential(name, phase):
    engine, system, twin = prepared(name)
    n = engine.model.properties.n_modes
    assert not system.propagator.size
    matrix = generator(twin, n, phase)
    for level in range(system.phases["levels"][phase] + 1):
        step = DT / 2**level
        blocks, _ = blocks_as_matrix(system.blocks[phase, level])
        out, into = bases(system, phase)
        mine = out.T @ blocks @ into.T
        expected = expm(matrix * step)[: 2 * n + 2, : 2 * n + 2]
        if phase == CONTACT:
            expected[-2:] = 0.0
            expected[:, -2:] = 0.0
            expected[-2, -2] = expected[-1, -1] = 1.0  # what is held stays as it is
        scale = np.abs(expected).max(axis=1, keepdims=True) + 1e-300
        np.testing.assert_allclose(mine / scale, expected / scale, rtol=0.0, atol=1e-10)


@PHASES
@pytest.mark.parametrize("name", FRAMES)
def test_levels_halve_until_no_mode_turns_by_more_than_a_radian(name, phase):
    engine, system, _ = prepared(name)
    fastest = engine._phases._bases[phase].fastest
    levels, terms = int(system.phases["levels"][phase]), int(system.phases["terms"][phase])
    assert (levels, terms) == (levels_of(fastest, DT), terms_of(fastest, DT))
    assert levels < system.blocks.shape[1]
    assert levels < system.bounds.shape[2]
    finest = DT / 2**levels
    assert fastest * finest <= 1.0
    assert levels == 0 or fastest * finest > 0.5
    # A series that starts at t³, as at an uplift: what follows its last term is beyond rounding.
    assert 6.0 / np.prod(np.arange(1.0, terms)) * (fastest * finest) ** (terms - 4) <= 1e-17


@PHASES
@pytest.mark.parametrize("name", FRAMES)
def test_forced_motion_under_a_linear_acceleration(name, phase):
    """The forced solution satisfies the equations of motion: its rate is the matrix times itself plus the drive."""
    engine, system, twin = prepared(name)
    n = engine.model.properties.n_modes
    matrix = generator(twin, n, phase)[: 2 * n + 2]
    moved, drive = matrix[:, : 2 * n + 2], matrix[:, 2 * n + 2 :]
    out, into = bases(system, phase)
    fastest, side = engine._phases._bases[phase].fastest, SIDES[phase]
    by_a, by_slope, by_side = system.forced[phase] @ out
    for steady, rate, push in (
        (by_a, 0.0, drive[:, 0]),
        (by_slope, by_a, drive[:, 1]),
        (by_side, 0.0, side * drive[:, 2]),
    ):
        left = (moved @ steady + push - rate) @ into
        size = fastest * np.abs(steady @ into).max() + np.abs(push @ into).max()
        assert np.abs(left).max() <= 1e-12 * size


@pytest.mark.parametrize("dense", [False, True])
@PHASES
@pytest.mark.parametrize("name", FRAMES)
def test_how_far_rows_leave_their_interpolants(name, phase, dense):
    """The chord, the chord of the slope, and the cubic through both ends; and no bound is idle."""
    engine, system, _ = prepared(name, dense=dense)
    chosen = engine._phases._bases[phase]
    assert chosen.dense == system.phases["dense"][phase] == (dense and phase != CONTACT)
    count = system.stray.shape[1]
    sag, swing, ripple = (system.bounds[phase, place, :, :, :count] for place in (SAG, SWING, RIPPLE))
    half = chosen.matrix.shape[0] // 2
    inside = np.linspace(0.0, 1.0, 65)
    chord = (1.0 - inside, inside)
    cubic = ((1.0 + 2.0 * inside) * (1.0 - inside) ** 2, inside**2 * (3.0 - 2.0 * inside))
    bulge = (inside * (1.0 - inside) ** 2, inside**2 * (inside - 1.0))
    tightest = np.inf
    for level in range(system.phases["levels"][phase] + 1):
        step = DT / 2**level
        states = np.concatenate((np.eye(2 * half), draws(2 * half)))
        path = np.stack([propagate(chosen, states, np.full(len(states), step * u)) for u in inside])
        if phase == CONTACT:
            path[..., [half - 1, 2 * half - 1]] = 0.0
        values, slopes = (path @ system.rows[phase, which, :, :count] for which in (VALUES, SLOPES))
        norms = np.hypot(states[:, :half], states[:, half:])

        def joined(weights, ends):
            return np.multiply.outer(weights[0], ends[0]) + np.multiply.outer(weights[1], ends[-1])

        for difference, bound, size in (
            (values - joined(chord, values), sag, values),
            (slopes - joined(chord, slopes), swing, slopes),
            (values - joined(cubic, values) - step * joined(bulge, slopes), ripple, values),
        ):
            worst, allowed = np.abs(difference).max(axis=0), norms @ bound[level]
            assert np.all(worst <= allowed * (1.0 + 1e-9) + 1e-12 * np.abs(size).max(axis=(0, 1)))
            tightest = min(tightest, (allowed / np.maximum(worst, 1e-300)).min())
    assert tightest < 50.0


@pytest.mark.parametrize("name", FRAMES)
def test_what_contact_can_still_bring_is_bounded(name):
    engine, system, _ = prepared(name)
    states = draws(system.basis.shape[2])
    half = states.shape[1] // 2
    states[:, [half - 1, -1]] = 0.0
    rows = system.rows[CONTACT, VALUES, :, : system.stray.shape[1]].T
    bound = np.hypot(states[:, :half], states[:, half:]) @ np.hypot(rows[:, :half], rows[:, half:]).T
    for time in np.linspace(0.0, 5.0, 300):
        moved = propagate(engine._phases._bases[CONTACT], states, np.full(len(states), time))
        assert np.all(np.abs(moved @ rows.T) <= bound * (1.0 + 1e-12))
    # What settles is what stays within the guard's limits, and within the peaks, by that bound.
    limit = engine.model.properties.resisting_moment
    for state, wide in zip(states, bound, strict=True):
        for size, most, expected in (
            (0.999 * limit / wide[0], 1.001, True),
            (1.001 * limit / wide[0], 1.001, False),
            (0.999 * limit / wide[0], 0.999, False),
        ):
            motion = motion_of(np.zeros(2 * half), system.layout, rows.shape[0], 4)
            motion.w[0] = size * state
            recollect(system, CONTACT, motion)
            peaks, tally = most * size * wide, np.zeros(4, np.int64)
            log = Log(peaks, np.zeros(wide.size), tally, np.zeros(5), np.zeros((0, 0)), wide.size - 1)
            assert settled(system, progress_at_start(CONTACT)[0], log, motion) == expected


def test_systems_are_made_once_a_step():
    engine, system, _ = prepared("usual")
    assert engine._phases.system(DT, 0.0) is system
    assert engine._phases.known_system(DT) is system
    assert engine._phases.system(0.005, 0.0) is not system


@pytest.mark.parametrize("name", FRAMES)
def test_phases_that_differ_by_constant_forces_alone_share_their_tables(name):
    """Rocking to the left is made from rocking to the right: it is what it would be of its own."""
    engine, system, _ = prepared(name)
    tied = engine.model
    other = Engine(tied, asked_of(tied, floors=True))._phases
    assert [other.place(tied.start(side)) for side in (0, -1)] == [0, 1]
    alone = other.system(DT, 0.0)
    for table in ("basis", "forced", "rows", "row_forcing", "blocks", "bounds", "plain_rows", "push", "base", "border"):
        mine, theirs = getattr(system, table)[LEFT], getattr(alone, table)[1]
        np.testing.assert_allclose(mine, theirs, rtol=1e-9, atol=1e-12 * np.abs(theirs).max())
    assert system.phases[LEFT] == alone.phases[1]


def test_a_step_in_which_rotations_overflow_is_refused():
    frame = make_frame(n_stories=1, period=0.5, aspect_ratio=9.0, damping_ratio=0.05)
    motion = GroundMotion([0.0, 5.0, 0.0], 1000.0)
    fall = float(np.sqrt(frame.rocking().l0r * 9.81 / frame.rocking().i_theta))
    with pytest.raises(InputError) as caught:
        simulate(frame, motion)
    text = str(caught.value)
    assert text.startswith("The time step of 1000 s is too long: a rocking rotation of this structure grows e-fold in ")
    longest = float(text.rpartition("at most ")[2].removesuffix(" s."))
    assert longest == pytest.approx(300.0 / fall, rel=0.05)
    simulate(frame, motion.resampled(125.0))
    # A base that never lifts has no rotation to overflow.
    assert simulate(frame, GroundMotion([0.0, 0.5, 0.0], 1000.0)).status == "no_uplift"


@pytest.mark.parametrize("omega", [1e200, 1e-200])
@pytest.mark.parametrize("model", ["2DOF-S", "fixed", "2DOF-C"])
def test_frequencies_whose_square_is_no_number(omega, model):
    properties = rf.RockingProperties([omega], [1e4], [3.0], [1.0], 2e5, 4e4, 2e4, 1.0, 0.02, 1e5)
    with pytest.raises(rf.InputError, match=r"The motion of .* with omega from 1e.200 to .* cannot be computed:"):
        rf.simulate(properties, rf.quiet_motion(1.0), model)
