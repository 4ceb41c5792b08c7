"""The vector field of nonlinear models that slide or stand on springs, and its conditions. Declarations: `.pxd`.

The state is that of `rockflex.models.StateLayout`; the equations are in docs/theory/ground.md. With a reference point
of the base, its pivot on rigid ground and the axis of the masses on springs, at X along the ground and Z above it, and
with A_x = (X'' + a) cos θ - (Z'' + a_v + g) sin θ and A_z = (X'' + a) sin θ + (Z'' + a_v + g) cos θ

    D'' + 2 ζ ω D' + ω² D + h* θ'' - (D - o) θ'² + A_x = 0
    I θ'' + Σ m* h* D'' + 2 θ' Σ m* (D - o) D' + L A_x - U A_z = Q_θ
    m A_x + L θ'' + Σ m* D'' - U θ'² = Q_x,      m A_z - U θ'' - 2 U' θ' - L θ'² = Q_z

along and across the base, whose reference point is at the distance o from the axis, with U = Σ m* D - m o. For small
rotations only the terms of first order in θ remain, as in Eq. 23. Cython compiles this module; it runs as Python, too.
"""

from math import cos, fabs, sin

import cython
import numpy as np

from rockflex.models._elements import DAMPING, DRAG, FORCE, MOMENT, PULL, STIFFNESS

if cython.compiled:
    from cython.cimports.libc.math import NAN, cos, fabs, sin
    from cython.cimports.rockflex.engine.field import Field
    from cython.cimports.rockflex.models._fields import RockingField
else:
    from rockflex.engine.field import Field
    from rockflex.models._fields import RockingField

    NAN = float("nan")

P_MOMENT = cython.declare(cython.int, MOMENT)
P_STIFFNESS = cython.declare(cython.int, STIFFNESS)
P_DAMPING = cython.declare(cython.int, DAMPING)
P_FORCE = cython.declare(cython.int, FORCE)
P_PULL = cython.declare(cython.int, PULL)
P_DRAG = cython.declare(cython.int, DRAG)

# Columns of the springs and of the elements on springs.
X = cython.declare(cython.int, 0)
K = cython.declare(cython.int, 1)
C = cython.declare(cython.int, 2)
RUBS = cython.declare(cython.int, 3)
LOADS = cython.declare(cython.int, 4)
CONSTANT = cython.declare(cython.int, 3)
RECALL = cython.declare(cython.int, 4)
AT_ZERO = cython.declare(cython.int, 5)

# Kinds of conditions, each times a factor.
GRIP, PRESSURE, PUSH, DEPTH, STRETCH, SPEED = range(6)
C_GRIP = cython.declare(cython.int, GRIP)  # friction that there is, and the factor times the horizontal force
C_PRESSURE = cython.declare(cython.int, PRESSURE)
C_PUSH = cython.declare(cython.int, PUSH)  # of a spring
C_DEPTH = cython.declare(cython.int, DEPTH)  # height of the base above it
C_STRETCH = cython.declare(cython.int, STRETCH)  # an elongation below a limit
C_SPEED = cython.declare(cython.int, SPEED)  # the rate of one

# Kinds of outputs, see `rockflex.models._quantities`.
SWAY = cython.declare(cython.int, 1)
LEFT_OUT = cython.declare(cython.int, 2)
SWING = cython.declare(cython.int, 3)
HORIZONTAL = cython.declare(cython.int, 4)
VERTICAL = cython.declare(cython.int, 5)
LIFT = cython.declare(cython.int, 6)
CLIMB = cython.declare(cython.int, 7)


@cython.cclass
class GroundField(Field):
    """N modes and a base that slides, or stands on springs, in one phase.

    Parameters
    ----------
    numbers
        Of the model: see `FieldNumbers`.
    phase
        What moves and what acts: see `rockflex.models._nonlinear_ground.GroundPhase`.
    stops
        Limits of rotations on rigid ground: see `RockingField`.
    checks : list
        For each condition that is not linear: its event, its kind, the number of a spring or an element, a factor, and
        of a limit of an elongation its place, the factor of an internal variable and the place of that in the state.
    """

    def __init__(self, numbers, phase, stops, checks):
        p, b, layout = numbers.properties, numbers.bouc_wen, numbers.layout
        self.about = RockingField(numbers, phase.side, phase.branch, phase.pulls, stops)
        self.n, self.side, self.branch, self.complete = p.n_modes, phase.side, phase.branch, numbers.complete
        self.core, self.slip, self.heave, self.memory = layout.core, layout.slip, layout.heave, layout.memory
        self.viscous, self.rubbed, self.soil, self.sweeps = layout.swept, layout.rubbed, layout.soil, layout.sweeps
        self.turns, self.slides, self.way, self.pressed = phase.turns, phase.way != 0, phase.way, phase.pressed
        self.offset, self.inertia = phase.offset, phase.inertia
        self.mass, self.height = np.array(p.effective_mass, dtype=float), np.array(p.effective_height, dtype=float)
        self.omega2, self.drag = p.omega**2, 2.0 * p.zeta * p.omega
        self.modal_mass, self.modal_arm = p.effective_mass.sum(), p.effective_mass @ p.effective_height
        self.modal_inertia = p.effective_mass @ p.effective_height**2
        self.arm, self.mass_all, self.mass_along = p.l0r, p.m_tot, p.horizontal_mass
        self.gravity, self.resting, self.friction = numbers.gravity, numbers.resting, phase.friction
        self.hysteretic, self.stiffness = b is not None, np.array(p.omega**2)
        self.yielding = self.loading = self.gamma = self.beta = 0.0
        if b is not None:
            self.stiffness = b.post_yield_ratio * p.omega**2
            self.yielding = float(p.omega[0] ** 2) * b.yield_displacement * (1.0 - b.post_yield_ratio)
            self.loading, self.gamma, self.beta = 1.0 / b.yield_displacement, b.gamma, b.beta
        self.springs, self.elements = np.array(phase.springs, dtype=float), np.array(phase.elements, dtype=float)
        self.recalled = np.array(phase.recalled, dtype=np.intc)
        self.spring_count, self.element_count = len(phase.springs), len(phase.elements)
        self.kinds, self.levers = np.array(numbers.kinds, dtype=np.intc), np.array(numbers.levers, dtype=float)
        self.kinds_count, self.check_count = len(numbers.kinds), len(checks)
        self.checks = np.array([(*each[:3], each[6]) for each in checks], dtype=np.intc).reshape(-1, 4)
        self.limits = np.array([each[3:6] for each in checks], dtype=float).reshape(-1, 3)

    def gather(self, y, a, a_v):
        """Compute what rates, reactions and outputs have in common."""
        n: cython.int = self.n
        i: cython.int
        theta: cython.double = y[2 * n]
        half: cython.double
        self.spin, self.weight, self.level = y[2 * n + 1], self.gravity + a_v, a
        self.first, self.rotary = -self.mass_all * self.offset, self.inertia
        self.flow = self.swirl = self.turning = self.lifting = self.pull = 0.0
        self.upright = 1.0
        for i in range(n):
            self.flow += self.mass[i] * y[n + i]
        if self.complete:
            self.sine, self.cosine, self.square = sin(theta), cos(theta), self.spin * self.spin
            self.lean, half = self.sine, sin(0.5 * theta)
            self.upright = cos(0.5 * theta)
            for i in range(n):
                self.first += self.mass[i] * y[i]
                self.rotary += self.mass[i] * y[i] * (y[i] - 2.0 * self.offset)
                self.swirl += self.mass[i] * (y[i] - self.offset) * y[n + i]
        else:
            self.sine, self.cosine, self.square, self.lean, half = 0.0, 1.0, 0.0, theta, 0.5 * theta
        if self.spring_count == 0:
            self.pull = self.about.pull(y, P_FORCE) + 2.0 * self.about.pulls[P_PULL, 0] * self.side * half
            self.pull = (self.pull + self.about.pulls[P_DRAG, 0] * self.upright * self.side * self.spin) * self.upright
            if self.side != 0:
                self.turning = -self.side * self.about.pull(y, P_MOMENT) * self.upright
                self.turning -= self.about.pulls[P_DAMPING, 0] * self.upright * self.upright * self.spin
                self.turning -= self.about.pulls[P_STIFFNESS, 0] * self.lean
            return
        for i in range(self.spring_count):
            if self.springs[i, LOADS] > 0.0:
                half = self.push(y, i)
                self.turning -= self.springs[i, X] * self.cosine * half
                self.lifting += half
        for i in range(self.element_count):
            half = self.tension(y, i)
            self.turning += self.elements[i, X] * self.cosine * half
            self.lifting -= half

    def push(self, y, j):
        """The force that a spring would have if it were loaded."""
        x: cython.double = self.springs[j, X]
        depth: cython.double = y[self.heave] - x * self.lean
        return -self.springs[j, K] * depth - self.springs[j, C] * (y[self.heave + 1] - x * self.cosine * self.spin)

    def tension(self, y, e):
        """The tension of an element on springs."""
        x: cython.double = self.elements[e, X]
        delta: cython.double = y[self.heave] - x * self.lean + self.elements[e, AT_ZERO]
        force: cython.double = self.elements[e, K] * delta + self.elements[e, CONSTANT]
        force += self.elements[e, C] * (y[self.heave + 1] - x * self.cosine * self.spin)
        if self.recalled[e] >= 0:
            force += self.elements[e, RECALL] * y[self.recalled[e]]
        return force

    def grip(self, y):
        """The friction of the springs that are loaded."""
        j: cython.int
        total: cython.double = 0.0
        for j in range(self.spring_count):
            if self.springs[j, LOADS] > 0.0:
                total += self.springs[j, RUBS] * self.push(y, j)
        return total

    def rates(self, y, a, a_v, out, counted):
        """Compute the rates of the states: D'' eliminated, two or three equations for the base are left."""
        n: cython.int = self.n
        i: cython.int
        across: cython.double
        beyond: cython.double = self.arm - self.modal_arm
        spring: cython.double = 0.0
        pushed: cython.double = 0.0
        turned: cython.double = 0.0
        # The matrix of θ'', X'' and Z'', and the other side.
        m11: cython.double = 1.0
        m12: cython.double = 0.0
        m13: cython.double = 0.0
        m21: cython.double = 0.0
        m22: cython.double = 1.0
        m23: cython.double = 0.0
        m33: cython.double = 1.0
        b1: cython.double = 0.0
        b2: cython.double = 0.0
        b3: cython.double = 0.0
        drag: cython.double
        turn: cython.double
        shift: cython.double = 0.0
        climb: cython.double = 0.0
        self.gather(y, a, a_v)
        across = a * self.cosine - self.weight * self.sine
        if self.hysteretic:
            spring = self.restoring(y, out, counted)
        for i in range(n):
            out[i] = y[n + i]
            out[n + i] = self.square * (y[i] - self.offset) - self.stiffness[i] * y[i] - self.drag[i] * y[n + i]
            out[n + i] -= across + spring
            pushed += self.mass[i] * out[n + i]
            turned += self.mass[i] * self.height[i] * out[n + i]
        # The reaction across the ground without accelerations of the base.
        drag = self.pull + self.mass_all * self.weight + (self.first * self.sine - self.arm * self.cosine) * self.square
        drag -= self.sine * pushed
        if self.complete:
            drag -= 2.0 * self.flow * self.spin * self.cosine
        if self.turns:
            m11 = self.rotary - self.modal_inertia
            b1 = self.turning - self.arm * (a * self.cosine - self.weight * self.lean) - turned
            b1 += self.first * (a * self.sine + self.weight * self.cosine) - 2.0 * self.spin * self.swirl
        if self.slides:
            m22 = self.mass_along - self.modal_mass * self.cosine * self.cosine
            b2 = (
                (self.first * self.cosine + self.arm * self.sine) * self.square
                - self.mass_along * a
                - self.cosine * pushed
            )
            if self.complete:
                b2 += 2.0 * self.flow * self.spin * self.sine
            if self.turns:
                m12 = m21 = beyond * self.cosine - self.first * self.sine
            if self.spring_count > 0:
                b2 -= self.way * self.grip(y)
            elif self.pressed:
                m22 += self.way * self.friction * self.modal_mass * self.sine * self.cosine
                b2 -= self.way * self.friction * drag
                if self.turns:
                    m21 -= self.way * self.friction * (beyond * self.sine + self.first * self.cosine)
        if self.heave >= 0:
            m33 = self.mass_all - self.modal_mass * self.sine * self.sine
            m13 = -beyond * self.sine - self.first * self.cosine
            m23 = self.modal_mass * self.sine * self.cosine if self.slides else 0.0
            b3 = self.lifting - drag
        # Elimination in the order of θ, X, Z; only friction on rigid ground, where there is no Z, is not symmetric.
        turn = m21 / m11
        m22 -= turn * m12
        b2 -= turn * b1
        if self.pressed and not m22 > 0.0:  # no acceleration satisfies Coulomb's law
            m22 = NAN
        if self.heave >= 0:
            m23 -= turn * m13
            m33 -= m13 * m13 / m11 + m23 * m23 / m22
            climb = (b3 - m13 / m11 * b1 - m23 / m22 * b2) / m33
        shift = (b2 - m23 * climb) / m22
        turn = (b1 - m12 * shift - m13 * climb) / m11
        for i in range(n):
            out[n + i] += self.sine * climb - self.cosine * shift - self.height[i] * turn
        out[2 * n], out[2 * n + 1] = self.spin, turn
        if self.slip >= 0:
            out[self.slip], out[self.slip + 1] = y[self.slip + 1], shift
        if self.heave >= 0:
            out[self.heave], out[self.heave + 1] = y[self.heave + 1], climb
        if counted:
            # What the ground carries follows from the accelerations that have been found.
            across, drag = self.reactions(out)
            if self.rubbed >= 0:
                out[self.rubbed] = 0.0
                if self.slides and self.spring_count > 0:
                    out[self.rubbed] = self.way * self.grip(y) * y[self.slip + 1]
                elif self.slides and self.pressed:
                    out[self.rubbed] = self.way * self.friction * drag * y[self.slip + 1]
            self.enter_energies(y, a, a_v, out)

    def restoring(self, y, out, counted):
        """The share of z in the restoring acceleration of the one mode, Eq. 37; its rate is that of Eq. 38."""
        z: cython.double = y[self.core]
        part: cython.double = self.yielding * z
        lean: cython.double = self.beta + (self.branch * self.gamma if z >= 0.0 else -self.branch * self.gamma)
        out[self.core] = y[1] * self.loading * (1.0 - lean * self.about.power(fabs(z)))
        if counted:
            out[self.core + 3] = self.mass[0] * part * y[1]
        return part

    def enter_energies(self, y, a, a_v, out):
        """Rates of the damped energy, of the work of the ground, and of what dashpots and viscous dampers sweep."""
        n: cython.int = self.n
        i: cython.int
        damped: cython.double = 0.0
        along: cython.double = (self.flow + self.arm * self.spin) * self.cosine - self.first * self.spin * self.sine
        upwards: cython.double = -(self.arm * self.spin + (self.flow if self.complete else 0.0)) * self.lean
        rate: cython.double
        if self.turns:
            upwards -= self.first * self.spin * self.cosine
        if self.slip >= 0:
            along += self.mass_along * y[self.slip + 1]
        if self.heave >= 0:
            upwards += self.mass_all * y[self.heave + 1]
        for i in range(n):
            damped += self.mass[i] * self.drag[i] * y[n + i] * y[n + i]
        out[self.core + 1], out[self.core + 2] = damped, -a * along - a_v * upwards
        if not self.hysteretic:
            out[self.core] = out[self.core + 3] = 0.0
        if self.viscous >= 0:
            out[self.viscous] = self.upright * self.upright * self.spin * self.spin if self.turns else 0.0
        for i in range(self.spring_count):
            rate = y[self.heave + 1] - self.springs[i, X] * self.cosine * self.spin
            along = y[self.heave] - self.springs[i, X] * self.lean
            if self.springs[i, LOADS] > 0.0:
                out[self.soil + i] = self.springs[i, C] * rate * rate
            else:  # a spring that recedes gives up what it still stores
                out[self.soil + i] = self.springs[i, LOADS] * self.springs[i, K] * along * rate
        for i in range(self.element_count):
            rate = y[self.heave + 1] - self.elements[i, X] * self.cosine * self.spin
            out[self.sweeps + i] = rate * rate

    def reactions(self, rates):
        """The forces of the ground on the base, along it and across it; on springs the second is that of all masses."""
        n: cython.int = self.n
        i: cython.int
        pushed: cython.double = 0.0
        turn: cython.double = rates[2 * n + 1]
        flow: cython.double = 2.0 * self.flow * self.spin if self.complete else 0.0
        along: cython.double = self.level
        upwards: cython.double = self.weight
        for i in range(n):
            pushed += self.mass[i] * rates[n + i]
        if self.slip >= 0:
            along += rates[self.slip + 1]
        if self.heave >= 0:
            upwards += rates[self.heave + 1]
        along = (
            self.mass_along * along + (self.arm * self.cosine - self.first * self.sine) * turn + self.cosine * pushed
        )
        along -= (self.first * self.cosine + self.arm * self.sine) * self.square + flow * self.sine
        upwards = (
            self.mass_all * upwards - (self.arm * self.sine + self.first * self.cosine) * turn - self.sine * pushed
        )
        upwards += (self.first * self.sine - self.arm * self.cosine) * self.square - flow * self.cosine
        return along, upwards + self.pull

    def sizes(self, y, a, a_v, out):
        """Compute the magnitudes of the terms of the rates of D, D', θ, θ', the slip, the heave and z."""
        n: cython.int = self.n
        i: cython.int
        fall: cython.double = fabs(a) + self.gravity + fabs(a_v)
        reach: cython.double = fabs(self.offset)
        spring: cython.double = 0.0
        pushed: cython.double
        moment: cython.double
        turn: cython.double = 0.0
        shift: cython.double = 0.0
        climb: cython.double = 0.0
        self.gather(y, a, a_v)
        pushed, moment = self.mass_all * fall + fabs(self.pull), fabs(self.turning) + self.arm * fall
        for i in range(self.spring_count):
            shift = self.springs[i, K] * fabs(y[self.heave]) + self.springs[i, C] * fabs(y[self.heave + 1])
            pushed += shift
            moment += shift * fabs(self.springs[i, X])
        shift = 0.0
        if self.hysteretic:
            spring = self.yielding * fabs(y[self.core])
            out[self.core] = fabs(y[1]) * self.loading
            out[self.core] *= 1.0 + (self.gamma + fabs(self.beta)) * self.about.power(fabs(y[self.core]))
        for i in range(n):
            out[i] = fabs(y[n + i])
            out[n + i] = fall + spring + self.stiffness[i] * fabs(y[i]) + self.drag[i] * out[i]
            out[n + i] += self.square * (fabs(y[i]) + reach)
            moment += self.mass[i] * (
                self.height[i] * out[n + i] + (fabs(y[i]) + reach) * (fall + fabs(self.spin) * out[i])
            )
            pushed += self.mass[i] * out[n + i]
        if self.turns:
            turn = moment / fabs(self.rotary - self.modal_inertia)
        if self.slides:
            shift = (
                pushed / fabs(self.mass_along - self.modal_mass * self.cosine * self.cosine)
                + fabs(self.arm / self.mass_all) * turn
            )
        if self.heave >= 0:
            climb = pushed / (self.mass_all - self.modal_mass * self.sine * self.sine)
        for i in range(n):
            out[n + i] += self.height[i] * turn + shift + fabs(self.sine) * climb
        out[2 * n], out[2 * n + 1] = fabs(self.spin), turn
        if self.slip >= 0:
            out[self.slip], out[self.slip + 1] = fabs(y[self.slip + 1]), shift
        if self.heave >= 0:
            out[self.heave], out[self.heave + 1] = fabs(y[self.heave + 1]), climb

    def conditions(self, y, rates, a, a_v, out):
        """Replace the conditions that are not linear."""
        k: cython.int
        kind: cython.int
        j: cython.int
        found: cython.double
        along: cython.double
        upwards: cython.double
        self.gather(y, a, a_v)
        along, upwards = self.reactions(rates)
        for k in range(self.check_count):
            kind, j = self.checks[k, 1], self.checks[k, 2]
            found = 0.0
            if kind == C_GRIP:
                found = self.grip(y) if self.spring_count > 0 else self.friction * upwards
                out[self.checks[k, 0]] = found + self.limits[k, 0] * along
                continue
            if kind == C_PRESSURE:
                found = upwards
            elif kind == C_PUSH:
                found = self.push(y, j)
            elif kind == C_DEPTH:
                found = y[self.heave] - self.springs[j, X] * self.lean
            elif kind == C_STRETCH:
                found = self.limits[k, 1] - (
                    y[self.heave] - self.elements[j, X] * self.lean + self.elements[j, AT_ZERO]
                )
                if self.checks[k, 3] >= 0:
                    found += self.limits[k, 2] * y[self.checks[k, 3]]
            elif kind == C_SPEED:
                found = y[self.heave + 1] - self.elements[j, X] * self.cosine * self.spin
            out[self.checks[k, 0]] = self.limits[k, 0] * found

    def observe(self, y, rates, a, a_v, out):
        """Replace the outputs that are not linear in large rotations: see `rockflex.models._quantities`."""
        n: cython.int = self.n
        j: cython.int
        kind: cython.int
        slip: cython.double = y[self.slip] if self.slip >= 0 else 0.0
        drive: cython.double = a
        fall: cython.double
        along: cython.double
        upwards: cython.double
        self.gather(y, a, a_v)
        fall = self.weight
        along, upwards = self.reactions(rates)
        if self.slip >= 0:
            drive += rates[self.slip + 1]
        if self.heave >= 0:
            fall += rates[self.heave + 1]
        drive = drive * self.cosine - fall * self.sine + self.square * self.offset
        if self.spring_count > 0:
            upwards = 0.0
            for j in range(self.spring_count):
                if self.springs[j, LOADS] > 0.0:
                    upwards += self.push(y, j)
        for j in range(self.kinds_count):
            kind = self.kinds[j]
            if kind == SWAY:
                out[j] = (out[j] - slip) * self.cosine + slip + self.levers[j, 0] * self.sine
                out[j] += self.offset * self.sine * self.sine / (1.0 + self.cosine)
            elif kind == LEFT_OUT:
                out[j] -= self.levers[j, 0] * drive + self.levers[j, 1] * rates[2 * n + 1]
            elif kind == SWING:
                out[j] *= self.upright
            elif kind == HORIZONTAL:
                out[j] = along
            elif kind == VERTICAL:
                out[j] = self.resting - upwards
            elif kind == LIFT:
                out[j] += self.levers[j, 0] * self.sine
            elif kind == CLIMB:
                out[j] = y[self.heave + 1] + (out[j] - y[self.heave + 1]) * self.cosine

    def enter(self, y, more):
        """Add to the conditions what the internal variables of elements on rigid ground say."""
        self.about.enter(y, more)

    def inertia_at(self, y):
        """Return the factor of θ'' at a state, without the slip."""
        return self.about.inertia_at(y)
