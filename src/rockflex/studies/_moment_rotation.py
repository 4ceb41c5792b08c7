"""Cyclic pushover of the base of a structure."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import overload

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.checks import checked_finite_vector
from rockflex.foundation.errors import InputError
from rockflex.models._label import Model
from rockflex.response._moment_rotation import MomentRotation, MomentRotationOnSprings
from rockflex.response._quasi_static import static_path
from rockflex.structure._ground import Ground
from rockflex.structure._rocking import RockingProperties
from rockflex.studies._arguments import (
    GroundChoice,
    RockingStructure,
    check_run_options,
    ground_under_structure,
    rocking_properties_of,
)

QUARTER_TURN = 0.5 * math.pi


@overload
def moment_rotation(
    structure: RockingStructure | RockingProperties, rotations: ArrayLike, *, ground: None = None
) -> MomentRotation: ...


@overload
def moment_rotation(
    structure: RockingStructure | RockingProperties,
    rotations: ArrayLike,
    *,
    ground: Ground | Callable[[RockingProperties], Ground],
) -> MomentRotationOnSprings: ...


def moment_rotation(
    structure: RockingStructure | RockingProperties, rotations: ArrayLike, *, ground: GroundChoice = None
) -> MomentRotation | MomentRotationOnSprings:
    """Rotate the base of a structure slowly to and fro, and return its moment and the forces of its elements.

    M = s (m_tot g B_s + Σ F r) - L_0^r g θ about the acting pivot, with the tension F of each element at its distance r
    from this pivot (Silva & Stojadinović 2024, Eq. 23 without inertia and flexure, and the elements). The path begins
    at rest. In contact the moment passes from the value at which the base closes to the one at which it lifts about the
    other pivot. An element that has yielded keeps a force there, which shifts these values.

    The rotation is prescribed, and the geometry is that of the simplified models. Everything is then linear between
    points at which elements change their branch, and these points are exact. Viscous dampers contribute nothing,
    because the rotation is infinitely slow. A friction damper turns its force round at once where the rotation turns.

    On springs the base heaves so that they carry the weight and the tensions, and M = Σ x N - Σ x F - L_0^r g θ with
    the force N of each spring at x from the axis of the masses. Dashpots and friction under the base contribute
    nothing. The path begins at rest, settled; θ counts from the level base, as in a run.

    The structure is rigid here, so that elements between its floors, stories that yield and joints above the base do
    not matter; `pushover` has the former two.

    Parameters
    ----------
    structure
        A structure with its elements, such as a `Restrained` one, or its `RockingProperties`.
    rotations : array_like, shape (m,)
        Rotations θ in rad through which the base is driven, positive about the right pivot: turning points, or the
        samples of any history. Between adjacent values the rotation does not turn back.
    ground
        A `Ground` with springs, or a function of `RockingProperties` that returns one. Default: rigid ground.

    Returns
    -------
    MomentRotation or MomentRotationOnSprings
        At the given rotations and at all points in between where an element changes its branch, or a spring becomes
        empty or is met again.

    Raises
    ------
    InputError
        If there are no rotations, one is not finite, beyond π/2 or to a side to which the structure does not open, the
        ground has no springs, or the structure cannot stand on them.

    References
    ----------
    The flag shape: Christopoulos, Filiatrault & Folz 2002, doi 10.1002/eqe.152. Two springs and a bed under a rigid
    base: Yim & Chopra 1984, Earthquake Engineering & Structural Dynamics 12, 263-281.

    Examples
    --------
    >>> import rockflex as rf
    >>> wall = rf.CantileverWithTipMass(
    ...     height=10.0, tip_mass=50e3, bending_stiffness=2e9, base_mass=10e3,
    ...     half_width=1.5, damping_ratio=0.02
    ... )
    >>> fuse = rf.YieldingDissipator(stiffness=60e6, yield_force=150e3)
    >>> held = rf.Restrained(wall,
    ...     [rf.Tendon(initial_force=300e3, stiffness=8e6), fuse])
    >>> curve = rf.moment_rotation(held, [0.0, 0.02, 0.0])
    >>> print((curve.to_frame()[["rotation", "moment",
    ...     "element_force_2"]] / [1.0, 1e3, 1e3]).round(4))
       rotation    moment  element_force_2
    0    0.0000     0.000              0.0
    1    0.0000  1332.900              0.0
    2    0.0017  1579.725            150.0
    3    0.0200  1819.800            150.0
    4    0.0167  1326.150           -150.0
    5    0.0000  1107.900           -150.0

    The same wall without elements on a bed of soil: a part of the base is lifted beyond M = W B/3, 294 kN m.

    >>> soil = rf.Ground(springs=rf.winkler_bed(1.5, 2.0, 100e6, n=100),
    ...     base_inertia=8e3)
    >>> push = rf.moment_rotation(wall, [0.0, 0.005], ground=soil)
    >>> print((push.uplift_moments / 1e3).round(1),
    ...     push.contact_length[-1].round(3))
    [294.] 1.085
    """
    path = checked_finite_vector("rotations", rotations, "rad")
    if path.size == 0:
        raise InputError("rotations is empty. Give at least one rotation of the base in rad.", field="rotations")
    beyond = np.flatnonzero(np.abs(path) > QUARTER_TURN * (1.0 + 1e-9))  # a run that overturns ends at π/2
    if beyond.size:
        raise InputError(
            f"rotations must be at most a quarter turn, {QUARTER_TURN:.4g} rad, to each side, but "
            f"rotations[{beyond[0]}] = {path[beyond[0]]:g} rad was given. Check the units: one degree is 0.01745 rad.",
            field="rotations",
        )
    properties = _held_at_base(rocking_properties_of(structure))
    closed = np.flatnonzero(~np.isin(np.sign(path), (0, *properties.sides)))
    if closed.size:
        raise InputError(
            f"rotations[{closed[0]}] = {path[closed[0]]:g} rad was given, but the structure opens to the "
            f"{properties.opens} alone. Give rotations to that side.",
            field="rotations",
        )
    check_run_options(None, None, ground)
    under = ground_under_structure(properties, ground)
    if under is None:
        return static_path(properties, path)
    if under.springs is None:
        raise InputError(
            "ground must have springs, but one with friction alone was given. A base that is pushed slowly does not "
            "slide: leave the ground out, or give it springs.",
            field="ground",
        )
    still = Ground(springs=under.springs, base_inertia=under.base_inertia)  # no horizontal force: nothing slides
    model = Model(n_modes=None if properties.n_modes else 0).of(properties, ground=still)
    return static_path(model.properties, path, model.springs, model.rest)


def _held_at_base(properties: RockingProperties) -> RockingProperties:
    """Return the structure with the elements under its base alone.

    Raises
    ------
    InputError
        If a tie holds it from a height.
    """
    for each in properties.elements:
        if each.height is not None:
            raise InputError(
                f"moment_rotation is for elements under the base, but a {type(each).__name__} acts from {each.where}. "
                "Use pushover, which has elements anywhere.",
                field="elements",
            )
    under = tuple(each for each in properties.elements if not each.attached)
    return replace(properties, elements=under, stories=(), joints=())
