"""The initial state of a run."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._checks import finite_vector, within
from rockflex._errors import InputError
from rockflex._shown import counted, shown
from rockflex._values import Value
from rockflex.models import RockingModel

LARGEST = 1e9  # m, m/s or rad/s: beyond any structure, and far from where numbers overflow


@dataclass(frozen=True, eq=False, init=False)
class InitialState(Value):
    """The state at t = 0, if the structure does not start at rest.

    The base starts uplifted if `rotation` is not zero; its sign gives the side. If only `rotation_velocity` is not
    zero, the base also starts uplifted, and the sign of the velocity gives the side.

    Parameters
    ----------
    rotation
        θ in rad, below π/2 in magnitude.
    modal_displacement, modal_velocity
        D_n in m and D'_n in m/s of the modes of the model, shape (N,) or fewer (the others are zero); None for zero.
        Stored as read-only copies.
    rotation_velocity
        θ' in rad/s; outward (the sign of θ) or, with θ ≠ 0, inward.

    Raises
    ------
    InputError
        If a value is not a finite number, |θ| is not below π/2, or another value is not below 1e9 in magnitude.

    Examples
    --------
    >>> import rockflex as rf
    >>> block = rf.rigid_block(slenderness=0.2, half_diagonal=2.0)
    >>> start = rf.InitialState(rotation=0.1)
    >>> response = rf.simulate(block, rf.quiet_motion(5.0), "rigid", initial=start)
    >>> round(response.max_rotation, 3)
    0.1
    """

    rotation: float
    modal_displacement: Array | None
    modal_velocity: Array | None
    rotation_velocity: float

    def __init__(
        self,
        rotation: float = 0.0,
        modal_displacement: ArrayLike | None = None,
        modal_velocity: ArrayLike | None = None,
        rotation_velocity: float = 0.0,
    ) -> None:
        vars(self).update(
            rotation=within("rotation", rotation, 0.5 * math.pi, "rad"),
            modal_displacement=_modal("modal_displacement", modal_displacement, "m"),
            modal_velocity=_modal("modal_velocity", modal_velocity, "m/s"),
            rotation_velocity=within("rotation_velocity", rotation_velocity, LARGEST, "rad/s"),
        )

    def state(self, model: RockingModel) -> Array:
        """Return the state [D.., D'.., θ, θ'] for a model.

        Raises
        ------
        InputError
            If there are more values than modes, or a fixed base would rotate.
        """
        n = model.properties.n_modes
        state = np.zeros(2 * n + 2)
        for name, values, first in (
            ("modal_displacement", self.modal_displacement, 0),
            ("modal_velocity", self.modal_velocity, n),
        ):
            if values is None:
                continue
            if values.size > n:
                raise InputError(
                    f"{name} has {counted(values.size, 'value')}, but {model.label} has {counted(n, 'mode')}. Give at "
                    f"most {n}."
                )
            state[first : first + values.size] = values
        state[-2:] = self.rotation, self.rotation_velocity
        if not model.lifts and np.any(state[-2:] != 0.0):
            raise InputError(
                f"{model.label} has a base that cannot lift, but rotation={shown(self.rotation)} and "
                f"rotation_velocity={shown(self.rotation_velocity)} were given. Give zero, or a model that rocks."
            )
        return state


def _modal(name: str, values: ArrayLike | None, unit: str) -> Array | None:
    if values is None:
        return None
    vector = finite_vector(name, values, unit)
    for place, value in enumerate(vector.tolist()):
        within(f"{name}[{place}]", value, LARGEST, unit)
    return vector
