"""The thousand random pairs of Section 3.3, which Figures 8, 9 and 13 share.

Intervals are over resampled recordings, with all pairs that drew them: pairs that share one are not independent.
"""

from collections.abc import Callable
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024._records import Records

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["PAIRS", "SEED", "Interval", "counts", "intervals", "population", "statistics"]

Array = NDArray[np.float64]
Interval = tuple[float, float, float]
"""Estimate, and lower and upper end of its 90 % interval."""

PAIRS, SEED = 1000, 2024
RESAMPLES = 300


@lru_cache(maxsize=1)
def population(records: Records) -> "pd.DataFrame":
    """Run a thousand random structures, each with MDOF-S and 2DOF-S under a record drawn for it."""
    return rf.run_population(records.suite, PAIRS, SEED)


@lru_cache(maxsize=1)
def statistics(records: Records) -> rf.PopulationStatistics:
    """Agreement of the two models."""
    return rf.population_statistics(population(records), n_resamples=1)


@lru_cache(maxsize=1)
def intervals(records: Records) -> dict[tuple[str, ...], Interval]:
    """R² and slopes of Sections 3.3 and 3.4.

    The keys are ("r2" or "slope", group, quantity, behaviour) of Section 3.3, and ("r2" or "slope", quantity, estimate)
    of Section 3.4. What rests on fewer than three pairs is NaN.
    """
    pairs = population(records)
    estimate = _values(statistics(records))
    known = [key for key, value in estimate.items() if np.isfinite(value)]

    def fit(_: Array, rows: Array) -> Array:
        drawn = pairs.iloc[rows.astype(int)].reset_index(drop=True)
        found = _values(rf.population_statistics(drawn, n_resamples=1, n_outliers=0))
        return np.array([found[key] for key in known])

    bands = _band(records, fit, np.arange(len(pairs), dtype=float), len(known))
    return dict.fromkeys(estimate, (np.nan, np.nan, np.nan)) | dict(zip(known, bands, strict=True))


def counts(records: Records, conditions: "dict[str, pd.Series[bool]]") -> dict[str, Interval]:
    """Count the pairs of which each condition holds."""
    flags: Array = np.array([condition.to_numpy(dtype=float) for condition in conditions.values()], dtype=float).T

    def fit(_: Array, rows: Array) -> Array:
        return PAIRS * rows.sum(axis=0) / len(rows)

    bands = _band(records, fit, flags, len(conditions))
    return dict(zip(conditions, bands, strict=True))


def _band(records: Records, fit: Callable[[Array, Array], Array], rows: Array, n: int) -> list[Interval]:
    pairs = population(records)
    band = rf.bootstrap_band(
        fit, pairs["pgv"].to_numpy(dtype=float), rows, pairs["group"].astype(str).to_numpy(), at=np.arange(n),
        n=RESAMPLES, curve=lambda found, at: found[at.astype(int)],
    )  # fmt: skip
    three = zip(band.estimate, band.low, band.high, strict=True)
    return [(float(estimate), float(low), float(high)) for estimate, low, high in three]


def _values(found: rf.PopulationStatistics) -> dict[tuple[str, ...], float]:
    values: dict[tuple[str, ...], float] = {}
    for table, names in (
        (found.agreement, ["group", "quantity", "behaviour"]),
        (found.combination, ["quantity", "estimate"]),
    ):
        for row in table.to_dict("records"):
            for value in ("r2", "slope"):
                values[value, *(str(row[name]) for name in names)] = float(row[value])
    return values
