"""Runs in slices: wherever a run pauses it goes on there, bit for bit, and can be stopped."""

from itertools import count

import numpy as np
import pytest

from builders import make_frame
from rockflex import BoucWen, Restitution, load_suite
from rockflex.models import parse_model
from rockflex.response import asked_of
from rockflex.solve import Engine, RunStoppedError, stopping_when
from rockflex.solve.layout import FOLLOWS

FRAME = make_frame(n_stories=3, period=0.5, aspect_ratio=8.0, damping_ratio=0.03)
RECORD = 2.5 * load_suite("el-centro-1940")[0].acceleration[60:220]
COARSE = RECORD[::5].copy()
CASES = {
    # what the run is of, and how
    "MDOF-S": ("MDOF-S", {}, RECORD, 0.02, {"history": True}),
    "2DOF-C": ("2DOF-C", {}, RECORD, 0.02, {"history": True, "free_vibration": 0.5}),
    "MDOF-C": ("MDOF-C", {}, RECORD[:80], 0.02, {}),
    "rigid": ("rigid", {"law": Restitution(0.9)}, RECORD, 0.02, {"history": True, "free_vibration": 2.0}),
    "rigid-C": ("rigid-C", {"law": Restitution(0.9)}, RECORD, 0.02, {"history": True, "free_vibration": 2.0}),
    "2DOF-S-BW": ("2DOF-S", {"bouc_wen": BoucWen(0.03)}, RECORD, 0.02, {"history": True}),
    "1DOF-fixed-BW": ("1DOF-fixed", {"bouc_wen": BoucWen(0.01)}, RECORD, 0.02, {"history": True}),
    "settles": ("MDOF-S", {}, RECORD[:80], 0.02, {"history": True, "free_vibration": None}),
    "settles, integrated": ("2DOF-C", {}, RECORD[:80], 0.02, {"free_vibration": None}),
    "on a grid": ("MDOF-S", {}, COARSE, 0.1, {"history": True, "free_vibration": 1.0}),
    "on a grid, peaks": ("MDOF-S", {}, COARSE, 0.1, {}),
    "on a grid, integrated": ("MDOF-C", {}, COARSE, 0.1, {"history": True}),
    "overturns": ("2DOF-S", {}, 3.0 * RECORD, 0.04, {"history": True, "free_vibration": 20.0}),
}


def engine(label, options):
    model = parse_model(label).of(FRAME.rocking(), options.get("law"), options.get("bouc_wen"))
    return Engine(model, asked_of(model, floors=True))


@pytest.fixture
def carried(monkeypatch):
    """How often the kernel was called."""
    calls, carry = [], Engine._carry

    def counting(self, *arguments):
        calls.append(carry(self, *arguments))
        return calls[-1]

    monkeypatch.setattr(Engine, "_carry", counting)
    return calls


@pytest.mark.parametrize("case", CASES)
def test_slices_say_the_same_bit_for_bit(case, carried):
    label, options, record, dt, how = CASES[case]
    whole = engine(label, options).run(record, dt, slice_of_work=np.inf, **how)
    assert whole.n_impacts > 0 or "fixed" in label
    assert whole.overturned == (case == "overturns")
    assert whole.settled == case.startswith("settles")
    in_one = len(carried)
    for slice_of_work in (1e-5, 1e-6):
        carried.clear()
        run = engine(label, options).run(record, dt, slice_of_work=slice_of_work, **how)
        assert len(carried) > in_one + 4
        for name in ("overturned", "settled", "end_time", "n_uplifts", "n_impacts"):
            assert getattr(run, name) == getattr(whole, name), name
        for name in ("peaks", "peak_times", "lost_support", "time_of_lost_support"):
            assert np.array_equal(getattr(run, name), getattr(whole, name)), name
        if how.get("history"):
            assert np.array_equal(run.states, whole.states)


@pytest.mark.parametrize("label", ["MDOF-S", "2DOF-C"])
def test_a_run_stops_where_it_is_asked_to(label, carried):
    mine, looks = engine(label, {}), count(1)
    with stopping_when(lambda: next(looks) == 5), pytest.raises(RunStoppedError, match="stopped before its end"):
        mine.run(RECORD, 0.02, slice_of_work=1e-5)
    assert len(carried) == 5
    assert next(looks) == 6
    with stopping_when(lambda: next(looks) < 0):
        run = mine.run(RECORD, 0.02, slice_of_work=1e-5)
    assert next(looks) > 20
    assert np.array_equal(mine.run(RECORD, 0.02).peaks, run.peaks)  # nobody asks any more, and nothing is left behind


def test_who_asks_within_has_the_word():
    mine = engine("MDOF-S", {})
    with stopping_when(lambda: True):
        with stopping_when(lambda: False):
            mine.run(RECORD, 0.02, slice_of_work=1e-5)
        with pytest.raises(RunStoppedError):
            mine.run(RECORD, 0.02, slice_of_work=1e-5)


@pytest.mark.parametrize("case", ["MDOF-S", "rigid", "2DOF-C", "on a grid"])
def test_runs_on_one_engine_do_not_meddle_with_each_other(case, monkeypatch):
    """As threads have it: while one run pauses, another one meets phases whose series are longer."""
    label, options, record, dt, wanted = CASES[case]
    options, wanted = dict(options), dict(wanted)
    alone = engine(label, options).run(record, dt, **wanted)
    shared, rounds, needed = engine(label, options), count(), []
    carry = Engine._carry

    def watched(self, system, steps, course, at, log, motion, batch):
        # The phases that this run can come to, as far as its tables know, fit the room that it has.
        reached = {int(p) for p in np.unique(system.links[:, FOLLOWS:]) if p >= 0} or {0}
        needed.append(max(int(system.phases["terms"][p]) for p in reached) <= motion.series.shape[0])
        return carry(self, system, steps, course, at, log, motion, batch)

    monkeypatch.setattr(Engine, "_carry", watched)

    def meanwhile():
        before, _ = shared._phases._systems[dt, False]
        links = before.links.copy()
        if next(rounds) < 3:
            with stopping_when(lambda: False):
                shared.run(-record, dt)
        assert np.array_equal(before.links, links)
        return False

    with stopping_when(meanwhile):
        found = shared.run(record, dt, slice_of_work=1e-5, **wanted)
    assert next(rounds) > 3
    assert all(needed)
    assert found.peaks.tobytes() == alone.peaks.tobytes()
    assert (found.n_uplifts, found.n_impacts) == (alone.n_uplifts, alone.n_impacts)
