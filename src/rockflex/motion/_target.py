"""A spectrum that motions are chosen for and scaled to."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._checks import all_positive, finite_vector, in_range, instance, positive
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex._values import Value


@dataclass(frozen=True, eq=False, init=False, repr=False)
class TargetSpectrum(Value):
    """A target spectrum of pseudo-acceleration, from a table.

    Between two positive periods ln S_a is linear in ln T, so that branches of a code that are constant, or fall with
    1/T or 1/T², are exact between their corners. Between a period of zero and the next one S_a is linear in T. Outside
    the table the target is unknown.

    Parameters
    ----------
    periods : array_like, shape (m,)
        Increasing periods in s, at least two; the first may be zero, the ground acceleration.
    sa : array_like, shape (m,)
        Pseudo-acceleration in m/s², positive.
    damping_ratio : float
        Damping ratio for which the ordinates hold, 0 <= ζ < 1.
    name : str, optional
        Name for tables and figures.

    Raises
    ------
    InputError
        If periods do not increase, an ordinate is not positive, their numbers differ, or the damping ratio is out of
        range.

    Examples
    --------
    >>> import rockflex as rf
    >>> target = rf.TargetSpectrum([0.0, 0.1, 0.5, 2.0], [3.0, 7.5, 7.5, 1.875], name="site")
    >>> target
    TargetSpectrum('site', 0 to 2 s, up to 7.5 m/s², ζ = 0.05)
    >>> target.at([0.05, 0.3, 1.0]).round(12)
    array([5.25, 7.5 , 3.75])
    """

    periods: Array
    sa: Array
    damping_ratio: float = 0.05
    name: str = ""

    def __init__(self, periods: ArrayLike, sa: ArrayLike, damping_ratio: float = 0.05, name: str = "") -> None:
        period, ordinates = finite_vector("periods", periods, "s"), finite_vector("sa", sa, "m/s²")
        if period.size < 2 or period.size != ordinates.size:
            raise InputError(
                "periods and sa must have the same length of at least 2, but "
                f"{period.size} and {ordinates.size} values were given."
            )
        if period[0] < 0.0 or (np.diff(period) <= 0.0).any():
            wrong = 0 if period[0] < 0.0 else int(np.argmax(np.diff(period) <= 0.0)) + 1
            raise InputError(
                f"periods must increase from zero or more, but {period[wrong]:g} s was given at index {wrong}. Sort "
                "the table by period, and keep each period once.",
                field="periods",
            )
        all_positive("sa", ordinates, "m/s²")
        zeta = in_range("damping_ratio", damping_ratio, 0.0, 1.0, hint="It is a fraction: 5 % is 0.05.")
        vars(self).update(periods=period, sa=ordinates, damping_ratio=zeta, name=instance("name", name, str))

    def __repr__(self) -> str:
        span = f"{self.periods[0]:g} to {self.periods[-1]:g} s"
        return f"TargetSpectrum({self.name!r}, {span}, up to {self.sa.max():.4g} m/s², ζ = {self.damping_ratio:g})"

    def at(self, periods: ArrayLike) -> Array:
        """Return the pseudo-acceleration in m/s² at periods in s, shape (m,).

        Raises
        ------
        InputError
            If a period is outside the table.
        """
        period = finite_vector("periods", periods, "s")
        outside = (period < self.periods[0]) | (period > self.periods[-1])
        if outside.any():
            raise InputError(
                f"The target {shown(self.name)} is known from {self.periods[0]:g} to {self.periods[-1]:g} s, but not "
                f"at {period[np.argmax(outside)]:g} s. Choose periods within it, or extend the table.",
                field="periods",
            )
        table, ordinates = self.periods, self.sa
        found = np.empty(period.size)
        first = 0
        if table[0] == 0.0:
            first, low = 1, period < table[1]
            found[low] = ordinates[0] + (ordinates[1] - ordinates[0]) * (period[low] / table[1])
        high = period >= table[first]
        found[high] = np.exp(np.interp(np.log(period[high]), np.log(table[first:]), np.log(ordinates[first:])))
        return found

    def scaled(self, factor: float) -> "TargetSpectrum":
        """Return the target with all ordinates multiplied by a positive factor, such as a ratio to another level.

        Raises
        ------
        InputError
            If the factor is not positive, or an ordinate becomes too large.
        """
        with np.errstate(over="ignore"):
            ordinates = positive("factor", factor, "") * self.sa
        return TargetSpectrum(self.periods, ordinates, self.damping_ratio, self.name)
