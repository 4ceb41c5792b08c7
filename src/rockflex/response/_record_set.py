"""The responses to a set of records as one result: peaks by record, statistics, and values for design by codes."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np

from rockflex.foundation.arrays import Array, Bools
from rockflex.foundation.checks import is_one_of
from rockflex.foundation.errors import InputError
from rockflex.foundation.html import HtmlTable
from rockflex.foundation.language import translated
from rockflex.foundation.shown import number_with_noun, shown
from rockflex.foundation.units import KN
from rockflex.foundation.values import Value
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._recordings import horizontal_pairs
from rockflex.response._outputs import DEMANDS_OF_SET, OUTPUTS
from rockflex.response._quasi_static import static_path
from rockflex.response._response import Response, history_of
from rockflex.structure._rocking import RockingProperties

if TYPE_CHECKING:
    import pandas as pd


Rule = Literal["ec8", "asce7", "asce7-ii"]
MEDIAN, FRACTILE = 0.5, 0.84
MEDIAN_FACTOR = 1.2  # on the median, where one record may overturn; not checked against the standard


@dataclass(frozen=True)
class DesignRule:
    """How a code takes one value from the demands of several records."""

    source: str
    least: int  # records
    mean_from: int  # records from which the mean counts; with fewer the most unfavourable value does
    may_overturn: int = 0  # records


RULES: Mapping[str, DesignRule] = {
    "ec8": DesignRule("EN 1998-1:2004, 4.3.3.4.3", 3, 7),
    "asce7": DesignRule("ASCE 7-16, 16.4.1", 11, 11),
    "asce7-ii": DesignRule("ASCE 7-16, 16.4.1.1, Risk Categories I and II", 11, 11, may_overturn=1),
}


def checked_rule(rule: object, n: int) -> Rule | None:
    """Return a rule that has enough records.

    Raises
    ------
    InputError
        If there is no such rule, or it asks for more records than `n`.
    """
    if rule is None:
        return None
    if not is_one_of(rule, get_args(Rule)):
        words = ", ".join(map(repr, get_args(Rule)))
        raise InputError(f"rule must be {words} or None, but {shown(rule)} was given.", field="rule")
    asked = RULES[str(rule)]
    if n < asked.least:
        raise InputError(
            f"{asked.source} asks for at least {asked.least} records, but {number_with_noun(n, 'was', 'were')} given. "
            "Give more records, or rule=None for their statistics alone.",
            field="rule",
        )
    return rule  # pyright: ignore[reportReturnType]


def design_value(values: Array, fallen: Bools, rule: str | None, *, worst_is_least: bool = False) -> tuple[float, str]:
    """Return the value to design for, NaN if there is none, and the reason; `fallen` tells which records overturn."""
    n, k = values.size, int(fallen.sum())
    worst = float(values.min() if worst_is_least else values.max())
    asked = None if rule is None else RULES[rule]
    few = asked is None or n < asked.mean_from
    known = {"n": n, "k": k, "rule": translated("no rule") if asked is None else asked.source}
    known["value"] = translated("the most unfavourable value" if few else "the mean")
    if k > (0 if asked is None else asked.may_overturn):
        said = translated(
            "{k} of {n} records overturns: {value} is not defined ({rule})"
            if k == 1
            else "{k} of {n} records overturn: {value} is not defined ({rule})",
            **known,
        )
        return math.nan, said
    said = translated("{value} of {n} record ({rule})" if n == 1 else "{value} of {n} records ({rule})", **known)
    if few:
        return worst, said
    standing = float(values[~fallen].mean())
    if k == 0:
        return standing, said
    # The greater of the two in magnitude; a least reaction has no median factor that is on the safe side.
    if worst_is_least:
        least = float(values[~fallen].min())
        return least, translated("1 of {n} records overturns: the least of the others ({rule})", **known)
    median = MEDIAN_FACTOR * fractile(values, fallen, MEDIAN)
    said = translated(
        "1 of {n} records overturns: the larger of 1.2 times the median and the mean of the others ({rule})", **known
    )
    return max(median, standing), said


def fractile(values: Array, fallen: Bools, share: float, *, worst_is_least: bool = False) -> float:
    """Return the counted fractile of demands, linear between ranks; an overturned record exceeds every value."""
    sign = -1.0 if worst_is_least else 1.0
    ranked = np.sort(np.where(fallen, math.inf, sign * values))
    place = share * (ranked.size - 1)
    low = math.floor(place)
    rest = place - low
    known = float(ranked[low])
    return sign * (known if rest == 0.0 or math.isinf(known) else known + rest * float(ranked[low + 1] - known))


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class RecordSet(HtmlTable, Value):
    """The responses of one structure to a set of records; `simulate_set` returns it.

    Attributes
    ----------
    responses : tuple of Response
        One of each record, with its history.
    motions : tuple of GroundMotion
        The records as they acted, scaled.
    properties : RockingProperties
        The structure.
    rule : {"ec8", "asce7", "asce7-ii"} or None
        The rule that makes one value for design of the demands of all records; see `simulate_set`.
    periods : tuple of float, or None
        Smallest and largest period in s for which the records were chosen.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
    >>> pulses = {f"T = {t} s": rf.one_sine_pulse(amplitude=3.0, period=t)
    ...     for t in (0.5, 0.6, 0.7)}
    >>> found = rf.simulate_set(frame, pulses, "2DOF-S", rule="ec8")
    >>> found.peaks["max_rotation"].round(4).tolist()
    [0.0059, 0.0093, 0.0131]
    >>> found.statistics.loc["max_rotation", "reason"]
    'the most unfavourable value of 3 records (EN 1998-1:2004, 4.3.3.4.3)'
    """

    responses: tuple[Response, ...]
    motions: tuple[GroundMotion, ...]
    properties: RockingProperties
    rule: Rule | None
    periods: tuple[float, float] | None

    def __repr__(self) -> str:
        return (
            f"RecordSet({self.responses[0].model} under {number_with_noun(len(self.responses), 'record')}, "
            f"{self.n_overturned} overturned, rule={self.rule!r})"
        )

    def _shown_as(self) -> dict[str, Any]:
        values = zip(map(str, self.statistics.index), self.statistics["design"], strict=True)
        design = {
            f"{OUTPUTS[name].symbol} [{unit}]": float(value) / size
            for name, value in values
            for size, unit in (OUTPUTS[name].unit_in(KN),)
        }
        return {
            "model": self.responses[0].model,
            "records": len(self.responses),
            "overturned": self.n_overturned,
        } | design

    @property
    def fallen(self) -> Bools:
        """Which records overturn the structure, shape (n,)."""
        return np.array([run.status == "overturned" for run in self.responses])

    @property
    def n_overturned(self) -> int:
        """Number of records that overturn the structure."""
        return int(self.fallen.sum())

    @property
    def peaks(self) -> "pd.DataFrame":
        """The peaks by record: every scalar of `Response` by its name, indexed by motion, in SI units.

        With floors also `max_story_drift` (m) and `max_floor_acceleration` (m/s²), the largest of all stories and
        floors. Those of an overturned record are the peaks up to its fall.
        """
        return self._peaks.copy()  # a frame can be changed

    @cached_property
    def _peaks(self) -> "pd.DataFrame":
        import pandas as pd

        rows = [run.peaks() | floor_peaks(run) for run in self.responses]
        return pd.DataFrame(rows).set_index("motion")

    @property
    def statistics(self) -> "pd.DataFrame":
        """Mean, extreme, median and 84 % fractile of each demand, and its value for design, in SI units.

        One row a demand that occurs. `worst` is the most unfavourable value, of `min_vertical_reaction` the least; the
        fractiles are counted, with ranks joined linearly (of `min_vertical_reaction` that on the unfavourable side). An
        overturned record exceeds every value: with one `mean` is NaN, `worst` and what lies beyond the ranks of the
        others is infinite, and `design` is NaN unless the rule allows it. `reason` tells how `design` was found.
        """
        import pandas as pd

        peaks, fallen = self._peaks, self.fallen
        rows: dict[str, dict[str, Any]] = {}
        for name in DEMANDS_OF_SET:
            if name not in peaks or peaks[name].isna().any() or not peaks[name].any():
                continue
            values, least = peaks[name].to_numpy(float), OUTPUTS[name].worst_is_least
            beyond = np.where(fallen, -math.inf if least else math.inf, values)
            design, reason = design_value(values, fallen, self.rule, worst_is_least=least)
            rows[name] = {
                "mean": math.nan if fallen.any() else float(values.mean()),
                "worst": float(beyond.min() if least else beyond.max()),
                "median": fractile(values, fallen, MEDIAN, worst_is_least=least),
                "fractile_84": fractile(values, fallen, FRACTILE, worst_is_least=least),
                "design": design,
                "reason": reason,
            }
        return pd.DataFrame.from_dict(rows, orient="index")

    @property
    def rocking_period(self) -> float:
        """Effective period in s at the largest rotation θ of the records that do not overturn.

        √(T_1² + T_r²) of the first period on a fixed base and of the rigid structure with the secant stiffness of its
        base, T_r = 2π √(I_θ θ/M(θ)), with the moment M of `moment_rotation`: on rigid ground without elements
        M = M_r - L_0^r g θ. It is the substitute structure of displacement-based design (Priestley, Calvi & Kowalsky
        2007), with the flexibilities added as Dunkerley does. Infinite where M is not positive; elements between
        floors and ties, which shorten it, are left out.
        """
        p = self.properties
        first = 2.0 * math.pi / float(p.omega[0]) if p.n_modes else 0.0
        standing = [run for run in self.responses if run.status != "overturned"]
        run = max(standing, key=lambda each: each.max_rotation, default=None)
        if run is None or not run.max_rotation:
            return first
        model = history_of(run).model
        under = tuple(each for each in p.elements if not each.attached)
        held, turn = replace(p, elements=under, stories=()), run.max_rotation
        paths = [static_path(held, np.array([s * turn]), model.springs, model.rest).moment for s in (1.0, -1.0)]
        moment = min(float(paths[0][-1]), -float(paths[1][-1]))
        if moment <= 0.0:
            return math.inf
        return math.sqrt(first**2 + (2.0 * math.pi) ** 2 * p.weaker_pivot.i_theta * turn / moment)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Warnings, a text each: records that overturn, a choice for too short periods, and those of single runs."""
        found, n = list[str](), len(self.responses)
        if self.n_overturned:
            names = ", ".join(run.motion for run, fell in zip(self.responses, self.fallen, strict=True) if fell)
            found.append(
                translated(
                    "{k} of {n} records overturn the structure: {names}. No mean is defined.",
                    k=self.n_overturned,
                    n=n,
                    names=names,
                )
            )
        reached = self.rocking_period
        if self.periods is not None and self.periods[1] < reached:
            largest = max((run.max_rotation for run in self.responses if run.status != "overturned"), default=0.0)
            period = translated("a period of {period} s", period=f"{reached:.3g}")
            found.append(
                translated(
                    "The records were chosen for periods up to {longest} s, but at the θ = {rotation} rad that is "
                    "reached rocking has {period}. Choose them for longer periods.",
                    longest=f"{self.periods[1]:.3g}",
                    rotation=f"{largest:.3g}",
                    period=period if math.isfinite(reached) else translated("periods of any length"),
                )
            )
        shared = len(horizontal_pairs(self.motions)[0])
        if shared:
            found.append(
                translated(
                    "{k} of {n} records are both components of {shared} recording: they are not independent, but each "
                    "counts. Choose one of each recording."
                    if shared == 1
                    else "{k} of {n} records are both components of {shared} recordings: they are not independent, but "
                    "each counts. Choose one of each recording.",
                    k=2 * shared,
                    n=n,
                    shared=shared,
                )
            )
        own = [(run.motion, run.warnings[0]) for run in self.responses if run.warnings]
        if own:
            found.append(
                translated(
                    "Runs with warnings of their own: {k} of {n}. {record}: {warning}",
                    k=len(own),
                    n=n,
                    record=own[0][0],
                    warning=own[0][1],
                )
            )
        return tuple(found)


def floor_peaks(run: Response) -> dict[str, float]:
    """Return `max_story_drift` in m and `max_floor_acceleration` in m/s² of all floors; nothing without floors."""
    if run.floors is None:
        return {}
    peaks = {"max_story_drift": run.floors.story_drift, "max_floor_acceleration": run.floors.floor_acceleration}
    return {name: float(values.max(initial=0.0)) for name, values in peaks.items()}
