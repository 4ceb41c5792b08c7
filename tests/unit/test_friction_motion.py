"""Reactions against the motion of the masses: second differences of Eq. 3's coordinates, impulses, dense records."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import simpson

from rockflex import BoucWen, Ground, GroundMotion, LumpedStructure, Restitution, load_suite, simulate
from rockflex.models._reactions import printed_reactions, reactions
from rockflex.models._values_at_states import accelerations_at_states
from rockflex.response._interpolation import quintic

GRAVITY = 9.81
EL_CENTRO = load_suite("el-centro-1940")[0]
MASSES, HEIGHTS = np.array([30e3, 25e3, 15e3]), np.array([3.0, 6.5, 9.0])
BASE, WIDTH = 20e3, 0.7
STIFFNESS = np.array([[14e6, -6e6, 0.0], [-6e6, 10e6, -4e6], [0.0, -4e6, 4e6]])
STRUCTURE = LumpedStructure(MASSES, STIFFNESS, HEIGHTS, base_mass=BASE, half_width=WIDTH, damping_ratio=0.03)
SHAKING = GroundMotion(EL_CENTRO.acceleration[80:230] * 1.6, EL_CENTRO.dt)

YIELDING = {"bouc_wen": BoucWen(0.02)}
RUNS = [
    ("fixed", {}),
    ("1DOF-fixed", YIELDING),
    ("2DOF-S", {}),
    ("3DOF-S", {}),
    ("MDOF-S", {}),
    ("2DOF-C", {}),
    ("2DOF-C-SI", {}),
    ("MDOF-C", {}),
    ("3DOF-C-E", {}),
    ("2DOF-S", YIELDING),
    ("2DOF-C", YIELDING),
    ("2DOF-C", {"impact": Restitution(0.6)}),
    ("rigid", {}),
    ("rigid-C", {}),
]
EACH = pytest.mark.parametrize(("model", "options"), RUNS, ids=lambda value: value if isinstance(value, str) else "")


def large(run):
    """Whether the model has large rotations."""
    return getattr(run.history.model, "complete", False)


def coordinates(run):
    """Σ m_i x_i and Σ m_i z_i of Eq. 3, of the ground's frame, mass by mass; for small rotations where the model is."""
    shapes = run.history.model.properties.floors
    u = np.zeros((run.time.size, 3))
    if shapes is not None:
        u = run.modal_displacement @ shapes.displacement.T
    if not large(run):
        x = (run.rotation[:, None] * HEIGHTS + u) @ MASSES
        return x, (BASE + MASSES.sum()) * WIDTH * run.side * run.rotation
    sin, cos = np.sin(run.rotation), np.cos(run.rotation)
    x, z = (BASE * WIDTH * run.side * f for f in (-cos, sin))
    for i in range(3):
        x = x + MASSES[i] * (-run.side * WIDTH * cos + HEIGHTS[i] * sin + u[:, i] * cos)
        z = z + MASSES[i] * (run.side * WIDTH * sin + HEIGHTS[i] * cos - u[:, i] * sin)
    return x, z


def stretches(run, shortest):
    """Slices of the nodes between events."""
    edges = np.concatenate(([0], np.flatnonzero(np.diff(run.time) == 0.0) + 1, [run.time.size]))
    return [slice(a, b) for a, b in pairwise(edges) if b - a >= shortest]


@EACH
def test_reactions_are_masses_times_accelerations(model, options):
    dense = SHAKING.refined(20)
    run = simulate(STRUCTURE, dense, model, **options)
    total = BASE + MASSES.sum()
    h = dense.dt
    rocked = checked = 0
    for piece in stretches(run, 12):
        # Uniform nodes only: the first and the last stand at events.
        inner = slice(piece.start + 1, piece.stop - 1)
        time = run.time[inner]
        np.testing.assert_allclose(np.diff(time), h, rtol=1e-6)
        a = run.ground_acceleration[inner][2:-2]
        for q, offset, reaction in zip(
            coordinates(run), (a, GRAVITY), (run.horizontal_reaction, run.vertical_reaction), strict=True
        ):
            q = q[inner]
            bend = (-q[4:] + 16 * q[3:-1] - 30 * q[2:-2] + 16 * q[1:-3] - q[:-4]) / (12 * h**2)
            # A ground acceleration that bends at a sample makes u''' jump, which the stencil sees.
            error = np.abs(reaction[inner][2:-2] - total * offset - bend)
            assert np.median(error) < 2e-6 * total * GRAVITY
            assert np.max(error) < 2e-2 * total * GRAVITY
        checked += time.size
        rocked += np.count_nonzero(run.side[inner])
    assert checked > 0.5 * run.time.size
    # The first yields before it rocks, and the fixed ones cannot.
    assert (rocked > 0) == ("fixed" not in model and (model, options) != ("2DOF-S", YIELDING))


@pytest.mark.parametrize("model", ["2DOF-S", "MDOF-C", "rigid-C"])
def test_vertical_impulse_is_the_momentum_gained(model):
    """From an uplift, where nothing moves upward, to the impact, where s B θ' - u_i θ' of every mass is met."""
    run = simulate(STRUCTURE, SHAKING.refined(20), model)
    p, found = run.history.model.properties, 0
    for piece in stretches(run, 40):
        if run.side[piece.start] == 0.0 or run.time[piece.stop - 1] == run.end_time:
            continue
        weight = (BASE + MASSES.sum()) * GRAVITY
        impulse = simpson(run.vertical_reaction[piece] - weight, x=run.time[piece])
        last, first = piece.stop - 1, piece.start
        momenta = [
            run.rotation_velocity[k]
            * (run.side[k] * WIDTH * (BASE + MASSES.sum()) - large(run) * run.modal_displacement[k] @ p.effective_mass)
            for k in (last, first)
        ]
        assert impulse == pytest.approx(momenta[0] - momenta[1], rel=1e-4)
        found += 1
    assert found >= 2


def largest(run, window):
    """Largest demand at the nodes that do not lie within the window after an impact, and where a window ends."""
    ends = run.impact_times + window
    time = np.append(run.time, ends[ends < run.end_time])
    demand = np.interp(time, run.time, run.friction_demand)
    demand[: run.time.size] = run.friction_demand
    counted = np.ones(time.size, dtype=bool)
    for impact in run.impact_times:
        kept = (time < impact) | (time >= impact + window)
        kept[np.searchsorted(run.time, impact)] = True  # the instant before
        counted &= kept
    return demand[counted].max()


@pytest.mark.slow
@EACH
@pytest.mark.parametrize("stride", [1, 6])
def test_peaks_between_nodes_are_those_of_a_dense_record(model, options, stride):
    """With stride 6 a step lasts up to 7 rad of the fastest mode: exact where linear, else interpolated."""
    motion = GroundMotion(SHAKING.acceleration[::stride], stride * SHAKING.dt)
    run, dense = (simulate(STRUCTURE, each, model, **options) for each in (motion, motion.refined(64 * stride)))
    linear = model.startswith(("fixed", "rigid")) or (model.endswith("-S") and not options)
    bound = 1e-9 if stride == 1 else 2e-6 if linear else 1e-3
    assert dense.n_impacts == run.n_impacts
    assert dense.required_friction == pytest.approx(dense.friction_demand.max(), rel=2e-6)
    assert run.required_friction == pytest.approx(dense.required_friction, rel=bound)
    assert run.required_friction >= run.friction_demand.max() * (1.0 - 1e-12)
    for window in (0.02, 0.05, 0.2):
        reached = run.required_friction_excluding_impacts(window)
        assert reached == pytest.approx(largest(dense, window), rel=bound + 1e-5)
        assert reached <= run.required_friction


@pytest.mark.slow
@EACH
def test_sliding_starts_where_the_demand_passes_the_coefficient(model, options):
    run, dense = (simulate(STRUCTURE, motion, model, **options) for motion in (SHAKING, SHAKING.refined(64)))
    step = dense.time[1] - dense.time[0]
    for share in (0.3, 0.6, 0.95):
        mu = share * min(dense.required_friction, 2.0)
        first = dense.time[np.argmax(dense.friction_demand > mu)]
        assert run.sliding_time(mu) == pytest.approx(first, abs=1.01 * step)
    required = run.required_friction
    if np.isfinite(required):
        assert run.sliding_time(required * (1.0 + 1e-7)) is None
        assert run.sliding_time(required * (1.0 - 1e-5)) is not None


def test_a_lone_peak_between_two_samples_is_found():
    """Fast oscillation under coarse samples: of the nodes none is near the peak."""
    stiff = LumpedStructure(MASSES, 4.0 * STIFFNESS, HEIGHTS, base_mass=BASE, half_width=50.0, damping_ratio=0.0)
    coarse = GroundMotion([0.0, 3.0, 3.0, 3.0], 0.2)
    run, dense = (simulate(stiff, motion, "1DOF-fixed") for motion in (coarse, coarse.refined(4000)))
    assert run.required_friction == pytest.approx(dense.friction_demand.max(), rel=1e-5)
    assert run.required_friction > 1.001 * run.friction_demand.max()
    # A coefficient that the peak alone exceeds, between two looks.
    assert run.sliding_time(run.required_friction * (1.0 - 1e-7)) is not None
    assert run.sliding_time(run.required_friction * (1.0 + 1e-7)) is None


def test_the_printed_reactions_of_a_base_that_slides_have_its_slip():
    """Before it rocks they are, but for the sign of the weight, those of small rotations."""
    history = simulate(STRUCTURE, SHAKING, "MDOF-S", ground=Ground(friction=0.12)).history
    found = [
        each(history.model, history.states, accelerations_at_states(history.model, history.states))
        for each in (reactions, printed_reactions)
    ]
    still = history.side == 0.0
    assert np.ptp(history.slip[still]) > 1e-3
    weight = history.model.properties.m_tot * 9.81
    np.testing.assert_allclose(found[1].horizontal[still], found[0].horizontal[still], rtol=0.0, atol=1e-10 * weight)
    np.testing.assert_allclose(found[1].vertical[still], found[0].vertical[still] - 2.0 * weight, rtol=1e-12)


def test_a_polynomial_of_fifth_degree_is_its_own_interpolant():
    polynomial = np.polynomial.Polynomial([0.3, -1.0, 2.0, 0.5, -0.7, 0.2])
    time = np.array([0.0, 0.4, 1.0])
    value, slope, bend = (polynomial.deriv(k)(time)[:, None] if k else polynomial(time)[:, None] for k in range(3))
    for place in (0.0, 0.3, 0.8, 1.0):
        inner = time[:-1] + place * np.diff(time)
        for k, found in enumerate(quintic(value, slope, bend, np.diff(time), place)):
            np.testing.assert_allclose(found[:, 0], polynomial.deriv(k)(inner) if k else polynomial(inner), rtol=1e-12)
