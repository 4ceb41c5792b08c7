"""Pieces of the work: runs that several targets share, or that take long, computed anywhere and kept as tables."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rockflex.papers.silva_stojadinovic_2024._inputs import PaperRecords

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True)
class Piece:
    """Some runs: number `number` of `count` in a group whose tables have the same columns.

    `make` is a function that another process can import, called with the records and the number; `cost` is the time
    that it takes on one core of a machine of 2024, in s, by which pieces and targets are weighed against each other.
    """

    group: str
    number: int
    count: int
    cost: float
    make: "Callable[[PaperRecords, int], pd.DataFrame]"

    @property
    def name(self) -> str:
        """Its name among the tables."""
        return f"{self.group} {self.number + 1} of {self.count}"

    def table(self, records: PaperRecords) -> "pd.DataFrame":
        """Return the table, computed when it is first asked for."""
        if self.name not in records.tables:
            records.tables[self.name] = self.make(records, self.number)
        return records.tables[self.name]
