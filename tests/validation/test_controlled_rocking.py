"""Controlled rocking: the exact engine against adaptive integration with events (SciPy)."""

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from rockflex.models._state_layout import SIDE
from rockflex.models._values_at_states import phases_at_states
from rockflex.structure._branches import BROKEN, DOWN, INWARD, OUTWARD, SLACK, UP
from twins.controlled import Bar, ControlledTwin, Dashpot, Slider

FRAME = make_frame(n_stories=3, stiffness_ratio=0.125, period=0.6, aspect_ratio=7.0, damping_ratio=0.03)
PLAIN = FRAME.rocking()
WEIGHT, B = PLAIN.m_tot * 9.81, PLAIN.half_width
MOTION = rf.load_suite("fema-p695-far-field")["FF-12-a"].scaled(1.6)
SHORT = rf.GroundMotion(MOTION.acceleration[3600:6400], MOTION.dt)  # its strong part
STIFF = WEIGHT / (0.004 * B)  # N/m: a force of the weight at a stretch of 0.004 B

FUSES = [rf.YieldingDissipator(0.5 * STIFF, 0.06 * WEIGHT, 0.03, x) for x in (-0.8 * B, 0.8 * B)]
HOOKS = [rf.YieldingDissipator(0.5 * STIFF, 0.08 * WEIGHT, 0.0, x, tension_only=True) for x in (-B, 0.5 * B)]
BRITTLE = [rf.YieldingDissipator(0.3 * STIFF, 0.05 * WEIGHT, 0.05, x, rupture_elongation=0.004 * B) for x in (-B, B)]
SLIDERS = [rf.FrictionDamper(0.05 * WEIGHT, x) for x in (-B, 0.3 * B)]
# What holds the base, eccentricity, modes, and the branches that the run must visit besides the elastic one.
CASES = {
    "fuses": (FUSES, 0.0, 3, {UP, DOWN}),
    "no compression": (HOOKS, 0.0, 2, {UP, SLACK}),
    "that break": (BRITTLE, 0.0, 1, {UP, DOWN, BROKEN}),
    "tendon that yields": ([rf.Tendon(0.3 * WEIGHT, 0.4 * STIFF, 0.0, 0.32 * WEIGHT, 0.02)], 0.0, 1, {UP, SLACK}),
    "friction": (SLIDERS, 0.0, 3, {OUTWARD, INWARD}),
    "strong friction": ([rf.FrictionDamper(0.4 * WEIGHT, x) for x in (-B, B)], 0.0, 2, {OUTWARD, INWARD}),
    "all, on an eccentric base": (
        [*FUSES, *SLIDERS, rf.ViscousDamper(0.02 * STIFF, -B), rf.Tendon(0.1 * WEIGHT, 0.1 * STIFF, 0.2 * B)],
        0.15 * B,
        2,
        {UP, DOWN},
    ),
}  # fmt: skip


def element_of(given):
    match given:
        case rf.ViscousDamper():
            return Dashpot(given.coefficient, given.position)
        case rf.FrictionDamper():
            return Slider(given.force, given.position)
        case rf.YieldingDissipator():
            at = (given.stiffness, given.yield_force, given.post_yield_ratio, given.position)
            return Bar(*at, no_push=given.tension_only, rupture=given.rupture_elongation or np.inf)
    yields = given.post_yield_ratio is not None
    force, ratio = (given.yield_force, given.post_yield_ratio) if yields else (1e30, 0.0)
    return Bar(given.stiffness, force, ratio, given.position, given.initial_force / given.stiffness, yields)


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_controlled_rocking_meets_its_twin(name):
    elements, eccentricity, n, branches = CASES[name]
    structure = rf.Restrained(rf.Eccentric(FRAME, eccentricity) if eccentricity else FRAME, elements)
    twin = ControlledTwin.of(structure.rocking(n), [element_of(each) for each in elements])
    expected = twin.run(SHORT.acceleration, SHORT.dt)
    found = rf.simulate(structure, SHORT, f"{n + 1}DOF-S")
    assert found.n_uplifts == len(expected.uplift_times) > 1
    assert found.max_rotation == pytest.approx(expected.max_rotation, rel=3e-7)
    assert found.max_top_displacement == pytest.approx(expected.max_top_displacement, rel=1e-8)
    assert found.max_base_moment == pytest.approx(expected.max_base_moment, rel=1e-8)
    model, states = rf.Model(n).of(structure.rocking()), found.history.states
    keys = [
        key
        for _, key in phases_at_states(model, states[:, SIDE], model.layout.of(states, model.layout.rotation), states)
    ]
    assert {branch for key in keys for branch in key[1:]} >= branches
    assert ("friction" not in name) or any(key[0] != 0 and not model.is_free(key) for key in keys)
