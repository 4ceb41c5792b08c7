"""Figure 9: MDOF-S against 2DOF-S, for a thousand random prototypes."""

from functools import partial

import numpy as np

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024._draws import measure
from rockflex.papers.silva_stojadinovic_2024._number import count_of, statistic, tendency
from rockflex.papers.silva_stojadinovic_2024._pool import DRAWS, PAIRS, intervals, pool, population
from rockflex.papers.silva_stojadinovic_2024._records import Records
from rockflex.papers.silva_stojadinovic_2024._verdict import Kind
from rockflex.papers.silva_stojadinovic_2024._weaker import under_weaker
from rockflex.report import Remark, Result

TITLE = "Agreement of 2DOF-S with MDOF-S"
PLACE = "Section 3.3"
COUNTS = {
    "no uplift": ("pairs in which MDOF-S does not uplift", "306"),
    "rocking": ("pairs in which MDOF-S rocks and stands", "693"),
    "overturned": ("pairs in which MDOF-S overturns", "1"),
    "beyond the limit, MDOF-S": ("pairs in which MDOF-S passes 0.7 atan(B/h*_1)", "10"),
    "beyond the limit, 2DOF-S": ("pairs in which 2DOF-S passes 0.7 atan(B/h*_1)", "6"),
    "2DOF-S alone uplifts": ("pairs in which 2DOF-S uplifts and MDOF-S does not", "2"),
}
AGREEMENT = {
    "r2, no_uplift, top_displacement, all": ("R² of u_top,max, no uplift", PLACE, "0.99"),
    "r2, rocking, top_displacement, all": ("R² of u_top,max, rocking", "Abstract, Sections 3.3, 3.4 and 5", "0.99"),
    "r2, rocking, rotation, all": ("R² of θ_max, rocking", "Abstract, Sections 3.3 and 5", "0.90"),
    "slope, rocking, top_displacement, shear": ("c_1 of u_top,max, shear", PLACE, "0.97"),
    "slope, rocking, top_displacement, flexure": ("c_1 of u_top,max, flexure", PLACE, "1.03"),
}

DISCREPANCIES = {
    "stories, least of the worst": (
        "stories of the five largest differences of u_top,max, no uplift, least", "more than 10 stories", "> 10", "",
    ),
    "aspect ratio of the largest": (
        "h*_1/B of the five largest u_top,max, no uplift, median", "aspect ratios 5 and 6 displace most", "≤ 6", "",
    ),
    "aspect ratio of outliers": (
        "h*_1/B of the five largest differences of θ_max, median", "outliers have high aspect ratios", "> 7.5",
        "7.5 is the middle of what is drawn",
    ),
    "stories of outliers": (
        "stories of the five largest differences of θ_max, median", "outliers have few stories", "< 8.5",
        "8.5 is the middle of what is drawn",
    ),
    "period of outliers": (
        "T_1 of the five largest differences of θ_max, median, over that of all pairs", "outliers have low periods",
        "< 1", "",
    ),
}  # fmt: skip
ROWS = COUNTS | {key: (name, printed) for key, (name, _, printed) in AGREEMENT.items()}


def reproduce(records: Records) -> Result:
    """Compare the models pair by pair."""
    found = intervals(records)
    numbers = [count_of(name, PLACE, n, found[key]) for key, (name, n) in COUNTS.items()]
    numbers.append(
        tendency(
            "θ_max of 2DOF-S where MDOF-S does not uplift, largest", PLACE, "smaller than 5·10⁻⁵",
            found["largest rotation of 2DOF-S"].times(1e5), "< 5", "10⁻⁵ rad",
        )
    )  # fmt: skip
    numbers += [statistic(*row, found[key]) for key, row in AGREEMENT.items()]
    numbers += [
        tendency(name, PLACE, words, found[key], bound, note=note)
        for key, (name, words, bound, note) in DISCREPANCIES.items()
    ]
    note = (
        "A thousand pairs; R² and slopes exclude pairs in which a model overturns. Our value is the median, with the "
        f"90 % interval, of {DRAWS} draws of a thousand from {records.seeds * PAIRS} pairs (seeds {records.seed} to "
        f"{records.seed + records.seeds - 1}). All draws use the same records, so the intervals do not include the "
        "effect of other records. The figure shows the first thousand."
    )
    pairs = population(records)
    return Result(
        "figure-9", TITLE, numbers, {"figure-9": lambda: rf.plot_agreement(pairs)}, note,
        remarking=(partial(_seeds, records), partial(under_weaker, records, ROWS)),
    )  # fmt: skip


def _seeds(records: Records) -> Remark:
    """Show the result of each seed by itself."""
    pairs = pool(records)
    found = [measure(pairs.iloc[i : i + PAIRS].reset_index(drop=True)) for i in range(0, len(pairs), PAIRS)]
    rows: list[tuple[str, ...]] = []
    for key, (name, _, printed) in AGREEMENT.items():
        values = [each[key] for each in found]
        drawn = intervals(records)[key]
        of_seeds = (f"{value:.3f}" for value in (np.min(values), np.median(values), np.max(values)))
        rows.append((name, printed, *of_seeds, f"{drawn.low:.3f} to {drawn.high:.3f}"))
    return Remark(
        Kind.BESIDE,
        f"Each of {len(found)} seeds by itself",
        "How far apart draws of a thousand lie, of which the paper has one. R² of θ_max hangs on a few outliers, which "
        "a draw meets or does not.",
        ("quantity", "paper", "least", "median", "largest", f"90 % of {DRAWS} draws"),
        rows,
    )
