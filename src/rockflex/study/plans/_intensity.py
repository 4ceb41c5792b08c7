"""Intensity measures of a scaled motion, seen from a structure."""

import math

from rockflex._checks import one_of
from rockflex._constants import GRAVITY
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.modal import RockingProperties
from rockflex.motion import GroundMotion

MEASURES = ("pga", "pgv", "pgd", "arias", "cav", "sd_t1", "sa_t1", "relative_pga", "relative_pgv")
STIFF = 1e-6  # s
SQUARED = frozenset({"arias"})  # of the acceleration; all others are linear in it


def intensity_measures(properties: RockingProperties, motion: GroundMotion) -> dict[str, float]:
    """Measures of a motion by their names, those of `GroundMotion` and four that look at the structure.

    `sd_t1` (m) and `sa_t1` (m/s²) are spectral ordinates at the first period and its damping ratio, NaN for a rigid
    block. `relative_pga` is pga/(g tan α) and `relative_pgv` is p pgv/(g tan α), without units, with g tan α =
    M_r/L_0^r, the acceleration that lifts the base of the rigid structure, and p² = L_0^r g/I_θ.
    """
    measures = {name: float(getattr(motion, name)) for name in ("pga", "pgv", "pgd", "arias", "cav")}
    sd, omega = math.nan, math.nan
    if properties.n_modes:
        omega = float(properties.omega[0])
        period = 2.0 * math.pi / omega
        # A structure so stiff moves with the ground, and no spectrum has its period.
        sd = motion.sd(period, float(properties.zeta[0])) if period >= STIFF else motion.pga / omega**2
    lifting = properties.resisting_moment / properties.l0r
    rate = math.sqrt(properties.l0r * GRAVITY / properties.i_theta)
    measures |= {"sd_t1": sd, "sa_t1": omega**2 * sd}
    return measures | {
        "relative_pga": measures["pga"] / lifting,
        "relative_pgv": rate * measures["pgv"] / lifting,
    }


def scaled_measures(measures: dict[str, float], scale: float) -> dict[str, float]:
    """Measures of the motion multiplied by `scale`, of either sign."""
    factor = abs(scale)
    return {name: value * factor * (factor if name in SQUARED else 1.0) for name, value in measures.items()}


def factor_to(measures: dict[str, float], name: str, level: float) -> float:
    """Scale at which a measure reaches a level; infinite or NaN where none does."""
    value = measures[name]
    if not value > 0.0:
        return math.inf
    return math.sqrt(level / value) if name in SQUARED else level / value


def check_measure(name: str) -> None:
    """Raise an InputError unless there is such a measure."""
    if not one_of(name, MEASURES):
        raise InputError(f"measure must be one of {', '.join(MEASURES)}, but {shown(name)} was given.")
