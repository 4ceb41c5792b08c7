"""The ground under the base: springs that cannot pull, and friction."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._checks import (
    all_positive,
    dimensions,
    finite,
    finite_vector,
    float_array,
    instance,
    positive,
    real_or_nan,
)
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex._values import Value

_MOST_SPRINGS = 200
_MAT = "for a rigid mat of mass m and width 2B it is m (2B)²/12"


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
        places = _positions(positions)
        stiff = _one_a_spring("stiffness", stiffness, "N/m", places.size)
        all_positive("stiffness", stiff, "N/m", "A spring without stiffness carries nothing: leave it out.")
        damped = _one_a_spring("damping", damping, "N s/m", places.size)
        if damped.min() < 0.0:
            first = int(np.argmin(damped))
            raise InputError(
                f"damping must be zero or positive, but damping[{first}] = {damped[first]:g} N s/m was given.",
                field="damping",
            )
        supported = None if area is None else _one_a_spring("area", area, "m²", places.size)
        if supported is not None:
            all_positive("area", supported, "m²")
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
        ratio = positive("heave_damping_ratio", heave_damping_ratio, "fractions of critical damping", zero=True)
        frequency = math.sqrt(self.total_stiffness / positive("mass", mass, "kg"))
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
        shaking; that of the heave, L_0^r z'' θ, is not modelled.
    base_inertia : float or None
        Rotary inertia I_b of the base and the floors about the axis of the masses in kg m², positive. Given with
        springs, and only then: on rigid ground it is part of I_θ. The inertia Σ m_i h_i² of the structure is added to
        it; that of a `rigid_block` already includes the rotary inertia of the block itself, so that only what the block
        leaves out counts here.

    Raises
    ------
    InputError
        If a value is outside its range, or neither friction nor springs are given.

    Examples
    --------
    >>> import rockflex as rf
    >>> rf.Ground(friction=0.4).slides
    True
    >>> ground = rf.Ground(springs=rf.Springs([-1.5, 1.5], stiffness=4e8, damping=2e6), base_inertia=30e3)
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
        inertia = _base_inertia(None if springs is None else instance("springs", springs, Springs), base_inertia)
        coefficient = None if friction is None else _friction(friction, None if springs is None else springs.n)
        vars(self).update(friction=coefficient, springs=springs, base_inertia=inertia)

    @property
    def rigid(self) -> bool:
        """Whether it is rigid ground on which the base cannot slide."""
        return self.springs is None and not self.slides

    @property
    def slides(self) -> bool:
        """Whether the base can slide: some coefficient of friction is given and finite."""
        return self.friction is not None and bool(np.isfinite(self.friction).any())


def _positions(given: ArrayLike) -> Array:
    places = finite_vector("positions", given, "m")
    if not 2 <= places.size <= _MOST_SPRINGS:
        raise InputError(
            f"positions must have 2 to {_MOST_SPRINGS} springs, but {places.size} were given. A base on one spring "
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


def _one_a_spring(name: str, given: ArrayLike, unit: str, n: int) -> Array:
    """Return a read-only array of one finite value for each spring, from one or from `n` numbers."""
    if dimensions(given) == 0:
        return _read_only(np.full(n, finite(name, given, unit)))  # pyright: ignore[reportArgumentType]
    return _counted(name, finite_vector(name, given, unit), n)


def _friction(given: ArrayLike, n: int | None) -> float | Array:
    expected = "friction must be a positive Coulomb coefficient, such as 0.4, or infinity for no sliding"
    if dimensions(given) == 0:
        value = real_or_nan(given)
        if not value > 0.0:
            raise InputError(f"{expected}, but {shown(given)} was given.", field="friction")
        return value if n is None else _read_only(np.full(n, value))
    if n is None:
        raise InputError(
            f"{expected}, but {shown(given)} was given. Several coefficients need springs, one for each.",
            field="friction",
        )
    values = float_array(given)
    if values is None or values.ndim != 1 or not bool(np.all(values > 0.0)):
        raise InputError(f"{expected}, or one for each spring, but {shown(given)} was given.", field="friction")
    return _read_only(_counted("friction", values, n))


def _counted(name: str, values: Array, n: int) -> Array:
    if values.size != n:
        raise InputError(
            f"{name} must be one number, or one for each of the {n} springs, but {values.size} were given.", field=name
        )
    return values


def _read_only(values: Array) -> Array:
    values.setflags(write=False)
    return values


def _base_inertia(springs: Springs | None, given: float | None) -> float | None:
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
            f"Give base_inertia in kg m², the rotary inertia of base and floors; {_MAT}.",
            field="base_inertia",
        )
    if not 0.0 < real_or_nan(given) < math.inf:
        raise InputError(
            f"base_inertia must be a positive, finite number in kg m², but {shown(given)} was given; {_MAT}.",
            field="base_inertia",
        )
    return real_or_nan(given)
