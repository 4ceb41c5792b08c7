import math

import numpy as np
import pytest

from rockflex import Frame, InitialState, InputError, quiet_motion, simulate
from rockflex.models import Model

FRAME = Frame(
    n_stories=3,
    story_height=3.0,
    story_mass=40e3,
    base_mass=60e3,
    stiffness_ratio=1.0,
    period=0.5,
    aspect_ratio=8.0,
    damping_ratio=0.03,
)
THREE, TWO = Model().of(FRAME.rocking()), Model(2).of(FRAME.rocking())
FIXED = Model(lifts=False).of(FRAME.rocking())


@pytest.mark.parametrize(
    ("initial", "expected"),
    [
        (InitialState(), [0, 0, 0, 0, 0, 0, 0, 0]),
        (InitialState(0.1), [0, 0, 0, 0, 0, 0, 0.1, 0]),
        (InitialState(-0.1, [1, 2, 3], [4, 5, 6], 7), [1, 2, 3, 4, 5, 6, -0.1, 7]),
        (InitialState(modal_displacement=[1.0]), [1, 0, 0, 0, 0, 0, 0, 0]),
        (InitialState(modal_velocity=np.array([1, 2])), [0, 0, 0, 1, 2, 0, 0, 0]),
        (InitialState(modal_displacement=[], rotation_velocity=-2.0), [0, 0, 0, 0, 0, 0, 0, -2]),
    ],
)
def test_states(initial, expected):
    assert initial.state(THREE).tolist() == expected


def test_a_fixed_base_may_start_deformed():
    assert InitialState(0.0, [1.0], [2.0]).state(FIXED).tolist() == [1, 0, 0, 2, 0, 0, 0, 0]


@pytest.mark.parametrize(
    ("initial", "model", "text"),
    [
        (InitialState(0.0, [1, 2, 3]), TWO, "modal_displacement has 3 values, but 3DOF-S has 2 modes. Give at most 2."),
        (InitialState(0.0, None, [1, 2, 3, 4]), THREE, "modal_velocity has 4 values, but MDOF-S has 3 modes"),
        (InitialState(0.0, [[1.0]]), THREE, r"modal_displacement must be one-dimensional, but .* shape \(1, 1\)"),
        (InitialState(0.0, [math.nan]), THREE, "modal_displacement must be finite, but 1 of 1 values are not"),
        (InitialState(0.0, None, "fast"), THREE, "modal_velocity must be .* in m/s, but str was given"),
        (InitialState(math.pi / 2), THREE, r"must lie below π/2 = 1\.5708 rad .*but rotation=1\.57.* were given"),
        (InitialState(-2.0), THREE, "must lie below π/2"),
        (InitialState(math.nan), THREE, "must lie below π/2.*rotation=nan"),
        (InitialState(rotation_velocity=math.inf), THREE, "its velocity be finite, but.*rotation_velocity=inf"),
        (InitialState(0.1), FIXED, r"fixed has a base that cannot lift, but rotation=0\.1 and .*Give zero, or a model"),
        (InitialState(rotation_velocity=1.0), FIXED, "fixed has a base that cannot lift"),
    ],
)
def test_impossible_states(initial, model, text):
    with pytest.raises(InputError, match=text):
        initial.state(model)


def test_where_a_run_starts():
    """At rest on the ground unless told otherwise; uplifted where the rotation or its velocity is not zero."""
    quiet = quiet_motion(0.1)
    start = InitialState(-0.02, [0.01, 0.002], [0.3], rotation_velocity=0.1)
    run = simulate(FRAME, quiet, initial=start)
    assert run.history.nodes[0].tolist() == [0, -1, 0, 0.01, 0.002, 0, 0.3, 0, 0, -0.02, 0.1]
    assert run.max_rotation == 0.02
    assert run.status == "rocking"
    for velocity in (0.5, -0.5):
        run = simulate(FRAME, quiet, initial=InitialState(rotation_velocity=velocity))
        assert run.side[0] == np.sign(velocity)
        assert (run.status, run.n_uplifts) == ("rocking", 0)
    run = simulate(FRAME, quiet, initial=InitialState(modal_displacement=[1e-4]))
    assert (run.status, run.side[0]) == ("no_uplift", 0.0)
    p = FRAME.rocking()
    assert run.max_top_displacement == pytest.approx(1e-4 * p.top_ordinate[0], rel=1e-12)


def test_a_state_that_the_ground_cannot_hold_lifts_at_once():
    run = simulate(FRAME, quiet_motion(1.0), initial=InitialState(modal_displacement=[0.2]))
    assert run.uplift_times[0] == 0.0
    assert run.time_of_max_top_displacement == 0.0
