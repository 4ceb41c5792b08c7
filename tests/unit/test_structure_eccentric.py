"""A structure beside the middle of its base: what it changes, and how it goes with tendons."""

import dataclasses
import pickle
import re

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame

FRAME = make_frame(n_stories=3, base_mass=60e3, stiffness_ratio=0.125, period=0.4, aspect_ratio=6.0)  # fmt: skip
B = FRAME.rocking().half_width
TENDONS = [rf.Tendon(2e5, 3e6, -0.9), rf.Tendon(1e5, 2e6, 0.4)]


def test_it_is_the_structure_with_its_pivots_elsewhere():
    moved, frame = rf.Eccentric(FRAME, 0.3), FRAME.rocking()
    p = moved.rocking()
    assert dataclasses.replace(p, eccentricity=0.0) == frame
    assert moved.rocking(2) == dataclasses.replace(FRAME.rocking(2), eccentricity=0.3)
    np.testing.assert_array_equal(moved.modal(2).omega, FRAME.modal(2).omega)
    # Masses and base, each by its distance from the two edges.
    heights = 3.0 * np.arange(1.0, 4.0)
    for side, arm in ((1, B - 0.3), (-1, B + 0.3)):
        pivot = p.pivot(side)
        inertia = float(np.sum(40e3 * (heights**2 + arm**2))) + 60e3 * arm**2
        assert pivot.i_theta == pytest.approx(inertia, rel=1e-14)
        assert pivot.resisting_moment == pytest.approx(180e3 * 9.81 * arm, rel=1e-14)


def test_no_eccentricity_is_the_structure_itself():
    assert rf.Eccentric(FRAME, 0.0).rocking() == FRAME.rocking()


def test_with_tendons_in_either_order():
    one = rf.Eccentric(rf.Restrained(FRAME, TENDONS), -0.2)
    other = rf.Restrained(rf.Eccentric(FRAME, -0.2), TENDONS)
    assert one.rocking() == other.rocking()
    assert one.rocking().eccentricity == -0.2
    assert one.rocking().tendons == tuple(TENDONS)
    assert one != other
    assert pickle.loads(pickle.dumps(one)) == one
    # Beyond the edge of a base in its middle, and within it where the base reaches further.
    far = rf.Tendon(1e5, 1e6, -B - 0.1)
    assert rf.Restrained(rf.Eccentric(FRAME, 0.2), far).rocking().tendons == (far,)


def test_the_outer_eccentricity_holds():
    assert rf.Eccentric(rf.Eccentric(FRAME, 0.1), 0.3).rocking() == rf.Eccentric(FRAME, 0.3).rocking()


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: rf.Eccentric(3.0, 0.1), "structure must be a structure such as a Frame"),
        (lambda: rf.Eccentric(rf.Frame, 0.1), "RockingProperties, but <class"),
        (lambda: rf.Eccentric(FRAME, "left"), "eccentricity must be a finite number in m, but 'left' was given"),
        (lambda: rf.Eccentric(FRAME, -1.2), "eccentricity must be smaller than half_width, 1.1955 m, to either side"),
    ],
)
def test_errors(call, says):
    with pytest.raises(rf.InputError, match=re.escape(says)):
        call()
