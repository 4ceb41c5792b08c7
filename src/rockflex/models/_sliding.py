"""The simplified models on rigid ground on which they may slide, with Coulomb friction."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockflex.foundation.arrays import Array
from rockflex.models._base_motion import accelerations_of, bordered_system_of
from rockflex.models._elements import CLOSED, base_equations_of, element_force_sums
from rockflex.models._phase import BaseEquations, BorderedSystem, GroundPhase, Key
from rockflex.models._rocking_model import RockingModel
from rockflex.models._state_layout import HEADER, StateLayout, n_branch_codes

STICK = 0  # the last branch of a key: it sticks, slips to the right (1) or left (-1), or does so without friction (±2)
LOST = 2  # magnitude of the branch on which the ground has no pressure to rub against


@dataclass(frozen=True, eq=False)
class SlidingModel(RockingModel):
    """N modes on a base that may uplift and slide: nine phases of contact and rocking, of sticking and slipping.

    An impact keeps all horizontal velocities, also that of the base. The last internal variable of the state tells
    whether, and to which side, the base slips. In complete and yielding models the vertical reaction that friction acts
    on is that of all terms; elements slide along with the base, so that their inclination puts no horizontal force on
    the ground; and the velocities relative to the base change by the impact law while the base keeps its own.

    Parameters
    ----------
    label, properties, lifts, law, missing_mass, gravity, complete, bouc_wen
        As in `RockingModel`.
    friction
        Coulomb's coefficient between base and ground.
    """

    friction: float = np.inf

    @cached_property
    def layout(self) -> StateLayout:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Layout of the state vector."""
        return self._layout(n_branch_codes(len(self.attached_places), self.code_base) + 1, slides=True)

    @property
    def ground_parameters(self) -> dict[str, Any]:
        """Coulomb's coefficient."""
        return {"friction": self.friction}

    @property
    def slip_marks(self) -> tuple[int, ...]:
        """Values of the slip, which is the last internal variable of a state."""
        return tuple(range(-LOST, LOST + 1))

    def element_key(self, key: Key) -> Key:
        """Return the branches of the base and of the elements."""
        return key[:-1]

    def start(self, side: int) -> Key:
        """Return the branches on which a run starts in contact, or as the base begins to rotate about a pivot."""
        return (*super().start(side), STICK)

    def from_rest(self, key: Key) -> Key:
        """Return the key of a base that does not slip, from its branches and those of the elements."""
        return (*key, STICK)

    def marks(self, key: Key) -> tuple[float, ...]:
        """Return the last internal variables of the state: the branches of attached elements and that of the slip."""
        return (*super().marks(key), float(key[-1]))

    def is_free(self, key: Key) -> bool:
        """Return whether the base rotates in a phase."""
        return key[0] != CLOSED

    def branches_at(self, side: Array, rotation: Array, states: Array) -> NDArray[np.int64]:
        """Return the branches at the states of a history, shape (n, K)."""
        place = HEADER + self.layout.memory + self.layout.n_internal - 1
        return np.column_stack((super().branches_at(side, rotation, states), states[:, place].astype(np.int64)))

    def _new_bordered_system(self, key: Key) -> BorderedSystem:
        side, slip = key[0], key[-1]
        return bordered_system_of(self, self._base_equations(key), np.array([side != CLOSED, slip != STICK]))

    def _base_equations(self, key: Key) -> BaseEquations:
        """Return the forces on the rotation and the slip; friction is -sign(x') μ N."""
        p, side, slip, elements = self.properties, key[0], key[-1], self.element_key(key)
        equations = BaseEquations.blank(2, self.layout.n_internal)
        equations.inertia[1, 1], equations.ground[1] = p.horizontal_mass, -p.horizontal_mass
        equations.inertia[0, 1] = equations.inertia[1, 0] = p.l0r
        equations.ground[0] = -p.l0r
        if side != CLOSED:
            rocking = base_equations_of(p, self.elements, elements, self.gravity)
            equations.inertia[0, 0] = rocking.inertia[0, 0]
            equations.damping[0, 0], equations.stiffness[0, 0] = rocking.damping[0, 0], rocking.stiffness[0, 0]
            equations.constant[0] = rocking.constant[0]
            equations.internal_factor[0, : rocking.internal_factor.size] = rocking.internal_factor[0]
        if abs(slip) == 1:
            self._add_friction(equations, key)
        return equations

    def _add_friction(self, equations: BaseEquations, key: Key) -> None:
        """Add -sign(x') μ N with N = m_tot (g + s B θ'') + the tensions of the elements."""
        p, side, layout = self.properties, key[0], self.layout
        drag, pull = key[-1] * self.friction, self.vertical_tension(key)
        equations.constant[1] -= drag * (p.m_tot * self.gravity + pull[-1])
        equations.internal_factor[1] -= drag * pull[layout.memory : layout.memory + layout.n_internal]
        if side != CLOSED:
            equations.inertia[1, 0] += drag * side * p.m_tot * p.pivot(side).arm
            equations.stiffness[1, 0] += drag * pull[layout.rotation]
            equations.damping[1, 0] += drag * pull[layout.spin]

    def _new_accelerations(self, key: Key) -> Array:
        return accelerations_of(self, key)

    def contact_moment(self, key: Key) -> Array:
        """Return the overturning moment in a phase in which the base does not rotate, which its slip adds to."""
        p = self.properties
        moving = p.l0r - float(np.sum(p.effective_mass * p.effective_height))
        return self.overturning_moment(key) + moving * self.accelerations(key)[-1]

    def pressure(self, key: Key) -> Array:
        """Return the vertical reaction m_tot (g + s B θ'') and the tensions of the elements in N: a row, shape (C,)."""
        row = -self.lost_support(key)
        row[-1] += self.properties.resting_reaction
        return row

    def ground_phase(self, key: Key, branch: int) -> GroundPhase:
        """Return what moves and what acts in a phase."""
        p, side, slip = self.properties, key[0], key[-1]
        pivot = p.pivot(side or 1)
        return GroundPhase(
            side=side,
            branch=branch,
            turns=side != CLOSED,
            way=int(np.sign(slip)),
            pressed=slip != STICK and abs(slip) != LOST,
            offset=side * pivot.arm,
            inertia=pivot.i_theta,
            friction=self.friction,
            pulls=element_force_sums(p, self.elements, self.element_key(key)),
            springs=np.zeros((0, 5)),
            elements=np.zeros((0, 6)),
        )
