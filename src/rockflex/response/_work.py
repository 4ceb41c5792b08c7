"""Work between the states of a history, by integrals of squares and products of the motion."""

from collections.abc import Callable
from functools import cached_property
from typing import NamedTuple

import numpy as np

from rockflex._arrays import Array
from rockflex._errors import InputError
from rockflex.models import (
    LOADED,
    SIDE,
    Key,
    LinearMotion,
    MotionBetween,
    Part,
    RockingModel,
    SpringModel,
    arms,
    horizontal_reaction,
    under_more_gravity,
)

POINTS, WEIGHTS = (0.5 * (each + shift) for each, shift in zip(np.polynomial.legendre.leggauss(10), (1.0, 0.0), strict=True))
FEW = 8  # intervals of a phase with less than so many are not worth its tables
MOST_PIECES = 10_000  # per interval with vertical motion: a minute of power series for a record of a thousand samples
AT_ONCE = 2**13  # intervals, whose power series take some dozens of megabytes


class Work(NamedTuple):
    """Energies in J between adjacent states, shape (n_states - 1,) unless another is given; zero in integrated phases."""

    damped: Array  # by modal damping
    ground: Array  # work of the ground
    friction: Array  # lost by sliding
    swing: Array  # ∫ (δ'/r)² dt in rad²/s, with the rate of an element's elongation per unit distance from the pivot
    soil: Array  # (n_states - 1, n_springs): lost by the dashpot of each spring under the base
    sweeps: Array  # (n_states - 1, E): ∫ δ'² dt of each element in m²/s; only on springs
