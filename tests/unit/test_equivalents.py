"""The equivalents against a finely lumped cantilever, quadrature, and the ratios that they are made from."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024._equivalents import _five_masses_of_s1, modes_of_tipped_cantilever

G = 9.81


def lumped_column(tip, parts=400):
    """Uniform column in equal pieces, masses at their middles and the tip; flexibility of a cantilever, EI = 1."""
    x = np.append((np.arange(parts) + 0.5) / parts, 1.0)
    masses = np.append(np.full(parts, 1.0 / parts), tip)
    low, high = np.minimum.outer(x, x), np.maximum.outer(x, x)
    flexibility = low**2 * (3.0 * high - low) / 6.0
    root = np.sqrt(masses)
    values, vectors = np.linalg.eigh(root[:, None] * flexibility * root)
    order = np.argsort(values)[::-1][:3]
    shapes = vectors[:, order] / root[:, None]
    excitation, moment = masses @ shapes, (masses * x) @ shapes
    return values[order] ** -0.5, excitation**2 / masses.sum(), moment / excitation, excitation * shapes[-1]


@pytest.mark.slow
@pytest.mark.parametrize("tip", [0.5, 5.0])
def test_the_cantilever_with_a_tip_mass_is_the_limit_of_many_masses(tip):
    roots, mass, height, top = modes_of_tipped_cantilever(tip, 3)
    omega, *others = lumped_column(tip)
    np.testing.assert_allclose(roots**2, omega, rtol=2e-4)
    for found, expected in zip((mass, height, top), others, strict=True):
        np.testing.assert_allclose(found, expected, rtol=2e-3)


def test_the_cantilever_without_a_tip_mass_is_the_textbook_s():
    roots, mass, height, _ = modes_of_tipped_cantilever(0.0, 5)
    np.testing.assert_allclose(roots[:3], [1.875104, 4.694091, 7.854757], rtol=1e-6)
    np.testing.assert_allclose(mass[:2], [0.6131, 0.1883], atol=1e-4)
    assert height[0] == pytest.approx(0.7265, abs=1e-4)
    assert np.sum(modes_of_tipped_cantilever(3.0, 5)[1]) < 1.0


def test_two_hz_meets_its_ratios():
    p = rf.equivalent_2hz_long_base(0.1, 0.01)
    assert 2 * math.pi / p.omega[0] == pytest.approx(0.5, rel=1e-12)
    above = p.m_tot / 1.1
    assert p.effective_mass[0] / above == pytest.approx(0.92, rel=1e-9)
    assert round(p.effective_mass[0] * p.effective_height[0] / p.l0r, 2) == 0.98
    assert p.half_width / p.effective_height[0] == pytest.approx(0.16, rel=1e-12)
    assert p.effective_height[0] == pytest.approx(0.888, abs=1e-3)
    # What the simplified resisting moment lacks when the base lifts.
    lifting = p.resisting_moment / (p.effective_mass[0] * p.effective_height[0] * p.omega[0] ** 2)
    assert p.effective_mass[0] * lifting / (p.m_tot * p.half_width) == pytest.approx(0.07, rel=1e-9)


def test_two_hz_is_a_column_with_a_point_at_its_tip():
    """L_0^r and Σ m h² give the column's share c and its length; many small masses then give the modes."""
    p = rf.equivalent_2hz_long_base(0.3, 0.01, n_modes=5)
    inertia = p.i_theta - 1.3 * p.half_width**2

    def missing(c):
        return (1 - 2 * c / 3) * (p.l0r / (1 - c / 2)) ** 2 - inertia

    share = brentq(missing, 0.01, 0.9)
    length = p.l0r / (1 - share / 2)
    omega, mass, height, top = lumped_column((1 - share) / share)
    np.testing.assert_allclose(p.omega[:3] / p.omega[0], omega / omega[0], rtol=5e-4)
    np.testing.assert_allclose(p.effective_mass[:3], mass, rtol=2e-3)
    np.testing.assert_allclose(p.effective_height[:3], length * height, rtol=2e-3)
    np.testing.assert_allclose(p.top_ordinate[:3], top, rtol=5e-3)
    assert p.n_modes == 5
    assert 0.9999 < float(np.sum(p.effective_mass * p.effective_height**2)) / p.translational_inertia < 1.0


def test_the_base_of_two_hz_was_light():
    pulse = rf.ricker_pulse(0.1 * G, 0.5)
    heavy = rf.simulate(rf.equivalent_2hz_long_base(1.0, 0.02), pulse, "2DOF-S", output="peaks")
    light = rf.simulate(rf.equivalent_2hz_long_base(0.1, 0.02), pulse, "2DOF-S", output="peaks")
    assert (heavy.status, light.status) == ("no_uplift", "rocking")


@pytest.mark.parametrize("spacing", [1.25, 1.5, 1.69])
def test_s1_meets_its_ratios(spacing):
    p = rf.equivalent_s1(0.4, [0.01, 0.02, 0.02, 0.02, 0.02], 0.2, 0.7, spacing)
    assert 2 * math.pi / p.omega[0] == pytest.approx(0.11, rel=1e-12)
    assert p.m_tot == pytest.approx(1.4, rel=1e-12)
    assert p.effective_mass[0] == pytest.approx(0.48, rel=1e-9)
    assert p.effective_mass[0] * p.effective_height[0] / p.l0r == pytest.approx(0.87, rel=1e-9)
    assert p.effective_height[0] == pytest.approx(0.7, rel=1e-12)
    assert p.half_width == pytest.approx(0.14, rel=1e-12)
    assert p.effective_mass.sum() == pytest.approx(1.0, rel=1e-9)
    heights, masses = _five_masses_of_s1(spacing)
    assert masses.min() > 0.0
    assert np.ptp(masses[1:4]) == 0.0
    assert np.all(np.diff(heights) > 0.0)


def test_s1_with_other_spacing_is_another_structure():
    ratios = []
    for spacing in (1.3, 1.6):
        p = rf.equivalent_s1(0.4, 0.01, 0.2, 0.7, spacing)
        ratios.append(p.omega[1] / p.omega[0])
    assert ratios[0] > 1.05 * ratios[1] or ratios[1] > 1.05 * ratios[0]


def test_masses_do_not_matter():
    """Scaled masses and inertia leave the response of every model as it is."""
    p = rf.equivalent_s1(0.4, 0.02, 0.2, 0.7)
    k = 250.0
    heavy = rf.RockingProperties(
        p.omega, k * p.effective_mass, p.effective_height, p.top_ordinate, k * p.i_theta, k * p.l0r, k * p.m_tot,
        p.half_width, p.zeta,
    )  # fmt: skip
    start = rf.InitialState(rotation=0.05)
    for model in ("2DOF-C", "MDOF-S"):
        one, other = (
            rf.simulate(each, rf.quiet_motion(0.6, 0.01), model, output="peaks", initial=start) for each in (p, heavy)
        )
        assert one.max_top_displacement == pytest.approx(other.max_top_displacement, rel=1e-7)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: rf.equivalent_2hz_long_base(-0.1, 0.01), "base_mass_ratio must be a zero or positive"),
        (lambda: rf.equivalent_2hz_long_base(0.1, 2.0), "damping_ratio must lie in"),
        (lambda: rf.equivalent_2hz_long_base(0.1, 0.01, 6), "n_modes must be a whole number from 1 to 5, but 6"),
        (lambda: rf.equivalent_s1(0.1, 0.01, 0.2, 0.0), "effective_height must be a positive"),
        (lambda: rf.equivalent_s1(0.1, 0.01, -1.0, 0.5), "width_ratio must be a positive"),
        (lambda: rf.equivalent_s1(-1.0, 0.01, 0.2, 0.5), "base_mass_ratio must be a zero or positive"),
        (lambda: rf.equivalent_s1(0.1, 0.01, 0.2, 0.5, 1.0), "spacing must lie in"),
    ],
)
def test_what_makes_no_equivalent_is_named(make, said):
    with pytest.raises(rf.InputError, match=said):
        make()


def test_the_block_is_homogeneous():
    alpha, r, mass = 0.3, 1.7, 40.0
    p = rf.rigid_block(alpha, r, mass)
    b, h = r * math.sin(alpha), r * math.cos(alpha)
    density = mass / (4 * b * h)
    inertia = density * quad(lambda x: quad(lambda y: x**2 + y**2, 0.0, 2 * h)[0], 0.0, 2 * b)[0]
    assert p.i_theta == pytest.approx(inertia, rel=1e-12)
    assert (p.half_width, p.l0r, p.m_tot, p.n_modes) == (pytest.approx(b), pytest.approx(mass * h), mass, 0)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            (0.0, 1.0),
            "slenderness must be above 0 and below π/2 = 1.5708 rad, but 0.0 was given. It is atan(b/h) of the half "
            "sides.",
        ),
        (
            (2.0, 1.0),
            "slenderness must be above 0 and below π/2 = 1.5708 rad, but 2.0 was given. It is atan(b/h) of the half "
            "sides. An aspect ratio h/b of 2 is 0.4636 rad.",
        ),
        ((0.2, 0.0), "half_diagonal must be a positive, finite number in m, but 0.0 was given."),
        ((0.2, 1.0, -1.0), "mass must be a positive, finite number in kg, but -1.0 was given."),
    ],
)
def test_what_makes_no_block_is_named(arguments, message):
    with pytest.raises(rf.InputError) as caught:
        rf.rigid_block(*arguments)
    assert str(caught.value) == message
