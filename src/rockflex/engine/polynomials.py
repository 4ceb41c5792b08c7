"""Values and first zeros of polynomials q[0] + q[1] t + .., t from 0 to 1. Declarations: `polynomials.pxd`."""

from math import fabs, sqrt

import cython

if cython.compiled:
    from cython.cimports.libc.math import fabs, sqrt

NEVER = cython.declare(cython.double, 2.0)
APART = cython.declare(cython.double, 1e-9)  # between two peaks
NOTHING = cython.declare(cython.double, 1e-18)  # of the magnitudes of all terms: one that is left out


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


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def positive_for(p: cython.double, slope: cython.double, bend: cython.double) -> cython.double:
    """The positive zero of p + slope d - bend d²/2 for p > 0, computed without cancellation."""
    root: cython.double = sqrt(slope * slope + 2.0 * bend * p)
    if slope < 0.0:
        return 2.0 * p / (root - slope)
    return (root + slope) / bend if bend > 0.0 else NEVER


@cython.ccall
@cython.nogil
@cython.exceptval(check=False)
def first_fall(
    q: cython.double[::1], shift: cython.int, terms: cython.int, start: cython.double, stop: cython.double
) -> cython.double:
    """The first zero in [start, stop] of the polynomial q[shift], q[shift + 1], .., positive at the start; or NEVER.

    With |q''| <= bend, q(t + d) >= q + q' d - bend d²/2, which is positive up to the step taken: no zero is passed.
    Where the bound in [0, 1] would allow a short step only, as where q begins like t⁵, that in [0, 2t] is tried.
    """
    k: cython.int
    p: cython.double
    slope: cython.double
    step: cython.double
    near: cython.double
    bend: cython.double = 0.0
    t: cython.double = start
    for k in range(2, terms):
        bend += k * (k - 1) * fabs(q[shift + k])
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
    when: cython.double = 0.0
    most: cython.double
    sign: cython.double = 1.0 if one_sided else 0.0
    size: cython.double = 0.0
    for k in range(terms):
        if sign == 0.0:
            sign = 1.0 if q[k] > 0.0 else -1.0 if q[k] < 0.0 else 0.0
        q[k] *= sign
        size += fabs(q[k]) if k > 0 else 0.0
    while terms > 1 and fabs(q[terms - 1]) <= NOTHING * size:
        terms -= 1
    most = q[0] if one_sided else fabs(q[0])
    while t < stop and terms > 1:
        t += APART
        sign = 0.0
        for k in range(terms - 1, 0, -1):
            sign = sign * t + k * q[k]
        sign = 1.0 if sign >= 0.0 else -1.0
        for k in range(1, terms):
            slope[k - 1] = sign * k * q[k]
        t = min(first_fall(slope, 0, terms - 1, t, stop), stop)
        size = value(q, terms, t)
        size = size if one_sided else fabs(size)
        if size > most:
            most, when = size, t
    return most, when
