"""The equations of motion of a phase: modes, and the degrees of freedom of the base that equations them."""

from dataclasses import dataclass

import numpy as np

from rockflex.foundation.arrays import Array, Bools

Key = tuple[int, ...]  # the branch of every element, the base first


@dataclass(frozen=True, eq=False)
class BaseEquations:
    """Contribution to the equations of the base, M q'' + .. + C q' + K q = f + a g + H m, with b unknowns q.

    Attributes
    ----------
    inertia, damping, stiffness : ndarray, shape (b, b)
        M, C and K.
    constant, ground : ndarray, shape (b,)
        f, and the factor g of the ground acceleration.
    internal_factor : ndarray, shape (b, M)
        H, the factor of the internal variables m of the elements.
    """

    inertia: Array
    damping: Array
    stiffness: Array
    constant: Array
    ground: Array
    internal_factor: Array

    @classmethod
    def on_rotation(
        cls,
        *,
        inertia: float = 0.0,
        damping: float = 0.0,
        stiffness: float = 0.0,
        constant: float = 0.0,
        ground: float = 0.0,
        internal_factor: Array | None = None,
    ) -> "BaseEquations":
        """Return the equations of an element that acts only on the rotation."""
        squares, columns = np.zeros((3, 1, 1)), np.zeros((2, 1))
        squares[:, 0, 0] = inertia, damping, stiffness
        columns[:, 0] = constant, ground
        factors = np.zeros((1, 0 if internal_factor is None else internal_factor.size))
        if internal_factor is not None:
            factors[0] = internal_factor
        return cls(squares[0], squares[1], squares[2], columns[0], columns[1], factors)

    @classmethod
    def blank(cls, freedoms: int, n_internal: int) -> "BaseEquations":
        """Return a equations without any entry."""
        b = freedoms
        return cls(
            np.zeros((b, b)),
            np.zeros((b, b)),
            np.zeros((b, b)),
            np.zeros(b),
            np.zeros(b),
            np.zeros((b, n_internal)),
        )

    def __add__(self, other: "BaseEquations") -> "BaseEquations":
        return BaseEquations(
            self.inertia + other.inertia,
            self.damping + other.damping,
            self.stiffness + other.stiffness,
            self.constant + other.constant,
            self.ground + other.ground,
            self.internal_factor + other.internal_factor,
        )


@dataclass(frozen=True, eq=False)
class BorderedSystem:
    """The equations of motion of one phase: N oscillators bordered by the b degrees of freedom q of the base.

        D''_n + 2 ζ_n ω_n D'_n + ω_n² D_n + c_n · q'' = -a
        M q'' + Σ_n m*_n c_n D''_n + C q' + K q = f + a g + H m

    With D'' eliminated, (M - Σ m* c cᵀ) q'' = f + H m + a (g + Σ m* c) + Σ m* c (2ζω D' + ω² D) - C q' - K q.

    Attributes
    ----------
    coupling : ndarray, shape (b, N)
        c: h* for the rotation.
    leverage : ndarray, shape (b, N)
        m* c.
    flexibility : ndarray, shape (b, b)
        (M - Σ m* c cᵀ)⁻¹ of the free degrees of freedom; zero in the rows and columns of fixed ones.
    damping, stiffness : ndarray, shape (b, b)
        C and K.
    constant, drive : ndarray, shape (b,)
        f, and g + Σ m* c.
    internal_factor : ndarray, shape (b, M)
        H, the factor of the internal variables m of the elements, which are constant during a phase.
    freed : ndarray of bool, shape (b,)
        Which are free.
    """

    coupling: Array
    leverage: Array
    flexibility: Array
    damping: Array
    stiffness: Array
    constant: Array
    drive: Array
    internal_factor: Array
    freed: Bools


@dataclass(frozen=True, eq=False)
class GroundPhase:
    """The motions and forces of a phase of a base that slides or stands on springs.

    Attributes
    ----------
    side
        The pivot, 1 right, -1 left; 0 in contact and on springs.
    branch
        Sign of the velocity of a hysteretic spring.
    turns
        Whether the base rotates.
    way
        Sign of the velocity of the slip; 0 if it sticks.
    pressed
        Whether the ground has a pressure to rub against; on rigid ground.
    offset, inertia
        Position of the pivot to the right of the axis of the masses in m, and rotary inertia about it in kg m²; on
        springs about the axis itself.
    friction
        Coulomb's coefficient on rigid ground.
    pulls : ndarray, shape (7, 1 + M)
        Sums over the elements of a base on rigid ground, see `element_force_sums`.
    springs : ndarray, shape (n_springs, 5)
        Position in m, stiffness, coefficient of the dashpot, friction, and 1 if it is loaded, -1 if it recedes.
    elements : ndarray, shape (E, 6)
        On springs: position, k, c, f and g of the tension k δ + c δ' + f + g m, and δ at z = θ = 0 in m.
    recalled
        On springs: places of the internal variables m in the state, -1 where there are none.
    """

    side: int
    branch: int
    turns: bool
    way: int
    pressed: bool
    offset: float
    inertia: float
    friction: float
    pulls: Array
    springs: Array
    elements: Array
    recalled: tuple[int, ...] = ()
