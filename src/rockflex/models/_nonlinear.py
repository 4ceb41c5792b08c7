"""The nonlinear models: complete (Eqs. 13-16 and 26-29), yielding (Eqs. 37-38), or both."""

from dataclasses import dataclass, field

from rockflex._constants import GRAVITY
from rockflex.modal import RockingProperties
from rockflex.models._bouc_wen import BoucWen
from rockflex.models._elements import CLOSED
from rockflex.models._impact import ImpactLaw, VVELSimplified
from rockflex.models._linear import LinearModel
from rockflex.models._modal_model import ModalModel
from rockflex.models._phase import Key, Phase
from rockflex.models._rocking_phase import phase_of


@dataclass(frozen=True, eq=False)
class NonlinearModel(ModalModel):
    """N modes on a base that may uplift, with large rotations, a yielding superstructure, or both.

    Parameters
    ----------
    label
        Label of the model, such as ``"2DOF-C"``.
    properties
        Parameters of the structure, with only the modes of this model.
    lifts
        Whether the base can lift; otherwise it is fixed.
    law
        Impact law.
    complete
        Whether to use Eqs. 13, 14 and 16 with all trigonometric, centrifugal and P-Δ terms, or Eqs. 23 and 24.
    bouc_wen
        Hysteresis of the one mode, or None for an elastic superstructure.
    missing_mass, gravity
        As in `LinearModel`.
    """

    label: str
    properties: RockingProperties
    lifts: bool = True
    law: ImpactLaw = field(default_factory=VVELSimplified)
    complete: bool = True  # pyright: ignore[reportIncompatibleMethodOverride]
    bouc_wen: BoucWen | None = None  # pyright: ignore[reportIncompatibleMethodOverride]
    missing_mass: bool = False
    gravity: float = GRAVITY

    @property
    def integrated(self) -> bool:
        """Always True: the model is integrated while it rocks, and with a hysteretic spring also in contact."""
        return True

    @property
    def linear(self) -> LinearModel:
        """The simplified, elastic model of the same modes."""
        return LinearModel(self.label, self.properties, self.lifts, self.law, self.missing_mass, self.gravity)

    def phase(self, key: Key) -> Phase:
        """Return one phase; it is linear only in contact with an elastic superstructure."""
        linear = key[0] == CLOSED and self.bouc_wen is None
        return phase_of(self, key, self.arrow(key) if linear else None)
