"""Limits that connect the models: small amplitudes, stiff structures."""

import dataclasses

import numpy as np
import pytest

from builders import make_frame
from rockflex import GroundMotion, InitialState, quiet_motion, simulate

FRAME = make_frame(n_stories=3, base_mass=60e3, stiffness_ratio=0.125, period=0.5, aspect_ratio=5.0, damping_ratio=0.03)
PROPERTIES = FRAME.rocking()
# With one mass Eq. 29 is Eq. 32, so that 2DOF-C has the impact of 2DOF-S; with more it keeps more, at any amplitude.
ONE_STORY = make_frame(
    n_stories=1,
    story_height=6.0,
    story_mass=120e3,
    base_mass=60e3,
    stiffness_ratio=0.125,
    period=0.5,
    aspect_ratio=5.0,
    damping_ratio=0.03,
)


def orders(errors, steps):
    return np.diff(np.log(errors)) / np.diff(np.log(steps))


@pytest.mark.parametrize(
    ("frame", "complete", "simple"),
    [(ONE_STORY, "2DOF-C", "2DOF-S"), (FRAME, "2DOF-C-SI", "2DOF-S"), (FRAME, "MDOF-C", "MDOF-S")],
)
def test_small_rotations_are_simplified_ones(frame, complete, simple, capsys):
    """Free vibration from θ0: what Eq. 23 leaves out is smaller than what it keeps by the order of θ0."""
    starts = 0.002 * 0.5 ** np.arange(6.0)
    quantities = {"time of impact": [], "velocity at impact": [], "displacement after": []}
    for start in starts:
        runs = []
        for model in (complete, simple):
            run = simulate(frame, quiet_motion(1.0, dt=0.005), model, initial=InitialState(start))
            impact = np.flatnonzero(run.side == 0.0)[0] - 1
            after = np.abs(run.modal_displacement[impact:, 0]).max()
            runs.append((run.impact_times[0], run.rotation_velocity[impact], after))
        for errors, one, other in zip(quantities.values(), *runs, strict=True):
            errors.append(abs(one / other - 1.0))
    for name, errors in quantities.items():
        observed = orders(errors, starts)
        with capsys.disabled():
            print(f"\n{complete} to {simple}, {name}: {errors[0]:.1e} to {errors[-1]:.1e}, orders {observed.round(3)}")
        assert observed[-1] == pytest.approx(1.0, abs=0.05)


@pytest.mark.parametrize(("flexible", "rigid"), [("2DOF-S", "rigid"), ("2DOF-C", "rigid-C"), ("MDOF-C", "rigid-C")])
def test_stiff_structures_rock_like_rigid_ones(flexible, rigid, capsys):
    """Before the first impact, from a rotation under shaking: the difference falls with 1/ω²."""
    time = 0.01 * np.arange(41)
    motion = GroundMotion(1.0 * np.sin(8.0 * time), 0.01)
    start = InitialState(0.08)
    block = simulate(FRAME, motion, rigid, initial=start)
    assert block.n_impacts == 0
    factors = 2.0 ** np.arange(3.0, 9.0)
    errors = []
    for factor in factors:
        stiff = dataclasses.replace(PROPERTIES, omega=factor * PROPERTIES.omega)
        run = simulate(stiff, motion, flexible, initial=start)
        assert run.n_impacts == 0
        errors.append(np.abs(run.rotation - block.rotation).max() / 0.08)
    observed = orders(errors, 1.0 / factors)
    with capsys.disabled():
        print(f"\n{flexible} to {rigid}: errors {errors[0]:.1e} to {errors[-1]:.1e}, orders {observed.round(3)}")
    assert np.all(np.abs(observed[1:] - 2.0) < 0.3)


def test_blocks_of_both_kinds_agree_for_small_rotations(capsys):
    """Rigid: the linearised block leaves out terms of the order of θ, relative to the weight's moment."""
    starts = 0.02 * 0.5 ** np.arange(6.0)
    errors = []
    for start in starts:
        one, other = (
            simulate(FRAME, quiet_motion(3.0, dt=0.01), model, initial=InitialState(start)).impact_times[0]
            for model in ("rigid-C", "rigid")
        )
        errors.append(abs(one / other - 1.0))
    observed = orders(errors, starts)
    with capsys.disabled():
        print(f"\nrigid-C to rigid: errors {errors[0]:.1e} to {errors[-1]:.1e}, orders {observed.round(3)}")
    assert observed[-1] == pytest.approx(2.0, abs=0.1)


def test_many_modes_of_which_one_moves_are_one():
    """A lone mass has one mode: all models of it with all modes are one."""
    frame = make_frame(n_stories=1, story_height=6.0, period=0.5, aspect_ratio=5.0, damping_ratio=0.03)
    motion = GroundMotion(4.0 * np.sin(0.2 * np.arange(150)), 0.02)
    runs = [simulate(frame, motion, m) for m in ("2DOF-C", "MDOF-C", "2DOF-C-SI", "2DOF-C-E", "MDOF-C-SI")]
    assert runs[0].n_impacts >= 2
    for run in runs[1:]:
        assert run.n_impacts == runs[0].n_impacts
        assert run.max_rotation == pytest.approx(runs[0].max_rotation, rel=1e-8)
        assert run.max_top_displacement == pytest.approx(runs[0].max_top_displacement, rel=1e-8)
