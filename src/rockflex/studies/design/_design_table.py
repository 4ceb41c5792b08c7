"""Probability or annual rate at which each design exceeds a limit, and the narrowest base that meets a target."""

import math
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_positive
from rockflex.foundation.language import translated
from rockflex.fragility._hazard import HazardCurve
from rockflex.studies.design._exceedance_fit import (
    ShakingLevel,
    check_confidence,
    check_design_limit,
    check_exceedance_table,
    check_hazard_damping,
    check_measure_of_record_alone,
    design_row,
)

if TYPE_CHECKING:
    import pandas as pd


FACTS = ("tendon", "half_width", "aspect_ratio", "prestress_ratio", "stiffness_ratio", "resisting_moment")
RESULTS = ("status", "max_rotation", "nominal_limit", "max_base_moment", "tendon_utilisation", "group")


def design_table(
    runs: "pd.DataFrame",
    limit: float | str,
    *,
    measure: str = "pgv",
    at: float | None = None,
    hazard: HazardCurve | None = None,
    confidence: float | None = 0.9,
) -> "pd.DataFrame":
    """Compute how likely each design is to exceed a limit, at a level of intensity or in a year.

    The probability is the total one of `fit_outcomes`, P(OV) + P(no OV) P(rocking | no OV) P(θ_max > limit | rocking),
    where OV is |θ| = π/2; over a hazard curve it is integrated by `annual_rate`. The band is that
    of `RotationFragility` and `annual_rate`, by recording.

    Parameters
    ----------
    runs
        The table of `run_design`, or of a `DesignStudy`.
    limit
        A rotation in rad; a multiple of 0.7 atan(B/h*_1) of each design, ``"nominal"`` or such as ``"0.5 nominal"``; a
        limit state such as ``"overturning"``; or a demand with its bound, such as ``"max_ductility > 4"``.
    measure
        Column of the intensity measure, which must not depend on the base.
    at
        Level of the measure in its unit.
    hazard
        Hazard curve in the measure's unit, in place of a level.
    confidence
        Confidence of the band, in [0, 1); None for no band.

    Returns
    -------
    pandas.DataFrame
        One row per model and design, in order of half width: `model`, `tendon`, `half_width`, `aspect_ratio`,
        `prestress_ratio`, `stiffness_ratio`, `resisting_moment`; `limit` (rad); `probability`, or with a hazard `rate`
        (1/year), NaN if it cannot be fitted; `low` and `high` of its band, NaN if all runs had the same outcome;
        `overturning`, the same value for |θ| = π/2; with a hazard `beyond`, an upper bound on the rate beyond the ends
        of the curve; `note`, warnings about the row; `median_base_moment` (N m) and
        `median_tendon_utilisation` of all solved runs, whatever their intensity; `n_runs` solved, `n_exceeding` the
        limit, `n_overturned`, `n_failed`.

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
    >>> pulses = {"a": rf.ricker_pulse(3.0, 0.6), "b": rf.ricker_pulse(3.0, 0.9)}
    >>> runs = rf.run_design(frame, pulses, half_widths=[1.0, 1.5],
    ...     models="2DOF-S", scales=[0.5, 1.0, 2.0, 4.0])
    >>> table = rf.design_table(runs, 0.005, at=0.5, confidence=None)
    >>> table["half_width"].tolist()
    [1.0, 1.5]
    >>> table["probability"].round(3).tolist()
    [1.0, 0.999]
    """
    check_measure_of_record_alone(measure)
    check_exceedance_table(runs, ("structure", "model", *FACTS, *RESULTS, measure), "run_design")
    level = ShakingLevel.of(at, hazard)
    check_hazard_damping(hazard, runs, measure)
    if confidence is not None:
        check_confidence(confidence)
    check_design_limit(limit)
    import pandas as pd

    rows: list[dict[str, Any]] = []
    for (_, model), group in runs.groupby(["structure", "model"], observed=True, sort=False):
        first = group.iloc[0]
        facts = {"model": str(model), **{name: first[name] for name in FACTS}}
        rows.append(facts | design_row(group, limit, measure, level, confidence))
    models, tendons = (list(dict.fromkeys(row[name] for row in rows)) for name in ("model", "tendon"))
    rows.sort(key=lambda row: (models.index(row["model"]), tendons.index(row["tendon"]), row["half_width"]))
    return pd.DataFrame(rows)


NEEDED = ("model", "tendon", "half_width", "prestress_ratio", "stiffness_ratio", "high")


def smallest_width(table: "pd.DataFrame", target: float) -> "pd.DataFrame":
    """Find the smallest half width at and above which every base meets a target, for each tendon.

    Between the widest base that does not meet it and the next, the logarithm of the value is interpolated linearly in
    B. If the next value is zero, the value itself is interpolated, which gives the wider base.

    Parameters
    ----------
    table
        The table of `design_table`.
    target
        Largest probability, or annual rate, of exceeding the limit.

    Returns
    -------
    pandas.DataFrame
        One row per model and tendon: `model`, `tendon`, `prestress_ratio`, `stiffness_ratio` (missing if it differs
        from base to base), `target`; `half_width` (m), NaN if the widest base does not meet the target;
        `half_width_upper` (m), the same for the upper limit of the band; `outcome`: ``"met"``; ``"met more than
        once"``, narrower bases meet it too, but not all in between; ``"all meet it"`` (the half width is then the
        smallest in the table, and a smaller one might do); or ``"not met"``. `monotone`, whether the value never rises
        with B; `note`, about bases without a value, rises, and narrower bases that meet the target.

    Raises
    ------
    InputError
        If the table lacks a column, or the target is not positive.

    Examples
    --------
    >>> import rockflex as rf
    >>> import pandas as pd
    >>> facts = {"model": "MDOF-S", "tendon": "no tendon", "prestress_ratio": 0.0,
    ...     "stiffness_ratio": 0.0}
    >>> values = {"probability": [0.4, 0.1, 0.05], "high": [0.5, 0.2, 0.1]}
    >>> table = pd.DataFrame({"half_width": [1.0, 1.5, 2.0], **values, **facts})
    >>> found = rf.smallest_width(table, target=0.2).iloc[0]
    >>> print(f"{found.half_width:.3g}, {found.half_width_upper:.3g},",
    ...     found.outcome)
    1.25, 1.5, met
    """
    import pandas as pd

    value = "rate" if "rate" in table else "probability"
    check_exceedance_table(table, (*NEEDED, value), "design_table")
    wanted = checked_positive("target", target, "1/year" if value == "rate" else "probability")
    rows: list[dict[str, Any]] = []
    for (model, tendon), group in table.groupby(["model", "tendon"], observed=True, sort=False):
        designs = group.sort_values("half_width")
        widths = designs["half_width"].to_numpy(float)
        found = _least_width(widths, designs[value].to_numpy(float), wanted)
        upper = _least_width(widths, designs["high"].to_numpy(float), wanted)
        rows.append(
            {
                "model": str(model),
                "tendon": str(tendon),
                "prestress_ratio": _common_value(designs["prestress_ratio"]),
                "stiffness_ratio": _common_value(designs["stiffness_ratio"]),
                "target": wanted,
                "half_width": found.half_width,
                "half_width_upper": upper.half_width,
                "outcome": found.outcome,
                "monotone": found.monotone,
                "note": found.note,
            }
        )
    return pd.DataFrame(rows)


class _LeastWidth(NamedTuple):
    half_width: float
    outcome: str
    monotone: bool
    note: str


def _common_value(column: "pd.Series[Any]") -> float:
    first = float(column.iloc[0])
    return first if np.allclose(column, first, rtol=1e-9, atol=0.0) else math.nan


def _least_width(widths: Array, values: Array, target: float) -> _LeastWidth:
    """Least width, outcome and notes, from values at rising widths."""
    known = np.isfinite(values)
    notes: list[str] = []
    if not known.all():
        lost = int((~known).sum())
        notes.append(translated("Left out for want of a value: {k} of {n} bases.", k=lost, n=known.size))
    b, y = widths[known], values[known]
    rises = [(one, other) for (one, low), (other, high) in pairwise(zip(b, y, strict=True)) if high > low]
    meets = y <= target
    if rises:
        one, other = rises[0]
        notes.append(
            translated(
                "It does not fall everywhere: it rises between B = {one} and {other} m."
                if len(rises) == 1
                else "It does not fall everywhere: it rises between B = {one} and {other} m and {n} times more.",
                one=f"{one:.4g}",
                other=f"{other:.4g}",
                n=len(rises) - 1,
            )
        )
    width, outcome = math.nan, "not met"
    if meets.all() and b.size:
        width, outcome = float(b[0]), "all meet it"
        notes.append(translated("Every base meets it; a base below B = {width} m might do.", width=f"{b[0]:.4g}"))
    elif b.size and meets[-1]:
        last = int(np.flatnonzero(~meets)[-1])
        width, outcome = _interpolated_width(b[last : last + 2], y[last : last + 2], target), "met"
        if meets[:last].any():
            outcome = "met more than once"
            notes.append(
                translated(
                    "Narrower bases meet it too, from B = {width} m, but {wider} m does not.",
                    width=f"{b[meets][0]:.4g}",
                    wider=f"{b[last]:.4g}",
                )
            )
    elif b.size:
        notes.append(
            translated("The widest base, B = {width} m, has {value}.", width=f"{b[-1]:.4g}", value=f"{y[-1]:.3g}")
        )
        if meets.any():
            notes.append(translated("Narrower bases meet it, from B = {width} m.", width=f"{b[meets][0]:.4g}"))
    return _LeastWidth(width, outcome, not rises, " ".join(notes))


def _interpolated_width(b: Array, y: Array, target: float) -> float:
    """Width at which a line through two values, the second at most the target, reaches it."""
    if y[1] > 0.0:
        y, target = np.log(y), math.log(target)
    return float(b[0] + (b[1] - b[0]) * (y[0] - target) / (y[0] - y[1]))
