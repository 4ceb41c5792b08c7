"""Follow the tangents of a run from event to event. Declarations: `tangent_pass.pxd`."""

from math import ceil, fabs, floor

import cython
import numpy as np

if cython.compiled:
    from cython.cimports.libc.math import ceil, fabs, floor
    from cython.cimports.rockflex.engine.tangent_steps import Motion, add
else:
    from rockflex.engine.tangent_steps import Motion, add

SAME = cython.declare(cython.double, 1e-9)  # samples: instants that are one


@cython.final
@cython.auto_pickle(False)
@cython.cclass
class Crossing:
    """What an event that leads to a certain phase makes of the state: a matrix J, and its derivatives.

    Both are None where the state is continuous. If `ask` is given, it says them for a state before the event and both
    accelerations: J, and (dJ/dp) y, shape (P, n).
    """

    def __init__(self, jump=None, slopes=None, ask=None):
        self.jump = np.zeros((0, 0)) if jump is None else np.ascontiguousarray(jump.T)
        self.slopes = np.zeros((0, 0, 0)) if slopes is None else np.ascontiguousarray(slopes)
        self.ask = ask


@cython.final
@cython.auto_pickle(False)
@cython.cclass
class Pass:
    """One pass over a run, whose states beside events are known.

    Parameters
    ----------
    motions : sequence of Motion
        By place of the phase; None of those that the run does not meet.
    n, parameters : int
        Numbers of states and of parameters.
    free
        The one parameter is the scale of the record, and the ground moves horizontally alone. Then w = y - s moves as
        without excitation, and is followed in place of s: from event to event in a few steps.
    """

    def __init__(self, motions, n: cython.int, parameters: cython.int, free: cython.bint):
        self.motions, self.n, self.P, self.free = motions, n, parameters, free
        self.x, self.s, self.w, self.none = np.zeros(n + 3), np.zeros(n * parameters), np.zeros(n + 3), np.zeros(0)
        self.before, self.then, self.found = np.zeros(n), np.zeros(n), np.zeros(n * parameters)
        self.x[n + 2] = self.w[n + 2] = 1.0

    def follow(self, trace, crossings, kinds, start, one_sided, observed):
        """Follow the tangents, and return their values at the end; `result` then has what was found.

        `kinds` has the place among the crossings of each event; `observed` the numbers of outputs that are noted at
        samples and beside events.
        """
        n: cython.int = self.n
        width: cython.int = self.n * self.P
        nodes: cython.int = len(trace.times)
        self.times, self.ground, self.rise, self.states, self.high, self.when = (
            np.ascontiguousarray(each)
            for each in (trace.times, trace.ground, trace.rise, trace.states, trace.high, trace.when)
        )
        self.places, self.turns = np.asarray(trace.places, dtype=np.intc), np.asarray(trace.turns, dtype=np.intc)
        self.record, self.vertical, self.h, self.one_sided = trace.record, trace.vertical, trace.h, one_sided
        self.last = self.record.shape[0] - 1
        self.crossings, self.kinds = crossings, np.asarray(kinds, dtype=np.intc)
        near = np.maximum(1e-12 * np.maximum(trace.when, 1.0), 1e-13)
        self.lows = np.searchsorted(trace.times, trace.when - near).astype(np.intc)
        self.highs = np.searchsorted(trace.times, trace.when + near, side="right").astype(np.intc)
        self.order = np.argsort(trace.when).astype(np.intc)
        self.at, self.delays = np.zeros((nodes, width)), np.zeros((nodes + 1, self.P))
        self.follows = np.zeros(nodes + 1, dtype=np.intc)  # 1 + the event before a state
        self.rates, self.peaks = np.full(self.turns.shape[0], np.nan), np.zeros((self.P, self.high.shape[0]))
        self.next, self.kept, self.observed = 0, 0, np.array(observed, dtype=np.intc)
        self.keeps = len(observed) > 0
        k: cython.int
        node: cython.int
        for k in range(self.turns.shape[0]):
            self.follows[self.turns[k, 2]] = k + 1
        room = int(floor(trace.times[nodes - 1])) + 2 + nodes if self.keeps else 0
        self.log = np.zeros((room, 1 + len(observed) * (1 + self.P)))
        self.s = np.array(start, dtype=float).ravel()
        for k in range(n):
            self.w[k] = self.states[0, k] - (self.s[k] if self.free else 0.0)
        for node in range(nodes):
            self.arrive(node)
            if node == nodes - 1:
                break
            if self.follows[node + 1]:
                self.cross(node, self.follows[node + 1] - 1)
            else:
                self.advance(node, self.times[node + 1])
        if self.follows[nodes]:  # it ends there, without a state after it
            self.end(nodes - 1, self.follows[nodes] - 1)
        else:
            self.advance(nodes - 1, np.inf)
            self.take(nodes - 1)
        final = np.array(self.s).reshape(self.P, n)
        for k in range(self.high.shape[0]):
            if self.highs[k] > self.lows[k]:
                self.slope_at_node(k)
        return final

    def arrive(self, node):
        """Be at a known state."""
        i: cython.int
        for i in range(self.n):
            self.x[i] = self.states[node, i]
        if self.free:
            for i in range(self.n):
                self.s[i] = self.x[i] - self.w[i]
        for i in range(self.n * self.P):
            self.at[node, i] = self.s[i]
        if self.keeps:
            self.note(self.times[node], node, self.ground[node], self.rise[node])
        return 0

    def note(self, time, node, a, v):
        """Note the outputs that are observed, in the phase of a known state, and their derivatives."""
        k: cython.int
        p: cython.int
        count: cython.int = self.observed.shape[0]
        motion: Motion = self.motions[self.places[node]]
        self.log[self.kept, 0] = time
        for k in range(count):
            self.log[self.kept, 1 + k] = motion.value(self.observed[k], self.x, a, v)
            for p in range(self.P):
                self.log[self.kept, 1 + (1 + p) * count + k] = motion.slope(self.observed[k], p, self.x, self.s, a, v)
        self.kept += 1
        return 0

    def change(self, sample):
        """How much the acceleration changes in a sample of the record, or after it."""
        return self.record[sample + 1] - self.record[sample] if 0 <= sample < self.last else 0.0

    def change_of_rise(self, sample):
        """The same of the vertical one."""
        if self.vertical.shape[0] == 0 or not 0 <= sample < self.last:
            return 0.0
        return self.vertical[sample + 1] - self.vertical[sample]

    def advance(self, node, end):
        """Go on in the phase of a state to a time in samples, through the peaks on the way; to the last if infinite."""
        motion: Motion = self.motions[self.places[node]]
        now: cython.double = self.times[node]
        k: cython.int
        i: cython.int
        r: cython.int
        walked: cython.double = now  # where w is
        while self.next < self.order.shape[0]:
            r = self.order[self.next]
            if self.highs[r] > self.lows[r] or self.lows[r] <= node:  # at a known state
                self.next += 1
                continue
            if self.lows[r] > node + 1:
                break
            self.move(motion, node, now, self.when[r], not self.free)
            now = self.when[r]
            k = cython.cast(cython.int, floor(now))
            self.sample(k, now)
            if self.free:
                motion.advance_freely(self.w, self.none, False, now - walked)
                walked = now
                for i in range(self.n):
                    self.s[i] = self.x[i] - self.w[i]
            self.slope_of_row(motion, r, self.x[self.n], self.v)
            self.next += 1
        if end < np.inf:
            if self.free:
                motion.advance_freely(self.w, self.none, False, end - walked)
            else:
                self.move(motion, node, now, end, True)
        return 0

    def sample(self, k, time):
        """Take the accelerations at a time within sample k."""
        n: cython.int = self.n
        self.x[n] = self.x[n + 1] = self.v = self.climb = 0.0
        if 0 <= k < self.last:
            self.x[n + 1] = self.change(k) / self.h
            self.x[n] = self.record[k] + self.change(k) * (time - k)
            if self.vertical.shape[0]:
                self.climb = self.change_of_rise(k) / self.h
                self.v = self.vertical[k] + self.change_of_rise(k) * (time - k)
        return 0

    def move(self, motion: Motion, node, now, end, tangents):
        """Move the state, and the tangents if they are asked for, from one time to another, in samples."""
        k: cython.int = cython.cast(cython.int, floor(now))
        stop: cython.double
        while now < end:
            if k >= self.last and not self.keeps:
                motion.advance_freely(self.x, self.s, tangents, end - now)
                return 0
            stop = end if end < k + 1.0 else k + 1.0
            self.sample(k, now)
            motion.advance_in_sample(self.x, self.s, tangents, self.v, self.climb, stop - now)
            now = stop
            if now == k + 1.0:
                k += 1
                if self.keeps and now < end:
                    self.sample(k, now)
                    self.note(now, node, self.x[self.n], self.v)
        return 0

    def slope_of_row(self, motion: Motion, r, a, v):
        """The derivatives of a peak where the state is; its own time needs none."""
        p: cython.int
        sign: cython.double = 1.0 if self.one_sided[r] or motion.value(r, self.x, a, v) >= 0.0 else -1.0
        for p in range(self.P):
            self.peaks[p, r] = sign * motion.slope(r, p, self.x, self.s, a, v)
        return 0

    def slope_at_node(self, r):
        """The derivatives of a peak at a known state, which moves with the event beside it."""
        node: cython.int
        p: cython.int
        chosen: cython.int = self.lows[r]
        best: cython.double = np.inf
        miss: cython.double
        value: cython.double
        motion: Motion
        for node in range(self.lows[r], self.highs[r]):
            self.take(node)
            motion = self.motions[self.places[node]]
            value = motion.value(r, self.x, self.ground[node], self.rise[node])
            miss = fabs((value if self.one_sided[r] else fabs(value)) - self.high[r])
            if miss < best:
                chosen, best = node, miss
        node = chosen
        self.take(node)
        motion = self.motions[self.places[node]]
        value = motion.value(r, self.x, self.ground[node], self.rise[node])
        rate: cython.double = 0.0
        event: cython.int = node if self.follows[node] else node + 1
        sample: cython.int
        if self.follows[event]:
            sample = cython.cast(
                cython.int, floor(self.times[node] + SAME) if event == node else ceil(self.times[node] - SAME) - 1
            )
            motion.rates_at(self.x, self.ground[node], self.rise[node], self.before)
            rate = motion.rate(
                r,
                self.x,
                self.before,
                self.change(sample) / self.h,
                self.rise[node],
                self.change_of_rise(sample) / self.h,
            )
        for p in range(self.P):
            miss = motion.slope(r, p, self.x, self.s, self.ground[node], self.rise[node])
            if rate != 0.0:
                miss += rate * self.delays[event, p]
            self.peaks[p, r] = miss if self.one_sided[r] or value >= 0.0 else -miss
        return 0

    def take(self, node):
        """Take a known state with its tangents."""
        i: cython.int
        for i in range(self.n):
            self.x[i] = self.states[node, i]
        for i in range(self.n * self.P):
            self.s[i] = self.at[node, i]
        return 0

    def cross(self, node, event):
        """The tangents after an event, from those before it.

        With g the condition, F the rates before and after, and J the slopes of the jump, the event moves by
        dt = -(g_y s + dg/dp)/g', and s becomes J s + dJ/dp y + (J F_before - F_after) dt. An event that follows another
        one at the same instant moves with it, and one that the acceleration caused as it jumped does not move.
        """
        n: cython.int = self.n
        i: cython.int
        j: cython.int
        p: cython.int
        dt: cython.double
        motion: Motion = self.motions[self.turns[event, 0]]
        after: Motion = self.motions[self.places[node + 1]]
        crossing: Crossing = self.crossings[self.kinds[event]]
        a: cython.double = self.ground[node]
        v: cython.double = self.rise[node]
        motion.rates_at(self.x, a, v, self.before)
        self.delay(motion, node, event)
        jump: cython.double[:, ::1] = crossing.jump
        moved: cython.double[:, ::1] = None
        if crossing.ask is not None:
            found, more = crossing.ask(np.array(self.x[:n]), a, v)
            jump, moved = np.ascontiguousarray(found.T), np.ascontiguousarray(more)
        if jump.shape[0]:
            self.found[:] = 0.0
            self.then[:] = 0.0
            for p in range(self.P):
                add(jump, 0, self.s, p * n, n, 1.0, self.found, p * n, n)
                if crossing.slopes.shape[0]:
                    for i in range(n):
                        for j in range(n):
                            self.found[p * n + i] += crossing.slopes[p, i, j] * self.x[j]
                if moved is not None:
                    for i in range(n):
                        self.found[p * n + i] += moved[p, i]
            add(jump, 0, self.before, 0, n, 1.0, self.then, 0, n)
            self.s[:] = self.found
            self.before[:] = self.then
        for i in range(n):
            self.x[i] = self.states[node + 1, i]
        after.rates_at(self.x, a, v, self.then)
        for p in range(self.P):
            dt = self.delays[node + 1, p]
            for i in range(n):
                self.s[p * n + i] += (self.before[i] - self.then[i]) * dt
        if self.free:
            for i in range(n):
                self.w[i] = self.x[i] - self.s[i]
        return 0

    def delay(self, motion: Motion, node, event):
        """By how much an event moves, dt/dp; the state and its rates are those before it."""
        p: cython.int
        row: cython.int = motion.outputs + self.turns[event, 1]
        a: cython.double = self.ground[node]
        v: cython.double = self.rise[node]
        if self.follows[node]:  # at the same instant as another one
            for p in range(self.P):
                self.delays[node + 1, p] = self.delays[node, p]
            return 0
        if self.is_jump_of_ground(node):
            return 0
        sample: cython.int = cython.cast(cython.int, ceil(self.times[node] - SAME)) - 1
        rate: cython.double = motion.rate(
            row, self.x, self.before, self.change(sample) / self.h, v, self.change_of_rise(sample) / self.h
        )
        self.rates[event] = rate / motion.scales[self.turns[event, 1]]
        for p in range(self.P):
            self.delays[node + 1, p] = -motion.slope(row, p, self.x, self.s, a, v) / rate if rate != 0.0 else np.nan
        return 0

    def is_jump_of_ground(self, node):
        """Whether the acceleration jumps at the time of a state: at the start, or at the end of the record."""
        if self.times[node] <= 0.0:
            return True
        if fabs(self.times[node] - self.last) >= SAME or self.ground[node] != 0.0 or self.rise[node] != 0.0:
            return False
        return self.record[self.last] != 0.0 or (self.vertical.shape[0] > 0 and self.vertical[self.last] != 0.0)

    def end(self, node, event):
        """The tangents of the last state, where an event ends the run: it is at a later time."""
        i: cython.int
        p: cython.int
        motion: Motion = self.motions[self.places[node]]
        motion.rates_at(self.x, self.ground[node], self.rise[node], self.before)
        self.delay(motion, node, event)
        for p in range(self.P):
            for i in range(self.n):
                self.s[p * self.n + i] += self.before[i] * self.delays[node + 1, p]
        return 0

    @property
    def result(self):
        """Derivatives of the peaks, rates of the conditions at the events, and what was noted.

        That is a time in samples, the values of the outputs, and their derivatives, parameter after parameter.
        """
        return np.array(self.peaks), np.array(self.rates), np.array(self.log[: self.kept])
