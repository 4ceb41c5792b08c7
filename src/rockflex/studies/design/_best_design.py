"""The cheapest design that meets all requirements, its certainty, and the trade-off between its variables."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, SupportsIndex

import numpy as np

from rockflex.foundation.arrays import Array, Bools
from rockflex.foundation.checks import checked_whole_number
from rockflex.foundation.errors import InputError
from rockflex.foundation.values import Value
from rockflex.studies.design._design_search import MarginSurface
from rockflex.studies.design._designs import VARIABLES
from rockflex.studies.design._exceedance_fit import check_confidence, check_exceedance_table, check_hazard_damping
from rockflex.studies.design._requirements import (
    DesignCost,
    Requirement,
    checked_requirements,
    requirement_margins,
    requirement_values,
)

if TYPE_CHECKING:
    import pandas as pd


FACTS = (*VARIABLES, "aspect_ratio", "prestress", "dissipator_force", "resisting_moment")
QUANTITIES = ("half_width", "prestress", "dissipator_force", "cost")
MIN_RESAMPLES = 20  # resamples
LABELS = {
    "half_width": "half width",
    "tendon_factor": "tendon factor",
    "dissipator_factor": "dissipator factor",
}


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
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3,
    ...     base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> held = rf.Restrained(frame, rf.Tendon(initial_force=300e3, stiffness=2e6))
    >>> pulses = {"a": rf.ricker_pulse(3.0, 0.6), "b": rf.ricker_pulse(3.0, 0.9)}
    >>> search = rf.DesignSearch([1.0, 2.0, 3.0], tendon_factors=[0.0, 1.0, 2.0],
    ...     refinements=1)
    >>> targets, cost = [rf.Requirement(0.01, 0.2, at=0.5)], rf.DesignCost(
    ...     half_width=1.0, prestress=5e-7)
    >>> runs = rf.search_design(held, pulses, search, targets, cost,
    ...     model="2DOF-S", scales=[0.5, 1.0, 2.0, 4.0])
    >>> found = rf.best_design(runs, targets, cost)
    >>> found.designs.loc[found.best, ["half_width", "tendon_factor",
    ...     "dissipator_factor"]].map(float).tolist()
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
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3,
    ...     base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> held = rf.Restrained(frame, rf.Tendon(initial_force=300e3, stiffness=2e6))
    >>> pulses = {"a": rf.ricker_pulse(3.0, 0.6), "b": rf.ricker_pulse(3.0, 0.9)}
    >>> search = rf.DesignSearch([1.0, 2.0, 3.0], tendon_factors=[0.0, 1.0, 2.0],
    ...     refinements=1)
    >>> targets, cost = [rf.Requirement(0.01, 0.2, at=0.5)], rf.DesignCost(
    ...     half_width=1.0, prestress=5e-7)
    >>> runs = rf.search_design(held, pulses, search, targets, cost,
    ...     model="2DOF-S", scales=[0.5, 1.0, 2.0, 4.0])
    >>> found = rf.best_design(runs, targets, cost)
    >>> width = found.designs.loc[found.best, "half_width"]
    >>> print(f"{width:.3g} m, {found.governs}")
    2.5 m, 0.01 rad at pgv = 0.5
    """
    import pandas as pd

    wanted, times = checked_requirements(requirements), checked_whole_number("n_resamples", n_resamples, MIN_RESAMPLES)
    check_confidence(confidence)
    check_exceedance_table(runs, (*FACTS, "structure", "round", "group"), "search_design")
    for each in wanted:
        check_hazard_damping(each.hazard, runs, each.measure)
    groups = [rows for _, rows in runs.groupby("structure", observed=True, sort=False)]
    values = requirement_values(groups, wanted)
    drawn = np.array([[each.resampled(rows, times, seed) for each in wanted] for rows in groups])
    drawn = drawn.transpose(2, 0, 1)  # (resamples, designs, requirements)
    table = pd.DataFrame([rows.iloc[0][["structure", "round", *FACTS]] for rows in groups]).infer_objects()
    table = table.reset_index(drop=True).assign(structure=[str(rows["structure"].iloc[0]) for rows in groups])
    costs = np.asarray(cost.of(*(table[name].to_numpy(float) for name in QUANTITIES[:3])), dtype=float)
    table["cost"] = costs
    low, high = np.array([[each.band(rows, confidence) for each in wanted] for rows in groups]).transpose(2, 0, 1)
    for place, each in enumerate(wanted):
        ends = values[:, place], low[:, place], high[:, place]
        table[each.label], table[f"{each.label}, low"], table[f"{each.label}, high"] = ends
    meets, targets = _requirements_met(values, wanted), np.array([each.target for each in wanted])
    labels = [each.label for each in wanted]
    closest = np.nan_to_num(requirement_margins(values, wanted), nan=-np.inf).argmax(axis=1)
    choices = [_cheapest_design(costs, each) for each in _requirements_met(drawn, wanted)]
    table["governs"] = [labels[place] for place in closest]
    table["meets"] = meets
    table["confidence"] = _requirements_met(drawn, wanted).mean(axis=0)
    table["chosen"] = [choices.count(place) / len(choices) for place in range(len(groups))]
    table["n_runs"] = [int(rows["status"].notna().sum()) for rows in groups]
    table["n_failed"] = [int(rows["status"].isna().sum()) for rows in groups]
    best = _cheapest_design(costs, meets)
    return BestDesign(
        designs=table,
        best=best,
        cautious=_cheapest_design(costs, meets & (np.fmax(values, high) <= targets).all(axis=1)),
        limits=_requirement_limits_table(table, best, wanted, values, costs),
        interval=_variable_intervals_table(table, best, choices, confidence),
        governs="" if best is None else labels[closest[best]],
        requirements=tuple(wanted),
        cost=cost,
        notes=tuple(_best_design_notes(table, best, choices, values)),
    )


def _requirements_met(values: Array, wanted: list[Requirement]) -> Bools:
    """Whether all targets are met, for values whose last axis is that of the requirements; NaN meets none."""
    return np.all(values <= np.array([each.target for each in wanted]), axis=-1)


def _cheapest_design(costs: Array, meets: Bools) -> int | None:
    return int(np.where(meets, costs, np.inf).argmin()) if meets.any() else None


def _requirement_limits_table(
    table: "pd.DataFrame", best: int | None, wanted: list[Requirement], values: Array, costs: Array
) -> "pd.DataFrame":
    import pandas as pd

    found = {"limit": [each.label for each in wanted], "target": [each.target for each in wanted]}
    if best is None:
        return pd.DataFrame(found | dict.fromkeys(("value", "low", "high", "used", "cost_without"), np.nan)).iloc[:0]
    row = table.iloc[best]
    for name, suffix in (("value", ""), ("low", ", low"), ("high", ", high")):
        found[name] = [row[f"{each.label}{suffix}"] for each in wanted]
    found["used"] = [row[each.label] / each.target for each in wanted]
    found["cost_without"] = []
    for place in range(len(wanted)):
        others = [other for other in range(len(wanted)) if other != place]
        free = _requirements_met(values[:, others], [wanted[other] for other in others])
        found["cost_without"].append(float(np.where(free, costs, np.inf).min()))
    return pd.DataFrame(found)


def _variable_intervals_table(
    table: "pd.DataFrame", best: int | None, choices: list[int | None], confidence: float
) -> "pd.DataFrame":
    import pandas as pd

    chosen = table[[*QUANTITIES]].iloc[[place for place in choices if place is not None]]
    ends = chosen.quantile([0.5 - 0.5 * confidence, 0.5 + 0.5 * confidence]).to_numpy(float)
    of_best = np.full(len(QUANTITIES), np.nan) if best is None else table[[*QUANTITIES]].iloc[best].to_numpy(float)
    return pd.DataFrame({"quantity": QUANTITIES, "best": of_best, "low": ends[0], "high": ends[1]})


def _best_design_notes(table: "pd.DataFrame", best: int | None, choices: list[int | None], values: Array) -> list[str]:
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
                f"The best design has the {at[0]} {LABELS[name]} of its range, {column[best]:.4g}: a design beyond it "
                "might be cheaper."
            )
    without = choices.count(None)
    if without:
        notes.append(f"In {without} of {len(choices)} resamples no design meets all targets.")
    return notes


FORCES = {"tendon_factor": "prestress", "dissipator_factor": "dissipator_force"}
MAX_GRID_POINTS = 60_000  # points of the grid on which a trade-off is found
MAX_PARTS_OF_STEP = 16  # parts of a step between two values given


@dataclass(frozen=True)
class InterpolatedMargins:
    """Margins of a search as functions of its variables.

    `given` are the values that the search was given of each variable that it varies, `fixed` is the value of each other
    one, and `forces` the force in N for a factor of 1, of the tendons and of the dissipators.
    """

    surface: MarginSurface
    given: dict[str, Array]
    fixed: dict[str, float]
    forces: dict[str, float]

    @classmethod
    def of(cls, found: BestDesign) -> "InterpolatedMargins":
        """Interpolate between the designs of a search."""
        table = found.designs
        first = table[table["round"] == 0]
        given = {name: np.unique(first[name].to_numpy(float)) for name in VARIABLES}
        fixed = {name: float(values[0]) for name, values in given.items() if values.size == 1}
        given = {name: values for name, values in given.items() if values.size > 1}
        margins = requirement_margins(
            table[[each.label for each in found.requirements]].to_numpy(float), found.requirements
        )
        forces = {}
        for factor, force in FORCES.items():
            place = int(table[factor].to_numpy(float).argmax())
            top = float(table[factor].iloc[place])
            forces[force] = float(table[force].iloc[place]) / top if top else 0.0
        if not given:
            raise InputError("All designs are the same, so there is no trade-off.")
        return cls(MarginSurface(_trade_off_steps(table, given), margins), given, fixed, forces)

    def at(self, table: "pd.DataFrame") -> Array:
        """Margins of designs with columns of the variables, shape (n, n_requirements)."""
        return self.surface.margins(_trade_off_steps(table, self.given))

    def designs(self, values: dict[str, Array]) -> "pd.DataFrame":
        """All combinations of values of the variables, with their forces in N."""
        import pandas as pd

        axes = [values.get(name, np.array([self.fixed.get(name, np.nan)])) for name in VARIABLES]
        table = pd.DataFrame([*product(*axes)], columns=list(VARIABLES))
        return table.assign(**{force: table[name] * self.forces[force] for name, force in FORCES.items()})

    def fine(self) -> dict[str, Array]:
        """Each variable's values, divided as finely as a grid of them allows."""
        parts = MAX_PARTS_OF_STEP
        while parts > 1 and np.prod([float((v.size - 1) * parts + 1) for v in self.given.values()]) > MAX_GRID_POINTS:
            parts //= 2
        return {
            name: np.interp(np.arange((v.size - 1) * parts + 1) / parts, np.arange(v.size), v)
            for name, v in self.given.items()
        }


def trade_off(found: BestDesign, variable: str = "half_width") -> "pd.DataFrame":
    """Find the cheapest design that meets all requirements for each value of one variable.

    The probits of the probabilities, or the logarithms of the rates, are interpolated between the designs of the search
    by smoothed thin-plate splines. The result is therefore a prediction, which runs confirm only where designs were
    tried.

    Parameters
    ----------
    found
        What `best_design` returned.
    variable
        ``"half_width"``, ``"tendon_factor"`` or ``"dissipator_factor"``.

    Returns
    -------
    pandas.DataFrame
        One row per value of the variable for which a design meets all requirements: `half_width` (m), `tendon_factor`,
        `dissipator_factor`, `prestress` (N), `dissipator_force` (N), `cost`, and `governs`, the label of the
        requirement that is the closest to its target.

    Raises
    ------
    InputError
        If the search did not vary this variable, or too few designs have probabilities of all limits.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3,
    ...     base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> held = rf.Restrained(frame, rf.Tendon(initial_force=300e3, stiffness=2e6))
    >>> pulses = {"a": rf.ricker_pulse(3.0, 0.6), "b": rf.ricker_pulse(3.0, 0.9)}
    >>> search = rf.DesignSearch([1.0, 2.0, 3.0], tendon_factors=[0.0, 1.0, 2.0],
    ...     refinements=1)
    >>> targets, cost = [rf.Requirement(0.01, 0.2, at=0.5)], rf.DesignCost(
    ...     half_width=1.0, prestress=5e-7)
    >>> runs = rf.search_design(held, pulses, search, targets, cost,
    ...     model="2DOF-S", scales=[0.5, 1.0, 2.0, 4.0])
    >>> curve = rf.trade_off(rf.best_design(runs, targets, cost))
    >>> curve.columns.tolist()
    ['half_width', 'tendon_factor', 'dissipator_factor', 'prestress', 'dissipator_force', 'cost', 'governs']
    """
    between = InterpolatedMargins.of(found)
    if variable not in between.given:
        raise InputError(f"variable must be one that the search varied, {', '.join(between.given)}, not {variable!r}.")
    table = between.designs(between.fine())
    margins = between.at(table)
    costs = found.cost.of(*(table[name] for name in ("half_width", "prestress", "dissipator_force")))
    labels = np.array([each.label for each in found.requirements])
    table = table.assign(cost=costs, governs=labels[margins.argmax(axis=1)])
    met = table[margins.max(axis=1) <= 0.0]
    return met.sort_values([variable, "cost"], kind="stable").groupby(variable).head(1).reset_index(drop=True)


def _trade_off_steps(table: "pd.DataFrame", given: dict[str, Array]) -> Array:
    columns = [np.interp(table[name].to_numpy(float), values, np.arange(values.size)) for name, values in given.items()]
    return np.column_stack(columns)
