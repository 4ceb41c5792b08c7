"""Rocking spectra: the largest rotation of rigid blocks under one motion."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal, SupportsIndex

import numpy as np

from rockflex._constants import GRAVITY
from rockflex._errors import InputError
from rockflex.models import ImpactLaw, Model, parse_model
from rockflex.motion import GroundMotion
from rockflex.progress import ProgressChoice
from rockflex.structure import rigid_block
from rockflex.study._arguments import WORK_LIMIT, GroundChoice, check_options, ground_under, positive_numbers
from rockflex.study._simulate_many import simulate_many

if TYPE_CHECKING:
    import pandas as pd


def rocking_spectrum(
    motion: GroundMotion,
    slendernesses: Sequence[float],
    periods: Sequence[float],
    model: str | Model = "rigid",
    impact: ImpactLaw | None = None,
    free_vibration: float | Literal["settle"] = "settle",
    workers: SupportsIndex | None = None,
    work_limit: float | None = WORK_LIMIT,
    ground: GroundChoice = None,
    progress: ProgressChoice = None,
) -> "pd.DataFrame":
    """Largest rotation of homogeneous rigid blocks under one motion, for several slendernesses and sizes.

    This is the rocking spectrum of Makris & Konstantinidis (2003, Earthquake Engng Struct Dyn 32(12), 1879-1901):
    θ_max/α against 2π/p, a curve for each slenderness α = atan(b/h), with p² = 3 g/(4 R). "rigid" is linearised in the
    rotation, so a block is balanced at tan α and not at α; "rigid-C" is not linearised.

    Parameters
    ----------
    motion
        The ground motion.
    slendernesses
        α in rad, each above 0 and below π/2.
    periods
        2π/p in s, positive.
    model
        "rigid" or "rigid-C".
    impact
        None for Housner's coefficient of each block, 1 - 1.5 sin² α; or `Restitution(e)` for all blocks.
    free_vibration
        As in `simulate`. Blocks may overturn after the record.
    workers
        Number of threads; None for one a core.
    work_limit
        Work limit of each run, as in `simulate_many`.
    ground, progress
        As in `simulate_many`.

    Returns
    -------
    pandas.DataFrame
        One row a block, slendernesses outermost: `slenderness` (rad), `period` (s), `half_diagonal` (m), `status`,
        `max_rotation` (rad; π/2 if overturned), `relative_rotation` (θ_max/α), `overturned` and `n_impacts`. A run that
        cannot be solved has a message in `error` and no results.

    Raises
    ------
    InputError
        If a value is out of range, the model has modes, or a block is too squat for Housner's coefficient.

    Examples
    --------
    >>> import rockflex as rf
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=0.8)
    >>> rf.rocking_spectrum(pulse, [0.2], [2.0, 4.0])[["period", "status", "relative_rotation"]].round(3)
       period      status  relative_rotation
    0     2.0  overturned              7.854
    1     4.0     rocking              0.272
    """
    alphas, times = positive_numbers("slendernesses", slendernesses, "rad"), positive_numbers("periods", periods, "s")
    chosen = parse_model(model)
    if chosen.n_modes != 0:
        raise InputError(f'Blocks have no modes, but the model {chosen.label} was given. Use "rigid" or "rigid-C".')
    check_options(None, impact, ground)
    radii = [0.75 * GRAVITY * (time / (2.0 * math.pi)) ** 2 for time in times]
    blocks = [rigid_block(alpha, radius) for alpha in alphas for radius in radii]
    squattest = blocks[int(np.argmax(alphas)) * len(radii)]
    chosen.of(squattest, impact, ground=ground_under(squattest, ground))  # before any work
    table = simulate_many(
        blocks,
        motion,
        chosen,
        free_vibration=free_vibration,
        impact=impact,
        workers=workers,
        work_limit=work_limit,
        ground=ground,
        progress=progress,
    ).reset_index(drop=True)
    slenderness, period = np.repeat(alphas, len(times)), np.tile(times, len(alphas))
    import pandas as pd

    return pd.DataFrame(
        {
            "slenderness": slenderness,
            "period": period,
            "half_diagonal": np.tile(radii, len(alphas)),
            "status": table["status"],
            "max_rotation": table["max_rotation"],
            "relative_rotation": table["max_rotation"] / slenderness,
            "overturned": (table["status"] == "overturned").astype("boolean").mask(table["status"].isna()),
            "n_impacts": table["n_impacts"],
            "error": table["error"],
        }
    )
