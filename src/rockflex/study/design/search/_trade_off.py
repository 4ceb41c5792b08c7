"""The trade-off between width, prestress and dissipators: the cheapest design for each value of one of them."""

from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from rockflex._arrays import Array
from rockflex._errors import InputError
from rockflex.study.design.search._best import BestDesign
from rockflex.study.design.search._requirement import margins_of
from rockflex.study.design.search._space import VARIABLES
from rockflex.study.design.search._surface import Surface

if TYPE_CHECKING:
    import pandas as pd

FORCES = {"tendon_factor": "prestress", "dissipator_factor": "dissipator_force"}
MOST = 60_000  # points of the grid on which a trade-off is found
FINEST = 16  # parts of a step between two values given


@dataclass(frozen=True)
class Interpolated:
    """Margins of a search as functions of its variables.

    Attributes
    ----------
    surface : Surface
    given : dict
        The values that the search was given, of each variable that it varies.
    fixed : dict
        The value of each other variable.
    forces : dict
        Force in N for a factor of 1, of the tendons and of the dissipators.
    """

    surface: Surface
    given: dict[str, Array]
    fixed: dict[str, float]
    forces: dict[str, float]

    @classmethod
    def of(cls, found: BestDesign) -> "Interpolated":
        """Interpolate between the designs of a search.

        Raises
        ------
        InputError
            If too few designs have probabilities of all limits.
        """
        table = found.designs
        first = table[table["round"] == 0]
        given = {name: np.unique(first[name].to_numpy(float)) for name in VARIABLES}
        fixed = {name: float(values[0]) for name, values in given.items() if values.size == 1}
        given = {name: values for name, values in given.items() if values.size > 1}
        margins = margins_of(table[[each.label for each in found.requirements]].to_numpy(float), found.requirements)
        forces = {}
        for factor, force in FORCES.items():
            place = int(table[factor].to_numpy(float).argmax())
            top = float(table[factor].iloc[place])
            forces[force] = float(table[force].iloc[place]) / top if top else 0.0
        if not given:
            raise InputError("All designs are the same, so there is no trade-off.")
        return cls(Surface(_steps(table, given), margins), given, fixed, forces)

    def at(self, table: "pd.DataFrame") -> Array:
        """Margins of designs with columns of the variables, shape (n, n_requirements)."""
        return self.surface.margins(_steps(table, self.given))

    def designs(self, values: dict[str, Array]) -> "pd.DataFrame":
        """All combinations of values of the variables, with their forces in N."""
        import pandas as pd

        axes = [values.get(name, np.array([self.fixed.get(name, np.nan)])) for name in VARIABLES]
        table = pd.DataFrame([*product(*axes)], columns=list(VARIABLES))
        return table.assign(**{force: table[name] * self.forces[force] for name, force in FORCES.items()})

    def fine(self) -> dict[str, Array]:
        """Each variable's values, divided as finely as a grid of them allows."""
        parts = FINEST
        while parts > 1 and np.prod([float((v.size - 1) * parts + 1) for v in self.given.values()]) > MOST:
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
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> held = rf.Restrained(frame, rf.Tendon(initial_force=300e3, stiffness=2e6))
    >>> pulses = {"a": rf.ricker_pulse(3.0, 0.6), "b": rf.ricker_pulse(3.0, 0.9)}
    >>> search = rf.DesignSearch([1.0, 2.0, 3.0], tendon_factors=[0.0, 1.0, 2.0], refinements=1)
    >>> targets, cost = [rf.Requirement(0.01, 0.2, at=0.5)], rf.DesignCost(half_width=1.0, prestress=5e-7)
    >>> runs = rf.search_design(held, pulses, search, targets, cost, model="2DOF-S", scales=[0.5, 1.0, 2.0, 4.0])
    >>> curve = rf.trade_off(rf.best_design(runs, targets, cost))
    >>> curve.columns.tolist()
    ['half_width', 'tendon_factor', 'dissipator_factor', 'prestress', 'dissipator_force', 'cost', 'governs']
    """
    between = Interpolated.of(found)
    if variable not in between.given:
        raise InputError(f"variable must be one that the search varied, {', '.join(between.given)}, not {variable!r}.")
    table = between.designs(between.fine())
    margins = between.at(table)
    costs = found.cost.of(*(table[name] for name in ("half_width", "prestress", "dissipator_force")))
    labels = np.array([each.label for each in found.requirements])
    table = table.assign(cost=costs, governs=labels[margins.argmax(axis=1)])
    met = table[margins.max(axis=1) <= 0.0]
    return met.sort_values([variable, "cost"], kind="stable").groupby(variable).head(1).reset_index(drop=True)


def _steps(table: "pd.DataFrame", given: dict[str, Array]) -> Array:
    columns = [np.interp(table[name].to_numpy(float), values, np.arange(values.size)) for name, values in given.items()]
    return np.column_stack(columns)
