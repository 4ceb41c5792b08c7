"""The measures of Figures 9 and 13 for a thousand random pairs, computed for many samples of the same pairs."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rockflex.foundation.arrays import Array, Bools
from rockflex.papers.silva_stojadinovic_2024.population._statistics import PairTerms, has_status, outcome_rows

if TYPE_CHECKING:
    import pandas as pd

N_LARGEST = 5  # pairs that count as "the largest"
COMBINED_QUANTITIES = ("top_displacement", "base_shear", "base_moment")
DRAWN = ("n_stories", "aspect_ratio", "period")

Rows = NDArray[np.intp]


class PairMeasures:
    """Outcomes, agreement and discrepancies of samples of some pairs; NaN where a sample has too few.

    Everything that a pair contributes is taken from the table once, because there are hundreds of samples.
    """

    def __init__(self, pairs: "pd.DataFrame") -> None:
        self._solved, self._resting, self._rocking = outcome_rows(pairs)
        self._conditions: dict[str, Bools] = {
            "no uplift": has_status(pairs, "mdof", "no_uplift"),
            "rocking": has_status(pairs, "mdof", "rocking"),
            "overturned": has_status(pairs, "mdof", "overturned"),
            "beyond the limit, MDOF-S": pairs["nominal_overturning_mdof"].to_numpy(dtype=bool),
            "beyond the limit, 2DOF-S": pairs["nominal_overturning_2dof"].to_numpy(dtype=bool),
            "2DOF-S alone uplifts": self._resting & ~has_status(pairs, "2dof", "no_uplift"),
        }
        self._drawn: dict[str, Array] = {name: pairs[name].to_numpy(dtype=float) for name in DRAWN}
        tops, rotations = (
            [pairs[f"max_{quantity}_{model}"].to_numpy(dtype=float) for model in ("mdof", "2dof")]
            for quantity in ("top_displacement", "rotation")
        )
        self._top, self._rotation = tops[0], rotations[1]
        self._top_miss, self._rotation_miss = (np.abs(each[0] - each[1]) for each in (tops, rotations))
        self._terms = PairTerms.of(pairs)

    def of(self, rows: Rows) -> dict[str, float]:
        """Return the measures of a sample of the pairs, given by its rows in ascending order."""
        counts = {name: float(holds[rows].sum()) for name, holds in self._conditions.items()}
        return counts | self._coefficients(rows) | self._extremes_of_resting_pairs(rows) | self._outlying_pairs(rows)

    def _coefficients(self, rows: Rows) -> dict[str, float]:
        """R² and slopes, such as ``"r2, rocking, rotation, all"`` and ``"r2, base_shear, SRSS"``, and gains by SRSS."""
        found: dict[str, float] = {}
        names, values = self._terms.names, self._terms.slopes_and_r2(rows).tolist()
        for (group, quantity, behaviour, estimate), (slope, r2) in zip(names, values, strict=True):
            for name, value in (("slope", slope), ("r2", r2)):
                if estimate == "2DOF-S":
                    found[f"{name}, {group}, {quantity}, {behaviour}"] = value
                if (group, behaviour) == ("rocking", "all"):
                    found[f"{name}, {quantity}, {estimate}"] = value
        gains = {f"gain, {q}": found[f"r2, {q}, SRSS"] - found[f"r2, {q}, 2DOF-S"] for q in COMBINED_QUANTITIES}
        return found | gains

    def _extremes_of_resting_pairs(self, rows: Rows) -> dict[str, float]:
        """Return extremes of the pairs in which MDOF-S does not uplift."""
        resting = rows[self._resting[rows]]
        worst = resting[_largest_first(self._top_miss[resting])[:N_LARGEST]]
        tall = resting[_largest_first(self._top[resting])[:N_LARGEST]]
        return {
            "largest rotation of 2DOF-S": float(self._rotation[resting].max(initial=-np.inf))
            if resting.size
            else np.nan,
            "stories, least of the worst": float(self._drawn["n_stories"][worst].min()) if resting.size else np.nan,
            "aspect ratio of the largest": _median(self._drawn["aspect_ratio"][tall]),
        }

    def _outlying_pairs(self, rows: Rows) -> dict[str, float]:
        """Return properties of the rocking pairs with the largest differences in rotation among all pairs."""
        solved = rows[self._solved[rows]]
        worst = solved[_largest_first(self._rotation_miss[solved])[: 2 * N_LARGEST]]
        few = worst[self._rocking[worst]][:N_LARGEST]  # none, if all overturned
        return {
            "aspect ratio of outliers": _median(self._drawn["aspect_ratio"][few]),
            "stories of outliers": _median(self._drawn["n_stories"][few]),
            "period of outliers": _median(self._drawn["period"][few]) / _median(self._drawn["period"][rows]),
        }


def _largest_first(values: Array) -> Rows:
    return np.argsort(-values, kind="stable")


def _median(values: Array) -> float:
    return float(np.median(values)) if values.size else np.nan
