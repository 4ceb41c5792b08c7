"""Seismic hazard curves."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._checks import finite_vector
from rockflex._errors import InputError
from rockflex._values import Value
from rockflex.fragility._arguments import log_at


@dataclass(frozen=True, eq=False, init=False)
class HazardCurve(Value):
    """Mean annual rate at which an intensity measure is exceeded; a power law between two points.

    Parameters
    ----------
    im : array_like, shape (n,)
        Intensity measures, positive and rising, two at least, in the unit of the fragility curve.
    rate : array_like, shape (n,)
        Annual rates λ in 1/year at which they are exceeded, positive and falling.

    Raises
    ------
    InputError
        If the columns differ in length, are not positive, or do not rise and fall as they should.

    Examples
    --------
    >>> import rockflex as rf
    >>> hazard = rf.HazardCurve([0.1, 0.2, 0.4, 0.8], [1e-2, 3e-3, 6e-4, 1e-4])
    >>> print(f"{hazard.rate_at(0.3):.3g}, {hazard.im_at(1e-3):.3g}")
    0.00117, 0.321
    """

    im: Array
    rate: Array

    def __init__(self, im: ArrayLike, rate: ArrayLike) -> None:
        measures, rates = finite_vector("im", im, "one unit"), finite_vector("rate", rate, "1/year")
        if measures.size != rates.size or measures.size < 2:
            raise InputError(
                f"A hazard curve needs two points or more, a rate for each measure, but {measures.size} measures and "
                f"{rates.size} rates were given."
            )
        if measures[0] <= 0.0 or (np.diff(measures) <= 0.0).any():
            raise InputError(
                "im must be positive and rise from point to point. Sort the curve by im and drop repeated points."
            )
        bad = np.flatnonzero((rates <= 0.0) | (np.diff(rates, prepend=np.inf) >= 0.0))
        if bad.size:
            raise InputError(
                f"rate must be positive and fall from point to point, but rate[{bad[0]}] = {rates[bad[0]]:g} does not. "
                "Give annual rates of exceedance; drop the points at which the rate is zero."
            )
        vars(self).update(im=measures, rate=rates)

    @property
    def slopes(self) -> Array:
        """Exponent k of λ ∝ IM^-k in each segment, shape (n - 1,)."""
        return -np.diff(np.log(self.rate)) / np.diff(np.log(self.im))

    def rate_at(self, im: ArrayLike) -> Array:
        """Annual rate at which `im` is exceeded, interpolated linearly in logarithms."""
        return np.exp(_between("im", log_at(im), np.log(self.im), np.log(self.rate)))

    def im_at(self, rate: ArrayLike) -> Array:
        """Measure that is exceeded at an annual `rate`: the uniform-hazard value (2 % in 50 years is 1/2475)."""
        return np.exp(_between("rate", log_at(rate, "rate"), np.log(self.rate[::-1]), np.log(self.im[::-1])))


def _between(name: str, x: Array, points: Array, values: Array) -> Array:
    margin = 1e-12 * (points[-1] - points[0])
    if (x < points[0] - margin).any() or (x > points[-1] + margin).any():
        raise InputError(
            f"{name} must lie between {np.exp(points[0]):.4g} and {np.exp(points[-1]):.4g}, the ends of the hazard "
            "curve, which is not extrapolated."
        )
    return np.interp(x, points, values)
