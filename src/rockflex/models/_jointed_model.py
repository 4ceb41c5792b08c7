"""The simplified models of structures that rock at several joints: the base, and joints above it."""

from collections.abc import Collection
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockflex.foundation.arrays import Array, Bools
from rockflex.models._base_motion import accelerations_of, bordered_system_of
from rockflex.models._elements import CLOSED, RIGHT, internal_count
from rockflex.models._phase import BaseEquations, BorderedSystem, Key
from rockflex.models._rocking_model import RockingModel
from rockflex.models._state_layout import (
    HEADER,
    TIME,
    StateLayout,
    branches_of_codes,
    codes_of_branches,
    n_branch_codes,
)
from rockflex.structure._rocking import RockingProperties


@dataclass(frozen=True, eq=False)
class JointedModel(RockingModel):
    """N modes on a base that may uplift, with joints above it that may open as well.

    A key has the side of the base, the branches of the elements, and the sides of the joints above the base. The state
    keeps all but the first as the last internal variables. Joint 0 is the base.
    """

    @cached_property
    def layout(self) -> StateLayout:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Layout of the state vector."""
        joints = len(self.properties.joints)
        return self._layout(n_branch_codes(len(self.elements) + joints, self.code_base), n_joints=joints)

    @cached_property
    def couplings(self) -> Array:  # pyright: ignore[reportIncompatibleMethodOverride]
        """The couplings of the modes with the rotations of all joints, shape (b, N)."""
        p = self.properties
        return np.array([p.effective_height, *(each.effective_height for each in p.joints)])

    @cached_property
    def horizontal_inertia(self) -> Array:
        """Σ m (z - Z_j) (z - Z_k) in kg m², shape (b, b)."""
        b, p = self.layout.freedoms, self.properties
        found = np.zeros((b, b))
        found[0, 0] = p.pivot(RIGHT).i_theta - p.m_tot * p.pivot(RIGHT).arm ** 2
        for j, each in enumerate(p.joints, 1):
            found[j, : j + 1] = found[: j + 1, j] = each.inertias
        return found

    @property
    def moving_places(self) -> tuple[int, ...]:
        """The places of all elements."""
        return tuple(range(len(self.elements)))

    @property
    def branch_values(self) -> list[Collection[int]]:
        """Values of each of `branches_at`: of the side of the base, every element, and the side of every joint."""
        return [self.sides, *(each.branches for each in self.elements), *((0, 1, -1) for _ in self.properties.joints)]

    def element_key(self, key: Key) -> Key:
        """Return the branches of the base and of the elements."""
        return key[: 1 + len(self.elements)]

    def stance(self, key: Key) -> Key:
        """Return the side of every joint, that of the base first."""
        return (key[0], *key[1 + len(self.elements) :])

    def with_side(self, key: Key, joint: int, side: int) -> Key:
        """Return the key with another side of a joint."""
        place = len(self.elements) + joint if joint else 0
        return (*key[:place], side, *key[place + 1 :])

    def start(self, side: int) -> Key:
        """Return the branches on which a run starts in contact, or as the base begins to rotate about a pivot."""
        return self.from_rest(super().start(side))

    def from_rest(self, key: Key) -> Key:
        """Return the key of a structure whose joints above the base are closed."""
        return (*key, *(CLOSED for _ in self.properties.joints))

    def marks(self, key: Key) -> tuple[float, ...]:
        """Return the last internal variables of the state, which tell all branches but the side of the base."""
        return codes_of_branches(key[1:], self.code_base)

    def branches_at(self, side: Array, rotation: Array, states: Array) -> NDArray[np.int64]:  # noqa: ARG002
        """Return the branches at the states of a history, shape (n, K)."""
        first, count = HEADER + self.layout.memory + internal_count(self.elements), self.layout.n_joints
        codes = states[:, first : HEADER + self.layout.size]
        branches = branches_of_codes(codes, len(self.elements) + count, self.code_base)
        return np.column_stack((side.astype(np.int64), branches))

    def sides_at(self, states: Array) -> NDArray[np.int64]:
        """Return the side of every joint at the states of a history, shape (n, b)."""
        found = self.branches_at(states[:, 1], states[:, 1], states)
        return found[:, [0, *range(found.shape[1] - self.layout.n_joints, found.shape[1])]]

    def is_free(self, key: Key) -> bool:
        """Return whether the base rotates in a phase."""
        return key[0] != CLOSED

    def elongations_at(self, states: Array) -> Array:
        """Return δ of every element at the states of a history in m, shape (n, E)."""
        found = np.zeros((len(states), len(self.elements)))
        moving = np.column_stack((states[:, HEADER : HEADER + self.layout.moving], np.zeros(len(states))))
        moving = np.column_stack((moving, np.ones(len(states))))
        stances, which = np.unique(self.sides_at(states), axis=0, return_inverse=True)
        for k, sides in enumerate(stances.tolist()):
            chosen = which.ravel() == k
            for place in self.moving_places:
                found[chosen, place] = moving[chosen] @ self.stretch(place, tuple(sides))
        return found

    def attached_forces(self, key: Key, *, stories_only: bool = False) -> tuple[Array, Array]:
        """Return what elements add in a phase, on the modes and on the rotations: rows."""
        first = len(self.properties.elements) if stories_only else 0
        return self._forces_of([place for place in self.moving_places if place >= first], key)

    def _new_bordered_system(self, key: Key) -> BorderedSystem:
        return bordered_system_of(self, self._base_equations(key), np.array(self.stance(key)) != CLOSED)

    def _base_equations(self, key: Key) -> BaseEquations:
        equations = BaseEquations.blank(self.layout.freedoms, self.layout.n_internal)
        lifts = self.lifts_by(self.stance(key))
        equations.inertia[:] = self.horizontal_inertia + np.outer(lifts, lifts) * self.shared_weights
        equations.stiffness[:] = -self.gravity * self.toppling
        equations.constant[:] = -self.gravity * self.weights * lifts
        equations.ground[:] = -self.levers
        return equations

    @cached_property
    def shared_weights(self) -> Array:
        """The mass that stands on both of two joints in kg, shape (b, b)."""
        return np.minimum(self.weights[:, None], self.weights)

    def _new_accelerations(self, key: Key) -> Array:
        return accelerations_of(self, key)

    def opening(self, key: Key, joint: int, side: int) -> Array:
        """Return the moment in N m that would turn a closed joint to a side: a row, shape (C,).

        It acts to that side once it has its sign; the weight above the joint, under the vertical acceleration that
        other open joints give it, is included.
        """
        p, layout, n = self.properties, self.layout, self.properties.n_modes
        opened = self.with_side(key, joint, side)
        equations, rows = self._base_equations(opened), self.accelerations(key)
        row = -equations.inertia[joint] @ rows[n:] - (p.effective_mass * self.couplings[joint]) @ rows[:n]
        row[layout.rotations] -= equations.stiffness[joint]
        row[-2] += equations.ground[joint]
        row[-1] += equations.constant[joint]
        for place in self.moving_places:
            reach = self.stretch(place, self.stance(opened))[layout.rotations[joint]]
            if reach:
                row -= reach * self.tension(place, key)
        return row

    def impacts(self, states: Array) -> Bools:
        """Return True for the interval between the two states of every landing of a joint, shape (n - 1,)."""
        return super().impacts(states) | self._landings(states).any(axis=1)

    def _landings(self, states: Array) -> Bools:
        """Return which joints above the base land between adjacent states, shape (n - 1, J).

        One that opens again to the same side at that instant has lost its velocity.
        """
        sides, time = self.sides_at(states)[:, 1:], states[:, TIME]
        spins = states[:, [HEADER + place + 1 for place in self.layout.rotations[1:]]]
        stopped = (sides[1:] != sides[:-1]) | ((spins[1:] == 0.0) & (spins[:-1] != 0.0))
        return (time[1:] == time[:-1])[:, None] & (sides[:-1] != CLOSED) & stopped

    def openings(self, states: Array) -> Bools:
        """Return which joints open between adjacent states, that of the base first, shape (n - 1, b)."""
        sides = self.sides_at(states)
        found = (sides[1:] != CLOSED) & (sides[1:] != sides[:-1])
        found[:, 1:] |= (sides[1:, 1:] != CLOSED) & self._landings(states)
        return found

    def uplift_times(self, states: Array) -> Array:
        """Return the times in s at which a joint opens, that of the base or another."""
        return np.repeat(states[1:, TIME], self.openings(states).sum(axis=1))

    def raised_weight(self, states: Array) -> Array:
        """Return the gravity energy per unit of gravity in kg m, for small rotations, shape (n,)."""
        turned = self.joint_rotations(states)
        lifts = self.lift_rates(np.sign(turned), turned)  # of the rotations themselves
        return lifts @ self.weights - 0.5 * np.einsum("nj,jk,nk->n", turned, self.toppling, turned)

    def kinetic_energy(self, states: Array) -> Array:
        """Return ½ q'ᵀ M q' of the rotations and the modes in J, shape (n,)."""
        p, v, spins = self.properties, self.layout.velocities(states), self.joint_spins(states)
        lifts = self.lift_rates(self.sides_at(states), spins)
        found = 0.5 * np.einsum("nj,jk,nk->n", spins, self.horizontal_inertia, spins)
        found += 0.5 * np.einsum("nj,jk,nk->n", lifts, self.shared_weights, lifts)
        return found + 0.5 * v**2 @ p.effective_mass + ((spins @ self.couplings) * v) @ p.effective_mass


def model_on_rigid_ground(
    label: str, properties: RockingProperties, lifts: bool, *given: Any, **more: Any
) -> RockingModel:
    """Return a model on rigid ground on which it does not slide, with the arguments of `RockingModel`."""
    made = JointedModel if properties.joints and lifts else RockingModel
    return made(label, properties, lifts, *given, **more)
