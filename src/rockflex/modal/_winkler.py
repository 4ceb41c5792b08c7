"""Beds of springs under a rigid base."""

import math

import numpy as np

from rockflex._arrays import Array
from rockflex._checks import finite, in_range, positive, real_or_nan, whole_number
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.modal._ground import Springs

_END, _MIDDLE = 6.83, 0.73  # stiffness per unit length over G/(1 - ν)
_MOST = 200


def winkler_bed(
    half_width: float,
    breadth: float,
    subgrade_modulus: float,
    *,
    damping: float = 0.0,
    n: int = 20,
    end_zone: float = 0.0,
    end_ratio: float = 1.0,
    eccentricity: float = 0.0,
) -> Springs:
    """Return equally spaced springs under a rigid base, which represent a Winkler bed.

    Each spring stands in the middle of the strip that it supports, with k = k_s × breadth × width of the strip. The
    total stiffness is that of the continuous bed. The rotational stiffness is smaller by the factor 1 - 1/n² if the bed
    is uniform.

    Parameters
    ----------
    half_width
        Half-width B of the base in m.
    breadth
        Dimension of the base perpendicular to the plane of rocking in m.
    subgrade_modulus
        Modulus of subgrade reaction k_s in N/m³: pressure over settlement.
    damping
        Total vertical damping coefficient Σ c in N s/m, distributed in proportion to the stiffness. For a fraction of
        critical damping use `Springs.damped`.
    n
        Number of springs, 2 to 200. With end zones it includes at least one spring in each of them.
    end_zone
        Length of the stiffer zone at either end in m, from 0 to below `half_width`.
    end_ratio
        Stiffness of the end zones over that of the rest, positive.
    eccentricity
        Distance of the axis of the masses to the right of the middle of the base in m, as in `Eccentric`.

    Returns
    -------
    Springs
        With positions from the axis of the masses, and the area that each spring supports.

    Raises
    ------
    InputError
        If a value is outside its range.

    Examples
    --------
    >>> import rockflex as rf
    >>> bed = rf.winkler_bed(half_width=2.0, breadth=3.0, subgrade_modulus=40e6, n=40)
    >>> round(bed.total_stiffness / (40e6 * 4.0 * 3.0), 6), round(bed.rotational_stiffness / (40e6 * 3.0 * 16.0 / 3), 4)
    (1.0, 0.9994)
    """
    B = positive("half_width", half_width, "m")
    across = positive("breadth", breadth, "m")
    modulus = positive("subgrade_modulus", subgrade_modulus, "N/m³")
    total = positive("damping", damping, "N s/m", zero=True)
    ratio = positive("end_ratio", end_ratio, "times the stiffness of the rest")
    shift = finite("eccentricity", eccentricity, "m")
    zone = in_range("end_zone", end_zone, 0.0, B, hint="Its unit is m; the two zones must leave a part between them.")
    count = whole_number("n", n, 3 if zone > 0.0 else 2, _MOST)
    if not abs(shift) < B:
        raise InputError(
            f"eccentricity must be less than half_width {B:g} m, but {shift:g} m was given.", field="eccentricity"
        )
    edges = _edges(B, zone, count)
    middles, widths = (edges[1:] + edges[:-1]) / 2.0, np.diff(edges)
    stiffness = modulus * across * widths * np.where(np.abs(middles) > B - zone, ratio, 1.0)
    return Springs(middles - shift, stiffness, total * stiffness / stiffness.sum(), across * widths)


def asce41_bed(
    half_width: float,
    breadth: float,
    shear_modulus: float,
    poisson_ratio: float,
    *,
    damping: float = 0.0,
    n: int = 20,
    eccentricity: float = 0.0,
) -> Springs:
    """Return a Winkler bed with the stiffened ends of ASCE/SEI 41-17, Section 8.4.2.3 (FEMA 356, Figure 4-5).

    For a footing that is rigid relative to the soil. The stiffness per unit length is 6.83 G/(1 - ν) in end zones of
    length breadth/6, and 0.73 G/(1 - ν) between them. The former is that of a separate footing of the size of the zone,
    the latter that of an endless strip (Gazetas 1991, J. Geotech. Eng. 117(9), 1363-1381), so the bed is stiff enough
    both in heave and in rotation.

    Parameters
    ----------
    half_width
        Half-width B of the base in m, more than breadth/6.
    breadth
        Dimension B_f of the base perpendicular to the plane of rocking in m.
    shear_modulus
        Effective shear modulus G of the soil in N/m².
    poisson_ratio
        ν of the soil, from 0 to 0.5.
    damping
        Total vertical damping coefficient Σ c in N s/m, distributed in proportion to the stiffness. For a fraction of
        critical damping use `Springs.damped`.
    n
        Number of springs, 3 to 200, including at least one in each end zone.
    eccentricity
        Distance of the axis of the masses to the right of the middle of the base in m, as in `Eccentric`.

    Returns
    -------
    Springs
        With positions from the axis of the masses, and the area that each spring supports.

    Raises
    ------
    InputError
        If a value is outside its range.

    Examples
    --------
    >>> import rockflex as rf
    >>> bed = rf.asce41_bed(half_width=2.0, breadth=3.0, shear_modulus=20e6, poisson_ratio=0.35)
    >>> round(bed.total_stiffness / (20e6 / 0.65), 3)  # 6.83 × 1 m + 0.73 × 3 m
    9.02
    """
    B = positive("half_width", half_width, "m")
    across = positive("breadth", breadth, "m")
    modulus = positive("shear_modulus", shear_modulus, "N/m²")
    poisson = real_or_nan(poisson_ratio)
    if not 0.0 <= poisson <= 0.5:
        raise InputError(
            f"poisson_ratio must be from 0 to 0.5, but {shown(poisson_ratio)} was given.", field="poisson_ratio"
        )
    zone = across / 6.0
    if zone >= B:
        raise InputError(
            f"The end zones of ASCE 41, breadth/6 = {zone:g} m each, cover the whole base of half_width {B:g} m. Use "
            "winkler_bed with a subgrade modulus, or check that breadth is perpendicular to the plane of rocking.",
            field="breadth",
        )
    return winkler_bed(
        B,
        across,
        _MIDDLE * modulus / (1.0 - poisson) / across,
        damping=damping,
        n=n,
        end_zone=zone,
        end_ratio=_END / _MIDDLE,
        eccentricity=eccentricity,
    )


def _edges(B: float, zone: float, n: int) -> Array:
    """Return the n + 1 ends of the strips: in each zone they are equal, and about equal everywhere."""
    if zone == 0.0:
        return np.linspace(-B, B, n + 1)
    in_each = min(max(round(n * zone / (2.0 * B)), 1), math.floor((n - 1) / 2))
    inner = np.linspace(zone - B, B - zone, n - 2 * in_each + 1)
    end = np.linspace(B - zone, B, in_each + 1)[1:]
    return np.concatenate([-end[::-1], inner, end])
