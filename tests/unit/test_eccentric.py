"""Eccentric bases and tendons to one side: against integrations of the same equations, and against the mirror image."""

import dataclasses

import numpy as np
import pytest

import rockflex as rf
from builders import NO_MODES, frame_values
from twins import impact_laws, newton
from twins.complete import complete_frame, simulate_complete
from twins.complete_model import Rope

FRAME = frame_values(n_stories=4, base_mass=60e3, stiffness_ratio=0.125, period=0.6, aspect_ratio=6.0)
P = rf.Frame(**FRAME).rocking()  # B = 1.59 m
PEAKS = ("max_rotation", "max_top_displacement", "max_base_moment", "max_base_shear")
# Force at rest in N, stiffness in N/m and distance from the axis in m.
ROPES = {
    "free": (),
    "one": ((1.5e5, 2e6, -1.1),),
    "two": ((1e5, 1e6, -1.0), (3e5, 2.5e6, 0.6)),
    "stiff to one side": ((0.0, 1.2e7, -0.9),),  # to the right it no longer falls, to the left it does
    "balance to one side": ((5e4, P.l0r * 9.81 / (P.half_width + 0.4) ** 2, -0.4),),
    "pairs": ((1e5, 1e6, -0.8), (1e5, 1e6, 0.8), (3e5, 2e6, 0.0)),
}
LAWS = {
    "SI": impact_laws.SimplifiedVVEL(),
    "E": impact_laws.CompleteVVEL(),
    "passing": impact_laws.Restitution(0.5, 1e-3),
}
CASES = [
    # eccentricity, ropes, model, modes, twin's law; two without either first
    (0.0, "pairs", "MDOF-S", None, "SI"),
    (0.0, "pairs", "2DOF-C", 1, "E"),
    (0.25, "free", "MDOF-S", None, "SI"),
    (-0.4, "free", "2DOF-S", 1, "SI"),
    (0.0, "one", "MDOF-S", None, "SI"),
    (0.3, "two", "3DOF-S", 2, "SI"),
    (-0.2, "stiff to one side", "MDOF-S", None, "SI"),
    (0.0, "balance to one side", "2DOF-S", 1, "SI"),
    (0.0, "one", "3DOF-S", 2, "passing"),
    (0.25, "free", "2DOF-C", 1, "E"),
    (-0.3, "two", "3DOF-C-SI", 2, "SI"),
    (0.2, "one", "MDOF-C", None, "E"),
    (0.0, "stiff to one side", "2DOF-C-SI", 1, "SI"),
]


def shaking(dt=0.02, duration=5.0):
    """Two sines under an envelope; starts and ends away from zero."""
    t = np.arange(0.0, duration + 0.5 * dt, dt)
    return 4.5 * np.sin(np.pi * (t + 0.2) / (duration + 0.5)) * (np.sin(8.0 * t + 0.4) + 0.6 * np.sin(25.0 * t))


def made(eccentricity, ropes, **frame):
    tendons = [rf.Tendon(force, stiffness, x) for force, stiffness, x in ROPES[ropes]]
    return rf.Restrained(rf.Eccentric(rf.Frame(**FRAME | frame), eccentricity), tendons)


def twin_of(eccentricity, ropes, model, n_modes, law, duration=5.0, free=1.0):
    return simulate_complete(
        **complete_frame(**FRAME, n_modes=n_modes),
        acceleration=shaking(duration=duration),
        dt=0.02,
        eccentricity=eccentricity,
        ropes=[Rope(*each) for each in ROPES[ropes]],
        complete="-C" in model,
        law=LAWS[law],
        free=free,
    )


def options(law):
    return {"impact": rf.Restitution(0.5, 1e-3)} if law == "passing" else {}


@pytest.mark.slow
@pytest.mark.parametrize(("eccentricity", "ropes", "model", "n_modes", "law"), CASES)
def test_against_the_twin(eccentricity, ropes, model, n_modes, law):
    twin = twin_of(eccentricity, ropes, model, n_modes, law)
    motion = rf.GroundMotion(shaking(), 0.02)
    structure = made(eccentricity, ropes)
    run = rf.simulate(structure, motion, model, free_vibration=1.0, **options(law))
    peaks = rf.simulate(structure, motion, model, free_vibration=1.0, output="peaks", **options(law))
    assert twin.n_impacts >= 4
    assert {-1, 1} <= set(twin.sides)
    bound = 1e-7 if "-C" in model else 1e-8
    for response in (run, peaks):
        assert (response.n_uplifts, response.n_impacts) == (twin.n_uplifts, twin.n_impacts)
        for name in PEAKS:
            assert getattr(response, name) == pytest.approx(getattr(twin, name), rel=bound), name
    np.testing.assert_allclose(run.impact_times, twin.impact_times, atol=1e-8)
    np.testing.assert_allclose(run.uplift_times, twin.uplift_times, atol=1e-8)
    last, n = twin.states[-1], (twin.states.shape[1] - 2) // 2
    for values, columns in ((run.modal_displacement, slice(2, 2 + n)), (run.rotation[:, None], slice(0, 1))):
        scale = abs(twin.states[:, columns]).max(axis=0)
        np.testing.assert_allclose(values[-1] / scale, last[columns] / scale, atol=1e-6)
    assert run.energy.closing_error < 1e-8


@pytest.mark.slow
@pytest.mark.parametrize("label", ["rigid", "rigid-C"])
def test_a_rigid_block_keeps_the_angular_momentum_of_each_side(label):
    """Housner's impact, whose coefficient depends on the edge that the rotation leaves."""
    block = dataclasses.replace(P.truncated(0), eccentricity=0.35)
    momentum = block.translational_inertia - block.m_tot * (block.half_width**2 - 0.35**2)
    right, left = (momentum / block.pivot(-side).i_theta for side in (1, -1))
    given = complete_frame(**FRAME) | NO_MODES
    twin = simulate_complete(
        **given, acceleration=shaking(), dt=0.02, eccentricity=0.35, complete=label == "rigid-C", free=2.0,
        law=impact_laws.SidedRestitution(right, left, 1e-4),
    )  # fmt: skip
    run = rf.simulate(block, rf.GroundMotion(shaking(), 0.02), label, free_vibration=2.0)
    assert twin.n_impacts >= 4
    assert (run.n_uplifts, run.n_impacts) == (twin.n_uplifts, twin.n_impacts)
    assert run.max_rotation == pytest.approx(twin.max_rotation, rel=1e-8)
    np.testing.assert_allclose(run.impact_times, twin.impact_times, atol=1e-8)


def newton_twin(kind, eccentricity, ropes):
    """Newton's laws for the masses in coordinates of the ground, with every tendon at its place."""
    masses = newton.masses_of(**FRAME, eccentricity=eccentricity, ropes=[Rope(*each) for each in ROPES[ropes]])
    return newton.integrate(kind(masses), shaking(duration=3.0), 0.02)


@pytest.mark.slow
@pytest.mark.parametrize(("label", "kind"), [("MDOF-S", newton.Simplified), ("MDOF-C", newton.Complete)])
@pytest.mark.parametrize(("eccentricity", "ropes"), [(-0.25, "two")])
def test_against_the_masses_and_tendons_in_place(label, kind, eccentricity, ropes):
    twin = newton_twin(kind, eccentricity, ropes)
    other = twin_of(eccentricity, ropes, label, None, "SI", duration=3.0, free=0.0)
    assert (twin.n_uplifts, twin.n_impacts) == (other.n_uplifts, other.n_impacts)
    assert twin.rotation == pytest.approx(other.max_rotation, rel=1e-11)
    motion = rf.GroundMotion(shaking(duration=3.0), 0.02)
    run = rf.simulate(made(eccentricity, ropes), motion, label)
    peaks = rf.simulate(made(eccentricity, ropes), motion, label, "peaks")
    assert (run.n_uplifts, run.n_impacts) == (twin.n_uplifts, twin.n_impacts)
    assert twin.n_impacts >= 2
    np.testing.assert_allclose(run.floors.total_floor_displacement, twin.places, rtol=1e-8)
    for response in (run, peaks):
        assert response.max_rotation == pytest.approx(twin.rotation, rel=1e-8)
        assert response.max_horizontal_reaction == pytest.approx(twin.horizontal, rel=1e-7)
        assert response.min_vertical_reaction == pytest.approx(twin.vertical, rel=1e-7)


@pytest.mark.parametrize(("eccentricity", "ropes", "model", "n_modes", "law"), CASES)
def test_the_mirror_image_of_structure_and_record_moves_the_other_way(eccentricity, ropes, model, n_modes, law):
    structure = made(eccentricity, ropes)
    flipped = rf.Restrained(
        rf.Eccentric(rf.Frame(**FRAME), -eccentricity),
        [dataclasses.replace(each, position=-each.position) for each in structure.tendons],
    )
    one, other = (
        rf.simulate(each, rf.GroundMotion(sign * shaking(), 0.02), model, free_vibration=1.0, **options(law))
        for each, sign in ((structure, 1.0), (flipped, -1.0))
    )
    assert one.status == "rocking"
    assert (one.n_uplifts, one.n_impacts) == (other.n_uplifts, other.n_impacts)
    np.testing.assert_array_equal(one.side, -other.side)
    np.testing.assert_allclose(one.rotation, -other.rotation, rtol=1e-9, atol=1e-10 * one.max_rotation)
    np.testing.assert_allclose(one.base_moment, -other.base_moment, rtol=1e-9, atol=1e-10 * one.max_base_moment)
    np.testing.assert_allclose(one.vertical_reaction, other.vertical_reaction, rtol=1e-9)
    np.testing.assert_allclose(one.tendon_force, other.tendon_force, rtol=1e-10)
    assert one.max_tendon_force == pytest.approx(other.max_tendon_force, rel=1e-12)


@pytest.mark.parametrize("model", ["MDOF-S", "2DOF-C", "rigid", "fixed"])
def test_no_eccentricity_and_pairs_in_any_order_change_no_bit(model):
    pairs = [rf.Tendon(1e5, 1e6, x) for x in (-0.7, 0.7)] + [rf.Tendon(2e5, 3e6, x) for x in (0.3, -0.3)]
    motion = rf.GroundMotion(shaking(), 0.02)
    plain = rf.simulate(rf.Restrained(rf.Frame(**FRAME), pairs), motion, model)
    moved = rf.simulate(rf.Eccentric(rf.Restrained(rf.Frame(**FRAME), pairs), 0.0), motion, model)
    np.testing.assert_array_equal(plain.history.states, moved.history.states)


@pytest.mark.parametrize("model", ["MDOF-S", "2DOF-C"])
def test_a_tendon_of_nothing_to_one_side_changes_nothing_but_digits(model):
    motion = rf.GroundMotion(shaking(), 0.02)
    plain = rf.simulate(rf.Frame(**FRAME), motion, model)
    held = rf.simulate(rf.Restrained(rf.Frame(**FRAME), rf.Tendon(0.0, 0.0, 0.4)), motion, model)
    np.testing.assert_allclose(held.rotation, plain.rotation, rtol=1e-9, atol=1e-12)


def test_the_forces_of_tendons_go_by_the_side():
    structure = made(0.3, "two")
    p = structure.rocking()
    run = rf.simulate(structure, rf.GroundMotion(shaking(), 0.02), "MDOF-S")
    theta = run.rotation
    for k, tendon in enumerate(p.tendons):
        arm = np.where(theta > 0.0, p.half_width - 0.3 - tendon.position, p.half_width + 0.3 + tendon.position)
        expected = tendon.initial_force + tendon.stiffness * arm * np.abs(theta)
        np.testing.assert_allclose(run.tendon_force[:, k], expected, rtol=1e-12)
    assert run.max_tendon_force >= run.tendon_force.max()
    # The largest rotation lies between two samples.
    dense = rf.simulate(structure, rf.GroundMotion(shaking(), 0.02).refined(40), "MDOF-S")
    assert run.max_tendon_force == pytest.approx(dense.tendon_force.max(), rel=1e-6)
