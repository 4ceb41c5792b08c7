"""Elastic spectra of EN 1998-1:2004 and ASCE 7-16 as targets."""

import math

import numpy as np

from rockflex._checks import one_of, positive, real_or_nan
from rockflex._constants import GRAVITY
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.motion._target import TargetSpectrum

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


def ec8_spectrum(
    ag: float,
    ground: str = "A",
    kind: int = 1,
    *,
    importance: float = 1.0,
    damping_ratio: float = 0.05,
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

    Returns
    -------
    TargetSpectrum
        The spectrum from 0 to 4 s.

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
    if not one_of(ground, table):
        raise InputError(
            f"ground must be one of {', '.join(table)}, the ground type of EN 1998-1, but {shown(ground)} was given. "
            "Ground of type S1 or S2 needs a study of its own, whose spectrum is a table: TargetSpectrum(periods, sa).",
            field="ground",
        )
    reference = positive("ag", ag, "m/s²")
    base = TargetSpectrum([0.0, 1.0], [1.0, 1.0], damping_ratio)  # checks the damping ratio
    eta = max(math.sqrt(10.0 / (5.0 + 100.0 * base.damping_ratio)), 0.55)
    soil, t_b, t_c, t_d = table[ground]
    zero = positive("importance", importance, "") * reference * soil
    top = 2.5 * eta * zero
    sa = [zero, top, top, top * t_c / t_d, top * t_c * t_d / _EC8_END**2]
    name = f"EC8 type {int(kind)}, ground {ground}, {zero / soil / GRAVITY:.3g} g"
    return TargetSpectrum([0.0, t_b, t_c, t_d, _EC8_END], sa, base.damping_ratio, name)


def asce7_spectrum(sds: float, sd1: float, tl: float, *, mce: bool = False) -> TargetSpectrum:
    """Design spectrum of ASCE 7-16, 11.4.6, or the risk-targeted maximum considered one (11.4.7).

    With T_0 = 0.2 S_D1/S_DS and T_S = S_D1/S_DS:

    - 0 <= T <= T_0: S_a = S_DS (0.4 + 0.6 T/T_0)
    - T_0 <= T <= T_S: S_a = S_DS
    - T_S <= T <= T_L: S_a = S_D1/T
    - T_L <= T: S_a = S_D1 T_L/T²

    Parameters
    ----------
    sds, sd1 : float
        Design spectral accelerations S_DS, at short periods, and S_D1, at 1 s, in m/s²: multiply the g of maps by 9.81.
    tl : float
        Long-period transition T_L of the maps, in s.
    mce : bool
        Multiply by 1.5, which gives the spectrum of the risk-targeted maximum considered earthquake, MCE_R.

    Returns
    -------
    TargetSpectrum
        The spectrum from 0 to 100 s, for 5 % damping.

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
    short, second, long = positive("sds", sds, "m/s²"), positive("sd1", sd1, "m/s²"), positive("tl", tl, "s")
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

    Returns
    -------
    TargetSpectrum
        The spectrum of `asce7_spectrum`.

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
    >>> (target.at([0.3, 1.0]) / 9.81).round(3)  # 2/3 · 1.2 · 1.5 and 2/3 · 1.4 · 0.6
    array([1.2 , 0.56])
    """
    if not one_of(site, (*_FA, "default")):
        raise InputError(
            f'site must be one of A, B, C, D, E or "default", the site class of ASCE 7-16, but {shown(site)} was given.'
            " Class F needs an analysis of the site.",
            field="site",
        )
    short, second = positive("ss", ss, "m/s²") / GRAVITY, positive("s1", s1, "m/s²") / GRAVITY
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
