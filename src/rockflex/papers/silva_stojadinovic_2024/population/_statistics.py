"""Agreement of one mode with all modes (Section 3.3), and the contribution of the second mode (Section 3.4)."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple, SupportsIndex

import numpy as np
from numpy.typing import NDArray

from rockflex.foundation.arrays import Array, Bools
from rockflex.foundation.checks import checked_in_range, checked_whole_number
from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError
from rockflex.foundation.values import Value
from rockflex.response._respond import STATUSES

if TYPE_CHECKING:
    import pandas as pd


AGREEING_QUANTITIES = {"no_uplift": ("top_displacement",), "rocking": ("top_displacement", "rotation")}
MIN_PAIRS = 3  # pairs for a comparison
N_SUMS = 6  # per comparison, from which slope and R² follow
OUTLIER_COLUMNS = (
    *("pair", "behaviour", "n_stories", "period", "aspect_ratio", "base_mass_ratio", "motion", "pga", "pgv"),
    *("status_mdof", "status_2dof", "max_rotation_mdof", "max_rotation_2dof"),
    *("max_top_displacement_mdof", "max_top_displacement_2dof"),
)


@dataclass(frozen=True, eq=False)
class PopulationStatistics(Value):
    """Agreement of MDOF-S with 2DOF-S, and with 2DOF-S combined with the second mode on a fixed base.

    The tables `agreement` and `combination` have one row per comparison of y, from MDOF-S, with an estimate x of it:
    `group`, `quantity`, `behaviour` ("all", "shear" or "flexure"), `estimate`, the number `n` of pairs, and

    - `r2` = 1 - Σ(y - x)²/Σ(y - ȳ)², the coefficient of determination of the line y = x, with `r2_low`, `r2_high`;
    - `slope`, c1 of y = c1 x by least squares, with `slope_low`, `slope_high`;
    - `r2_line`, the coefficient of determination of that line.

    The intervals are bootstrap percentiles over resampled pairs. With fewer than three pairs all values are NaN.

    Attributes
    ----------
    outcomes : pandas.DataFrame
        Number of pairs by the status of MDOF-S (rows) and 2DOF-S (columns).
    n_failed : int
        Number of pairs with a run that could not be solved. They are not in the tables.
    n_nominal_mdof, n_nominal_2dof : int
        Number of pairs whose rotation exceeded 0.7 atan(B/h*_1).
    agreement : pandas.DataFrame
        Section 3.3, Fig. 9: the top displacement of pairs without uplift, and top displacement and rotation of pairs
        in which MDOF-S rocks and neither model overturns.
    combination : pandas.DataFrame
        Section 3.4, Fig. 13, of the same rocking pairs: D_2 against S_d(ω_2); top displacement (m), base shear over
        m_s g and base moment over L_0^r g against 2DOF-S ("2DOF-S") and its combination with the second mode ("SRSS").
    outliers : pandas.DataFrame
        Pairs with the largest difference in rotation, and their properties. `share` is their part of Σ(y - x)² over
        the rocking pairs; it is missing for other pairs.

    Examples
    --------
    >>> import rockflex as rf
    >>> pairs = rf.run_population(rf.load_suite("el-centro-1940"), pairs=12,
    ...     seed=1)
    >>> rf.population_statistics(pairs, n_resamples=50).n_failed
    0
    """

    outcomes: "pd.DataFrame"
    n_failed: int
    n_nominal_mdof: int
    n_nominal_2dof: int
    agreement: "pd.DataFrame"
    combination: "pd.DataFrame"
    outliers: "pd.DataFrame"


class OutcomeGroups(NamedTuple):
    """Pairs that were solved, those of them without uplift, and those that rock while no model overturns."""

    solved: "pd.DataFrame"
    resting: "pd.DataFrame"
    rocking: "pd.DataFrame"


def outcome_groups(pairs: "pd.DataFrame") -> OutcomeGroups:
    """Divide pairs by their outcome, according to MDOF-S."""
    return OutcomeGroups(*(pairs[members] for members in outcome_rows(pairs)))


def outcome_rows(pairs: "pd.DataFrame") -> tuple[Bools, Bools, Bools]:
    """Return which rows belong to each of the `OutcomeGroups`."""
    solved = (pairs["status_mdof"].notna() & pairs["status_2dof"].notna()).to_numpy(dtype=bool)
    resting, rocking = (solved & has_status(pairs, "mdof", status) for status in ("no_uplift", "rocking"))
    return solved, resting, rocking & ~has_status(pairs, "2dof", "overturned")


def has_status(pairs: "pd.DataFrame", model: str, status: str) -> Bools:
    """Return where ``"mdof"`` or ``"2dof"`` ended so; not where it could not be solved, in which case it has none."""
    return pairs[f"status_{model}"].isin([status]).to_numpy(dtype=bool)


def slope_and_r2(x: Array, y: Array) -> tuple[float, float]:
    """Return c1 of y = c1 x by least squares, and R² of the line y = x; NaN for too few pairs."""
    if x.size < MIN_PAIRS:
        return np.nan, np.nan
    slope, r2 = _slopes_and_r2(_regression_terms(x, y, np.ones(x.size, dtype=bool)).sum(axis=0)[None])[0].tolist()
    return slope, r2


class PairTerms(NamedTuple):
    """The terms of every comparison of `population_statistics`, one row per pair, which add up to slope and R².

    So the comparisons of many samples of the same pairs need sums only. `names` has group, quantity, behaviour and
    estimate of each comparison.
    """

    names: list[tuple[str, str, str, str]]
    terms: Array

    @classmethod
    def of(cls, pairs: "pd.DataFrame") -> "PairTerms":
        """Compute the terms, which are zero where a pair does not belong to a comparison."""
        _, resting, rocking = outcome_rows(pairs)
        compared = [
            *_agreement_comparisons("no_uplift", pairs, resting),
            *_agreement_comparisons("rocking", pairs, rocking),
            *_combination_comparisons(pairs, rocking),
        ]
        names = [(each.group, each.quantity, each.behaviour, each.estimate) for each in compared]
        return cls(names, np.column_stack([_regression_terms(each.x, each.y, each.kept) for each in compared]))

    def slopes_and_r2(self, chosen: NDArray[np.intp]) -> Array:
        """Return c1 and R² of each comparison over the chosen rows, one row per comparison; NaN for too few pairs."""
        sums = self.terms[chosen].sum(axis=0).reshape(-1, N_SUMS)
        return np.where(sums[:, -1:] < MIN_PAIRS, np.nan, _slopes_and_r2(sums))


@dataclass(frozen=True, eq=False)
class _PopulationComparison:
    """An estimate x of y in every pair, and which pairs are compared: some or all of those of the group."""

    group: str
    quantity: str
    behaviour: str
    estimate: str
    x: Array
    y: Array
    kept: Bools


def population_statistics(
    pairs: "pd.DataFrame",
    confidence: float = 0.9,
    n_resamples: SupportsIndex = 1000,
    seed: SupportsIndex = 0,
    n_outliers: SupportsIndex = 10,
) -> PopulationStatistics:
    """Compare the two models of a population of random structures (Silva & Stojadinović 2024, Sections 3.3 and 3.4).

    Parameters
    ----------
    pairs
        The table of `run_population` or of a `PopulationStudy`.
    confidence
        Confidence of the bootstrap intervals, between 0 and 1.
    n_resamples, seed
        Number of bootstrap samples, and seed of the bootstrap.
    n_outliers
        Number of rows in the table of outliers.

    Returns
    -------
    PopulationStatistics
        Counts, coefficients of determination, slopes and outliers.

    Raises
    ------
    InputError
        If an argument is out of range, or no pair could be solved.

    Examples
    --------
    >>> import rockflex as rf
    >>> pairs = rf.run_population(rf.load_suite("el-centro-1940"), pairs=12,
    ...     seed=1)
    >>> found = rf.population_statistics(pairs, n_resamples=50)
    >>> int(found.outcomes.loc["rocking", "rocking"])
    10
    """
    checked_in_range("confidence", confidence, 1e-9, 1.0)
    resamples, start = checked_whole_number("n_resamples", n_resamples, 1), checked_whole_number("seed", seed, 0)
    shown = checked_whole_number("n_outliers", n_outliers, 0)
    solved, resting, rocking = outcome_rows(pairs)
    if not solved.any():
        raise InputError(
            "pairs holds no pair that was solved. Give the table of run_population, or see its column error."
        )
    import pandas as pd

    bootstrap = confidence, resamples, start
    agreeing = [
        row
        for group, members in (("no_uplift", resting), ("rocking", rocking))
        for row in _comparison_rows(_agreement_comparisons(group, pairs, members), members, *bootstrap)
    ]
    combining = _comparison_rows(_combination_comparisons(pairs, rocking), rocking, *bootstrap)
    counts = pd.crosstab(
        pd.Categorical(pairs["status_mdof"][solved], STATUSES),
        pd.Categorical(pairs["status_2dof"][solved], STATUSES),
        rownames=["MDOF-S"],
        colnames=["2DOF-S"],
        dropna=False,
    )
    return PopulationStatistics(
        outcomes=counts,
        n_failed=int((~solved).sum()),
        n_nominal_mdof=int(pairs["nominal_overturning_mdof"][solved].sum()),
        n_nominal_2dof=int(pairs["nominal_overturning_2dof"][solved].sum()),
        agreement=pd.DataFrame(agreeing),
        combination=pd.DataFrame(combining).drop(columns=["group", "behaviour"]),
        outliers=_outlying_pairs(pairs[solved], rocking[solved], shown),
    )


def _agreement_comparisons(group: str, pairs: "pd.DataFrame", members: Bools) -> list[_PopulationComparison]:
    """Compare the models in a group; `members` are its rows among the pairs."""
    shear = (pairs["behaviour"] == "shear").to_numpy(dtype=bool)
    among = {"all": members, "shear": members & shear, "flexure": members & ~shear}
    found: list[_PopulationComparison] = []
    for quantity in AGREEING_QUANTITIES[group]:
        x, y = (pairs[f"max_{quantity}_{model}"].to_numpy(dtype=float) for model in ("2dof", "mdof"))
        found += [_PopulationComparison(group, quantity, name, "2DOF-S", x, y, kept) for name, kept in among.items()]
    return found


def _combination_comparisons(pairs: "pd.DataFrame", members: Bools) -> list[_PopulationComparison]:
    found: list[_PopulationComparison] = []

    def compare(quantity: str, estimate: str, x: str, y: str, unit: Array) -> None:
        of_x, of_y = (pairs[name].to_numpy(dtype=float) / unit for name in (x, y))
        found.append(_PopulationComparison("rocking", quantity, "all", estimate, of_x, of_y, members))

    one = np.ones(len(pairs))
    weight, moment = pairs["structure_mass"].to_numpy(dtype=float) * GRAVITY, pairs["l0r_g"].to_numpy(dtype=float)
    compare("second_displacement", "S_d(ω_2)", "sd_2", "max_second_displacement_mdof", one)
    for quantity, unit in (("top_displacement", one), ("base_shear", weight), ("base_moment", moment)):
        compare(quantity, "2DOF-S", f"max_{quantity}_2dof", f"max_{quantity}_mdof", unit)
        compare(quantity, "SRSS", f"srss_{quantity}", f"max_{quantity}_mdof", unit)
    return found


def _comparison_rows(
    comparisons: list[_PopulationComparison], members: Bools, confidence: float, resamples: int, seed: int
) -> list[dict[str, object]]:
    """Return the rows of comparisons of one group, whose members are resampled together."""
    terms = np.column_stack([_regression_terms(each.x, each.y, each.kept) for each in comparisons])[members]
    n = terms.shape[0]
    rng = np.random.Generator(np.random.Philox(seed))
    drawn = np.full((resamples, len(comparisons), 2), np.nan)
    for resample in drawn if n else ():
        weights = np.bincount(rng.integers(n, size=n), minlength=n).astype(float)
        resample[:] = _slopes_and_r2((weights @ terms).reshape(-1, N_SUMS))
    tail = 0.5 * (1.0 - confidence)
    best = _slopes_and_r2(terms.sum(axis=0).reshape(-1, N_SUMS))
    rows: list[dict[str, object]] = []
    for place, each in enumerate(comparisons):
        x, y = each.x[each.kept], each.y[each.kept]
        known = drawn[np.isfinite(drawn[:, place]).all(axis=1), place]
        (slope, r2), low, high = np.full((3, 2), np.nan)
        if x.size >= MIN_PAIRS and len(known):
            (slope, r2), (low, high) = best[place], np.quantile(known, (tail, 1.0 - tail), axis=0)
        spread = float(np.sum((y - y.mean()) ** 2)) if y.size else 0.0
        rows.append(
            {
                "group": each.group,
                "quantity": each.quantity,
                "behaviour": each.behaviour,
                "estimate": each.estimate,
                "n": x.size,
                "r2": r2,
                "r2_low": low[1],
                "r2_high": high[1],
                "slope": slope,
                "slope_low": low[0],
                "slope_high": high[0],
                "r2_line": 1.0 - float(np.sum((y - slope * x) ** 2)) / spread if spread > 0.0 else np.nan,
            }
        )
    return rows


def _regression_terms(x: Array, y: Array, kept: Bools) -> Array:
    """Return the terms of the sums, one row per pair: x², xy, (y - x)², and y, y² about the mean of y, and 1.

    They are zero where a pair is not kept; the values of one that was not solved are NaN.
    """
    away = y - (float(y[kept].mean()) if kept.any() else 0.0)
    terms = np.column_stack((x * x, x * y, (y - x) ** 2, away, away**2, np.ones_like(x)))
    return np.where(kept[:, None], terms, 0.0)


def _slopes_and_r2(sums: Array) -> Array:
    """Return the slope of y = c1 x and R² of y = x, one row per comparison."""
    xx, xy, misses, away, square, count = sums.T
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.column_stack((xy / xx, 1.0 - misses / (square - away**2 / count)))


def _outlying_pairs(solved: "pd.DataFrame", rocking: Bools, count: int) -> "pd.DataFrame":
    misses = (solved["max_rotation_mdof"] - solved["max_rotation_2dof"]).abs()
    total = float((misses[rocking] ** 2).sum())
    share = (misses**2 / total).where(rocking) if total > 0.0 else misses * np.nan
    table = solved[list(OUTLIER_COLUMNS)].assign(difference=misses, share=share)
    return table.sort_values("difference", ascending=False, kind="stable", ignore_index=True)[:count]
