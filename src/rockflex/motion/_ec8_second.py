"""Elastic spectra of the second generation of Eurocode 8 as targets."""

import math

import numpy as np

from rockflex._checks import finite_vector, one_of, positive
from rockflex._constants import GRAVITY
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.motion._target import TargetSpectrum

# Default amplification factors where depth and shear wave velocity are not used: F = top (1 - slope S/g).
_SITES = {
    "A": ((1.0, 0.0), (1.0, 0.0)),
    "B": ((1.3, 0.1), (1.6, 0.2)),
    "C": ((1.6, 0.2), (2.3, 0.3)),
    "D": ((1.8, 0.3), (3.2, 1.0)),
}
_T_A = 0.02  # s
_F_A = 2.5  # plateau over the peak ground acceleration
_CHI = 4.0  # T_C over T_B
_T_B = (0.05, 0.10)  # s, limits
_RISE = 129  # points of the rising branch, which is linear in T
_END = 10.0  # s, where the table ends


def ec8_second_spectrum(
    s_alpha: float,
    s_beta: float,
    site: str = "A",
    *,
    amplification: tuple[float, float] | None = None,
    topography: float = 1.0,
    damping_ratio: float = 0.05,
) -> TargetSpectrum:
    """Horizontal elastic spectrum of the second generation of Eurocode 8, EN 1998-1-1:2024, 5.2.2.2.

    With S_α = F_T F_α S_α,RP, S_β = F_T F_β S_β,RP, T_A = 0.02 s, T_C = S_β (1 s)/S_α, T_B = T_C/4 within
    0.05 s and 0.10 s, T_D = 1 s + S_β,RP/(1 m/s³) but 2 s if S_β,RP <= 1 m/s², and η = √(10/(5 + ξ)) >= 0.55, ξ being
    the damping ratio in %:

    - 0 <= T <= T_A: S_e = S_α/2.5
    - T_A <= T <= T_B: linear, to η S_α
    - T_B <= T <= T_C: S_e = η S_α
    - T_C <= T <= T_D: S_e = η S_β (1 s)/T
    - T_D <= T: S_e = η S_β (1 s) T_D/T²

    Parameters
    ----------
    s_alpha, s_beta : float
        S_α,RP and S_β,RP in m/s²: the plateau of the spectrum and its ordinate at 1 s, on site category A and for the
        return period of the limit state and consequence class.
    site : {"A", "B", "C", "D"}
        Site category, for the default factors F_α and F_β, which need no depth or shear wave velocity.
    amplification : tuple of float, optional
        F_α and F_β of the site, in the place of those of `site`: from the shear wave velocity and the depth of the
        bedrock, or for categories E and F.
    topography : float
        Topography amplification factor F_T.
    damping_ratio : float
        Fraction of critical damping, 0 <= ζ < 1.

    Returns
    -------
    TargetSpectrum
        The spectrum from 0 to 10 s, on the rising branch within 1e-4.

    Raises
    ------
    InputError
        If a value is not positive, the site category is unknown, or the factor of a default falls below 1.

    Notes
    -----
    The formulas and the default factors are those of the public drafts; compare them with your edition and its
    National Annex before you rely on them.

    References
    ----------
    EN 1998-1-1:2024, 5.2.2.2; Paolucci R et al. Checking the site categorization criteria and amplification factors of
    the 2021 draft of Eurocode 8 Part 1-1. *Bull Earthq Eng* 2021;19:4199-4234.

    Examples
    --------
    >>> import rockflex as rf
    >>> target = rf.ec8_second_spectrum(5.0, 1.5, "B")
    >>> target.at([0.0, 0.2, 1.0, 3.0]).round(2)
    array([2.47, 6.17, 2.33, 0.65])
    """
    alpha, beta = positive("s_alpha", s_alpha, "m/s²"), positive("s_beta", s_beta, "m/s²")
    of_alpha, of_beta = _amplification(alpha, beta, site, amplification)
    shape = positive("topography", topography, "")
    plateau, second = shape * of_alpha * alpha, shape * of_beta * beta
    t_c = second / plateau
    t_b = min(max(t_c / _CHI, _T_B[0]), _T_B[1])
    t_d = 1.0 + beta if beta > 1.0 else 2.0
    if not t_b < t_c < t_d < _END:
        raise InputError(
            f"s_alpha = {alpha:g} m/s² and s_beta = {beta:g} m/s² give the corner periods T_B = {t_b:.3g} s, "
            f"T_C = {t_c:.3g} s and T_D = {t_d:.3g} s, which must increase and stay below {_END:g} s. Check the values "
            "and their unit, m/s².",
            field="s_beta",
        )
    base = TargetSpectrum([0.0, 1.0], [1.0, 1.0], damping_ratio)  # checks the damping ratio
    eta = max(math.sqrt(10.0 / (5.0 + 100.0 * base.damping_ratio)), 0.55)
    rise = np.geomspace(_T_A, t_b, _RISE)
    share = (rise - _T_A) / (t_b - _T_A)
    rising = plateau * (eta * share + (1.0 - share) / _F_A)
    falling = eta * second * np.array([1.0 / t_c, 1.0 / t_d, t_d / _END**2])
    periods = np.concatenate(([0.0], rise, [t_c, t_d, _END]))
    where = f"site {site}" if amplification is None else f"F = {of_alpha:.3g}, {of_beta:.3g}"
    name = f"EC8 2024, {where}, S_α {alpha / GRAVITY:.3g} g, S_β {beta / GRAVITY:.3g} g"
    return TargetSpectrum(periods, np.concatenate(([plateau / _F_A], rising, falling)), base.damping_ratio, name)


def _amplification(alpha: float, beta: float, site: str, given: tuple[float, float] | None) -> tuple[float, float]:
    if given is not None:
        if site != "A":
            raise InputError(
                f"site={shown(site)} and amplification were both given. Give one: amplification takes the place of the "
                "default factors of a site category.",
                field="amplification",
            )
        factors = finite_vector("amplification", given, "")
        if factors.size != 2 or factors.min() <= 0.0:
            raise InputError(
                f"amplification must be the two positive factors F_α and F_β, but {shown(given)} was given.",
                field="amplification",
            )
        return float(factors[0]), float(factors[1])
    if not one_of(site, _SITES):
        raise InputError(
            f"site must be one of {', '.join(_SITES)}, a site category of EN 1998-1-1:2024, but {shown(site)} was "
            "given. For E and F, and with a measured shear wave velocity, give amplification=(F_α, F_β).",
            field="site",
        )
    (top, slope), (second, fall) = _SITES[site]
    of_alpha, of_beta = top * (1.0 - slope * alpha / GRAVITY), second * (1.0 - fall * beta / GRAVITY)
    if min(of_alpha, of_beta) < 1.0:
        raise InputError(
            f"For s_alpha = {alpha:g} m/s² and s_beta = {beta:g} m/s² the default factors of site category {site} are "
            f"F_α = {of_alpha:.3g} and F_β = {of_beta:.3g}, below 1. Give those of the site: amplification=(F_α, F_β).",
            field="site",
        )
    return of_alpha, of_beta
