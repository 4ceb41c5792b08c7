"""A study killed at random moments is resumed, and its table is that of the undisturbed one."""

import multiprocessing
import os
import random
import sys
import time
from collections.abc import Callable
from functools import partial
from multiprocessing.process import BaseProcess
from pathlib import Path

import pandas as pd
import pytest

import rockflex as rf
from rockflex.studies.folders import StudyFolder
from toy_study import ToyPlan, run_study

pytestmark = pytest.mark.slow
PLAN = ToyPlan(n_chunks=20, delay=0.04)
Start = Callable[..., BaseProcess]
RECORDS = '[records]\nsuites = ["fema-p695-far-field"]\n'
WALLS = Path(__file__).parents[2] / "examples" / "controlled_rocking_walls.toml"


@pytest.fixture
def start(monkeypatch: pytest.MonkeyPatch) -> Start:
    """Call a function in a new process: a copy of one that has imported what studies need, and run nothing."""
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(path for path in sys.path if path))
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload([run_study.__module__, rf.run_study.__module__])

    def started(function: Callable[..., object], *arguments: object) -> BaseProcess:
        process = context.Process(target=function, args=arguments)
        process.start()
        return process

    return started


def await_file(path: Path) -> None:
    while not path.exists():
        time.sleep(0.001)


def kill(process: BaseProcess) -> None:
    process.kill()
    process.join()


def test_killed_at_ten_random_moments_and_resumed(tmp_path: Path, start: Start) -> None:
    names, cut_short = [f"part-{number:05d}.parquet" for number in range(PLAN.n_chunks)], 0
    for attempt in range(10):
        study = tmp_path / f"study-{attempt}"
        process = start(run_study, str(study), PLAN)
        await_file(study)
        time.sleep(random.Random(attempt).uniform(0.0, 0.5))
        kill(process)
        before = {path.name: path.read_bytes() for path in study.glob("parts/*.parquet")}
        cut_short += len(before) < PLAN.n_chunks
        computed = run_study(str(study), ToyPlan(PLAN.n_chunks))
        assert sorted(computed) == [number for number, name in enumerate(names) if name not in before]
        after = {path.name: path.read_bytes() for path in (study / "parts").iterdir()}
        assert sorted(after) == names
        assert before.items() <= after.items()
        pd.testing.assert_frame_equal(StudyFolder.load(study).frame(), PLAN.whole())
    assert cut_short > 4  # a few may have been faster than this process


def test_killed_again_and_again_it_ends(tmp_path: Path, start: Start) -> None:
    study, draw = tmp_path / "study", random.Random(99)
    for _ in range(4):
        process = start(run_study, str(study), PLAN)
        await_file(study / "lock")
        time.sleep(draw.uniform(0.0, 0.3))
        kill(process)
    run_study(str(study), ToyPlan(PLAN.n_chunks))
    pd.testing.assert_frame_equal(StudyFolder.load(study).frame(), PLAN.whole())


@pytest.mark.parametrize(
    "content",
    [
        'study = "population"\npairs = 120\nruns_per_chunk = 12\n' + RECORDS,
        'study = "monte_carlo"\ncount = 120\nruns_per_chunk = 6\nrecords_per_structure = 1\nmodels = ["rigid"]\n'
        "variables = { b = { uniform = [0.1, 0.2] }, fuse = { uniform = [0.1, 0.5] } }\n"
        'structure.block = { slenderness = "= b", half_diagonal = 3.0 }\n'
        'structure.elements = [{ kind = "yielding_dissipator", stiffness = "= 100 * weight", '
        'yield_force = "= fuse * weight" }]\n' + RECORDS,
        WALLS.read_text("utf-8")
        .replace("count = 1000", "count = 4")
        .replace("records_per_structure = 4", "runs_per_chunk = 72"),
    ],
    ids=["population", "monte_carlo", "walls"],
)
def test_a_real_study_killed_at_random_moments_ends_alike(content: str, tmp_path: Path, start: Start) -> None:
    """Killed as often as it takes: each process goes on where the one before was stopped."""
    spec, folder, draw = tmp_path / "study.toml", tmp_path / "killed", random.Random(7)
    spec.write_text(content, "utf-8")
    kills, kept = 0, 0
    while True:
        process = start(partial(rf.run_study, spec, folder, workers=1))
        while process.is_alive() and len(list(folder.glob("parts/*.parquet"))) <= kept:
            time.sleep(0.001)
        time.sleep(draw.uniform(0.0, 0.05))
        if process.is_alive() and kills < 2:
            process.kill()
            kills += 1
        process.join()
        kept = len(list(folder.glob("parts/*.parquet")))
        if process.exitcode == 0:
            break
    assert kills > 0
    whole = tmp_path / "whole"  # by a process of its own, which has the same kernels from the cache
    process = start(partial(rf.run_study, spec, whole, workers=1))
    process.join()
    assert process.exitcode == 0
    pd.testing.assert_frame_equal(rf.run_study(spec, folder), rf.run_study(spec, whole))
    for path in (whole / "parts").iterdir():
        assert (folder / "parts" / path.name).read_bytes() == path.read_bytes()
