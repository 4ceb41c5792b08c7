"""Figure 16: structure #1, which yields and barely rocks."""

from functools import partial

import numpy as np

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024._number import compared, stated
from rockflex.papers.silva_stojadinovic_2024._printed import range_of
from rockflex.papers.silva_stojadinovic_2024._records import Records
from rockflex.papers.silva_stojadinovic_2024._verdict import Kind
from rockflex.papers.silva_stojadinovic_2024._yielding import (
    SAME,
    STRONG,
    STRONGER,
    WEAK,
    largest_yielding,
    run,
)
from rockflex.report import Remark, Result

TITLE = "An elastic and a weak structure #1 that may rock, El Centro"
PLACE = "Section 4.2"
YIELDS, BARELY, TOP = "> 0.99", "< 0.4", "≈ 0.05"
TRIED: list[float] = np.linspace(0.02, STRONG, 23).tolist()  # m


def reproduce(records: Records) -> Result:
    """Run the elastic structure, and the weak one with two yield displacements."""
    elastic = run(records, "2DOF-S")
    weak, stronger = (run(records, "2DOF-S-BW", value) for value in (WEAK, STRONGER))
    assumed = f"D_1,y = {WEAK} m is assumed"
    numbers = (
        stated(
            "largest |z| of the weak structure", PLACE, "clearly yields", largest_yielding(weak), YIELDS, note=assumed,
        ),
        stated(
            "θ_max of the weak structure over the elastic one", PLACE, "barely rocks",
            weak.max_rotation / elastic.max_rotation, BARELY, note=f"{assumed}; 0.4 is our reading",
        ),
        compared("u_top,max of the weak structure", PLACE, TOP, weak.max_top_displacement, "m", note=assumed),
    )  # fmt: skip
    names = ["2DOF-S", *(f"2DOF-S-BW, $D_y$ = {value} m" for value in (WEAK, STRONGER))]
    text = (
        f"The paper does not give D_1,y of this figure; with {WEAK} m the structure yields and barely rocks. With "
        f"{STRONGER} m, also shown, it has the printed top displacement, and rocks."
    )
    figures = {"figure-16": lambda: rf.plot_yielding([elastic, weak, stronger], names)}
    return Result("figure-16", TITLE, numbers, figures, text, remarking=(partial(_yield_displacements, records),))


def _yield_displacements(records: Records) -> Remark:
    """Find which of four statements on this figure hold, depending on the yield displacement (not in the paper)."""
    wanted = [range_of(text) for text in (YIELDS, BARELY, TOP, SAME)]
    elastic, strong = run(records, "2DOF-S"), run(records, "2DOF-S-BW", STRONG)

    def judged(value: float) -> list[tuple[float, bool]]:
        weak = run(records, "2DOF-S-BW", value)
        top, rotation = weak.max_top_displacement, weak.max_rotation / elastic.max_rotation
        found = (largest_yielding(weak), rotation, top, top / strong.max_top_displacement)
        return [(ours, ours in each) for ours, each in zip(found, wanted, strict=True)]

    most = max(sum(holds for _, holds in judged(value)) for value in TRIED)
    rows = [
        (f"{value}", *(f"{ours:.3f} ({'yes' if holds else 'no'})" for ours, holds in judged(value)))
        for value in (WEAK, STRONGER)
    ]
    return Remark(
        Kind.AFTERWARDS,
        "The yield displacement of the weak structure",
        f"Four statements of Section 4.2 depend on it. With {len(TRIED)} values from {TRIED[0]:g} to {TRIED[-1]:g} m, "
        f"at most {most} of the four hold.",
        (
            "D_1,y in m",
            f"largest |z| ({YIELDS})",
            f"θ_max over the elastic one ({BARELY})",
            f"u_top,max in m ({TOP})",
            f"u_top,max over Fig. 17's ({SAME})",
        ),
        rows,
    )
