"""The statements of Sections 3.3 and 3.4 about a thousand random pairs, as named numbers."""

import math
from typing import TYPE_CHECKING

import rockflex as rf

if TYPE_CHECKING:
    import pandas as pd

QUANTITIES = ("top_displacement", "base_shear", "base_moment")
FEW = 5  # pairs that count as "the largest"


def measure(pairs: "pd.DataFrame") -> dict[str, float]:
    """Return outcomes, agreement and discrepancies of some pairs; NaN where there are too few."""
    found = rf.population_statistics(pairs, n_resamples=1, n_outliers=2 * FEW)
    return _outcomes(pairs) | _agreement(found) | _combination(found) | _resting(pairs) | _outliers(pairs, found)


def _outcomes(pairs: "pd.DataFrame") -> dict[str, float]:
    every, one = pairs["status_mdof"], pairs["status_2dof"]
    conditions = {
        "no uplift": every == "no_uplift",
        "rocking": every == "rocking",
        "overturned": every == "overturned",
        "beyond the limit, MDOF-S": pairs["nominal_overturning_mdof"].astype(bool),
        "beyond the limit, 2DOF-S": pairs["nominal_overturning_2dof"].astype(bool),
        "2DOF-S alone uplifts": (every == "no_uplift") & (one != "no_uplift"),
    }
    return {name: float(condition.sum()) for name, condition in conditions.items()}


def _agreement(found: rf.PopulationStatistics) -> dict[str, float]:
    """R² and slopes of Section 3.3, such as ``"r2, rocking, rotation, all"``."""
    rows = found.agreement.to_dict("records")
    return {
        f"{value}, {row['group']}, {row['quantity']}, {row['behaviour']}": float(row[value])
        for row in rows
        for value in ("r2", "slope")
    }


def _combination(found: rf.PopulationStatistics) -> dict[str, float]:
    """R² and slopes of Section 3.4, such as ``"r2, base_shear, SRSS"``, and what SRSS adds to R²."""
    rows = found.combination.to_dict("records")
    values = {
        f"{value}, {row['quantity']}, {row['estimate']}": float(row[value]) for row in rows for value in ("r2", "slope")
    }
    gains = {f"gain, {name}": values[f"r2, {name}, SRSS"] - values[f"r2, {name}, 2DOF-S"] for name in QUANTITIES}
    return values | gains


def _resting(pairs: "pd.DataFrame") -> dict[str, float]:
    """Return extremes of the pairs in which MDOF-S does not uplift; NaN where there are none."""
    resting = pairs[pairs["status_mdof"] == "no_uplift"]
    if resting.empty:
        names = ("largest rotation of 2DOF-S", "stories, least of the worst", "aspect ratio of the largest")
        return dict.fromkeys(names, math.nan)
    miss = (resting["max_top_displacement_mdof"] - resting["max_top_displacement_2dof"]).abs()
    worst = resting.loc[miss.nlargest(FEW).index]
    tall = resting.nlargest(FEW, "max_top_displacement_mdof")
    return {
        "largest rotation of 2DOF-S": float(resting["max_rotation_2dof"].max()),
        "stories, least of the worst": float(worst["n_stories"].min()),
        "aspect ratio of the largest": float(tall["aspect_ratio"].median()),
    }


def _outliers(pairs: "pd.DataFrame", found: rf.PopulationStatistics) -> dict[str, float]:
    """Return properties of the rocking pairs with the largest differences in rotation."""
    few = found.outliers[found.outliers["share"].notna()].head(FEW)  # none, if all overturned
    return {
        "aspect ratio of outliers": float(few["aspect_ratio"].astype(float).median()),
        "stories of outliers": float(few["n_stories"].astype(float).median()),
        "period of outliers": float(few["period"].astype(float).median() / pairs["period"].median()),
    }
