from collections.abc import Callable, Sequence

from rockflex.engine.tangent import Trace
from rockflex.engine.tangent_steps import Motion
from rockflex.foundation.arrays import Array, Bools

class Crossing:
    def __init__(
        self,
        jump: Array | None = None,
        slopes: Array | None = None,
        ask: Callable[[Array, float, float], tuple[Array, Array]] | None = None,
    ) -> None: ...

class Pass:
    def __init__(self, motions: Sequence[Motion | None], n: int, parameters: int, free: bool) -> None: ...
    def follow(
        self,
        trace: Trace,
        crossings: Sequence[Crossing],
        kinds: Sequence[int],
        start: Array,
        one_sided: Bools,
        observed: Sequence[int],
    ) -> Array: ...
    @property
    def result(self) -> tuple[Array, Array, Array]: ...
