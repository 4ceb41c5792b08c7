"""Beds of springs under a rigid base: Winkler's, that of ASCE 41, and Gazetas' footing."""

import math
from dataclasses import replace
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import (
    checked_in_range,
    checked_positive,
    checked_whole_number,
    real_or_nan,
)
from rockflex.foundation.descriptions import Described, described
from rockflex.foundation.errors import InputError
from rockflex.foundation.overflow import explaining_overflow
from rockflex.foundation.schema import BREADTH, POISSON_RATIO, SHEAR_MODULUS, SUBGRADE_MODULUS, HalfWidth
from rockflex.foundation.shown import shown
from rockflex.structure._ground import MAX_SPRINGS, Springs

_END_STIFFNESS, _MIDDLE_STIFFNESS = 6.83, 0.73  # stiffness per unit length over G/(1 - ν)

BED_DAMPING = Described(
    "the damping coefficient of all springs together",
    "N s/m",
    rule="zero or positive",
    note="In proportion to their stiffness. For a fraction of critical damping use `Springs.damped`.",
    low=0.0,
    high=1e15,
)
NUMBER_OF_SPRINGS = Described(
    "the number of springs",
    rule="whole",
    within=(2, MAX_SPRINGS),
    note="With end zones at least 3, one in each of them.",
    label="Number of springs",
    low=2,
    high=MAX_SPRINGS,
)
END_ZONE = Described("the length of the stiffer zone at either end", "m", low=0.0, high=1000.0)
END_RATIO = Described("the stiffness of the end zones over that of the rest", rule="positive", low=1e-3, high=1e3)
SOIL_DENSITY = Described(
    "the density of the soil, for dashpots that radiate",
    "kg/m³",
    rule="positive",
    note="ρ V_La per area with V_La = 3.4 (G/ρ)^0.5/(π (1 - ν)) (Gazetas 1991). This is the radiation of waves in "
    "heave. In rotation of a base that stays on the ground it is the limit for high frequencies; at those of "
    "buildings far less is radiated. Default: no dashpots.",
    low=1.0,
    high=1e4,
)
BEARING_CAPACITY = Described(
    "the bearing capacity q_ult of the soil, at which springs yield",
    "N/m²",
    rule="positive",
    note="Each spring yields at q_ult times the area that it supports. Default: they do not.",
    low=1.0,
    high=1e12,
)
_Shift = Annotated[
    float,
    Described("the distance of the masses to the right of the middle of the base", "m", rule="finite"),
]


@described
@explaining_overflow("A bed of springs of this size and stiffness")
def winkler_bed(
    half_width: HalfWidth,
    breadth: Annotated[float, BREADTH],
    subgrade_modulus: Annotated[float, SUBGRADE_MODULUS],
    *,
    damping: Annotated[float, BED_DAMPING] = 0.0,
    n: Annotated[int, NUMBER_OF_SPRINGS] = 20,
    end_zone: Annotated[float, END_ZONE] = 0.0,
    end_ratio: Annotated[float, END_RATIO] = 1.0,
    eccentricity: _Shift = 0.0,
    bearing_capacity: Annotated[float | None, BEARING_CAPACITY] = None,
) -> Springs:
    """Return equally spaced springs under a rigid base, which represent a Winkler bed.

    Each spring stands in the middle of the strip that it supports, with k = k_s × breadth × width of the strip. The
    total stiffness equals that of the continuous bed. If the bed is uniform, the rotational stiffness is smaller by the
    factor 1 - 1/n².

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
    >>> bed = rf.winkler_bed(half_width=2.0, breadth=3.0, subgrade_modulus=40e6,
    ...     n=40)
    >>> round(bed.total_stiffness / (40e6 * 4.0 * 3.0),
    ...     6), round(bed.rotational_stiffness / (40e6 * 3.0 * 16.0 / 3), 4)
    (1.0, 0.9994)
    """
    B, shift = half_width, _checked_shift(eccentricity, half_width)
    zone = checked_in_range(
        "end_zone", end_zone, 0.0, B, hint="Its unit is m; the two zones must leave a part between them."
    )
    count = checked_whole_number("n", n, 3 if zone > 0.0 else 2, MAX_SPRINGS)
    with explaining_overflow(f"A bed of springs {2.0 * B:g} m wide"):
        edges = _spring_strip_edges(B, zone, count)
        middles, widths = (edges[1:] + edges[:-1]) / 2.0, np.diff(edges)
        stiffness = subgrade_modulus * breadth * widths * np.where(np.abs(middles) > B - zone, end_ratio, 1.0)
        area = breadth * widths
        capacity = None if bearing_capacity is None else bearing_capacity * area
        return Springs(middles - shift, stiffness, damping * stiffness / stiffness.sum(), area, capacity)


@described
@explaining_overflow("A bed of springs of this size and stiffness")
def asce41_bed(
    half_width: HalfWidth,
    breadth: Annotated[float, BREADTH],
    shear_modulus: Annotated[float, SHEAR_MODULUS],
    poisson_ratio: Annotated[float, POISSON_RATIO],
    *,
    damping: Annotated[float, BED_DAMPING] = 0.0,
    n: Annotated[int, NUMBER_OF_SPRINGS] = 20,
    eccentricity: _Shift = 0.0,
    bearing_capacity: Annotated[float | None, BEARING_CAPACITY] = None,
) -> Springs:
    """Return a Winkler bed with the stiffened ends of ASCE/SEI 41-17, Section 8.4.2.3 (FEMA 356, Figure 4-5).

    For a footing that is rigid relative to the soil. The stiffness per unit length is 6.83 G/(1 - ν) in end zones of
    length breadth/6, and 0.73 G/(1 - ν) between them. The former is the stiffness of a separate footing of the
    size of the zone, the latter of an endless strip (Gazetas 1991, J. Geotech. Eng. 117(9), 1363-1381), so the bed is
    stiff enough both in heave and in rotation. Compared with Gazetas' formula, within 1 %, and not with the text of the
    standard.

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
    >>> bed = rf.asce41_bed(half_width=2.0, breadth=3.0, shear_modulus=20e6,
    ...     poisson_ratio=0.35)
    >>> round(bed.total_stiffness / (20e6 / 0.65), 3)  # 6.83 × 1 m + 0.73 × 3 m
    9.02
    """
    B, poisson, zone = half_width, _checked_poisson_ratio(poisson_ratio), breadth / 6.0
    if zone >= B:
        raise InputError(
            f"The end zones of ASCE 41, breadth/6 = {zone:g} m each, cover the whole base of half_width {B:g} m. Use "
            "winkler_bed with a subgrade modulus, or check that breadth is perpendicular to the plane of rocking.",
            field="breadth",
        )
    return winkler_bed(
        B,
        breadth,
        _MIDDLE_STIFFNESS * shear_modulus / (1.0 - poisson) / breadth,
        damping=damping,
        n=n,
        end_zone=zone,
        end_ratio=_END_STIFFNESS / _MIDDLE_STIFFNESS,
        eccentricity=eccentricity,
        bearing_capacity=bearing_capacity,
    )


@described
@explaining_overflow("A bed of springs of this size and stiffness")
def gazetas_bed(
    half_width: HalfWidth,
    breadth: Annotated[float, BREADTH],
    shear_modulus: Annotated[float, SHEAR_MODULUS],
    poisson_ratio: Annotated[float, POISSON_RATIO],
    *,
    density: Annotated[float | None, SOIL_DENSITY] = None,
    n: Annotated[int, NUMBER_OF_SPRINGS] = 20,
    end_zone: Annotated[float | None, replace(END_ZONE, note="With n > 2. Default: 0.3 B.")] = None,
    eccentricity: _Shift = 0.0,
    bearing_capacity: Annotated[float | None, BEARING_CAPACITY] = None,
) -> Springs:
    """Return springs with the stiffness of a rigid rectangular footing on an elastic half-space (Gazetas 1991).

    With the half length L and half width l of the footing, L >= l, and its second moment I of area (Gazetas 1991, J.
    Geotech. Eng. 117(9), 1363-1381; NIST GCR 12-917-21, Table 2-2a):

    K_z = 2 G L/(1 - ν) [0.73 + 1.54 (l/L)^0.75], in rotation along the length
    K_θ = 3 G/(1 - ν) I^0.75 (L/l)^0.15, and across it K_θ = G/(1 - ν) I^0.75 (L/l)^0.25 (2.4 + 0.5 l/L).

    A rigid footing presses the ground under its edges most, so K_θ is much larger than that of a uniform bed. Two
    springs, n = 2, stand at ± (K_θ/K_z)^0.5 from the middle, and have both stiffnesses. A bed of more springs has K_z
    per area between its end zones and in these as much as K_θ requires (NIST GCR 12-917-21, Chapter 2); in heave it
    is then stiffer than K_z. So are two springs where they would stand beyond the edges: they are put there. K_θ is
    right in all of them. The coefficients were not checked against the texts.

    Returns
    -------
    Springs
        With positions from the axis of the masses, and the area that each spring supports. Embedment, layers, and the
        change of stiffness with frequency are left out.

    Raises
    ------
    InputError
        If a value is outside its range.

    Examples
    --------
    >>> import rockflex as rf
    >>> two = rf.gazetas_bed(half_width=1.5, breadth=2.0, shear_modulus=30e6,
    ...     poisson_ratio=0.3, n=2)
    >>> two.positions.round(3), round(two.total_stiffness / 1e6), round(
    ...     two.rotational_stiffness / 1e6)
    (array([-1.326,  1.326]), 240, 422)
    """
    B, across, modulus = half_width, breadth, shear_modulus
    checked_in_range(
        "breadth/(2 half_width)", across / (2.0 * B), 0.05, 20.0, field="breadth", hint="Check their units, m."
    )
    poisson, shift = _checked_poisson_ratio(poisson_ratio), _checked_shift(eccentricity, B)
    L, l = max(B, across / 2.0), min(B, across / 2.0)  # noqa: E741
    inertia = across * (2.0 * B) ** 3 / 12.0
    shape = 3.0 * (L / l) ** 0.15 if L == B else (L / l) ** 0.25 * (2.4 + 0.5 * l / L)
    heave = 2.0 * modulus * L / (1.0 - poisson) * (0.73 + 1.54 * (l / L) ** 0.75)
    rotation = modulus / (1.0 - poisson) * inertia**0.75 * shape
    if n == 2:
        if end_zone is not None:
            raise InputError(
                "end_zone is for a bed of more than two springs. Leave it out, or give n.", field="end_zone"
            )
        arm = min(math.sqrt(rotation / heave), B)
        stiffness, area = rotation / (2.0 * arm**2), across * B
        springs = Springs([-arm - shift, arm - shift], stiffness, 0.0, area)
    else:
        zone = 0.3 * B if end_zone is None else checked_positive("end_zone", end_zone, "m")
        even = winkler_bed(B, across, heave / (2.0 * B * across), n=n, end_zone=zone, eccentricity=shift)
        share = even.stiffness * (even.positions + shift) ** 2
        ends = np.abs(even.positions + shift) > B - zone
        ratio = (rotation - share[~ends].sum()) / share[ends].sum()
        springs = Springs(even.positions, even.stiffness * np.where(ends, ratio, 1.0), 0.0, even.area)
    assert springs.area is not None
    capacity = None if bearing_capacity is None else bearing_capacity * springs.area
    damping: ArrayLike = 0.0
    if density is not None:
        damping = density * 3.4 * math.sqrt(modulus / density) / (math.pi * (1.0 - poisson)) * springs.area
    return Springs(springs.positions, springs.stiffness, damping, springs.area, capacity)


def _checked_shift(shift: float, B: float) -> float:
    if not abs(shift) < B:
        raise InputError(
            f"eccentricity must be less than half_width {B:g} m, but {shift:g} m was given.", field="eccentricity"
        )
    return shift


def _checked_poisson_ratio(given: float) -> float:
    poisson = real_or_nan(given)
    if not 0.0 <= poisson <= 0.5:
        raise InputError(f"poisson_ratio must be from 0 to 0.5, but {shown(given)} was given.", field="poisson_ratio")
    return poisson


def _spring_strip_edges(B: float, zone: float, n: int) -> Array:
    """Return the n + 1 ends of the strips: in each zone they are equal, and about equal everywhere."""
    if zone == 0.0:
        return np.linspace(-B, B, n + 1)
    in_each = min(max(round(n * zone / (2.0 * B)), 1), math.floor((n - 1) / 2))
    inner = np.linspace(zone - B, B - zone, n - 2 * in_each + 1)
    end = np.linspace(B - zone, B, in_each + 1)[1:]
    return np.concatenate([-end[::-1], inner, end])
