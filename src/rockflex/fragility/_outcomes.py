"""The three outcomes of a run: no rocking, rocking, overturning."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self, overload

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array, Bools
from rockflex._checks import finite_vector, positive
from rockflex._errors import InputError, SolverError
from rockflex._html import HtmlTable
from rockflex._shown import shown
from rockflex._values import Value
from rockflex.fragility._arguments import flags, log_at, log_measures, same_length
from rockflex.fragility._cloud import CloudFit, fit_cloud
from rockflex.fragility._limit_states import ROCKED
from rockflex.fragility._logistic import LogisticFit, fit_logistic
from rockflex.fragility._unanimous import UnanimousOutcome
from rockflex.fragility._words import curve_words, power_law

FEW = 10  # fewer runs give a note


class Note(str):
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
    >>> outcomes = rf.fit_outcomes(im, rotation, [angle > 1.5 for angle in rotation])
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

    Examples
    --------
    >>> import rockflex as rf
    >>> im = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8]
    >>> rotation = [0.0, 0.0, 0.01, 0.0, 0.02, 0.05, 1.6, 1.6]
    >>> outcomes = rf.fit_outcomes(im, rotation, [angle > 1.5 for angle in rotation])
    >>> print(f"{outcomes.exceedance(0.5, 0.02):.3g}")
    0.747
    >>> outcomes.notes[0]
    'Only 3 of 8 runs do not rock: fits of these runs are uncertain, see bootstrap_band.'
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
    notes: tuple[Note, ...]

    def __repr__(self) -> str:
        notes = f"; see {len(self.notes)} in notes" if self.notes else ""
        return f"OutcomeFragility({self.counts}; overturning: {curve_words(self.overturning)}{notes})"

    def _shown_as(self) -> Mapping[str, Any]:
        curves = {name: getattr(self, name) for name in ("overturning", "rocking", "initiation")}
        return {
            "runs": self.counts,
            **{name: None if curve is None else curve_words(curve) for name, curve in curves.items()},
            "rotation": None if self.rotation is None else power_law(self.rotation, "rad"),
            "threshold": f"{self.threshold:g} rad",
            "notes": " ".join(self.notes) or None,
        }

    @property
    def counts(self) -> str:
        """How many runs had each outcome, in words."""
        return f"{self.n_no_rocking} no rocking, {self.n_rocking} rocking, {self.n_overturned} overturned"

    def probabilities(self, im: ArrayLike) -> OutcomeProbabilities:
        """Probabilities of no rocking, rocking, and overturning, each of the shape of `im`."""
        falls = self.overturning.probability(im)
        rocks = np.full_like(falls, np.nan) if self.rocking is None else self.rocking.probability(im)
        stands = 1.0 - falls
        return OutcomeProbabilities(_weighted(stands, 1.0 - rocks), _weighted(stands, rocks), falls)

    def exceedance(self, im: ArrayLike, limit: ArrayLike) -> Array:
        """Probability that the rotation exceeds `limit` (rad) at `im`; the two broadcast.

        P(OV) + P(no OV) P(rocking | no OV) P(θ_max > limit | rocking), all given IM; NaN if a factor that matters
        could not be fitted (see `notes`).

        Raises
        ------
        InputError
            If a measure is not positive, or a limit is below `lowest_limit` or not below `highest_limit`.
        """
        limits = np.exp(log_at(limit, "limit"))
        if (limits < self.lowest_limit * (1.0 - 1e-12)).any() or (limits >= self.highest_limit).any():
            raise InputError(
                f"limit must lie in [{self.lowest_limit:.4g}, {self.highest_limit:.4g}) rad, but {shown(limit)} was "
                "given. Below, a run that does not rock may exceed it, as a base on springs turns without uplift (fit "
                "the rotations by fit_outcomes without uplifted); above, an overturned run need not exceed it."
            )
        falls = self.overturning.probability(im)
        rocks = np.full_like(falls, np.nan) if self.rocking is None else self.rocking.probability(im)
        beyond = np.full_like(limits, np.nan) if self.rotation is None else self.rotation.exceedance(im, limit)
        return total_probability(falls, rocks, beyond)


def fit_outcomes(
    im: ArrayLike,
    rotation: ArrayLike,
    overturned: ArrayLike,
    *,
    uplifted: ArrayLike | None = None,
    threshold: float = ROCKED,
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
    uplifted : array_like, shape (n,), optional
        Whether the base of the run uplifted (column `status`). Default: wherever it turned, as on rigid ground; one
        on springs also turns without uplift.
    threshold
        A run counts as rocking if its base uplifted and its rotation in rad is larger.

    Raises
    ------
    InputError
        If a value is out of range, all measures are the same, or a run overturned with a rotation up to `threshold`.

    Examples
    --------
    >>> import rockflex as rf
    >>> im = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8]
    >>> rotation = [0.0, 0.0, 0.01, 0.0, 0.02, 0.05, 1.6, 1.6]
    >>> outcomes = rf.fit_outcomes(im, rotation, [angle > 1.5 for angle in rotation])
    >>> outcomes.n_no_rocking, outcomes.n_rocking, outcomes.n_overturned
    (3, 3, 2)
    >>> outcomes.overturning.method
    'Firth'
    """
    log_measures(im)
    measures = finite_vector("im", im, "one unit")
    rotations, falls = finite_vector("rotation", rotation, "rad"), flags("overturned", overturned)
    lifts = np.ones(falls.size, dtype=bool) if uplifted is None else flags("uplifted", uplifted)
    same_length(im=measures, rotation=rotations, overturned=falls, uplifted=lifts)
    limit = positive("threshold", threshold, "rad")
    _check(rotations, falls, limit)

    stands, moves = ~falls, (rotations > limit) & (lifts | falls)
    rocked = stands & moves
    counts = int((~moves).sum()), int(rocked.sum()), int(falls.sum())
    notes = [
        Note(f"Only {count} of {falls.size} runs {what}: fits of these runs are uncertain, see bootstrap_band.")
        for count, what in zip(counts, ("do not rock", "rock without overturning", "overturn"), strict=True)
        if 0 < count < FEW
    ]
    return OutcomeFragility(
        overturning=_curve("overturning", measures, falls, notes) or UnanimousOutcome(bool(falls[0]), falls.size),
        rocking=_curve("rocking", measures[stands], moves[stands], notes),
        initiation=_curve("initiation", measures, moves, notes) or UnanimousOutcome(bool(moves[0]), moves.size),
        rotation=_cloud(measures[rocked], rotations[rocked], notes),
        threshold=limit,
        lowest_limit=float(rotations[~moves].max(initial=limit)),
        highest_limit=float(rotations[falls].min(initial=0.5 * math.pi)),
        n_no_rocking=counts[0],
        n_rocking=counts[1],
        n_overturned=counts[2],
        notes=tuple(notes),
    )


def _check(rotations: Array, falls: Bools, threshold: float) -> None:
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


def _curve(name: str, im: Array, outcome: Bools, notes: list[Note]) -> LogisticFit | UnanimousOutcome | None:
    if outcome.size == 0:
        notes.append(Note(f"{name}: all runs overturned, so there is nothing to fit.", name))
        return None
    if outcome.all() or not outcome.any():
        alike = UnanimousOutcome(bool(outcome[0]), outcome.size)
        notes.append(Note(f"{name}: {'all' if alike.outcome else 'none'} of {alike.n} runs. {alike.note}", name))
        return alike
    try:
        fit = fit_logistic(im, outcome)
    except (InputError, SolverError) as error:
        notes.append(Note(f"{name}: {error}", name))
        return None
    if fit.note:
        notes.append(Note(f"{name}: {fit.note}", name))
    return fit


def _cloud(im: Array, rotation: Array, notes: list[Note]) -> CloudFit | None:
    try:
        return fit_cloud(im, rotation)
    except InputError as error:
        notes.append(Note(f"rotation: {error}", "rotation"))
        return None


def total_probability(falls: Array, rocks: Array, beyond: Array) -> Array:
    """P(OV) + P(no OV) P(rocking | no OV) P(θ_max > limit | rocking)."""
    return falls + _weighted(_weighted(1.0 - falls, rocks), beyond)


def _weighted(weight: Array, values: Array) -> Array:
    """The product; zero where the weight is zero, even if the value could not be fitted."""
    return np.where(weight == 0.0, 0.0, weight * values)[()]
