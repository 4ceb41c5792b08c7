"""Target spectra of EN 1998-1:2004, EN 1998-1-1:2024 and ASCE 7-16."""

import math

import numpy as np

from rockflex.foundation.checks import checked_finite_vector, checked_positive, is_one_of, real_or_nan
from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.motion._spectra import TargetSpectrum, checked_spectrum_damping

# EN 1998-1:2004, Tables 3.2 and 3.3 (recommended values): S, T_B, T_C, T_D by type and ground type.
_EC8 = {
    1: {
        "A": (1.0, 0.15, 0.4, 2.0),
        "B": (1.2, 0.15, 0.5, 2.0),
        "C": (1.15, 0.20, 0.6, 2.0),
        "D": (1.35, 0.20, 0.8, 2.0),
        "E": (1.4, 0.15, 0.5, 2.0),
    },
    2: {
        "A": (1.0, 0.05, 0.25, 1.2),
        "B": (1.35, 0.05, 0.25, 1.2),
        "C": (1.5, 0.10, 0.25, 1.2),
        "D": (1.8, 0.10, 0.30, 1.2),
        "E": (1.6, 0.05, 0.25, 1.2),
    },
}
_EC8_END = 4.0  # s, up to which 3.2.2.2 defines the spectrum

# ASCE 7-16, Tables 11.4-1 and 11.4-2: F_a at S_S, and F_v at S_1, both in g; class E as far as the tables go.
_SHORT = (0.25, 0.5, 0.75, 1.0, 1.25, 1.5)
_FA = {
    "A": (0.8, 0.8, 0.8, 0.8, 0.8, 0.8),
    "B": (0.9, 0.9, 0.9, 0.9, 0.9, 0.9),
    "C": (1.3, 1.3, 1.2, 1.2, 1.2, 1.2),
    "D": (1.6, 1.4, 1.2, 1.1, 1.0, 1.0),
    "E": (2.4, 1.7, 1.3),
}
_SECOND = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6)
_FV = {
    "A": (0.8, 0.8, 0.8, 0.8, 0.8, 0.8),
    "B": (0.8, 0.8, 0.8, 0.8, 0.8, 0.8),
    "C": (1.5, 1.5, 1.5, 1.5, 1.5, 1.4),
    "D": (2.4, 2.2, 2.0, 1.9, 1.8, 1.7),
    "E": (4.2,),
}
_ASCE_END = 100.0  # s; the code sets no end
_E_SHORT, _E_SECOND = 1.0, 0.2  # g, from which 11.4.8 asks for an analysis of the hazard in class E
# Default amplification factors where depth and shear wave velocity are not used: F = top (1 - slope S/g).
_EC8_2024_SITES = {
    "A": ((1.0, 0.0), (1.0, 0.0)),
    "B": ((1.3, 0.1), (1.6, 0.2)),
    "C": ((1.6, 0.2), (2.3, 0.3)),
    "D": ((1.8, 0.3), (3.2, 1.0)),
}
_T_A = 0.02  # s
_F_A = 2.5  # plateau over the peak ground acceleration
_CHI = 4.0  # T_C over T_B
_T_B = (0.05, 0.10)  # s, limits
_N_RISING = 129  # points of the rising branch, which is linear in T
_EC8_2024_END = 10.0  # s, where the table ends


def ec8_spectrum(
    ag: float, ground: str = "A", kind: int = 1, *, importance: float = 1.0, damping_ratio: float = 0.05
) -> TargetSpectrum:
    """Horizontal elastic spectrum of EN 1998-1:2004, 3.2.2.2, with the recommended parameters.

    With η = √(10/(5 + ξ)) >= 0.55, ξ being the damping ratio in %, and a_g = γ_I a_gR:

    - 0 <= T <= T_B: S_e = a_g S (1 + T/T_B (2.5 η - 1))
    - T_B <= T <= T_C: S_e = 2.5 η a_g S
    - T_C <= T <= T_D: S_e = 2.5 η a_g S T_C/T
    - T_D <= T <= 4 s: S_e = 2.5 η a_g S T_C T_D/T²

    A National Annex may set other values of S, T_B, T_C and T_D: then give the corners of its spectrum to
    `TargetSpectrum`, which is exact between them.

    Parameters
    ----------
    ag : float
        Reference peak ground acceleration on type A ground, a_gR, in m/s².
    ground : {"A", "B", "C", "D", "E"}
        Ground type.
    kind : {1, 2}
        Type of the spectrum: 2 is recommended where the earthquakes that contribute most have a magnitude M_s of at
        most 5.5.
    importance : float
        Importance factor γ_I.
    damping_ratio : float
        Fraction of critical damping, 0 <= ζ < 1.

    Raises
    ------
    InputError
        If an acceleration or factor is not positive, or the ground type or type of spectrum is unknown.

    References
    ----------
    EN 1998-1:2004, 3.2.2.2, Tables 3.2 and 3.3.

    Examples
    --------
    >>> import rockflex as rf
    >>> target = rf.ec8_spectrum(2.5, "C")
    >>> target.at([0.0, 0.2, 0.6, 1.2, 4.0]).round(2)
    array([2.88, 7.19, 7.19, 3.59, 0.54])
    """
    if real_or_nan(kind) not in _EC8:
        raise InputError(f"kind must be 1 or 2, the type of the spectrum, but {shown(kind)} was given.", field="kind")
    table = _EC8[int(kind)]
    if not is_one_of(ground, table):
        raise InputError(
            f"ground must be one of {', '.join(table)}, the ground type of EN 1998-1, but {shown(ground)} was given. "
            "Ground of type S1 or S2 needs a study of its own, whose spectrum is a table: TargetSpectrum(periods, sa).",
            field="ground",
        )
    reference = checked_positive("ag", ag, "m/s²")
    zeta = checked_spectrum_damping(damping_ratio)
    eta = damping_correction(zeta)
    soil, t_b, t_c, t_d = table[ground]
    zero = checked_positive("importance", importance, "") * reference * soil
    top = 2.5 * eta * zero
    sa = [zero, top, top, top * t_c / t_d, top * t_c * t_d / _EC8_END**2]
    name = f"EC8 type {int(kind)}, ground {ground}, {zero / soil / GRAVITY:.3g} g"
    return TargetSpectrum([0.0, t_b, t_c, t_d, _EC8_END], sa, zeta, name)


def damping_correction(damping_ratio: float) -> float:
    """Factor η of both generations of Eurocode 8 on the plateau."""
    return max(math.sqrt(10.0 / (5.0 + 100.0 * damping_ratio)), 0.55)


def asce7_spectrum(sds: float, sd1: float, tl: float, *, mce: bool = False) -> TargetSpectrum:
    """Design spectrum of ASCE 7-16, 11.4.6, or the risk-targeted maximum considered one (11.4.7), for 5 % damping.

    With T_0 = 0.2 S_D1/S_DS and T_S = S_D1/S_DS:

    - 0 <= T <= T_0: S_a = S_DS (0.4 + 0.6 T/T_0)
    - T_0 <= T <= T_S: S_a = S_DS
    - T_S <= T <= T_L: S_a = S_D1/T
    - T_L <= T <= 100 s: S_a = S_D1 T_L/T²

    Parameters
    ----------
    sds, sd1 : float
        Design spectral accelerations S_DS, at short periods, and S_D1, at 1 s, in m/s²: multiply the g of maps by 9.81.
    tl : float
        Long-period transition T_L of the maps, in s.
    mce : bool
        Multiply by 1.5, which gives the spectrum of the risk-targeted maximum considered earthquake, MCE_R.

    Raises
    ------
    InputError
        If a value is not positive, or T_S does not lie below T_L, nor T_L below 100 s.

    References
    ----------
    ASCE/SEI 7-16, Minimum Design Loads and Associated Criteria for Buildings and Other Structures, 11.4.

    Examples
    --------
    >>> import rockflex as rf
    >>> target = rf.asce7_spectrum(1.0 * 9.81, 0.6 * 9.81, tl=8.0)
    >>> (target.at([0.0, 0.12, 0.6, 1.2, 16.0]) / 9.81).round(6)
    array([0.4    , 1.     , 1.     , 0.5    , 0.01875])
    """
    short, second, long = (
        checked_positive("sds", sds, "m/s²"),
        checked_positive("sd1", sd1, "m/s²"),
        checked_positive("tl", tl, "s"),
    )
    if not isinstance(mce, bool):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(f"mce must be True or False, but {shown(mce)} was given.", field="mce")
    corner = second / short
    if not 0.0 < corner < long < _ASCE_END:
        raise InputError(
            f"tl must lie between sd1/sds = {corner:g} s and {_ASCE_END:g} s, but {shown(tl)} was given. "
            "sds and sd1 are accelerations in the same unit, m/s².",
            field="tl",
        )
    sa = np.array([0.4 * short, short, short, second / long, second * long / _ASCE_END**2]) * (1.5 if mce else 1.0)
    level = "MCE_R" if mce else "design"
    name = f"ASCE 7-16 {level}, S_DS = {short / GRAVITY:.3g} g, S_D1 = {second / GRAVITY:.3g} g"
    return TargetSpectrum([0.0, 0.2 * corner, corner, long, _ASCE_END], sa, 0.05, name)


def asce7_site_spectrum(ss: float, s1: float, site: str, tl: float, *, mce: bool = False) -> TargetSpectrum:
    """Spectrum of ASCE 7-16 from mapped accelerations and the site class, by the general procedure (11.4).

    S_DS = 2/3 F_a S_S and S_D1 = 2/3 F_v S_1; F_a and F_v are interpolated linearly in Tables 11.4-1 and 11.4-2.

    Where 11.4.8 asks for an analysis of the hazard at the site, the tables alone do not suffice: in class E from S_S =
    1.0 g or S_1 = 0.2 g, which is refused here, and in class D from S_1 = 0.2 g, unless its exceptions are used.

    Parameters
    ----------
    ss, s1 : float
        Mapped accelerations S_S, at short periods, and S_1, at 1 s, in m/s²: multiply the g of maps by 9.81.
    site : {"A", "B", "C", "D", "default", "E"}
        Site class. Class B is rock whose shear-wave velocity was measured. "default" is class D where soil properties
        are not known in detail, for which F_a is at least 1.2 (11.4.4).
    tl : float
        Long-period transition T_L of the maps, in s.
    mce : bool
        As in `asce7_spectrum`.

    Raises
    ------
    InputError
        If a value is not positive, the site class is unknown, or the general procedure does not apply.

    References
    ----------
    ASCE/SEI 7-16, 11.4.

    Examples
    --------
    >>> import rockflex as rf
    >>> target = rf.asce7_site_spectrum(1.5 * 9.81, 0.6 * 9.81, "C", tl=8.0)
    >>> # 2/3 · 1.2 · 1.5 and 2/3 · 1.4 · 0.6
    >>> (target.at([0.3, 1.0]) / 9.81).round(3)
    array([1.2 , 0.56])
    """
    if not is_one_of(site, (*_FA, "default")):
        raise InputError(
            f'site must be one of A, B, C, D, E or "default", the site class of ASCE 7-16, but {shown(site)} was given.'
            " Class F needs an analysis of the site.",
            field="site",
        )
    short, second = checked_positive("ss", ss, "m/s²") / GRAVITY, checked_positive("s1", s1, "m/s²") / GRAVITY
    if site == "E" and (short >= _E_SHORT or second >= _E_SECOND):
        raise InputError(
            f"site E with S_S = {short:.3g} g and S_1 = {second:.3g} g needs an analysis of the hazard at the site "
            f"(ASCE 7-16, 11.4.8: from S_S = {_E_SHORT:g} g or S_1 = {_E_SECOND:g} g). Give its result as a table: "
            "TargetSpectrum(periods, sa).",
            field="site",
        )
    rows = "D" if site == "default" else site
    fa = float(np.interp(short, _SHORT[: len(_FA[rows])], _FA[rows]))
    fv = float(np.interp(second, _SECOND[: len(_FV[rows])], _FV[rows]))
    if site == "default":
        fa = max(fa, 1.2)
    return asce7_spectrum(2.0 / 3.0 * fa * short * GRAVITY, 2.0 / 3.0 * fv * second * GRAVITY, tl, mce=mce)


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
        F_α and F_β of the site, in place of the defaults for `site`: from the shear wave velocity and the depth of the
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
    The formulas and the default factors are taken from the public drafts; compare them with your edition and its
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
    alpha, beta = checked_positive("s_alpha", s_alpha, "m/s²"), checked_positive("s_beta", s_beta, "m/s²")
    of_alpha, of_beta = _site_amplification(alpha, beta, site, amplification)
    shape = checked_positive("topography", topography, "")
    plateau, second = shape * of_alpha * alpha, shape * of_beta * beta
    t_c = second / plateau
    t_b = min(max(t_c / _CHI, _T_B[0]), _T_B[1])
    t_d = 1.0 + beta if beta > 1.0 else 2.0
    if not t_b < t_c < t_d < _EC8_2024_END:
        raise InputError(
            f"s_alpha = {alpha:g} m/s² and s_beta = {beta:g} m/s² give the corner periods T_B = {t_b:.3g} s, "
            f"T_C = {t_c:.3g} s and T_D = {t_d:.3g} s, which must increase and stay below {_EC8_2024_END:g} s. Check "
            "the values and their unit, m/s².",
            field="s_beta",
        )
    zeta = checked_spectrum_damping(damping_ratio)
    eta = damping_correction(zeta)
    rise = np.geomspace(_T_A, t_b, _N_RISING)
    share = (rise - _T_A) / (t_b - _T_A)
    rising = plateau * (eta * share + (1.0 - share) / _F_A)
    falling = eta * second * np.array([1.0 / t_c, 1.0 / t_d, t_d / _EC8_2024_END**2])
    periods = np.concatenate(([0.0], rise, [t_c, t_d, _EC8_2024_END]))
    where = f"site {site}" if amplification is None else f"F = {of_alpha:.3g}, {of_beta:.3g}"
    name = f"EC8 2024, {where}, S_α {alpha / GRAVITY:.3g} g, S_β {beta / GRAVITY:.3g} g"
    return TargetSpectrum(periods, np.concatenate(([plateau / _F_A], rising, falling)), zeta, name)


def _site_amplification(alpha: float, beta: float, site: str, given: tuple[float, float] | None) -> tuple[float, float]:
    if given is not None:
        if site != "A":
            raise InputError(
                f"site={shown(site)} and amplification were both given. Give one: amplification takes the place of the "
                "default factors of a site category.",
                field="amplification",
            )
        factors = checked_finite_vector("amplification", given, "")
        if factors.size != 2 or factors.min() <= 0.0:
            raise InputError(
                f"amplification must be the two positive factors F_α and F_β, but {shown(given)} was given.",
                field="amplification",
            )
        return float(factors[0]), float(factors[1])
    if not is_one_of(site, _EC8_2024_SITES):
        raise InputError(
            f"site must be one of {', '.join(_EC8_2024_SITES)}, a site category of EN 1998-1-1:2024, but {shown(site)} "
            "was given. For E and F, and with a measured shear wave velocity, give amplification=(F_α, F_β).",
            field="site",
        )
    (top, slope), (second, fall) = _EC8_2024_SITES[site]
    of_alpha, of_beta = top * (1.0 - slope * alpha / GRAVITY), second * (1.0 - fall * beta / GRAVITY)
    if min(of_alpha, of_beta) < 1.0:
        raise InputError(
            f"For s_alpha = {alpha:g} m/s² and s_beta = {beta:g} m/s² the default factors of site category {site} are "
            f"F_α = {of_alpha:.3g} and F_β = {of_beta:.3g}, below 1. Give the site's own: amplification=(F_α, F_β).",
            field="site",
        )
    return of_alpha, of_beta
