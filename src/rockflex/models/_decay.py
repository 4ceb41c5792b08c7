"""The restitution of a rocking structure from the decay of a free rocking test."""

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.checks import checked_finite_vector
from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.structure._rocking import RockingProperties


def restitution_from_decay(peaks: ArrayLike, properties: RockingProperties) -> float:
    """Return the restitution e from successive peaks of |θ|, as `AngularMomentum` and `Restitution` of blocks take it.

    Between two peaks the structure falls and rises again, with one impact. Its energy at a peak is that of the raised
    weight, g [m_tot B sin |θ| - L_0^r (1 - cos θ)], and the velocity at the impact beside it follows from that as of a
    rigid body: its vibration is taken to have decayed at the peaks, as in a stiff column. All peaks together give e,
    by a line through the logarithms of these velocities.

    Parameters
    ----------
    peaks
        Successive peaks of the rotation in rad, two at least, with or without their signs; the release counts. For an
        eccentric base with their signs, which alternate.
    properties
        The parameters of the structure.

    Raises
    ------
    InputError
        If there are less than two peaks, one of them is not between zero and the rotation at which the static moment
        vanishes, or together they do not fall; or if elements hold the structure, which store energy, too.

    Examples
    --------
    >>> import rockflex as rf
    >>> block = rf.rigid_block(slenderness=0.2, half_diagonal=3.0)
    >>> start = rf.InitialState(rotation=0.1)
    >>> law = rf.AngularMomentum(0.9)
    >>> run = rf.simulate(block, rf.quiet_motion(4.0), "rigid-C",
    ...     impact=law, initial=start)
    >>> turns = [abs(run.rotation[run.side == side]).max() for side in (1, -1)]
    >>> round(rf.restitution_from_decay(turns, block), 3)
    0.9
    """
    p, turns = properties, checked_finite_vector("peaks", peaks, "rad")
    if p.elements:
        raise InputError(
            "The properties have elements, which store energy at a peak, too. Test and give it without them.",
            field="properties",
        )
    if turns.size < 2:
        raise InputError(f"Two peaks at least are needed, but {turns.size} were given.", field="peaks")
    sides = np.where(turns < 0.0, -1, 1)
    if p.eccentricity != 0.0 and (sides[1:] == sides[:-1]).any():
        raise InputError(
            "On an eccentric base the edges differ, so peaks need their signs, which alternate, but "
            f"{shown(turns.tolist())} was given. Give θ, positive to the right.",
            field="peaks",
        )
    pivots = [p.pivot(int(side)) for side in sides]
    arms, inertias = (np.array([getattr(each, name) for each in pivots]) for name in ("arm", "i_theta"))
    angle = np.abs(turns)
    limit = np.arctan2(p.m_tot * arms, p.l0r)
    if not ((angle > 0.0) & (angle < limit)).all():
        raise InputError(
            f"Every peak must be above 0 and below {float(limit.min()):.4g} rad, at which the structure would not "
            f"return, but {shown(turns.tolist())} was given. Give |θ| in rad.",
            field="peaks",
        )
    energy = GRAVITY * (p.m_tot * arms * np.sin(angle) - 2.0 * p.l0r * np.sin(0.5 * angle) ** 2)
    place = np.arange(turns.size) - 0.5 * (turns.size - 1)
    slope = float(place @ (0.5 * np.log(energy / inertias))) / float(place @ place)
    if slope > 0.0:
        raise InputError(
            f"The peaks must fall from one to the next, but {shown(turns.tolist())} was given. Give those of a free "
            "rocking test in their order.",
            field="peaks",
        )
    return float(np.exp(slope))
