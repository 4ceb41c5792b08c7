"""The fit of one design, its result, and the confidence band of the result."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple, SupportsIndex

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array, Bools
from rockflex._checks import in_range, positive, whole_number
from rockflex._errors import InputError, SolverError
from rockflex.fragility import (
    OVERTURNED,
    OVERTURNING,
    HazardCurve,
    LimitState,
    LogisticFit,
    UnanimousOutcome,
    annual_rate,
    fit_logistic,
    fit_outcomes,
    resample_weights,
    resampled_exceedance,
)
from rockflex.study.design._limits import is_rotation, state_of

if TYPE_CHECKING:
    import pandas as pd

Curve = Callable[[Array], Array]

NODES = 12  # of Gauss and Legendre in a segment of a hazard curve
FEWEST = 20  # resamples


@dataclass(frozen=True)
class Band:
    """Settings of a band: its confidence, the number of resamples, and their seed."""

    confidence: float
    n: SupportsIndex
    seed: int

    def __post_init__(self) -> None:
        in_range("confidence", self.confidence, 0.0, 1.0, hint="A 90 % band is 0.9.")
        whole_number("n_resamples", self.n, FEWEST)


@dataclass(frozen=True)
class Question:
    """The strength of the shaking: a level of the measure, or a hazard curve.

    The result for a curve P is the sum of P at `nodes` times `weights`, for resamples by Gauss' rule in log IM.
    """

    hazard: HazardCurve | None
    nodes: Array
    weights: Array

    def answer(self, curve: Curve) -> tuple[float, float]:
        """Probability at the level and zero, or annual rate and an upper bound on the rate beyond the hazard curve."""
        if self.hazard is not None:
            found = annual_rate(self.hazard, curve)
            return found.rate, found.beyond
        return float(curve(self.nodes)[0]), 0.0

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
        points, shares = np.polynomial.legendre.leggauss(NODES)
        step = 0.5 + 0.5 * points
        start, width, k = np.log(hazard.im[:-1]), np.diff(np.log(hazard.im)), hazard.slopes
        nodes = np.exp(start[:, None] + width[:, None] * step)
        falls = (k * width * hazard.rate[:-1])[:, None] * np.exp(-np.outer(k * width, step))
        return cls(hazard, nodes.ravel(), (0.5 * shares * falls).ravel())


class Runs(NamedTuple):
    """The solved runs of one design and model, and which of them exceed the limit."""

    im: Array
    rotation: Array
    fallen: Bools
    exceeded: Bools
    groups: NDArray[Any]
    state: LimitState

    @classmethod
    def of(cls, solved: "pd.DataFrame", limit: float | str, measure: str) -> "Runs":
        """Take the runs from the rows of a table that have a status, at least one."""
        state = state_of(limit, float(solved["nominal_limit"].iloc[0]))
        rotation = solved["max_rotation"].to_numpy(dtype=float)
        exceeded, fallen = (
            np.asarray(each.exceeded(solved).fillna(False), dtype=bool) for each in (state, OVERTURNING)
        )
        return cls(solved[measure].to_numpy(float), rotation, fallen, exceeded, solved["group"].to_numpy(), state)

    def fitted(self) -> "Fitted":
        """Fit the curve of exceeding the limit.

        Raises
        ------
        InputError, SolverError
            If there is no fit.
        """
        fit = fit_outcomes(self.im, self.rotation, self.fallen)
        falls, rocks = fit.overturning, fit.initiation
        if is_rotation(self.state):
            limit = self.state.threshold
            sure = isinstance(falls, UnanimousOutcome) and (falls.outcome or limit == OVERTURNED)
            sure |= isinstance(rocks, UnanimousOutcome) and not rocks.outcome
            curve: Curve = falls.probability if limit == OVERTURNED else partial(fit.exceedance, limit=limit)
            return Fitted(curve, falls.probability, sure, [note for note in fit.notes if note.kind != "initiation"])
        alike = self.exceeded.all() or not self.exceeded.any()
        found: LogisticFit | UnanimousOutcome = (
            UnanimousOutcome(bool(self.exceeded[0]), self.exceeded.size)
            if alike
            else fit_logistic(self.im, self.exceeded)
        )
        return Fitted(found.probability, falls.probability, bool(alike), [found.note] if found.note else [])

    def resampled(self, question: Question, n: int, seed: int) -> Array:
        """The result for each of `n` resamples of the recordings, NaN where there is no fit."""
        import pandas as pd

        weights = resample_weights(pd.factorize(self.groups)[0], n, seed)
        outcome, limit = (self.fallen, self.state.threshold) if is_rotation(self.state) else (self.exceeded, OVERTURNED)
        return resampled_exceedance(self.im, self.rotation, outcome, weights, question.nodes, limit) @ question.weights


class Fitted(NamedTuple):
    """The curves of exceeding a limit and of overturning, and whether every resample would give the same."""

    curve: Curve
    overturning: Curve
    certain: bool
    notes: list[str]


def judged(
    group: "pd.DataFrame", limit: float | str, measure: str, question: Question, band: Band | None
) -> dict[str, Any]:
    """Columns of `design_table` for all runs of one design and model."""
    solved = group[group["status"].notna()]
    found: dict[str, Any]
    if len(solved):
        runs = Runs.of(solved, limit, measure)
        bound = runs.state.threshold if is_rotation(runs.state) else math.nan
        found = {"limit": bound, "state": runs.state.label, **_answers(runs, question, band)}
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


def _answers(runs: Runs, question: Question, band: Band | None) -> dict[str, Any]:
    """Value, band, value for overturning, and notes."""
    name = "probability" if question.hazard is None else "rate"
    found = _nothing(question)
    try:
        fit = runs.fitted()
        found["overturning"] = question.answer(fit.overturning)[0]
        notes = list(fit.notes)
        if question.hazard is None and not runs.im.min() <= question.nodes[0] <= runs.im.max():
            ends = f"{runs.im.min():.3g} to {runs.im.max():.3g}"
            notes.append(f"The level lies outside the measures of the runs, {ends}: the result is extrapolated.")
        if not np.isfinite(fit.curve(question.nodes)).all():
            notes.append("There is no probability: a curve that it needs could not be fitted.")
            return found | {"note": " ".join(notes)}
        found[name], beyond = question.answer(fit.curve)
    except (InputError, SolverError) as error:
        return found | {"note": str(error)}
    if question.hazard is not None:
        found["beyond"] = beyond
    if band is not None:
        found["low"], found["high"], note = _limits(runs, question, band, certain=fit.certain)
        notes += [note] if note else []
    return found | {"note": " ".join(notes)}


def _limits(runs: Runs, question: Question, band: Band, *, certain: bool) -> tuple[float, float, str]:
    """Lower and upper confidence limit, and a note."""
    if certain:
        return math.nan, math.nan, "No band: all runs had the same outcome."
    n_groups = len(set(runs.groups))
    if n_groups < 2:
        return math.nan, math.nan, "No band: all runs belong to one recording."
    values = runs.resampled(question, int(band.n), band.seed)
    values = values[np.isfinite(values)]
    if values.size < FEWEST:
        return math.nan, math.nan, f"No band: only {values.size} of {int(band.n)} resamples could be fitted."
    low, high = np.quantile(values, (0.5 - 0.5 * band.confidence, 0.5 + 0.5 * band.confidence))
    notes: list[str] = []
    if values.size < int(band.n):
        lost = int(band.n) - values.size
        notes.append(f"{lost} of {int(band.n)} resamples could not be fitted, so the band is too narrow.")
    if n_groups < 20:
        notes.append(f"A band from {n_groups} recordings is too narrow.")
    return float(low), float(high), " ".join(notes)
