"""Ctrl-C ends a study soon: the running chunks end, no further one begins, and the folder is free and whole."""

import functools
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pandas as pd
import pytest

import toy_study
from rockflex.store import StudyFolder
from toy_study import ToyPlan, run_study

PLAN = ToyPlan(n_chunks=30, delay=0.3)


@pytest.mark.skipif(os.name == "nt", reason="there Ctrl-C goes to a whole group of processes")
@pytest.mark.parametrize("wait", [0.0, 0.2])
def test_an_interrupted_study_ends_soon(tmp_path: Path, wait: float) -> None:
    command = [sys.executable, toy_study.__file__, str(tmp_path), str(PLAN.n_chunks), str(PLAN.delay)]
    # A shell lets its background jobs ignore Ctrl-C, and so would the study's process.
    heed = functools.partial(signal.signal, signal.SIGINT, signal.SIG_DFL)
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True, preexec_fn=heed) as process:
        while not (tmp_path / "parts" / "part-00000.parquet").exists():
            time.sleep(0.01)
        time.sleep(wait)
        process.send_signal(signal.SIGINT)
        begin = time.monotonic()
        assert "KeyboardInterrupt" in process.communicate()[1]
    assert time.monotonic() - begin < 2.0  # all that are left would take 4.2 s
    assert not (tmp_path / "lock").exists()
    missing = StudyFolder.load(tmp_path).missing()
    assert 20 < len(missing) < 30
    assert sorted(run_study(str(tmp_path), ToyPlan(n_chunks=30))) == missing
    pd.testing.assert_frame_equal(StudyFolder.load(tmp_path).frame(), PLAN.whole())
