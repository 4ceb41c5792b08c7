"""What a history tells about the base on its ground."""

import numpy as np

from rockflex._arrays import Array, Bools
from rockflex.models import RISE, SIDE, TIME, RockingModel, SpringModel, lifted_springs, spring_forces
from rockflex.response._pressure import no_area, pressure_of


class GroundHistory:
    """Slip, heave, edges and springs of the base at the states of a history."""

    model: RockingModel
    states: Array

    @property
    def vertical_ground_acceleration(self) -> Array:
        """Vertical acceleration of the ground in m/s², positive upwards, shape (n_states,)."""
        return self.states[:, RISE]

    @property
    def slip(self) -> Array:
        """Displacement of the base along the ground in m, positive to the right; zero if it cannot slide."""
        return self._of_base(self.model.layout.slip)

    @property
    def slip_velocity(self) -> Array:
        """Velocity of the slip in m/s, shape (n_states,)."""
        layout = self.model.layout
        return self._of_base(layout.slip + 1 if layout.slip >= 0 else -1)

    @property
    def heave(self) -> Array:
        """Rise of the base at the axis of the masses in m, shape (n_states,).

        On springs from the level at which they are unloaded, on rigid ground the distance to the pivot times |θ|.
        """
        if isinstance(self.model, SpringModel):
            return self._of_base(self.model.layout.heave)
        p, left, right = self.model.properties, self.edge_uplift[:, 0], self.edge_uplift[:, 1]
        return (p.pivot(1).arm * left + p.pivot(-1).arm * right) / (2.0 * p.half_width)

    @property
    def edge_uplift(self) -> Array:
        """Rise of the left and of the right edge of the base in m, negative where it settles, shape (n_states, 2)."""
        p, rotation = self.model.properties, self.model.layout.of(self.states, self.model.layout.rotation)
        if isinstance(self.model, SpringModel):
            places = np.array([-p.pivot(-1).arm, p.pivot(1).arm])
            return self.heave[:, None] - places * rotation[:, None]
        turn = np.sin(rotation) if self.model.complete else rotation
        return 2.0 * p.half_width * np.stack((np.maximum(turn, 0.0), np.maximum(-turn, 0.0)), axis=1)

    @property
    def uplifted(self) -> Bools:
        """Whether the base is off the ground, on springs whether an edge has left its spring, shape (n_states,)."""
        if isinstance(self.model, SpringModel):
            lifted = lifted_springs(self.model, self.states)
            return lifted[:, 0] | lifted[:, -1]
        return self.states[:, SIDE] != 0.0

    @property
    def spring_force(self) -> Array:
        """Upward force of each spring under the base in N, shape (n_states, n_springs); none on rigid ground."""
        if not isinstance(self.model, SpringModel):
            return np.zeros((self.states.shape[0], 0))
        return spring_forces(self.model, self.states)

    @property
    def soil_pressure(self) -> Array:
        """Pressure under the base at each spring in Pa, shape (n_states, n_springs).

        Raises
        ------
        InputError
            If the springs have no `area`.
        """
        return pressure_of(self.spring_force, self.model.springs if isinstance(self.model, SpringModel) else None)

    @property
    def bearing_pressure(self) -> Array:
        """Static bearing pressure in Pa, shape (n_states,): the resultant of the springs over its effective area.

        Without dashpots, and uniform over the part 2 (B - |e|) of the base whose middle is the resultant, at the
        eccentricity e: the area of Meyerhof (1953), by which bearing capacities are given, whatever the distribution of
        stiffness. The end zones of a bed and its dashpots raise `soil_pressure` above it. Zero in flight; on one spring
        alone it is the pressure of that spring.

        Raises
        ------
        InputError
            If the springs have no `area`.
        """
        model = self.model
        springs = model.springs if isinstance(model, SpringModel) else None
        if springs is None or springs.area is None:
            raise no_area()
        turn = model.layout.of(self.states, model.layout.rotation)[:, None]
        pushes = springs.stiffness * np.maximum(springs.positions * turn - self.heave[:, None], 0.0)
        force, p = pushes.sum(axis=1), model.properties
        middle = 0.5 * (p.pivot(1).arm - p.pivot(-1).arm)
        moved = np.abs(pushes @ (springs.positions - middle)) / np.where(force > 0.0, force, 1.0)
        return force / (springs.area.sum() * (1.0 - moved / p.half_width))

    def _of_base(self, place: int) -> Array:
        return self.model.layout.of(self.states, place) if place >= 0 else np.zeros(self.states.shape[0])


def edge_times(model: SpringModel, states: Array, *, lifts: bool) -> Array:
    """Return the times in s at which an edge of a base leaves its spring, or comes back to it."""
    lifted = lifted_springs(model, states)[:, [0, -1]]
    changes = lifted[1:] & ~lifted[:-1] if lifts else ~lifted[1:] & lifted[:-1]
    return np.repeat(states[1:, TIME], changes.sum(axis=1))
