"""Vibration of a structure whose base has lifted."""

import math
from dataclasses import dataclass
from typing import SupportsIndex

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._checks import float_array, instance
from rockflex._computable import computable
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex._values import Value
from rockflex.modal._pivot import Pivot
from rockflex.modal._rocking import RockingProperties
from rockflex.modal._uplifted_damping import uplifted_damping

HIGHEST = 1e60  # rad/s, whose fourth power still fits in double precision

_BESIDE = (1e-13, 1e-11, 1e-9)  # relative shifts from a root: the first that gives a regular matrix is used


@dataclass(frozen=True, eq=False)
class UpliftedModes(Value):
    """Vibration modes of the uplifted structure about one pivot. The arrays are read-only.

    Attributes
    ----------
    omega : ndarray, shape (n,)
        Circular frequencies ω*_n of vibration in rad/s, in ascending order.
    ratio : ndarray, shape (n,)
        ω*_n/ω_n, relative to the same mode on a fixed base.
    damping_ratio : ndarray, shape (n,)
        ζ*_n = -Re λ/|λ| of the complex eigenvalues λ of Eq. 23 with its damping, in the order of |λ|. A value of 1 or
        more is an overdamped motion with two real eigenvalues, ζ*_n = -(λ_a + λ_b)/(2 √(λ_a λ_b)). With one mode
        it is ζ ω*/ω if the weight is neglected.
    shapes : ndarray, shape (n + 1, n)
        (θ, D_1 .. D_n) as columns, with Σ_n |D_n| = 1 m and the largest D_n positive.
    growth_rate : float
        Growth rate in 1/s of the unstable rigid mode; √(L_0^r g/I_θ) for a rigid structure. Zero if tendons make it
        stable.
    sway_rate : float
        Circular frequency in rad/s of that mode if tendons make it stable, otherwise zero.
    growth_shape : ndarray, shape (n + 1,)
        (θ, D_1 .. D_n) of that mode, with θ = 1 rad.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(
    ...     n_stories=5, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=float("inf"),
    ...     period=1.0, aspect_ratio=8.0, damping_ratio=0.02,
    ... )
    >>> modes = rf.uplifted_modes(frame.rocking(2))
    >>> modes.omega.round(2), modes.damping_ratio.round(3)
    (array([17.45, 43.9 ]), array([0.024, 0.131]))
    """

    omega: Array
    ratio: Array
    damping_ratio: Array
    shapes: Array
    growth_rate: float
    sway_rate: float
    growth_shape: Array


@computable("The uplifted modes of the given properties")
def uplifted_modes(
    properties: RockingProperties, n_modes: SupportsIndex | None = None, *, side: int | None = None
) -> UpliftedModes:
    """Return the modes of Eq. 23 from the first `n_modes` modes of the structure (default: all).

    Frequencies and shapes are undamped; `damping_ratio` is the damping that results from that of the fixed base.

    With the rows of D_n multiplied by m*_n, the matrices are symmetric, and the mass matrix is positive definite
    because I_θ > Σ m*_n h*_n². The lowest root ω² belongs to the rotation; it is negative if gravity outweighs the
    tendons. The others are vibrations.

    Parameters
    ----------
    properties : RockingProperties
    n_modes : int, optional
        Number of modes to keep: 1 is 2DOF-S, 2 is 3DOF-S. Default: all.
    side : int, optional
        1 for motion about the right edge of the base, -1 about the left edge. Default: the `weaker_pivot`; both give
        the same if the structure is `symmetric`.

    Returns
    -------
    UpliftedModes

    Raises
    ------
    InputError
        If the structure has fewer modes than `n_modes`, or `side` is neither 1 nor -1.

    References
    ----------
    Silva & Stojadinović 2024, Eq. 23 and Section 3.4 (Fig. 10).

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(
    ...     n_stories=5, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=float("inf"),
    ...     period=1.0, aspect_ratio=8.0, damping_ratio=0.02,
    ... )
    >>> modes = rf.uplifted_modes(frame.rocking(2))
    >>> modes.ratio.round(2)
    array([2.78, 2.39])
    """
    p = instance("properties", properties, RockingProperties)
    p = p if n_modes is None else p.truncated(n_modes)
    n = p.n_modes
    pivot = _pivot(p, side)
    squares, motions = _lowest(p, pivot, n)
    omega = np.sqrt(squares[1:])
    modal = motions[1:, 1:]
    largest = modal[np.abs(modal).argmax(axis=0), np.arange(n)] if n else np.ones(0)
    return UpliftedModes(
        omega=omega,
        ratio=omega / p.omega,
        damping_ratio=uplifted_damping(squares, _modal_damping(p, pivot, motions)),
        shapes=motions[:, 1:] / (np.sign(largest) * np.abs(modal).sum(axis=0)),
        growth_rate=math.sqrt(max(-squares[0], 0.0)),
        sway_rate=math.sqrt(max(squares[0], 0.0)),
        growth_shape=motions[:, 0] / motions[0, 0],
    )


@computable("The uplifted frequencies of the given properties")
def lowest_uplifted(properties: RockingProperties, count: int, side: int | None = None) -> Array:
    """Return at most the first `count` of `UpliftedModes.omega`, which is faster than computing all."""
    return np.sqrt(_lowest(properties, _pivot(properties, side), min(count, properties.n_modes))[0][1:])


def _pivot(p: RockingProperties, side: int | None) -> Pivot:
    return p.weaker_pivot if side is None else p.pivot(side)


def _lowest(p: RockingProperties, pivot: Pivot, vibrations: int) -> tuple[Array, Array]:
    """Return ω² (v + 1,) and (θ, D) (n + 1, v + 1) of the rotation and the lowest v vibrations."""
    # With D_n √m*_n as coordinates the lower block of the mass matrix is the identity.
    root = np.sqrt(p.effective_mass)
    arm = root * p.effective_height
    # M = L L^T, from the rest of the inertia and the directions of the modes.
    rest = float(np.sqrt(pivot.i_theta - arm @ arm))
    # With y = (rest θ, √m*_n D_n + arm θ), M is the identity and K' = S^T K S, where (θ, √m* D) = S y.
    n = p.n_modes
    back = np.eye(n + 1)
    back[0, 0] = 1.0 / rest
    back[1:, 0] = -arm / rest
    stiffness = np.concatenate([[pivot.rocking_stiffness], p.omega**2])
    squares, vectors = np.linalg.eigh(back.T @ (stiffness[:, None] * back))
    mass = np.eye(n + 1)
    mass[0, 0], mass[0, 1:], mass[1:, 0] = pivot.i_theta, arm, arm
    kept = slice(vibrations + 1)
    squares, motions = _polished(stiffness, mass, squares[kept], back @ vectors[:, kept])
    motions[1:] /= root[:, None]
    return squares, motions


def _modal_damping(p: RockingProperties, pivot: Pivot, motions: Array) -> Array:
    """Return the modal damping matrix of Eq. 23 for motions (θ, D) as columns, each scaled to unit modal mass."""
    root = np.sqrt(p.effective_mass)
    arm = root * p.effective_height
    turn, modal = motions[0], root[:, None] * motions[1:]
    mass = (pivot.i_theta - arm @ arm) * turn**2 + ((modal + arm[:, None] * turn) ** 2).sum(axis=0)
    share = modal / np.sqrt(mass)
    return share.T @ ((2.0 * p.zeta * p.omega)[:, None] * share)


def _polished(stiffness: Array, mass: Array, squares: Array, motions: Array) -> tuple[Array, Array]:
    """Restore the digits that small roots lost to rounding of the largest, by one step of inverse iteration each."""
    moved = motions
    for shift in _BESIDE:
        near = np.diag(stiffness) - (squares * (1.0 + shift))[:, None, None] * mass
        try:
            moved = np.linalg.solve(near, (mass @ motions).T[:, :, None])[:, :, 0].T
        except np.linalg.LinAlgError:
            continue
        break
    moved = moved / np.abs(moved).max(axis=0)
    work = np.einsum("in,in->n", moved, stiffness[:, None] * moved)
    return work / np.einsum("in,in->n", moved, mass @ moved), moved


def frequency_equation(properties: RockingProperties, omega: ArrayLike, *, side: int | None = None) -> Array:
    """Return k_r - ω² I_θ - Σ_n ω⁴ m*_n h*_n²/(ω_n² - ω²), whose zeros are the uplifted frequencies.

    k_r is the `rocking_stiffness` of the pivot, which is -L_0^r g without tendons, and I_θ the inertia about it.

    Parameters
    ----------
    properties : RockingProperties
        Use `truncated` for fewer modes.
    omega : array_like
        Circular frequencies in rad/s, any shape.
    side : int, optional
        1 for motion about the right edge of the base, -1 about the left edge. Default: the `weaker_pivot`.

    Returns
    -------
    ndarray
        Values in N m/rad, with the shape of `omega`; NaN at a fixed-base frequency ω_n, where the sum has a pole.

    Raises
    ------
    InputError
        If a frequency is not a number below 1e60 rad/s, or `side` is neither 1 nor -1.

    References
    ----------
    Silva & Stojadinović 2024, Section 3.4 (Fig. 12).

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(
    ...     n_stories=5, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=float("inf"),
    ...     period=1.0, aspect_ratio=8.0, damping_ratio=0.02,
    ... )
    >>> props = frame.rocking(1)
    >>> omega = rf.uplifted_modes(props).omega
    >>> bool(abs(rf.frequency_equation(props, omega)[0]) < 1e-6 * props.i_theta * omega[0] ** 2)
    True
    """
    pivot = _pivot(instance("properties", properties, RockingProperties), side)
    frequencies = float_array(omega)
    if frequencies is None or not (np.abs(frequencies) < HIGHEST).all():
        raise InputError(
            f"omega must contain frequencies in rad/s below {HIGHEST:g}, but {shown(omega)} was given.", field="omega"
        )
    square = frequencies[..., None] ** 2
    inertia = properties.effective_mass * properties.effective_height**2
    gap = properties.omega**2 - square
    terms = np.divide(square**2 * inertia, gap, out=np.full(gap.shape, np.nan), where=gap != 0.0)
    return pivot.rocking_stiffness - square[..., 0] * pivot.i_theta - terms.sum(axis=-1)
