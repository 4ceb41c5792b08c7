"""The models on rigid ground, simplified, complete or yielding: elements, phases, and equations of motion as rows."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, ClassVar, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from rockflex.foundation.arrays import Array, Bools
from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.values import Value
from rockflex.models._bouc_wen import BoucWen
from rockflex.models._elements import (
    CLOSED,
    LEFT,
    RIGHT,
    arm_of_element,
    base_equations_of,
    branches_of_moving_elements,
    elements_of,
    elongation_rows_of_attached,
    first_branches,
    friction_damper_shares,
    internal_count,
    internal_places,
    is_held_by_dampers,
    rate_of_elongation_row,
)
from rockflex.models._impact import ImpactLaw, VVELSimplified
from rockflex.models._phase import BaseEquations, BorderedSystem, GroundPhase, Key
from rockflex.models._state_layout import (
    BASES,
    HEADER,
    SHIFT,
    SIDE,
    TIME,
    StateLayout,
    branches_of_codes,
    codes_of_branches,
    n_branch_codes,
    state_layout_of,
)
from rockflex.structure._branches import Element
from rockflex.structure._ground import Springs
from rockflex.structure._joint import JointAbove
from rockflex.structure._rocking import RockingProperties

MAX_PHASES = 1000  # whose equations of motion are kept


class Pose(NamedTuple):
    """Position of a base: its rotation in rad and its heave in m."""

    rotation: float
    heave: float


LEVEL = Pose(0.0, 0.0)


@dataclass(frozen=True, eq=False)
class RockingModel(Value):
    """N modes on a base that may uplift: the equations of motion in each phase, as bordered systems and as rows.

    On rigid ground without sliding; models on other ground derive from this one. A *row* is a linear functional of the
    state, the ground acceleration and 1: `StateLayout`.

    Parameters
    ----------
    label
        Label of the model, such as ``"2DOF-S"``.
    properties
        Parameters of the structure, with only the modes of this model.
    lifts
        Whether the base can lift; otherwise it is fixed.
    law
        Impact law.
    missing_mass
        Whether base shear and base moment include the mass that the modes leave out, as if it moved with the base.
    gravity
        Gravitational acceleration in m/s².
    complete
        Whether rotations may be large, with all trigonometric, centrifugal and P-Δ terms (Eqs. 13, 14 and 16);
        otherwise the simplified Eqs. 15, 23, 24 and 25 hold.
    bouc_wen
        Hysteresis of the one mode, or None for an elastic superstructure.
    stepwise
        Whether a model that could be solved in closed form is integrated step by step, too: to compare the two, and to
        read responses saved when models with balanced tendons were.
    """

    label: str
    properties: RockingProperties
    lifts: bool = True
    law: ImpactLaw = field(default_factory=VVELSimplified)
    missing_mass: bool = False
    gravity: float = GRAVITY
    complete: bool = field(default=False, kw_only=True)
    bouc_wen: BoucWen | None = field(default=None, kw_only=True)
    stepwise: bool = field(default=False, kw_only=True)
    springs: ClassVar[Springs | None] = None  # under the base; None on rigid ground
    rest: ClassVar[Pose] = LEVEL  # of the base under its weight, from which the elements are stretched

    @property
    def integrated(self) -> bool:
        """Whether some phase is integrated step by step rather than solved in closed form."""
        return self.complete or self.bouc_wen is not None or self.stepwise

    @property
    def linear(self) -> Self:
        """The simplified, elastic model of the same modes."""
        return replace(self, complete=False, bouc_wen=None, stepwise=False) if self.integrated else self

    @property
    def has_bare_base(self) -> bool:
        """Whether nothing but the rotation moves the base: rigid ground, no elements, no slip."""
        return self.springs is None and not self.elements and self.layout.slip < 0 and not self.layout.n_joints

    @property
    def ground_parameters(self) -> dict[str, Any]:
        """The parameters of the ground, by name; none if it is rigid and the base cannot slide."""
        return {}

    @cached_property
    def layout(self) -> StateLayout:
        """Layout of the state vector."""
        return self._layout(n_branch_codes(len(self.attached_places), self.code_base))

    def _layout(self, n_marks: int, *, slides: bool = False, heaves: bool = False, n_joints: int = 0) -> StateLayout:
        """Return the layout with a number of internal variables that tell branches."""
        springs = self.springs if heaves else None
        return state_layout_of(
            self.properties.n_modes,
            integrated=self.integrated,
            viscous=not heaves and any(each.rate_dependent for each in self.elements),
            n_internal=internal_count(self.elements) + n_marks,
            slides=slides,
            heaves=heaves,
            n_joints=n_joints,
            springs=0 if springs is None else springs.n,
            elements=len(self.elements) if heaves else 0,
        )

    @cached_property
    def elements(self) -> tuple[Element, ...]:
        """The elements under the base and those attached to floors, and then the stories that yield."""
        return elements_of(self.properties)

    @cached_property
    def attached_places(self) -> tuple[int, ...]:
        """The places of attached elements and stories among the elements."""
        return tuple(place for place, each in enumerate(self.elements) if each.position is None)

    @property
    def first_mark(self) -> int:
        """The place of the first number that tells branches among the internal variables."""
        return internal_count(self.elements)

    @property
    def moving_places(self) -> tuple[int, ...]:
        """The places of elements whose elongation does not follow from the rotation of the base alone."""
        return self.attached_places

    def stance(self, key: Key) -> Key:
        """Return the side of every joint in a phase, that of the base first."""
        return key[:1]

    def stance_on(self, side: int) -> Key:
        """Return the stance in which all joints are open to a side."""
        return (side,) * len(self.layout.rotations)

    def sides_at(self, states: Array) -> NDArray[np.int64]:
        """Return the side of every joint at the states of a history, that of the base first, shape (n, j)."""
        return states[:, [SIDE]].astype(np.int64)

    @cached_property
    def joints(self) -> tuple[JointAbove, ...]:
        """The joints above the base that may open."""
        return self.properties.joints[: self.layout.n_joints]

    @cached_property
    def levers(self) -> Array:
        """Σ m (z - Z_j) of what is above each joint in kg m, that of the base first, shape (j,)."""
        return np.array([self.properties.l0r, *(each.moment for each in self.joints)])

    @cached_property
    def weights(self) -> Array:
        """The mass that stands on each joint in kg, that of the base first, shape (j,)."""
        return np.array([self.properties.m_tot, *(each.mass for each in self.joints)])

    def arm(self, joint: int, side: int) -> float:
        """Return the distance of the edge of a joint from the axis of the masses in m; joint 0 is the base."""
        return self.properties.pivot(side).arm if joint == 0 else self.joints[joint - 1].half_width

    @cached_property
    def toppling(self) -> Array:
        """Σ m ℓ_k Θ_k² / 2 as a matrix: what the weight takes from the stiffness for each m/s² of gravity, (j, j).

        ℓ_k is the length of segment k below a mass, and Θ_k the sum of the rotations up to it.
        """
        found = np.zeros((self.levers.size, self.levers.size))
        for k, length in enumerate(self.levers - np.append(self.levers[1:], 0.0)):
            found[: k + 1, : k + 1] += length
        return found

    def lifts_by(self, stance: Key) -> Array:
        """Return s B of each joint in m: how far a unit of its rotation lifts what is above; shape (j,)."""
        return np.array([side * self.arm(joint, side or RIGHT) for joint, side in enumerate(stance)])

    def lift_rates(self, sides: NDArray[Any], spins: Array) -> Array:
        """Return s_j B_j θ'_j of every joint in m/s at sides and rates of a history, or of θ''_j, shape (n, j)."""
        left, right = (np.array([self.arm(joint, each) for joint in range(spins.shape[1])]) for each in (LEFT, RIGHT))
        return sides * np.where(sides < 0, left, right) * spins

    def joint_rotations(self, states: Array) -> Array:
        """Return the rotation of every joint at the states of a history, that of the base first, in rad, (n, j)."""
        return states[:, [HEADER + place for place in self.layout.rotations]]

    def joint_spins(self, states: Array) -> Array:
        """Return the rates of `joint_rotations` in rad/s, shape (n, j)."""
        return states[:, [HEADER + place + 1 for place in self.layout.rotations]]

    @cached_property
    def couplings(self) -> Array:
        """The couplings c of the modes with the degrees of freedom of the base, shape (b, N)."""
        found = np.zeros((self.layout.freedoms, self.properties.n_modes))
        found[0] = self.properties.effective_height
        if self.layout.slip >= 0:
            found[1] = 1.0
        return found

    @cached_property
    def code_base(self) -> int:
        """Base of the numbers whose digits are the branches of springs and elements."""
        most = max((max(each.branches) for each in self.elements), default=0)
        return next(base for base in BASES if most + SHIFT < base)

    @cached_property
    def attached(self) -> dict[int, Array]:
        """The elongation in m of each attached element and story, by its place: a row, shape (C,)."""
        return elongation_rows_of_attached(self.properties, self.layout)

    def integrates(self, side: Array | int) -> Bools:
        """Return for every side of the base whether a phase on it is integrated step by step."""
        return np.asarray(self.integrated & ((np.asarray(side) != CLOSED) | (self.bouc_wen is not None)))

    def bends(self, side: Array | int) -> Bools:
        """Return for every side of the base whether rotations may be large, so that outputs are not linear."""
        return np.asarray(self.complete & (np.asarray(side) != CLOSED))

    def turned(self, rotation: Array | float) -> Array:
        """Return sin θ in complete models, otherwise θ."""
        return np.sin(rotation) if self.complete else np.asarray(rotation)

    def stretched(self, vector: Array) -> Array:
        """Return vectors of states, shape (n, C), whose θ and θ' are what elongations and their rates are linear in.

        In complete models that is 2 sin(θ/2), on springs sin θ.
        """
        if not self.complete:
            return vector
        found, half = vector.copy(), 0.5 * vector[:, self.layout.rotation]
        found[:, self.layout.rotation] = 2.0 * np.sin(half)
        found[:, self.layout.spin] *= np.cos(half)
        return found

    def start(self, side: int) -> Key:
        """Return the branches on which a run starts in contact, or as the base begins to rotate about a pivot."""
        return first_branches(self.properties, self.elements, side)

    def initial(self, state: Array | None) -> tuple[Key, Array]:
        """Return the branches and the state at the start of a run, from [D.., D'.., θ, θ'] or at rest.

        Elements as built are brought to this state, and may yield or break on the way. At rest the structure is bent by
        the initial forces of attached elements, as far as these do not balance.
        """
        layout = self.layout
        start = np.zeros(layout.size)
        if state is None:
            start[: layout.modes] = self.bent_at_rest(np.zeros(len(self.elements)))
        else:
            start[: state.size] = state
        rotation, spin = float(start[layout.rotation]), float(start[layout.spin])
        outward = rotation or spin
        side = (outward > 0.0) - (outward < 0.0)
        kept, branches = list[float](), list[int]()
        moving = np.append(start[: layout.moving], (0.0, 1.0))
        for place, each in enumerate(self.elements):
            if place in self.attached:
                elongation = float(self.attached[place] @ moving)
            else:
                elongation = 0.0 if side == CLOSED else float(self.elongations(each, side, np.array(abs(rotation))))
            branch, remembered = each.state_after_slow_stretch(elongation)
            branches.append(branch)
            kept += remembered
        key = (side, *branches)
        if side != CLOSED and spin != 0.0:
            key = branches_of_moving_elements(self.properties, self.elements, key, 1 if spin > 0.0 else -1)
        start[layout.memory : layout.memory + len(kept)] = kept
        key = self.from_rest(key)
        start[layout.memory + len(kept) :] = self.marks(key)
        return key, start

    def bent_at_rest(self, plastic: Array) -> Array:
        """Return D of every mode in m, shape (N,), at rest in contact with plastic stretches of the elements, (E,).

        Everything is elastic but for elements that are broken, whose plastic stretch is NaN.
        """
        p, forces = self.properties, np.zeros(self.properties.n_modes)
        if not self.attached:
            return forces
        stiffness = np.diag(p.effective_mass * p.omega**2)
        for place, row in self.attached.items():
            each, r = self.elements[place], row[: p.n_modes]
            if not np.isnan(plastic[place]):
                pull = each.tension(each.branches[0])
                stiffness += pull.stiffness * np.outer(r, r)
                forces -= r * (pull.force + pull.internal_factor * plastic[place])
        return np.asarray(np.linalg.solve(stiffness, forces), dtype=float) if forces.any() else forces

    def from_rest(self, key: Key) -> Key:
        """Return the key of a base that does not slip, from its branches and those of the elements."""
        return key

    def marks(self, key: Key) -> tuple[float, ...]:
        """Return the last internal variables of the state, which tell the branches of attached elements."""
        return codes_of_branches(tuple(key[1 + place] for place in self.attached_places), self.code_base)

    def element_key(self, key: Key) -> Key:
        """Return the branches of the base and of the elements, without those that a kind of ground adds."""
        return key

    def with_branches(self, key: Key, branches: Sequence[int]) -> Key:
        """Return the key of the same phase with other branches of the elements."""
        return (key[0], *branches, *key[1 + len(branches) :])

    def branches_at(self, side: Array, rotation: Array, states: Array) -> NDArray[np.int64]:
        """Return the branches at the states of a history, by sides, rotations and internal variables, shape (n, K)."""
        branches = np.empty((side.size, 1 + len(self.elements)), dtype=np.int64)
        branches[:, 0] = side
        known = internal_places(self.elements)
        first = HEADER + self.layout.memory + internal_count(self.elements)
        codes = states[:, first : first + n_branch_codes(len(self.attached_places), self.code_base)]
        branches_of = branches_of_codes(codes, len(self.attached_places), self.code_base).T
        attached = dict(zip(self.attached_places, branches_of, strict=True))
        for place, each in enumerate(self.elements):
            if place in attached:
                branches[:, 1 + place] = attached[place]
                continue
            right, left = (self.elongations(each, which, np.abs(rotation)) for which in (RIGHT, LEFT))
            elongation = np.where(side < 0.0, left, right)
            first = HEADER + self.layout.memory + known.get(place, 0)
            found = each.branch_at(elongation, states[:, first : first + each.n_internal])
            at_rest = np.array([each.branch_at_rest(branch) for branch in range(max(each.branches) + 1)])
            branches[:, 1 + place] = np.where(side == 0.0, at_rest[found], found)
        return branches

    def elongations(self, element: Element, side: int, rotation: Array) -> Array:
        """Return the elongations δ of an element in m at rotations |θ| about a pivot, shape (n,)."""
        return arm_of_element(self.properties, element, side) * self.stretch_per_arm(rotation)

    def stretch_per_arm(self, rotation: Array) -> Array:
        """Return the elongations of an element per unit distance from the pivot at |θ|: 2 sin(|θ|/2), or |θ|."""
        return 2.0 * np.sin(0.5 * rotation) if self.complete else rotation

    def arms(self, side: Array) -> Array:
        """Return the distance of every element from the pivot of a side, or of a sign of θ, in m, shape (n, E)."""
        right, left = (
            np.array([arm_of_element(self.properties, each, which) for each in self.elements])
            for which in (RIGHT, LEFT)
        )
        return np.where(side[:, None] < 0.0, left, right)

    def elongations_at(self, states: Array) -> Array:
        """Return δ of every element at the states of a history in m, shape (n, E).

        That is r |θ|, in complete models 2 r sin(|θ|/2); on springs how far the base has risen there since it was at
        rest; and for attached elements as in `Attachment`.
        """
        rotation = self.layout.of(states, self.layout.rotation)
        found = self.arms(rotation) * self.stretch_per_arm(np.abs(rotation))[:, None]
        moving = states[:, HEADER : HEADER + self.layout.moving]
        for place, row in self.attached.items():
            found[:, place] = moving @ row[:-2] + row[-1]
        return found

    def stretch(self, place: int, stance: Key) -> Array:
        """Return the elongation of an element in m in a `stance`, for small rotations: a row, shape (C,).

        A tendon passes through all joints, any other element under the base through that of the base.
        """
        if place in self.attached:
            return self.attached[place].copy()
        row, each = np.zeros(self.layout.columns), self.properties.elements[place]
        for joint, side in enumerate(stance):
            if side != CLOSED and (joint == 0 or each.prestressed):
                row[self.layout.rotations[joint]] = side * each.arm(self.arm(joint, side), side)
        return row

    def tension(self, place: int, key: Key) -> Array:
        """Return the tension of an element in a phase in N, for small rotations: a row, shape (C,)."""
        branch, stance = self.element_key(key)[1 + place], self.stance(key)
        known = self._tensions.get((place, stance, branch))
        if known is None:
            known = self._tensions[place, stance, branch] = self._tension(place, stance, branch)
        return known

    @cached_property
    def _tensions(self) -> dict[tuple[int, Key, int], Array]:
        return {}

    def _tension(self, place: int, stance: Key, branch: int) -> Array:
        each, stretch, known = self.elements[place], self.stretch(place, stance), internal_places(self.elements)
        pull = each.tension(branch)
        row = pull.stiffness * stretch + pull.damping * rate_of_elongation_row(stretch, self.layout)
        row[-1] += pull.force
        if place in known:
            row[self.layout.memory + known[place]] += pull.internal_factor
        row.setflags(write=False)
        return row

    def attached_forces(self, key: Key, *, stories_only: bool = False) -> tuple[Array, Array]:
        """Return what attached elements add in a phase: rows.

        Returns
        -------
        accelerations : ndarray, shape (N, C)
            Of the modes in m/s², -r F/m* with the elongation r of an element per unit of D.
        forces : ndarray, shape (b, C)
            On the degrees of freedom of the base.
        """
        first = len(self.properties.elements) if stories_only else 0
        return self._forces_of([place for place in self.attached_places if place >= first], key)

    def _forces_of(self, places: Sequence[int], key: Key) -> tuple[Array, Array]:
        """Return what some elements add in a phase: as `attached_forces`."""
        if not places:
            layout = self.layout
            return np.zeros((layout.modes, layout.columns)), np.zeros((layout.freedoms, layout.columns))
        reach = np.array([self.stretch(place, self.stance(key)) for place in places])
        tensions = np.array([self.tension(place, key) for place in places])
        of_modes = reach[:, : self.layout.modes] / self.properties.effective_mass
        of_base = reach[:, self.layout.rotation : self.layout.core : 2]
        return -of_modes.T @ tensions, -of_base.T @ tensions

    def ties(self, key: Key) -> Array:
        """Return the horizontal force of the ground on the base that ties from a height demand in N: a row, (C,)."""
        row = np.zeros(self.layout.columns)
        for place, each in enumerate(self.properties.elements):
            if each.height is not None:
                row += each.cosine * self.tension(place, key)
        return row

    def uplifted(self, states: Array) -> Bools:
        """Return whether the base is off the ground, on springs whether an edge has left its spring, shape (n,)."""
        return states[:, SIDE] != 0.0

    def uplift_times(self, states: Array) -> Array:
        """Return the times of uplift in s; on springs those at which an edge leaves its spring."""
        uplifted = self.uplifted(states)
        return states[1:, TIME][~uplifted[:-1] & uplifted[1:]]

    def impact_times(self, states: Array) -> Array:
        """Return the times of impact in s; on springs those at which an edge comes back to its spring."""
        return states[1:, TIME][self.impacts(states)]

    def impacts(self, states: Array) -> Bools:
        """Return True for the interval between the two states of every impact, shape (n - 1,); on springs none."""
        spin, rotation = (self.layout.of(states, place) for place in (self.layout.spin, self.layout.rotation))
        time, side = states[:, TIME], states[:, SIDE]
        landed = (time[1:] == time[:-1]) & (side[:-1] != 0.0) & (rotation[:-1] == 0.0)
        # A base that bounces turns back; in an event of an element at the same instant rounding may change θ'.
        return landed & ((side[1:] != side[:-1]) | (spin[1:] * spin[:-1] < 0.0))

    def stayed_uplifted(self, largest: float, final: Array) -> bool:  # noqa: ARG002
        """Return whether the base of a run without uplift and impact was off the ground all the time.

        Parameters
        ----------
        largest
            Largest |θ| of the run in rad.
        final : ndarray, shape (size,)
            Its last state.
        """
        return largest > 0.0

    def edge_uplift(self, states: Array) -> Array:
        """Return the rise of the left and of the right edge in m, negative where they settle, shape (n, 2)."""
        rotation = self.layout.of(states, self.layout.rotation)
        turn = self.turned(rotation)
        return 2.0 * self.properties.half_width * np.stack((np.maximum(turn, 0.0), np.maximum(-turn, 0.0)), axis=1)

    def heave(self, states: Array) -> Array:
        """Return the rise of the base at the axis of the masses in m, shape (n,).

        On springs from the level at which they are unloaded, on rigid ground the distance to the pivot times |θ|.
        """
        p, (left, right) = self.properties, self.edge_uplift(states).T
        return (p.pivot(1).arm * left + p.pivot(-1).arm * right) / (2.0 * p.half_width)

    def raised_weight(self, states: Array) -> Array:
        """Return the gravity energy per unit of gravity in kg m, for small rotations, shape (n,)."""
        p, rotation, side = self.properties, self.layout.of(states, self.layout.rotation), states[:, SIDE]
        arm = np.where(side < 0.0, p.pivot(-1).arm, p.pivot(1).arm)
        return side * p.m_tot * arm * rotation - 0.5 * p.l0r * rotation**2

    def rotary_inertia(self, side: Array) -> Array:
        """Return the inertia of the rotation on each side in kg m², shape (n,): I_θ about the pivot."""
        p = self.properties
        return np.where(side < 0.0, p.pivot(-1).i_theta, p.pivot(1).i_theta)

    def kinetic_energy(self, states: Array) -> Array:
        """Return the energy of the motion relative to the ground in J, for small rotations, shape (n,).

        ½ I_θ θ'² + θ' Σ m* h* D' + ½ Σ m* D'²; with a slip x plus ½ m_tot x'² + x' (L_0^r θ' + Σ m* D'), on springs
        plus ½ m_tot z'².
        """
        p, layout, v = self.properties, self.layout, self.layout.velocities(states)
        spin = layout.of(states, layout.spin)
        found = 0.5 * self.rotary_inertia(states[:, SIDE]) * spin**2
        found += spin * (v @ (p.effective_mass * p.effective_height)) + 0.5 * v**2 @ p.effective_mass
        if layout.heave >= 0:
            found += 0.5 * p.m_tot * layout.of(states, layout.heave + 1) ** 2
        if layout.slip >= 0:
            slide = layout.of(states, layout.slip + 1)
            found += slide * (0.5 * p.horizontal_mass * slide + p.l0r * spin + v @ p.effective_mass)
        return found

    @property
    def sides(self) -> tuple[int, ...]:
        """Possible sides of the base: contact, and both pivots if it can lift."""
        return (CLOSED, *self.properties.sides) if self.lifts else (CLOSED,)

    @property
    def slip_marks(self) -> tuple[int, ...]:
        """Values of the slip where it is the last internal variable of a state, by itself; none elsewhere."""
        return ()

    @property
    def branch_values(self) -> list[Collection[int]]:
        """Values of each of `branches_at`, but that of a slip with marks, which is the last one."""
        return [self.sides, *(each.branches for each in self.elements)]

    def bordered_system(self, key: Key) -> BorderedSystem:
        """Return the equations of motion of a linear phase (Eq. 15 or 23)."""
        known = self._bordered_systems.get(key)
        if known is None:
            if len(self._bordered_systems) >= MAX_PHASES:
                self._bordered_systems.clear()
            known = self._bordered_systems[key] = self._new_bordered_system(key)
        return known

    @cached_property
    def _bordered_systems(self) -> dict[Key, BorderedSystem]:
        return {}

    def _new_bordered_system(self, key: Key) -> BorderedSystem:
        p = self.properties
        leverage = (p.effective_mass * p.effective_height)[None]
        coupling = p.effective_height[None]
        free = self.is_free(key)
        equations = base_equations_of(p, self.elements, key, self.gravity) if free else BaseEquations.on_rotation()
        flexibility: Array = np.zeros((1, 1))
        if free:
            flexibility[:] = np.linalg.inv(equations.inertia - leverage @ coupling.T)
        return BorderedSystem(
            coupling=coupling.copy(),
            leverage=leverage,
            flexibility=flexibility,
            damping=equations.damping,
            stiffness=equations.stiffness,
            constant=equations.constant,
            drive=equations.ground + leverage.sum(axis=1) if free else equations.ground,
            internal_factor=equations.internal_factor if free else np.zeros((1, internal_count(self.elements))),
            freed=np.array([free]),
        )

    def free_inertia(self, side: int) -> float:
        """Return I_θ - Σ m* h*² about the pivot of a side in kg m²: the inertia of the rotation with free modes."""
        p = self.properties
        return p.pivot(side).i_theta - float(np.sum(p.effective_mass * p.effective_height**2))

    @cached_property
    def restoring(self) -> Array:
        """Restoring accelerations of the modes, ω² D or those of Eq. 37, in m/s²: rows, shape (N, C)."""
        n, omega2 = self.properties.n_modes, self.properties.omega**2
        rows = np.zeros((n, self.layout.columns))
        rows[:, :n] = np.diag(omega2)
        if self.bouc_wen is not None:
            share = self.bouc_wen.post_yield_ratio
            rows[:, :n] *= share
            rows[:, self.layout.hysteresis] = omega2 * self.bouc_wen.yield_displacement * (1.0 - share)
        rows.setflags(write=False)
        return rows

    def restoring_in(self, key: Key) -> Array:
        """Return the restoring accelerations in a phase, with those of stories that yield: rows, shape (N, C)."""
        if not self.properties.stories:
            return self.restoring
        return self.restoring - self.attached_forces(key, stories_only=True)[0]

    def contact_moment(self, key: Key) -> Array:
        """Return the overturning moment in a phase in which the base stands still, in N m: a row, shape (C,)."""
        return self.overturning_moment(key)

    def overturning_moment(self, key: Key) -> Array:
        """Return the overturning moment of a phase (left-hand side of Eq. 24 or 16) in N m: a row, shape (C,).

        That is of a base that neither rotates nor slides; attached elements are included.
        """
        row = self._moment_in(key).copy()
        if self.complete:
            row[: self.properties.n_modes] -= self.properties.effective_mass * self.gravity
        return row

    def _moment_in(self, key: Key) -> Array:
        if not self.attached:
            return self._moment
        p, (accelerations, forces) = self.properties, self.attached_forces(key)
        return self._moment + (p.effective_mass * p.effective_height) @ accelerations - forces[0]

    @cached_property
    def _moment(self) -> Array:
        p = self.properties
        n = p.n_modes
        arm = p.effective_mass * p.effective_height
        row = -(arm @ self.restoring) if n else np.zeros(self.layout.columns)
        row[n : 2 * n] -= arm * 2.0 * p.zeta * p.omega
        row[-2] = p.l0r - arm.sum()
        return row

    def angular_acceleration(self, key: Key) -> Array:
        """Return θ'' in a phase of a simplified model, Eq. 23 with D'' eliminated, in rad/s²: a row, shape (C,)."""
        return self.accelerations(key)[self.properties.n_modes]

    def modal_accelerations(self, key: Key) -> Array:
        """Return D'' of every mode in a phase, Eq. 15 or 23, in m/s²: rows, shape (N, C)."""
        return self.accelerations(key)[: self.properties.n_modes]

    def accelerations(self, key: Key) -> Array:
        """Return D'' of every mode and q'' of the base, θ'' first, in a phase: read-only rows, shape (N + b, C)."""
        known = self._accelerations.get(key)
        if known is None:
            if len(self._accelerations) >= MAX_PHASES:
                self._accelerations.clear()
            known = self._accelerations[key] = self._new_accelerations(key)
            known.setflags(write=False)
        return known

    @cached_property
    def _accelerations(self) -> dict[Key, Array]:
        return {}

    def _new_accelerations(self, key: Key) -> Array:
        p = self.properties
        n, modes = p.n_modes, np.arange(p.n_modes)
        rows = np.zeros((n + 1, self.layout.columns))
        rows[:n] -= self.restoring
        rows[modes, n + modes] -= 2.0 * p.zeta * p.omega
        rows[:n, -2] = -1.0
        if self.attached:
            rows[:n] += self.attached_forces(key)[0]
        if self.is_free(key):
            bordered_system, turn = self.bordered_system(key), rows[n]
            turn -= self._moment_in(key)
            turn[self.layout.rotation] -= bordered_system.stiffness[0, 0]
            turn[self.layout.spin] -= bordered_system.damping[0, 0]
            turn[-1] += bordered_system.constant[0]
            turn[self.layout.memory : self.layout.memory + bordered_system.internal_factor.size] += (
                bordered_system.internal_factor[0]
            )
            turn *= bordered_system.flexibility[0, 0]
            rows[:n] -= np.outer(p.effective_height, turn)
        return rows

    def ground_phase(self, key: Key, branch: int) -> GroundPhase | None:  # noqa: ARG002
        """Return what a `GroundField` knows of a phase; None on rigid ground without sliding."""
        return None

    def is_free(self, key: Key) -> bool:
        """Return whether the base rotates in a phase: it neither rests on the ground nor is held at a rotation."""
        return key[0] != CLOSED and not is_held_by_dampers(self.properties, self.elements, key)

    def spring_forces(self, key: Key) -> Array:  # noqa: ARG002
        """Return the force of each spring under the base in a phase in N, upwards: rows, shape (n_springs, C)."""
        return np.zeros((0, self.layout.columns))

    def lost_support(self, key: Key) -> Array:
        """Return the decrease of ΣF_z below its value at rest in a phase, in N: a row, shape (C,).

        ΣF_z = m_tot (g + s B θ'') plus the tensions of the elements, Eq. 22 for small rotations with the sign
        corrected; at rest it is m_tot g plus the prestress. While a complete model rocks the row is zero, and
        `RockingField.observe` gives the value.
        """
        row, side, p = np.zeros(self.layout.columns), key[0], self.properties
        if self.bends(side):
            return row
        row -= (self.lifts_by(self.stance(key)) * self.weights) @ self.accelerations(key)[self.layout.turns]
        row -= self.vertical_tension(key)
        row[-1] += self.properties.prestress
        row[-1] -= p.m_tot * (self.gravity - GRAVITY)
        return row

    def axial_forces(self, key: Key) -> Array:
        """Return N of each joint above the base in a phase in N, for small rotations: rows, shape (J, C).

        Σ m (g + v'') of the masses above it, which the open joints below them lift, and the tensions of the tendons,
        which run through it.
        """
        places = [
            place for place, each in enumerate(self.properties.elements) if each.prestressed and not each.attached
        ]
        above = np.minimum(self.weights[1:, None], self.weights)
        rows = (above * self.lifts_by(self.stance(key))) @ self.accelerations(key)[self.layout.turns]
        rows += sum((self.tension(place, key) for place in places), np.zeros(self.layout.columns))
        rows[:, -1] += self.weights[1:] * self.gravity
        return rows

    def tensions(self, key: Key) -> Array:
        """Return the tension of every element in a phase in N, for small rotations: rows, shape (E, C)."""
        rows = np.zeros((len(self.elements), self.layout.columns))
        for place in range(len(self.elements)):
            rows[place] = self.tension(place, key)
        if is_held_by_dampers(self.properties, self.elements, self.element_key(key)):
            self._hold(key, rows)
        return rows

    def vertical_tension(self, key: Key) -> Array:
        """Return the sum of the tensions of the elements under the base in a phase in N: a row, shape (C,)."""
        under = [place for place, each in enumerate(self.elements) if each.position is not None]
        return self.tensions(key)[under].sum(axis=0)

    def _hold(self, key: Key, rows: Array) -> None:
        """Add the tensions of friction dampers that hold the base: together they balance all other moments."""
        if self.complete:  # that is not linear in the motion, see `held_moment`
            return
        side, layout, p = key[0], self.layout, self.properties
        moment = -self.overturning_moment(key)
        others = base_equations_of(p, self.elements, key, self.gravity)
        moment[layout.rotation] -= others.stiffness[0, 0]
        moment[-1] += others.constant[0]
        moment[layout.memory : layout.memory + others.internal_factor.size] += others.internal_factor[0]
        rows += np.outer(friction_damper_shares(p, self.elements, side), moment)
