"""The kernels are plain functions on arrays: they run uncompiled too, and say the same."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from builders import frame_values
from rockflex import Frame, GroundMotion, InitialState, Restrained, Tendon, load_suite, simulate

SCRIPT = """
import json, sys
import numba
from test_solve_without_jit import runs
assert numba.config.DISABLE_JIT
json.dump([run.peaks() for run in runs()], sys.stdout)
"""


def runs():
    """Uplifts, impacts and a settled end; overturning; a fixed base; a dense start with jumps at both ends."""
    record = load_suite("el-centro-1940")[0].acceleration[60:200]
    frame = frame_values(n_stories=3, period=0.5, aspect_ratio=9.0, damping_ratio=0.05)
    motion = GroundMotion(2.0 * record, 0.02, name="El Centro")
    tied = Restrained(Frame(**frame), Tendon(0.0, 0.0))  # which leaves the motion as it is
    yield simulate(tied, motion, free_vibration="settle")
    yield simulate(tied, motion, "2DOF-S", initial=InitialState(0.8))
    yield simulate(tied, motion, "fixed", output="peaks")
    yield simulate(tied, motion, "3DOF-S", initial=InitialState(0.05, [0.01]), output="peaks")


def uncompiled(script):
    """What a script prints where kernels are plain functions."""
    path = os.pathsep.join([str(Path(__file__).parent), *sys.path])
    environment = {**os.environ, "NUMBA_DISABLE_JIT": "1", "PYTHONPATH": path}
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", script], env=environment, capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_uncompiled_kernels_say_the_same():
    compiled = [run.peaks() for run in runs()]
    assert [run["status"] for run in compiled] == ["rocking", "overturned", "no_uplift", "rocking"]
    for one, other in zip(uncompiled(SCRIPT), compiled, strict=True):
        for name, value in other.items():
            if name.startswith("max"):
                value = pytest.approx(value, rel=1e-10, abs=0.0)
            elif isinstance(value, float):  # a summit is flat: its time is known to half the digits
                value = pytest.approx(value, abs=1e-7, nan_ok=True)
            assert one[name] == value, name


CHATTERING = """
import json, sys
import rockflex.solve.events as events
from rockflex import SolverError
from test_solve_without_jit import runs
events.MOST_EVENTS = -1
try:
    next(runs())
except SolverError as error:
    json.dump(str(error), sys.stdout)
"""


def test_impacts_without_end_are_reported_where_they_are():
    """With no event allowed at all, the message names the end of the sample of the first uplift."""
    first = next(runs()).uplift_times[0]
    end = 0.02 * np.ceil(first / 0.02)
    message = uncompiled(CHATTERING)
    assert message.startswith(
        f"The events of MDOF-S, such as impacts, accumulate without end in the sample before {end:.6g} s. The state "
    )
