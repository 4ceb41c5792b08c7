"""Uplifted modes against closed forms, determinants and a rotating beam of many masses."""

import dataclasses
import math

import numpy as np
import pytest
import scipy.linalg
import scipy.optimize

import rockflex as rf
from builders import make_frame
from rockflex import InputError


def frame(stiffness_ratio=math.inf, aspect_ratio=10.0, n=15, period=1.0):
    return make_frame(n_stories=n, stiffness_ratio=stiffness_ratio, period=period, aspect_ratio=aspect_ratio).rocking()


def test_one_mode_in_closed_form():
    p = frame().truncated(1)
    inertia, gravity = p.effective_mass[0] * p.effective_height[0] ** 2, p.l0r * 9.81
    # (I - m*h*²) ω⁴ - (I ω_1² - L g) ω² - L g ω_1² = 0
    a, b, c = p.i_theta - inertia, -(p.i_theta * p.omega[0] ** 2 - gravity), -gravity * p.omega[0] ** 2
    root = math.sqrt(b**2 - 4.0 * a * c)
    modes = rf.uplifted_modes(p)
    assert modes.omega[0] == pytest.approx(math.sqrt((-b + root) / (2.0 * a)), rel=1e-13)
    assert modes.growth_rate == pytest.approx(math.sqrt((b + root) / (2.0 * a)), rel=1e-11)
    assert modes.ratio[0] == pytest.approx(modes.omega[0] / p.omega[0], rel=1e-15)


@pytest.mark.parametrize("stiffness_ratio", [0.0, math.inf])
@pytest.mark.parametrize("n_modes", [1, 2, 5, None])
def test_motions_meet_the_equations(stiffness_ratio, n_modes):
    p = frame(stiffness_ratio)
    p = p if n_modes is None else p.truncated(n_modes)
    modes = rf.uplifted_modes(frame(stiffness_ratio), n_modes)
    # Eq. 23 as it stands, rows of D_n not scaled.
    mass = np.eye(p.n_modes + 1)
    mass[0, 0], mass[0, 1:], mass[1:, 0] = p.i_theta, p.effective_mass * p.effective_height, p.effective_height
    stiffness = np.diag([-p.l0r * 9.81, *p.omega**2])
    motions = [*zip(modes.omega**2, modes.shapes.T, strict=True), (-(modes.growth_rate**2), modes.growth_shape)]
    for square, motion in motions:
        left, right = stiffness @ motion, square * mass @ motion
        scale = np.abs(stiffness) @ np.abs(motion) + abs(square) * np.abs(mass) @ np.abs(motion)
        assert (np.abs(left - right) <= 1e-12 * scale).all()
    # The smallest root of a graded pencil keeps fewer digits.
    values = np.sort(scipy.linalg.eigvals(stiffness, mass).real)
    np.testing.assert_allclose(modes.omega**2, values[1:], rtol=1e-7)
    np.testing.assert_allclose(np.abs(modes.shapes[1:]).sum(axis=0), 1.0, rtol=1e-12)
    assert modes.growth_shape[0] == 1.0
    assert modes.shapes.shape == (p.n_modes + 1, p.n_modes)


@pytest.mark.parametrize("n_modes", [1, 2, 15])
@pytest.mark.parametrize("stiffness_ratio", [0.0, math.inf])
def test_zeros_of_the_frequency_equation(stiffness_ratio, n_modes):
    p = frame(stiffness_ratio).truncated(n_modes)
    zeros = []
    for low, high in zip(p.omega, [*p.omega[1:], 10.0 * p.omega[-1]], strict=True):
        ends = low * (1.0 + 1e-9), high * (1.0 - 1e-9)
        zeros.append(scipy.optimize.brentq(lambda w: float(rf.frequency_equation(p, w)), *ends, xtol=1e-13))
    np.testing.assert_allclose(rf.uplifted_modes(p).omega, zeros, rtol=1e-11)


def test_frequency_equation_by_hand():
    p = rf.RockingProperties(
        omega=[2.0, 5.0],
        effective_mass=[3.0, 1.0],
        effective_height=[4.0, -2.0],
        top_ordinate=[1.0, 0.1],
        i_theta=100.0,
        l0r=20.0,
        m_tot=10.0,
        half_width=1.0,
        zeta=0.0,
    )
    # -20 g - 9·100 - 81·48/(4 - 9) - 81·4/(25 - 9)
    assert float(rf.frequency_equation(p, 3.0)) == pytest.approx(-196.2 - 900.0 + 777.6 - 20.25, rel=1e-14)
    found = rf.frequency_equation(p, [[0.0, 2.0], [5.0, 3.0]])
    assert found.shape == (2, 2)
    assert found[0, 0] == pytest.approx(-196.2)
    assert np.isnan([found[0, 1], found[1, 0]]).all()


def test_a_rigid_structure_has_the_growth_alone():
    p = frame().truncated(0)
    modes = rf.uplifted_modes(p)
    assert modes.omega.size == modes.ratio.size == 0
    assert modes.growth_rate == pytest.approx(math.sqrt(p.l0r * 9.81 / p.i_theta), rel=1e-14)


def test_stiff_structures_feel_no_gravity():
    # ω_1 against √(g/h): as T_1 → 0 the root is that without gravity.
    p = frame(period=1e-3).truncated(1)
    without = 1.0 / math.sqrt(1.0 - p.effective_mass[0] * p.effective_height[0] ** 2 / p.i_theta)
    assert rf.uplifted_modes(p).ratio[0] == pytest.approx(without, rel=1e-7)
    soft = frame(period=1.0).truncated(1)
    assert rf.uplifted_modes(soft).ratio[0] < without


def test_wide_bases_do_not_change_the_modes():
    modes = rf.uplifted_modes(frame(aspect_ratio=1e-4))
    np.testing.assert_allclose(modes.ratio, 1.0, rtol=1e-6)


def test_arrays_are_read_only():
    modes = rf.uplifted_modes(frame())
    with pytest.raises(ValueError, match="read-only"):
        modes.omega[0] = 1.0
    with pytest.raises(ValueError, match="read-only"):
        modes.growth_shape[0] = 2.0


def test_more_modes_than_there_are():
    with pytest.raises(InputError, match="n_modes must be a whole number from 0 to 15, but 16 was given"):
        rf.uplifted_modes(frame(), 16)


@pytest.mark.parametrize("spring", [0.0, 0.3, 40.0])
def test_pinned_beam_in_shear_solves_its_equation(spring):
    # A beam in shear that turns by θ: tan λ = (1 + κ) λ.
    found = rf.pinned_beam("shear", spring, 4)
    roots = found.roots if spring else found.roots[1:]
    np.testing.assert_allclose(np.sin(roots), (1.0 + spring) * roots * np.cos(roots), atol=1e-11)
    assert found.roots.size == 5


@pytest.mark.parametrize("spring", [0.0, 1e-3, 0.3, 40.0, 1e4])
def test_pinned_beam_in_flexure_solves_its_equation(spring):
    def left(x):
        a, b, c, d = math.cos(x), math.sin(x), math.cosh(x), math.sinh(x)
        # w = A cos + B sin + C cosh + D sinh: w(0), EI w''(0) = k w'(0), w''(1), w'''(1)
        rows = [
            [1.0, 0.0, 1.0, 0.0],
            [-x, -spring, x, -spring],
            [-a, -b, c, d],
            [b, -a, d, c],
        ]
        return np.linalg.det(np.array(rows) / np.array([[1.0], [max(x, spring)], [c], [c]]))

    found = rf.pinned_beam("flexure", spring, 3)
    for root in found.roots if spring else found.roots[1:]:
        assert abs(left(root)) < 1e-12 * max(1.0, 1.0 / root)
        assert left(root * (1.0 - 1e-6)) * left(root * (1.0 + 1e-6)) < 0.0


def test_pinned_beam_limits():
    flexure, shear = rf.pinned_beam("flexure"), rf.pinned_beam("shear")
    assert flexure.roots[1] == pytest.approx(3.9266, abs=5e-5)
    np.testing.assert_allclose(flexure.ratio, [4.385, 2.268], atol=5e-4)
    np.testing.assert_allclose(shear.roots[1:], [4.493409, 7.725252], atol=1e-6)
    assert flexure.rotation_ratio == shear.rotation_ratio == 0.0
    for behaviour in ("flexure", "shear"):
        stiff = rf.pinned_beam(behaviour, 1e9, 3)
        clamped = {"flexure": [1.875104, 4.694091, 7.854757, 10.995541], "shear": np.arange(0.5, 4.0) * math.pi}
        np.testing.assert_allclose(stiff.roots, clamped[behaviour], rtol=1e-6)
        assert stiff.rotation_ratio == pytest.approx(1.0, abs=1e-6)


def test_soft_spring_is_a_rigid_bar_on_it():
    # ω² = k_r/(m L³/3)
    assert rf.pinned_beam("flexure", 1e-5).roots[0] == pytest.approx((3e-5) ** 0.25, rel=1e-5)
    assert rf.pinned_beam("shear", 1e-5).roots[0] == pytest.approx(math.sqrt(3e-5), rel=1e-5)


def test_pinned_beam_from_beam_elements():
    """The same spring under a beam of finite elements, as a soft lowest piece of no length to speak of."""
    kappa, length, ei, mass = 2.0, 30.0, 4e9, 800.0
    hinge = 1e-3  # m; EI_hinge/hinge = k_r
    soft = kappa * ei / length * hinge
    beam = rf.Beam(
        height=length + hinge,
        mass=mass,
        bending_stiffness=([0.0, hinge, hinge, length + hinge], [soft, soft, ei, ei]),
        half_width=1.0,
        damping_ratio=0.0,
    )
    roots = np.sqrt(beam.modal(3).omega / math.sqrt(ei / mass)) * length
    np.testing.assert_allclose(roots, rf.pinned_beam("flexure", kappa, 2).roots, rtol=1e-4)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("bending",), 'behaviour must be "flexure" or "shear", but \'bending\' was given'),
        (("shear", -1.0), r"spring must be a zero or positive, finite number in k_r L/EI \(flexure\) or"),
        (("shear", 0.0, 0), "n_modes must be a whole number from 1 to 200, but 0 was given"),
    ],
)
def test_pinned_beam_refused(arguments, words):
    with pytest.raises(InputError, match=words):
        rf.pinned_beam(*arguments)


@pytest.mark.parametrize("n_modes", [1, 3, 15])
@pytest.mark.parametrize("side", [1, -1])
def test_each_side_of_an_eccentric_base_is_a_concentric_base_of_its_arm(side, n_modes):
    tendons = [rf.Tendon(1e5, 2e7, -1.0), rf.Tendon(1e5, 1e7, 0.3)]
    p = dataclasses.replace(frame(), eccentricity=0.7, elements=tendons)
    arm = p.half_width - side * 0.7
    # One tendon in the middle of a base as narrow, with the same stiffness about its edges.
    stiffness = sum(each.stiffness * (side * arm - each.position) ** 2 for each in tendons)
    same = dataclasses.replace(frame().with_half_width(arm), elements=rf.Tendon(0.0, stiffness / arm**2))
    one, other = rf.uplifted_modes(p, n_modes, side=side), rf.uplifted_modes(same, n_modes)
    np.testing.assert_allclose(one.omega, other.omega, rtol=1e-12)
    np.testing.assert_allclose(one.damping_ratio, other.damping_ratio, rtol=1e-9)
    np.testing.assert_allclose(one.shapes, other.shapes, rtol=1e-8, atol=1e-12)
    assert one.growth_rate == pytest.approx(other.growth_rate, rel=1e-10)
    omega = np.linspace(0.1, 60.0, 9)
    mine = rf.frequency_equation(p, omega, side=side)
    np.testing.assert_allclose(mine, rf.frequency_equation(same, omega), rtol=1e-9)


def test_without_a_side_it_is_the_pivot_that_lifts_first():
    p = dataclasses.replace(frame(), eccentricity=-0.5)
    assert rf.uplifted_modes(p) == rf.uplifted_modes(p, side=-1) != rf.uplifted_modes(p, side=1)
    assert rf.frequency_equation(p, 3.0) == rf.frequency_equation(p, 3.0, side=-1)
    assert rf.uplifted_modes(frame(), side=-1) == rf.uplifted_modes(frame())
    with pytest.raises(InputError, match=r"side must be 1 \(right edge of the base\) or -1 \(left edge\), but 0"):
        rf.uplifted_modes(p, side=0)
