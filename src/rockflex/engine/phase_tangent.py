"""The derivatives of a phase with respect to parameters: of its matrices, its conditions and its jumps."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rockflex.engine.field import Jump
from rockflex.engine.system import VERTICAL, Event, Key, LinearPhase
from rockflex.foundation.arrays import Array
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown

CENTRAL = {-3: -1 / 60, -2: 9 / 60, -1: -45 / 60, 1: 45 / 60, 2: -9 / 60, 3: 1 / 60}
ONE_SIDED = {0: -147 / 60, 1: 360 / 60, 2: -450 / 60, 3: 400 / 60, 4: -225 / 60, 5: 72 / 60, 6: -10 / 60}
"""Weights of values at so many steps of a parameter, whose sum over the step is the derivative, to the sixth order."""
NEAR = 1e-5  # of the size of a state: a step for the slopes of a jump


@dataclass(frozen=True, eq=False)
class PhaseTangent:
    """The derivatives of a phase with respect to P parameters: its arrays with a first axis more.

    `jumped` returns the derivative of the state after an event, by the number of the event, for a given state before it
    and both accelerations, shape (P, n); `target` is the key that then follows.
    """

    arrays: Mapping[str, Array]
    events: Sequence[Mapping[str, Array]]
    jumped: Callable[[int, Array, float, float, Key | None], Array]

    def __getitem__(self, name: str) -> Array:
        return self.arrays[name]


NUMBERS = ("A", "f", "c", "C", "d", "e", *VERTICAL)
OF_EVENTS = ("row", "constant", "direct", "row_v", "direct_v")


def scale_tangent(phase: LinearPhase) -> PhaseTangent:
    """Return the derivatives of a phase with respect to the logarithm of a factor on both accelerations."""
    takes = {"f", "d", *VERTICAL}
    arrays = {name: number_of_phase(phase, name) * (name in takes) for name in NUMBERS}
    of_events = ("direct", "row_v", "direct_v")
    events = [
        {name: number_of_event(each, name, phase) * (name in of_events) for name in OF_EVENTS} for each in phase.events
    ]
    still = np.zeros((1, len(phase.A)))

    def jumped(number: int, y: Array, a: float, a_v: float, target: Key | None) -> Array:
        del number, y, a, a_v, target
        return still

    return PhaseTangent(
        {name: each[None] for name, each in arrays.items()},
        [{name: np.asarray(number)[None] for name, number in each.items()} for each in events],
        jumped,
    )


def phase_tangent(
    phase: LinearPhase, phases: Sequence[Mapping[int, LinearPhase]], weights: Sequence[Mapping[int, float]]
) -> PhaseTangent:
    """Return the derivatives of a phase, from the phase at a few steps of each parameter and their weights.

    `jumped` raises an InputError at an event that some of them lack.
    """
    events = [{step: _events_by_name(each) for step, each in some.items()} for some in phases]

    def taken(value: Callable[[int, int], Any]) -> Array:
        found = list[Array]()
        for k, each in enumerate(weights):
            of_steps = {step: np.asarray(value(k, step)) for step in each}
            first = next(iter(of_steps.values()))  # what a parameter does not change has no derivative, to the bit
            found.append(np.asarray(sum(weight * (of_steps[step] - first) for step, weight in each.items())))
        return np.array(found)

    def jumped(number: int, y: Array, a: float, a_v: float, target: Key | None) -> Array:
        def after(k: int, step: int) -> Array:
            if names[number] not in events[k][step]:
                raise InputError(
                    f"Near its value a parameter decides whether there is an event {shown(names[number][0])}, which "
                    "happens in the run: no derivative tells what it does. Change the parameter a little.",
                    field="parameters",
                )
            return state_after(events[k][step][names[number]], y, a, a_v, target)[0]

        return taken(after)

    def of_event(number: int, name: str) -> Array:
        def value(k: int, step: int) -> Array:
            event = events[k][step].get(names[number])
            like = number_of_event(phase.events[number], name, phase)
            return np.full_like(like, np.nan) if event is None else number_of_event(event, name, phase)

        return taken(value)

    names = list(_events_by_name(phase))
    arrays = {name: taken(lambda k, step, name=name: number_of_phase(phases[k][step], name)) for name in NUMBERS}
    return PhaseTangent(
        arrays, [{name: of_event(number, name) for name in OF_EVENTS} for number in range(len(names))], jumped
    )


def _events_by_name(phase: LinearPhase) -> dict[tuple[str, Key | None, int], Event]:
    """The events of a phase by name and target; several that have both alike are counted."""
    found, often = dict[tuple[str, Key | None, int], Event](), Counter[tuple[str, Key | None]]()
    for event in phase.events:
        known = event.name, event.target
        found[*known, often[known]] = event
        often[known] += 1
    return found


def joined_tangents(parts: Sequence[PhaseTangent]) -> PhaseTangent:
    """Return the derivatives of a phase with respect to the parameters of several parts, in their order."""
    if len(parts) == 1:
        return parts[0]
    arrays = {name: np.concatenate([each.arrays[name] for each in parts]) for name in NUMBERS}
    events = [
        {name: np.concatenate([each.events[k][name] for each in parts]) for name in OF_EVENTS}
        for k in range(len(parts[0].events))
    ]

    def jumped(number: int, y: Array, a: float, a_v: float, target: Key | None) -> Array:
        return np.concatenate([each.jumped(number, y, a, a_v, target) for each in parts])

    return PhaseTangent(arrays, events, jumped)


def number_of_phase(phase: LinearPhase, name: str) -> Array:
    """Return an array of a phase; zero if it is left out."""
    found = getattr(phase, name)
    like = {"A_v": "A", "f_v": "f", "C_v": "C", "d_v": "d"}
    return np.zeros_like(getattr(phase, like[name])) if found is None else found


def number_of_event(event: Event, name: str, phase: LinearPhase) -> Array:
    """Return a number or a row of an event; zero if it is left out."""
    found = getattr(event, name)
    return np.zeros(len(phase.A)) if found is None else np.asarray(found, dtype=float)


def state_after(event: Event, y: Array, a: float, a_v: float, target: Key | None) -> tuple[Array, int]:
    """The state after an event that led to a phase, and what a compiled jump said."""
    if isinstance(event.jump, Jump):
        found = y.copy()
        return found, event.jump.apply_at(found, a, a_v)
    if callable(event.jump):
        return event.apply_jump(y, a, a_v)[0], 0
    rest = event.rest
    found = y if event.jump is None else event.jump @ y
    if rest is not None and target == rest.target and target != event.target and rest.jump is not None:
        found = rest.jump @ found
    return found, 0


def slopes_of_jump(event: Event, y: Array, a: float, a_v: float, target: Key | None) -> Array:
    """The derivatives of the state after an event with respect to the one before it, shape (n, n)."""
    if not callable(event.jump) and not isinstance(event.jump, Jump):
        found = np.eye(len(y)) if event.jump is None else event.jump
        rest = event.rest
        chosen = rest is not None and target == rest.target and target != event.target and rest.jump is not None
        return rest.jump @ found if chosen and rest is not None and rest.jump is not None else found
    sizes = NEAR * np.maximum(np.abs(y), np.abs(y).max(initial=0.0) * 1e-6)
    columns = np.zeros((len(y), len(y)))
    for place, size in enumerate(sizes):
        if size:
            ends = []
            for way in (1.0, -1.0):
                moved = y.copy()
                moved[place] += way * size
                ends.append((moved[place], state_after(event, moved, a, a_v, target)[0]))
            columns[:, place] = (ends[0][1] - ends[1][1]) / (ends[0][0] - ends[1][0])
    return columns
