"""The ground under the base: springs that cannot pull, friction, and beds of springs."""

import math
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import (
    check_all_positive,
    checked_finite,
    checked_finite_vector,
    checked_in_range,
    checked_instance,
    checked_positive,
    checked_whole_number,
    float_array,
    number_of_dimensions,
    real_or_nan,
)
from rockflex.foundation.descriptions import Described, described
from rockflex.foundation.errors import InputError
from rockflex.foundation.overflow import explaining_overflow
from rockflex.foundation.schema import BREADTH, POISSON_RATIO, SHEAR_MODULUS, SUBGRADE_MODULUS, HalfWidth
from rockflex.foundation.shown import shown
from rockflex.foundation.values import Value

_MAX_SPRINGS = 200
_MAT_HINT = "for a rigid mat of mass m and width 2B it is m (2B)²/12"
_END_STIFFNESS, _MIDDLE_STIFFNESS = 6.83, 0.73  # stiffness per unit length over G/(1 - ν)


@dataclass(frozen=True, eq=False)
class Springs(Value):
    """Vertical spring-dashpots under the base, which push and cannot pull.

    A spring at x is compressed by x θ - z, where z is the heave of the base above the position in which the springs
    are unloaded. Its force is max(0, -k (z - x θ) - c (z' - x θ')) while it is compressed, and zero otherwise.

    Attributes
    ----------
    positions : ndarray, shape (n,)
        Distances in m from the axis of the masses, positive to the right; increasing, with at least one spring on
        either side of the axis.
    stiffness : ndarray, shape (n,)
        k in N/m, positive. A single number applies to all springs.
    damping : ndarray, shape (n,)
        c in N s/m, zero or positive. A single number applies to all springs.
    area : ndarray, shape (n,), or None
        Area of the base in m² that each spring supports, positive, from which the soil pressure follows. A single
        number applies to all springs. `winkler_bed` and `asce41_bed` set it.

    Raises
    ------
    InputError
        If a value is outside its range, or the numbers of values differ.

    Examples
    --------
    >>> import rockflex as rf
    >>> springs = rf.Springs([-1.5, 1.5], stiffness=4e8, damping=2e6)
    >>> springs.n, springs.total_stiffness, springs.rotational_stiffness
    (2, 800000000.0, 1800000000.0)
    """

    positions: Array
    stiffness: Array
    damping: Array
    area: Array | None = None

    def __init__(
        self,
        positions: ArrayLike,
        stiffness: ArrayLike,
        damping: ArrayLike = 0.0,
        area: ArrayLike | None = None,
    ) -> None:
        places = _checked_spring_positions(positions)
        stiff = _one_value_per_spring("stiffness", stiffness, "N/m", places.size)
        check_all_positive("stiffness", stiff, "N/m", "A spring without stiffness carries nothing: leave it out.")
        damped = _one_value_per_spring("damping", damping, "N s/m", places.size)
        if damped.min() < 0.0:
            first = int(np.argmin(damped))
            raise InputError(
                f"damping must be zero or positive, but damping[{first}] = {damped[first]:g} N s/m was given.",
                field="damping",
            )
        supported = None if area is None else _one_value_per_spring("area", area, "m²", places.size)
        if supported is not None:
            check_all_positive("area", supported, "m²")
        vars(self).update(positions=places, stiffness=stiff, damping=damped, area=supported)

    @property
    def n(self) -> int:
        """Number of springs."""
        return self.positions.size

    @property
    def total_stiffness(self) -> float:
        """Vertical stiffness Σ k in N/m while all springs are compressed."""
        return float(self.stiffness.sum())

    @property
    def total_damping(self) -> float:
        """Vertical damping coefficient Σ c in N s/m while all springs are compressed."""
        return float(self.damping.sum())

    @property
    def rotational_stiffness(self) -> float:
        """Rotational stiffness Σ k x² in N m/rad about the axis of the masses, while all springs are compressed."""
        return float(self.stiffness @ self.positions**2)

    @property
    def tilting_stiffness(self) -> float:
        """Σ k x² - (Σ k x)²/Σ k in N m/rad: rotational stiffness of a base that is free to heave."""
        return self.rotational_stiffness - float(self.stiffness @ self.positions) ** 2 / self.total_stiffness

    def damped(self, heave_damping_ratio: float, mass: float) -> "Springs":
        """Return the same springs with dashpots in proportion to their stiffness.

        Parameters
        ----------
        heave_damping_ratio
            Fraction of the critical damping of the heave mode: Σ c = 2 ζ (m Σ k)^½. Zero or positive; a stiff footing
            on soil may exceed 1.
        mass
            Total mass m on the springs in kg, with the base: `RockingProperties.m_tot`.

        Raises
        ------
        InputError
            If a value is outside its range.
        """
        ratio = checked_positive("heave_damping_ratio", heave_damping_ratio, "fractions of critical damping", zero=True)
        frequency = math.sqrt(self.total_stiffness / checked_positive("mass", mass, "kg"))
        return Springs(self.positions, self.stiffness, 2.0 * ratio / frequency * self.stiffness, self.area)


@dataclass(frozen=True, eq=False)
class Ground(Value):
    """The ground that a base stands on, if it is not rigid or may not hold the base in place.

    Attributes
    ----------
    friction : float, ndarray of shape (n,), or None
        Coulomb coefficient μ between base and ground, positive; infinity prevents sliding. With springs, one for each
        of the n springs; a single number applies to all. Default: the base cannot slide.
    springs : Springs or None
        Springs under the base. Default: the ground is rigid. The weight has the moment L_0^r (g + a_v) θ under vertical
        shaking; the moment of the heave, L_0^r z'' θ, is not modelled.
    base_inertia : float or None
        Rotary inertia I_b of the base and the floors about the axis of the masses in kg m², zero or positive. Given
        with springs, and only then: on rigid ground it is part of I_θ. The inertia Σ m_i h_i² of the structure is added
        to it; that of a `rigid_block` already includes the rotary inertia of the block itself, so that zero belongs
        here.

    Raises
    ------
    InputError
        If a value is outside its range, or neither friction nor springs are given.

    Examples
    --------
    >>> import rockflex as rf
    >>> rf.Ground(friction=0.4).slides
    True
    >>> ground = rf.Ground(springs=rf.Springs([-1.5, 1.5], stiffness=4e8,
    ...     damping=2e6), base_inertia=30e3)
    >>> ground.slides, ground.springs.n
    (False, 2)
    """

    friction: float | Array | None
    springs: Springs | None
    base_inertia: float | None

    def __init__(
        self,
        friction: ArrayLike | None = None,
        springs: Springs | None = None,
        base_inertia: float | None = None,
    ) -> None:
        if friction is None and springs is None:
            raise InputError(
                "Ground needs friction, springs or both: Ground(friction=0.4), for example. Leave the ground out for "
                "a base on rigid ground that cannot slide."
            )
        inertia = _checked_base_inertia(
            None if springs is None else checked_instance("springs", springs, Springs), base_inertia
        )
        coefficient = (
            None if friction is None else _checked_ground_friction(friction, None if springs is None else springs.n)
        )
        vars(self).update(friction=coefficient, springs=springs, base_inertia=inertia)

    @property
    def rigid(self) -> bool:
        """Whether it is rigid ground on which the base cannot slide."""
        return self.springs is None and not self.slides

    @property
    def slides(self) -> bool:
        """Whether the base can slide: some coefficient of friction is given and finite."""
        return self.friction is not None and bool(np.isfinite(self.friction).any())


def _checked_spring_positions(given: ArrayLike) -> Array:
    places = checked_finite_vector("positions", given, "m")
    if not 2 <= places.size <= _MAX_SPRINGS:
        raise InputError(
            f"positions must have 2 to {_MAX_SPRINGS} springs, but {places.size} were given. A base on one spring "
            "falls over.",
            field="positions",
        )
    falls = np.flatnonzero(np.diff(places) <= 0.0)
    if falls.size:
        first = int(falls[0])
        raise InputError(
            f"positions must increase from left to right, but positions[{first}] = {places[first]:g} m is followed by "
            f"{places[first + 1]:g} m. Sort the springs, and add up those at the same place.",
            field="positions",
        )
    if not places[0] < 0.0 < places[-1]:
        raise InputError(
            "positions must be on both sides of the axis of the masses, x = 0, or the base falls over, but they reach "
            f"from {places[0]:g} to {places[-1]:g} m. Measure them from that axis, positive to the right.",
            field="positions",
        )
    return places


def _one_value_per_spring(name: str, given: ArrayLike, unit: str, n: int) -> Array:
    """Return a read-only array of one finite value for each spring, from one or from `n` numbers."""
    if number_of_dimensions(given) == 0:
        return _read_only_array(np.full(n, checked_finite(name, given, unit)))  # pyright: ignore[reportArgumentType]
    return _checked_spring_values(name, checked_finite_vector(name, given, unit), n)


def _checked_ground_friction(given: ArrayLike, n: int | None) -> float | Array:
    expected = "friction must be a positive Coulomb coefficient, such as 0.4, or infinity for no sliding"
    if number_of_dimensions(given) == 0:
        value = real_or_nan(given)
        if not value > 0.0:
            raise InputError(f"{expected}, but {shown(given)} was given.", field="friction")
        return value if n is None else _read_only_array(np.full(n, value))
    if n is None:
        raise InputError(
            f"{expected}, but {shown(given)} was given. Several coefficients need springs, one for each.",
            field="friction",
        )
    values = float_array(given)
    if values is None or values.ndim != 1 or not bool(np.all(values > 0.0)):
        raise InputError(f"{expected}, or one for each spring, but {shown(given)} was given.", field="friction")
    return _read_only_array(_checked_spring_values("friction", values, n))


def _checked_spring_values(name: str, values: Array, n: int) -> Array:
    if values.size != n:
        raise InputError(
            f"{name} must be one number, or one for each of the {n} springs, but {values.size} were given.", field=name
        )
    return values


def _read_only_array(values: Array) -> Array:
    values.setflags(write=False)
    return values


def _checked_base_inertia(springs: Springs | None, given: float | None) -> float | None:
    if springs is None:
        if given is not None:
            raise InputError(
                f"base_inertia belongs to springs, but {shown(given)} was given without any. On rigid ground it is "
                "part of i_theta: leave it out, or give springs.",
                field="base_inertia",
            )
        return None
    if given is None:
        raise InputError(
            "A base without rotary inertia on springs has no inertia against rotation once all modes are included. "
            f"Give base_inertia in kg m², the rotary inertia of base and floors; {_MAT_HINT}. Give 0 where the "
            "structure has its own, as a rigid_block does: it would count twice.",
            field="base_inertia",
        )
    if not 0.0 <= real_or_nan(given) < math.inf:
        raise InputError(
            "base_inertia must be a zero or positive, finite number in kg m², but "
            f"{shown(given)} was given; {_MAT_HINT}.",
            field="base_inertia",
        )
    return real_or_nan(given)


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
    within=(2, _MAX_SPRINGS),
    note="With end zones at least 3, one in each of them.",
    label="Number of springs",
    low=2,
    high=_MAX_SPRINGS,
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
    count = checked_whole_number("n", n, 3 if zone > 0.0 else 2, _MAX_SPRINGS)
    with explaining_overflow(f"A bed of springs {2.0 * B:g} m wide"):
        edges = _spring_strip_edges(B, zone, count)
        middles, widths = (edges[1:] + edges[:-1]) / 2.0, np.diff(edges)
        stiffness = subgrade_modulus * breadth * widths * np.where(np.abs(middles) > B - zone, end_ratio, 1.0)
        return Springs(middles - shift, stiffness, damping * stiffness / stiffness.sum(), breadth * widths)


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
    if density is None or springs.area is None:
        return springs
    wave = 3.4 * math.sqrt(modulus / density) / (math.pi * (1.0 - poisson))
    return Springs(springs.positions, springs.stiffness, density * wave * springs.area, springs.area)


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
