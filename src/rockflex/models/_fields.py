"""The vector field of the nonlinear models, what they are observed by, and their jumps. Declarations: `_fields.pxd`.

Equations are those of Silva & Stojadinović 2024: 13 to 15, 23, 37 and 38 for the rates, 3, 21 and 22 for what is
observed, and 19, 25 and 29 for impacts. The state is that of `rockflex.models.StateLayout`. Cython compiles this
module; it runs as Python, too.
"""

import math
from math import asin, cos, fabs, sin, sqrt
from math import pow as power_of

import cython
import numpy as np

from rockflex.models._elements import DAMPING, DRAG, FORCE, HOLD, MOMENT, PULL, STIFFNESS

if cython.compiled:
    from cython.cimports.libc.math import asin, cos, fabs, sin, sqrt
    from cython.cimports.libc.math import pow as power_of
    from cython.cimports.rockflex.engine.field import Field, Jump
else:
    from rockflex.engine.field import Field, Jump

P_MOMENT = cython.declare(cython.int, MOMENT)
P_STIFFNESS = cython.declare(cython.int, STIFFNESS)
P_DAMPING = cython.declare(cython.int, DAMPING)
P_FORCE = cython.declare(cython.int, FORCE)
P_PULL = cython.declare(cython.int, PULL)
P_DRAG = cython.declare(cython.int, DRAG)
GAIN = cython.declare(cython.double, 1e-9)  # relative gain of energy in an impact that is attributed to rounding
CLOSE = cython.declare(cython.double, 1e-13)  # of the terms of a limit
NEVER = cython.declare(cython.double, 10.0)  # rad: no rotation is as large

# Kinds of outputs, see `rockflex.models._quantities`.
LINEAR = cython.declare(cython.int, 0)
SWAY = cython.declare(cython.int, 1)
LEFT_OUT = cython.declare(cython.int, 2)
SWING = cython.declare(cython.int, 3)
HORIZONTAL = cython.declare(cython.int, 4)
VERTICAL = cython.declare(cython.int, 5)

SMALL = cython.declare(cython.double, math.pi / 4)  # rad: the largest rotation for the series
SMALLER = cython.declare(cython.double, 0.125)  # and for fewer terms
# 1/n! with alternating signs, for sin θ = θ + θ³ (S_1 + S_2 θ² + ..) and cos θ = 1 + θ² (C_1 + C_2 θ² + ..); the first
# term left out is below a quarter of rounding.
S1 = cython.declare(cython.double, -1.0 / math.factorial(3))
S2 = cython.declare(cython.double, 1.0 / math.factorial(5))
S3 = cython.declare(cython.double, -1.0 / math.factorial(7))
S4 = cython.declare(cython.double, 1.0 / math.factorial(9))
S5 = cython.declare(cython.double, -1.0 / math.factorial(11))
S6 = cython.declare(cython.double, 1.0 / math.factorial(13))
S7 = cython.declare(cython.double, -1.0 / math.factorial(15))
S8 = cython.declare(cython.double, 1.0 / math.factorial(17))
C1 = cython.declare(cython.double, -1.0 / math.factorial(2))
C2 = cython.declare(cython.double, 1.0 / math.factorial(4))
C3 = cython.declare(cython.double, -1.0 / math.factorial(6))
C4 = cython.declare(cython.double, 1.0 / math.factorial(8))
C5 = cython.declare(cython.double, -1.0 / math.factorial(10))
C6 = cython.declare(cython.double, 1.0 / math.factorial(12))
C7 = cython.declare(cython.double, -1.0 / math.factorial(14))
C8 = cython.declare(cython.double, 1.0 / math.factorial(16))


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def sine_and_cosine(theta: cython.double) -> tuple[cython.double, cython.double]:
    """Sin θ and cos θ, without a call of the C library in every stage of a step; terms in pairs make short chains."""
    x: cython.double = theta * theta
    z: cython.double = x * x
    sine: cython.double
    cosine: cython.double
    if fabs(theta) <= SMALLER:
        sine = (S1 + S2 * x) + z * (S3 + S4 * x)
        cosine = (C1 + C2 * x) + z * ((C3 + C4 * x) + z * C5)
        return theta + theta * x * sine, 1.0 + x * cosine
    if fabs(theta) > SMALL:
        return sin(theta), cos(theta)
    sine = (S1 + S2 * x) + z * ((S3 + S4 * x) + z * ((S5 + S6 * x) + z * (S7 + S8 * x)))
    cosine = (C1 + C2 * x) + z * ((C3 + C4 * x) + z * ((C5 + C6 * x) + z * (C7 + C8 * x)))
    return theta + theta * x * sine, 1.0 + x * cosine


@cython.cclass
class RockingField(Field):
    """N modes and a base in one phase.

    Parameters
    ----------
    side, branch
        Pivot about which the base rotates, 1 right, -1 left, 0 in contact; sign of D'_1 in the law of Bouc and Wen.
    numbers
        Of the model: see `FieldNumbers`.
    pulls : ndarray, shape (7, 1 + M)
        Sums over the elements, see `element_force_sums`.
    stops : list
        For each of the first conditions, what the constant states add to it: whether it is a limit from below (1) or
        above (-1) of |θ|, the index of an internal variable or -1, and of the elongation per unit distance from the
        pivot a part and the factor of the internal variable.
    releases : ndarray, shape (2, 1 + M)
        While friction dampers hold the base at a large rotation: the sums for the moment of the elements in the phases
        in which θ would then grow or fall, which end this one.
    grip : float
        While they hold it, the sum of their tensions for each N m of the moment that they balance, at a small rotation.
    """

    def __init__(self, numbers, side, branch, pulls, stops, releases=None, grip=0.0):
        p, b = numbers.properties, numbers.bouc_wen
        self.n, self.side, self.branch = p.n_modes, side, branch
        self.complete, self.hysteretic, self.viscous = numbers.complete, b is not None, numbers.viscous
        self.omega2, self.drag = p.omega**2, 2.0 * p.zeta * p.omega
        self.height, self.mass = np.array(p.effective_height, dtype=float), np.array(p.effective_mass, dtype=float)
        pivot = p.pivot(side or 1)
        self.offset = side * pivot.arm
        self.lever, self.levers_sum = p.effective_mass * p.effective_height, p.effective_mass @ p.effective_height
        self.left = pivot.i_theta - p.effective_mass @ p.effective_height**2
        self.inverse = 1.0 / self.left
        self.weight_arm, self.total_mass, self.gravity, self.resting = p.l0r, p.m_tot, numbers.gravity, numbers.resting
        self.yields, self.ratio, self.gamma, self.beta, self.exponent = 1.0, 1.0, 0.0, 0.0, 1.0
        if b is not None:
            self.yields, self.ratio, self.gamma, self.beta = b.yield_displacement, b.post_yield_ratio, b.gamma, b.beta
            self.exponent = b.exponent
        self.stiffness, self.loading = self.ratio * p.omega**2, 1.0 / self.yields
        self.slip = float(p.omega[0] ** 2) * self.yields * (1.0 - self.ratio) if b is not None else 0.0
        self.whole = int(self.exponent) if float(self.exponent).is_integer() else 0
        self.pulls, self.memory, self.n_internal = np.array(pulls), numbers.layout.memory, pulls.shape[1] - 1
        self.pulled, self.held = bool(pulls[[MOMENT, FORCE]].any()), bool(pulls[HOLD, 0])
        self.releases, self.grip = np.zeros((2, pulls.shape[1])) if releases is None else np.array(releases), grip
        self.kinds, self.levers = np.array(numbers.kinds, dtype=np.intc), np.array(numbers.levers, dtype=float)
        self.kinds_count, self.stops_count = len(numbers.kinds), len(stops)
        self.stop_kinds = np.array([each[:2] for each in stops], dtype=np.intc).reshape(-1, 2)
        self.stops = np.array([each[2] for each in stops], dtype=float).reshape(-1, 2)

    @property
    def size(self):
        """Number of states."""
        return self.memory + self.n_internal

    def rates(self, y, a, a_v, out, counted):
        """Compute the rates of the states; the compiler makes a copy without loops for a single mode."""
        if self.n == 1:
            self.rates_of(1, y, a, a_v, out, counted)
        else:
            self.rates_of(self.n, y, a, a_v, out, counted)

    def rates_of(self, n, y, a, a_v, out, counted):
        """Compute the rates of the states, n of which are displacements."""
        if self.side == 0:
            self.in_contact(n, y, a, out, counted)
        elif self.complete:
            self.by_large_rotations(n, y, a, a_v, out, counted)
        else:
            self.by_small_rotations(n, y, a, a_v, out, counted)

    def pull(self, y, which):
        """A sum over the elements, with their internal variables."""
        m: cython.int
        total: cython.double = self.pulls[which, 0]
        for m in range(self.n_internal):
            total += self.pulls[which, 1 + m] * y[self.memory + m]
        return total

    def inertia_left(self, y):
        """The factor of θ'' after eliminating D'': I_θ - Σ m* h*², in complete models plus the terms of D."""
        i: cython.int
        total: cython.double = self.left
        if self.complete:
            for i in range(self.n):
                total += self.mass[i] * y[i] * (y[i] - 2.0 * self.offset)
        return total

    def in_contact(self, n, y, a, out, counted):
        """Rates while the base stands still: Eq. 13 or 23 without rotation."""
        i: cython.int
        drive: cython.double = -a
        if self.hysteretic:
            drive -= self.restoring(n, y, out, counted)
        for i in range(n):
            out[i] = y[n + i]
            out[n + i] = drive - self.stiffness[i] * y[i] - self.drag[i] * y[n + i]
        out[2 * n], out[2 * n + 1] = y[2 * n + 1], 0.0
        if counted:
            self.enter_energies(y, 0.0, -a, 0.0, 0.0, out)

    def by_small_rotations(self, n, y, a, a_v, out, counted):
        """Rates of the simplified models while rocking: Eq. 23."""
        i: cython.int
        theta: cython.double = y[2 * n]
        spin: cython.double = y[2 * n + 1]
        across: cython.double = self.total_mass * self.offset - self.weight_arm * theta
        moment: cython.double = (self.gravity + a_v) * across + a * self.weight_arm + self.pulls[P_STIFFNESS, 0] * theta
        drive: cython.double = -a
        turn: cython.double = 0.0
        if self.pulled:
            moment += self.side * self.pull(y, P_MOMENT)
        if self.viscous:
            moment += self.pulls[P_DAMPING, 0] * spin
        if self.hysteretic:
            drive -= self.restoring(n, y, out, counted)
        for i in range(n):
            out[i] = y[n + i]
            out[n + i] = drive - self.stiffness[i] * y[i] - self.drag[i] * y[n + i]
            moment += self.lever[i] * out[n + i]
        if not self.held:
            turn = -moment * self.inverse
        for i in range(n):
            out[n + i] -= self.height[i] * turn
        out[2 * n], out[2 * n + 1] = spin, turn
        if counted:
            self.enter_energies(y, -a * self.weight_arm - a_v * across, -a, spin, spin, out)

    def by_large_rotations(self, n, y, a, a_v, out, counted):
        """Rates of the complete models while rocking: Eqs. 13 and 14, the moment by its parts of sin θ and cos θ."""
        i: cython.int
        spin: cython.double = y[2 * n + 1]
        sine: cython.double
        cosine: cython.double
        square: cython.double = spin * spin
        gravity: cython.double = self.gravity + a_v
        lever: cython.double = 1.0
        displaced: cython.double = 0.0
        moment: cython.double = 0.0
        coriolis: cython.double = 0.0
        spring: cython.double = 0.0
        inertia: cython.double = self.left
        drive: cython.double
        behind: cython.double
        beside: cython.double
        share: cython.double = 0.0
        turn: cython.double
        part: cython.double
        if self.hysteretic:
            spring = self.restoring(n, y, out, counted)
        for i in range(n):
            behind = y[i] - self.offset
            displaced += self.mass[i] * y[i]
            inertia += self.mass[i] * y[i] * (behind - self.offset)
            coriolis += self.mass[i] * behind * y[n + i]
            out[i] = y[n + i]
            part = square * behind - self.stiffness[i] * y[i] - self.drag[i] * y[n + i]
            moment += self.lever[i] * part
            out[n + i] = part
        if not self.held:
            share = -1.0 / inertia
        moment += 2.0 * spin * coriolis - self.levers_sum * spring
        beside = self.total_mass * self.offset - displaced
        drive = self.weight_arm - self.levers_sum
        sine, cosine = sine_and_cosine(y[2 * n])
        # An element is stretched by 2 r sin(|θ|/2) and pulls with the lever arm r cos(θ/2).
        if self.viscous or self.pulled:
            lever = sqrt(0.5 + 0.5 * cosine)
            moment += self.side * self.pull(y, P_MOMENT) * lever + self.pulls[P_DAMPING, 0] * lever * lever * spin
        moment += (a * beside - gravity * drive + self.pulls[P_STIFFNESS, 0]) * sine
        moment += (a * drive + gravity * beside) * cosine
        turn = moment * share
        drive = gravity * sine - a * cosine - spring
        for i in range(n):
            out[n + i] += drive - self.height[i] * turn
        out[2 * n], out[2 * n + 1] = spin, turn
        if counted:
            part = -a * (beside * sine + self.weight_arm * cosine) - a_v * (beside * cosine - self.weight_arm * sine)
            self.enter_energies(y, part, a_v * sine - a * cosine, spin, lever * spin, out)

    def restoring(self, n, y, out, counted):
        """The share of z in the restoring acceleration of the one mode, Eq. 37; its rate is that of Eq. 38.

        With the branch times D' in place of |D'| the law is smooth up to the reversal.
        """
        z: cython.double = y[2 * n + 2]
        slip: cython.double = self.slip * z
        # z |z|^(n-1) |D'| is |z|^n |D'| with the sign of z.
        lean: cython.double = self.beta + (self.branch * self.gamma if z >= 0.0 else -self.branch * self.gamma)
        out[2 * n + 2] = y[n] * self.loading * (1.0 - lean * self.power(fabs(z)))
        if counted:
            out[2 * n + 5] = self.mass[0] * slip * y[n]
        return slip

    def power(self, z):
        """z^n for z >= 0."""
        left: cython.int = self.whole
        power: cython.double = z
        factor: cython.double
        if left == 0:
            return power_of(z, self.exponent)
        while left & 1 == 0:
            power *= power
            left >>= 1
        factor = power
        left >>= 1
        while left > 0:
            factor *= factor
            if left & 1:
                power *= factor
            left >>= 1
        return power

    def enter_energies(self, y, turning, pushing, spin, swing, out):
        """Rates of the damped energy, of the work of the ground on θ and on D, and of what viscous dampers sweep."""
        n: cython.int = self.n
        i: cython.int
        damped: cython.double = 0.0
        carried: cython.double = 0.0
        for i in range(n):
            damped += self.mass[i] * self.drag[i] * y[n + i] * y[n + i]
            carried += self.mass[i] * y[n + i]
        out[2 * n + 3], out[2 * n + 4] = damped, turning * spin + pushing * carried
        if not self.hysteretic:
            out[2 * n + 2] = out[2 * n + 5] = 0.0
        if self.viscous:
            out[2 * n + 6] = swing * swing

    def sizes(self, y, a, a_v, out):
        """Compute the magnitudes of the terms of the rates of D, D', θ, θ' and z."""
        n: cython.int = self.n
        i: cython.int
        spin: cython.double = fabs(y[2 * n + 1])
        theta: cython.double = fabs(y[2 * n]) if self.side != 0 else 0.0
        large: cython.double = 1.0 if self.complete and self.side != 0 else 0.0
        gravity: cython.double = self.gravity + fabs(a_v)
        arm: cython.double = fabs(self.offset)
        moment: cython.double = gravity * (self.total_mass * arm + self.weight_arm * theta)
        part: cython.double
        moment += fabs(a) * self.weight_arm + self.pulls[P_STIFFNESS, 0] * theta + self.pulls[P_DAMPING, 0] * spin
        moment += fabs(self.pulls[P_MOMENT, 0])
        for i in range(self.n_internal):
            moment += fabs(self.pulls[P_MOMENT, 1 + i] * y[self.memory + i])
        for i in range(n):
            out[i] = fabs(y[n + i])
            part = fabs(a) + self.omega2[i] * fabs(y[i]) + self.drag[i] * out[i]
            if self.hysteretic:
                part += self.omega2[i] * self.yields * fabs(y[2 * n + 2])
            part += large * (gravity * theta + spin * spin * (fabs(y[i]) + arm))
            moment += large * self.mass[i] * (gravity * fabs(y[i]) + 2.0 * (fabs(y[i]) + arm) * spin * out[i])
            moment += self.mass[i] * self.height[i] * part
            out[n + i] = part
        moment = 0.0 if self.side == 0 or self.held else moment / fabs(self.inertia_left(y))
        for i in range(n):
            out[n + i] += self.height[i] * moment
        out[2 * n], out[2 * n + 1] = spin, moment
        if self.hysteretic:
            out[2 * n + 2] = (
                fabs(y[n]) / self.yields * (1.0 + (self.gamma + fabs(self.beta)) * self.power(fabs(y[2 * n + 2])))
            )

    def imbalance(self, y, rates, a, a_v):
        """The moment about the pivot that friction dampers balance while they hold the base at a large rotation."""
        n: cython.int = self.n
        i: cython.int
        sine: cython.double
        cosine: cython.double
        gravity: cython.double = self.gravity + a_v
        beside: cython.double = self.total_mass * self.offset
        total: cython.double = 0.0
        sine, cosine = sine_and_cosine(y[2 * n])
        for i in range(n):
            beside -= self.mass[i] * y[i]
            total += self.lever[i] * rates[n + i]
        total += self.weight_arm * (a * cosine - gravity * sine) + beside * (a * sine + gravity * cosine)
        total += self.pulls[P_STIFFNESS, 0] * sine
        return -total - self.side * self.pull(y, P_MOMENT) * sqrt(0.5 + 0.5 * cosine)

    def imbalance_along(self, states, rates, a, a_v):
        """Return `imbalance` at many states, shape (k,)."""
        given: cython.double[:, ::1] = states
        moves: cython.double[:, ::1] = rates
        across: cython.double[::1] = a
        upwards: cython.double[::1] = a_v
        found = np.zeros(len(states))
        total: cython.double[::1] = found
        k: cython.Py_ssize_t
        for k in range(given.shape[0] if states.size else 0):
            if cython.compiled:
                total[k] = self.imbalance(
                    cython.address(given[k, 0]), cython.address(moves[k, 0]), across[k], upwards[k]
                )
            else:
                total[k] = self.imbalance(given[k], moves[k], across[k], upwards[k])
        return found

    def conditions(self, y, rates, a, a_v, out):
        """Replace the conditions under which friction dampers hold the base: by how much both moments fail to turn it.

        The moments are those of the phases that follow, with θ growing and falling.
        """
        m: cython.int
        k: cython.int
        upright: cython.double = cos(0.5 * y[2 * self.n])
        own: cython.double = self.pull(y, P_MOMENT)
        after: cython.double
        moment: cython.double = self.imbalance(y, rates, a, a_v)
        for k in range(2):
            after = self.releases[k, 0] - own
            for m in range(self.n_internal):
                after += self.releases[k, 1 + m] * y[self.memory + m]
            out[k] = self.side * upright * after - moment
            if k == 1:
                out[k] = -out[k]

    def observe(self, y, rates, a, a_v, out):
        """Replace the outputs that are not linear in large rotations: see `rockflex.models._quantities`."""
        n: cython.int = self.n
        i: cython.int
        j: cython.int
        kind: cython.int
        spin: cython.double = y[2 * n + 1]
        turn: cython.double = rates[2 * n + 1]
        sine: cython.double
        cosine: cython.double
        upright: cython.double  # cos θ/2
        square: cython.double = spin * spin
        gravity: cython.double = self.gravity + a_v
        across: cython.double = self.total_mass * self.offset  # Σ m_i (s B - u_i)
        speed: cython.double = 0.0
        push: cython.double = 0.0
        aside: cython.double = 0.0  # forces of the elements
        upwards: cython.double = 0.0
        along: cython.double
        beside: cython.double
        half: cython.double
        coriolis: cython.double
        drive: cython.double
        sine, cosine = sine_and_cosine(y[2 * n])
        upright = sqrt(0.5 + 0.5 * cosine)
        drive = a * cosine - gravity * sine + square * self.offset
        for i in range(n):
            across -= self.mass[i] * y[i]
            speed += self.mass[i] * y[n + i]
            push += self.mass[i] * rates[n + i]
        along = across * cosine - self.weight_arm * sine
        beside = across * sine + self.weight_arm * cosine
        # An element points from its present anchor on the base to its position in contact: at θ/2 from the vertical.
        if self.held or self.pulled or self.pulls[P_PULL, 0] != 0.0 or self.pulls[P_DRAG, 0] != 0.0:
            half = 0.5 * sine / upright
            coriolis = self.pull(y, P_FORCE) + 2.0 * self.pulls[P_PULL, 0] * self.side * half
            coriolis += self.pulls[P_DRAG, 0] * upright * self.side * spin
            if self.held:
                coriolis += self.grip / upright * self.imbalance(y, rates, a, a_v)
            aside, upwards = coriolis * half, coriolis * upright
        coriolis = 2.0 * spin * speed
        for j in range(self.kinds_count):
            kind = self.kinds[j]
            if kind == SWAY:
                out[j] = self.offset * sine * sine / (1.0 + cosine) + self.levers[j, 0] * sine + out[j] * cosine
            elif kind == LEFT_OUT:
                out[j] -= self.levers[j, 0] * drive + self.levers[j, 1] * turn
            elif kind == SWING:
                out[j] *= upright
            elif kind == HORIZONTAL:
                out[j] = self.total_mass * a + (
                    turn * beside + push * cosine - coriolis * sine + square * along + aside
                )
            elif kind == VERTICAL:
                out[j] = self.resting - (
                    self.total_mass * gravity
                    + (turn * along - push * sine - coriolis * cosine - square * beside + upwards)
                )

    def enter(self, y, more):
        """Add to the conditions what the internal variables of the elements say."""
        k: cython.int
        m: cython.int
        kind: cython.int
        memory: cython.double
        limit: cython.double
        for k in range(self.stops_count):
            kind = self.stop_kinds[k, 0]
            m = self.stop_kinds[k, 1]
            memory = 0.0 if m < 0 else y[self.memory + m]
            limit = self.stops[k, 0] + self.stops[k, 1] * memory
            if kind > 0 and limit <= CLOSE * (fabs(self.stops[k, 0]) + fabs(self.stops[k, 1] * memory)):
                more[k] += NEVER  # the base lands first, or at the same instant
                continue
            if self.complete:
                limit = 2.0 * asin(max(0.5 * limit, -1.0)) if limit < 2.0 else NEVER
            more[k] += -limit if kind > 0 else limit

    def inertia_at(self, y):
        """Return the factor of θ'' at a state."""
        state: cython.double[::1] = y
        if cython.compiled:
            return self.inertia_left(cython.address(state[0]))
        return self.inertia_left(state)


@cython.cclass
class LinearTurn(Field):
    """θ'' of a linear phase, for `Landing`: rows over the states, the acceleration and 1, and the second per a_v."""

    def __init__(self, row, vertical, spin):
        self.row, self.vertical = np.array(row, dtype=float), np.array(vertical, dtype=float)
        self.n, self.spin = len(row) - 2, spin

    def rates(self, y, a, a_v, out, counted):
        """Compute θ'' alone."""
        k: cython.int
        total: cython.double = (self.row[self.n] + a_v * self.vertical[self.n]) * a
        total += self.row[self.n + 1] + a_v * self.vertical[self.n + 1]
        for k in range(self.n):
            total += (self.row[k] + a_v * self.vertical[k]) * y[k]
        out[self.spin] = total


@cython.cclass
class Landing(Jump):
    """An impact by a `LandingRule`, after which the base stays in contact, or (`other`) rocks on about the other edge.

    Parameters
    ----------
    gains : callable
        Returns the exception if the rule returns energy.
    properties, side, complete
        The structure, the side that ends, and whether the inertia depends on D.
    rule
        What the law says.
    beyond : Field
        Has θ'' about the other edge.
    size, slip
        Number of states, and the place of the velocity of a base that slides among them; -1 if it does not.
    turnings : list
        The internal variables that are set, as elements cease to yield: place, r, and δ - m.
    """

    def __init__(self, gains, properties, side, complete, rule, beyond, size, slip, turnings):
        p, own, new = properties, properties.pivot(side), properties.pivot(-side)
        self.gains, self.n, self.side, self.complete, self.beyond = gains, p.n_modes, side, complete, beyond
        self.mass, self.height = np.array(p.effective_mass, dtype=float), np.array(p.effective_height, dtype=float)
        self.total_mass, self.modal_inertia = p.m_tot, p.effective_mass @ p.effective_height**2
        self.own_offset, self.own_left = side * own.arm, own.i_theta - p.effective_mass @ p.effective_height**2
        self.new_offset, self.new_left = -side * new.arm, new.i_theta - p.effective_mass @ p.effective_height**2
        self.follows, self.guarded, self.measured = rule.follows, rule.guarded, rule.ratio is not None
        self.passes, self.shortest, self.scaled = rule.ratio or 0.0, rule.shortest_excursion, rule.scaled
        self.unseen = p.translational_inertia - float(p.effective_mass @ p.effective_height**2)
        self.rates, self.slip, self.arm = np.zeros(size), slip, p.l0r
        self.places = np.array([place for place, _, _ in turnings], dtype=np.intc)
        self.offsets = np.array([offset for _, _, offset in turnings], dtype=float)

    def inertia(self, y, left, offset):
        """The inertia of the rotation with free modes about a pivot: I_θ - Σ m* h*², in complete models with D."""
        i: cython.int
        if self.complete:
            for i in range(self.n):
                left += self.mass[i] * y[i] * (y[i] - 2.0 * offset)
        return left

    def energy(self, y, inertia):
        """The kinetic energy at θ = 0, without the inertia terms of D: ½ I_f θ'² + ½ Σ m* (D' + h* θ')²."""
        n: cython.int = self.n
        i: cython.int
        velocity: cython.double
        spin: cython.double = y[2 * n + 1]
        total: cython.double = 0.5 * inertia * spin * spin
        for i in range(n):
            velocity = y[n + i] + self.height[i] * spin
            total += 0.5 * self.mass[i] * velocity * velocity
        return total

    def share(self, y, before, after):
        """θ'_a/θ'_b, from the inertias with free modes; below zero where the guard acts.

        By momentum about the new pivot it is (H - κ K)/(J - κ K), see `LandingRule`.
        """
        i: cython.int
        lean: cython.double = -self.total_mass * self.new_offset  # m s B + U
        locked: cython.double = 0.0 if self.follows else self.modal_inertia
        share: cython.double = self.passes
        spin: cython.double = y[2 * self.n + 1]
        flow: cython.double = 0.0
        lost: cython.double
        if not self.measured:
            for i in range(self.n if self.complete else 0):
                lean += self.mass[i] * y[i]
            share = 1.0 - (self.own_offset - self.new_offset) * lean / (after + locked)
        if self.guarded:
            for i in range(self.n):
                flow += self.mass[i] * self.height[i] * y[self.n + i]
            lost = 0.5 * (before + locked - share * share * (after + locked)) * spin + (1.0 - share) * flow
            if lost * spin < 0.0:
                return -1.0
            if self.slip >= 0 and (lost + (1.0 - share) * self.arm * y[self.slip]) * spin < 0.0:
                return -1.0  # the ground would push the base on as it slides
        elif not self.measured:
            return max(share, 0.0)
        return share

    def apply(self, y, a, a_v):
        """Apply the rule; 1 if rocking goes on, unless the next excursion would be too short to count; 2 if guarded."""
        n: cython.int = self.n
        i: cython.int
        found: cython.int = 0
        moving: cython.double = 0.0
        inertia: cython.double = self.inertia(y, self.own_left, self.own_offset)
        before: cython.double = self.energy(y, inertia)
        spin: cython.double = y[2 * n + 1]
        share: cython.double = self.share(y, inertia, self.inertia(y, self.new_left, self.new_offset))
        follows: cython.bint = self.follows
        passed: cython.double
        if share < 0.0:
            share, follows, found = 0.0, True, 2
        passed = share * spin
        y[2 * n] = 0.0
        for i in range(self.places.shape[0]):
            y[self.places[i]] = -self.offsets[i]
        for i in range(n):
            if follows:
                y[n + i] += self.height[i] * (spin - passed)
            moving += self.mass[i] * y[n + i] * y[n + i]
        if self.scaled and moving > 0.0:
            moving = sqrt(1.0 + self.unseen * spin * spin / moving)
            for i in range(n):
                y[n + i] *= moving
        y[2 * n + 1] = passed
        if passed != 0.0:
            if self.energy(y, self.inertia(y, self.new_left, self.new_offset)) > before * (1.0 + GAIN):
                return -1
            if cython.compiled:
                self.beyond.rates(y, a, a_v, cython.address(self.rates[0]), False)
            else:
                self.beyond.rates(y, a, a_v, self.rates, False)
            if 2.0 * fabs(passed) >= self.side * self.rates[2 * n + 1] * self.shortest:
                return 1
            for i in range(n):
                y[n + i] += self.height[i] * (passed if follows else spin)
            y[2 * n + 1] = 0.0
        return -1 if self.energy(y, 0.0) > before * (1.0 + GAIN) else found

    def error(self):
        """Return the exception after a gain of energy."""
        return self.gains()


@cython.cclass
class Change(Jump):
    """A change of the branches of elements: those that yield keep their plastic stretch; a turn stops the rotation."""

    def __init__(self, rotation, chords, stops, turnings, marks):
        self.rotation, self.chords, self.stops = rotation, chords, stops
        self.places = np.array([place for place, _, _ in turnings], dtype=np.intc)
        self.turnings = np.array([each[1:] for each in turnings], dtype=float).reshape(-1, 2)
        self.marked = np.array([place for place, _ in marks], dtype=np.intc)
        self.marks = np.array([value for _, value in marks], dtype=float)

    def apply(self, y, a, a_v):
        """Set the internal variables."""
        k: cython.int
        stretch: cython.double = fabs(y[self.rotation])
        if self.chords:
            stretch = 2.0 * sin(0.5 * stretch)
        for k in range(self.places.shape[0]):
            y[self.places[k]] = self.turnings[k, 0] * stretch - self.turnings[k, 1]
        for k in range(self.marked.shape[0]):
            y[self.marked[k]] = self.marks[k]
        if self.stops:
            y[self.rotation + 1] = 0.0
        return 0


@cython.cclass
class Reversal(Jump):
    """The velocity of a hysteretic spring changes its sign."""

    def __init__(self, velocity, barely):
        self.velocity, self.barely = velocity, barely

    def apply(self, y, a, a_v):
        """Make it zero exactly, unless an impact has reversed it."""
        if fabs(y[self.velocity]) <= self.barely:
            y[self.velocity] = 0.0
        return 0
