import itertools
import threading
import tracemalloc

import numpy as np
import pandas as pd
import pytest

from rockflex import (
    Frame,
    GroundMotion,
    InitialState,
    InputError,
    Model,
    Response,
    Suite,
    load_suite,
    quiet_motion,
    simulate,
    simulate_many,
)
from rockflex.response import PEAKS
from rockflex.solve.exact import engine
from rockflex.solve.exact.unit import CHATTER

RECORD = load_suite("el-centro-1940")[0].acceleration


def frame(**changes):
    given = {
        "n_stories": 3,
        "story_height": 3.0,
        "story_mass": 40e3,
        "base_mass": 60e3,
        "stiffness_ratio": np.inf,
        "period": 0.5,
        "aspect_ratio": 8.0,
        "damping_ratio": 0.03,
    }
    return Frame(**{**given, **changes})


STRUCTURES = [frame(), frame(n_stories=2, stiffness_ratio=0.0).rocking(), frame(period=0.3).lumped]
MOTIONS = [
    GroundMotion(2.0 * RECORD[:300], 0.02, name="first"),
    GroundMotion(1.5 * RECORD[100:350], 0.01, name="second"),
]
MODELS = ["MDOF-S", "2DOF-S", Model(1, lifts=False)]
SCALES = (1.0, -0.7, 3.0, 0.0)
VALUES = [name for name in PEAKS if name not in ("model", "motion", "status")]


def assert_row(row, response):
    assert pd.isna(row["error"])
    for name in (*VALUES, "status"):
        assert row[name] == getattr(response, name), name


def test_rows_are_the_cross_product_in_order():
    table = simulate_many(STRUCTURES, MOTIONS, MODELS, scales=SCALES, free_vibration=0.5)
    runs = list(itertools.product(range(3), MOTIONS, MODELS, SCALES))
    assert len(table) == len(runs) == 72
    assert list(table.columns) == ["structure", "motion", "scale", "model", "status", "error", *VALUES]
    for (index, motion, model, scale), (_, row) in zip(runs, table.iterrows(), strict=True):
        response = simulate(STRUCTURES[index], motion.scaled(scale), model, output="peaks", free_vibration=0.5)
        assert (row["structure"], row["motion"], row["scale"]) == (index, motion.name, scale)
        assert row["model"] == response.model
        assert_row(row, response)
    assert set(table["status"]) >= {"no_uplift", "rocking"}


def test_columns_have_types():
    table = simulate_many(STRUCTURES[0], MOTIONS)
    for name in VALUES:
        kind = {"n": "i", "s": "b"}.get(name[0], "f") if name != "nominal_overturning" else "b"
        assert table[name].dtype.kind == kind, name
    assert list(table["status"].cat.categories) == ["no_uplift", "rocking", "overturned"]
    assert table["error"].dtype == "string"


def test_one_of_each_stands_for_a_list():
    single = simulate_many(STRUCTURES[1], MOTIONS[0], "2DOF-S")
    assert len(single) == 1
    assert_row(single.iloc[0], simulate(STRUCTURES[1], MOTIONS[0], "2DOF-S", output="peaks"))
    pd.testing.assert_frame_equal(single, simulate_many((STRUCTURES[1],), (MOTIONS[0],), (Model(1),)))
    assert simulate_many(STRUCTURES[0], MOTIONS[0])["model"].tolist() == ["MDOF-S"]


def test_any_iterable_does():
    expected = simulate_many(STRUCTURES, MOTIONS, ["2DOF-S"], scales=[1.0, 2.0])
    pd.testing.assert_frame_equal(
        simulate_many(iter(STRUCTURES), iter(MOTIONS), iter(["2DOF-S"]), scales=np.array([1.0, 2.0])), expected
    )


def test_a_suite_is_a_sequence_of_motions():
    suite = Suite(MOTIONS, "two")
    pd.testing.assert_frame_equal(simulate_many(STRUCTURES[0], suite), simulate_many(STRUCTURES[0], MOTIONS))
    assert simulate_many(STRUCTURES[0], suite[1:])["motion"].tolist() == ["second"]


def test_scales_are_factors_on_the_acceleration():
    table = simulate_many(STRUCTURES[0], MOTIONS[0], "fixed", scales=(1.0, 2.0, -1.0))
    peaks = table["max_top_displacement"]
    assert peaks[1] == pytest.approx(2.0 * peaks[0], rel=1e-12)
    assert peaks[2] == peaks[0]
    assert simulate_many(STRUCTURES[0], MOTIONS[0], scales=(5.0, 30.0))["status"].tolist()[1] == "overturned"


def test_names_that_occur_twice_stay_apart_as_rows():
    twice = [MOTIONS[0], GroundMotion(0.1 * RECORD[:300], 0.02, name="first"), MOTIONS[1]]
    table = simulate_many(STRUCTURES[0], twice, ["MDOF-S", "4DOF-S", "MDOF-S"])
    assert table["motion"].tolist() == ["first"] * 6 + ["second"] * 3
    assert table["model"].tolist() == ["MDOF-S", "4DOF-S", "MDOF-S"] * 3
    assert list(table["motion"].cat.categories) == ["first", "second"]
    assert table["max_rotation"][0] == table["max_rotation"][2]
    assert table["max_top_displacement"][3] < 0.5 * table["max_top_displacement"][0]
    same = simulate_many([STRUCTURES[0]] * 2, MOTIONS[0])
    assert same["structure"].tolist() == [0, 1]
    assert same["max_rotation"][0] == same["max_rotation"][1]


@pytest.mark.parametrize("output", ["peaks", "history"])
def test_threads_change_nothing(output):
    """Runs enough for several tasks; every bit is that of one thread."""
    scales = np.linspace(0.2, 4.0, 40)
    serial = simulate_many(STRUCTURES, MOTIONS, MODELS[:2], output, scales, workers=1)
    for workers in (2, 5, None):
        table = simulate_many(STRUCTURES, MOTIONS, MODELS[:2], output, scales, workers=workers)
        if output == "history":
            for one, other in zip(table.pop("response"), serial["response"], strict=True):
                assert np.array_equal(one.history.nodes, other.history.nodes)
            pd.testing.assert_frame_equal(table, serial.drop(columns="response"), check_exact=True)
        else:
            pd.testing.assert_frame_equal(table, serial, check_exact=True)


def test_work_is_done_by_the_threads_asked_for(monkeypatch):
    seen, real = set(), engine.run

    def run(*arguments):
        seen.add(threading.current_thread())
        return real(*arguments)

    monkeypatch.setattr(engine, "run", run)
    simulate_many(STRUCTURES, MOTIONS, workers=1)
    assert seen == {threading.current_thread()}
    simulate_many(STRUCTURES, MOTIONS, workers=3)
    assert len(seen) > 1


def test_histories_on_request():
    table = simulate_many(STRUCTURES[0], MOTIONS, ["MDOF-S", "fixed"], output="history")
    for _, row in table.iterrows():
        response = row["response"]
        assert isinstance(response, Response)
        motion = MOTIONS[0] if row["motion"] == "first" else MOTIONS[1]
        alone = simulate(STRUCTURES[0], motion, row["model"])
        assert np.array_equal(response.history.nodes, alone.history.nodes)
        assert response.motion == row["motion"]
        assert_row(row, response)
        assert response.floors is not None


def test_options_reach_every_run():
    start = InitialState(rotation=0.05)
    table = simulate_many(
        STRUCTURES[:2], quiet_motion(0.5), ["MDOF-S", "2DOF-S"], free_vibration="settle", initial=start
    )
    assert table["settled"].all()
    expected = simulate(STRUCTURES[1], quiet_motion(0.5), "2DOF-S", free_vibration="settle", initial=start)
    assert_row(table.iloc[3], simulate(
        STRUCTURES[1], quiet_motion(0.5), "2DOF-S", output="peaks", free_vibration="settle", initial=start
    ))  # fmt: skip
    assert table["n_impacts"][3] == expected.n_impacts > 0


@pytest.mark.parametrize("workers", [1, 3])
@pytest.mark.parametrize("output", ["peaks", "history"])
def test_runs_that_fail_become_rows(monkeypatch, workers, output):
    """Models with more modes than a structure has; runs that the solver gives up."""
    real = engine.run

    def run(system, record, quiet, dt, *others):
        if dt == 0.01:  # of the second motion
            return CHATTER, 1, 0
        return real(system, record, quiet, dt, *others)

    monkeypatch.setattr(engine, "run", run)
    table = simulate_many(STRUCTURES, MOTIONS, ["2DOF-S", "4DOF-S"], output, workers=workers)
    for (index, motion, model), (_, row) in zip(
        itertools.product(range(3), ["first", "second"], ["2DOF-S", "4DOF-S"]), table.iterrows(), strict=True
    ):
        assert (row["structure"], row["motion"], row["model"]) == (index, motion, model)
        if index == 1 and model == "4DOF-S":
            text = "Model 4DOF-S needs 3 modes, but the structure has 2."
        elif motion == "second":
            text = f"The impacts of {model} accumulate without end in the sample before 0.01 s."
        else:
            assert row["status"] == "rocking"
            assert pd.isna(row["error"])
            continue
        assert row["error"].startswith(text)
        assert pd.isna(row["status"])
        assert all(pd.isna(row[name]) for name in VALUES if isinstance(row[name], float))
        assert row["n_impacts"] == 0
        if output == "history":
            assert row["response"] is None


def test_a_start_that_a_model_cannot_have_is_a_row():
    table = simulate_many(STRUCTURES[0], MOTIONS[0], ["2DOF-S", "fixed"], initial=InitialState(rotation=0.01))
    assert pd.isna(table["error"][0])
    assert table["error"][1].startswith("fixed has a base that cannot lift, but rotation=0.01")


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({"structures": []}, "structures is empty. Give at least one."),
        ({"motions": []}, "motions is empty. Give at least one."),
        ({"models": []}, "models is empty. Give at least one."),
        ({"scales": []}, r"scales must be one or more finite factors, but \[\] was given"),
        ({"scales": [1.0, np.nan]}, r"scales must be one or more finite factors, but \[1.0, nan\] was given"),
        ({"scales": [np.inf]}, "scales must be one or more finite factors"),
        ({"structures": [frame(), 3]}, r"structures\[1\] is a int. Expected a Frame, a LumpedStructure or Rocking"),
        ({"motions": [MOTIONS[0], RECORD]}, r"motions\[1\] is a ndarray. Expected a GroundMotion"),
        ({"models": ["2DOF-S", 2]}, r"models\[1\] is a int. Expected a label such as \"2DOF-S\", or a Model"),
        ({"models": ["2DOF-S", "2DOF-Q"]}, "Unknown model '2DOF-Q'"),
        ({"output": "all"}, 'output must be "history" or "peaks", but \'all\' was given'),
        ({"free_vibration": -1}, "free_vibration must be zero or more seconds"),
        ({"workers": 0}, "workers must be a positive whole number, but 0 was given"),
    ],
)
def test_arguments_that_cannot_be_used(changes, text):
    with pytest.raises(InputError, match=text):
        simulate_many(**{"structures": STRUCTURES, "motions": MOTIONS, **changes})


def test_memory_grows_with_the_table_alone():
    """Twenty times the runs, and what is held at once grows by the bytes of their rows only."""
    motion = GroundMotion(np.tile(RECORD, 4), 0.02, name="long")
    simulate_many(STRUCTURES[0], motion)

    def most(runs):
        scales = np.full(runs, 0.5)
        tracemalloc.start()
        try:
            table = simulate_many(STRUCTURES[0], motion, scales=scales, workers=2)
            return tracemalloc.get_traced_memory()[1], table
        finally:
            tracemalloc.stop()

    few, table = most(20)
    many, _ = most(400)
    row = table.memory_usage(index=False, deep=True).sum() / 20.0
    # One history of this record is 100 times as large as what a run may add.
    assert (many - few) / 380.0 < 10.0 * row < motion.acceleration.nbytes
