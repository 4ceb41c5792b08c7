"""The cheapest design that meets all requirements, and how certain that is."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, SupportsIndex

import numpy as np

from rockflex._arrays import Array, Bools
from rockflex._checks import whole_number
from rockflex._errors import InputError
from rockflex._values import Value
from rockflex.study.design._fit import check_confidence, check_damping
from rockflex.study.design.search._cost import DesignCost
from rockflex.study.design.search._requirement import Requirement, check_requirements, margins_of, values_of
from rockflex.study.design.search._space import VARIABLES

if TYPE_CHECKING:
    import pandas as pd

FACTS = (*VARIABLES, "aspect_ratio", "prestress", "dissipator_force", "resisting_moment")
QUANTITIES = ("half_width", "prestress", "dissipator_force", "cost")
FEWEST = 20  # resamples
NAMES = {"half_width": "half width", "tendon_factor": "tendon factor", "dissipator_factor": "dissipator factor"}


@dataclass(frozen=True, eq=False)
class BestDesign(Value):
    """The designs that a search tried, and the cheapest of them that meets all requirements.

    Attributes
    ----------
    designs : pandas.DataFrame
        One row per design tried, in the order of the search: `structure`, `round`, `half_width` (m), `tendon_factor`,
        `dissipator_factor`, `aspect_ratio`, `prestress` (N), `dissipator_force` (N), `resisting_moment` (N m), `cost`;
        for each requirement, by its label, the probability or annual rate, and with ", low" and ", high" its band, NaN
        without one; `governs`, the requirement that is closest to its target, or exceeds it most; `meets`, whether all
        targets are met; `confidence`, the share of resamples in which they are; `chosen`, the share of resamples in
        which it is the cheapest design that meets them; `n_runs`, `n_failed`.
    best : int or None
        Row of the cheapest design that meets all targets; None if none does.
    cautious : int or None
        Row of the cheapest design whose bands lie below all targets.
    limits : pandas.DataFrame
        One row per requirement, for the best design: `limit`, `target`, `value`, `low`, `high`; `used` = value/target;
        `cost_without`, the least cost if this requirement were dropped: below the cost of the best design if it alone
        governs.
    interval : pandas.DataFrame
        One row per quantity: `half_width`, `prestress`, `dissipator_force` and `cost` of the best design, with the
        limits `low` and `high` of its band over the resamples.
    governs : str
        Label of the requirement that governs the best design; empty if there is none.
    requirements : tuple of Requirement
    cost : DesignCost
    notes : tuple of str
        Warnings: a best design at the end of a range, designs without probabilities, resamples without a design.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> held = rf.Restrained(frame, rf.Tendon(initial_force=300e3, stiffness=2e6))
    >>> pulses = {"a": rf.ricker_pulse(3.0, 0.6), "b": rf.ricker_pulse(3.0, 0.9)}
    >>> search = rf.DesignSearch([1.0, 2.0, 3.0], tendon_factors=[0.0, 1.0, 2.0], refinements=1)
    >>> targets, cost = [rf.Requirement(0.01, 0.2, at=0.5)], rf.DesignCost(half_width=1.0, prestress=5e-7)
    >>> runs = rf.search_design(held, pulses, search, targets, cost, model="2DOF-S", scales=[0.5, 1.0, 2.0, 4.0])
    >>> found = rf.best_design(runs, targets, cost)
    >>> found.designs.loc[found.best, ["half_width", "tendon_factor", "dissipator_factor"]].map(float).tolist()
    [2.5, 1.5, 1.0]
    """

    designs: "pd.DataFrame"
    best: int | None
    cautious: int | None
    limits: "pd.DataFrame"
    interval: "pd.DataFrame"
    governs: str
    requirements: tuple[Requirement, ...]
    cost: DesignCost
    notes: tuple[str, ...]


def best_design(
    runs: "pd.DataFrame",
    requirements: Sequence[Requirement],
    cost: DesignCost,
    *,
    confidence: float = 0.9,
    n_resamples: SupportsIndex = 200,
    seed: int = 0,
) -> BestDesign:
    """Find the cheapest of the designs of a search that meets all requirements, and which of these governs.

    All designs were run under the same records. The bands are those of `design_table`; the uncertainty of the choice
    comes from choosing anew in each of many resamples of the recordings, the same for all designs.

    Parameters
    ----------
    runs
        The table of `search_design`, or of a `DesignStudy` with a search.
    requirements, cost
        As in `search_design`; others than those that led the search are possible.
    confidence
        Confidence of the bands, in [0, 1).
    n_resamples, seed
        Number of resamples, at least 20, and the seed of NumPy's default generator.

    Raises
    ------
    InputError
        If the table lacks a column, or an argument is out of range.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> held = rf.Restrained(frame, rf.Tendon(initial_force=300e3, stiffness=2e6))
    >>> pulses = {"a": rf.ricker_pulse(3.0, 0.6), "b": rf.ricker_pulse(3.0, 0.9)}
    >>> search = rf.DesignSearch([1.0, 2.0, 3.0], tendon_factors=[0.0, 1.0, 2.0], refinements=1)
    >>> targets, cost = [rf.Requirement(0.01, 0.2, at=0.5)], rf.DesignCost(half_width=1.0, prestress=5e-7)
    >>> runs = rf.search_design(held, pulses, search, targets, cost, model="2DOF-S", scales=[0.5, 1.0, 2.0, 4.0])
    >>> found = rf.best_design(runs, targets, cost)
    >>> print(f"{found.designs.loc[found.best, 'half_width']:.3g} m, {found.governs}")
    2.5 m, 0.01 rad at pgv = 0.5
    """
    import pandas as pd

    wanted, times = check_requirements(requirements), whole_number("n_resamples", n_resamples, FEWEST)
    check_confidence(confidence)
    lacking = [name for name in (*FACTS, "structure", "round", "group") if name not in runs]
    if lacking or not len(runs):
        lacks = f"lacks {', '.join(lacking)}" if lacking else "has no rows"
        raise InputError(f"The table {lacks}. Give what search_design returned.")
    for each in wanted:
        check_damping(each.hazard, runs, each.measure)
    groups = [rows for _, rows in runs.groupby("structure", observed=True, sort=False)]
    values = values_of(groups, wanted)
    drawn = np.stack(
        [_drawn(rows, wanted, times, seed) for rows in groups], axis=1
    )  # (resamples, designs, requirements)
    table = pd.DataFrame([rows.iloc[0][["structure", "round", *FACTS]] for rows in groups]).infer_objects()
    table = table.reset_index(drop=True).assign(structure=[str(rows["structure"].iloc[0]) for rows in groups])
    price = np.asarray(cost.of(*(table[name].to_numpy(float) for name in QUANTITIES[:3])), dtype=float)
    table["cost"] = price
    low, high = np.array([[each.band(rows, confidence) for each in wanted] for rows in groups]).transpose(2, 0, 1)
    for place, each in enumerate(wanted):
        ends = values[:, place], low[:, place], high[:, place]
        table[each.label], table[f"{each.label}, low"], table[f"{each.label}, high"] = ends
    meets, targets = _met(values, wanted), np.array([each.target for each in wanted])
    labels = [each.label for each in wanted]
    closest = np.nan_to_num(margins_of(values, wanted), nan=-np.inf).argmax(axis=1)
    choices = [_cheapest(price, each) for each in _met(drawn, wanted)]
    table["governs"] = [labels[place] for place in closest]
    table["meets"] = meets
    table["confidence"] = _met(drawn, wanted).mean(axis=0)
    table["chosen"] = [choices.count(place) / len(choices) for place in range(len(groups))]
    table["n_runs"] = [int(rows["status"].notna().sum()) for rows in groups]
    table["n_failed"] = [int(rows["status"].isna().sum()) for rows in groups]
    best = _cheapest(price, meets)
    return BestDesign(
        designs=table,
        best=best,
        cautious=_cheapest(price, meets & (np.fmax(values, high) <= targets).all(axis=1)),
        limits=_limits(table, best, wanted, values, price),
        interval=_interval(table, best, choices, confidence),
        governs="" if best is None else labels[closest[best]],
        requirements=tuple(wanted),
        cost=cost,
        notes=tuple(_notes(table, best, choices, values)),
    )


def _drawn(rows: "pd.DataFrame", wanted: list[Requirement], n: int, seed: int) -> Array:
    return np.column_stack([each.resampled(rows, n, seed) for each in wanted])


def _met(values: Array, wanted: list[Requirement]) -> Bools:
    """Whether all targets are met, for values whose last axis is that of the requirements; NaN meets none."""
    return np.all(values <= np.array([each.target for each in wanted]), axis=-1)


def _cheapest(price: Array, meets: Bools) -> int | None:
    return int(np.where(meets, price, np.inf).argmin()) if meets.any() else None


def _limits(
    table: "pd.DataFrame", best: int | None, wanted: list[Requirement], values: Array, price: Array
) -> "pd.DataFrame":
    import pandas as pd

    rows: list[dict[str, Any]] = []
    for place, each in enumerate(wanted):
        if best is None:
            continue
        others = [other for other in range(len(wanted)) if other != place]
        free = _met(values[:, others], [wanted[other] for other in others])
        row = table.iloc[best]
        rows.append(
            {
                "limit": each.label,
                "target": each.target,
                "value": row[each.label],
                "low": row[f"{each.label}, low"],
                "high": row[f"{each.label}, high"],
                "used": row[each.label] / each.target,
                "cost_without": float(np.where(free, price, np.inf).min()),
            }
        )
    return pd.DataFrame(rows, columns=["limit", "target", "value", "low", "high", "used", "cost_without"])


def _interval(table: "pd.DataFrame", best: int | None, choices: list[int | None], confidence: float) -> "pd.DataFrame":
    import pandas as pd

    places = [place for place in choices if place is not None]
    rows: list[dict[str, Any]] = []
    for name in QUANTITIES:
        column = table[name].to_numpy(float)
        ends = [np.nan, np.nan]
        if places:
            ends = np.quantile(column[places], (0.5 - 0.5 * confidence, 0.5 + 0.5 * confidence)).tolist()
        rows.append(
            {"quantity": name, "best": np.nan if best is None else column[best], "low": ends[0], "high": ends[1]}
        )
    return pd.DataFrame(rows)


def _notes(table: "pd.DataFrame", best: int | None, choices: list[int | None], values: Array) -> list[str]:
    notes: list[str] = []
    lost = int((~np.isfinite(values)).any(axis=1).sum())
    if lost:
        notes.append(f"{lost} of {len(table)} designs have no probability of every limit, and are left out.")
    if best is None:
        return [*notes, "No design meets all targets. Widen the ranges, or accept a higher probability."]
    for name in VARIABLES:
        column = table[name].to_numpy(float)
        ends = {"smallest": column.min(), "largest": column.max()}
        at = [word for word, end in ends.items() if column[best] == end and ends["smallest"] < ends["largest"]]
        if at and column[best] != 0.0:
            notes.append(
                f"The best design has the {at[0]} {NAMES[name]} of its range, {column[best]:.4g}: a design beyond it "
                "might be cheaper."
            )
    without = choices.count(None)
    if without:
        notes.append(f"In {without} of {len(choices)} resamples no design meets all targets.")
    return notes
