"""Uplifted frequencies as a function of the slenderness of a structure."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, SupportsIndex

from rockflex._checks import dimensions, whole_number
from rockflex._errors import InputError
from rockflex.modal import RockingProperties, uplifted_modes
from rockflex.study._arguments import RockingStructure, positive_numbers, properties_of

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
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0, damping_ratio=0.02)
    >>> rf.frequency_ratios(frame, [2.0, 10.0], n_modes=1)[["model", "aspect_ratio", "ratio"]].round(2)
        model  aspect_ratio  ratio
    0  2DOF-S           2.0   1.85
    1  2DOF-S          10.0   7.67
    """
    ratios = positive_numbers("aspect_ratios", aspect_ratios, "")
    properties = properties_of(structure)
    if properties.n_modes == 0 or properties.effective_height[0] <= 0.0:
        height = f"h*_1 = {properties.effective_height[0]:g} m" if properties.n_modes else "no modes"
        raise InputError(
            f"An aspect ratio h*_1/B needs a structure whose h*_1 is positive, but one with {height} was given."
        )
    kept = [_kept(each, properties.n_modes) for each in _several(n_modes)]
    rows: list[dict[str, Any]] = []
    for label, count in kept:
        for aspect_ratio in ratios:
            based = properties.with_half_width(float(properties.effective_height[0]) / aspect_ratio)
            found = uplifted_modes(based, count, side=side)
            rows += [
                {
                    "model": label,
                    "n_modes": count,
                    "aspect_ratio": aspect_ratio,
                    "half_width": based.half_width,
                    "mode": n + 1,
                    "omega": float(properties.omega[n]),
                    "uplifted_omega": float(found.omega[n]),
                    "ratio": float(found.ratio[n]),
                }
                for n in range(count)
            ]
    import pandas as pd

    return pd.DataFrame(rows)


def _several(n_modes: Any) -> list[Any]:
    given = list(n_modes) if dimensions(n_modes) == 1 else [n_modes]
    if not given:
        raise InputError("n_modes is empty. Give at least one number of modes, or None for all.")
    return given


def _kept(given: SupportsIndex | None, available: int) -> tuple[str, int]:
    if given is None:
        return "MDOF-S", available
    count = whole_number("n_modes", given, 1, available)
    return f"{count + 1}DOF-S", count
