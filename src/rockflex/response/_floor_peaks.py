"""The floor peaks of one run."""

from dataclasses import dataclass

from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._checks import finite_vector
from rockflex._errors import InputError
from rockflex._values import Value


@dataclass(frozen=True, eq=False, init=False)
class FloorPeaks(Value):
    """Largest magnitudes at the floors during a run, including peaks between samples; read-only arrays.

    Attributes
    ----------
    story_drift : ndarray, shape (N_floors,)
        Displacement of each floor minus that of the floor below, relative to the rotated base, in m.
    story_shear : ndarray, shape (N_floors,)
        Sum of the elastic forces at and above each floor, in N.
    floor_acceleration : ndarray, shape (N_floors,)
        Total horizontal acceleration of each floor, in m/s²; for nonlinear models only at samples and events.
    total_floor_displacement : ndarray, shape (N_floors,)
        Horizontal displacement of each floor relative to the ground in m, including the rotation of the base (Eq. 3).

    Raises
    ------
    InputError
        If the lengths differ, or a value is not finite.
    """

    story_drift: Array
    story_shear: Array
    floor_acceleration: Array
    total_floor_displacement: Array

    def __init__(
        self,
        story_drift: ArrayLike,
        story_shear: ArrayLike,
        floor_acceleration: ArrayLike,
        total_floor_displacement: ArrayLike,
    ) -> None:
        peaks = {
            "story_drift": finite_vector("story_drift", story_drift, "m"),
            "story_shear": finite_vector("story_shear", story_shear, "N"),
            "floor_acceleration": finite_vector("floor_acceleration", floor_acceleration, "m/s²"),
            "total_floor_displacement": finite_vector("total_floor_displacement", total_floor_displacement, "m"),
        }
        sizes = [values.size for values in peaks.values()]
        if len(set(sizes)) > 1:
            raise InputError(
                f"There must be one peak of each kind per floor, but {', '.join(peaks)} have the sizes {sizes}."
            )
        vars(self).update(peaks)
