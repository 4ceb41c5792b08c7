"""The layout of the state vector, of rows, and of the states in a history."""

from typing import NamedTuple

from rockflex._arrays import Array

TIME, SIDE, GROUND, HEADER = 0, 1, 2, 3  # columns that precede the state vector in a history, and their number


class StateLayout(NamedTuple):
    """Indices in the state vector [D_1..D_N, D'_1..D'_N, θ, θ'], for integrated models [.., z, E_d, E_i, E_h].

    ∫ (δ'/r)² dt follows if an integrated model has viscous dampers, and then the memories of all elements.

    A *row* is a linear functional of the first `moving` entries, the ground acceleration and the constant 1.
    An index that the model does not have is -1.

    Attributes
    ----------
    modes
        Number N of modes; D_n has the index n, and D'_n the index N + n.
    rotation, spin
        θ and θ'.
    hysteresis
        z of Eq. 38.
    damped, put_in, yielded
        Damped energy, work of the ground and energy absorbed by the hysteretic spring since the start of the run.
    swept
        ∫ (δ'/r)² dt over the rocking since the start of the run, in rad²/s: with cos² (θ/2) θ'² or, for small
        rotations, θ'². Times c r² it is the energy that a viscous damper dissipates.
    memory, remembered
        Index of the first memory of an element, and the number of memories; constant during a phase.
    moving
        Number of entries that rows multiply.
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
    swept: int
    memory: int
    remembered: int
    moving: int
    size: int

    @property
    def columns(self) -> int:
        """Number of columns of a row: the moving entries, the ground acceleration and 1."""
        return self.moving + 2

    @property
    def core(self) -> int:
        """Number of entries [D.., D'.., θ, θ'], which all models have."""
        return 2 * self.modes + 2

    def displacements(self, states: Array) -> Array:
        """Return D at the states of a history, shape (n, N)."""
        return states[:, HEADER : HEADER + self.modes]

    def velocities(self, states: Array) -> Array:
        """Return D' at the states of a history, shape (n, N)."""
        return states[:, HEADER + self.modes : HEADER + 2 * self.modes]

    def of(self, states: Array, place: int) -> Array:
        """Return one entry at the states of a history, shape (n,)."""
        return states[:, HEADER + place]


def layout_of(modes: int, *, integrated: bool, viscous: bool = False, remembered: int = 0) -> StateLayout:
    """Return the layout of a model; integrated models also integrate their energies. The memories come last."""
    core = 2 * modes + 2
    if not integrated:
        size = core + remembered
        return StateLayout(modes, core - 2, core - 1, -1, -1, -1, -1, -1, core, remembered, size, size)
    memory = core + 4 + viscous
    size = memory + remembered
    moving = size if remembered else core + 1
    swept = core + 4 if viscous else -1
    return StateLayout(
        modes, core - 2, core - 1, core, core + 1, core + 2, core + 3, swept, memory, remembered, moving, size
    )
