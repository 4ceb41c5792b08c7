"""The impact laws as limits of springs and dashpots under the base, and the forces that follow from both:
docs/theory/contact.md and forces.md.
"""

import math

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from rockflex.models import housner

GRAVITY = 9.81
STILL = 0.15  # rad/s at landing


def two_springs(p, heave, ratio, inertia):
    b = p.half_width
    return rf.Ground(springs=rf.Springs([-b, b], 0.5 * p.m_tot * heave**2).damped(ratio, p.m_tot), base_inertia=inertia)


def block(slenderness):
    p = rf.rigid_block(slenderness, 3.0, 1e5)
    return p, 1e-9 * p.translational_inertia, p.resisting_moment / (p.l0r * GRAVITY)


def apex_restitution(p, ground, limit):
    """Ratio of the velocities that belong to the first two apexes, from half the rotation of equilibrium."""
    quarter = math.acosh(2.0) / math.sqrt(p.l0r * GRAVITY / p.i_theta)
    still = rf.quiet_motion(2.1 * quarter, dt=quarter / 300.0)
    run = rf.simulate(p, still, "rigid", ground=ground, initial=rf.InitialState(rotation=0.5 * limit))
    return math.sqrt((1.0 - (1.0 + run.rotation.min() / limit) ** 2) / 0.75)


@pytest.mark.parametrize("slenderness", [0.1, 0.2, 0.4])
def test_two_springs_become_housners_law_with_the_compliance(slenderness):
    """The impulse acts at the new pivot alone; the error is the weight over the force of landing, of first order."""
    p, inertia, limit = block(slenderness)
    error = [
        apex_restitution(p, two_springs(p, math.sqrt(GRAVITY / (s * limit * p.half_width)), 2.0, inertia), limit)
        - housner(p).e
        for s in (1e-3, 1e-4)
    ]
    assert abs(error[1]) < 3e-4
    assert error[0] / error[1] == pytest.approx(10.0, rel=0.06)


@pytest.mark.parametrize("ratio", [0.2, 0.5])
def test_a_block_that_hops_obeys_housner_too(ratio):
    """All impulses of a hopping edge act at the same pivot."""
    p, inertia, limit = block(0.2)
    ground = two_springs(p, math.sqrt(GRAVITY / (1e-5 * limit * p.half_width)), ratio, inertia)
    assert apex_restitution(p, ground, limit) == pytest.approx(housner(p).e, abs=2e-4)


def test_a_bed_returns_more_than_housners_law():
    """Its impulse acts between the edges, a third of B to B from the axis."""
    p, inertia, limit = block(0.4)
    heave = math.sqrt(GRAVITY / (1e-4 * limit * p.half_width))
    springs = rf.Springs(np.linspace(-p.half_width, p.half_width, 20), p.m_tot * heave**2 / 20).damped(2.0, p.m_tot)
    found = apex_restitution(p, rf.Ground(springs=springs, base_inertia=inertia), limit)
    beta = p.m_tot * p.half_width**2 / p.translational_inertia
    assert housner(p).e + 0.05 < found < (3.0 - beta) / (3.0 + beta)


def bounce(ratio):
    """Restitution of a mass on a spring and a dashpot that cannot pull (Schwager & Pöschel 2007)."""
    rest = math.sqrt(1.0 - ratio**2)
    return math.exp(-ratio / rest * math.atan2(2.0 * ratio * rest, 2.0 * ratio**2 - 1.0))


@pytest.mark.parametrize("ratio", [0.05, 0.2, 0.7])
@pytest.mark.parametrize("beta", [1.0 / 3.0, 0.8])
def test_first_landing_of_a_flexible_structure(beta, ratio):
    """Flexure keeps its momentum: the base lands as a block with the inertia that the modes leave over."""
    mass, height, b = 1e5, 10.0, 1.5
    total = 1.2 * mass
    inertia = total * b**2 / beta
    p = rf.RockingProperties(
        [6.0], [mass], [height], [1.0], i_theta=mass * height**2 + total * b**2 + inertia, l0r=mass * height,
        m_tot=total, half_width=b, zeta=0.02, translational_inertia=mass * height**2,
    )  # fmt: skip
    heave = 1e4
    run = rf.simulate(
        p, rf.quiet_motion(24.0 / heave, dt=0.1 / heave), "2DOF-S", ground=two_springs(p, heave, ratio, inertia),
        initial=rf.InitialState(rotation=60.0 / heave**2, rotation_velocity=-STILL),
    )  # fmt: skip
    spin = run.rotation_velocity[np.searchsorted(run.time, run.impact_times[0])]
    law = (1.0 - beta) / (1.0 + beta)
    kept = bounce(ratio * math.sqrt(0.5 * (1.0 + beta)))
    taken = run.energy.soil[-1].sum() / (0.5 * spin**2 * (total * b**2 + inertia))
    assert taken == pytest.approx((1.0 - law**2) * (1.0 - kept**2), rel=5e-3)


def with_rotary(p, inertia):
    modes = (p.omega, p.effective_mass, p.effective_height, p.top_ordinate)
    return rf.RockingProperties(
        *modes, p.i_theta + inertia, p.l0r, p.m_tot, p.half_width, p.zeta, p.translational_inertia
    )


@pytest.mark.parametrize(("share", "e"), [(1.0 / 18.0, 0.0), (3.0, 0.5)])
def test_a_frame_on_stiff_springs_follows_the_law_of_its_rotary_inertia(share, e):
    """θ_max tends to that with e = max(0, (J - m B²)/(J + m B²)): VVEL with a mat, one half with three times m B²."""
    bare = make_frame().rocking()
    inertia = share * bare.m_tot * bare.half_width**2
    p = with_rotary(bare, inertia)
    motion = rf.load_suite("el-centro-1940")[0].scaled(1.5)
    law = rf.simulate(p, motion, "MDOF-S", output="peaks", impact=rf.Restitution(e)).max_rotation
    stiff = p.omega[0] * p.effective_height[0] / p.half_width
    found = [
        rf.simulate(p, motion, "MDOF-S", output="peaks", ground=two_springs(p, over * stiff, 0.7, inertia)).max_rotation
        for over in (2.0, 10.0, 40.0)
    ]
    error = np.abs(np.array(found) / law - 1.0)
    assert error[1] < 0.03
    assert error[2] < 0.005
    assert error[2] < error[1] < error[0]


def on_a_mat(**changes):
    """A frame of Table 1 on a mat of the width of the base, and the inertia of the mat."""
    bare = make_frame(**changes).rocking()
    inertia = bare.base_mass * bare.half_width**2 / 3.0
    return with_rotary(bare, inertia), inertia


def stiff_springs(p, over, ratio, inertia):
    """Two springs whose heave is `over` times as fast as the first uplifted mode, about."""
    return two_springs(p, over * p.omega[0] * p.effective_height[0] / p.half_width, ratio, inertia)


def over_the_law(p, inertia, over, ratio):
    """Peaks on springs over those with VVEL, of the records under which both rock, and where VVEL never pulls."""
    suite = list(rf.load_suite("fema-p695-far-field"))[::4]
    law, found = (
        rf.simulate_many(p, suite, "MDOF-S", scales=(2.0,), output="peaks", workers=1, ground=ground)
        for ground in (None, stiff_springs(p, over, ratio, inertia))
    )
    both = (law["status"] == "rocking") & (found["status"] == "rocking")
    peaks = ["max_rotation", "max_base_moment", "max_base_shear"]
    return (found[peaks] / law[peaks])[both], (law["min_vertical_reaction"] >= 0.0)[both]


FLEXURE = {"stiffness_ratio": 0.0}
SIXTH = {**FLEXURE, "aspect_ratio": 5.0}
FOURTH = {**FLEXURE, "period": 0.5}


@pytest.mark.slow
@pytest.mark.parametrize("changes", [{}, SIXTH])
def test_stiff_ground_without_rebound_gives_the_forces_of_the_law(changes):
    ratios, _ = over_the_law(*on_a_mat(**changes), 20.0, 0.7)
    assert ratios.median().tolist() == pytest.approx([1.0] * 3, abs=0.02)


def test_rebound_leaves_the_rotation_of_a_flexural_frame_and_raises_its_base_shear():
    """Also where the law never pulls the base down, so that is not the reason; hardly that of a shear frame."""
    ratios, pressed = over_the_law(*on_a_mat(**SIXTH), 20.0, 0.05)
    assert pressed.sum() > 5
    for some in (ratios, ratios[pressed]):
        rotation, moment, shear = some.median()
        assert rotation == pytest.approx(1.0, abs=0.03)
        assert moment == pytest.approx(1.0, abs=0.1)
        assert shear > 1.2
    shear_frame, _ = over_the_law(*on_a_mat(), 20.0, 0.05)
    assert shear_frame["max_base_shear"].median() == pytest.approx(1.0, abs=0.02)


@pytest.mark.slow
def test_springs_let_go_where_the_law_pulls_the_base_down():
    """Then both forces of structure #4 are smaller on springs, at nearly the same rotation."""
    ratios, pressed = over_the_law(*on_a_mat(**FOURTH), 20.0, 0.05)
    rotation, moment, shear = ratios[~pressed].median()
    assert rotation == pytest.approx(1.0, abs=0.05)
    assert moment < 0.85
    assert shear < 0.85


@pytest.mark.parametrize("changes", [FOURTH, SIXTH])
def test_forces_on_compliant_ground_are_below_those_of_the_law(changes):
    ratios, _ = over_the_law(*on_a_mat(**changes), 1.0, 0.2)
    assert ratios["max_base_moment"].median() < 0.8
    assert ratios["max_base_shear"].median() < 0.75


@pytest.mark.parametrize(("ratio", "share"), [(0.05, 0.931), (0.2, 0.821), (0.7, 1.4), (1.0, 2.0)])
def test_the_blow_on_the_ground_grows_with_its_stiffness(ratio, share):
    """N_max - m g is a share of m B θ' ω_z; with an impact law it is not in the history."""
    p, inertia = on_a_mat(**FOURTH)
    start = rf.InitialState(rotation=1e-6, rotation_velocity=-STILL)
    for over in (100.0, 200.0):
        heave = over * p.omega[0] * p.effective_height[0] / p.half_width
        still = rf.quiet_motion(30.0 / heave, dt=0.02 / heave)
        run = rf.simulate(p, still, "MDOF-S", ground=two_springs(p, heave, ratio, inertia), initial=start)
        blow = run.history.vertical_reaction.max() - p.m_tot * GRAVITY
        assert blow == pytest.approx(share * p.m_tot * p.half_width * STILL * heave, rel=0.03)
    law = rf.simulate(p, still, "MDOF-S", initial=start)
    assert law.history.vertical_reaction.max() < 3.0 * p.m_tot * GRAVITY
