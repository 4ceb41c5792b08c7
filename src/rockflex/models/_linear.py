"""The simplified models: linear in contact and while rocking, connected by guards and jumps (Eqs. 15, 23-25)."""

from dataclasses import dataclass, field

from rockflex._constants import GRAVITY
from rockflex.modal import RockingProperties
from rockflex.models._impact import ImpactLaw, VVELSimplified
from rockflex.models._modal_model import ModalModel
from rockflex.models._phase import Key, Phase
from rockflex.models._rocking_phase import phase_of


@dataclass(frozen=True, eq=False)
class LinearModel(ModalModel):
    """N modes on a base that may uplift: Eqs. 15, 23, 24 and 25.

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
    """

    label: str
    properties: RockingProperties
    lifts: bool = True
    law: ImpactLaw = field(default_factory=VVELSimplified)
    missing_mass: bool = False
    gravity: float = GRAVITY

    @property
    def linear(self) -> "LinearModel":
        """The simplified, elastic model of the same modes: the model itself."""
        return self

    def phase(self, key: Key) -> Phase:
        """Return one phase: the equations of motion on these branches, and the conditions that end it."""
        return phase_of(self, key, self.arrow(key))
