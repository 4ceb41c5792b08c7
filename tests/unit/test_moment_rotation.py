"""The quasi-static moment of a base over its rotation, with all of its elements."""

import math
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import rockflex as rf
from builders import BY_HAND

WEIGHT, ARM = 240e3 * 9.81, 1.2
WEIGHT_SLOPE = 1.8e6 * 9.81
TENDON = rf.Tendon(initial_force=1.0e6, stiffness=30e6)
K, FY = 200e6, 0.4e6  # of the fuse
FUSE = rf.YieldingDissipator(K, FY)


def base(*elements, **changes):
    return rf.RockingProperties(**BY_HAND | changes, elements=elements)


def plastic_work(curve, place, force):
    """(1 - α) F_y times the path of the plastic stretch."""
    return force * np.abs(np.diff(curve.plastic_stretch[:, place])).sum()


# --- closed forms -----------------------------------------------------------------------------------------------------


def test_a_free_base_follows_equation_23():
    curve = rf.moment_rotation(base(), [0.0, 0.05, -0.03, 0.0])
    np.testing.assert_array_equal(curve.rotation, [0.0, 0.0, 0.05, 0.0, 0.0, -0.03, 0.0])
    m = WEIGHT * ARM
    np.testing.assert_allclose(
        curve.moment,
        [0.0, m, m - WEIGHT_SLOPE * 0.05, m, -m, -m + WEIGHT_SLOPE * 0.03, -m],
        rtol=1e-14,
    )
    np.testing.assert_array_equal(curve.side, [0, 1, 1, 1, -1, -1, -1])
    np.testing.assert_array_equal(curve.given, [True, False, True, False, False, True, True])
    assert curve.element_force.shape == (7, 0)
    assert curve.work[-1] == pytest.approx(0.0, abs=1e-9 * m)
    assert curve.self_centring
    assert not np.signbit(curve.rotation[-1])


def test_the_flag_of_a_tendon_and_a_fuse():
    """Spine: weight and tendon. Loop: twice the fuse's moment high, closed by its elastic stiffness."""
    p, top = base(TENDON, FUSE), 0.02
    curve = rf.moment_rotation(p, [top, 0.0])
    yields = FY / K / ARM
    spine, slope = (WEIGHT + 1.0e6) * ARM, 30e6 * ARM**2 - WEIGHT_SLOPE
    corners = [0.0, 0.0, yields, top, top - 2.0 * yields, 0.0]
    np.testing.assert_allclose(curve.rotation, corners, rtol=1e-13)
    fuse = np.array([0.0, 0.0, FY, FY, -FY, -FY]) * ARM
    expected = spine + slope * curve.rotation + fuse
    np.testing.assert_allclose(curve.moment[1:], expected[1:], rtol=1e-13)
    assert curve.moment[0] == 0.0
    assert curve.uplift_moments == pytest.approx([p.resisting_moment])
    # F_y on the way out past the elastic part, and on the way back past twice the elastic part.
    area = FY * (top * ARM - FY / K) + FY * (top * ARM - 2.0 * FY / K)
    assert curve.loop_energies == pytest.approx([area], rel=1e-12)
    assert curve.work[-1] == pytest.approx(area + 0.5 * FY**2 / K, rel=1e-12)  # the fuse is left compressed
    np.testing.assert_allclose(curve.element_losses[:, 0], 0.0, atol=1e-9 * area)


@pytest.mark.parametrize("hardening", [0.0, 0.03])
def test_a_full_loop_of_a_fuse(hardening):
    """At an outrigger beyond the nearer edge a fuse is stretched to one side and pressed to the other: ± δ."""
    e, reach = 0.3, 0.02
    p = base(rf.YieldingDissipator(K, FY, hardening, ARM + e), eccentricity=e)
    right, left = reach / (2.0 * e), -reach / (2.0 * (ARM + e))
    curve = rf.moment_rotation(p, [right, left] * 3)
    turns = np.flatnonzero(curve.given)
    np.testing.assert_allclose(curve.element_elongation[turns, 0], [-reach, reach] * 3, rtol=1e-13)
    cycle = np.diff(curve.element_losses[turns[1::2], 0])
    # Bauschinger: past the first turn the fuse yields after twice its elastic stretch.
    np.testing.assert_allclose(cycle, 4.0 * (1.0 - hardening) * FY * (reach - FY / K), rtol=1e-12)


def test_a_fuse_locks_a_force_into_contact():
    """Once yielded it pushes the base up, so it lifts earlier about either pivot."""
    p = base(TENDON, rf.YieldingDissipator(K, FY, 0.0, 0.5))
    curve = rf.moment_rotation(p, [0.02, -0.02, 0.02])
    right, left = p.pivot(1).resisting_moment, p.pivot(-1).resisting_moment
    locked = FY * np.array([ARM - 0.5, ARM + 0.5])
    np.testing.assert_allclose(curve.uplift_moments, [right, -(left - locked[1]), right - locked[0]], rtol=1e-13)
    contact = np.flatnonzero((curve.rotation[:-1] == 0.0) & (curve.rotation[1:] == 0.0) & (curve.side[:-1] != 0))
    for k in contact:  # one vertical line, with the same forces at both ends
        np.testing.assert_array_equal(curve.element_force[k], curve.element_force[k + 1])
        assert curve.moment[k] * curve.moment[k + 1] < 0.0


@pytest.mark.parametrize("share", [0.999, 1.001])
def test_the_limit_of_self_centring(share):
    """One central fuse: F_y r < M_r + F_0 r, if the tendon outweighs the weight's moment beyond."""
    limit = WEIGHT + 1.0e6
    p = base(TENDON, rf.YieldingDissipator(2e9, share * limit))
    curve = rf.moment_rotation(p, [0.02, 0.0, -0.02, 0.0])
    assert curve.self_centring == (share < 1.0)
    slope = 30e6 * ARM**2 - WEIGHT_SLOPE
    rest = max(share - 1.0, 0.0) * limit * ARM / slope  # where the spine has recovered what is lacking
    np.testing.assert_allclose(curve.residual_rotations, [rest, -rest], rtol=1e-9)


def test_a_base_without_tendon_is_held_open_at_a_large_rotation():
    """The weight's moment falls with the rotation, so a fuse that closes at small rotations can hold at large ones."""
    fy = 0.9 * WEIGHT
    p = base(rf.YieldingDissipator(2e9, fy))
    small, large = rf.moment_rotation(p, [0.005, 0.0]), rf.moment_rotation(p, [0.06, 0.0])
    assert small.self_centring
    (rest,) = large.residual_rotations
    assert 0.06 - 2.0 * fy / 2e9 / ARM < rest < 0.06
    force = fy - 2e9 * ARM * (0.06 - rest)
    assert (WEIGHT + force) * ARM - WEIGHT_SLOPE * rest == pytest.approx(0.0, abs=1e-9 * WEIGHT)


def test_a_fuse_in_tension_only_engages_where_it_was_left():
    p = base(rf.YieldingDissipator(K, FY, 0.0, 0.0, tension_only=True))
    curve = rf.moment_rotation(p, [0.01, 0.0, 0.02, 0.0])
    left = 0.01 * ARM - FY / K
    assert curve.element_force.min() == 0.0
    engaged = curve.element_elongation[curve.element_force[:, 0] == 0.0, 0]
    assert np.isclose(engaged, left, rtol=1e-12).sum() == 2  # slack on the way back, taut on the way out
    assert curve.plastic_stretch[-1, 0] == pytest.approx(0.02 * ARM - FY / K, rel=1e-13)
    assert curve.element_losses[-1, 0] == pytest.approx(FY * (0.02 * ARM - FY / K), rel=1e-12)
    np.testing.assert_allclose(curve.uplift_moments, WEIGHT * ARM, rtol=1e-14)
    assert curve.self_centring


def test_a_tendon_that_yields_loses_prestress_and_goes_slack():
    k, start, limit = 30e6, 0.6e6, 0.9e6
    p = base(rf.Tendon(start, k, 0.0, limit, post_yield_ratio=0.0))
    little, much = rf.moment_rotation(p, [0.012, 0.0]), rf.moment_rotation(p, [0.04, 0.0, -0.01])
    lost = k * 0.012 * ARM + start - limit
    assert little.element_force[-1, 0] == pytest.approx(start - lost, rel=1e-12)
    assert little.moment[-1] == pytest.approx((WEIGHT + start - lost) * ARM, rel=1e-12)
    assert much.element_force[-1, 0] == much.element_force[-2, 0] == 0.0
    assert much.uplift_moments == pytest.approx([(WEIGHT + start) * ARM, -WEIGHT * ARM], rel=1e-13)
    assert much.plastic_stretch[-1, 0] == pytest.approx(0.04 * ARM - (limit - start) / k, rel=1e-12)
    elastic = rf.moment_rotation(base(rf.Tendon(start, k, 0.0, limit)), [0.04])
    assert elastic.element_force[-1, 0] == pytest.approx(start + k * 0.04 * ARM, rel=1e-14)


def test_a_rupture_is_a_vertical_drop_for_good():
    snaps = 0.018
    p = base(rf.YieldingDissipator(K, FY, 0.02, 0.0, rupture_elongation=snaps))
    curve = rf.moment_rotation(p, [0.02, 0.0, -0.02, 0.0])
    (at,) = np.flatnonzero(np.diff(curve.rotation, prepend=-1.0) == 0.0)[1:2]
    assert curve.element_elongation[at, 0] == pytest.approx(snaps, rel=1e-13)
    assert curve.element_force[at - 1, 0] == pytest.approx(FY + 0.02 * K * (snaps - FY / K), rel=1e-12)
    np.testing.assert_array_equal(curve.element_force[at:], 0.0)
    assert np.isnan(curve.plastic_stretch[at:]).all()
    # All of its work is gone, what it had stored too.
    work = 0.5 * FY**2 / K + FY * (snaps - FY / K) + 0.5 * 0.02 * K * (snaps - FY / K) ** 2
    assert curve.element_losses[-1, 0] == pytest.approx(work, rel=1e-12)
    assert curve.work[-1] == pytest.approx(work, rel=1e-12)


def test_a_rupture_at_the_given_rotation_comes_with_the_next_one():
    p = base(rf.YieldingDissipator(K, FY, rupture_elongation=0.018))
    curve = rf.moment_rotation(p, [0.018 / ARM, 0.02])
    force = curve.element_force[:, 0]
    np.testing.assert_allclose(force, [0.0, 0.0, FY, FY, 0.0, 0.0])
    np.testing.assert_allclose(curve.rotation[3:], [0.015, 0.015, 0.02])


def test_a_friction_damper_turns_its_force_at_once():
    force, x = 0.2e6, 0.4
    curve = rf.moment_rotation(base(TENDON, rf.FrictionDamper(force, x)), [0.02, -0.01, 0.0])
    np.testing.assert_allclose(curve.element_force[:, 1] / force, [0, 1, 1, -1, -1, 1, 1, -1, -1])
    np.testing.assert_allclose(curve.rotation, [0, 0, 0.02, 0.02, 0, 0, -0.01, -0.01, 0])
    right, left = ARM - x, ARM + x
    np.testing.assert_allclose(curve.loop_energies, [2 * force * right * 0.02, 2 * force * left * 0.01], rtol=1e-12)
    spine = (WEIGHT + 1.0e6) * ARM
    np.testing.assert_allclose(curve.uplift_moments, [spine + force * right, -spine - force * left], rtol=1e-14)


def test_a_stiff_fuse_becomes_a_friction_damper():
    force, path = 0.2e6, [0.02, -0.01, 0.0]
    slides = rf.moment_rotation(base(TENDON, rf.FrictionDamper(force, 0.4)), path)
    errors = []
    for k in (1e10, 1e11, 1e12):
        fuse = rf.moment_rotation(base(TENDON, rf.YieldingDissipator(k, force, 0.0, 0.4)), path)
        errors.append(abs(fuse.dissipated_energy[-1] / slides.dissipated_energy[-1] - 1.0))
        assert fuse.plastic_stretch[fuse.given, 1] == pytest.approx(
            slides.element_elongation[slides.given, 1], abs=2.0 * force / k
        )
    assert errors[-1] < 1e-4
    assert np.log10(errors[0] / errors[2]) == pytest.approx(2.0, abs=1e-3)  # first order in 1/k


def test_a_friction_damper_stronger_than_the_weight_holds_the_base_where_it_is():
    curve = rf.moment_rotation(base(rf.FrictionDamper(1.1 * WEIGHT)), [0.02, 0.0])
    assert curve.residual_rotations == pytest.approx([0.02])
    assert not curve.self_centring


def test_a_viscous_damper_is_too_slow_to_matter():
    with_damper = rf.moment_rotation(base(TENDON, rf.ViscousDamper(5e6)), [0.02, -0.02, 0.0])
    without = rf.moment_rotation(base(TENDON), [0.02, -0.02, 0.0])
    np.testing.assert_array_equal(with_damper.moment, without.moment)
    np.testing.assert_array_equal(with_damper.element_force[:, 1], 0.0)


def test_elements_at_the_pivot_do_nothing_about_it():
    p = base(rf.YieldingDissipator(K, FY, 0.0, ARM), rf.FrictionDamper(1e5, ARM))
    curve = rf.moment_rotation(p, [0.02, 0.0])
    np.testing.assert_array_equal(curve.element_force, 0.0)
    np.testing.assert_allclose(curve.moment[1:], WEIGHT * ARM - WEIGHT_SLOPE * np.array([0.0, 0.02, 0.0]))


# --- against independent computations --------------------------------------------------------------------------------

FORCES = st.floats(0.05e6, 1.5e6)
PLACES = st.floats(-1.4, 1.4).map(lambda x: round(x, 3))
FUSES = st.builds(rf.YieldingDissipator, st.floats(20e6, 2e9), FORCES, st.floats(0.0, 0.05), PLACES)
FRICTION = st.builds(rf.FrictionDamper, FORCES, PLACES)
TENDONS = st.builds(rf.Tendon, FORCES, st.floats(1e6, 50e6), PLACES)
DAMPERS = st.builds(rf.ViscousDamper, st.floats(0.0, 1e7), PLACES)
ELEMENTS = st.lists(st.one_of(FUSES, FRICTION, TENDONS, DAMPERS), min_size=1, max_size=4)
PATHS = st.lists(st.floats(-0.05, 0.05).map(lambda x: round(x, 5) + 0.0), min_size=1, max_size=8)


def mapped_forces(p, rotations):
    """Forces at the rotations by return mapping, which is exact for any step in one direction; closed in between."""
    arms = {1: p.pivot(1).arm, -1: p.pivot(-1).arm}
    forces = np.zeros((len(rotations), len(p.elements)))
    for place, each in enumerate(p.elements):
        known, plastic, friction = 0.0, 0.0, 0.0
        theta = 0.0
        for row, rotation in enumerate(rotations):
            for reached in [0.0, rotation] if theta * rotation < 0.0 else [rotation]:
                side = int(np.sign(reached) or np.sign(theta) or 1)
                stretch = (arms[side] - side * each.position) * abs(reached)
                if isinstance(each, rf.YieldingDissipator):
                    limit = each.yield_force / each.stiffness
                    plastic = float(np.clip(plastic, stretch - limit, stretch + limit))
                if stretch != known:
                    friction = np.sign(stretch - known)
                known, theta = stretch, reached
            if isinstance(each, rf.Tendon):
                forces[row, place] = max(each.initial_force + each.stiffness * known, 0.0)
            elif isinstance(each, rf.FrictionDamper):
                forces[row, place] = friction * each.force
            elif isinstance(each, rf.YieldingDissipator):
                a, k = each.post_yield_ratio, each.stiffness
                forces[row, place] = a * k * known + (1.0 - a) * k * (known - plastic)
    return forces


@given(elements=ELEMENTS, path=PATHS)
def test_forces_are_those_of_return_mapping(elements, path):
    p = base(*elements, eccentricity=0.3)
    curve = rf.moment_rotation(p, path)
    np.testing.assert_array_equal(curve.rotation[curve.given], path)
    scale = 2e6 + np.abs(curve.element_force).max()
    np.testing.assert_allclose(curve.element_force[curve.given], mapped_forces(p, path), atol=1e-9 * scale)


@given(elements=ELEMENTS, path=PATHS)
def test_the_work_of_the_moment_is_stored_or_dissipated(elements, path):
    p = base(*elements, eccentricity=-0.2)
    curve = rf.moment_rotation(p, [*path, 0.0])
    lost = stored = 0.0
    for place, each in enumerate(p.elements):
        slid = np.abs(np.diff(curve.element_elongation[:, place])).sum()
        if isinstance(each, rf.FrictionDamper):
            lost += each.force * slid
        if isinstance(each, rf.YieldingDissipator):  # closed, it still holds what its locked-in force has stored
            a, k = each.post_yield_ratio, each.stiffness
            lost += plastic_work(curve, place, (1.0 - a) * each.yield_force)
            stored += 0.5 * (1.0 - a) * k * curve.plastic_stretch[-1, place] ** 2
    scale = max(np.abs(curve.work).max(), 1.0)
    assert curve.dissipated_energy[-1] == pytest.approx(lost, abs=1e-9 * scale)
    assert curve.work[-1] == pytest.approx(lost + stored, abs=1e-9 * scale)
    assert np.diff(curve.dissipated_energy).min(initial=0.0) >= -1e-9 * scale
    assert curve.loop_energies.sum() == pytest.approx(lost, abs=1e-9 * scale)


@given(elements=ELEMENTS, path=PATHS, count=st.integers(2, 9))
def test_samples_in_between_change_nothing(elements, path, count):
    p = base(*elements, eccentricity=0.2)
    turns = rf.moment_rotation(p, path)
    spans = [np.linspace(a, b, count)[1:] for a, b in zip([0.0, *path[:-1]], path, strict=True)]
    fine = rf.moment_rotation(p, np.concatenate(spans))
    at = np.flatnonzero(fine.given)[count - 2 :: count - 1]
    scale = np.abs(turns.moment).max() + 1.0
    np.testing.assert_allclose(fine.moment[at], turns.moment[turns.given], atol=1e-9 * scale)
    np.testing.assert_allclose(fine.dissipated_energy[-1], turns.dissipated_energy[-1], atol=1e-9 * scale)
    np.testing.assert_allclose(fine.uplift_moments, turns.uplift_moments, atol=1e-9 * scale)
    # The curve has no corner that the samples miss.
    assert np.abs(turns.moment).max() == pytest.approx(np.abs(fine.moment).max(), rel=1e-9)


def test_a_run_has_the_forces_of_its_rotations():
    """Without dampers the elements do not know how fast the base moves: the same path gives the same forces."""
    fuses = [rf.YieldingDissipator(K, 0.3e6, 0.02, x) for x in (-0.5, 0.5)]
    bar = rf.Tendon(0.5e6, 30e6, 0.0, 0.7e6, 0.02)
    p = base(bar, *fuses)
    history = rf.simulate(p, rf.ricker_pulse(5.0, 1.2), "MDOF-S", free_vibration=5.0).history
    curve = rf.moment_rotation(p, history.rotation)
    assert history.impact_times.size > 2
    known = history.element_force
    np.testing.assert_allclose(curve.element_force[curve.given], known, atol=1e-9 * known.max())
    np.testing.assert_allclose(curve.element_energy, history.element_energy, rtol=1e-9)
    assert (curve.element_energy > 0.0).all()


# --- the value --------------------------------------------------------------------------------------------------------


def test_the_path_as_a_table():
    curve = rf.moment_rotation(base(TENDON, FUSE), [0.02, 0.0])
    table = curve.to_frame()
    of_one = ["element_force", "element_elongation", "plastic_stretch", "element_losses"]
    assert list(table) == ["rotation", "moment", "side", "given"] + [f"{name}_{k}" for k in (1, 2) for name in of_one]
    np.testing.assert_array_equal(table["element_force_2"], curve.element_force[:, 1])
    assert len(table) == curve.rotation.size
    assert table["given"].sum() == 2


def test_it_is_a_frozen_value():
    curve = rf.moment_rotation(base(TENDON, FUSE), [0.02, 0.0])
    assert pickle.loads(pickle.dumps(curve)) == curve == rf.moment_rotation(base(TENDON, FUSE), [0.02, 0.0])
    with pytest.raises(ValueError, match="read-only"):
        curve.element_force[0] = 1.0
    assert curve.elements == (TENDON, FUSE)
    np.testing.assert_array_equal(curve.element_energy, curve.element_losses[-1])
    assert repr(curve) == (
        "MomentRotation(6 points, 2 elements, |θ| up to 0.02 rad, |M| up to 5.016e+06 N m, 1.68e+04 J dissipated)"
    )
    parts = curve.weight_moment + curve.element_moment.sum(axis=1)
    np.testing.assert_array_equal(curve.moment, parts)


def test_one_that_does_not_return_has_no_residual_rotation():
    curve = rf.moment_rotation(base(TENDON, FUSE), [0.02, 0.0, 0.01])
    assert curve.residual_rotations[0] == 0.0
    assert math.isnan(curve.residual_rotations[1])
    assert curve.self_centring
    assert curve.uplift_moments.size == curve.loop_energies.size == 2


def test_a_base_that_never_lifts():
    curve = rf.moment_rotation(base(TENDON), [0.0, 0.0])
    np.testing.assert_array_equal(curve.moment, [0.0, 0.0])
    assert curve.uplift_moments.size == curve.residual_rotations.size == curve.loop_energies.size == 0
    assert curve.given.all()


def test_a_structure_or_its_properties():
    frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0, damping_ratio=0.02)
    held = rf.Restrained(frame, [rf.Tendon(1e5, 1e6), rf.YieldingDissipator(1e7, 2e4)])
    assert rf.moment_rotation(held, [0.01]) == rf.moment_rotation(held.rocking(), [0.01])


@pytest.mark.parametrize(
    ("structure", "rotations", "message"),
    [
        (base(), [], "rotations is empty. Give at least one rotation of the base in rad."),
        (base(), [0.0, 2.0], "rotations must be at most a quarter turn, 1.571 rad, to each side, but rotations[1]"),
        (base(), [0.0, math.nan], "rotations must be finite, but 1 of 2 values are not, the first (nan) at index 1."),
        (base(), [[0.0]], "rotations must be one-dimensional, but an array of shape (1, 1) was given."),
        (rf.Frame, [0.0], "structure must be a structure such as a Frame or a TaperedTower, or RockingProperties"),
    ],
)
def test_bad_input_is_explained(structure, rotations, message):
    with pytest.raises(rf.InputError) as caught:
        rf.moment_rotation(structure, rotations)
    assert str(caught.value).startswith(message)
