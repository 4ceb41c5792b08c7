"""A tower shaped like a hollow truncated cone."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._checks import one_of, positive
from rockflex._computable import computable
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex._values import Value
from rockflex.structure._based import Assembled
from rockflex.structure._beam import Beam

_N_ELEMENTS = 2000  # as in the paper


@dataclass(frozen=True, eq=False)
class TaperedTower(Assembled, Value):
    """A hollow truncated cone with a wall of constant thickness (Silva & Stojadinović 2024, Section 4.1.1).

    Attributes
    ----------
    height : float
        Height in m.
    base_radius, top_radius : float
        Outer radius at the base and at the top in m, linear in between. The half-width B is `base_radius`.
    wall : float
        Thickness of the wall in m, at most the smaller radius.
    density : float
        Density in kg/m³.
    elastic_modulus : float
        Young's modulus in N/m².
    damping_ratio : float or ndarray, shape (n_modes,)
        Damping ratio in [0, 1): one number for all modes, or one per mode.
    method : {"ritz", "fe"}
        Rayleigh-Ritz with the shapes of Eq. 36 (five, or `n_modes` if more), or 2000 finite elements.
    n_modes : int
        Number of modes, at most 200.

    Raises
    ------
    InputError
        If a value is outside its range, or the wall is thicker than the smaller radius.

    Notes
    -----
    The rotary inertia of the sections is included in I_θ (Eq. 33), but not in the modes.

    Examples
    --------
    >>> import rockflex as rf
    >>> tower = rf.TaperedTower(
    ...     height=200.0, base_radius=8.0, top_radius=4.0, wall=1.0, density=2400.0, elastic_modulus=25e9,
    ...     damping_ratio=0.02,
    ... )
    >>> tower.modal(3).period.round(2)
    array([3.79, 0.81, 0.32])
    """

    height: float
    base_radius: float
    top_radius: float
    wall: float
    density: float
    elastic_modulus: float
    damping_ratio: ArrayLike
    method: Literal["ritz", "fe"] = "ritz"
    n_modes: int = 5

    def __post_init__(self) -> None:
        if not one_of(self.method, ("fe", "ritz")):
            raise InputError(f'method must be "fe" or "ritz", but {shown(self.method)} was given.', field="method")
        vars(self).update(
            height=positive("height", self.height, "m"),
            base_radius=positive("base_radius", self.base_radius, "m"),
            top_radius=positive("top_radius", self.top_radius, "m"),
            wall=positive("wall", self.wall, "m"),
            density=positive("density", self.density, "kg/m³"),
            elastic_modulus=positive("elastic_modulus", self.elastic_modulus, "N/m²"),
        )
        name, radius = min(("top_radius", self.top_radius), ("base_radius", self.base_radius), key=lambda r: r[1])
        if self.wall > radius:
            raise InputError(
                f"wall must be at most the smaller radius, {name} = {radius:g} m, but {self.wall:g} m was given. "
                "It is the wall thickness, not a diameter; for a solid tower it equals the radius.",
                field="wall",
            )
        vars(self).update(n_modes=self.beam.n_modes, damping_ratio=self.beam.damping_ratio)

    @cached_property
    @computable("The sections of a tower with these radii, wall, density and elastic_modulus")
    def beam(self) -> Beam:
        """The tower as a cantilever beam."""
        ring = (self.height, self.base_radius, self.top_radius, self.wall)
        return Beam(
            height=self.height,
            mass=_Area(*ring, self.density),
            bending_stiffness=_SecondMoment(*ring, self.elastic_modulus),
            half_width=self.base_radius,
            damping_ratio=self.damping_ratio,
            rotary_inertia=_SecondMoment(*ring, self.density),
            rotary_in_modes=False,
            method=self.method,
            n_modes=self.n_modes,
            n_elements=max(_N_ELEMENTS, self.n_modes) if self.method == "fe" else None,
        )

    @property
    def half_width(self) -> float:
        """Half-width B of the base in m."""
        return self.base_radius

    @property
    def assembled(self) -> Beam:
        """The cantilever of `beam`."""
        return self.beam


@dataclass(frozen=True)
class _Ring:
    """The annular section at any height: height, radii and wall of the tower in m, and a factor."""

    height: float
    base_radius: float
    top_radius: float
    wall: float
    factor: float

    def radii(self, z: Array) -> tuple[Array, Array]:
        outer = self.base_radius + (self.top_radius - self.base_radius) * z / self.height
        return outer, np.maximum(outer - self.wall, 0.0)


class _Area(_Ring):
    """The factor times the area in m²."""

    def __call__(self, z: Array) -> Array:
        outer, inner = self.radii(z)
        return self.factor * (math.pi * (outer**2 - inner**2))


class _SecondMoment(_Ring):
    """The factor times the second moment of the area in m⁴."""

    def __call__(self, z: Array) -> Array:
        outer, inner = self.radii(z)
        return self.factor * (math.pi * (outer**2 - inner**2)) * ((outer**2 + inner**2) / 4.0)
