"""Whether a base closes against its dissipators: moments by hand, and the end of a slow cycle."""

import math

import pytest

import rockflex as rf

G = 9.81
B, MASS = 1.0, 100e3
WEIGHT = MASS * G * B  # moment of the weight, N m


def block(*elements, eccentricity=0.0):
    """A rigid block of 100 t on a base 2 m wide, 5 m from base to centre."""
    inertia = MASS * 5.0**2 * 4.0 / 3.0
    return rf.RockingProperties(
        [], [], [], [], inertia + MASS * B**2, 5.0 * MASS, MASS, B, [], inertia, elements=elements,
        eccentricity=eccentricity,
    )  # fmt: skip


def fuse(strength, **more):
    return rf.YieldingDissipator(stiffness=1e8, yield_force=strength, **more)


def test_nothing_keeps_a_base_open_without_dissipators():
    for p in (
        block(),
        block(rf.Tendon(1e5, 1e6)),
        block(rf.ViscousDamper(1e6, 0.5)),
        block(fuse(9e9, tension_only=True)),
    ):
        assert p.self_centring
        assert p.recentring_ratio == math.inf
        assert p.pivot(1).dissipator_moment == 0.0


@pytest.mark.parametrize(
    ("elements", "locked", "resisting"),
    [
        ([fuse(4e5)], 4e5 * B, WEIGHT),
        ([fuse(4e5, post_yield_ratio=0.1)], 0.9 * 4e5 * B, WEIGHT),
        ([rf.FrictionDamper(3e5)], 3e5 * B, WEIGHT),
        ([fuse(2e5, position=0.5), fuse(2e5, position=-0.5)], 2e5 * (0.5 + 1.5), WEIGHT),
        ([fuse(4e5), rf.FrictionDamper(1e5), rf.Tendon(3e5, 2e6)], 5e5 * B, WEIGHT + 3e5 * B),
        ([fuse(4e5), fuse(4e5, tension_only=True), rf.ViscousDamper(1e6)], 4e5 * B, WEIGHT),
        ([fuse(4e5), rf.Tendon(3e5, 2e6, yield_force=5e5, post_yield_ratio=0.0)], 4e5 * B, WEIGHT + 3e5 * B),
    ],
)
def test_moments_of_a_symmetric_base(elements, locked, resisting):
    p = block(*elements)
    for side in (1, -1):
        assert p.pivot(side).dissipator_moment == pytest.approx(locked, rel=1e-14)
        assert p.pivot(side).recentring_ratio == pytest.approx(resisting / locked, rel=1e-14)
    assert p.recentring_ratio == pytest.approx(resisting / locked, rel=1e-14)
    assert p.self_centring


def test_each_edge_of_an_eccentric_base():
    # Pivots 0.7 m to the right and 1.3 m to the left of the masses; the fuse is beyond the right one.
    p = block(fuse(6e5, position=1.1), rf.FrictionDamper(2e5, position=-0.3), eccentricity=0.3)
    right, left = p.pivot(1), p.pivot(-1)
    assert right.dissipator_moment == pytest.approx(6e5 * 0.4 + 2e5 * 1.0)
    assert left.dissipator_moment == pytest.approx(6e5 * 2.4 + 2e5 * 1.0)
    assert right.recentring_ratio == pytest.approx(MASS * G * 0.7 / 4.4e5)
    assert p.recentring_ratio == left.recentring_ratio == pytest.approx(MASS * G * 1.3 / 16.4e5)
    assert right.self_centring
    assert not left.self_centring
    assert not p.self_centring


def test_strength_equal_to_the_weight_is_not_enough():
    weight = block().resisting_moment / B
    assert block(rf.FrictionDamper(math.nextafter(weight, 0.0))).self_centring
    assert not block(rf.FrictionDamper(weight)).self_centring
    assert block(rf.FrictionDamper(weight)).recentring_ratio == 1.0
    # Hardening leaves less to be locked in.
    assert not block(fuse(1.05 * weight)).self_centring
    assert block(fuse(1.05 * weight, post_yield_ratio=0.05)).self_centring


@pytest.mark.parametrize(("ratio", "post_yield"), [(0.8, 0.0), (0.95, 0.0), (1.05, 0.0), (1.2, 0.0), (1.05, 0.1)])
def test_a_pushed_base_closes_if_it_is_self_centring(ratio, post_yield):
    """Push the base open and back slowly, with F and z of the fuse in small steps: does it close by itself?"""
    p = block(fuse(ratio * WEIGHT / B, post_yield_ratio=post_yield))
    (each,) = p.elements
    steps, widest = 20_000, 0.06  # rad, 60 mm of elongation: 6 times that at yield
    z, before, moments = 0.0, 0.0, []
    for step in [*range(steps), *range(steps, -1, -1)]:
        elongation = B * widest * step / steps
        z = min(max(z + each.stiffness * (elongation - before), -each.yield_force), each.yield_force)
        force = post_yield * each.stiffness * elongation + (1.0 - post_yield) * z
        moments.append(p.resisting_moment - p.l0r * G * elongation / B + force * B)
        before = elongation
    closes = moments[-1] > 0.0  # what is left at θ = 0 on the way back
    assert closes == p.self_centring == (p.recentring_ratio > 1.0)
    assert moments[-1] == pytest.approx(p.resisting_moment - p.pivot(1).dissipator_moment, abs=1e-6 * WEIGHT)


def test_the_ratio_at_a_design_rotation_is_that_of_nzs_3101():
    """Moments of weight and tendons over those of fuses, all pushed to the rotation, by hand."""
    turn = 0.02
    fuses = 4e5 + 0.1 * 1e8 * (turn * B - 4e5 / 1e8)
    p = block(fuse(4e5, post_yield_ratio=0.1), rf.Tendon(3e5, 2e6))
    assert p.recentring_ratio_at(turn) == pytest.approx((WEIGHT + (3e5 + 2e6 * turn * B) * B) / (fuses * B), rel=1e-14)
    assert p.recentring_ratio_at(turn) < 0.95 * p.recentring_ratio  # fuses that harden
    held = block(rf.FrictionDamper(3e5), rf.Tendon(3e5, 2e7, yield_force=5e5, post_yield_ratio=0.01))
    yielded = 5e5 + 0.01 * (3e5 + 2e7 * turn - 5e5)
    assert held.recentring_ratio_at(turn) == pytest.approx((WEIGHT + yielded * B) / 3e5, rel=1e-14)
    assert block(fuse(4e5, rupture_elongation=0.01)).recentring_ratio_at(turn) == math.inf
    assert block(rf.ViscousDamper(1e6), rf.Tendon(3e5, 2e6)).recentring_ratio_at(turn) == math.inf


def test_the_ratio_at_a_design_rotation_of_an_eccentric_base_is_that_of_its_worse_edge():
    p = block(fuse(4e5, position=0.4), eccentricity=0.3)
    ratios = [MASS * G * arm / (4e5 * r) for arm, r in ((0.7, 0.3), (1.3, 1.7))]
    assert p.recentring_ratio_at(0.1) == pytest.approx(min(ratios), rel=1e-14)
    for wrong in (0.0, -0.1, 1.6, math.nan):
        with pytest.raises(rf.InputError, match="rotation"):
            p.recentring_ratio_at(wrong)
