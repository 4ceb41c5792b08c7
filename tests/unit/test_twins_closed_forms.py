"""Both twins against closed forms: rigid limit, energy, impact loss, a step on a fixed base, overturning."""

import numpy as np
import pytest

from twins.fine_step import simulate_fine
from twins.frame import frame_properties
from twins.ode import simulate_ode
from twins.result import InitialState

GRAVITY = 9.81


def restarted(**run):
    return simulate_ode(**run, restart_every_sample=True, rtol=1e-12)


TWINS = pytest.mark.parametrize("twin", [simulate_fine, restarted])


def nearly_rigid(omega):
    """One stiff mode on a base; p² = L g / I and α = M B / L in the limit."""
    return {
        "omega": np.array([omega]),
        "m_eff": np.array([9e4]),
        "h_eff": np.array([8.0]),
        "top_ordinate": np.array([1.0]),
        "i_theta": 1.1e7,
        "l0r": 9e5,
        "m_tot": 1.4e5,
        "half_width": 0.8,
        "zeta": 0.0,
    }


def rate_and_slenderness(p):
    return np.sqrt(p["l0r"] * GRAVITY / p["i_theta"]), p["m_tot"] * p["half_width"] / p["l0r"]


@TWINS
@pytest.mark.parametrize("fraction", [0.2, -0.7])
def test_quarter_period_in_the_rigid_limit(twin, fraction):
    p = nearly_rigid(500.0)
    rate, alpha = rate_and_slenderness(p)
    # D starts at its quasi-static value, so that it does not ring.
    turn = rate**2 * alpha * (fraction - np.sign(fraction))
    start = InitialState(fraction * alpha, -p["h_eff"] * turn / p["omega"] ** 2)
    result = twin(**p, acceleration=np.zeros(241), dt=0.01, initial=start)
    expected = np.arccosh(1.0 / (1.0 - abs(fraction))) / rate
    assert result.impact_times[0] == pytest.approx(expected, rel=1e-5)


def energy(p, state):
    """½ q'ᵀ M q' + ½ Σ m* ω² D² + M_r |θ| - ½ L g θ², of which Eq. 23 is the equation of motion."""
    n = p["omega"].size
    turn, speed, d, v = state[0], state[1], state[2 : 2 + n], state[2 + n :]
    m, h = p["m_eff"], p["h_eff"]
    kinetic = 0.5 * p["i_theta"] * speed**2 + speed * (m * h) @ v + 0.5 * m @ v**2
    weight = p["m_tot"] * GRAVITY * p["half_width"] * abs(turn) - 0.5 * p["l0r"] * GRAVITY * turn**2
    return kinetic + 0.5 * m @ (p["omega"] * d) ** 2 + weight


@TWINS
@pytest.mark.parametrize("n_modes", [1, 3])
def test_energy_is_lost_at_impacts_only(twin, n_modes):
    p = frame_properties(
        n_stories=3,
        story_height=3.0,
        story_mass=40e3,
        base_mass=120e3,
        stiffness_ratio=np.inf,
        period=0.5,
        aspect_ratio=6.0,
        damping_ratio=0.0,
        n_modes=n_modes,
    ).kwargs()
    alpha = p["m_tot"] * p["half_width"] / p["l0r"]
    result = twin(**p, acceleration=np.zeros(301), dt=0.02, initial=InitialState(0.4 * alpha))
    assert result.n_impacts >= 5
    left = energy(p, result.history[0])
    spare = p["i_theta"] - p["m_eff"] @ p["h_eff"] ** 2
    for state in result.impact_states:
        assert energy(p, state) == pytest.approx(left, rel=1e-10)
        left -= 0.5 * state[1] ** 2 * spare
    assert energy(p, result.final_state) == pytest.approx(left, rel=1e-10)


@TWINS
def test_step_on_a_fixed_base(twin):
    p = {**nearly_rigid(10.0), "zeta": 0.05, "fixed": True}
    result = twin(**p, acceleration=np.full(51, 2.0), dt=0.013)
    damped = np.sqrt(1.0 - 0.05**2)
    peak = 2.0 / 100.0 * (1.0 + np.exp(-np.pi * 0.05 / damped))
    assert result.max_top_displacement == pytest.approx(peak, rel=1e-12)
    assert result.time_of_max_top_displacement == pytest.approx(np.pi / (10.0 * damped), rel=1e-6)
    assert result.max_base_shear == pytest.approx(9e4 * 100.0 * peak, rel=1e-12)
    assert result.max_base_moment == pytest.approx(8.0 * 9e4 * 100.0 * peak, rel=1e-12)


@pytest.mark.parametrize(("frequency", "least"), [(2.0, 1.800724), (5.0, 3.289147)])
def test_least_half_sine_that_overturns_in_the_rigid_limit(frequency, least):
    p = nearly_rigid(400.0)
    rate, alpha = rate_and_slenderness(p)
    n = 150
    pulse = GRAVITY * alpha * np.sin(np.linspace(0.0, np.pi, n + 1))
    run = dict(p, dt=np.pi / (frequency * rate) / n, free_vibration=12.0, substeps=8)
    assert simulate_fine(**run, acceleration=-1.003 * least * pulse).status == "overturned"
    returned = simulate_fine(**run, acceleration=-0.997 * least * pulse)
    assert returned.impact_times.size > 0
    assert returned.max_rotation < alpha
