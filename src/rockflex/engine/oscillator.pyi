from collections.abc import Sequence

from rockflex.foundation.arrays import Array

def peaks(acceleration: Array, h: float, frequencies: Array | Sequence[float], zeta: float) -> Array: ...
def rotated_peaks(
    first: Array, second: Array, h: float, frequencies: Array | Sequence[float], zeta: float, angles: Array
) -> Array: ...
