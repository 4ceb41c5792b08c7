"""The acceleration of a floor as a motion, and its spectrum."""

import numpy as np
import pytest
from scipy.signal import StateSpace, lsim

import rockflex as rf
from builders import PROPERTIES, make_frame, random_shaking

FRAME = make_frame(n_stories=3, period=0.6, aspect_ratio=8.0)
MOTION = rf.GroundMotion(random_shaking(4, 9.0, 4.0, 0.02), 0.02, "random")
PERIODS = [0.1, 0.3, 0.6, 1.5]


def run(model, **options):
    return rf.simulate(FRAME, MOTION, model, free_vibration=1.0, **options)


@pytest.fixture(scope="module")
def response():
    found = run("2DOF-S", impact=rf.Restitution(0.8))
    assert found.n_impacts > 3
    return found


def test_the_spectrum_is_that_of_the_floor():
    """Against oscillators integrated by SciPy on the acceleration at a much finer step."""
    fixed = run("fixed")
    found = fixed.floor_spectrum(3, PERIODS, 0.03, dt=0.001)
    fine = fixed.resample(2e-4)
    for period, sd in zip(PERIODS, found.sd, strict=True):
        w = 2.0 * np.pi / period
        oscillator = StateSpace([[0.0, 1.0], [-w * w, -0.06 * w]], [[0.0], [-1.0]], [[1.0, 0.0]], [[0.0]])
        _, moved, _ = lsim(oscillator, fine.floor_acceleration[:, 2], fine.time)
        assert sd == pytest.approx(np.abs(moved).max(), rel=1e-4)


@pytest.mark.parametrize("model", ["2DOF-S", "MDOF-S", "2DOF-C"])
def test_the_velocity_of_the_floor_is_the_integral(model):
    """With the impulses of impacts, the acceleration leads from rest to the velocity at the end."""
    found = run(model)
    history, step = found.history, 1e-5
    moved = np.diff(history.at([history.time[-1] - step, history.time[-1]]).total_floor_displacement, axis=0)[0]
    for floor in (1, 3):
        motion = found.floor_motion(floor, dt=5e-4)
        gained = np.trapezoid(motion.acceleration, motion.time)
        expected = moved[floor - 1] / step + np.trapezoid(MOTION.acceleration, MOTION.time)
        assert gained == pytest.approx(expected, abs=3e-4)


def test_impulses_count_unless_left_out(response):
    with_, without = (response.floor_motion(2, impulses=each) for each in (True, False))
    assert with_.dt == without.dt <= 0.005
    assert with_.name == "floor 2"
    np.testing.assert_array_equal(
        without.acceleration, response.at(np.minimum(without.time, response.end_time)).floor_acceleration[:, 1]
    )
    changed = np.flatnonzero(with_.acceleration != without.acceleration)
    events = response.time[1:][np.diff(response.time) == 0.0]
    near = np.abs(with_.time[changed, None] - events).min(axis=1)
    assert near.max() < 1.001 * with_.dt
    assert changed.size >= response.n_impacts


def test_the_spectrum_converges(response):
    rough, fine, finest = (response.floor_spectrum(3, PERIODS, dt=dt).sa for dt in (0.004, 0.001, 0.00025))
    np.testing.assert_allclose(fine, finest, rtol=2e-3)
    assert np.abs(fine - finest).max() < 0.3 * np.abs(rough - finest).max()


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda r: r.floor_spectrum(0, [0.5]), "floor"),
        (lambda r: r.floor_motion(4), "floor"),
        (lambda r: r.floor_motion(1, dt=0.0), "dt must be"),
        (lambda r: r.floor_spectrum(1, [-1.0]), "periods must be zero or"),
        (lambda r: r.resample(0.1).floor_spectrum(1, [0.1]), "A sampled history has no floor_spectrum"),
    ],
)
def test_errors(response, call, message):
    with pytest.raises(rf.InputError, match=message):
        call(response)


def test_without_floors_there_is_none():
    found = rf.simulate(rf.RockingProperties(**PROPERTIES), MOTION)
    with pytest.raises(rf.InputError, match="include no floors, so there is no floor motion"):
        found.floor_motion(1)
