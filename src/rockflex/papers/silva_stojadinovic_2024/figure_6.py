"""Figure 6: clouds of the rotation."""

from functools import partial

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024._cloud import cloud, largest, places
from rockflex.papers.silva_stojadinovic_2024._records import Records
from rockflex.papers.silva_stojadinovic_2024._verdict import Kind
from rockflex.report import Remark, Result

TITLE = "Clouds of the rotation of the runs that rock and stand"
QUANTITY = "max_rotation"
QUANTILES = "largest difference of the 84 % quantiles of θ_max"
ROWS = (
    ("largest difference of the medians of θ_max", "0.002", "rad", "median, largest", "median"),
    (
        "largest difference of the medians of θ_max over the median of MDOF-S", "15", "%", "median, of the largest",
        "median",
    ),
    (QUANTILES, "0.005", "rad", "84 % quantile, largest", "quantile"),
    (f"{QUANTILES} over that of MDOF-S", "12", "%", "84 % quantile, of the largest", "quantile"),
)  # fmt: skip


def reproduce(records: Records) -> Result:
    """Run the cloud, and compare the models' regressions."""
    runs = cloud(records)
    note = (
        "Differences of 2DOF-C or 2DOF-S from MDOF-S, for the structure and model where they are largest in rad. We "
        "interpret the text so: 0.002 rad are 15 % of a median of 0.013 rad, where the differences are not "
        "relatively largest. Intervals are over resampled recordings, with all of their runs."
    )
    figures = {"figure-6": lambda: rf.plot_clouds(runs, QUANTITY)}
    return Result(
        "figure-6", TITLE, largest(records, QUANTITY, ROWS), figures, note, remarking=(partial(_readings, records),)
    )


def _readings(records: Records) -> Remark:
    """Show the differences where they are largest, absolutely and relatively."""
    at = places(records, QUANTITY)
    where = {part: str(place) for part, place in at.idxmax().items()}
    reasons = {
        "median": "largest of the medians, in rad",
        "quantile": "largest of the 84 % quantiles, in rad",
        "median_relative": "relatively largest of the medians",
        "quantile_relative": "relatively largest of the 84 % quantiles",
    }
    rows: list[tuple[str, ...]] = [("the paper", "", "0.002 rad (15 %)", "0.005 rad (12 %)")]
    for reason, words in reasons.items():
        row = at.loc[where[reason]]
        cells = [f"{row[part]:.5f} rad ({100.0 * row[part + '_relative']:.1f} %)" for part in ("median", "quantile")]
        rows.append((where[reason], words, *cells))
    return Remark(
        Kind.BESIDE,
        "Which difference is the largest",
        "One line for each structure and model. The last two lines interpret the text by the largest relative "
        "difference.",
        ("structure and model", "where the difference is", "medians", "84 % quantiles"),
        rows,
    )
