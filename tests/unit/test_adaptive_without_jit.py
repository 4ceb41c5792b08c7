"""The kernels of integrated models run uncompiled too, and say the same."""

import numpy as np
import pytest
from test_solve_without_jit import uncompiled

from builders import make_frame
from rockflex import BoucWen, GroundMotion, InitialState, Restitution, load_suite, simulate

SCRIPT = """
import json, sys
import numba
from test_adaptive_without_jit import runs
assert numba.config.DISABLE_JIT
json.dump([run.peaks() for run in runs()], sys.stdout)
"""


class Halves:
    """A law of the user's own."""

    keeps, loses = "half", "half"

    def after(self, properties, modal_velocity, rotation_velocity):
        return 0.5 * modal_velocity, 0.0


def runs():
    """Complete, with all modes and with one; passing; yielding on a free and on a fixed base; overturned; own law."""
    record = load_suite("el-centro-1940")[0].acceleration[68:108]
    frame = make_frame(n_stories=2, period=0.5, aspect_ratio=9.0, damping_ratio=0.05)
    motion = GroundMotion(2.5 * record, 0.02, name="El Centro")
    yield simulate(frame, motion, "MDOF-C")
    yield simulate(frame, motion, "2DOF-C", free_vibration="settle", output="peaks")
    yield simulate(frame, motion, "rigid-C", impact=Restitution(0.6, 1e-2), output="peaks")
    yield simulate(frame, motion, "2DOF-S", bouc_wen=BoucWen(0.03), output="peaks")
    yield simulate(frame, motion, "1DOF-fixed", bouc_wen=BoucWen(0.03, exponent=1.5), output="peaks")
    yield simulate(frame, motion, "2DOF-C", initial=InitialState(1.3, rotation_velocity=0.5), output="peaks")
    yield simulate(frame, motion, "2DOF-C", impact=Halves(), output="peaks")


def test_uncompiled_kernels_say_the_same():
    compiled = [run.peaks() for run in runs()]
    statuses = ["rocking", "rocking", "rocking", "rocking", "no_uplift", "overturned", "rocking"]
    assert [run["status"] for run in compiled] == statuses
    assert all(run["n_impacts"] > 0 for run in compiled if run["status"] == "rocking")
    for one, other in zip(uncompiled(SCRIPT), compiled, strict=True):
        for name, value in other.items():
            if name.startswith("max"):
                value = pytest.approx(value, rel=1e-9, abs=1e-15)
            elif isinstance(value, float):  # a summit is flat: its time is known to half the digits
                value = pytest.approx(value, abs=1e-6, nan_ok=True)
            assert one[name] == value, name


CHATTERING = """
import json, sys
import rockflex.solve.events as events
from rockflex import SolverError
from test_adaptive_without_jit import runs
events.MOST_EVENTS = -1
try:
    next(runs())
except SolverError as error:
    json.dump(str(error), sys.stdout)
"""


def test_impacts_without_end_are_reported_where_they_are():
    """With no event allowed at all, the message names the end of the sample of the first uplift."""
    run = next(runs())
    end = 0.02 * np.ceil(run.uplift_times[0] / 0.02)
    message = uncompiled(CHATTERING)
    assert isinstance(message, str)
    assert message.startswith(
        f"The events of MDOF-C, such as impacts, accumulate without end in the sample before {end:.6g} s. The state "
    )
    assert message.endswith("Check the model's parameters, and refine the record.")
