"""A single run, and what `simulate` stores of a structure for the next one."""

import threading

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from rockflex.foundation.shown import shown
from rockflex.studies import _simulate
from rockflex.studies._prepared_case import PreparedCase

MOTION = rf.GroundMotion(rf.load_suite("el-centro-1940")[0].acceleration[:300] * 2.0, 0.02, name="El Centro")
FRAME = make_frame(n_stories=3, base_mass=60e3, stiffness_ratio=1.0, period=0.5, aspect_ratio=8.0, damping_ratio=0.03)


def test_structures_and_their_properties_are_alike():
    whole = rf.simulate(FRAME, MOTION)
    assert whole.status == "rocking"
    assert rf.simulate(FRAME.rocking(), MOTION).peaks() == whole.peaks()
    for same in (FRAME.lumped, FRAME.lumped.rocking()):  # whose modes are computed, those of the frame are scaled
        for name, value in rf.simulate(same, MOTION).peaks().items():
            expected = whole.peaks()[name]
            assert value == (pytest.approx(expected, rel=1e-9) if isinstance(expected, float) else expected), name
    assert rf.simulate(FRAME.rocking(1), MOTION).peaks() == {
        **rf.simulate(FRAME, MOTION, "2DOF-S").peaks(),
        "model": "MDOF-S",
    }
    assert isinstance(FRAME.lumped, rf.LumpedStructure)


def test_labels_and_models_are_alike():
    for label, model in (("3DOF-S", rf.Model(2)), ("MDOF-S", rf.Model()), ("2DOF-fixed", rf.Model(2, lifts=False))):
        assert rf.simulate(FRAME, MOTION, label).peaks() == rf.simulate(FRAME, MOTION, model).peaks()
    assert rf.simulate(FRAME, MOTION).model == "MDOF-S"


def test_a_label_of_all_modes_is_all_modes():
    one, all_modes = rf.simulate(FRAME, MOTION, "4DOF-S"), rf.simulate(FRAME, MOTION, "MDOF-S")
    assert one.peaks() == {**all_modes.peaks(), "model": "4DOF-S"}
    assert np.array_equal(one.history.states, all_modes.history.states)


def test_the_name_of_the_motion_is_kept():
    assert rf.simulate(FRAME, MOTION).motion == "El Centro"
    assert rf.simulate(FRAME, rf.GroundMotion([0.0, 1.0, 0.0], 0.1)).motion == ""


def test_what_a_run_leaves_untouched():
    before = MOTION.acceleration.copy()
    one, other = rf.simulate(FRAME, MOTION), rf.simulate(FRAME, MOTION)
    assert one.peaks() == other.peaks()
    assert np.array_equal(one.history.states, other.history.states)
    assert np.array_equal(MOTION.acceleration, before)
    assert not MOTION.acceleration.flags.writeable


@pytest.mark.parametrize(
    ("seconds", "end"), [(0.0, 5.98), (0, 5.98), (0.02, 6.0), (1.0, 6.98), (0.011, 6.0), (np.float32(0.5), 6.48)]
)
def test_free_vibration_is_rounded_up_to_samples(seconds, end):
    run = rf.simulate(FRAME, MOTION, free_vibration=seconds)
    assert run.end_time == pytest.approx(end, abs=1e-9)
    assert run.time[-1] == pytest.approx(end, abs=1e-9)
    assert not run.settled


def test_free_vibration_is_a_record_that_goes_on_with_zeros():
    ended = rf.GroundMotion(np.append(MOTION.acceleration, 0.0), 0.02)
    longer = rf.GroundMotion(np.append(MOTION.acceleration, np.zeros(101)), 0.02)
    one, other = rf.simulate(FRAME, ended, free_vibration=2.0), rf.simulate(FRAME, longer)
    for name, value in one.peaks().items():
        assert getattr(other, name) == (pytest.approx(value, rel=1e-12) if isinstance(value, float) else value)


def test_many_modes_of_few_floors():
    with pytest.raises(rf.InputError, match="Model 6DOF-S needs 5 modes, but the structure has 3"):
        rf.simulate(FRAME, MOTION, "6DOF-S")


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({"structure": 3}, "structure must be a structure such as a Frame or a TaperedTower, or RockingProperties,"),
        ({"structure": rf.Frame}, "structure must be .*, but the class Frame was given"),
        ({"motion": MOTION.acceleration}, "motion must be a GroundMotion, but ndarray was given. Read or build one"),
        ({"motion": rf.load_suite("el-centro-1940")}, "motion must be a GroundMotion, but Suite was given"),
        ({"model": "nonsense"}, "Unknown model 'nonsense'. Expected "),
        ({"model": None}, "Unknown model None. Expected "),
        ({"output": "everything"}, 'output must be "history" or "peaks", but \'everything\' was given'),
        ({"initial": 0.1}, r"initial must be an InitialState or None, but 0\.1 was given. Write"),
    ],
)
def test_arguments_that_cannot_be_used(changes, text):
    with pytest.raises(rf.InputError, match=text):
        rf.simulate(**{"structure": FRAME, "motion": MOTION, **changes})


@pytest.mark.parametrize(
    "given", [-1.0, np.nan, np.inf, 1.1e9, 10**400, None, True, "x", "rest", [1.0], np.array([1.0, 2.0]), 1j]
)
@pytest.mark.parametrize("output", ["history", "peaks"])
def test_free_vibration_is_seconds_or_a_word(given, output):
    with pytest.raises(rf.InputError) as caught:
        rf.simulate(FRAME, MOTION, output=output, free_vibration=given)
    text = f'free_vibration must be zero or more seconds (at most 1e+09), or "settle", but {shown(given)} was given.'
    assert str(caught.value) == text


def test_where_the_ground_comes_to_rest():
    """The last sample acts to the end; the jump to zero after it belongs to the free vibration."""
    assert MOTION.acceleration[-1] != 0.0
    alone = rf.simulate(FRAME, MOTION)
    assert alone.ground_acceleration[-1] == MOTION.acceleration[-1]
    assert alone.end_time == pytest.approx(MOTION.duration)
    for seconds in (1.0, "settle"):
        run = rf.simulate(FRAME, MOTION, free_vibration=seconds)
        last = np.flatnonzero(np.abs(run.time - MOTION.duration) < 1e-9)
        assert run.ground_acceleration[last].tolist() == [MOTION.acceleration[-1], 0.0]
        assert not run.ground_acceleration[last[1] :].any()
        assert np.array_equal(run.history.states[: last[1]], alone.history.states)
    ended = rf.GroundMotion(np.append(MOTION.acceleration, 0.0), 0.02)
    run = rf.simulate(FRAME, ended, free_vibration=1.0)
    assert np.count_nonzero(np.abs(run.time - ended.duration) < 1e-9) == 1


def test_the_shortest_record():
    run = rf.simulate(FRAME, rf.GroundMotion([0.0, 1.0, 0.0], 0.02))
    assert run.time.tolist() == [0.0, 0.02, 0.04]
    assert run.max_top_displacement > 0.0


def test_nothing_but_zeros():
    run = rf.simulate(FRAME, rf.quiet_motion(1.0, dt=0.01))
    assert (run.status, run.n_uplifts, run.n_impacts, run.nominal_overturning) == ("no_uplift", 0, 0, False)
    assert all(value == 0.0 for name, value in run.peaks().items() if name.startswith(("max", "time")))


PULSE = rf.one_sine_pulse(amplitude=4.0, period=0.8)


@pytest.fixture
def prepared(monkeypatch):
    """The cases that were prepared."""
    _simulate._cache.clear()
    found, prepare = [], PreparedCase.__post_init__

    def watched(self):
        prepare(self)
        found.append(self)

    monkeypatch.setattr(PreparedCase, "__post_init__", watched)
    return found


def test_a_structure_is_prepared_once(prepared):
    frame = make_frame(n_stories=2)
    first = rf.simulate(frame, PULSE, "2DOF-S", output="peaks")
    assert rf.simulate(frame, PULSE, "2DOF-S", output="peaks") == first
    rf.simulate(frame, PULSE.scaled(2.0), "2DOF-S", output="peaks")
    assert len(prepared) == 1


@pytest.mark.parametrize(
    "other",
    [
        {"model": "MDOF-S"},
        {"output": "history"},
        {"free_vibration": 1.0},
        {"impact": rf.Restitution(0.5)},
        {"initial": rf.InitialState(rotation=0.001)},
        {"ground": rf.Ground(friction=0.4)},
        {"work_limit": None},
    ],
    ids=lambda other: next(iter(other)),
)
def test_another_argument_needs_another_preparation(prepared, other):
    frame, usual = make_frame(n_stories=2), {"model": "2DOF-S", "output": "peaks"}
    expected = rf.simulate(make_frame(n_stories=2), PULSE, **usual | other).peaks()
    rf.simulate(frame, PULSE, **usual)
    assert rf.simulate(frame, PULSE, **usual | other).peaks() == expected
    assert len(prepared) == 3


def test_a_law_of_the_user_is_asked_anew(prepared):
    class Half:
        keeps = "half of it"
        loses = "the rest"
        share = 0.5

        def after(self, properties, modal_velocity, rotation_velocity):
            return self.share * modal_velocity, 0.0

    frame, law = make_frame(n_stories=2), Half()
    one = rf.simulate(frame, PULSE, "2DOF-S", impact=law, free_vibration=2.0)
    law.share = 0.1
    other = rf.simulate(frame, PULSE, "2DOF-S", impact=law, free_vibration=2.0)
    assert one.n_impacts > 0
    assert not np.allclose(one.modal_velocity[-1], other.modal_velocity[-1])
    assert len(prepared) == 2


def test_failed_runs_leave_nothing_behind(prepared):
    frame = make_frame(n_stories=2)
    for _ in range(2):
        with pytest.raises(rf.InputError, match="work_limit is 1e-09 s"):
            rf.simulate(frame, PULSE, work_limit=1e-9)
    assert len(prepared) == 2
    assert not _simulate._cache


def test_few_cases_are_kept(monkeypatch):
    _simulate._cache.clear()
    monkeypatch.setattr(_simulate, "MAX_CASES", 3)
    frames = [make_frame(n_stories=n) for n in (1, 2, 3, 4, 5)]
    for frame in frames:
        rf.simulate(frame, PULSE, "2DOF-S", output="peaks")
    assert len(_simulate._cache) == 3
    monkeypatch.setattr(_simulate, "MIN_WEIGHED_BYTES", 10)  # so that the cases are weighed after every run
    monkeypatch.setattr(_simulate, "MAX_TOTAL_BYTES", 10)
    rf.simulate(frames[-1], PULSE, "2DOF-S", output="peaks")
    assert not _simulate._cache


def test_threads_may_simulate_the_same_structure():
    frame, found = make_frame(n_stories=3), []
    expected = rf.simulate(make_frame(n_stories=3), PULSE, "MDOF-S", output="peaks").peaks()

    def work():
        found.extend(rf.simulate(frame, PULSE, "MDOF-S", output="peaks").peaks() for _ in range(20))

    threads = [threading.Thread(target=work) for _ in range(4)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    assert found == [expected] * 80


def test_many_structures_give_the_same_table_on_threads(monkeypatch):
    monkeypatch.setattr(_simulate, "RUNS_PER_TASK", (8, 8))
    frames = {f"{t:.3g} s": make_frame(n_stories=2, period=t) for t in np.linspace(0.3, 1.5, 20)}
    frames["low"] = make_frame(n_stories=1)  # has one mode only
    options = {"models": ["2DOF-S", "3DOF-S"], "scales": (0.5, 1.0)}
    alone = rf.simulate_many(frames, PULSE, workers=1, **options)
    assert rf.simulate_many(frames, PULSE, workers=2, **options).equals(alone)
    assert alone["error"].notna().sum() == 2
