"""Equivalents of two tested specimens, built from published ratios (docs/design/0009-validation.md).

They are not the specimens, whose masses, lengths and damping are not published. The parameters that the ratios do not
fix are arguments. The mass above the base is 1 kg, because the response does not depend on it.
"""

import math
from functools import lru_cache

import numpy as np
from scipy.optimize import brentq, root

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_damping_ratios, checked_in_range, checked_positive, checked_whole_number
from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError
from rockflex.structure._analysis import modal_properties
from rockflex.structure._frames import LumpedStructure
from rockflex.structure._rocking import RockingProperties

_SPACING = (1.25, 1.7)  # outside, positive masses barely meet both ratios of S1, or do not exist


def equivalent_2hz_long_base(base_mass_ratio: float, damping_ratio: float, n_modes: int = 2) -> RockingProperties:
    """Equivalent of specimen 2Hz-Long Base(14): a uniform cantilever with a mass at its tip.

    It has T_1 = 0.5 s, m*_1/m_s = 0.92, B/h*_1 = 0.16 and, to two digits, m*_1 h*_1/L_0^r = 0.98 (Silva & Stojadinović
    2024, Section 3.1). Its size follows from the 7 % by which the simplified resisting moment exceeds the complete one:
    m*_1 D_1 / (m_tot B) = g / (ω_1² h*_1) when the base lifts, so h*_1 = 0.888 m.

    Parameters
    ----------
    base_mass_ratio
        Mass m_0 of the base over the mass above it, zero or positive. Not published.
    damping_ratio
        Damping ratio of every mode in [0, 1). Not published.
    n_modes
        Number of modes of the cantilever, from 1 to 5; the paper uses two.

    Returns
    -------
    RockingProperties
        For 1 kg above the base.

    Raises
    ------
    InputError
        If a value is out of range.

    Examples
    --------
    >>> import rockflex as rf
    >>> rf.equivalent_2hz_long_base(base_mass_ratio=0.1,
    ...     damping_ratio=0.01).effective_height.round(3).tolist()
    [0.887, 0.228]
    """
    heavy = checked_positive("base_mass_ratio", base_mass_ratio, "kg of base a kg above it", zero=True)
    zeta = checked_damping_ratios("damping_ratio", damping_ratio, 1)[0]
    n = checked_whole_number("n_modes", n_modes, 1, 5)
    tip = _tip_mass_ratio(0.92)
    roots, mass, height, top = modes_of_tipped_cantilever(tip, n)
    omega_1 = 2.0 * math.pi / 0.5
    length = GRAVITY / (omega_1**2 * 0.07) / height[0]
    half_width = 0.16 * length * height[0]
    share = 1.0 / (1.0 + tip)  # of the column in the mass above the base
    inertia = length**2 * (share / 3.0 + tip * share)
    return RockingProperties(
        omega=omega_1 * (roots / roots[0]) ** 2,
        effective_mass=mass,
        effective_height=length * height,
        top_ordinate=top,
        i_theta=inertia + (1.0 + heavy) * half_width**2,
        l0r=length * (share / 2.0 + tip * share),
        m_tot=1.0 + heavy,
        half_width=half_width,
        zeta=float(zeta),
        top_height=length,
        base_mass=heavy,
    )


def equivalent_s1(
    base_mass_ratio: float,
    damping_ratio: float,
    width_ratio: float,
    effective_height: float,
    spacing: float = 1.5,
) -> RockingProperties:
    """Equivalent of specimen S1: five masses, irregularly spaced, on a uniform column without mass.

    It has T_1 = 0.11 s, m*_1/m_s = 0.48 and m*_1 h*_1/L_0^r = 0.87 (Silva & Stojadinović 2024, Section 3.1). These do
    not determine it uniquely, so the masses are placed at the heights H (i/5)^a and the middle three are equal; the two
    ratios give the lowest and the highest. All five modes are included.

    Parameters
    ----------
    base_mass_ratio
        Mass m_0 of the base over the mass above it, zero or positive. Not published.
    damping_ratio
        Damping ratio of every mode in [0, 1). Not published.
    width_ratio
        B/h*_1, positive. Not published.
    effective_height
        h*_1 in m, positive. Not published, and not determined by the ratios.
    spacing
        Exponent a in [1.25, 1.7). For equal spacing, a = 1, no positive masses were found.

    Returns
    -------
    RockingProperties
        For 1 kg above the base.

    Raises
    ------
    InputError
        If a value is out of range.

    Examples
    --------
    >>> import rockflex as rf
    >>> p = rf.equivalent_s1(base_mass_ratio=0.3, damping_ratio=0.02,
    ...     width_ratio=0.2, effective_height=1.0)
    >>> p.n_modes, round(6.2832 / float(p.omega[0]), 3)
    (5, 0.11)
    """
    height = checked_positive("effective_height", effective_height, "m")
    exponent = checked_in_range("spacing", spacing, *_SPACING, hint="Elsewhere no masses meet both ratios well.")
    ordinates, masses = _five_masses_of_s1(exponent)
    stiffness = _cantilever_stiffness(ordinates)
    unit = modal_properties(masses, stiffness, ordinates)
    length = height / float(unit.effective_height[0])
    stretch = (2.0 * math.pi / (0.11 * float(unit.omega[0]))) ** 2
    return LumpedStructure(
        masses,
        stretch * stiffness,
        length * ordinates,
        base_mass=checked_positive("base_mass_ratio", base_mass_ratio, "kg of base a kg above it", zero=True),
        half_width=checked_positive("width_ratio", width_ratio, "m of B a m of h*_1") * height,
        damping_ratio=damping_ratio,
    ).rocking()


def modes_of_tipped_cantilever(tip: float, n_modes: int) -> tuple[Array, Array, Array, Array]:
    """Return the modes of a uniform Euler-Bernoulli cantilever of unit length with `tip` times its mass at the tip.

    Returns
    -------
    roots, mass, height, top : ndarray, shape (n_modes,)
        λ_n with ω_n ∝ λ_n²; m*_n over the whole mass; h*_n over the length; Γ_n φ_n at the tip.
    """

    def frequency(root: float) -> float:
        # 1 + cos λ cosh λ + μ λ (cos λ sinh λ - sin λ cosh λ), over cosh λ
        return 1.0 / math.cosh(root) + math.cos(root) + tip * root * (math.cos(root) * math.tanh(root) - math.sin(root))

    # One root in each (nπ, nπ + π): at its ends the sign is that of ±(1 + small).
    roots = np.array([brentq(frequency, n * math.pi + 1e-9, (n + 1) * math.pi, xtol=1e-14) for n in range(n_modes)])
    sine, cosine = np.sinh(roots) + np.sin(roots), np.cosh(roots) + np.cos(roots)
    sigma = cosine / sine
    top = np.cosh(roots) - np.cos(roots) - sigma * (np.sinh(roots) - np.sin(roots))
    slope = roots * (sine - sigma * (np.cosh(roots) - np.cos(roots)))
    modal_mass = top**2 * (1.0 + tip) / 4.0 + tip * top * slope / 2.0
    excitation = 2.0 * sigma / roots
    return (
        roots,
        excitation**2 / modal_mass / (1.0 + tip),
        1.0 / (sigma * roots),
        excitation * top / modal_mass,
    )


@lru_cache(maxsize=4)
def _tip_mass_ratio(share: float) -> float:
    """Return the tip mass, over that of the column, for which m*_1 is `share` of their sum."""
    return float(brentq(lambda tip: float(modes_of_tipped_cantilever(tip, 1)[1][0]) - share, 0.0, 100.0, xtol=1e-12))


@lru_cache(maxsize=32)
def _five_masses_of_s1(spacing: float) -> tuple[Array, Array]:
    """Return heights (largest 1) and masses (sum 1) that meet the two ratios of S1."""
    x = (np.arange(1, 6) / 5.0) ** spacing

    stiffness = _cantilever_stiffness(x)

    def masses(logarithms: Array) -> Array:
        m = np.array([math.exp(logarithms[0]), 1.0, 1.0, 1.0, math.exp(logarithms[1])])
        return m / m.sum()

    def missing(logarithms: Array) -> list[float]:
        m = masses(logarithms)
        unit = modal_properties(m, stiffness, x)
        mass, height = float(unit.effective_mass[0]), float(unit.effective_height[0])
        return [mass - 0.48, mass * height / float(m @ x) - 0.87]

    found = root(missing, [1.0, 0.5], tol=1e-13)
    if not found.success or max(map(abs, missing(found.x))) > 1e-10:
        raise InputError(
            f"No masses were found that meet the ratios of S1 with spacing={spacing:g}. Give one nearer 1.5."
        )
    m = masses(found.x)
    for array in (x, m):
        array.setflags(write=False)
    return x, m


def _cantilever_stiffness(x: Array) -> Array:
    """Return the stiffness of a uniform cantilever with EI = 1, condensed to the heights `x`."""
    low, high = np.minimum.outer(x, x), np.maximum.outer(x, x)
    stiffness = np.linalg.inv(low**2 * (3.0 * high - low) / 6.0)
    return 0.5 * (stiffness + stiffness.T)
