"""Response spectra of one component, and of two in all directions."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.signal import StateSpace, lsim

import rockflex as rf
from rockflex.foundation.errors import InputError
from rockflex.motion import GroundMotion, half_sine_pulse, one_sine_pulse, rectangular_pulse

RECORD = GroundMotion(np.random.default_rng(3).normal(size=25), 0.1)
SUITE = rf.load_suite("fema-p695-far-field")
FIRST, SECOND = SUITE["FF-1-a"], SUITE["FF-1-b"]
PERIODS = np.geomspace(0.015, 6.0, 12)


def twin(motion, period, zeta):
    """Peaks by adaptive integration with event location, restarted at every sample."""
    omega = 2 * math.pi / period
    state, sd, sv = [0.0, 0.0], 0.0, 0.0
    for k, a in enumerate(motion.acceleration[:-1]):
        slope = (motion.acceleration[k + 1] - a) / motion.dt

        def rate(t, y, a=a, slope=slope):
            return [y[1], -2 * zeta * omega * y[1] - omega**2 * y[0] - a - slope * t]

        done = solve_ivp(
            rate,
            (0, motion.dt),
            state,
            method="DOP853",
            rtol=1e-12,
            atol=1e-15,
            max_step=period / 12,
            events=[lambda t, y: y[1], lambda t, y, rate=rate: rate(t, y)[1]],
        )
        points = [done.y.T, *(found for found in done.y_events if len(found))]
        sd, sv = np.maximum((sd, sv), np.max(np.abs(np.concatenate(points)), axis=0))
        state = done.y[:, -1]
    return sd, sv


@pytest.mark.slow
@pytest.mark.parametrize("zeta", [0.0, 0.05, 0.7])
@pytest.mark.parametrize("period", [0.03, 0.1, 0.21, 1.0, 7.0])
def test_peaks_against_adaptive_integration(period, zeta):
    spectrum = RECORD.spectrum([period], zeta)
    sd, sv = twin(RECORD, period, zeta)
    assert spectrum.sd[0] == pytest.approx(sd, rel=1e-9)
    assert spectrum.sv[0] == pytest.approx(sv, rel=1e-9)
    assert spectrum.sa[0] == pytest.approx((2 * math.pi / period) ** 2 * sd, rel=1e-9)
    assert spectrum.psv[0] == pytest.approx(2 * math.pi / period * sd, rel=1e-9)


@pytest.mark.parametrize("period", [1.03, 1.37, 1.91])
def test_slowly_growing_peaks_between_samples(period):
    # Each peak is a little higher than the one before, and no sample of it may show that.
    t = 0.1 * np.arange(120)
    for extra in (0.004 * t, 0.002 * np.sin(2 * np.pi / period * t)):
        motion = GroundMotion(1 + extra, 0.1)
        spectrum = motion.spectrum([period], 0.0)
        sd, sv = twin(motion, period, 0.0)
        assert spectrum.sd[0] == pytest.approx(sd, rel=1e-10)
        assert spectrum.sv[0] == pytest.approx(sv, rel=1e-10)


def test_period_zero_is_the_peak_ground_acceleration():
    spectrum = RECORD.spectrum([0.0, 1.0])
    assert (spectrum.sd[0], spectrum.sv[0], spectrum.psv[0], spectrum.sa[0]) == (0, 0, 0, RECORD.pga)
    assert RECORD.sa(0) == RECORD.pga


def test_very_stiff_and_very_soft_oscillators():
    ramp = GroundMotion(np.linspace(0, 1, 101), 0.01)
    assert ramp.sa(1e-4, 0.05) == pytest.approx(1.0, rel=1e-3)
    # A very soft oscillator stays where it is while the ground moves.
    assert RECORD.sd(1e5, 0.0) == pytest.approx(RECORD.pgd, rel=1e-7)
    assert RECORD.spectrum([1e5], 0.0).sv[0] == pytest.approx(RECORD.pgv, rel=1e-7)


def test_rectangle_doubles_the_static_response():
    # u = (a/ω²)(1 - cos ωt), a peak between samples.
    pulse = rectangular_pulse(2.0, 1.0, dt=0.3)
    assert pulse.sa(0.77, 0.0) == pytest.approx(4.0, rel=1e-13)


def test_damped_step_overshoots_as_it_should():
    zeta = 0.05
    overshoot = 1 + math.exp(-math.pi * zeta / math.sqrt(1 - zeta**2))
    assert rectangular_pulse(1.0, 2.0, dt=0.1).sa(0.33, zeta) == pytest.approx(overshoot, rel=1e-12)


def test_resonant_full_sine():
    # u = (a/2ω²)(sin ωt - ωt cos ωt) at resonance: the peak within one cycle is at t = T, where u = -π a/ω².
    assert one_sine_pulse(1.0, 1.0, dt=0.001).sa(1.0, 0.0) == pytest.approx(math.pi, rel=1e-5)


def test_free_vibration_after_the_record_is_not_included():
    # A pulse much shorter than the period: the peak comes later.
    pulse = half_sine_pulse(1.0, 0.1)
    assert pulse.sd(10.0, 0.0) == pytest.approx(pulse.pgd, rel=1e-3)


@pytest.mark.parametrize("zeta", [0.0, 0.05])
def test_a_spectrum_does_not_depend_on_what_else_is_asked(zeta):
    periods = np.geomspace(1e-3, 20.0, 40)
    spectrum, mirrored = RECORD.spectrum(periods, zeta), GroundMotion(-RECORD.acceleration, RECORD.dt)
    backwards, (third,) = RECORD.spectrum(periods[::-1], zeta), RECORD.spectrum(periods[[3]], zeta).sd
    for name in ("sd", "sv", "sa"):
        assert getattr(backwards, name)[::-1].tolist() == getattr(spectrum, name).tolist()
        assert getattr(mirrored.spectrum(periods, zeta), name).tolist() == getattr(spectrum, name).tolist()
    assert third == spectrum.sd[3] == RECORD.sd(float(periods[3]), zeta)


def test_results_are_read_only_and_in_order():
    spectrum = RECORD.spectrum([1.0, 0.5], 0.02)
    assert spectrum.period.tolist() == [1.0, 0.5]
    assert spectrum.damping_ratio == 0.02
    assert spectrum.sd[1] == RECORD.sd(0.5, 0.02)
    for array in (spectrum.period, spectrum.sd, spectrum.sv, spectrum.sa):
        assert not array.flags.writeable


@pytest.mark.parametrize(
    ("periods", "zeta", "text"),
    [
        ([-1.0], 0.05, "periods must be zero or at least 1e-6 s, but -1 was given at index 0"),
        ([1.0, 1e-7], 0.05, "but 1e-07 was given at index 1"),
        ([1.0], 1.0, r"damping_ratio must lie in \[0, 1\), but 1.0 was given. It is a fraction: 5 % is 0.05"),
    ],
)
def test_refuses(periods, zeta, text):
    with pytest.raises(InputError, match=text):
        RECORD.spectrum(periods, zeta)


def rotated(first, second, degrees):
    angle = math.radians(degrees)
    return rf.GroundMotion(math.cos(angle) * first.acceleration + math.sin(angle) * second.acceleration, first.dt)


@pytest.mark.parametrize("zeta", [0.0, 0.05, 0.7])
def test_every_direction_is_the_spectrum_of_the_rotated_record(zeta):
    spectrum = rf.rotated_spectrum(FIRST, SECOND, PERIODS, zeta)
    for degrees in range(0, 180, 11):
        alone = rotated(FIRST, SECOND, degrees).spectrum(PERIODS, zeta).sa
        # The same recurrence, combined after instead of before: some thousand rounding errors apart.
        np.testing.assert_allclose(spectrum.sa[:, degrees], alone, rtol=1e-10)


def test_against_a_simulation_on_a_fine_grid():
    # SciPy holds the input linear between samples too; on this grid peaks between its samples do not count.
    period, zeta, fine = 0.35, 0.05, 20
    omega = 2 * math.pi / period
    system = StateSpace([[0.0, 1.0], [-(omega**2), -2 * zeta * omega]], [[0.0], [-1.0]], [[1.0, 0.0]], [[0.0]])
    dt = FIRST.dt / fine
    inputs = [motion.refined(fine).acceleration for motion in (FIRST, SECOND)]
    histories = [lsim(system, a, dt * np.arange(a.size))[1] for a in inputs]
    angles = np.radians(np.arange(180))
    peaks = [np.max(np.abs(math.cos(a) * histories[0] + math.sin(a) * histories[1])) for a in angles]
    spectrum = rf.rotated_spectrum(FIRST, SECOND, [period], zeta)
    # Between samples of the grid u falls short of its peak by at most |u''| dt²/8, about (ω dt)²/8 of it.
    np.testing.assert_allclose(spectrum.sa[0], omega**2 * np.array(peaks), rtol=1.5 * (omega * dt) ** 2 / 8)
    assert spectrum.rotd50[0] == pytest.approx(omega**2 * np.median(peaks), rel=1e-4)
    assert spectrum.rotd100[0] == pytest.approx(omega**2 * np.max(peaks), rel=1e-4)


def test_percentiles_and_components():
    spectrum = rf.rotated_spectrum(FIRST, SECOND, PERIODS)
    assert spectrum.sa.shape == (12, 180)
    np.testing.assert_array_equal(spectrum.rotd50, np.percentile(spectrum.sa, 50, axis=1))
    np.testing.assert_array_equal(spectrum.rotd(100), spectrum.rotd100)
    np.testing.assert_array_equal(spectrum.rotd(0), spectrum.sa.min(axis=1))
    both = np.sqrt(FIRST.spectrum(PERIODS).sa * SECOND.spectrum(PERIODS).sa)
    np.testing.assert_allclose(spectrum.geometric_mean, both, rtol=1e-10)
    # Boore 2010: RotD50 lies near the geometric mean, RotD100 above it and at most √2 times the larger component.
    assert (spectrum.rotd100 >= both * (1 - 1e-10)).all()
    larger = np.maximum(FIRST.spectrum(PERIODS).sa, SECOND.spectrum(PERIODS).sa)
    assert (spectrum.rotd100 <= math.sqrt(2) * larger).all()


def test_one_direction_only_is_a_cosine():
    quiet = rf.GroundMotion(np.zeros(FIRST.acceleration.size), FIRST.dt)
    spectrum = rf.rotated_spectrum(FIRST, quiet, [0.5])
    np.testing.assert_allclose(
        spectrum.sa[0], FIRST.sa(0.5) * np.abs(np.cos(np.radians(np.arange(180)))), rtol=1e-10, atol=1e-12
    )
    assert spectrum.rotd50[0] == pytest.approx(FIRST.sa(0.5) / math.sqrt(2), rel=1e-10)  # the median of |cos|


def test_rotating_the_instrument_changes_nothing():
    turned = rf.rotated_spectrum(rotated(FIRST, SECOND, 30), rotated(FIRST, SECOND, 120), PERIODS)
    spectrum = rf.rotated_spectrum(FIRST, SECOND, PERIODS)
    np.testing.assert_allclose(turned.rotd50, spectrum.rotd50, rtol=1e-10)
    np.testing.assert_allclose(turned.sa, np.roll(spectrum.sa, -30, axis=1), rtol=1e-10)


def test_period_zero_is_the_peak_ground_acceleration_rotation():
    spectrum = rf.rotated_spectrum(FIRST, SECOND, [0.0])
    assert spectrum.sa[0, 0] == FIRST.pga
    assert spectrum.sa[0, 45] == pytest.approx(rotated(FIRST, SECOND, 45).pga, rel=1e-12)


def test_zeros_are_appended_to_the_shorter_component():
    short = rf.GroundMotion(SECOND.acceleration[:500], SECOND.dt)
    padded = rf.GroundMotion(np.append(SECOND.acceleration[:500], np.zeros(FIRST.acceleration.size - 500)), SECOND.dt)
    np.testing.assert_array_equal(
        rf.rotated_spectrum(FIRST, short, [0.3]).sa, rf.rotated_spectrum(FIRST, padded, [0.3]).sa
    )


def test_a_spectrum_does_not_depend_on_what_else_is_asked_rotation():
    spectrum = rf.rotated_spectrum(FIRST, SECOND, PERIODS)
    backwards = rf.rotated_spectrum(FIRST, SECOND, PERIODS[::-1])
    np.testing.assert_array_equal(backwards.sa[::-1], spectrum.sa)
    np.testing.assert_array_equal(rf.rotated_spectrum(FIRST, SECOND, PERIODS[[3]]).sa[0], spectrum.sa[3])
    mirrored = [rf.GroundMotion(-motion.acceleration, motion.dt) for motion in (FIRST, SECOND)]
    np.testing.assert_array_equal(rf.rotated_spectrum(*mirrored, PERIODS).sa, spectrum.sa)


def test_refuses_components_of_different_steps():
    with pytest.raises(rf.InputError, match=r"need the same time step, but 0\.01 s and 0\.005 s"):
        rf.rotated_spectrum(FIRST, SECOND.refined(2), [1.0])


@pytest.mark.parametrize("percentile", [-1, 100.1, math.nan, "50"])
def test_refuses_percentiles(percentile):
    with pytest.raises(rf.InputError, match=r"percentile must be a number from 0 to 100, but .* RotD50 is the 50th"):
        rf.rotated_spectrum(FIRST, SECOND, [1.0]).rotd(percentile)
