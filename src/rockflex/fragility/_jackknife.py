"""How uncertain parameters are when runs share recordings: the jackknife that leaves out one recording at a time.

The covariance is (G - 1)/G Σ (θ_g - mean θ)(θ_g - mean θ)ᵀ over the parameters θ_g without recording g of G, and bands
follow Student's t with G - 1 degrees of freedom (MacKinnon, Nielsen & Webb 2023, J. Econometrics 232(2), 272-299:
their CV3J). Quantities that are not linear in the parameters, such as an annual rate, have the quantiles of their
values at parameters drawn from that t distribution.
"""

import math
from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockflex.foundation.arrays import Array, Bools
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.fragility._arguments import check_same_column_length, checked_confidence

N_SAMPLES = 2048  # parameters drawn; a power of two, as Sobol's sequence wants
_MAX_WEIGHTS = 2_000_000  # weights held at once
ONE_RECORDING = "All runs belong to one recording, so nothing is known about the scatter between recordings: no band."


class RecordingGroups(NamedTuple):
    """The number of the recording of every run, from 0 in the order in which they first appear, and how many there are.

    A subset of the runs may lack a recording; its parameters without that recording are then those of the subset. What
    has a row a recording has them in the order of their names, which other runs of the same recordings share.
    """

    codes: NDArray[np.int64]
    n: int
    by_name: NDArray[np.int64]

    @classmethod
    def of(cls, groups: ArrayLike) -> Self:
        """Number a column of names or numbers."""
        import pandas as pd

        try:
            labels = np.asarray(groups)
            if labels.ndim != 1:
                raise ValueError
            codes, names = pd.factorize(labels, use_na_sentinel=True)
        except (TypeError, ValueError) as error:
            raise InputError(
                f"groups must hold the name or number of the recording of every run, but {shown(groups)} was given.",
                field="groups",
            ) from error
        if (codes < 0).any():
            raise InputError(
                f"groups must name the recording of every run, but {int((codes < 0).sum())} names are missing.",
                field="groups",
            )
        return cls(codes.astype(np.int64), len(names), np.argsort(names.astype(str)))

    @classmethod
    def beside(cls, groups: ArrayLike | None, **columns: NDArray[np.generic]) -> Self | None:
        """Number the recordings of runs with these columns, all of one length; None without `groups`."""
        found = None if groups is None else cls.of(groups)
        check_same_column_length(**columns, **({} if found is None else {"groups": found.codes}))
        return found

    def some(self, chosen: Bools) -> "RecordingGroups":
        """The recordings of a subset of the runs, with the same numbers."""
        return self._replace(codes=self.codes[chosen])

    @property
    def held(self) -> Bools:
        """Whether there are runs of each recording, shape (n,)."""
        return np.bincount(self.codes, minlength=self.n)[self.by_name] > 0

    def without_each(self, fit: Callable[[Array], Array]) -> Array:
        """Parameters without each recording, shape (n, k); `fit` takes weights of shape (m, n)."""
        step = max(1, _MAX_WEIGHTS // max(1, self.codes.size))
        parts = (self.by_name[first : first + step, None] != self.codes for first in range(0, self.n, step))
        return np.concatenate([fit(part.astype(float)) for part in parts])


def jackknife_covariance(replicates: Array) -> Array:
    """Covariance of the parameters from their values without each recording.

    NaN for a single recording, and for parameters that could not be fitted without one of the recordings.
    """
    count = replicates.shape[0]
    known = np.isfinite(replicates).all(axis=0) & (count > 1)
    away = np.where(known, replicates, 0.0) - np.where(known, replicates, 0.0).mean(axis=0)
    covariance = (count - 1.0) / count * (away.T @ away)
    covariance[~known, :] = covariance[:, ~known] = np.nan
    return covariance


def student_t_quantile(confidence: float, n_groups: int) -> float:
    """Half width of a band in standard errors; of the normal distribution for `n_groups` = 0, independent runs."""
    from scipy.special import ndtri, stdtrit

    p = 0.5 + 0.5 * confidence
    return float(stdtrit(n_groups - 1, p) if n_groups > 1 else ndtri(p) if n_groups == 0 else np.nan)


def band_of_line(
    line: tuple[float, float], x: Array, covariance: Array, confidence: float, n_groups: int
) -> tuple[Array, Array]:
    """Confidence limits of a + b x at x, for the covariance of (a, b)."""
    variance = covariance[0, 0] + 2.0 * covariance[0, 1] * x + covariance[1, 1] * x**2
    error = np.sqrt(np.maximum(variance, 0.0))  # rounding may leave a small negative variance
    half, centre = student_t_quantile(checked_confidence(confidence), n_groups) * error, line[0] + line[1] * x
    return centre - half, centre + half


def sampled_fit_parameters(parameters: ArrayLike, covariance: Array, n_groups: int) -> Array:
    """Parameters drawn from the t distribution of an estimate, shape (N_SAMPLES, k); the same ones on every call."""
    values, vectors = np.linalg.eigh(covariance) if np.isfinite(covariance).all() else (np.nan, np.eye(len(covariance)))
    root = vectors * np.sqrt(np.maximum(values, 0.0)) @ vectors.T  # does not depend on the signs of the vectors
    return np.asarray(parameters) + _student_t_sample(len(covariance), n_groups) @ root


def sampled_by_recordings(estimate: Array, without: Array) -> Array:
    """Values of an estimate drawn from the normal distribution of the jackknife, shape (N_SAMPLES, ...).

    `without` has the estimate without each recording, shape (n_groups, ...). A draw has a score for each recording, so
    that estimates from the same recordings are drawn together.
    """
    count = len(without)
    moves: Array = math.sqrt((count - 1.0) / count) * (without - without.mean(axis=0))
    return estimate + np.einsum("sg,g...->s...", _student_t_sample(count, 0), moves)


def sampled_band_limits(values: Array, confidence: float) -> tuple[Any, Any]:
    """Lower and upper limit of values at drawn parameters, along the first axis."""
    low, high = np.quantile(values, (0.5 - 0.5 * confidence, 0.5 + 0.5 * confidence), axis=0)
    return low, high


@cache
def _student_t_sample(size: int, n_groups: int) -> Array:
    """Quasi-random sample of Student's t in `size` dimensions, with unit scale; normal for `n_groups` = 0."""
    from scipy.special import chdtri, ndtri
    from scipy.stats import qmc

    uniform = qmc.Sobol(size + 1, seed=0).random(N_SAMPLES)
    normal, freedom = ndtri(uniform[:, :size]), n_groups - 1
    if n_groups < 2:
        return normal
    return normal / np.sqrt(chdtri(freedom, uniform[:, size]) / freedom)[:, None]
