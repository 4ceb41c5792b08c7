"""Multiple stripes: every record scaled to each of a few intensities."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal, TypeAlias

from pydantic import Field

from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.fragility._limit_states import LimitState, limit_state_of
from rockflex.motion._measures import scalable_measure
from rockflex.studies._arguments import checked_positive_numbers
from rockflex.studies._plan import CrossPlan
from rockflex.studies._result_tables import Columns, Table
from rockflex.studies._run_matrix import StudyMatrix
from rockflex.studies.spec import LimitKeys, StructuresStudySpec

if TYPE_CHECKING:
    import pandas as pd


StripeLimit: TypeAlias = str | float | LimitState


class StripeStudy(LimitKeys, StructuresStudySpec):
    """Multiple-stripe analysis: every record is scaled to each level of an intensity measure.

    The table has the columns of `run_cloud` and the `level` of the stripe; `stripe_counts` counts its runs.

    Examples
    --------
    >>> import rockflex as rf
    >>> table = {"n_stories": 2, "story_height": 3.0, "story_mass": 40e3,
    ...     "base_mass": 40e3}
    >>> table |= {"stiffness_ratio": 1.0, "period": 0.5, "aspect_ratio": 8.0,
    ...     "damping_ratio": 0.02}
    >>> study = rf.StripeStudy(
    ...     structures=[{"name": "frame", "frame": table}],
    ...     records={"suites": ["el-centro-1940"]}, levels=[0.2, 0.4]
    ... )
    >>> rf.run_study(study)[["level", "pgv"]].round(3)
       level  pgv
    0    0.2  0.2
    1    0.4  0.4
    """

    study: Literal["stripes"] = Field("stripes", description='"stripes"')
    measure: str = Field("pgv", description='the intensity measure, such as "pga", "pgv" or "sa_t1_5"')
    levels: list[float] = Field(min_length=1, description="a list of levels of the measure, in SI units")

    def plan(self) -> "StripePlan":
        """Build the structures, load the records, and divide the study into chunks.

        Raises
        ------
        InputError
            If a structure cannot be built, a record cannot be read, the measure is unknown, a level is not positive,
            or a record cannot be scaled to it.
        """
        plan = StripePlan(self.matrix(), self.measure, self.levels, self.runs_per_chunk)
        self.check_limits(plan.columns)
        return plan


class StripePlan(CrossPlan):
    """The cross product of structures, records, models and levels, divided into chunks."""

    def __init__(self, matrix: StudyMatrix, measure: str, levels: Sequence[float], per_chunk: int) -> None:
        chosen = scalable_measure(measure)
        self.measure = measure  # the name, because a pickle cannot hold the measure
        self.levels = checked_positive_numbers("levels", levels, "")
        for structure, name in enumerate(matrix.names):
            for record, motion in enumerate(matrix.motions):
                if not math.isfinite(chosen.factor(matrix.measures(structure, record)[measure], 1.0)):
                    raise InputError(
                        f"{shown(motion.name)} has no {measure} for {shown(name)}, so no scale takes it to a level."
                    )
        super().__init__(matrix, len(self.levels), per_chunk)

    def scale(self, structure: int, record: int, level: int) -> float:
        """Return the factor that scales a record to a level of the measure."""
        value = self.matrix.measures(structure, record)[self.measure]
        return scalable_measure(self.measure).factor(value, self.levels[level])

    @property
    def columns(self) -> Columns:
        """Columns of every chunk's table."""
        return {"level": float, **super().columns}

    def results(self, units: Sequence[int]) -> Table:
        """Simulate one run a unit."""
        return {**super().results(units), "level": [self.levels[unit % len(self.levels)] for unit in units]}


def stripe_counts(runs: "pd.DataFrame", limit: StripeLimit = "overturning") -> "pd.DataFrame":
    """Count the runs of each stripe that exceed a limit, as input of `fit_stripes`.

    Parameters
    ----------
    runs
        The table of a `StripeStudy`.
    limit
        Name of a limit state: ``"overturning"`` (|θ| = π/2), ``"nominal"`` (|θ| > 0.7 atan(B/h*_1)),
        ``"tendon_yield"``, ``"uplift"``, or another of ``rockflex.fragility.LIMIT_STATES``; a demand with its
        bound, such as ``"max_ductility > 4"``; a rotation in rad; or a limit state such as
        ``rockflex.fragility.residual_rotation_limit_state(0.005)``.

    Returns
    -------
    pandas.DataFrame
        One row per structure, model and level: `structure`, `model`, `level`, `n_exceeding`, `n_total`. Runs that could
        not be solved are not counted.

    Raises
    ------
    InputError
        If the limit is another word, or not positive.

    Examples
    --------
    >>> import rockflex as rf
    >>> table = {"n_stories": 2, "story_height": 3.0, "story_mass": 40e3,
    ...     "base_mass": 40e3}
    >>> table |= {"stiffness_ratio": 1.0, "period": 0.5, "aspect_ratio": 8.0,
    ...     "damping_ratio": 0.02}
    >>> study = rf.StripeStudy(
    ...     structures=[{"name": "frame", "frame": table}],
    ...     records={"suites": ["el-centro-1940"]}, levels=[0.2, 0.4]
    ... )
    >>> rf.stripe_counts(rf.run_study(study),
    ...     "uplift")[["level", "n_exceeding", "n_total"]]
       level  n_exceeding  n_total
    0    0.2            1        1
    1    0.4            1        1
    """
    solved, state = runs[runs["status"].notna()], limit_state_of(limit)
    counted = solved.assign(exceeds=state.exceeded(solved).astype(bool)).groupby(
        ["structure", "model", "level"], observed=True
    )
    return counted["exceeds"].agg(n_exceeding="sum", n_total="size").reset_index()
