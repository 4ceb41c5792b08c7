"""A ground motion together with the properties of a structure that some intensity measures need."""

import math
from dataclasses import dataclass
from functools import cached_property

from rockflex.motion._ground_motion import GroundMotion

STIFF = 1e-6  # s


@dataclass(frozen=True)
class Shaking:
    """The input of an intensity measure: a motion and properties of the structure; unknown properties are NaN.

    Attributes
    ----------
    motion : GroundMotion
        The motion.
    omega, damping_ratio : float
        Circular frequency in rad/s and damping ratio of the first mode on a fixed base.
    lifting : float
        Acceleration in m/s² that lifts the base of the structure if it were rigid, g tan α = M_r/L_0^r.
    rate : float
        Frequency parameter p of the rocking structure in rad/s, p² = L_0^r g/I_θ.
    """

    motion: GroundMotion
    omega: float = math.nan
    damping_ratio: float = math.nan
    lifting: float = math.nan
    rate: float = math.nan

    @cached_property
    def sd(self) -> float:
        """Spectral displacement in m of the first mode; NaN if there is no mode."""
        return self.sd_at(self.damping_ratio)

    def sd_at(self, damping_ratio: float) -> float:
        """Spectral displacement in m at the period of the first mode and another damping; NaN if there is no mode."""
        if math.isnan(self.omega):
            return math.nan
        period = 2.0 * math.pi / self.omega
        # Such a stiff structure moves with the ground; its period is below those of a spectrum.
        return self.motion.sd(period, damping_ratio) if period >= STIFF else self.motion.pga / self.omega**2
