"""Numbers that no double can hold are refused."""

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from rockflex import GroundMotion, InputError, simulate


def test_a_step_in_which_rotations_overflow_is_refused():
    frame = make_frame(n_stories=1, period=0.5, aspect_ratio=9.0, damping_ratio=0.05)
    motion = GroundMotion([0.0, 5.0, 0.0], 1000.0)
    fall = float(np.sqrt(frame.rocking().l0r * 9.81 / frame.rocking().i_theta))
    with pytest.raises(InputError) as caught:
        simulate(frame, motion)
    text = str(caught.value)
    assert text.startswith("The time step of 1000 s is too long: a rocking rotation of this structure grows e-fold in ")
    longest = float(text.rpartition("at most ")[2].removesuffix(" s."))
    assert longest == pytest.approx(300.0 / fall, rel=0.05)
    simulate(frame, motion.resampled(125.0))
    # A base that never lifts has no rotation to overflow.
    assert simulate(frame, GroundMotion([0.0, 0.5, 0.0], 1000.0)).status == "no_uplift"


@pytest.mark.parametrize("omega", [1e200, 1e-200])
@pytest.mark.parametrize("model", ["2DOF-S", "fixed", "2DOF-C"])
def test_frequencies_whose_square_is_no_number(omega, model):
    properties = rf.RockingProperties([omega], [1e4], [3.0], [1.0], 2e5, 4e4, 2e4, 1.0, 0.02, 1e5)
    with pytest.raises(rf.InputError, match=r"The motion of .* with omega from 1e.200 to .* cannot be computed:"):
        rf.simulate(properties, rf.quiet_motion(1.0), model)
