"""Fragility curves of lognormal shape."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._checks import finite_matrix, positive
from rockflex._errors import InputError
from rockflex._html import HtmlTable
from rockflex._values import Value
from rockflex.fragility._arguments import checked_confidence, fractions, log_at
from rockflex.fragility._recordings import ONE_RECORDING, drawn, jackknifed, quantile_of_t


@dataclass(frozen=True, eq=False)
class LognormalFragility(HtmlTable, Value):
    """The curve P = Φ(ln(IM/median)/beta).

    Attributes
    ----------
    median : float
        Median capacity, in the unit of IM.
    beta : float
        Standard deviation of the logarithm of the capacity.
    covariance : ndarray, shape (2, 2), or None
        Covariance of (ln median, beta), read-only: the jackknife over recordings, or that of independent runs or
        records; None where it is not known.
    n : int
        Number of runs or records in the fit; 0 for a curve that was given.
    method : str
        Method of the fit.
    n_groups : int
        Number of recordings; 0 if the runs or records were taken as independent.
    damping : float or None
        Damping ratio of the spectral acceleration or displacement that IM is; None for other measures.

    Raises
    ------
    InputError
        If the median or beta is not positive and finite, or the covariance is not a finite 2 by 2 matrix.

    Examples
    --------
    >>> import rockflex as rf
    >>> curve = rf.LognormalFragility(median=0.5, beta=0.4)
    >>> print(f"{curve.probability(0.3):.3g}, {curve.quantile(0.84):.3g}")
    0.101, 0.744
    """

    median: float
    beta: float
    covariance: Array | None = None
    n: int = 0
    method: str = "given"
    n_groups: int = 0
    damping: float | None = None

    def __post_init__(self) -> None:
        median = positive("median", self.median, "the unit of IM")
        vars(self).update(median=median, beta=positive("beta", self.beta, "natural logarithms"))
        if self.covariance is not None:
            matrix = finite_matrix("covariance", self.covariance, "natural logarithms squared", (2, 2))
            matrix.setflags(write=False)
            vars(self).update(covariance=matrix)

    def probability(self, im: ArrayLike) -> Array:
        """Probability of failure, of the shape of `im`."""
        from scipy.special import ndtr

        return ndtr(self._score(im))

    def quantile(self, p: ArrayLike) -> Array:
        """Capacity that a fraction `p` stay below, of the shape of `p`."""
        from scipy.special import ndtri

        return self.median * np.exp(self.beta * ndtri(fractions("p", p)))

    def band(self, im: ArrayLike, confidence: float = 0.9) -> tuple[Array, Array]:
        """Lower and upper confidence limits of the probability: delta method on ln(IM/median)/beta, then Φ.

        Student's t with `n_groups` - 1 degrees of freedom; the normal distribution for independent runs.

        Raises
        ------
        InputError
            If the covariance is not known.
        """
        from scipy.special import ndtr

        z = self._score(im)
        gradient = np.stack((np.full_like(z, -1.0), -z)) / self.beta
        error = np.sqrt(np.einsum("i...,ij,j...->...", gradient, self._known_covariance, gradient))
        half = quantile_of_t(checked_confidence(confidence), self.n_groups) * error
        return ndtr(z - half), ndtr(z + half)

    @property
    def _known_covariance(self) -> Array:
        if self.covariance is None:
            why = "which this curve was given without" if self.n_groups != 1 else f"but: {ONE_RECORDING}"
            raise InputError(f"A band needs the covariance of (ln median, beta), {why}.".replace("..", "."))
        return self.covariance

    def drawn(self, im: Array) -> Array:
        """Probabilities at `im`, shape (m,), for 2048 parameters drawn from the t distribution of the estimate."""
        from scipy.special import ndtr

        away = score_derivatives(self.median, self.beta)
        score = -math.log(self.median) / self.beta, 1.0 / self.beta
        b = drawn(score, away @ self._known_covariance @ away.T, self.n_groups)
        return ndtr(b[:, :1] + b[:, 1:] * np.log(im))

    def _score(self, im: ArrayLike) -> Array:
        with np.errstate(over="ignore"):  # a nearly zero dispersion makes a step
            return (log_at(im) - math.log(self.median)) / self.beta


def score_derivatives(median: float, beta: float) -> Array:
    """Derivatives of intercept and slope of the normal score of log(IM) by (ln median, beta)."""
    return np.array([[-1.0 / beta, math.log(median) / beta**2], [0.0, -1.0 / beta**2]])


def covariance_of_scores(replicates: Array, median: float, beta: float) -> Array | None:
    """Covariance of (ln median, beta) from intercepts and slopes without each recording; None if it is not known."""
    covariance = jackknifed(replicates)
    if not np.isfinite(covariance).all():
        return None
    back = np.linalg.inv(score_derivatives(median, beta))
    return back @ covariance @ back.T
