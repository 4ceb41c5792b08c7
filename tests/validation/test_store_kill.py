"""A study killed at twenty random moments is resumed, and its table is that of the undisturbed one."""

import os
import random
import subprocess
import sys
import time
from pathlib import Path

import pandas as pd
import pytest

import rockflex as rf
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


def test_a_real_study_killed_at_random_moments_ends_alike(tmp_path: Path) -> None:
    """Killed as often as it takes: each process goes on where the one before was stopped."""
    spec, folder, draw = tmp_path / "study.toml", tmp_path / "killed", random.Random(7)
    spec.write_text(
        'study = "population"\npairs = 240\nruns_per_chunk = 12\n[records]\nsuites = ["fema-p695-far-field"]\n'
    )
    command = [sys.executable, "-m", "rockflex", "population", str(spec), "--out", str(folder), "--workers", "1"]
    kills, kept = 0, 0
    while True:
        with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
            while process.poll() is None and len(list(folder.glob("parts/*.parquet"))) <= kept:
                time.sleep(0.001)
            time.sleep(draw.uniform(0.0, 0.05))
            if process.poll() is None and kills < 8:
                process.kill()
                kills += 1
            process.wait()
        kept = len(list(folder.glob("parts/*.parquet")))
        if process.returncode == 0:
            break
    assert kills > 0
    whole = tmp_path / "whole"  # by a process of its own, which has the same kernels from the cache
    subprocess.run([str(whole) if each == str(folder) else each for each in command], check=True, capture_output=True)
    pd.testing.assert_frame_equal(rf.run_study(spec, folder), rf.run_study(spec, whole))
    for path in (whole / "parts").iterdir():
        assert (folder / "parts" / path.name).read_bytes() == path.read_bytes()
