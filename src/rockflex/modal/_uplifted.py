"""Vibration of a structure whose base has lifted."""

import math
from dataclasses import dataclass
from typing import SupportsIndex

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockflex._checks import float_array, instance
from rockflex._computable import computable
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex._values import Value
from rockflex.modal._pivot import Pivot
from rockflex.modal._rocking import RockingProperties
from rockflex.modal._uplifted_damping import uplifted_damping

Float = NDArray[np.float64]
HIGHEST = 1e60  # rad/s, whose fourth power is still a number

_BESIDE = (1e-13, 1e-11, 1e-9)  # shifts beside a root, relative: the first at which no pivot is zero


@dataclass(frozen=True, eq=False)
class UpliftedModes(Value):
    """Modes of free motion about one pivot. The arrays are read-only.

    Attributes
    ----------
    omega : ndarray, shape (n,)
        Circular frequencies ω*_n of vibration in rad/s, rising.
    ratio : ndarray, shape (n,)
        ω*_n/ω_n: against the same mode on a fixed base.
    damping_ratio : ndarray, shape (n,)
        ζ*_n = -Re λ/|λ| of the complex eigenvalues λ of Eq. 23 with its damping, in the order of |λ|. From 1 on the
        motion does not vibrate, and of its two real eigenvalues ζ*_n is -(λ_a + λ_b)/(2 √(λ_a λ_b)). With one mode
        it is ζ ω*/ω, but for the weight.
    shapes : ndarray, shape (n + 1, n)
        (θ, D_1 .. D_n) as columns, with Σ_n |D_n| = 1 m and the largest D_n positive.
    growth_rate : float
        Rate in 1/s at which the rigid, unstable mode grows; √(L_0^r g/I_θ) of a rigid structure. Zero where tendons
        hold it.
    sway_rate : float
        Circular frequency in rad/s of that mode where tendons hold it, else zero.
    growth_shape : ndarray, shape (n + 1,)
        (θ, D_1 .. D_n) of that mode, with θ = 1 rad.
    """

    omega: Float
    ratio: Float
    damping_ratio: Float
    shapes: Float
    growth_rate: float
    sway_rate: float
    growth_shape: Float


@computable("The uplifted modes of the given properties")
def uplifted_modes(
    properties: RockingProperties, n_modes: SupportsIndex | None = None, *, side: int | None = None
) -> UpliftedModes:
    """Return the modes of Eq. 23, with the first `n_modes` modes of the structure or with all.

    Frequencies and shapes are those without damping; `damping_ratio` says what the damping of the fixed base becomes.

    Its matrices, the rows of D_n times m*_n, are symmetric, and the mass matrix is positive definite since
    I_θ > Σ m*_n h*_n². The lowest root in ω² is that of the rotation, negative where gravity drives it (and tendons do
    not outdo it); the others are vibrations.

    Parameters
    ----------
    properties : RockingProperties
    n_modes : int, optional
        Modes of the structure to keep: 1 is 2DOF-S, 2 is 3DOF-S. Default: all.
    side : int, optional
        1 for motion about the right edge of the base, -1 about the left one. Default: the `weaker_pivot`; both are
        alike if the structure is `symmetric`.

    Returns
    -------
    UpliftedModes

    Raises
    ------
    InputError
        If there are not as many modes, or `side` is neither.

    References
    ----------
    Silva & Stojadinović 2024, Eq. 23 and Section 3.4 (Fig. 10).
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
def lowest_uplifted(properties: RockingProperties, count: int, side: int | None = None) -> Float:
    """Return the first `count` of `UpliftedModes.omega`, or as many as there are, with less work than for all."""
    return np.sqrt(_lowest(properties, _pivot(properties, side), min(count, properties.n_modes))[0][1:])


def _pivot(p: RockingProperties, side: int | None) -> Pivot:
    return p.weaker_pivot if side is None else p.pivot(side)


def _lowest(p: RockingProperties, pivot: Pivot, vibrations: int) -> tuple[Float, Float]:
    """Return ω² and (θ, D) of the rotation and of the lowest vibrations, of shapes (v + 1,) and (n + 1, v + 1)."""
    # With D_n √m*_n for freedoms the lower block of the mass matrix is the identity.
    root = np.sqrt(p.effective_mass)
    arm = root * p.effective_height
    # M = L L^T: the rest of the inertia, and the modes' own directions.
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


def _modal_damping(p: RockingProperties, pivot: Pivot, motions: Float) -> Float:
    """Return the damping of Eq. 23 over motions (θ, D) as columns, each scaled to unit modal mass."""
    root = np.sqrt(p.effective_mass)
    arm = root * p.effective_height
    turn, modal = motions[0], root[:, None] * motions[1:]
    mass = (pivot.i_theta - arm @ arm) * turn**2 + ((modal + arm[:, None] * turn) ** 2).sum(axis=0)
    share = modal / np.sqrt(mass)
    return share.T @ ((2.0 * p.zeta * p.omega)[:, None] * share)


def _polished(stiffness: Float, mass: Float, squares: Float, motions: Float) -> tuple[Float, Float]:
    """Give small roots back the digits that rounding of the largest took: a step of inverse iteration each."""
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


def frequency_equation(properties: RockingProperties, omega: ArrayLike, *, side: int | None = None) -> Float:
    """Return k_r - ω² I_θ - Σ_n ω⁴ m*_n h*_n²/(ω_n² - ω²), whose zeros are the uplifted frequencies.

    k_r is the `rocking_stiffness` of the pivot, which is -L_0^r g without tendons, and I_θ the inertia about it.

    Parameters
    ----------
    properties : RockingProperties
        `truncated` for fewer modes.
    omega : array_like
        Circular frequencies in rad/s, any shape.
    side : int, optional
        1 for motion about the right edge of the base, -1 about the left one. Default: the `weaker_pivot`.

    Returns
    -------
    ndarray
        In N m/rad, in the shape of `omega`; NaN at a frequency ω_n of the fixed base, where the sum has a pole.

    Raises
    ------
    InputError
        If a frequency is no number below 1e60 rad/s, or `side` is neither.

    References
    ----------
    Silva & Stojadinović 2024, Section 3.4 (Fig. 12).
    """
    pivot = _pivot(instance("properties", properties, RockingProperties), side)
    frequencies = float_array(omega)
    if frequencies is None or not (np.abs(frequencies) < HIGHEST).all():
        raise InputError(
            f"omega must hold frequencies in rad/s, below {HIGHEST:g}, but {shown(omega)} was given.", field="omega"
        )
    square = frequencies[..., None] ** 2
    inertia = properties.effective_mass * properties.effective_height**2
    gap = properties.omega**2 - square
    terms = np.divide(square**2 * inertia, gap, out=np.full(gap.shape, np.nan), where=gap != 0.0)
    return pivot.rocking_stiffness - square[..., 0] * pivot.i_theta - terms.sum(axis=-1)
