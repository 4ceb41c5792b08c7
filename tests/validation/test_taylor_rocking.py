"""2DOF-C against Taylor series of the whole vector field (heyoka, which is optional: `pip install heyoka`)."""

import math

import numpy as np
import pytest

import rockflex as rf

hy = pytest.importorskip("heyoka")

from twins.taylor_rocking import of_properties  # noqa: E402

README = rf.Frame(5, 3.0, 40e3, 40e3, math.inf, period=1.0, aspect_ratio=10.0, damping_ratio=0.02)
MOTIONS = rf.load_suite("fema-p695-far-field")


def compared(frame, motion, kind=float):
    """The largest rotation and displacement of both, as ratios, and whether their events are the same."""
    properties = frame.rocking(1)
    run = rf.simulate(frame, motion, "2DOF-C")
    other = of_properties(properties, kind).run(motion.acceleration, motion.dt)
    counts = len(other.uplift_times) == run.n_uplifts, len(other.impact_times) == run.n_impacts
    top = run.max_top_displacement / properties.top_ordinate[0]
    rotation = float(kind(run.max_rotation) / other.max_rotation - kind(1.0)) if run.n_uplifts else 0.0
    return rotation, float(kind(top) / other.max_displacement - kind(1.0)), all(counts)


def test_the_frame_of_the_readme():
    """In 34 digits; the tolerance of a step is 1e-10, and most steps, which end with their sample, are shorter."""
    kind = getattr(hy, "real128", float)  # not on every machine
    rotation, displacement, same = compared(README, rf.load_suite("el-centro-1940")[0].scaled(1.5), kind)
    assert same
    assert abs(rotation) < 1e-12
    assert abs(displacement) < 1e-12


def test_double_precision_is_enough_for_taylor_series():
    motion, properties = rf.load_suite("el-centro-1940")[0].scaled(1.5), README.rocking(1)
    kind = getattr(hy, "real128", None)
    if kind is None:
        pytest.skip("no numbers of 34 digits on this machine")
    exact, double = (of_properties(properties, each).run(motion.acceleration, motion.dt) for each in (kind, float))
    assert abs(float(kind(double.max_rotation) / exact.max_rotation - kind(1.0))) < 1e-14
    assert np.abs(np.subtract(exact.impact_times, double.impact_times)).max() < 1e-13


@pytest.mark.parametrize("seed", range(8))
def test_random_frames(seed):
    """Errors of 1e-10 a step at most grow with the impacts: nine of ten random runs agree to 5e-12."""
    rng = np.random.default_rng(seed)
    frame = rf.Frame(
        int(rng.integers(1, 6)), 3.0, 40e3, 40e3 * rng.uniform(1.0, 3.0), math.inf,
        period=rng.uniform(0.4, 1.5), aspect_ratio=rng.uniform(6.0, 11.0), damping_ratio=rng.uniform(0.0, 0.05),
    )  # fmt: skip
    motion = MOTIONS[int(rng.integers(len(MOTIONS)))].scaled(rng.uniform(1.0, 2.0))
    rotation, displacement, same = compared(frame, motion)
    assert same
    assert abs(rotation) < 1e-9
    assert abs(displacement) < 1e-9
