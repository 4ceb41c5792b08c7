"""Where everything stands in the state vector, in the rows over it, and in the states that a history keeps."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

TIME, SIDE, GROUND, HEADER = 0, 1, 2, 3  # columns of a kept state before the state vector, and how many


class StateLayout(NamedTuple):
    """Places in the state vector [D_1..D_N, D'_1..D'_N, θ, θ'], and of integrated models [.., z, E_d, E_i, E_h].

    A *row* is a linear functional of the first `moving` entries, the ground acceleration and the constant 1.
    A place that the model does not have is -1.

    Attributes
    ----------
    modes
        Number N of modes; D_n stands at n, and D'_n at N + n.
    rotation, spin
        θ and θ'.
    hysteresis
        z of Eq. 38.
    damped, put_in, yielded
        Energies damped, put in by the ground and taken up by the hysteretic spring since the run began.
    moving
        Number of entries that rows run over.
    size
        Number of entries.
    """

    modes: int
    rotation: int
    spin: int
    hysteresis: int
    damped: int
    put_in: int
    yielded: int
    moving: int
    size: int

    @property
    def columns(self) -> int:
        """Columns of a row: the moving entries, the ground acceleration and 1."""
        return self.moving + 2

    @property
    def core(self) -> int:
        """Entries of [D.., D'.., θ, θ'], which all models have."""
        return 2 * self.modes + 2

    def displacements(self, states: Array) -> Array:
        """D at kept states, shape (n, N)."""
        return states[:, HEADER : HEADER + self.modes]

    def velocities(self, states: Array) -> Array:
        """D' at kept states, shape (n, N)."""
        return states[:, HEADER + self.modes : HEADER + 2 * self.modes]

    def of(self, states: Array, place: int) -> Array:
        """One entry at kept states, shape (n,)."""
        return states[:, HEADER + place]


def layout_of(modes: int, *, integrated: bool) -> StateLayout:
    """Return the layout of a model with so many modes; an integrated one counts its energies as it goes."""
    core = 2 * modes + 2
    if not integrated:
        return StateLayout(modes, core - 2, core - 1, -1, -1, -1, -1, core, core)
    return StateLayout(modes, core - 2, core - 1, core, core + 1, core + 2, core + 3, core + 1, core + 4)
