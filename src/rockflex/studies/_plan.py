"""A study divided into chunks that can be computed anywhere."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from copy import copy
from typing import TYPE_CHECKING, ClassVar, Self, SupportsIndex

import numpy as np

from rockflex.foundation.checks import checked_whole_number
from rockflex.motion._ground_motion import check_horizontal_component
from rockflex.motion._suite import Suite
from rockflex.studies._result_tables import ArrowTable, Columns, Table, arrow_table, joined_tables
from rockflex.studies._run_matrix import StudyMatrix, record_checksums
from rockflex.studies.parallel import map_runs_in_order

if TYPE_CHECKING:
    import pandas as pd


PER_CHUNK = 64  # runs of a chunk of functions such as `run_cloud`, so that a few hundred runs occupy many threads
PIECES_PER_THREAD = 4  # of a chunk that several threads share, so that they end together


class ChunkedPlan(ABC):
    """A plan of `n_units` units, computed `per_chunk` at a time; each unit gives some rows of the table.

    A unit depends only on its own number, so the size of the chunks changes no row.
    """

    exact_count: ClassVar[bool] = True
    """Whether `n_runs` is the number of runs, and not only an upper bound."""

    units: ClassVar[str] = "runs"
    """The name of the units, in the plural."""

    threads: int = 1
    """Number of threads that share a chunk, see `on_threads`."""

    def __init__(self, motions: Suite, n_units: int, per_chunk: int) -> None:
        check_horizontal_component(*motions)
        self.motions = motions
        self.n_units = n_units
        self.per_chunk = checked_whole_number("the size of a chunk", per_chunk, 1)

    @property
    @abstractmethod
    def n_runs(self) -> int:
        """Number of runs in all chunks, or an upper bound of it."""

    @property
    @abstractmethod
    def columns(self) -> Columns:
        """Columns of every chunk's table."""

    @abstractmethod
    def results(self, units: Sequence[int]) -> Table:
        """Compute some units, and return the columns of their rows, in their order."""

    def check_work(self) -> None:
        """Refuse a study if every run exceeds its work limit; one whose runs are not known in advance, none."""
        return

    @property
    def rounds(self) -> list[range]:
        """Numbers of the chunks that can be computed one round after the other, all of them at once by default."""
        return [range(-(-self.n_units // self.per_chunk))]

    def next_round(self, table: "pd.DataFrame") -> "ChunkedPlan":  # noqa: ARG002
        """Return the plan of the next round, which may depend on the table of the rounds before."""
        return self

    @property
    def n_ready(self) -> int:
        """Number of units, from the first, that do not depend on other units."""
        return self.n_units

    @property
    def n_chunks(self) -> int:
        """Number of chunks."""
        return self.rounds[-1].stop

    def units_of(self, number: int) -> range:
        """Units of a chunk."""
        first = self.per_chunk * number
        return range(first, min(first + self.per_chunk, self.n_units))

    def in_order_of_work(self, units: Sequence[int]) -> Sequence[int]:
        """Return units in the order in which they are computed, for instance with those alike side by side."""
        return units

    @property
    def checksums(self) -> dict[str, str]:
        """SHA-256 of each record's step and samples, by its name."""
        return record_checksums(self.motions)

    def chunk(self, number: SupportsIndex) -> ArrowTable:
        """Compute a chunk. The table is the same to the last bit, whenever and wherever it is computed."""
        pieces = self.pieces(checked_whole_number("number", number, 0, self.n_chunks - 1))
        found = map_runs_in_order(self.results, pieces, self.threads)
        table = arrow_table(found[0] if len(found) == 1 else joined_tables(found), self.columns)
        places = np.argsort(np.concatenate(pieces))
        return table if (np.diff(places) == 1).all() else table.take(places)

    def pieces(self, number: int) -> list[Sequence[int]]:
        """Return the units of a chunk in the order in which they are computed, divided among the threads."""
        units = self.in_order_of_work(self.units_of(number))
        size = len(units) if self.threads == 1 else -(-len(units) // (PIECES_PER_THREAD * self.threads))
        return [units[first : first + size] for first in range(0, len(units), size)]

    def on_threads(self, threads: int) -> Self:
        """Return the plan whose every chunk is computed on several threads, for studies of few chunks."""
        other = copy(self)
        other.threads = threads
        return other


class CrossPlan(ChunkedPlan):
    """The cross product of structures, records, models and `n_levels` levels, one unit each, divided into chunks."""

    def __init__(self, matrix: StudyMatrix, n_levels: int, per_chunk: int) -> None:
        self.matrix, self._n_levels = matrix, n_levels
        n_units = len(matrix.names) * len(matrix.motions) * len(matrix.labels) * n_levels
        super().__init__(matrix.motions, n_units, per_chunk)

    @abstractmethod
    def scale(self, structure: int, record: int, level: int) -> float:
        """Factor on a record's acceleration at a level."""

    @property
    def n_runs(self) -> int:
        """Number of runs."""
        return self.n_units

    @property
    def columns(self) -> Columns:
        """Columns of every chunk's table."""
        return self.matrix.columns

    def results(self, units: Sequence[int]) -> Table:
        """Simulate one run a unit."""
        return self.matrix.results([self.run_of(unit) for unit in units])

    def check_work(self) -> None:
        """Refuse a study if every run exceeds its work limit."""
        self.matrix.check_work(map(self.run_of, range(self.n_units)))

    def run_of(self, unit: int) -> tuple[int, int, int, float]:
        """Return the places of the structure, record and model of a unit, and the scale of its (first) run."""
        structure, record, model, level = self.matrix.run_at(unit, self._n_levels)
        return structure, record, model, self.scale(structure, record, level)
