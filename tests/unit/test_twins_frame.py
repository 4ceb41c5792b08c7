"""The twins' own frame, against closed forms and published uplifted frequencies."""

import numpy as np
import pytest
from scipy.linalg import eigh

from twins.frame import frame_properties, frame_stiffness

GRAVITY = 9.81


def frame(stiffness_ratio, n_stories=15, n_modes=None, damping_ratio=0.02):
    return frame_properties(
        n_stories=n_stories,
        story_height=3.0,
        story_mass=40e3,
        base_mass=40e3,
        stiffness_ratio=stiffness_ratio,
        period=1.0,
        aspect_ratio=10.0,
        damping_ratio=damping_ratio,
        n_modes=n_modes,
    )


def test_shear_building_frequencies():
    n = np.arange(1, 8)
    expected = np.sin((2 * n - 1) * np.pi / 30) / np.sin(np.pi / 30) * 2 * np.pi
    np.testing.assert_allclose(frame(np.inf, n_stories=7).omega, expected, rtol=1e-11)


def test_no_beams_is_two_cantilevers():
    x = 2.5 * np.arange(1.0, 7.0)
    low, high = np.minimum.outer(x, x), np.maximum.outer(x, x)
    flexibility = low**2 * (3 * high - low) / 6 / 2
    np.testing.assert_allclose(frame_stiffness(6, 2.5, 0.0) @ flexibility, np.eye(6), atol=1e-10)


@pytest.mark.parametrize("rho", [0.0, 0.125, 2.0])
def test_portal_frame(rho):
    expected = 24 / 3.0**3 * (12 * rho + 1) / (12 * rho + 4)
    assert frame_stiffness(1, 3.0, rho)[0, 0] == pytest.approx(expected, rel=1e-13)


@pytest.mark.parametrize("rho", [0.0, 0.125, np.inf])
def test_modal_sums(rho):
    p = frame(rho, n_stories=6)
    height = 3.0 * np.arange(1, 7)
    assert p.m_eff.sum() == pytest.approx(240e3)
    assert p.m_eff @ p.h_eff == pytest.approx(p.l0r)
    assert p.m_eff @ p.h_eff**2 == pytest.approx(40e3 * height @ height)
    assert p.top_ordinate.sum() == pytest.approx(1.0)
    assert p.half_width == pytest.approx(p.h_eff[0] / 10)
    assert p.i_theta == pytest.approx(40e3 * height @ height + 280e3 * p.half_width**2)


@pytest.mark.parametrize(
    ("rho", "n_modes", "first"),
    [
        (np.inf, 1, 6.116),
        (np.inf, 2, 2.840),
        (np.inf, 15, 2.839),
        (0.0, 1, 4.705),
        (0.0, 2, 4.038),
        (0.0, 15, 4.034),
    ],
)
def test_uplifted_frequency(rho, n_modes, first):
    p = frame(rho, n_modes=n_modes)
    coupling = p.m_eff * p.h_eff
    mass = np.block([[np.array([[p.i_theta]]), coupling[None]], [coupling[:, None], np.diag(p.m_eff)]])
    stiffness = np.diag(np.concatenate([[-p.l0r * GRAVITY], p.m_eff * p.omega**2]))
    square = eigh(stiffness, mass, eigvals_only=True)
    assert square[0] < 0.0
    assert np.sqrt(square[1]) / p.omega[0] == pytest.approx(first, abs=1e-3)
