"""Probability or annual rate at which each design exceeds a limit."""

from typing import TYPE_CHECKING, Any

from rockflex._errors import InputError
from rockflex.fragility import HazardCurve
from rockflex.study.design._fit import Question, check_confidence, check_damping, judged
from rockflex.study.design._limits import check_limit, check_same_for_all

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
        A rotation in rad; a multiple of 0.7 atan(B/h*_1) of each design, ``"nominal"`` or such as ``"0.5 nominal"``; or
        ``"overturning"``.
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
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> pulses = {"a": rf.ricker_pulse(3.0, 0.6), "b": rf.ricker_pulse(3.0, 0.9)}
    >>> runs = rf.run_design(frame, pulses, half_widths=[1.0, 1.5], models="2DOF-S", scales=[0.5, 1.0, 2.0, 4.0])
    >>> table = rf.design_table(runs, 0.005, at=0.5, confidence=None)
    >>> table["half_width"].tolist()
    [1.0, 1.5]
    >>> table["probability"].round(3).tolist()
    [1.0, 0.999]
    """
    check_same_for_all(measure)
    lacking = [name for name in ("structure", "model", *FACTS, *RESULTS, measure) if name not in runs]
    if lacking or not len(runs):
        lacks = f"lacks {', '.join(lacking)}" if lacking else "has no rows"
        raise InputError(f"The table {lacks}. Give what run_design returned.")
    question = Question.of(at, hazard)
    check_damping(hazard, runs, measure)
    if confidence is not None:
        check_confidence(confidence)
    check_limit(limit)
    import pandas as pd

    rows: list[dict[str, Any]] = []
    for (_, model), group in runs.groupby(["structure", "model"], observed=True, sort=False):
        first = group.iloc[0]
        facts = {"model": str(model), **{name: first[name] for name in FACTS}}
        rows.append(facts | judged(group, limit, measure, question, confidence))
    models, tendons = (list(dict.fromkeys(row[name] for row in rows)) for name in ("model", "tendon"))
    rows.sort(key=lambda row: (models.index(row["model"]), tendons.index(row["tendon"]), row["half_width"]))
    return pd.DataFrame(rows)
