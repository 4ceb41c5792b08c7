"""Linear models with elements, on springs, or that slide, as hybrid systems for `rockflex.engine`."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from rockflex.engine.system import Event, LinearPhase, Rest, StateLayout, System
from rockflex.foundation.arrays import Array, Integers
from rockflex.models._base_motion import horizontal_reaction
from rockflex.models._elements import (
    CLOSED,
    LEFT,
    QUARTER_TURN,
    RIGHT,
    arm_of_element,
    base_equations_of,
    branches_of_moving_elements,
    direction_of_yielding,
    internal_places,
    is_in_reach,
    rate_of_elongation_row,
)
from rockflex.models._fields import LinearTurn
from rockflex.models._landing import (
    GUARDED,
    fixed_share,
    landing_jump,
    landing_of_rule,
    rotation_acceleration_by_rows,
    rule_of_law,
)
from rockflex.models._phase import Key
from rockflex.models._quantities import Quantities, joined_quantities, rows_of_quantities
from rockflex.models._rocking_model import RockingModel
from rockflex.models._sliding import LOST, STICK, SlidingModel

TINY = 1e-300
LEAST_ELONGATION = 1e-6  # m
MORE = 1e6  # m/s², of gravity: the terms that it adds outweigh the rounding of all others


def linear_system_of(base: "LinearSystemBase") -> System:
    """Return a linear model as a hybrid system.

    The states are the motion and the elastic stretches of the bars. The outputs are the rotation, the quantities,
    and those of which the largest value counts: `extremes`, and the loss of support.
    """
    many, most = len(base.quantities), len(base.extremes)
    names = ("rotation", *(f"quantity {k}" for k in range(many)), *(f"extreme {k}" for k in range(most)))
    names += ("loss of support",)
    return System(base.layout, names, base.phase, base.model.start(CLOSED), names[1 + many :])


@dataclass(frozen=True, eq=False)
class LinearSystemBase:
    """A system of any base: states, outputs, and the conversion from and to the states of the model.

    A row has the columns of the states, the ground acceleration and 1.
    """

    model: RockingModel
    quantities: Quantities
    extremes: Quantities
    shaken: bool = False

    @cached_property
    def bars(self) -> dict[int, int]:
        """The place in the states of the elastic stretch of each bar, by the place of the bar among the elements.

        The plastic stretch m would be as good, but its rounding is that of the largest elongation so far.
        """
        bars = [place for place, each in enumerate(self.model.elements) if each.stretches is not None]
        return {place: self.model.layout.core + k for k, place in enumerate(bars)}

    @cached_property
    def shown(self) -> Quantities:
        """The quantities and the extremes."""
        return joined_quantities([self.quantities, self.extremes])

    @cached_property
    def layout(self) -> StateLayout:
        """The states: modes, rotation, slip and heave, each with its rate, and elastic stretches."""
        layout, N = self.model.layout, self.model.properties.n_modes
        parts = {"displacement": N, "velocity": N, "rotation": 1, "spin": 1}
        parts |= {"slip": 1, "slip_rate": 1} if layout.slip >= 0 else {}
        parts |= {"heave": 1, "heave_rate": 1} if layout.heave >= 0 else {}
        parts |= {"joints": 2 * layout.n_joints} if layout.n_joints else {}
        return StateLayout(**parts, elastic=len(self.bars) + len(self.soil))

    @cached_property
    def soil(self) -> dict[int, int]:
        """The place in the states of the elastic compression of each spring that can yield, by its own place."""
        return {}

    def compression(self, place: int) -> Array:
        """The whole compression of a spring under the base: a row."""
        raise NotImplementedError

    @cached_property
    def _soil_columns(self) -> list[int]:
        return []

    @cached_property
    def columns(self) -> Integers:
        """Where the columns of a row are in the rows of the model."""
        layout, known = self.model.layout, internal_places(self.model.elements)
        bars = (layout.memory + known[place] for place in self.bars)
        return np.array([*range(layout.core), *bars, *self._soil_columns, -2, -1])

    def taken(self, rows: Array, key: Key) -> Array:
        """Rows of the model over the states, in which a plastic stretch m is δ + e_0 minus the elastic one."""
        found = rows[..., self.columns]
        for place, at in self.bars.items():
            share = found[..., at].copy()
            found[..., at] = -share
            found += share[..., None] * self.stretch_in(place, key)
        for place, at in self.soil.items():
            share = found[..., at].copy()
            found[..., at] = -share
            found += share[..., None] * self.compression(place)
        return found

    def stretch_in(self, place: int, key: Key) -> Array:
        """The whole stretch δ + e_0 of a bar: a row."""
        return self._stretches(place, self.model.stance(key))[2]

    def blank(self) -> Array:
        """A row of zeros."""
        return np.zeros(self.layout.size + 2)

    def unit(self, place: int) -> Array:
        """The row of one state."""
        row = self.blank()
        row[place] = 1.0
        return row

    def event(self, name: str, row: Array, key: Key | None, scale: float, jump: object = None) -> Event:
        """An event from the row of its condition."""
        n = self.layout.size
        return Event(name, row[:n], key, float(row[n + 1]), float(row[n]), max(scale, TINY), jump)  # pyright: ignore[reportArgumentType]

    @cached_property
    def heavier(self) -> "LinearSystemBase":
        """The same under more gravity: a vertical acceleration acts in the same way."""
        return replace(self, model=replace(self.model, gravity=self.model.gravity + MORE), shaken=False)

    def phase(self, key: Key) -> LinearPhase:
        """The phase of a key."""
        still = self.still(key)
        if not self.shaken:
            return still
        more, places = self.heavier.still(key), self.model.layout.rotations
        found = {"A_v": np.zeros_like(still.A), "C_v": np.zeros_like(still.C)}
        # Gravity acts on rotations alone, and by itself.
        found["A_v"][:, places] = (more.A - still.A)[:, places] / MORE
        found["C_v"][:, places] = (more.C - still.C)[:, places] / MORE
        found |= {"f_v": (more.c - still.c) / MORE, "d_v": (more.e - still.e) / MORE}
        events = tuple(self._shaken(one, other) for one, other in zip(still.events, more.events, strict=True))
        return replace(still, events=events, **found)

    def _shaken(self, still: Any, more: Any) -> Any:
        """An event, or what follows instead, with the terms of a vertical acceleration."""
        row, places = np.zeros(self.layout.size), self.model.layout.rotations
        row[places] = (more.row[places] - still.row[places]) / MORE
        found = replace(still, row_v=row, direct_v=(more.constant - still.constant) / MORE)
        if getattr(still, "rest", None) is not None:
            found = replace(found, rest=self._shaken(still.rest, more.rest))
        return found

    def still(self, key: Key) -> LinearPhase:
        """The phase of a key while the ground does not move vertically."""
        model, n = self.model, self.layout.size
        shown = np.vstack((rows_of_quantities(model, self.shown, key), model.lost_support(key)))
        rows = np.vstack((self.unit(model.layout.rotation), self.taken(shown, key)))
        rates = self.rates(key)
        events = tuple(self.events(key))
        return LinearPhase(rates[:, :n], rates[:, n], rates[:, n + 1], rows[:, :n], rows[:, n], rows[:, n + 1], events)

    def rates(self, key: Key) -> Array:
        """The rates of the states, shape (n, C)."""
        model = self.model
        layout, N, n = model.layout, model.properties.n_modes, self.layout.size
        accelerations = self.taken(model.accelerations(key), key)
        found = np.zeros((n, n + 2))
        found[np.arange(N), N + np.arange(N)] = 1.0
        found[N : 2 * N] = accelerations[:N]
        for k, free in enumerate(model.bordered_system(key).freed):
            place = layout.rotation + 2 * k
            if free:
                found[place, place + 1] = 1.0
                found[place + 1] = accelerations[N + k]
        branches = model.element_key(key)[1:]
        for place, at in self.bars.items():
            if not model.elements[place].yields(branches[place]):
                found[at] = self.stretching(place, key)
        return found

    def stretch(self, place: int, key: Key) -> Array:
        """The elongation of an element: a row."""
        return self._stretches(place, self.model.stance(key))[0]

    def stretching(self, place: int, key: Key) -> Array:
        """The rate of the elongation of an element: a row."""
        return self._stretches(place, self.model.stance(key))[1]

    def _stretches(self, place: int, stance: Key) -> Array:
        """The elongation of an element, its rate, and the whole stretch: read-only rows."""
        known = self._known_stretches.get((place, stance))
        if known is None:
            row = self.model.stretch(place, stance)
            known = np.array([row, rate_of_elongation_row(row, self.model.layout), row])[:, self.columns]
            known[2, -1] += self.model.elements[place].stretches or 0.0
            known.setflags(write=False)
            self._known_stretches[place, stance] = known
        return known

    @cached_property
    def _known_stretches(self) -> dict[tuple[int, Key], Array]:
        return {}

    def events(self, key: Key) -> list[Event]:
        """The events that end a phase."""
        raise NotImplementedError

    def limit_rows(self, place: int, key: Key, branch: int) -> list[tuple[Array, int, float]]:
        """The ends of the branch of an element: condition, next branch, and the scale of the condition."""
        each, found = self.model.elements[place], list[tuple[Array, int, float]]()
        for stop in each.limits(branch):
            way = 1.0 if stop.upper else -1.0
            row = -self.stretch(place, key)
            row[-1] += stop.place
            if place in self.bars:
                row += stop.internal_factor * self.stretch_in(place, key)
                row[self.bars[place]] -= stop.internal_factor
            found.append((way * row, stop.branch, abs(stop.place)))
        return found

    def begun(self, place: int, branch: int) -> Array | None:
        """The jump as an element begins a branch: one that yields without any elastic stretch has none, to the bit."""
        each = self.model.elements[place]
        offset = each.reversal_offset(branch) if place in self.bars else None
        return (
            self.without(self.bars[place]) if offset is not None and offset + (each.stretches or 0.0) == 0.0 else None
        )

    def without(self, *places: int) -> Array:
        """The jump that sets some states to zero."""
        jump = np.eye(self.layout.size)
        jump[list(places)] = 0.0
        return jump

    def state_of(self, key: Key, state: Array) -> Array:
        """The states from the state of the model, whose internal variables are those at the start of the branches."""
        model, known = self.model, internal_places(self.model.elements)
        found = np.concatenate((state[: model.layout.core], np.zeros(len(self.bars) + len(self.soil))))
        for place, at in self.bars.items():
            memory, offset = state[model.layout.memory + known[place]], self._offset(place, key)
            stretch = self.stretch_in(place, key) @ np.append(found, (0.0, 1.0))
            broken = model.elements[place].broken(model.element_key(key)[1 + place])
            found[at] = 0.0 if broken else stretch - memory if offset is None else offset
        return found

    def _offset(self, place: int, key: Key) -> float | None:
        """The elastic stretch of a bar that yields; None if it does not."""
        bar = self.model.elements[place]
        offset = bar.reversal_offset(self.model.element_key(key)[1 + place])
        return None if offset is None else offset + (bar.stretches or 0.0)

    def states_of_model(self, keys: Sequence[Key], places: Integers, states: Array, *, history: bool = False) -> Array:
        """The states of the model, shape (R, S), from states in phases whose keys are keys[places].

        In a history the internal variable of a bar is its plastic stretch at the start of its branch.
        """
        model, core, known = self.model, self.model.layout.core, internal_places(self.model.elements)
        found = np.zeros((len(states), model.layout.size))
        found[:, :core] = states[:, :core]
        met = np.array([model.element_key(key)[1:] for key in keys], dtype=int).reshape(len(keys), -1)[places]
        for place, index in known.items():
            column, branch, each = found[:, model.layout.memory + index], met[:, place], model.elements[place]
            if place in self.bars:
                stretches = np.array([self.stretch_in(place, key) for key in keys])[places]
                column[:] = (stretches[:, :-2] * states).sum(axis=1) + stretches[:, -1] - states[:, self.bars[place]]
                if history:
                    begins = np.append(True, branch[1:] != branch[:-1])[: len(column)]
                    column[:] = column[np.maximum.accumulate(np.where(begins, np.arange(len(column)), 0))]
            marks = np.array([each.branch_code(model.element_key(key)[1 + place]) for key in keys], dtype=float)[places]
            last = found[:, model.layout.memory + index + each.n_internal - 1]
            last[:] = np.where(np.isnan(marks), last, marks)  # NaN where there is none
        for (place, at), column in zip(self.soil.items(), self._soil_columns, strict=True):
            found[:, column] = states @ self.compression(place)[:-2] - states[:, at]
        if model.layout.n_internal > model.first_mark:
            more = np.array([model.marks(key) for key in keys])[places]
            found[:, model.layout.memory + model.first_mark :] = more
        return found

    def element_events(self, place: int, key: Key) -> list[Event]:
        """An element that may be stretched and shortened in every phase takes another branch."""
        model, found = self.model, list[Event]()
        branches = model.element_key(key)[1:]
        each, branch = model.elements[place], branches[place]

        def other(branch: int) -> Key:
            return model.with_branches(key, (*branches[:place], branch, *branches[place + 1 :]))

        for row, following, scale in self.limit_rows(place, key, branch):
            jump = self.begun(place, following)
            found.append(self.event("change", row, other(following), scale or self.least_elongation, jump))
        way = each.direction(branch)
        if way:
            row = way * self.stretching(place, key)
            found.append(self.event("turn", row, other(each.branch_at_rest(branch)), 1.0))
        return found

    @property
    def least_elongation(self) -> float:
        """An elongation in m that is small, for conditions without a scale of their own."""
        return LEAST_ELONGATION


@dataclass(frozen=True, eq=False)
class LinearOnRigidGround(LinearSystemBase):
    """A base that rocks about its edges (Silva & Stojadinović 2024, Eqs. 15 and 23 to 25)."""

    def along(self, key: Key, base: Key) -> Key:  # noqa: ARG002
        """The key with other branches of base and elements."""
        return base

    def events(self, key: Key) -> list[Event]:
        """The events that end a phase: uplift, or the release of a held base; impact, overturning, and elements."""
        model = self.model
        found = list[Event]()
        if model.is_free(key):
            found += (self.landing(key), self.overturning(key), *self.changes(key), *self.reversal_events(key))
        elif model.lifts:
            found += self.departures(key)
        for place in model.attached_places:
            found += self.element_events(place, key)
        return found

    def departures(self, key: Key) -> list[Event]:
        """The base begins to rotate when the forces of the phase that follows would turn it (Eq. 24).

        Where it would lift and slide at once, that comes first of which the demand exceeds the capacity by more.
        """
        model, base = self.model, self.model.element_key(key)
        p, side = model.properties, base[0]
        moment = model.contact_moment(key)
        found, weight = list[Event](), p.m_tot * model.gravity * p.half_width
        known = internal_places(model.elements)
        for turn in model.sides[1:] if side == CLOSED else (RIGHT, LEFT):
            following = branches_of_moving_elements(p, model.elements, (side or turn, *base[1:]), turn)
            equations, row = base_equations_of(p, model.elements, following, model.gravity), moment.copy()
            for place in self.bars:
                row[model.layout.memory + known[place]] -= float(equations.internal_factor[0, known[place]])
            condition = turn * self.taken(row, key)
            condition[-1] -= turn * float(equations.constant[0])
            if side != CLOSED:
                condition[model.layout.rotation] += turn * float(equations.stiffness[0, 0])
            name = "uplift" if side == CLOSED else "release"
            found.append(self.event(name, condition, self.along(key, following), weight))
        return found

    def overturning(self, key: Key) -> Event:
        """The end of the run at a rotation of π/2."""
        row = -key[0] * self.unit(self.model.layout.rotation)
        row[-1] = QUARTER_TURN
        return self.event("overturning", row, None, QUARTER_TURN)

    def changes(self, key: Key) -> list[Event]:
        """The elements that take other branches at some elongation."""
        found, base = list[Event](), self.model.element_key(key)
        for place, each in enumerate(self.model.elements):
            arm = arm_of_element(self.model.properties, each, base[0])
            reached = [is_in_reach(stop, arm) for stop in each.limits(base[1 + place])]
            for within, (row, branch, scale) in zip(reached, self.limit_rows(place, key, base[1 + place]), strict=True):
                following = (*base[: place + 1], branch, *base[place + 2 :])
                if within:
                    found.append(
                        self.event("change", row, self.along(key, following), scale, self.begun(place, branch))
                    )
        return found

    def reversal_events(self, key: Key) -> list[Event]:
        """The rotation turns back while elements yield or slide, whose branches then end."""
        model, base, spin = self.model, self.model.element_key(key), self.model.layout.spin
        way = direction_of_yielding(model.properties, model.elements, base)
        if way == 0:
            return []
        turned = branches_of_moving_elements(model.properties, model.elements, base, 0)
        row = base[0] * way * self.unit(spin)
        return [self.event("turn", row, self.along(key, turned), 1.0, self.without(spin))]

    def landing(self, key: Key) -> Event:
        """The impact, after which rocking may go on to the other side."""
        model, side = self.model, key[0]
        contact, row = self.beside(key, CLOSED), side * self.unit(model.layout.rotation)
        rule, (share, excursion) = rule_of_law(model.law, side), fixed_share(model, side)
        if share == 0.0:
            return self.event("impact", row, contact, QUARTER_TURN, self.struck(0.0))
        onto = side if share is not None and share < 0.0 else -side
        if rule is None and (share is None or self._gains(side, onto, share)):
            keys = {each: self.beside(key, each) for each in (CLOSED, RIGHT, LEFT)}
            turns = {each: (self.turn(keys[each]), self.turn_by_weight(keys[each])) for each in (RIGHT, LEFT)}
            jump = landing_jump(
                model, keys, lambda each, _: model.free_inertia(each), rotation_acceleration_by_rows(turns)
            )
            return self.event("impact", row, contact, QUARTER_TURN, jump)
        other = self.beside(key, onto)
        if rule is not None and (share is None or self._gains(side, onto, share)):
            beyond = LinearTurn(self.turn(other), self.turn_by_weight(other), model.layout.spin)
            jump = landing_of_rule(model, side, rule, beyond, self.layout.size)
            return replace(self.event("impact", row, contact, QUARTER_TURN, jump), other=other, noted=GUARDED)
        assert share is not None  # any other is a jump
        back = -onto * excursion * self.turn(other)  # what θ' would lose within the shortest excursion
        back[model.layout.spin] -= 2.0 * onto
        n = self.layout.size
        rest = Rest(-back[:n], contact, -float(back[n + 1]), -float(back[n]), self.struck(0.0))
        return Event("impact", row[:n], other, scale=QUARTER_TURN, jump=self.struck(share), rest=rest)

    def beside(self, key: Key, side: int) -> Key:
        """The phase after an impact, on one side or in contact."""
        base = self.model.element_key(key)
        return self.along(
            key, branches_of_moving_elements(self.model.properties, self.model.elements, (side, *base[1:]), side)
        )

    def turn(self, key: Key) -> Array:
        """θ'' in a phase: a row."""
        return self.taken(self.model.angular_acceleration(key), key)

    def turn_by_weight(self, key: Key) -> Array:
        """The share of θ'' of each m/s² of vertical acceleration: a row."""
        heavier = self.heavier
        assert isinstance(heavier, LinearOnRigidGround)
        return (heavier.turn(key) - self.turn(key)) / MORE

    def struck(self, e: float) -> Array:
        """The jump at an impact: every mass keeps its velocity, and the rotation a share e of its own (Eq. 25)."""
        N, layout = self.model.properties.n_modes, self.model.layout
        found = self.without(layout.rotation, layout.spin)
        found[N : 2 * N, layout.spin] = (1.0 - e) * self.model.properties.effective_height
        found[layout.spin, layout.spin] = e
        return found

    def _gains(self, side: int, onto: int, share: float) -> bool:
        """Whether the restitution may gain energy: on an eccentric base, whose pivots have different inertias."""
        return share**2 * self.model.free_inertia(onto) > self.model.free_inertia(side)


@dataclass(frozen=True, eq=False)
class LinearSliding(LinearOnRigidGround):
    """A base that rocks about its edges, and slides."""

    model: SlidingModel  # pyright: ignore[reportIncompatibleVariableOverride]

    def along(self, key: Key, base: Key) -> Key:
        """The key with other branches of base and elements, and that of the slip."""
        return (*base, key[-1])

    def events(self, key: Key) -> list[Event]:
        """The events that end a phase on ground on which the base cannot slide, and the slip."""
        return [*super().events(key), *self.slip(key)]

    def slip(self, key: Key) -> list[Event]:
        """The base begins to slide, ends it, or loses its pressure on the ground (Coulomb)."""
        model = self.model
        before, slip, place = key[:-1], key[-1], model.layout.slip + 1
        pressure, weight = model.pressure(key), model.properties.m_tot * model.gravity
        if slip == STICK:
            held = horizontal_reaction(model, key)
            # The ground pushes to the right on a base that would slide to the left.
            rows = {-1: model.friction * pressure - held, 1: model.friction * pressure + held}
            return [
                self.event("slip", self.taken(row, key), (*before, way), model.friction * weight)
                for way, row in rows.items()
            ]
        way = 1 if slip > 0 else -1
        sticks = (*before, -slip) if abs(slip) == LOST else (*before, STICK)
        found = [self.event("stick", way * self.unit(place), sticks, 1.0, self.without(place))]
        if abs(slip) == LOST:
            return [*found, self.event("change", self.taken(-pressure, key), (*before, way), weight)]
        return [*found, self.event("change", self.taken(pressure, key), (*before, LOST * way), weight)]
