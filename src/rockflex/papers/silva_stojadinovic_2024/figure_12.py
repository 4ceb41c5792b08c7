"""Figure 12: the frequency equation of two 15-story buildings at h*_1/B = 10."""

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024._number import stated
from rockflex.papers.silva_stojadinovic_2024._records import Records
from rockflex.papers.silva_stojadinovic_2024._structures import BEHAVIOURS, MARK, tall_frame
from rockflex.papers.silva_stojadinovic_2024._uplifted import errors
from rockflex.report import Result

TITLE = "Zeros of the frequency equation at h*_1/B = 10"
STATEMENTS = (
    ("shear", "2DOF-S", 1, "poor", "> 50"),
    ("shear", "3DOF-S", 1, "quite close to MDOF-S", "< 1"),
    ("shear", "3DOF-S", 2, "quite inaccurate", "> 50"),
    ("flexure", "3DOF-S", 1, "essentially the same as MDOF-S", "< 5"),
    ("flexure", "3DOF-S", 2, "essentially the same as MDOF-S", "< 5"),
    ("flexure", "2DOF-S", 1, "quite good; likely satisfactory below 10", "< 20"),
)


def reproduce(_: Records) -> Result:
    """Compare the zeros with those of MDOF-S."""
    numbers = tuple(
        stated(
            f"{behaviour}: error of ω*_{mode} of {model}", "Section 3.4", words, errors(behaviour, model, mode, MARK),
            criterion, "%",
        )
        for behaviour, model, mode, words, criterion in STATEMENTS
    )  # fmt: skip
    frames = {behaviour: tall_frame(behaviour) for behaviour in BEHAVIOURS}
    note = "Errors relative to MDOF-S. The text uses words; the limits in per cent are our interpretation."
    return Result("figure-12", TITLE, numbers, {"figure-12": lambda: rf.plot_frequency_equation(frames)}, note)
