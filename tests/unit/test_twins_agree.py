"""The two twins share no equation and no method: on any run they must give the same answer."""

import numpy as np
import pytest

from twins.exact import Exact
from twins.fine_step import simulate_fine
from twins.frame import frame_properties
from twins.ode import simulate_ode
from twins.result import InitialState

PEAKS = ("max_rotation", "max_top_displacement", "max_base_moment", "max_base_shear")


def frame(n_modes=3, **changes):
    given = {
        "n_stories": 4,
        "story_height": 3.0,
        "story_mass": 40e3,
        "base_mass": 60e3,
        "stiffness_ratio": 0.125,
        "period": 0.6,
        "aspect_ratio": 9.0,
        "damping_ratio": 0.02,
        "n_modes": n_modes,
    }
    return frame_properties(**{**given, **changes}).kwargs()


def shaking(dt=0.02, duration=4.0):
    """Two sines under an envelope; starts and ends away from zero."""
    t = np.arange(0.0, duration + 0.5 * dt, dt)
    return 3.5 * np.sin(np.pi * (t + 0.2) / (duration + 0.5)) * (np.sin(9.0 * t + 0.4) + 0.6 * np.sin(27.0 * t))


def assert_same(one, two, rtol):
    assert (one.status, one.n_uplifts, one.n_impacts) == (two.status, two.n_uplifts, two.n_impacts)
    assert one.final_side == two.final_side
    for name in PEAKS:
        assert getattr(one, name) == pytest.approx(getattr(two, name), rel=rtol), name
        # At a summit the value is flat: its time is known to half the digits.
        assert getattr(one, f"time_of_{name}") == pytest.approx(
            getattr(two, f"time_of_{name}"), abs=100 * np.sqrt(rtol)
        )
    np.testing.assert_allclose(one.uplift_times, two.uplift_times, atol=1e3 * rtol)
    np.testing.assert_allclose(one.impact_times, two.impact_times, atol=1e3 * rtol)
    scale = abs(two.history).max(axis=0) + 1e-12
    np.testing.assert_allclose(one.final_state / scale, two.final_state / scale, atol=1e4 * rtol)


@pytest.mark.parametrize("n_modes", [1, 3, 4])
def test_restarted_integration_against_exponentials(n_modes):
    run = dict(frame(n_modes), acceleration=shaking(), dt=0.02, free_vibration=1.0)
    fine = simulate_fine(**run)
    ode = simulate_ode(**run, restart_every_sample=True, rtol=1e-12)
    assert fine.n_uplifts > 3
    assert_same(ode, fine, rtol=1e-11)
    scale = abs(fine.history).max(axis=0)
    np.testing.assert_allclose(ode.history / scale, fine.history / scale, atol=1e-8)


@pytest.mark.parametrize(
    ("method", "rtol", "expected"), [("DOP853", 1e-10, 1e-7), ("LSODA", 1e-10, 1e-7), ("LSODA", 1e-7, 1e-4)]
)
def test_record_handed_over_whole(method, rtol, expected):
    run = dict(frame(2), acceleration=shaking(), dt=0.02, free_vibration=0.5)
    ode = simulate_ode(**run, method=method, rtol=rtol)
    assert ode.history is None
    assert_same(ode, simulate_fine(**run), rtol=expected)


def test_without_refinement_the_largest_step_counts():
    run = dict(frame(2), acceleration=shaking(), dt=0.02)
    rough, true = simulate_ode(**run, refine=False), simulate_ode(**run)
    assert rough.n_uplifts == true.n_uplifts
    for name in PEAKS:
        loss = 1.0 - getattr(rough, name) / getattr(true, name)
        assert -1e-7 < loss < 0.02


def test_number_of_sub_samples_does_not_matter():
    # White noise sampled at a sixth of the period: some rocking phases are shorter than a sample.
    record = 0.9 * np.random.default_rng(4).standard_normal(60)
    run = {**frame(4, period=0.3, stiffness_ratio=np.inf), "acceleration": record, "dt": 0.05}
    coarse, fine = simulate_fine(**run, substeps=8), simulate_fine(**run, substeps=700)
    assert (fine.impact_times - fine.uplift_times[: fine.n_impacts]).min() < 0.05
    assert_same(coarse, fine, rtol=1e-12)
    assert_same(simulate_ode(**run, restart_every_sample=True, rtol=1e-12), fine, rtol=1e-11)


@pytest.mark.parametrize("excess", [1e-2, 1e-5, 1e-8])
def test_barely_lifting_base_is_not_missed(excess):
    # Undamped and with all modes, the overturning moment of Eq. 24 is minus the elastic base moment.
    run = {**frame(4, damping_ratio=0.0), "dt": 0.02}
    resisting = run["m_tot"] * 9.81 * run["half_width"]
    record = np.append(shaking(duration=2.0), np.zeros(5))
    needed = resisting / simulate_fine(**run, acceleration=record, fixed=True).max_base_moment
    run["acceleration"] = record * needed * (1.0 + excess)
    fine, ode = simulate_fine(**run), simulate_ode(**run, restart_every_sample=True, rtol=1e-12)
    assert fine.n_uplifts == ode.n_uplifts >= 1
    assert fine.max_rotation == pytest.approx(ode.max_rotation, rel=1e-12 / excess + 1e-9, abs=0.0)
    if excess < 1e-3:  # the guard's summit is a parabola: time grows like √excess, rotation like excess²
        assert fine.max_rotation / excess**2 == pytest.approx(0.4184, rel=2e-3)
    run["acceleration"] = record * needed * (1.0 - 1e-8)
    assert simulate_fine(**run).status == "no_uplift"
    assert simulate_ode(**run, restart_every_sample=True, rtol=1e-12).status == "no_uplift"


def test_mirrored_record_mirrors_the_response():
    run = dict(frame(2), dt=0.02)
    one, two = simulate_fine(**run, acceleration=shaking()), simulate_fine(**run, acceleration=-shaking())
    np.testing.assert_array_equal(one.history, -two.history)


def test_a_jump_of_the_excitation_lifts_the_base_at_once():
    # A rectangular pulse strong enough for Eq. 24 with D = 0; one mode, so that L - Σ m* h* is not zero.
    run = dict(frame(1), dt=0.01, free_vibration=1.0)
    needed = run["m_tot"] * 9.81 * run["half_width"] / (run["l0r"] - run["m_eff"] @ run["h_eff"])
    run["acceleration"] = np.full(21, 1.2 * abs(needed))
    fine, ode = simulate_fine(**run), simulate_ode(**run, restart_every_sample=True, rtol=1e-12)
    assert fine.uplift_times[0] == 0.0
    assert_same(ode, fine, rtol=1e-11)


def test_fixed_base_never_lifts():
    run = dict(frame(3), acceleration=4 * shaking(), dt=0.02, fixed=True)
    fine, ode = simulate_fine(**run), simulate_ode(**run, restart_every_sample=True, rtol=1e-12)
    assert fine.status == "no_uplift"
    assert fine.max_rotation == 0.0
    assert_same(ode, fine, rtol=1e-11)


def test_initial_modal_state():
    start = InitialState(0.0, np.array([0.02, 0.001]), np.array([0.1, -0.2]))
    run = dict(frame(2), acceleration=np.zeros(101), dt=0.02, initial=start)
    assert_same(simulate_ode(**run, rtol=1e-12), simulate_fine(**run), rtol=1e-11)


def test_overturning_stops_the_run():
    run = dict(frame(1), acceleration=np.zeros(1001), dt=0.02)
    run["initial"] = InitialState(-1.5 * run["m_tot"] * run["half_width"] / run["l0r"])
    fine, ode = simulate_fine(**run), simulate_ode(**run, restart_every_sample=True, rtol=1e-12)
    assert fine.status == "overturned"
    assert fine.max_rotation == ode.max_rotation == np.pi / 2
    assert fine.final_state[0] == ode.final_state[0] == -np.pi / 2
    assert fine.final_time == pytest.approx(ode.final_time, abs=1e-10)
    assert fine.final_time < 20.0


@pytest.mark.parametrize("phase", [False, True])
def test_series_is_the_dense_exponential(phase):
    ex = Exact(**frame(4), dt=0.02, substeps=64)
    z = np.random.default_rng(1).standard_normal(13)
    z[ex.side] = float(phase)
    if not phase:
        z[[0, ex.angular_velocity]] = 0.0
    np.testing.assert_allclose(ex.inside(z, ex.step), ex.stack[phase][0] @ z, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("tau", [1e-5, 1e-7, 1e-9])
def test_rotation_grows_with_the_cube_of_time_after_a_continuous_uplift(tau):
    p = frame(1)
    ex = Exact(**p, dt=0.02, substeps=64)
    w, moment_arm, zeta, v = p["omega"][0], (p["m_eff"] * p["h_eff"])[0], p["zeta"], 0.5
    d = ex.resisting / (moment_arm * w**2) - 2 * zeta * v / w  # no excitation: Eq. 24 as an equality
    z = np.array([0.0, d, 0.0, v, 1.0, 0.0, 0.0])
    guard_rate = moment_arm * (w**2 * v - 2 * zeta * w * (2 * zeta * w * v + w**2 * d))
    inertia = p["i_theta"] - p["m_eff"] @ p["h_eff"] ** 2
    assert ex.inside(z, tau)[0] == pytest.approx(guard_rate / inertia * tau**3 / 6, rel=1e-3)


@pytest.mark.parametrize("twin", [simulate_fine, simulate_ode])
def test_impossible_initial_rotation(twin):
    run = dict(frame(1), acceleration=np.zeros(5), dt=0.02)
    for more in ({"initial": InitialState(1.6)}, {"initial": InitialState(0.01), "fixed": True}):
        with pytest.raises(ValueError, match="initial rotation must lie within"):
            twin(**run, **more)


def test_too_few_sub_samples():
    with pytest.raises(ValueError, match=r"substeps=2 is too coarse: take at least \d+"):
        simulate_fine(**frame(4), acceleration=np.zeros(5), dt=0.05, substeps=2)


def test_ode_refuses_an_impossible_inertia():
    with pytest.raises(ValueError, match="must exceed"):
        simulate_ode(**{**frame(1), "i_theta": 1.0}, acceleration=np.zeros(5), dt=0.02)
