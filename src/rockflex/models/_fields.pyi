from collections.abc import Callable, Sequence

from rockflex.engine.field import Field, Jump
from rockflex.foundation.arrays import Array
from rockflex.models._field_numbers import FieldNumbers
from rockflex.models._impact import LandingRule
from rockflex.structure._rocking import RockingProperties

class RockingField(Field):
    def __init__(
        self,
        numbers: FieldNumbers,
        side: int,
        branch: int,
        pulls: Array,
        stops: Sequence[tuple[int, int, tuple[float, float]]],
        releases: Array | None = None,
        grip: float = 0.0,
    ) -> None: ...
    @property
    def size(self) -> int: ...
    def imbalance_along(self, states: Array, rates: Array, a: Array, a_v: Array) -> Array: ...
    def inertia_at(self, y: Array) -> float: ...

class LinearTurn(Field):
    def __init__(self, row: Array, vertical: Array, spin: int) -> None: ...

class Landing(Jump):
    def __init__(
        self,
        gains: Callable[[], BaseException],
        properties: RockingProperties,
        side: int,
        complete: bool,
        rule: LandingRule,
        beyond: Field,
        size: int,
        slip: int,
        turnings: Sequence[tuple[int, float, float]],
    ) -> None: ...

class Change(Jump):
    def __init__(
        self,
        rotation: int,
        chords: bool,
        stops: bool,
        turnings: Sequence[tuple[int, float, float]],
        marks: Sequence[tuple[int, float]],
    ) -> None: ...

class Reversal(Jump):
    def __init__(self, velocity: int, barely: float) -> None: ...
