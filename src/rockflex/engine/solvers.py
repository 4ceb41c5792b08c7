"""Solvers of one system, kept for further runs; each is used by one thread at a time."""

from collections import defaultdict
from collections.abc import Callable
from contextlib import AbstractContextManager

from rockflex.engine.run import Run
from rockflex.engine.system import System

MAX_KEYS = 10_000  # phases that a solver has met, from which on it is given up: their keys take memory, too


class SolverPool:
    """A system and its solvers for every time step used so far.

    Parameters
    ----------
    system
        Returns the system.
    explaining
        Returns the context within which it, and a solver, are made: errors of numbers are explained there.
    """

    def __init__(self, system: Callable[[], System], explaining: Callable[[], AbstractContextManager[None]]) -> None:
        self._explaining = explaining
        with explaining():
            self.system = system()
        self._solvers = defaultdict[float, list[Run]](list)

    @property
    def size(self) -> int:
        """Memory of all solvers that are not in use, bytes."""
        return sum(solver.size for solvers in list(self._solvers.values()) for solver in list(solvers))

    def acquire(self, dt: float) -> Run:
        """Return a solver that no other thread uses."""
        try:
            return self._solvers[dt].pop()
        except IndexError:
            with self._explaining():
                return Run(self.system, dt)

    def release(self, solver: Run) -> None:
        """Keep a solver, whose history has been read, for the next run."""
        solver.trim()
        if solver.counts[0] < MAX_KEYS:
            self._solvers[solver.h].append(solver)
