"""The chimney of Section 4.1.1: Table 3, Eqs. 33-35, its finite element values and its responses, from its geometry.

Two printed finite element values do not reproduce: ω_1 = 1.678 rad/s (1.6557 here; the paper's own Ritz value is 1.66)
and h*_2 = 50.02 m (51.319 here). In Table 3, h*_2 = 51.33 m misses by 0.012 m. None is tuned to.
"""

import math

import numpy as np
import pytest

import rockflex as rf

CHIMNEY = {
    "height": 200.0,
    "base_radius": 8.0,
    "top_radius": 4.0,
    "wall": 1.0,
    "density": 2400.0,
    "elastic_modulus": 25e9,
    "damping_ratio": 0.02,
}
MASS_FACTOR = math.pi * 2400.0

OMEGA = (1.66, 7.76, 19.94, 38.14, 62.74)
MASS = (8.48, 3.32, 1.39, 0.75, 0.52)
HEIGHT = (141.63, 51.33, 31.40, 22.51, 17.25)
GAMMA = (1.73, -1.19, 0.81, -0.60, 0.47)


@pytest.fixture(scope="module")
def ritz() -> rf.RockingProperties:
    return rf.TaperedTower(**CHIMNEY).rocking()


@pytest.fixture(scope="module")
def elements() -> rf.RockingProperties:
    return rf.TaperedTower(**CHIMNEY, method="fe").rocking()


def test_table_3_within_one_unit_of_the_last_digit(ritz: rf.RockingProperties) -> None:
    # The table rounds some values and truncates others.
    misses = np.array(
        [
            ritz.omega - OMEGA,
            ritz.effective_mass / 1e6 - MASS,
            ritz.effective_height - HEIGHT,
            ritz.top_ordinate - GAMMA,
        ]
    )
    print("Table 3, computed less printed (ω, m*, h*, Γ):\n", misses.round(4))
    reproduced = np.abs(misses) <= 0.0100001
    assert np.argwhere(~reproduced).tolist() == [[2, 1]]


def test_printed_second_height_of_table_3_misses(ritz: rf.RockingProperties) -> None:
    assert ritz.effective_height[1] - 51.33 == pytest.approx(0.012, abs=5e-4)


def test_ritz_to_all_known_digits(ritz: rf.RockingProperties) -> None:
    np.testing.assert_allclose(ritz.omega, [1.6557, 7.7574, 19.9423, 38.1428, 62.7468], atol=5.1e-5)
    np.testing.assert_allclose(ritz.effective_mass / 1e6, [8.4807, 3.3219, 1.3917, 0.7453, 0.5253], atol=5.1e-5)
    np.testing.assert_allclose(ritz.effective_height, [141.633, 51.342, 31.408, 22.519, 17.256], atol=5.1e-4)
    np.testing.assert_allclose(ritz.top_ordinate, [1.7256, -1.1898, 0.8110, -0.6040, 0.4703], atol=5.1e-5)


def test_finite_elements_to_five_digits(elements: rf.RockingProperties) -> None:
    print("finite elements:", elements.omega, elements.effective_mass, elements.effective_height, elements.top_ordinate)
    np.testing.assert_allclose(elements.omega, [1.6557, 7.7536, 19.8622, 37.9199, 61.9811], rtol=1e-5 * 2.0)
    np.testing.assert_allclose(elements.effective_mass / 1e6, [8.4804, 3.3272, 1.4215, 0.7800, 0.4889], atol=1.01e-4)
    np.testing.assert_allclose(elements.effective_height, [141.634, 51.319, 31.217, 22.205, 17.205], atol=1.01e-3)


def test_printed_finite_element_values_that_reproduce(elements: rf.RockingProperties) -> None:
    assert elements.effective_mass[0] == pytest.approx(8.485e6, rel=1e-3)
    assert elements.effective_height[0] == pytest.approx(141.66, abs=0.03)
    assert elements.omega[1] == pytest.approx(7.75, abs=0.005)
    assert elements.top_ordinate[0] == pytest.approx(1.725, abs=1e-3)
    assert elements.effective_mass[0] / elements.m_tot == pytest.approx(0.51, abs=0.005)


def test_printed_finite_element_values_that_do_not_reproduce(elements: rf.RockingProperties) -> None:
    # Of m*_2 = 3.233e6 kg and Γ_2 = -1.179 the same holds: 2.9 % and 0.8 % off.
    assert elements.omega[0] == pytest.approx(1.6557, abs=5e-5)  # printed 1.678
    assert elements.effective_height[1] == pytest.approx(51.319, abs=1e-3)  # printed 50.02


def test_finite_elements_are_below_ritz(ritz: rf.RockingProperties, elements: rf.RockingProperties) -> None:
    assert (elements.omega < ritz.omega).all()
    np.testing.assert_allclose(elements.omega, ritz.omega, rtol=0.013)


@pytest.mark.parametrize("method", ["ritz", "fe"])
def test_equations_33_to_35(method: str) -> None:
    props = rf.TaperedTower(**CHIMNEY, method=method).rocking()
    assert props.i_theta == pytest.approx(24_178_750.0 * MASS_FACTOR, rel=1e-12)
    assert props.l0r == pytest.approx(580_000.0 / 3.0 * MASS_FACTOR, rel=1e-12)
    assert props.resisting_moment == pytest.approx(17_600.0 * MASS_FACTOR * 9.81, rel=1e-12)


def peaks(response: rf.Response) -> np.ndarray:
    return np.array(
        [
            response.max_rotation,
            response.max_top_displacement,
            response.max_base_moment,
            response.max_base_shear,
        ]
    )


def test_responses_of_section_4_1_1() -> None:
    # In per cent, within 0.1: errors against 6DOF-S of rotation, top displacement, base moment and base shear.
    expected = {"2DOF-S": (-41.2, -5.8, -12.7, -75.0), "3DOF-S": (-2.1, -0.6, 15.1, -19.3)}
    tower, motion = rf.TaperedTower(**CHIMNEY), rf.load_suite("el-centro-1940")[0].scaled(2.0)
    benchmark = rf.simulate(tower, motion, "6DOF-S", output="peaks")
    assert benchmark.max_rotation == pytest.approx(3.152e-3, abs=5e-7)
    rocking, fixed = peaks(benchmark), peaks(rf.simulate(tower, motion, "5DOF-fixed", output="peaks"))
    np.testing.assert_allclose(100.0 * (rocking[2:] / fixed[2:] - 1.0), [-44.0, -24.5], atol=0.1)
    for label, errors in expected.items():
        found = 100.0 * (peaks(rf.simulate(tower, motion, label, output="peaks")) / rocking - 1.0)
        print(label, found.round(2))
        np.testing.assert_allclose(found, errors, atol=0.1)
