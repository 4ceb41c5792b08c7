import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from rockflex.foundation.constants import GRAVITY
from rockflex.motion import GroundMotion, one_sine_pulse, read_at2, read_motion, ricker_pulse
from rockflex.motion._suite import pack_decimal_samples, unpack_decimal_samples

pytestmark = pytest.mark.filterwarnings("ignore:.*about 1 g")  # of samples at random
MEASURES = ("pga", "pgv", "pgd", "arias", "cav", "d5_95")

# Multiples of 1/1024 that are no denormals: sums and products behave.
values = st.integers(-4096, 4096).map(lambda k: k / 1024)
samples = st.lists(values, min_size=3, max_size=40)
steps = st.sampled_from([0.001, 0.005, 0.02, 0.3])
factors = st.floats(0.01, 100).flatmap(lambda x: st.sampled_from([x, -x]))
motions = st.builds(GroundMotion, samples, steps)
moving = motions.filter(lambda motion: motion.pga > 0)


@given(moving, factors)
def test_measures_scale(motion, factor):
    scaled = motion.scaled(factor)
    for name, power in zip(MEASURES, (1, 1, 1, 2, 1, 0), strict=True):
        expected = getattr(motion, name) * abs(factor) ** power
        assert getattr(scaled, name) == pytest.approx(expected, rel=1e-10)


@given(moving)
def test_mirroring_changes_no_measure(motion):
    mirrored = motion.scaled(-1)
    assert all(getattr(mirrored, name) == getattr(motion, name) for name in MEASURES)


@given(motions, st.integers(1, 6))
def test_refining_changes_no_measure(motion, k):
    fine = motion.refined(k)
    # Where the velocity returns to zero its rounding is that of the largest one passed on the way.
    passed = motion.pga * motion.duration * np.array([1 / motion.duration, 1, motion.duration])
    for name, size in zip(("pga", "pgv", "pgd"), passed, strict=True):
        assert getattr(fine, name) == pytest.approx(getattr(motion, name), rel=1e-12, abs=1e-12 * size)
    assert fine.arias == pytest.approx(motion.arias, rel=1e-12)
    assert fine.cav == pytest.approx(motion.cav, rel=1e-12)


@pytest.mark.slow
@given(moving, st.integers(2, 5))
def test_refining_changes_no_duration(motion, k):
    # A quiet stretch exactly at a fraction of the energy would make the crossing a matter of rounding.
    energy = np.cumsum(motion.acceleration**2)
    assume(np.all(np.diff(energy) > 1e-6 * energy[-1]))
    assert motion.refined(k).d5_95 == pytest.approx(motion.d5_95, rel=1e-12, abs=1e-9 * motion.dt)


@settings(max_examples=40, deadline=None)
@given(moving, st.floats(0.01, 5), st.sampled_from([0.0, 0.02, 0.3]), st.integers(2, 5))
def test_refining_changes_no_spectrum(motion, period, zeta, k):
    coarse, fine = motion.spectrum([period], zeta), motion.refined(k).spectrum([period], zeta)
    size = motion.pga * min(period / 6, motion.duration) ** 2
    assert fine.sd[0] == pytest.approx(coarse.sd[0], rel=1e-10, abs=1e-12 * size)
    assert fine.sv[0] == pytest.approx(coarse.sv[0], rel=1e-10, abs=1e-12 * size * 6 / period)


@settings(max_examples=40, deadline=None)
@given(moving, factors, st.floats(0.01, 5))
def test_spectra_scale(motion, factor, period):
    scaled = motion.scaled(factor).spectrum([0, period])
    assert scaled.sa == pytest.approx(abs(factor) * motion.spectrum([0, period]).sa, rel=1e-9)


@given(samples, steps, st.integers(1, 5))
def test_a_late_start_changes_nothing_but_time(values, dt, delay):
    motion = GroundMotion([0, *values], dt)
    late = GroundMotion([0] * (delay + 1) + values, dt)
    assert late.duration == pytest.approx(motion.duration + delay * dt)
    for name in MEASURES:
        assert getattr(late, name) == pytest.approx(getattr(motion, name), rel=1e-9, abs=1e-12)


@given(motions)
def test_bounds(motion):
    tiny = 1 + 1e-12
    assert np.max(np.abs(motion.velocity)) <= motion.pgv <= motion.cav * tiny
    assert np.max(np.abs(motion.displacement)) <= motion.pgd <= motion.pgv * motion.duration * tiny
    assert motion.cav <= motion.pga * motion.duration * tiny
    assert 0 <= motion.d5_95 <= motion.duration * tiny


@given(moving, st.integers(0, 2))
def test_correcting_the_baseline_twice_changes_nothing(motion, degree):
    assume(degree <= motion.acceleration.size - 2)
    once = motion.baseline_corrected(degree)
    assert once.baseline_corrected(degree).acceleration == pytest.approx(once.acceleration, abs=1e-9)


@given(st.lists(st.decimals(-2, 2, places=9), min_size=1, max_size=30))
def test_decimals_survive_their_encoding(decimals):
    exact = np.array([float(f"{value:.6e}") for value in decimals]) + 0.0
    assert unpack_decimal_samples(pack_decimal_samples(exact, 7)).tobytes() == exact.tobytes()


@settings(deadline=None)
@given(st.lists(values, min_size=3, max_size=30), st.integers(1, 9), st.sampled_from(["", " ", "  "]), st.data())
def test_wrapping_does_not_matter(tmp_path_factory, numbers, columns, gap, data):
    words = [f"{value:+.10E}" for value in numbers]
    lines = [gap.join(words[i : i + columns]) for i in range(0, len(words), columns)]
    path = tmp_path_factory.mktemp("at2") / "a.at2"
    newline = data.draw(st.sampled_from(["\n", "\r\n"]))
    path.write_bytes(newline.join([f"NPTS= {len(words)}, DT= .01 SEC", *lines]).encode())
    assert read_at2(path).acceleration == pytest.approx(np.array(numbers) * GRAVITY, rel=1e-9)


@settings(deadline=None)
@given(samples, steps, st.sampled_from([",", ";", "\t", " "]))
def test_columns_come_back_as_written(tmp_path_factory, numbers, dt, separator):
    assume(min(numbers) <= 0.0)  # others may be a spectrum
    path = tmp_path_factory.mktemp("text") / "a.txt"
    path.write_text("\n".join(f"{k * dt:.9g}{separator}{value!r}" for k, value in enumerate(numbers)))
    motion = read_motion(path, units="m/s2", dt=dt)
    assert motion.acceleration.tolist() == numbers
    assert motion.dt == dt


@given(st.floats(0.05, 5), st.floats(0.001, 0.5))
def test_steps_of_pulses(period, dt):
    for pulse in (one_sine_pulse(1.0, period, dt), ricker_pulse(1.0, period, dt)):
        assert pulse.dt <= max(dt, pulse.duration / 2) * (1 + 1e-9)
        lengths = pulse.duration / period
        assert lengths == pytest.approx(round(lengths), rel=1e-9)
        assert abs(pulse.velocity[-1]) <= 1e-12 * period
