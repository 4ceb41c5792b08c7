"""What a history tells about the reactions of the ground, and the friction that they demand."""

from functools import cached_property

from rockflex._arrays import Array
from rockflex.models import RockingModel
from rockflex.response._friction import IMPACT_WINDOW, Friction


class ReactionHistory:
    """Ground reactions and friction demand at the states of a history."""

    model: RockingModel
    states: Array

    @property
    def horizontal_reaction(self) -> Array:
        """Horizontal ground reaction Σ m_i (a + x''_i) of Eq. 21, in N, shape (n_states,).

        In the simplified models, for small rotations: m_tot a + L_0^r θ'' + Σ m* D''.
        """
        return self._friction.reactions.horizontal

    @property
    def vertical_reaction(self) -> Array:
        """Vertical ground reaction Σ m_i (g + z''_i), in N, positive upwards, shape (n_states,).

        This is Eq. 22 with the sign of the weight corrected; as printed, it is smaller by 2 m_tot g. Tendon forces are
        included. In the simplified models, for small rotations: m_tot (g + s B θ'').
        """
        return self._friction.reactions.vertical

    @property
    def friction_demand(self) -> Array:
        """|ΣF_x| / ΣF_z of Eq. 20, dimensionless, shape (n_states,); infinite if the base would lose contact."""
        return self._friction.demand

    @cached_property
    def required_friction(self) -> float:
        """Largest friction demand of the run, including between states; infinite if the base would lose contact.

        Raises
        ------
        InputError
            If the model is too fast for the sampling.
        """
        return self._friction.required()

    def required_friction_excluding_impacts(self, window: float = IMPACT_WINDOW, printed: bool = False) -> float:
        """Return the largest friction demand except for the time after each impact, when it has short spikes.

        Parameters
        ----------
        window
            Seconds after each impact to exclude; with zero nothing is excluded. If no time remains, the result is zero.
        printed
            Use the magnitude of Eq. 22 as printed, Σ m_i (-g + z''_i), which has a wrong sign; for comparison.

        Raises
        ------
        InputError
            If `window` is negative or not finite, or the model is too fast for the sampling.
        """
        return self._friction_by(printed).required(window)

    def sliding_time(self, mu: float, printed: bool = False) -> float | None:
        """Return the time in s at which the friction demand first exceeds `mu` and sliding would start, or None.

        Parameters
        ----------
        mu
            Coefficient of friction, positive.
        printed
            As in `required_friction_excluding_impacts`.

        Raises
        ------
        InputError
            If `mu` is not a positive number, or the model is too fast for the sampling.
        """
        return self._friction_by(printed).sliding_time(mu)

    @cached_property
    def _friction(self) -> Friction:
        return Friction(self.model, self.states)

    def _friction_by(self, printed: bool) -> Friction:
        return Friction(self.model, self.states, printed=True) if printed else self._friction
