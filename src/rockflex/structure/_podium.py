"""Structures on columns that rock together: podiums."""

from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.descriptions import PLAIN, Described, described
from rockflex.foundation.errors import InputError
from rockflex.structure._pivot import OnColumns
from rockflex.structure._rigid_bodies import body_on_columns, rocking_frame
from rockflex.structure._rocking import RockingProperties
from rockflex.structure._structure import InFile, ModifiedStructure, Structure, checked_structure


@described
@dataclass(frozen=True, init=False)
class Podium(ModifiedStructure):
    """A building on a slab that stands on equal columns, which rock together: a rocking podium.

    The slab is the base of the building, with its `base_mass`. It moves sideways by H θ and rises by 2 b |θ| without
    turning, and so do all floors, beside their drifts. At an impact slab and columns roll on, θ' → e θ', while every
    floor keeps its horizontal velocity.

    Raises
    ------
    InputError
        If `structure` is no such structure, a value is out of range, or the columns are so squat that e would be
        negative.

    Notes
    -----
    With H = 2 h, R² = b² + h² and the mass M_s of slab and building, I_θ = N m_c 4/3 R² + M_s (H² + 4 b²), the weight's
    moment is (N m_c + 2 M_s) g b, and every mode is coupled by H in place of h*_n. Base moment and drifts are those
    above the slab. The restitution, with the floors free sideways,

    e = [N m_c (R²/3 + h² - b²) + 4 m_slab (h² - b²) - 4 b² m_building]
    / [4/3 N m_c R² + 4 m_slab R² + 4 b² m_building],

    is derived for rockflex from the momentum about the new pivots; without a building it is that of
    Makris & Vassiliou (2013, Earthq. Eng. Struct. Dyn. 42(3), 431-449), as in `rocking_frame`. For simplified models on
    rigid ground.

    Examples
    --------
    >>> import rockflex as rf
    >>> building = rf.Frame(
    ...     n_stories=3, story_height=3.0, story_mass=40e3, base_mass=120e3,
    ...     stiffness_ratio=1.0,
    ...     period=0.4, aspect_ratio=3.0, damping_ratio=0.03,
    ... )
    >>> podium = rf.Podium(building, n_columns=4, column_width=0.8,
    ...     column_height=5.0, column_mass=8e3)
    >>> round(podium.rocking().restitution, 3)
    0.907
    """

    in_file = InFile(
        key="podium",
        words=Described("a table", label="Podium", form=PLAIN, page="columns under it that rock together"),
        floors=True,
    )

    structure: Annotated[
        Structure | None,
        Described(
            "a building, with the slab as its base",
            in_file=False,
            note="A `Frame`, a `Beam` ...; None for the slab alone, which is a `rocking_frame`.",
        ),
    ]
    n_columns: Annotated[
        int, Described("how many columns stand side by side", rule="whole", within=(1, 10_000), low=1, high=10_000)
    ]
    column_width: Annotated[
        float,
        Described("the width 2 b of a column in the plane of rocking", "m", rule="positive", low=1e-3, high=1000.0),
    ]
    column_height: Annotated[
        float, Described("the height 2 h of a column", "m", rule="positive", low=1e-3, high=1000.0)
    ]
    column_mass: Annotated[float, Described("the mass of one column", "kg", rule="positive")]
    slab_mass: Annotated[
        float | None,
        Described(
            "the mass of the slab (default: that of the base of the building)",
            "kg",
            rule="zero or positive",
            low=0.0,
            high=1e12,
        ),
    ] = None
    column_spacing: Annotated[
        float | None,
        Described(
            "the distance between neighbouring columns",
            "m",
            rule="positive",
            note="With it, a run warns where the base moment of the building would pull an outer column up.",
            low=1e-3,
            high=1000.0,
        ),
    ] = None

    def __init__(
        self,
        structure: Structure | None,
        n_columns: int,
        column_width: float,
        column_height: float,
        column_mass: float,
        slab_mass: float | None = None,
        column_spacing: float | None = None,
    ) -> None:
        vars(self).update(
            structure=None if structure is None else checked_structure(structure),
            n_columns=n_columns,
            column_width=column_width,
            column_height=column_height,
            column_mass=column_mass,
            slab_mass=slab_mass,
            column_spacing=column_spacing,
        )
        self.check()

    def rocking(self, n_modes: Any = None) -> RockingProperties:
        """Return the parameters of the rocking structure with its first `n_modes` modes (default: all)."""
        if self.structure is None:
            return rocking_frame(
                self.n_columns, self.column_width, self.column_height, self.column_mass, self.slab_mass or 0.0
            ).rocking(n_modes)
        return super().rocking(n_modes)

    def _changes(self, base: RockingProperties) -> dict[str, Any]:
        slab, height = base.base_mass if self.slab_mass is None else self.slab_mass, self.column_height
        if slab is None or base.base_mass is None or base.floors is None or base.leaning_mass or base.joints:
            raise InputError(
                "The structure on a podium needs floors, a mass of its base, which is the slab, and neither leaning "
                "mass nor joints. Give a Frame or another structure with floors.",
                field="structure",
            )
        if base.opens != "both" or base.eccentricity or any(not each.between for each in base.elements):
            raise InputError(
                "A podium changes how a building stands: what is under its base does not apply. Put a podium under the "
                "building itself, and elements between its floors alone.",
                field="structure",
            )
        building = base.m_tot - base.base_mass
        body = body_on_columns(self.n_columns, self.column_width, height, self.column_mass, slab, building)
        pull = np.inf
        if self.column_spacing is not None and self.n_columns > 1:
            pull = (slab + building) * GRAVITY * self.column_spacing * (self.n_columns + 1) / 6.0
        return body._asdict() | {
            "effective_height": np.full(base.n_modes, height),
            "translational_inertia": body.i_theta - body.m_tot * body.half_width**2,
            "top_height": height,
            "base_mass": body.m_tot - building,
            "columns": OnColumns(height, float(pull)),
        }
