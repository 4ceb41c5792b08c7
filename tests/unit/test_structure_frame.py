"""The frame against closed forms, exact algebra and assemblies that share nothing with it."""

import dataclasses
import math

import numpy as np
import pytest
import scipy.linalg
import sympy

from rockflex.foundation.errors import InputError
from rockflex.structure import Frame

GOOD = {
    "n_stories": 4,
    "story_height": 3.0,
    "story_mass": 40e3,
    "base_mass": 20e3,
    "stiffness_ratio": 0.125,
    "period": 0.8,
    "aspect_ratio": 6.0,
    "damping_ratio": 0.05,
}


def frame(**changes):
    return Frame(**(GOOD | changes))


def bar_stiffness(start, end, axial, bending):
    """Stiffness (6, 6) of a plane bar in global axes: (u, w, φ) at each end."""
    (dx, dz), length = np.subtract(end, start), math.dist(start, end)
    c, s, a, b = dx / length, dz / length, axial / length, bending / length**3
    local = np.zeros((6, 6))
    local[np.ix_([0, 3], [0, 3])] = [[a, -a], [-a, a]]
    local[np.ix_([1, 2, 4, 5], [1, 2, 4, 5])] = b * np.array(
        [
            [12, 6 * length, -12, 6 * length],
            [6 * length, 4 * length**2, -6 * length, 2 * length**2],
            [-12, -6 * length, 12, -6 * length],
            [6 * length, 2 * length**2, -6 * length, 4 * length**2],
        ]
    )
    turn = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
    both = scipy.linalg.block_diag(turn, turn)
    return both.T @ local @ both


def plane_frame_modes(n, story_height, bay_width, ratio, floor_mass):
    """Frequencies and Γφ at the left joints, from a frame with three freedoms at each of its joints."""
    column = 1.0
    beam = ratio * 2.0 * column / story_height * bay_width
    axial = 1e7 * column / story_height**2
    joints = [(x, i * story_height) for i in range(n + 1) for x in (0.0, bay_width)]
    bars = [(2 * i + side, 2 * i + 2 + side, column) for i in range(n) for side in (0, 1)]
    bars += [(2 * i, 2 * i + 1, beam) for i in range(1, n + 1)]
    stiffness = np.zeros((6 * (n + 1), 6 * (n + 1)))
    for a, b, bending in bars:
        freedoms = [*range(3 * a, 3 * a + 3), *range(3 * b, 3 * b + 3)]
        stiffness[np.ix_(freedoms, freedoms)] += bar_stiffness(joints[a], joints[b], axial, bending)
    stiffness = stiffness[6:, 6:]
    sway = np.arange(0, 6 * n, 3)
    flexibility = np.linalg.inv(stiffness)[np.ix_(sway, sway)]
    # Half of the floor mass at each joint; the axial modes of the beams come last.
    values, vectors = np.linalg.eigh(flexibility * floor_mass / 2.0)
    values, vectors = values[::-1][:n], vectors[:, ::-1][:, :n]
    return values**-0.5, (vectors * vectors.sum(axis=0))[::2]


@pytest.mark.parametrize("bay_width", [2.0, 9.0])
@pytest.mark.parametrize("ratio", [0.0, 0.125, 1.0, 30.0])
@pytest.mark.parametrize("n", [1, 2, 4])
def test_frame_with_three_freedoms_a_joint(n, ratio, bay_width):
    omega, displacement = plane_frame_modes(n, 3.0, bay_width, ratio, 40e3)
    props = frame(n_stories=n, stiffness_ratio=ratio, period=2.0 * np.pi / omega[0]).rocking()
    np.testing.assert_allclose(props.omega, omega, rtol=1e-4)
    np.testing.assert_allclose(props.floors.displacement, displacement, atol=1e-4)


@pytest.mark.parametrize("n", [1, 3, 8])
def test_no_beams_is_a_cantilever(n):
    cantilever = frame(n_stories=n, stiffness_ratio=0.0)
    h = cantilever.lumped.heights
    low, high = np.minimum.outer(h, h), np.maximum.outer(h, h)
    flexibility = low**2 * (3.0 * high - low) / 6.0
    product = cantilever.lumped.stiffness @ flexibility
    np.testing.assert_allclose(product / product[0, 0], np.eye(n), atol=1e-9)


@pytest.mark.parametrize("n", [1, 3, 8])
def test_no_beams_against_beam_elements(n):
    cantilever = frame(n_stories=n, stiffness_ratio=0.0)
    length = GOOD["story_height"]
    full = np.zeros((2 * n + 2, 2 * n + 2))
    for i in range(n):
        bar = bar_stiffness((0.0, 0.0), (length, 0.0), 0.0, 1.0)[np.ix_([1, 2, 4, 5], [1, 2, 4, 5])]
        full[2 * i : 2 * i + 4, 2 * i : 2 * i + 4] += bar
    flexibility = np.linalg.inv(full[2:, 2:])[::2, ::2]
    values = scipy.linalg.eigvalsh(GOOD["story_mass"] * flexibility)[::-1]
    omega = cantilever.modal().omega
    np.testing.assert_allclose(omega / omega[0], np.sqrt(values[0] / values), rtol=1e-8)


@pytest.mark.parametrize("n", [1, 3, 8])
def test_rigid_beams_are_a_shear_building(n):
    shear = frame(n_stories=n, stiffness_ratio=math.inf)
    pattern = 2.0 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)
    pattern[-1, -1] = 1.0
    np.testing.assert_allclose(shear.lumped.stiffness / shear.lumped.stiffness[-1, -1], pattern, rtol=1e-15)
    number = 2 * np.arange(1, n + 1) - 1
    sines = np.sin(number * np.pi / (2 * (2 * n + 1)))
    np.testing.assert_allclose(shear.modal().omega, 2.0 * np.pi / 0.8 * sines / sines[0], rtol=1e-12)


@pytest.mark.parametrize("ratio", [sympy.Integer(0), sympy.Rational(1, 8), sympy.Integer(3)])
def test_two_stories_exactly(ratio):
    sway = sympy.Matrix([[24, -12], [-12, 12]])
    coupling = sympy.Matrix([[0, 6], [-6, -6]])
    rotational = sympy.Matrix([[8, 2], [2, 4]]) + 12 * ratio * sympy.eye(2)
    exact = sway - coupling * rotational.inv() * coupling.T
    stiffness = frame(n_stories=2, stiffness_ratio=float(ratio)).lumped.stiffness
    expected = np.array((exact / exact[1, 1]).tolist(), dtype=float)
    np.testing.assert_allclose(stiffness / stiffness[1, 1], expected, rtol=1e-13)


@pytest.mark.parametrize(("limit", "near"), [(math.inf, lambda e: 1.0 / e), (0.0, lambda e: e)])
def test_limits_are_approached_at_first_order(limit, near):
    def departure(ratio):
        h = frame(stiffness_ratio=ratio).modal().effective_height
        return np.abs(h - frame(stiffness_ratio=limit).modal().effective_height).max()

    assert departure(near(1e-4)) / departure(near(1e-5)) == pytest.approx(10.0, rel=0.05)
    assert departure(near(1e-300)) < 1e-12


@pytest.mark.parametrize("ratio", [0.0, 0.125, math.inf])
@pytest.mark.parametrize("n", [1, 2, 5, 15])
def test_period_and_base_are_as_asked(n, ratio):
    asked = frame(n_stories=n, stiffness_ratio=ratio)
    assert asked.modal().period[0] == pytest.approx(0.8, rel=1e-11)
    assert asked.modal().effective_height[0] / asked.half_width == pytest.approx(6.0, rel=1e-11)
    assert asked.rocking().half_width == asked.half_width


@pytest.mark.parametrize("ratio", [0.0, 0.125, math.inf])
@pytest.mark.parametrize("n", [1, 2, 15])
def test_scaled_parameters_are_those_of_the_assembled_frame(n, ratio):
    asked = frame(n_stories=n, stiffness_ratio=ratio)
    scaled, assembled = asked.rocking(), asked.lumped.rocking()
    for field in dataclasses.fields(scaled):
        if field.name not in ("floors", "elements"):
            value = getattr(scaled, field.name)
            if value is None or isinstance(value, str):
                assert value == getattr(assembled, field.name)
                continue
            np.testing.assert_allclose(value, getattr(assembled, field.name), rtol=1e-9, err_msg=field.name)
    for name in ("heights", "displacement", "force"):
        value, other = (getattr(each.floors, name) for each in (scaled, assembled))
        np.testing.assert_allclose(value, other, rtol=1e-9, atol=1e-9 * abs(other).max(), err_msg=name)
        assert not value.flags.writeable
    assert not any(getattr(scaled, name).flags.writeable for name in ("omega", "effective_mass", "zeta"))
    assert scaled.elements == ()


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"period": 1e-200}, "stiffness of a frame with story_mass = 40000 kg and period = 1e-200 s cannot be"),
        ({"story_height": 1e200}, "cannot be computed: numbers arise"),
        ({"aspect_ratio": 1e12}, "i_theta"),
    ],
)
def test_extreme_frames_say_what_overflows(change, text):
    with pytest.raises(InputError, match=text):
        frame(**change).rocking()


@pytest.mark.parametrize("change", [{"period": 1e30}, {"aspect_ratio": 1e5}, {"base_mass": 1e30}])
def test_unusual_frames_are_assembled(change):
    asked = frame(**change)
    assert asked.rocking() is asked.lumped.rocking()


def test_geometry_and_masses():
    asked = frame(n_stories=3)
    assert asked.height == 9.0
    np.testing.assert_array_equal(asked.lumped.heights, [3.0, 6.0, 9.0])
    np.testing.assert_array_equal(asked.lumped.masses, 40e3)
    props = asked.rocking()
    assert props.m_tot == 140e3
    assert props.l0r == 40e3 * 18.0
    assert props.i_theta == pytest.approx(40e3 * 126.0 + 140e3 * asked.half_width**2, rel=1e-14)
    np.testing.assert_array_equal(props.zeta, 0.05)


def test_first_modes_and_caching():
    asked = frame()
    assert asked.lumped is asked.lumped
    assert asked.rocking() is asked.rocking()
    assert asked.modal(2).n_modes == 2
    assert asked.rocking(1).n_modes == 1
    with pytest.raises(InputError, match="n_modes must be a whole number from 1 to 4, but 5 was given"):
        asked.rocking(5)


def test_frames_are_values():
    assert frame() == frame(n_stories=np.int64(4), story_height=3)
    assert hash(frame()) == hash(frame())
    assert frame() != frame(period=0.9)
    assert type(frame(n_stories=np.int32(4)).n_stories) is int
    with pytest.raises(AttributeError):
        frame().period = 1.0
