"""The campaign of Section 3.2 on one and on all cores, and what a plain ODE solver would need for it.

``python benchmarks/campaign.py`` runs the six structures of Table 1 of the paper under the 72 components of FEMA P-695
without pulses, at two scales, with three models, by one call of `simulate_many`. The solver is SciPy's LSODA with
events (`ode`), which runs some of the runs with one mode.
"""

import argparse
import time
from collections.abc import Callable, Iterable
from functools import partial

import numpy as np
from ode import peak_rotation
from rich.console import Console
from rich.table import Table
from timing import least

import rockflex as rf
from rockflex.foundation.arrays import Array
from rockflex.papers.silva_stojadinovic_2024._inputs import MODELS, STRUCTURES, SUITES, table_1_frame

SCALES = (1.0, 2.0)
ONE_MODE = MODELS[1:]
TOLERANCE = 1e-8  # relative, of the solver
SMALL = 1e-6  # rad, below which a rotation is rounding and small uplifts


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--structures", nargs="+", choices=[*STRUCTURES], default=[*STRUCTURES])
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--sample", type=int, default=3, help="runs of each structure by the ODE solver; 0: none")
    given = parser.parse_args()
    Console(width=120).print(table(given.structures, given.rounds, given.sample))


def table(names: list[str], rounds: int, sample: int) -> Table:
    """Times of the campaign of some structures, each the least of some rounds, by model and of all in one call."""
    frames = [table_1_frame(name) for name in names]
    suite = rf.Suite([motion for name in SUITES for motion in rf.load_suite(name)])
    runs = len(frames) * len(suite) * len(SCALES)
    counts = np.array([*(runs for _ in MODELS), runs * len(MODELS)])
    title = f"{len(frames)} structures × {len(suite)} components × {len(SCALES)} scales"
    found = Table("", *MODELS, "all", title=title)

    def measured(workers: int | None, clock: Callable[[], float]) -> Array:
        """Return the time of each model, and of all in one call."""

        def run(models: str | tuple[str, ...]) -> object:
            return rf.simulate_many(frames, suite, models, scales=SCALES, workers=workers)

        return np.array([least(partial(run, models), rounds, clock) for models in (*MODELS, MODELS)])

    processor, wall = measured(1, time.process_time), measured(None, time.perf_counter)
    found.add_row("runs", *(f"{each:,d}" for each in counts.tolist()))
    found.add_row("one thread, processor time, s", *(f"{each:.2f}" for each in processor))
    found.add_row("  runs a second", *(f"{each:,.0f}" for each in counts / processor))
    found.add_row("all cores, s", *(f"{each:.2f}" for each in wall))
    found.add_row("  runs a second", *(f"{each:,.0f}" for each in counts / wall))
    if sample:
        times, apart = zip(*(by_solver(frames, suite, model, sample) for model in ONE_MODE), strict=True)
        ours = [processor[MODELS.index(model)] / runs for model in ONE_MODE]
        ratios = (solver / own for solver, own in zip(times, ours, strict=True))
        found.add_row(f"LSODA, a run, s ({len(frames) * sample} runs of each)", *blank(f"{each:.2f}" for each in times))
        found.add_row("  times as long as a run on one thread", *blank(f"{each:,.0f}" for each in ratios))
        found.add_row("  relative difference of θ_max, median", *blank(f"{each:.0e}" for each in apart))
    return found


def by_solver(frames: list[rf.Frame], suite: rf.Suite, model: str, sample: int) -> tuple[float, float]:
    """Return the processor time of a run by the ODE solver, and the median of its relative error in θ_max."""
    places = np.linspace(0, len(suite) * len(SCALES) - 1, sample).astype(int).tolist()
    taken, apart = 0.0, list[float]()
    for frame in frames:
        one_mode = frame.rocking().truncated(1)
        for place in places:
            motion = suite[place // len(SCALES)].scaled(SCALES[place % len(SCALES)])
            begun = time.process_time()
            rotation, _ = peak_rotation(
                one_mode, motion, TOLERANCE, complete=model == "2DOF-C", scaled=model == "2DOF-C"
            )
            taken += time.process_time() - begun
            ours = rf.simulate(frame, motion, model, output="peaks").max_rotation
            apart.append(abs(rotation - ours) / max(ours, SMALL))
    return taken / len(apart), float(np.median(apart))


def blank(cells: Iterable[str]) -> list[str]:
    """Return cells of the models with one mode in the columns of all."""
    values = dict(zip(ONE_MODE, cells, strict=True))
    return [values.get(name, "") for name in (*MODELS, "all")]


if __name__ == "__main__":
    main()
