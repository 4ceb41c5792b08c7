import numpy as np
import pytest

from builders import make_frame
from rockflex import (
    Frame,
    GroundMotion,
    InitialState,
    InputError,
    LumpedStructure,
    Model,
    RockingProperties,
    load_suite,
    quiet_motion,
    simulate,
)
from rockflex._shown import shown

MOTION = GroundMotion(load_suite("el-centro-1940")[0].acceleration[:300] * 2.0, 0.02, name="El Centro")
FRAME = make_frame(n_stories=3, base_mass=60e3, stiffness_ratio=1.0, period=0.5, aspect_ratio=8.0, damping_ratio=0.03)


def test_structures_and_their_properties_are_alike():
    whole = simulate(FRAME, MOTION)
    assert whole.status == "rocking"
    assert simulate(FRAME.rocking(), MOTION).peaks() == whole.peaks()
    for same in (FRAME.lumped, FRAME.lumped.rocking()):  # whose modes are computed, those of the frame are scaled
        for name, value in simulate(same, MOTION).peaks().items():
            expected = whole.peaks()[name]
            assert value == (pytest.approx(expected, rel=1e-9) if isinstance(expected, float) else expected), name
    assert simulate(FRAME.rocking(1), MOTION).peaks() == {
        **simulate(FRAME, MOTION, "2DOF-S").peaks(),
        "model": "MDOF-S",
    }
    assert isinstance(FRAME.lumped, LumpedStructure)


def test_labels_and_models_are_alike():
    for label, model in (("3DOF-S", Model(2)), ("MDOF-S", Model()), ("2DOF-fixed", Model(2, lifts=False))):
        assert simulate(FRAME, MOTION, label).peaks() == simulate(FRAME, MOTION, model).peaks()
    assert simulate(FRAME, MOTION).model == "MDOF-S"


def test_a_label_of_all_modes_is_all_modes():
    one, all_modes = simulate(FRAME, MOTION, "4DOF-S"), simulate(FRAME, MOTION, "MDOF-S")
    assert one.peaks() == {**all_modes.peaks(), "model": "4DOF-S"}
    assert np.array_equal(one.history.states, all_modes.history.states)


def test_the_name_of_the_motion_is_kept():
    assert simulate(FRAME, MOTION).motion == "El Centro"
    assert simulate(FRAME, GroundMotion([0.0, 1.0, 0.0], 0.1)).motion == ""


def test_what_a_run_leaves_untouched():
    before = MOTION.acceleration.copy()
    one, other = simulate(FRAME, MOTION), simulate(FRAME, MOTION)
    assert one.peaks() == other.peaks()
    assert np.array_equal(one.history.states, other.history.states)
    assert np.array_equal(MOTION.acceleration, before)
    assert not MOTION.acceleration.flags.writeable


@pytest.mark.parametrize(
    ("seconds", "end"), [(0.0, 5.98), (0, 5.98), (0.02, 6.0), (1.0, 6.98), (0.011, 6.0), (np.float32(0.5), 6.48)]
)
def test_free_vibration_is_rounded_up_to_samples(seconds, end):
    run = simulate(FRAME, MOTION, free_vibration=seconds)
    assert run.end_time == pytest.approx(end, abs=1e-9)
    assert run.time[-1] == pytest.approx(end, abs=1e-9)
    assert not run.settled


def test_free_vibration_is_a_record_that_goes_on_with_zeros():
    ended = GroundMotion(np.append(MOTION.acceleration, 0.0), 0.02)
    longer = GroundMotion(np.append(MOTION.acceleration, np.zeros(101)), 0.02)
    one, other = simulate(FRAME, ended, free_vibration=2.0), simulate(FRAME, longer)
    for name, value in one.peaks().items():
        assert getattr(other, name) == (pytest.approx(value, rel=1e-12) if isinstance(value, float) else value)


def test_many_modes_of_few_floors():
    with pytest.raises(InputError, match="Model 6DOF-S needs 5 modes, but the structure has 3"):
        simulate(FRAME, MOTION, "6DOF-S")


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        (
            {"structure": 3},
            "structure must be a structure such as a Frame or a TaperedTower, or RockingProperties, but int was given.",
        ),
        ({"structure": None}, "structure must be .*, but NoneType was given"),
        ({"structure": Frame}, "structure must be .*, but the class Frame was given"),
        ({"structure": RockingProperties}, "structure must be .*, but the class RockingProperties was given"),
        ({"motion": MOTION.acceleration}, "motion must be a GroundMotion, but ndarray was given. Read or build one"),
        ({"motion": load_suite("el-centro-1940")}, "motion must be a GroundMotion, but Suite was given"),
        ({"motion": GroundMotion}, "motion must be a GroundMotion, but the class GroundMotion was given"),
        ({"model": "nonsense"}, "Unknown model 'nonsense'. Expected "),
        ({"model": None}, "Unknown model None. Expected "),
        ({"output": "everything"}, 'output must be "history" or "peaks", but \'everything\' was given'),
        ({"output": None}, 'output must be "history" or "peaks", but None was given'),
        (
            {"initial": 0.1},
            r"initial must be an InitialState or None, but 0\.1 was given. Write InitialState\(rotation=",
        ),
        ({"initial": (0.1,)}, r"initial must be an InitialState or None, but \(0\.1,\) was given"),
        ({"initial": InitialState}, "initial must be an InitialState or None, but <class .*InitialState'> was given"),
    ],
)
def test_arguments_that_cannot_be_used(changes, text):
    with pytest.raises(InputError, match=text):
        simulate(**{"structure": FRAME, "motion": MOTION, **changes})


@pytest.mark.parametrize(
    "given", [-1.0, np.nan, np.inf, 1.1e9, 10**400, None, True, "x", "rest", [1.0], np.array([1.0, 2.0]), 1j]
)
@pytest.mark.parametrize("output", ["history", "peaks"])
def test_free_vibration_is_seconds_or_a_word(given, output):
    with pytest.raises(InputError) as caught:
        simulate(FRAME, MOTION, output=output, free_vibration=given)
    text = f'free_vibration must be zero or more seconds (at most 1e+09), or "settle", but {shown(given)} was given.'
    assert str(caught.value) == text


def test_where_the_ground_comes_to_rest():
    """The last sample acts to the end; the jump to zero after it belongs to the free vibration."""
    assert MOTION.acceleration[-1] != 0.0
    alone = simulate(FRAME, MOTION)
    assert alone.ground_acceleration[-1] == MOTION.acceleration[-1]
    assert alone.end_time == pytest.approx(MOTION.duration)
    for seconds in (1.0, "settle"):
        run = simulate(FRAME, MOTION, free_vibration=seconds)
        last = np.flatnonzero(np.abs(run.time - MOTION.duration) < 1e-9)
        assert run.ground_acceleration[last].tolist() == [MOTION.acceleration[-1], 0.0]
        assert not run.ground_acceleration[last[1] :].any()
        assert np.array_equal(run.history.states[: last[1]], alone.history.states)
    ended = GroundMotion(np.append(MOTION.acceleration, 0.0), 0.02)
    run = simulate(FRAME, ended, free_vibration=1.0)
    assert np.count_nonzero(np.abs(run.time - ended.duration) < 1e-9) == 1


def test_the_shortest_record():
    run = simulate(FRAME, GroundMotion([0.0, 1.0, 0.0], 0.02))
    assert run.time.tolist() == [0.0, 0.02, 0.04]
    assert run.max_top_displacement > 0.0


def test_nothing_but_zeros():
    run = simulate(FRAME, quiet_motion(1.0, dt=0.01))
    assert (run.status, run.n_uplifts, run.n_impacts, run.nominal_overturning) == ("no_uplift", 0, 0, False)
    assert all(value == 0.0 for name, value in run.peaks().items() if name.startswith(("max", "time")))
