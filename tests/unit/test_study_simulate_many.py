"""The cross product of structures, motions, scales and models; its failures; and threads."""

import itertools
import threading
import tracemalloc

import numpy as np
import pandas as pd
import pytest

import rockflex as rf
from builders import frame_values, make_frame
from rockflex.engine.solution import Status
from rockflex.engine.solvers import SolverPool
from rockflex.models import _prepared_model
from rockflex.response._response import PEAKS

RECORD = rf.load_suite("el-centro-1940")[0].acceleration


def frame(**changes):
    given = frame_values(n_stories=3, base_mass=60e3, period=0.5, aspect_ratio=8.0, damping_ratio=0.03)
    return rf.Frame(**{**given, **changes})


STRUCTURES = [frame(), frame(n_stories=2, stiffness_ratio=0.0).rocking(), frame(period=0.3).lumped]
MOTIONS = [
    rf.GroundMotion(2.0 * RECORD[:300], 0.02, name="first"),
    rf.GroundMotion(1.5 * RECORD[100:350], 0.01, name="second"),
]
MODELS = ["MDOF-S", "2DOF-S", rf.Model(1, lifts=False)]
SCALES = (1.0, -0.7, 3.0, 0.0)
VALUES = [name for name in PEAKS if name not in ("model", "motion", "status")]


def assert_row(row, response):
    assert pd.isna(row["error"])
    for name in (*VALUES, "status"):
        assert row[name] == getattr(response, name), name


def test_rows_are_the_cross_product_in_order():
    table = rf.simulate_many(STRUCTURES, MOTIONS, MODELS, scales=SCALES, free_vibration=0.5)
    runs = list(itertools.product(range(3), MOTIONS, MODELS, SCALES))
    assert len(table) == len(runs) == 72
    assert list(table.columns) == ["structure", "motion", "scale", "model", "status", "error", *VALUES]
    for (index, motion, model, scale), (_, row) in zip(runs, table.iterrows(), strict=True):
        response = rf.simulate(STRUCTURES[index], motion.scaled(scale), model, output="peaks", free_vibration=0.5)
        assert (row["structure"], row["motion"], row["scale"]) == (index, motion.name, scale)
        assert row["model"] == response.model
        assert_row(row, response)
    assert set(table["status"]) >= {"no_uplift", "rocking"}


def test_columns_have_types():
    table = rf.simulate_many(STRUCTURES[0], MOTIONS)
    nullable = dict.fromkeys(("n_uplifts", "n_impacts"), "Int64")
    nullable |= dict.fromkeys(
        ("nominal_overturning", "may_fall", "settled", "tendon_yield", "tendon_overload"), "boolean"
    )
    for name in VALUES:
        assert table[name].dtype == nullable.get(name, "float64"), name
    assert list(table["status"].cat.categories) == ["no_uplift", "rocking", "overturned"]
    assert table["error"].dtype == "string"


def test_one_of_each_stands_for_a_list():
    single = rf.simulate_many(STRUCTURES[1], MOTIONS[0], "2DOF-S")
    assert len(single) == 1
    assert_row(single.iloc[0], rf.simulate(STRUCTURES[1], MOTIONS[0], "2DOF-S", output="peaks"))
    pd.testing.assert_frame_equal(single, rf.simulate_many((STRUCTURES[1],), (MOTIONS[0],), (rf.Model(1),)))
    assert rf.simulate_many(STRUCTURES[0], MOTIONS[0])["model"].tolist() == ["MDOF-S"]


def test_any_iterable_does():
    expected = rf.simulate_many(STRUCTURES, MOTIONS, ["2DOF-S"], scales=[1.0, 2.0])
    pd.testing.assert_frame_equal(
        rf.simulate_many(iter(STRUCTURES), iter(MOTIONS), iter(["2DOF-S"]), scales=np.array([1.0, 2.0])), expected
    )


def test_a_suite_is_a_sequence_of_motions():
    suite = rf.Suite(MOTIONS, "two")
    pd.testing.assert_frame_equal(rf.simulate_many(STRUCTURES[0], suite), rf.simulate_many(STRUCTURES[0], MOTIONS))
    assert rf.simulate_many(STRUCTURES[0], suite[1:])["motion"].tolist() == ["second"]


def test_scales_are_factors_on_the_acceleration():
    table = rf.simulate_many(STRUCTURES[0], MOTIONS[0], "fixed", scales=(1.0, 2.0, -1.0))
    peaks = table["max_top_displacement"]
    assert peaks[1] == pytest.approx(2.0 * peaks[0], rel=1e-12)
    assert peaks[2] == peaks[0]
    for one in (2.0, 2, np.float32(2.0)):
        single = rf.simulate_many(STRUCTURES[0], MOTIONS[0], "fixed", scales=one)
        pd.testing.assert_frame_equal(single, rf.simulate_many(STRUCTURES[0], MOTIONS[0], "fixed", scales=(2.0,)))
    assert rf.simulate_many(STRUCTURES[0], MOTIONS[0], scales=(5.0, 30.0))["status"].tolist()[1] == "overturned"


def test_names_that_occur_twice_stay_apart_as_rows():
    twice = [MOTIONS[0], rf.GroundMotion(0.1 * RECORD[:300], 0.02, name="first"), MOTIONS[1]]
    table = rf.simulate_many(STRUCTURES[0], twice, ["MDOF-S", "4DOF-S", "MDOF-S"])
    assert table["motion"].tolist() == ["first"] * 6 + ["second"] * 3
    assert table["model"].tolist() == ["MDOF-S", "4DOF-S", "MDOF-S"] * 3
    assert list(table["motion"].cat.categories) == ["first", "second"]
    assert table["max_rotation"][0] == table["max_rotation"][2]
    assert table["max_top_displacement"][3] < 0.5 * table["max_top_displacement"][0]
    same = rf.simulate_many([STRUCTURES[0]] * 2, MOTIONS[0])
    assert same["structure"].tolist() == [0, 1]
    assert same["max_rotation"][0] == same["max_rotation"][1]


@pytest.mark.slow
@pytest.mark.parametrize("output", ["peaks", "history"])
def test_threads_change_nothing(output):
    """Runs enough for several tasks; every bit is that of one thread."""
    scales = np.linspace(0.2, 4.0, 40)
    serial = rf.simulate_many(STRUCTURES, MOTIONS, MODELS[:2], output, scales, workers=1)
    for workers in (2, 5, None):
        table = rf.simulate_many(STRUCTURES, MOTIONS, MODELS[:2], output, scales, workers=workers)
        if output == "history":
            for one, other in zip(table.pop("response"), serial["response"], strict=True):
                assert np.array_equal(one.history.states, other.history.states)
            pd.testing.assert_frame_equal(table, serial.drop(columns="response"), check_exact=True)
        else:
            pd.testing.assert_frame_equal(table, serial, check_exact=True)


def test_work_is_done_by_the_threads_asked_for(monkeypatch):
    seen, real = set(), SolverPool.acquire

    def acquire(pool, dt):
        seen.add(threading.current_thread())
        return real(pool, dt)

    monkeypatch.setattr(SolverPool, "acquire", acquire)
    rf.simulate_many(STRUCTURES, MOTIONS, workers=1)
    assert seen == {threading.current_thread()}
    rf.simulate_many(STRUCTURES, MOTIONS, workers=3)
    assert len(seen) > 1


def test_histories_on_request():
    table = rf.simulate_many(STRUCTURES[0], MOTIONS, ["MDOF-S", "fixed"], output="history")
    for _, row in table.iterrows():
        response = row["response"]
        assert isinstance(response, rf.Response)
        motion = MOTIONS[0] if row["motion"] == "first" else MOTIONS[1]
        alone = rf.simulate(STRUCTURES[0], motion, row["model"])
        assert np.array_equal(response.history.states, alone.history.states)
        assert response.motion == row["motion"]
        assert_row(row, response)
        assert response.floors is not None


def test_options_reach_every_run():
    start = rf.InitialState(rotation=0.05)
    table = rf.simulate_many(
        STRUCTURES[:2], rf.quiet_motion(0.5), ["MDOF-S", "2DOF-S"], free_vibration="settle", initial=start
    )
    assert table["settled"].all()
    expected = rf.simulate(STRUCTURES[1], rf.quiet_motion(0.5), "2DOF-S", free_vibration="settle", initial=start)
    assert_row(table.iloc[3], rf.simulate(
        STRUCTURES[1], rf.quiet_motion(0.5), "2DOF-S", output="peaks", free_vibration="settle", initial=start
    ))  # fmt: skip
    assert table["n_impacts"][3] == expected.n_impacts > 0


@pytest.mark.slow
def test_memory_grows_with_the_table_alone():
    """Twenty times the runs, and what is held at once grows by the bytes of their rows only."""
    motion = rf.GroundMotion(np.tile(RECORD, 4), 0.02, name="long")
    rf.simulate_many(STRUCTURES[0], motion)

    def most(runs):
        scales = np.full(runs, 0.5)
        tracemalloc.start()
        try:
            table = rf.simulate_many(STRUCTURES[0], motion, scales=scales, workers=2)
            return tracemalloc.get_traced_memory()[1], table
        finally:
            tracemalloc.stop()

    few, table = most(20)
    many, _ = most(400)
    row = table.memory_usage(index=False, deep=True).sum() / 20.0
    # One history of this record is 100 times as large as what a run may add.
    assert (many - few) / 380.0 < 10.0 * row < motion.acceleration.nbytes


def test_a_hysteresis_is_that_of_the_models_that_end_in_bw_or_else_of_all() -> None:
    structure = frame()
    yielding = rf.BoucWen(0.03)
    motion = rf.load_suite("el-centro-1940")[0]
    mixed = ["MDOF-S", "2DOF-S", "2DOF-S-BW"]
    expected = [rf.simulate(structure, motion, label).max_rotation for label in mixed[:2]]
    expected.append(rf.simulate(structure, motion, "2DOF-S", bouc_wen=yielding).max_rotation)
    for run in (rf.simulate_many, rf.run_cloud):
        table = run(structure, motion, mixed, bouc_wen=yielding)
        assert table["max_rotation"].tolist() == expected
        table = run(structure, motion, mixed[:2], bouc_wen=yielding)
        assert table["max_rotation"][1] == expected[2]
        assert "bouc_wen applies to models with one mode, but MDOF-S has 3" in table["error"][0]


@pytest.mark.parametrize("workers", [1, 3])
@pytest.mark.parametrize("output", ["peaks", "history"])
def test_runs_that_fail_become_rows(monkeypatch, workers, output):
    """Models with more modes than a structure has; runs that the solver gives up."""
    real = _prepared_model._ends_of

    def ends_of(batch, states, dt, *others, **options):
        found = real(batch, states, dt, *others, **options)
        if dt == MOTIONS[1].dt:
            found.status[:], found.samples[:] = Status.CHATTER, 0
        return found

    monkeypatch.setattr(_prepared_model, "_ends_of", ends_of)
    table = rf.simulate_many(STRUCTURES, MOTIONS, ["2DOF-S", "4DOF-S"], output, workers=workers)
    for name in ("n_uplifts", "n_impacts"):
        assert table[name].dtype == "Int64"
    for name in ("nominal_overturning", "settled"):
        assert table[name].dtype == "boolean"
    for (index, motion, model), (_, row) in zip(
        itertools.product(range(3), ["first", "second"], ["2DOF-S", "4DOF-S"]), table.iterrows(), strict=True
    ):
        assert (row["structure"], row["motion"], row["model"]) == (index, motion, model)
        if index == 1 and model == "4DOF-S":
            text = "Model 4DOF-S needs 3 modes, but the structure has 2."
        elif motion == "second":
            text = f"The events of {model}, such as impacts, accumulate without end in the sample before 0.01 s."
        else:
            assert row["status"] == "rocking"
            assert pd.isna(row["error"])
            continue
        assert row["error"].startswith(text)
        assert pd.isna(row["status"])
        for name in VALUES:
            assert pd.isna(row[name]), name
        if output == "history":
            assert row["response"] is None


def test_a_start_that_a_model_cannot_have_is_a_row():
    table = rf.simulate_many(STRUCTURES[0], MOTIONS[0], ["2DOF-S", "fixed"], initial=rf.InitialState(rotation=0.01))
    assert pd.isna(table["error"][0])
    assert table["error"][1].startswith("fixed has a base that cannot lift, but rotation=0.01")


def test_one_start_for_models_of_several_lengths():
    """A start of more modes than a model has makes a row with an error; the others run."""
    start = rf.InitialState(modal_displacement=[1e-3, 1e-4])
    table = rf.simulate_many(STRUCTURES[0], MOTIONS[0], ["2DOF-S", "3DOF-S", "MDOF-S"], initial=start)
    assert table["error"].isna().tolist() == [False, True, True]
    assert table["error"][0] == "modal_displacement has 2 values, but 2DOF-S has 1 mode. Give at most 1."
    assert table["n_impacts"].isna().tolist() == [True, False, False]
    alone = rf.simulate(STRUCTURES[0], MOTIONS[0], "3DOF-S", initial=start)
    assert table["max_rotation"][1] == pytest.approx(alone.max_rotation, rel=1e-12)


STRUCTURE = "a structure such as a Frame, or RockingProperties"
LABEL = 'a label such as "2DOF-S", or a Model'


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({"models": []}, "models is empty. Give at least one."),
        ({"structures": 3}, f"structures must be {STRUCTURE}, or a sequence of them, but int was given."),
        (
            {"structures": rf.Frame},
            f"structures must be {STRUCTURE}, or a sequence of them, but the class Frame was given.",
        ),
        ({"motions": np.array(1.0)}, "motions must be a GroundMotion, or a sequence of them, but ndarray was given."),
        ({"structures": [frame(), 3]}, f"structures[1] is int. Expected {STRUCTURE}."),
        ({"structures": [rf.Frame]}, f"structures[0] is the class Frame. Expected {STRUCTURE}."),
        ({"motions": [MOTIONS[0], RECORD]}, "motions[1] is ndarray. Expected a GroundMotion."),
        ({"models": ["2DOF-S", 2]}, f"models[1] is int. Expected {LABEL}."),
        ({"initial": 0.1}, "initial must be an InitialState or None, but 0.1 was given. Write"),
        ({"free_vibration": -1}, 'free_vibration must be zero or more seconds (at most 1e+09), or "settle", but -1'),
        ({"workers": 0}, "workers must be a whole number of at least 1, but 0 was given."),
        ({"workers": True}, "workers must be a whole number of at least 1, but True was given."),
        ({"output": "all"}, 'output must be "history" or "peaks", but \'all\' was given.'),
        (
            {"scales": [1.0, -1e308]},
            "scales must keep the accelerations finite, but the factor -1e+308 was given for 'first' with "
            f"{MOTIONS[0].pga:.3g} m/s². Give a smaller factor.",
        ),
    ],
)
def test_arguments_that_cannot_be_used(changes, text):
    with pytest.raises(rf.InputError) as caught:
        rf.simulate_many(**{"structures": STRUCTURES, "motions": MOTIONS, **changes})
    assert str(caught.value).startswith(text)


@pytest.mark.parametrize(
    "scales", [[], [1.0, np.nan], [np.inf], np.nan, "a", "12", ["a"], ["1.0"], [True], None, [[1.0]], [10**400]]
)
def test_scales_that_are_none(scales):
    with pytest.raises(rf.InputError) as caught:
        rf.simulate_many(STRUCTURES, MOTIONS, scales=scales)
    given = repr(scales).replace(str(10**400), "an integer of about 400 digits")
    assert str(caught.value) == f"scales must be one or more finite factors, but {given} was given."


FRAME = frame_values(n_stories=3, stiffness_ratio=0.0, period=0.6, aspect_ratio=8.0)
RECORDS = {"suites": ["fema-p695-far-field"], "include": ["FF-1-*", "FF-2-*"]}
COMMON = {"structures": [{"name": "A", "frame": FRAME}], "records": RECORDS}
CLOUD = rf.CloudStudy(
    **COMMON,
    models=["2DOF-S", "2DOF-C", "5DOF-S"],  # the last has more modes than the structure: rows with errors
    scales=[0.5, 1.5],
    runs_per_chunk=5,
)
STUDIES = {
    "cloud": CLOUD,
    "friction": CLOUD.model_copy(update={"friction": True}),
    "incremental": rf.IncrementalStudy(**COMMON, models=["2DOF-S"], growth=1.6, tolerance=0.1, runs_per_chunk=40),
    "population": rf.PopulationStudy(pairs=8, seed=3, records=RECORDS, runs_per_chunk=4),
    "random": rf.MonteCarloStudy(
        variables={"period": {"uniform": [0.4, 1.2]}},
        structure={"frame": FRAME | {"period": "= period"}},
        count=8,
        records=RECORDS,
        models=["2DOF-S"],
        runs_per_chunk=8,
    ),
    "ground": rf.CloudStudy(**COMMON, models=["2DOF-S"], runs_per_chunk=1, ground={"friction": 0.3}),
}


def contents(folder):
    return {path.name: path.read_bytes() for path in (folder / "parts").iterdir()}


@pytest.mark.slow
@pytest.mark.parametrize("name", STUDIES)
def test_the_same_parts_whatever_the_number_of_workers(name, tmp_path):
    study = STUDIES[name]
    alone = rf.run_study(study, tmp_path / "alone", workers=1)
    for workers in (2, 3):
        together = rf.run_study(study, tmp_path / str(workers), workers=workers)
        assert contents(tmp_path / str(workers)) == contents(tmp_path / "alone")
        pd.testing.assert_frame_equal(together, alone)
    pd.testing.assert_frame_equal(rf.run_study(study, workers=2), alone)


def test_a_search_gives_the_same_designs():
    held = rf.Restrained(rf.Frame(**FRAME), rf.Tendon(initial_force=300e3, stiffness=2e6))
    pulses = {f"{period} s": rf.ricker_pulse(3.0, period) for period in (0.5, 0.6, 0.7, 0.8, 0.9)}
    search = rf.DesignSearch([1.0, 2.0, 3.0], tendon_factors=[0.0, 1.0, 2.0], refinements=1)
    targets, cost = [rf.Requirement(0.01, 0.2, at=0.5)], rf.DesignCost(half_width=1.0, prestress=5e-7)
    given, scales = (held, pulses, search, targets, cost), [0.5, 1.0, 2.0, 4.0]
    alone = rf.search_design(*given, model="2DOF-S", scales=scales, workers=1)
    pd.testing.assert_frame_equal(rf.search_design(*given, model="2DOF-S", scales=scales, workers=2), alone)


def test_work_limits_count():
    limited = CLOUD.model_copy(update={"work_limit": 1e-9})
    alone = rf.run_study(limited, workers=1)
    pd.testing.assert_frame_equal(rf.run_study(limited, workers=2), alone)
    assert alone["error"].str.contains("work_limit is 1e-09 s").sum() == 16
    with pytest.raises(rf.InputError, match="work_limit is 1e-09 s"):
        rf.run_study(limited.model_copy(update={"models": ["2DOF-S"]}), workers=2)


@pytest.mark.slow
@pytest.mark.parametrize("stop", [KeyboardInterrupt, OSError])
def test_a_study_that_is_stopped_leaves_its_parts_and_no_thread(stop, tmp_path):
    def progress(now):
        if now.done == 2:
            raise stop

    before = threading.active_count()
    with pytest.raises(stop):
        rf.run_study(CLOUD, tmp_path, workers=2, progress=progress)
    assert threading.active_count() == before
    assert len(rf.StudyFolder.load(tmp_path).missing()) == 3
    pd.testing.assert_frame_equal(rf.run_study(CLOUD, tmp_path, workers=2), rf.run_study(CLOUD, workers=1))


def test_records_of_a_selection_are_the_scaled_ones():
    chosen = rf.load_suite("fema-p695-far-field").select(rf.ec8_spectrum(2.5, ground="C"), 3, (0.2, 2.0))
    table = rf.simulate_many(make_frame(), chosen, "2DOF-S")
    again = rf.simulate_many(make_frame(), chosen.suite, "2DOF-S")
    assert list(table["motion"]) == [name for (name,) in chosen.names]
    assert list(table["max_rotation"]) == list(again["max_rotation"])
    cloud = rf.run_cloud(make_frame(), chosen, "2DOF-S", scales=(1.0,))
    assert sorted(cloud["motion"]) == sorted(table["motion"])
