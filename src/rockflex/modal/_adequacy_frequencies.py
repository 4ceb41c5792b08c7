"""Errors of the uplifted frequencies with few modes."""

import math
from dataclasses import replace

import numpy as np

from rockflex._arrays import Array
from rockflex.modal._rocking import RockingProperties
from rockflex.modal._uplifted import lowest_uplifted


def frequency_errors(p: RockingProperties, missing: float) -> tuple[Array, Array]:
    """Return `Adequacy.frequency_error` (N, 2) and `reference_error` (2,), the larger values of the two pivots.

    Parameters
    ----------
    p : RockingProperties
        Properties with N modes, at least one.
    missing : float
        Inertia in kg m² that no available mode represents; zero if no mode is missing.
    """
    errors = [_about(p, missing, pivot.side) for pivot in p.pivots]
    largest, reference = (np.maximum.reduce(each) for each in zip(*errors, strict=True))
    return largest, reference


def _about(p: RockingProperties, missing: float, side: int) -> tuple[Array, Array]:
    found = np.full((p.n_modes, 2), np.nan)
    for k in range(1, p.n_modes + 1):
        found[k - 1, :k] = lowest_uplifted(p.truncated(k), 2, side)
    reference = np.zeros(2)
    if missing:
        reference = np.maximum(found[-1] / _lowest(p, missing, side) - 1.0, 0.0)
    return np.maximum(found / found[-1] - 1.0, 0.0), reference


def _lowest(p: RockingProperties, inertia: float, side: int) -> Array:
    """Return the first two uplifted frequencies if the missing `inertia` in kg m² moves with the last mode."""
    # Two modes with the same frequency: one has the inertia of both, and the rotation does not excite the other.
    if p.n_modes == 1:  # the latter is the lowest
        return np.append(p.omega, np.nan)
    height = p.effective_height.copy()
    height[-1] = math.sqrt(height[-1] ** 2 + inertia / p.effective_mass[-1])
    both = lowest_uplifted(replace(p, effective_height=height), 2, side)
    return np.sort(np.append(both, p.omega[-1]))[:2]
