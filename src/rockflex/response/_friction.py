"""The friction required to prevent sliding (Silva & Stojadinović 2024, Eq. 20)."""

import math
from collections.abc import Callable, Iterator, Sequence
from copy import copy
from functools import cached_property
from itertools import repeat
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from rockflex.engine.stops import check_interruption
from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_positive, real_or_nan
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.models._motion_between_states import IntervalsBetweenStates, MotionBetween
from rockflex.models._reactions import Reactions, printed_reactions, reactions
from rockflex.models._rocking_model import RockingModel
from rockflex.models._state_layout import GROUND, HEADER, RISE, SIDE, TIME
from rockflex.models._values_at_states import accelerations_at_states
from rockflex.response._interpolation import interpolated_columns, quintic

IMPACT_WINDOW = 0.05  # s after an impact, in which the demand has short spikes
MAX_PHASE_STEP = 0.2  # radians of the fastest mode between adjacent evaluation points
ROUNDING = 1e-12  # relative: a base that slides demands its coefficient all the time
MIN_POINTS, MAX_POINTS = 4, 2000  # evaluation points in the interval between adjacent states
ROUNDS, CLOSER = 4, 9  # a peak is looked for so often, each time at so many places around the highest one before

AnglesAt: TypeAlias = Callable[[Sequence[float]], Array]  # angles at rising places of an interval


def friction_coefficient(mu: float) -> float:
    """Return a coefficient of friction.

    Raises
    ------
    InputError
        If it is not a positive number.
    """
    coefficient = real_or_nan(mu)
    if not 0.0 < coefficient < math.inf:
        raise InputError(f"mu must be a friction coefficient above zero, such as 0.5, but {shown(mu)} was given.")
    return coefficient


class Friction:
    """Required friction along a history.

    Parameters
    ----------
    model, states
        As in `History`.
    """

    def __init__(self, model: RockingModel, states: Array) -> None:
        self._model = model
        self._states = states
        self._printed = False
        self._required: dict[float, float] = {}  # by window: finding it takes long, and checks ask again
        self._rates = accelerations_at_states(model, states)
        self._linear = None if model.bouc_wen is not None else MotionBetween(model)
        p = model.properties
        # Upper bound of the factor by which uplift increases the frequencies.
        scale = max(math.sqrt(p.pivot(side).i_theta / model.free_inertia(side)) for side in (1, -1))
        self._fastest = self._linear.fastest if self._linear else float(p.omega.max(initial=0.0) * scale)

    @cached_property
    def as_printed(self) -> "Friction":
        """The same by Eqs. 21 and 22 as printed, for every model: with the magnitude of Σ m_i (-g + z''_i)."""
        other = copy(self)
        other._printed, other._required = True, {}
        for name in ("reactions", "demand", "_looks", "_rise"):
            other.__dict__.pop(name, None)
        if self._stretches.size:  # the motion between the states, which takes the longest, is the same
            signs = (other,) if "_looks" in self.__dict__ else (self, other)
            for each, looks in zip(signs, self._looks_of(*signs), strict=True):
                each.__dict__["_looks"] = looks
        return other

    @cached_property
    def reactions(self) -> Reactions:
        """Ground reactions at the states."""
        return self._reactions_at(self._states, self._rates)

    @cached_property
    def demand(self) -> Array:
        """|ΣF_x| / ΣF_z at the states, shape (n_states,); infinite if the ground would have to pull."""
        return _coefficient(self._angle(self.reactions))

    def required(self, window: float = 0.0) -> float:
        """Return the largest demand of the continuous motion, except for `window` seconds after each impact.

        Raises
        ------
        InputError
            If the window is negative or not finite, or the model is too fast for the sampling.
        """
        window = checked_positive("window", window, "s", zero=True)
        if window not in self._required:
            self._required[window] = self._required_after(window)
        return self._required[window]

    def _required_after(self, window: float) -> float:
        if not self._stretches.size:
            return float(self.demand.max())
        start = self._after(window)
        looks = np.where(self._places[:, None] >= start, self._looks, -1.0)
        for k in np.flatnonzero((start > 0.0) & (start < 1.0)):
            # The first point outside the window also covers the start of the interval, in place of the point before.
            first = int(np.searchsorted(self._places, start[k]))
            looks[first, k] = max(looks[first, k], float(self._angles_within(int(k))([float(start[k])])[0]))
        best = float(looks.max())
        highest = looks.max(axis=0)
        above = np.where(start < 1.0, highest + self._rise, -1.0)
        may = np.flatnonzero(above > best * (1.0 + ROUNDING))
        for k in may[np.argsort(-highest[may])].tolist():  # from the highest, which leaves the fewest others
            if not 0.0 < best < 0.5 * math.pi:
                break
            if above[k] > best * (1.0 + ROUNDING):
                best = max(best, self._peak(k, int(np.argmax(looks[:, k])), float(start[k]))[1])
        return float(_coefficient(np.array(max(best, 0.0))))

    def sliding_time(self, mu: float) -> float | None:
        """Return the time at which the demand first exceeds `mu`, in s; None if it never does.

        Raises
        ------
        InputError
            If `mu` is not a positive number, or the model is too fast for the sampling.
        """
        coefficient = friction_coefficient(mu)
        limit = math.atan(coefficient)
        if not self._stretches.size:
            return float(self._states[0, TIME]) if self.demand[0] > coefficient else None
        for k in np.flatnonzero(self._looks.max(axis=0) + self._rise > limit).tolist():
            place = self._first_above(k, limit)
            if place is not None:
                begin, end = self._states[self._stretches[k] : self._stretches[k] + 2, TIME]
                return float(begin + place * (end - begin))
        return None

    def _first_above(self, k: int, limit: float) -> float | None:
        """Return the place in an interval at which the angle first exceeds a limit."""
        for look in range(self._places.size):
            below, above = float(self._places[max(look - 1, 0)]), float(self._places[look])
            angle = self._looks[look, k]
            if angle <= limit < angle + self._rise[k]:
                above, angle = self._peak(k, look, 0.0)
            if angle > limit:
                return self._crossing(self._angles_within(k), limit, below, above)
        return None

    @staticmethod
    def _crossing(angles_at: AnglesAt, limit: float, below: float, above: float) -> float:
        """Return the place between two places at which the angle, above the limit at the second, exceeds it."""
        from scipy.optimize import brentq

        if angles_at([below])[0] > limit:
            return below
        return float(brentq(lambda place: angles_at([place])[0] - limit, below, above, xtol=1e-12))  # pyright: ignore[reportArgumentType]

    def _peak(self, k: int, look: int, start: float) -> tuple[float, float]:
        """Return place and angle of the peak near one point of an interval, not before `start`."""
        low = max(float(self._places[max(look - 1, 0)]), start)
        high = float(self._places[min(look + 1, self._places.size - 1)])
        angles_at = self._angles_within(k)
        if low >= high:
            return high, float(angles_at([high])[0])
        top, places, angles = 0, np.zeros(0), np.zeros(0)
        for _ in range(ROUNDS):
            places = np.linspace(low, high, CLOSER)
            angles = angles_at(places.tolist())
            top = int(angles.argmax())
            low, high = places[max(top - 1, 0)], places[min(top + 1, CLOSER - 1)]
        best = float(places[top]), float(angles[top])
        if not 0 < top < CLOSER - 1:
            return best
        before, here, after = angles[top - 1 : top + 2]
        if before + after >= 2.0 * here:  # by rounding
            return best
        crown = float(places[top] + 0.5 * (high - places[top]) * (before - after) / (before - 2.0 * here + after))
        return max(best, (crown, float(angles_at([crown])[0])), key=lambda found: found[1])

    @cached_property
    def _stretches(self) -> NDArray[np.intp]:
        """First states of the intervals of positive length; events have zero length."""
        return np.flatnonzero(np.diff(self._states[:, TIME]) > 0.0)

    @cached_property
    def _places(self) -> Array:
        longest = float(np.diff(self._states[:, TIME]).max(initial=0.0))
        pieces = max(math.ceil(self._fastest * longest / MAX_PHASE_STEP), MIN_POINTS)
        if pieces > MAX_POINTS:
            raise InputError(
                f"The friction demand of {self._model.label} needs {pieces} points per step, above the limit of "
                f"{MAX_POINTS}: the model vibrates or decays at up to {self._fastest:.3g} rad/s, and steps last up to "
                f"{longest:.3g} s. Keep fewer modes, damp them less, or refine the record."
            )
        return np.linspace(0.0, 1.0, pieces + 1)

    @cached_property
    def _looks(self) -> Array:
        """Angles at places from 0 to 1 of every interval, shape (n_places, n_intervals)."""
        (found,) = self._looks_of(self)
        return found

    def _looks_of(self, *signs: "Friction") -> list[Array]:
        """Return `_looks` with each of some signs of the weight, from the same motion."""
        motion = self._motion_between(self._states)
        every = list(self._angles(self._states, self._rates, motion, self._places.tolist(), signs))
        return [np.stack(each) for each in zip(*every, strict=True)]

    @cached_property
    def _rise(self) -> Array:
        """Bound of the height of a peak in each interval above adjacent points: eight times that of a parabola."""
        return np.abs(np.diff(self._looks, 2, axis=0)).max(axis=0)

    def _after(self, window: float) -> Array:
        """Return the place in each interval where the window after the last impact ends: 0 before, above 1 beyond."""
        time = self._states[:, TIME]
        begin, length = time[self._stretches], np.diff(time)[self._stretches]
        impacts = np.append(-np.inf, time[1:][self._model.impacts(self._states)])
        last = impacts[np.searchsorted(impacts, begin, side="right") - 1]
        return np.maximum((last + window - begin) / length, 0.0)

    def _angles_within(self, k: int) -> AnglesAt:
        """Return the angles at rising places of one interval as a function of these."""
        pair = slice(self._stretches[k], self._stretches[k] + 2)
        states, rates = self._states[pair], self._rates[pair]
        motion = self._motion_between(states)

        def angles_at(places: Sequence[float]) -> Array:
            found = list(self._between(states, rates, motion, places))
            rows, moved = np.concatenate([inside for inside, _ in found]), found[0][1]
            if moved is None:
                return self._angle(self._reactions_at(rows, accelerations_at_states(self._model, rows)))
            return self._angle(
                self._reactions_at(rows, np.concatenate([each for _, each in found if each is not None]))
            )

        return angles_at

    def _motion_between(self, states: Array) -> IntervalsBetweenStates | None:
        """Return the motion between states where it is linear; None for a hysteretic spring."""
        return None if self._linear is None else self._linear.intervals(states)

    def _angles(
        self,
        states: Array,
        rates: Array,
        motion: IntervalsBetweenStates | None,
        places: Sequence[float],
        signs: Sequence["Friction"],
    ) -> Iterator[list[Array]]:
        """Yield the angles with each of some signs at rising places of every interval of positive length."""
        lasting = np.diff(states[:, TIME]) > 0.0
        for rows, moved in self._between(states, rates, motion, places):
            check_interruption()  # many stiff springs need many places
            inside = rows[lasting]
            known = accelerations_at_states(self._model, inside) if moved is None else moved[lasting]
            yield [each._angle(each._reactions_at(inside, known)) for each in signs]

    def _between(
        self, states: Array, rates: Array, motion: IntervalsBetweenStates | None, places: Sequence[float]
    ) -> Iterator[tuple[Array, Array | None]]:
        """Yield states at rising places of every interval, and accelerations if these do not follow from the states.

        The latter is the case for a hysteretic spring. Linear models are exact; otherwise a polynomial of fifth degree
        through both states is used.
        """
        steps = np.diff(states[:, [TIME, GROUND, RISE]], axis=0)
        exact = repeat(None) if motion is None else motion.along(places)
        for place, inside in zip(places, exact, strict=False):
            rows = states[:-1].copy()
            rows[:, [TIME, GROUND, RISE]] += place * steps
            if inside is None:
                yield rows, self._interpolated(rows, states, rates, place)
                continue
            rows[:, HEADER:] = inside
            if self._model.integrated:
                self._interpolated(rows, states, rates, place)
            yield rows, None

    def _interpolated(self, rows: Array, states: Array, rates: Array, place: float) -> Array:
        """Put polynomials into rows where the model is not linear; return the accelerations that they give."""
        layout = self._model.layout
        where, velocity = interpolated_columns(layout)
        value, slope, bend = quintic(states[:, where], states[:, velocity], rates, np.diff(states[:, TIME]), place)
        integrated = self._model.integrates(states[:-1, SIDE])
        rows[np.ix_(integrated, where)] = value[integrated]
        rows[np.ix_(integrated, velocity)] = slope[integrated]
        rows[:, HEADER + layout.core : HEADER + layout.memory] = 0.0
        return bend

    def _reactions_at(self, states: Array, rates: Array) -> Reactions:
        return (printed_reactions if self._printed else reactions)(self._model, states, rates)

    def _angle(self, forces: Reactions) -> Array:
        """Return the angle of the reaction from the vertical, 0 to π; unlike its tangent μ it is always finite."""
        support = np.abs(forces.vertical) if self._printed else forces.vertical
        return np.arctan2(np.abs(forces.horizontal), support)


def _coefficient(angle: Array) -> Array:
    upright = angle < 0.5 * math.pi
    return np.where(upright, np.tan(np.where(upright, angle, 0.0)), np.inf)
