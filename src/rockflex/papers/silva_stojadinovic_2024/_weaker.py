"""The random pairs of Sections 3.3 and 3.4 under weaker records."""

from collections.abc import Mapping
from functools import lru_cache
from typing import TYPE_CHECKING

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024._draws import measure
from rockflex.papers.silva_stojadinovic_2024._pool import PAIRS, intervals
from rockflex.papers.silva_stojadinovic_2024._records import Records
from rockflex.papers.silva_stojadinovic_2024._verdict import Kind
from rockflex.report import Remark

if TYPE_CHECKING:
    import pandas as pd

FACTOR = 0.6  # on the acceleration of the records


def under_weaker(records: Records, rows: Mapping[str, tuple[str, str]]) -> Remark:
    """Compare some measures, with their printed values, for unscaled and for weaker records."""
    as_they_are, weaker = intervals(records), measure(_pairs(records))
    return Remark(
        Kind.AFTERWARDS,
        f"All records times {FACTOR}",
        "The factor is chosen so that about as many pairs uplift as in the paper, whose records are not available. "
        f"The sample is one thousand pairs (seed {records.seed}); a count of 300 of them has a standard deviation of "
        "14.",
        ("quantity", "paper", "records as they are, median", f"times {FACTOR}"),
        [
            (name, printed, f"{as_they_are[key].estimate:.4g}", f"{weaker[key]:.4g}")
            for key, (name, printed) in rows.items()
        ],
    )


@lru_cache(maxsize=1)
def _pairs(records: Records) -> "pd.DataFrame":
    """Return the measures of the first thousand structures of the population under weaker records."""
    suite = rf.Suite([motion.scaled(FACTOR) for motion in records.suite])
    return rf.run_population(suite, PAIRS, records.seed)
