"""Factors by which motions meet a spectral ordinate, or fit a target over a range of periods."""

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._checks import instance, positive
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.motion._periods import examined_periods
from rockflex.motion._samples import Samples
from rockflex.motion._target import TargetSpectrum


def factor_to(
    motion: Samples,
    name: str,
    target: TargetSpectrum | None,
    periods: ArrayLike | None,
    sa: float | None,
    period: float | None,
    damping_ratio: float | None,
) -> float:
    """Return the factor of a motion for a target over periods, or for one ordinate; see `GroundMotion.scaled_to`."""
    if target is not None and periods is not None and sa is None and period is None and damping_ratio is None:
        wanted = instance("target", target, TargetSpectrum)
        examined = examined_periods(periods)
        spectrum = motion.spectrum(examined, wanted.damping_ratio).sa
        return fitting_factor(spectrum, wanted.at(examined), name)
    if sa is None or period is None or target is not None or periods is not None:
        raise InputError(
            "scaled_to needs either a target and periods, or sa and period, with damping_ratio if it is not 0.05: "
            "motion.scaled_to(target, (0.2, 2.0)) or motion.scaled_to(sa=5.0, period=1.0). A target has its own "
            "damping ratio."
        )
    ordinate, at = positive("sa", sa, "m/s²"), positive("period", period, "s", zero=True)
    return ordinate / _moving(motion.sa(at, 0.05 if damping_ratio is None else damping_ratio), name, at)


def fitting_factor(spectrum: Array, target: Array, name: str) -> float:
    """Return the factor with the least mean square of ln(factor · spectrum / target)."""
    _moving(float(spectrum.min()), name, None)
    return float(np.exp(np.mean(np.log(target / spectrum))))


def _moving(sa: float, name: str, period: float | None) -> float:
    if sa <= 0.0 or not np.isfinite(sa):
        where = "" if period is None else f" at a period of {period:g} s"
        raise InputError(f"The motion {shown(name)} cannot be scaled to a spectrum: its own is {sa:g} m/s²{where}.")
    return sa
