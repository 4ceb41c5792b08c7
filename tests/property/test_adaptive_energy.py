"""Energy of the nonlinear models: nothing appears or vanishes but by damping, yielding, input and impact."""

from functools import partial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from builders import make_frame
from rockflex import BoucWen, Frame, GroundMotion, InitialState, Restitution, quiet_motion, simulate
from strategies import GRAVITY, frame_arguments, stretches

settings_ = settings(max_examples=40, deadline=None)

frames = frame_arguments(5, 2.0)
dampings = st.floats(0.01, 0.1)


motions = partial(stretches, factors=(0.5, 4.0), suites=["fema-p695-far-field"])


def energy_of_the_masses(frame, run):
    """½ Σ m v² + g Σ m z + strain, from the coordinates of Eq. 3 of every mass and of the base."""
    p = run.history.model.properties
    n = frame["n_stories"]
    masses = np.concatenate(([frame["base_mass"]], np.full(n, frame["story_mass"])))
    heights = np.concatenate(([0.0], frame["story_height"] * np.arange(1.0, n + 1.0)))
    shapes = np.vstack((np.zeros((1, p.n_modes)), p.floors.displacement))
    u, du = run.modal_displacement @ shapes.T, run.modal_velocity @ shapes.T
    turn, spin, offset = run.rotation[:, None], run.rotation_velocity[:, None], run.side[:, None] * p.half_width
    sin, cos = np.sin(turn), np.cos(turn)
    across = spin * (offset * sin + heights * cos - u * sin) + du * cos
    upward = spin * (offset * cos - heights * sin - u * cos) - du * sin
    rise = offset * sin - heights * 2.0 * np.sin(0.5 * turn) ** 2 - u * sin
    strain = 0.5 * run.modal_displacement**2 @ (p.effective_mass * p.omega**2)
    return 0.5 * (across**2 + upward**2) @ masses + GRAVITY * rise @ masses + strain


@settings_
@given(frames, st.floats(0.05, 0.9), st.booleans())
def test_free_and_undamped(frame, fraction, left):
    """With all modes, the energy of the masses changes at impacts alone, and falls there."""
    structure = Frame(**frame, damping_ratio=0.0)
    p = structure.rocking()
    start = (-1.0 if left else 1.0) * fraction * np.arctan(p.m_tot * p.half_width / p.l0r)
    run = simulate(structure, quiet_motion(3.0, dt=0.02), "MDOF-C", initial=InitialState(start))
    total = energy_of_the_masses(frame, run)
    ledger = run.energy
    np.testing.assert_allclose(ledger.kinetic + ledger.strain + ledger.gravity, total, atol=1e-11 * total.max())
    impact = (run.side[:-1] != 0.0) & (run.side[1:] == 0.0)
    drops = total[:-1] - total[1:]
    assert np.all(np.abs(drops[~impact]) <= 1e-9 * total[0])
    assert np.all(drops[impact] > -1e-12 * total[0])
    np.testing.assert_allclose(ledger.impact_losses, drops[impact], atol=1e-11 * total[0])
    np.testing.assert_allclose(total + ledger.lost, total[0], rtol=1e-9)
    assert not ledger.damped.any()
    assert not ledger.input.any()
    assert ledger.closing_error < 1e-9


@settings_
@given(frames, dampings, motions(), st.sampled_from(["2DOF-C", "2DOF-C-SI", "MDOF-C", "MDOF-C-E", "rigid-C"]))
def test_the_ledger_closes(frame, damping_ratio, motion, model):
    run = simulate(Frame(**frame, damping_ratio=damping_ratio), motion, model, free_vibration=0.5)
    energy = run.energy
    assert energy.closing_error < 1e-9
    assert np.all(np.diff(energy.damped) >= -1e-12 * np.abs(energy.input).max())
    assert not energy.yielded.any()


@settings_
@given(frames, motions(), st.floats(0.3, 0.95), st.sampled_from(["rigid-C", "rigid", "2DOF-S"]))
def test_the_ledger_closes_where_rocking_passes(frame, motion, e, model):
    structure = Frame(**frame, damping_ratio=0.03)
    run = simulate(structure, motion, model, impact=Restitution(e))
    rounding = 1e-15 * structure.rocking().resisting_moment  # of rotations, which are sums of ones near 0.1 rad
    assert np.abs(run.energy.residual).max() < 1e-9 * np.abs(run.energy.input).max() + rounding
    assert np.all(run.energy.impact_losses >= -1e-12 * np.abs(run.energy.input).max())


@settings(max_examples=30, deadline=None)
@given(
    frames,
    dampings,
    motions(),
    st.sampled_from(["2DOF-S", "2DOF-C", "1DOF-fixed"]),
    st.builds(BoucWen, st.floats(0.01, 0.1), st.floats(0.0, 0.3), exponent=st.sampled_from([1.0, 2.5, 8.0])),
)
def test_the_ledger_of_a_yielding_structure_closes(frame, damping_ratio, motion, model, spring):
    run = simulate(Frame(**frame, damping_ratio=damping_ratio), motion, model, bouc_wen=spring)
    assert run.energy.closing_error < 1e-7


def test_a_hysteretic_spring_takes_the_area_of_its_loops():
    frame = make_frame(n_stories=1, story_height=6.0, period=0.6, aspect_ratio=4.0)
    spring = BoucWen(0.02, 0.05)
    motion = GroundMotion(6.0 * np.sin(0.2 * np.arange(200)), 0.02).refined(40)
    run = simulate(frame, motion, "1DOF-fixed", bouc_wen=spring)
    p = frame.rocking()
    force = p.effective_mass[0] * p.omega[0] ** 2 * 0.95 * 0.02 * run.yielding
    d = run.modal_displacement[:, 0]
    area = np.concatenate(([0.0], np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(d))))
    assert area[-1] > 5.0 * np.abs(force * d).max()
    np.testing.assert_allclose(run.energy.yielded, area, atol=2e-4 * area[-1])
    np.testing.assert_allclose(run.base_shear - force, p.effective_mass[0] * p.omega[0] ** 2 * 0.05 * d, atol=1e-6)
    assert run.energy.closing_error < 1e-9


@settings(max_examples=20, deadline=None)
@given(frames, st.floats(0.1, 0.6), st.floats(0.2, 0.97))
def test_a_block_without_flexure_falls_by_its_restitution(frame, fraction, e):
    """Energies after impacts follow e²: one by one, under full trigonometry."""
    p = Frame(**frame, damping_ratio=0.0).rocking()
    start = fraction * np.arctan(p.m_tot * p.half_width / p.l0r)
    run = simulate(p, quiet_motion(6.0, dt=0.02), "rigid-C", impact=Restitution(e), initial=InitialState(start))
    k = np.flatnonzero((np.diff(run.time) == 0.0) & (run.side[:-1] == -run.side[1:]) & (run.side[1:] != 0.0))
    total = run.energy.kinetic + run.energy.gravity
    np.testing.assert_allclose(total[k + 1], e * e * total[k], rtol=1e-12)
    falls = e ** (2.0 * np.arange(k.size + 1.0)) * total[0]
    np.testing.assert_allclose(total[k], falls[:-1], rtol=1e-8)
    assert total[0] == pytest.approx(
        GRAVITY * (p.m_tot * p.half_width * np.sin(start) - p.l0r * (1.0 - np.cos(start))), rel=1e-10
    )
