"""What a history tells about the elements between the base and the ground."""

from functools import cached_property

from rockflex._arrays import Array
from rockflex.modal import Tendon
from rockflex.models import RockingModel, element_forces, elongations


class ElementHistory:
    """Forces and elongations of the elements of the base at the states of a history."""

    model: RockingModel
    states: Array

    @property
    def tendon_force(self) -> Array:
        """Force of each tendon in N, in the order of `RockingProperties.tendons`, shape (n_states, n_tendons)."""
        places = [k for k, each in enumerate(self.model.properties.elements) if isinstance(each, Tendon)]
        return self.element_force[:, places]

    @cached_property
    def element_force(self) -> Array:
        """Force of each element of the base in N, positive if it pulls the base down, shape (n_states, E).

        The order is that of `RockingProperties.elements`.
        """
        values = element_forces(self.model, self.states)
        values.setflags(write=False)
        return values

    @property
    def element_elongation(self) -> Array:
        """Elongation r |θ| of each element in m, in complete models 2 r sin(|θ|/2), shape (n_states, E)."""
        return elongations(self.model, self.states)
