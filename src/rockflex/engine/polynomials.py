"""Values and first zeros of polynomials q[0] + q[1] t + .., t from 0 to 1. Declarations: `polynomials.pxd`.

Coefficients whose squares might overflow or vanish are multiplied by a power of two first, which leaves every bit of a
zero as it is: forces have the same peaks in any unit.
"""

from math import fabs, sqrt

import cython

if cython.compiled:
    from cython.cimports.libc.math import INFINITY, fabs, ilogb, ldexp, sqrt
else:
    from math import frexp, ldexp

    INFINITY = float("inf")

    def ilogb(x):
        """The exponent of a number, as in C."""
        return frexp(x)[1] - 1


NEVER = cython.declare(cython.double, 2.0)
APART = cython.declare(cython.double, 1e-9)  # between two peaks
NOTHING = cython.declare(cython.double, 1e-18)  # of the magnitudes of all terms: one that is left out
SMALL = cython.declare(cython.double, 1e-20)  # coefficients of sizes between these are left as they are
LARGE = cython.declare(cython.double, 1e20)


@cython.ccall
@cython.nogil
@cython.exceptval(check=False)
def value(q: cython.double[::1], terms: cython.int, t: cython.double) -> cython.double:
    """The value of a polynomial."""
    total: cython.double = 0.0
    k: cython.int
    for k in range(terms - 1, -1, -1):
        total = total * t + q[k]
    return total


@cython.ccall
@cython.nogil
@cython.exceptval(check=False)
def unit_for(size: cython.double) -> cython.double:
    """The power of two by which a positive size is brought near to 1."""
    return ldexp(1.0, -max(-1000, min(1000, ilogb(size))))


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def unit_of(q: cython.double[::1], shift: cython.int, terms: cython.int) -> cython.double:
    """The power of two by which coefficients of unusual size are multiplied; 0 if they are not finite, or all zero."""
    k: cython.int
    size: cython.double = 0.0
    for k in range(terms):
        if not fabs(q[shift + k]) < INFINITY:
            return 0.0
        size = max(size, fabs(q[shift + k]))
    return unit_for(size) if size > 0.0 else 0.0


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def positive_for(p: cython.double, slope: cython.double, bend: cython.double) -> cython.double:
    """The positive zero of p + slope d - bend d²/2 for p > 0, computed without cancellation."""
    root: cython.double = sqrt(slope * slope + 2.0 * bend * p)
    if slope < 0.0:
        return 2.0 * p / (root - slope)
    return (root + slope) / bend if bend > 0.0 else NEVER


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def bend_of(q: cython.double[::1], shift: cython.int, terms: cython.int) -> cython.double:
    """A bound of the second derivative in [0, 1]."""
    k: cython.int
    bend: cython.double = 0.0
    for k in range(2, terms):
        bend += k * (k - 1) * fabs(q[shift + k])
    return bend


@cython.ccall
@cython.nogil
@cython.exceptval(check=False)
def first_fall(
    q: cython.double[::1], shift: cython.int, terms: cython.int, start: cython.double, stop: cython.double
) -> cython.double:
    """The first zero in [start, stop] of the polynomial q[shift], q[shift + 1], .., positive at the start; or NEVER.

    With |q''| <= bend, q(t + d) >= q + q' d - bend d²/2, which is positive up to the step taken: no zero is passed.
    Where the bound in [0, 1] would allow a short step only, as where q begins like t⁵, that in [0, 2t] is tried.
    Coefficients of unusual size are changed.
    """
    k: cython.int
    p: cython.double
    slope: cython.double
    step: cython.double
    near: cython.double
    bend: cython.double = bend_of(q, shift, terms)
    t: cython.double = start
    near = fabs(q[shift]) + (fabs(q[shift + 1]) if terms > 1 else 0.0) + bend
    if not SMALL < near < LARGE:
        near = unit_of(q, shift, terms)
        if near == 0.0:
            return NEVER
        for k in range(terms):
            q[shift + k] *= near
        bend = bend_of(q, shift, terms)
    while True:
        p = slope = 0.0
        for k in range(terms - 1, -1, -1):
            slope = slope * t + p
            p = p * t + q[shift + k]
        if not p > 0.0:
            return t
        step = positive_for(p, slope, bend)
        if step < t:
            near = 0.0
            for k in range(terms - 1, 1, -1):
                near = near * (2.0 * t) + k * (k - 1) * fabs(q[shift + k])
            step = max(step, min(t, positive_for(p, slope, near)))
        if t + step > stop:
            return NEVER
        if t + step <= t:
            return t
        t += step


@cython.ccall
@cython.nogil
@cython.exceptval(check=False)
def highest_of(
    q: cython.double[::1], slope: cython.double[::1], terms: cython.int, stop: cython.double, one_sided: cython.bint
) -> tuple[cython.double, cython.double]:
    """The highest value in [0, stop], or magnitude unless one-sided, and where it is; q and slope are changed.

    The polynomial is turned so that it begins upwards: a mirrored motion has the same peaks.
    """
    k: cython.int
    t: cython.double = 0.0
    before: cython.double
    apart: cython.double = APART
    when: cython.double = 0.0
    most: cython.double
    unit: cython.double = 1.0
    sign: cython.double = 1.0 if one_sided else 0.0
    size: cython.double = 0.0
    for k in range(terms):
        if sign == 0.0:
            sign = 1.0 if q[k] > 0.0 else -1.0 if q[k] < 0.0 else 0.0
        q[k] *= sign
        size += fabs(q[k]) if k > 0 else 0.0
    if not SMALL < size < LARGE:
        unit, size = unit_of(q, 0, terms), 0.0
        if unit == 0.0:
            return q[0] if one_sided else fabs(q[0]), 0.0
        for k in range(terms):
            q[k] *= unit
            size += fabs(q[k]) if k > 0 else 0.0
    while terms > 1 and fabs(q[terms - 1]) <= NOTHING * size:
        terms -= 1
    most = q[0] if one_sided else fabs(q[0])
    while t < stop and terms > 1:
        before = t = t + apart
        sign = 0.0
        for k in range(terms - 1, 0, -1):
            sign = sign * t + k * q[k]
        sign = 1.0 if sign >= 0.0 else -1.0
        for k in range(1, terms):
            slope[k - 1] = sign * k * q[k]
        t = min(first_fall(slope, 0, terms - 1, t, stop), stop)
        apart = APART if t > before else 2.0 * apart  # where all is rounding, no more than some steps are taken
        size = value(q, terms, t)
        size = size if one_sided else fabs(size)
        if size > most:
            most, when = size, t
    return most / unit, when
