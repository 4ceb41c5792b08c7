"""The search for the cheapest design: the values given, then a few designs for each refinement."""

from collections.abc import Callable, Iterable, Sequence
from copy import copy
from itertools import accumulate, pairwise, product
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import NDArray

from rockflex.foundation.arrays import Array
from rockflex.foundation.errors import InputError
from rockflex.fragility._limit_states import check_limit_columns
from rockflex.structure._rocking import RockingProperties
from rockflex.studies._arguments import checked_scale_factors
from rockflex.studies._plan import ChunkedPlan
from rockflex.studies._result_tables import Columns, Table
from rockflex.studies._run_matrix import Run, StudyMatrix, check_base_can_lift
from rockflex.studies.design._designs import VARIABLES, DesignSearch, Point, facts_of_design, total_dissipator_force
from rockflex.studies.design._exceedance_fit import check_hazard_damping, design_limit_state, first_damping_column
from rockflex.studies.design._requirements import (
    DesignCost,
    Requirement,
    requirement_margins,
    requirement_values,
)

if TYPE_CHECKING:
    import pandas as pd


CHUNK = 5_000  # points at once
SMOOTHINGS = (1e-6, 1e-3, 1e-2, 0.1, 1.0, 10.0)

Costs = Callable[[Array], Array]
Integer = NDArray[np.intp]


class MarginSurface:
    """Smoothed thin-plate splines through the margins of the designs tried, one for each requirement.

    Coordinates are counted in steps between the values that were given, so that the surface does not depend on units.
    The smoothing of each spline is the one with the smallest error where each design is left out in turn (Wahba 1990,
    Spline Models for Observational Data, Chapter 4).

    `steps`, shape (n, d), are the coordinates of the designs in the variables that are varied; `margins` has the shape
    (n, m). Designs without a margin are left out; an `InputError` says if too few are left.
    """

    def __init__(self, steps: Array, margins: Array) -> None:
        known = np.isfinite(margins).all(axis=1)
        self._centres, values = steps[known], margins[known]
        n, d = self._centres.shape
        tail = np.column_stack((np.ones(n), self._centres))
        if n <= d + 1 or np.linalg.matrix_rank(tail) <= d:
            raise InputError(
                f"Only {int(known.sum())} of {known.size} designs have all probabilities, too few to interpolate "
                "between them."
            )
        system = np.zeros((n + d + 1, n + d + 1))
        system[:n, n:], system[n:, :n] = tail, tail.T
        bending = _thin_plate_bending(self._centres, self._centres)
        padded = np.vstack((values, np.zeros((d + 1, values.shape[1]))))
        least = np.full(values.shape[1], np.inf)
        self._weights = np.zeros_like(padded)
        for smoothing in SMOOTHINGS:
            system[:n, :n] = bending + smoothing * np.eye(n)
            inverse = np.linalg.pinv(system)
            weights = inverse @ padded
            left_out = ((weights[:n] / np.diag(inverse)[:n, None]) ** 2).sum(axis=0)
            better = left_out < least
            least[better], self._weights[:, better] = left_out[better], weights[:, better]

    def margins(self, steps: Array) -> Array:
        """Margins at other coordinates, shape (k, m)."""
        return np.concatenate([self._at(steps[start : start + CHUNK]) for start in range(0, len(steps), CHUNK)])

    def _at(self, steps: Array) -> Array:
        rows = np.column_stack((_thin_plate_bending(steps, self._centres), np.ones(len(steps)), steps))
        return rows @ self._weights


def _thin_plate_bending(steps: Array, centres: Array) -> Array:
    """r² log r between two sets of coordinates."""
    squares = ((steps[:, None, :] - centres[None, :, :]) ** 2).sum(axis=2)
    return 0.5 * squares * np.log(np.where(squares > 0.0, squares, 1.0))


def next_search_points(
    search: DesignSearch, level: int, tried: Sequence[Point], margins: Array, costs: Costs
) -> list[Point]:
    """Points that a refinement tries, in the order of their number; `costs` are those of values of the variables.

    One half are the cheapest designs that are expected to meet all targets, and that are the cheapest for one value of
    a variable. The other half are those among them that are farthest from all designs tried, so that the trade-off is
    known in its whole range. If there are too few, those that are expected to meet or miss the targets by the least
    follow. Where no design is expected to meet the targets, they are the closest to doing so.
    """
    axes, most = search.varied, search.designs_per_refinement
    points = np.array([*product(*search.grid(level))])
    scale = 2.0**search.refinements
    seen = np.array(tried)
    try:
        surface = MarginSurface(seen[:, axes] / scale, margins)
    except InputError:
        return []
    worst = surface.margins(points[:, axes] / scale).max(axis=1)
    cost = costs(search.at(points))
    new = ~np.isin(_search_point_codes(points), _search_point_codes(seen))
    meets = worst <= 0.0
    if not meets.any():
        order = np.lexsort((cost, worst))
        return _search_point_tuples(points[order[new[order]][:most]])
    front = np.unique(
        np.concatenate([_cheapest_point_of_each(points[:, axis], np.where(meets, cost, np.inf)) for axis in axes])
    )
    front = front[new[front] & meets[front]]
    front = front[np.argsort(cost[front], kind="stable")]
    chosen = [int(place) for place in front[: -(-most // 2)]]
    rest = [int(place) for place in front[len(chosen) :]]
    while rest and len(chosen) < most:
        known = np.concatenate([seen, points[chosen]])
        apart = [float(np.abs(known - points[place]).max(axis=1).min()) for place in rest]
        chosen.append(rest.pop(int(np.argmax(apart))))
    new[chosen] = False
    nearest = np.lexsort((cost, np.abs(worst)))
    chosen += [int(place) for place in nearest[new[nearest]][: most - len(chosen)]]
    return _search_point_tuples(points[chosen])


def _cheapest_point_of_each(values: Integer, cost: Array) -> Integer:
    """Place of the least cost among the points of each value."""
    order = np.lexsort((cost, values))
    return order[np.unique(values[order], return_index=True)[1]]


def _search_point_codes(points: Integer) -> Integer:
    """A number for each point; no grid reaches 2^20."""
    return points[:, 0] * 2**40 + points[:, 1] * 2**20 + points[:, 2]


def _search_point_tuples(points: Integer) -> list[Point]:
    found = [(int(b), int(tendon), int(dissipator)) for b, tendon, dissipator in points]
    return sorted(found)


FACTS = (*VARIABLES, "aspect_ratio", "prestress", "dissipator_force", "prestress_ratio", "resisting_moment")


class DesignSearchPlan(ChunkedPlan):
    """A search in rounds: each unit is a design under all records at all scales.

    The number of units is fixed. A unit of a refinement stays empty if there are fewer designs worth trying.
    """

    exact_count = False
    units = "designs"

    def __init__(
        self,
        matrix: StudyMatrix,
        search: DesignSearch,
        requirements: Sequence[Requirement],
        cost: DesignCost,
        scales: Sequence[float],
        runs_per_chunk: int,
    ) -> None:
        check_base_can_lift(matrix, "a fixed base, so the base width has no effect")
        if len(matrix.labels) != 1:
            raise InputError(f"models: a search needs one model, but {', '.join(matrix.labels)} were given.")
        (self.structure,) = matrix.structures
        search.check_elements(self.structure)
        self.search, self.requirements, self.cost = search, list(requirements), cost
        for each in self.requirements:
            check_hazard_damping(each.hazard, first_damping_column(self.structure), each.measure)
        self.scales = checked_scale_factors(scales, max(matrix.motions, key=lambda motion: motion.pga))
        self._each = len(matrix.motions) * len(self.scales)
        super().__init__(matrix.motions, search.n_designs, max(1, runs_per_chunk // self._each))
        self._empty = matrix
        self._start_round(0, search.first())
        for point, properties in zip(search.first(), self._matrix.structures, strict=True):
            self._check_limits(point, properties)

    def _start_round(self, number: int, points: Sequence[Point]) -> None:
        self.round, self.points = number, list(points)
        names = [f"design {self._first_unit(number) + place + 1}" for place in range(len(self.points))]
        built = {name: self.search.built(self.structure, point) for name, point in zip(names, self.points, strict=True)}
        self._matrix = StudyMatrix(built, self._empty.motions, self._empty.options)

    def _check_limits(self, point: Point, properties: RockingProperties) -> None:
        for each in self.requirements:
            try:
                state = design_limit_state(each.limit, properties.nominal_overturning_rotation)
                check_limit_columns([state], self._empty.columns)
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

    def next_round(self, table: "pd.DataFrame") -> Self:
        """Return the plan of the next round, from the table of this and the earlier rounds."""
        following = copy(self)
        known = table[table["round"] <= self.round]
        designs = [rows for _, rows in known.groupby("structure", observed=True, sort=False)]
        margins = requirement_margins(requirement_values(designs, self.requirements), self.requirements)
        values = np.array([rows[[*VARIABLES]].iloc[0].to_numpy(float) for rows in designs])
        points = next_search_points(self.search, self.round + 1, self.search.points_of(values), margins, self.costs)
        following._start_round(self.round + 1, points)
        return following

    def costs(self, values: Array) -> Array:
        """Cost of designs from the values of their variables, shape (n, 3)."""
        prestress = self.structure.prestress * values[:, 1]
        return self.cost.of(values[:, 0], prestress, total_dissipator_force(self.structure) * values[:, 2])

    @property
    def columns(self) -> Columns:
        """Columns of every chunk's table."""
        names = [f"design {unit + 1}" for unit in range(self.n_units)]
        found = dict(self._empty.columns) | {"structure": names}
        return {"structure": found.pop("structure"), "round": int, **dict.fromkeys(FACTS, float), **found}

    def results(self, units: Sequence[int]) -> Table:
        """Simulate all runs of a design a unit; none if the round has no such design."""
        first = self._first_unit(self.round)
        designs = [unit - first for unit in units if 0 <= unit - first < len(self.points)]
        found = self._matrix.results(self._runs_of(designs))
        facts = {place: {"structure": first + place, "round": self.round, **self._facts_of(place)} for place in designs}
        names = ("structure", "round", *FACTS) if designs else ()
        return {**found, **{name: [facts[each][name] for each in found["structure"]] for name in names}}

    def _runs_of(self, designs: Iterable[int]) -> list[Run]:
        return [*self._matrix.cross(self.scales, designs)]

    def _facts_of(self, place: int) -> dict[str, Any]:
        p = self._matrix.structures[place]
        variables = dict(zip(VARIABLES, map(float, self.search.at(self.points[place])[0]), strict=True))
        forces = {"prestress": p.prestress, "dissipator_force": total_dissipator_force(p)}
        return facts_of_design(p) | variables | forces

    def check_work(self) -> None:
        """Refuse a search if every run of its first round exceeds its work limit."""
        self._matrix.check_work(self._runs_of(range(len(self.points))))
