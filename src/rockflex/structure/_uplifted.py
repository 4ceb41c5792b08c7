"""Vibration of a structure whose base has lifted, its damping, and the pinned beam as a bound."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal, SupportsIndex

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import (
    checked_instance,
    checked_positive,
    checked_whole_number,
    float_array,
    is_one_of,
)
from rockflex.foundation.constants import MOST_MODES
from rockflex.foundation.errors import InputError
from rockflex.foundation.overflow import explaining_overflow
from rockflex.foundation.shown import shown
from rockflex.foundation.values import Value
from rockflex.structure._pivot import Pivot
from rockflex.structure._rocking import RockingProperties

MAX_FREQUENCY = 1e60  # rad/s, whose fourth power still fits in double precision
_MANY = 50  # modes, from which their damping ratios are found one by one: all eigenvalues take a time with their cube
_MOST_STEPS, _CONVERGED, _APART = 20, 1e-9, 1e-9  # of the iteration, and relative to the root
_ROOT_SHIFTS = (1e-13, 1e-11, 1e-9)  # relative shifts from a root: the first that gives a regular matrix is used


def uplifted_damping_ratios(squares: Array, damping: Array) -> Array:
    """Return ζ* (n,) of the vibrations of q'' + C q' + Λ q = 0, without the rotation.

    Parameters
    ----------
    squares : ndarray, shape (n + 1,)
        Λ: the eigenvalues ω² of the undamped system in rad²/s², in ascending order; the first is the rotation.
    damping : ndarray, shape (n + 1, n + 1)
        C in 1/s, in the undamped modes with unit modal mass; symmetric, positive semidefinite.

    Notes
    -----
    The roots λ come in pairs: two conjugates, or two real roots of an overdamped motion (if there are more, the slowest
    is paired with the fastest). The pair of the rotation is the growing root and the slowest decaying real root;
    without a growing root, it is the pair with the smallest product. The other pairs are sorted by √(λ_a λ_b), which is
    ω* without damping, and have ζ* = -(λ_a + λ_b)/(2 √(λ_a λ_b)).
    """
    size = squares.size
    # Displacements are scaled by ω: without damping the matrix is then skew-symmetric except for the rotation, and so
    # well conditioned.
    scale = np.sqrt(np.abs(squares))
    scale[scale == 0.0] = 1.0
    matrix = np.zeros((2 * size, 2 * size))
    matrix[:size, size:] = np.diag(scale)
    matrix[size:, :size] = np.diag(-squares / scale)
    matrix[size:, size:] = -damping
    roots = np.linalg.eigvals(matrix)
    turning = roots[roots.imag > 0.0]
    still = roots.real[roots.imag == 0.0]
    still = still[np.argsort(np.abs(still))]
    grows = bool(squares[0] < 0.0)
    if grows:
        still = np.delete(still, np.argmax(still))[1:]
    slow, fast = still[: still.size // 2], still[::-1][: still.size // 2]
    total = np.concatenate([2.0 * turning.real, slow + fast])
    product = np.concatenate([np.abs(turning) ** 2, np.abs(slow * fast)])
    order = np.argsort(product)[0 if grows else 1 :]
    return -total[order] / (2.0 * np.sqrt(product[order]))


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
    ...     n_stories=5, story_height=3.0, story_mass=40e3, base_mass=40e3,
    ...     stiffness_ratio=float("inf"),
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


@explaining_overflow("The uplifted modes of the given properties")
def uplifted_modes(
    properties: RockingProperties, n_modes: SupportsIndex | None = None, *, side: int | None = None
) -> UpliftedModes:
    """Return the modes of Eq. 23 from the first `n_modes` modes of the structure (default: all).

    Frequencies and shapes are undamped; `damping_ratio` results from the damping ratios on the fixed base.

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
    ...     n_stories=5, story_height=3.0, story_mass=40e3, base_mass=40e3,
    ...     stiffness_ratio=float("inf"),
    ...     period=1.0, aspect_ratio=8.0, damping_ratio=0.02,
    ... )
    >>> modes = rf.uplifted_modes(frame.rocking(2))
    >>> modes.ratio.round(2)
    array([2.78, 2.39])
    """
    p = checked_instance("properties", properties, RockingProperties)
    p = p if n_modes is None else p.truncated(n_modes)
    n = p.n_modes
    pivot = _pivot_at_side(p, side)
    squares, motions = _lowest_uplifted_modes(p, pivot, n)
    omega = np.sqrt(squares[1:])
    modal = motions[1:, 1:]
    largest = modal[np.abs(modal).argmax(axis=0), np.arange(n)] if n else np.ones(0)
    ratios = _tracked_damping_ratios(p, pivot, squares, motions) if n >= _MANY else None
    if ratios is None:
        ratios = uplifted_damping_ratios(squares, _uplifted_modal_damping(p, pivot, motions))
    return UpliftedModes(
        omega=omega,
        ratio=omega / p.omega,
        damping_ratio=ratios,
        shapes=motions[:, 1:] / (np.sign(largest) * np.abs(modal).sum(axis=0)),
        growth_rate=math.sqrt(max(-squares[0], 0.0)),
        sway_rate=math.sqrt(max(squares[0], 0.0)),
        growth_shape=motions[:, 0] / motions[0, 0],
    )


@explaining_overflow("The uplifted frequencies of the given properties")
def lowest_uplifted_frequencies(properties: RockingProperties, count: int, side: int | None = None) -> Array:
    """Return at most the first `count` of `UpliftedModes.omega`, which is faster than computing all."""
    return np.sqrt(
        _lowest_uplifted_modes(properties, _pivot_at_side(properties, side), min(count, properties.n_modes))[0][1:]
    )


def _pivot_at_side(p: RockingProperties, side: int | None) -> Pivot:
    return p.weaker_pivot if side is None else p.pivot(side)


def _lowest_uplifted_modes(p: RockingProperties, pivot: Pivot, vibrations: int) -> tuple[Array, Array]:
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
    kept = slice(vibrations + 1)
    squares, vectors = _lowest_eigenvalues(back.T @ (stiffness[:, None] * back), vibrations + 1)
    mass = _Arrow(pivot.i_theta, arm, np.ones(n))
    squares, motions = _polished_uplifted_modes(mass, stiffness, squares[kept], back @ vectors[:, kept])
    motions[1:] /= root[:, None]
    return squares, motions


def _lowest_eigenvalues(matrix: Array, count: int) -> tuple[Array, Array]:
    """Return the first `count` eigenvalues and vectors of a symmetric matrix, or all of a small one."""
    if len(matrix) < _MANY or count == len(matrix):
        return np.linalg.eigh(matrix)
    from scipy.linalg import eigh

    return eigh(matrix, subset_by_index=(0, count - 1))


def _uplifted_modal_damping(p: RockingProperties, pivot: Pivot, motions: Array) -> Array:
    """Return the modal damping matrix of Eq. 23 for motions (θ, D) as columns, each scaled to unit modal mass."""
    root = np.sqrt(p.effective_mass)
    arm = root * p.effective_height
    turn, modal = motions[0], root[:, None] * motions[1:]
    mass = (pivot.i_theta - arm @ arm) * turn**2 + ((modal + arm[:, None] * turn) ** 2).sum(axis=0)
    share = modal / np.sqrt(mass)
    return share.T @ ((2.0 * p.zeta * p.omega)[:, None] * share)


@dataclass(frozen=True)
class _Arrow:
    """Symmetric matrices of the rotation and n modes that are coupled by the rotation alone, for k shifts at once.

    `corner` is a number or (k,), `border` and `diagonal` are (n,) or (n, k).
    """

    corner: Any
    border: Any
    diagonal: Any

    def times(self, vectors: Any) -> Any:
        """Return the product with vectors (n + 1, k), each of its own matrix."""
        border, diagonal = (each if each.ndim == 2 else each[:, None] for each in (self.border, self.diagonal))
        first = self.corner * vectors[0] + (border * vectors[1:]).sum(axis=0)
        return np.concatenate([first[None], border * vectors[0] + diagonal * vectors[1:]])

    def solved(self, right: Any) -> Any:
        """Return the solutions (n + 1, k) by elimination of the modes; not finite where a matrix is singular."""
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            share = self.border / self.diagonal
            turn = (right[0] - (share * right[1:]).sum(axis=0)) / (self.corner - (share * self.border).sum(axis=0))
            return np.concatenate([turn[None], right[1:] / self.diagonal - share * turn])


def _polished_uplifted_modes(mass: _Arrow, stiffness: Array, squares: Array, motions: Array) -> tuple[Array, Array]:
    """Restore the digits that small roots lost to rounding of the largest, by one step of inverse iteration each."""
    moved = motions
    for shift in _ROOT_SHIFTS:
        at = squares * (1.0 + shift)
        near = _Arrow(
            stiffness[0] - at * mass.corner,
            -at * mass.border[:, None],
            stiffness[1:, None] - at * mass.diagonal[:, None],
        )
        found = near.solved(mass.times(motions))
        if np.isfinite(found).all():
            moved = found
            break
    moved = moved / np.abs(moved).max(axis=0)
    work = np.einsum("in,in->n", moved, stiffness[:, None] * moved)
    return work / np.einsum("in,in->n", moved, mass.times(moved)), moved


def _tracked_damping_ratios(p: RockingProperties, pivot: Pivot, squares: Array, motions: Array) -> Array | None:
    """Return ζ* (n,) as `uplifted_damping_ratios`, from roots followed one by one; None if not all are found so.

    Each undamped mode is the start of an iteration with the Rayleigh functional. Where all modes vibrate, and no two
    starts end at one root, these are all roots.
    """
    first = 1 if squares[0] < 0.0 else 0  # the rotation grows, or is the vibration with the smallest root
    root = np.sqrt(p.effective_mass)
    arm, drag = root * p.effective_height, 2.0 * p.zeta * p.omega
    x = motions[:, first:].astype(complex)
    x[1:] *= root[:, None]
    mass, damping = _Arrow(pivot.i_theta, arm, np.ones(p.n_modes)), _Arrow(0.0, 0.0 * arm, drag)
    stiffness = _Arrow(pivot.rocking_stiffness, 0.0 * arm, p.omega**2)

    def nearest() -> Any:
        a, b, c = ((x * each.times(x)).sum(axis=0) for each in (mass, damping, stiffness))
        half = np.sqrt(b * b - 4.0 * a * c + 0.0j)
        one, other = (half - b) / (2.0 * a), (-half - b) / (2.0 * a)
        return np.where(one.imag > other.imag, one, other)

    at = nearest()
    for _ in range(_MOST_STEPS):
        slope = _Arrow(
            2.0 * at * mass.corner,
            2.0 * at * arm[:, None],
            2.0 * at * mass.diagonal[:, None] + drag[:, None],
        )
        near = at * (1.0 + _ROOT_SHIFTS[0])  # where the matrix is regular
        system = _Arrow(
            pivot.rocking_stiffness + near**2 * mass.corner,
            near**2 * arm[:, None],
            near**2 + drag[:, None] * near + p.omega[:, None] ** 2,
        )
        found = system.solved(slope.times(x))
        if not np.isfinite(found).all():
            return None
        x = found / np.abs(found).max(axis=0)
        before, at = at, nearest()
        if (np.abs(at - before) <= _CONVERGED * np.abs(at)).all():
            break
    else:
        return None
    apart = np.abs(at[:, None] - at) + np.diag(np.abs(at))
    if not (at.imag > _APART * np.abs(at)).all() or not (apart > _APART * np.abs(at)).all():
        return None
    at = at[np.argsort(np.abs(at))][1 - first :]
    return -at.real / np.abs(at)


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
    ...     n_stories=5, story_height=3.0, story_mass=40e3, base_mass=40e3,
    ...     stiffness_ratio=float("inf"),
    ...     period=1.0, aspect_ratio=8.0, damping_ratio=0.02,
    ... )
    >>> props = frame.rocking(1)
    >>> omega = rf.uplifted_modes(props).omega
    >>> left = rf.frequency_equation(props, omega)[0]
    >>> bool(abs(left) < 1e-6 * props.i_theta * omega[0] ** 2)
    True
    """
    pivot = _pivot_at_side(checked_instance("properties", properties, RockingProperties), side)
    frequencies = float_array(omega)
    if frequencies is None or not (np.abs(frequencies) < MAX_FREQUENCY).all():
        raise InputError(
            f"omega must contain frequencies in rad/s below {MAX_FREQUENCY:g}, but {shown(omega)} was given.",
            field="omega",
        )
    square = frequencies[..., None] ** 2
    inertia = properties.effective_mass * properties.effective_height**2
    gap = properties.omega**2 - square
    terms = np.divide(square**2 * inertia, gap, out=np.full(gap.shape, np.nan), where=gap != 0.0)
    return pivot.rocking_stiffness - square[..., 0] * pivot.i_theta - terms.sum(axis=-1)


@dataclass(frozen=True, eq=False)
class PinnedBeam(Value):
    """Frequencies of a pinned beam relative to the clamped beam.

    Attributes
    ----------
    rotation_ratio : float
        Frequency of the rotation on the spring divided by the first frequency of the clamped beam; 0 without a spring,
        1 if clamped. An uplifted structure has no corresponding frequency.
    ratio : ndarray, shape (n,)
        ω*_n/ω_n of the higher vibrations, relative to mode n of the clamped beam. Without a spring these are bounds for
        an uplifted structure.
    roots : ndarray, shape (n + 1,)
        λ of the rotation and of the vibrations: ω = λ² √(EI/(m L⁴)) in flexure, λ √(GA/(m L²)) in shear.

    Examples
    --------
    >>> import rockflex as rf
    >>> beam = rf.pinned_beam("shear", spring=1.0)
    >>> round(beam.rotation_ratio, 3), beam.ratio.round(3)
    (0.742, array([2.931, 1.653]))
    """

    rotation_ratio: float
    ratio: Array
    roots: Array


def pinned_beam(behaviour: Literal["flexure", "shear"], spring: float = 0.0, n_modes: SupportsIndex = 2) -> PinnedBeam:
    """Return the frequencies of a uniform cantilever on a rotational spring.

    Parameters
    ----------
    behaviour : {"flexure", "shear"}
        Kind of deformation.
    spring : float
        k_r L/EI in flexure, k_r/(GA L) in shear, zero (pinned) or positive.
    n_modes : int
        Number of vibrations, at most 200.

    Returns
    -------
    PinnedBeam

    Raises
    ------
    InputError
        If the behaviour is unknown, the spring negative or not finite, or `n_modes` not positive.

    References
    ----------
    The limit k_r → 0 is due to Wiebe & Christopoulos, cited in Silva & Stojadinović 2024, Section 3.4 (Fig. 10).

    Examples
    --------
    >>> import rockflex as rf
    >>> beam = rf.pinned_beam("flexure")
    >>> beam.ratio.round(3)
    array([4.385, 2.268])
    """
    if not is_one_of(behaviour, ("flexure", "shear")):
        raise InputError(
            f'behaviour must be "flexure" or "shear", but {shown(behaviour)} was given.', field="behaviour"
        )
    k = checked_positive("spring", spring, "k_r L/EI (flexure) or k_r/(GA L) (shear)", zero=True)
    n = checked_whole_number("n_modes", n_modes, 1, MOST_MODES)
    flexure = behaviour == "flexure"
    clamp, pin = (_clamped_flexural_beam, _pinned_flexural_beam) if flexure else (math.cos, _pinned_shear_beam)
    pinned, clamped = [0.0], [_bisected_root(clamp, 0.0, math.pi)]
    for i in range(1, n + 1):
        pinned.append(_bisected_root(pin, i * math.pi, (i + 1) * math.pi if flexure else (i + 0.5) * math.pi))
        clamped.append(_bisected_root(clamp, i * math.pi, (i + 1) * math.pi))
    # The roots with a spring lie between the roots of the pinned and of the clamped beam.
    spring_of = _flexural_beam_on_spring if flexure else _shear_beam_on_spring
    roots = [
        _bisected_root(lambda x: spring_of(x, k), low, high) if k else low
        for low, high in zip(pinned, clamped, strict=True)
    ]  # fmt: skip
    found = np.array(roots)
    power = 2 if flexure else 1
    against = np.array(clamped)
    return PinnedBeam(
        rotation_ratio=float((found[0] / against[0]) ** power),
        ratio=(found[1:] / against[:-1]) ** power,
        roots=found,
    )


def _clamped_flexural_beam(x: float) -> float:
    return math.cos(x) + 1.0 / math.cosh(x)


def _pinned_flexural_beam(x: float) -> float:
    return math.sin(x) - math.cos(x) * math.tanh(x)


def _pinned_shear_beam(x: float) -> float:
    return math.sin(x) - x * math.cos(x)


def _flexural_beam_on_spring(x: float, k: float) -> float:
    return k * _clamped_flexural_beam(x) - x * _pinned_flexural_beam(x)


def _shear_beam_on_spring(x: float, k: float) -> float:
    return k * x * math.cos(x) - _pinned_shear_beam(x)


def _bisected_root(function: Callable[[float], float], low: float, high: float) -> float:
    """Return the place of the sign change, to the last bit."""
    above = function(high) > 0.0
    while low < (middle := 0.5 * (low + high)) < high:
        if (function(middle) > 0.0) == above:
            high = middle
        else:
            low = middle
    return middle
