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
        Covariance of (ln median, beta), read-only; None where it is not known.
    n : int
        Number of runs or records in the fit; 0 for a curve that was given.
    method : str
        Method of the fit.

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

        Raises
        ------
        InputError
            If the covariance is not known.
        """
        from scipy.special import ndtr, ndtri

        if self.covariance is None:
            raise InputError("A band needs the covariance of (ln median, beta), which this curve was given without.")
        z = self._score(im)
        gradient = np.stack((np.full_like(z, -1.0), -z)) / self.beta
        error = np.sqrt(np.einsum("i...,ij,j...->...", gradient, self.covariance, gradient))
        half = ndtri(0.5 + 0.5 * checked_confidence(confidence)) * error
        return ndtr(z - half), ndtr(z + half)

    def _score(self, im: ArrayLike) -> Array:
        with np.errstate(over="ignore"):  # a nearly zero dispersion makes a step
            return (log_at(im) - math.log(self.median)) / self.beta
