"""Laws that hold for every structure: sums over all modes, scaling, positive rotational inertia."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from rockflex.structure import Frame, modal_properties, rocking_properties

positive = st.floats(0.1, 10.0)
entries = st.floats(-1.0, 1.0)


@st.composite
def definite(draw, n):
    factor = draw(arrays(float, (n, n), elements=entries))
    return factor @ factor.T + draw(positive) * np.eye(n)


@st.composite
def systems(draw):
    n = draw(st.integers(1, 7))
    mass = draw(st.one_of(arrays(float, n, elements=positive), definite(n)))
    return mass, 1e4 * draw(definite(n)), np.cumsum(draw(arrays(float, n, elements=positive)))


def full(mass):
    return np.diag(mass) if mass.ndim == 1 else mass


def shares(modal):
    """m*, m*h* and m*h*², which are zero for a mode that takes part in nothing."""
    height = np.nan_to_num(modal.effective_height)
    return modal.effective_mass, modal.effective_mass * height, modal.effective_mass * height**2


@given(systems())
def test_sums_over_all_modes(system):
    mass, _, heights = system
    modal = modal_properties(*system)
    assume(not np.isinf(modal.effective_height).any())
    m, mh, mhh = shares(modal)
    matrix, ones = full(mass), np.ones_like(heights)
    assert m.sum() == pytest.approx(ones @ matrix @ ones, rel=1e-9)
    assert mh.sum() == pytest.approx(ones @ matrix @ heights, rel=1e-9)
    assert mhh.sum() == pytest.approx(heights @ matrix @ heights, rel=1e-7)


@given(systems())
def test_modes_are_orthogonal(system):
    mass, stiffness, _ = system
    modal = modal_properties(*system)
    shapes = modal.shapes / np.linalg.norm(modal.shapes, axis=0)
    generalised = shapes.T @ full(mass) @ shapes
    np.testing.assert_allclose(generalised, np.diag(np.diag(generalised)), atol=1e-8)
    np.testing.assert_allclose(
        shapes.T @ stiffness @ shapes, generalised * modal.omega**2, atol=1e-7 * np.abs(stiffness).max()
    )


@given(systems(), st.integers(-30, 30), st.integers(-30, 30))
def test_scaling(system, mass_power, stiffness_power):
    mass, stiffness, heights = system
    a, b = 4.0**mass_power, 4.0**stiffness_power
    one, other = modal_properties(*system), modal_properties(a * mass, b * stiffness, 2.0 * heights)
    np.testing.assert_allclose(other.omega, one.omega * np.sqrt(b / a), rtol=1e-9)
    gap = (np.diff(one.omega) / one.omega[1:]).min(initial=1.0)
    assume(gap > 1e-3)  # else the shapes are not unique
    # Subnormal stiffnesses do not scale exactly, and an eigenvector magnifies rounding by the inverse of the gap.
    rounding = 1e-14 / gap * np.abs(one.shapes).max()
    np.testing.assert_allclose(other.shapes, one.shapes, rtol=1e-9, atol=rounding)
    np.testing.assert_allclose(other.effective_mass, a * one.effective_mass, rtol=1e-9)
    np.testing.assert_allclose(other.effective_height, 2.0 * one.effective_height, rtol=1e-9)


@given(systems(), st.floats(0.0, 5.0), positive)
def test_the_base_always_keeps_inertia_to_rotate(system, base_mass, half_width):
    mass, _, heights = system
    modal = modal_properties(*system)
    assume(not np.isinf(modal.effective_height).any())
    props = rocking_properties(modal, mass, heights, base_mass, half_width, 0.02)
    modal_inertia = props.effective_mass @ props.effective_height**2
    left = props.m_tot * half_width**2
    assert props.i_theta - modal_inertia == pytest.approx(left, rel=1e-6, abs=1e-7 * props.i_theta)
    for k in range(1, props.n_modes + 1):
        first = props.truncated(k)
        assert first.translational_inertia >= first.effective_mass @ first.effective_height**2


@settings(max_examples=50)
@given(
    st.integers(1, 12),
    st.one_of(st.just(np.inf), st.floats(0.0, 1e6)),
    positive,
    st.floats(1.0, 1e6),
    st.floats(0.05, 5.0),
)
def test_frames_differ_only_by_story_count_and_stiffness_ratio(n, ratio, height, mass, period):
    def modes(h, m, t):
        return Frame(n, h, m, m, ratio, t, 8.0, 0.02).modal()

    one, other = modes(1.0, 1.0, 1.0), modes(height, mass, period)
    np.testing.assert_allclose(other.omega, one.omega / period, rtol=1e-8)
    np.testing.assert_allclose(other.effective_mass, mass * one.effective_mass, rtol=1e-6)
    np.testing.assert_allclose(other.effective_height, height * one.effective_height, rtol=1e-6)


@settings(max_examples=30)
@given(st.integers(2, 12), st.floats(0.0, 100.0), st.floats(0.01, 100.0))
def test_stiffer_beams_lower_the_first_effective_height(n, ratio, more):
    def height(r):
        return Frame(n, 1.0, 1.0, 1.0, r, 1.0, 8.0, 0.02).modal().effective_height[0]

    assert height(ratio + more) < height(ratio)
