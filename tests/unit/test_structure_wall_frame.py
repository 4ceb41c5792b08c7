"""The coupled beam against its differential equation, both limits, and what its modes must add up to."""

import math

import numpy as np
import pytest
import scipy.linalg
import scipy.optimize

import rockflex as rf

GOOD = {
    "height": 45.0,
    "mass": 2e6,
    "stiffness_parameter": 4.0,
    "base_mass": 1e5,
    "period": 1.2,
    "aspect_ratio": 8.0,
    "damping_ratio": 0.05,
}


def wall_frame(**changes):
    return rf.WallFrame(**(GOOD | changes))


@pytest.mark.slow
@pytest.mark.parametrize("alpha", [0.3, 2.0, 6.0, 15.0])
def test_frequencies_solve_the_differential_equation(alpha):
    omega = wall_frame(stiffness_parameter=alpha).modal().omega

    def free_top(square):
        # u'''' = α² u'' + ω² u; clamped below; u'' and u''' - α² u' vanish at the top
        rates = np.diag([1.0, 1.0, 1.0], k=1)
        rates[3, 0], rates[3, 2] = square, alpha**2
        state = scipy.linalg.expm(rates)[:, 2:]
        return np.linalg.det([state[2], state[3] - alpha**2 * state[1]])

    squares = np.linspace(1.0, 900.0, 600) ** 2 / 20.0
    signs = np.sign([free_top(s) for s in squares])
    at = np.flatnonzero(signs[1:] != signs[:-1])[:4]
    found = np.sqrt([scipy.optimize.brentq(free_top, squares[i], squares[i + 1], rtol=1e-13) for i in at])
    np.testing.assert_allclose(omega[: found.size] / omega[0], found / found[0], rtol=1e-7)
    assert found.size >= 3


def test_no_frame_is_a_cantilever():
    wall = wall_frame(stiffness_parameter=0.0).rocking()
    beam = rf.Beam(height=45.0, mass=2e6 / 45.0, bending_stiffness=1e10, half_width=1.0, damping_ratio=0.0).rocking()
    np.testing.assert_allclose(wall.omega / wall.omega[0], beam.omega / beam.omega[0], rtol=1e-8)
    for name in ("effective_mass", "effective_height", "top_ordinate"):
        np.testing.assert_allclose(getattr(wall, name), getattr(beam, name), rtol=1e-7)
    stations = np.abs(wall.floors.displacement - beam.floors.displacement).max(axis=0)
    assert (stations < 1e-7).all()


@pytest.mark.parametrize(("alpha", "room"), [(math.inf, 1e-12), (1e4, 5e-4), (1e6, 5e-6)])
def test_no_wall_is_a_shear_beam(alpha, room):
    modes = wall_frame(stiffness_parameter=alpha).modal()
    number = 2.0 * np.arange(1, 6) - 1.0
    np.testing.assert_allclose(modes.omega / modes.omega[0], number, rtol=room)
    root = number * math.pi / 2.0
    np.testing.assert_allclose(modes.effective_mass / 2e6, 2.0 / root**2, rtol=10.0 * room)
    np.testing.assert_allclose(modes.effective_height / 45.0, np.sin(root) / root, rtol=10.0 * room)


@pytest.mark.parametrize("alpha", [0.0, 3.0, 60.0, math.inf])
def test_many_modes_carry_the_whole_mass(alpha):
    props = wall_frame(stiffness_parameter=alpha, n_modes=80).rocking()
    assert props.effective_mass.sum() == pytest.approx(2e6, rel=0.01)
    assert props.effective_mass @ props.effective_height == pytest.approx(props.l0r, rel=1e-3)
    assert props.effective_mass @ props.effective_height**2 == pytest.approx(2e6 * 45.0**2 / 3.0, rel=1e-4)


@pytest.mark.parametrize("alpha", [0.0, 5.0, 700.0, math.inf])
def test_modes_are_orthogonal_and_free_of_overflow(alpha):
    floors = wall_frame(stiffness_parameter=alpha, n_modes=8).rocking().floors
    assert np.isfinite(floors.displacement).all()
    np.testing.assert_allclose(floors.displacement[0], 0.0, atol=1e-12)


def test_scaled_to_period_and_width():
    structure = wall_frame()
    props = structure.rocking()
    assert 2.0 * math.pi / props.omega[0] == pytest.approx(1.2, rel=1e-14)
    assert props.effective_height[0] / props.half_width == pytest.approx(8.0, rel=1e-14)
    assert props.m_tot == 2.1e6
    assert props.l0r == 2e6 * 22.5
    assert props.i_theta == pytest.approx(2e6 * 45.0**2 / 3.0 + 2.1e6 * structure.half_width**2, rel=1e-14)
    np.testing.assert_allclose(props.floors.force.sum(axis=0), props.effective_mass * props.omega**2, rtol=1e-10)
    assert structure.modal(2).n_modes == structure.rocking(2).n_modes == 2
