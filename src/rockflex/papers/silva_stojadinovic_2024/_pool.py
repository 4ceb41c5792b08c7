"""The random pairs of Sections 3.3 and 3.4, which Figures 8, 9 and 13 share.

The paper drew a thousand pairs once. A few outliers dominate its numbers, so one draw says little, and resampling it
cannot show the outliers that it missed. Here tens of thousands of pairs are run, and several hundred samples of a
thousand are drawn from them without replacement, as if with other seeds.
"""

from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024._draws import measure
from rockflex.papers.silva_stojadinovic_2024._number import Interval
from rockflex.papers.silva_stojadinovic_2024._records import Records

if TYPE_CHECKING:
    import pandas as pd

PAIRS = 1000
DRAWS = 400
KNOWN = 0.95  # share of the draws in which a measure must exist


@lru_cache(maxsize=1)
def pool(records: Records) -> "pd.DataFrame":
    """Run populations of a thousand random structures, each with MDOF-S and 2DOF-S under a record drawn for it."""
    import pandas as pd

    seeds = range(records.seed, records.seed + records.seeds)
    return pd.concat([rf.run_population(records.suite, PAIRS, seed) for seed in seeds], ignore_index=True)


def population(records: Records) -> "pd.DataFrame":
    """Return the first thousand pairs, which the figures show."""
    return pool(records).iloc[:PAIRS]


@lru_cache(maxsize=1)
def intervals(records: Records) -> dict[str, Interval]:
    """Return the median of each `measure` over draws of a thousand pairs, and its 5 and 95 % quantiles.

    A measure that is missing in more than one draw out of twenty, such as a slope without enough pairs, is NaN.
    """
    pairs, generator = pool(records), np.random.default_rng(records.seed)
    drawn = [
        measure(pairs.iloc[np.sort(generator.choice(len(pairs), PAIRS, replace=False))].reset_index(drop=True))
        for _ in range(DRAWS)
    ]
    found: dict[str, Interval] = {}
    for name in drawn[0]:
        values = np.array([each[name] for each in drawn])
        known = values[~np.isnan(values)]
        enough = known.size >= KNOWN * DRAWS
        # Quantiles are values that occur, so that counts remain integers.
        quantiles = np.quantile(known, (0.5, 0.05, 0.95), method="inverted_cdf") if enough else np.full(3, np.nan)
        found[name] = Interval(*quantiles.tolist())
    return found
