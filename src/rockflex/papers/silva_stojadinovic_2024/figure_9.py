"""Figure 9: MDOF-S over 2DOF-S, for a thousand random prototypes."""

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024._population import counts, intervals, population, statistics
from rockflex.papers.silva_stojadinovic_2024._records import Records
from rockflex.papers.silva_stojadinovic_2024._result import Result
from rockflex.papers.silva_stojadinovic_2024._verdict import Number, Verdict, compared, stated, statistic

__all__ = ["TITLE", "reproduce"]

TITLE = "Agreement of 2DOF-S with MDOF-S"
PLACE = "Section 3.3"
OWN = "hangs on how strong the records are"


def reproduce(records: Records) -> Result:
    """Compare the models pair by pair."""
    pairs = population(records)
    numbers = (*_outcomes(records), *_agreement(records), *_discrepancies(records))
    note = (
        "A thousand pairs; what overturns with either model is in no R² and no slope. Intervals are over resampled "
        "recordings, with all pairs that drew them."
    )
    return Result("figure-9", TITLE, numbers, {"figure-9": lambda: rf.plot_agreement(pairs)}, note)


def _outcomes(records: Records) -> list[Number]:
    pairs = population(records)
    mdof, simple = pairs["status_mdof"], pairs["status_2dof"]
    resting = mdof == "no_uplift"
    found = counts(
        records,
        {
            "306": resting,
            "693": mdof == "rocking",
            "1": mdof == "overturned",
            "10": pairs["nominal_overturning_mdof"].astype(bool),
            "6": pairs["nominal_overturning_2dof"].astype(bool),
            "2": resting & (simple != "no_uplift"),
        },
    )
    names = {
        "306": "pairs in which MDOF-S does not uplift", "693": "pairs in which MDOF-S rocks and stands",
        "1": "pairs in which MDOF-S overturns", "10": "pairs in which MDOF-S passes 0.7 atan(B/h*_1)",
        "6": "pairs in which 2DOF-S passes 0.7 atan(B/h*_1)",
        "2": "pairs in which 2DOF-S uplifts and MDOF-S does not",
    }  # fmt: skip
    lines = [statistic(names[n], PLACE, n, *found[n], note=OWN if n != "2" else "") for n in names]
    largest = float(pairs.loc[resting, "max_rotation_2dof"].max()) if resting.any() else float("nan")
    lines.append(
        compared(
            "θ_max of 2DOF-S where MDOF-S does not uplift, largest", PLACE, "< 5", 1e5 * largest, "10⁻⁵ rad",
            ground=Verdict.OTHER_RECORDS,
        )
    )  # fmt: skip
    return lines


def _agreement(records: Records) -> list[Number]:
    found = intervals(records)
    everywhere = "Abstract, Sections 3.3 and 5"
    rows = (
        ("R² of u_top,max, no uplift", PLACE, "0.99", ("r2", "no_uplift", "top_displacement", "all")),
        ("R² of u_top,max, rocking", everywhere, "0.99", ("r2", "rocking", "top_displacement", "all")),
        ("R² of θ_max, rocking", everywhere, "0.90", ("r2", "rocking", "rotation", "all")),
        ("c_1 of u_top,max, shear", PLACE, "0.97", ("slope", "rocking", "top_displacement", "shear")),
        ("c_1 of u_top,max, flexure", PLACE, "1.03", ("slope", "rocking", "top_displacement", "flexure")),
    )
    return [statistic(name, place, printed, *found[key]) for name, place, printed, key in rows]


def _discrepancies(records: Records) -> list[Number]:
    pairs, ground = population(records), Verdict.OTHER_RECORDS
    resting = pairs[pairs["status_mdof"] == "no_uplift"]
    miss = (resting["max_top_displacement_mdof"] - resting["max_top_displacement_2dof"]).abs()
    worst = resting.loc[miss.sort_values(ascending=False).index[:5]]
    tall = resting.sort_values("max_top_displacement_mdof", ascending=False).head(5)
    outliers = statistics(records).outliers
    outliers = outliers[outliers["share"].notna()].head(5)
    return [
        stated(
            "stories of the five largest differences of u_top,max, no uplift, least", PLACE, "more than 10 stories",
            float(worst["n_stories"].min()), "> 10", ground=ground,
        ),
        stated(
            "h*_1/B of the five largest u_top,max, no uplift, median", PLACE, "aspect ratios 5 and 6 displace most",
            float(tall["aspect_ratio"].median()), "≤ 6", ground=ground,
        ),
        stated(
            "h*_1/B of the five largest differences of θ_max, median", PLACE, "outliers have high aspect ratios",
            float(outliers["aspect_ratio"].median()), "> 7.5", ground=ground, note="7.5 is the middle of what is drawn",
        ),
        stated(
            "stories of the five largest differences of θ_max, median", PLACE, "outliers have few stories",
            float(outliers["n_stories"].median()),
            "< 8.5", ground=ground, note="8.5 is the middle of what is drawn",
        ),
        stated(
            "T_1 of the five largest differences of θ_max, median, over that of all pairs", PLACE,
            "outliers have low periods",
            float(outliers["period"].median() / pairs["period"].median()), "< 1", ground=ground,
        ),
    ]  # fmt: skip
