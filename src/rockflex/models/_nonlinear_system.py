"""The nonlinear models as hybrid systems: phases, events and outputs for `rockflex.engine`."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from rockflex._arrays import Array, Integers
from rockflex._constants import GRAVITY
from rockflex._shown import shown
from rockflex.engine import Event, LinearPhase, NonlinearPhase, StateLayout, System
from rockflex.models._elements import CLOSED, LEFT, RIGHT
from rockflex.models._fields import Change, Landing, Reversal, RockingField
from rockflex.models._impact import Restitution, SidedRestitution, VVELComplete, VVELSimplified
from rockflex.models._landing import GAIN, WITHOUT, GainsEnergyError, velocities_after
from rockflex.models._nonlinear import NonlinearModel
from rockflex.models._numbers import numbers_of
from rockflex.models._observe import LINEAR, VERTICAL
from rockflex.models._phase import Guard, Key, Phase
from rockflex.models._quantities import Quantities, lost_support_row, rows_of
from rockflex.models._rocking_phase import QUARTER_TURN

TREMOR = 0.01  # m/s²: the error of a step is relative to the response to it, or to a larger motion so far
LIGHT = 0.05  # of the vertical reaction at rest: the least size of the loss of support
BARELY = 1e-10  # of that response: a velocity that is zero at a reversal


def nonlinear_system(model: NonlinearModel, quantities: Quantities) -> System:
    """Return a model on rigid ground as a hybrid system.

    The outputs are the rotation, the quantities, and the loss of support, of which the largest value counts. A key is
    that of the model; with a hysteretic spring the sign of its velocity follows.
    """
    layout = model.layout
    parts = {f"state {k}": 1 for k in range(layout.size)}
    names = ("rotation", *(f"quantity {k}" for k in range(len(quantities))), "loss of support")
    rocks = Rocks(model, quantities)
    return System(StateLayout(**parts), names, rocks.phase, key_of(model, model.start(CLOSED)), names[-1:])


def key_of(model: NonlinearModel, key: Key, state: Array | None = None) -> Key:
    """Return the key of a phase of the hybrid system from that of the model."""
    if model.bouc_wen is None:
        return key
    return (*key, -1 if state is not None and state[model.properties.n_modes] < 0.0 else 1)


def with_marks(model: NonlinearModel, keys: Sequence[Key], places: Integers, states: Array) -> Array:
    """Return states in which the memories of friction dampers are those of their phases, at keys[places]."""
    marks = [model.phase(key[:-1] if model.bouc_wen is not None else key).marks for key in keys]
    if any(marks):
        states = states.copy()
        for place, of_phase in enumerate(marks):
            for index, value in of_phase:
                states[places == place, model.layout.memory + index] = value
    return states


class Rocks:
    """The phases of a model."""

    def __init__(self, model: NonlinearModel, quantities: Quantities) -> None:
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
        known = model.phase(own)
        side, n = own[0], layout.size
        rows = self.rows(model, own)
        more = self.rows(self.heavier, own) - rows
        outputs = rows[:, :n], rows[:, n], rows[:, n + 1]
        if not known.free:
            stops, events = [], self.uplifts(known, branch)
        else:
            stops, events = self.changes(known, branch)
            events += (*self.ends(known, branch), *self.turns(known, branch))
        if known.arrow is not None:
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
            RockingField(self.numbers, side, branch, known.pulls, stops),
            *outputs,
            events,
            self.scale,
            layout.memory,
            {layout.rotation: layout.spin} | {k: layout.modes + k for k in modes},
            self.curved if side != CLOSED else {},
            more[:, :n],
            more[:, n + 1],
        )

    def rows(self, model: NonlinearModel, key: Key) -> Array:
        """The outputs of a model in a phase: rows with columns for the state, a and 1."""
        layout, found = model.layout, np.zeros((len(self.quantities) + 2, model.layout.size + 2))
        found[0, layout.rotation] = 1.0
        for place, row in enumerate((*rows_of(model, self.quantities, key), lost_support_row(model, key))):
            found[1 + place, [*range(layout.moving), -2, -1]] = row
        return found

    def full(self, key: Key, branch: int) -> Key:
        """The key of a phase from that of the model and the sign of the velocity of a hysteretic spring."""
        return (*key, branch) if self.model.bouc_wen is not None else key

    def uplifts(self, known: Phase, branch: int) -> tuple[Event, ...]:
        """The base lifts, or leaves friction dampers, where the moment exceeds a limit (Eq. 16 or 24)."""
        guard, found, heavier = known.guard, list[Event](), self.heavier.phase(known.key).guard
        scale = max([abs(each) for each in (guard.low, guard.high) if 0.0 < abs(each) < np.inf], default=1.0)
        for bound, leads in enumerate((guard.below, guard.above)):
            if leads is not None:
                row, more = (self.limit(each, bound) for each in (guard, heavier))
                target, heavy = self.full(leads.key, branch), more - row
                event = Event(
                    "release" if known.side else "uplift", row[:-2], target, float(row[-1]), float(row[-2]), scale
                )
                found.append(replace(event, row_v=heavy[:-2], direct_v=float(heavy[-1])))
        return tuple(found)

    def limit(self, guard: Guard, bound: int) -> Array:
        """By how much a moment is within its lower (0) or upper (1) limit: a row over the state, a and 1."""
        layout, sign = self.model.layout, 1.0 - 2.0 * bound
        row = np.zeros(layout.size + 2)
        row[[*range(layout.moving), -2, -1]] = sign * guard.row
        row[layout.memory : layout.memory + layout.remembered] -= sign * guard.recall[bound]
        row[-1] -= sign * (guard.high if bound else guard.low)
        row[layout.rotation] -= sign * guard.turn
        return row

    def rotation(self, factor: float) -> Array:
        """A row that is a factor times θ."""
        found = np.zeros(self.model.layout.size)
        found[self.model.layout.rotation] = factor
        return found

    def changes(self, known: Phase, branch: int) -> tuple[list[Any], tuple[Event, ...]]:
        """The elongations at which an element changes its branch, each a limit of |θ| that its memory moves."""
        stops, found = list[Any](), list[Event]()
        for change in known.changes:
            kind = -1 if change.outer else 1
            stops.append((kind, change.memory, (change.place, change.recall)))
            jump = self.change(known, change.key, stops=False)
            row = self.rotation(kind * known.side)
            found.append(Event("change", row, self.full(change.key, branch), jump=jump))
        return stops, tuple(found)

    def change(self, known: Phase, following: Key, *, stops: bool) -> Change:
        """The jump from a phase to one in which other branches are taken."""
        layout, marks = self.model.layout, self.model.phase(following).marks
        places = [(layout.memory + index, value) for index, value in marks]
        return Change(layout.rotation, self.model.complete, stops, self.turnings(known), places)

    def turnings(self, known: Phase) -> list[tuple[int, float, float]]:
        """The memories of the elements that yield: their places, and as in `Turning`."""
        return [(self.model.layout.memory + each.memory, each.arm, each.offset) for each in known.turnings]

    def turns(self, known: Phase, branch: int) -> tuple[Event, ...]:
        """The rotation turns back while an element yields."""
        if known.turns == 0:
            return ()
        row = np.zeros(self.model.layout.size)
        row[self.model.layout.spin] = known.turns * known.side
        target = self.full(known.turned, branch)
        return (Event("turn", row, target, jump=self.change(known, known.turned, stops=True)),)

    def ends(self, known: Phase, branch: int) -> tuple[Event, Event]:
        """The landing, after which rocking may go on about the other edge, and overturning."""
        side, law = known.side, self.model.law
        contact, other = (self.full(known.beside[k], branch) for k in (0, 1 if side == LEFT else 2))
        tips = Event("overturning", self.rotation(-side), None, QUARTER_TURN, scale=QUARTER_TURN)
        if isinstance(law, SidedRestitution):
            law = law.right if side == RIGHT else law.left
        if not isinstance(law, VVELSimplified | VVELComplete | Restitution):
            return Event("impact", self.rotation(side), contact, jump=self.told(known, branch)), tips
        p = self.model.properties
        own, beyond = (self.field(key, branch) for key in (known.key, known.beside[1 if side == LEFT else 2]))
        unseen = p.translational_inertia - float(p.effective_mass @ p.effective_height**2)
        jump = Landing(
            partial(_gains, self.model),
            own,
            beyond,
            law.e if isinstance(law, Restitution) else 0.0,
            law.shortest_excursion if isinstance(law, Restitution) else WITHOUT.shortest_excursion,
            unseen if isinstance(law, VVELComplete) else None,
            self.turnings(known),
        )
        return Event("impact", self.rotation(side), contact, jump=jump, other=other), tips

    def field(self, key: Key, branch: int) -> RockingField:
        """The vector field of a phase, without its conditions."""
        return RockingField(self.numbers, key[0], branch, self.model.phase(key).pulls, [])

    def reversal(self, key: Key, branch: int) -> Event:
        """The velocity of the hysteretic spring changes its sign."""
        row = np.zeros(self.model.layout.size)
        row[self.model.layout.modes] = branch
        return Event("reversal", row, (*key, -branch), jump=Reversal(self.model.layout.modes, self.barely))

    def told(self, known: Phase, branch: int) -> Callable[[Array, float, float], tuple[Array, Key]]:
        """The jump of a law of the user's own."""
        model, N = self.model, self.model.layout.modes
        p, layout = model.properties, model.layout
        fields = {side: self.field(known.beside[k], branch) for k, side in ((1, RIGHT), (2, LEFT))}
        turnings = self.turnings(known)

        def land(state: Array, acceleration: float, vertical: float) -> tuple[Array, Key]:
            before = energy(state, fields[known.side].inertia_at(state))
            for place, _, offset in turnings:
                state[place] = -offset
            state[layout.rotation] = 0.0
            velocity, spin = velocities_after(model.law, p, state[N : 2 * N], float(state[layout.spin]))
            state[N : 2 * N], state[layout.spin], key = velocity, spin, known.beside[0]
            if spin != 0.0:
                side, key = (RIGHT, known.beside[1]) if spin > 0.0 else (LEFT, known.beside[2])
                after = energy(state, fields[side].inertia_at(state))
                back = -side * float(fields[side].rates_at(state, acceleration, vertical)[layout.spin])
                if 2.0 * abs(spin) < back * WITHOUT.shortest_excursion:
                    state[N : 2 * N] += p.effective_height * spin
                    state[layout.spin], key = 0.0, known.beside[0]
                    after = energy(state, 0.0)
            else:
                after = energy(state, 0.0)
            if after > before * (1.0 + GAIN):
                raise _gains(model)
            return state, self.full(key, branch)

        def energy(state: Array, inertia: float) -> float:
            velocity, spin = state[N : 2 * N] + p.effective_height * state[layout.spin], state[layout.spin]
            return 0.5 * float(inertia * spin**2 + p.effective_mass @ velocity**2)

        return land


def _gains(model: NonlinearModel) -> GainsEnergyError:
    """The error of a law that returns energy."""
    return GainsEnergyError(f"The impact law {shown(model.law)} returns energy.")
