"""Figure 16: structure #1 that yields and barely rocks."""

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024._records import Records
from rockflex.papers.silva_stojadinovic_2024._result import Result
from rockflex.papers.silva_stojadinovic_2024._verdict import compared, stated
from rockflex.papers.silva_stojadinovic_2024._yielding import WEAK, largest_yielding, run

__all__ = ["TITLE", "reproduce"]

TITLE = "An elastic and a weak structure #1 that may rock, El Centro"
PLACE = "Section 4.2"


def reproduce(records: Records) -> Result:
    """Run both."""
    elastic, weak = run(records, "2DOF-S"), run(records, "2DOF-S-BW", WEAK)
    stronger = run(records, "2DOF-S-BW", 0.045)
    note = (
        f"D_1,y = {WEAK} m is assumed. With 0.045 m it is {stronger.max_top_displacement:.3f} m, but θ_max is then "
        f"{stronger.max_rotation / elastic.max_rotation:.2f} of the elastic one"
    )
    numbers = (
        stated(
            "largest |z| of the weak structure", PLACE, "clearly yields", largest_yielding(weak), "> 0.99",
        ),
        stated(
            "θ_max of the weak structure over the elastic one", PLACE, "barely rocks",
            weak.max_rotation / elastic.max_rotation, "< 0.4", note="0.4 is our reading",
        ),
        compared("u_top,max of the weak structure", PLACE, "≈ 0.05", weak.max_top_displacement, "m", note=note),
    )  # fmt: skip
    names = ["2DOF-S", f"2DOF-S-BW, $D_y$ = {WEAK} m"]
    text = (
        "The paper does not give D_1,y of this figure; 0.035 m is one with which the structure yields and barely rocks."
    )
    return Result("figure-16", TITLE, numbers, {"figure-16": lambda: rf.plot_yielding([elastic, weak], names)}, text)
