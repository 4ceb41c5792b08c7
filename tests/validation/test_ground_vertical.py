"""Vertical shaking of rigid ground on which nothing slides: the exact engine against power series between events."""

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from twins.ground_sliding import TURN, SlidingTwin, impacts, uplifts

FRAME = make_frame(n_stories=3, base_mass=120e3, stiffness_ratio=0.125, period=0.4, aspect_ratio=6.0)
SLENDER = make_frame(n_stories=4, stiffness_ratio=0.125, period=0.9, aspect_ratio=9.0)
BLOCK = rf.rigid_block(slenderness=0.25, half_diagonal=4.0, mass=1e5)
B = FRAME.rocking().half_width
DT = 0.01
T = DT * np.arange(801)
SHAKING = 4.5 * np.sin(np.pi * (T + 0.2) / 8.5) * (np.sin(7.0 * T + 0.4) + 0.6 * np.sin(19.0 * T))
UPWARDS = 5.0 * np.sin(np.pi * (T + 0.1) / 8.3) * (np.cos(11.0 * T) + 0.7 * np.sin(31.0 * T))


def compared(structure, model, a, vertical, *, rel=1e-8, **more):
    p = structure if isinstance(structure, rf.RockingProperties) else structure.rocking()
    if model not in ("rigid", "MDOF-S"):
        p = structure.rocking(int(model[0]) - 1)
    expected = SlidingTwin.of(p, None, **more).run(a, DT, vertical)
    run = rf.simulate(structure, rf.GroundMotion(a, DT, vertical=vertical), model)
    found = (run.max_rotation, run.max_top_displacement, run.max_base_moment, run.max_base_shear)
    assert found == pytest.approx(expected.peaks[:4], rel=rel, abs=1e-13)
    assert run.rotation[-1] == pytest.approx(expected.y[TURN], abs=10.0 * rel * run.max_rotation)
    assert run.n_impacts == len(impacts(expected))
    assert more or run.n_uplifts == len(uplifts(expected))  # a block that rocks on does not lift anew
    return run


@pytest.mark.slow
@pytest.mark.parametrize("model", ["2DOF-S", "3DOF-S", "MDOF-S"])
@pytest.mark.parametrize("structure", [FRAME, SLENDER], ids=["frame", "slender"])
def test_frames(structure, model):
    run = compared(structure, model, SHAKING, UPWARDS)
    assert run.n_uplifts > 3


def test_a_rigid_block():
    e = 1.0 - 1.5 * np.sin(0.25) ** 2
    assert compared(BLOCK, "rigid", SHAKING, UPWARDS, restitution=e, rel=1e-7).n_impacts > 3


@pytest.mark.parametrize("eccentricity", [0.2 * B, -0.3 * B])
def test_an_eccentric_base(eccentricity):
    compared(rf.Eccentric(FRAME, eccentricity), "2DOF-S", SHAKING, UPWARDS)


@pytest.mark.parametrize("gravity", [7.0, 12.5])
@pytest.mark.parametrize("model", ["2DOF-S", "MDOF-S"])
def test_a_constant_acceleration_is_another_gravity(model, gravity):
    p = FRAME.rocking(1 if model == "2DOF-S" else None)
    expected = SlidingTwin.of(p, None, gravity=gravity).run(SHAKING, DT)
    up = np.full(SHAKING.size, gravity - 9.81)
    run = rf.simulate(FRAME, rf.GroundMotion(SHAKING, DT, vertical=up), model, output="peaks")
    assert run.max_rotation == pytest.approx(expected.peaks[0], rel=1e-9)
    assert run.max_base_moment == pytest.approx(expected.peaks[2], rel=1e-9)


def test_no_vertical_acceleration_changes_no_bit():
    plain = rf.simulate(FRAME, rf.GroundMotion(SHAKING, DT), "3DOF-S")
    still = rf.simulate(FRAME, rf.GroundMotion(SHAKING, DT, vertical=0.0 * SHAKING), "3DOF-S")
    np.testing.assert_array_equal(plain.history.states, still.history.states)
