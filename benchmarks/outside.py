"""How much of a batch's processor time is not the engine's, and how much holds the interpreter's lock.

    python benchmarks/outside.py

Times of the thread, in which neighbours count little: marching and preparing tables are the engine's, without the lock
but for the phases and rooms that are made within. With a share L under the lock two threads are at best 2/(1 + L²)
times as fast as one, if each waits its turn.
"""

import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
from population import population
from rich.console import Console
from rich.table import Table
from timing import frame

import rockflex as rf
from rockflex.engine import tables
from rockflex.engine.solvers import SolverPool
from rockflex.engine.system import System

COUNT, PAIRS, ROUNDS = 100, 256, 11
PARTS_WITH_LOCK = ("parts_of_events", "room_of_tables", "roots_and_vectors", "rates_of", "rows_of", "shift_of")


class Timed:
    """A solver whose march is timed."""

    def __init__(self, solver: Any, spent: Counter[str]) -> None:
        vars(self).update(solver=solver, spent=spent)

    def __getattr__(self, name: str) -> Any:
        return getattr(self.solver, name)

    def __setattr__(self, name: str, value: Any) -> None:
        setattr(self.solver, name, value)

    def follow(self, *given: Any) -> None:
        """March."""
        with timing(self.spent, "march"):
            self.solver.follow(*given)


@contextmanager
def timing(spent: Counter[str], name: str) -> Iterator[None]:
    begun = time.thread_time()
    try:
        yield
    finally:
        spent[name] += time.thread_time() - begun  # pyright: ignore[reportArgumentType]


def watch(spent: Counter[str]) -> None:
    """Time the engine's parts from here on."""
    acquire, release = SolverPool.acquire, SolverPool.release

    def timed(function: Callable[..., Any]) -> Callable[..., Any]:
        def call(*given: Any) -> Any:
            with timing(spent, "within"):
                return function(*given)

        return call

    def acquire_timed(pool: SolverPool, dt: float) -> Any:
        with timing(spent, "tables"):
            return Timed(acquire(pool, dt), spent)

    SolverPool.acquire = acquire_timed
    SolverPool.release = lambda pool, solver: release(pool, solver.solver)
    System.checked = timed(System.checked)
    for name in PARTS_WITH_LOCK:
        setattr(tables, name, timed(getattr(tables, name)))


def main() -> None:
    spent = Counter[str]()
    watch(spent)
    suite, single = rf.load_suite("fema-p695-far-field"), frame(5)
    records = [*suite, *suite, *suite][:COUNT]
    motion = suite["FF-1-a"].scaled(1.5)

    def of_fresh_structures() -> Callable[[], object]:  # which are not assembled yet
        structures = population(0)[:COUNT]
        return lambda: rf.simulate_many(structures, motion, workers=1)

    def shared_by_threads() -> Callable[[], object]:
        plan = rf.PopulationStudy(records={"suites": ["fema-p695-far-field"]}, pairs=PAIRS).plan().on_threads(2)
        return lambda: [plan.results(piece) for number in range(plan.n_chunks) for piece in plan.pieces(number)]

    cases: dict[str, Callable[[], Callable[[], object]]] = {
        f"{COUNT} records on one structure of 5 stories": lambda: lambda: rf.simulate_many(single, records, workers=1),
        f"one record on {COUNT} structures of 2 to 5": of_fresh_structures,
        f"run_population, {COUNT} pairs of 2 to 15": lambda: lambda: rf.run_population(suite, COUNT, workers=1),
        f"{PAIRS} pairs in the pieces of two threads": shared_by_threads,
    }
    columns = "all, ms", "march", "tables", "outside the engine", "all over march", "lock", "two threads, at best"
    found = Table("", *columns, title="processor time on one thread")
    for title, make in cases.items():
        rows = list[tuple[float, ...]]()
        for _ in range(ROUNDS):
            run = make()
            spent.clear()
            begun = time.thread_time()
            run()
            whole = time.thread_time() - begun
            rows.append((whole, *(spent[name] / whole for name in ("march", "tables", "within"))))
        whole, march, made, within = np.median(rows[1:], axis=0)
        outside = 1.0 - march - made
        lock = outside + within
        shares = (f"{share:.0%}" for share in (march, made, outside))
        best = f"{2.0 / (1.0 + lock**2):.2f}"
        found.add_row(title, f"{1e3 * whole:.1f}", *shares, f"{1.0 / march:.2f}", f"{lock:.0%}", best)
    Console(width=140).print(found)


if __name__ == "__main__":
    main()
