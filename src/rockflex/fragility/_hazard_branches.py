"""An uncertain hazard: curves with weights, as of the branches of a logic tree, or with a lognormal dispersion."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import (
    checked_finite_vector,
    checked_instance,
    checked_instances,
    checked_magnitude,
    checked_positive,
)
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.foundation.values import Value
from rockflex.fragility._hazard import HazardCurve

N_BRANCHES = 24  # of a lognormal dispersion: Gauss and Hermite's, which knows the variance to 1e-7 up to:
MAX_DISPERSION = 3.0


@dataclass(frozen=True, eq=False, init=False)
class HazardBranches(Value):
    """Hazard curves one of which is the true one, each with the probability that it is.

    Parameters
    ----------
    curves : sequence of HazardCurve
        Two or more, in one measure: those of the branches of a logic tree, or fractiles.
    weights : array_like, shape (n,), optional
        Positive, in proportion to the probabilities. Default: equal. For the fractiles 0.05, 0.5 and 0.95 of a curve
        0.185, 0.63 and 0.185 keep mean and variance best (Keefer & Bodily 1983, Management Science 29(5), 595-609).

    Attributes
    ----------
    curves : tuple of HazardCurve
    weights : ndarray, shape (n,)
        Probabilities, which sum to 1.

    Raises
    ------
    InputError
        If there are fewer than two curves, their damping differs, or a weight is not positive.

    Examples
    --------
    >>> import rockflex as rf
    >>> low, high = (rf.HazardCurve([0.1, 0.4, 1.6], [1e-2, rate, rate / 30])
    ...     for rate in (4e-4, 9e-4))
    >>> rf.HazardBranches([low, high], weights=[2, 1]).weights.round(3)
    array([0.667, 0.333])
    """

    curves: tuple[HazardCurve, ...]
    weights: Array

    def __init__(self, curves: Sequence[HazardCurve], weights: ArrayLike | None = None) -> None:
        known = checked_instances("curves", curves, HazardCurve)
        for curve in known:
            known[0].check_damping(curve.damping)
        if len(known) < 2:
            raise InputError(
                f"curves must be two hazard curves or more, but {len(known)} were given. A hazard that is certain is "
                "a HazardCurve; with a dispersion it is HazardBranches.lognormal(curve, 0.5).",
                field="curves",
            )
        given = np.ones(len(known)) if weights is None else checked_finite_vector("weights", weights, "")
        if given.size != len(known) or not (given > 0.0).all():
            raise InputError(
                f"weights must be {len(known)} positive numbers, one for each curve, but {shown(weights)} was given.",
                field="weights",
            )
        vars(self).update(curves=known, weights=given / given.sum())
        self.__post_init__()

    @classmethod
    def lognormal(cls, mean: HazardCurve, dispersion: float) -> Self:
        """Return branches on which the rates of a mean curve are multiplied by a lognormal factor of mean 1.

        Parameters
        ----------
        mean
            The mean hazard curve, which codes and programs give unless they say otherwise. A median curve has to be
            multiplied by exp(dispersion²/2) before.
        dispersion
            Standard deviation of the logarithm of the rates: ln(λ_84/λ_16)/2 of two fractiles.

        Raises
        ------
        InputError
            If the dispersion is not positive, or above 3.

        Examples
        --------
        >>> import rockflex as rf
        >>> mean = rf.HazardCurve([0.1, 0.4, 1.6], [1e-2, 6e-4, 2e-5])
        >>> hazard = rf.HazardBranches.lognormal(mean, 0.5)
        >>> rates = [curve.rate_at(0.4) for curve in hazard.curves]
        >>> print(f"{hazard.weights @ rates:.3g}")
        0.0006
        """
        checked_instance("mean", mean, HazardCurve)
        unit = "natural logarithms"
        sigma = checked_magnitude("dispersion", checked_positive("dispersion", dispersion, unit), MAX_DISPERSION, unit)
        scores, weights = np.polynomial.hermite_e.hermegauss(N_BRANCHES)
        return cls(
            [
                HazardCurve(mean.im, mean.rate * math.exp(sigma * score - 0.5 * sigma**2), damping=mean.damping)
                for score in scores.tolist()
            ],
            weights,
        )

    def __repr__(self) -> str:
        return f"HazardBranches({len(self.curves)} curves)"
