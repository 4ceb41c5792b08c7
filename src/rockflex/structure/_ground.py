"""The ground under the base: springs that cannot pull, friction, and beds of springs."""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import (
    check_all_positive,
    checked_finite,
    checked_finite_vector,
    checked_instance,
    checked_positive,
    float_array,
    number_of_dimensions,
    real_or_nan,
)
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.foundation.values import Value

MAX_SPRINGS = 200
_MAT_HINT = "for a rigid mat of mass m and width 2B it is m (2B)²/12"


@dataclass(frozen=True, eq=False)
class Springs(Value):
    """Vertical spring-dashpots under the base, which push and cannot pull.

    A spring at x is compressed by w = x θ - z, where z is the heave of the base above the position in which the springs
    are unloaded. Its force is max(0, k w + c w') while it is compressed, and zero otherwise. With a `capacity` F_y it
    is max(0, min(k (w - w_p), F_y) + c w'): as the force k (w - w_p) reaches F_y, the permanent settlement w_p grows.

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
    capacity : ndarray, shape (n,), or None
        Largest force F_y in N that a spring carries besides its dashpot, positive or infinite. A single number applies
        to all springs. Default: springs do not yield. The structure at rest must not reach it.

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
    capacity: Array | None = None

    def __init__(
        self,
        positions: ArrayLike,
        stiffness: ArrayLike,
        damping: ArrayLike = 0.0,
        area: ArrayLike | None = None,
        capacity: ArrayLike | None = None,
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
        strength = None if capacity is None else _checked_capacity(capacity, places.size)
        vars(self).update(positions=places, stiffness=stiff, damping=damped, area=supported, capacity=strength)

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
        return replace(self, damping=2.0 * ratio / frequency * self.stiffness)

    def moment_capacity(self, force: float, side: int = 1) -> float:
        """Return the moment in N m about the axis of the masses at which the base rotates without limit.

        The springs at one edge carry their capacity, all others nothing: the plateau of the static moment, without the
        moment of the weight of a structure that leans. Of a continuous bed of the strength N_ult it is
        N B (1 - N/N_ult), the moment capacity of a rigid footing in ASCE/SEI 41 (there L P (1 - q/q_c)/2 with L = 2 B);
        J equal springs with the outer ones at the edges have up to J/(J - 1) times that.

        Parameters
        ----------
        force
            The vertical force N in N on the base, its weight for example.
        side
            1 for a rotation to the right, -1 to the left.

        Raises
        ------
        InputError
            If the force is not positive, or no less than all springs carry.

        Examples
        --------
        >>> import rockflex as rf
        >>> bed = rf.winkler_bed(2.0, 3.0, 40e6, n=100, bearing_capacity=600e3)
        >>> force = 2.4e6
        >>> round(bed.moment_capacity(force) / (force * 2.0 * (1 - force / 7.2e6)), 3)
        1.0
        """
        carried = checked_positive("force", force, "N")
        if self.capacity is None or not carried < self.capacity.sum():
            raise InputError(
                f"force must be less than the capacity of all springs, but {carried:g} N was given, and they carry "
                f"{'any force' if self.capacity is None else f'{self.capacity.sum():g} N'}.",
                field="force",
            )
        order = slice(None, None, -1) if side > 0 else slice(None)
        strength, places = self.capacity[order], self.positions[order]
        before = np.cumsum(strength) - strength
        return float(abs(np.clip(carried - before, 0.0, strength) @ places))


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
    if not 2 <= places.size <= MAX_SPRINGS:
        raise InputError(
            f"positions must have 2 to {MAX_SPRINGS} springs, but {places.size} were given. A base on one spring "
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


def _checked_capacity(given: ArrayLike, n: int) -> Array:
    values = np.full(n, real_or_nan(given)) if number_of_dimensions(given) == 0 else float_array(given)
    if values is None or values.ndim != 1 or not bool(np.all(values > 0.0)):
        raise InputError(
            "capacity must be the largest force of a spring in N, positive or infinite, or one for each spring, but "
            f"{shown(given)} was given.",
            field="capacity",
        )
    return _read_only_array(_checked_spring_values("capacity", values, n))


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
