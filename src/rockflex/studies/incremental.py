"""Incremental dynamic analysis: rising scales of every record until the structure overturns."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple, Unpack

from pydantic import Field, model_validator

from rockflex.foundation.checks import checked_in_range, checked_positive
from rockflex.foundation.errors import InputError
from rockflex.fragility._limit_states import OVERTURNING, check_limit_columns, limit_state_of
from rockflex.motion._measures import scalable_measure
from rockflex.studies._arguments import Models, Motions, Structures
from rockflex.studies._case_keys import FreeVibration, validator_of_check
from rockflex.studies._plan import CrossPlan
from rockflex.studies._result_tables import Columns, Row, Table, joined_tables
from rockflex.studies._run_matrix import StudyMatrix, check_base_can_lift
from rockflex.studies._run_plan import StudyKeywords, run_of_arguments
from rockflex.studies.spec import StructuresStudySpec

if TYPE_CHECKING:
    import pandas as pd


class ScaleSteps(NamedTuple):
    """The first and the last scale, each over the one before, and the width to which bisection narrows a boundary."""

    smallest: float
    largest: float
    growth: float
    tolerance: float


def rising_scales(smallest: float, largest: float, growth: float) -> list[float]:
    """Return scales from `smallest` to `largest`, each `growth` times the one before; the last step may be smaller."""
    count = math.ceil(math.log(largest / smallest) / math.log(growth) - 1e-9)
    return [*(smallest * growth**step for step in range(count)), largest]


def max_bisections_between_scales(growth: float, tolerance: float) -> int:
    """Return the largest number of bisections between two neighbouring grid_scales."""
    return max(0, math.ceil(math.log2((growth - 1.0) / tolerance)))


def max_bisections_below_scales(tolerance: float) -> int:
    """Return the largest number of bisections below the lowest scale, down to a thousandth of it."""
    return math.ceil(math.log2(1.0 / tolerance)) + 10


@dataclass
class ScaleLadder:
    """The runs of one structure under one record at rising scales.

    Overturning is not monotone: a structure may overturn at a scale and survive a larger one. Therefore all scales
    of the grid are run; bisection then narrows the first and the last boundary.

    `overturns` runs a scale, and returns None if the run could not be solved; `growth` is the ratio of neighbouring
    scales of the grid, `tolerance` the relative width of the boundaries found.
    """

    overturns: Callable[[float], bool | None]
    growth: float
    tolerance: float
    outcomes: dict[float, bool | None] = field(default_factory=dict[float, bool | None])
    """Whether it overturns at each scale, in rising order after the search."""

    def search(self, grid: Sequence[float]) -> None:
        """Run the scales of the grid, and bisect."""
        for scale in grid:
            self._try(scale)
        boundaries = self._boundaries()
        for stands, falls in dict.fromkeys((boundaries[0], boundaries[-1]) if boundaries else ()):
            self._bisect(stands, falls)
        self.outcomes = dict(sorted(self.outcomes.items()))

    def _try(self, scale: float) -> bool | None:
        self.outcomes[scale] = self.overturns(scale)
        return self.outcomes[scale]

    def _boundaries(self) -> list[tuple[float, float]]:
        """Return neighbouring scales of which the lower survives and the upper overturns; zero always survives."""
        known = [(0.0, False), *self._known.items()]
        return [(lower, upper) for (lower, fell), (upper, falls) in pairwise(known) if falls and not fell]

    def _bisect(self, stands: float, falls: float) -> None:
        steps = max_bisections_below_scales(self.tolerance)
        if stands > 0.0:
            steps = max_bisections_between_scales(self.growth, self.tolerance)
        for _ in range(steps):
            if falls - stands <= self.tolerance * falls:
                break
            middle = 0.5 * (stands + falls)
            fell = self._try(middle)
            if fell is None:
                break
            stands, falls = (stands, middle) if fell else (middle, falls)

    @property
    def _known(self) -> dict[float, bool]:
        return {scale: fell for scale, fell in self.outcomes.items() if fell is not None}

    def summary(self) -> Row:
        """Return what the outcomes of all scales say, by the names of its columns."""
        known = self._known
        falls = [scale for scale, fell in known.items() if fell]
        stands = [scale for scale, fell in known.items() if not fell]
        return {
            "first_overturning_scale": min(falls, default=None),
            "last_survival_scale": max(stands, default=None),
            "resurrections": sum(lower and not upper for lower, upper in pairwise(known.values())),
            "right_censored": not falls if known else None,
        }


MAX_SCALE_RATIO = 1e12  # the last scale over the first


class IncrementalStudy(StructuresStudySpec):
    """Incremental dynamic analysis (Vamvatsikos & Cornell 2002) of structures that overturn.

    The table has one row per run; its columns are those of `run_incremental`.

    Examples
    --------
    >>> import rockflex as rf
    >>> table = {"n_stories": 2, "story_height": 3.0, "story_mass": 40e3,
    ...     "base_mass": 40e3}
    >>> table |= {"stiffness_ratio": 1.0, "period": 0.5, "aspect_ratio": 8.0,
    ...     "damping_ratio": 0.02}
    >>> study = rf.IncrementalStudy(
    ...     structures=[{"name": "frame", "frame": table}],
    ...     records={"suites": ["el-centro-1940"]}, largest_scale=5.0
    ... )
    >>> round(study.plan().scales[1], 3)
    0.115
    """

    study: Literal["incremental"] = Field("incremental", description='"incremental"')
    free_vibration: FreeVibration = "settle"
    smallest_scale: float = Field(0.1, description="the first factor on the acceleration, a number")
    largest_scale: float = Field(20.0, description="the last factor on the acceleration, a number")
    growth: float = Field(1.15, description="each factor over the one before, a number above 1")
    tolerance: float = Field(0.01, description="the relative width to which bisection narrows a boundary, a number")
    limit: Annotated[str | float, validator_of_check(limit_state_of)] = Field(
        "overturning",
        description='a limit state, such as "overturning" (|θ| = π/2) or "max_ductility > 4", or a rotation in rad',
    )

    @model_validator(mode="after")
    def _ladder(self) -> "IncrementalStudy":
        check_scale_ladder(self.smallest_scale, self.largest_scale, self.growth, self.tolerance)
        return self

    def plan(self) -> "IncrementalPlan":
        """Build the structures, load the records, and divide the study into chunks.

        Raises
        ------
        InputError
            If a structure cannot be built, a record cannot be read, or a model's base cannot lift.
        """
        steps = ScaleSteps(self.smallest_scale, self.largest_scale, self.growth, self.tolerance)
        return IncrementalPlan(self.matrix(), steps, self.limit, self.runs_per_chunk)


class IncrementalPlan(CrossPlan):
    """A ladder of scales for every structure, record and model, divided into chunks."""

    exact_count = False
    units = "ladders"

    def __init__(self, matrix: StudyMatrix, steps: ScaleSteps, limit: str | float, runs_per_chunk: int) -> None:
        check_scale_ladder(*steps)
        check_base_can_lift(matrix, "a base that cannot lift, so nothing overturns it")
        self.steps, self.limit = steps, limit
        self.scales = rising_scales(steps.smallest, steps.largest, steps.growth)
        most = (
            len(self.scales)
            + max_bisections_between_scales(steps.growth, steps.tolerance)
            + max_bisections_below_scales(steps.tolerance)
        )
        self._most = most
        super().__init__(matrix, 1, max(1, runs_per_chunk // most))
        check_limit_columns([limit_state_of(limit)], self.columns)

    def scale(self, structure: int, record: int, level: int) -> float:  # noqa: ARG002
        """Return the first factor of every ladder."""
        return self.scales[0]

    @property
    def n_runs(self) -> int:
        """Upper bound of the number of runs: the number of bisections is only known after a ladder was run."""
        return self.n_units * self._most

    @property
    def columns(self) -> Columns:
        """Columns of every chunk's table."""
        base = dict(super().columns)
        error = base.pop("error")
        ladder = {"overturned": bool, "first_overturning_scale": float, "last_survival_scale": float}
        return base | ladder | {"resurrections": int, "right_censored": bool, "error": error}

    def results(self, units: Sequence[int]) -> Table:
        """Run one ladder a unit."""
        return joined_tables([self._ladder(unit) for unit in units])

    def _ladder(self, unit: int) -> dict[str, list[Any]]:
        structure, record, model, _ = self.run_of(unit)
        state, runs = limit_state_of(self.limit), dict[float, Any]()

        def overturns(scale: float) -> bool | None:
            runs[scale] = self.matrix.results([(structure, record, model, scale)])
            row = {name: values[0] for name, values in runs[scale].items()}
            return None if row["status"] is None else bool(OVERTURNING.exceeded(row) or state.exceeded(row))

        ladder = ScaleLadder(overturns, self.steps.growth, self.steps.tolerance)
        ladder.search(self.scales)
        found = joined_tables([runs[scale] for scale in ladder.outcomes])
        summary = {name: [value] * len(runs) for name, value in ladder.summary().items()}
        return {**found, "overturned": list(ladder.outcomes.values()), **summary}


def check_scale_ladder(smallest: float, largest: float, growth: float, tolerance: float) -> None:
    """Raise an InputError unless the scales form a ladder."""
    checked_positive("smallest_scale", smallest, "times the record")
    checked_positive("largest_scale", largest, "times the record")
    if not smallest < largest:
        raise InputError(f"largest_scale must be above smallest_scale, {smallest:g}, but {largest:g} was given.")
    if largest / smallest > MAX_SCALE_RATIO:
        raise InputError(
            f"largest_scale must be at most {MAX_SCALE_RATIO:g} times smallest_scale, {smallest:g}, but {largest:g} "
            "was given. Bring the two closer."
        )
    checked_in_range(
        "growth", growth, 1.0001, 100.0, hint="It is the factor from one scale to the next: 1.15 for 15 %."
    )
    checked_in_range("tolerance", tolerance, 1e-9, 0.5)


def run_incremental(
    structures: Structures,
    motions: Motions,
    models: Models = "MDOF-S",
    smallest_scale: float = 0.1,
    largest_scale: float = 20.0,
    growth: float = 1.15,
    tolerance: float = 0.01,
    limit: str | float = "overturning",
    **options: Unpack[StudyKeywords],
) -> "pd.DataFrame":
    """Scale every motion until it overturns the structure, and beyond, and return every run.

    All scales of a geometric grid are run, because a structure that a motion overturns may survive a stronger one.
    Bisection then narrows the first and the last boundary between survival and overturning. An island of scales
    narrower than a step of the grid can be missed.

    Parameters
    ----------
    structures, motions, models, options
        As in `run_cloud`; `progress` is counted in ladders: all runs of a structure, a record and a model.
    smallest_scale, largest_scale, growth
        First and last scale of the grid, and the ratio of each scale to the one before.
    tolerance
        Relative width of the boundaries.
    limit
        Name of a limit state: ``"overturning"``: |θ| reaches π/2; ``"nominal"``: it passes 0.7 atan(B/h*_1); or
        another one of ``rockflex.fragility.LIMIT_STATES``; a demand with its bound, such as ``"max_ductility > 4"``; or
        a rotation in rad. A run that overturns exceeds them all.

    Returns
    -------
    pandas.DataFrame
        One row per run, with rising scales for every structure, record and model. The columns of `run_cloud`, then
        `overturned` by the limit, and for the ladder of the run: `first_overturning_scale` (the smallest; missing if
        none), `last_survival_scale` (the largest; missing if none), `resurrections` (how often a run survives after
        the next smaller scale overturned) and `right_censored` (no scale up to `largest_scale` overturned).

    Raises
    ------
    InputError
        If the scales do not form a grid, a model's base cannot lift, or as in `run_cloud`.
    ClusterError
        As in `run_study`.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=0.8)
    >>> runs = rf.run_incremental(frame, pulse, "2DOF-S", growth=1.5,
    ...     tolerance=0.05)
    >>> round(float(runs["first_overturning_scale"].iloc[0]), 2)
    2.56
    """
    keys = {"smallest_scale": smallest_scale, "largest_scale": largest_scale, "growth": growth}
    keys |= {"tolerance": tolerance, "limit": limit}
    return run_of_arguments(IncrementalStudy, structures, motions, models, keys, options)


def incremental_capacities(runs: "pd.DataFrame", measure: str = "pga") -> "pd.DataFrame":
    """Intensities at which records overturn structures, one row per ladder, as input of `fit_capacities`.

    Parameters
    ----------
    runs
        The table of `run_incremental` or of an `IncrementalStudy`.
    measure
        Name of an intensity measure among its columns.

    Returns
    -------
    pandas.DataFrame
        `structure`, `motion`, `group`, `model`; `capacity`, the measure at the first scale that overturns, or, if
        `censored`, at the largest scale that survives; `first_overturning_scale`, `last_survival_scale`,
        `resurrections`; `failed`, the number of runs that could not be solved. `capacity` is missing if all failed.

    Raises
    ------
    InputError
        If the measure is unknown.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=0.8)
    >>> runs = rf.run_incremental({"A": frame}, pulse, "2DOF-S", growth=1.5,
    ...     tolerance=0.05)
    >>> rf.incremental_capacities(runs, "pga")[["structure", "model", "capacity",
    ...     "censored"]].round(2)
      structure   model  capacity  censored
    0         A  2DOF-S      7.69     False
    """
    scalable_measure(measure)
    import pandas as pd

    rows = []
    for _, ladder in runs.groupby(["structure", "motion", "model"], observed=True, sort=False):
        first = ladder.iloc[0]
        solved = ladder[ladder["overturned"].notna()]
        falls = solved[solved["overturned"].astype(bool)]
        last = falls.iloc[0] if len(falls) else (solved.iloc[-1] if len(solved) else None)
        row = {name: first[name] for name in ("structure", "motion", "group", "model")}
        row["capacity"] = math.nan if last is None else float(last[measure])
        row["censored"] = not len(falls)
        row |= {name: first[name] for name in ("first_overturning_scale", "last_survival_scale", "resurrections")}
        rows.append(row | {"failed": len(ladder) - len(solved)})
    return pd.DataFrame(rows)
