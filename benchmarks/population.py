"""A population, one structure a run: against the same number of runs on one structure, and on two threads.

``python benchmarks/population.py`` prints ratios of times taken in turn; they need two idle cores.
"""

import statistics
import time

import numpy as np
from rich.console import Console
from rich.table import Table

import rockflex as rf

STRUCTURES, ROUNDS = 2000, 3


def main() -> None:
    Console(width=120).print(table())


def population(seed: int) -> list[rf.Frame]:
    """Random frames of two to five stories; none is assembled yet."""
    rng = np.random.default_rng(seed)
    return [
        rf.Frame(
            n_stories=int(rng.integers(2, 6)),
            story_height=3.0,
            story_mass=40e3,
            base_mass=40e3 * rng.uniform(1.0, 3.0),
            stiffness_ratio=np.inf,
            period=rng.uniform(0.5, 1.5),
            aspect_ratio=rng.uniform(7.0, 11.0),
            damping_ratio=0.02,
        )
        for _ in range(STRUCTURES)
    ]


def table() -> Table:
    motion = rf.load_suite("fema-p695-far-field")["FF-1-a"].scaled(1.5)
    found = Table("", "one core / one structure", "two threads, times as fast", title=f"{STRUCTURES} structures")
    for model in ("2DOF-S", "MDOF-S"):
        rounds = [measured(model, motion, seed) for seed in range(ROUNDS)]
        found.add_row(model, *(f"{statistics.median(column):.2f}" for column in zip(*rounds, strict=True)))
    return found


def measured(model: str, motion: rf.GroundMotion, seed: int) -> tuple[float, float]:
    """Return both ratios; the single structure is run as often, with every 20th of the population in turn."""

    def taken(structures: list[rf.Frame], motions: list[rf.GroundMotion], workers: int) -> float:
        started = time.perf_counter()
        rf.simulate_many(structures, motions, model, workers=workers)
        return time.perf_counter() - started

    rf.simulate_many(population(seed)[:4], motion, model, workers=1)
    alone, shared = taken(population(seed), [motion], 1), taken(population(seed), [motion], 2)
    some = population(seed)[::20]
    single = sum(taken([each], [motion] * (STRUCTURES // len(some)), 1) for each in some)
    return alone / single, alone / shared


if __name__ == "__main__":
    main()
