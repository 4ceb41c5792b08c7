"""A coupled wall and frame: the combined flexural and shear beam."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_damping_ratios
from rockflex.foundation.descriptions import PLAIN, Described, described
from rockflex.foundation.overflow import explaining_overflow
from rockflex.foundation.schema import DAMPING_RATIOS, AspectRatio, BaseMass, Height, Modes, Period
from rockflex.foundation.values import Value
from rockflex.structure._beam_modes import N_STATIONS, beam_forces_at_stations, beam_mesh_nodes, gauss_points
from rockflex.structure._participation import MassNormalisedModes
from rockflex.structure._structure import AssembledStructure, ModalStructure

_N_PANELS, _N_POINTS = 64, 8
_BOUNDARY_LAYER = np.array([0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0])


@described
@dataclass(frozen=True, eq=False)
class WallFrame(AssembledStructure, Value):
    """A uniform flexural wall coupled to a uniform shear frame over the full height.

    EI u'''' - GA u'' = m ω² u: the coupled beam of Miranda & Taghavi (2005, Journal of Structural Engineering 131(2),
    203-211), with modes in closed form. The stiffness is scaled to give the specified period, and the base width
    follows from the aspect ratio, as in `Frame`.

    Raises
    ------
    InputError
        If a value is outside its range.

    Examples
    --------
    >>> import rockflex as rf
    >>> building = rf.WallFrame(
    ...     height=30.0, mass=2e6, stiffness_parameter=2.0, base_mass=2e5,
    ...     period=1.0, aspect_ratio=6.0,
    ...     damping_ratio=0.03,
    ... )
    >>> building.modal(3).period.round(3)
    array([1.   , 0.219, 0.084])
    >>> round(building.half_width, 2)
    3.56
    """

    title: ClassVar[str] = "Wall and frame"

    height: Height
    mass: Annotated[
        float,
        Described("the mass of wall and frame together, without the base", "kg", rule="positive", note="Uniform."),
    ]
    stiffness_parameter: Annotated[
        float,
        Described(
            "α = H √(GA/EI), a number from 0 (a wall alone: flexure) to inf (a frame alone: shear)",
            form=PLAIN,
            rule="zero, positive or infinite",
            low=0.0,
            high=math.inf,
        ),
    ]
    base_mass: BaseMass
    period: Period
    aspect_ratio: AspectRatio
    damping_ratio: Annotated[ArrayLike, DAMPING_RATIOS]
    n_modes: Modes = 5

    def __post_init__(self) -> None:
        vars(self)["damping_ratio"] = checked_damping_ratios("damping_ratio", self.damping_ratio, self.n_modes)

    @property
    def half_width(self) -> float:
        """Half-width B = h*_1/aspect_ratio of the base in m."""
        return float(self._modes.moment[0] / self._modes.shear[0]) / self.aspect_ratio

    @property
    def assembled(self) -> ModalStructure:
        """The structure known by its modes; their shapes are given at 20 equal steps of the height."""
        zeta = np.asarray(self.damping_ratio, dtype=np.float64)
        return ModalStructure(self._modes, self.base_mass, self.half_width, zeta)

    @cached_property
    @explaining_overflow("The modes of a wall and frame with this height, mass, stiffness_parameter and period")
    def _modes(self) -> MassNormalisedModes:
        alpha = self.stiffness_parameter
        roots = np.array([_wall_frame_root(n, alpha) for n in range(1, self.n_modes + 1)])
        partners = np.sqrt(alpha**2 + roots**2)  # β of the hyperbolic functions, steepest in the highest mode
        layer = _BOUNDARY_LAYER / partners[-1] if math.isfinite(alpha) else np.zeros(0)
        points, weights = gauss_points(
            beam_mesh_nodes(1.0, max(_N_PANELS, 4 * self.n_modes), layer, 1.0 - layer), _N_POINTS
        )
        x, mass = points.ravel(), self.mass * weights.ravel()
        stations = np.linspace(0.0, 1.0, N_STATIONS)
        shapes, ordinates = (np.column_stack([_wall_frame_shape(z, g, alpha) for g in roots]) for z in (x, stations))
        size = np.sqrt(mass @ shapes**2)
        forces = mass[:, None] * shapes / size
        speed = roots * partners if math.isfinite(alpha) else roots
        h = self.height
        return MassNormalisedModes(
            omega=2.0 * math.pi / self.period * speed / speed[0],
            shear=forces.sum(axis=0),
            moment=h * (x @ forces),
            heights=h * stations,
            ordinates=ordinates / size,
            forces=beam_forces_at_stations(stations, x, forces, np.zeros_like(forces)),
            mass=self.mass,
            first_moment=self.mass * h / 2.0,
            inertia=self.mass * h**2 / 3.0,
        )


def _wall_frame_root(n: int, alpha: float) -> float:
    """Return γ_n of sin γx from the boundary conditions of a free top."""
    if math.isinf(alpha):
        return (n - 0.5) * math.pi
    from scipy.optimize import brentq

    def frequency(g: float) -> float:
        # 2 + (2 + α⁴/(γβ)²) cos γ cosh β + α²/(γβ) sin γ sinh β, times (γβ)²/cosh β
        b = math.hypot(alpha, g)
        fall = 2.0 * math.exp(-b) / (1.0 + math.exp(-2.0 * b))
        both = (g * b) ** 2
        return (
            2.0 * both * (fall + math.cos(g)) + alpha**4 * math.cos(g) + alpha**2 * g * b * math.sin(g) * math.tanh(b)
        )

    # At nπ the cosine is ±1 and dominates, so there is exactly one sign change in between.
    return float(brentq(frequency, max((n - 1) * math.pi, 1e-6), n * math.pi, xtol=1e-15, rtol=1e-14))


def _wall_frame_shape(x: Array, g: float, alpha: float) -> Array:
    """Return sin γx - η cos γx - (γ/β) sinh βx + η cosh βx, with the growing exponential measured from the top."""
    if math.isinf(alpha):
        return np.sin(g * x)
    b = math.hypot(alpha, g)
    q = math.exp(-2.0 * b)
    fall = 2.0 * math.exp(-b) / (1.0 + q)
    whole = g**2 * math.cos(g) * fall + b**2
    eta = (g**2 * math.sin(g) * fall + g * b * math.tanh(b)) / whole
    rising = (g**2 * math.sin(g) - g**3 / b * math.cos(g) - g * b * math.exp(-b)) / ((1.0 + q) * whole)
    falling = 0.5 * (eta + g / b)
    return np.sin(g * x) - eta * np.cos(g * x) + rising * np.exp(b * (x - 1.0)) + falling * np.exp(-b * x)
