"""The tapered tower: geometry and refusals. Its numbers are those of Table 3, in tests/validation."""

import math

import numpy as np
import pytest

import rockflex as rf
from rockflex import InputError

GOOD = {
    "height": 60.0,
    "base_radius": 3.0,
    "top_radius": 2.0,
    "wall": 0.3,
    "density": 2400.0,
    "elastic_modulus": 30e9,
    "damping_ratio": 0.02,
}


def tower(**changes):
    return rf.TaperedTower(**(GOOD | changes))


@pytest.mark.parametrize("method", ["ritz", "fe"])
def test_a_tube_is_a_uniform_cantilever(method):
    tube = tower(base_radius=2.0, method=method, n_modes=2)
    area, inertia = math.pi * (4.0 - 1.7**2), math.pi * (16.0 - 1.7**4) / 4.0
    omega = 1.875104068711961**2 * math.sqrt(30e9 * inertia / (2400.0 * area)) / 60.0**2
    assert tube.modal().omega[0] == pytest.approx(omega, rel=3e-4 if method == "ritz" else 1e-8)
    mass = 2400.0 * area * 60.0
    rotary = 2400.0 * inertia * 60.0
    assert tube.rocking().i_theta == pytest.approx(mass * (60.0**2 / 3.0 + 4.0) + rotary, rel=1e-12)
    assert tube.half_width == 2.0


def test_a_wall_of_the_radius_is_solid():
    solid = tower(base_radius=2.0, wall=2.0)
    assert solid.rocking().m_tot == pytest.approx(2400.0 * math.pi * 4.0 * 60.0, rel=1e-12)


def test_fewer_modes_are_the_first_of_five():
    # Two functions alone would be a poorer approximation of the second mode.
    np.testing.assert_allclose(tower(n_modes=2).modal().omega, tower().modal(2).omega, rtol=1e-12)
    assert tower(n_modes=7).rocking().n_modes == 7


def test_simulates():
    pulse = rf.ricker_pulse(8.0, 1.0)
    assert rf.simulate(tower(), pulse, "6DOF-S", output="peaks").status == "rocking"


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"wall": 2.1}, "wall must be at most the smaller radius, top_radius = 2 m, but 2.1 m was given. It is the"),
        ({"wall": 1.1, "base_radius": 1.0}, "wall must be at most the smaller radius, base_radius = 1 m"),
        ({"method": "FE"}, 'method must be "fe" or "ritz", but \'FE\' was given'),
        ({"damping_ratio": [0.1, 0.2]}, "damping_ratio must be one number, or one for each of the 5 modes"),
    ],
)
def test_refused(changes, words):
    with pytest.raises(InputError, match=words):
        tower(**changes)
