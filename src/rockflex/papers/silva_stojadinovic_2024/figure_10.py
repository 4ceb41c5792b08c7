"""Figure 10: uplifted over fixed-base frequencies of two 15-story buildings, over the aspect ratio."""

import numpy as np

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024._records import Records
from rockflex.papers.silva_stojadinovic_2024._result import Result
from rockflex.papers.silva_stojadinovic_2024._structures import BEHAVIOURS, MARK, tall_frame
from rockflex.papers.silva_stojadinovic_2024._uplifted import errors, ratio
from rockflex.papers.silva_stojadinovic_2024._verdict import Number, stated

__all__ = ["TITLE", "reproduce"]

TITLE = "Uplifted over fixed-base frequencies"
PLACE = "Section 3.4"
WIDE, NARROW = 0.1, 1000.0  # h*_1/B of the ends of the figure
SHOWN: list[float] = np.geomspace(WIDE, NARROW, 201).tolist()
MODES = {"2DOF-S": (1,), "3DOF-S": (1, 2), "MDOF-S": (1, 2)}
NOTE = (
    "15 stories of 3 m and 40 t, T_1 = 1 s, a base of 40 t: the paper gives neither period nor base mass. The pinned "
    "beam has its mass and stiffness spread evenly and feels no gravity."
)


def reproduce(_: Records) -> Result:
    """Compare the models at the ends of the figure and at its gray line."""

    def figure() -> object:
        tables = {b: rf.frequency_ratios(tall_frame(b), SHOWN) for b in BEHAVIOURS}
        limits = {"shear": rf.pinned_beam("shear"), "flexure": rf.pinned_beam("flexure")}
        return rf.plot_frequency_ratios(tables, limits, mark=MARK)

    numbers = [number for behaviour in BEHAVIOURS for number in _of(behaviour)]
    return Result("figure-10", TITLE, tuple(numbers), {"figure-10": figure}, NOTE)


def _of(behaviour: str) -> list[Number]:
    beam = rf.pinned_beam("shear" if behaviour == "shear" else "flexure").ratio
    wide = max(abs(ratio(behaviour, model, n, WIDE) - 1.0) for model, modes in MODES.items() for n in modes)
    growth = min(
        errors(behaviour, model, n, MARK) - errors(behaviour, model, n, 1.0)
        for model, modes in MODES.items() if model != "MDOF-S" for n in modes
    )  # fmt: skip
    bounds = [
        stated(
            f"{behaviour}: ω*_n/ω_n of {model} over the pinned beam's, largest, h*_1/B = {NARROW:g}", PLACE,
            f"the pinned beam bounds {model} from above",
            max(ratio(behaviour, model, n, NARROW) / float(beam[n - 1]) for n in modes), "≤ 1",
            note=_why(behaviour, model),
        )
        for model, modes in MODES.items()
    ]  # fmt: skip
    limit = 10.0 if behaviour == "flexure" else 5.0
    first, second = (ratio(behaviour, "MDOF-S", n, MARK) - 1.0 for n in (1, 2))
    return [
        stated(
            f"{behaviour}: ω*_n/ω_n less 1, largest of all models, h*_1/B = {WIDE:g}", PLACE,
            "about 1 for low aspect ratios", wide, "< 0.01",
        ),
        stated(
            f"{behaviour}: growth of the error of 2DOF-S and 3DOF-S from h*_1/B = 1 to 10, least", PLACE,
            "degrades with the aspect ratio", growth, "> 0", "%",
        ),
        stated(
            f"{behaviour}: rise of ω_1 over that of ω_2, MDOF-S, h*_1/B = {MARK:g}", PLACE,
            "uplift affects the first mode much more", first / second, "> 1",
        ),
        *bounds,
        stated(
            f"{behaviour}: error of ω*_1 of 2DOF-S, h*_1/B = {limit:g}", PLACE,
            f"likely satisfactory below {limit:g}", errors(behaviour, "2DOF-S", 1, limit), "< 20", "%",
            note="20 % is our reading of satisfactory",
        ),
    ]  # fmt: skip


def _why(behaviour: str, model: str) -> str:
    if model != "MDOF-S":
        return "the highest mode kept stands for all above it, and is too stiff"
    return "masses lumped at 15 floors are not spread evenly; the excess falls with more floors" * (
        behaviour == "flexure"
    )
