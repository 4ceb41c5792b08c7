"""Tornado diagrams: how a demand changes when each parameter of a structure is at the ends of its range."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import is_one_of
from rockflex.foundation.errors import InputError, SolverError
from rockflex.foundation.shown import shown
from rockflex.foundation.values import Value
from rockflex.models._label import Model, parse_model
from rockflex.response._outputs import OUTPUTS
from rockflex.response._respond import STATUSES
from rockflex.structure._rocking import RockingProperties
from rockflex.studies._arguments import Motions, RockingStructure, check_keywords, checked_motions
from rockflex.studies._parameters import SCALE, Subject
from rockflex.studies._prepared_case import ManyKeywords, PreparedRun, RunOptions, peaks_of_runs
from rockflex.studies.parallel import map_runs_in_order
from rockflex.studies.progress import reporting_progress

if TYPE_CHECKING:
    import pandas as pd

Range = float | tuple[float, float]
OVERTURNED = STATUSES.index("overturned")


@dataclass(frozen=True, eq=False, kw_only=True)
class Tornado(Value):
    """The median of a demand over the records, with each parameter at the ends of its range; widest first.

    Attributes
    ----------
    demand : str
        Name of the demand, such as ``"max_rotation"``.
    base : float
        Its median with all parameters as given, in SI units.
    parameters : tuple of str
        Names of the P parameters.
    factors : ndarray, shape (P, 2)
        What each is multiplied by at both ends of its range.
    values : ndarray, shape (P, 2)
        Medians of the demand there.
    overturned : ndarray of int, shape (P, 2)
        Numbers of records under which the structure overturns there.
    n_records : int
        Number of records.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
    >>> found = rf.tornado(frame, rf.one_sine_pulse(amplitude=3.0, period=0.8),
    ...     parameters={"period": 0.2})
    >>> found
    Tornado(max_rotation over 1 records, 1 parameters)
    >>> found.to_frame()[["change_low", "change_high"]].round(1)
               change_low  change_high
    parameter
    period           13.6        -16.6
    """

    demand: str
    base: float
    parameters: tuple[str, ...]
    factors: Array
    values: Array
    overturned: Array
    n_records: int

    @property
    def swings(self) -> Array:
        """The width of each bar: how far the two ends and the base are apart, shape (P,)."""
        ends = np.column_stack((self.values, np.full(len(self.values), self.base)))
        return ends.max(axis=1) - ends.min(axis=1)

    def to_frame(self) -> "pd.DataFrame":
        """Return a table with a row a parameter: factors, the demand there, and by how many per cent it differs."""
        import pandas as pd

        changes = 100.0 * (self.values / self.base - 1.0) if self.base else np.full_like(self.values, np.nan)
        columns: dict[str, Any] = {}
        for end, place in (("low", 0), ("high", 1)):
            columns |= {f"factor_{end}": self.factors[:, place], end: self.values[:, place]}
            columns |= {f"change_{end}": changes[:, place], f"overturned_{end}": self.overturned[:, place].astype(int)}
        return pd.DataFrame(columns, index=pd.Index(self.parameters, name="parameter"))

    def __repr__(self) -> str:
        return f"Tornado({self.demand} over {self.n_records} records, {len(self.parameters)} parameters)"


def tornado(
    structure: RockingStructure | RockingProperties,
    motions: Motions,
    model: str | Model = "MDOF-S",
    parameters: Mapping[str, Range] | Sequence[str] | float = 0.1,
    *,
    demand: str = "max_rotation",
    **options: Unpack[ManyKeywords],
) -> Tornado:
    """Run a structure with each parameter at both ends of its range, the others as given.

    The runs are complete ones, of any model, so that nothing is linear in them; `gradient` tells the same for small
    changes, of one run and in less time.

    Parameters
    ----------
    structure, motions, model
        As in `simulate_many`: one record, or many of which the medians are taken.
    parameters
        By name, as in `gradient`, a relative range such as 0.1 for ±10 %, or the two factors at its ends; names alone
        have ±10 %. ``"scale"`` is the factor on the records. A range alone is that of all `parameter_names` that can
        be so far from their values.
    demand
        Name of a number of `Response`.
    options
        As in `simulate_many`.

    Returns
    -------
    Tornado
        The medians, widest bar first; `plot_tornado` draws it. A run that overturns counts with its peaks until then.

    Raises
    ------
    InputError
        If a name or a range is not possible, the demand is unknown, or as for `simulate_many`.
    SolverError
        If a run cannot be solved.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
    >>> found = rf.tornado(frame, rf.one_sine_pulse(amplitude=3.0, period=0.8),
    ...     parameters={"period": 0.2, "damping_ratio": (0.5, 2.0), "scale": 0.1})
    >>> found.parameters
    ('period', 'scale', 'damping_ratio')
    """
    check_keywords(options, ManyKeywords)
    given: dict[str, Any] = {**options}
    workers, progress = given.pop("workers", None), given.pop("progress", None)
    records, chosen = checked_motions(motions), parse_model(model)
    if not is_one_of(demand, OUTPUTS) or OUTPUTS[demand].quantity in ("flag", "count"):
        raise InputError(f"demand must be a number of a Response, but {shown(demand)} was given.", field="demand")
    subject = Subject(structure, replace(RunOptions.of(**given), all_yield=True))
    if isinstance(parameters, int | float):
        parameters = possible_ranges(subject, chosen, float(parameters))
    ranges = _checked_ranges(subject, parameters)
    cases = [(subject, 1.0)]
    for name, ends in ranges.items():
        for factor in ends:
            if name == SCALE:
                cases.append((subject, factor))
                continue
            try:
                changed = subject.changed(subject.place_of(name), float(np.log(factor)))
                changed.case(chosen)
            except InputError as error:
                raise InputError(f"{name} times {factor:g}: {error}", field="parameters") from error
            cases.append((changed, 1.0))

    def work(task: tuple[Subject, float]) -> tuple[float, int]:
        case = task[0].case(chosen)
        runs: list[PreparedRun] = [(case, record, task[1]) for record in records]
        found = peaks_of_runs(runs, keep=False)
        if found.failures:
            place, error = next(iter(found.failures.items()))
            raise SolverError(f"{records[place].name}: {error}")
        return float(np.median(found.columns[demand])), int((found.columns["status"] == OVERTURNED).sum())

    with reporting_progress(progress, len(cases), "cases") as advance:
        made = list(map_runs_in_order(work, iter(cases), workers, lambda _: advance(1)))
    values = np.array([value for value, _ in made[1:]]).reshape(-1, 2)
    found = Tornado(
        demand=demand,
        base=made[0][0],
        parameters=tuple(ranges),
        factors=np.array(list(ranges.values())).reshape(-1, 2),
        values=values,
        overturned=np.array([count for _, count in made[1:]], dtype=float).reshape(-1, 2),
        n_records=len(records),
    )
    order = np.argsort(-found.swings, kind="stable")
    return replace(
        found,
        parameters=tuple(found.parameters[k] for k in order),
        factors=found.factors[order],
        values=values[order],
        overturned=found.overturned[order],
    )


def possible_ranges(subject: Subject, model: Model, share: float) -> dict[str, float]:
    """Return a relative range for every number of a structure, its ground and its impact law that can have it."""
    factors, found = _factors("parameters", share), dict[str, float]()
    for name in subject.names():
        try:
            for factor in factors:
                subject.changed(subject.place_of(name), float(np.log(factor))).case(model)
        except InputError:  # beyond its range
            continue
        found[name] = share
    return found


def _checked_ranges(
    subject: Subject, parameters: Mapping[str, Range] | Sequence[str]
) -> dict[str, tuple[float, float]]:
    """The factors at the ends of each parameter."""
    given = dict(parameters) if isinstance(parameters, Mapping) else dict.fromkeys(parameters, 0.1)
    found = dict[str, tuple[float, float]]()
    for name, ends in given.items():
        if name != SCALE:
            subject.place_of(name)
        found[name] = _factors(name, ends)
    if not found:
        raise InputError("parameters must be one or more names.", field="parameters")
    return found


def _factors(name: str, ends: Any) -> tuple[float, float]:
    """The factors at the ends of a range."""
    try:
        low, high = (1.0 - ends, 1.0 + ends) if isinstance(ends, int | float) else map(float, ends)
    except (TypeError, ValueError):
        low, high = np.nan, np.nan
    if not 0.0 < low < high < np.inf:
        raise InputError(
            f"{name} must have a relative range such as 0.1, below 1, or two rising positive factors such as "
            f"(0.5, 2), but {shown(ends)} was given.",
            field="parameters",
        )
    return low, high
