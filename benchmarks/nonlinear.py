"""Speed of integrated models against SciPy's LSODA, both with an error of 1e-7 in the largest rotation.

On a fixed base the error is that of the largest displacement. The reference is LSODA with a tolerance of 1e-12. Times
are processor time, the least of several, so that other programs on the machine do not count.
"""

import sys
import time
from pathlib import Path

from ode import peak_rotation
from rich.table import Table
from timing import frame, least

import rockflex as rf
from rockflex.models import NonlinearModel, parse_model

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
    """2DOF-C by Taylor series of the whole field, the twin of the tests; None without heyoka."""
    sys.path.append(str(Path(__file__).parents[1] / "tests"))
    try:
        from twins.taylor_rocking import of_properties
    except ImportError:
        return None
    structure = frame(5)
    p, samples = structure.rocking(1), motion.acceleration.size - 1
    twin = of_properties(p)
    found = twin.run(motion.acceleration, motion.dt)
    mine = rf.simulate(structure, motion, "2DOF-C", "peaks")
    call = least(lambda: rf.simulate(structure, motion, "2DOF-C", "peaks"), 200, time.process_time)
    other = least(lambda: twin.run(motion.acceleration, motion.dt), 5, time.process_time)
    result = Table("", "ms", "µs a sample", title="2DOF-C, one run after another")
    result.add_row("simulate", f"{call * 1e3:.2f}", f"{call / samples * 1e6:.2f}")
    result.add_row("heyoka, driven from Python", f"{other * 1e3:.1f}", f"{other / samples * 1e6:.1f}")
    result.caption = f"largest rotations differ by {abs(mine.max_rotation / found.max_rotation - 1.0):.0e}"
    return result


def measure(label: str, motion: rf.GroundMotion) -> tuple[str, ...]:
    given = MODELS[label]
    bouc_wen = given.get("bouc_wen")
    structure = frame(5)
    tied = parse_model(label).of(structure.rocking(), None, bouc_wen)
    assert isinstance(tied, NonlinearModel)
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
