"""Where a free motion starts from."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockflex._checks import finite_vector
from rockflex._errors import InputError
from rockflex.models import LinearModel

__all__ = ["InitialState"]


@dataclass(frozen=True, eq=False)
class InitialState:
    """The state at t = 0, in place of rest.

    Parameters
    ----------
    rotation
        θ in rad; the base starts uplifted where it is not zero.
    modal_displacement, modal_velocity
        D_n in m and D'_n in m/s of the model's modes, shape (N,) or fewer (the rest is zero); None for zero.
    rotation_velocity
        θ' in rad/s; outward (the sign of θ) or, with θ ≠ 0, inward.
    """

    rotation: float = 0.0
    modal_displacement: ArrayLike | None = None
    modal_velocity: ArrayLike | None = None
    rotation_velocity: float = 0.0

    def state(self, model: LinearModel) -> NDArray[np.float64]:
        """State [D.., D'.., θ, θ'] for a model.

        Raises
        ------
        InputError
            If there are more values than modes, |θ| is not below π/2, or a fixed base would rotate.
        """
        n = model.properties.n_modes
        state = np.zeros(2 * n + 2)
        for name, values, start in (
            ("modal_displacement", self.modal_displacement, 0),
            ("modal_velocity", self.modal_velocity, n),
        ):
            if values is None:
                continue
            vector = finite_vector(name, values, "m" if start == 0 else "m/s")
            if vector.size > n:
                message = f"{name} has {vector.size} values, but {model.label} has {n} modes. Give at most {n}."
                raise InputError(message)
            state[start : start + vector.size] = vector
        state[-2:] = self.rotation, self.rotation_velocity
        if not (abs(self.rotation) < 0.5 * math.pi and math.isfinite(self.rotation_velocity)):
            message = (
                f"The initial rotation must lie below π/2 = 1.5708 rad in magnitude and its velocity be finite, but "
                f"rotation={self.rotation!r} and rotation_velocity={self.rotation_velocity!r} were given."
            )
            raise InputError(message)
        if not model.lifts and np.any(state[-2:] != 0.0):
            message = (
                f"{model.label} has a base that cannot lift, but rotation={self.rotation!r} and "
                f"rotation_velocity={self.rotation_velocity!r} were given. Give zero, or a model that rocks."
            )
            raise InputError(message)
        return state
