"""Sine and cosine in one evaluation, against mpmath."""

import math

import mpmath
import numpy as np
import pytest

from rockflex.models._sines import SMALL, SMALLER, sine_and_cosine

ROTATIONS = np.concatenate(
    [
        np.linspace(-1.6, 1.6, 801),
        np.geomspace(1e-12, SMALLER, 200),
        [SMALLER, -SMALLER, math.nextafter(SMALLER, 1.0), SMALL, -SMALL, math.nextafter(SMALL, 1.0)],
    ]
)


@pytest.mark.parametrize(("place", "exact"), [(0, mpmath.sin), (1, mpmath.cos)])
def test_both_are_accurate_to_the_last_digit(place, exact):
    with mpmath.workdps(40):
        for theta in ROTATIONS.tolist():
            wanted = exact(mpmath.mpf(theta))
            assert abs(sine_and_cosine(theta)[place] - wanted) <= 2.5e-16 * abs(wanted)


def test_without_rotation():
    assert sine_and_cosine(0.0) == (0.0, 1.0)
