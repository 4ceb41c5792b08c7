"""Energy: nothing appears or vanishes but by the laws of damping, input and impact."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from builders import make_frame
from rockflex import Frame, InitialState, quiet_motion, simulate
from strategies import GRAVITY, frame_arguments, stretches

settings_ = settings(max_examples=60, deadline=None)

frames = frame_arguments(8, 2.5)


@pytest.mark.slow
@settings_
@given(frames, st.floats(0.02, 0.95), st.booleans(), st.data())
def test_free_and_undamped(given_, fraction, left, data):
    """Constant between impacts; each impact takes ½ θ'² (I_θ - Σ m* h*²) and none gives."""
    structure = Frame(**given_, damping_ratio=0.0)
    n = data.draw(st.integers(1, given_["n_stories"]))
    p = structure.rocking(n)
    start = (-1.0 if left else 1.0) * min(fraction * p.m_tot * p.half_width / p.l0r, 1.5)
    run = simulate(structure, quiet_motion(5.0, dt=0.02), f"{n + 1}DOF-S", initial=InitialState(start))
    lever = p.effective_mass * p.effective_height
    spin, v, d = run.rotation_velocity, run.modal_velocity, run.modal_displacement
    energy = 0.5 * p.i_theta * spin**2 + spin * (v @ lever) + 0.5 * v**2 @ p.effective_mass
    energy += 0.5 * d**2 @ (p.effective_mass * p.omega**2)
    energy += p.resisting_moment * np.abs(run.rotation) - 0.5 * p.l0r * GRAVITY * run.rotation**2
    impact = (run.side[:-1] != 0.0) & (run.side[1:] == 0.0)
    loss = 0.5 * spin[:-1] ** 2 * (p.i_theta - lever @ p.effective_height) * impact
    np.testing.assert_allclose(energy[:-1] - energy[1:], loss, rtol=0.0, atol=1e-10 * energy[0])
    assert np.all(energy[1:][impact] <= energy[:-1][impact] * (1.0 + 1e-12))
    # A loss is known to the rounding of the energies before and after.
    np.testing.assert_allclose(run.energy.impact_losses, loss[impact], rtol=1e-12, atol=1e-14 * energy[0])


@settings_
@given(frames, st.floats(0.01, 0.1), stretches(), st.sampled_from(["MDOF-S", "2DOF-S", "fixed"]))
def test_the_ledger_closes(given_, damping_ratio, motion, model):
    run = simulate(Frame(**given_, damping_ratio=damping_ratio), motion, model, free_vibration=0.5)
    assert run.energy.closing_error < 1e-9


@pytest.mark.slow
@settings_
@given(frames, st.floats(0.01, 0.1), stretches())
def test_after_the_shaking_energy_only_falls(given_, damping_ratio, motion):
    run = simulate(Frame(**given_, damping_ratio=damping_ratio), motion, free_vibration=2.0)
    energy = run.energy
    total = energy.kinetic + energy.strain + energy.gravity
    free = total[run.time >= motion.duration - 1e-9][1:]
    assert np.all(np.diff(free) <= 1e-10 * np.abs(total).max())


@pytest.mark.slow
@settings_
@given(st.floats(0.02, 0.95), st.floats(3.0, 12.0), st.just(1e-3))
@example(0.02, 3.0, 1e-4)
@example(0.2, 4.0, 1e-4)
def test_rigid_rocking_decays_by_the_law_of_impact(fraction, aspect_ratio, period):
    """Nearly rigid, peaks follow 1 - (1 - φ')² = r (1 - (1 - φ)²) with the kinetic energy kept by the impact, r."""
    structure = make_frame(n_stories=1, period=period, aspect_ratio=aspect_ratio, damping_ratio=0.9)
    p = structure.rocking()
    alpha = p.m_tot * p.half_width / p.l0r
    start = InitialState(fraction * alpha)
    run = simulate(structure, quiet_motion(1.0, dt=0.01), initial=start, output="history", work_limit=None)
    # The flexible mode takes all of the velocity over, and damps it out: nothing is left to rock with.
    kept = (run.rotation_velocity[1:] ** 2)[(run.side[:-1] != 0.0) & (run.side[1:] == 0.0)]
    assert not kept.any()
    if run.n_impacts:
        speed = np.abs(run.rotation_velocity[np.flatnonzero(np.diff(np.abs(run.side)) < 0.0)[0]])
        rate2 = p.l0r * GRAVITY / p.i_theta
        assert speed == pytest.approx(alpha * np.sqrt(rate2 * (1.0 - (1.0 - fraction) ** 2)), rel=1e-3)
