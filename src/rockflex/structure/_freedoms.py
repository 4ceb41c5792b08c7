"""What a rigid motion of the base does to each freedom of a structure."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import SupportsIndex

import numpy as np
from numpy.typing import NDArray

from rockflex._checks import finite_vector, whole_number
from rockflex._errors import InputError
from rockflex.modal import MassNormalisedModes
from rockflex.structure._matrix_files import Given, numbers

Float = NDArray[np.float64]
Heights = Given | Mapping[int, float]
"""Height of every freedom in m, or a map from the index of each that translates horizontally to its height."""


@dataclass(frozen=True, eq=False)
class Freedoms:
    """Freedoms that translate horizontally, and those that rotate in the plane; others stay still.

    Attributes
    ----------
    translates : ndarray of int, shape (T,)
        Indices of the freedoms that translate, by rising height.
    heights : ndarray, shape (T,)
        Their heights above the base in m.
    rotates : ndarray of int, shape (R,)
        Indices of the rotations.
    size : int
        Number N of freedoms.
    """

    translates: NDArray[np.intp]
    heights: Float
    rotates: NDArray[np.intp]
    size: int

    @classmethod
    def of(cls, heights: Heights, rotations: Sequence[SupportsIndex], size: int) -> "Freedoms":
        """Return the freedoms of a structure with `size` of them.

        Raises
        ------
        InputError
            If a height is missing or not positive, or an index is out of range or named twice.
        """
        if isinstance(heights, Mapping):
            where = [whole_number("heights, index", i, 0, size - 1, field="heights") for i in heights]
            values = finite_vector("heights", list(heights.values()), "m")
        else:
            values = finite_vector("heights", numbers("heights", heights), "m")
            where = list(range(values.size))
            if values.size != size:
                raise InputError(
                    f"heights must hold one height for each of the {size} freedoms, but {values.size} were given. "
                    "Where some do not translate horizontally, give a map {index: height} of those that do.",
                    field="heights",
                )
        if not isinstance(rotations, Iterable):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise InputError(
                f"rotations must be a sequence of indices of freedoms, but {type(rotations).__name__} was given.",
                field="rotations",
            )
        turning = [whole_number("rotations, index", i, 0, size - 1, field="rotations") for i in rotations]
        twice = sorted({i for i in turning if turning.count(i) > 1 or i in where})
        if twice:
            raise InputError(
                f"rotations must name each freedom once, and none that has a height, but {twice[0]} is named twice. "
                "Give heights as a map {index: height} of the freedoms that translate horizontally.",
                field="rotations",
            )
        if values.min(initial=np.inf) <= 0.0 or values.size == 0:
            lowest = f"{values.min():g} m" if values.size else "none"
            raise InputError(
                f"heights must be positive, in m above the base, at least one of them, but {lowest} was given. "
                "A mass at the base belongs to base_mass.",
                field="heights",
            )
        order = np.argsort(values, kind="stable")
        return cls(np.array(where, dtype=np.intp)[order], values[order], np.array(turning, dtype=np.intp), size)

    def kept(self, keep: NDArray[np.bool_]) -> "Freedoms":
        """Return the freedoms of the structure that keeps only some of its own.

        Raises
        ------
        InputError
            If none of those that translate is kept.
        """
        number = np.cumsum(keep) - 1
        moves, turns = keep[self.translates], keep[self.rotates]
        if not moves.any():
            raise InputError(
                "mass must move with at least one freedom that translates horizontally, but all have none.",
                field="mass",
            )
        return Freedoms(
            number[self.translates[moves]], self.heights[moves], number[self.rotates[turns]], int(keep.sum())
        )

    def modes(self, omega: Float, shapes: Float, mass: Float) -> MassNormalisedModes:
        """Return the modes, with φ^T M φ = 1, and their participation; `mass` is (N, N).

        Freedoms at one height are one station, with their mean ordinate and the sum of their forces. Rotations
        with mass carry moments at heights that are not known: there are no forces at stations then.
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
