"""Frames with unequal stories against frames with equal ones, closed forms, and half beams of their own."""

import math

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from rockflex import InputError

GOOD = {
    "story_heights": [4.0, 3.0, 2.5],
    "masses": [50e3, 40e3, 30e3],
    "column_stiffness": [3e8, 2e8, 1e8],
    "beam_stiffness": [5e8, 2e8, 8e7],
    "base_mass": 20e3,
    "half_width": 2.0,
    "damping_ratio": 0.05,
}


def fish_bone(**changes):
    return rf.FishBone(**(GOOD | changes))


@pytest.mark.parametrize("ratio", [0.0, 0.125, 2.0, math.inf])
def test_equal_stories_are_a_frame(ratio):
    frame = make_frame(base_mass=20e3, stiffness_ratio=ratio, period=0.8, aspect_ratio=6.0, damping_ratio=0.05)

    def equal(stiffness):
        beams = math.inf if math.isinf(ratio) else 12.0 * ratio * stiffness / 3.0
        return fish_bone(
            story_heights=[3.0] * 5,
            masses=40e3,
            column_stiffness=stiffness,
            beam_stiffness=beams,
            half_width=frame.half_width,
        )

    stiffness = (frame.modal().omega[0] / equal(1.0).modal().omega[0]) ** 2
    found, expected = equal(stiffness).rocking(), frame.rocking()
    for name in ("omega", "effective_mass", "effective_height", "top_ordinate", "i_theta", "l0r", "zeta"):
        np.testing.assert_allclose(getattr(found, name), getattr(expected, name), rtol=1e-10)
    np.testing.assert_allclose(found.floors.force, expected.floors.force, rtol=1e-9)
    motion = rf.load_suite("el-centro-1940")[0].scaled(2.0)
    responses = [rf.simulate(each, motion, "MDOF-S", output="peaks") for each in (found, expected)]
    assert responses[1].status == "rocking"
    for name in ("rotation", "top_displacement", "base_moment", "base_shear"):
        values = [getattr(each, f"max_{name}") for each in responses]
        assert values[0] == pytest.approx(values[1], rel=1e-10)


def test_no_beams_is_a_stepped_cantilever():
    column = fish_bone(beam_stiffness=0.0)
    h = column.lumped.heights
    z, w = np.polynomial.legendre.leggauss(4)
    flexibility, base = np.zeros((3, 3)), 0.0
    for length, stiffness in zip(GOOD["story_heights"], GOOD["column_stiffness"], strict=True):
        at = base + length * (1.0 + z) / 2.0
        arms = np.maximum(h[:, None] - at, 0.0) * (h[:, None] > base)
        flexibility += (arms * w * length / 2.0 / stiffness) @ arms.T
        base += length
    np.testing.assert_allclose(column.lumped.stiffness @ flexibility, np.eye(3), atol=1e-11)


def test_rigid_beams_are_a_shear_building():
    stiffness = fish_bone(beam_stiffness=math.inf).lumped.stiffness
    k = 12.0 * np.array(GOOD["column_stiffness"]) / np.array(GOOD["story_heights"]) ** 3
    expected = np.diag(k + np.append(k[1:], 0.0)) - np.diag(k[1:], 1) - np.diag(k[1:], -1)
    np.testing.assert_allclose(stiffness, expected, rtol=1e-13, atol=1e-6)


def test_one_rigid_floor_is_the_limit_of_a_stiff_one():
    rigid = fish_bone(beam_stiffness=[5e8, math.inf, 0.0]).modal().omega
    np.testing.assert_allclose(rigid, fish_bone(beam_stiffness=[5e8, 1e18, 0.0]).modal().omega, rtol=1e-8)


def test_half_beams_of_their_own():
    """Columns and half beams with every rotation, the rollers' included, without mass and condensed elsewhere."""
    n, span = 3, 6.0
    beams = np.array(GOOD["beam_stiffness"]) * span / 12.0  # EI_b
    size = 4 * n  # u, φ of the joint, φ of both rollers
    k = np.zeros((size + 4, size + 4))
    for i, (length, ei) in enumerate(zip(GOOD["story_heights"], GOOD["column_stiffness"], strict=True)):
        at = [4 * i, 4 * i + 1, 4 * i + 4, 4 * i + 5]
        h = length
        k[np.ix_(at, at)] += (
            ei
            / h**3
            * np.array(
                [
                    [12, 6 * h, -12, 6 * h],
                    [6 * h, 4 * h**2, -6 * h, 2 * h**2],
                    [-12, -6 * h, 12, -6 * h],
                    [6 * h, 2 * h**2, -6 * h, 4 * h**2],
                ]
            )
        )
        half = span / 2.0
        for roller in (4 * i + 6, 4 * i + 7):
            ends = [4 * i + 5, roller]
            k[np.ix_(ends, ends)] += beams[i] / half * np.array([[4.0, 2.0], [2.0, 4.0]])
    k = k[4:, 4:]
    mass = np.zeros(size)
    mass[::4] = GOOD["masses"]
    heights = dict(zip(range(0, size, 4), np.cumsum(GOOD["story_heights"]), strict=True))
    other = rf.from_matrices(
        mass,
        k,
        heights,
        rotations=[i for i in range(size) if i % 4],
        base_mass=20e3,
        half_width=2.0,
        damping_ratio=0.05,
    )
    for name in ("omega", "effective_mass", "effective_height", "top_ordinate", "i_theta"):
        np.testing.assert_allclose(getattr(fish_bone().rocking(), name), getattr(other.rocking(), name), rtol=1e-11)


def test_height_and_modes():
    structure = fish_bone()
    assert structure.height == 9.5
    assert structure.modal(2).n_modes == structure.rocking(2).n_modes == 2
    np.testing.assert_array_equal(structure.damping_ratio, [0.05] * 3)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"story_heights": []}, "story_heights must contain at least one height in m, but none was given"),
        ({"story_heights": [4.0, -3.0, 2.0]}, r"story_heights must be positive, but story_heights\[1\] = -3 m was"),
        ({"masses": [1.0, 2.0]}, "masses must be one number, or one for each of the 3 stories, but 2 were given"),
        ({"masses": [1.0, 2.0, 0.0]}, r"masses must be positive, but masses\[2\] = 0 kg was given"),
        ({"column_stiffness": 0.0}, "column_stiffness must be a positive, finite number in N m²"),
        ({"beam_stiffness": [1.0, -1.0, 2.0]}, r"beam_stiffness must be one number, or one for each of the 3"),
        ({"beam_stiffness": "stiff"}, "rigid beams\\) in N m/rad, but 'stiff' was given"),
        ({"damping_ratio": 1.0}, r"damping_ratio must lie in \[0, 1\)"),
    ],
)
def test_refused(changes, words):
    with pytest.raises(InputError, match=words):
        fish_bone(**changes)
