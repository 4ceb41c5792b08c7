"""Properties of a beam along its height."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._checks import finite_vector
from rockflex._errors import InputError
from rockflex._values import Value
from rockflex.structure._profile import Profile


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
    ...     height=20.0, mass=500.0, bending_stiffness=2e9, half_width=1.5, damping_ratio=0.02,
    ...     lumped_masses=tank, n_modes=2,
    ... )
    >>> tower.modal().period.round(3)
    array([1.669, 0.12 ])
    """

    heights: Array
    masses: Array
    rotary: Array

    def __init__(self, heights: ArrayLike, masses: ArrayLike, rotary: ArrayLike | None = None) -> None:
        z = finite_vector("lumped_masses.heights", heights, "m", field="lumped_masses")
        m = finite_vector("lumped_masses.masses", masses, "kg", field="lumped_masses")
        j = np.zeros(z.size) if rotary is None else rotary
        j = finite_vector("lumped_masses.rotary", j, "kg m²", field="lumped_masses")
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
class Sections(Value):
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
    mass: Profile
    bending_stiffness: Profile
    shear_stiffness: Profile | None
    rotary_inertia: Profile | None
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


def on_beam(given: LumpedMasses | None, height: float) -> LumpedMasses:
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
