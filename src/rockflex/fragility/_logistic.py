"""Logistic regression of a yes-or-no outcome on the logarithm of an intensity measure."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array, Bools
from rockflex.foundation.errors import InputError, SolverError
from rockflex.foundation.html import HtmlTable
from rockflex.foundation.language import translated
from rockflex.foundation.values import Value
from rockflex.fragility import _jackknife, _regression
from rockflex.fragility._arguments import boolean_column, checked_confidence, log_measures, log_of_evaluation_points
from rockflex.fragility._hazard import measure_damping_of_column

Method = Literal["maximum likelihood", "Firth"]
FIRTH_TOLERANCE = 1e-4  # score and step of the penalised fit: the defaults of the package firthmodels


@dataclass(frozen=True)
class UnanimousOutcome:
    """An outcome that happened in every run, or in none; it replaces a curve that cannot be fitted.

    Attributes
    ----------
    outcome : bool
        Whether it happened in all runs, or in none.
    n : int
        Number of runs.
    n_groups : int
        Number of recordings, each of which counts once in a bound; 0 if the runs are taken as independent.

    Examples
    --------
    >>> import rockflex as rf
    >>> never = rf.UnanimousOutcome(outcome=False, n=44)
    >>> print(f"{never.bound(0.95):.3g}")
    0.0658
    """

    outcome: bool
    n: int
    n_groups: int = 0

    @property
    def note(self) -> str:
        """The conclusion in words."""
        return translated(
            "This gives only a bound: with 95 % confidence the probability, averaged over these runs, is above {bound} "
            "%."
            if self.outcome
            else "This gives only a bound: with 95 % confidence the probability, averaged over these runs, is below "
            "{bound} %.",
            bound=f"{100.0 * self.bound(0.95):.3g}",
        )

    def bound(self, confidence: float = 0.95) -> float:
        """Exact one-sided bound of the probability averaged over the runs, with the given confidence.

        An upper bound, 1 - (1 - confidence)^(1/m), if it never happened; a lower one, (1 - confidence)^(1/m), if it
        always did (Clopper & Pearson 1934, Biometrika 26(4), 404-413). m is the number of recordings, or of independent
        runs.
        """
        root = (1.0 - checked_confidence(confidence)) ** (1.0 / (self.n_groups or self.n))
        return root if self.outcome else 1.0 - root

    def probability(self, im: ArrayLike) -> Array:
        """1 or 0 as observed, of the shape of `im`."""
        return np.full_like(log_of_evaluation_points(im), 1.0 if self.outcome else 0.0)

    def band(self, im: ArrayLike, confidence: float = 0.9) -> tuple[Array, Array]:
        """Observed value and its one-sided bound with the given confidence, the same at every `im`."""
        seen, bound = self.probability(im), np.full_like(log_of_evaluation_points(im), self.bound(confidence))
        return (bound, seen) if self.outcome else (seen, bound)


@dataclass(frozen=True, eq=False, repr=False)
class LogisticFit(HtmlTable, Value):
    """The curve P = 1/(1 + exp(-(b0 + b1 log IM))), with the natural logarithm.

    Attributes
    ----------
    b0, b1 : float
        Intercept (at IM = 1) and slope.
    covariance : ndarray, shape (2, 2)
        Covariance of (b0, b1), read-only: the jackknife over recordings; for independent runs the inverse of the Fisher
        information at the estimate, without the penalty.
    n, n_events : int
        Number of runs, and of runs in which the outcome happened.
    method : str
        "maximum likelihood", or "Firth" where that has no finite slope.
    separated : bool
        Whether one measure separates the runs with the outcome from those without, so that maximum likelihood has no
        finite slope.
    note : str
        Warnings about the curve; empty if there are none.
    n_groups : int
        Number of recordings; 0 if the runs were taken as independent.
    damping : float or None
        Damping ratio of the spectral acceleration or displacement that IM is; None for other measures.
    measured : tuple of float, or None
        Smallest and largest measure of the runs; outside, the curve is extrapolated.
    without : ndarray, shape (n_groups, 2), or None
        (b0, b1) without each recording, in the order of their names; None for independent runs.

    Examples
    --------
    >>> import rockflex as rf
    >>> fit = rf.fit_logistic([0.1, 0.2, 0.3, 0.4, 0.5, 0.6],
    ...     [False, False, True, False, True, True])
    >>> print(f"{fit.median:.3g}, {fit.dispersion:.3g}")
    0.327, 0.253
    >>> fit.probability([0.2, 0.5]).round(3).tolist()
    [0.125, 0.843]
    """

    b0: float
    b1: float
    covariance: Array
    n: int
    n_events: int
    method: Method
    separated: bool
    note: str
    n_groups: int = 0
    damping: float | None = None
    measured: tuple[float, float] | None = None
    without: Array | None = None

    def __repr__(self) -> str:
        rises = f"median={self.median:.4g}, dispersion={self.dispersion:.4g}, " if self.b1 > 0.0 else ""
        separated = ", separated" if self.separated else ""
        return (
            f"LogisticFit(b0={self.b0:.4g}, b1={self.b1:.4g}, {rises}{self.n_events} of {self.n} runs, "
            f"{self.method}{separated})"
        )

    def _shown_as(self) -> Mapping[str, Any]:
        return {
            "b0": self.b0,
            "b1": self.b1,
            "median": self.median,
            "dispersion": self.dispersion,
            "events": f"{self.n_events} of {self.n} runs",
            "method": f"{self.method}, separated" if self.separated else self.method,
            "note": self.note or None,
        }

    @property
    def median(self) -> float:
        """The measure at which P = 0.5, exp(-b0/b1); NaN for a curve that does not rise."""
        return math.exp(-self.b0 / self.b1) if self.b1 > 0.0 else math.nan

    @property
    def dispersion(self) -> float:
        """Scale 1/b1 of the logistic distribution of log capacity; NaN for a curve that does not rise.

        The standard deviation of that distribution is π/√3 times as large.
        """
        return 1.0 / self.b1 if self.b1 > 0.0 else math.nan

    def probability(self, im: ArrayLike) -> Array:
        """Probability of the outcome, of the shape of `im`."""
        from scipy.special import expit

        return expit(self.b0 + self.b1 * log_of_evaluation_points(im))

    def band(self, im: ArrayLike, confidence: float = 0.9) -> tuple[Array, Array]:
        """Lower and upper confidence limits of the probability, from the limits of b0 + b1 log IM.

        Student's t with `n_groups` - 1 degrees of freedom; the normal distribution for independent runs. NaN if all
        runs belong to one recording.
        """
        from scipy.special import expit

        x = log_of_evaluation_points(im)
        low, high = _jackknife.band_of_line((self.b0, self.b1), x, self.covariance, confidence, self.n_groups)
        return expit(low), expit(high)

    def drawn(self, im: Array) -> Array:
        """Probabilities at `im`, shape (m,), for 2048 parameters drawn from the t distribution of the estimate."""
        from scipy.special import expit

        b = _jackknife.sampled_fit_parameters((self.b0, self.b1), self.covariance, self.n_groups)
        return expit(b[:, :1] + b[:, 1:] * np.log(im))

    def probability_without(self, im: Array) -> Array | None:
        """Probabilities at `im`, shape (m,), without each recording, shape (n_groups, m); None for independent runs."""
        from scipy.special import expit

        return None if self.without is None else expit(self.without[:, :1] + self.without[:, 1:] * np.log(im))


def fit_logistic(
    im: ArrayLike, outcome: ArrayLike, groups: ArrayLike | None = None, *, damping: float | None = None
) -> LogisticFit:
    """Fit a logistic curve by maximum likelihood (Silva & Stojadinović 2024, Figure 5).

    If one measure separates the runs with the outcome from those without, the likelihood increases with the slope
    without limit. The curve is then fitted with Firth's penalty, which gives a finite slope for any data (Firth 1993,
    Biometrika 80(1), 27-38; Heinze & Schemper 2002, Stat. Med. 21(16), 2409-2419), and `method`, `separated` and `note`
    report it.

    Parameters
    ----------
    im : array_like, shape (n,)
        Intensity measure of every run, in any one unit.
    outcome : array_like, shape (n,)
        Whether it happened: booleans, or 1 and 0.
    groups : array_like, shape (n,), optional
        Name or number of the recording of every run, the same for both components and all scales: the column `group` of
        a study. Without it the band assumes independent runs, and is too narrow where recordings repeat.
    damping
        Damping ratio of the spectral acceleration or displacement that `im` is, which `annual_rate` compares with the
        hazard curve's. Default: another measure, or not known; a column named sa_t1_5 is at 5 %, and with sa_t1 or
        sd_t1 a rate is refused.

    Raises
    ------
    InputError
        If a measure is not positive and finite, all are the same, an outcome is neither true nor false, all
        outcomes are alike, or the name of a recording is missing.

    Examples
    --------
    >>> import rockflex as rf
    >>> fit = rf.fit_logistic([0.1, 0.2, 0.3, 0.4, 0.5, 0.6],
    ...     [False, False, True, False, True, True])
    >>> print(f"{fit.b0:.3g}, {fit.b1:.3g}")
    4.42, 3.96
    >>> fit.method
    'maximum likelihood'
    """
    x = log_measures(im)
    y = boolean_column("outcome", outcome)
    return fit_logistic_curve(
        x, y, _jackknife.RecordingGroups.beside(groups, im=x, outcome=y), measure_damping_of_column(im, damping)
    )[0]


def fit_logistic_curve(
    x: Array, y: Bools, recordings: _jackknife.RecordingGroups | None, damping: float | None
) -> tuple[LogisticFit, Array | None]:
    """Fit a curve through logarithms of equal length; the fit, and its parameters without each recording."""
    if y.all() or not y.any():
        alike = UnanimousOutcome(bool(y[0]), y.size, 0 if recordings is None else int(recordings.held.sum()))
        raise InputError(
            f"outcome is {alike.outcome} in all {alike.n} runs, so there is no curve to fit. {alike.note} "
            "Add runs at other measures, or use fit_outcomes, which accepts such a group."
        )
    scaled = _regression.StandardisedLogs(x)
    unit = np.ones((1, x.size))
    scoring = _regression.FirthScoringOptions(FIRTH_TOLERANCE / y.size, FIRTH_TOLERANCE, augmented=True)
    curve = _regression.fit_logistic_curves(scaled.x, y, unit, scoring)
    if not np.isfinite(curve.parameters).all():
        raise SolverError(
            f"Firth's penalised likelihood did not converge for {y.size} runs with {int(y.sum())} events. "
            "Look for a single run far from all others."
        )
    count, replicates, without = 0, None, None
    if recordings is None:
        covariance = np.linalg.inv(_regression.fisher_information(scaled.x, unit, curve.parameters)[0])
    else:
        count = int(recordings.held.sum())
        replicates = recordings.without_each(
            lambda some: _regression.fit_logistic_curves(scaled.x, y, some, scoring).parameters
        )
        covariance = _jackknife.jackknife_covariance(replicates[recordings.held])
        replicates = scaled.back(replicates)
        without = replicates[recordings.held]
    b0, b1, covariance = scaled.unscaled(curve.parameters[0], covariance)
    separated = bool(curve.separated[0])
    method: Method = "Firth" if curve.penalised[0] else "maximum likelihood"
    notes: list[str] = []
    if separated:
        low, high = _outcome_separation_gap(x, y)
        notes.append(
            translated(
                "Separated between im = {low} and {high}: maximum likelihood has no finite slope, so Firth's penalty "
                "was used. Median and slope are uncertain by the width of that gap.",
                low=f"{low:.4g}",
                high=f"{high:.4g}",
            )
        )
    elif method == "Firth":
        notes.append(translated("Nearly separated: maximum likelihood did not converge, so Firth's penalty was used."))
    if b1 <= 0.0:
        notes.append(
            translated(
                "The probability does not rise with im (b1 = {slope}), so there is no median or dispersion.",
                slope=f"{b1:.3g}",
            )
        )
    if count == 1:
        notes.append(translated(_jackknife.ONE_RECORDING))
    events = int(y.sum())
    ends, note = (math.exp(x.min()), math.exp(x.max())), " ".join(notes)
    fit = LogisticFit(b0, b1, covariance, y.size, events, method, separated, note, count, damping, ends, without)
    return fit, replicates


def _outcome_separation_gap(x: Array, y: Bools) -> tuple[float, float]:
    below, above = (~y, y) if x[~y].max() <= x[y].min() else (y, ~y)
    return math.exp(x[below].max()), math.exp(x[above].min())


def describe_logistic_curve(curve: LogisticFit | UnanimousOutcome) -> str:
    """Return the median and the dispersion of a curve, or why it has none, as text."""
    if isinstance(curve, UnanimousOutcome):
        return f"in {'all' if curve.outcome else 'none'} of {curve.n} runs"
    if curve.b1 <= 0.0:
        return f"does not rise (b1 = {curve.b1:.4g})"
    return f"median {curve.median:.4g}, dispersion {curve.dispersion:.4g}"
