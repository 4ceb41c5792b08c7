"""The quasi-static moment of a base on springs over its rotation, with and without elements."""

import pickle

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from scipy.optimize import brentq

import rockflex as rf
from builders import BY_HAND
from twins import ground_answers as answers

GRAVITY = 9.81
WEIGHT, ARM = 240e3 * GRAVITY, 1.2
SLOPE = 1.8e6 * GRAVITY  # L_0^r g
TENDON = rf.Tendon(initial_force=0.5e6, stiffness=20e6)
FUSE = rf.YieldingDissipator(200e6, 0.3e6)
K = 400e6


def base(*elements, **changes):
    return rf.RockingProperties(**BY_HAND | changes, elements=elements)


def on(springs):
    return rf.Ground(springs=springs, base_inertia=1e5)


TWO = on(rf.Springs([-ARM, ARM], K))


# --- closed forms -----------------------------------------------------------------------------------------------------


def test_two_springs():
    """2 k b² θ until one spring is empty, W b from there on, less the moment of the weight that leans."""
    curve = rf.moment_rotation(base(), [0.0, 0.02, -0.01, 0.001], ground=TWO)
    lifts = WEIGHT / (2.0 * K * ARM)
    assert curve.uplift_rotations == pytest.approx([lifts, -lifts], rel=1e-13)
    assert curve.uplift_moments == pytest.approx(
        [WEIGHT * ARM - SLOPE * lifts, SLOPE * lifts - WEIGHT * ARM], rel=1e-12
    )
    expected = [answers.two_springs(abs(theta), WEIGHT, K, ARM) for theta in curve.rotation]
    moments, heaves = np.array(expected).T
    np.testing.assert_allclose(
        curve.moment, np.sign(curve.rotation) * moments - SLOPE * curve.rotation, atol=1e-12 * WEIGHT
    )
    np.testing.assert_allclose(curve.heave, heaves, atol=1e-15)
    np.testing.assert_array_equal(curve.given, [1, 0, 1, 0, 0, 1, 0, 1])
    np.testing.assert_array_equal(curve.rotation[curve.given], [0.0, 0.02, -0.01, 0.001])
    np.testing.assert_allclose(curve.spring_force.sum(axis=1), WEIGHT, rtol=1e-13)
    assert curve.edge_uplift[2] == pytest.approx([2.0 * ARM * 0.02 - WEIGHT / K, -WEIGHT / K], rel=1e-12)
    assert curve.contact_length[2] == pytest.approx(WEIGHT / K / 0.02, rel=1e-12)
    assert curve.contact_length[0] == 2.0 * ARM
    assert not np.signbit(curve.moment[0])


@pytest.mark.parametrize("theta", [0.0005, 0.003, 0.02])
def test_a_bed(theta):
    """With many springs a uniform bed: a triangle of pressure, M = W (B - c/3)."""
    modulus = 500e6
    errors = []
    for n in (50, 200):
        soil = on(rf.winkler_bed(ARM, 1.0, modulus, n=n))
        curve = rf.moment_rotation(base(), [theta], ground=soil)
        moment, heave = answers.bed(theta, WEIGHT, modulus, ARM)
        errors.append(abs(curve.moment[-1] + SLOPE * theta - moment) / moment)
        assert curve.heave[-1] == pytest.approx(heave, rel=0.02)
        length = min(np.sqrt(2.0 * WEIGHT / (modulus * theta)), 2.0 * ARM)
        assert curve.contact_length[-1] == pytest.approx(length, rel=0.02)
        if length < 2.0 * ARM:
            assert curve.soil_pressure[-1, -1] == pytest.approx(
                2.0 * WEIGHT / length, rel=2.0 / n * ARM / length + 0.02
            )
    assert errors[1] < 2e-3
    assert errors[1] < 0.3 * errors[0] or errors[0] < 1e-3


def test_an_eccentric_base_begins_tilted():
    e = 0.2
    ground = on(rf.Springs([-ARM - e, ARM - e], K))
    curve = rf.moment_rotation(base(eccentricity=e), [0.03, -0.03], ground=ground)
    x = np.array([-ARM - e, ARM - e])
    matrix = [[2.0 * K, -K * x.sum()], [-K * x.sum(), K * x @ x - SLOPE]]
    heave, tilt = np.linalg.solve(matrix, [-WEIGHT, 0.0])
    assert (curve.rotation[0], curve.heave[0]) == pytest.approx((tilt, heave), rel=1e-12)
    assert curve.moment[0] == pytest.approx(0.0, abs=1e-9 * WEIGHT)
    right, left = WEIGHT * (ARM - e), -WEIGHT * (ARM + e)
    assert curve.uplift_moments + SLOPE * curve.uplift_rotations == pytest.approx([right, left], rel=1e-12)
    assert not curve.given[0]
    at_rest = rf.moment_rotation(base(eccentricity=e), [curve.rotation[0]], ground=ground)
    assert at_rest.rotation.size == 1


def test_stiff_springs_become_rigid_ground():
    path = [0.02, -0.015, 0.01, 0.0]
    elements = (rf.Tendon(0.6e6, 30e6, 0.2, 0.8e6, 0.02), rf.YieldingDissipator(200e6, 0.3e6, 0.02, -0.4))
    rigid = rf.moment_rotation(base(*elements), path)
    errors = []
    for k in (1e10, 1e11, 1e12):
        curve = rf.moment_rotation(base(*elements), path, ground=on(rf.Springs([-ARM, ARM], k)))
        errors.append(np.abs(curve.element_losses[-1] / rigid.element_losses[-1] - 1.0).max())
        np.testing.assert_allclose(
            curve.moment[curve.given][:3], rigid.moment[rigid.given][:3], rtol=3.0 * WEIGHT / k / 0.01
        )
    assert np.log10(errors[0] / errors[1]) == pytest.approx(1.0, abs=0.05)
    assert errors[2] < 1e-2 * errors[0] * 1.1


def test_a_tendon_is_stretched_from_the_position_at_rest():
    """Both edges loaded: δ = z - z_0 - x (θ - θ_0), and the tendon presses the base on its springs."""
    x = 0.5
    p = base(rf.Tendon(0.5e6, 20e6, x))
    curve = rf.moment_rotation(p, [0.001], ground=TWO)
    stretch = curve.heave - curve.heave[0] - x * (curve.rotation - curve.rotation[0])
    np.testing.assert_allclose(curve.element_elongation[:, 0], stretch, atol=1e-16)
    np.testing.assert_allclose(curve.element_force[:, 0], 0.5e6 + 20e6 * stretch, rtol=1e-13)
    np.testing.assert_allclose(curve.spring_force.sum(axis=1), WEIGHT + curve.element_force[:, 0], rtol=1e-12)


def test_a_rupture_lets_the_base_rise():
    """The element's force is let go at a constant rotation; what it had stored and does meanwhile is lost."""
    fuse = rf.YieldingDissipator(200e6, 0.3e6, 0.0, 0.0, rupture_elongation=0.01)
    curve = rf.moment_rotation(base(fuse), [0.02], ground=TWO)
    (before,) = np.flatnonzero(np.diff(curve.rotation) == 0.0)
    assert curve.element_elongation[before, 0] == pytest.approx(0.01, rel=1e-12)
    np.testing.assert_array_equal(curve.element_force[before + 1 :], 0.0)
    rises = curve.heave[before + 1] - curve.heave[before]
    assert rises == pytest.approx(0.3e6 / K, rel=1e-12)
    work = 0.5 * 0.3e6**2 / 200e6 + 0.3e6 * (0.01 - 0.3e6 / 200e6) + 0.5 * 0.3e6 * rises
    assert curve.element_losses[-1, 0] == pytest.approx(work, rel=1e-12)
    assert np.isnan(curve.plastic_stretch[-1, 0])


def test_dashpots_and_friction_do_not_matter():
    calm = rf.moment_rotation(base(TENDON), [0.02, -0.02], ground=TWO)
    ground = rf.Ground(friction=0.3, springs=rf.Springs([-ARM, ARM], K, 1e7), base_inertia=2e5)
    other = rf.moment_rotation(base(TENDON, rf.ViscousDamper(1e6, 0.3)), [0.02, -0.02], ground=lambda _: ground)
    np.testing.assert_array_equal(other.moment, calm.moment)
    np.testing.assert_array_equal(other.element_force[:, 1], 0.0)


# --- against independent computations ---------------------------------------------------------------------------------

FORCES = st.floats(0.05e6, 0.4e6)
PLACES = st.floats(-1.2, 1.2).map(lambda x: round(x, 3))
FUSES = st.builds(rf.YieldingDissipator, st.floats(20e6, 2e9), FORCES, st.floats(0.0, 0.05), PLACES)
ONE_WAY = st.builds(
    lambda k, f, x: rf.YieldingDissipator(k, f, 0.0, x, tension_only=True), st.floats(20e6, 1e9), FORCES, PLACES
)
TENDONS = st.builds(rf.Tendon, FORCES, st.floats(1e6, 50e6), PLACES)
ELEMENTS = st.lists(st.one_of(FUSES, ONE_WAY, TENDONS), max_size=3)
PATHS = st.lists(st.floats(-0.03, 0.03).map(lambda x: round(x, 5) + 0.0), min_size=1, max_size=5)
BEDS = st.integers(0, 8).flatmap(
    lambda n: st.tuples(
        st.lists(st.floats(-1.19, 1.19).map(lambda x: round(x, 2)), min_size=n, max_size=n, unique=True),
        st.lists(st.floats(1e8, 3e9), min_size=n + 2, max_size=n + 2),
    )
)


def bed_of(drawn):
    inner, stiffness = drawn
    return rf.Springs(sorted([-ARM, *inner, ARM]), stiffness)


def tension_of(each, stretch, plastic):
    """Tension and plastic stretch after a return mapping."""
    if isinstance(each, rf.Tendon):
        return max(each.initial_force + each.stiffness * stretch, 0.0), 0.0
    limit = each.yield_force / each.stiffness
    lowest = 0.0 if each.tension_only else -limit
    trial = stretch - plastic
    if trial > limit:
        plastic = stretch - limit
    elif trial < lowest and not each.tension_only:
        plastic = stretch + limit
    a, k = each.post_yield_ratio, each.stiffness
    force = a * k * stretch + (1.0 - a) * k * (stretch - plastic)
    return (max(force, 0.0) if each.tension_only else force), plastic


@example(elements=[rf.Tendon(5e4, 5333306.0, -1.0)], bed=([], [1e8, 1e8]), path=[-0.01562])  # slack on the way
@given(elements=ELEMENTS, bed=BEDS, path=PATHS)
def test_every_point_is_in_equilibrium(elements, bed, path):
    """At each point SciPy finds the heave, with forces by return mapping, which is exact between the points."""
    springs = bed_of(bed)
    curve = rf.moment_rotation(base(*elements), path, ground=on(springs))
    first = curve.heave[0] - springs.positions * curve.rotation[0]
    plastic = [0.0] * len(elements)
    x0, z0 = curve.rotation[0], curve.heave[0]
    assert (first < 0.0).any()
    for k in range(curve.rotation.size):
        theta = curve.rotation[k]

        def stretch(each, z, theta=theta):
            return z - z0 - each.position * (theta - x0)

        def unbalanced(z, theta=theta, stretch=stretch, plastic=tuple(plastic)):
            up = springs.stiffness @ np.maximum(springs.positions * theta - z, 0.0)
            down = sum(tension_of(each, stretch(each, z), m)[0] for each, m in zip(elements, plastic, strict=True))
            return up - WEIGHT - down

        z = brentq(unbalanced, -1.0, 1.0, xtol=1e-18, rtol=1e-15)
        assert curve.heave[k] == pytest.approx(z, abs=1e-12)
        found = [tension_of(each, stretch(each, z), m) for each, m in zip(elements, plastic, strict=True)]
        plastic = [m for _, m in found]
        forces = np.maximum(springs.positions * theta - z, 0.0) * springs.stiffness
        np.testing.assert_allclose(curve.spring_force[k], forces, atol=1e-9 * WEIGHT)
        moment = springs.positions @ forces - SLOPE * theta
        moment -= sum(each.position * force for each, (force, _) in zip(elements, found, strict=True))
        assert curve.moment[k] == pytest.approx(moment, abs=1e-8 * WEIGHT)
    np.testing.assert_array_equal(curve.rotation[curve.given], path)


@given(elements=ELEMENTS, bed=BEDS, path=PATHS)
def test_the_work_of_the_moment_is_stored_or_dissipated(elements, bed, path):
    springs = bed_of(bed)
    curve = rf.moment_rotation(base(*elements), path, ground=on(springs))
    stored = 0.5 * (curve.spring_force**2 / springs.stiffness).sum(axis=1)
    stored += WEIGHT * curve.heave - 0.5 * SLOPE * curve.rotation**2
    work = np.zeros(curve.rotation.size)
    steps = 0.5 * (curve.element_force[1:] + curve.element_force[:-1]) * np.diff(curve.element_elongation, axis=0)
    work[1:] = np.cumsum(steps.sum(axis=1))
    scale = np.abs(curve.work).max() + WEIGHT * 1e-3
    np.testing.assert_allclose(curve.work, stored - stored[0] + work, atol=1e-9 * scale)
    assert np.diff(curve.dissipated_energy).min(initial=0.0) >= -1e-9 * scale


@given(elements=ELEMENTS, bed=BEDS, path=PATHS, count=st.integers(2, 7))
def test_samples_in_between_change_nothing(elements, bed, path, count):
    ground = on(bed_of(bed))
    turns = rf.moment_rotation(base(*elements), path, ground=ground)
    spans = [np.linspace(a, b, count)[1:] for a, b in zip([turns.rotation[0], *path[:-1]], path, strict=True)]
    fine = rf.moment_rotation(base(*elements), np.concatenate(spans), ground=ground)
    assert fine.moment[-1] == pytest.approx(turns.moment[-1], abs=1e-9 * WEIGHT)
    assert np.abs(fine.moment).max() == pytest.approx(np.abs(turns.moment).max(), abs=1e-9 * WEIGHT)


def test_a_slow_run_follows_the_curve():
    """A base that is pushed slowly by the ground rotates as the curve says, with the tension it says."""
    p = base(rf.Tendon(0.3e6, 20e6, 0.3))
    ground = on(rf.Springs([-ARM, 0.0, ARM], K, 4e7))
    ramp = np.concatenate((np.linspace(0.0, 1.3, 401), np.full(3000, 1.3)))
    run = rf.simulate(p, rf.GroundMotion(-ramp, 0.01), "rigid", ground=ground)
    curve = rf.moment_rotation(p, [run.rotation[-1]], ground=ground)
    assert curve.uplift_rotations.size == 1
    assert curve.moment[-1] == pytest.approx(p.l0r * 1.3, rel=1e-7)
    assert curve.element_force[-1] == pytest.approx(run.element_force[-1], rel=1e-7)
    assert curve.heave[-1] == pytest.approx(run.heave[-1], rel=1e-7)


# --- the value --------------------------------------------------------------------------------------------------------


def test_the_path_as_a_table():
    curve = rf.moment_rotation(base(TENDON), [0.02], ground=TWO)
    table = curve.to_frame()
    assert list(table) == [
        "rotation", "moment", "heave", "left_uplift", "right_uplift", "contact_length", "given", "spring_force_1",
        "spring_force_2", "element_force_1", "element_elongation_1", "plastic_stretch_1", "element_losses_1",
    ]  # fmt: skip
    np.testing.assert_array_equal(table[["left_uplift", "right_uplift"]], curve.edge_uplift)
    assert repr(curve).startswith("MomentRotationOnSprings(3 points, 2 springs, 1 element, |θ| up to 0.02 rad, |M| up")
    assert pickle.loads(pickle.dumps(curve)) == curve


def test_springs_without_area_have_no_pressure():
    curve = rf.moment_rotation(base(), [0.02], ground=TWO)
    assert not hasattr(curve, "soil_pressure")
    with pytest.raises(rf.InputError, match=r"^The springs under the base have no area, so there is no soil"):
        _ = curve.soil_pressure


def test_a_ground_without_springs_is_refused():
    with pytest.raises(rf.InputError) as caught:
        rf.moment_rotation(base(), [0.02], ground=rf.Ground(friction=0.4))
    assert str(caught.value).startswith("ground must have springs, but one with friction alone was given. A base")
    assert caught.value.field == "ground"


@pytest.mark.parametrize(
    ("structure", "ground", "message"),
    [
        (base(), 3.0, "ground must be a Ground, a function of RockingProperties that returns one, or None"),
        (base(), on(rf.Springs([-2.0, 2.0], K)), "The springs must be under the base, which reaches from -1.2 to 1.2"),
        (base(), on(rf.Springs([-ARM, ARM], 1e6)), "The springs are too soft: the structure falls over"),
        (base(rf.FrictionDamper(1e5)), TWO, "No model has friction dampers under a base that stands on springs."),
    ],
)
def test_bad_input_is_explained(structure, ground, message):
    with pytest.raises(rf.InputError) as caught:
        rf.moment_rotation(structure, [0.02], ground=ground)
    assert str(caught.value).startswith(message)
