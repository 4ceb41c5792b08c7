"""Speed of integrated models against SciPy's LSODA, both with an error of 1e-7 in the largest rotation.

On a fixed base the error is that of the largest displacement. The reference is LSODA with a tolerance of 1e-12. Times
are processor time, the least of several, so that other programs on the machine do not count.
"""

import sys
import time
from pathlib import Path

import numpy as np
from ode import peak_rotation
from rich.table import Table
from timing import frame, least

import rockflex as rf
from rockflex.models import parse_model

HELD = 1e-7
YIELDING = rf.BoucWen(0.04)
MODELS = {
    "2DOF-C": {"complete": True, "scaled": True},
    "2DOF-C-SI": {"complete": True},
    "2DOF-C-BW": {"complete": True, "scaled": True, "bouc_wen": YIELDING},
    "2DOF-S-BW": {"complete": False, "bouc_wen": YIELDING},
    "1DOF-fixed-BW": {"complete": False, "lifts": False, "bouc_wen": YIELDING},
}


def table(motion: rf.GroundMotion) -> Table:
    columns = ("model", "LSODA rtol", "LSODA error", "LSODA ms", "error", "one call ms", "ns a sample", "LSODA / call")
    result = Table(*columns, title="nonlinear models, both to 1e-7")
    for label in MODELS:
        result.add_row(label, *measure(label, motion))
    return result


def taylor_table(motion: rf.GroundMotion) -> Table | None:
    """2DOF-C by Taylor series of the whole field, one run after another and several at once; None without heyoka."""
    sys.path.append(str(Path(__file__).parents[1] / "tests"))
    try:
        import heyoka
        from taylor_batch import TaylorBatch

        from twins.taylor_rocking import of_properties
    except ImportError:
        return None
    structure = frame(5)
    p, samples, record = structure.rocking(1), motion.acceleration.size - 1, (motion.acceleration, motion.dt)
    twin, lanes = of_properties(p), heyoka.recommended_simd_size()
    batch, scales = TaylorBatch(p, lanes), np.linspace(0.9, 1.1, lanes)
    motions = [motion.scaled(scale) for scale in scales]
    mine = [rf.simulate(structure, each, "2DOF-C", "peaks").max_rotation for each in motions]
    found, alone = batch.run(*record, scales), twin.run(*record).max_rotation
    call = rf.simulate(structure, motion, "2DOF-C", "peaks").max_rotation
    seconds = {
        "simulate": least(lambda: rf.simulate(structure, motion, "2DOF-C", "peaks"), 200, time.process_time),
        "SciPy's LSODA, to 1e-7": float(measure("2DOF-C", motion)[2]) * 1e-3,
        "heyoka, driven from Python": least(lambda: twin.run(*record), 20, time.process_time),
        f"heyoka, {lanes} runs at once": least(lambda: batch.run(*record, scales), 20, time.process_time) / lanes,
    }
    result = Table("", "ms a run", "µs a sample", "over simulate", title="2DOF-C")
    for name, each in seconds.items():
        ratio = each / seconds["simulate"]
        result.add_row(name, f"{each * 1e3:.2f}", f"{each / samples * 1e6:.2f}", f"{ratio:.3g}")
    worst = np.abs(found / np.array(mine) - 1.0).max()
    result.caption = f"largest rotations differ by {abs(call / alone - 1.0):.0e}; of {lanes} at once by {worst:.0e}"
    return result


def measure(label: str, motion: rf.GroundMotion) -> tuple[str, ...]:
    given = MODELS[label]
    bouc_wen = given.get("bouc_wen")
    structure = frame(5)
    tied = parse_model(label).of(structure.rocking(), None, bouc_wen)
    assert tied.integrated
    row = 0 if tied.lifts else 1
    top = tied.properties.top_ordinate[0]
    turned, moved = peak_rotation(tied.properties, motion, 1e-12, **given)
    reference = (turned, top * moved)[row]

    def error(rotation: float, displacement: float) -> float:
        return abs((rotation, displacement)[row] / reference - 1.0)

    mine = rf.simulate(structure, motion, label, "peaks", bouc_wen=bouc_wen)
    call = least(lambda: rf.simulate(structure, motion, label, "peaks", bouc_wen=bouc_wen), 200, time.process_time)
    for rtol in (1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11):
        rotation, displacement = peak_rotation(tied.properties, motion, rtol, **given)
        reached = error(rotation, top * displacement)
        if reached < HELD:
            break
    seconds = least(lambda: peak_rotation(tied.properties, motion, rtol, **given), 3, time.process_time)
    ours = error(mine.max_rotation, mine.max_top_displacement)
    sample = call / (motion.acceleration.size - 1)
    times = (f"{seconds * 1e3:.0f}", f"{ours:.0e}", f"{call * 1e3:.2f}", f"{sample * 1e9:.0f}", f"{seconds / call:.0f}")
    return (f"{rtol:g}", f"{reached:.0e}", *times)
