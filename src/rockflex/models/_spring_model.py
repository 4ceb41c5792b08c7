"""The simplified models on springs that cannot pull: the base rotates, heaves and, with friction, slides."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockflex.foundation.arrays import Array, Bools
from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError
from rockflex.models._base_motion import accelerations_of, bordered_system_of
from rockflex.models._elements import CLOSED, SUMS, internal_count, internal_places
from rockflex.models._phase import BaseEquations, BorderedSystem, GroundPhase, Key
from rockflex.models._rocking_model import LEVEL, Pose, RockingModel
from rockflex.models._state_layout import (
    HEADER,
    SIDE,
    TIME,
    StateLayout,
    branches_of_codes,
    codes_of_branches,
    n_branch_codes,
)
from rockflex.structure._ground import Springs

# Branches of a spring. RECEDING: still compressed, but unloaded, since its dashpot would have to pull the base.
# YIELDING: it carries its capacity, and settles for good as the base presses on.
LOADED, LIFTED, RECEDING, YIELDING = range(4)
STICK = 0  # the branch of the slip; 1 and -1: it slips to the right or left


@dataclass(frozen=True, eq=False)
class SpringModel(RockingModel):
    """N modes on a base on springs and dashpots that cannot pull: no impact law, and flight as one more phase.

    A key has the side, always 0, the branches of the springs, that of the slip, and those of the elements. The state
    keeps them as the last internal variables.

    In complete and yielding models springs and elements stand upright and travel with the base: the depth of a spring
    is z - x sin θ, and its force has the lever arm x cos θ about the point where the axis of the masses meets the base.
    So has an element. That point is held by the ground, or slides against the friction of all springs.

    A spring with a finite capacity keeps its permanent settlement w_p as an internal variable, after those of the
    elements; only simplified models have such springs.

    Parameters
    ----------
    label, properties, lifts, law, missing_mass, gravity, complete, bouc_wen
        As in `RockingModel`; the law is not used.
    springs
        The springs.
    inertia
        Rotary inertia Σ m_i h_i² + I_b about the axis of the masses, kg m².
    friction : ndarray, shape (n,), or None
        Coulomb's coefficient at each spring; None for a base that cannot slide.
    rest
        Rotation and heave under the weight, from which the elements are stretched.
    """

    springs: Springs = field(kw_only=True)  # pyright: ignore[reportIncompatibleVariableOverride]
    inertia: float = field(kw_only=True)
    friction: Array | None = None
    rest: Pose = LEVEL  # pyright: ignore[reportIncompatibleVariableOverride]

    @cached_property
    def layout(self) -> StateLayout:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Layout of the state vector."""
        marks = n_branch_codes(self._key_size, self.code_base)
        return self._layout(len(self.soft) + marks, slides=self.friction is not None, heaves=True)

    @cached_property
    def soft(self) -> tuple[int, ...]:
        """The places of the springs that can yield."""
        capacity = self.springs.capacity
        return () if capacity is None else tuple(np.flatnonzero(np.isfinite(capacity)).tolist())

    @property
    def first_mark(self) -> int:
        """The place of the first number that tells branches among the internal variables."""
        return super().first_mark + len(self.soft)

    def crushed(self, place: int) -> int:
        """The place of the permanent settlement of a spring that can yield in the state."""
        return self.layout.memory + internal_count(self.elements) + self.soft.index(place)

    def integrates(self, side: Array | int) -> Bools:
        """Return for every side whether its phases are integrated step by step: all of them or none."""
        return np.full(np.shape(side), self.integrated)

    def bends(self, side: Array | int) -> Bools:
        """Return for every side whether rotations may be large."""
        return np.full(np.shape(side), self.complete)

    @property
    def ground_parameters(self) -> dict[str, Any]:
        """The springs, the rotary inertia, the position at rest, and the friction if the base can slide."""
        springs = {
            name: getattr(self.springs, name) for name in ("positions", "stiffness", "damping", "area", "capacity")
        }
        known = {"inertia": self.inertia, "rest": list(self.rest), **springs, "friction": self.friction}
        return {name: value for name, value in known.items() if value is not None}

    @property
    def sides(self) -> tuple[int, ...]:
        """The only side, 0: the base has no pivot."""
        return (CLOSED,)

    @property
    def branch_values(self) -> list[Collection[int]]:
        """Values of each of `branches_at`: of the side, every spring, the slip and every element."""
        slips = (STICK,) if self.friction is None else (STICK, 1, -1)
        springs = [(LOADED, LIFTED, RECEDING, YIELDING)] * self.springs.n
        return [self.sides, *springs, slips, *(each.branches for each in self.elements)]

    @property
    def _key_size(self) -> int:
        return self.springs.n + 1 + len(self.elements)

    def element_key(self, key: Key) -> Key:
        """Return the branches of the base and of the elements."""
        return (key[0], *key[self.springs.n + 2 :])

    def with_branches(self, key: Key, branches: Sequence[int]) -> Key:
        """Return the key of the same phase with other branches of the elements."""
        return (*key[: self.springs.n + 2], *branches)

    def start(self, side: int) -> Key:
        """Return the branches of a base at rest."""
        return (side, *(LOADED,) * self.springs.n, STICK, *(each.branches[0] for each in self.elements))

    def is_free(self, key: Key) -> bool:  # noqa: ARG002
        """Always True: the base rotates in every phase."""
        return True

    def branches_at(self, side: Array, rotation: Array, states: Array) -> NDArray[np.int64]:  # noqa: ARG002
        """Return the branches at the states of a history, shape (n, K)."""
        first = HEADER + self.layout.memory + self.first_mark
        codes = states[:, first : HEADER + self.layout.size]
        return np.column_stack(
            (np.zeros(side.size, dtype=np.int64), branches_of_codes(codes, self._key_size, self.code_base))
        )

    def lifted(self, states: Array) -> Bools:
        """Return which springs the base has left at the states of a history, shape (n, n_springs)."""
        branches = self.branches_at(states[:, SIDE], states[:, SIDE], states)
        return branches[:, 1 : self.springs.n + 1] == LIFTED

    def uplifted(self, states: Array) -> Bools:
        """Return whether an edge has left its spring, shape (n,)."""
        lifted = self.lifted(states)
        return lifted[:, 0] | lifted[:, -1]

    def uplift_times(self, states: Array) -> Array:
        """Return the times in s at which an edge leaves its spring."""
        lifted = self.lifted(states)[:, [0, -1]]
        return np.repeat(states[1:, TIME], (lifted[1:] & ~lifted[:-1]).sum(axis=1))

    def impact_times(self, states: Array) -> Array:
        """Return the times in s at which an edge comes back to its spring."""
        lifted = self.lifted(states)[:, [0, -1]]
        return np.repeat(states[1:, TIME], (~lifted[1:] & lifted[:-1]).sum(axis=1))

    def stayed_uplifted(self, largest: float, final: Array) -> bool:  # noqa: ARG002
        """Return whether an edge is off its spring in the last state, as it then was all the time."""
        return bool(self.uplifted(np.concatenate((np.zeros(HEADER), final))[None])[0])

    def heave(self, states: Array) -> Array:
        """Return the rise of the base at the axis of the masses in m, shape (n,)."""
        return self.layout.of(states, self.layout.heave)

    def edge_uplift(self, states: Array) -> Array:
        """Return the rise of the left and of the right edge in m, negative where they settle, shape (n, 2)."""
        p, rotation = self.properties, self.layout.of(states, self.layout.rotation)
        places = np.array([-p.pivot(-1).arm, p.pivot(1).arm])
        return self.heave(states)[:, None] - places * self.turned(rotation)[:, None]

    def elongations_at(self, states: Array) -> Array:
        """Return how far the base has risen at every element since it was at rest, in m, shape (n, E)."""
        moving = states[:, HEADER : HEADER + self.layout.moving].copy()
        moving[:, self.layout.rotation] = self.turned(moving[:, self.layout.rotation])
        rows = np.array([self.stretch(place, self.stance_on(CLOSED)) for place in range(len(self.elements))])
        return moving @ rows[:, :-2].T + rows[:, -1] if len(rows) else np.zeros((len(states), 0))

    def raised_weight(self, states: Array) -> Array:
        """Return the gravity energy per unit of gravity in kg m, shape (n,)."""
        p, rotation = self.properties, self.layout.of(states, self.layout.rotation)
        return p.m_tot * self.heave(states) - 0.5 * p.l0r * rotation**2

    def rotary_inertia(self, side: Array) -> Array:
        """Return the inertia about the axis of the masses in kg m², shape (n,)."""
        return np.full(side.size, self.inertia)

    def stretched(self, vector: Array) -> Array:
        """Return vectors of states whose θ and θ' are what depths, elongations and their rates are linear in."""
        if not self.complete:
            return vector
        found, rotation = vector.copy(), vector[:, self.layout.rotation]
        found[:, self.layout.rotation] = np.sin(rotation)
        found[:, self.layout.spin] *= np.cos(rotation)
        return found

    def spring_forces(self, key: Key) -> Array:
        """Return the force of each spring on the base in a phase in N, upwards: rows, shape (n, C)."""
        branches = np.array(key[1 : self.springs.n + 1])[:, None]
        return np.where(branches == LOADED, self.pushes, np.where(branches == YIELDING, self.holds, 0.0))

    @cached_property
    def pushes(self) -> Array:
        """-k z_j - c z_j' of every spring: rows, shape (n, C)."""
        rates = np.zeros_like(self.depths)
        rates[:, self.layout.heave + 1], rates[:, self.layout.spin] = 1.0, -self.springs.positions
        found = -self.springs.stiffness[:, None] * self.depths - self.springs.damping[:, None] * rates
        for place in self.soft:
            found[place, self.crushed(place)] = -self.springs.stiffness[place]
        return found

    @cached_property
    def holds(self) -> Array:
        """F_y - c z_j' of every spring that yields: rows, shape (n, C)."""
        found = np.zeros_like(self.depths)
        for place in self.soft:
            found[place, self.layout.rotation : self.layout.core] = self.pushes[
                place, self.layout.rotation : self.layout.core
            ]
            found[place, self.layout.rotation : self.layout.core : 2] = 0.0
            assert self.springs.capacity is not None
            found[place, -1] = self.springs.capacity[place]
        return found

    def permanent_settlements(self, states: Array) -> Array:
        """Return the permanent settlement of every spring at the states of a history in m, shape (n, n_springs)."""
        found = np.zeros((len(states), self.springs.n))
        if not self.soft:
            return found
        assert self.springs.capacity is not None
        branches = self.branches_at(states[:, SIDE], states[:, SIDE], states)[:, 1 : self.springs.n + 1]
        moving = states[:, HEADER : HEADER + self.layout.moving]
        for place in self.soft:
            depth = moving @ self.depths[place, :-2]
            settled = -depth - self.springs.capacity[place] / self.springs.stiffness[place]
            kept = self.layout.of(states, self.crushed(place))
            found[:, place] = np.where(branches[:, place] == YIELDING, settled, kept)
        return found

    @cached_property
    def depths(self) -> Array:
        """z_j = z - x_j θ above every spring: rows, shape (n, C)."""
        rows = np.zeros((self.springs.n, self.layout.columns))
        rows[:, self.layout.heave], rows[:, self.layout.rotation] = 1.0, -self.springs.positions
        return rows

    @property
    def moving_places(self) -> tuple[int, ...]:
        """The places of all elements."""
        return tuple(range(len(self.elements)))

    def stretch(self, place: int, stance: Key) -> Array:
        """Return the elongation of an element in m as a row over `stretched` states, shape (C,): zero at rest."""
        position, layout = self.elements[place].position, self.layout
        row = super().stretch(place, stance)
        if position is not None:
            row[layout.heave], row[layout.rotation] = 1.0, -position
        rest = float(self.turned(self.rest.rotation))
        row[-1] -= row[layout.rotation] * rest + row[layout.heave] * self.rest.heave
        return row

    def lost_support(self, key: Key) -> Array:
        """Return the decrease of the sum of the spring forces below its value at rest, in N: a row, shape (C,)."""
        if self.bends(key[0]):
            return np.zeros(self.layout.columns)
        row = np.zeros(self.layout.columns) - self.spring_forces(key).sum(axis=0)
        row[-1] += self.properties.resting_reaction
        return row

    def _new_bordered_system(self, key: Key) -> BorderedSystem:
        slips = [] if self.friction is None else [key[self.springs.n + 1] != STICK]
        return bordered_system_of(self, self._base_equations(key), np.array([True, *slips, True]))

    def _base_equations(self, key: Key) -> BaseEquations:
        p, layout = self.properties, self.layout
        b = layout.freedoms
        equations = BaseEquations.blank(b, layout.n_internal)
        z = b - 1
        equations.inertia[0, 0], equations.inertia[z, z] = self.inertia, p.m_tot
        equations.stiffness[0, 0] = -p.l0r * self.gravity
        equations.constant[z] = -p.m_tot * self.gravity
        equations.ground[0] = -p.l0r
        if self.friction is not None:
            equations.inertia[0, 1] = equations.inertia[1, 0] = p.l0r
            equations.inertia[1, 1], equations.ground[1] = p.horizontal_mass, -p.horizontal_mass
        forces = self.spring_forces(key)
        self._add_to(equations, 0, -self.springs.positions @ forces)
        self._add_to(equations, z, forces.sum(axis=0))
        for place, each in enumerate(self.elements):
            if each.position is not None:
                tension = self.tension(place, key)
                self._add_to(equations, 0, each.position * tension)
                self._add_to(equations, z, -tension)
        if self.friction is not None:
            slip = key[self.springs.n + 1]
            self._add_to(equations, 1, -slip * self.grip(key))
        return equations

    def _add_to(self, equations: BaseEquations, freedom: int, force: Array) -> None:
        """Add a force on one degree of freedom of the base, a row over its state and 1."""
        layout = self.layout
        motion = force[layout.rotation : layout.rotation + 2 * layout.freedoms]
        equations.stiffness[freedom] -= motion[::2]
        equations.damping[freedom] -= motion[1::2]
        equations.constant[freedom] += force[-1]
        equations.internal_factor[freedom] += force[layout.memory : layout.memory + layout.n_internal]

    def grip(self, key: Key) -> Array:
        """Return Σ μ_j N_j as a row, shape (C,)."""
        return self.friction @ self.spring_forces(key) if self.friction is not None else np.zeros(self.layout.columns)

    def initial(self, state: Array | None) -> tuple[Key, Array]:
        """Return the branches and the state at the start of a run, from [D.., D'.., θ, θ'] or at rest.

        The rotation of a state counts from the base at rest. The base heaves as the weight on its springs demands, and
        the elements as built are brought to this position.
        """
        layout, springs = self.layout, self.springs
        start = np.zeros(layout.size)
        rotation, heave = self.rest
        if state is None:
            start[: layout.modes], bent = self.leaning()
            if layout.hysteresis >= 0:
                start[layout.hysteresis] = bent
        else:
            start[: state.size] = state
            rotation += start[layout.rotation]
            heave = heave_at(springs, float(self.turned(rotation)), self._weight)
        start[layout.rotation], start[layout.heave] = rotation, heave
        turned = float(self.turned(rotation))
        depth = heave - springs.positions * turned
        pressed = np.where(depth < 0.0, springs.stiffness, 0.0)
        spin = start[layout.spin] * (np.cos(rotation) if self.complete else 1.0)
        start[layout.heave + 1] = pressed @ springs.positions / pressed.sum() * spin if spin else 0.0
        speed = start[layout.heave + 1] - springs.positions * spin
        force = -springs.stiffness * depth - springs.damping * speed
        branches = np.where(depth >= 0.0, LIFTED, np.where(force > 0.0, LOADED, RECEDING))
        if springs.capacity is not None and bool((-springs.stiffness * depth > springs.capacity).any()):
            raise InputError(
                "The start must be elastic, but a spring under the base would carry more than its capacity. Give a "
                "smaller initial rotation, or a larger capacity.",
                field="capacity",
            )
        kept, of_elements = list[float](), list[int]()
        moving = np.append(start[: layout.moving], (0.0, 1.0))
        moving[layout.rotation] = turned
        for place, each in enumerate(self.elements):
            stretch = self.stretch(place, self.stance_on(CLOSED))
            branch, remembered = each.state_after_slow_stretch(float(stretch @ moving))
            of_elements.append(branch)
            kept += remembered
        key = (CLOSED, *(int(branch) for branch in branches), STICK, *of_elements)
        start[layout.memory :] = (*kept, *(0.0 for _ in self.soft), *self.marks(key))
        return key, start

    def leaning(self) -> tuple[Array, float]:
        """Return D in m, and z of a hysteretic spring, at rest: the weight bends a structure whose base is tilted."""
        p = self.properties
        if not self.complete:
            return np.zeros(p.n_modes), 0.0
        bent = GRAVITY * np.sin(self.rest.rotation) / p.omega**2
        return bent, 0.0 if self.bouc_wen is None else float(bent[0]) / self.bouc_wen.yield_displacement

    def marks(self, key: Key) -> tuple[float, ...]:
        """Return the last internal variables of the state, which tell all branches."""
        return codes_of_branches(key[1:], self.code_base)

    @property
    def _weight(self) -> float:
        """Weight with the initial tensions of the elements under the base, N."""
        return self.properties.resting_reaction

    def _new_accelerations(self, key: Key) -> Array:
        return accelerations_of(self, key)

    def ground_phase(self, key: Key, branch: int) -> GroundPhase:
        """Return what moves and what acts in a phase."""
        n, springs = self.springs.n, self.springs
        friction = np.zeros(n) if self.friction is None else self.friction
        acts = [{LOADED: 1.0, RECEDING: -1.0}.get(branch, 0.0) for branch in key[1 : n + 1]]
        known, recalled, rows = internal_places(self.elements), list[int](), np.zeros((len(self.elements), 6))
        for place, (each, taken) in enumerate(zip(self.elements, self.element_key(key)[1:], strict=True)):
            pull, stretch = each.tension(taken), self.stretch(place, self.stance_on(CLOSED))
            rows[place] = each.position, pull.stiffness, pull.damping, pull.force, pull.internal_factor, stretch[-1]
            recalled.append(self.layout.memory + known[place] if place in known else -1)
        return GroundPhase(
            side=CLOSED,
            branch=branch,
            turns=True,
            way=key[n + 1],
            pressed=True,
            offset=0.0,
            inertia=self.inertia,
            friction=0.0,
            pulls=np.zeros((SUMS, 1)),
            springs=np.column_stack((springs.positions, springs.stiffness, springs.damping, friction, acts)),
            elements=rows,
            recalled=tuple(recalled),
        )


def heave_at(springs: Springs, rotation: float, weight: float) -> float:
    """Return the heave in m at which the springs carry a weight in N at a rotation in rad."""
    ends = springs.positions * rotation  # a spring is compressed while the heave is below its end
    order = np.argsort(-ends)
    stiffness = np.cumsum(springs.stiffness[order])
    heaves = (np.cumsum(springs.stiffness[order] * ends[order]) - weight) / stiffness
    fits = np.append(heaves[:-1] >= ends[order][1:], True)
    return float(heaves[np.argmax(fits)])
