"""Analytical pulses, sampled so that their corners coincide with samples.

The step used is the largest one up to `dt` that divides the pulse (half of the window for Ricker pulses)
into whole intervals: length / ceil(length/dt - 1e-9). A step that already divides the pulse is used as it
is. Between samples the motion is linear, as in all motions.
"""

import math
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from rockflex.foundation.checks import checked_finite, checked_positive, is_one_of, real_or_nan
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.motion._ground_motion import GroundMotion

Float = NDArray[np.floating[Any]]

# Peak of |x (x² - 3)| exp(-x²/2), at x² = 3 - √6: the published β = 1.3801, to all digits.
_BETA = math.sqrt(6 * (3 - math.sqrt(6))) * math.exp(-(3 - math.sqrt(6)) / 2)

MAX_SAMPLES = 100_000_000  # samples


def ricker_pulse(
    amplitude: float, period: float, dt: float = 0.005, kind: Literal["antisymmetric", "symmetric"] = "antisymmetric"
) -> GroundMotion:
    """Ricker wavelet: the second (symmetric) or third (antisymmetric) derivative of a Gaussian.

    With t from the centre of the pulse, u = √2 π t/T_p and x = 2π t/(√3 T_p),

    - symmetric: a_p (1 - u²) exp(-u²/2), with its peak a_p at the centre;
    - antisymmetric: (a_p/β) x (x² - 3) exp(-x²/2), with peaks ±a_p at x² = 3 - √6 and β = 1.3801.

    The window is three (symmetric) or four (antisymmetric) periods long, with the centre on its middle
    sample; the truncated part is below 2e-8 of the peak. The net velocity is zero. The antisymmetric peak
    lies between samples, so `pga` is below the amplitude by at most about 4 (dt/T_p)² of it.

    Parameters
    ----------
    amplitude : float
        Peak acceleration a_p in m/s²; negative values reverse the pulse.
    period : float
        Period T_p in s.
    dt : float
        Largest allowed sampling step in s.
    kind : {"antisymmetric", "symmetric"}
        Form of the wavelet.

    Raises
    ------
    InputError
        If `period` or `dt` is not positive, `amplitude` not finite, or `kind` unknown.

    References
    ----------
    Ricker (1943), Geophysics 8(4); Vassiliou & Makris (2011), Bull. Seism. Soc. Am. 101(2), 596-618.

    Examples
    --------
    >>> import rockflex as rf
    >>> rf.ricker_pulse(amplitude=3.0, period=1.0, kind="symmetric")
    GroundMotion('Ricker symmetric 3 m/s², T=1 s', 601 samples, dt=0.005 s, duration=3 s, pga=3 m/s²)
    """
    if not is_one_of(kind, ("antisymmetric", "symmetric")):
        raise InputError(f'kind must be "antisymmetric" or "symmetric", but {shown(kind)} was given.')
    checked_positive("period", period, "s")
    periods = 2.0 if kind == "antisymmetric" else 1.5
    n, step = pulse_intervals("period", periods * period, dt)
    turns = np.arange(-n, n + 1) * (periods / n)
    if kind == "symmetric":
        u2 = 2 * (np.pi * turns) ** 2
        shape = (1 - u2) * np.exp(-u2 / 2)
    else:
        x = 2 * np.pi / math.sqrt(3) * turns
        shape = x * (x**2 - 3) * np.exp(-(x**2) / 2) / _BETA
    return named_pulse(f"Ricker {kind}", amplitude, shape, step, f"T={period:g} s")


def one_sine_pulse(amplitude: float, period: float, dt: float = 0.005) -> GroundMotion:
    """One full sine, a_p sin(2π t/T_p) for 0 <= t <= T_p: zero net velocity, net displacement a_p T_p²/(2π).

    Parameters
    ----------
    amplitude : float
        Peak acceleration a_p in m/s².
    period : float
        Period T_p in s, the length of the pulse.
    dt : float
        Largest allowed sampling step in s; peaks coincide with samples if the step divides T_p/4.

    Raises
    ------
    InputError
        If `period` or `dt` is not positive, or `amplitude` not finite.

    Examples
    --------
    >>> import rockflex as rf
    >>> rf.one_sine_pulse(amplitude=3.0, period=1.0)
    GroundMotion('One sine 3 m/s², T=1 s', 201 samples, dt=0.005 s, duration=1 s, pga=3 m/s²)
    """
    n, step = pulse_intervals("period", period, dt)
    return named_pulse("One sine", amplitude, _sine_samples(n, 1.0), step, f"T={period:g} s")


def one_cosine_pulse(amplitude: float, period: float, dt: float = 0.005) -> GroundMotion:
    """One full cosine, a_p cos(2π t/T_p) for 0 <= t <= T_p: zero net velocity and displacement.

    The jumps at both ends are represented exactly: the motion starts with the first sample at t = 0, and the
    acceleration is zero after the last sample.

    Parameters
    ----------
    amplitude : float
        Peak acceleration a_p in m/s².
    period : float
        Period T_p in s, the length of the pulse.
    dt : float
        Largest allowed sampling step in s.

    Raises
    ------
    InputError
        If `period` or `dt` is not positive, or `amplitude` not finite.

    Examples
    --------
    >>> import rockflex as rf
    >>> rf.one_cosine_pulse(amplitude=3.0, period=1.0)
    GroundMotion('One cosine 3 m/s², T=1 s', 201 samples, dt=0.005 s, duration=1 s, pga=3 m/s²)
    """
    n, step = pulse_intervals("period", period, dt)
    return named_pulse("One cosine", amplitude, np.cos(2 * np.pi * np.arange(n + 1) / n), step, f"T={period:g} s")


def half_sine_pulse(amplitude: float, duration: float, dt: float = 0.005) -> GroundMotion:
    """Half a sine, a_p sin(π t/t_p) for 0 <= t <= t_p: net velocity 2 a_p t_p/π.

    Parameters
    ----------
    amplitude : float
        Peak acceleration a_p in m/s².
    duration : float
        Length t_p of the pulse in s: half of the sine's period.
    dt : float
        Largest allowed sampling step in s.

    Raises
    ------
    InputError
        If `duration` or `dt` is not positive, or `amplitude` not finite.

    Examples
    --------
    >>> import rockflex as rf
    >>> rf.half_sine_pulse(amplitude=3.0, duration=0.5)
    GroundMotion('Half sine 3 m/s², t=0.5 s', 101 samples, dt=0.005 s, duration=0.5 s, pga=3 m/s²)
    """
    n, step = pulse_intervals("duration", duration, dt)
    return named_pulse("Half sine", amplitude, _sine_samples(n, 0.5), step, f"t={duration:g} s")


def rectangular_pulse(amplitude: float, duration: float, dt: float = 0.005) -> GroundMotion:
    """Constant acceleration a_p for 0 <= t <= t_p: net velocity a_p t_p.

    Exact for any step: the motion starts with the first sample at t = 0, and the acceleration is zero after the
    last sample, so equal samples are a rectangle with a jump at both ends.

    Parameters
    ----------
    amplitude : float
        Acceleration a_p in m/s².
    duration : float
        Length t_p of the pulse in s.
    dt : float
        Largest allowed sampling step in s.

    Raises
    ------
    InputError
        If `duration` or `dt` is not positive, or `amplitude` not finite.

    Examples
    --------
    >>> import rockflex as rf
    >>> pulse = rf.rectangular_pulse(amplitude=3.0, duration=0.5)
    >>> round(pulse.pgv, 3)
    1.5
    """
    n, step = pulse_intervals("duration", duration, dt)
    return named_pulse("Rectangle", amplitude, np.ones(n + 1), step, f"t={duration:g} s")


def quiet_motion(duration: float, dt: float = 0.005) -> GroundMotion:
    """Return ground at rest, for free vibration.

    Parameters
    ----------
    duration : float
        Length in s.
    dt : float
        Largest allowed sampling step in s.

    Raises
    ------
    InputError
        If `duration` or `dt` is not positive.

    Examples
    --------
    >>> import rockflex as rf
    >>> rf.quiet_motion(duration=10.0)
    GroundMotion('Quiet t=10 s', 2001 samples, dt=0.005 s, duration=10 s, pga=0 m/s²)
    """
    n, step = pulse_intervals("duration", duration, dt)
    return GroundMotion(np.zeros(n + 1), step, name=f"Quiet t={duration:g} s")


def pulse_intervals(name: str, length: float, dt: float) -> tuple[int, float]:
    """Return the number of intervals of a pulse and the sampling step in s."""
    length, dt = checked_positive(name, length, "s"), checked_positive("dt", dt, "s")
    # Two intervals at least: a motion has three samples or more.
    if length / dt > MAX_SAMPLES:
        raise InputError(
            f"{name} = {length:g} s with dt = {dt:g} s requires {length / dt:.3g} samples; use a larger dt."
        )
    n = max(2, math.ceil(length / dt - 1e-9))
    return n, dt if math.isclose(n * dt, length, rel_tol=1e-9) else length / n


def _sine_samples(n: int, turns: float) -> Float:
    shape = np.sin(2 * np.pi * turns * np.arange(n + 1) / n)
    shape[-1] = 0.0
    return shape


def named_pulse(kind: str, amplitude: float, shape: Float, dt: float, detail: str, unit: str = "m/s²") -> GroundMotion:
    """Return the motion of a shape times an amplitude, named after both."""
    amplitude = checked_finite("amplitude", amplitude, unit)
    with np.errstate(over="ignore"):  # samples that are not finite are rejected later
        samples = amplitude * shape
    return GroundMotion(samples, dt, name=f"{kind} {amplitude:g} {unit}, {detail}")


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
    >>> pulse = rf.mavroeidis_papageorgiou_pulse(amplitude=1.0, period=2.0,
    ...     gamma=1.5, nu=0.0)
    >>> round(pulse.pgv, 3)
    1.0
    """
    checked_positive("period", period, "s")
    if not 1 < real_or_nan(gamma) < math.inf:
        raise InputError(f"gamma must be finite and above 1, but {shown(gamma)} was given. Usual values are 1 to 3.")
    checked_finite("nu", nu, "rad")
    n, step = pulse_intervals("period", gamma * period, dt)
    envelope = np.pi * np.linspace(-1, 1, n + 1)
    phase = gamma * envelope + nu
    rate = np.sin(envelope) * np.cos(phase) + gamma * (1 + np.cos(envelope)) * np.sin(phase)
    with np.errstate(over="ignore", invalid="ignore"):  # samples that are not finite are rejected later
        shape = -np.pi / (gamma * period) * rate
    detail = f"T={period:g} s, gamma={gamma:g}, nu={nu:g}"
    return named_pulse("Mavroeidis-Papageorgiou", amplitude, shape, step, detail, unit="m/s")
