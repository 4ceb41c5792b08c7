"""Figure 6: clouds of the rotation."""

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024._cloud import cloud, differences, percent
from rockflex.papers.silva_stojadinovic_2024._records import Records
from rockflex.papers.silva_stojadinovic_2024._result import Result
from rockflex.papers.silva_stojadinovic_2024._verdict import statistic

__all__ = ["TITLE", "reproduce"]

TITLE = "Clouds of the rotation of the runs that rock and stand"
PLACE = "Section 3.2, PGV = 0.4 m/s"


def reproduce(records: Records) -> Result:
    """Run the cloud, and compare the models' regressions."""
    runs = cloud(records)
    found = differences(records, "max_rotation")
    numbers = (
        statistic("difference of the medians of θ_max", PLACE, "0.002", *found.median, unit="rad"),
        statistic(
            "relative difference of the medians of θ_max", PLACE, "15", *percent(found.median_relative), unit="%"
        ),
        statistic("difference of the 84 % quantiles of θ_max", PLACE, "0.005", *found.quantile, unit="rad"),
        statistic(
            "relative difference of the 84 % quantiles of θ_max",
            PLACE,
            "12",
            *percent(found.quantile_relative),
            unit="%",
        ),
    )
    note = (
        "Differences of 2DOF-C or 2DOF-S from MDOF-S, of the structure and model where they are relatively largest: so "
        "the text reads, which has #3 for Fig. 7. Records are resampled with all that belongs to them."
    )
    return Result("figure-6", TITLE, numbers, {"figure-6": lambda: rf.plot_clouds(runs, "max_rotation")}, note)
