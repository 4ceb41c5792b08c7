"""What a phase of the motion is: which freedoms of the base are free, which forces act on them, and how it ends."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

FREEDOMS = ("rotation",)  # of the base, in the order in which the borders name them

Key = tuple[int, ...]  # the branch of every element, the base's own first

LIFTS, LANDS, OVERTURNS = 0, 1, 2  # what happens where a guard is passed


@dataclass(frozen=True, eq=False)
class Border:
    """What an element adds to the equations of the base: M q'' + .. + C q' + K q = f + a g, b freedoms q.

    Attributes
    ----------
    inertia, damping, stiffness : ndarray, shape (b, b)
        M, C and K.
    constant, ground : ndarray, shape (b,)
        f, and the factor g of the ground acceleration.
    """

    inertia: Array
    damping: Array
    stiffness: Array
    constant: Array
    ground: Array

    @classmethod
    def on_rotation(
        cls,
        *,
        inertia: float = 0.0,
        damping: float = 0.0,
        stiffness: float = 0.0,
        constant: float = 0.0,
        ground: float = 0.0,
    ) -> "Border":
        """Return the border of an element that acts on the rotation alone."""
        b = len(FREEDOMS)
        squares, columns = np.zeros((3, b, b)), np.zeros((2, b))
        squares[:, 0, 0] = inertia, damping, stiffness
        columns[:, 0] = constant, ground
        return cls(squares[0], squares[1], squares[2], columns[0], columns[1])

    def __add__(self, other: "Border") -> "Border":
        return Border(
            self.inertia + other.inertia,
            self.damping + other.damping,
            self.stiffness + other.stiffness,
            self.constant + other.constant,
            self.ground + other.ground,
        )


@dataclass(frozen=True, eq=False)
class Arrow:
    """The equations of motion of one phase: N oscillators bordered by the base's free freedoms q.

        D''_n + 2 ζ_n ω_n D'_n + ω_n² D_n + c_n · q'' = -a
        M q'' + Σ_n m*_n c_n D''_n + C q' + K q = f + a g

    With D'' eliminated, (M - Σ m* c cᵀ) q'' = f + a (g + Σ m* c) + Σ m* c (2ζω D' + ω² D) - C q' - K q.

    Attributes
    ----------
    coupling : ndarray, shape (b, N)
        c: h* for the rotation.
    leverage : ndarray, shape (b, N)
        m* c.
    flexibility : ndarray, shape (b, b)
        (M - Σ m* c cᵀ)⁻¹ of the free freedoms; zero in rows and columns of those that are held.
    damping, stiffness : ndarray, shape (b, b)
        C and K.
    constant, drive : ndarray, shape (b,)
        f, and g + Σ m* c.
    free
        Whether any freedom of the base is free.
    """

    coupling: Array
    leverage: Array
    flexibility: Array
    damping: Array
    stiffness: Array
    constant: Array
    drive: Array
    free: bool

    def alike(self, other: "Arrow") -> bool:
        """Whether both have the same eigenvectors: all but the constant forces agree."""
        return self.free == other.free and all(
            bool((getattr(self, name) == getattr(other, name)).all())
            for name in ("flexibility", "stiffness", "damping", "drive", "coupling")
        )


@dataclass(frozen=True)
class Exit:
    """What happens where a guard leaves its band, and the phase that follows."""

    event: int
    key: Key


@dataclass(frozen=True, eq=False)
class Guard:
    """A row that stays between two limits as long as the phase lasts.

    Attributes
    ----------
    row : ndarray, shape (C,)
        Over the moving entries of the state, the ground acceleration and 1.
    low, high
        Its limits.
    below, above
        What happens at each of them; None where there is no limit.
    """

    row: Array
    low: float
    high: float
    below: Exit | None
    above: Exit | None


@dataclass(frozen=True, eq=False)
class Phase:
    """One branch of every element of a model.

    Attributes
    ----------
    key
        The branches.
    side
        Pivot about which the base turns: 1 right, -1 left, 0 in contact.
    arrow
        The equations of motion; None where they are not linear, and a vector field takes their place.
    guards
        What ends the phase. While the base rocks the first is its rotation.
    """

    key: Key
    side: int
    arrow: Arrow | None
    guards: tuple[Guard, ...]
