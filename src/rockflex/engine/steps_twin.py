"""The steps of `loops` and `steps.h` for phases that are not linear, in NumPy: slow, and a check of the compiled."""

from typing import Any

import numpy as np

from rockflex._arrays import Array
from rockflex.engine.field import Field, Jump
from rockflex.engine.system import Event
from rockflex.engine.tableau import DENSE, ERROR_3, ERROR_5, LAST, STAGES, A, C
from rockflex.engine.tables import Tables

TERMS = 8  # of the polynomial over a step
TRIAL = STAGES  # row of the room for a step


class Steps:
    """What `loops_twin.Phases` knows of phases that are not linear."""

    n: int
    states: int
    phases: list[Any]

    def drive(self, place: int, field: Field, floor: Array, counted: int) -> None:
        """Say that a phase is not linear: its field, the least sizes of its moving states, and states with rates."""
        self.phases[place].field, self.phases[place].floor, self.phases[place].counted = field, floor, counted

    def _field(self, place: int) -> Field:
        return self.phases[place].field

    def _events(self, place: int) -> tuple[Event, ...]:
        return self.phases[place].events

    def _tables(self, place: int) -> Tables:
        return self.phases[place].tables

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

    def begin(self, place: int, y: Array, more: Array) -> None:
        """Let the constant states add to the constants of the conditions."""
        self._field(place).enter_at(np.array(y[: self.n]), more)

    def rates(self, place: int, a: float, a_v: float, y: Array, out: Array, counted: bool) -> None:
        """The rates of the states."""
        out[: self.n] = self._field(place).rates_at(np.array(y[: self.n]), a, a_v, counted)[: self.n]

    def terms_of_rates(self, place: int, a: float, a_v: float, y: Array, out: Array) -> None:
        """The magnitudes of the terms of the rates."""
        out[: self.n] = self._field(place).sizes_at(np.array(y[: self.n]), a, a_v)[: self.n]

    def within(self, place: int, stage: int, h: float, y: Array, work: Array, out: Array) -> None:
        """The state at which a stage of a step has been evaluated."""
        m, rates = self.moving(place), np.asarray(work)[:STAGES]
        out[: self.n] = y[: self.n]
        out[:m] = y[:m] + h * (A[stage] @ rates[:, :m])

    def _stage(self, place: int, stage: int, h: float, shaking: Array, y: Array, work: Array, counted: bool) -> None:
        """Evaluate a stage at its state, which is kept where the end of the step will be."""
        self.within(place, stage, h, y, work, work[TRIAL])
        a, a_v = shaking[0] + shaking[1] * C[stage], shaking[2] + shaking[3] * C[stage]
        self.rates(place, a, a_v, work[TRIAL], work[stage], counted)

    def attempt(
        self, place: int, h: float, shaking: Array, y: Array, sizes: Array, work: Array, counted: bool
    ) -> float:
        """Take the stages of a step from the first one on; its end, and its error over the sizes of the states."""
        m, rates, end = self.moving(place), np.asarray(work)[:STAGES], np.asarray(work)[TRIAL]
        for stage in range(1, LAST + 1):
            self._stage(place, stage, h, shaking, y, work, counted)
        if counted:
            last = self.phases[place].counted
            end[m:last] = y[m:last] + h * (A[LAST] @ rates[:, m:last])
        end[self.n : self.n + 2] = shaking[0] + shaking[1], 1.0
        size = np.max((np.abs(y[:m]), np.abs(end[:m]), np.asarray(sizes)[:m], self.phases[place].floor), axis=0)
        third, fifth = (((h * (each @ rates[:13, :m]) / size) ** 2).sum() for each in (ERROR_3, ERROR_5))
        return 0.0 if fifth == 0.0 else float(fifth / np.sqrt((fifth + 0.01 * third) * m))

    def bend(self, place: int, h: float, shaking: Array, y: Array, work: Array, series: Array, counted: bool) -> None:
        """Fill the series with the polynomials of the states over the step that was attempted."""
        rates, end = np.asarray(work)[:STAGES], np.array(work[TRIAL])
        count = self.phases[place].counted if counted else self.moving(place)
        for stage in range(LAST + 1, STAGES):
            self._stage(place, stage, h, shaking, y, work, counted)
        np.asarray(work)[TRIAL] = end
        rise = end[:count] - y[:count]
        first, last = h * rates[0, :count], h * rates[LAST, :count]
        nested = rise, first - rise, 2.0 * rise - first - last, *(h * (DENSE @ rates[:, :count]))
        u, v = np.polynomial.Polynomial((0.0, 1.0)), np.polynomial.Polynomial((1.0, -1.0))
        series[:TERMS, : self.states] = 0.0
        series[0, : self.n] = y[: self.n]
        for i in range(count):
            total = np.polynomial.Polynomial((0.0,))
            for k in range(6, -1, -1):
                total = nested[k][i] + (v if k % 2 == 0 else u) * total
            found = (u * total).coef
            series[1 : found.size, i] = found[1:]
            series[1, i] = first[i]
        series[0, self.n : self.n + 2], series[1, self.n] = (shaking[0], 1.0), shaking[1]

    def rows_of(
        self, place: int, outputs: bool, x: Array, before: Array, v: tuple[float, float, float], out: Array
    ) -> None:
        """The outputs or conditions of y, a and 1, those that are not linear as their rows say.

        Under vertical acceleration v[0] multiplies this term of the states and v[1] that before; v[2] is a term itself.
        """
        tables, shaken, n = self._tables(place), self.phases[place].shaken, self.n
        count = tables.outputs if outputs else len(self._events(place))
        x, before = np.asarray(x), np.asarray(before)
        table, given = tables.outs if outputs else tables.now, x[: n + 2]
        if shaken is not None and any(v):
            fed = v[0] * x[shaken.places] + v[1] * before[shaken.places]
            table, given = shaken.outs if outputs else shaken.now, np.concatenate((given, (v[2],), fed))
        out[:count] = table[0, :count] @ given

    def observe(self, place: int, a: float, a_v: float, y: Array, rates: Array, out: Array) -> None:
        """Replace the outputs that are not linear."""
        self._field(place).observe_at(np.array(y[: self.n]), np.array(rates[: self.n]), a, a_v, out)
