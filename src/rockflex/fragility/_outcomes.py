"""The three outcomes of a run: no rocking, rocking, overturning."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, Self, TypeAlias, overload

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array, Bools
from rockflex.foundation.checks import checked_finite_vector, checked_positive
from rockflex.foundation.errors import InputError, SolverError
from rockflex.foundation.html import HtmlTable
from rockflex.foundation.language import translated
from rockflex.foundation.shown import shown
from rockflex.foundation.values import Value
from rockflex.fragility._arguments import boolean_column, checked_confidence, log_measures, log_of_evaluation_points
from rockflex.fragility._cloud import CloudFit, describe_power_law, fit_cloud_line
from rockflex.fragility._hazard import measure_damping_of_column
from rockflex.fragility._jackknife import (
    RecordingGroups,
    jackknife_covariance,
    sampled_band_limits,
    sampled_fit_parameters,
    student_t_quantile,
)
from rockflex.fragility._limit_states import ROCKED
from rockflex.fragility._logistic import LogisticFit, UnanimousOutcome, describe_logistic_curve, fit_logistic_curve

MIN_RUNS = 10  # fewer runs give a note
FEW_RUNS = (
    "Only {count} of {n} runs do not rock: fits of these runs are uncertain.",
    "Only {count} of {n} runs rock without overturning: fits of these runs are uncertain.",
    "Only {count} of {n} runs overturn: fits of these runs are uncertain.",
)
PARTS = ("overturning", "rocking", "initiation", "rotation")
_Part: TypeAlias = tuple[Array, Array | None]
"""Covariance of the parameters of a part for independent runs, and its parameters without each recording."""


class OutcomeNote(str):
    """A warning about the fits, and its `kind`: "runs", or the fit that it concerns, such as "rocking"."""

    __slots__ = ("kind",)
    kind: str

    def __new__(cls, text: str, kind: str = "runs") -> Self:
        note = super().__new__(cls, text)
        note.kind = kind
        return note


@dataclass(frozen=True, eq=False)
class OutcomeProbabilities(Value, Sequence[Array]):
    """Probabilities of the three outcomes, which sum to 1; a sequence in this order.

    Examples
    --------
    >>> import rockflex as rf
    >>> im = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8]
    >>> rotation = [0.0, 0.0, 0.01, 0.0, 0.02, 0.05, 1.6, 1.6]
    >>> outcomes = rf.fit_outcomes(im, rotation,
    ...     [angle > 1.5 for angle in rotation])
    >>> p = outcomes.probabilities(0.5)
    >>> print(f"{p.no_rocking + p.rocking + p.overturning:.3g}")
    1
    """

    no_rocking: Array
    rocking: Array
    overturning: Array

    def __len__(self) -> int:
        return 3

    @overload
    def __getitem__(self, index: int) -> Array: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[Array, ...]: ...
    def __getitem__(self, index: int | slice) -> Array | tuple[Array, ...]:
        return (self.no_rocking, self.rocking, self.overturning)[index]


@dataclass(frozen=True, eq=False, repr=False)
class OutcomeFragility(HtmlTable, Value):
    """Fits of the three outcomes of Silva & Stojadinović 2024, Section 3.2.

    Attributes
    ----------
    overturning : LogisticFit or UnanimousOutcome
        P(overturning | IM), of all runs.
    rocking : LogisticFit, UnanimousOutcome or None
        P(rocking | no overturning, IM), of the runs that did not overturn. None if it cannot be fitted: all runs
        overturned, or all others share one measure.
    initiation : LogisticFit or UnanimousOutcome
        P(rocking or overturning | IM) as one curve of all runs, as in Figure 5. The total probability does not use it:
        two independent logistic curves may cross, which would make the probability of rocking negative.
    rotation : CloudFit or None
        log θ_max on log IM, of the runs that rocked without overturning, as in Figure 6. None if it cannot be fitted.
    threshold : float
        A run counts as rocking if its base uplifted and its rotation in rad is larger.
    lowest_limit : float
        Smallest limit in rad of `exceedance`: the threshold or, on springs, the largest rotation without uplift.
    highest_limit : float
        Smallest rotation in rad of an overturned run, π/2 if there is none; they exceed every limit below it.
    n_no_rocking, n_rocking, n_overturned : int
        Runs of each outcome.
    notes : tuple of str
        Warnings about the fits: few runs, or curves that could not be fitted. The `kind` of each is ``"runs"`` or the
        attribute above that it concerns.
    covariance : ndarray, shape (7, 7)
        Covariance of the parameters of the total probability, read-only: (b0, b1) of `overturning` and of `rocking`,
        and (c1, c2, ln dispersion) of `rotation`; zero where there is no curve.
    without : ndarray, shape (n_groups, 7), or None
        The same parameters without each recording, in the order of their names; None for independent runs.
    n_groups : int
        Number of recordings; 0 if the runs were taken as independent.
    damping : float or None
        Damping ratio of the spectral acceleration or displacement that IM is; None for other measures.
    measured : tuple of float, or None
        Smallest and largest measure of the runs; outside, all curves are extrapolated.

    Examples
    --------
    >>> import rockflex as rf
    >>> im = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8]
    >>> rotation = [0.0, 0.0, 0.01, 0.0, 0.02, 0.05, 1.6, 1.6]
    >>> outcomes = rf.fit_outcomes(im, rotation,
    ...     [angle > 1.5 for angle in rotation])
    >>> print(f"{outcomes.exceedance(0.5, 0.02):.3g}")
    0.747
    >>> outcomes.notes[0]
    'Only 3 of 8 runs do not rock: fits of these runs are uncertain.'
    """

    overturning: LogisticFit | UnanimousOutcome
    rocking: LogisticFit | UnanimousOutcome | None
    initiation: LogisticFit | UnanimousOutcome
    rotation: CloudFit | None
    threshold: float
    lowest_limit: float
    highest_limit: float
    n_no_rocking: int
    n_rocking: int
    n_overturned: int
    notes: tuple[OutcomeNote, ...]
    covariance: Array
    without: Array | None = None
    n_groups: int = 0
    damping: float | None = None
    measured: tuple[float, float] | None = None

    def __repr__(self) -> str:
        notes = f"; see {len(self.notes)} in notes" if self.notes else ""
        return f"OutcomeFragility({self.counts}; overturning: {describe_logistic_curve(self.overturning)}{notes})"

    def _shown_as(self) -> Mapping[str, Any]:
        curves = {name: getattr(self, name) for name in ("overturning", "rocking", "initiation")}
        return {
            "runs": self.counts,
            **{name: None if curve is None else describe_logistic_curve(curve) for name, curve in curves.items()},
            "rotation": None if self.rotation is None else describe_power_law(self.rotation, "rad"),
            "threshold": f"{self.threshold:g} rad",
            "notes": " ".join(self.notes) or None,
        }

    @property
    def counts(self) -> str:
        """How many runs had each outcome, in words."""
        return f"{self.n_no_rocking} no rocking, {self.n_rocking} rocking, {self.n_overturned} overturned"

    def probabilities(self, im: ArrayLike) -> OutcomeProbabilities:
        """Probabilities of no rocking, rocking, and overturning, each of the shape of `im`."""
        falls, rocks = self._curves_at(im)
        still, moves = (_weighted_probability(1.0 - falls, each) for each in (1.0 - rocks, rocks))
        return OutcomeProbabilities(still, moves, falls)

    def _curves_at(self, im: ArrayLike) -> tuple[Array, Array]:
        falls = self.overturning.probability(im)
        return falls, np.full_like(falls, np.nan) if self.rocking is None else self.rocking.probability(im)

    def exceedance(self, im: ArrayLike, limit: ArrayLike) -> Array:
        """Probability that the rotation exceeds `limit` (rad) at `im`; the two broadcast.

        P(OV) + P(no OV) P(rocking | no OV) P(θ_max > limit | rocking), all given IM; NaN if a factor that matters
        could not be fitted (see `notes`).

        Raises
        ------
        InputError
            If a measure is not positive, or a limit is below `lowest_limit` or not below `highest_limit`.
        """
        sample_limits = self._checked(limit)
        falls, rocks = self._curves_at(im)
        beyond = np.full_like(sample_limits, np.nan) if self.rotation is None else self.rotation.exceedance(im, limit)
        return total_exceedance_probability(falls, rocks, beyond)

    def curve(self, limit: float) -> "RotationFragility":
        """Fragility curve of a rotation in rad, with its band, for `annual_rate` and the files of risk programs.

        Raises
        ------
        InputError
            If the limit is below the threshold of rocking or not below `highest_limit`.
        """
        self._checked(checked_positive("limit", limit, "rad"))
        return RotationFragility(self, float(limit))

    def _checked(self, limit: ArrayLike) -> Array:
        sample_limits = np.exp(log_of_evaluation_points(limit, "limit"))
        if (sample_limits < self.lowest_limit * (1.0 - 1e-12)).any() or (sample_limits >= self.highest_limit).any():
            raise InputError(
                f"limit must lie in [{self.lowest_limit:.4g}, {self.highest_limit:.4g}) rad, but {shown(limit)} was "
                "given. Below, a run that does not rock may exceed it, as a base on springs turns without uplift (fit "
                "the rotations by fit_outcomes without uplifted); above, an overturned run need not exceed it."
            )
        return sample_limits


@dataclass(frozen=True, eq=False)
class RotationFragility(Value):
    """Fragility curve of a rotation: the total probability of `OutcomeFragility.exceedance` at one limit.

    Attributes
    ----------
    outcomes : OutcomeFragility
        The fits.
    limit : float
        Rotation in rad.

    Examples
    --------
    >>> import rockflex as rf
    >>> im = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8]
    >>> rotation = [0.0, 0.0, 0.01, 0.0, 0.02, 0.05, 1.6, 1.6]
    >>> curve = rf.fit_outcomes(im, rotation,
    ...     [angle > 1.5 for angle in rotation]).curve(0.02)
    >>> print(f"{curve.probability(0.5):.3g}")
    0.747
    """

    outcomes: OutcomeFragility
    limit: float

    @property
    def damping(self) -> float | None:
        """Damping ratio of the spectral acceleration or displacement that IM is; None for other measures."""
        return self.outcomes.damping

    @property
    def measured(self) -> tuple[float, float] | None:
        """Smallest and largest measure of the runs; outside, the curve is extrapolated."""
        return self.outcomes.measured

    def probability(self, im: ArrayLike) -> Array:
        """Probability that the rotation exceeds the limit, of the shape of `im`; NaN if it could not be fitted."""
        return self.outcomes.exceedance(im, self.limit)

    def band(self, im: ArrayLike, confidence: float = 0.9) -> tuple[Array, Array]:
        """Lower and upper confidence limits of the probability; NaN if there are none.

        The jackknife over recordings of the logit, with Student's t with `n_groups` - 1 degrees of freedom. For
        independent runs, quantiles for parameters drawn from the normal distribution of the estimate. Outcomes that no
        run or every run had are taken as certain.
        """
        from scipy.special import expit, logit

        wanted, x, without = checked_confidence(confidence), np.exp(log_of_evaluation_points(im)), self.outcomes.without
        if without is None:
            low, high = sampled_band_limits(self.drawn(x.ravel()), wanted)
            return low.reshape(x.shape), high.reshape(x.shape)
        with np.errstate(divide="ignore", invalid="ignore"):  # a probability of 0 or 1
            away = logit(self._at(without, x.ravel())).reshape(-1, *x.shape)
            error = np.sqrt((len(without) - 1.0) * away.var(axis=0))
            centre, half = logit(self.probability(x)), student_t_quantile(wanted, len(without)) * error
            return expit(centre - half), expit(centre + half)

    def drawn(self, im: Array) -> Array:
        """Probabilities at `im`, shape (m,), for 2048 parameters drawn from the t distribution of the estimate."""
        fit = self.outcomes
        return self._at(sampled_fit_parameters(_outcome_parameters(fit), fit.covariance, fit.n_groups), im)

    def probability_without(self, im: Array) -> Array | None:
        """Probabilities at `im`, shape (m,), without each recording, shape (n_groups, m); None for independent runs."""
        return None if self.outcomes.without is None else self._at(self.outcomes.without, im)

    def _at(self, parameters: Array, im: Array) -> Array:
        """Probabilities at `im` for each row of parameters."""
        from scipy.special import expit, ndtr

        fit, x = self.outcomes, np.log(im)
        falls, rocks = (
            expit(parameters[:, place : place + 1] + parameters[:, place + 1 : place + 2] * x)
            if isinstance(curve, LogisticFit)
            else np.full((len(parameters), x.size), np.nan if curve is None else float(curve.outcome))
            for place, curve in ((0, fit.overturning), (2, fit.rocking))
        )
        c1, c2, spread = (parameters[:, place : place + 1] for place in (4, 5, 6))
        known = 1.0 if fit.rotation else np.nan
        return total_exceedance_probability(
            falls, rocks, known * ndtr((c1 + c2 * x - np.log(self.limit)) / np.exp(spread))
        )


def fit_outcomes(
    im: ArrayLike,
    rotation: ArrayLike,
    overturned: ArrayLike,
    groups: ArrayLike | None = None,
    *,
    uplifted: ArrayLike | None = None,
    threshold: float = ROCKED,
    damping: float | None = None,
) -> OutcomeFragility:
    """Fit the three outcomes of a cloud of runs, and the rotations of those that rocked.

    An empty or small group is not an error: its curve becomes a constant with a one-sided bound, or None, and `notes`
    report it.

    Parameters
    ----------
    im : array_like, shape (n,)
        Intensity measure of every run, in any one unit.
    rotation : array_like, shape (n,)
        Largest rotation θ_max of every run in rad, zero or more.
    overturned : array_like, shape (n,)
        Whether the run overturned, by the caller's definition: the rotation reached π/2, or passed the nominal
        0.7 atan(B/h*_1) (columns `status` and `nominal_overturning` of a study).
    groups : array_like, shape (n,), optional
        Name or number of the recording of every run, as in `fit_logistic`. Without it bands assume independent runs,
        and are too narrow where recordings repeat.
    uplifted : array_like, shape (n,), optional
        Whether the base of the run uplifted (column `status`). Default: wherever it turned, as on rigid ground; one
        on springs also turns without uplift.
    threshold
        A run counts as rocking if its base uplifted and its rotation in rad is larger.
    damping
        As in `fit_logistic`.

    Raises
    ------
    InputError
        If a value is out of range, all measures are the same, a run overturned with a rotation up to `threshold`, or
        the name of a recording is missing.

    Examples
    --------
    >>> import rockflex as rf
    >>> im = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8]
    >>> rotation = [0.0, 0.0, 0.01, 0.0, 0.02, 0.05, 1.6, 1.6]
    >>> outcomes = rf.fit_outcomes(im, rotation,
    ...     [angle > 1.5 for angle in rotation])
    >>> outcomes.n_no_rocking, outcomes.n_rocking, outcomes.n_overturned
    (3, 3, 2)
    >>> outcomes.overturning.method
    'Firth'
    """
    from scipy.linalg import block_diag

    log_measures(im)
    measures = checked_finite_vector("im", im, "one unit")
    rotations, falls = checked_finite_vector("rotation", rotation, "rad"), boolean_column("overturned", overturned)
    lifts = np.ones(falls.size, dtype=bool) if uplifted is None else boolean_column("uplifted", uplifted)
    recordings = RecordingGroups.beside(groups, im=measures, rotation=rotations, overturned=falls, uplifted=lifts)
    limit = checked_positive("threshold", threshold, "rad")
    _check_outcome_rotations(rotations, falls, limit)

    stands, moves = ~falls, (rotations > limit) & (lifts | falls)
    rocked = stands & moves
    counts = int((~moves).sum()), int(rocked.sum()), int(falls.sum())
    notes = [
        OutcomeNote(translated(text, count=count, n=falls.size))
        for count, text in zip(counts, FEW_RUNS, strict=True)
        if 0 < count < MIN_RUNS
    ]
    damping = measure_damping_of_column(im, damping)
    shared = _OutcomePartFits(measures, recordings, damping, notes)
    overturning, part = shared.curve("overturning", falls, np.ones_like(falls))
    rocking, other = shared.curve("rocking", moves, stands)
    initiation, _ = shared.curve("initiation", moves, np.ones_like(falls))
    line, last = shared.cloud(rotations, rocked)
    count = 0 if recordings is None else recordings.n
    without = None if recordings is None else _joined_outcome_replicates((part, other, last), count)
    return OutcomeFragility(
        overturning=overturning or UnanimousOutcome(bool(falls[0]), falls.size, count),
        rocking=rocking,
        initiation=initiation or UnanimousOutcome(bool(moves[0]), moves.size, count),
        rotation=line,
        threshold=limit,
        lowest_limit=float(rotations[~moves].max(initial=limit)),
        highest_limit=float(rotations[falls].min(initial=0.5 * math.pi)),
        n_no_rocking=counts[0],
        n_rocking=counts[1],
        n_overturned=counts[2],
        notes=tuple(notes),
        covariance=block_diag(part[0], other[0], last[0]) if without is None else jackknife_covariance(without),
        without=without,
        n_groups=count,
        damping=damping,
        measured=(float(measures.min()), float(measures.max())),
    )


def _check_outcome_rotations(rotations: Array, falls: Bools, threshold: float) -> None:
    negative = np.flatnonzero(rotations < 0.0)
    if negative.size:
        raise InputError(
            f"rotation must be zero or positive, but {negative.size} of {rotations.size} values are not, the first "
            f"({rotations[negative[0]]:g}) in row {negative[0]}. Give the largest magnitude of every run."
        )
    small = np.flatnonzero(falls & (rotations <= threshold))
    if small.size:
        raise InputError(
            f"{small.size} overturned runs have a rotation of at most the threshold {threshold:g} rad, the first in "
            f"row {small[0]} ({rotations[small[0]]:g} rad). Check that the columns belong together, and the unit."
        )


class _OutcomePartFits(NamedTuple):
    """Fits of the parts of the total probability, with the data that they share."""

    im: Array
    recordings: RecordingGroups | None
    damping: float | None
    notes: list[OutcomeNote]

    def some(self, chosen: Bools) -> RecordingGroups | None:
        return None if self.recordings is None else self.recordings.some(chosen)

    def note(self, part: str, text: object) -> None:
        self.notes.append(OutcomeNote(translated(f"{part}: {{note}}", note=text), part))

    def curve(self, name: str, happened: Bools, chosen: Bools) -> tuple[LogisticFit | UnanimousOutcome | None, _Part]:
        """The curve of an outcome of some of the runs."""
        outcome, some, none = happened[chosen], self.some(chosen), (np.zeros((2, 2)), None)
        if outcome.size == 0:
            self.note(name, translated("all runs overturned, so there is nothing to fit."))
            return None, none
        if outcome.all() or not outcome.any():
            alike = UnanimousOutcome(bool(outcome[0]), outcome.size, 0 if some is None else int(some.held.sum()))
            count = translated("all of {n} runs." if alike.outcome else "none of {n} runs.", n=alike.n)
            self.note(name, f"{count} {alike.note}")
            return alike, none
        try:
            fit, replicates = fit_logistic_curve(log_measures(self.im[chosen]), outcome, some, self.damping)
        except (InputError, SolverError) as error:
            self.note(name, error)
            return None, none
        if fit.note:
            self.note(name, fit.note)
        return fit, (fit.covariance, replicates)

    def cloud(self, rotation: Array, rocked: Bools) -> tuple[CloudFit | None, _Part]:
        """The line through the rotations of the runs that rocked."""
        try:
            x, y = log_measures(self.im[rocked]), np.log(rotation[rocked])
            fit, replicates = fit_cloud_line(x, y, self.some(rocked))
        except InputError as error:
            self.note("rotation", error)
            return None, (np.zeros((3, 3)), None)
        covariance = np.zeros((3, 3))
        covariance[:2, :2], covariance[2, 2] = fit.covariance, 0.5 / (fit.n - 2.0)
        return fit, (covariance, replicates)


def _joined_outcome_replicates(parts: Sequence[_Part], count: int) -> Array:
    """Parameters of all parts without each recording; zero where there is no curve."""
    zeros = (np.zeros((count, len(covariance))) for covariance, _ in parts)
    return np.column_stack([zero if found is None else found for zero, (_, found) in zip(zeros, parts, strict=True)])


def _outcome_parameters(fit: OutcomeFragility) -> Array:
    """Parameters of the total probability, in the order of their covariance; zero where there is no curve."""
    curves = (
        (curve.b0, curve.b1) if isinstance(curve, LogisticFit) else (0.0, 0.0)
        for curve in (fit.overturning, fit.rocking)
    )
    line = fit.rotation
    with np.errstate(divide="ignore"):  # runs on one line have no scatter
        last = (0.0, 0.0, 0.0) if line is None else (line.c1, line.c2, float(np.log(line.dispersion)))
    return np.array([*(value for pair in curves for value in pair), *last])


def total_exceedance_probability(falls: Array, rocks: Array, beyond: Array) -> Array:
    """P(OV) + P(no OV) P(rocking | no OV) P(θ_max > limit | rocking)."""
    return falls + _weighted_probability(_weighted_probability(1.0 - falls, rocks), beyond)


def _weighted_probability(weight: Array, values: Array) -> Array:
    """The product; zero where the weight is zero, even if the value could not be fitted."""
    return np.where(weight == 0.0, 0.0, weight * values)[()]
