"""How near a run came to overturning about either edge of its base; the edges of an eccentric base differ."""

import math

import numpy as np

from rockflex.modal import RockingProperties
from rockflex.response import History, Response


def largest_rotations(run: Response, history: History) -> dict[int, float]:
    """Return the largest |θ| in rad to the right (1) and to the left (-1).

    The larger one is that of the response; the other is that of the stored states.
    """
    found = {side: float(np.max(side * history.rotation, initial=0.0)) for side in (1, -1)}
    found[max(found, key=found.__getitem__)] = run.max_rotation
    return found


def nominal_share(p: RockingProperties, run: Response, history: History) -> float:
    """Return the largest |θ| over the nominal limit θ_nom = 0.7 atan(b/h*_1), to the side on which it is larger."""
    sides = largest_rotations(run, history).items()
    return max(value / p.pivot(side).nominal_overturning_rotation for side, value in sides)


def overturning_margin(p: RockingProperties, run: Response, history: History) -> float:
    """Return the smaller of the nominal limits over the rotation to the same side; infinite without rotation."""
    share = nominal_share(p, run, history)
    return 1.0 / share if share else math.inf
