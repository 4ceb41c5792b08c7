"""The work of a run: estimated before it, bounded while it goes on, and lifted where it is asked for."""

import json
import math
import threading
from dataclasses import replace

import numpy as np
import pytest

import rockflex as rf
from builders import frame_values
from rockflex import InputError, SolverError
from rockflex.models import parse_model
from rockflex.models._work import CostModel, Task, WorkLimitError, cost_model_of
from rockflex.studies import PreparedCase
from rockflex.studies.running import WORK_LIMIT, checked_work_limit

EL_CENTRO = rf.load_suite("el-centro-1940")[0]
LIFT = 'Or raise work_limit, or lift it: work_limit=None ("none" in a file and on the command line).'


FRAME = frame_values()


def frame(**given):
    return rf.Frame(**(FRAME | given))


def task(label="MDOF-S", structure=None, motion=EL_CENTRO, free=0.0, bouc_wen=None, output="peaks"):
    model = parse_model(label).of((structure or frame()).rocking(), None, bouc_wen)
    whole = output == "history"
    return PreparedCase(model, free, history=whole, floors=whole).task(motion)


@pytest.mark.parametrize(
    ("structure", "motion", "options", "words"),
    [
        (
            {},
            EL_CENTRO.scaled(3e7),
            {"model": "1DOF-fixed", "bouc_wen": rf.BoucWen(0.04)},
            "(scale), or a larger yield_",
        ),
        ({}, rf.GroundMotion(np.zeros(9), 1e-7), {"free_vibration": 1e6}, "free_vibration = 1e+06 s is 1e+13 time"),
        ({"period": 1e-6}, EL_CENTRO, {}, "advances by 1.18e+06 rad in every time step of 0.02 s"),
        ({"period": 1e-6}, EL_CENTRO, {"model": "MDOF-C"}, "Give fewer modes, a longer period, or a wider base"),
        ({"period": 1e9}, EL_CENTRO, {"free_vibration": "settle"}, "with a slowest period of 1e+09 s, is 5e+10 time"),
        ({"aspect_ratio": 1e5}, EL_CENTRO, {}, "(half_width, or aspect_ratio): the narrower the base, the faster it"),
    ],
)
def test_what_would_take_minutes_is_refused_at_once_and_says_why(structure, motion, options, words) -> None:
    with pytest.raises(InputError) as caught:
        rf.simulate(frame(**structure), motion, output="peaks", **options)
    message = str(caught.value)
    assert "of computing, but work_limit is 30 s: " in message
    assert words in message
    assert message.endswith(LIFT)


def test_a_long_motion_is_named_where_it_is_what_takes_long() -> None:
    found = task(motion=rf.GroundMotion(np.zeros(200_000), 0.001))
    with pytest.raises(WorkLimitError, match=r"the motion has 200000 samples\. Give a shorter motion, or one"):
        found.check(0.001)


def test_a_run_is_stopped_when_its_work_is_done_and_says_how_far_it_came(monkeypatch) -> None:
    monkeypatch.setattr(Task, "check", lambda self, limit: None)  # as where the estimate is far too low
    for label, options in (("MDOF-S", {}), ("MDOF-C", {}), ("1DOF-fixed", {"bouc_wen": rf.BoucWen(0.04)})):
        with pytest.raises(SolverError) as caught:
            rf.simulate(frame(), EL_CENTRO, label, work_limit=1e-5, **options)
        said = str(caught.value)
        assert f"{label}{'-BW' if options else ''} was stopped at" in said
        assert "of a run to 31.2 s: work_limit = 1e-05 s of computing is used up. The state there is D = [" in said
        assert "The reason: " in said
        assert said.endswith(LIFT)


def test_the_free_vibration_until_settled_is_stopped_too() -> None:
    with pytest.raises(SolverError, match=r"was stopped at [0-9.]+ s of a run until it settles: work_limit = 0\.003 s"):
        rf.simulate(frame(damping_ratio=0.0), EL_CENTRO, free_vibration="settle", output="peaks", work_limit=0.003)


@pytest.mark.parametrize("label", ["MDOF-S", "fixed", "MDOF-C", "2DOF-S-BW"])
@pytest.mark.parametrize("output", ["peaks", "history"])
def test_a_limit_changes_no_result(label, output) -> None:
    yielding = rf.BoucWen(0.04) if label.endswith("BW") else None
    with_limit = rf.simulate(frame(), EL_CENTRO, label, output, bouc_wen=yielding)
    without = rf.simulate(frame(), EL_CENTRO, label, output, bouc_wen=yielding, work_limit=None)
    assert with_limit.peaks() == without.peaks()


@pytest.mark.parametrize(
    ("label", "structure", "seconds", "step"),
    [
        ("MDOF-S", frame(n_stories=30, damping_ratio=0.0), 1800.0, 0.005),
        ("MDOF-C", frame(n_stories=20, period=3.0), 600.0, 0.005),
        ("MDOF-C", frame(n_stories=15, aspect_ratio=30.0), 300.0, 0.02),
        ("2DOF-S-BW", frame(period=0.2), 600.0, 0.005),
    ],
)
@pytest.mark.parametrize("output", ["peaks", "history"])
def test_long_records_are_far_from_the_limit(label, structure, seconds, step, output) -> None:
    noise = np.random.default_rng(1).standard_normal(int(seconds / step))
    yielding = rf.BoucWen(0.01) if label.endswith("BW") else None
    free = 60.0 if yielding else None
    assert task(label, structure, rf.GroundMotion(noise, step), free, yielding, output).work().total < 0.5 * WORK_LIMIT


@pytest.mark.parametrize(("label", "lifts"), [("MDOF-S", True), ("MDOF-C", True), ("fixed", False)])
def test_the_fastest_vibration_is_that_of_the_uplifted_structure(label, lifts) -> None:
    p = frame().rocking()
    expected = rf.uplifted_modes(p).omega[-1] if lifts else p.omega[-1]
    model = parse_model(label).of(p)
    assert 0.999999 * expected <= cost_model_of(model, 4).fastest <= 1.03 * expected  # a bound
    assert PreparedCase(model).engine.cost_model.fastest == cost_model_of(model, 4).fastest


def test_work_grows_with_what_it_is_said_to_grow_with() -> None:
    known = CostModel(modes=5, rows=4, fastest=1e3)
    usual = known.work(1000, 0.01, history=False).total
    assert known.work(2000, 0.01, history=False).total == pytest.approx(2.0 * usual, rel=0.01)  # but for the tables
    assert known.work(1000, 0.01, history=True).total > usual
    for more in ({"modes": 6}, {"rows": 5}, {"fastest": 2e3}, {"integrated": True}):
        assert replace(known, **more).work(1000, 0.01, history=False).total > usual
    yielding = replace(known, integrated=True, flow=1e4)
    assert yielding.work(1000, 0.01, 2.0, history=False).yielding == pytest.approx(
        2.0 * yielding.work(1000, 0.01, 1.0, history=False).yielding
    )
    many, more = (replace(known, modes=count) for count in (200, 400))  # series and tables are products of matrices
    for samples, power in ((10**6, 1.7), (0, 2.9)):
        assert more.work(samples, 0.01, history=False).total > 2**power * many.work(samples, 0.01, history=False).total
    assert many.work(0, 1e-3, history=False).total < 0.5 * many.work(0, 0.01, history=False).total  # no fast modes
    assert replace(known, fading=3e4).work(1, 1.0, history=False).total > known.work(1, 1.0, history=False).total
    assert replace(known, fastest=math.nan).work(1, 1.0, history=False).total == math.inf


@pytest.mark.parametrize("value", [0.0, -1.0, math.nan, "60", "never", True])
def test_a_limit_that_is_none_is_refused(value) -> None:
    with pytest.raises(InputError, match="work_limit must be a positive number of seconds of computing for one run"):
        rf.simulate(frame(), EL_CENTRO, work_limit=value)


def test_no_limit_has_three_names() -> None:
    assert checked_work_limit(None) is None
    assert checked_work_limit("none") is None
    assert checked_work_limit(math.inf) is None


def test_a_history_that_no_memory_holds_is_refused() -> None:
    words = (
        r"would have 1e\+09 states and take 128 GB, but the limit is 4 GB\. Use output=\"peaks\", less free_vibration"
    )
    with pytest.raises(InputError, match=words):
        rf.simulate(frame(), rf.GroundMotion(np.zeros(9), 0.01), free_vibration=1e7, work_limit=None)


def test_in_a_table_a_run_that_is_refused_is_a_row_and_all_of_them_an_error() -> None:
    both = [frame(), frame(period=1e-6)]
    table = rf.simulate_many(both, EL_CENTRO, "MDOF-S")
    assert list(table["error"].isna()) == [True, False]
    assert "work_limit is 30 s" in table["error"][1]
    with pytest.raises(InputError, match="work_limit is 30 s"):
        rf.simulate_many(both[1], EL_CENTRO, ["MDOF-S", "MDOF-C"])


@pytest.mark.parametrize("run", [rf.run_cloud, rf.run_incremental])
def test_in_a_study_too(run) -> None:
    options = {"largest_scale": 0.2, "growth": 2.0} if run is rf.run_incremental else {}
    table = run({"usual": frame(), "stiff": frame(period=9e-7)}, EL_CENTRO, "MDOF-S", **options)
    failed = table["error"].notna()
    assert set(table["structure"][failed]) == {"stiff"}
    assert set(table["structure"][~failed]) == {"usual"}
    stiff = table[failed]  # so that it moves with the ground
    np.testing.assert_allclose(stiff["sa_t1"], stiff["pga"], rtol=1e-12)
    with pytest.raises(InputError, match="work_limit is 30 s"):
        run(frame(period=9e-7), EL_CENTRO, "MDOF-S", **options)


def test_a_study_file_has_a_limit() -> None:
    content = {
        "structures": [{"frame": FRAME}],
        "records": {"suites": ["el-centro-1940"]},
    }
    study = rf.CloudStudy(**content)
    assert study.document()["work_limit"] == WORK_LIMIT
    assert study.plan().matrix.options.work_limit == WORK_LIMIT
    assert rf.CloudStudy(**content, work_limit="none").plan().matrix.options.work_limit is None
    with pytest.raises(InputError, match="work_limit is 1e-05 s"):
        rf.run_study(rf.CloudStudy(**content, work_limit=1e-5))
    with pytest.raises(InputError, match="work_limit must be a positive number of seconds"):
        rf.CloudStudy(**content, work_limit=-1.0)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: frame(n_stories=10**9), "n_stories must be a whole number from 1 to 1000, but 1000000000 was given"),
        (lambda: rf.TaperedTower(200, 8, 4, 1, 2400, 25e9, 0.02, n_modes=10**9), "n_modes must be a whole number"),
        (
            lambda: rf.Beam(
                height=9.0, mass=1.0, bending_stiffness=1.0, half_width=1.0, damping_ratio=0.02, n_modes=10**9
            ),
            "n_modes must be a whole number from 1 to 200",
        ),
        (
            lambda: rf.Beam(
                height=9.0, mass=1.0, bending_stiffness=1.0, half_width=1.0, damping_ratio=0.02, n_elements=10**9
            ),
            "n_elements must be a whole number from 1 to 10000",
        ),
        (lambda: rf.WallFrame(50.0, 1e6, 3.0, 1e4, 1.0, 5.0, 0.02, n_modes=10**9), "n_modes must be a whole number"),
        (lambda: rf.cosine_shapes(10.0, 10**9), "n_shapes must be a whole number from 1 to 200"),
        (lambda: rf.pinned_beam("shear", n_modes=10**9), "n_modes must be a whole number from 1 to 200"),
    ],
)
def test_sizes_that_no_memory_holds_are_refused_before_they_are_made(make, words) -> None:
    with pytest.raises(InputError, match=words):
        make()


def test_a_block_of_running_has_its_limit_and_its_threads():
    frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0, damping_ratio=0.02)
    pulse = rf.one_sine_pulse(amplitude=3.0, period=0.8)
    used = set[int]()

    def thread(_):
        used.add(threading.get_ident())
        return 0.0

    with rf.running(workers=1, work_limit=1e-9):
        for tried in (
            lambda: rf.simulate(frame, pulse),
            lambda: rf.simulate_many(frame, pulse),
            lambda: rf.simulate_set(frame, pulse),
            lambda: rf.compare([frame, frame], pulse),
            lambda: rf.run_cloud(frame, pulse),
            lambda: rf.modal_combination(frame, pulse),
            lambda: rf.overturning_scales(frame, pulse, [0.5, 1.0], "MDOF-S"),
        ):
            with pytest.raises((rf.InputError, rf.SolverError), match="work_limit"):
                tried()
        assert rf.simulate(frame, pulse, work_limit=5.0).status == "rocking"  # what a function is given comes first
        with rf.running(work_limit=None):
            rf.run_cloud(frame, pulse, scales=(0.5, 1.0), demands={"thread": thread})
        with rf.running(workers=3), pytest.raises(rf.InputError, match="work_limit"):
            rf.simulate(frame, pulse)
    assert used == {threading.get_ident()}  # one thread of the outer block: none was started
    assert rf.simulate(frame, pulse).status == "rocking"


def test_a_study_in_a_block_of_running_records_its_limit(tmp_path):
    frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0, damping_ratio=0.02)
    pulse = rf.one_sine_pulse(amplitude=3.0, period=0.8)
    with rf.running(work_limit=7.0):
        rf.run_cloud(frame, pulse, folder=tmp_path / "study")
    assert json.loads((tmp_path / "study" / "spec.json").read_text())["work_limit"] == 7.0


@pytest.mark.parametrize("given", [{"workers": 0}, {"workers": 1.5}, {"work_limit": -1.0}, {"work_limit": "much"}])
def test_running_refuses_what_it_cannot_use(given):
    with pytest.raises(rf.InputError) as error, rf.running(**given):
        pass
    assert error.value.field in given
