"""A frame with different stories."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._checks import all_positive, dimensions, finite_vector, float_array, positive
from rockflex._computable import computable
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex._values import Value
from rockflex.structure._based import Assembled
from rockflex.structure._lumped import LumpedStructure


@dataclass(frozen=True, eq=False, init=False)
class FishBone(Assembled, Value):
    """A fish-bone frame: one column with half beams at each floor, clamped to a base that can rock.

    The column represents all columns of a story and the half beams all beams of a floor. Members are
    inextensible, masses are lumped at the floors, and the rotations of the floors are condensed out.

    Attributes
    ----------
    story_heights : ndarray, shape (N,)
        Height L_i of each story in m, from the base up.
    masses : ndarray, shape (N,)
        Mass of each floor in kg.
    column_stiffness : ndarray, shape (N,)
        EI_i of each story in N m²: the sum over its columns.
    beam_stiffness : ndarray, shape (N,)
        Rotational stiffness of the beams of each floor in N m/rad, from zero to infinity, both included. It is
        12 EI_b/L_b for a bay in antisymmetric bending; half beams on rollers give the same.
    base_mass : float
        Mass m_0 of the base in kg, zero or positive.
    half_width : float
        Half-width B of the base in m.
    damping_ratio : float or ndarray, shape (N,)
        Damping ratio in [0, 1): one number for all modes, or one per mode.

    Raises
    ------
    InputError
        If the lengths differ, or a value is outside its range.

    Notes
    -----
    A number in place of an array applies to all stories. With equal stories, EI_i = 2 EI_c and
    beam_stiffness = 12 ρ EI_i/L_i it is the same as `Frame`.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.FishBone(
    ...     story_heights=[4.0, 3.0], masses=[50e3, 40e3], column_stiffness=[2e8, 1.5e8], beam_stiffness=5e8,
    ...     base_mass=50e3, half_width=1.5, damping_ratio=0.02,
    ... )
    >>> frame.height
    7.0
    >>> frame.modal().period.round(3)
    array([0.398, 0.122])
    """

    story_heights: Array
    masses: Array
    column_stiffness: Array
    beam_stiffness: Array
    base_mass: float
    half_width: float
    damping_ratio: ArrayLike

    def __init__(
        self,
        story_heights: ArrayLike,
        masses: ArrayLike,
        column_stiffness: ArrayLike,
        beam_stiffness: ArrayLike,
        *,
        base_mass: float,
        half_width: float,
        damping_ratio: ArrayLike,
    ) -> None:
        lengths = finite_vector("story_heights", story_heights, "m")
        n = lengths.size
        all_positive("story_heights", lengths, "m")
        if n == 0:
            raise InputError(
                "story_heights must contain at least one height in m, but none was given.", field="story_heights"
            )
        vars(self).update(
            story_heights=lengths,
            masses=_one_a_story("masses", masses, n, "kg"),
            column_stiffness=_one_a_story("column_stiffness", column_stiffness, n, "N m²"),
            beam_stiffness=_beams(beam_stiffness, n),
            base_mass=positive("base_mass", base_mass, "kg", zero=True),
            half_width=positive("half_width", half_width, "m"),
            damping_ratio=damping_ratio,
        )
        vars(self).update(damping_ratio=self.lumped.damping_ratio)

    @property
    def height(self) -> float:
        """Height of the top floor above the base in m."""
        return float(self.story_heights.sum())

    @cached_property
    def lumped(self) -> LumpedStructure:
        """The assembled structure: floor masses, condensed stiffness, floor heights."""
        return LumpedStructure(
            self.masses,
            condensed_stiffness(self.story_heights, self.column_stiffness, self.beam_stiffness),
            np.cumsum(self.story_heights),
            base_mass=self.base_mass,
            half_width=self.half_width,
            damping_ratio=self.damping_ratio,
        )

    @property
    def assembled(self) -> LumpedStructure:
        """Lumped masses: those of `lumped`."""
        return self.lumped


@computable("The stiffness of a frame with these story heights, column and beam stiffnesses")
def condensed_stiffness(story_heights: Array, column_stiffness: Array, beam_stiffness: Array) -> Array:
    """Return the condensed lateral stiffness of the floors in N/m, shape (N, N); arguments as in `FishBone`."""
    n = story_heights.size
    sway, coupling, bending = (np.zeros((n + 1, n + 1)) for _ in range(3))
    for i, (length, stiffness) in enumerate(zip(story_heights, column_stiffness, strict=True)):
        ends = np.ix_([i, i + 1], [i, i + 1])
        sway[ends] += 12.0 * stiffness / length**3 * np.array([[1.0, -1.0], [-1.0, 1.0]])
        coupling[ends] += 6.0 * stiffness / length**2 * np.array([[1.0, 1.0], [-1.0, -1.0]])
        bending[ends] += 2.0 * stiffness / length * np.array([[2.0, 1.0], [1.0, 2.0]])
    turning = np.flatnonzero(np.isfinite(beam_stiffness)) + 1  # rigid beams prevent the floor from rotating
    rotational = bending[np.ix_(turning, turning)] + np.diag(beam_stiffness[turning - 1])
    tied = coupling[1:, turning]
    stiffness = sway[1:, 1:] - tied @ np.linalg.solve(rotational, tied.T)
    return 0.5 * (stiffness + stiffness.T)


def _one_a_story(name: str, values: ArrayLike, n: int, unit: str) -> Array:
    if dimensions(values) == 0:
        filled = np.full(n, positive(name, values, unit))  # pyright: ignore[reportArgumentType]
        filled.setflags(write=False)
        return filled
    array = finite_vector(name, values, unit)
    if array.size != n:
        raise InputError(
            f"{name} must be one number, or one for each of the {n} stories, but {array.size} were given.", field=name
        )
    all_positive(name, array, unit)
    return array


def _beams(values: ArrayLike, n: int) -> Array:
    given = float_array(values)
    array = np.full(n, np.nan) if given is None else given
    if array.ndim == 0:
        array = np.full(n, float(array))
    if array.shape != (n,) or not (array >= 0.0).all():
        raise InputError(
            f"beam_stiffness must be one number, or one for each of the {n} stories, from 0 (no beams) to float('inf') "
            f"(rigid beams) in N m/rad, but {shown(values)} was given.",
            field="beam_stiffness",
        )
    array.setflags(write=False)
    return array
