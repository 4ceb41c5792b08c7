"""Figure 6: clouds of the rotation."""

from functools import partial

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024._cloud import cloud, differences, percent, places
from rockflex.papers.silva_stojadinovic_2024._number import statistic
from rockflex.papers.silva_stojadinovic_2024._records import Records
from rockflex.papers.silva_stojadinovic_2024._verdict import Kind
from rockflex.report import Remark, Result

TITLE = "Clouds of the rotation of the runs that rock and stand"
PLACE = "Section 3.2, PGV = 0.4 m/s"
QUANTITY = "max_rotation"


def reproduce(records: Records) -> Result:
    """Run the cloud, and compare the models' regressions."""
    runs = cloud(records)
    found = differences(records, QUANTITY)
    largest = {part: str(place) for part, place in places(records, QUANTITY).idxmax().items()}
    numbers = (
        statistic(
            "largest difference of the medians of θ_max", PLACE, "0.002", found["median, largest"], "rad",
            note=largest["median"],
        ),
        statistic(
            "largest difference of the medians of θ_max over the median of MDOF-S", PLACE, "15",
            percent(found["median, of the largest"]), "%", note=largest["median"],
        ),
        statistic(
            "largest difference of the 84 % quantiles of θ_max", PLACE, "0.005", found["84 % quantile, largest"], "rad",
            note=largest["quantile"],
        ),
        statistic(
            "largest difference of the 84 % quantiles of θ_max over that of MDOF-S", PLACE, "12",
            percent(found["84 % quantile, of the largest"]), "%", note=largest["quantile"],
        ),
    )  # fmt: skip
    note = (
        "Differences of 2DOF-C or 2DOF-S from MDOF-S, for the structure and model where they are largest in rad. We "
        "interpret the text so: 0.002 rad are 15 % of a median of 0.013 rad, where the differences are not "
        "relatively largest. Intervals are over resampled recordings, with all of their runs."
    )
    figures = {"figure-6": lambda: rf.plot_clouds(runs, QUANTITY)}
    return Result("figure-6", TITLE, numbers, figures, note, remarking=(partial(_readings, records),))


def _readings(records: Records) -> Remark:
    """Show the differences where they are largest, absolutely and relatively."""
    at = places(records, QUANTITY)
    largest = {part: str(place) for part, place in at.idxmax().items()}
    reasons = {
        "median": "largest of the medians, in rad",
        "quantile": "largest of the 84 % quantiles, in rad",
        "median_relative": "relatively largest of the medians",
        "quantile_relative": "relatively largest of the 84 % quantiles",
    }
    rows: list[tuple[str, ...]] = [("the paper", "", "0.002 rad (15 %)", "0.005 rad (12 %)")]
    for reason, words in reasons.items():
        row = at.loc[largest[reason]]
        cells = [f"{row[part]:.5f} rad ({100.0 * row[part + '_relative']:.1f} %)" for part in ("median", "quantile")]
        rows.append((largest[reason], words, *cells))
    return Remark(
        Kind.BESIDE,
        "Which difference is the largest",
        "One line for each structure and model. The last two lines interpret the text by the largest relative "
        "difference.",
        ("structure and model", "where the difference is", "medians", "84 % quantiles"),
        rows,
    )
