"""Studies shared among copies of this process: the same parts as on one thread, however they end."""

import multiprocessing
import os
import re
import signal
import subprocess
import sys
import textwrap
import time
from pathlib import Path

import pandas as pd
import pytest

import rockflex as rf
from builders import frame_values
from own_law import Lossy
from rockflex.parallel import map_processes, may_fork
from rockflex.study import _runs
from rockflex.study.plan import _chunked

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
    "ground": rf.CloudStudy(**COMMON, models=["2DOF-S"], runs_per_chunk=1, ground={"friction": 0.3}),
}


@pytest.fixture
def copied(monkeypatch):
    """Whether processes were used; they are from two runs on."""
    if not may_fork():
        pytest.skip("this process cannot be copied: it may have threads of earlier tests")
    used = []

    def watched(*arguments):
        used.append(True)
        return map_processes(*arguments)

    monkeypatch.setattr(_runs, "map_processes", watched)
    monkeypatch.setattr(_chunked, "FEW", 2)
    return used


def contents(folder):
    return {path.name: path.read_bytes() for path in (folder / "parts").iterdir()}


@pytest.mark.parametrize("name", STUDIES)
def test_the_same_parts_whatever_the_number_of_workers(name, copied, tmp_path):
    study = STUDIES[name]
    alone = rf.run_study(study, tmp_path / "alone", workers=1)
    assert not copied
    for workers in (2, 3):
        together = rf.run_study(study, tmp_path / str(workers), workers=workers)
        assert len(copied) == workers - 1
        assert contents(tmp_path / str(workers)) == contents(tmp_path / "alone")
        pd.testing.assert_frame_equal(together, alone)
    pd.testing.assert_frame_equal(rf.run_study(study, workers=2), alone)
    assert len(copied) == 3


def test_functions_of_studies_are_shared_too(copied):
    motions = rf.load_suite("fema-p695-far-field")[:4]
    alone = rf.run_cloud(rf.Frame(**FRAME), motions, scales=[0.5 + 0.1 * k for k in range(40)], workers=1)
    together = rf.run_cloud(rf.Frame(**FRAME), motions, scales=[0.5 + 0.1 * k for k in range(40)], workers=2)
    assert copied
    pd.testing.assert_frame_equal(together, alone)


def test_a_search_starts_processes_in_each_round(copied):
    held = rf.Restrained(rf.Frame(**FRAME), rf.Tendon(initial_force=300e3, stiffness=2e6))
    pulses = {f"{period} s": rf.ricker_pulse(3.0, period) for period in (0.5, 0.6, 0.7, 0.8, 0.9)}
    search = rf.DesignSearch([1.0, 2.0, 3.0], tendon_factors=[0.0, 1.0, 2.0], refinements=1)
    targets, cost = [rf.Requirement(0.01, 0.2, at=0.5)], rf.DesignCost(half_width=1.0, prestress=5e-7)
    given, scales = (held, pulses, search, targets, cost), [0.5, 1.0, 2.0, 4.0]
    alone = rf.search_design(*given, model="2DOF-S", scales=scales, workers=1)
    assert not copied
    together = rf.search_design(*given, model="2DOF-S", scales=scales, workers=2)
    assert len(copied) == 2
    pd.testing.assert_frame_equal(together, alone)


def test_random_structures_are_shared_too(copied):
    variables = {"period": {"uniform": [0.4, 1.2]}}
    frame = FRAME | {"period": "= period"}
    study = rf.MonteCarloStudy(variables=variables, structure={"frame": frame}, count=8, records=RECORDS)
    study = study.model_copy(update={"models": ["2DOF-S"], "runs_per_chunk": 8})
    alone = rf.run_study(study, workers=1)
    assert not copied
    pd.testing.assert_frame_equal(rf.run_study(study, workers=2), alone)
    assert copied


def test_what_a_user_may_look_into_stays_in_this_process(copied):
    told = []

    class Telling(Lossy):
        def after(self, *given):
            told.append(given)
            return super().after(*given)

    def ground(_):
        told.append(None)
        return rf.Ground(friction=0.5)

    motions, scales = rf.load_suite("fema-p695-far-field")[:2], [1.0 + 0.01 * k for k in range(40)]
    rf.run_cloud(rf.Frame(**FRAME), motions, "2DOF-S", scales=scales, impact=Telling(), workers=2)
    assert len(told) > 80
    told.clear()
    rf.run_cloud(rf.Frame(**FRAME), motions, "2DOF-S", scales=scales, ground=ground, workers=2)
    assert told
    assert not copied


def test_few_runs_stay_in_this_process(copied, monkeypatch):
    monkeypatch.setattr(_chunked, "FEW", 25)
    rf.run_study(CLOUD, workers=2)
    assert not copied


def test_only_missing_parts_are_computed(copied, tmp_path):
    whole = rf.run_study(CLOUD, tmp_path, workers=2)
    kept = contents(tmp_path)
    for number in (1, 3):
        (tmp_path / "parts" / f"part-0000{number}.parquet").unlink()
    seen = []
    pd.testing.assert_frame_equal(rf.run_study(CLOUD, tmp_path, workers=2, progress=seen.append), whole)
    assert (seen[0].kept, seen[-1].done, seen[-1].runs) == (3, 5, 10)
    assert contents(tmp_path) == kept
    assert len(copied) == 2


def test_work_limits_count(copied):
    limited = CLOUD.model_copy(update={"work_limit": 1e-9})
    alone = rf.run_study(limited, workers=1)
    pd.testing.assert_frame_equal(rf.run_study(limited, workers=2), alone)
    assert copied
    assert alone["error"].str.contains("work_limit is 1e-09 s").sum() == 16
    with pytest.raises(rf.InputError, match="work_limit is 1e-09 s"):
        rf.run_study(limited.model_copy(update={"models": ["2DOF-S"]}), workers=2)


@pytest.mark.parametrize("stop", [KeyboardInterrupt, OSError])
def test_a_study_that_is_stopped_leaves_its_parts_and_no_process(stop, copied, tmp_path):
    def progress(now):
        if now.done == 2:
            raise stop

    with pytest.raises(stop):
        rf.run_study(CLOUD, tmp_path, workers=2, progress=progress)
    assert not multiprocessing.active_children()
    assert len(rf.StudyFolder.load(tmp_path).missing()) == 3
    pd.testing.assert_frame_equal(rf.run_study(CLOUD, tmp_path, workers=2), rf.run_study(CLOUD, workers=1))


def test_a_process_that_is_ended_from_outside():
    def ended(task):
        if task == 1:
            os.kill(os.getpid(), signal.SIGKILL)
        return task

    with pytest.raises(rf.SolverError, match=r"ended from outside, most often because memory ran out.*workers=1"):
        list(map_processes(ended, range(4), 2, lambda: False))
    assert not multiprocessing.active_children()


@pytest.mark.skipif(sys.platform != "linux", reason="processes are copied on Linux only")
def test_copies_end_with_their_process():
    script = textwrap.dedent(r"""
        import os, time
        from rockflex.parallel import map_processes

        def waits(task):
            os.write(1, b"%d\n" % os.getpid())
            time.sleep(60.0)

        list(map_processes(waits, range(2), 2, lambda: False))
    """)
    with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        copies = [int(process.stdout.readline()) for _ in range(2)]
        process.kill()
        process.wait()
    end = time.monotonic() + 20.0
    while any(map(lives, copies)):
        assert time.monotonic() < end
        time.sleep(0.05)


def lives(process):
    """Tell whether a process runs: neither gone, nor ended and not yet collected by its new parent."""
    try:
        return re.search(r"^State:\s+Z", Path(f"/proc/{process}/status").read_text(), re.MULTILINE) is None
    except OSError:
        return False
