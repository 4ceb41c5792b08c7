"""2DOF-C against Taylor series of the whole vector field (heyoka, which is optional: `pip install heyoka`)."""

import math

import numpy as np
import pytest

import rockflex as rf

pytest.importorskip("heyoka")

from twins.taylor_rocking import of_properties

README = rf.Frame(5, 3.0, 40e3, 40e3, math.inf, period=1.0, aspect_ratio=10.0, damping_ratio=0.02)
MOTIONS = rf.load_suite("fema-p695-far-field")


def compared(frame, motion):
    """The largest rotation and displacement of both, as ratios, and whether their events are the same."""
    properties = frame.rocking(1)
    run = rf.simulate(frame, motion, "2DOF-C")
    other = of_properties(properties).run(motion.acceleration, motion.dt)
    counts = len(other.uplift_times) == run.n_uplifts, len(other.impact_times) == run.n_impacts
    top = run.max_top_displacement / properties.top_ordinate[0]
    rotation = run.max_rotation / other.max_rotation - 1.0 if run.n_uplifts else 0.0
    return rotation, top / other.max_displacement - 1.0, all(counts)


def test_the_frame_of_the_readme():
    """The tolerance of a step is 1e-10; over this run the errors are a hundredth of that."""
    rotation, displacement, same = compared(README, rf.load_suite("el-centro-1940")[0].scaled(1.5))
    assert same
    assert abs(rotation) < 1e-11
    assert abs(displacement) < 1e-11


@pytest.mark.parametrize("seed", range(8))
def test_random_frames(seed):
    """Errors of 1e-10 a step grow with the impacts: two thirds of random runs agree to 1e-10, all to 1e-8."""
    rng = np.random.default_rng(seed)
    frame = rf.Frame(
        int(rng.integers(1, 6)), 3.0, 40e3, 40e3 * rng.uniform(1.0, 3.0), math.inf,
        period=rng.uniform(0.4, 1.5), aspect_ratio=rng.uniform(6.0, 11.0), damping_ratio=rng.uniform(0.0, 0.05),
    )  # fmt: skip
    motion = MOTIONS[int(rng.integers(len(MOTIONS)))].scaled(rng.uniform(1.0, 2.0))
    rotation, displacement, same = compared(frame, motion)
    assert same
    assert abs(rotation) < 1e-8
    assert abs(displacement) < 1e-8
