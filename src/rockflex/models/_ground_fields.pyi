from collections.abc import Sequence
from typing import Any

from rockflex.engine.field import Field
from rockflex.foundation.arrays import Array
from rockflex.models._field_numbers import FieldNumbers
from rockflex.models._phase import GroundPhase

GRIP: int
PRESSURE: int
PUSH: int
DEPTH: int
STRETCH: int
SPEED: int

class GroundField(Field):
    def __init__(
        self,
        numbers: FieldNumbers,
        phase: GroundPhase,
        stops: Sequence[tuple[int, int, tuple[float, float]]],
        checks: Sequence[tuple[Any, ...]],
    ) -> None: ...
    def inertia_at(self, y: Array) -> float: ...
