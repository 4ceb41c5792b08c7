"""Derivatives of a run, against a run with peaks alone.

``python benchmarks/sensitivity.py`` prints this table alone.
"""

import time
from collections.abc import Callable

import numpy as np
from rich.console import Console
from rich.table import Table
from timing import frame, milliseconds

import rockflex as rf

SIZES = (1, 5, 15)
ROUNDS = 15
CALLS = 5  # of each in a round
PEAKS = "run with peaks"


def table() -> Table:
    """Processor time of each call over that of a run with peaks, the median of alternating rounds."""
    motion = rf.load_suite("el-centro-1940")[0].scaled(1.5)
    made = Table(
        "",
        *(f"N = {n}" for n in SIZES),
        title=f"derivatives of a run, over a {PEAKS}: MDOF-S under {motion.name} ×1.5",
    )
    columns = [column(n, motion) for n in SIZES]
    for name in columns[0]:
        made.add_row(name, *(each[name] for each in columns))
    return made


def column(n: int, motion: rf.GroundMotion) -> dict[str, str]:
    """The times of a frame of n stories, as texts."""
    structure = frame(n)
    names = rf.parameter_names(structure)
    calls: dict[str, Callable[[], object]] = {
        PEAKS: lambda: rf.simulate(structure, motion, "MDOF-S", "peaks"),
        "run with history": lambda: rf.simulate(structure, motion, "MDOF-S"),
        "run with history and sensitivity": lambda: rf.simulate(structure, motion, "MDOF-S").sensitivity,
        "gradient, the scale of the record alone": lambda: rf.gradient(structure, motion, "MDOF-S", []),
        "gradient, and one parameter": lambda: rf.gradient(structure, motion, "MDOF-S", ["period"]),
        f"gradient, and {len(names)} parameters": lambda: rf.gradient(structure, motion, "MDOF-S", names),
    }
    spent = {name: np.zeros(ROUNDS + 1) for name in calls}
    for place in range(ROUNDS + 1):  # the first round is not counted
        for name, call in calls.items():
            started = time.process_time()  # other processes do not count
            for _ in range(CALLS):
                call()
            spent[name][place] = (time.process_time() - started) / CALLS
    peaks = spent.pop(PEAKS)[1:]
    found = {f"{PEAKS}, ms": milliseconds(float(np.median(peaks)))}
    return found | {name: f"{np.median(each[1:] / peaks):.1f}" for name, each in spent.items()}


if __name__ == "__main__":
    Console(width=120).print(table())
