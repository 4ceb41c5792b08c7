"""Bases that slide on rigid ground: the exact engine against power series between events."""

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame, random_shaking
from twins.ground_sliding import SLIP, TURN, SlidingTwin, impacts, uplifts

FRAME = make_frame(n_stories=3, base_mass=120e3, stiffness_ratio=0.125, period=0.4, aspect_ratio=6.0)
SLENDER = make_frame(n_stories=4, stiffness_ratio=0.125, period=0.9, aspect_ratio=9.0)
BLOCK = rf.rigid_block(slenderness=0.25, half_diagonal=4.0, mass=1e5)
B = FRAME.rocking().half_width
DT = 0.01


def shaking(seed, strength, seconds=8.0):
    return random_shaking(seed, strength, seconds, DT)


def compared(structure, model, friction, a, vertical=None, *, rel=1e-8, free=0.0, restitution=0.0, impact=None):
    """The run, and the twin's, after a look whether both are the same."""
    p = structure if isinstance(structure, rf.RockingProperties) else structure.rocking()
    if model not in ("rigid", "MDOF-S"):
        p = structure.rocking(int(model[0]) - 1)
    twin = SlidingTwin.of(p, friction, restitution=restitution)
    expected = twin.run(a, DT, vertical, free)
    motion, ground = rf.GroundMotion(a, DT, vertical=vertical), rf.Ground(friction=friction)
    run = rf.simulate(structure, motion, model, ground=ground, free_vibration=free, impact=impact)
    found = (run.max_rotation, run.max_top_displacement, run.max_base_moment, run.max_base_shear, run.max_slip)
    assert found == pytest.approx(expected.peaks, rel=rel, abs=1e-13)
    assert run.residual_slip == pytest.approx(expected.y[SLIP], rel=rel, abs=rel * run.max_slip)
    assert run.rotation[-1] == pytest.approx(expected.y[TURN], abs=10.0 * rel * max(run.max_rotation, 1e-9))
    assert run.n_impacts == len(impacts(expected))
    assert restitution or run.n_uplifts == len(uplifts(expected))  # a block that rocks on does not lift anew
    parts = twin.energies(expected)
    size = max(abs(parts["input"]), parts["modes"], parts["friction"])
    assert abs(parts["error"]) < 1e-10 * size
    assert run.energy.closing_error < 1e-10
    assert run.energy.input[-1] == pytest.approx(parts["input"], abs=100.0 * rel * size)
    assert run.energy.lost[-1] == pytest.approx(parts["impacts"], abs=100.0 * rel * size)
    return run, expected


def test_infinite_friction_changes_no_bit():
    motion = rf.GroundMotion(shaking(1, 9.0), DT)
    plain = rf.simulate(FRAME, motion, "MDOF-S")
    held = rf.simulate(FRAME, motion, "MDOF-S", ground=rf.Ground(friction=np.inf))
    for name in ("rotation", "top_displacement", "base_moment", "base_shear"):
        np.testing.assert_array_equal(getattr(plain, name), getattr(held, name))
    assert (held.max_slip, held.residual_slip) == (0.0, 0.0)


def phases(track):
    return {key[:2] for _, before, _, after in track.events for key in (before, after)}


@pytest.mark.slow
@pytest.mark.parametrize("model", ["2DOF-S", "3DOF-S", "MDOF-S"])
@pytest.mark.parametrize("friction", [0.1, 0.165, 0.22])
def test_frames(model, friction):
    run, _ = compared(FRAME, model, friction, shaking(1, 9.0))
    assert run.max_slip > 1e-3


def test_all_nine_phases():
    """Rocking to either side, sticking or sliding to either side, and contact likewise."""
    _, twin = compared(FRAME, "2DOF-S", 0.17, shaking(2, 14.0, 16.0))
    assert phases(twin) == {(side, slip) for side in (0, 1, -1) for slip in (0, 1, -1)}


def test_a_base_that_slides_in_free_vibration():
    run, _ = compared(SLENDER, "MDOF-S", 0.08, shaking(3, 7.0, 3.0), free=4.0)
    assert run.slip[-1] == run.residual_slip


@pytest.mark.parametrize("e", [0.6, 0.93])
def test_a_rigid_block_with_a_restitution(e):
    """The block slides on through its impacts."""
    law = rf.Restitution(e)
    run, _ = compared(BLOCK, "rigid", 0.3, shaking(4, 12.0), restitution=e, impact=law, rel=1e-7)
    assert run.n_impacts > 3


def test_a_rigid_block_with_housners_restitution():
    e = 1.0 - 1.5 * np.sin(0.25) ** 2
    run, _ = compared(BLOCK, "rigid", 0.27, shaking(5, 9.0), restitution=e, rel=1e-7)
    assert run.n_impacts > 3


@pytest.mark.parametrize("eccentricity", [0.2 * B, -0.3 * B])
def test_an_eccentric_base(eccentricity):
    run, _ = compared(rf.Eccentric(FRAME, eccentricity), "2DOF-S", 0.16, shaking(6, 9.0))
    assert run.max_slip > 1e-3


@pytest.mark.parametrize("model", ["2DOF-S", "MDOF-S"])
def test_vertical_shaking(model):
    """Weight and grip change with the vertical acceleration."""
    compared(FRAME, model, 0.17, shaking(7, 9.0), shaking(8, 8.0))


def test_a_ground_that_falls_away():
    """Below -g nothing presses the base down: it slides without friction."""
    vertical = 5.0 * shaking(9, 9.0, 4.0)
    assert vertical.min() < -9.81
    _, twin = compared(FRAME, "2DOF-S", 0.4, shaking(10, 5.0, 4.0), vertical, rel=1e-7)
    assert any(not key[2] for _, key, *_ in twin.events)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(8))
def test_random_frames(seed):
    chance = np.random.default_rng(400 + seed)
    structure = (FRAME, SLENDER)[seed % 2]
    p = structure.rocking()
    friction = chance.uniform(0.7, 1.6) * p.m_tot * p.half_width / p.l0r
    a = shaking(500 + seed, chance.uniform(4.0, 12.0))
    vertical = None if seed % 4 < 2 else shaking(600 + seed, 5.0)
    compared(structure, ("2DOF-S", "3DOF-S", "MDOF-S")[seed % 3], friction, a, vertical, rel=1e-7)
