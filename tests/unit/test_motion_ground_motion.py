"""Ground motions: construction, integrals, finer sampling, correction and filtering."""

from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest
from scipy.signal import butter, sosfreqz

from rockflex.foundation.errors import InputError
from rockflex.motion import GroundMotion, RecordInfo

MOTION = GroundMotion(np.random.default_rng(5).normal(size=400), 0.01, "noise")


def test_holds_a_copy():
    samples = np.array([0.0, 1.0, -2.0])
    motion = GroundMotion(samples, 0.5, name="a")
    samples[1] = 9.0
    assert motion.acceleration.tolist() == [0.0, 1.0, -2.0]
    assert motion.time.tolist() == [0.0, 0.5, 1.0]
    assert motion.duration == 1.0
    assert motion.pga == 2.0


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (([1, 2], 0.1), "at least 3 samples, but 2 were given"),
        (([1, 2, np.nan], 0.1), r"must be finite, but 1 of 3 values are not, the first \(nan\) at index 2"),
        (([1, 2, 3], 0.1, 7), "name must be a string, but 7"),
        (([1, 2, 3], 0.1, "x", {"year": 1940}), "metadata must be a RecordInfo or None, but dict"),
    ],
)
def test_refuses(arguments, text):
    with pytest.raises(InputError, match=text):
        GroundMotion(*arguments)


@pytest.mark.parametrize(
    "dt", [True, np.True_, np.array(True), "0.02", np.str_("0.02"), np.array("0.02"), b"0.02", np.ma.masked]
)
def test_a_time_step_is_a_number(dt):
    with pytest.raises(InputError, match="dt must be a number in s, but") as caught:
        GroundMotion([0.0, 1.0, 2.0], dt)
    assert caught.value.field == "dt"
    for call in (MOTION.scaled, MOTION.resampled, lambda x: MOTION.sd(x), lambda x: MOTION.spectrum([1.0], x)):
        with pytest.raises(InputError):
            call(dt)


@pytest.mark.parametrize("dt", [1, np.float32(0.25), np.int64(2), np.array(0.5), Fraction(1, 2), Decimal("0.25")])
def test_a_time_step_is_any_number(dt):
    assert GroundMotion([0.0, 1.0, 2.0], dt).dt == float(dt)


GAP = np.ma.masked_values([0.0, 1.0, -9999.0, 2.0], -9999.0)


@pytest.mark.parametrize(
    ("field", "call"),
    [
        ("acceleration", lambda: GroundMotion(GAP, 0.01)),
        ("acceleration", lambda: GroundMotion([1.0, np.ma.masked, 2.0], 0.01)),
        ("vertical", lambda: GroundMotion([1.0, 2.0, 3.0, 4.0], 0.01, vertical=GAP)),
        ("periods", lambda: MOTION.spectrum(GAP)),
    ],
)
def test_a_mask_is_not_forgotten(field, call):
    with pytest.raises(InputError, match=rf"{field} .* with 1 masked value .*compressed.*filled") as caught:
        call()
    assert caught.value.field == field


def test_a_mask_that_hides_nothing():
    assert GroundMotion(np.ma.masked_array([0.0, 1.0, 2.0]), 0.01).pga == 2.0


@pytest.mark.parametrize(
    "values", [["1", "2", "3"], [True, False, True], np.array(["1", "2", "3"], dtype=object), [b"1", b"2", b"3"]]
)
def test_texts_and_booleans_are_no_numbers(values):
    with pytest.raises(InputError, match="acceleration must be a sequence of numbers"):
        GroundMotion(values, 0.01)


def test_scaling_keeps_name_and_metadata_and_tells_the_whole_factor():
    motion = GroundMotion([0, 1, -2], 0.5, "a", RecordInfo(event="x"))
    scaled = motion.scaled(-2)
    assert scaled.acceleration.tolist() == [0, -2, 4]
    assert (scaled.name, scaled.metadata) == ("a", RecordInfo(event="x", scale=-2.0))
    assert scaled.scaled(1.5).metadata.scale == -3.0
    assert scaled.scaled(-0.5) == motion == motion.scaled(1.0)
    assert GroundMotion([0, 1, -2], 0.5).scaled(3.0).metadata == RecordInfo(scale=3.0)


def test_scaling_stays_finite():
    with pytest.raises(InputError, match="acceleration must be finite"):
        GroundMotion([0, 1, -2], 0.5).scaled(1e308)


def test_refining_splits_every_interval():
    fine = GroundMotion([0, 3, -3], 0.3).refined(3)
    assert fine.acceleration == pytest.approx([0, 1, 2, 3, 1, -1, -3])
    assert fine.dt == pytest.approx(0.1)
    assert fine.duration == pytest.approx(0.6)
    assert np.array_equal(MOTION.refined(7).acceleration[::7], MOTION.acceleration)
    assert np.array_equal(MOTION.refined(1).acceleration, MOTION.acceleration)


def test_resampling_is_refining():
    fine = MOTION.resampled(0.0025)
    assert fine.dt == 0.0025
    assert np.array_equal(fine.acceleration, MOTION.refined(4).acceleration)
    assert MOTION.resampled(0.01 * (1 + 1e-12)).dt == 0.01


@pytest.mark.parametrize(
    ("dt", "steps"), [(0.004, "0.005 s or 0.00333333333333 s"), (0.02, "0.01 s"), (0.0099, "0.01 s or 0.005 s")]
)
def test_resampling_names_the_steps_that_can_be_had(dt, steps):
    with pytest.raises(InputError, match=f"cannot be resampled exactly to dt = {dt} s.*Use {steps}\\."):
        MOTION.resampled(dt)


@pytest.mark.parametrize("degree", [0, 1, 3])
def test_baseline_removes_the_polynomial_and_nothing_else(degree):
    t = MOTION.time
    drift = sum((0.3 - 0.1 * k) * (t / 4) ** k for k in range(degree + 1))
    clean = MOTION.baseline_corrected(degree)
    drifted = GroundMotion(MOTION.acceleration + drift, MOTION.dt).baseline_corrected(degree)
    assert drifted.acceleration == pytest.approx(clean.acceleration, abs=1e-12)
    # What remains of the velocity is orthogonal to every drift that could have been removed.
    for k in range(degree + 1):
        assert clean.velocity @ GroundMotion((t / 4) ** k, MOTION.dt).velocity == pytest.approx(0, abs=1e-9)
    # The least-squares fit through the normal equations, in plain powers.
    basis = np.stack([GroundMotion((t / 4) ** k, MOTION.dt).velocity for k in range(degree + 1)], axis=1)
    weights = np.linalg.solve(basis.T @ basis, basis.T @ MOTION.velocity)
    assert clean.velocity == pytest.approx(MOTION.velocity - basis @ weights, abs=1e-10)


@pytest.mark.parametrize(
    ("degree", "text"), [(-1, "at least 0, but -1"), (1.5, "at least 0, but 1.5"), (399, "at most 398 for 400 samples")]
)
def test_baseline_refuses(degree, text):
    with pytest.raises(InputError, match=text):
        MOTION.baseline_corrected(degree)


def test_band_pass_has_the_squared_gain_and_no_phase():
    t = np.arange(20000) * 0.01
    sections = butter(4, (0.5, 10), btype="bandpass", output="sos", fs=100)
    for frequency in (0.2, 0.5, 2.0, 10.0, 20.0):
        sine = np.sin(2 * np.pi * frequency * t)
        filtered = GroundMotion(sine, 0.01).band_passed(0.5, 10.0).acceleration
        _, gain = sosfreqz(sections, [frequency], fs=100)
        middle = slice(5000, 15000)
        assert filtered[middle] == pytest.approx(abs(gain[0]) ** 2 * sine[middle], abs=1e-6)


@pytest.mark.parametrize(("low", "high"), [(0, 10), (10, 1), (1, 50), (-1, 10), (1, 1)])
def test_band_pass_checks_the_corners(low, high):
    with pytest.raises(InputError, match=r"0 < low < high < 50 Hz, the Nyquist frequency of dt = 0\.01 s"):
        MOTION.band_passed(low, high)


def test_band_pass_checks_the_length():
    with pytest.raises(InputError, match="order 4 needs more than 27 samples, but the record has 20"):
        GroundMotion(np.ones(20), 0.01).band_passed(1, 10)
