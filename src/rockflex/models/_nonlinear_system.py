"""The nonlinear models on rigid ground as hybrid systems: phases, events and outputs for `rockflex.engine`."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from rockflex.engine.system import Event, LinearPhase, NonlinearPhase
from rockflex.foundation.arrays import Array, Integers
from rockflex.foundation.constants import GRAVITY
from rockflex.models._elements import (
    CLOSED,
    LEFT,
    QUARTER_TURN,
    RIGHT,
    arm_of_element,
    base_equations_of,
    branches_of_moving_elements,
    direction_of_yielding,
    internal_count,
    internal_places,
    internal_variables_of_branches,
    is_in_reach,
)
from rockflex.models._field_numbers import field_numbers
from rockflex.models._fields import Change, Reversal, RockingField
from rockflex.models._ground_fields import GroundField
from rockflex.models._landing import GUARDED, landing_jump, landing_of_rule, rule_of_law
from rockflex.models._phase import Key
from rockflex.models._quantities import LINEAR, VERTICAL, Quantities, rows_of_quantities
from rockflex.models._rocking_model import RockingModel
from rockflex.models._vector_fields import field_of

TREMOR = 0.01  # m/s²: the error of a step is relative to the response to it, or to a larger motion so far
LIGHT = 0.05  # of the vertical reaction at rest: the least size of the loss of support
BARELY = 1e-10  # of that response: a velocity that is zero at a reversal

# A condition that is not linear, see `GroundField`: event, kind, number of a spring or an element, factor, and of a
# limit its place, the factor of an internal variable in it, and the place of that in the state, -1 if there is none.
Check = tuple[int, int, int, float, float, float, int]


def nonlinear_system_key(model: RockingModel, key: Key, state: Array | None = None) -> Key:
    """Return the key of a phase of the hybrid system from that of the model."""
    if model.bouc_wen is None:
        return key
    return (*key, -1 if state is not None and state[model.properties.n_modes] < 0.0 else 1)


def model_key(model: RockingModel, key: Key) -> Key:
    """Return the key of the model from that of a phase of the hybrid system."""
    return key if model.bouc_wen is None else key[:-1]


def states_with_branch_codes(model: RockingModel, keys: Sequence[Key], places: Integers, states: Array) -> Array:
    """Return states in which the internal variables that tell branches are those of their phases, at keys[places]."""
    marks, first = list[list[tuple[int, float]]](), internal_count(model.elements)
    for key in keys:
        own = model_key(model, key)
        of_ground = enumerate(model.marks(own), first)
        marks.append([*internal_variables_of_branches(model.elements, model.element_key(own)), *of_ground])
    if any(marks):
        states = states.copy()
        for place, of_phase in enumerate(marks):
            for index, value in of_phase:
                states[places == place, model.layout.memory + index] = value
    return states


class NonlinearRockingPhases:
    """The phases of a model."""

    def __init__(self, model: RockingModel, quantities: Quantities) -> None:
        self.model, self.quantities = model, quantities
        # All forces are linear in gravity, and the vertical acceleration of the ground acts like more of it.
        self.heavier = replace(model, gravity=model.gravity + 1.0)
        p, curved = model.properties, model.complete
        count = len(quantities)
        kinds = quantities.kinds.tolist() if curved else [LINEAR] * count
        self.numbers = field_numbers(
            model,
            [LINEAR, *kinds, VERTICAL if curved else LINEAR],
            np.vstack((np.zeros((1, 2)), quantities.levers, np.zeros((1, 2)))),
        )
        rotation = TREMOR / GRAVITY * p.m_tot * p.half_width / p.l0r
        fall = math.sqrt(p.l0r * GRAVITY / p.i_theta)
        hysteresis = [TREMOR / GRAVITY] * (model.bouc_wen is not None)
        velocities = TREMOR / p.omega
        base = [rotation, rotation * fall]
        if model.layout.slip >= 0:
            base += [TREMOR / fall**2, TREMOR / fall]
        if model.layout.heave >= 0:
            base += [rotation * p.half_width, rotation * p.half_width * fall]
        self.scale = np.concatenate((TREMOR / p.omega**2, velocities, base, hysteresis))
        light = LIGHT * p.resting_reaction
        self.curved = {
            place: light if kind == VERTICAL else 0.0 for place, kind in enumerate(self.numbers.kinds) if kind != LINEAR
        }
        self.barely = BARELY * float(velocities[0]) if p.n_modes else 0.0

    def phase(self, key: Key) -> LinearPhase | NonlinearPhase:
        """Return a phase: full contact, or rocking about one side."""
        stops, checks, events = self.ends_of(key)
        if self.model.integrates(key[0]):
            return self.integrated(key, stops, checks, events)
        return self.linear(key, events)

    def ends_of(self, key: Key) -> tuple[list[Any], list[Check], tuple[Event, ...]]:
        """Limits of the rotation that the first events have, conditions that are not linear, and all events."""
        stops, events = list[Any](), tuple[Event, ...]()
        if self.model.is_free(model_key(self.model, key)):
            stops, events = self.changes(key)
            events += (*self.ends(key), *self.turns(key))
        else:
            events = self.uplifts(key)
        checks, slips = self.slips(key, len(events))
        events += slips
        return stops, checks, (*events, self.reversal(key)) if self.model.bouc_wen is not None else events

    def linear(self, key: Key, events: tuple[Event, ...]) -> LinearPhase:
        """Contact of an elastic superstructure."""
        outputs, more = self.outputs(key)
        n, rates = self.model.layout.size, self.contact(self.model, key)
        found = LinearPhase(rates[:, :n], rates[:, n], rates[:, n + 1], *outputs, events, C_v=more[0], d_v=more[2])
        heavier = self.contact(self.heavier, key) - rates
        return replace(found, A_v=heavier[:, :n], f_v=heavier[:, n + 1]) if heavier.any() else found

    def contact(self, model: RockingModel, key: Key) -> Array:
        """The rates of the states in contact: rows with columns for the state, a and 1."""
        layout, own = model.layout, model_key(model, key)
        n, modes, rates = layout.size, np.arange(layout.modes), np.zeros((layout.size, layout.size + 2))
        columns = [*range(layout.moving), n, n + 1]
        of_motion = model.accelerations(own)
        rates[modes, layout.modes + modes] = 1.0
        rates[layout.modes : 2 * layout.modes, columns] = of_motion[: layout.modes]
        if layout.slip >= 0 and model.bordered_system(own).freed[1]:
            rates[layout.slip, layout.slip + 1] = 1.0
            rates[layout.slip + 1, columns] = of_motion[layout.modes + 1]
        return rates

    def integrated(
        self, key: Key, stops: Sequence[Any], checks: Sequence[Check], events: tuple[Event, ...]
    ) -> NonlinearPhase:
        """A phase that is not linear."""
        layout, own = self.model.layout, model_key(self.model, key)
        (C, d, e), (C_v, _, d_v) = self.outputs(key)
        places = (*range(layout.modes), *range(2 * layout.modes, layout.core, 2))
        speeds = (*range(layout.modes, 2 * layout.modes), *range(2 * layout.modes + 1, layout.core, 2))
        held = self.model.complete and key[0] != CLOSED and not self.model.is_free(own)  # by friction dampers
        return NonlinearPhase(
            self.field(key, stops, checks),
            C,
            d,
            e,
            events,
            self.scale,
            layout.memory,
            dict(zip(places, speeds, strict=True)),
            self.curved if self.model.bends(key[0]) else {},
            C_v,
            d_v,
            (0, 1) if held else tuple(check[0] for check in checks),
        )

    def outputs(self, key: Key) -> tuple[tuple[Array, Array, Array], tuple[Array, Array, Array]]:
        """C, d and e of the outputs in a phase, and what each m/s² of vertical acceleration adds to them."""
        own, n = model_key(self.model, key), self.model.layout.size
        rows = self.rows(self.model, own)
        more = self.rows(self.heavier, own) - rows
        return (rows[:, :n], rows[:, n], rows[:, n + 1]), (more[:, :n], more[:, n], more[:, n + 1])

    def rows(self, model: RockingModel, key: Key) -> Array:
        """The outputs of a model in a phase: rows with columns for the state, a and 1."""
        layout, found = model.layout, np.zeros((len(self.quantities) + 2, model.layout.size + 2))
        found[0, layout.rotation] = 1.0
        for place, row in enumerate((*rows_of_quantities(model, self.quantities, key), model.lost_support(key))):
            found[1 + place, [*range(layout.moving), -2, -1]] = row
        return found

    def base_of(self, key: Key) -> Key:
        """The side and the branches of the elements in a phase."""
        return self.model.element_key(model_key(self.model, key))

    def following(self, key: Key, base: Key) -> Key:
        """The phase in which the side and the elements are on other branches."""
        return (*base, *key[len(base) :])

    def uplifts(self, key: Key) -> tuple[Event, ...]:
        """The base lifts, or leaves friction dampers, where the moment exceeds a limit (Eq. 16 or 24)."""
        model, (side, *rest) = self.model, self.base_of(key)
        if not model.lifts:
            return ()
        following = [
            branches_of_moving_elements(model.properties, model.elements, (side or turn, *rest), turn)
            for turn in (RIGHT, LEFT)
        ]
        rows, limits = self.margins(model, key, following)
        heavier, _ = self.margins(self.heavier, key, following)
        scale = max([abs(each) for each in limits if 0.0 < abs(each) < np.inf], default=1.0)
        name, found = "uplift" if side == CLOSED else "release", list[Event]()
        for row, heavy, after in zip(rows, heavier - rows, following, strict=True):
            if side == CLOSED and after[0] not in model.sides:
                continue
            if model.bends(side):  # `RockingField.conditions` has them
                found.append(Event(name, np.zeros(len(row) - 2), self.following(key, after), scale=scale))
                continue
            found.append(self.event(name, row, heavy, self.following(key, after), scale))
        return tuple(found)

    def event(self, name: str, row: Array, more: Array, target: Key, scale: float) -> Event:
        """An event from the row of its condition, and what each m/s² of vertical acceleration adds to it."""
        found = Event(name, row[:-2], target, float(row[-1]), float(row[-2]), scale)
        return replace(found, row_v=more[:-2], direct_v=float(more[-1]))

    def margins(self, model: RockingModel, key: Key, following: Sequence[Key]) -> tuple[Array, list[float]]:
        """By how much the moment is within its limits, rows over the state, a and 1, and these limits.

        A limit is the moment at which the forces of the phase that follows would turn the base.
        """
        layout, p, side = model.layout, model.properties, key[0]
        equations_after = [base_equations_of(p, model.elements, each, model.gravity) for each in following]
        rows, moment = np.zeros((2, layout.size + 2)), model.contact_moment(model_key(model, key))
        for row, equations, sign in zip(rows, equations_after, (1.0, -1.0), strict=True):
            row[[*range(layout.moving), -2, -1]] = sign * moment
            internal_factor = equations.internal_factor[0]
            row[layout.memory : layout.memory + internal_factor.size] -= sign * internal_factor
            row[-1] -= sign * equations.constant[0]
            if side != CLOSED:
                row[layout.rotation] += sign * equations_after[0].stiffness[0, 0]
        return rows, [float(each.constant[0]) for each in equations_after]

    def unit(self, place: int, factor: float = 1.0) -> Array:
        """A row that is a factor times a state."""
        found = np.zeros(self.model.layout.size)
        found[place] = factor
        return found

    def rotation(self, factor: float) -> Array:
        """A row that is a factor times θ."""
        return self.unit(self.model.layout.rotation, factor)

    def changes(self, key: Key) -> tuple[list[Any], tuple[Event, ...]]:
        """The elongations at which an element changes its branch: limits of |θ| that its internal variable moves."""
        stops, found, base = list[Any](), list[Event](), self.base_of(key)
        model, known = self.model, internal_places(self.model.elements)
        for place, (each, taken) in enumerate(zip(model.elements, base[1:], strict=True)):
            arm = arm_of_element(model.properties, each, base[0])
            for stop in each.limits(taken):
                if not is_in_reach(stop, arm):
                    continue
                kind = -1 if stop.upper == (arm > 0.0) else 1  # the limit is above |θ|, or below
                stops.append((kind, known.get(place, -1), (stop.place / arm, stop.internal_factor / arm)))
                following = (*base[: place + 1], stop.branch, *base[place + 2 :])
                jump = self.change(base, following, stops=False)
                target = self.following(key, following)
                found.append(Event("change", self.rotation(kind * base[0]), target, jump=jump))
        return stops, tuple(found)

    def change(self, base: Key, following: Key, *, stops: bool) -> Change:
        """The jump from a phase to one in which other branches are taken."""
        layout, marks = self.model.layout, internal_variables_of_branches(self.model.elements, following)
        places = [(layout.memory + index, value) for index, value in marks]
        return Change(layout.rotation, self.model.complete, stops, self.turnings(base), places)

    def turnings(self, base: Key) -> list[tuple[int, float, float]]:
        """The internal variables m that are set where elements cease to yield: place, r, and δ - m."""
        model, known, found = self.model, internal_places(self.model.elements), list[tuple[int, float, float]]()
        for place, (each, taken) in enumerate(zip(model.elements, base[1:], strict=True)):
            offset = each.reversal_offset(taken)
            if offset is not None:
                arm = arm_of_element(model.properties, each, base[0])
                found.append((model.layout.memory + known[place], arm, offset))
        return found

    def turns(self, key: Key) -> tuple[Event, ...]:
        """The rotation turns back while an element yields."""
        base = self.base_of(key)
        way = direction_of_yielding(self.model.properties, self.model.elements, base)
        if way == 0:
            return ()
        row = self.unit(self.model.layout.spin, way * base[0])
        turned = branches_of_moving_elements(self.model.properties, self.model.elements, base, 0)
        return (Event("turn", row, self.following(key, turned), jump=self.change(base, turned, stops=True)),)

    def beside(self, key: Key, side: int) -> Key:
        """The phase after an impact, on one side or in contact."""
        after = branches_of_moving_elements(
            self.model.properties, self.model.elements, (side, *self.base_of(key)[1:]), side
        )
        return self.following(key, after)

    def ends(self, key: Key) -> tuple[Event, Event]:
        """The landing, after which rocking may go on about the other edge, and overturning."""
        side, rule = key[0], rule_of_law(self.model.law, key[0])
        contact, other = self.beside(key, CLOSED), self.beside(key, -side)
        tips = Event("overturning", self.rotation(-side), None, QUARTER_TURN, scale=QUARTER_TURN)
        if rule is None:
            return Event("impact", self.rotation(side), contact, jump=self.landing(key)), tips
        turnings = self.turnings(self.base_of(key))
        jump = landing_of_rule(self.model, side, rule, self.field(other), self.model.layout.size, turnings)
        return Event("impact", self.rotation(side), contact, jump=jump, other=other, noted=GUARDED), tips

    def landing(self, key: Key) -> Callable[[Array, float, float], tuple[Array, Key]]:
        """The jump of a law of the user's own, at which elements cease to yield."""
        spin, turnings = self.model.layout.spin, self.turnings(self.base_of(key))
        fields = {side: self.field(self.beside(key, side)) for side in (RIGHT, LEFT)}
        land = landing_jump(
            self.model,
            {side: self.beside(key, side) for side in (CLOSED, RIGHT, LEFT)},
            lambda side, state: fields[side].inertia_at(state),
            lambda side, state, a, a_v: float(fields[side].rates_at(state, a, a_v)[spin]),
        )

        def jump(state: Array, acceleration: float, vertical: float) -> tuple[Array, Key]:
            for place, _, offset in turnings:
                state[place] = -offset
            return land(state, acceleration, vertical)

        return jump

    def slips(self, key: Key, first: int) -> tuple[list[Check], tuple[Event, ...]]:  # noqa: ARG002
        """How a slip begins and ends: conditions that are not linear, and events, of which there are `first` before."""
        return [], ()

    def field(self, key: Key, stops: Sequence[Any] = (), checks: Sequence[Check] = ()) -> RockingField | GroundField:
        """The vector field of a phase, with conditions or without."""
        branch = key[-1] if self.model.bouc_wen is not None else 1
        return field_of(self.model, self.numbers, model_key(self.model, key), branch, stops, checks)

    def reversal(self, key: Key) -> Event:
        """The velocity of the hysteretic spring changes its sign."""
        row = self.unit(self.model.layout.modes, key[-1])
        return Event("reversal", row, (*key[:-1], -key[-1]), jump=Reversal(self.model.layout.modes, self.barely))
