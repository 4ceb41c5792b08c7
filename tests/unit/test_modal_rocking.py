"""Parameters of a rocking structure: filled by hand, or from matrices."""

import copy
import math
import pickle

import numpy as np
import pytest

from rockflex.foundation.errors import InputError
from rockflex.structure import FloorModes, RockingProperties, modal_properties, rocking_properties

CHIMNEY_LIKE = {
    "omega": [1.66, 7.76],
    "effective_mass": [8.48e6, 3.32e6],
    "effective_height": [141.6, 51.3],
    "top_ordinate": [1.73, -1.19],
    "i_theta": 1.82e11,
    "l0r": 1.46e9,
    "m_tot": 1.66e7,
    "half_width": 8.0,
    "zeta": 0.02,
}

MASS = np.array([2.0, 1.0, 3.0])
STIFFNESS = np.array([[90.0, -40.0, 5.0], [-40.0, 70.0, -30.0], [5.0, -30.0, 30.0]])
HEIGHTS = np.array([2.0, 5.0, 7.0])


def assembled(mass=MASS, **changes):
    arguments = {
        "modal": modal_properties(mass, STIFFNESS, HEIGHTS),
        "mass": mass,
        "heights": HEIGHTS,
        "base_mass": 4.0,
        "half_width": 1.5,
        "damping_ratio": 0.03,
    } | changes
    return rocking_properties(**arguments)


def test_filled_by_hand():
    props = RockingProperties(**CHIMNEY_LIKE)
    assert props.n_modes == 2
    np.testing.assert_array_equal(props.omega, [1.66, 7.76])
    np.testing.assert_array_equal(props.zeta, [0.02, 0.02])
    assert props.translational_inertia == pytest.approx(1.82e11 - 1.66e7 * 64.0)
    assert props.resisting_moment == pytest.approx(1.66e7 * 9.81 * 8.0)
    assert props.nominal_overturning_rotation == pytest.approx(0.7 * math.atan(8.0 / 141.6))
    assert props.floors is None


def test_damping_ratio_a_mode():
    np.testing.assert_array_equal(RockingProperties(**CHIMNEY_LIKE | {"zeta": [0.0, 0.05]}).zeta, [0.0, 0.05])


def test_translational_inertia_may_be_given():
    assert RockingProperties(**CHIMNEY_LIKE, translational_inertia=1.8e11).translational_inertia == 1.8e11


def test_translational_inertia_never_falls_below_that_of_the_modes():
    modal_inertia = 3.0 * 7.0**2
    single = {name: [1.0] for name in ("omega", "top_ordinate")} | {
        "effective_mass": [3.0],
        "effective_height": [7.0],
        "i_theta": 3.0 * 7.0**2 + 5.0 * 0.1**2,
        "l0r": 21.0,
        "m_tot": 5.0,
        "half_width": 0.1,
        "zeta": 0.0,
        "translational_inertia": modal_inertia * (1.0 - 1e-12),
    }
    assert RockingProperties(**single).translational_inertia == modal_inertia


def test_arrays_are_read_only_copies():
    omega = np.array([1.66, 7.76])
    props = RockingProperties(**CHIMNEY_LIKE | {"omega": omega})
    omega[0] = 5.0
    assert props.omega[0] == 1.66
    for name in ("omega", "effective_mass", "effective_height", "top_ordinate", "zeta"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(props, name)[0] = 0.0


def test_frozen():
    with pytest.raises(AttributeError):
        RockingProperties(**CHIMNEY_LIKE).i_theta = 1.0


@pytest.mark.parametrize("clone", [copy.deepcopy, lambda props: pickle.loads(pickle.dumps(props))])
def test_copies_keep_the_values(clone):
    props = assembled()
    twin = clone(props)
    np.testing.assert_array_equal(twin.omega, props.omega)
    np.testing.assert_array_equal(twin.floors.force, props.floors.force)
    assert twin.i_theta == props.i_theta


def test_negative_effective_height_of_the_first_mode():
    props = RockingProperties(**CHIMNEY_LIKE | {"effective_height": [-141.6, 51.3]})
    assert props.nominal_overturning_rotation == pytest.approx(0.7 * (math.pi - math.atan(8.0 / 141.6)))


def test_truncation_keeps_what_belongs_to_the_structure():
    props = assembled(damping_ratio=[0.01, 0.02, 0.03])
    first = props.truncated(1)
    np.testing.assert_array_equal(props.truncated(2).zeta, [0.01, 0.02])
    assert first.n_modes == 1
    for name in ("omega", "effective_mass", "effective_height", "top_ordinate", "zeta"):
        np.testing.assert_array_equal(getattr(first, name), getattr(props, name)[:1])
    for name in ("i_theta", "l0r", "m_tot", "half_width", "translational_inertia"):
        assert getattr(first, name) == getattr(props, name)
    np.testing.assert_array_equal(first.floors.force, props.floors.force[:, :1])
    assert props.truncated(3) is props


def test_a_structure_without_modes_is_a_block():
    block = assembled().truncated(0)
    given = {name: getattr(block, name) for name in ("i_theta", "l0r", "m_tot", "half_width", "translational_inertia")}
    for same in (block, RockingProperties([], [], [], [], zeta=[], **given), pickle.loads(pickle.dumps(block))):
        assert (same.n_modes, same.floors, same.zeta.size) == (0, None, 0)
        assert {name: getattr(same, name) for name in given} == given
        assert same.nominal_overturning_rotation == pytest.approx(0.7 * math.atan(1.5 * same.m_tot / same.l0r))


@pytest.mark.parametrize("n_modes", [4, -1, False, 1.5])
def test_truncation_out_of_range(n_modes):
    with pytest.raises(InputError, match=rf"n_modes must be a whole number from 0 to 3, but {n_modes} was"):
        assembled().truncated(n_modes)


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"omega": [0.0, 7.76]}, r"omega must be positive, but omega\[0\] = 0 rad/s was given"),
        ({"omega": [7.76, 1.66]}, r"omega\[1\] = 1.66 rad/s is below omega\[0\] = 7.76 rad/s\. Sort"),
        ({"omega": [1.66, np.nan]}, r"omega must be finite, but 1 of 2"),
        ({"omega": []}, r"effective_mass must contain one value per mode, as omega does \(0\), but 2 were given"),
        ({"effective_mass": [8.48e6]}, r"effective_mass must contain one value per mode.*\(2\), but 1 were given"),
        ({"effective_mass": [8.48e6, -1.0]}, r"must be positive, but effective_mass\[1\] = -1 kg"),
        ({"effective_height": [np.inf, 51.3]}, r"effective_height must be finite"),
        ({"top_ordinate": [1.0, 2.0, 3.0]}, r"top_ordinate must contain one value per mode.*\(2\), but 3"),
        ({"i_theta": 1e11}, r"i_theta must exceed .*1.78\d+e\+11 kg m², but 1e\+11 .*no inertia is left"),
        ({"i_theta": 0.0}, r"i_theta must be a positive, finite number in kg m², but 0.0 was given"),
        ({"l0r": -1.0}, r"l0r must be a positive, finite number in kg m, but -1.0 was given"),
        ({"m_tot": 1.1e7}, r"m_tot must be at least the sum of effective_mass, 11800000 kg, but 11000000 kg"),
        ({"m_tot": math.inf}, r"m_tot must be a positive, finite number in kg, but inf was given"),
        ({"half_width": 0.0}, r"half_width must be a positive, finite number in m, but 0.0 was given"),
        ({"half_width": math.inf}, r"half_width must be a positive, finite number in m, but inf was given"),
        ({"half_width": 20.0}, r"translational_inertia .*but i_theta - m_tot \* half_width\*\*2, its default"),
        ({"translational_inertia": 1.7e11}, r"translational_inertia .*the given value is 1.7e\+11.*Give the"),
        ({"translational_inertia": 1.83e11}, r"below i_theta, 1.82e\+11 kg m², but the given value is 1.83e"),
        ({"translational_inertia": math.nan}, r"translational_inertia must be a positive, finite number"),
        ({"zeta": 2.0}, r"zeta must lie in \[0, 1\), but 2.0 was given\. Give the fraction .* 2 % is 0.02"),
        ({"zeta": -0.01}, r"zeta must lie in \[0, 1\), but -0.01 was given"),
        ({"zeta": math.nan}, r"zeta must lie in \[0, 1\), but nan was given"),
        ({"zeta": [0.02, 1.0]}, r"zeta\[1\] must lie in \[0, 1\), but 1.0 was given"),
        ({"zeta": [0.02]}, r"zeta must be one number, or one for each of the 2 modes, but 1 were given"),
        ({"zeta": "low"}, r"zeta must be a number, but 'low' was given"),
        ({"floors": FloorModes([1.0], [[1.0]], [[1.0]])}, r"floors must hold the same 2 modes as omega, but it holds"),
    ],
)
def test_errors(change, text):
    with pytest.raises(InputError, match=text):
        RockingProperties(**(CHIMNEY_LIKE | change))


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (([1.0, 2.0], [1.0, 2.0], [[1.0], [2.0]]), r"floors.displacement must have the shape \(2, 1\), .*\(2,\)"),
        (([1.0, 2.0], [[1.0], [2.0]], [[1.0]]), r"floors.force must have the shape \(2, 1\), but.*\(1, 1\)"),
        (([1.0, 2.0], [[1.0], [2.0, 3.0]], [[1.0]]), r"floors.displacement must be a matrix of numbers"),
        (([np.nan], [[1.0]], [[1.0]]), r"floors.heights must be finite"),
        (([1.0], [[1.0]], [[np.nan]]), r"floors.force must be finite, but its entry \[0, 0\] is nan"),
    ],
)
def test_errors_of_floors(arguments, text):
    with pytest.raises(InputError, match=text):
        FloorModes(*arguments)


def test_more_floor_modes_than_there_are():
    with pytest.raises(InputError, match="n_modes must be a whole number from 1 to 1, but 2 was given"):
        FloorModes([1.0], [[1.0]], [[1.0]]).truncated(2)


def test_lumped_masses():
    props = assembled()
    assert props.m_tot == 10.0
    assert props.l0r == 2.0 * 2.0 + 1.0 * 5.0 + 3.0 * 7.0
    assert props.translational_inertia == pytest.approx(2.0 * 4.0 + 1.0 * 25.0 + 3.0 * 49.0, rel=1e-14)
    assert props.i_theta == pytest.approx(4.0 * 1.5**2 + sum(MASS * (HEIGHTS**2 + 1.5**2)), rel=1e-14)
    assert props.half_width == 1.5
    np.testing.assert_array_equal(props.zeta, [0.03, 0.03, 0.03])


def test_full_mass_matrix():
    mass = np.array([[2.0, 0.3, 0.0], [0.3, 1.0, 0.2], [0.0, 0.2, 3.0]])
    props = assembled(mass)
    ones = np.ones(3)
    assert props.m_tot == pytest.approx(ones @ mass @ ones + 4.0)
    assert props.l0r == pytest.approx(ones @ mass @ HEIGHTS)
    assert props.translational_inertia == pytest.approx(HEIGHTS @ mass @ HEIGHTS)
    assert props.i_theta == pytest.approx(HEIGHTS @ mass @ HEIGHTS + props.m_tot * 1.5**2)


@pytest.mark.parametrize("mass", [MASS, np.array([[2.0, 0.3, 0.0], [0.3, 1.0, 0.2], [0.0, 0.2, 3.0]])])
def test_floors_carry_displacements_and_forces(mass):
    props = assembled(mass)
    modal_displacement = np.array([0.3, -0.2, 0.05])
    displacement = props.floors.displacement @ modal_displacement
    np.testing.assert_allclose(props.floors.force @ modal_displacement, STIFFNESS @ displacement, rtol=1e-11)
    assert displacement[-1] == pytest.approx(props.top_ordinate @ modal_displacement)
    shear = props.effective_mass * props.omega**2
    np.testing.assert_allclose(props.floors.force.sum(axis=0), shear, rtol=1e-11)
    np.testing.assert_allclose(HEIGHTS @ props.floors.force, shear * props.effective_height, rtol=1e-11)
    np.testing.assert_array_equal(props.floors.heights, HEIGHTS)


def test_modes_without_participation_are_left_out_and_not_counted():
    shapes = np.linalg.qr(np.array([[1.0, 1.0, 1.0], [1.0, -2.0, 1.0], [1.0, 0.0, -1.0]]).T)[0]
    shapes = shapes @ np.linalg.qr([[1.0, 0.0, 0.2], [0.0, 1.0, 0.0], [-0.2, 0.0, 1.0]])[0]
    stiffness = shapes @ np.diag([1.0, 4.0, 9.0]) @ shapes.T
    heights = [1.0, 2.0, 3.0]
    modal = modal_properties(np.ones(3), stiffness, heights)
    props = rocking_properties(modal, np.ones(3), heights, 1.0, 1.0, [0.01, 0.02, 0.03])
    np.testing.assert_allclose(props.omega, [1.0, 3.0])
    np.testing.assert_array_equal(props.zeta, [0.01, 0.03])
    assert props.effective_mass.sum() == pytest.approx(3.0)
    assert props.effective_mass @ props.effective_height**2 == pytest.approx(14.0)
    assert rocking_properties(modal, np.ones(3), heights, 1.0, 1.0, 0.0, n_modes=2).n_modes == 2
    with pytest.raises(InputError, match="n_modes must be a whole number from 1 to 2, but 3 was given"):
        rocking_properties(modal, np.ones(3), heights, 1.0, 1.0, 0.0, n_modes=3)


def test_mode_that_takes_part_in_the_base_moment_alone():
    modal = modal_properties([1.0, 1.0], [[5.0, -3.0], [-3.0, 5.0]], [1.0, 2.0])
    arguments = (modal, [1.0, 1.0], [1.0, 2.0], 1.0, 1.0, 0.02)
    text = r"Mode 2 \(2.82843 rad/s\) contributes to the base moment but not.*keep only .*\(n_modes=1\)"
    with pytest.raises(InputError, match=text):
        rocking_properties(*arguments)
    assert rocking_properties(*arguments, n_modes=1).effective_mass == pytest.approx([2.0])


def test_first_mode_that_takes_part_in_the_base_moment_alone():
    modal = modal_properties([1.0, 1.0], [[5.0, 3.0], [3.0, 5.0]], [1.0, 2.0])
    with pytest.raises(InputError, match=r"Mode 1 .* Change a mass or a stiffness slightly\.$"):
        rocking_properties(modal, [1.0, 1.0], [1.0, 2.0], 1.0, 1.0, 0.02)


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"heights": [2.0, 5.0, 8.0]}, r"heights must .*, \[2. 5. 7.\], but \[2. 5. 8.\] was given"),
        ({"mass": [1.0, 2.0]}, r"one mass for each of the 3 heights, but 2 were given"),
        ({"base_mass": -1.0}, r"base_mass must be a zero or positive, finite number in kg, but -1.0"),
        ({"half_width": -1.0}, r"half_width must be a positive, finite number in m, but -1.0"),
        ({"damping_ratio": 1.0}, r"damping_ratio must lie in \[0, 1\), but 1.0 was given"),
    ],
)
def test_errors_of_the_assembly(change, text):
    modal = modal_properties(MASS, STIFFNESS, HEIGHTS)
    with pytest.raises(InputError, match=text):
        assembled(**({"modal": modal} | change))
