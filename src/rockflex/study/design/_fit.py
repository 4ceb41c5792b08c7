"""The fit of one design, its result, and the confidence band of the result."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array, Bools
from rockflex._checks import in_range, positive
from rockflex._errors import InputError, SolverError
from rockflex.fragility import (
    OVERTURNED,
    OVERTURNING,
    HazardCurve,
    LimitState,
    LogisticFit,
    RotationFragility,
    UnanimousOutcome,
    annual_rate,
    damping_of,
    fit_logistic,
    fit_outcomes,
    quadrature,
    resample_weights,
    resampled_exceedance,
)
from rockflex.modal import RockingProperties
from rockflex.study.design._limits import is_rotation, state_of

if TYPE_CHECKING:
    import pandas as pd


def check_confidence(confidence: float) -> None:
    """Raise an InputError unless a confidence is in [0, 1)."""
    in_range("confidence", confidence, 0.0, 1.0, hint="A 90 % band is 0.9.")


def check_damping(hazard: HazardCurve | None, runs: "pd.DataFrame", measure: str) -> None:
    """Raise an InputError if a spectral measure of runs, with the column `zeta_1`, is not at the damping of a curve."""
    if hazard is not None:
        hazard.check_damping(damping_of(runs, measure))


def first_damping(structure: RockingProperties) -> "pd.DataFrame":
    """The column `zeta_1` that the runs of a structure will have."""
    import pandas as pd

    return pd.DataFrame({"zeta_1": structure.zeta[:1]})


@dataclass(frozen=True)
class Question:
    """The strength of the shaking: a level of the measure, or a hazard curve.

    The result for a curve P is the sum of P at `nodes` times `weights`.
    """

    hazard: HazardCurve | None
    nodes: Array
    weights: Array

    def answer(self, curve: LogisticFit | UnanimousOutcome | RotationFragility) -> tuple[float, float]:
        """Probability at the level and zero, or annual rate and an upper bound on the rate beyond the hazard curve."""
        if self.hazard is not None:
            found = annual_rate(self.hazard, curve)
            return found.rate, found.beyond
        return float(curve.probability(self.nodes)[0]), 0.0

    @classmethod
    def of(cls, at: float | None, hazard: HazardCurve | None) -> "Question":
        """Check the arguments, and choose the nodes.

        Raises
        ------
        InputError
            If both or neither were given, or the level is not positive.
        """
        if (at is None) == (hazard is None):
            raise InputError("Give either at, a level of the measure, or hazard, a HazardCurve in it.")
        if hazard is None:
            level = positive("at", at, "the unit of the measure")  # pyright: ignore[reportArgumentType]
            return cls(None, np.array([level]), np.ones(1))
        return cls(hazard, *quadrature(hazard))


class Runs(NamedTuple):
    """The solved runs of one design and model, and which of them exceed the limit."""

    im: Array
    rotation: Array
    fallen: Bools
    exceeded: Bools
    groups: NDArray[Any]
    state: LimitState
    damping: float | None

    @classmethod
    def of(cls, solved: "pd.DataFrame", limit: float | str, measure: str) -> "Runs":
        """Take the runs from the rows of a table that have a status, at least one."""
        state = state_of(limit, float(solved["nominal_limit"].iloc[0]))
        rotation = solved["max_rotation"].to_numpy(dtype=float)
        exceeded, fallen = (
            np.asarray(each.exceeded(solved).fillna(False), dtype=bool) for each in (state, OVERTURNING)
        )
        damping, groups = damping_of(solved, measure), solved["group"].to_numpy()
        return cls(solved[measure].to_numpy(float), rotation, fallen, exceeded, groups, state, damping)

    def fitted(self, *, banded: bool = False) -> "Fitted":
        """Fit the curve of exceeding the limit; without the covariance of a band it takes less time.

        Raises
        ------
        InputError, SolverError
            If there is no fit.
        """
        groups = self.groups if banded else None
        fit = fit_outcomes(self.im, self.rotation, self.fallen, groups, damping=self.damping)
        falls, rocks = fit.overturning, fit.initiation
        if is_rotation(self.state):
            limit = self.state.threshold
            sure = isinstance(falls, UnanimousOutcome) and (falls.outcome or limit == OVERTURNED)
            sure |= isinstance(rocks, UnanimousOutcome) and not rocks.outcome
            curve = falls if limit == OVERTURNED else fit.curve(limit)
            return Fitted(curve, falls, sure, [note for note in fit.notes if note.kind != "initiation"])
        alike = self.exceeded.all() or not self.exceeded.any()
        found: LogisticFit | UnanimousOutcome = (
            UnanimousOutcome(bool(self.exceeded[0]), self.exceeded.size)
            if alike
            else fit_logistic(self.im, self.exceeded, groups, damping=self.damping)
        )
        return Fitted(found, falls, bool(alike), [found.note] if found.note else [])

    def resampled(self, question: Question, n: int, seed: int) -> Array:
        """The result for each of `n` resamples of the recordings, NaN where there is no fit."""
        import pandas as pd

        weights = resample_weights(pd.factorize(self.groups)[0], n, seed)
        outcome, limit = (self.fallen, self.state.threshold) if is_rotation(self.state) else (self.exceeded, OVERTURNED)
        return resampled_exceedance(self.im, self.rotation, outcome, weights, question.nodes, limit) @ question.weights


class Fitted(NamedTuple):
    """The curves of exceeding a limit and of overturning, and whether all runs had the same outcome."""

    curve: LogisticFit | UnanimousOutcome | RotationFragility
    overturning: LogisticFit | UnanimousOutcome
    certain: bool
    notes: list[str]

    def band(self, question: Question, confidence: float, n_groups: int) -> tuple[float, float, str]:
        """Lower and upper confidence limit of the answer, and a note; NaN where there is none."""
        if self.certain or isinstance(self.curve, UnanimousOutcome):
            return math.nan, math.nan, "No band: all runs had the same outcome."
        if n_groups < 2:
            return math.nan, math.nan, "No band: all runs belong to one recording."
        if question.hazard is None:
            low, high = (float(end[0]) for end in self.curve.band(question.nodes, confidence))
            return low, high, ""
        found = annual_rate(question.hazard, self.curve, confidence=confidence)
        return found.low, found.high, ""


def judged(
    group: "pd.DataFrame", limit: float | str, measure: str, question: Question, confidence: float | None
) -> dict[str, Any]:
    """Columns of `design_table` for all runs of one design and model."""
    solved = group[group["status"].notna()]
    found: dict[str, Any]
    if len(solved):
        runs = Runs.of(solved, limit, measure)
        bound = runs.state.threshold if is_rotation(runs.state) else math.nan
        found = {"limit": bound, "state": runs.state.label, **_answers(runs, question, confidence)}
        counts = int(runs.exceeded.sum()), int(runs.fallen.sum())
    else:
        found = {
            "limit": math.nan,
            "state": "",
            **_nothing(question),
            "note": "No run was solved: see the column error.",
        }
        counts = 0, 0
    return found | {
        "median_base_moment": solved["max_base_moment"].median(),
        "median_tendon_utilisation": solved["tendon_utilisation"].median(),
        "n_runs": len(solved),
        "n_exceeding": counts[0],
        "n_overturned": counts[1],
        "n_failed": len(group) - len(solved),
    }


def _nothing(question: Question) -> dict[str, Any]:
    names = ("probability", "low", "high", "overturning") if question.hazard is None else (
        "rate", "low", "high", "overturning", "beyond",
    )  # fmt: skip
    return dict.fromkeys(names, math.nan)


def _answers(runs: Runs, question: Question, confidence: float | None) -> dict[str, Any]:
    """Value, band, value for overturning, and notes."""
    name = "probability" if question.hazard is None else "rate"
    found = _nothing(question)
    try:
        fit = runs.fitted(banded=confidence is not None)
        found["overturning"] = question.answer(fit.overturning)[0]
        notes = list(fit.notes)
        if question.hazard is None and not runs.im.min() <= question.nodes[0] <= runs.im.max():
            ends = f"{runs.im.min():.3g} to {runs.im.max():.3g}"
            notes.append(f"The level lies outside the measures of the runs, {ends}: the result is extrapolated.")
        if not np.isfinite(fit.curve.probability(question.nodes)).all():
            notes.append("There is no probability: a curve that it needs could not be fitted.")
            return found | {"note": " ".join(notes)}
        found[name], beyond = question.answer(fit.curve)
    except (InputError, SolverError) as error:
        return found | {"note": str(error)}
    if question.hazard is not None:
        found["beyond"] = beyond
    if confidence is not None:
        found["low"], found["high"], note = fit.band(question, confidence, len(set(runs.groups)))
        notes += [note] if note else []
    return found | {"note": " ".join(notes)}
