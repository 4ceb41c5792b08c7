from collections.abc import Sequence

from rockflex.engine.system import Key, System
from rockflex.foundation.arrays import Array, Integers

class Batch:
    place: int

    def __init__(
        self,
        system: System,
        records: Sequence[Array],
        scales: Sequence[float] | Array | None = None,
        free: int | Sequence[int] = 0,
        settles: bool = False,
        names: Sequence[str] = (),
        verticals: Sequence[Array | None] | None = None,
        start: Array | Sequence[float] | None = None,
        keys: Sequence[Key] | None = None,
        which: Sequence[int] | None = None,
    ) -> None: ...
    @property
    def count(self) -> int: ...
    @property
    def names(self) -> tuple[str, ...]: ...
    @property
    def outcomes(self) -> Integers: ...
    @property
    def places(self) -> Integers: ...
    @property
    def times(self) -> Array: ...
    @property
    def counts(self) -> Integers: ...
    @property
    def high(self) -> Array: ...
    @property
    def when(self) -> Array: ...
    @property
    def states(self) -> Array: ...
