"""A cantilever whose mass and stiffness vary along the height."""

from dataclasses import dataclass, field
from functools import cached_property
from typing import Annotated, ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.checks import (
    checked_damping_ratios,
    checked_instance,
    checked_whole_number,
    is_one_of,
)
from rockflex.foundation.descriptions import Described, described, one_for_each
from rockflex.foundation.errors import InputError
from rockflex.foundation.overflow import explaining_overflow
from rockflex.foundation.schema import DAMPING_RATIOS, BaseMass, HalfWidth, Modes
from rockflex.foundation.shown import shown
from rockflex.foundation.values import Value
from rockflex.structure._beam_modes import RitzShapes, cosine_shapes, ritz_modes
from rockflex.structure._beam_sections import (
    Along,
    BeamProfile,
    BeamSections,
    LumpedMasses,
    beam_profile,
    lumped_masses_on_beam,
)
from rockflex.structure._cross_section import Section, checked_section, value_from_section
from rockflex.structure._outline import Masses
from rockflex.structure._participation import MassNormalisedModes
from rockflex.structure._structure import AssembledStructure, ModalStructure

_N_ELEMENTS = 1000
_MAX_ELEMENTS = 10_000
_MIN_RITZ_SHAPES = 5  # at least: the number in Eq. 36


def _along(description: str, unit: str, note: str = "") -> Described:
    form = one_for_each("height in z")
    return Described(description, unit, form=form, in_file=float | list[float] | None, note=note)


@described
@dataclass(frozen=True, eq=False, kw_only=True)
class Beam(AssembledStructure, Value):
    """A cantilever with distributed mass on a rigid base that can rock.

    A property that varies along the height is given as a number, as a function of heights (n,) in m that returns values
    (n,), or as a table ``(heights, values)`` from the base to the top, linear between its rows; two rows at the same
    height are a jump. The formulas follow Silva & Stojadinović 2024, Table 2, with integrals in place of sums,
    and Eq. 33 for I_θ.

    Raises
    ------
    InputError
        If a value is outside its range, a table does not reach the top, or an argument does not apply to the method.

    Examples
    --------
    >>> import rockflex as rf
    >>> beam = rf.Beam(
    ...     height=20.0, mass=([0.0, 20.0], [800.0, 400.0]),
    ...     bending_stiffness=2e9, half_width=1.0,
    ...     damping_ratio=0.02, n_modes=3,
    ... )
    >>> beam.modal().period.round(3)
    array([0.349, 0.06 , 0.022])
    """

    title: ClassVar[str] = "Beam, perhaps tapered"

    height: Annotated[
        float, Described("the height of the beam above the base", "m", rule="positive", low=0.01, high=2000.0)
    ]
    mass: Annotated[Along | None, _along("the mass per metre in kg/m (unless a section gives it)", "kg/m")] = None
    bending_stiffness: Annotated[Along | None, _along("EI in N m² (unless a section gives it)", "N m²")] = None
    half_width: HalfWidth
    damping_ratio: Annotated[ArrayLike, DAMPING_RATIOS]
    shear_stiffness: Annotated[
        Along | None, _along("GA_s in N (default: no deformation in shear)", "N", "Of a Timoshenko beam; positive.")
    ] = None
    rotary_inertia: Annotated[
        Along | None, _along("ρI in kg m (default: none)", "kg m", "Of the section, for each metre; zero or positive.")
    ] = None
    section: Annotated[
        Section | None,
        Described(
            "the cross-section in place of bending stiffness and mass",
            form="a table of {}",
            note="The same from the base to the top.",
        ),
    ] = None
    lumped_masses: Annotated[
        LumpedMasses | None, Described("bodies", form="a table of {}", note="They are attached along the height.")
    ] = None
    base_mass: BaseMass = 0.0
    rotary_in_modes: Annotated[
        bool,
        Described(
            "whether the rotary inertia takes part in the modes, or in I_θ only",
            note="The first is consistent; the second is the paper's chimney.",
        ),
    ] = True
    method: Annotated[
        Literal["fe", "ritz"],
        Described(
            '"fe" (finite elements) or "ritz" (shapes over the whole height)',
            note="Rayleigh-Ritz neglects shear deformation.",
        ),
    ] = "fe"
    n_modes: Modes = 5
    n_elements: Annotated[
        int | None,
        Described(
            "how many finite elements to take (default: 1000)",
            rule="whole",
            within=(1, _MAX_ELEMENTS),
            note="Equal, and at least `n_modes`; they are subdivided where needed. Only for the method fe.",
            low=2,
            high=2000,
            label="Elements",
        ),
    ] = None
    shapes: Annotated[
        RitzShapes | None,
        Described(
            "at least `n_modes` shapes",
            in_file=False,
            note="Default: five shapes of Eq. 36, or `n_modes` if that is more. Only for the method ritz.",
        ),
    ] = None
    sections: BeamSections = field(init=False, repr=False)  # the given properties as profiles along the height

    def __post_init__(self) -> None:
        if not isinstance(self.rotary_in_modes, bool | np.bool_):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise InputError(
                f"rotary_in_modes must be True or False, but {shown(self.rotary_in_modes)} was given.",
                field="rotary_in_modes",
            )
        height, section = self.height, checked_section(self.section)
        mass, stiffness = (
            value_from_section(section, name, getattr(self, name)) for name in ("mass", "bending_stiffness")
        )
        vars(self).update(
            damping_ratio=checked_damping_ratios("damping_ratio", self.damping_ratio, self.n_modes),
            sections=BeamSections(
                height,
                beam_profile("mass", mass, height, "kg/m"),
                beam_profile("bending_stiffness", stiffness, height, "N m²"),
                _optional_profile("shear_stiffness", self.shear_stiffness, height, "N"),
                _optional_profile("rotary_inertia", self.rotary_inertia, height, "kg m", zero=True),
                lumped_masses_on_beam(self.lumped_masses, height),
                bool(self.rotary_in_modes),
            ),
        )
        for name in ("mass", "bending_stiffness", "shear_stiffness", "rotary_inertia"):
            along: BeamProfile | None = getattr(self.sections, name)
            vars(self)[name] = None if along is None else along.given
        self._check_method()

    @property
    def assembled(self) -> ModalStructure:
        """The structure known by its modes; their shapes are given at 20 equal steps of the height."""
        zeta = np.asarray(self.damping_ratio, dtype=np.float64)
        return ModalStructure(self._modes, self.base_mass, self.half_width, zeta)

    @cached_property
    def _modes(self) -> MassNormalisedModes:
        with explaining_overflow(f"The modes of a beam with {self.sections}"):
            if self.method == "fe":
                from rockflex.structure._finite_elements import finite_element_modes

                return finite_element_modes(self.sections, self._elements, self.n_modes)
            shapes = self.shapes
            if shapes is None:
                shapes = cosine_shapes(self.height, max(self.n_modes, _MIN_RITZ_SHAPES))
            return ritz_modes(self.sections, shapes, self.n_modes)

    @property
    def _elements(self) -> int:
        return max(_N_ELEMENTS, self.n_modes) if self.n_elements is None else self.n_elements

    def concentrated_masses(self) -> Masses:
        bodies = self.lumped_masses
        return () if bodies is None else tuple(zip(bodies.heights.tolist(), bodies.masses.tolist(), strict=True))

    def _check_method(self) -> None:
        if not is_one_of(self.method, ("fe", "ritz")):
            raise InputError(f'method must be "fe" or "ritz", but {shown(self.method)} was given.', field="method")
        lacking = {"fe": {"shapes": "ritz"}, "ritz": {"n_elements": "fe", "shear_stiffness": "fe"}}
        for name, other in lacking[self.method].items():
            if getattr(self, name) is not None:
                raise InputError(
                    f'{name} does not apply to method="{self.method}". Leave it out, or use method="{other}".',
                    field=name,
                )
        if self.n_elements is not None:
            vars(self).update(
                n_elements=checked_whole_number("n_elements", self.n_elements, self.n_modes, _MAX_ELEMENTS)
            )
        if self.shapes is not None:
            found = checked_instance("shapes", self.shapes, RitzShapes).check(self.height)
            if found < self.n_modes:
                raise InputError(
                    f"shapes must contain at least n_modes = {self.n_modes} shapes, but it contains {found}.",
                    field="shapes",
                )


def _optional_profile(
    name: str, given: Along | None, height: float, unit: str, *, zero: bool = False
) -> BeamProfile | None:
    return None if given is None else beam_profile(name, given, height, unit, zero=zero)
