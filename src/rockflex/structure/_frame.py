"""A regular frame, from a pair of cantilevers to a shear building."""

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import SupportsIndex

import numpy as np

from rockflex._arrays import Array
from rockflex._checks import MOST_STORIES, in_range, mode_count, positive, real_or_nan, whole_number
from rockflex._computable import computable
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex._values import changed
from rockflex.modal import ModalProperties, RockingProperties, modal_properties, rocking_properties
from rockflex.structure._based import Assembled
from rockflex.structure._fish_bone import condensed_stiffness
from rockflex.structure._lumped import LumpedStructure

SMALL, LARGE = 1e-20, 1e20  # of numbers in SI units whose products certainly do not overflow
SLENDER = 1e4  # h*_1/B from which the base hardly adds to the inertia, which must be checked


@dataclass(frozen=True)
class Frame(Assembled):
    """A frame of one bay and N equal stories, with columns clamped to a base that can rock.

    Columns and beams are inextensible, of uniform stiffness, and the same in all stories; the masses are
    lumped at the floors. The stiffness is scaled to give the specified period, and the base width follows from the
    aspect ratio (Silva & Stojadinović 2024, Section 3.2 and Table 1).

    Attributes
    ----------
    n_stories : int
        Number of stories N, at most 1000.
    story_height : float
        Column length L_c in m; floor i is at i L_c.
    story_mass : float
        Mass of each floor in kg.
    base_mass : float
        Mass m_0 of the base in kg, zero or positive.
    stiffness_ratio : float
        ρ = (EI_b/L_b)/(2 EI_c/L_c), from 0 (two cantilevers) to infinity (shear building), both included.
    period : float
        First natural period T_1 on a fixed base in s.
    aspect_ratio : float
        h*_1/B.
    damping_ratio : float
        Damping ratio of every mode in [0, 1).

    Raises
    ------
    InputError
        If a value is outside its range.

    Notes
    -----
    Sway is antisymmetric, so the two joints of a floor rotate by the same angle φ and a beam of stiffness
    EI_b/L_b bends in double curvature with end moments 6 (EI_b/L_b) φ. It adds the rotational stiffness
    12 EI_b/L_b = 12 ρ (2 EI_c/L_c). The two columns contribute 2 EI_c/L_c times the usual terms of a clamped bar. In
    units of 2 EI_c/L_c³, with φ L_c for the rotations, the beam enters only through ρ: neither the width of
    the bay nor EI_b matters by itself.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(
    ...     n_stories=5, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=float("inf"),
    ...     period=1.0, aspect_ratio=8.0, damping_ratio=0.02,
    ... )
    >>> round(frame.half_width, 3)
    1.318
    >>> frame.modal(3).period.round(3)
    array([1.   , 0.343, 0.217])
    """

    n_stories: int
    story_height: float
    story_mass: float
    base_mass: float
    stiffness_ratio: float
    period: float
    aspect_ratio: float
    damping_ratio: float

    def __post_init__(self) -> None:
        vars(self).update(
            n_stories=whole_number("n_stories", self.n_stories, 1, MOST_STORIES),
            story_height=positive("story_height", self.story_height, "m"),
            story_mass=positive("story_mass", self.story_mass, "kg"),
            base_mass=positive("base_mass", self.base_mass, "kg", zero=True),
            stiffness_ratio=_checked_stiffness_ratio(self.stiffness_ratio),
            period=positive("period", self.period, "s"),
            aspect_ratio=positive("aspect_ratio", self.aspect_ratio, "m of h*_1 a m of B"),
            damping_ratio=in_range(
                "damping_ratio",
                self.damping_ratio,
                0.0,
                1.0,
                hint="Give the fraction of critical damping: 2 % is 0.02.",
            ),
        )

    @property
    def height(self) -> float:
        """Height N L_c of the top floor above the base in m."""
        return self.n_stories * self.story_height

    @property
    def half_width(self) -> float:
        """Half-width B = h*_1/aspect_ratio of the base in m."""
        _, unit_modes = _unit_frame(self.n_stories, self.stiffness_ratio)
        return float(unit_modes.effective_height[0]) * self.story_height / self.aspect_ratio

    @cached_property
    def lumped(self) -> LumpedStructure:
        """The assembled structure: floor masses, condensed stiffness, floor heights."""
        unit_stiffness, unit_modes = _unit_frame(self.n_stories, self.stiffness_ratio)
        given = f"story_mass = {self.story_mass:g} kg and period = {self.period:g} s"
        with computable(f"The stiffness of a frame with {given}"):
            column_stiffness = self.story_mass * (2.0 * math.pi / (self.period * float(unit_modes.omega[0]))) ** 2
            stiffness = column_stiffness * unit_stiffness
        with computable(f"The heights of {self.n_stories} stories of {self.story_height:g} m"):
            heights = self.story_height * np.arange(1.0, self.n_stories + 1.0)
        return LumpedStructure(
            np.full(self.n_stories, self.story_mass),
            stiffness,
            heights,
            base_mass=self.base_mass,
            half_width=self.half_width,
            damping_ratio=self.damping_ratio,
        )

    @property
    def assembled(self) -> LumpedStructure:
        """Lumped masses: those of `lumped`."""
        return self.lumped

    def rocking(self, n_modes: SupportsIndex | None = None) -> RockingProperties:
        """Return the parameters of the rocking structure with its first `n_modes` modes, or with all.

        They are those of a frame with unit masses and stories, scaled.

        Raises
        ------
        InputError
            If `n_modes` is not from 1 to the number that the structure has.
        """
        whole = self._rocking
        return whole if n_modes is None else whole.truncated(mode_count(n_modes, whole.n_modes))

    @cached_property
    def _rocking(self) -> RockingProperties:
        given = (self.story_height, self.story_mass, self.period, self.half_width)
        if not (min(given) > SMALL and max(given) < LARGE > self.base_mass and self.aspect_ratio < SLENDER):
            return self.lumped.rocking()  # which says what overflows
        _, unit_modes = _unit_frame(self.n_stories, self.stiffness_ratio)
        unit, m, length = _unit_rocking(self.n_stories, self.stiffness_ratio), self.story_mass, self.story_height
        rate = 2.0 * math.pi / (self.period * float(unit_modes.omega[0]))
        mass, height = m * unit.effective_mass, length * unit.effective_height
        n, m_tot = self.n_stories, self.n_stories * m + self.base_mass
        inertia = m * length**2 * (n * (n + 1) * (2 * n + 1) // 6)
        floors = unit.floors
        assert floors is not None
        heights = length * floors.heights
        return changed(
            unit,
            omega=rate * unit.omega,
            effective_mass=mass,
            effective_height=height,
            i_theta=inertia + m_tot * self.half_width**2,
            l0r=m * length * unit.l0r,
            m_tot=m_tot,
            half_width=self.half_width,
            zeta=np.full(unit.n_modes, self.damping_ratio),
            translational_inertia=max(inertia, float(mass @ height**2)),
            floors=changed(floors, heights=heights, force=(m * rate**2) * floors.force),
            top_height=float(heights[-1]),
            base_mass=self.base_mass,
        )


@lru_cache(maxsize=128)
@computable("The modes of the frame with this stiffness_ratio", field="stiffness_ratio")
def _unit_frame(n_stories: int, stiffness_ratio: float) -> tuple[Array, ModalProperties]:
    """Return the condensed stiffness in units of 2 EI_c/L_c³, and the modes for unit masses and stories."""
    one = np.ones(n_stories)
    stiffness = condensed_stiffness(one, one, 12.0 * stiffness_ratio * one)
    stiffness.setflags(write=False)
    return stiffness, modal_properties(one, stiffness, np.cumsum(one))


@lru_cache(maxsize=128)
def _unit_rocking(n_stories: int, stiffness_ratio: float) -> RockingProperties:
    """Return the parameters for unit masses and stories, on a base of unit half-width without mass."""
    _, modes = _unit_frame(n_stories, stiffness_ratio)
    return rocking_properties(modes, np.ones(n_stories), modes.heights, 0.0, 1.0, 0.0)


def _checked_stiffness_ratio(value: float) -> float:
    ratio = real_or_nan(value)
    if not ratio >= 0.0:
        raise InputError(
            f"stiffness_ratio must be from 0 (two cantilever columns) to float('inf') (shear building), "
            f"but {shown(value)} was given.",
            field="stiffness_ratio",
        )
    return ratio
