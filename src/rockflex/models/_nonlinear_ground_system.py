"""The nonlinear models as hybrid systems for `rockflex.engine`; phases of those that slide or stand on springs."""

from collections.abc import Callable
from typing import Any

import numpy as np

from rockflex.engine.system import Event, StateLayout, System
from rockflex.foundation.arrays import Array
from rockflex.models._base_motion import horizontal_reaction
from rockflex.models._elements import CLOSED, QUARTER_TURN, internal_places, internal_variables_of_branches
from rockflex.models._ground_fields import DEPTH, GRIP, PRESSURE, PUSH, SPEED, STRETCH
from rockflex.models._nonlinear_system import Check, NonlinearRockingPhases, model_key, nonlinear_system_key
from rockflex.models._phase import Key
from rockflex.models._quantities import Quantities, joined_quantities
from rockflex.models._rocking_model import RockingModel
from rockflex.models._sliding import LOST, STICK, SlidingModel
from rockflex.models._spring_model import LIFTED, LOADED, RECEDING, SpringModel

Jump = Callable[[Array, float, float], tuple[Array, Key]]


def nonlinear_system(model: RockingModel, quantities: Quantities, extremes: Quantities | None = None) -> System:
    """Return a nonlinear model as a hybrid system.

    The outputs are the rotation, the quantities, and those of which the largest value counts: `extremes`, and the loss
    of support. A key is that of the model; with a hysteretic spring the sign of its velocity follows.
    """
    layout, most = model.layout, Quantities.none(model.layout.modes) if extremes is None else extremes
    parts = {f"state {k}": 1 for k in range(layout.size)}
    names = ("rotation", *(f"quantity {k}" for k in range(len(quantities))))
    names += (*(f"extreme {k}" for k in range(len(most))), "loss of support")
    on_rigid = NonlinearSlidingPhases if model.slip_marks else NonlinearRockingPhases
    kind = on_rigid if model.springs is None else NonlinearSpringPhases
    phases = kind(model, joined_quantities((quantities, most)))
    return System(
        StateLayout(**parts),
        names,
        phases.phase,
        nonlinear_system_key(model, model.start(CLOSED)),
        names[1 + len(quantities) :],
    )


class NonlinearSlidingPhases(NonlinearRockingPhases):
    """The phases of a model that slides on rigid ground."""

    model: SlidingModel
    heavier: SlidingModel

    def slips(self, key: Key, first: int) -> tuple[list[Check], tuple[Event, ...]]:
        """The base begins to slide, ends it, or loses its pressure on the ground (Coulomb)."""
        model, layout = self.model, self.model.layout
        model.bordered_system(model_key(model, key))  # raises an error if the base jams at a small rotation
        place = -1 - (model.bouc_wen is not None)
        slip, weight = key[place], model.properties.m_tot * model.gravity
        way = 1 if slip > 0 else -1
        if slip == STICK:
            targets = {each: _with(key, place, each) for each in (-1, 1)}
            names, scale = dict.fromkeys(targets, "slip"), model.friction * weight
        else:
            lost = abs(slip) == LOST
            target = _with(key, place, way if lost else LOST * way)
            targets, names, scale = {-1 if lost else 1: target}, {-1: "change", 1: "change"}, weight
        if key[0] == CLOSED:
            rows, heavy = (self.contact_rows(each, key) for each in (model, self.heavier))
            found = [
                self.event(names[each], rows[each], heavy[each] - rows[each], target, scale)
                for each, target in targets.items()
            ]
            checks = list[Check]()
        else:
            nothing, kind = np.zeros(layout.size), GRIP if slip == STICK else PRESSURE
            found = [Event(names[each], nothing, target, scale=scale) for each, target in targets.items()]
            checks = [(first + k, kind, 0, float(each), 0.0, 0.0, -1) for k, each in enumerate(targets)]
        if slip != STICK:
            stops = np.eye(layout.size)
            stops[layout.slip + 1] = 0.0
            sticks = _with(key, place, -slip if abs(slip) == LOST else STICK)
            found.append(Event("stick", self.unit(layout.slip + 1, way), sticks, jump=stops))
        return checks, tuple(found)

    def contact_rows(self, model: SlidingModel, key: Key) -> dict[int, Array]:
        """Conditions of the slip in contact: rows over the state, a and 1, by their factors while the base rocks."""
        own = model_key(self.model, key)
        pressure = model.pressure(own)
        rows = {-1: -pressure, 1: pressure}
        if own[-1] == STICK:
            held = horizontal_reaction(model, own)
            # The ground pushes to the right on a base that would slide to the left.
            rows = {way: model.friction * pressure + way * held for way in (-1, 1)}
        found = {way: np.zeros(model.layout.size + 2) for way in rows}
        for way, row in rows.items():
            found[way][[*range(model.layout.moving), -2, -1]] = row
        return found


class NonlinearSpringPhases(NonlinearRockingPhases):
    """The phases of a model on springs."""

    model: SpringModel

    def ends_of(self, key: Key) -> tuple[list[Any], list[Check], tuple[Event, ...]]:
        """Limits of the rotation, of which there are none, conditions that are not linear, and all events."""
        checks, events = list[Check](), list[Event]()
        for event, check in (*self.of_springs(key), *self.of_slip(key), *self.of_elements(key)):
            if check is not None:
                checks.append((len(events), *check))
            events.append(event)
        for way in (-1.0, 1.0):
            events.append(Event("overturning", self.rotation(way), None, QUARTER_TURN, scale=QUARTER_TURN))
        if self.model.bouc_wen is not None:
            events.append(self.reversal(key))
        return [], checks, tuple(events)

    def checked(
        self, name: str, target: Key, scale: float, *check: float, jump: Jump | None = None
    ) -> tuple[Event, tuple[Any, ...]]:
        """An event whose condition the field computes: its kind, what it is of, its factor, and a limit."""
        kind, number, factor, *limit = check
        event = Event(name, np.zeros(self.model.layout.size), target, scale=scale, jump=jump)
        place, share, memory = limit or (0.0, 0.0, -1)
        return event, (int(kind), int(number), float(factor), place, share, memory)

    @property
    def weight(self) -> float:
        """m_tot g, N."""
        return self.model.properties.m_tot * self.model.gravity

    @property
    def settlement(self) -> float:
        """That of the springs under the weight, m."""
        return self.weight / float(self.model.springs.stiffness.sum())

    def of_springs(self, key: Key) -> list[tuple[Event, tuple[Any, ...] | None]]:
        """A spring unloads, the base leaves it, or comes back to it."""
        springs, found = self.model.springs, list[tuple[Event, tuple[Any, ...] | None]]()
        for j, branch in enumerate(key[1 : springs.n + 1]):
            edge, damped = j in (0, springs.n - 1), springs.damping[j] > 0.0
            opens, closes = ("uplift", "impact") if edge else ("change", "change")
            on = {each: _with(key, 1 + j, each) for each in (LOADED, RECEDING, LIFTED)}
            if branch == LOADED:
                name, target = ("change", on[RECEDING]) if damped else (opens, on[LIFTED])
                found.append(self.checked(name, target, self.weight, PUSH, j, 1.0))
            elif branch == LIFTED:
                found.append(self.checked(closes, on[LOADED], self.settlement, DEPTH, j, 1.0))
            else:
                found.append(self.checked("change", on[LOADED], self.weight, PUSH, j, -1.0))
                found.append(self.checked(opens, on[LIFTED], self.settlement, DEPTH, j, -1.0))
        return found

    def of_slip(self, key: Key) -> list[tuple[Event, tuple[Any, ...] | None]]:
        """The base begins to slide, or ends it."""
        model, layout = self.model, self.model.layout
        if model.friction is None:
            return []
        place = model.springs.n + 1
        if key[place] == STICK:
            scale = float(model.friction.max()) * self.weight
            # The ground pushes to the right on a base that would slide to the left.
            return [self.checked("slip", _with(key, place, way), scale, GRIP, 0, way) for way in (-1, 1)]
        stops = np.eye(layout.size)
        stops[layout.slip + 1] = 0.0
        row = self.unit(layout.slip + 1, key[place])
        return [(Event("stick", row, _with(key, place, STICK), jump=stops), None)]

    def of_elements(self, key: Key) -> list[tuple[Event, tuple[Any, ...] | None]]:
        """An element takes another branch."""
        model, found = self.model, list[tuple[Event, tuple[Any, ...] | None]]()
        known = internal_places(model.elements)
        for k, each in enumerate(model.elements):
            place = model.springs.n + 2 + k
            memory = model.layout.memory + known[k] if k in known else -1
            for stop in each.limits(key[place]):
                target, way = _with(key, place, stop.branch), 1.0 if stop.upper else -1.0
                limit = STRETCH, k, way, stop.place, stop.internal_factor, memory
                scale = abs(stop.place) or self.settlement
                found.append(self.checked("change", target, scale, *limit, jump=self.kept(key, target)))
            way = each.direction(key[place])
            if way:
                target = _with(key, place, each.branch_at_rest(key[place]))
                found.append(self.checked("turn", target, 1.0, SPEED, k, way, jump=self.kept(key, target)))
        return found

    def kept(self, key: Key, target: Key) -> Jump:
        """The jump at which elements that yield keep their plastic stretch."""
        model, layout, known = self.model, self.model.layout, internal_places(self.model.elements)
        own = model_key(model, key)
        marks = internal_variables_of_branches(model.elements, model.element_key(model_key(model, target)))
        yielding = list[tuple[int, float, Array]]()
        for place, (each, taken) in enumerate(zip(model.elements, model.element_key(own)[1:], strict=True)):
            offset = each.reversal_offset(taken)
            if offset is not None:
                yielding.append((layout.memory + known[place], offset, model.stretch(place, model.stance_on(CLOSED))))

        def jump(state: Array, acceleration: float, vertical: float) -> tuple[Array, Key]:
            del acceleration, vertical
            row = np.concatenate((state[: layout.moving], (0.0, 1.0)))
            row = model.stretched(row[None])[0]
            for place, offset, stretch in yielding:
                state[place] = stretch @ row - offset
            for index, value in marks:
                state[layout.memory + index] = value
            return state, target

        return jump


def _with(key: Key, place: int, branch: int) -> Key:
    found = list(key)
    found[place] = branch
    return tuple(found)
