"""Beams: what goes in, what their sums are, and what is refused."""

import math
import time

import numpy as np
import pytest

import rockflex as rf
from rockflex import InputError

GOOD = {
    "height": 20.0,
    "mass": 500.0,
    "bending_stiffness": 1e9,
    "half_width": 1.5,
    "damping_ratio": 0.02,
}


def beam(**changes):
    return rf.Beam(**(GOOD | changes))


@pytest.mark.parametrize("method", ["fe", "ritz"])
def test_number_function_and_table_are_one(method):
    number = beam(method=method).rocking()
    function = beam(method=method, mass=lambda _: 500.0, bending_stiffness=lambda z: np.full_like(z, 1e9)).rocking()
    table = beam(method=method, mass=([0, 20], [500, 500]), bending_stiffness=([0, 7, 20], [1e9, 1e9, 1e9])).rocking()
    for other in (function, table):
        np.testing.assert_allclose(other.omega, number.omega, rtol=1e-9)
        np.testing.assert_allclose(other.effective_mass, number.effective_mass, rtol=1e-7)


@pytest.mark.parametrize("method", ["fe", "ritz"])
def test_table_is_linear_between_its_rows(method):
    table = beam(method=method, mass=([0, 20], [800, 200]), bending_stiffness=([0, 20], [2e9, 1e8])).rocking()
    function = beam(
        method=method, mass=lambda z: 800.0 - 30.0 * z, bending_stiffness=lambda z: 2e9 - 9.5e7 * z
    ).rocking()
    np.testing.assert_allclose(table.omega, function.omega, rtol=1e-9)


@pytest.mark.parametrize("rotary_in_modes", [True, False])
@pytest.mark.parametrize("method", ["fe", "ritz"])
def test_sums(method, rotary_in_modes):
    # Masses in kg, heights in m, by hand.
    props = beam(
        mass=([0, 20], [600, 300]),
        rotary_inertia=70.0,
        lumped_masses=rf.LumpedMasses([8.0, 20.0], [1e3, 2e3], [5e3, 0.0]),
        base_mass=4e3,
        method=method,
        rotary_in_modes=rotary_in_modes,
    ).rocking()
    distributed = 600.0 * 20.0**3 / 3.0 - 15.0 * 20.0**4 / 4.0
    inertia = distributed + 1e3 * 64.0 + 2e3 * 400.0
    rotary = 70.0 * 20.0 + 5e3
    assert props.m_tot == pytest.approx(450.0 * 20.0 + 3e3 + 4e3, rel=1e-12)
    assert props.l0r == pytest.approx(600.0 * 200.0 - 15.0 * 20.0**3 / 3.0 + 8e3 + 40e3, rel=1e-12)
    assert props.translational_inertia == pytest.approx(inertia + rotary * rotary_in_modes, rel=1e-12)
    assert props.i_theta == pytest.approx(inertia + rotary + props.m_tot * 1.5**2, rel=1e-12)


@pytest.mark.parametrize("method", ["fe", "ritz"])
def test_stations_carry_base_shear_and_base_moment(method):
    props = beam(
        mass=([0, 20], [600, 300]),
        rotary_inertia=400.0,
        lumped_masses=rf.LumpedMasses([8.3], [1e3]),
        method=method,
    ).rocking()
    floors = props.floors
    shear = props.effective_mass * props.omega**2
    np.testing.assert_allclose(floors.force.sum(axis=0), shear, rtol=1e-10)
    np.testing.assert_allclose(floors.heights @ floors.force, shear * props.effective_height, rtol=1e-10)
    np.testing.assert_allclose(floors.displacement[-1], props.top_ordinate)
    np.testing.assert_array_equal(floors.displacement[0], 0.0)
    assert floors.heights[0] == 0.0
    assert floors.heights[-1] == 20.0


def test_modes_have_the_top_ordinate_one():
    modes = beam().modal()
    np.testing.assert_allclose(modes.shapes[-1], 1.0, rtol=1e-12)
    np.testing.assert_allclose(modes.participation, beam().rocking().top_ordinate, rtol=1e-12)
    assert modes.heights[-1] == 20.0
    assert modes.shapes.shape == (20, 5)


@pytest.mark.parametrize("method", ["fe", "ritz"])
def test_first_modes(method):
    structure = beam(method=method)
    assert structure.rocking(2).n_modes == 2
    np.testing.assert_array_equal(structure.modal(2).omega, structure.modal().omega[:2])
    alone = beam(method=method, n_modes=2).modal()
    np.testing.assert_allclose(alone.omega, structure.modal(2).omega, rtol=1e-9)  # another search for them


def test_damping_of_each_mode():
    props = beam(n_modes=2, damping_ratio=[0.01, 0.05]).rocking()
    np.testing.assert_array_equal(props.zeta, [0.01, 0.05])


def test_thousands_of_elements_are_fast():
    fine = beam(n_elements=4000, bending_stiffness=lambda z: 1e9 * (1.5 - z / 20.0) ** 2)
    fine.modal()
    again = beam(n_elements=4000, bending_stiffness=lambda z: 1e9 * (1.5 - z / 20.0) ** 2)
    started = time.perf_counter()
    again.modal()
    assert time.perf_counter() - started < 2.0  # 0.2 s on an idle core


def test_shapes_of_equation_36():
    z = np.linspace(0.0, 5.0, 7)
    value, slope, curvature = rf.cosine_shapes(5.0, 3).at(z)
    argument = np.outer(z, [1.0, 3.0, 5.0]) * math.pi / 10.0
    np.testing.assert_allclose(value, 1.0 - np.cos(argument), atol=1e-15)
    np.testing.assert_allclose(np.gradient(value, z, axis=0)[3], slope[3], atol=0.6)
    assert rf.cosine_shapes(5.0, 3).check(5.0) == 3
    assert curvature[0] == pytest.approx((np.array([1.0, 3.0, 5.0]) * math.pi / 10.0) ** 2)


REFUSED = [
    ({"mass": ([0, 15], [500, 500])}, r"mass: a table must extend from the base \(0 m\) to the top \(20 m\)"),
    ({"mass": ([2, 20], [500, 500])}, "but it covers 2 m to 20 m"),
    ({"mass": ([0, 12, 9, 20], [5, 5, 5, 5])}, "mass: the heights of a table must not decrease, but 9 m follows"),
    ({"mass": ([0, 20], [500, 500, 500])}, "at least two rows, but 2 heights and 3 values were given"),
    ({"mass": ([0, 20], [500, 500], [1, 1])}, r"mass must be a table \(heights, values\), but 3 columns were given"),
    ({"bending_stiffness": ([0, 20], [1e9, 0])}, "bending_stiffness must be positive, but its table contains 0 N m²"),
    ({"rotary_inertia": ([0, 20], [1, -1])}, "rotary_inertia must be zero or positive, but its table contains -1 kg m"),
    ({"mass": 0.0}, "mass must be a positive, finite number in kg/m, but 0.0 was given"),
    ({"mass": lambda z: 10.0 - z}, "mass must be positive and finite along the whole height, but it is 0 kg/m at 10 m"),
    ({"rotary_inertia": lambda z: z - 1.0}, "rotary_inertia must be zero or positive and finite along the whole"),
    ({"mass": lambda z: np.ones(3)}, r"mass must return one number for each height, an array of shape \(65,\)"),
    ({"lumped_masses": rf.LumpedMasses([25.0], [1.0])}, "must lie on the beam, at most 20 m above the base, but one"),
    ({"lumped_masses": ([3.0], [1.0])}, r"lumped_masses must be LumpedMasses\(heights, masses\), but tuple was given"),
    ({"method": "fem"}, 'method must be "fe" or "ritz", but \'fem\' was given'),
    ({"method": "ritz", "n_elements": 10}, 'n_elements does not apply to method="ritz". Leave it out, or use'),
    ({"method": "ritz", "shear_stiffness": 1e8}, 'shear_stiffness does not apply to method="ritz"'),
    ({"shapes": rf.cosine_shapes(20.0, 5)}, 'shapes does not apply to method="fe". Leave it out, or use method="ritz"'),
    ({"method": "ritz", "shapes": rf.cosine_shapes(20.0, 2)}, "shapes must contain at least n_modes = 5 shapes, but"),
    ({"n_elements": 3}, "n_elements must be a whole number from 5 to 10000, but 3 was given"),
    ({"n_modes": 0}, "n_modes must be a whole number from 1 to 200, but 0 was given"),
    ({"damping_ratio": 2.0}, r"damping_ratio must lie in \[0, 1\)"),
]  # fmt: skip


@pytest.mark.parametrize(("changes", "words"), REFUSED)
def test_refused(changes, words):
    with pytest.raises(InputError, match=words):
        beam(**changes)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (([1.0], [1.0, 2.0]), "must contain one mass and one rotary inertia for each of its 1 heights, but 2 and 1"),
        (([0.0], [1.0]), r"lumped_masses.heights must be positive, but heights\[0\] = 0 m was given. A mass"),
        (([1.0], [-1.0]), r"lumped_masses.masses must be positive, but masses\[0\] = -1 kg was given"),
        (([1.0], [1.0], [-2.0]), r"lumped_masses.rotary must be zero or positive, but rotary\[0\] = -2 kg m² was"),
    ],
)
def test_bodies_refused(arguments, words):
    with pytest.raises(InputError, match=words):
        rf.LumpedMasses(*arguments)


def column(function):
    return lambda z: np.asarray(function(z))[:, None] if np.ndim(function(z)) == 1 else np.asarray(function(z))


SHAPES = [
    (lambda z: z + 1.0, np.ones_like, np.zeros_like, "Shape 1 must vanish at the base"),
    (lambda z: z, np.ones_like, np.zeros_like, "Shape 1 must have no slope at the base"),
    (lambda z: z**2, lambda z: 3.0 * z, lambda z: np.full_like(z, 3.0), "Shape 1 is not the integral of its slope"),
    (lambda z: z**2, lambda z: 2.0 * z, np.ones_like, "Shape 1 has a slope that is not the integral of its curvature"),
    (lambda z: z**2, lambda z: 2.0 * z, lambda z: z * np.nan, "shapes.curvature must be finite along the height"),
]


@pytest.mark.parametrize(("value", "slope", "curvature", "words"), SHAPES)
def test_shapes_refused(value, slope, curvature, words):
    shapes = rf.RitzShapes(column(value), column(slope), column(curvature))
    with pytest.raises(InputError, match=words):
        beam(method="ritz", shapes=shapes, n_modes=1)


def test_shape_of_shapes_refused():
    flat = rf.RitzShapes(lambda z: z**2, lambda z: 2.0 * z, np.ones_like)
    with pytest.raises(InputError, match=r"shapes.value must return one row per height and one column per shape"):
        beam(method="ritz", shapes=flat)


def test_dependent_shapes_refused():
    twice = rf.RitzShapes(
        lambda z: np.column_stack([z**2, 3.0 * z**2]),
        lambda z: np.column_stack([2.0 * z, 6.0 * z]),
        lambda z: np.column_stack([2.0 + 0.0 * z, 6.0 + 0.0 * z]),
    )
    with pytest.raises(InputError, match=r"The 2 Ritz shapes are linearly dependent \(smallest eigenvalue"):
        beam(method="ritz", shapes=twice, n_modes=2).rocking()
