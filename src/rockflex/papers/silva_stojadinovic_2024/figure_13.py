"""Figure 13: 2DOF-S combined with the second mode on a fixed base."""

from functools import partial

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024._number import Interval, statistic, tendency
from rockflex.papers.silva_stojadinovic_2024._pool import DRAWS, PAIRS, intervals, population
from rockflex.papers.silva_stojadinovic_2024._records import Records
from rockflex.papers.silva_stojadinovic_2024._weaker import under_weaker
from rockflex.report import Result

TITLE = "Modal combination with the second mode"
PLACE = "Section 3.4"
PRINTED = {
    "r2, top_displacement, SRSS": ("R² of u_top,max, SRSS", "0.99"),
    "r2, base_shear, SRSS": ("R² of V_b,max, SRSS", "0.55"),
    "r2, base_shear, 2DOF-S": ("R² of V_b,max, 2DOF-S", "0.41"),
    "r2, base_moment, SRSS": ("R² of M_b,max, SRSS", "0.93"),
    "r2, base_moment, 2DOF-S": ("R² of M_b,max, 2DOF-S", "0.93"),
}
"""The value of u_top,max for 2DOF-S is a number of Figure 9."""

STATED = {
    "slope, second_displacement, S_d(ω_2)": ("D_2,max over S_d(ω_2), slope", "underestimated by the fixed base", "> 1"),
    "slope, base_shear, SRSS": ("V_b,max over SRSS, slope", "base shear generally underestimated", "> 1"),
    "slope, base_moment, SRSS": ("M_b,max over SRSS, slope", "slight overestimation of the base moment", "< 1"),
    "gain, base_shear": ("gain of R² of V_b,max by SRSS", "significantly improved", "> 0.00"),
    "gain, base_moment": ("gain of R² of M_b,max by SRSS", "2DOF-S alone is slightly worse", "> 0.00"),
    "gain, top_displacement": ("gain of R² of u_top,max by SRSS", "2DOF-S alone is slightly worse", "> 0.00"),
}


def reproduce(records: Records) -> Result:
    """Compare the estimates with the peaks of MDOF-S."""
    found, pairs = intervals(records), population(records)
    slope = found["slope, top_displacement, SRSS"]
    numbers = (
        *(statistic(name, PLACE, text, found[key]) for key, (name, text) in PRINTED.items()),
        *(tendency(name, PLACE, words, found[key], bound) for key, (name, words, bound) in STATED.items()),
        tendency(
            "u_top,max over SRSS, slope less 1", PLACE, "no systematic trend", _size(slope), "< 0.02",
            note="2 % is our reading; in magnitude",
        ),
    )  # fmt: skip
    note = (
        "R² refers to the line of equality, as in the paper; the blue line is y = c_1 x. Our value is the median, with "
        f"the 90 % interval, of {DRAWS} draws of a thousand from {records.seeds * PAIRS} pairs, as for Figure 9."
    )
    return Result(
        "figure-13", TITLE, numbers, {"figure-13": lambda: rf.plot_modal_combination(pairs)}, note,
        remarking=(partial(under_weaker, records, PRINTED),),
    )  # fmt: skip


def _size(slope: Interval) -> Interval:
    """Return the magnitude of a slope minus 1."""
    estimate, *ends = (value - 1.0 for value in slope)
    low, high = sorted(map(abs, ends))
    return Interval(abs(estimate), 0.0 if min(ends) < 0.0 < max(ends) else low, high)
