"""Intensity measures of a scaled motion for a structure."""

import math

from rockflex._constants import GRAVITY
from rockflex.modal import RockingProperties
from rockflex.motion import MEASURES, GroundMotion, Shaking, intensities


def intensity_measures(properties: RockingProperties, motion: GroundMotion) -> dict[str, float]:
    """Return the measures of a motion for a structure, by name; those of a mode are NaN for a rigid block."""
    omega, zeta = math.nan, math.nan
    if properties.n_modes:
        omega, zeta = float(properties.omega[0]), float(properties.zeta[0])
    rate = math.sqrt(properties.l0r * GRAVITY / properties.i_theta)
    shaking = Shaking(motion, omega, zeta, properties.uplift_acceleration, rate)
    return {measure.name: float(measure.of(shaking)) for measure in intensities()}


def scaled_measures(measures: dict[str, float], scale: float) -> dict[str, float]:
    """Return the measures of the motion multiplied by `scale`, which may be negative."""
    return {name: MEASURES[name].scaled(value, scale) for name, value in measures.items()}
