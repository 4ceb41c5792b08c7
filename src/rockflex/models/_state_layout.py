"""The layout of the state vector, of rows, and of the states in a history."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockflex.foundation.arrays import Array

# Columns that precede the state vector in a history, and their number; GROUND and RISE are the horizontal and the
# vertical acceleration of the ground.
TIME, SIDE, GROUND, RISE, HEADER = 0, 1, 2, 3, 4

# Branches of many springs and elements are kept in the state as digits of a few numbers.
BASES = 8, 64  # the least in which all branches are digits; an element has at most 32
BITS = 51  # of a number, that a double holds exactly
SHIFT = 1  # the lowest branch is -1


class StateLayout(NamedTuple):
    """Indices in the state vector [D_1..D_N, D'_1..D'_N, θ, θ'], for integrated models [.., z, E_d, E_i, E_h].

    A base that may slide adds its slip and the rate of it after θ', one on springs its heave and the rate of that, and
    a structure with joints above the base the rotation of each and its rate.
    ∫ (δ'/r)² dt follows if an integrated model has viscous dampers, and then the internal variables of all elements.

    A *row* is a linear functional of the first `moving` entries, the ground acceleration and the constant 1.
    An index that the model does not have is -1.

    Attributes
    ----------
    modes
        Number N of modes; D_n has the index n, and D'_n the index N + n.
    rotation, spin
        θ and θ'.
    slip, heave
        Displacement of the base to the right and upwards, each followed by its velocity.
    joints, n_joints
        Rotation of the first joint above the base, followed by its rate and by those of the other joints, and how many
        there are.
    hysteresis
        z of Eq. 38.
    damped, put_in, yielded
        Damped energy, work of the ground and energy absorbed by the hysteretic spring since the start of the run.
    swept
        ∫ (δ'/r)² dt over the rocking since the start of the run, in rad²/s: that of cos² (θ/2) θ'² or, for small
        rotations, of θ'². Times c r² it is the energy that a viscous damper dissipates.
    rubbed, soil, sweeps
        Of integrated models, since the start of the run: energy lost by sliding, that lost by each spring under the
        base, and ∫ δ'² dt of each element on springs in m²/s.
    memory, n_internal
        Index of the first internal variable of an element, and the number of all; constant during a phase.
    moving
        Number of entries that rows multiply.
    size
        Number of entries.
    """

    modes: int
    rotation: int
    spin: int
    slip: int
    heave: int
    joints: int
    n_joints: int
    hysteresis: int
    damped: int
    put_in: int
    yielded: int
    swept: int
    rubbed: int
    soil: int
    sweeps: int
    memory: int
    n_internal: int
    moving: int
    size: int

    @property
    def columns(self) -> int:
        """Number of columns of a row: the moving entries, the ground acceleration and 1."""
        return self.moving + 2

    @property
    def core(self) -> int:
        """Number of entries [D.., D'.., θ, θ'] with the slip and the heave, which follow from equations of motion."""
        return 2 * (self.modes + self.freedoms)

    @property
    def freedoms(self) -> int:
        """Number b of the degrees of freedom of the base."""
        return 1 + (self.slip >= 0) + (self.heave >= 0) + self.n_joints

    @property
    def rotations(self) -> list[int]:
        """The places of all rotations: that of the base, and of the joints above it."""
        return [self.rotation, *(self.joints + 2 * k for k in range(self.n_joints))]

    @property
    def turns(self) -> list[int]:
        """The places of θ'' of all rotations among the accelerations of modes and base."""
        return [self.modes + (place - self.rotation) // 2 for place in self.rotations]

    def displacements(self, states: Array) -> Array:
        """Return D at the states of a history, shape (n, N)."""
        return states[:, HEADER : HEADER + self.modes]

    def velocities(self, states: Array) -> Array:
        """Return D' at the states of a history, shape (n, N)."""
        return states[:, HEADER + self.modes : HEADER + 2 * self.modes]

    def of(self, states: Array, place: int) -> Array:
        """Return one entry at the states of a history, shape (n,)."""
        return states[:, HEADER + place]


@lru_cache(maxsize=256)
def state_layout_of(
    modes: int,
    *,
    integrated: bool = False,
    viscous: bool = False,
    n_internal: int = 0,
    slides: bool = False,
    heaves: bool = False,
    n_joints: int = 0,
    springs: int = 0,
    elements: int = 0,
) -> StateLayout:
    """Return the layout of a model, internal variables last; integrated models also integrate their energies.

    `springs` and `elements` are the numbers of those of an integrated model on springs.
    """
    rotation = 2 * modes
    slip = rotation + 2 if slides else -1
    heave = rotation + 2 * (1 + slides) if heaves else -1
    joints = rotation + 2 * (1 + slides + heaves) if n_joints else -1
    core = rotation + 2 * (1 + slides + heaves + n_joints)
    base = rotation, rotation + 1, slip, heave, joints, n_joints
    if not integrated:
        size = core + n_internal
        absent = -1, -1, -1, -1, -1, -1, -1, -1
        return StateLayout(modes, *base, *absent, core, n_internal, size, size)
    swept = core + 4
    rubbed = swept + viscous
    soil = rubbed + slides
    sweeps = soil + springs
    memory = sweeps + elements
    size = memory + n_internal
    moving = size if n_internal else core + 1
    counters = swept if viscous else -1, rubbed if slides else -1, soil if heaves else -1, sweeps if heaves else -1
    return StateLayout(modes, *base, core, core + 1, core + 2, core + 3, *counters, memory, n_internal, moving, size)


def branches_per_code(base: int) -> int:
    """Return how many digits a number has."""
    return BITS // (base.bit_length() - 1)


def n_branch_codes(size: int, base: int) -> int:
    """Return how many numbers hold the branches of `size` elements."""
    return -(-size // branches_per_code(base))


def codes_of_branches(branches: tuple[int, ...], base: int) -> tuple[float, ...]:
    """Return the numbers that stand for branches from -1 to base - 2."""
    digits = branches_per_code(base)
    parts = (branches[first : first + digits] for first in range(0, len(branches), digits))
    return tuple(float(sum((branch + SHIFT) * base**k for k, branch in enumerate(part))) for part in parts)


def branches_of_codes(codes: Array, size: int, base: int) -> NDArray[np.int64]:
    """Return the branches of `size` elements from their numbers, (n, codes_for(size, base)), as (n, size)."""
    whole, digits = codes.astype(np.int64), branches_per_code(base)
    columns = [whole[:, k // digits] // base ** (k % digits) % base - SHIFT for k in range(size)]
    return np.array(columns, dtype=np.int64).reshape(size, len(codes)).T
