"""The simplified models: linear in contact, linear while rocking, joined by guards and jumps (Eqs. 15, 23-25)."""

from dataclasses import dataclass, field

from rockflex._constants import GRAVITY
from rockflex.modal import RockingProperties
from rockflex.models._impact import ImpactLaw, VVELSimplified
from rockflex.models._modal_model import ModalModel
from rockflex.models._phase import Key, Phase

NEUTRAL = 0.01  # of L_0^r g: nearer to balance the steady rotation, ∝ 1/`rocking_stiffness`, drowns the motion


@dataclass(frozen=True, eq=False)
class LinearModel(ModalModel):
    """N modes on a base that may uplift: Eqs. 15, 23, 24 and 25.

    Parameters
    ----------
    label
        The model's name, such as ``"2DOF-S"``.
    properties
        The structure's parameters, with the modes of this model alone.
    lifts
        Whether the base can lift; if not, this is the structure on a fixed base.
    law
        What happens at an impact.
    missing_mass
        Whether base shear and base moment count the mass that the modes leave out, as if it moved with the base.
    """

    label: str
    properties: RockingProperties
    lifts: bool = True
    law: ImpactLaw = field(default_factory=VVELSimplified)
    missing_mass: bool = False

    @property
    def neutral(self) -> bool:
        """Whether tendons balance the weight so closely that a rocking base has no steady rotation to speak of."""
        p = self.properties
        least = min(abs(p.pivot(side).rocking_stiffness) for side in (1, -1))
        return self.lifts and least < NEUTRAL * p.l0r * GRAVITY

    @property
    def linear(self) -> "LinearModel":
        """The model itself, as of every model its simplified, elastic one."""
        return self

    def phase(self, key: Key) -> Phase:
        """Return one phase: the equations of motion on these branches, and what ends it."""
        return Phase(key, key[0], self.arrow(key), self.guards(key))
