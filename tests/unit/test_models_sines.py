"""Sine and cosine in one evaluation, as a sway and its lever take them, against mpmath."""

import math

import mpmath
import numpy as np
import pytest

from builders import make_frame, vector_field
from rockflex.models._quantities import SWAY
from rockflex.models._rocking_model import RockingModel

SMALL, SMALLER = math.pi / 4, 0.125  # rad: up to which there are series
ROTATIONS = np.concatenate(
    [
        np.linspace(-1.6, 1.6, 801),
        np.geomspace(1e-12, SMALLER, 200),
        [SMALLER, -SMALLER, math.nextafter(SMALLER, 1.0), SMALL, -SMALL, math.nextafter(SMALL, 1.0)],
    ]
)


def sines_and_cosines(rotations):
    """Of a point 1 m above the middle of a base whose edge is there, and of one displaced by 1 m."""
    model = RockingModel("rigid-C", make_frame().rocking().truncated(0), complete=True)
    field = vector_field(model, 0, kinds=[SWAY, SWAY], levers=np.array([[1.0, 0.0], [0.0, 0.0]]))
    motion, still = np.zeros((rotations.size, model.layout.size)), np.zeros(rotations.size)
    motion[:, model.layout.rotation] = rotations
    values = np.tile([0.0, 1.0], (rotations.size, 1))
    field.observe_along(motion, np.zeros_like(motion), still, still, values)
    return values


@pytest.mark.parametrize(("place", "exact"), [(0, mpmath.sin), (1, mpmath.cos)])
def test_both_are_accurate_to_the_last_digit(place, exact):
    with mpmath.workdps(40):
        for theta, found in zip(ROTATIONS.tolist(), sines_and_cosines(ROTATIONS)[:, place].tolist(), strict=True):
            wanted = exact(mpmath.mpf(theta))
            assert abs(found - wanted) <= 2.5e-16 * abs(wanted)


def test_without_rotation():
    assert sines_and_cosines(np.zeros(1)).tolist() == [[0.0, 1.0]]
