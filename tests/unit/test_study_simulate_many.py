import itertools
import threading
import tracemalloc

import numpy as np
import pandas as pd
import pytest

from builders import frame_values
from rockflex import (
    BoucWen,
    Frame,
    GroundMotion,
    InitialState,
    Model,
    Response,
    Suite,
    load_suite,
    quiet_motion,
    run_cloud,
    simulate,
    simulate_many,
)
from rockflex.response import PEAKS
from rockflex.solve import Engine

RECORD = load_suite("el-centro-1940")[0].acceleration


def frame(**changes):
    given = frame_values(n_stories=3, base_mass=60e3, period=0.5, aspect_ratio=8.0, damping_ratio=0.03)
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
    nullable = dict.fromkeys(("n_uplifts", "n_impacts"), "Int64")
    nullable |= dict.fromkeys(("nominal_overturning", "settled", "tendon_yield", "tendon_overload"), "boolean")
    for name in VALUES:
        assert table[name].dtype == nullable.get(name, "float64"), name
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
    for one in (2.0, 2, np.float32(2.0)):
        single = simulate_many(STRUCTURES[0], MOTIONS[0], "fixed", scales=one)
        pd.testing.assert_frame_equal(single, simulate_many(STRUCTURES[0], MOTIONS[0], "fixed", scales=(2.0,)))
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
                assert np.array_equal(one.history.states, other.history.states)
            pd.testing.assert_frame_equal(table, serial.drop(columns="response"), check_exact=True)
        else:
            pd.testing.assert_frame_equal(table, serial, check_exact=True)


def test_work_is_done_by_the_threads_asked_for(monkeypatch):
    seen, real = set(), Engine.run_all

    def run_all(*arguments, **options):
        seen.add(threading.current_thread())
        return real(*arguments, **options)

    monkeypatch.setattr(Engine, "run_all", run_all)
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
        assert np.array_equal(response.history.states, alone.history.states)
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


def test_a_hysteresis_is_that_of_the_models_that_end_in_bw_or_else_of_all() -> None:
    structure = frame()
    yielding = BoucWen(0.03)
    motion = load_suite("el-centro-1940")[0]
    mixed = ["MDOF-S", "2DOF-S", "2DOF-S-BW"]
    expected = [simulate(structure, motion, label).max_rotation for label in mixed[:2]]
    expected.append(simulate(structure, motion, "2DOF-S", bouc_wen=yielding).max_rotation)
    for run in (simulate_many, run_cloud):
        table = run(structure, motion, mixed, bouc_wen=yielding)
        assert table["max_rotation"].tolist() == expected
        table = run(structure, motion, mixed[:2], bouc_wen=yielding)
        assert table["max_rotation"][1] == expected[2]
        assert "bouc_wen applies to models with one mode, but MDOF-S has 3" in table["error"][0]
