"""A structure given by its matrices."""

import numpy as np
import pytest

from rockflex.foundation.errors import InputError
from rockflex.structure import LumpedStructure, modal_properties, rocking_properties

GOOD = {
    "masses": [2.0, 1.0],
    "stiffness": [[30.0, -10.0], [-10.0, 10.0]],
    "heights": [3.0, 6.0],
    "base_mass": 1.0,
    "half_width": 0.5,
    "damping_ratio": 0.02,
}


def test_modes_and_parameters_are_those_of_the_modal_layer():
    structure = LumpedStructure(**GOOD)
    modal = modal_properties(GOOD["masses"], GOOD["stiffness"], GOOD["heights"])
    props = rocking_properties(modal, GOOD["masses"], GOOD["heights"], 1.0, 0.5, 0.02)
    np.testing.assert_array_equal(structure.modal().omega, modal.omega)
    np.testing.assert_array_equal(structure.rocking().effective_height, props.effective_height)
    assert structure.rocking().i_theta == props.i_theta
    assert structure.height == 6.0


def test_modes_are_computed_once():
    structure = LumpedStructure(**GOOD)
    assert structure.modal() is structure.modal()
    assert structure.rocking() is structure.rocking()


def test_first_modes():
    structure = LumpedStructure(**GOOD | {"damping_ratio": [0.01, 0.05]})
    assert structure.modal(1).n_modes == 1
    first = structure.rocking(1)
    assert first.n_modes == 1
    np.testing.assert_array_equal(first.zeta, [0.01])
    np.testing.assert_allclose(first.floors.force, structure.rocking().floors.force[:, :1], rtol=1e-12)
    assert first.i_theta == structure.rocking().i_theta


def test_full_mass_matrix():
    full = LumpedStructure(**GOOD | {"masses": [[2.0, 0.0], [0.0, 1.0]]})
    np.testing.assert_allclose(full.rocking().omega, LumpedStructure(**GOOD).rocking().omega, rtol=1e-13)


def test_a_mode_in_the_base_moment_alone_can_be_left_out():
    twin_masses = {"masses": [1.0, 1.0], "stiffness": [[5.0, -3.0], [-3.0, 5.0]]}
    structure = LumpedStructure(**GOOD | twin_masses)
    assert structure.modal().n_modes == 2
    assert structure.rocking(1).n_modes == 1
    with pytest.raises(InputError, match=r"Mode 2 .* contributes to the base moment but not to the base shear"):
        structure.rocking()


def test_frozen_and_read_only():
    structure = LumpedStructure(**GOOD)
    with pytest.raises(AttributeError):
        structure.base_mass = 2.0
    for name in ("masses", "stiffness", "heights", "damping_ratio"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(structure, name)[0] = 1.0


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"masses": [2.0]}, r"one mass for each of the 2 heights, but 1 were given"),
        ({"masses": [2.0, 0.0]}, r"mass must be positive, but mass\[1\] = 0 kg"),
        ({"masses": [[1.0, 1.0], [1.0, 1.0]]}, r"mass must be positive definite.*Condense massless degrees of freedom"),
        ({"stiffness": np.eye(3)}, r"stiffness must have the shape \(2, 2\), but an array of shape \(3, 3\)"),
        ({"stiffness": [[30.0, -10.0], [-9.0, 10.0]]}, r"stiffness must be symmetric.*\[0, 1\] = -10 and"),
        ({"stiffness": [[1.0, 0.0], [0.0, -4.0]]}, r"smallest eigenvalue is -4 N/m \(the largest is 1\)"),
        ({"heights": [6.0, 3.0]}, r"heights\[1\] = 3 m is not above heights\[0\] = 6 m"),
        ({"damping_ratio": 1.0}, r"damping_ratio must lie in \[0, 1\), but 1.0 .* Give the fraction"),
        ({"damping_ratio": [0.1, -0.1]}, r"damping_ratio\[1\] must lie in \[0, 1\), but -0.1 was given"),
        ({"damping_ratio": [0.1] * 3}, r"damping_ratio must be one number, or one for each of the 2 modes"),
    ],
)
def test_errors(change, text):
    with pytest.raises(InputError, match=text):
        LumpedStructure(**(GOOD | change))


@pytest.mark.parametrize("method", ["modal", "rocking"])
@pytest.mark.parametrize("n_modes", [0, 3, 1.5, True])
def test_number_of_modes_out_of_range(method, n_modes):
    with pytest.raises(InputError, match=rf"n_modes must be a whole number from 1 to 2, but {n_modes} was"):
        getattr(LumpedStructure(**GOOD), method)(n_modes)
