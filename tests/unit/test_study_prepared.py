"""What `simulate` keeps of a structure, and what many structures share."""

import threading

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from rockflex.study import _prepared, _simulate_many
from rockflex.study._case import Case

PULSE = rf.one_sine_pulse(amplitude=4.0, period=0.8)


@pytest.fixture
def prepared(monkeypatch):
    """The cases that were prepared."""
    _prepared._kept.clear()
    found, prepare = [], Case.__post_init__

    def watched(self):
        prepare(self)
        found.append(self)

    monkeypatch.setattr(Case, "__post_init__", watched)
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
    assert not _prepared._kept


def test_few_cases_are_kept(monkeypatch):
    _prepared._kept.clear()
    monkeypatch.setattr(_prepared, "MOST", 3)
    frames = [make_frame(n_stories=n) for n in (1, 2, 3, 4, 5)]
    for frame in frames:
        rf.simulate(frame, PULSE, "2DOF-S", output="peaks")
    assert len(_prepared._kept) == 3
    monkeypatch.setattr(_prepared, "LARGE", 10)  # so that the cases are weighed after every run
    monkeypatch.setattr(_prepared, "TOGETHER", 10)
    rf.simulate(frames[-1], PULSE, "2DOF-S", output="peaks")
    assert not _prepared._kept


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
    monkeypatch.setattr(_simulate_many, "CHUNK", 8)
    frames = {f"{t:.3g} s": make_frame(n_stories=2, period=t) for t in np.linspace(0.3, 1.5, 20)}
    frames["low"] = make_frame(n_stories=1)  # has one mode only
    options = {"models": ["2DOF-S", "3DOF-S"], "scales": (0.5, 1.0)}
    alone = rf.simulate_many(frames, PULSE, workers=1, **options)
    assert rf.simulate_many(frames, PULSE, workers=2, **options).equals(alone)
    assert alone["error"].notna().sum() == 2
