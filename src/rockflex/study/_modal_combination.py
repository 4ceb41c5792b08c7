"""Modal combination of 2DOF-S and the second mode on a fixed base (Section 3.4)."""

import math
from dataclasses import dataclass
from typing import Literal

from rockflex._errors import InputError
from rockflex.modal import RockingProperties
from rockflex.motion import GroundMotion
from rockflex.response import Response
from rockflex.study._arguments import WORK_LIMIT, RockingStructure, properties_of
from rockflex.study._simulate import simulate


@dataclass(frozen=True)
class SecondMode:
    """Peaks of the second mode on a fixed base.

    Attributes
    ----------
    displacement : float
        S_d(ω_2) in m.
    top_displacement : float
        |Γ_2 φ_top,2| S_d(ω_2) in m.
    base_shear : float
        m*_2 S_a(ω_2) in N.
    base_moment : float
        m*_2 |h*_2| S_a(ω_2) in N m.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0, damping_ratio=0.02)
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=0.8)
    >>> second = rf.modal_combination(frame, pulse).second
    >>> round(second.displacement, 4)
    0.0024
    """

    displacement: float
    top_displacement: float
    base_shear: float
    base_moment: float


@dataclass(frozen=True)
class CombinedPeaks:
    """Peaks of 2DOF-S and of the second mode, and their combination.

    Attributes
    ----------
    rocking : Response
        Response of 2DOF-S: peaks only.
    second : SecondMode
        Peaks of the second mode on a fixed base.
    max_top_displacement, max_base_shear, max_base_moment : float
        Square root of the sum of the two squares, in m, N and N m.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0, damping_ratio=0.02)
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=0.8)
    >>> peaks = rf.modal_combination(frame, pulse)
    >>> round(peaks.max_top_displacement, 4)
    0.0258
    """

    rocking: Response
    second: SecondMode
    max_top_displacement: float
    max_base_shear: float
    max_base_moment: float


def second_mode(properties: RockingProperties, motion: GroundMotion) -> SecondMode:
    """Return the peaks of the second mode, as an oscillator on a fixed base.

    Raises
    ------
    InputError
        If the structure has only one mode.
    """
    if properties.n_modes < 2:
        raise InputError(
            f"A modal combination needs two modes, but the structure has {properties.n_modes}. Give more modes."
        )
    omega = float(properties.omega[1])
    displacement = motion.sd(2.0 * math.pi / omega, float(properties.zeta[1]))
    force = float(properties.effective_mass[1]) * omega**2 * displacement
    return SecondMode(
        displacement=displacement,
        top_displacement=abs(float(properties.top_ordinate[1])) * displacement,
        base_shear=force,
        base_moment=abs(float(properties.effective_height[1])) * force,
    )


def combine(rocking: Response, second: SecondMode) -> CombinedPeaks:
    """Return the square root of the sum of the squares of the two peaks, for each quantity."""
    return CombinedPeaks(
        rocking=rocking,
        second=second,
        max_top_displacement=math.hypot(rocking.max_top_displacement, second.top_displacement),
        max_base_shear=math.hypot(rocking.max_base_shear, second.base_shear),
        max_base_moment=math.hypot(rocking.max_base_moment, second.base_moment),
    )


def modal_combination(
    structure: RockingStructure | RockingProperties,
    motion: GroundMotion,
    free_vibration: float | Literal["settle"] = 0.0,
    work_limit: float | None = WORK_LIMIT,
) -> CombinedPeaks:
    """Estimate peaks of a structure from 2DOF-S and its second mode on a fixed base, by SRSS.

    This is Yim & Chopra's rule. In the paper it improves the base shear and hardly changes top displacement and base
    moment (Silva & Stojadinović 2024, Section 3.4 and Fig. 13).

    Parameters
    ----------
    structure
        A structure with at least two modes, or its `RockingProperties`.
    motion
        The ground motion.
    free_vibration, work_limit
        As in `simulate`.

    Returns
    -------
    CombinedPeaks

    Raises
    ------
    InputError
        If the structure has only one mode, or as in `simulate`.
    SolverError
        If the run cannot be solved.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0, damping_ratio=0.02)
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=0.8)
    >>> peaks = rf.modal_combination(frame, pulse)
    >>> round(peaks.max_base_shear / peaks.rocking.max_base_shear, 3)
    1.004
    """
    properties = properties_of(structure)
    rocking = simulate(
        properties, motion, "2DOF-S", output="peaks", free_vibration=free_vibration, work_limit=work_limit
    )
    return combine(rocking, second_mode(properties, motion))
