"""Modes: closed forms, an independent eigensolver, higher precision, and modes that do not take part."""

import mpmath
import numpy as np
import pytest
import scipy.linalg

from rockflex.foundation.errors import InputError
from rockflex.structure import modal_properties

STORIES = [1, 2, 5, 20]


def shear_stiffness(n, k=1.0):
    matrix = k * (2.0 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1))
    matrix[-1, -1] = k
    return matrix


def random_structure(seed, n=6):
    rng = np.random.default_rng(seed)
    factor = rng.normal(size=(n, n))
    mass_factor = rng.normal(size=(n, n))
    return (
        mass_factor @ mass_factor.T + n * np.eye(n),
        1e3 * (factor @ factor.T + np.eye(n)),
        np.cumsum(rng.uniform(0.5, 4.0, n)),
    )


@pytest.mark.parametrize("n", STORIES)
def test_shear_building_frequencies(n):
    mass, k = 3.0, 700.0
    modes = modal_properties(np.full(n, mass), shear_stiffness(n, k), np.arange(1.0, n + 1))
    number = np.arange(1, n + 1)
    expected = 2.0 * np.sqrt(k / mass) * np.sin((2 * number - 1) * np.pi / (2 * (2 * n + 1)))
    np.testing.assert_allclose(modes.omega, expected, rtol=1e-12)
    np.testing.assert_allclose(modes.period, 2.0 * np.pi / expected, rtol=1e-12)


@pytest.mark.parametrize("n", STORIES)
def test_shear_building_shapes(n):
    modes = modal_properties(np.ones(n), shear_stiffness(n), np.arange(1.0, n + 1))
    angle = np.outer(np.arange(1, n + 1), (2 * np.arange(1, n + 1) - 1) * np.pi / (2 * n + 1))
    np.testing.assert_allclose(modes.shapes, np.sin(angle) / np.sin(angle[-1]), atol=1e-11)


@pytest.mark.parametrize("seed", range(5))
def test_full_mass_matrix_against_scipy(seed):
    mass, stiffness, heights = random_structure(seed)
    modes = modal_properties(mass, stiffness, heights)
    values, vectors = scipy.linalg.eigh(stiffness, mass)
    shear, moment = vectors.T @ mass @ np.ones(6), vectors.T @ mass @ heights
    np.testing.assert_allclose(modes.omega, np.sqrt(values), rtol=1e-10)
    np.testing.assert_allclose(modes.effective_mass, shear**2, rtol=1e-8)
    np.testing.assert_allclose(modes.effective_height, moment / shear, rtol=1e-8)
    np.testing.assert_allclose(modes.participation * modes.shapes, vectors * shear, rtol=1e-8, atol=1e-10)


def test_diagonal_matrix_and_vector_of_masses_agree():
    _, stiffness, heights = random_structure(11)
    masses = np.arange(1.0, 7.0)
    as_vector = modal_properties(masses, stiffness, heights)
    as_matrix = modal_properties(np.diag(masses), stiffness, heights)
    for name in ("omega", "effective_mass", "effective_height", "participation", "shapes"):
        np.testing.assert_allclose(getattr(as_vector, name), getattr(as_matrix, name), rtol=1e-9)


def test_participation_goes_with_the_normalisation():
    mass, stiffness, heights = random_structure(3)
    modes = modal_properties(mass, stiffness, heights)
    for n, shape in enumerate(modes.shapes.T):
        modal_mass = shape @ mass @ shape
        shear = shape @ mass @ np.ones(6)
        assert shape[-1] == 1.0
        assert modes.participation[n] == pytest.approx(shear / modal_mass, rel=1e-9)
        assert modes.effective_mass[n] == pytest.approx(shear**2 / modal_mass, rel=1e-9)
        np.testing.assert_allclose(stiffness @ shape, modes.omega[n] ** 2 * (mass @ shape), rtol=1e-8)


def test_light_masses_leave_the_low_frequencies_their_digits():
    masses = [1e5, 1e-6, 1e5, 1e-4, 2e5]
    stiffness = shear_stiffness(5, 1e7)
    modes = modal_properties(masses, stiffness, [1, 2, 3, 4, 5])
    with mpmath.workdps(50):
        root = [mpmath.sqrt(m) for m in masses]
        reduced = mpmath.matrix(5, 5)
        for i in range(5):
            for j in range(5):
                reduced[i, j] = mpmath.mpf(stiffness[i, j]) / (root[i] * root[j])
        exact = sorted(mpmath.sqrt(value) for value in mpmath.eigsy(reduced, eigvals_only=True))
    np.testing.assert_allclose(modes.omega, [float(value) for value in exact], rtol=1e-9)


def test_first_modes_are_those_of_all():
    mass, stiffness, heights = random_structure(2)
    all_modes = modal_properties(mass, stiffness, heights)
    for first in (modal_properties(mass, stiffness, heights, 2), all_modes.truncated(2)):
        assert first.n_modes == 2
        assert first.shapes.shape == (6, 2)
        np.testing.assert_array_equal(first.omega, all_modes.omega[:2])
        np.testing.assert_array_equal(first.shapes, all_modes.shapes[:, :2])
        np.testing.assert_array_equal(first.heights, heights)


def test_results_are_read_only():
    modes = modal_properties([1.0, 1.0], shear_stiffness(2), [1.0, 2.0])
    for name in ("omega", "effective_mass", "effective_height", "participation", "shapes", "heights"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(modes, name)[0] = 0.0


def test_the_arguments_stay_as_they_are():
    mass, stiffness, heights = np.ones(2), shear_stiffness(2), np.array([1.0, 2.0])
    modal_properties(mass, stiffness, heights)
    assert all(array.flags.writeable for array in (mass, stiffness, heights))


def test_a_top_at_rest_is_normalised_by_the_largest_ordinate():
    shapes = np.array([[2.0, 0.0, -3.0], [0.0, 1.0, 0.0], [3.0, 0.0, 2.0]]).T / [13**0.5, 1.0, 13**0.5]
    stiffness = shapes @ np.diag([1.0, 4.0, 9.0]) @ shapes.T
    modes = modal_properties(np.ones(3), stiffness, [1.0, 2.0, 3.0])
    np.testing.assert_allclose(modes.shapes[:, 1], [0.0, 1.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(modes.shapes[-1, [0, 2]], 1.0)


def test_mode_without_any_participation():
    shapes = np.linalg.qr(np.array([[1.0, 1.0, 1.0], [1.0, 0.0, -1.0], [1.0, -2.0, 1.0]]).T)[0]
    stiffness = shapes @ np.diag([1.0, 4.0, 9.0]) @ shapes.T
    modes = modal_properties(np.ones(3), stiffness, [1.0, 2.0, 3.0])
    assert modes.effective_mass[2] == 0.0
    assert modes.participation[2] == 0.0
    assert np.isnan(modes.effective_height[2])


def test_mode_with_participation_in_the_base_moment_alone():
    stiffness = np.array([[5.0, -3.0], [-3.0, 5.0]])  # modes (1, 1) and (-1, 1)
    modes = modal_properties([1.0, 1.0], stiffness, [1.0, 2.0])
    assert modes.effective_mass[1] == 0.0
    assert np.isinf(modes.effective_height[1])


GOOD = {"mass": [1.0, 2.0], "stiffness": [[2.0, -1.0], [-1.0, 1.0]], "heights": [3.0, 6.0], "n_modes": None}


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"mass": [1.0, 2.0, 3.0]}, r"one mass for each of the 2 heights, but 3 were given.*base_mass"),
        ({"mass": [1.0, -2.0]}, r"mass must be positive, but mass\[1\] = -2 kg was given\. Condense"),
        ({"mass": [0.0, 2.0]}, r"mass must be positive, but mass\[0\] = 0 kg"),
        ({"mass": [1.0, np.nan]}, r"mass must be finite, but 1 of 2 values are not"),
        ({"mass": [[1.0, 2.0], [2.0, 1.0]]}, r"mass must be positive definite.*smallest eigenvalue is -1 kg"),
        ({"mass": [[1.0, 0.5], [0.0, 1.0]]}, r"mass must be symmetric, but mass\[0, 1\] = 0.5"),
        ({"mass": np.eye(3)}, r"mass must have the shape \(2, 2\), but an array of shape \(3, 3\)"),
        ({"mass": [[1.0, 2.0], [3.0]]}, r"mass must be a sequence of numbers in kg, but list whose rows differ"),
        ({"stiffness": [1.0, 2.0]}, r"stiffness must have the shape \(2, 2\), but an array of shape \(2,\)"),
        ({"stiffness": "soft"}, r"stiffness must be a matrix of numbers in N/m, but str was given"),
        ({"stiffness": [[2.0, -1.0], [-1.5, 1.0]]}, r"symmetric, but stiffness\[0, 1\] = -1 and stiffness\[1, 0\]"),
        ({"stiffness": [[2.0, np.inf], [-1.0, 1.0]]}, r"stiffness must be finite, but its entry \[0, 1\] is inf"),
        ({"stiffness": [[1.0, -2.0], [-2.0, 1.0]]}, r"stiffness must be positive definite.* smallest eigenvalue"),
        ({"stiffness": [[1.0, -1.0], [-1.0, 1.0]]}, r"stiffness must be positive definite"),
        ({"stiffness": np.zeros((2, 2))}, r"stiffness must be positive definite"),
        ({"stiffness": np.diag([1.0, 1e-17])}, r"positive definite.* smallest eigenvalue is 1e-17 N/m"),
        ({"heights": [6.0, 3.0]}, r"heights\[1\] = 3 m is not above heights\[0\] = 6 m\. Sort"),
        ({"heights": [3.0, 3.0]}, r"heights\[1\] = 3 m is not above heights\[0\] = 3 m"),
        ({"heights": [0.0, 3.0]}, r"heights must be positive.*heights\[0\] = 0 was given.*base_mass"),
        ({"heights": []}, r"heights must contain at least one height in m, but none was given"),
        ({"heights": [3.0, np.nan]}, r"heights must be finite, but 1 of 2"),
        ({"n_modes": 0}, r"n_modes must be a whole number from 1 to 2, but 0 was given"),
        ({"n_modes": 3}, r"n_modes must be a whole number from 1 to 2, but 3 was given"),
        ({"n_modes": True}, r"n_modes must be a whole number from 1 to 2, but True was given"),
        ({"n_modes": 1.0}, r"n_modes must be a whole number from 1 to 2, but 1.0 was given"),
        ({"mass": [1e-18, 1e18]}, r"frequencies span too wide a range for a modal analysis: .* rad/s\. Condense"),
    ],
)
def test_errors(change, text):
    with pytest.raises(InputError, match=text):
        modal_properties(**(GOOD | change))


def test_worst_pair_is_named():
    stiffness = shear_stiffness(4, 10.0)
    stiffness[0, 1] += 0.1
    stiffness[3, 2] += 0.3
    with pytest.raises(InputError, match=r"stiffness\[2, 3\] = -10 and stiffness\[3, 2\] = -9.7 N/m"):
        modal_properties(np.ones(4), stiffness, [1.0, 2.0, 3.0, 4.0])


def test_rounding_may_break_the_symmetry():
    stiffness = shear_stiffness(4, 10.0)
    stiffness[3, 2] *= 1.0 + 1e-12
    modes = modal_properties(np.ones(4), stiffness, [1.0, 2.0, 3.0, 4.0])
    expected = modal_properties(np.ones(4), shear_stiffness(4, 10.0), [1.0, 2.0, 3.0, 4.0])
    np.testing.assert_allclose(modes.omega, expected.omega, rtol=1e-11)


def test_more_modes_than_there_are():
    modes = modal_properties(**GOOD)
    with pytest.raises(InputError, match="n_modes must be a whole number from 1 to 2, but 5 was given"):
        modes.truncated(5)
