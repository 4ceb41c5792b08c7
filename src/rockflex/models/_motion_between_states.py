"""The motion between the states of a history, in linear phases: matrix exponentials, and power series.

Between two states the accelerations of the ground are linear in time. A vector z = [y, m, a, a', 1] has the states y
that move, the internal variables m that act in a phase, the horizontal acceleration of the ground and its slope.
Without vertical acceleration z' = G z, and the exponentials of G for a step and its halves carry an interval of any
length, but for a short rest. With it z' = (G + a_v V) z is developed in a power series. Eigenvectors are not used, so
that repeated roots need no special case.
"""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockflex.engine.tables import exponentials_less_identity, halvings_of, spectral_radius_bound
from rockflex.foundation.arrays import Array, Bools
from rockflex.models._phase import Key
from rockflex.models._rocking_model import RockingModel
from rockflex.models._state_layout import GROUND, HEADER, RISE, SIDE, TIME
from rockflex.models._values_at_states import phases_at_states, under_more_gravity

TURN = 2.0  # rad that a mode may turn within one power series
REST = 0.5  # rad that it turns at most in what is left of an interval after the exponentials
SMALL = 1e-18  # of a sum: terms that no longer change it
BLUR = 1e-15  # of the last time: lengths that differ only by rounding of the times share one exponential
MOST = 2**14  # intervals whose power series fit in memory: a hundred megabytes
ASIDE = 1e-6  # of a step times the change of θ' in it, from the middle rotation


class VerticalShaking(NamedTuple):
    """Vertical acceleration of the ground in m/s² and its slope, shape (n,)."""

    rise: Array
    slope: Array

    def later(self, time: Array) -> "VerticalShaking":
        """Return the same after times in s."""
        return VerticalShaking(self.rise + time * self.slope, self.slope)

    def of(self, which: NDArray[np.intp]) -> "VerticalShaking":
        """Return that of some intervals."""
        return VerticalShaking(self.rise[which], self.slope[which])


class LinearMotion:
    """The motion in one linear phase.

    Parameters
    ----------
    model, key
        The model and the phase.
    longest
        The length in s of the longest intervals; it is best if many have this length, or half or a quarter of it.

    Attributes
    ----------
    rates, more : ndarray, shape (Z, Z)
        G and V.
    speed
        A close upper estimate of the largest eigenvalue magnitude in rad/s.
    """

    def __init__(self, model: RockingModel, key: Key, longest: float) -> None:
        layout, accelerations, free = (
            model.layout,
            model.accelerations(key),
            np.flatnonzero(model.bordered_system(key).freed),
        )
        heavier = under_more_gravity(model).accelerations(key) - accelerations
        n, internal = layout.modes, accelerations[:, layout.core : layout.moving]
        acting = np.flatnonzero(internal.any(axis=0))
        self.columns = np.concatenate((np.arange(layout.core), layout.core + acting, [layout.moving]))  # of y, m and a
        size = self.columns.size + 2
        modes, base = np.arange(n), layout.rotation + 2 * free
        self.rates, self.more = np.zeros((2, size, size))
        self.rates[[*modes, *base], [*(n + modes), *(base + 1)]] = 1.0
        self.rates[[*(n + modes), *(base + 1)]] = self.taken(accelerations[[*modes, *(n + free)]])
        self.more[[*(n + modes), *(base + 1)]] = self.taken(heavier[[*modes, *(n + free)]])
        self.rates[-3, -2] = 1.0
        self.speed = float(spectral_radius_bound(self.rates[None, : layout.core, : layout.core])[0])
        self._felt, self._longest = np.flatnonzero(self.more.any(axis=0)), longest

    def taken(self, rows: Array) -> Array:
        """Return rows of the model, shape (.., C), as functionals of z, shape (.., Z)."""
        found = np.zeros((*rows.shape[:-1], self.columns.size + 2))
        found[..., :-2], found[..., -1] = rows[..., self.columns], rows[..., -1]
        return found

    @property
    def shaken(self) -> bool:
        """Whether a vertical acceleration of the ground acts on the motion."""
        return self._felt.size > 0

    @cached_property
    def changes(self) -> list[Array]:
        """exp(G t) - 1 for the lengths t."""
        halvings = int(halvings_of(self.speed * self._longest, REST))
        return [each[0] for each in exponentials_less_identity(self.rates[None] * self._longest, halvings)]

    @property
    def lengths(self) -> Array:
        """The longest length and its halves, down to one that a power series can pass, in s."""
        return np.ldexp(self._longest, -np.arange(len(self.changes)))

    def parts(self, longest: float) -> int:
        """Return the number of equal parts in which intervals are to be taken, so that power series converge."""
        return max(math.ceil(self.speed * longest / TURN), 1)

    def series(self, z: Array, h: Array, shaking: VerticalShaking | None = None) -> Array:
        """Return the terms of z in powers of the fraction of steps h in s, shape (terms, n, Z)."""
        turn, size, count = self.speed * float(h.max(initial=0.0)), 1.0, 8
        while count < 8 or size > SMALL:
            count += 1
            size = turn**count / math.factorial(count)
        found = np.empty((count, *z.shape))
        found[0], felt = z, self.more[:, self._felt].T
        for k in range(1, count):
            rate = found[k - 1] @ self.rates.T
            if shaking is not None:
                rate += shaking.rise[:, None] * (found[k - 1][:, self._felt] @ felt)
                if k > 1:
                    rate += (shaking.slope * h)[:, None] * (found[k - 2][:, self._felt] @ felt)
            np.multiply(rate, (h / k)[:, None], out=found[k])
        return found

    def pieces(self, z: Array, left: Array) -> Iterator[tuple[int, NDArray[np.intp]]]:
        """Move z, shape (n, Z), by the times `left` in s, in place, but for a rest that is shorter than all lengths.

        Before each move the number of the length is yielded, and which intervals it moves.
        """
        for k, length in enumerate(self.lengths.tolist()):
            while (which := np.flatnonzero(left >= length)).size:
                yield k, which
                z[which] += z[which] @ self.changes[k].T
                left[which] -= length

    def moved(self, z: Array, elapsed: Array) -> Array:
        """Return z after times in s, shape (n,); where many are equal, with one matrix."""
        size, (times, which, count) = z.shape[1], np.unique(elapsed, return_inverse=True, return_counts=True)
        many = np.flatnonzero(count > size)
        alone = np.flatnonzero(count[which] <= size)
        both = np.concatenate((z[alone], np.tile(np.eye(size), (many.size, 1))))
        left = np.concatenate((elapsed[alone], np.repeat(times[many], size)))
        for _ in self.pieces(both, left):
            pass
        rest = np.flatnonzero(left)
        both[rest] = self.series(both[rest], left[rest]).sum(axis=0)
        found = np.empty_like(z)
        found[alone] = both[: alone.size]
        for place, matrix in zip(many.tolist(), both[alone.size :].reshape(-1, size, size), strict=True):
            alike = which == place
            found[alike] = z[alike] @ matrix
        return found

    def developed(self, z: Array, steps: Array, shaking: VerticalShaking | None = None) -> Iterator[Array]:
        """Yield the power series in equal parts of steps in s, shape (n,), one after the other: see `series`."""
        parts = self.parts(float(steps.max(initial=0.0)))
        h = steps / parts
        for k in range(parts):
            terms = self.series(z, h, None if shaking is None else shaking.later(k * h))
            yield terms
            z = terms.sum(axis=0)


@dataclass(frozen=True, eq=False)
class IntervalsOfPhase:
    """Intervals in one linear phase, with or without vertical acceleration."""

    key: Key
    motion: LinearMotion
    rows: NDArray[np.intp]  # which intervals, (n,)
    z: Array  # at their starts, (n, Z)
    steps: Array  # their lengths in s, (n,)
    shaking: VerticalShaking | None

    def after(self, which: NDArray[np.intp], elapsed: Array) -> Array:
        """Return z `elapsed` seconds after the start of some of the intervals, shape (m, Z)."""
        if self.shaking is None:
            return self.motion.moved(self.z[which], elapsed)
        terms = np.zeros((1, 0, 0))
        for each in self.motion.developed(self.z[which], elapsed, self.shaking.of(which)):
            terms = each
        return terms.sum(axis=0)

    @property
    def mostly_alike(self) -> bool:
        """Whether most intervals are as long as many others, so that a matrix for each length is less than a series."""
        counts = np.unique(self.steps, return_counts=True)[1]
        return 2 * int(counts[counts > self.z.shape[1]].sum()) > self.steps.size

    def along(self, fractions: Array) -> Iterator[Array]:
        """Yield z at one fraction of all intervals after the other, shape (n, Z); they rise."""
        parts, done = self.motion.parts(float(self.steps.max())), 0
        if self.shaking is None and (parts > fractions.size or self.rows.size > MOST or self.mostly_alike):
            for fraction in fractions.tolist():
                yield self.after(np.arange(self.rows.size), fraction * self.steps)
            return
        for k, terms in enumerate(self.motion.developed(self.z, self.steps, self.shaking)):
            end = int(np.searchsorted(fractions * parts, k + 1, side="right")) if k < parts - 1 else fractions.size
            yield from series_between_states(terms, fractions[done:end] * parts - k)
            done = end


@dataclass(frozen=True, eq=False)
class IntervalsBetweenStates:
    """The motion between adjacent states of a history; in phases that are not linear, the states at the start."""

    before: Array  # states at the start, (n - 1, S)
    core: int
    parts: list[IntervalsOfPhase]
    blur: float  # s, below which lengths do not differ

    def at(self, fraction: float) -> Array:
        """Return the states at a fraction of every interval, shape (n - 1, S)."""
        return next(self.along([fraction]))

    def along(self, fractions: Iterable[float]) -> Iterator[Array]:
        """Yield the states as `at` does, at rising fractions, with less work than one after the other."""
        wanted = np.array(list(fractions), dtype=float)
        courses = [(part.rows, part.along(wanted)) for part in self.parts]
        for _ in range(wanted.size):
            found = self.before.copy()
            for rows, course in courses:
                found[rows, : self.core] = next(course)[:, : self.core]
            yield found

    def after(self, which: NDArray[np.intp], elapsed: Array) -> Array:
        """Return the states `elapsed` (m,) seconds after the start of some intervals, shape (m, S)."""
        found, place = self.before[which], np.empty(len(self.before), dtype=np.intp)
        elapsed = _merged_interval_lengths(elapsed, self.blur)
        for part in self.parts:
            place[:] = -1
            place[part.rows] = np.arange(part.rows.size)
            chosen = np.flatnonzero(place[which] >= 0)
            if chosen.size:
                found[chosen, : self.core] = part.after(place[which[chosen]], elapsed[chosen])[:, : self.core]
        return found


class MotionBetween:
    """The motion between the states of histories of a model, in its linear phases.

    Parameters
    ----------
    model
        The model.
    """

    def __init__(self, model: RockingModel) -> None:
        self._model = model
        self._known = dict[Key, LinearMotion]()

    @cached_property
    def fastest(self) -> float:
        """Largest eigenvalue magnitude of all phases, rad/s; integrated phases are linearised for small rotations."""
        model = self._model.linear
        stiffest = [max(each.branches, key=lambda branch: each.tension(branch).stiffness) for each in model.elements]
        core, keys = model.layout.core, (model.with_branches(model.start(side), stiffest) for side in model.sides)
        found = (np.linalg.eigvals(LinearMotion(model, key, 1.0).rates[:core, :core]) for key in keys)
        return max(float(np.abs(roots).max()) for roots in found)

    def intervals(self, states: Array) -> IntervalsBetweenStates:
        """Return the motion over the intervals between adjacent states, shape (n, columns)."""
        model, layout = self._model, self._model.layout
        blur = BLUR * max(float(states[-1, TIME]), 1e-300)
        steps = _merged_interval_lengths(np.diff(states[:, TIME]), blur)
        lasting = steps > 0.0
        slopes = np.diff(states[:, [GROUND, RISE]], axis=0) / np.where(lasting, steps, 1.0)[:, None]
        slopes[~lasting] = 0.0
        shaking = VerticalShaking(states[:-1, RISE], slopes[:, 1])
        shaken: Bools = (shaking.rise != 0.0) | (shaking.slope != 0.0)
        # The branch of an element over an interval is that in its middle, with the internal variable at its start. An
        # excursion may begin and end on the border of a branch: a little of its height tells on which side it is.
        rotation, spin = layout.of(states, layout.rotation), layout.of(states, layout.spin)
        middle = 0.5 * (rotation[:-1] + rotation[1:]) - ASIDE * steps * np.diff(spin)
        parts, longest = list[IntervalsOfPhase](), _longest(steps)
        for found, key in phases_at_states(model, states[:-1, SIDE], middle, states[:-1]):
            if model.integrates(key[0]):
                continue
            if key not in self._known:
                self._known[key] = LinearMotion(model, key, longest)
            motion = self._known[key]
            for apart in (False, True):
                rows = found[(shaken[found] & motion.shaken) == apart]
                if rows.size:
                    start = states[rows]
                    moving = start[:, HEADER + motion.columns[:-1]]
                    z = np.column_stack((moving, start[:, GROUND], slopes[rows, 0], np.ones(rows.size)))
                    parts.append(
                        IntervalsOfPhase(key, motion, rows, z, steps[rows], shaking.of(rows) if apart else None)
                    )
        return IntervalsBetweenStates(states[:-1, HEADER:], layout.core, parts, blur)


def series_between_states(terms: Array, places: Array) -> Array:
    """Return z at fractions of a step from its power series, shape (places, n, Z)."""
    return np.tensordot(np.vander(places, len(terms), increasing=True), terms, axes=1)


def _merged_interval_lengths(lengths: Array, blur: float) -> Array:
    """Return lengths in s, where those that differ by no more than a blur from the next shorter one have their mean."""
    if not lengths.size:
        return lengths
    values, which, count = np.unique(lengths, return_inverse=True, return_counts=True)
    group = np.cumsum(np.append(0, (np.diff(values) > blur) | (values[:-1] == 0.0)))
    return (np.bincount(group, values * count) / np.bincount(group, count))[group[which]]


def _longest(steps: Array) -> float:
    """Return the most frequent positive step, or a power of two times it that no step exceeds, in s."""
    lengths, count = np.unique(steps[steps > 0.0], return_counts=True)
    if not lengths.size:
        return 1.0
    usual = float(lengths[np.argmax(count)])
    return usual * 2.0 ** math.ceil(math.log2(float(lengths[-1]) / usual))
