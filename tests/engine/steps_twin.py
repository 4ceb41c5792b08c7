"""The steps of `loops` and `steps.h` for phases that are not linear, in NumPy: slow, and a check of the compiled."""

from typing import Any

import numpy as np

from rockflex.engine.field import Field, Jump
from rockflex.engine.system import Event, up8
from rockflex.engine.tableau import (
    DENSE,
    END,
    ERROR_3,
    ERROR_5,
    FOUND,
    LARGEST,
    LAST,
    MORE,
    PLACE,
    ROWS,
    STAGES,
    START,
    A,
    C,
)
from rockflex.foundation.arrays import Array

TERMS = 8  # of the polynomial over a step


class Steps:
    """What `loops_twin.Phases` knows of phases that are not linear."""

    phases: list[Any]
    step: tuple[float, float, float, float, float]  # its length, and the accelerations at its start with their changes

    acting: Any  # what is summed from, and a term of it
    term: Any

    def __init__(self, states: int, outputs: int) -> None:
        self.n, self.states = states, up8(states + 2)
        self.rows, self.found = np.zeros((ROWS, self.states)), np.zeros((FOUND, outputs))

    def set_field(self, place: int, field: Field, floor: Array, counted: int) -> None:
        """Say that a phase is not linear: its field, the least sizes of its moving states, and states with rates."""
        self.phases[place].field, self.phases[place].floor, self.phases[place].counted = field, floor, counted
        if self.found.shape[1] < len(self._events(place)):
            self.found = np.zeros((FOUND, len(self._events(place))))

    def _field(self, place: int) -> Field:
        return self.phases[place].field

    def _events(self, place: int) -> tuple[Event, ...]:
        return self.phases[place].events

    def nonlinear(self, place: int) -> bool:
        """Whether a phase is not linear."""
        return self.phases[place].field is not None

    def moving(self, place: int) -> int:
        """Number of states on which the rates of a phase depend."""
        return self.phases[place].floor.size

    def leap(self, place: int, event: int, y: Array, a: float, a_v: float) -> int:
        """Do what the `Jump` of an event says; -2 if it has none."""
        jump = self._events(place)[event].jump
        return jump.apply_at(y, a, a_v) if isinstance(jump, Jump) else -2

    def begin(self, place: int) -> None:
        """Let the constant states add to the constants of the conditions."""
        self._field(place).enter_at(self._state(START), self.found[MORE])

    def _state(self, row: int) -> Array:
        return self.rows[row, : self.n].copy()

    def rates(self, place: int, a: float, a_v: float, at: int, to: int, counted: bool) -> None:
        """Compute the rates of the states in a row."""
        self.rows[to, : self.n] = self._field(place).rates_at(self._state(at), a, a_v, counted)[: self.n]

    def terms_of_rates(self, place: int, a: float, a_v: float, at: int, to: int) -> None:
        """Compute the magnitudes of the terms of the rates."""
        self.rows[to, : self.n] = self._field(place).sizes_at(self._state(at), a, a_v)[: self.n]

    def within(self, place: int, stage: int, row: int = PLACE) -> None:
        """Compute the state at which a stage of a step has been evaluated."""
        m = self.moving(place)
        self.rows[row] = self.rows[START]
        self.rows[row, :m] += self.step[0] * (A[stage] @ self.rows[:STAGES, :m])

    def _stage(self, place: int, stage: int, row: int, counted: bool) -> None:
        """Evaluate a stage at its state, which is kept in a row."""
        _, a, rise, v, climb = self.step
        self.within(place, stage, row)
        self.rates(place, a + rise * C[stage], v + climb * C[stage], row, stage, counted)

    @np.errstate(over="ignore", invalid="ignore")
    def attempt(self, place: int, length: float, a: float, rise: float, v: float, climb: float, counted: bool) -> float:
        """Take the stages of a step from the first one on; its error over the sizes of the states."""
        m, last, rates, start, end = (
            self.moving(place),
            self.phases[place].counted,
            self.rows[:STAGES],
            self.rows[START],
            self.rows[END],
        )
        self.step = length, a, rise, v, climb
        for stage in range(1, LAST + 1):
            self._stage(place, stage, END, counted)
        if counted:
            end[m:last] = start[m:last] + length * (A[LAST] @ rates[:, m:last])
        end[self.n : self.n + 2] = a + rise, 1.0
        floor = self.phases[place].floor
        size = np.max((np.abs(start[:m]), np.abs(end[:m]), self.rows[LARGEST, :m], floor), axis=0)
        third, fifth = (((length * (each @ rates[:13, :m]) / size) ** 2).sum() for each in (ERROR_3, ERROR_5))
        return 0.0 if fifth == 0.0 else float(fifth / np.sqrt((fifth + 0.01 * third) * m))

    @np.errstate(over="ignore", invalid="ignore")
    def bend(self, place: int, counted: bool, series: Array) -> None:
        """Fill the series with the polynomials of the states over the step that was attempted."""
        h, a, rise, _, _ = self.step
        rates, start = self.rows[:STAGES], self.rows[START]
        count = self.phases[place].counted if counted else self.moving(place)
        for stage in range(LAST + 1, STAGES):
            self._stage(place, stage, PLACE, counted)
        change = self.rows[END, :count] - start[:count]
        first, last = h * rates[0, :count], h * rates[LAST, :count]
        nested = change, first - change, 2.0 * change - first - last, *(h * (DENSE @ rates[:, :count]))
        u, v = np.polynomial.Polynomial((0.0, 1.0)), np.polynomial.Polynomial((1.0, -1.0))
        series[:TERMS, : self.states] = 0.0
        series[0, : self.n] = start[: self.n]
        for i in range(count):
            total = np.polynomial.Polynomial((0.0,))
            for k in range(6, -1, -1):
                total = nested[k][i] + (v if k % 2 == 0 else u) * total
            found = (u * total).coef
            series[1 : found.size, i] = found[1:]
            series[1, i] = first[i]
        series[0, self.n : self.n + 2], series[1, self.n] = (a, 1.0), rise

    def look(self, place: int, outputs: bool, v: tuple[float, float], k: int, before: int, at: int, to: int) -> None:
        """Compute the outputs or conditions of a row that has y, a and 1, those that are not linear as their rows say.

        It is the term of order k of a series under the vertical acceleration v, whose term before is another row.
        """
        content, count = self.acting(place, v), self.phases[place].outputs if outputs else len(self._events(place))
        found = (content.outs if outputs else content.now)[0] @ self.term(place, v, k, self.rows[before], self.rows[at])
        self.found[to, :count] = found[:count]

    def observe(self, place: int, a: float, a_v: float, at: int, rates: int, to: int) -> None:
        """Replace the outputs that are not linear."""
        self._field(place).observe_at(self._state(at), self._state(rates), a, a_v, self.found[to])

    def check(self, place: int, a: float, a_v: float, at: int, rates: int, to: int) -> None:
        """Replace the conditions that are not linear."""
        self._field(place).conditions_at(self._state(at), self._state(rates), a, a_v, self.found[to])
