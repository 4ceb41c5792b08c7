"""Uplifted frequencies of structures of many widths, and the modal combination of 2DOF-S and the second mode."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, SupportsIndex

from rockflex.foundation.checks import checked_whole_number, number_of_dimensions
from rockflex.foundation.errors import InputError
from rockflex.motion._ground_motion import GroundMotion
from rockflex.response._response import Response
from rockflex.structure._rocking import RockingProperties
from rockflex.structure._uplifted import uplifted_modes
from rockflex.studies._arguments import RockingStructure, checked_positive_numbers, rocking_properties_of
from rockflex.studies._simulate import simulate
from rockflex.studies.running import WorkLimit

if TYPE_CHECKING:
    import pandas as pd


def frequency_ratios(
    structure: RockingStructure | RockingProperties,
    aspect_ratios: Sequence[float],
    n_modes: SupportsIndex | Sequence[SupportsIndex | None] | None = (1, 2, None),
    *,
    side: int | None = None,
) -> "pd.DataFrame":
    """Ratio of uplifted to fixed-base frequencies of a structure, for bases of many widths.

    The structure above the base and all masses stay the same; the half width is B = h*_1/(aspect ratio), and I_θ
    changes with m_tot B². For large B the ratios tend to 1. For small B and all modes they approach those of the pinned
    beam (`pinned_beam`), the more closely the more evenly the mass is distributed; with fewer modes they exceed them.

    Parameters
    ----------
    structure
        A structure, or its `RockingProperties`, on a base of any width. Tendons and eccentricity do not change, so
        every base must be wide enough for them.
    aspect_ratios
        h*_1/B, positive.
    n_modes
        Modes to keep: 1 for 2DOF-S, 2 for 3DOF-S, None for all; or a sequence of these.
    side
        1 for motion about the right edge of the base, -1 about the left one. Default: the edge about which each base
        lifts first; both give the same result if the structure is symmetric.

    Returns
    -------
    pandas.DataFrame
        One row a model, aspect ratio and mode, models outermost: `model` ("2DOF-S", ..., "MDOF-S" for all), `n_modes`,
        `aspect_ratio`, `half_width` (m), `mode` (from 1), `omega` and `uplifted_omega` (ω_n and ω*_n in rad/s) and
        `ratio` (ω*_n/ω_n).

    Raises
    ------
    InputError
        If an aspect ratio is not positive, the structure has too few modes, h*_1 is not positive, or `side` is not ±1.

    References
    ----------
    Silva & Stojadinović 2024, Section 3.4 (Fig. 10).

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
    >>> rf.frequency_ratios(frame, [2.0, 10.0],
    ...     n_modes=1)[["model", "aspect_ratio", "ratio"]].round(2)
        model  aspect_ratio  ratio
    0  2DOF-S           2.0   1.85
    1  2DOF-S          10.0   7.67
    """
    ratios = checked_positive_numbers("aspect_ratios", aspect_ratios, "")
    properties = rocking_properties_of(structure)
    if properties.n_modes == 0 or properties.effective_height[0] <= 0.0:
        height = f"h*_1 = {properties.effective_height[0]:g} m" if properties.n_modes else "no modes"
        raise InputError(
            f"An aspect ratio h*_1/B needs a structure whose h*_1 is positive, but one with {height} was given."
        )
    models = [_labelled_mode_count(each, properties.n_modes) for each in _mode_counts_as_list(n_modes)]
    rows: list[dict[str, Any]] = []
    for label, count in models:
        for aspect_ratio in ratios:
            widened = properties.with_half_width(float(properties.effective_height[0]) / aspect_ratio)
            found = uplifted_modes(widened, count, side=side)
            rows += [
                {
                    "model": label,
                    "n_modes": count,
                    "aspect_ratio": aspect_ratio,
                    "half_width": widened.half_width,
                    "mode": n + 1,
                    "omega": float(properties.omega[n]),
                    "uplifted_omega": float(found.omega[n]),
                    "ratio": float(found.ratio[n]),
                }
                for n in range(count)
            ]
    import pandas as pd

    return pd.DataFrame(rows)


def _mode_counts_as_list(n_modes: Any) -> list[Any]:
    given = list(n_modes) if number_of_dimensions(n_modes) == 1 else [n_modes]
    if not given:
        raise InputError("n_modes is empty. Give at least one number of modes, or None for all.")
    return given


def _labelled_mode_count(given: SupportsIndex | None, available: int) -> tuple[str, int]:
    if given is None:
        return "MDOF-S", available
    count = checked_whole_number("n_modes", given, 1, available)
    return f"{count + 1}DOF-S", count


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
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=0.8)
    >>> second = rf.modal_combination(frame, pulse).second
    >>> round(second.displacement, 4)
    0.0024
    """

    displacement: float
    top_displacement: float
    base_shear: float
    base_moment: float

    def combined(self, name: str, peak: float) -> float:
        """Return the square root of the sum of the squares of a peak of 2DOF-S and of this mode's, by its name."""
        return math.hypot(peak, getattr(self, name))


COMBINED_QUANTITIES = ("top_displacement", "base_shear", "base_moment")  # in the order of `CombinedPeaks`


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
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
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


def second_mode_peaks(properties: RockingProperties, motion: GroundMotion) -> SecondMode:
    """Return the peaks of the second mode, as an oscillator on a fixed base."""
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


def modal_combination(
    structure: RockingStructure | RockingProperties,
    motion: GroundMotion,
    free_vibration: float | Literal["settle"] = 0.0,
    work_limit: WorkLimit = "default",
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
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=0.8)
    >>> peaks = rf.modal_combination(frame, pulse)
    >>> round(peaks.max_base_shear / peaks.rocking.max_base_shear, 3)
    1.004
    """
    properties = rocking_properties_of(structure)
    rocking = simulate(
        properties, motion, "2DOF-S", output="peaks", free_vibration=free_vibration, work_limit=work_limit
    )
    second = second_mode_peaks(properties, motion)
    combined = (second.combined(name, getattr(rocking, f"max_{name}")) for name in COMBINED_QUANTITIES)
    return CombinedPeaks(rocking, second, *combined)
