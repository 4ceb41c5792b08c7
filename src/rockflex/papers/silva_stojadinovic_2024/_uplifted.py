"""Uplifted frequencies of the 15-story buildings, which Figures 10 and 12 share."""

from functools import lru_cache

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024._structures import tall_frame


@lru_cache
def ratio(behaviour: str, model: str, mode: int, aspect_ratio: float) -> float:
    """Return ω*_n/ω_n of 2DOF-S, 3DOF-S or MDOF-S."""
    kept = {"2DOF-S": 1, "3DOF-S": 2, "MDOF-S": None}[model]
    modes = rf.uplifted_modes(tall_frame(behaviour, aspect_ratio).rocking(), kept)
    return float(modes.ratio[mode - 1])


def errors(behaviour: str, model: str, mode: int, aspect_ratio: float) -> float:
    """Return the error of this ratio relative to MDOF-S, in per cent."""
    mine, every = (ratio(behaviour, each, mode, aspect_ratio) for each in (model, "MDOF-S"))
    return 100.0 * (mine / every - 1.0)
