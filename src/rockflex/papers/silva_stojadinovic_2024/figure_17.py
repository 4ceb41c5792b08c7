"""Figure 17: structure #1, which rocks and barely yields, and the same structure on a fixed base."""

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024._number import compared, stated
from rockflex.papers.silva_stojadinovic_2024._records import Records
from rockflex.papers.silva_stojadinovic_2024._yielding import SAME, STRONG, WEAK, largest_yielding, run
from rockflex.report import Result

TITLE = "Structure #1 with a yield displacement of 0.075 m, rocking and fixed, El Centro"
PLACE = "Section 4.2"


def reproduce(records: Records) -> Result:
    """Run both structures."""
    fixed, rocking = run(records, "1DOF-fixed-BW", STRONG), run(records, "2DOF-S-BW", STRONG)
    weak = run(records, "2DOF-S-BW", WEAK)
    top = rocking.max_top_displacement
    numbers = (
        compared("θ_max, rocking", PLACE, "≈ 0.01", rocking.max_rotation, "rad"),
        compared("u_top,max, rocking", PLACE, "≈ 0.05", top, "m"),
        compared("u_top,max, fixed over rocking", PLACE, "approximately 2", fixed.max_top_displacement / top),
        stated("largest |z|, rocking", PLACE, "barely yields", largest_yielding(rocking), "< 0.7",
               note="0.7 is our reading"),
        stated("largest |z|, fixed", PLACE, "the fixed base yields", largest_yielding(fixed), "> 0.99"),
        stated(
            "u_top,max of Fig. 16's weak structure over Fig. 17's", PLACE, "approximately the same",
            weak.max_top_displacement / top, SAME, note=f"with D_1,y = {WEAK} m for Fig. 16; 1.1 is our interpretation",
        ),
    )  # fmt: skip
    names = [f"fixed base, $D_y$ = {STRONG} m", f"2DOF-S-BW, $D_y$ = {STRONG} m"]
    return Result("figure-17", TITLE, numbers, {"figure-17": lambda: rf.plot_yielding([fixed, rocking], names)})
