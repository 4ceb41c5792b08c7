import copy
import math
import pickle
from fractions import Fraction

import numpy as np
import pytest

from builders import make_frame
from rockflex import InitialState, InputError, quiet_motion, simulate
from rockflex.models import Model

FRAME = make_frame(n_stories=3, base_mass=60e3, stiffness_ratio=1.0, period=0.5, aspect_ratio=8.0, damping_ratio=0.03)
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
        (InitialState(0.1), FIXED, r"fixed has a base that cannot lift, but rotation=0\.1 and .*Give zero, or a model"),
        (InitialState(rotation_velocity=1.0), FIXED, "fixed has a base that cannot lift"),
    ],
)
def test_impossible_states(initial, model, text):
    with pytest.raises(InputError, match=text):
        initial.state(model)


PI = 0.5 * math.pi


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({"rotation": None}, "rotation must be a number between -1.5708 and 1.5708 rad, but None was given."),
        ({"rotation": True}, "rotation must be a number between -1.5708 and 1.5708 rad, but True was given."),
        ({"rotation": np.array([0.1])}, "rotation must be a number between -1.5708 and 1.5708 rad, but array([0.1])"),
        ({"rotation": PI}, f"rotation must be a number between -1.5708 and 1.5708 rad, but {PI!r} was given."),
        ({"rotation_velocity": -1e300}, "rotation_velocity must be a number between -1e+09 and 1e+09 rad/s, but"),
        ({"modal_displacement": [[1.0]]}, "modal_displacement must be one-dimensional, but an array of shape (1, 1)"),
        ({"modal_displacement": [math.nan]}, "modal_displacement must be finite, but 1 of 1 values are not, the first"),
        ({"modal_displacement": [0.1, -1e10]}, "modal_displacement[1] must be a number between -1e+09 and 1e+09 m,"),
        ({"modal_velocity": "fast"}, "modal_velocity must be a sequence of numbers in m/s, but str was given."),
        ({"modal_velocity": (1e200,)}, "modal_velocity[0] must be a number between -1e+09 and 1e+09 m/s, but 1e+200"),
    ],
)
def test_values_that_no_state_has(changes, text):
    with pytest.raises(InputError) as caught:
        InitialState(**changes)
    assert str(caught.value).startswith(text)


@pytest.mark.parametrize("number", [1, np.float32(0.5), np.float16(0.5), np.int64(1), Fraction(1, 2)])
def test_any_number_does(number):
    state = InitialState(number, rotation_velocity=number)
    assert (state.rotation, state.rotation_velocity) == (float(number), float(number))
    assert type(state.rotation) is float


def test_values_are_copied_and_frozen():
    mine = np.array([0.1, 0.2])
    given = InitialState(0.1, mine, [0.3])
    mine[:] = 0.0
    for state in (given, copy.deepcopy(given), pickle.loads(pickle.dumps(given))):
        assert (state.rotation, state.rotation_velocity) == (0.1, 0.0)
        assert state.modal_displacement.tolist() == [0.1, 0.2]
        assert state.modal_velocity.tolist() == [0.3]
        for values in (state.modal_displacement, state.modal_velocity):
            with pytest.raises(ValueError, match="read-only"):
                values[0] = 0.0
        with pytest.raises(AttributeError):
            state.rotation = 0.0
    assert InitialState().modal_displacement is None


@pytest.mark.parametrize("velocity", [-9.9e8, -1e3, 1e3, 9.9e8])
@pytest.mark.parametrize("rotation", [0.0, 0.1, -0.1])
def test_whatever_is_accepted_is_solved(rotation, velocity):
    start = InitialState(rotation, [1e3], [1e8], rotation_velocity=velocity)
    run = simulate(FRAME, quiet_motion(0.1), initial=start)
    assert run.status == "overturned"
    assert np.isfinite(run.history.states).all()
    assert np.isfinite(run.energy.residual).all()


def test_where_a_run_starts():
    """At rest on the ground unless told otherwise; uplifted where the rotation or its velocity is not zero."""
    quiet = quiet_motion(0.1)
    start = InitialState(-0.02, [0.01, 0.002], [0.3], rotation_velocity=0.1)
    run = simulate(FRAME, quiet, initial=start)
    assert run.history.states[0].tolist() == [0, -1, 0, 0, 0.01, 0.002, 0, 0.3, 0, 0, -0.02, 0.1]
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
