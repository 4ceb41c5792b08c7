"""Multiple stripes: every record scaled to each of a few intensities, or records of its own at each."""

import math
from collections.abc import Iterable, Mapping, Sequence
from difflib import get_close_matches
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self, TypeAlias, cast

from pydantic import BeforeValidator, Field, model_validator

from rockflex.foundation.descriptions import PLAIN, Described
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.fragility._limit_states import LimitState, limit_state_of
from rockflex.motion._measures import scalable_measure
from rockflex.motion._suite import Selection
from rockflex.structure.file._toml_table import TomlTable
from rockflex.studies._arguments import checked_positive_numbers, checked_scale_factors
from rockflex.studies._plan import CrossPlan
from rockflex.studies._result_tables import Columns, Table
from rockflex.studies._run_matrix import StudyMatrix, check_different_values
from rockflex.studies.spec import LimitKeys, StructuresStudySpec

if TYPE_CHECKING:
    import pandas as pd


StripeLimit: TypeAlias = str | float | LimitState


class Stripe(TomlTable):
    """A stripe with records of its own: its level, and the names of its records, or their factors by name."""

    level: Annotated[float, Described("the level of the measure, in SI units", form=PLAIN)]
    records: Annotated[
        list[str] | dict[str, float],
        Described('a list of names among the records of the study, or a table of factors, such as {"FF-1-a" = 1.4}'),
    ]


def _stripes_of_python(given: Any) -> Any:
    """Return the tables of stripes, from selections, motions or names by level."""
    if not isinstance(given, Mapping):
        return given
    return [
        {"level": level, "records": _records_of_python(records)}
        for level, records in cast("Mapping[Any, Any]", given).items()
    ]


def _records_of_python(given: Any) -> Any:
    if isinstance(given, Selection):
        pairs = zip(given.names, given.factors.tolist(), strict=True)
        return {name: factor for names, factor in pairs for name in names}
    if isinstance(given, Mapping):
        return dict(cast("Mapping[str, Any]", given))
    if isinstance(given, Iterable) and not isinstance(given, str):
        return [getattr(each, "name", each) for each in cast("Iterable[Any]", given)]
    return given


class StripeStudy(LimitKeys, StructuresStudySpec):
    """Multiple-stripe analysis: records at each of a few levels of an intensity measure.

    With `levels` every record is scaled to each of them. With `stripes` each level has records of its own, and any
    number of them, as chosen for the hazard at that level: a list of names, whose records are scaled to the level, or
    factors by name, which are used as they are. In Python `stripes` may also be a mapping from levels to a `Selection`,
    whose factors are used, to names or to motions; `records` has all that are named, unscaled.

    The table has the columns of `run_cloud` and the `level` of the stripe; `stripe_counts` counts its runs.

    Examples
    --------
    >>> import rockflex as rf
    >>> table = {"n_stories": 2, "story_height": 3.0, "story_mass": 40e3,
    ...     "base_mass": 40e3}
    >>> table |= {"stiffness_ratio": 1.0, "period": 0.5, "aspect_ratio": 8.0,
    ...     "damping_ratio": 0.02}
    >>> structures = [{"name": "frame", "frame": table}]
    >>> study = rf.StripeStudy(structures=structures,
    ...     records={"suites": ["el-centro-1940"]}, levels=[0.2, 0.4])
    >>> rf.run_study(study)[["level", "pgv"]].round(3)
       level  pgv
    0    0.2  0.2
    1    0.4  0.4

    Other records at each level, and more of them where more is at stake:

    >>> suite = rf.load_suite("fema-p695-far-field")
    >>> study = rf.StripeStudy(structures=structures, records=suite,
    ...     stripes={0.2: suite.names[:2], 0.4: {"FF-3-a": 0.7}})
    >>> rf.run_study(study)[["level", "motion", "scale", "pgv"]].round(3)
       level  motion  scale    pgv
    0    0.2  FF-1-a  0.339  0.200
    1    0.2  FF-1-b  0.319  0.200
    2    0.4  FF-3-a  0.700  0.395
    """

    study: Literal["stripes"] = Field("stripes", description='"stripes"')
    measure: str = Field("pgv", description='the intensity measure, such as "pga", "pgv" or "sa_t1_5"')
    levels: list[float] | None = Field(
        None, min_length=1, description="a list of levels of the measure, in SI units (default: those of the stripes)"
    )
    stripes: Annotated[list[Stripe] | None, BeforeValidator(_stripes_of_python)] = Field(
        None, min_length=1, description="tables [[stripes]] with records of their own, instead of levels"
    )

    @model_validator(mode="after")
    def _levels_or_stripes(self) -> Self:
        if (self.levels is None) == (self.stripes is None):
            raise InputError(
                "a study of stripes needs levels, to which every record is scaled, or stripes, tables of a level and "
                "its own records: give one of them."
            )
        return self

    def plan(self) -> "StripePlan":
        """Build the structures, load the records, and divide the study into chunks.

        Raises
        ------
        InputError
            If a structure cannot be built, a record cannot be read or is not among those of the study, the measure is
            unknown, a level is not positive, or a record cannot be scaled to it.
        """
        if self.stripes is None:
            plan = StripePlan(self.matrix(), self.measure, self.levels or [], self.runs_per_chunk)
        else:
            plan = OwnStripePlan(self.matrix(), self.measure, self.stripes, self.runs_per_chunk)
        self.check_limits(plan.columns)
        return plan


class StripePlan(CrossPlan):
    """The cross product of structures, records, models and levels, divided into chunks."""

    def __init__(self, matrix: StudyMatrix, measure: str, levels: Sequence[float], per_chunk: int) -> None:
        scalable_measure(measure)
        self.measure = measure  # the name, because a pickle cannot hold the measure
        self.levels = checked_positive_numbers("levels", levels, "")
        super().__init__(matrix, len(self.levels), per_chunk)
        self._check_scalable(range(len(matrix.motions)))

    def _check_scalable(self, records: Iterable[int]) -> None:
        """Refuse records that no factor takes to a level."""
        chosen, matrix = scalable_measure(self.measure), self.matrix
        for structure, name in enumerate(matrix.names):
            for record in records:
                if not math.isfinite(chosen.factor(matrix.measures(structure, record)[self.measure], 1.0)):
                    raise InputError(
                        f"{shown(matrix.motions[record].name)} has no {self.measure} for {shown(name)}, so no scale "
                        "takes it to a level."
                    )

    def scale(self, structure: int, record: int, level: int) -> float:
        """Return the factor that scales a record to a level of the measure."""
        value = self.matrix.measures(structure, record)[self.measure]
        return scalable_measure(self.measure).factor(value, self.levels[level])

    def level_of(self, unit: int) -> float:
        """Return the level of a unit."""
        return self.levels[unit % len(self.levels)]

    @property
    def columns(self) -> Columns:
        """Columns of every chunk's table."""
        return {"level": float, **super().columns}

    def results(self, units: Sequence[int]) -> Table:
        """Simulate one run a unit."""
        return {**super().results(units), "level": [self.level_of(unit) for unit in units]}


class OwnStripePlan(StripePlan):
    """Structures, levels with records of their own, and models, in this order, divided into chunks."""

    def __init__(self, matrix: StudyMatrix, measure: str, stripes: Sequence[Stripe], per_chunk: int) -> None:
        places = {name: place for place, name in enumerate(matrix.motions.names)}
        self._points = list[tuple[int, int, float | None]]()  # record, level and factor, None for that of the level
        for level, stripe in enumerate(stripes):
            where = f"stripes at the level {stripe.level:g}"
            names = list(stripe.records)
            if not names:
                raise InputError(f"{where}: no record is named.", field="stripes")
            check_different_values(where, names)
            unknown = [name for name in names if name not in places]
            if unknown:
                near = get_close_matches(unknown[0], places, n=3, cutoff=0.4) or list(places)[:3]
                raise InputError(
                    f"{where}: {shown(unknown[0])} is not among the records of the study. The nearest names are "
                    f"{', '.join(map(shown, near))}.",
                    field="stripes",
                )
            if isinstance(stripe.records, dict):
                checked_scale_factors(list(stripe.records.values()), max(matrix.motions, key=lambda each: each.pga))
                self._points += [(places[name], level, factor) for name, factor in stripe.records.items()]
            else:
                self._points += [(places[name], level, None) for name in names]
        check_different_values("the levels of stripes", [f"{stripe.level:g}" for stripe in stripes])
        super().__init__(matrix, measure, [stripe.level for stripe in stripes], per_chunk)
        self.n_units = len(matrix.names) * len(self._points) * len(matrix.labels)

    def _check_scalable(self, records: Iterable[int]) -> None:  # noqa: ARG002
        super()._check_scalable({record for record, _, factor in self._points if factor is None})

    def level_of(self, unit: int) -> float:
        """Return the level of a unit."""
        return self.levels[self._points[unit // len(self.matrix.labels) % len(self._points)][1]]

    def run_of(self, unit: int) -> tuple[int, int, int, float]:
        """Return the places of the structure, record and model of a unit, and the scale of its run."""
        rest, model = divmod(unit, len(self.matrix.labels))
        structure, point = divmod(rest, len(self._points))
        record, level, factor = self._points[point]
        return structure, record, model, self.scale(structure, record, level) if factor is None else factor


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
