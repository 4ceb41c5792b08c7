"""Friction dampers under complete models, against an independent integration, Newton's laws and closed forms."""

from dataclasses import replace

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from twins.grounded_complete import Phase, Slider, Twin

FRAME = make_frame(n_stories=3, base_mass=120e3, stiffness_ratio=0.125, period=0.4, aspect_ratio=6.0)
P = FRAME.rocking()
B, WEIGHT, DT = P.half_width, P.m_tot * 9.81, 0.01
TIME = DT * np.arange(250)
SHAKING = 9.0 * np.sin(6.0 * TIME) * np.exp(-0.2 * TIME) * np.minimum(1.0, TIME / 0.3)
UPWARDS = 3.0 * np.sin(11.0 * TIME)
CASES = {
    # model: modes of the twin, forces over the weight, positions over the half width, vertical motion
    "MDOF-C, two dampers": ("MDOF-C", None, (0.3, 0.2), (0.8, -0.9), None),
    "MDOF-C, shaken": ("MDOF-C", None, (0.5,), (0.25,), UPWARDS),
    "3DOF-C-SI, beyond the shorter side": ("3DOF-C-SI", 2, (0.2, 0.3), (1.05, -0.5), UPWARDS),
    "2DOF-C-SI, strong": ("2DOF-C-SI", 1, (1.6,), (0.0,), None),
}


def damped(forces, places, structure=FRAME):
    return rf.Restrained(structure, [rf.FrictionDamper(f * WEIGHT, x * B) for f, x in zip(forces, places, strict=True)])


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_against_the_twin(name):
    model, modes, forces, places, vertical = CASES[name]
    structure = rf.Eccentric(FRAME, 0.1 * B) if max(places) > 1.0 else FRAME
    twin = Twin(structure.rocking(modes))
    twin.sliders = [Slider(f * WEIGHT, x * B) for f, x in zip(forces, places, strict=True)]
    twin.run(SHAKING, DT, vertical)
    motion = rf.GroundMotion(SHAKING, DT, vertical=vertical)
    run = rf.simulate(damped(forces, places, structure), motion, model)
    assert run.max_rotation == pytest.approx(twin.peaks[0], rel=1e-8)
    assert np.abs(run.history.modal_displacement[:, 0]).max() <= twin.peaks[1] * (1.0 + 1e-7)
    assert (run.n_uplifts, run.n_impacts) == (twin.counts["uplift"], twin.counts["impact"])
    assert sum(kind == "release" for _, kind in twin.track) >= 3  # it was held at a rotation
    assert run.energy.closing_error < 1e-10
    assert (run.energy.elements[-1] > 0.0).all()
    _check_forces(run, twin)


def _check_forces(run, twin):
    """While the dampers hold the base, together they balance what turns it, and press it onto the ground."""
    n, p = twin.n, run.history.model.properties
    held = np.flatnonzero(
        (run.side != 0.0) & (run.rotation_velocity == 0.0) & (run.history.rotation_acceleration == 0.0)
    )
    assert held.size > 5
    for place in held[:: max(held.size // 20, 1)]:
        phase = Phase(side=int(run.side[place]), held=True)
        q, v = np.zeros(n + 3), np.zeros(n + 3)
        q[:n], v[:n] = run.history.modal_displacement[place], run.history.modal_velocity[place]
        q[n] = run.rotation[place]
        ground = run.history.ground_acceleration[place], run.history.vertical_ground_acceleration[place]
        _, (moment, across, upwards), _ = twin.solve(q, v, *ground, phase)
        force = run.element_force[place]
        pulls = np.array([twin.gradient(each.position, q, phase)[0] for each in twin.sliders])
        assert force @ pulls == pytest.approx(-moment, rel=1e-9, abs=1e-9 * WEIGHT)
        assert (np.abs(force) <= [each.limit * (1.0 + 1e-9) for each in twin.sliders]).all()
        half = 0.5 * q[n]
        assert run.vertical_reaction[place] == pytest.approx(upwards + force.sum() * np.cos(half), abs=1e-9 * WEIGHT)
        assert run.horizontal_reaction[place] == pytest.approx(across + force.sum() * np.sin(half), abs=1e-9 * WEIGHT)
    assert p.elements


def test_a_block_stays_where_friction_can_hold_it():
    """The weight closes it with m g (B cos θ - h sin θ), two dampers at the edges hold it with F_0 2 B cos (θ/2)."""
    block = rf.rigid_block(slenderness=0.3, half_diagonal=3.0, mass=1e5)
    b, rotation = block.half_width, 0.12
    closing = 1e5 * 9.81 * b * np.cos(rotation) - block.l0r * 9.81 * np.sin(rotation)
    for share, stays in ((1.0001, True), (0.9999, False)):
        force = share * closing / (2.0 * b * np.cos(0.5 * rotation))
        held = replace(block, elements=[rf.FrictionDamper(force, x) for x in (-b, b)])
        run = rf.simulate(
            held,
            rf.quiet_motion(0.5),
            "rigid-C",
            initial=rf.InitialState(rotation=rotation),
            free_vibration="settle",
        )
        assert run.settled
        assert run.residual_rotation == pytest.approx(rotation if stays else 0.0, rel=1e-12)


def test_a_fuse_of_infinite_stiffness_is_the_same():
    exact = rf.simulate(damped((0.2, 0.2), (0.9, -0.9)), rf.GroundMotion(SHAKING, DT), "2DOF-C")
    errors = []
    for stiffness in (1e10, 1e14):
        fuses = [rf.YieldingDissipator(stiffness, 0.2 * WEIGHT, 0.0, x) for x in (0.9 * B, -0.9 * B)]
        run = rf.simulate(rf.Restrained(FRAME, fuses), rf.GroundMotion(SHAKING, DT), "2DOF-C")
        errors.append(abs(run.max_rotation / exact.max_rotation - 1.0))
    assert errors[0] < 2e-2
    assert errors[1] < 0.03 * errors[0]  # they fall slowly: while it sticks, a stiff fuse vibrates


def test_small_rotations_are_those_of_the_simplified_model():
    """A base released from a rotation: when it lands differs by a share of that rotation."""
    apart = []
    for rotation in (1e-3, 1e-4):
        options = {"initial": rf.InitialState(rotation=rotation), "free_vibration": 0.0}
        held = damped((0.2, 0.3), (0.9, -0.9))
        one, other = (rf.simulate(held, rf.quiet_motion(1.0), model, **options) for model in ("MDOF-C", "MDOF-S"))
        apart.append(abs(one.history.impact_times[0] / other.history.impact_times[0] - 1.0))
    assert apart[0] < 1e-2
    assert apart[1] == pytest.approx(0.1 * apart[0], rel=0.3)


def test_a_yielding_structure_that_never_yields_is_an_elastic_one():
    held = damped((0.3,), (0.4,))
    motion = rf.GroundMotion(SHAKING, DT, vertical=UPWARDS)
    elastic = rf.simulate(held, motion, "2DOF-C")
    yielding = rf.simulate(held, motion, "2DOF-C", bouc_wen=rf.BoucWen(1e3))
    assert yielding.n_uplifts == elastic.n_uplifts > 2
    assert yielding.max_rotation == pytest.approx(elastic.max_rotation, rel=1e-8)
    assert yielding.energy.closing_error < 1e-9


def test_a_yielding_structure_loses_energy_in_both():
    held = damped((0.3,), (0.4,))
    run = rf.simulate(held, rf.GroundMotion(2.0 * SHAKING, DT), "2DOF-C", bouc_wen=rf.BoucWen(0.02))
    assert run.energy.yielded[-1] > 0.0
    assert run.energy.elements[-1, 0] > 0.0
    assert run.energy.closing_error < 1e-9


def test_a_saved_response_keeps_its_dampers(tmp_path):
    run = rf.simulate(damped((0.3, 0.2), (0.8, -0.9)), rf.GroundMotion(SHAKING, DT), "MDOF-C")
    back = rf.Response.load(run.save(tmp_path / "run"))
    for name in ("element_force", "vertical_reaction", "horizontal_reaction", "base_moment"):
        np.testing.assert_array_equal(getattr(back, name), getattr(run, name))
    middle = run.history.resample(0.0025)
    assert np.abs(middle.element_force).max() <= 0.3 * WEIGHT * (1.0 + 1e-9)
