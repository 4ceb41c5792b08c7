"""The twin of matrix exponentials and that of SciPy's integrator share no method: on any run they are the same."""

import numpy as np
import pytest

from builders import make_frame
from twins.controlled import ControlledTwin
from twins.exact import Exact
from twins.fine_step import simulate_fine
from twins.frame import frame_properties

FRAME = {
    "n_stories": 4,
    "base_mass": 60e3,
    "stiffness_ratio": 0.125,
    "period": 0.6,
    "aspect_ratio": 9.0,
    "damping_ratio": 0.02,
}
OTHERS = {"story_height": 3.0, "story_mass": 40e3}
PEAKS = ("max_rotation", "max_top_displacement", "max_base_moment", "max_base_shear")


def both(n_modes, record, dt=0.02, **changes):
    """The run of each; the properties of the structure come from the package for one, from the twins for the other."""
    fine = simulate_fine(**properties(n_modes, **changes), acceleration=record, dt=dt, free_vibration=1.0)
    ode = ControlledTwin.of(make_frame(**FRAME | changes).rocking(n_modes), [], rtol=1e-12).run(record, dt, 1.0)
    return fine, ode


def properties(n_modes, **changes):
    return frame_properties(**FRAME | OTHERS | changes, n_modes=n_modes)


def shaking(dt=0.02, duration=4.0):
    """Two sines under an envelope; starts and ends away from zero."""
    t = np.arange(0.0, duration + 0.5 * dt, dt)
    return 3.5 * np.sin(np.pi * (t + 0.2) / (duration + 0.5)) * (np.sin(9.0 * t + 0.4) + 0.6 * np.sin(27.0 * t))


def assert_same(one, two, rtol):
    assert (one.status, one.n_uplifts, one.n_impacts) == (two.status, two.n_uplifts, two.n_impacts)
    for name in PEAKS:
        assert getattr(one, name) == pytest.approx(getattr(two, name), rel=rtol), name
    np.testing.assert_allclose(one.uplift_times, two.uplift_times, atol=1e3 * rtol)
    np.testing.assert_allclose(one.impact_times, two.impact_times, atol=1e3 * rtol)


@pytest.mark.slow
@pytest.mark.parametrize("n_modes", [1, 3, 4])
def test_integration_against_exponentials(n_modes):
    fine, ode = both(n_modes, shaking())
    assert fine.n_uplifts > 3
    assert_same(ode, fine, rtol=1e-9)


@pytest.mark.slow
def test_number_of_sub_samples_does_not_matter():
    # White noise sampled at a sixth of the period: some rocking phases are shorter than a sample.
    record, stiff = 0.9 * np.random.default_rng(4).standard_normal(60), {"period": 0.3, "stiffness_ratio": np.inf}
    run = {**properties(4, **stiff), "acceleration": record, "dt": 0.05, "free_vibration": 1.0}
    coarse, fine = simulate_fine(**run, substeps=8), simulate_fine(**run, substeps=700)
    assert (fine.impact_times - fine.uplift_times[: fine.n_impacts]).min() < 0.05
    assert_same(coarse, fine, rtol=1e-12)
    assert_same(both(4, record, 0.05, **stiff)[1], fine, rtol=1e-9)


@pytest.mark.parametrize("phase", [False, True])
def test_series_is_the_dense_exponential(phase):
    ex = Exact(**properties(4), dt=0.02, substeps=64)
    z = np.random.default_rng(1).standard_normal(13)
    z[ex.side] = float(phase)
    if not phase:
        z[[0, ex.angular_velocity]] = 0.0
    np.testing.assert_allclose(ex.inside(z, ex.step), ex.stack[phase][0] @ z, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("tau", [1e-5, 1e-7, 1e-9])
def test_rotation_grows_with_the_cube_of_time_after_a_continuous_uplift(tau):
    p = properties(1)
    ex = Exact(**p, dt=0.02, substeps=64)
    w, moment_arm, zeta, v = p["omega"][0], (p["effective_mass"] * p["effective_height"])[0], p["zeta"], 0.5
    d = ex.resisting / (moment_arm * w**2) - 2 * zeta * v / w  # no excitation: Eq. 24 as an equality
    z = np.array([0.0, d, 0.0, v, 1.0, 0.0, 0.0])
    guard_rate = moment_arm * (w**2 * v - 2 * zeta * w * (2 * zeta * w * v + w**2 * d))
    inertia = p["i_theta"] - p["effective_mass"] @ p["effective_height"] ** 2
    assert ex.inside(z, tau)[0] == pytest.approx(guard_rate / inertia * tau**3 / 6, rel=1e-3)
