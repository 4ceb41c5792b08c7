"""A ground motion beside the numbers of a structure that some intensity measures refer to."""

import math
from dataclasses import dataclass
from functools import cached_property

from rockflex.motion._ground_motion import GroundMotion

STIFF = 1e-6  # s


@dataclass(frozen=True)
class Shaking:
    """What intensity measures are computed from: a motion, and what it shakes; a number that is not known is NaN.

    Attributes
    ----------
    motion : GroundMotion
        The motion.
    omega, damping_ratio : float
        Of the first mode on a fixed base, in rad/s and as a fraction of critical.
    lifting : float
        Acceleration in m/s² that lifts the base of the structure if it is rigid, g tan α = M_r/L_0^r.
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
        """Spectral displacement in m of the first mode; NaN if there is none."""
        if math.isnan(self.omega):
            return math.nan
        period = 2.0 * math.pi / self.omega
        # A structure so stiff moves with the ground, and no spectrum has its period.
        return self.motion.sd(period, self.damping_ratio) if period >= STIFF else self.motion.pga / self.omega**2
