"""Peaks of linear oscillators under an acceleration that is linear between samples, in closed form.

The motion relative to the ground solves u'' + 2ζω u' + ω² u = -a(t), from rest. Between two samples it is a straight
line and a free vibration, so that no time step is too long: any frequency and any sampling give exact peaks.
"""

from math import atan, cos, exp, fabs, hypot, pi, sin, sqrt

import cython
import numpy as np

if cython.compiled:
    from cython.cimports.cpython.exc import PyErr_CheckSignals
    from cython.cimports.libc.math import atan, cos, exp, fabs, hypot, sin, sqrt
    from cython.cimports.rockflex.engine import levels
else:
    from rockflex.engine import loops as levels
    from rockflex.engine.loops import PyErr_CheckSignals

PI = cython.declare(cython.double, pi)
ENDLESS = cython.declare(cython.double, np.inf)
SHORT = cython.declare(cython.double, 0.5)  # ωt below which power series replace closed forms, which would cancel
TERMS = cython.declare(cython.int, 16)  # of these series: the next one is below 0.5¹⁶/16! of the first
STRETCH = cython.declare(cython.Py_ssize_t, 1 << 22)  # samples between two looks at Ctrl-C: some 20 ms
PIECE = cython.declare(cython.Py_ssize_t, 1 << 14)  # samples that are counted at once
WITHIN = cython.declare(cython.Py_ssize_t, 32)  # samples that a part of one in which the motion is searched counts like
COARSE = cython.declare(cython.Py_ssize_t, 256)  # samples from which peaks in all directions are first estimated
BEYOND = cython.declare(cython.double, 1.0 + 1e-14)  # for bounds that hold in spite of rounding


def peaks(acceleration, h, frequencies, zeta):
    """Largest |u| and |u'| during a record, those between samples included.

    Parameters
    ----------
    acceleration : ndarray, shape (n,)
        In m/s².
    h : float
        Time step in s.
    frequencies : ndarray, shape (m,)
        Circular frequencies ω > 0 in rad/s.
    zeta : float
        Fraction of critical damping, 0 <= ζ < 1.

    Returns
    -------
    ndarray, shape (m, 2)
        In m and m/s. They do not depend on the other frequencies.
    """
    a: cython.double[::1] = np.array(acceleration, dtype=float)
    omegas: cython.double[::1] = np.array(frequencies, dtype=float)
    motion: cython.double[:, :, ::1] = np.zeros((2, a.shape[0], levels.TOGETHER))
    factors: cython.double[:, ::1] = np.empty((levels.FACTORS, levels.TOGETHER))
    places: cython.Py_ssize_t[:, ::1] = np.empty((levels.TOGETHER, min(PIECE, a.shape[0]) + 1), dtype=np.intp)
    found = np.empty((omegas.shape[0], 2))
    out: cython.double[:, ::1] = found
    oscillator: Oscillator = Oscillator(h, zeta)
    i: cython.Py_ssize_t
    with cython.nogil:
        for i in range(0, omegas.shape[0], 8):  # TOGETHER, as a number: the sign of a step must be known
            oscillator.peaks(a, omegas[i : i + levels.TOGETHER], factors, motion, places, out[i : i + levels.TOGETHER])
    return found


def states(acceleration, h, frequency, zeta, shift):
    """The states (u, u') at every sample but the last one, and the same time after each.

    Parameters
    ----------
    acceleration, h, zeta
        As in `peaks`.
    frequency : float
        Circular frequency ω > 0 in rad/s.
    shift : float
        Time in s after the samples, 0 < shift <= h.

    Returns
    -------
    ndarray, shape (4, n - 1)
        In m and m/s: u and u' at the samples, and after them.
    """
    a: cython.double[::1] = np.array(acceleration, dtype=float)
    found = np.empty((4, max(a.shape[0] - 1, 0)))
    out: cython.double[:, ::1] = found
    motion: cython.double[:, :, ::1] = np.zeros((2, a.shape[0], levels.TOGETHER))
    factors: cython.double[:, ::1] = np.empty((levels.FACTORS, levels.TOGETHER))
    oscillator: Oscillator = Oscillator(h, zeta)
    impulse: cython.double
    step: cython.double
    ramp: cython.double
    slope: cython.double
    k: cython.Py_ssize_t
    oscillator.tune(frequency)
    impulse, step, ramp = oscillator.responses(shift)
    with cython.nogil:
        for k in range(levels.TOGETHER):
            oscillator.write_factors(factors[:, k])
        oscillator.march(a, factors, motion)
        for k in range(a.shape[0] - 1):
            slope = (a[k + 1] - a[k]) / oscillator.h
            out[0, k], out[1, k] = motion[0, k, 0], motion[1, k, 0]
            out[2, k], out[3, k] = oscillator.moved(impulse, step, ramp, out[0, k], out[1, k], a[k], slope)
            if k % PIECE == 0:
                oscillator.check_stop_request(PIECE)
    return found


def rotated_peaks(first, second, h, frequencies, zeta, angles):
    """Largest |u| under a₁ cos φ + a₂ sin φ during a record, those between samples included.

    Parameters
    ----------
    first, second : ndarray, shape (n,)
        Accelerations a₁ and a₂ in m/s².
    h, frequencies, zeta
        As in `peaks`.
    angles : ndarray, shape (k,)
        Directions φ in rad.

    Returns
    -------
    ndarray, shape (m, k)
        In m. They do not depend on the other frequencies and directions.

    Raises
    ------
    ValueError
        If the accelerations are not of the same length.
    """
    a: cython.double[:, ::1] = np.array((first, second), dtype=float)
    omegas: cython.double[::1] = np.array(frequencies, dtype=float)
    turns: cython.double[:, ::1] = np.array((np.cos(angles), np.sin(angles)))
    motion: cython.double[:, ::1] = np.empty((5, a.shape[1]))
    several: cython.double[:, :, ::1] = np.zeros((2, a.shape[1], levels.TOGETHER))
    factors: cython.double[:, ::1] = np.empty((levels.FACTORS, levels.TOGETHER))
    found = np.zeros((omegas.shape[0], turns.shape[1]))
    out: cython.double[:, ::1] = found
    oscillator: Oscillator = Oscillator(h, zeta)
    i: cython.Py_ssize_t
    with cython.nogil:
        for i in range(omegas.shape[0]):
            oscillator.tune(omegas[i])
            oscillator.rotated(a, turns, factors, several, motion, out[i])
    return found


@cython.final
@cython.cclass
class Oscillator:
    """An oscillator of one damping and time step, tuned to one frequency after the other."""

    h: cython.double
    zeta: cython.double
    omega: cython.double
    square: cython.double  # ω²
    drag: cython.double  # 2ζω
    damped: cython.double  # circular frequency of the free vibration
    bend: cython.double  # largest distance from the chord of a curve, and of the velocity's, for u'' up to 1
    sway: cython.double
    turns_once: cython.bint  # whether u'' changes its sign at most once between two samples
    impulse: cython.double  # the responses at the next sample
    step: cython.double
    ramp: cython.double
    sd: cython.double  # the largest |u| and |u'| so far
    sv: cython.double
    work: cython.Py_ssize_t  # since the last look at Ctrl-C

    def __init__(self, h: cython.double, zeta: cython.double):
        self.h, self.zeta, self.bend, self.work = h, zeta, h * h / 8.0, 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1)
    def check_stop_request(self, work: cython.Py_ssize_t) -> cython.int:
        """After some work, see whether there was Ctrl-C."""
        self.work += work
        if self.work >= STRETCH:
            self.work = 0
            with cython.gil:
                PyErr_CheckSignals()
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def tune(self, omega: cython.double) -> cython.void:
        """Take another frequency."""
        self.omega, self.square, self.drag = omega, omega * omega, 2.0 * self.zeta * omega
        self.damped = omega * sqrt(1.0 - self.zeta * self.zeta)
        self.sway = min(0.5 * self.h, omega * self.bend)  # |u'''| is not larger than ω |u''|
        self.turns_once = self.damped * self.h < PI
        self.impulse, self.step, self.ramp = self.responses(self.h)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def responses(self, t: cython.double) -> tuple[cython.double, cython.double, cython.double]:
        """The displacement at t > 0, from rest, under a unit impulse, a unit step and a unit ramp."""
        k: cython.int
        x: cython.double = self.omega * t
        before: cython.double = 0.0
        term: cython.double = t
        impulse: cython.double = 0.0
        step: cython.double = 0.0
        ramp: cython.double = 0.0
        if x < SHORT:
            for k in range(1, TERMS + 1):
                impulse += term
                step += term * t / (k + 1)
                ramp += term * t * t / ((k + 1) * (k + 2))
                before, term = term, -(2.0 * self.zeta * x * k * term + x * x * before) / (k * (k + 1))
            return impulse, step, ramp
        term = exp(-self.zeta * x)
        impulse = term * sin(self.damped * t) / self.damped
        step = (1.0 - term * cos(self.damped * t) - 0.5 * self.drag * impulse) / self.square
        ramp = (t - self.drag * step - impulse) / self.square
        return impulse, step, ramp

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def state(
        self, t: cython.double, u: cython.double, v: cython.double, a: cython.double, slope: cython.double
    ) -> tuple[cython.double, cython.double, cython.double]:
        """Displacement, velocity and relative acceleration at t > 0 after (u, v), under a + slope t."""
        impulse: cython.double
        step: cython.double
        ramp: cython.double
        impulse, step, ramp = self.responses(t)
        u, v = self.moved(impulse, step, ramp, u, v, a, slope)
        return u, v, self.acceleration(u, v, a + slope * t)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def moved(
        self,
        impulse: cython.double,
        step: cython.double,
        ramp: cython.double,
        u: cython.double,
        v: cython.double,
        a: cython.double,
        slope: cython.double,
    ) -> tuple[cython.double, cython.double]:
        """Displacement and velocity after (u, v), under a + slope t, by the responses at that time."""
        force: cython.double = a + self.square * u
        return (
            u + (impulse * v - step * force - ramp * slope),
            v - (impulse * (force + self.drag * v) + step * (self.square * v + slope)),
        )

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def acceleration(self, u: cython.double, v: cython.double, a: cython.double) -> cython.double:
        """The relative acceleration u''."""
        return -a - self.drag * v - self.square * u

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def quadrature(self, w: cython.double, v: cython.double, slope: cython.double) -> cython.double:
        """What gives u''(t) = exp(-ζωt) (w cos ω_d t + q sin ω_d t), a free vibration, from (u'', u') at a sample."""
        return -(slope + 0.5 * self.drag * w + self.square * v) / self.damped

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def write_factors(self, to: cython.double[:]) -> cython.void:
        """Write what the march of this oscillator among others takes of it; its peaks are zero."""
        u1: cython.double = self.ramp / self.h
        v1: cython.double = self.step / self.h
        uu: cython.double = self.square * self.step
        to[levels.UU], to[levels.UV], to[levels.U0], to[levels.U1] = uu, self.impulse, self.step - u1, u1
        to[levels.VU], to[levels.VV] = self.square * self.impulse, self.drag * self.impulse + uu
        to[levels.V0], to[levels.V1] = self.impulse - v1, v1
        to[levels.SQUARE], to[levels.DRAG], to[levels.SWAY], to[levels.SPREAD] = (
            self.square,
            self.drag,
            self.sway,
            BEYOND / self.damped,
        )
        to[levels.SD] = to[levels.SV] = 0.0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1)
    def march(
        self, a: cython.double[::1], factors: cython.double[:, ::1], motion: cython.double[:, :, ::1]
    ) -> cython.int:
        """Fill displacements and velocities at the samples, and raise peaks in the factors to those there."""
        us: cython.p_double = cython.address(motion[0, 0, 0]) if a.shape[0] else cython.NULL
        vs: cython.p_double = us + levels.TOGETHER * a.shape[0]
        first: cython.Py_ssize_t = 0
        end: cython.Py_ssize_t
        while first < a.shape[0] - 1:
            end = min(first + PIECE, a.shape[0] - 1)
            levels.LOOPS.oscillate(cython.address(a[0]), first, end, cython.address(factors[0, 0]), us, vs)
            self.check_stop_request(levels.TOGETHER * PIECE // 2)
            first += PIECE
        return 0

    @cython.cfunc
    @cython.inline
    @cython.nogil
    @cython.exceptval(-1)
    def look_after(
        self,
        a: cython.double,
        b: cython.double,
        u: cython.double,
        v: cython.double,
        u1: cython.double,
        v1: cython.double,
    ) -> cython.int:
        """Raise the peaks to those between a sample with (a, u, u') and the next one, with (b, u1, v1)."""
        slope: cython.double = (b - a) / self.h
        w: cython.double = self.acceleration(u, v, a)
        size: cython.double = fabs(w) + fabs(self.quadrature(w, v, slope))  # |u''| is not larger until the next sample
        if (
            max(fabs(u), fabs(u1)) + size * self.bend > self.sd or max(fabs(v), fabs(v1)) + size * self.sway > self.sv
        ) and not self.monotonic(w, v, u1, v1, b):
            self.inside(u, v, a, slope)
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1)
    def peaks(
        self,
        a: cython.double[::1],
        omegas: cython.double[::1],
        factors: cython.double[:, ::1],
        motion: cython.double[:, :, ::1],
        places: cython.Py_ssize_t[:, ::1],
        out: cython.double[:, ::1],
    ) -> cython.int:
        """Fill the largest |u| and |u'| of a few oscillators during a record, with room for what is found.

        The peaks at samples are found first, so that few intervals may have a higher one inside.
        """
        j: cython.Py_ssize_t
        k: cython.Py_ssize_t
        i: cython.Py_ssize_t
        first: cython.Py_ssize_t = 0
        for j in range(levels.TOGETHER):  # the last of fewer is there several times
            self.tune(omegas[min(j, omegas.shape[0] - 1)])
            self.write_factors(factors[:, j])
        self.march(a, factors, motion)
        while first < a.shape[0] - 1:
            look_together(a, self.h, factors, motion, first, min(first + PIECE, a.shape[0] - 1), places)
            self.check_stop_request(levels.TOGETHER * PIECE // 2)
            for j in range(omegas.shape[0]):
                self.tune(omegas[j])
                self.sd, self.sv = factors[levels.SD, j], factors[levels.SV, j]
                for i in range(1, places[j, 0] + 1):
                    k = places[j, i]
                    self.look_after(
                        a[k], a[k + 1], motion[0, k, j], motion[1, k, j], motion[0, k + 1, j], motion[1, k + 1, j]
                    )
                factors[levels.SD, j], factors[levels.SV, j] = self.sd, self.sv
            first += PIECE
        for j in range(omegas.shape[0]):
            out[j, 0], out[j, 1] = factors[levels.SD, j], factors[levels.SV, j]
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def monotonic(
        self, w: cython.double, v: cython.double, u1: cython.double, v1: cython.double, b: cython.double
    ) -> cython.bint:
        """Whether u and u' are, from (u'', u') at a sample to (u, u', a) at the next one."""
        w1: cython.double = self.acceleration(u1, v1, b)
        return (
            self.turns_once
            and ((w > 0.0 and w1 > 0.0) or (w < 0.0 and w1 < 0.0))
            and ((v > 0.0 and v1 > 0.0) or (v < 0.0 and v1 < 0.0))
        )

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1)
    def inside(self, u: cython.double, v: cython.double, a: cython.double, slope: cython.double) -> cython.int:
        """Raise the peaks to those between a sample with the state (u, v) and the next one.

        The zeros of u'', a free vibration, divide the interval into parts in which u' is monotonic.
        """
        w: cython.double = self.acceleration(u, v, a)
        q: cython.double = self.quadrature(w, v, slope)
        size: cython.double = hypot(w, q) / self.square
        # The forced part of u is a line, here at the start of a part and at the end of the interval.
        line: cython.double = (slope * self.drag / self.square - a) / self.square
        fall: cython.double = slope / self.square
        end: cython.double = line - fall * self.h
        low: cython.double = 0.0
        high: cython.double
        v_low: cython.double = v
        v_high: cython.double
        rest: cython.double = size
        # Of w and q alone the ratio is used, so that a mirrored record has the same bits.
        zero: cython.double = (atan(-w / q) if q != 0.0 else 0.5 * PI) / self.damped
        if not zero > 0.0:
            zero += PI / self.damped
        while low < self.h and (
            max(fabs(line - fall * low), fabs(end)) + rest > self.sd or fabs(fall) + self.omega * rest > self.sv
        ):
            self.check_stop_request(WITHIN)
            high = zero if zero < self.h else self.h
            v_high = self.state(high, u, v, a, slope)[1]
            self.sv = max(self.sv, fabs(v_high))
            if (v_low < 0.0 and v_high > 0.0) or (v_low > 0.0 and v_high < 0.0):
                self.sd = max(self.sd, fabs(self.turning(low, high, v_low, u, v, a, slope)))
            low, v_low = high, v_high
            zero += PI / self.damped
            rest = size * exp(-self.zeta * self.omega * low)
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def turning(
        self,
        low: cython.double,
        high: cython.double,
        v_low: cython.double,
        u: cython.double,
        v: cython.double,
        a: cython.double,
        slope: cython.double,
    ) -> cython.double:
        """The displacement at the zero in (low, high) of u', which is monotonic there."""
        _k: cython.int
        t: cython.double = 0.5 * (low + high)
        guess: cython.double
        u1: cython.double = u
        v1: cython.double
        w1: cython.double
        for _k in range(60):
            u1, v1, w1 = self.state(t, u, v, a, slope)
            if (v1 > 0.0 and v_low > 0.0) or (v1 < 0.0 and v_low < 0.0):
                low = t
            else:
                high = t
            guess = t - v1 / w1 if w1 != 0.0 else low
            # u is flat here: 1e-9 of the interval leaves an error of 1e-18 of its curvature.
            if fabs(guess - t) <= 1e-9 * (high - low) or high - low <= 1e-9 * high:
                break
            t = guess if low < guess < high else 0.5 * (low + high)
        return u1

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1)
    def rotated(
        self,
        a: cython.double[:, ::1],
        turns: cython.double[:, ::1],
        factors: cython.double[:, ::1],
        several: cython.double[:, :, ::1],
        motion: cython.double[:, ::1],
        peaks: cython.double[::1],
    ) -> cython.int:
        """Raise peaks from zero to the largest |u| in every direction, with room of five rows for the motion."""
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        last: cython.Py_ssize_t = a.shape[1] - 1
        directions: cython.Py_ssize_t = 2 + peaks.shape[0]
        least: cython.double
        farther: cython.double
        self.check_stop_request(COARSE * directions)
        for k in range(levels.TOGETHER):
            self.write_factors(factors[:, k])
        for i in range(2):
            self.march(a[i], factors, several)
            for k in range(last + 1):
                motion[2 * i, k], motion[2 * i + 1, k] = several[0, k, 0], several[1, k, 0]
        for k in range(last + 1):
            motion[4, k] = hypot(motion[0, k], motion[2, k])
            if k % PIECE == 0:
                self.check_stop_request(2 * PIECE)
        for k in range(min(COARSE, last + 1)):
            self.look_round(k * last // COARSE, turns, motion, peaks)
        # Where the oscillator stays closer than the smallest peak so far, it raises none.
        least = smallest(peaks)
        for k in range(last + 1):
            if k % PIECE == 0:
                self.check_stop_request(PIECE)
            if motion[4, k] > least:
                self.look_round(k, turns, motion, peaks)
                least = smallest(peaks)
                self.check_stop_request(directions)
        for k in range(last):
            if k % PIECE == 0:
                self.check_stop_request(4 * PIECE)
            farther = self.reach(k, a, motion)
            if max(motion[4, k], motion[4, k + 1]) + farther > least:
                self.look_inside(k, farther, a, turns, motion, peaks)
                least = smallest(peaks)
                self.check_stop_request(2 * directions)
        return 0

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def look_round(
        self,
        k: cython.Py_ssize_t,
        turns: cython.double[:, ::1],
        motion: cython.double[:, ::1],
        peaks: cython.double[::1],
    ) -> cython.void:
        """Raise the peaks to those at a sample."""
        j: cython.Py_ssize_t
        for j in range(peaks.shape[0]):
            peaks[j] = max(peaks[j], fabs(turns[0, j] * motion[0, k] + turns[1, j] * motion[2, k]))

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def reach(self, k: cython.Py_ssize_t, a: cython.double[:, ::1], motion: cython.double[:, ::1]) -> cython.double:
        """How much farther than at both ends the oscillator can get between a sample and the next one."""
        i: cython.int
        w: cython.double
        slope: cython.double
        size: cython.double = 0.0
        for i in range(2):
            slope = (a[i, k + 1] - a[i, k]) / self.h
            w = self.acceleration(motion[2 * i, k], motion[2 * i + 1, k], a[i, k])
            size += fabs(w) + fabs(self.quadrature(w, motion[2 * i + 1, k], slope))
        return size * self.bend

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(-1)
    def look_inside(
        self,
        k: cython.Py_ssize_t,
        farther: cython.double,
        a: cython.double[:, ::1],
        turns: cython.double[:, ::1],
        motion: cython.double[:, ::1],
        peaks: cython.double[::1],
    ) -> cython.int:
        """Raise the peaks to those between a sample and the next one."""
        j: cython.Py_ssize_t
        c: cython.double
        s: cython.double
        u: cython.double
        v: cython.double
        u1: cython.double
        v1: cython.double
        a0: cython.double
        a1: cython.double
        for j in range(peaks.shape[0]):
            c, s = turns[0, j], turns[1, j]
            u, u1 = c * motion[0, k] + s * motion[2, k], c * motion[0, k + 1] + s * motion[2, k + 1]
            if max(fabs(u), fabs(u1)) + farther > peaks[j]:
                v, v1 = c * motion[1, k] + s * motion[3, k], c * motion[1, k + 1] + s * motion[3, k + 1]
                a0, a1 = c * a[0, k] + s * a[1, k], c * a[0, k + 1] + s * a[1, k + 1]
                # With an infinite velocity only the displacement decides how far the search goes.
                self.sd, self.sv = peaks[j], ENDLESS
                self.look_after(a0, a1, u, v, u1, v1)
                peaks[j] = self.sd
        return 0


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def smallest(values: cython.double[::1]) -> cython.double:
    """The smallest of some values; infinite if there are none."""
    least: cython.double = ENDLESS
    j: cython.Py_ssize_t
    for j in range(values.shape[0]):
        least = min(least, values[j])
    return least


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def look_together(
    a: cython.double[::1],
    h: cython.double,
    factors: cython.double[:, ::1],
    motion: cython.double[:, :, ::1],
    first: cython.Py_ssize_t,
    last: cython.Py_ssize_t,
    places: cython.Py_ssize_t[:, ::1],
) -> cython.void:
    """For each oscillator, write how many samples there are after which it may exceed its peaks, and which ones."""
    us: cython.p_double = cython.address(motion[0, 0, 0])
    vs: cython.p_double = us + levels.TOGETHER * a.shape[0]
    f: cython.p_double = cython.address(factors[0, 0])
    levels.LOOPS.exceed(cython.address(a[0]), h, first, last, f, us, vs, places.shape[1], cython.address(places[0, 0]))
