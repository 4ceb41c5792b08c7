"""Whether anything can still happen in a phase without excitation. Declarations: `rest.pxd`."""

from math import fabs, hypot, log

import cython
import numpy as np

from rockflex.engine.tables import by_rows

if cython.compiled:
    from cython.cimports.libc.math import fabs, hypot, log

NEVER = cython.declare(cython.double, 1e300)  # s
SOON = cython.declare(cython.double, 1e-9)  # s, or a share that is next to nothing
ROUNDING = cython.declare(cython.double, 1e-12)  # of the magnitudes of its terms: a motion that is nothing but rounding


@cython.final
@cython.cclass
class Decay:
    """The motion of a phase with a = 0 in its modes: y' = Σ V_k w_k e^{λ_k t}.

    Every row approaches C (y - Σ V_k w_k/λ_k) + e, and never gets further away from it than Σ |C V_k w_k/λ_k|; parts
    that do not oscillate stay on their side. States that are held have λ_k = 0 and w_k = 0.
    """

    def __init__(self, phase):
        roots, vectors = (np.asarray(each, dtype=complex) for each in np.linalg.eig(phase.A))
        try:
            inverse, self.parted = np.linalg.inv(vectors), True
        except np.linalg.LinAlgError:  # the modes are not independent
            inverse, self.parted = vectors, False
        rows = np.concatenate((phase.C, np.array([event.row for event in phase.events]).reshape(-1, len(roots))))
        still = np.abs(roots) <= ROUNDING * np.abs(roots).max(initial=1e-300)
        seen = np.where(still, 0.0, by_rows(rows, vectors) / np.where(still, 1.0, roots))
        grows = ~still & (roots.real > ROUNDING * np.abs(roots))
        self.n, self.outputs, self.rows = len(roots), len(phase.C), np.ascontiguousarray(rows)
        self.constants = np.concatenate((phase.e, [event.constant for event in phase.events]))
        self.A, self.c = np.ascontiguousarray(phase.A), np.ascontiguousarray(phase.c)
        self.inverse = np.ascontiguousarray([inverse.real, inverse.imag, np.abs(inverse)])
        self.seen = np.ascontiguousarray([seen.real, seen.imag, np.abs(seen)])
        self.sizes, ends = np.abs(vectors), np.where(still, 0.0, vectors / np.where(still, 1.0, roots))
        self.ends = np.ascontiguousarray([ends.real, ends.imag])
        kinds = np.where(still, 0, np.where(roots.imag == 0.0, 1, 2)) + np.where(grows, 4, 0)
        self.kinds = kinds.astype(np.intc)
        self.swings = bool((still | (roots.imag != 0.0)).all())
        self.fastest = max(float(-roots.real.min(initial=0.0)), SOON)
        self.rate, self.terms, self.parts = np.zeros(self.n), np.zeros(self.n), np.zeros((3, self.n))
        self.size = rows.nbytes + 4 * seen.nbytes + 5 * inverse.nbytes

    def moves(self, kind):
        """Whether a mode that is held (0), or one that grows (4), moves by more than rounding."""
        i: cython.int
        k: cython.int
        for k in range(self.n):
            if (self.kinds[k] == 0) if kind == 0 else (self.kinds[k] >= 4):
                for i in range(self.n):
                    if self.sizes[i, k] * self.parts[2, k] > ROUNDING * self.terms[i]:
                        return True
        return False

    def look(self, j, y):
        """Find where a row ends, what is rounding of it, and how far below, above and to both sides it may get."""
        k: cython.int
        swing: cython.double
        stray: cython.double
        end: cython.double = self.constants[j]
        rounding: cython.double = fabs(self.constants[j])
        below: cython.double = 0.0
        above: cython.double = 0.0
        away: cython.double = 0.0
        for k in range(self.n):
            end += self.rows[j, k] * y[k]
            rounding += fabs(self.rows[j, k] * y[k])
            stray = self.seen[0, j, k] * self.parts[0, k] - self.seen[1, j, k] * self.parts[1, k]
            swing = self.seen[2, j, k] * self.parts[2, k]
            end -= stray
            away += swing
            if self.kinds[k] % 4 == 1:
                below += max(-stray, 0.0)
                above += max(stray, 0.0)
            else:
                below += swing
                above += swing
        return end, ROUNDING * rounding, below, above, away

    def bring_to_rest(self, y):
        """Replace the state, of which `time_to_rest` was asked, by the one about which it will be in the end."""
        i: cython.int
        k: cython.int
        for i in range(self.n):
            for k in range(self.n):
                y[i] -= self.ends[0, i, k] * self.parts[0, k] - self.ends[1, i, k] * self.parts[1, k]

    def time_to_rest(self, y, high, one_sided):
        """Return 0 at rest: no condition can fail any more, and no output exceed its highest value, with a = 0.

        Otherwise a time in which that cannot come, unless another phase does; a tiny one if nothing is known.
        """
        i: cython.int
        j: cython.int
        k: cython.int
        total: cython.double
        other: cython.double
        end: cython.double
        rounding: cython.double
        below: cython.double
        above: cython.double
        away: cython.double
        ratio: cython.double = 0.0
        may_fail: cython.bint = False
        if not self.parted:
            return NEVER
        for i in range(self.n):
            total, other = self.c[i], fabs(self.c[i])
            for k in range(self.n):
                total += self.A[i, k] * y[k]
                other += fabs(self.A[i, k] * y[k])
            self.rate[i], self.terms[i] = total, other
        for i in range(self.n):
            total = other = rounding = 0.0
            for k in range(self.n):
                total += self.inverse[0, i, k] * self.rate[k]
                other += self.inverse[1, i, k] * self.rate[k]
                rounding += self.inverse[2, i, k] * self.terms[k]
            if hypot(total, other) <= ROUNDING * rounding:
                total = other = 0.0
            self.parts[0, i], self.parts[1, i], self.parts[2, i] = total, other, hypot(total, other)
        if self.moves(4):
            return SOON
        for j in range(self.outputs, self.rows.shape[0]):
            end, rounding, below, above, away = self.look(j, y)
            if self.swings and end - away + rounding < 0.0:
                ratio = max(ratio, away / max(end + rounding, SOON * away))
            may_fail = may_fail or (end + rounding if below <= rounding else end - below) < 0.0
        if ratio > 0.0:
            return log(ratio) / self.fastest if ratio < 1.0 / SOON else SOON
        if may_fail or self.moves(0):
            return SOON
        for j in range(self.outputs):
            end, rounding, below, above, away = self.look(j, y)
            if max(below, above) > rounding:
                total = end + above if one_sided[j] > 0.0 else max(end + above, below - end)
                if total > high[j] + rounding:
                    return SOON
        return 0.0


@cython.final
@cython.cclass
class PhaseDecay:
    """How motion fades in the phases in which a free vibration has been asked for its end, for systems of a stack."""

    def __init__(self):
        self.known, self.place, self.which = {}, -1, -1

    def prepare_phase(self, phase, place, which):
        """Take a phase, and its place; look it up, or find how motion fades in it. Returns the memory for that."""
        of_phase, more = self.known.setdefault(place, {}), 0
        if which not in of_phase:
            of_phase[which] = Decay(phase.of(which))
            more = of_phase[which].size
        self.decay, self.place, self.which = of_phase[which], place, which
        return more

    def drop(self, place):
        """Forget a phase, and return the memory that this frees."""
        return sum(decay.size for decay in self.known.pop(place, {}).values())
