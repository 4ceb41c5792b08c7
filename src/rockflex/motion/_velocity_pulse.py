"""Near-fault velocity pulses."""

import math

import numpy as np

from rockflex._checks import finite, positive, real_or_nan
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._pulses import intervals, named_pulse


def mavroeidis_papageorgiou_pulse(
    amplitude: float, period: float, gamma: float, nu: float, dt: float = 0.005
) -> GroundMotion:
    """Near-fault velocity pulse: a cosine under a raised-cosine envelope, differentiated in closed form.

    With τ from the centre, |τ| <= γ T_p/2, and w = 2π τ/T_p, the velocity is
    v = (A/2) [1 + cos(w/γ)] cos(w + ν) and the acceleration
    a = -(π A/(γ T_p)) {sin(w/γ) cos(w + ν) + γ [1 + cos(w/γ)] sin(w + ν)}.

    Parameters
    ----------
    amplitude : float
        Amplitude A of the velocity in m/s.
    period : float
        Prevailing period T_p = 1/f_p in s.
    gamma : float
        Oscillatory character γ > 1: the length of the pulse in periods.
    nu : float
        Phase ν in rad: 0 for a velocity symmetric about the centre, ±π/2 for an antisymmetric one.
    dt : float
        Largest allowed sampling step in s.

    Returns
    -------
    GroundMotion
        The sampled acceleration, γ T_p long.

    Raises
    ------
    InputError
        If `period` or `dt` is not positive, `gamma` not above 1, or `amplitude` or `nu` not finite.

    References
    ----------
    Mavroeidis & Papageorgiou (2003), Bull. Seism. Soc. Am. 93(3), 1099-1131, Eqs. 3 and 4.

    Examples
    --------
    >>> import rockflex as rf
    >>> pulse = rf.mavroeidis_papageorgiou_pulse(amplitude=1.0, period=2.0, gamma=1.5, nu=0.0)
    >>> round(pulse.pgv, 3)
    1.0
    """
    positive("period", period, "s")
    if not 1 < real_or_nan(gamma) < math.inf:
        raise InputError(f"gamma must be finite and above 1, but {shown(gamma)} was given. Usual values are 1 to 3.")
    finite("nu", nu, "rad")
    n, step = intervals("period", gamma * period, dt)
    envelope = np.pi * np.linspace(-1, 1, n + 1)
    carrier = gamma * envelope + nu
    rate = np.sin(envelope) * np.cos(carrier) + gamma * (1 + np.cos(envelope)) * np.sin(carrier)
    with np.errstate(over="ignore", invalid="ignore"):  # samples that are not finite are rejected later
        shape = -np.pi / (gamma * period) * rate
    detail = f"T={period:g} s, gamma={gamma:g}, nu={nu:g}"
    return named_pulse("Mavroeidis-Papageorgiou", amplitude, shape, step, detail, unit="m/s")
