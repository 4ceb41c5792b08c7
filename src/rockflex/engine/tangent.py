"""Derivatives of a run with respect to parameters: tangents of its motion, with a jump of their own at every event.

The run is known: its states at samples and beside events, the phases between them, and the times of its peaks. Within
a phase y' = A y + f a + c a tangent s = dy/dp obeys s' = A s + (dA/dp) y + (df/dp) a + dc/dp. At an event it jumps, see
`_crossed`. Several parameters are followed side by side.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from rockflex.engine.phase_tangent import PhaseTangent, number_of_event, number_of_phase, slopes_of_jump
from rockflex.engine.run import Run
from rockflex.engine.system import Key, LinearPhase
from rockflex.foundation.arrays import Array, Bools, Integers

TERMS = 22  # of a power series, for
TURN = 1.5  # rad of the fastest motion in one
FOR_EVER = 22  # doublings of the time of a decay
SAME = 1e-9  # samples: instants that are one


class Trace(NamedTuple):
    """What is known of a run with a history."""

    h: float
    times: Array  # (k,): of the states, in samples
    places: Integers  # (k,): of their phases among the keys
    ground: Array  # (k,): acceleration
    rise: Array  # (k,): vertical acceleration
    states: Array  # (k, n)
    keys: Sequence[Key]
    turns: Integers  # (e, 3): of each event its phase, its number, and the state after it
    high: Array  # (m,): peaks
    when: Array  # (m,): their times, in samples
    slopes: Array  # (samples, 2): changes of both accelerations in every sample of the record

    @classmethod
    def of(cls, run: Run, acceleration: Array, vertical: Array | None) -> "Trace":
        """Return what a run has met, whose record is given."""
        times, places, ground, states, rise = run.history
        high, when = run.highest
        still = np.zeros_like(acceleration) if vertical is None else vertical
        slopes = np.stack((np.diff(acceleration), np.diff(still)), axis=1)
        h = run.h
        return cls(h, times / h, places, ground, rise, states, run.keys, run.journal.turns, high, when / h, slopes)

    def changes_in(self, nodes: Integers) -> Array:
        """By how much both accelerations change in the samples that states begin, or lie in, shape (.., 2)."""
        samples = np.floor(self.times[nodes] + SAME).astype(np.int64)
        return self._changes(samples)

    def changes_before(self, node: int) -> Array:
        """By how much they change in the sample that a state ends, or lies in, shape (2,)."""
        return self._changes(np.array(np.ceil(self.times[node] - SAME).astype(np.int64) - 1))

    def _changes(self, samples: Integers) -> Array:
        known = (samples >= 0) & (samples < len(self.slopes))
        found = self.slopes[np.where(known, samples, 0)] if len(self.slopes) else np.zeros((*samples.shape, 2))
        return np.where(known[..., None], found, 0.0)


class Tangents(NamedTuple):
    """Derivatives with respect to P parameters, and what they rest on."""

    peaks: Array  # (P, m)
    final: Array  # (P, n): of the last state
    state: Array  # (n,): that state
    place: int  # of its phase among the keys
    rates: Array  # (e,): of the conditions at the events, over their scales, in 1/s; NaN where none was crossed
    seen: Array  # (k, r): outputs that were observed, at the states of the run
    slopes: Array  # (P, k, r): and their derivatives at these times


class _Part(NamedTuple):
    """A motion over a part of a sample, from a state."""

    y: Array  # (k, n): states at its end
    change: Array  # (k, P, n): tangents at its end that were zero at its start
    carry: Array  # (k, n, n), or (1, n, n) for all: what a tangent at its start is multiplied by


@dataclass(frozen=True, eq=False)
class _Motion:
    """A phase with its tangents, for parts of samples."""

    phase: LinearPhase
    tangent: PhaseTangent
    h: float
    shakes: bool  # whether the ground moves vertically

    @cached_property
    def speed(self) -> float:
        """How fast its motion may turn or grow, 1/s."""
        roots = np.linalg.eigvals(self.phase.A)
        return float(np.abs(roots).max(initial=0.0))

    def rates(self, y: Array, a: float, a_v: float) -> Array:
        """Y'."""
        p = self.phase
        found = p.A @ y + p.f * a + p.c
        return found + a_v * (number_of_phase(p, "A_v") @ y + number_of_phase(p, "f_v")) if self.shakes else found

    def part(self, y: Array, a: Array, change: Array, length: Array) -> _Part:
        """Follow the motion from k states (k, n) with accelerations (k, 2) over lengths in samples, (k,).

        `change` is by how much the accelerations change in the whole sample, (k, 2).
        """
        n, ones = y.shape[1], np.ones(len(y))
        if self.shakes or len(y) <= n + 3 or bool((length != length[0]).any()):
            return self._along(y, a, change, length, ones)
        # Equal lengths: what follows is linear in y, both values of a, and 1.
        base, given = np.eye(n + 3), np.column_stack((y, a[:, 0], change[:, 0], ones))
        drive, zero = base[:, n : n + 2], np.zeros(n + 3)
        own = self._along(
            base[:, :n],
            np.column_stack((drive[:, 0], zero)),
            np.column_stack((drive[:, 1], zero)),
            np.full(n + 3, length[0]),
            base[:, -1],
        )
        found = given @ own.change.reshape(n + 3, -1)
        return _Part(given @ own.y, found.reshape(len(y), -1, n), own.carry)

    def _along(self, y: Array, a: Array, change: Array, length: Array, ones: Array) -> _Part:
        """The same by power series, with factors on the constant terms, (k,)."""
        pieces = max(1, int(np.ceil(self.speed * self.h * float(length.max(initial=0.0)) / TURN)))
        n, P = y.shape[1], len(self.tangent["f"])
        tau, step = self.h * length / pieces, change * (length / pieces)[:, None]
        common = not self.shakes and bool((length == length[:1]).all())
        carry = np.broadcast_to(np.eye(n), (1 if common else len(y), n, n))
        found = np.zeros((len(y), P, n))
        own = self._carry(a, step, tau, common)
        for piece in range(pieces):
            start = a + piece * step
            if self.shakes and piece:
                own = self._carry(start, step, tau, common)
            y, more = self._series(y, start, step, tau, ones)
            found = found @ own.transpose(0, 2, 1) + more
            carry = own @ carry
        return _Part(y, found, carry)

    def _carry(self, a: Array, step: Array, tau: Array, common: bool) -> Array:
        """The matrix by which a tangent is multiplied in a piece, as a power series, (k, n, n)."""
        A, n = self.phase.A, len(self.phase.A)
        if common:
            a, step, tau = a[:1], step[:1], tau[:1]
        term = np.broadcast_to(np.eye(n), (len(tau), n, n))
        before = np.zeros_like(term)
        total = term.copy()
        for k in range(1, TERMS):
            moved = A @ term
            if self.shakes:
                A_v = number_of_phase(self.phase, "A_v")
                moved = moved + a[:, 1, None, None] * (A_v @ term) + step[:, 1, None, None] * (A_v @ before)
            term, before = moved * (tau / k)[:, None, None], term
            total += term
        return total

    def _series(self, y: Array, a: Array, step: Array, tau: Array, ones: Array) -> tuple[Array, Array]:
        """States at the end of a piece, and tangents that were zero at its start, as power series."""
        p, t = self.phase, self.tangent
        P, n = t["f"].shape
        term, tangent = y, np.zeros((len(y), P, n))
        before, passed = np.zeros_like(y), tangent
        total, more = y.copy(), tangent.copy()
        flat = t["A"].reshape(P * n, n).T
        for k in range(1, TERMS):
            moved = term @ p.A.T
            turned = tangent @ p.A.T + (term @ flat).reshape(-1, P, n)
            if k < 3:
                drive = a if k == 1 else step
                moved = moved + drive[:, :1] * p.f
                turned = turned + drive[:, :1, None] * t["f"]
                if k == 1:
                    moved, turned = moved + np.outer(ones, p.c), turned + ones[:, None, None] * t["c"]
                if self.shakes:
                    moved = moved + drive[:, 1:] * number_of_phase(p, "f_v")
                    turned = turned + drive[:, 1:, None] * t["f_v"]
            if self.shakes:
                A_v, slope = number_of_phase(p, "A_v"), t["A_v"].reshape(P * n, n).T
                u, w = a[:, 1:], step[:, 1:]
                moved = moved + u * (term @ A_v.T) + w * (before @ A_v.T)
                turned = turned + u[..., None] * (tangent @ A_v.T + (term @ slope).reshape(-1, P, n))
                turned = turned + w[..., None] * (passed @ A_v.T + (before @ slope).reshape(-1, P, n))
            size = (tau / k)[:, None]
            before, passed = term, tangent
            term, tangent = moved * size, turned * size[..., None]
            total, more = total + term, more + tangent
        return total, more

    def value(self, row: int, y: Array, a: float, a_v: float) -> float:
        """An output."""
        p = self.phase
        found = p.C[row] @ y + p.d[row] * a + p.e[row]
        if self.shakes:
            found += a_v * (number_of_phase(p, "C_v")[row] @ y + number_of_phase(p, "d_v")[row])
        return float(found)

    def slope_of_value(self, row: int, y: Array, s: Array, a: float, a_v: float) -> Array:
        """Its derivatives at a given time, shape (P,)."""
        p, t = self.phase, self.tangent
        found = s @ p.C[row] + t["C"][:, row] @ y + t["d"][:, row] * a + t["e"][:, row]
        if self.shakes:
            C_v = number_of_phase(p, "C_v")[row]
            found = found + a_v * (s @ C_v + t["C_v"][:, row] @ y + t["d_v"][:, row])
        return found

    def rate_of_value(self, row: int, y: Array, a: Array, slopes: Array) -> float:
        """Its rate, under accelerations (2,) that change by so much in a second."""
        p, rates = self.phase, self.rates(y, float(a[0]), float(a[1]))
        found = p.C[row] @ rates + p.d[row] * slopes[0]
        if self.shakes:
            C_v = number_of_phase(p, "C_v")[row]
            found += a[1] * (C_v @ rates) + slopes[1] * (C_v @ y + number_of_phase(p, "d_v")[row])
        return float(found)


def follow_tangents(
    trace: Trace,
    phase_of: Callable[[Key], LinearPhase],
    tangent_of: Callable[[Key], PhaseTangent],
    start: Array,
    one_sided: Bools,
    *,
    at_rest: bool = False,
    observed: Sequence[int] = (),
) -> Tangents:
    """Follow tangents through a run.

    Parameters
    ----------
    trace
        The run.
    phase_of, tangent_of
        Its phases and their derivatives.
    start
        Derivatives of the first state, shape (P, n).
    one_sided
        Which peaks are largest values, and not largest magnitudes, shape (m,).
    at_rest
        Whether the last state is that which the run would approach without excitation.
    observed
        Numbers of the outputs whose values at all states are wanted, too.
    """
    found = _Pass(trace, phase_of, tangent_of, one_sided, observed)
    made = found.follow(start)
    return found.brought_to_rest(made) if at_rest else made


class _Pass:
    """One pass over a run."""

    def __init__(
        self,
        trace: Trace,
        phase_of: Callable[[Key], LinearPhase],
        tangent_of: Callable[[Key], PhaseTangent],
        one_sided: Bools,
        observed: Sequence[int],
    ) -> None:
        self.trace, self.one_sided, self.observed = trace, one_sided, list(observed)
        used, shakes = np.unique(trace.places).tolist(), bool(trace.rise.any())
        self.motions = {
            place: _Motion(phase_of(trace.keys[place]), tangent_of(trace.keys[place]), trace.h, shakes)
            for place in used
        }
        self.accelerations = np.stack((trace.ground, trace.rise), axis=1)
        self.events = {int(after): number for number, (_, _, after) in enumerate(trace.turns)}
        self.peaks = [self._base_of_peak(row) for row in range(len(trace.high))]
        self.rates = np.full(len(trace.turns), np.nan)
        self.delays = dict[int, Array]()  # dt/dp of events, by the number of the state after it

    def follow(self, start: Array) -> Tangents:
        trace, last = self.trace, len(self.trace.times) - 1
        wanted = set(range(last + 1)) if self.observed else {node for node, _ in self.peaks}
        lengths, at = np.diff(trace.times), {}
        parts = self._parts(lengths)
        s, node = start, 0
        while True:
            if node in wanted:
                at[node] = s
            if node == last:
                break
            if node + 1 in self.events:
                s = self._crossed(s, node)
                node += 1
            elif lengths[node] <= 0.0:
                node += 1
            else:
                run = self._whole[node]
                stop = next((k for k in range(node + 1, node + run) if k in wanted), node + run)
                if run and stop > node + 1:
                    s = self._over(s, parts, node, stop)
                    node = stop
                else:
                    carry, change = parts[node]
                    s = s @ carry.T + change
                    node += 1
        if last + 1 in self.events:  # it ends there, without a state after it
            delay = self.delays[last + 1] = self._delay(s, last, self.events[last + 1])
            place = self.motions[int(trace.places[last])]
            s = s + delay[:, None] * place.rates(trace.states[last], *self.accelerations[last])
        found = np.stack([self._slope_of_peak(row, at) for row in range(len(self.peaks))], axis=1)
        values, slopes = self._along(at) if self.observed else (np.zeros((0, 0)), np.zeros((len(s), 0, 0)))
        return Tangents(found, s, trace.states[last], int(trace.places[last]), self.rates, values, slopes)

    def _along(self, at: Mapping[int, Array]) -> tuple[Array, Array]:
        """The outputs that are observed, and their derivatives, at all states."""
        trace, count, rows = self.trace, len(self.trace.times), self.observed
        tangents = np.array([at[node] for node in range(count)])
        values, slopes = np.zeros((count, len(rows))), np.zeros((tangents.shape[1], count, len(rows)))
        for place, motion in self.motions.items():
            nodes = np.flatnonzero(trace.places == place)
            p, t, y, s = motion.phase, motion.tangent, trace.states[nodes], tangents[nodes]
            a, a_v = trace.ground[nodes, None], trace.rise[nodes, None]
            C_v, d_v = number_of_phase(p, "C_v")[rows], number_of_phase(p, "d_v")[rows]
            values[nodes] = y @ p.C[rows].T + a * p.d[rows] + p.e[rows] + a_v * (y @ C_v.T + d_v)
            for k in range(tangents.shape[1]):
                slopes[k, nodes] = s[:, k] @ p.C[rows].T + y @ t["C"][k, rows].T + a * t["d"][k, rows] + t["e"][k, rows]
                slopes[k, nodes] += a_v * (s[:, k] @ C_v.T + y @ t["C_v"][k, rows].T + t["d_v"][k, rows])
        return values, slopes

    def brought_to_rest(self, made: Tangents) -> Tangents:
        """Let the motion after the last state go on for ever, without excitation."""
        motion, (P, n) = self.motions[made.place], made.final.shape
        A, both = motion.phase.A, np.zeros((n + n * P + 1,) * 2)
        both[:n, :n], both[:n, -1] = A, motion.phase.c
        for k in range(P):
            own = slice(n + k * n, n + (k + 1) * n)
            both[own, own], both[own, :n], both[own, -1] = A, motion.tangent["A"][k], motion.tangent["c"][k]
        step = both * (TURN / max(motion.speed, 1e-9))
        carry, term = np.eye(len(both)), np.eye(len(both))
        for k in range(1, TERMS):
            term = term @ step / k
            carry = carry + term
        for _ in range(FOR_EVER):
            carry = carry @ carry
        found = carry @ np.concatenate((made.state, made.final.ravel(), (1.0,)))
        return made._replace(state=found[:n], final=found[n:-1].reshape(P, n))

    def _parts(self, lengths: Array) -> dict[int, tuple[Array, Array]]:
        """Of every step from a state to the next one in a phase what carries a tangent, and what adds to it."""
        trace, found = self.trace, dict[int, tuple[Array, Array]]()
        moves = lengths > 0.0
        whole = moves & (np.abs(lengths - 1.0) < SAME)
        self._whole = np.zeros(len(lengths) + 1, dtype=np.int64)  # how many whole samples follow in the same phase
        for place, motion in self.motions.items():
            for some in (whole, moves & ~whole):
                nodes = np.flatnonzero(some & (trace.places[:-1] == place))
                if not nodes.size:
                    continue
                length = np.ones(nodes.size) if some is whole else lengths[nodes]
                part = motion.part(trace.states[nodes], self.accelerations[nodes], trace.changes_in(nodes), length)
                shared = len(part.carry) == 1
                for k, node in enumerate(nodes.tolist()):
                    found[node] = part.carry[0 if shared else k], part.change[k]
        kinds = np.where(whole, trace.places[:-1], -1)
        for node in range(len(lengths) - 1, -1, -1):
            if kinds[node] >= 0 and not self.motions[int(kinds[node])].shakes:
                follows = node + 1 < len(lengths) and kinds[node + 1] == kinds[node]
                self._whole[node] = 1 + (self._whole[node + 1] if follows else 0)
        return found

    def _over(self, s: Array, parts: Mapping[int, tuple[Array, Array]], first: int, stop: int) -> Array:
        """Over whole samples in one phase: sums of pairs, of pairs of pairs and so on."""
        carry = parts[first][0].T
        changes = np.array([parts[node][1] for node in range(first, stop)])
        changes[0] += s @ carry
        while len(changes) > 1:
            if len(changes) % 2:
                changes = np.concatenate((np.zeros_like(changes[:1]), changes))
            changes = changes[::2] @ carry + changes[1::2]
            carry = carry @ carry
        return changes[0]

    def _crossed(self, s: Array, node: int) -> Array:
        """The tangents after an event, from those before it.

        With g the condition, F the rates before and after, and J the slopes of the jump, the event moves by
        dt = -(g_y s + dg/dp)/g', and s becomes J s + dJ/dp y + (J F_before - F_after) dt. An event that follows another
        one at the same instant moves with it, and one that the acceleration caused as it jumped does not move.
        """
        trace = self.trace
        number = self.events[node + 1]
        place, event, _ = (int(each) for each in trace.turns[number])
        motion, after = self.motions[place], self.motions[int(trace.places[node + 1])]
        y, beyond = trace.states[node], trace.states[node + 1]
        a, a_v = self.accelerations[node]
        held, change = motion.phase.events[event], motion.tangent
        target = trace.keys[int(trace.places[node + 1])]
        slopes = slopes_of_jump(held, y, a, a_v, target)
        found = s @ slopes.T + change.jumped(event, y, a, a_v, target)
        delay = self._delay(s, node, number)
        before, then = motion.rates(y, a, a_v), after.rates(beyond, a, a_v)
        self.delays[node + 1] = delay
        return found + delay[:, None] * (slopes @ before - then)

    def _delay(self, s: Array, node: int, number: int) -> Array:
        """By how much an event moves, dt/dp, shape (P,)."""
        trace = self.trace
        if node in self.events:  # at the same instant as another one
            return self.delays[node]
        if self._is_jump_of_ground(node):
            return np.zeros(len(s))
        place, event, _ = (int(each) for each in trace.turns[number])
        motion = self.motions[place]
        held, slopes = motion.phase.events[event], motion.tangent.events[event]
        y, (a, a_v) = trace.states[node], self.accelerations[node]
        rates, (moves, rises) = motion.rates(y, a, a_v), trace.changes_before(node) / trace.h
        rate = held.row @ rates + float(held.direct) * moves
        found = s @ held.row + slopes["row"] @ y + slopes["direct"] * a + slopes["constant"]
        if motion.shakes:
            row_v, direct_v = number_of_event(held, "row_v", motion.phase), float(held.direct_v)
            rate += a_v * (row_v @ rates) + rises * (row_v @ y + direct_v)
            found = found + a_v * (s @ row_v + slopes["row_v"] @ y + slopes["direct_v"])
        self.rates[number] = rate / float(held.scale)
        return -found / rate if rate else np.full(len(s), np.nan)

    def _is_jump_of_ground(self, node: int) -> bool:
        """Whether the acceleration jumps at the time of a state: at the start, or at the end of the record."""
        time, end = self.trace.times[node], len(self.trace.slopes)
        return time <= 0.0 or (node > 0 and abs(time - end) < SAME and self._falls(node))

    def _falls(self, node: int) -> bool:
        times, k = self.trace.times, node
        while k > 0 and times[node] - times[k - 1] < SAME:
            k -= 1
        return bool(self.trace.ground[k] != self.trace.ground[node] or self.trace.rise[k] != self.trace.rise[node])

    def _base_of_peak(self, row: int) -> tuple[int, float]:
        """The state from which a peak is reached, and how many samples later."""
        trace = self.trace
        time, high = float(trace.when[row]), float(trace.high[row])
        near = max(1e-12 * max(time, 1.0), 1e-13)
        some = np.flatnonzero(np.abs(trace.times - time) <= near).tolist()
        if some:

            def miss(node: int) -> float:
                value = self._signed(row, node)
                return abs((value if self.one_sided[row] else abs(value)) - high)

            return min(some, key=miss), 0.0
        node = int(np.searchsorted(trace.times, time, side="right")) - 1
        return node, time - float(trace.times[node])

    def _signed(self, row: int, node: int) -> float:
        motion = self.motions[int(self.trace.places[node])]
        return motion.value(row, self.trace.states[node], *self.accelerations[node])

    def _slope_of_peak(self, row: int, at: Mapping[int, Array]) -> Array:
        """The derivatives of a peak; its own time needs none, unless it is that of an event."""
        trace, (node, later) = self.trace, self.peaks[row]
        motion, y, a, s = self.motions[int(trace.places[node])], trace.states[node], self.accelerations[node], at[node]
        more = 0.0
        if later > 0.0:
            change = trace.changes_in(np.array([node]))
            part = motion.part(y[None], a[None], change, np.array([later]))
            y, s, a = part.y[0], s @ part.carry[0].T + part.change[0], a + change[0] * later
        elif node in self.delays:
            slope = trace.changes_in(np.array([node]))[0] / trace.h
            more = motion.rate_of_value(row, y, a, slope) * self.delays[node]
        elif node + 1 in self.delays:
            slope = trace.changes_before(node) / trace.h
            more = motion.rate_of_value(row, y, a, slope) * self.delays[node + 1]
        found = motion.slope_of_value(row, y, s, float(a[0]), float(a[1])) + more
        return found if self.one_sided[row] or motion.value(row, y, float(a[0]), float(a[1])) >= 0.0 else -found
