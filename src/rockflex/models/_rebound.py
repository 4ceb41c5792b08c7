"""The impact of a structure that opens to one side, at the wall behind it."""

from dataclasses import dataclass
from typing import Annotated

from rockflex.foundation.arrays import Array
from rockflex.foundation.descriptions import described
from rockflex.foundation.schema import RESTITUTION, SHORTEST_EXCURSION, ShortestExcursion
from rockflex.structure._rocking import RockingProperties


@described
@dataclass(frozen=True)
class Rebound:
    """A base that opens to one side turns back at the wall behind it with a fraction e of its velocity, θ' → -e θ'.

    It belongs to structures that open to one side (`OneSided`), which take no other law.
    """

    e: Annotated[float, RESTITUTION]
    shortest_excursion: ShortestExcursion = SHORTEST_EXCURSION

    keeps = "the horizontal velocity of every mass, and a share of the rotation, turned back"
    loses = "the rest of the rotation's energy"

    def __post_init__(self) -> None:
        """Check nothing beyond what is known of each field."""

    def after(
        self, properties: RockingProperties, modal_velocity: Array, rotation_velocity: float, *_: Array
    ) -> tuple[Array, float]:
        """Return D'_n + h*_n (1 + e) θ', and -e θ'."""
        back = -self.e * rotation_velocity
        return modal_velocity + properties.effective_height * (rotation_velocity - back), back
