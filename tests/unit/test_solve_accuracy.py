"""How many digits are left where the motion itself doubles no error: few impacts, much damping."""

import numpy as np
import pytest

from builders import frame_values
from rockflex import Frame, GroundMotion, load_suite, simulate
from twins.fine_step import simulate_fine
from twins.frame import frame_properties

PEAKS = ("max_rotation", "max_top_displacement", "max_base_moment", "max_base_shear")


def errors(motion, **changes):
    frame = frame_values(n_stories=3, stiffness_ratio=1.0, period=0.3, aspect_ratio=6.0, damping_ratio=0.05)
    given = {**frame, **changes}
    mine = simulate(Frame(**given), motion, output="peaks")
    parameters = frame_properties(**given)
    twin, moved = (
        simulate_fine(**parameters, acceleration=factor * motion.acceleration, dt=motion.dt)
        for factor in (1.0, 1.0 + 1e-15)
    )
    assert mine.n_impacts == twin.n_impacts > 1

    def relative(one):
        return max(abs(getattr(one, name) / getattr(twin, name) - 1.0) for name in PEAKS)

    assert relative(moved) < 1e-13
    return relative(mine)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["FF-2-a", "FF-17-b"])
def test_records(name):
    assert errors(load_suite("fema-p695-far-field")[name]) < 1e-11


NOISE = {"period": 0.2, "aspect_ratio": 10.0}


def noise():
    return GroundMotion(8.0 * np.random.default_rng(1).standard_normal(300), 0.002)


def test_steep_noise():
    """Slopes of 10 000 m/s³ against rotations of a milliradian."""
    motion = noise()
    # A slope a' displaces the speed that is carried by about a'/g: each sample rounds θ' by ε a'/g.
    slopes = np.diff(motion.acceleration) / motion.dt / 9.81
    rounding = np.finfo(float).eps * np.linalg.norm(slopes) * motion.duration
    assert errors(motion, **NOISE) < rounding / 1.026e-3  # θ_max in rad
