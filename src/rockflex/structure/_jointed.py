"""Structures that rock at several joints: walls that open above their base as well, and segmental piers."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_instances
from rockflex.foundation.descriptions import PLAIN, Described, described, one_for_each
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.structure._joint import Joint, JointAbove
from rockflex.structure._leaning import Leaning, lumped_structure_of
from rockflex.structure._rocking import RockingProperties
from rockflex.structure._structure import InFile, ModifiedStructure, Structure
from rockflex.structure._yielding_stories import YieldingStories

MASSLESS = 1e-9  # of all mass


@described
def joints_at(
    heights: Annotated[
        list[float],
        Described("a list of the heights of the joints above the base in m, from the lowest up", "m", form=PLAIN),
    ],
    half_widths: Annotated[
        float | list[float],
        Described("the distance from the axis of the masses to either edge", "m", form=one_for_each("joint")),
    ],
) -> list[Joint]:
    """Return joints at some heights, as files and forms have them.

    Raises
    ------
    InputError
        If there is not one half width for all joints, or one for each.
    """
    widths = half_widths if isinstance(half_widths, list) else [half_widths] * len(heights)
    if len(widths) != len(heights):
        raise InputError(
            f"half_widths must be one number, or one for each of the {len(heights)} joints, but {shown(widths)} was "
            "given.",
            field="half_widths",
        )
    return [Joint(height, width) for height, width in zip(heights, widths, strict=True)]


def _table_of_joints(joints: Sequence[Mapping[str, float]]) -> dict[str, list[float]]:
    """Return the arguments of `joints_at` for the arguments of joints."""
    return {f"{name}s": [each[name] for each in joints] for name in ("height", "half_width")}


@described
@dataclass(frozen=True, init=False)
class Jointed(ModifiedStructure):
    """A structure that rocks at its base and at horizontal joints above it: a wall or a pier of segments.

    What is above a joint rotates as a whole, and rises, about one edge of the joint; it lands without rebound. Tendons
    run from the ground through all joints to the top; other elements under the base act at the base alone.

    Raises
    ------
    InputError
        If `structure` is none of these, or a joint is not below its top, not above the one before, or no mass is
        between the two.

    Notes
    -----
    With the rotations θ_j of the joints at the heights Z_j, the base among them, a floor moves by u_i + Σ_j (z_i - Z_j)
    θ_j over the joints below it, and rises by Σ_j B_j |θ_j|. A joint opens once the moment that holds it exceeds N_j
    B_j, where N_j is what presses on it at that moment. As a joint lands, all horizontal velocities stay, and an
    impulse at the joint alone stops its rotation; other open joints are slowed down with it. Of the base alone this is
    Eq. 25.

    Examples
    --------
    >>> import rockflex as rf
    >>> wall = rf.Frame(
    ...     n_stories=6, story_height=3.0, story_mass=40e3, base_mass=60e3,
    ...     stiffness_ratio=0.0,
    ...     period=0.4, aspect_ratio=7.0, damping_ratio=0.03,
    ... )
    >>> jointed = rf.Jointed(wall, [rf.Joint(height=9.0, half_width=1.0)])
    >>> pulse = rf.one_sine_pulse(amplitude=6.0, period=0.5)
    >>> for each in (wall, jointed):
    ...     run = rf.simulate(each, pulse, free_vibration=2.0)
    ...     print(round(run.max_rotation, 4), round(run.max_joint_rotation, 4))
    0.0151 0.0
    0.006 0.0311
    """

    in_file = InFile(
        key="joints",
        words=Described("a table", label="Joints above the base", form=PLAIN, page="where it rocks besides its base"),
        argument="joints",
        makes=joints_at,
        taken=_table_of_joints,
        floors=True,
    )

    structure: Annotated[
        Structure,
        Described(
            "a structure of floors",
            in_file=False,
            note="A `Frame`, a `FishBone` or a `LumpedStructure`, also with `Leaning` mass or `YieldingStories`. "
            "Elements and an eccentricity come afterwards.",
        ),
    ]
    joints: Annotated[
        tuple[Joint, ...],
        Described(
            "a list of joints above the base, from the lowest up", form=PLAIN, note="The base is a joint itself."
        ),
    ]

    def __init__(self, structure: Structure, joints: Joint | Iterable[Joint]) -> None:
        given = checked_instances("joints", (joints,) if isinstance(joints, Joint) else joints, Joint)
        heights, _, _ = _masses_of(structure)
        below = 0.0
        for place, each in enumerate(given):
            if not below < each.height <= heights.max():
                raise InputError(
                    f"joints must be above one another and not above the highest mass, at {heights.max():g} m, but no. "
                    f"{place + 1} is at {each.height:g} m after {below:g} m.",
                    field=f"joints.{place}.height",
                )
            below = each.height
        vars(self).update(structure=structure, joints=given)
        self.check()

    def _changes(self, base: RockingProperties) -> dict[str, Any]:
        heights, standing, moving = _masses_of(self.structure)
        floors = base.floors
        shapes = np.zeros((heights.size, 0)) if floors is None else floors.displacement
        found, levers, below, what = list[JointAbove](), [heights], base.m_tot, "the base"
        for place, each in enumerate(self.joints):
            lever, above = np.maximum(heights - each.height, 0.0), heights >= each.height
            levers.append(lever)
            mass = float(standing[np.ix_(above, above)].sum())
            if not below - mass > MASSLESS * base.m_tot:
                raise InputError(
                    f"joints must have mass between them, but there is none between {what} and no. {place + 1} at "
                    f"{each.height:g} m: with both open, that part would move without inertia. Leave one out, or put a "
                    "floor between them.",
                    field=f"joints.{place}.height",
                )
            below, what = mass, f"no. {place + 1} at {each.height:g} m"
            found.append(
                JointAbove(
                    each.height,
                    each.half_width,
                    mass,
                    float((moving @ lever).sum()),
                    [float(other @ moving @ lever) for other in levers],
                    (shapes.T @ moving @ lever) / base.effective_mass,
                )
            )
        return {"joints": tuple(found)}


def _masses_of(structure: object) -> tuple[Array, Array, Array]:
    """Return the heights of the floors, the mass matrix of what stands on the base, and that of all that moves."""
    inner = structure.structure if isinstance(structure, YieldingStories) else structure
    lumped = lumped_structure_of(inner.structure if isinstance(inner, Leaning) else inner)
    standing = np.diag(lumped.masses) if lumped.masses.ndim == 1 else lumped.masses
    return lumped.heights, standing, standing + np.diag(inner.masses) if isinstance(inner, Leaning) else standing
