"""Studies on several threads: the same parts as on one, however they end."""

import threading

import pandas as pd
import pytest

import rockflex as rf
from builders import frame_values

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
