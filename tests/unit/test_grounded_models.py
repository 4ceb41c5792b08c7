"""Models on springs and models that slide: what is refused, gravity in place of vertical motion, codes of branches."""

from dataclasses import replace

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from rockflex.models import parse_model
from rockflex.models._spring_model import heave_at
from rockflex.models._state_layout import branches_of_codes, codes_of_branches, n_branch_codes
from rockflex.studies._prepared_case import PreparedCase

FRAME = make_frame(n_stories=3, base_mass=120e3, stiffness_ratio=0.125, period=0.4, aspect_ratio=6.0)
P = FRAME.rocking()
B = P.half_width
SPRINGS = rf.Springs([-B, B], 3e8, 3e6)
GROUNDS = {
    "rigid": None,
    "slides": rf.Ground(friction=0.2),
    "springs": rf.Ground(springs=SPRINGS, base_inertia=60e3),
    "both": rf.Ground(friction=0.2, springs=SPRINGS, base_inertia=60e3),
}
T = 0.01 * np.arange(600)
SHAKING = 6.0 * np.sin(7.0 * T) * np.exp(-0.2 * T)


@pytest.mark.parametrize("ground", GROUNDS)
@pytest.mark.parametrize("model", ["2DOF-S", "MDOF-S"])
@pytest.mark.parametrize("upwards", [-3.0, 2.0])
def test_a_constant_vertical_acceleration_is_another_gravity(ground, model, upwards):
    """Of a base on springs, once it stands where that gravity presses it: its start is that of g."""
    tied = parse_model(model).of(P, ground=GROUNDS[ground])
    run = PreparedCase(tied).run(rf.GroundMotion(SHAKING, 0.01, vertical=np.full(T.size, upwards)))
    other = PreparedCase(replace(tied, gravity=tied.gravity + upwards)).run(rf.GroundMotion(SHAKING, 0.01))
    names = "max_rotation", "max_top_displacement", "max_base_moment", "max_slip", "max_edge_uplift", "n_uplifts"
    for name in (*names, "min_vertical_reaction", "max_horizontal_reaction"):
        assert getattr(run, name) == pytest.approx(getattr(other, name), rel=1e-9), name


@pytest.mark.parametrize("upwards", [-2.0, 2.0])
def test_a_base_held_by_friction_dampers_under_vertical_acceleration(upwards):
    held = rf.Restrained(FRAME, rf.FrictionDamper(force=1.5 * P.m_tot * 9.81))
    tied = parse_model("2DOF-S").of(held.rocking())
    motion = rf.GroundMotion(16.0 / 6.0 * SHAKING, 0.01, vertical=np.full(T.size, upwards))
    run = PreparedCase(tied, history=True).run(motion)
    other = PreparedCase(replace(tied, gravity=tied.gravity + upwards)).run(rf.GroundMotion(16.0 / 6.0 * SHAKING, 0.01))
    assert run.max_rotation == pytest.approx(other.max_rotation, rel=1e-10)
    assert run.energy.closing_error < 1e-10


def test_no_vertical_motion_changes_no_bit():
    level = rf.GroundMotion(SHAKING, 0.01)
    flat = level.with_vertical(np.zeros(T.size))
    one, other = (rf.simulate(FRAME, motion, "MDOF-S") for motion in (level, flat))
    np.testing.assert_array_equal(one.history.states, other.history.states)


def test_a_run_on_springs_settles_where_it_stood():
    run = rf.simulate(
        FRAME, rf.GroundMotion(SHAKING, 0.01), "2DOF-S", ground=GROUNDS["springs"], free_vibration="settle"
    )
    assert run.settled
    assert run.residual_rotation == pytest.approx(0.0, abs=1e-12)


def test_a_run_that_slides_settles_where_it_stops():
    run = rf.simulate(
        FRAME, rf.GroundMotion(SHAKING, 0.01), "MDOF-S", ground=GROUNDS["slides"], free_vibration="settle"
    )
    assert run.settled
    assert run.residual_slip == run.slip[-1] != 0.0


def test_a_base_tilted_by_its_eccentricity_stands():
    ground = rf.Ground(springs=rf.Springs([-B, 0.9 * B], 3e8, 3e6), base_inertia=60e3)
    run = rf.simulate(rf.Eccentric(FRAME, 0.1 * B), rf.quiet_motion(2.0), "2DOF-S", ground=ground)
    assert run.rotation[0] != 0.0
    np.testing.assert_allclose(run.rotation, run.rotation[0], rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(run.vertical_reaction, P.m_tot * 9.81, rtol=1e-12)


def test_a_rotation_at_the_start_is_carried_by_the_springs_it_presses():
    start = rf.InitialState(rotation=0.02)
    run = rf.simulate(FRAME, rf.quiet_motion(0.5), "2DOF-S", ground=GROUNDS["springs"], initial=start)
    assert run.vertical_reaction[0] == pytest.approx(P.m_tot * 9.81, rel=1e-12)
    assert run.edge_uplift[0, 0] > 0.0
    assert run.energy.closing_error < 1e-10


@pytest.mark.parametrize("rotation", [0.0, 0.001, -0.02])
def test_the_heave_under_a_weight(rotation):
    springs = rf.Springs([-1.0, -0.3, 0.2, 1.1], [3e8, 1e8, 2e8, 4e8])
    heave = heave_at(springs, rotation, 2e6)
    depth = np.maximum(springs.positions * rotation - heave, 0.0)
    assert springs.stiffness @ depth == pytest.approx(2e6, rel=1e-12)


@pytest.mark.parametrize(("base", "least"), [(8, 17), (64, 8)])
@pytest.mark.parametrize("size", [1, 7, 8, 9, 16, 17, 18, 40])
def test_codes_of_branches(size, base, least):
    chance = np.random.default_rng(size)
    branches = chance.integers(-1, base - 1, size=(5, size))
    branches[0] = base - 2  # all digits are the largest
    codes = np.array([codes_of_branches(tuple(each), base) for each in branches.tolist()])
    assert codes.shape == (5, n_branch_codes(size, base)) == (5, -(-size // least))
    np.testing.assert_array_equal(branches_of_codes(codes, size, base), branches)


def refused(text, structure=FRAME, model="2DOF-S", **ground):
    with pytest.raises(rf.InputError, match=text):
        rf.simulate(structure, rf.GroundMotion(SHAKING, 0.01), model, ground=rf.Ground(**ground))


def test_what_is_refused():
    refused(
        r"friction must be finite for all springs or infinite for all, since a base slides on all of them at once, but "
        r"\[0\.3, inf\] was given\.",
        friction=[0.3, np.inf],
        springs=SPRINGS,
        base_inertia=60e3,
    )
    light = make_frame(n_stories=3, base_mass=0.0, stiffness_ratio=0.125, period=0.4, aspect_ratio=6.0)
    refused(
        r"MDOF-S with 3 modes leaves no mass in the base that slides: Σ m\* = m_tot = 120000 kg\. Give the structure a "
        r"base_mass, or keep fewer modes\.",
        light,
        "MDOF-S",
        friction=0.2,
    )


def test_friction_beyond_reason_jams():
    """A block that slides while it rocks over the leading edge has no solution with very high friction (Painlevé)."""
    block = rf.rigid_block(slenderness=0.1, half_diagonal=3.0)
    motion = rf.GroundMotion(np.concatenate((np.full(20, -40.0), np.full(100, 900.0))), 0.01)
    with pytest.raises(rf.InputError, match=r"The base of rigid jams: with so large a friction coefficient, no "):
        rf.simulate(block, motion, "rigid", ground=rf.Ground(friction=40.0))
