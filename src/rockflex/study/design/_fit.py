"""The fit of one design, its result, and the confidence band of the result."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple, SupportsIndex

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array, Bools
from rockflex._checks import in_range, positive, whole_number
from rockflex._errors import InputError
from rockflex.fragility import (
    OVERTURNED,
    OVERTURNING,
    HazardCurve,
    OutcomeFragility,
    UnanimousOutcome,
    annual_rate,
    fit_outcomes,
    resample_weights,
    resampled_exceedance,
)
from rockflex.study.design._limits import rotation_of

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
    """The solved runs of one design and model, and the rotation of the limit."""

    im: Array
    rotation: Array
    fallen: Bools
    groups: NDArray[Any]
    limit: float

    def curve(self, fit: OutcomeFragility) -> Curve:
        """Probability of exceeding the limit."""
        if self.limit == OVERTURNED:
            return fit.overturning.probability
        return lambda im: fit.exceedance(im, self.limit)

    def certain(self, fit: OutcomeFragility) -> bool:
        """Whether every resample would give the same result."""
        rocks, falls = fit.initiation, fit.overturning
        if isinstance(falls, UnanimousOutcome) and (falls.outcome or self.limit == OVERTURNED):
            return True
        return isinstance(rocks, UnanimousOutcome) and not rocks.outcome


def judged(
    group: "pd.DataFrame", limit: float | str, measure: str, question: Question, band: Band | None
) -> dict[str, Any]:
    """Columns of `design_table` for all runs of one design and model."""
    solved = group[group["status"].notna()]
    fallen = OVERTURNING.exceeded(solved).to_numpy(dtype=bool)
    rotation = solved["max_rotation"].to_numpy(dtype=float)
    nominal = float(solved["nominal_limit"].iloc[0]) if len(solved) else math.nan
    bound = rotation_of(limit, nominal) if len(solved) else math.nan
    runs = Runs(solved[measure].to_numpy(dtype=float), rotation, fallen, solved["group"].to_numpy(), bound)
    return {
        "limit": bound,
        **_answers(runs, question, band),
        "median_base_moment": solved["max_base_moment"].median(),
        "median_tendon_utilisation": solved["tendon_utilisation"].median(),
        "n_runs": len(solved),
        "n_exceeding": int((fallen | (rotation > bound)).sum()),
        "n_overturned": int(fallen.sum()),
        "n_failed": len(group) - len(solved),
    }


def _answers(runs: Runs, question: Question, band: Band | None) -> dict[str, Any]:
    """Value, band, value for overturning, and notes."""
    name = "probability" if question.hazard is None else "rate"
    found: dict[str, Any] = dict.fromkeys((name, "low", "high", "overturning"), math.nan)
    if question.hazard is not None:
        found["beyond"] = math.nan
    if not runs.im.size:
        return found | {"note": "No run was solved: see the column error."}
    try:
        fit = fit_outcomes(runs.im, runs.rotation, runs.fallen)
        found["overturning"] = question.answer(fit.overturning.probability)[0]
        notes: list[str] = [note for note in fit.notes if note.kind != "initiation"]
        if question.hazard is None and not runs.im.min() <= question.nodes[0] <= runs.im.max():
            ends = f"{runs.im.min():.3g} to {runs.im.max():.3g}"
            notes.append(f"The level lies outside the measures of the runs, {ends}: the result is extrapolated.")
        if not np.isfinite(runs.curve(fit)(question.nodes)).all():
            notes.append("There is no probability: a curve that it needs could not be fitted.")
            return found | {"note": " ".join(notes)}
        found[name], beyond = question.answer(runs.curve(fit))
    except InputError as error:
        return found | {"note": str(error)}
    if question.hazard is not None:
        found["beyond"] = beyond
    if band is not None:
        found["low"], found["high"], note = _limits(runs, question, band, fit)
        notes += [note] if note else []
    return found | {"note": " ".join(notes)}


def _limits(runs: Runs, question: Question, band: Band, fit: OutcomeFragility) -> tuple[float, float, str]:
    """Lower and upper confidence limit, and a note."""
    if runs.certain(fit):
        return math.nan, math.nan, "No band: all runs had the same outcome."
    import pandas as pd

    codes, names = pd.factorize(runs.groups)
    if len(names) < 2:
        return math.nan, math.nan, "No band: all runs belong to one recording."
    weights = resample_weights(codes, int(band.n), band.seed)
    drawn = resampled_exceedance(runs.im, runs.rotation, runs.fallen, weights, question.nodes, runs.limit)
    values = drawn @ question.weights
    values = values[np.isfinite(values)]
    if values.size < FEWEST:
        return math.nan, math.nan, f"No band: only {values.size} of {int(band.n)} resamples could be fitted."
    low, high = np.quantile(values, (0.5 - 0.5 * band.confidence, 0.5 + 0.5 * band.confidence))
    notes: list[str] = []
    if values.size < int(band.n):
        lost = int(band.n) - values.size
        notes.append(f"{lost} of {int(band.n)} resamples could not be fitted, so the band is too narrow.")
    if len(names) < 20:
        notes.append(f"A band from {len(names)} recordings is too narrow.")
    return float(low), float(high), " ".join(notes)
