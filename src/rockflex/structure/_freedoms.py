"""How each degree of freedom of a structure moves with the base."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import SupportsIndex

import numpy as np
from numpy.typing import NDArray

from rockflex._arrays import Array, Bools
from rockflex._checks import finite_vector, float_array, whole_number
from rockflex._errors import InputError
from rockflex.modal import MassNormalisedModes
from rockflex.structure._matrix_files import Given, numbers

Heights = Given | Mapping[int, float]
"""Height of every degree of freedom in m, NaN for none, or a map {index: height} of those that translate."""


@dataclass(frozen=True, eq=False)
class Freedoms:
    """The degrees of freedom that translate horizontally or rotate in the plane; the base does not move the others.

    Attributes
    ----------
    translates : ndarray of int, shape (T,)
        Indices of the horizontal translations, in order of height.
    heights : ndarray, shape (T,)
        Their heights above the base in m.
    rotates : ndarray of int, shape (R,)
        Indices of the rotations in the plane.
    size : int
        Number N of degrees of freedom.
    """

    translates: NDArray[np.intp]
    heights: Array
    rotates: NDArray[np.intp]
    size: int

    @classmethod
    def of(cls, heights: Heights, rotations: Sequence[SupportsIndex], size: int) -> "Freedoms":
        """Return the degrees of freedom of a structure that has `size` of them.

        Raises
        ------
        InputError
            If a height is missing or not positive, or an index is out of range or named twice.
        """
        if not isinstance(rotations, Iterable):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise InputError(
                f"rotations must be a sequence of indices of degrees of freedom, but {type(rotations).__name__} was "
                "given.",
                field="rotations",
            )
        turning = [whole_number("rotations, index", i, 0, size - 1, field="rotations") for i in rotations]
        where, values = _translating(heights, turning, size)
        twice = sorted({i for i in turning if turning.count(i) > 1 or i in where})
        if twice:
            raise InputError(
                f"rotations must list each degree of freedom once, and none that has a height, but {twice[0]} is "
                "listed twice.",
                field="rotations",
            )
        if values.min(initial=np.inf) <= 0.0 or values.size == 0:
            lowest = f"{values.min():g} m" if values.size else "none"
            raise InputError(
                f"heights must contain at least one height in m above the base, all positive, but {lowest} was given. "
                "A mass at the base belongs to base_mass; what does not translate horizontally has none.",
                field="heights",
            )
        order = np.argsort(values, kind="stable")
        return cls(np.array(where, dtype=np.intp)[order], values[order], np.array(turning, dtype=np.intp), size)

    def kept(self, keep: Bools) -> "Freedoms":
        """Return the degrees of freedom of the structure reduced to some of them.

        Raises
        ------
        InputError
            If none of the remaining ones translates.
        """
        number = np.cumsum(keep) - 1
        moves, turns = keep[self.translates], keep[self.rotates]
        if not moves.any():
            raise InputError(
                "mass must be assigned to at least one degree of freedom that translates horizontally, but it is zero "
                "for all of them.",
                field="mass",
            )
        return Freedoms(
            number[self.translates[moves]], self.heights[moves], number[self.rotates[turns]], int(keep.sum())
        )

    def modes(self, omega: Array, shapes: Array, mass: Array) -> MassNormalisedModes:
        """Return the modes, with φ^T M φ = 1, and their participation; `mass` is (N, N).

        Degrees of freedom at the same height form one station, with their mean ordinate and the sum of their forces. If
        a rotation has mass, its moment acts at an unknown height, so there are no forces at stations.
        """
        translation, rotation = np.zeros(self.size), np.zeros(self.size)
        translation[self.translates] = 1.0
        rotation[self.translates] = self.heights
        rotation[self.rotates] = 1.0
        moved = mass @ shapes
        stations, at, count = np.unique(self.heights, return_inverse=True, return_counts=True)
        ordinates, forces = np.zeros((2, stations.size, omega.size))
        np.add.at(ordinates, at, shapes[self.translates])
        np.add.at(forces, at, moved[self.translates])
        carried = bool(np.any(mass[self.rotates]))
        return MassNormalisedModes(
            omega=omega,
            shear=translation @ moved,
            moment=rotation @ moved,
            heights=stations,
            ordinates=ordinates / count[:, None],
            forces=None if carried else forces,
            mass=float(translation @ mass @ translation),
            first_moment=float(translation @ mass @ rotation),
            inertia=float(rotation @ mass @ rotation),
        )


def _translating(heights: Heights, turning: Sequence[int], size: int) -> tuple[list[int], Array]:
    """Return the degrees of freedom that translate horizontally, and their heights."""
    if isinstance(heights, Mapping):
        where = [whole_number("heights, index", i, 0, size - 1, field="heights") for i in heights]
        return where, finite_vector("heights", list(heights.values()), "m")
    given = numbers("heights", heights)
    values = float_array(given)
    if values is None or values.ndim != 1:
        finite_vector("heights", given, "m")  # says what is wrong
        raise AssertionError
    others = [i for i in range(size) if i not in turning]
    if values.size == size:
        values = values[others]  # that of a rotation is the height of its node, which does not matter
    elif values.size != len(others):
        raise InputError(
            f"heights must contain one height for each of the {size} degrees of freedom, but {values.size} were given. "
            "List those that rotate in rotations; if others do not translate horizontally, give the heights of those "
            "that do with their indices, such as {0: 3.0, 2: 6.0}.",
            field="heights",
        )
    moves = ~np.isnan(values)
    return [i for i, each in zip(others, moves, strict=True) if each], finite_vector("heights", values[moves], "m")
