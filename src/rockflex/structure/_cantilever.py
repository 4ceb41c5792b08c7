"""A uniform cantilever with a mass at its tip."""

from dataclasses import dataclass
from functools import cached_property

from numpy.typing import ArrayLike

from rockflex._checks import mode_count, positive
from rockflex._computable import computable
from rockflex._values import Value
from rockflex.structure._based import Assembled
from rockflex.structure._beam import Beam
from rockflex.structure._cross_section import Section, checked_section, of_section
from rockflex.structure._from_matrices import from_matrices
from rockflex.structure._modal_structure import ModalStructure
from rockflex.structure._sections import LumpedMasses

_N_MODES = 5


@dataclass(frozen=True, eq=False, kw_only=True)
class CantileverWithTipMass(Assembled, Value):
    """A uniform column with a mass at its tip, clamped to a base that can rock.

    Attributes
    ----------
    height : float
        Height H of the tip in m.
    tip_mass : float
        Mass at the tip in kg.
    bending_stiffness : float
        EI of the column in N m². With a section, its stiffness.
    base_mass : float
        Mass m_0 of the base in kg, zero or positive.
    half_width : float
        Half-width B of the base in m.
    damping_ratio : float or ndarray, shape (n_modes,)
        Damping ratio in [0, 1): one number for all modes, or one per mode.
    mass_per_length : float
        Mass of the column in kg/m, zero or positive. With a section, its mass.
    tip_inertia : float
        Rotary inertia of the tip mass about its own axis in kg m², zero or positive.
    n_modes : int, optional
        Number of modes. Default: 5; for a massless column all its modes: one, or two with `tip_inertia`.
    section : Section, optional
        Section of the column, in place of `bending_stiffness` and `mass_per_length`.

    Raises
    ------
    InputError
        If a value is outside its range, or the structure has fewer modes than `n_modes`.

    Examples
    --------
    >>> import rockflex as rf
    >>> column = rf.CantileverWithTipMass(
    ...     height=10.0, tip_mass=50e3, bending_stiffness=2e8, base_mass=10e3, half_width=1.0, damping_ratio=0.02
    ... )
    >>> column.modal().period.round(3)
    array([1.814])
    >>> round(column.rocking().resisting_moment)
    588600
    """

    height: float
    tip_mass: float
    bending_stiffness: float | None = None
    base_mass: float
    half_width: float
    damping_ratio: ArrayLike
    mass_per_length: float = 0.0
    tip_inertia: float = 0.0
    n_modes: int | None = None
    section: Section | None = None

    def __post_init__(self) -> None:
        section = checked_section(self.section)
        stiffness = of_section(section, "bending_stiffness", self.bending_stiffness)
        mass = of_section(section, "mass_per_length", self.mass_per_length, absent=0.0)
        vars(self).update(
            height=positive("height", self.height, "m"),
            tip_mass=positive("tip_mass", self.tip_mass, "kg"),
            bending_stiffness=positive("bending_stiffness", stiffness, "N m²"),
            mass_per_length=positive("mass_per_length", mass, "kg/m", zero=True),
            tip_inertia=positive("tip_inertia", self.tip_inertia, "kg m²", zero=True),
        )
        built = self.built
        vars(self).update(base_mass=built.base_mass, half_width=built.half_width, damping_ratio=built.damping_ratio)

    @cached_property
    def built(self) -> Beam | ModalStructure:
        """The column as a beam; for a massless column, the tip mass with two degrees of freedom."""
        if self.mass_per_length > 0.0:
            return Beam(
                height=self.height,
                mass=self.mass_per_length,
                bending_stiffness=self.bending_stiffness,
                lumped_masses=LumpedMasses([self.height], [self.tip_mass], [self.tip_inertia]),
                base_mass=self.base_mass,
                half_width=self.half_width,
                damping_ratio=self.damping_ratio,
                n_modes=_N_MODES if self.n_modes is None else self.n_modes,
            )
        modes = 1 if self.tip_inertia == 0.0 else 2
        h, stiffness = self.height, self.bending_stiffness or 0.0
        with computable(f"The stiffness of a column with height = {h:g} m and EI = {stiffness:g} N m²"):
            k = stiffness / h**3
            matrix = [[12.0 * k, -6.0 * k * h], [-6.0 * k * h, 4.0 * k * h**2]]
        return from_matrices(
            [self.tip_mass, self.tip_inertia],
            matrix,
            {0: h},
            rotations=[1],
            base_mass=self.base_mass,
            half_width=self.half_width,
            damping_ratio=self.damping_ratio,
            n_modes=mode_count(self.n_modes, modes),
        )

    @property
    def assembled(self) -> Beam | ModalStructure:
        """The beam, or the body on two freedoms: that of `built`."""
        return self.built
