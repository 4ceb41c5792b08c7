"""The cantilever with a body at its tip against closed forms."""

import math

import numpy as np
import pytest
import scipy.optimize

import rockflex as rf
from rockflex import InputError

GOOD = {
    "height": 12.0,
    "tip_mass": 50e3,
    "bending_stiffness": 2e9,
    "base_mass": 10e3,
    "half_width": 1.2,
    "damping_ratio": 0.03,
}


def cantilever(**changes):
    return rf.CantileverWithTipMass(**(GOOD | changes))


def test_a_mass_on_a_spring():
    props = cantilever().rocking()
    np.testing.assert_allclose(props.omega, [math.sqrt(3.0 * 2e9 / 12.0**3 / 50e3)], rtol=1e-13)
    np.testing.assert_allclose(props.effective_mass, [50e3], rtol=1e-13)
    np.testing.assert_allclose(props.effective_height, [12.0], rtol=1e-13)
    np.testing.assert_allclose(props.top_ordinate, [1.0], rtol=1e-13)
    assert props.i_theta == pytest.approx(50e3 * 144.0 + 60e3 * 1.44, rel=1e-14)
    assert props.l0r == pytest.approx(600e3, rel=1e-14)
    assert props.floors.heights.tolist() == [12.0]


def test_a_body_that_turns():
    inertia = 400e3
    structure = cantilever(tip_inertia=inertia)
    props = structure.rocking()
    k = 2e9 / 12.0**3 * np.array([[12.0, -72.0], [-72.0, 576.0]])
    squares, phi = scipy.linalg.eigh(k, np.diag([50e3, inertia]))
    np.testing.assert_allclose(props.omega, np.sqrt(squares), rtol=1e-11)
    carried = phi.T @ np.diag([50e3, inertia]) @ np.array([[1.0, 12.0], [0.0, 1.0]])
    np.testing.assert_allclose(props.effective_mass, carried[:, 0] ** 2, rtol=1e-9)
    np.testing.assert_allclose(props.effective_height, carried[:, 1] / carried[:, 0], rtol=1e-9)
    # Both modes kept: what turns with the base is all there is.
    total = 50e3 * 144.0 + inertia
    assert props.effective_mass @ props.effective_height**2 == pytest.approx(total, rel=1e-11)
    assert props.i_theta == pytest.approx(total + 60e3 * 1.44, rel=1e-12)
    assert props.floors is None


@pytest.mark.parametrize("column", [10.0, 800.0, 30e3])
def test_column_with_mass(column):
    mu = 50e3 / (column * 12.0)

    def free_tip(x):
        return 1.0 / math.cosh(x) + math.cos(x) + mu * x * (math.cos(x) * math.tanh(x) - math.sin(x))

    roots = [scipy.optimize.brentq(free_tip, max(n * math.pi, 1e-6), (n + 1) * math.pi, xtol=1e-14) for n in range(3)]
    props = cantilever(mass_per_length=column).rocking(3)
    np.testing.assert_allclose(props.omega, np.square(roots) * math.sqrt(2e9 / column) / 144.0, rtol=1e-8)
    assert props.m_tot == pytest.approx(60e3 + 12.0 * column, rel=1e-12)


def test_a_light_column_is_one_without_mass():
    light, none = cantilever(mass_per_length=1e-3).rocking(1), cantilever().rocking()
    for name in ("omega", "effective_mass", "effective_height"):
        np.testing.assert_allclose(getattr(light, name), getattr(none, name), rtol=1e-6)


def test_number_of_modes():
    assert cantilever().modal().n_modes == 1
    assert cantilever(tip_inertia=1e3).modal().n_modes == 2
    assert cantilever(tip_inertia=1e3, n_modes=1).modal().n_modes == 1
    assert cantilever(mass_per_length=1.0).modal().n_modes == 5
    assert cantilever(mass_per_length=1.0, n_modes=3).modal(2).n_modes == 2


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"n_modes": 2}, "n_modes must be a whole number from 1 to 1, but 2 was given"),
    ],
)
def test_refused(changes, words):
    with pytest.raises(InputError, match=words):
        cantilever(**changes)
