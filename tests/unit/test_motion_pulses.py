import math

import numpy as np
import pytest

from rockflex import motion as rm
from rockflex.foundation.errors import InputError
from rockflex.motion import _pulses

ONE_LENGTH = [rm.one_sine_pulse, rm.one_cosine_pulse, rm.half_sine_pulse, rm.rectangular_pulse]


@pytest.mark.parametrize("pulse", ONE_LENGTH)
def test_the_step_divides_the_pulse_and_is_not_above_the_asked_one(pulse):
    assert pulse(1.0, 0.5).dt == 0.005
    assert pulse(1.0, 0.3, dt=0.1).dt == 0.1  # 0.3/0.1 is 2.9999999999999996 in floating point
    uneven = pulse(1.0, 1.0, dt=0.3)
    assert uneven.dt == 0.25
    least = pulse(1.0, 1.0, dt=5.0)
    assert (least.duration, least.acceleration.size) == (1.0, 3)


def test_antisymmetric_ricker_peaks_at_its_amplitude():
    pulse = rm.ricker_pulse(2.0, 0.8, dt=1e-4)
    assert pulse.pga == pytest.approx(2.0, rel=1e-7)
    assert pulse.pga <= 2.0
    coarse = rm.ricker_pulse(2.0, 0.8, dt=0.01)
    assert 1 - 4 * (0.01 / 0.8) ** 2 < coarse.pga / 2.0 <= 1
    # Printed form with the printed β.
    t = pulse.time - pulse.duration / 2
    x = math.pi * t / 0.8
    printed = 2 / 1.3801 * (4 * x**2 / 3 - 3) * (2 * x / math.sqrt(3)) * np.exp(-2 * x**2 / 3)
    assert pulse.acceleration == pytest.approx(printed, abs=2e-4)
    assert pulse.acceleration == pytest.approx(-pulse.acceleration[::-1], abs=1e-15)
    assert pulse.velocity[-1] == pytest.approx(0, abs=1e-12)


def test_symmetric_ricker():
    pulse = rm.ricker_pulse(-2.0, 0.8, kind="symmetric")
    middle = pulse.acceleration.size // 2
    assert pulse.acceleration[middle] == -2.0
    assert pulse.pga == 2.0
    t = pulse.time - pulse.time[middle]
    x = math.pi * t / 0.8
    assert pulse.acceleration == pytest.approx(-2 * (1 - 2 * x**2) * np.exp(-(x**2)), abs=1e-14)
    assert pulse.velocity[-1] == pytest.approx(0, abs=1e-7)


@pytest.mark.parametrize(("kind", "bound"), [("symmetric", 2e-8), ("antisymmetric", 2e-9)])
def test_ricker_tails_are_cut_where_they_are_negligible(kind, bound):
    pulse = rm.ricker_pulse(1.0, 0.5, kind=kind)
    assert 0 < abs(pulse.acceleration[0]) < bound
    assert abs(pulse.acceleration[-1]) < bound
    assert pulse.duration == pytest.approx(1.5 if kind == "symmetric" else 2.0)
    assert pulse.dt == pytest.approx(0.005)


def test_full_sine_and_cosine():
    sine = rm.one_sine_pulse(3.0, 0.4, dt=0.001)
    assert sine.pga == pytest.approx(3.0, rel=1e-12)
    assert sine.acceleration[0] == sine.acceleration[-1] == 0
    assert sine.velocity[-1] == pytest.approx(0, abs=1e-15)
    assert sine.displacement[-1] == pytest.approx(3 * 0.16 / (2 * math.pi), rel=1e-4)
    assert sine.pgv == pytest.approx(3 * 0.4 / math.pi, rel=1e-4)
    cosine = rm.one_cosine_pulse(3.0, 0.4, dt=0.001)
    assert cosine.acceleration[0] == cosine.acceleration[-1] == 3.0
    assert cosine.velocity[-1] == pytest.approx(0, abs=1e-15)
    assert cosine.displacement[-1] == pytest.approx(0, abs=1e-6)
    assert cosine.pgd == pytest.approx(3 * 0.16 / (2 * math.pi**2), rel=1e-4)


def test_half_sine_and_rectangle():
    half = rm.half_sine_pulse(3.0, 0.4, dt=0.001)
    assert half.pga == pytest.approx(3.0)
    assert half.velocity[-1] == pytest.approx(2 * 3 * 0.4 / math.pi, rel=1e-5)
    assert half.acceleration[-1] == 0
    rectangle = rm.rectangular_pulse(3.0, 0.4, dt=0.15)
    assert np.all(rectangle.acceleration == 3.0)
    assert rectangle.velocity[-1] == pytest.approx(1.2, rel=1e-14)
    assert rectangle.displacement[-1] == pytest.approx(0.24, rel=1e-14)


@pytest.mark.parametrize("nu", [0.0, math.pi / 2, 2.0])
@pytest.mark.parametrize("gamma", [1.3, 2.0, 3.5])
def test_mavroeidis_papageorgiou_velocity(gamma, nu):
    pulse = rm.mavroeidis_papageorgiou_pulse(0.6, 2.0, gamma, nu, dt=0.001)
    t = pulse.time - pulse.duration / 2
    velocity = 0.3 * (1 + np.cos(math.pi * t / gamma)) * np.cos(math.pi * t + nu)
    assert pulse.duration == pytest.approx(2.0 * gamma)
    assert pulse.velocity == pytest.approx(velocity, abs=1e-6)
    assert abs(pulse.acceleration[[0, -1]]).max() < 1e-12
    if nu == 0:
        assert pulse.pgv == pytest.approx(0.6, rel=1e-5)


def test_quiet_motion():
    quiet = rm.quiet_motion(2.0)
    assert quiet.duration == pytest.approx(2.0)
    assert quiet.dt == 0.005
    assert not quiet.acceleration.any()
    assert rm.quiet_motion(1e-3, dt=1.0).duration == pytest.approx(1e-3)


def test_a_motion_has_as_many_steps_as_allowed(monkeypatch):
    monkeypatch.setattr(_pulses, "MAX_SAMPLES", 10)
    assert rm.quiet_motion(10.0, dt=1.0).acceleration.size == 11
    with pytest.raises(InputError, match="use a larger dt"):
        rm.quiet_motion(10.5, dt=1.0)


def test_names_tell_pulses_apart():
    names = {pulse(1.0, 0.5).name for pulse in ONE_LENGTH} | {rm.ricker_pulse(1.0, 0.5).name}
    assert len(names) == 5
    assert rm.ricker_pulse(0.5, 0.8).name == "Ricker antisymmetric 0.5 m/s², T=0.8 s"


@pytest.mark.parametrize(
    ("call", "text"),
    [
        (lambda: rm.ricker_pulse(1, 0.5, kind="odd"), 'kind must be "antisymmetric" or "symmetric", but \'odd\''),
        (lambda: rm.ricker_pulse(1, -0.5), "period must be .*but -0.5 was given"),
        (lambda: rm.mavroeidis_papageorgiou_pulse(1, -0.5, 2, 0), "period must be .*but -0.5 was given"),
        (lambda: rm.quiet_motion(1e9, dt=1e-9), "requires 1e\\+18 samples; use a larger dt"),
        (lambda: rm.quiet_motion(1e8 + 0.5, dt=1.0), "requires 1e\\+08 samples; use a larger dt"),
        (lambda: rm.mavroeidis_papageorgiou_pulse(1, 1, 1, 0), "gamma must be finite and above 1, but 1 was"),
        (
            lambda: rm.mavroeidis_papageorgiou_pulse(math.nan, 1, 2, 0),
            "amplitude must be a finite number in m/s, but nan",
        ),
    ],
)
def test_refuses(call, text):
    with pytest.raises(InputError, match=text):
        call()
