"""The nonlinear models as hybrid systems: phases, events and outputs for `rockflex.engine`."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from rockflex._arrays import Array, Integers
from rockflex._constants import GRAVITY
from rockflex.engine import Event, LinearPhase, NonlinearPhase, StateLayout, System
from rockflex.models._elements import (
    CLOSED,
    LEFT,
    QUARTER_TURN,
    RIGHT,
    arm_of,
    base_equations_of,
    internal_places,
    is_in_reach,
    marks_of,
    set_off,
    turning_way,
)
from rockflex.models._fields import Change, Landing, Reversal, RockingField
from rockflex.models._impact import Restitution, VVELComplete, VVELSimplified
from rockflex.models._label import RockingModel
from rockflex.models._landing import gains_energy, landing_of, shortest_excursion, sided
from rockflex.models._nonlinear import field_of, numbers_of
from rockflex.models._phase import Key
from rockflex.models._quantities import LINEAR, VERTICAL, Quantities, rows_of

TREMOR = 0.01  # m/s²: the error of a step is relative to the response to it, or to a larger motion so far
LIGHT = 0.05  # of the vertical reaction at rest: the least size of the loss of support
BARELY = 1e-10  # of that response: a velocity that is zero at a reversal


def nonlinear_system(model: RockingModel, quantities: Quantities) -> System:
    """Return a model on rigid ground as a hybrid system.

    The outputs are the rotation, the quantities, and the loss of support, of which the largest value counts. A key is
    that of the model; with a hysteretic spring the sign of its velocity follows.
    """
    layout = model.layout
    parts = {f"state {k}": 1 for k in range(layout.size)}
    names = ("rotation", *(f"quantity {k}" for k in range(len(quantities))), "loss of support")
    rocks = Rocks(model, quantities)
    return System(StateLayout(**parts), names, rocks.phase, key_of(model, model.start(CLOSED)), names[-1:])


def key_of(model: RockingModel, key: Key, state: Array | None = None) -> Key:
    """Return the key of a phase of the hybrid system from that of the model."""
    if model.bouc_wen is None:
        return key
    return (*key, -1 if state is not None and state[model.properties.n_modes] < 0.0 else 1)


def with_marks(model: RockingModel, keys: Sequence[Key], places: Integers, states: Array) -> Array:
    """Return states in which the internal variables of friction dampers are those of their phases, at keys[places]."""
    marks = [marks_of(model.elements, key[:-1] if model.bouc_wen is not None else key) for key in keys]
    if any(marks):
        states = states.copy()
        for place, of_phase in enumerate(marks):
            for index, value in of_phase:
                states[places == place, model.layout.memory + index] = value
    return states


class Rocks:
    """The phases of a model."""

    def __init__(self, model: RockingModel, quantities: Quantities) -> None:
        self.model, self.quantities = model, quantities
        # All forces are linear in gravity, and the vertical acceleration of the ground acts like more of it.
        self.heavier = replace(model, gravity=model.gravity + 1.0)
        p, curved = model.properties, model.complete
        count = len(quantities)
        kinds = quantities.kinds.tolist() if curved else [LINEAR] * count
        self.numbers = numbers_of(
            model,
            [LINEAR, *kinds, VERTICAL if curved else LINEAR],
            np.vstack((np.zeros((1, 2)), quantities.levers, np.zeros((1, 2)))),
        )
        rotation = TREMOR / GRAVITY * p.m_tot * p.half_width / p.l0r
        fall = math.sqrt(p.l0r * GRAVITY / p.i_theta)
        hysteresis = [TREMOR / GRAVITY] * (model.bouc_wen is not None)
        velocities = TREMOR / p.omega
        self.scale = np.concatenate((TREMOR / p.omega**2, velocities, [rotation, rotation * fall], hysteresis))
        light = LIGHT * p.resting_reaction
        self.curved = {
            place: light if kind == VERTICAL else 0.0 for place, kind in enumerate(self.numbers.kinds) if kind != LINEAR
        }
        self.barely = BARELY * float(velocities[0]) if p.n_modes else 0.0

    def phase(self, key: Key) -> LinearPhase | NonlinearPhase:
        """Return a phase: full contact, or rocking about one side."""
        model, layout = self.model, self.model.layout
        branch, own = (key[-1], key[:-1]) if model.bouc_wen is not None else (1, key)
        side, n = own[0], layout.size
        rows = self.rows(model, own)
        more = self.rows(self.heavier, own) - rows
        outputs = rows[:, :n], rows[:, n], rows[:, n + 1]
        curved = model.complete and side != CLOSED and not model.is_free(own)  # friction dampers hold the base
        if not model.is_free(own):
            stops, events = [], self.uplifts(own, branch)
        else:
            stops, events = self.changes(own, branch)
            events += (*self.ends(own, branch), *self.turns(own, branch))
        if side == CLOSED and model.bouc_wen is None:
            rates = np.zeros((n, n + 2))
            modes = np.arange(layout.modes)
            rates[modes, layout.modes + modes] = 1.0
            of_modes = model.modal_accelerations(own)
            rates[layout.modes : 2 * layout.modes, [*range(layout.moving), n, n + 1]] = of_modes
            linear = LinearPhase(rates[:, :n], rates[:, n], rates[:, n + 1], *outputs, events)
            return replace(linear, C_v=more[:, :n], d_v=more[:, n + 1])
        if model.bouc_wen is not None:
            events += (self.reversal(own, branch),)
        modes = range(layout.modes)
        return NonlinearPhase(
            self.field(own, branch, stops),
            *outputs,
            events,
            self.scale,
            layout.memory,
            {layout.rotation: layout.spin} | {k: layout.modes + k for k in modes},
            self.curved if side != CLOSED else {},
            more[:, :n],
            more[:, n + 1],
            (0, 1) if curved else (),
        )

    def rows(self, model: RockingModel, key: Key) -> Array:
        """The outputs of a model in a phase: rows with columns for the state, a and 1."""
        layout, found = model.layout, np.zeros((len(self.quantities) + 2, model.layout.size + 2))
        found[0, layout.rotation] = 1.0
        for place, row in enumerate((*rows_of(model, self.quantities, key), model.lost_support(key))):
            found[1 + place, [*range(layout.moving), -2, -1]] = row
        return found

    def full(self, key: Key, branch: int) -> Key:
        """The key of a phase from that of the model and the sign of the velocity of a hysteretic spring."""
        return (*key, branch) if self.model.bouc_wen is not None else key

    def uplifts(self, key: Key, branch: int) -> tuple[Event, ...]:
        """The base lifts, or leaves friction dampers, where the moment exceeds a limit (Eq. 16 or 24)."""
        model, (side, *rest) = self.model, key
        if not model.lifts:
            return ()
        following = [set_off(model.properties, model.elements, (side or turn, *rest), turn) for turn in (RIGHT, LEFT)]
        rows, limits = self.margins(model, key, following)
        heavier, _ = self.margins(self.heavier, key, following)
        scale = max([abs(each) for each in limits if 0.0 < abs(each) < np.inf], default=1.0)
        name, found = "uplift" if side == CLOSED else "release", list[Event]()
        curved = model.complete and side != CLOSED  # `RockingField.conditions` has them
        for row, heavy, after in zip(rows, heavier - rows, following, strict=True):
            if curved:
                found.append(Event(name, np.zeros(len(row) - 2), self.full(after, branch), scale=scale))
                continue
            event = Event(name, row[:-2], self.full(after, branch), float(row[-1]), float(row[-2]), scale)
            found.append(replace(event, row_v=heavy[:-2], direct_v=float(heavy[-1])))
        return tuple(found)

    def margins(self, model: RockingModel, key: Key, following: Sequence[Key]) -> tuple[Array, list[float]]:
        """By how much the moment is within its limits, rows over the state, a and 1, and these limits.

        A limit is the moment at which the forces of the phase that follows would turn the base.
        """
        layout, p = model.layout, model.properties
        equations_after = [base_equations_of(p, model.elements, each, model.gravity) for each in following]
        rows = np.zeros((2, layout.size + 2))
        for row, equations, sign in zip(rows, equations_after, (1.0, -1.0), strict=True):
            row[[*range(layout.moving), -2, -1]] = sign * model.overturning_moment()
            row[layout.memory : layout.memory + layout.n_internal] -= sign * equations.recall[0]
            row[-1] -= sign * equations.constant[0]
            if key[0] != CLOSED:
                row[layout.rotation] += sign * equations_after[0].stiffness[0, 0]
        return rows, [float(each.constant[0]) for each in equations_after]

    def rotation(self, factor: float) -> Array:
        """A row that is a factor times θ."""
        found = np.zeros(self.model.layout.size)
        found[self.model.layout.rotation] = factor
        return found

    def changes(self, key: Key, branch: int) -> tuple[list[Any], tuple[Event, ...]]:
        """The elongations at which an element changes its branch: limits of |θ| that its internal variable moves."""
        stops, found = list[Any](), list[Event]()
        model, known = self.model, internal_places(self.model.elements)
        for place, (each, taken) in enumerate(zip(model.elements, key[1:], strict=True)):
            arm = arm_of(model.properties, each, key[0])
            for stop in each.stops(taken):
                if not is_in_reach(stop, arm):
                    continue
                kind = -1 if stop.upper == (arm > 0.0) else 1  # the limit is above |θ|, or below
                stops.append((kind, known.get(place, -1), (stop.place / arm, stop.recall / arm)))
                following = (*key[: place + 1], stop.branch, *key[place + 2 :])
                jump = self.change(key, following, stops=False)
                found.append(Event("change", self.rotation(kind * key[0]), self.full(following, branch), jump=jump))
        return stops, tuple(found)

    def change(self, key: Key, following: Key, *, stops: bool) -> Change:
        """The jump from a phase to one in which other branches are taken."""
        layout, marks = self.model.layout, marks_of(self.model.elements, following)
        places = [(layout.memory + index, value) for index, value in marks]
        return Change(layout.rotation, self.model.complete, stops, self.turnings(key), places)

    def turnings(self, key: Key) -> list[tuple[int, float, float]]:
        """The internal variables m that are set where elements cease to yield: place, r, and δ - m."""
        model, known, found = self.model, internal_places(self.model.elements), list[tuple[int, float, float]]()
        for place, (each, taken) in enumerate(zip(model.elements, key[1:], strict=True)):
            offset = each.turning(taken)
            if offset is not None:
                arm = arm_of(model.properties, each, key[0])
                found.append((model.layout.memory + known[place], arm, offset))
        return found

    def turns(self, key: Key, branch: int) -> tuple[Event, ...]:
        """The rotation turns back while an element yields."""
        way = turning_way(self.model.properties, self.model.elements, key)
        if way == 0:
            return ()
        row = np.zeros(self.model.layout.size)
        row[self.model.layout.spin] = way * key[0]
        turned = set_off(self.model.properties, self.model.elements, key, 0)
        return (Event("turn", row, self.full(turned, branch), jump=self.change(key, turned, stops=True)),)

    def beside(self, key: Key, side: int) -> Key:
        """The phase after an impact, on one side or in contact, as a key of the model."""
        return set_off(self.model.properties, self.model.elements, (side, *key[1:]), side)

    def ends(self, key: Key, branch: int) -> tuple[Event, Event]:
        """The landing, after which rocking may go on about the other edge, and overturning."""
        side, law = key[0], sided(self.model.law, key[0])
        contact, other = self.full(self.beside(key, CLOSED), branch), self.full(self.beside(key, -side), branch)
        tips = Event("overturning", self.rotation(-side), None, QUARTER_TURN, scale=QUARTER_TURN)
        if not isinstance(law, VVELSimplified | VVELComplete | Restitution):
            return Event("impact", self.rotation(side), contact, jump=self.landing(key, branch)), tips
        p = self.model.properties
        own, beyond = self.field(key, branch), self.field(self.beside(key, -side), branch)
        unseen = p.translational_inertia - float(p.effective_mass @ p.effective_height**2)
        jump = Landing(
            partial(gains_energy, self.model),
            own,
            beyond,
            law.e if isinstance(law, Restitution) else 0.0,
            shortest_excursion(law),
            unseen if isinstance(law, VVELComplete) else None,
            self.turnings(key),
        )
        return Event("impact", self.rotation(side), contact, jump=jump, other=other), tips

    def landing(self, key: Key, branch: int) -> Callable[[Array, float, float], tuple[Array, Key]]:
        """The jump of a law of the user's own, at which elements cease to yield."""
        spin, turnings = self.model.layout.spin, self.turnings(key)
        fields = {side: self.field(self.beside(key, side), branch) for side in (RIGHT, LEFT)}
        land = landing_of(
            self.model,
            key[0],
            {side: self.full(self.beside(key, side), branch) for side in (CLOSED, RIGHT, LEFT)},
            lambda side, state: fields[side].inertia_at(state),
            lambda side, state, a, a_v: float(fields[side].rates_at(state, a, a_v)[spin]),
        )

        def jump(state: Array, acceleration: float, vertical: float) -> tuple[Array, Key]:
            for place, _, offset in turnings:
                state[place] = -offset
            return land(state, acceleration, vertical)

        return jump

    def field(self, key: Key, branch: int, stops: Sequence[Any] = ()) -> RockingField:
        """The vector field of a phase, with conditions or without."""
        return field_of(self.model, self.numbers, key, branch, stops)

    def reversal(self, key: Key, branch: int) -> Event:
        """The velocity of the hysteretic spring changes its sign."""
        row = np.zeros(self.model.layout.size)
        row[self.model.layout.modes] = branch
        return Event("reversal", row, (*key, -branch), jump=Reversal(self.model.layout.modes, self.barely))
