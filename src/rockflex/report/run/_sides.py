"""How near a run came to overturning about either edge of its base; the edges of an eccentric base differ."""

import math

import numpy as np

from rockflex.modal import RockingProperties
from rockflex.response import History, Response


def slenderness_angle(p: RockingProperties, side: int) -> float:
    """Return α = atan(arm/h*_1) in rad about the right (1) or left (-1) edge; for a rigid block h is L_0^r/m_tot."""
    height = float(p.effective_height[0]) if p.n_modes else p.l0r / p.m_tot
    return math.atan2(p.pivot(side).arm, height)


def largest_rotations(run: Response, history: History) -> dict[int, float]:
    """Return the largest |θ| in rad to the right (1) and to the left (-1).

    The larger one is that of the response; the other is that of the stored states.
    """
    found = {side: float(np.max(side * history.rotation, initial=0.0)) for side in (1, -1)}
    found[max(found, key=found.__getitem__)] = run.max_rotation
    return found


def slenderness_share(p: RockingProperties, run: Response, history: History) -> float:
    """Return the largest |θ|/α, to the side on which it is larger."""
    return max(value / slenderness_angle(p, side) for side, value in largest_rotations(run, history).items())


def overturning_margin(p: RockingProperties, run: Response, history: History) -> float:
    """Return the smaller of the nominal limits 0.7 α over the rotation to the same side; infinite without rotation."""
    sides = largest_rotations(run, history).items()
    return min((p.pivot(side).nominal_overturning_rotation / value for side, value in sides if value), default=math.inf)
