"""The runs of a search: the values given, then a few designs for each refinement."""

from collections.abc import Iterator, Sequence
from copy import copy
from itertools import accumulate, pairwise, product
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from rockflex._arrays import Array
from rockflex._constants import GRAVITY
from rockflex._errors import InputError
from rockflex.modal import RockingProperties
from rockflex.study._arguments import factors_of
from rockflex.study._tables import Columns, Row
from rockflex.study.design._fit import check_damping, first_damping
from rockflex.study.design._limits import state_of
from rockflex.study.design.search._cost import DesignCost
from rockflex.study.design.search._requirement import Requirement, margins_of, values_of
from rockflex.study.design.search._space import VARIABLES, DesignSearch, Point, dissipator_force_of
from rockflex.study.design.search._surface import next_points
from rockflex.study.plan._bench import Bench, check_lifts
from rockflex.study.plan._chunked import ChunkedPlan

if TYPE_CHECKING:
    import pandas as pd

FACTS = (*VARIABLES, "aspect_ratio", "prestress", "dissipator_force", "prestress_ratio", "resisting_moment")


class SearchPlan(ChunkedPlan):
    """A search in rounds: each unit is a design under all records at all scales.

    The number of units is fixed. A unit of a refinement stays empty if there are fewer designs worth trying.
    """

    exact_count = False
    units = "designs"

    def __init__(
        self,
        bench: Bench,
        search: DesignSearch,
        requirements: Sequence[Requirement],
        cost: DesignCost,
        scales: Sequence[float],
        runs_per_chunk: int,
    ) -> None:
        check_lifts(bench, "a fixed base, so the base width has no effect")
        if len(bench.labels) != 1:
            raise InputError(f"models: a search needs one model, but {', '.join(bench.labels)} were given.")
        (self.structure,) = bench.structures
        search.check_elements(self.structure)
        self.search, self.requirements, self.cost = search, list(requirements), cost
        for each in self.requirements:
            check_damping(each.hazard, first_damping(self.structure), each.measure)
        self.scales = factors_of(scales, max(bench.motions, key=lambda motion: motion.pga))
        self._each = len(bench.motions) * len(self.scales)
        super().__init__(bench.motions, search.n_designs, max(1, runs_per_chunk // self._each))
        self._empty = bench
        self._start_round(0, search.first())
        for point, properties in zip(search.first(), self._bench.structures, strict=True):
            self._check_limits(point, properties)

    def _start_round(self, number: int, points: Sequence[Point]) -> None:
        self.round, self.points = number, list(points)
        names = [f"design {self._first_unit(number) + place + 1}" for place in range(len(self.points))]
        built = {name: self.search.built(self.structure, point) for name, point in zip(names, self.points, strict=True)}
        self._bench = Bench(built, self._empty.motions, self._empty.options)

    def _check_limits(self, point: Point, properties: RockingProperties) -> None:
        for each in self.requirements:
            try:
                state_of(each.limit, properties.nominal_overturning_rotation)
            except InputError as error:
                raise InputError(f"B = {self.search.at(point)[0, 0]:.6g} m: {error}") from error

    def _first_unit(self, number: int) -> int:
        return self.search.n_first + (number - 1) * self.search.designs_per_refinement if number else 0

    @property
    def n_runs(self) -> int:
        """Upper bound of the number of runs."""
        return self.n_units * self._each

    @property
    def n_ready(self) -> int:
        """Number of units that are known before anything was run."""
        return self.search.n_first

    @property
    def rounds(self) -> list[range]:
        """Numbers of the chunks of each round."""
        counts = [self.search.n_first] + [self.search.designs_per_refinement] * self.search.refinements
        ends = accumulate((-(-count // self.per_chunk) for count in counts), initial=0)
        return [range(start, end) for start, end in pairwise(ends)]

    def units_of(self, number: int) -> range:
        """Units of a chunk, all of one round."""
        place = next(place for place, numbers in enumerate(self.rounds) if number in numbers)
        first, last = self._first_unit(place), self._first_unit(place + 1)
        start = first + (number - self.rounds[place].start) * self.per_chunk
        return range(start, min(start + self.per_chunk, last))

    def informed(self, table: "pd.DataFrame") -> Self:
        """Return the plan of the next round, from the table of this and the earlier rounds."""
        following = copy(self)
        known = table[table["round"] <= self.round]
        designs = [rows for _, rows in known.groupby("structure", observed=True, sort=False)]
        margins = margins_of(values_of(designs, self.requirements), self.requirements)
        values = np.array([rows[[*VARIABLES]].iloc[0].to_numpy(float) for rows in designs])
        points = next_points(self.search, self.round + 1, self.search.points_of(values), margins, self.costs)
        following._start_round(self.round + 1, points)
        return following

    def costs(self, values: Array) -> Array:
        """Cost of designs from the values of their variables, shape (n, 3)."""
        prestress = self.structure.prestress * values[:, 1]
        return self.cost.of(values[:, 0], prestress, dissipator_force_of(self.structure) * values[:, 2])

    @property
    def columns(self) -> Columns:
        """Columns of every chunk's table."""
        names = [f"design {unit + 1}" for unit in range(self.n_units)]
        found = dict(self._empty.columns) | {"structure": names}
        return {"structure": found.pop("structure"), "round": int, **dict.fromkeys(FACTS, float), **found}

    def rows(self, units: Sequence[int]) -> list[Row]:
        """Simulate all runs of a design a unit; none if the round has no such design."""
        return [row for unit in units for row in self._runs_of(unit)]

    def _runs_of(self, unit: int) -> Iterator[Row]:
        place = unit - self._first_unit(self.round)
        if not 0 <= place < len(self.points):
            return
        facts = {"structure": unit, "round": self.round} | self._facts_of(place)
        runs = [(place, record, 0, scale) for record, scale in product(range(len(self.motions)), self.scales)]
        for row in self._bench.run_all(runs):
            yield row | facts

    def _facts_of(self, place: int) -> dict[str, Any]:
        p = self._bench.structures[place]
        height = float(p.effective_height[0]) if p.n_modes else p.l0r / p.m_tot
        return {
            **dict(zip(VARIABLES, map(float, self.search.at(self.points[place])[0]), strict=True)),
            "aspect_ratio": height / p.half_width,
            "prestress": p.prestress,
            "dissipator_force": dissipator_force_of(p),
            "prestress_ratio": p.prestress / (p.m_tot * GRAVITY),
            "resisting_moment": p.resisting_moment,
        }

    def check_work(self) -> None:
        """Refuse a search if every run of its first round exceeds its work limit.

        Raises
        ------
        InputError
            If no run is within its work limit.
        """
        places = range(len(self.points)), range(len(self.motions)), self.scales
        self._bench.check_work((place, record, 0, scale) for place, record, scale in product(*places))
