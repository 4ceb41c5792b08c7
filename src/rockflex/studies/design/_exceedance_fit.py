"""Limits of a design, the fit of its probability or annual rate, and the confidence band."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockflex.foundation.arrays import Array, Bools
from rockflex.foundation.checks import checked_in_range, checked_positive, real_or_nan
from rockflex.foundation.errors import InputError, SolverError
from rockflex.foundation.language import translated
from rockflex.foundation.shown import shown
from rockflex.fragility._annual_rate import annual_rate, hazard_quadrature
from rockflex.fragility._bootstrap import bootstrap_weights, resampled_exceedance
from rockflex.fragility._hazard import HazardCurve, measure_damping_of_runs
from rockflex.fragility._limit_states import (
    LIMIT_STATES,
    NOMINAL,
    OVERTURNED,
    OVERTURNING,
    ROCKED,
    LimitState,
    bounded_demand,
    rotation_limit_state,
)
from rockflex.fragility._logistic import LogisticFit, UnanimousOutcome, fit_logistic
from rockflex.fragility._outcomes import RotationFragility, fit_outcomes
from rockflex.motion._measures import scalable_measure
from rockflex.structure._rocking import RockingProperties

if TYPE_CHECKING:
    import pandas as pd


def check_design_limit(limit: float | str) -> None:
    """Raise an InputError unless a limit is one of those that `design_limit_state` knows."""
    design_limit_state(limit, 0.1)


def check_measure_of_record_alone(measure: str) -> None:
    """Raise an InputError unless the measure exists and does not depend on the base."""
    if scalable_measure(measure).of_what == "base":
        raise InputError(
            f"measure must not depend on the base, as a level of {measure} does. Give pgv, pga or sa_t1_5."
        )


def design_limit_state(limit: float | str, nominal: float) -> LimitState:
    """Limit state of a limit, where `nominal` is 0.7 atan(B/h*_1) of the design.

    A rotation in rad; a multiple of the nominal one; the name of a limit state; or a result with its bound, such as
    ``"max_base_moment > 5e6"`` or ``"max_ductility > 4"``, which an overturned run exceeds too.
    """
    words = limit.split() if isinstance(limit, str) else []
    if words == [OVERTURNING.name]:
        return OVERTURNING
    if len(words) == 1 and words[0] in LIMIT_STATES and words[0] != NOMINAL.name:
        return LIMIT_STATES[words[0]]
    state = bounded_demand(limit)
    if state is not None and state.column != "max_rotation":
        return state
    given = limit if state is None else float(words[2])
    return rotation_limit_state(_limit_rotation(given, nominal, words if state is None else []))


def is_rotation_limit_state(state: LimitState) -> bool:
    """Whether a state is a rotation whose probability `fit_outcomes` gives."""
    return ROCKED <= state.threshold <= OVERTURNED


def _limit_rotation(limit: float | str, nominal: float, words: list[str]) -> float:
    rotation = real_or_nan(limit)
    if words and words[-1] == NOMINAL.name and len(words) <= 2:
        try:
            rotation = nominal * float(words[0] if len(words) == 2 else 1.0)
        except ValueError:
            rotation = math.nan
    if not ROCKED <= rotation < OVERTURNED:
        is_of = f" ({rotation:.3g} rad)" if words and math.isfinite(rotation) else ""
        raise InputError(
            f"limit must be a rotation from {ROCKED:g} rad to below π/2, a multiple of 0.7 atan(B/h*_1) such as "
            f'"nominal" or "0.5 nominal" in the same range, a limit state ({", ".join(LIMIT_STATES)}), or a result '
            f'with its bound, such as "max_base_moment > 5e6", but {shown(limit)}{is_of} was given.'
        )
    return rotation


def check_exceedance_table(table: "pd.DataFrame", names: Iterable[str], origin: str) -> None:
    """Raise an InputError unless a table has rows and these columns; it is what the function `origin` returns."""
    lacking = [name for name in names if name not in table]
    if lacking or not len(table):
        lacks = f"lacks {', '.join(lacking)}" if lacking else "has no rows"
        raise InputError(f"The table {lacks}. Give what {origin} returned.")


def check_confidence(confidence: float) -> None:
    """Raise an InputError unless a confidence is in [0, 1)."""
    checked_in_range("confidence", confidence, 0.0, 1.0, hint="A 90 % band is 0.9.")


def check_hazard_damping(hazard: HazardCurve | None, runs: "pd.DataFrame", measure: str) -> None:
    """Raise an InputError if a spectral measure of runs, with the column `zeta_1`, is not at the damping of a curve."""
    if hazard is not None:
        hazard.check_damping(measure_damping_of_runs(runs, measure))


def first_damping_column(structure: RockingProperties) -> "pd.DataFrame":
    """The column `zeta_1` that the runs of a structure will have."""
    import pandas as pd

    return pd.DataFrame({"zeta_1": structure.zeta[:1]})


@dataclass(frozen=True)
class ShakingLevel:
    """The strength of the shaking: a level of the measure, or a hazard curve.

    The result for a curve P is the sum of P at `nodes` times `weights`.
    """

    hazard: HazardCurve | None
    nodes: Array
    weights: Array

    def exceedance(self, curve: LogisticFit | UnanimousOutcome | RotationFragility) -> tuple[float, float]:
        """Probability at the level and zero, or annual rate and an upper bound on the rate beyond the hazard curve."""
        if self.hazard is not None:
            found = annual_rate(self.hazard, curve)
            return found.rate, found.beyond
        return float(curve.probability(self.nodes)[0]), 0.0

    @classmethod
    def of(cls, at: float | None, hazard: HazardCurve | None) -> "ShakingLevel":
        """Check the arguments, and choose the nodes."""
        if (at is None) == (hazard is None):
            raise InputError("Give either at, a level of the measure, or hazard, a HazardCurve in it.")
        if hazard is None:
            level = checked_positive("at", at, "the unit of the measure")  # pyright: ignore[reportArgumentType]
            return cls(None, np.array([level]), np.ones(1))
        return cls(hazard, *hazard_quadrature(hazard))


class DesignRuns(NamedTuple):
    """The solved runs of one design and model, and which of them exceed the limit."""

    im: Array
    rotation: Array
    fallen: Bools
    exceeded: Bools
    groups: NDArray[Any]
    state: LimitState
    damping: float | None

    @classmethod
    def of(cls, runs: "pd.DataFrame", limit: float | str, measure: str) -> "DesignRuns | None":
        """Take the runs from the rows of a table that have a status; None if there are none."""
        solved = runs[runs["status"].notna()]
        if not len(solved):
            return None
        state = design_limit_state(limit, float(solved["nominal_limit"].iloc[0]))
        rotation = solved["max_rotation"].to_numpy(dtype=float)
        exceeded, fallen = (
            np.asarray(each.exceeded(solved).fillna(False), dtype=bool) for each in (state, OVERTURNING)
        )
        damping, groups = measure_damping_of_runs(solved, measure), solved["group"].to_numpy()
        return cls(solved[measure].to_numpy(float), rotation, fallen, exceeded, groups, state, damping)

    def fitted(self, *, banded: bool = False) -> "FittedExceedance":
        """Fit the curve of exceeding the limit; without the covariance of a band it takes less time.

        Raises
        ------
        InputError, SolverError
            If there is no fit.
        """
        groups = self.groups if banded else None
        fit = fit_outcomes(self.im, self.rotation, self.fallen, groups, damping=self.damping)
        falls, rocks = fit.overturning, fit.initiation
        if is_rotation_limit_state(self.state):
            limit = self.state.threshold
            sure = isinstance(falls, UnanimousOutcome) and (falls.outcome or limit == OVERTURNED)
            sure |= isinstance(rocks, UnanimousOutcome) and not rocks.outcome
            curve = falls if limit == OVERTURNED else fit.curve(limit)
            return FittedExceedance(curve, falls, sure, [note for note in fit.notes if note.kind != "initiation"])
        alike = self.exceeded.all() or not self.exceeded.any()
        found: LogisticFit | UnanimousOutcome = (
            UnanimousOutcome(bool(self.exceeded[0]), self.exceeded.size)
            if alike
            else fit_logistic(self.im, self.exceeded, groups, damping=self.damping)
        )
        return FittedExceedance(found, falls, bool(alike), [found.note] if found.note else [])

    def resampled(self, level: ShakingLevel, n: int, seed: int) -> Array:
        """The result for each of `n` resamples of the recordings, NaN where there is no fit."""
        import pandas as pd

        weights = bootstrap_weights(pd.factorize(self.groups)[0], n, seed)
        outcome, limit = (
            (self.fallen, self.state.threshold) if is_rotation_limit_state(self.state) else (self.exceeded, OVERTURNED)
        )
        return resampled_exceedance(self.im, self.rotation, outcome, weights, level.nodes, limit) @ level.weights


class FittedExceedance(NamedTuple):
    """The curves of exceeding a limit and of overturning, and whether all runs had the same outcome."""

    curve: LogisticFit | UnanimousOutcome | RotationFragility
    overturning: LogisticFit | UnanimousOutcome
    certain: bool
    notes: list[str]

    def band(self, level: ShakingLevel, confidence: float, n_groups: int) -> tuple[float, float, str]:
        """Lower and upper confidence limit of the probability or rate, and a note; NaN where there is none."""
        if self.certain or isinstance(self.curve, UnanimousOutcome):
            return math.nan, math.nan, translated("No band: all runs had the same outcome.")
        if n_groups < 2:
            return math.nan, math.nan, translated("No band: all runs belong to one recording.")
        if level.hazard is None:
            low, high = (float(end[0]) for end in self.curve.band(level.nodes, confidence))
            return low, high, ""
        found = annual_rate(level.hazard, self.curve, confidence=confidence)
        return found.low, found.high, ""


def design_row(
    group: "pd.DataFrame", limit: float | str, measure: str, level: ShakingLevel, confidence: float | None
) -> dict[str, Any]:
    """Columns of `design_table` for all runs of one design and model."""
    solved, runs = group[group["status"].notna()], DesignRuns.of(group, limit, measure)
    found: dict[str, Any] = {"limit": math.nan, "state": "", **_empty_exceedance_columns(level)}
    found |= {"note": translated("No run was solved: see the column error.")}
    if runs is not None:
        bound = runs.state.threshold if is_rotation_limit_state(runs.state) else math.nan
        found = {"limit": bound, "state": runs.state.label, **_exceedance_columns(runs, level, confidence)}
    return found | {
        "median_base_moment": solved["max_base_moment"].median(),
        "median_tendon_utilisation": solved["tendon_utilisation"].median(),
        "n_runs": len(solved),
        "n_exceeding": 0 if runs is None else int(runs.exceeded.sum()),
        "n_overturned": 0 if runs is None else int(runs.fallen.sum()),
        "n_failed": len(group) - len(solved),
    }


def _empty_exceedance_columns(level: ShakingLevel) -> dict[str, Any]:
    own = ("probability", "low", "high", "overturning")
    names = own if level.hazard is None else ("rate", *own[1:], "beyond")
    return dict.fromkeys(names, math.nan)


def _exceedance_columns(runs: DesignRuns, level: ShakingLevel, confidence: float | None) -> dict[str, Any]:
    """Value, band, value for overturning, and notes."""
    name = "probability" if level.hazard is None else "rate"
    found = _empty_exceedance_columns(level)
    try:
        fit = runs.fitted(banded=confidence is not None)
        found["overturning"] = level.exceedance(fit.overturning)[0]
        notes = list(fit.notes)
        if level.hazard is None and not runs.im.min() <= level.nodes[0] <= runs.im.max():
            notes.append(
                translated(
                    "The level lies outside the measures of the runs, {low} to {high}: the result is extrapolated.",
                    low=f"{runs.im.min():.3g}",
                    high=f"{runs.im.max():.3g}",
                )
            )
        if not np.isfinite(fit.curve.probability(level.nodes)).all():
            notes.append(translated("There is no probability: a curve that it needs could not be fitted."))
            return found | {"note": " ".join(notes)}
        found[name], beyond = level.exceedance(fit.curve)
    except (InputError, SolverError) as error:
        return found | {"note": str(error)}
    if level.hazard is not None:
        found["beyond"] = beyond
    if confidence is not None:
        found["low"], found["high"], note = fit.band(level, confidence, len(set(runs.groups)))
        notes += [note] if note else []
    return found | {"note": " ".join(notes)}
