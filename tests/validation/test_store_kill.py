"""A study killed at twenty random moments is resumed, and its table is that of the undisturbed one."""

import os
import random
import subprocess
import sys
import time
from pathlib import Path

import pandas as pd
import pytest

from rockflex.store import StudyFolder
from toy_study import ToyPlan, run_study

pytestmark = pytest.mark.slow
HELPER = Path(__file__).parents[1] / "toy_study.py"
PLAN = ToyPlan(n_chunks=40, delay=0.02)


def start(folder: Path) -> "subprocess.Popen[bytes]":
    command = [sys.executable, str(HELPER), str(folder), str(PLAN.n_chunks), str(PLAN.delay)]
    return subprocess.Popen(command, env=os.environ | {"PYTHONPATH": str(HELPER.parent)})


def await_file(path: Path) -> None:
    while not path.exists():
        time.sleep(0.001)


def test_killed_at_twenty_random_moments_and_resumed(tmp_path: Path) -> None:
    names, cut_short = [f"part-{number:05d}.parquet" for number in range(PLAN.n_chunks)], 0
    for attempt in range(20):
        study = tmp_path / f"study-{attempt}"
        with start(study) as process:
            await_file(study)  # the imports take longer than the study
            time.sleep(random.Random(attempt).uniform(0.0, 0.5))
            process.kill()
        before = {path.name: path.read_bytes() for path in study.glob("parts/*.parquet")}
        cut_short += len(before) < PLAN.n_chunks
        computed = run_study(str(study), ToyPlan(PLAN.n_chunks))
        assert sorted(computed) == [number for number, name in enumerate(names) if name not in before]
        after = {path.name: path.read_bytes() for path in (study / "parts").iterdir()}
        assert sorted(after) == names
        assert before.items() <= after.items()
        pd.testing.assert_frame_equal(StudyFolder.load(study).frame(), PLAN.whole())
    assert cut_short > 10  # a few may have been faster than this process


def test_killed_again_and_again_it_ends(tmp_path: Path) -> None:
    study, draw = tmp_path / "study", random.Random(99)
    for _ in range(4):
        with start(study) as process:
            await_file(study / "lock")
            time.sleep(draw.uniform(0.0, 0.3))
            process.kill()
    run_study(str(study), ToyPlan(PLAN.n_chunks))
    pd.testing.assert_frame_equal(StudyFolder.load(study).frame(), PLAN.whole())
