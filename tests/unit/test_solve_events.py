"""Uplift, impact and overturning where they are hard to see: in corners, at jumps, within a sample."""

import math

import numpy as np
import pytest

from builders import frame_values
from rockflex import Frame, GroundMotion, InitialState, RockingProperties, quiet_motion, rigid_block, simulate
from rockflex.models import Model
from rockflex.models._state_layout import GROUND, HEADER
from twins.controlled import ControlledTwin
from twins.fine_step import simulate_fine
from twins.frame import frame_properties

GRAVITY = 9.81
PEAKS = ("rotation", "top_displacement", "base_moment", "base_shear")


def frame(**changes):
    given = frame_values(n_stories=4, base_mass=60e3, period=0.6, aspect_ratio=9.0)
    return {**given, **changes}


def both(given, record, dt, n_modes=None, *, substeps=64, **options):
    """A run and its twin on the same frame; 64 looks a sample."""
    label = "MDOF-S" if n_modes is None else f"{n_modes + 1}DOF-S"
    mine = simulate(Frame(**given), GroundMotion(record, dt), label, **options)
    parameters = frame_properties(**given, n_modes=n_modes)
    return mine, simulate_fine(**parameters, acceleration=record, dt=dt, substeps=substeps, **options)


def assert_same(mine, twin, rtol=1e-10, atol=1e-10):
    assert (mine.status, mine.n_uplifts, mine.n_impacts) == (twin.status, twin.n_uplifts, twin.n_impacts)
    for name in PEAKS:
        assert getattr(mine, f"max_{name}") == pytest.approx(getattr(twin, f"max_{name}"), rel=rtol, abs=0.0), name
    np.testing.assert_allclose(mine.uplift_times, twin.uplift_times, rtol=0.0, atol=atol)
    np.testing.assert_allclose(mine.impact_times, twin.impact_times, rtol=0.0, atol=atol)


def block(**changes):
    """A nearly rigid block on a base: one stiff mode, which takes a part of the moment alone."""
    given = {
        "omega": [500.0],
        "effective_mass": [2e4],
        "effective_height": [8.0],
        "top_ordinate": [1.0],
        "i_theta": 1.1e7,
        "l0r": 9e5,
        "m_tot": 1.4e5,
        "half_width": 0.8,
        "zeta": 0.05,
    }
    return RockingProperties(**{**given, **changes})


def rate_and_slenderness(p):
    return math.sqrt(p.l0r * GRAVITY / p.i_theta), p.m_tot * p.half_width / p.l0r


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 2, 3])
def test_rocking_shorter_than_a_sample(seed):
    """White noise sampled at a sixth of the period, a third above what lifts the base."""
    given, record = frame(period=0.3), np.random.default_rng(seed).standard_normal(120)
    fixed = simulate(Frame(**given), GroundMotion(record, 0.05), "fixed")
    record *= 1.3 * Frame(**given).rocking().resisting_moment / fixed.max_base_moment
    mine, twin = both(given, record, 0.05, substeps=256)
    lasted = mine.impact_times - mine.uplift_times[: mine.n_impacts]
    assert lasted.min() < 0.035
    assert_same(mine, twin, rtol=1e-9, atol=1e-9)


def test_several_phases_within_one_sample():
    record = np.zeros(12)
    record[1:-1:2], record[2:-1:2] = 4.0, -4.0
    mine, twin = both(frame(period=0.2), record, 0.3, substeps=1024)
    assert np.bincount((mine.impact_times / 0.3).astype(int)).max() >= 3
    assert_same(mine, twin, rtol=1e-9, atol=1e-9)


def test_a_peak_between_an_event_and_the_next_sample():
    """Here the base shear culminates, for a fraction of a sample, right after an event."""
    given = frame(n_stories=2, base_mass=40e3, period=1.0, aspect_ratio=6.0, damping_ratio=0.03)
    mine, twin = both(given, 2.5 * np.random.default_rng(33).standard_normal(60), 0.1)
    when = mine.time_of_max_base_shear
    events = np.concatenate((mine.uplift_times, mine.impact_times))
    assert np.any((events < when) & (events // 0.1 == when // 0.1))
    assert_same(mine, twin, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize(
    "record",
    [
        [0.5, 2.1, -2.5, 2.4, -0.1, -1.1, -1.1, -1.5, -0.3, 1.2],
        [2.4, 1.4, 1.6, -1.4, -0.8, -1.1, -2.4, -0.6, 1.2, 0.3],
    ],
)
def test_the_highest_excursion_may_be_shorter_than_two_samples(record):
    """In an integrated model, whose steps end with the samples: at both ends of a step the block is nearly down."""
    block, motion = rigid_block(slenderness=0.2, half_diagonal=5.0), GroundMotion(record, 0.05)
    run, finer = (simulate(block, each, "rigid-C", "peaks") for each in (motion, motion.refined(5)))
    assert 0.0 < run.max_rotation == pytest.approx(finer.max_rotation, rel=1e-9)
    assert run.max_rotation == pytest.approx(simulate(block, motion, "rigid", "peaks").max_rotation, rel=1e-3)


@pytest.mark.parametrize("excess", [1e-2, 1e-5, 1e-8])
def test_barely_lifting(excess):
    """Undamped with all modes, the overturning moment is minus the elastic base moment: the scale is known."""
    given, dt = frame(damping_ratio=0.0), 0.02
    t = np.arange(0.0, 2.0 + 0.5 * dt, dt)
    record = np.append(np.sin(np.pi * t / 2.0) * (3.0 * np.sin(9.0 * t) + 2.0 * np.sin(27.0 * t)), np.zeros(5))
    fixed = simulate(Frame(**given), GroundMotion(record, dt), "fixed")
    needed = Frame(**given).rocking().resisting_moment / fixed.max_base_moment
    mine, twin = both(given, record * needed * (1.0 + excess), dt)
    assert mine.n_uplifts >= 1
    assert_same(mine, twin, rtol=1e-12 / excess + 1e-9, atol=1e-9)
    if excess < 1e-3:  # the summit of the moment is a parabola
        assert mine.max_rotation < 0.1 * excess**1.5
    assert simulate(Frame(**given), GroundMotion(record * needed * (1.0 - 1e-9), dt)).status == "no_uplift"


@pytest.mark.parametrize("excess", [-1e-9, -1e-14, 0.0, 1e-14, 1e-9, 1e-3])
def test_a_moment_that_culminates_at_a_sample(excess):
    """A triangular pulse pushes a truncated model, whose moment follows it, to a corner at its middle sample."""
    p = block(omega=[200.0], zeta=0.3)
    record = np.concatenate((np.linspace(0.0, 1.0, 41), np.linspace(1.0, 0.0, 41)[1:]))
    fixed = simulate(p, GroundMotion(record, 0.05), "fixed").history.states
    vector = np.column_stack((fixed[:, HEADER:], fixed[:, GROUND], np.ones(len(fixed))))
    moment = np.abs(vector @ Model().of(p).overturning_moment((0,)))
    assert moment.argmax() == 40
    record *= p.resisting_moment / moment[40] * (1.0 + excess)
    run = simulate(p, GroundMotion(record, 0.05))
    assert run.n_uplifts <= 2
    if abs(excess) > 1e-12:
        assert (run.n_uplifts > 0) == (excess > 0.0)
    if run.n_uplifts:
        assert run.uplift_times[0] == pytest.approx(2.0, abs=1e-5 + 3.0 * abs(excess))
        assert run.max_rotation <= 1e-6 + 1e3 * excess**2


@pytest.mark.parametrize("samples", [1, 2, 7, 40])
def test_uplift_exactly_at_a_sample(samples):
    """A ramp of ground acceleration does not know how it is sampled: the uplift is put on the given sample."""
    given, slope = frame(damping_ratio=0.05), 3.0
    ramp = np.array([0.0, 1.0, 2.0, 3.0, 4.0])
    lifts = simulate(Frame(**given), GroundMotion(slope * ramp * 0.3, 0.3), "2DOF-S").uplift_times[0]
    dt = lifts / samples
    record = slope * dt * np.arange(samples + math.ceil(0.2 / dt) + 2)
    mine, twin = both(given, record, dt, 1, substeps=max(64, 512 // samples))
    assert mine.uplift_times[0] == pytest.approx(lifts, abs=1e-12)
    assert_same(mine, twin)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_jump_at_the_start_lifts_at_once(sign):
    """One mode of several, so that the ground acts on the moment itself."""
    given = frame(stiffness_ratio=0.0)
    p = Frame(**given).rocking(1)
    arm = p.l0r - float(p.effective_mass[0] * p.effective_height[0])
    record = np.full(21, sign * 1.2 * p.resisting_moment / arm)
    mine, twin = both(given, record, 0.01, 1, free_vibration=1.0)
    assert mine.uplift_times[0] == 0.0
    assert_same(mine, twin)
    ode = ControlledTwin.of(p, []).run(record, 0.01, 1.0)
    assert_same(mine, ode, rtol=1e-9, atol=1e-9)
    # From a jump the rotation grows with the square of time.
    lift = 0.2 * p.resisting_moment / (p.i_theta - float(p.effective_mass @ p.effective_height**2))
    early = simulate(Frame(**given), GroundMotion(record[:3], 1e-6), "2DOF-S")
    assert early.rotation[-1] == pytest.approx(-sign * 0.5 * lift * early.time[-1] ** 2, rel=1e-3)
    # Below the resistance nothing happens at the start.
    below = simulate(Frame(**given), GroundMotion(record / 1.3, 0.01), "2DOF-S")
    assert not below.n_uplifts or below.uplift_times[0] > 0.0


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_end_of_the_shaking_lifts_the_base(sign):
    """In a shear frame m* h* of the first mode exceeds L: taking a slow push away raises the moment by 3 %."""
    given = frame(damping_ratio=0.05)
    p = Frame(**given).rocking(1)
    share = float(p.effective_mass[0] * p.effective_height[0]) / p.l0r
    assert share > 1.02
    push = sign * 0.99 * p.resisting_moment / p.l0r
    t = np.linspace(0.0, 1.0, 1001)
    record = push * t**3 * (10.0 - 15.0 * t + 6.0 * t**2)
    assert both(given, record, 0.03, 1)[0].status == "no_uplift"
    mine, twin = both(given, record, 0.03, 1, free_vibration=2.0)
    assert mine.uplift_times[0] == pytest.approx(30.0, abs=1e-12)
    assert mine.status == "rocking"
    assert_same(mine, twin)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_overturning_ends_the_run_at_a_quarter_turn(sign):
    p = block(effective_mass=[1.0], omega=[3000.0])
    rate, alpha = rate_and_slenderness(p)
    start = 1.2 * alpha
    run = simulate(p, quiet_motion(60.0, dt=0.01), initial=InitialState(rotation=sign * start))
    expected = math.acosh((0.5 * math.pi - alpha) / (start - alpha)) / rate
    assert run.status == "overturned"
    assert run.nominal_overturning
    assert run.max_rotation == 0.5 * math.pi
    assert run.end_time == run.time_of_max_rotation == run.time[-1]
    assert run.end_time == pytest.approx(expected, rel=1e-6)
    assert run.rotation[-1] == sign * 0.5 * math.pi
    assert (run.n_uplifts, run.n_impacts) == (0, 0)


def test_overturning_of_a_flexible_frame():
    given = frame()
    p = Frame(**given).rocking()
    start = 1.5 * p.m_tot * p.half_width / p.l0r
    from_twin = simulate_fine(
        **frame_properties(**given),
        acceleration=np.zeros(1001),
        dt=0.02,
        initial=InitialState(rotation=start),
    )
    run = simulate(Frame(**given), quiet_motion(20.0, dt=0.02), initial=InitialState(rotation=start))
    assert run.status == from_twin.status == "overturned"
    assert run.end_time == pytest.approx(from_twin.final_time, abs=1e-9)
    assert run.max_base_moment == pytest.approx(from_twin.max_base_moment, rel=1e-9)


@pytest.mark.parametrize("fraction", [0.05, 0.2, -0.7, 0.99])
def test_release_of_a_nearly_rigid_structure(fraction):
    """The quarter period acosh[1/(1 - θ_0/α)]/p, with p² = L g/I_θ and α = m_tot B/L."""
    p = block(omega=[2000.0], zeta=0.0)
    rate, alpha = rate_and_slenderness(p)
    turn = rate**2 * alpha * (fraction - math.copysign(1.0, fraction))
    start = InitialState(fraction * alpha, modal_displacement=[-8.0 * turn / 2000.0**2])  # without ringing
    run = simulate(p, quiet_motion(8.0 / rate, dt=0.01), initial=start)
    expected = math.acosh(1.0 / (1.0 - abs(fraction))) / rate
    assert run.impact_times[0] == pytest.approx(expected, rel=1e-6)
    assert run.max_rotation == abs(fraction) * alpha
    assert run.time_of_max_rotation == 0.0


def test_pushed_off_with_a_velocity():
    """Thrown from rest on its base a rigid block reaches α (1 - √(1 - (θ'/(p α))²))."""
    p = block(omega=[2000.0], effective_mass=[1.0])
    rate, alpha = rate_and_slenderness(p)
    for push in (0.5, -0.5):
        run = simulate(
            p, quiet_motion(2.0, dt=0.01), initial=InitialState(rotation_velocity=push * rate * alpha), output="history"
        )
        assert run.max_rotation == pytest.approx(alpha * (1.0 - math.sqrt(1.0 - push**2)), rel=1e-5)
        assert np.sign(run.rotation[run.rotation != 0.0][0]) == np.sign(push)
        assert run.status == "rocking"


@pytest.mark.slow
def test_rest_stays_rest():
    run = simulate(Frame(**frame()), quiet_motion(1.0), free_vibration=3600.0)
    assert (run.status, run.n_uplifts, run.max_rotation, run.max_base_shear) == ("no_uplift", 0, 0.0, 0.0)
    assert run.end_time == pytest.approx(3601.0)
    assert not run.history.states[:, 1:].any()
