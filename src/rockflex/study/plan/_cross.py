"""Plans of every structure under every record with every model, at a few levels of shaking."""

from abc import abstractmethod
from collections.abc import Sequence

from rockflex.study._tables import Columns, Row
from rockflex.study.plan._bench import Bench
from rockflex.study.plan._chunked import ChunkedPlan


class CrossPlan(ChunkedPlan):
    """The cross product of structures, records, models and `n_levels` levels, one unit each, divided into chunks."""

    def __init__(self, bench: Bench, n_levels: int, per_chunk: int) -> None:
        self.bench, self._n_levels = bench, n_levels
        n_units = len(bench.names) * len(bench.motions) * len(bench.labels) * n_levels
        super().__init__(bench.motions, n_units, per_chunk)

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
        return self.bench.columns

    def rows(self, units: Sequence[int]) -> list[Row]:
        """Simulate one run a unit."""
        return self.bench.run_all([self.run_of(unit) for unit in units])

    def check_work(self) -> None:
        """Refuse a study if every run exceeds its work limit.

        Raises
        ------
        InputError
            If no run is within its work limit.
        """
        self.bench.check_work(map(self.run_of, range(self.n_units)))

    def run_of(self, unit: int) -> tuple[int, int, int, float]:
        """Return the places of the structure, record and model of a unit, and the scale of its (first) run."""
        rest, level = divmod(unit, self._n_levels)
        rest, model = divmod(rest, len(self.bench.labels))
        structure, record = divmod(rest, len(self.bench.motions))
        return structure, record, model, self.scale(structure, record, level)
