"""Exact peaks of a damped oscillator under an acceleration that is linear between samples."""

import math

from rockflex._arrays import Array
from rockflex._kernel import kernel, python_kernel


@kernel
def unit_responses(omega: float, zeta: float, t: float) -> tuple[float, float, float, float]:
    """Responses of u'' + 2ζω u' + ω² u = f, from rest, at time t: s', s (impulse), ∫s (step), ∫∫s (ramp)."""
    if t == 0:
        return 1.0, 0.0, 0.0, 0.0
    x = omega * t
    if x < 0.5:
        # Power series of s: for small ωt the closed forms of step and ramp suffer from cancellation.
        before, term = 0.0, t
        rate, impulse, step, ramp = 0.0, 0.0, 0.0, 0.0
        for k in range(1, 22):
            rate += k * term / t
            impulse += term
            step += term * t / (k + 1)
            ramp += term * t * t / ((k + 1) * (k + 2))
            before, term = term, -(2 * zeta * x * k * term + x * x * before) / (k * (k + 1))
        return rate, impulse, step, ramp
    omega_d = omega * math.sqrt(1 - zeta * zeta)
    decay = math.exp(-zeta * x)
    impulse = decay * math.sin(omega_d * t) / omega_d
    rate = decay * math.cos(omega_d * t) - zeta * omega * impulse
    step = (1 - rate - 2 * zeta * omega * impulse) / omega**2
    ramp = (t - 2 * zeta * omega * step - impulse) / omega**2
    return rate, impulse, step, ramp


@kernel
def _state(
    omega: float, zeta: float, u: float, v: float, a: float, slope: float, t: float
) -> tuple[float, float, float]:
    """Relative displacement, velocity and acceleration a time t after the state (u, v)."""
    rate, impulse, step, ramp = unit_responses(omega, zeta, t)
    u1 = (rate + 2 * zeta * omega * impulse) * u + impulse * v - a * step - slope * ramp
    v1 = rate * v - omega * omega * impulse * u - a * impulse - slope * step
    return u1, v1, -(a + slope * t) - 2 * zeta * omega * v1 - omega * omega * u1


@kernel
def _stationary(
    omega: float, zeta: float, u: float, v: float, a: float, slope: float, low: float, high: float
) -> float:
    """Return the displacement at the zero of the velocity, which is monotonic and changes sign in (low, high)."""
    t, best = 0.5 * (low + high), u
    rising = _state(omega, zeta, u, v, a, slope, low)[1] < 0
    for _ in range(60):
        best, v1, w1 = _state(omega, zeta, u, v, a, slope, t)
        if (v1 < 0) == rising:
            low = t
        else:
            high = t
        guess = t - v1 / w1 if w1 != 0 else low
        # The displacement is flat here: 1e-9 of the bracket leaves an error of 1e-18 of its curvature.
        if abs(guess - t) <= 1e-9 * (high - low) or high - low <= 1e-9 * high:
            break
        t = guess if low < guess < high else 0.5 * (low + high)
    return best


@kernel
def peaks_inside(
    omega: float, zeta: float, u: float, v: float, a: float, slope: float, dt: float, sd: float, sv: float
) -> tuple[float, float]:
    """Largest |u| and |v| within one interval.

    The forcing is linear there, so the relative acceleration is a free vibration: its zeros are equally
    spaced and known in closed form. They divide the interval into parts in which v is monotonic.
    """
    omega_d = omega * math.sqrt(1 - zeta * zeta)
    w = -a - 2 * zeta * omega * v - omega * omega * u
    dw = -slope - 2 * zeta * omega * w - omega * omega * v
    # w(t) = exp(-ζωt) (w cos ω_d t + q sin ω_d t)
    q = (dw + zeta * omega * w) / omega_d
    size = math.hypot(w, q)
    low, v_low = 0.0, v
    zero = math.atan2(-w, q) / omega_d
    if zero <= 0:
        zero += math.pi / omega_d
    end_u, end_v, _ = _state(omega, zeta, u, v, a, slope, dt)
    # The forced part of u is the line through p0 and p1; its slope is the forced part of v.
    p0 = (-a + 2 * zeta / omega * slope) / (omega * omega)
    p1 = p0 - slope * dt / (omega * omega)
    while low < dt:
        high = min(zero, dt)
        v_high = end_v
        if zero < dt:
            _, v_high, _ = _state(omega, zeta, u, v, a, slope, zero)
        sv = max(sv, abs(v_high))
        if v_low * v_high < 0:
            sd = max(sd, abs(_stationary(omega, zeta, u, v, a, slope, low, high)))
        low, v_low = high, v_high
        zero += math.pi / omega_d
        rest = size * math.exp(-zeta * omega * low) / (omega * omega)
        bound_u = max(abs(p0), abs(p1)) + rest
        bound_v = abs(slope) / (omega * omega) + omega * rest
        if bound_u <= sd and bound_v <= sv:
            break
    return max(sd, abs(end_u)), max(sv, abs(end_v))


@python_kernel
def oscillator_peaks(acceleration: Array, dt: float, omega: float, zeta: float) -> tuple[float, float]:
    """Largest |u| and |u'| of u'' + 2ζω u' + ω² u = -a(t), from rest, over the record."""
    rate, impulse, step, ramp = unit_responses(omega, zeta, dt)
    keep = rate + 2 * zeta * omega * impulse
    omega_d = omega * math.sqrt(1 - zeta * zeta)
    turns_once = omega_d * dt < math.pi  # between two samples the relative acceleration has one zero at most
    u, v, sd, sv = 0.0, 0.0, 0.0, 0.0
    w = -acceleration[0]
    for k in range(acceleration.size - 1):
        a, b = acceleration[k], acceleration[k + 1]
        slope = (b - a) / dt
        u1 = keep * u + impulse * v - a * step - slope * ramp
        v1 = rate * v - omega * omega * impulse * u - a * impulse - slope * step
        w1 = -b - 2 * zeta * omega * v1 - omega * omega * u1
        end_u, end_v = max(abs(u), abs(u1)), max(abs(v), abs(v1))
        if turns_once and w * w1 > 0 and v * v1 > 0:  # v and u are monotonic
            sd, sv = max(sd, end_u), max(sv, end_v)
        else:
            # Bounds on the curvature decide whether a new peak can occur between the two samples.
            q = (-slope - zeta * omega * w - omega * omega * v) / omega_d
            size = math.hypot(w, q)
            if end_u + size * dt * dt / 8 > sd or end_v + size * dt / 2 > sv:
                sd, sv = peaks_inside(omega, zeta, u, v, a, slope, dt, sd, sv)
        u, v, w = u1, v1, w1
    return sd, sv
