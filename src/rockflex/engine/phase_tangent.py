"""The derivatives of phases with respect to parameters, from the same phases of systems with other numbers."""

from collections import Counter
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from rockflex.engine.field import Jump
from rockflex.engine.system import VERTICAL, Event, Key, LinearPhase
from rockflex.engine.tables import rates_of, rows_of, spectral_radius_bound
from rockflex.engine.tangent_pass import Crossing
from rockflex.engine.tangent_steps import Motion
from rockflex.foundation.arrays import Array, Integers
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown

CENTRAL = {-3: -1 / 60, -2: 9 / 60, -1: -45 / 60, 1: 45 / 60, 2: -9 / 60, 3: 1 / 60}
ONE_SIDED = {0: -147 / 60, 1: 360 / 60, 2: -450 / 60, 3: 400 / 60, 4: -225 / 60, 5: 72 / 60, 6: -10 / 60}
"""Weights of values at so many steps of a parameter, whose sum over the step is the derivative, to the sixth order."""
KINK = {-3: 1 / 6, -2: -1.0, -1: 5 / 2, 1: 5 / 2, 2: -1.0, 3: 1 / 6}
"""The same of their differences from the middle, whose sum is the jump of the slope there: zero to the fifth order."""
BENT, NOTHING = 1e-5, 1e-5  # of the largest number of a row: such a jump is none of rounding; of all rows: rounding
NEAR = 1e-5  # of the size of a state: a step for the slopes of a jump
SMALL = 0.125  # rad of the fastest motion in the smallest step
LEFT_OUT = 1e-18  # of a series of an exponential, beyond which
SPARE = 3  # terms more are summed
FOR_EVER = 26  # doublings of that step: a decay


class PhaseNumbers(NamedTuple):
    """The numbers of a phase of S systems.

    Parameters
    ----------
    rates, rows
        [A f c], shape (S, n, n + 2); of outputs and then of conditions [C d e], (S, m + e, n + 2).
    rates_v, rows_v
        The same for the vertical acceleration, without the column of 1: [A_v f_v] and [C_v d_v].
    """

    rates: Array
    rows: Array
    rates_v: Array
    rows_v: Array

    def at(self, places: Integers) -> "PhaseNumbers":
        """Those of some systems."""
        return PhaseNumbers(*(each[places] for each in self))

    def by_scale(self) -> "PhaseNumbers":
        """Their derivatives with respect to the logarithm of a factor on both accelerations."""
        found = PhaseNumbers(np.zeros_like(self.rates), np.zeros_like(self.rows), self.rates_v, self.rows_v)
        found.rates[..., -2], found.rows[..., -2] = self.rates[..., -2], self.rows[..., -2]
        return found


def numbers_of_phase(phase: LinearPhase) -> PhaseNumbers:
    """Return the numbers of a phase of a stack of systems."""
    rates, rows = rates_of(phase), rows_of(phase)
    rates_v, rows_v = np.zeros_like(rates[..., :-1]), np.zeros_like(rows[..., :-1])
    m = phase.d.shape[1]
    for name, to in zip(
        VERTICAL, (rates_v[..., :-1], rates_v[..., -1], rows_v[:, :m, :-1], rows_v[:, :m, -1]), strict=True
    ):
        if getattr(phase, name) is not None:
            to[:] = getattr(phase, name)
    for row, event in enumerate(phase.events, m):
        rows_v[:, row, -1] = event.direct_v
        if event.row_v is not None:
            rows_v[:, row, :-1] = event.row_v
    return PhaseNumbers(rates, rows, rates_v, rows_v)


class Neighbours(NamedTuple):
    """A phase of K systems with other numbers, and the weights of P derivatives.

    Parameters
    ----------
    phases
        The phase of stacks of systems.
    places
        Of each stack, which of the K systems are in it, and their places there.
    weights
        Shape (P, K); those of a parameter sum up to zero.
    kinks
        Weights by which a jump of the slope is found, shape (P, K); zero where the neighbours are on one side.
    """

    phases: Sequence[LinearPhase]
    places: Sequence[tuple[Integers, Integers]]
    weights: Array
    kinks: Array

    def slopes(self, values: Array, own: Array) -> Array:
        """Derivatives of a matrix from K values and the own one, (P, n, ...); NaN by a parameter at a kink."""
        apart = values - own
        found, jumps = _weighed(self.weights, apart), np.abs(_weighed(self.kinks, apart))
        sizes = np.abs(own) + np.abs(found)
        of_rows, of_all = (np.max(sizes, axis=of, keepdims=True, initial=0.0) for of in (-1, (-2, -1)))
        bent = (jumps > BENT * (of_rows + NOTHING * of_all)).reshape(len(found), -1).any(axis=1)
        found[bent] = np.nan
        return found


def slopes_of_numbers(phase: LinearPhase, own: PhaseNumbers, neighbours: Neighbours) -> PhaseNumbers:
    """Return the derivatives of the numbers of a phase of one system, with a first axis for P parameters.

    What a parameter does not change has no derivative, to the bit. Conditions that some neighbours lack have NaN, and
    so have rates whose slopes on both sides of the parameter differ.
    """
    m, names = phase.d.shape[1], list(_events_by_name(phase))
    given = PhaseNumbers(*(np.zeros((neighbours.weights.shape[1], *each.shape[1:])) for each in own))
    for each, (among, where) in zip(neighbours.phases, neighbours.places, strict=True):
        known = numbers_of_phase(each).at(where)
        listed = list(_events_by_name(each))
        if listed != names:
            rows = [m + listed.index(name) if name in listed else -1 for name in names]
            order = np.concatenate((np.arange(m, dtype=np.int64), np.array(rows, dtype=np.int64)))
            lacks = order < 0
            known = known._replace(rows=known.rows[:, order], rows_v=known.rows_v[:, order])
            known.rows[:, lacks] = known.rows_v[:, lacks] = np.nan
        for to, values in zip(given, known, strict=True):
            to[among] = values
    slopes = (_weighed(neighbours.weights, values - base) for values, base in zip(given[1:], own[1:], strict=True))
    return PhaseNumbers(neighbours.slopes(given.rates, own.rates), *slopes)


def _weighed(weights: Array, values: Array) -> Array:
    """Sums of K values with P sets of weights, shape (P, ...)."""
    return np.asarray(np.tensordot(weights, values, 1), dtype=np.float64)


def _events_by_name(phase: LinearPhase) -> dict[tuple[str, Key | None, int], Event]:
    """The events of a phase by name and target; several that have both alike are counted."""
    found, often = dict[tuple[str, Key | None, int], Event](), Counter[tuple[str, Key | None]]()
    for event in phase.events:
        known = event.name, event.target
        found[*known, often[known]] = event
        often[known] += 1
    return found


def motion_of_phase(
    phase: LinearPhase, place: int, h: float, neighbours: Neighbours | None, *, free: bool, upward: int
) -> Motion:
    """Return a phase with its derivatives by the scale of the record and by parameters, and the tables of its steps.

    Parameters
    ----------
    phase, place
        The phase, and which system of its stack.
    h
        The time step, s.
    neighbours
        Of the parameters, if there are any.
    free
        Whether the motion without excitation is followed instead, which needs no derivatives of the tables.
    upward
        The longest step that there are tables for is 2^upward samples.
    """
    own = numbers_of_phase(phase).at(np.array([place]))
    slopes = own.by_scale()
    if neighbours is not None:
        more = slopes_of_numbers(phase, own, neighbours)
        slopes = PhaseNumbers(*(np.concatenate(pair) for pair in zip(slopes, more, strict=True)))
    rates = own.rates[0]
    speed = _speed(rates)
    tables, changes, whole = _steps(rates, slopes.rates[:0] if free else slopes.rates, h, speed, upward)
    scales = np.array([float(np.broadcast_to(event.scale, len(phase.A))[place]) for event in phase.events])
    return Motion(
        rates, own.rows[0], own.rates_v[0], own.rows_v[0], *slopes, scales, tables, changes, whole, h, speed
    )  # fmt: skip


def _speed(rates: Array) -> float:
    """How fast a motion may turn or grow, 1/s."""
    A = rates[:, :-2]
    size = float(np.abs(A).max(initial=0.0))
    return size * float(spectral_radius_bound(A[None] / size)[0]) if size else 0.0


def _steps(rates: Array, slopes: Array, h: float, speed: float, upward: int) -> tuple[Array, Array, int]:
    """Return the changes of [y, a, a', 1] over steps that double, their derivatives, and which of them is a sample.

    Shapes (L, n + 3, n) and (L, n + 3, P, n), column after column.
    """
    whole = max(0, int(np.ceil(np.log2(max(speed * h / SMALL, 1e-300)))))
    with np.errstate(over="ignore", invalid="ignore"):  # steps that a run of finite motion does not take
        changes, derived = _doubled(rates, slopes, h / 2.0**whole, speed, whole + upward)
    n = len(rates)
    return (
        np.ascontiguousarray(np.array(changes)[:, :n].transpose(0, 2, 1)),
        np.ascontiguousarray(np.array(derived)[:, :, :n].transpose(0, 3, 1, 2)),
        whole,
    )


def _doubled(rates: Array, slopes: Array, step: float, speed: float, times: int) -> tuple[list[Array], list[Array]]:
    """Return exp(M t) - 1 and its derivatives for a small step t, and for steps that double so many times.

    M has the rates of [y, a, a', 1]. What is left of exp without 1 keeps the digits of small changes.
    """
    n, P = len(rates), len(slopes)
    M, dM = np.zeros((n + 3, n + 3)), np.zeros((P, n + 3, n + 3))
    for to, of in ((M, rates), (dM, slopes)):
        to[..., :n, : n + 1], to[..., :n, -1] = of[..., : n + 1] * step, of[..., -1] * step
    M[n, n + 1] = step
    terms, left = 1, speed * step
    while left > LEFT_OUT:
        terms += 1
        left *= speed * step / terms
    term, more, total, derived = M, dM, M.copy(), dM.copy()
    for k in range(2, terms + SPARE):
        term, more = term @ M / k, (more @ M + term @ dM) / k
        total, derived = total + term, derived + more
    found, of_found = [total], [derived]
    for _ in range(times):
        total, derived = total @ total + 2.0 * total, derived @ total + total @ derived + 2.0 * derived
        found.append(total)
        of_found.append(derived)
    return found, of_found


def brought_to_rest(
    phase: LinearPhase, place: int, neighbours: Neighbours | None, y: Array, s: Array
) -> tuple[Array, Array]:
    """Return the state that a motion without excitation approaches, and its tangents, shapes (n,) and (P, n)."""
    own = numbers_of_phase(phase).at(np.array([place]))
    slopes = own.by_scale().rates
    if neighbours is not None:
        slopes = np.concatenate((slopes, slopes_of_numbers(phase, own, neighbours).rates))
    n, speed = len(y), max(_speed(own.rates[0]), 1e-9)
    changes, derived = _doubled(own.rates[0], slopes, SMALL / speed, speed, FOR_EVER)
    start = np.concatenate((y, (0.0, 0.0, 1.0)))
    return y + (changes[-1] @ start)[:n], s + s @ changes[-1][:n, :n].T + (derived[-1] @ start)[:, :n]


def crossing_of_event(
    phase: LinearPhase, place: int, number: int, target: Key | None, neighbours: Neighbours | None
) -> Crossing:
    """Return what an event that led to a phase makes of the state, with its derivatives.

    Raises
    ------
    InputError
        If some of the neighbours lack the event.
    """
    event, P = phase.events[number], 0 if neighbours is None else len(neighbours.weights)
    name = list(_events_by_name(phase))[number]
    others = list[tuple[Integers, Integers, Event, LinearPhase]]()
    if neighbours is not None:
        for each, (among, where) in zip(neighbours.phases, neighbours.places, strict=True):
            found = _events_by_name(each).get(name)
            if found is None:
                raise InputError(
                    f"Near its value a parameter decides whether there is an event {shown(name[0])}, which happens in "
                    "the run: no derivative tells what it does. Change the parameter a little.",
                    field="parameters",
                )
            others.append((among, where, found, each))
    if not _is_function(event):
        own, slopes = _matrix_of(event, target), None
        if own is not None and neighbours is not None:
            given = np.zeros((neighbours.weights.shape[1], *own.shape[1:]))
            for among, where, found, each in others:
                matrix = _matrix_of(found, target)
                given[among] = (
                    np.eye(own.shape[1])
                    if matrix is None
                    else np.broadcast_to(matrix, (len(each.A), *own.shape[1:]))[where]
                )
            changed = neighbours.slopes(given, own[place])
            slopes = np.concatenate((np.zeros((1, *own.shape[1:])), changed))
        return Crossing(None if own is None else own[place], slopes)
    alone = [(found, int(k)) for among, _, found, _ in others for k in among]  # a function is of one system

    def ask(y: Array, a: float, a_v: float) -> tuple[Array, Array]:
        moved = np.zeros((1 + P, len(y)))
        if neighbours is not None:
            first = state_after(event, y, a, a_v, target)
            for found, k in alone:
                moved[1:] += np.outer(neighbours.weights[:, k], state_after(found, y, a, a_v, target) - first)
        return slopes_of_jump(event, y, a, a_v, target), moved

    return Crossing(ask=ask)


def _is_function(event: Event) -> bool:
    return callable(event.jump) or isinstance(event.jump, Jump)


def _matrix_of(event: Event, target: Key | None) -> Array | None:
    """The matrices, (S, n, n), by which states are multiplied at an event that led to a phase; None if by none."""
    jump, rest = event.jump, event.rest
    assert jump is None or isinstance(jump, np.ndarray)
    if rest is None or target != rest.target or target == event.target or rest.jump is None:
        return jump
    return rest.jump if jump is None else rest.jump @ jump


def state_after(event: Event, y: Array, a: float, a_v: float, target: Key | None) -> Array:
    """Return the state after an event, whose jump is a function, that led to a phase."""
    del target
    if isinstance(event.jump, Jump):
        found = y.copy()
        event.jump.apply_at(found, a, a_v)
        return found
    return event.apply_jump(y, a, a_v)[0]


def slopes_of_jump(event: Event, y: Array, a: float, a_v: float, target: Key | None) -> Array:
    """Return the derivatives of that with respect to the state before it, by differences, shape (n, n)."""
    sizes = NEAR * np.maximum(np.abs(y), np.abs(y).max(initial=0.0) * 1e-6)
    columns = np.zeros((len(y), len(y)))
    for place, size in enumerate(sizes):
        if size:
            ends = []
            for way in (1.0, -1.0):
                moved = y.copy()
                moved[place] += way * size
                ends.append((moved[place], state_after(event, moved, a, a_v, target)))
            columns[:, place] = (ends[0][1] - ends[1][1]) / (ends[0][0] - ends[1][0])
    return columns
