"""Limits of controlled rocking that are known without any computation, and the damped rigid block in closed form."""

import dataclasses
import math

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from rockflex.models._prepared_model import PreparedModel
from rockflex.models._state_layout import HEADER
from rockflex.response._peaks import tracked_quantities

FRAME = make_frame(n_stories=3, stiffness_ratio=0.125, period=0.6, aspect_ratio=7.0, damping_ratio=0.03)
PLAIN = FRAME.rocking()
WEIGHT, B = PLAIN.m_tot * 9.81, PLAIN.half_width
MOTION = rf.load_suite("fema-p695-far-field")["FF-12-a"].scaled(1.6)
K, FORCE = 0.5 * WEIGHT / (0.004 * B), 0.06 * WEIGHT
SIDES = (-0.8 * B, 0.8 * B)
PEAKS = ("max_rotation", "max_top_displacement", "max_base_moment", "max_base_shear", "min_vertical_reaction")


def peaks(elements, model="MDOF-S"):
    structure = rf.Restrained(FRAME, elements) if elements else FRAME
    response = rf.simulate(structure, MOTION, model, output="peaks")
    return np.array([getattr(response, name) for name in PEAKS])


def engine_of(elements, n=2):
    model = rf.Model(n).of(rf.Restrained(FRAME, elements).rocking())
    return PreparedModel(model, tracked_quantities(model).peaks.quantities)


def residual(run):
    """Rotation at the end of a run of an engine with two modes."""
    return run.final_state[4]


@pytest.mark.parametrize("nothing", [rf.ViscousDamper(0.0, 0.3), rf.FrictionDamper(0.0, -0.2), rf.Tendon(0.0, 0.0)])
@pytest.mark.parametrize("model", ["2DOF-S", "MDOF-S", "rigid"])
def test_an_element_of_zero_changes_nothing(nothing, model):
    np.testing.assert_allclose(peaks([nothing], model), peaks([], model), rtol=1e-9)


def test_a_fuse_that_never_yields_is_a_tendon_without_prestress():
    elastic = peaks([rf.Tendon(0.0, K, x) for x in SIDES])
    fuses = [rf.YieldingDissipator(K, 1e3 * WEIGHT, 0.0, x) for x in SIDES]
    np.testing.assert_allclose(peaks(fuses), elastic, rtol=1e-11)
    unyielding = [rf.Tendon(0.0, K, x, yield_force=1e3 * WEIGHT, post_yield_ratio=0.0) for x in SIDES]
    np.testing.assert_allclose(peaks(unyielding), elastic, rtol=1e-11)


def test_a_friction_damper_is_a_fuse_of_infinite_stiffness():
    """The difference falls like 1/k: the stretch at yield is F_y/k."""
    exact = peaks([rf.FrictionDamper(FORCE, x) for x in SIDES])[:3]
    errors = []
    for stiffer in (1e4, 1e6):
        fuses = [rf.YieldingDissipator(stiffer * K, FORCE, 0.0, x) for x in SIDES]
        errors.append(np.abs(peaks(fuses)[:3] / exact - 1.0))
    assert errors[0].max() < 1e-3
    assert errors[1].max() < 1e-4
    order = np.log10(errors[0] / errors[1]) / 2.0
    assert order[0] == pytest.approx(1.0, abs=0.25)


def test_elements_that_yield_leave_the_base_open_where_they_outdo_the_weight():
    strong = [rf.YieldingDissipator(K, 1.2 * WEIGHT, 0.02, x) for x in (-B, B)]
    run = engine_of(strong).run(3.0 * MOTION.acceleration, MOTION.dt, free_vibration=None)
    assert run.settled
    assert residual(run) != 0.0
    longer = engine_of(strong).run(3.0 * MOTION.acceleration, MOTION.dt, free_vibration=300.0)
    assert residual(run) == pytest.approx(residual(longer), rel=1e-9)
    weak = engine_of([rf.YieldingDissipator(K, 0.1 * WEIGHT, 0.02, x) for x in (-B, B)])
    assert residual(weak.run(MOTION.acceleration, MOTION.dt, free_vibration=None)) == 0.0


@pytest.mark.parametrize("rotation", [0.004, -0.004])
def test_friction_holds_a_base_at_any_rotation_that_its_moment_can_hold(rotation):
    """The weight closes the base with m g B - L_0^r g |θ|; dampers at both edges hold it with F_0 2 B."""
    closing = WEIGHT * B - PLAIN.l0r * 9.81 * abs(rotation)
    start = np.zeros(6)
    start[4] = rotation
    for share, stays in ((1.001, True), (0.999, False)):
        dampers = [rf.FrictionDamper(share * closing / (2.0 * B), x) for x in (-B, B)]
        run = engine_of(dampers).run(np.zeros(200), 0.01, free_vibration=None, state=start.copy())
        assert run.settled
        assert run.peaks[0] == pytest.approx(abs(rotation))
        assert bool(residual(run) == rotation) is stays
        assert bool(residual(run) == 0.0) is not stays


def test_a_fuse_as_built_yields_as_the_base_is_brought_to_its_initial_rotation():
    """Released from a rotation, the base swings back from the fuse's elastic branch, which starts at its limit."""
    rotation, n = 0.01, 1
    engine = engine_of([rf.YieldingDissipator(K, 2.0 * WEIGHT, 0.0, -B)], n)
    start = np.zeros(4)
    start[2] = rotation
    run = engine.run(np.zeros(2), 1e-3, state=start, history=True)
    plastic = run.states[:, -1]
    assert plastic == pytest.approx(2.0 * B * rotation - 2.0 * WEIGHT / K, rel=1e-9)
    assert plastic[0] > 0.0


def test_the_damped_rigid_block_in_closed_form():
    """I_θ θ'' + C θ' - L_0^r g θ = -m g B s, with C = Σ c r²; Dimitrakopoulos & DeJong 2012."""
    block = rf.rigid_block(slenderness=0.2, half_diagonal=4.0)
    b, c = block.half_width, 0.05 * block.i_theta / block.half_width**2
    held = rf.RockingProperties(**{**values_of(block), "elements": [rf.ViscousDamper(c, 0.5 * b)]})
    damping, weight, fall = c * (0.5 * b) ** 2, held.m_tot * 9.81 * b, held.l0r * 9.81
    root = math.sqrt(damping**2 + 4.0 * held.i_theta * fall)
    one, two = (-damping + root) / (2.0 * held.i_theta), (-damping - root) / (2.0 * held.i_theta)
    balance, theta_0 = weight / fall, 0.05
    # θ = balance + a exp(one t) + b exp(two t), from θ_0 at rest
    a = (theta_0 - balance) * two / (two - one)
    e = theta_0 - balance - a
    model = rf.Model(0).of(held)
    engine = PreparedModel(model, tracked_quantities(model).peaks.quantities)
    dt = 0.01
    run = engine.run(np.zeros(30), dt, state=np.array([theta_0, 0.0]), history=True)
    time, theta = run.states[:, 0], run.states[:, HEADER]
    free = theta > 0.0
    expected = balance + a * np.exp(one * time) + e * np.exp(two * time)
    assert free.sum() > 20
    np.testing.assert_allclose(theta[free], expected[free], rtol=0.0, atol=1e-13)


def values_of(properties):
    return {each.name: getattr(properties, each.name) for each in dataclasses.fields(properties)} | {"zeta": 0.0}


def test_friction_of_a_yielding_structure_that_never_yields_is_that_of_an_elastic_one():
    dampers = [rf.FrictionDamper(FORCE, x) for x in SIDES]
    held = rf.Restrained(FRAME, dampers)
    elastic = rf.simulate(held, MOTION, "2DOF-S", output="peaks")
    yielding = rf.simulate(held, MOTION, "2DOF-S-BW", output="peaks", bouc_wen=rf.BoucWen(1e3))
    assert yielding.n_uplifts == elastic.n_uplifts > 5
    for name in PEAKS[:4]:
        assert getattr(yielding, name) == pytest.approx(getattr(elastic, name), rel=1e-8)


def test_a_complete_model_settles_where_its_fuses_hold_it_open():
    strong = rf.Restrained(FRAME, [rf.YieldingDissipator(K, 1.2 * WEIGHT, 0.02, x) for x in (-B, B)])
    motion = MOTION.scaled(2.0)
    settled = rf.simulate(strong, motion, "2DOF-C", output="peaks", free_vibration="settle")
    longer = rf.simulate(strong, motion, "2DOF-C", output="peaks", free_vibration=300.0)
    assert abs(settled.residual_rotation) > 1e-4
    assert settled.residual_rotation == pytest.approx(longer.residual_rotation, rel=1e-3)
