"""What runs leave behind: what their cases hold is counted, and no number of runs fills the memory."""

import gc
import subprocess
import sys
import tracemalloc
from pathlib import Path

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from rockflex.models import parse_model
from rockflex.studies import PreparedCase

NOISE = np.random.default_rng(5).standard_normal((2, 100_000))
FRAME = make_frame()
HALF_WIDTH, WEIGHT = FRAME.rocking().half_width, 9.81 * FRAME.rocking().m_tot
RESTRAINED = rf.Restrained(
    FRAME, [rf.Tendon(0.1 * WEIGHT, WEIGHT), rf.YieldingDissipator(10.0 * WEIGHT, 0.1 * WEIGHT, 0.02, HALF_WIDTH)]
)
BED = rf.Ground(springs=rf.winkler_bed(HALF_WIDTH, 1.0, 4e8, damping=1e6, n=9), base_inertia=2e5)


def motion(samples, *, vertical=False):
    """White noise that makes the base rock."""
    return rf.GroundMotion(2.0 * NOISE[0, :samples], 0.01, vertical=NOISE[1, :samples] if vertical else None)


@pytest.mark.parametrize(
    ("structure", "model", "shaking", "ground"),
    [
        (FRAME, "MDOF-S", motion(100_000), None),
        (FRAME, "MDOF-S", motion(2000), None),
        (FRAME, "MDOF-S", motion(2000, vertical=True), None),
        (make_frame(n_stories=40), "MDOF-S", motion(1000), None),
        (RESTRAINED, "MDOF-S", motion(2000), None),
        (FRAME, "MDOF-S", motion(1000), BED),
        (FRAME, "MDOF-C", motion(20_000), None),
    ],
)
def test_what_a_case_holds_for_further_runs_is_counted(structure, model, shaking, ground) -> None:
    def case():
        tied = parse_model(model).of(structure.rocking(), None, None, ground)
        return PreparedCase(tied, work_limit=None, history=True, floors=True)

    case().run(shaking)  # what is made once, whatever runs
    gc.collect()
    tracemalloc.start()
    try:
        before, kept = tracemalloc.get_traced_memory()[0], case()
        kept.run(shaking)
        gc.collect()
        held = tracemalloc.get_traced_memory()[0] - before
    finally:
        tracemalloc.stop()
    assert held < 1.15 * kept.engine.size + 2e5
    assert kept.engine.size < 5e6 + 6e3 * structure.rocking().n_modes ** 2  # tables, but no long history


RUNS = """
import sys
import numpy as np
import rockflex as rf

noise = np.random.default_rng(0).standard_normal(200_000)


def resident():
    with open("/proc/self/status") as lines:
        return next(int(line.split()[1]) / 1024.0 for line in lines if line.startswith("VmRSS"))  # MB


def run(motion, count):
    for k in range(count):
        frame = rf.Frame(5, 3.0, 40e3, 40e3, 1.0, period=0.5 + 0.01 * k, aspect_ratio=10.0, damping_ratio=0.02)
        rf.simulate(frame, motion, ("MDOF-S", "2DOF-S", "fixed")[k % 3])


run(rf.GroundMotion(noise[:100], 0.005), 3)
first = resident()
run(rf.GroundMotion(noise, 0.005), 15)
print(resident() - first)
"""


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="no /proc, which says what is resident")
def test_many_long_histories_that_nobody_keeps_leave_little() -> None:
    made = subprocess.run([sys.executable, "-c", RUNS], capture_output=True, text=True, check=True)
    assert float(made.stdout) < 200.0  # MB: some histories at a time; it was 50 MB more for each run
