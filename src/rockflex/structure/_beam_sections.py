"""Properties of a beam along its height: profiles and lumped masses."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_finite_vector, checked_positive
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import number_with_noun
from rockflex.foundation.values import Value

Along: TypeAlias = float | Callable[[Array], ArrayLike] | tuple[ArrayLike, ArrayLike]
"""A number, a function of heights (n,) that returns values (n,), or a table (heights, values) to interpolate."""

_N_CHECKED = 65
_HEIGHT_TOLERANCE = 1e-9  # of the height: tolerance for printed digits in the last row of a table


@dataclass(frozen=True)
class ConstantProfile:
    """The same value at every height."""

    value: float

    def __call__(self, z: Array) -> Array:
        return np.full(z.shape, self.value)


@dataclass(frozen=True, eq=False)
class InterpolatedProfile(Value):
    """A table of values (n,) at heights (n,) in m, linear between its rows."""

    heights: Array
    values: Array

    def __call__(self, z: Array) -> Array:
        return np.interp(z, self.heights, self.values)


@dataclass(frozen=True, eq=False)
class BeamProfile(Value):
    """Values along the height, checked whenever they are evaluated.

    Attributes
    ----------
    name, unit : str
        Name and unit of the property, for messages.
    function : callable
        Returns the values at given heights.
    kinks : ndarray
        Heights in m where the values are not smooth.
    zero : bool
        Whether zero is allowed.
    """

    name: str
    unit: str
    function: Callable[[Array], ArrayLike]
    kinks: Array
    zero: bool

    @property
    def given(self) -> Along:
        """The number, the function, or the table (as read-only arrays) that was given."""
        if isinstance(self.function, ConstantProfile):
            return self.function.value
        if isinstance(self.function, InterpolatedProfile):
            return self.function.heights, self.function.values
        return self.function

    def at(self, z: Array) -> Array:
        """Return the values at heights `z`, in the shape of `z`.

        Raises
        ------
        InputError
            If a value is missing, not finite, or not positive.
        """
        flat = z.ravel()
        try:
            with np.errstate(all="ignore"):  # values that are not finite are rejected below
                found = np.ma.asarray(self.function(flat), dtype=np.float64).filled(np.nan)  # masked values are missing
                values = np.broadcast_to(found, flat.shape)
        except (TypeError, ValueError) as error:
            raise InputError(
                f"{self.name} must return one number for each height, an array of shape {flat.shape}, but it did not: "
                f"{error}.",
                field=self.name,
            ) from error
        allowed = (values >= 0.0) if self.zero else (values > 0.0)
        bad = np.flatnonzero(~(allowed & np.isfinite(values)))
        if bad.size:
            i = int(bad[0])
            kind = "zero or positive" if self.zero else "positive"
            raise InputError(
                f"{self.name} must be {kind} and finite along the whole height, but it is {values[i]:g} "
                f"{self.unit} at {flat[i]:.6g} m.",
                field=self.name,
            )
        return values.reshape(z.shape)


def beam_profile(name: str, given: Along, height: float, unit: str, *, zero: bool = False) -> BeamProfile:
    """Return the given property as a profile from the base to `height`.

    Raises
    ------
    InputError
        If a table does not extend from the base to the top, its heights decrease, or a value is not positive.
    """
    if callable(given):
        result = BeamProfile(name, unit, given, np.zeros(0), zero)
    elif isinstance(given, tuple):
        result = _interpolated_profile(name, given, height, unit, zero)
    else:
        constant = checked_positive(name, given, unit, zero=zero)
        result = BeamProfile(name, unit, ConstantProfile(constant), np.zeros(0), zero)
    result.at(np.linspace(0.0, height, _N_CHECKED))
    return result


def _interpolated_profile(
    name: str, given: tuple[ArrayLike, ArrayLike], height: float, unit: str, zero: bool
) -> BeamProfile:
    if len(given) != 2:  # pyright: ignore[reportUnnecessaryComparison]
        raise InputError(
            f"{name} must be a table (heights, values), but "
            f"{number_with_noun(len(given), 'column was', 'columns were')} given.",
            field=name,
        )
    z = checked_finite_vector(f"{name}, heights", given[0], "m", field=name)
    values = checked_finite_vector(f"{name}, values", given[1], unit, field=name)
    if z.size != values.size or z.size < 2:
        raise InputError(
            f"{name} must contain one value for each height of its table, and at least two rows, but {z.size} heights "
            f"and {values.size} values were given.",
            field=name,
        )
    falls = np.flatnonzero(z[1:] < z[:-1])
    if falls.size:
        i = int(falls[0])
        raise InputError(
            f"{name}: the heights of a table must not decrease, but {z[i + 1]:g} m follows {z[i]:g} m. Sort the rows; "
            "two rows at the same height are a jump.",
            field=name,
        )
    if z[0] > _HEIGHT_TOLERANCE * height or z[-1] < height * (1.0 - _HEIGHT_TOLERANCE):
        raise InputError(
            f"{name}: a table must extend from the base (0 m) to the top ({height:g} m), but it covers {z[0]:g} m to "
            f"{z[-1]:g} m. Add the missing rows.",
            field=name,
        )
    low = values < 0.0 if zero else values <= 0.0
    if low.any():
        i = int(np.flatnonzero(low)[0])
        kind = "zero or positive" if zero else "positive"
        raise InputError(
            f"{name} must be {kind}, but its table contains {values[i]:g} {unit} at {z[i]:g} m.", field=name
        )
    inside = z[(z > 0.0) & (z < height)]
    return BeamProfile(name, unit, InterpolatedProfile(z, values), np.unique(inside), zero)


@dataclass(frozen=True, eq=False, init=False)
class LumpedMasses(Value):
    """Masses fixed to a beam.

    Attributes
    ----------
    heights : ndarray, shape (P,)
        Heights above the base in m, above zero and at most the height of the beam.
    masses : ndarray, shape (P,)
        Masses in kg, positive.
    rotary : ndarray, shape (P,)
        Rotary inertia of each mass about its own axis in kg m², zero or positive. Default: none.

    Raises
    ------
    InputError
        If the lengths differ, or a value is not finite or outside its range.

    Examples
    --------
    >>> import rockflex as rf
    >>> tank = rf.LumpedMasses(heights=[20.0], masses=[50e3], rotary=[1e5])
    >>> tower = rf.Beam(
    ...     height=20.0, mass=500.0, bending_stiffness=2e9, half_width=1.5,
    ...     damping_ratio=0.02,
    ...     lumped_masses=tank, n_modes=2,
    ... )
    >>> tower.modal().period.round(3)
    array([1.669, 0.12 ])
    """

    heights: Array
    masses: Array
    rotary: Array

    def __init__(self, heights: ArrayLike, masses: ArrayLike, rotary: ArrayLike | None = None) -> None:
        z = checked_finite_vector("lumped_masses.heights", heights, "m", field="lumped_masses")
        m = checked_finite_vector("lumped_masses.masses", masses, "kg", field="lumped_masses")
        j = np.zeros(z.size) if rotary is None else rotary
        j = checked_finite_vector("lumped_masses.rotary", j, "kg m²", field="lumped_masses")
        if not z.size == m.size == j.size:
            raise InputError(
                f"lumped_masses must contain one mass and one rotary inertia for each of its {z.size} heights, but "
                f"{m.size} and {j.size} were given.",
                field="lumped_masses",
            )
        for name, values, bad, kind, unit in (
            ("heights", z, z <= 0.0, "positive", "m"),
            ("masses", m, m <= 0.0, "positive", "kg"),
            ("rotary", j, j < 0.0, "zero or positive", "kg m²"),
        ):
            if bad.any():
                i = int(np.flatnonzero(bad)[0])
                hint = " A mass at the base belongs to base_mass." if name == "heights" else ""
                raise InputError(
                    f"lumped_masses.{name} must be {kind}, but {name}[{i}] = {values[i]:g} {unit} was given.{hint}",
                    field="lumped_masses",
                )
        vars(self).update(heights=z, masses=m, rotary=j)


@dataclass(frozen=True, eq=False)
class BeamSections(Value):
    """Profiles and lumped masses of a beam.

    Attributes
    ----------
    height : float
        Height H in m.
    mass, bending_stiffness : Profile
        m in kg/m and EI in N m².
    shear_stiffness, rotary_inertia : Profile or None
        GA_s in N and the rotary inertia in kg m; None for no shear deformation and no rotary inertia.
    lumped : LumpedMasses
        Lumped masses; may be empty.
    rotary_in_modes : bool
        Whether the modes include the rotary inertia.
    """

    height: float
    mass: BeamProfile
    bending_stiffness: BeamProfile
    shear_stiffness: BeamProfile | None
    rotary_inertia: BeamProfile | None
    lumped: LumpedMasses
    rotary_in_modes: bool

    def __str__(self) -> str:
        masses, stiffness = (profile.at(np.zeros(1))[0] for profile in (self.mass, self.bending_stiffness))
        return f"height = {self.height:g} m, and mass = {masses:g} kg/m and EI = {stiffness:g} N m² at its base"

    @property
    def kinks(self) -> Array:
        """Heights in m of the rows of all tables."""
        each = (self.mass, self.bending_stiffness, self.shear_stiffness, self.rotary_inertia)
        return np.concatenate([profile.kinks for profile in each if profile is not None])

    def rotary_at(self, z: Array) -> Array:
        """Return the rotary inertia in kg m at heights in m."""
        return np.zeros_like(z) if self.rotary_inertia is None else self.rotary_inertia.at(z)


def lumped_masses_on_beam(given: LumpedMasses | None, height: float) -> LumpedMasses:
    """Return the lumped masses of a beam; None stands for no masses.

    Raises
    ------
    InputError
        If one is above the top.
    """
    bodies: Any = LumpedMasses([], []) if given is None else given
    if not isinstance(bodies, LumpedMasses):
        raise InputError(
            f"lumped_masses must be LumpedMasses(heights, masses), but {type(bodies).__name__} was given.",
            field="lumped_masses",
        )
    if bodies.heights.max(initial=0.0) > height * (1.0 + 1e-12):
        raise InputError(
            f"lumped_masses must lie on the beam, at most {height:g} m above the base, but one lies at "
            f"{bodies.heights.max():g} m.",
            field="lumped_masses",
        )
    return bodies
