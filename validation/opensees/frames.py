"""Structures #1 and #2 of Table 1 as OpenSees models, on a base that is fixed or can uplift.

Units are SI. Rotations are positive counterclockwise in OpenSees, clockwise in rockflex: θ = −(OpenSees' rotation).
"""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

import rockflex as rf

Float = NDArray[np.float64]

N_STORIES, STORY_HEIGHT, STORY_MASS, BASE_MASS = 5, 3.0, 40e3, 40e3  # m, kg, kg
PERIOD, ASPECT_RATIO, GRAVITY = 1.0, 10.0, 9.81  # s, h*_1/B, m/s²
HEIGHTS = STORY_HEIGHT * np.arange(1.0, N_STORIES + 1.0)
TOTAL_MASS = BASE_MASS + N_STORIES * STORY_MASS
WEIGHT_ARM = STORY_MASS * float(HEIGHTS.sum())  # L_0^r
FLOORS = range(1, N_STORIES + 1)
GROUND, FOOTING, LEFT, RIGHT = 100, 101, 102, 103  # nodes; the base is node 0, the floors are 1 to 5
SECTION = 200  # element
STIFF = 1e13  # N, EA of columns that must not shorten


def load_opensees() -> Any:
    """OpenSeesPy's commands.

    Raises
    ------
    ImportError
        If it is not installed, or lacks Debian's BLAS; the message says what to install.
    """
    try:
        import openseespy.opensees as ops
    except (ImportError, RuntimeError) as error:
        raise ImportError(
            f"OpenSeesPy cannot be imported ({error}). Install it (pip install openseespy) and, on Debian, the "
            "libraries that it is linked with (apt-get install libblas3 liblapack3)."
        ) from error
    return ops


@dataclass(frozen=True)
class Prototype:
    """A frame of Table 1 with T_1 = 1 s and h*_1/B = 10."""

    name: str
    shear: bool  # rigid beams (ρ = ∞), or none (ρ = 0)

    def frame(self, damping_ratio: float = 0.0) -> rf.Frame:
        """Return the frame in rockflex."""
        ratio = math.inf if self.shear else 0.0
        arguments = (N_STORIES, STORY_HEIGHT, STORY_MASS, BASE_MASS, ratio, PERIOD, ASPECT_RATIO)
        return rf.Frame(*arguments, damping_ratio)

    def structure(self, damping_ratio: Float | float = 0.0, *, second_order: bool = False) -> rf.LumpedStructure:
        """Return the frame with a damping ratio for each mode; `second_order` subtracts P/L from each stiffness."""
        lumped = self.frame().lumped
        stiffness = np.array(lumped.stiffness)
        if second_order:
            for i in range(N_STORIES):  # story i carries the floors from i up
                chord = (N_STORIES - i) * STORY_MASS * GRAVITY / STORY_HEIGHT
                ends = np.zeros(N_STORIES)
                ends[i] = 1.0
                if i > 0:
                    ends[i - 1] = -1.0
                stiffness -= chord * np.outer(ends, ends)
        given = {"base_mass": BASE_MASS, "half_width": lumped.half_width, "damping_ratio": damping_ratio}
        return rf.LumpedStructure(lumped.masses, stiffness, lumped.heights, **given)


SHEAR, FLEXURE = Prototype("#1 shear", True), Prototype("#2 flexure", False)


@dataclass(frozen=True)
class Contact:
    """Two corners in no-tension contact with the ground."""

    stiffness: float  # of each corner, N/m
    damping: float = 0.0  # of the footing under the corners, of critical for the total mass; 0: no footing


@dataclass(frozen=True)
class Modes:
    """Properties on a fixed base, from OpenSees only."""

    column: float  # EI of all columns of a story, N m²
    omega: Float
    effective_mass: Float
    effective_height: Float

    @property
    def half_width(self) -> float:
        """B in m."""
        return float(self.effective_height[0]) / ASPECT_RATIO


def start(ops: Any) -> None:
    """Start a plane model with three degrees of freedom per node."""
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)


def fixed(ops: Any, prototype: Prototype, column: float) -> None:
    """One column for all columns of a story, fixed at the base; rigid beams prevent rotations of the floors."""
    start(ops)
    ops.geomTransf("Linear", 1)
    ops.node(0, 0.0, 0.0)
    ops.fix(0, 1, 1, 1)
    for i in FLOORS:
        ops.node(i, 0.0, i * STORY_HEIGHT)
        ops.mass(i, STORY_MASS, 0.0, 0.0)
        ops.fix(i, 0, 1, int(prototype.shear))
        ops.element("elasticBeamColumn", i, i - 1, i, 1.0, 1.0, column, 1)


@lru_cache(maxsize=4)
def modes(prototype: Prototype) -> Modes:
    """Columns that give the required period, and the modes, all by OpenSees' eigen."""
    ops = load_opensees()
    fixed(ops, prototype, 1.0)
    column = (2.0 * math.pi / PERIOD) ** 2 / eigenvalues(ops)[0]
    fixed(ops, prototype, column)
    omega = np.sqrt(eigenvalues(ops))
    shapes = np.array([[ops.nodeEigenvector(i, n, 1) for n in FLOORS] for i in FLOORS])
    generalised = STORY_MASS * (shapes**2).sum(axis=0)
    excitation = STORY_MASS * shapes.sum(axis=0)
    height = STORY_MASS * (HEIGHTS @ shapes) / excitation
    ops.wipe()
    return Modes(column, omega, excitation**2 / generalised, height)


def eigenvalues(ops: Any, count: int = N_STORIES) -> Float:
    """ω_n² in (rad/s)²; by LAPACK, because ARPACK cannot compute as many as there are masses."""
    return np.array(ops.eigen("-fullGenLapack", count))


def linear(ops: Any, prototype: Prototype, contact: Contact, *, gravity_spring: bool = True) -> None:
    """Linear geometry: the simplified model, MDOF-S.

    The base rotates about its middle and translates vertically; two no-tension fibres of a section are its corners. The
    moment of the weight, L_0^r g θ, is a spring of negative stiffness on the base. Floors share the base's vertical
    displacement (inextensible columns), and with rigid beams its rotation.
    """
    start(ops)
    properties = modes(prototype)
    width = properties.half_width
    ops.geomTransf("Linear", 1)
    base(ops, held=True)
    ops.node(GROUND, 0.0, 0.0)
    ops.fix(GROUND, 1, 1, 1)
    corner, below = contact.stiffness, GROUND
    if contact.damping > 0.0:  # a footing on springs and dashpots; contact with it is ten times as stiff
        ops.node(FOOTING, 0.0, 0.0)
        ops.fix(FOOTING, 1, 0, 0)
        dashpot = contact.damping * 2.0 * math.sqrt(2.0 * corner * TOTAL_MASS)
        ops.uniaxialMaterial("Elastic", 11, 2.0 * corner, dashpot)
        ops.uniaxialMaterial("Elastic", 12, 2.0 * corner * width**2, dashpot * width**2)
        ops.element("zeroLength", SECTION + 1, GROUND, FOOTING, "-mat", 11, 12, "-dir", 2, 6)
        corner, below = 10.0 * corner, FOOTING
    ops.uniaxialMaterial("ENT", 1, corner)
    ops.section("Fiber", 1)
    for x in (-width, width):
        ops.fiber(x, 0.0, 1.0, 1)
    ops.element("zeroLengthSection", SECTION, below, 0, 1, "-orient", 0.0, 1.0, 0.0, -1.0, 0.0, 0.0)
    if gravity_spring:
        ops.uniaxialMaterial("Elastic", 2, -WEIGHT_ARM * GRAVITY)
        ops.element("zeroLength", SECTION + 2, GROUND, 0, "-mat", 2, "-dir", 6)
    columns(ops, properties.column, 1.0, (2, 3) if prototype.shear else (2,))
    weights(ops)


def corotational(ops: Any, prototype: Prototype, contact: Contact, pivot: float) -> None:
    """Large rotations: the complete model, MDOF-C, with columns softened by the weight that they carry.

    The base is two stiff corotational beams, held horizontally only at the corner on the side `pivot` (+1 right, −1
    left), so it is valid for one excursion about that corner.
    """
    start(ops)
    properties = modes(prototype)
    width = properties.half_width
    ops.geomTransf("Corotational", 1)
    base(ops, held=False)
    ops.uniaxialMaterial("ENT", 1, contact.stiffness)
    for corner, x in ((LEFT, -width), (RIGHT, width)):
        ops.node(corner, x, 0.0)
        ops.fix(corner, int(x * pivot > 0.0), 0, 0)
        ops.node(corner + 10, x, 0.0)
        ops.fix(corner + 10, 1, 1, 1)
        ops.element("zeroLength", corner, corner + 10, corner, "-mat", 1, "-dir", 2)
        stiff = 100.0 * contact.stiffness * width**3  # a corner's sag in the beam is 1/300 of that in the contact
        ops.element("elasticBeamColumn", corner + 10, 0, corner, STIFF, 1.0, stiff, 1)
    columns(ops, properties.column, STIFF, (3,) if prototype.shear else ())
    weights(ops)


def base(ops: Any, *, held: bool) -> None:
    """Add the base at its middle; `held` horizontally."""
    ops.node(0, 0.0, 0.0)
    ops.fix(0, int(held), 0, 0)
    ops.mass(0, BASE_MASS, BASE_MASS, 0.0)


def columns(ops: Any, column: float, axial: float, tied: tuple[int, ...]) -> None:
    """Add floors and columns; they share the degrees of freedom `tied` with the base."""
    for i in FLOORS:
        ops.node(i, 0.0, i * STORY_HEIGHT)
        ops.mass(i, STORY_MASS, STORY_MASS, 0.0)
        if tied:
            ops.equalDOF(0, i, *tied)
        ops.element("elasticBeamColumn", i, i - 1, i, axial, 1.0, column, 1)


def weights(ops: Any) -> None:
    """Add the dead loads."""
    ops.timeSeries("Constant", 1)
    ops.pattern("Plain", 1, 1)
    for i, mass in enumerate([BASE_MASS] + [STORY_MASS] * N_STORIES):
        ops.load(i, 0.0, -mass * GRAVITY, 0.0)
