"""The friction that keeps the prototypes of Table 1 from sliding, as the end of Section 3.2 has it."""

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024._records import Records
from rockflex.papers.silva_stojadinovic_2024._result import Result
from rockflex.papers.silva_stojadinovic_2024._structures import STRUCTURES, frame_of
from rockflex.papers.silva_stojadinovic_2024._verdict import Verdict, stated

__all__ = ["TITLE", "reproduce"]

TITLE = "Friction that keeps the prototypes from sliding"
EVERY = 3  # every third record: to find the friction of a run takes its history


def reproduce(records: Records) -> Result:
    """Run MDOF-S of every structure under every third record, and compare medians of the required friction."""
    motions = records.suite[::EVERY]
    runs = rf.run_cloud({name: frame_of(name) for name in STRUCTURES}, motions, "MDOF-S", friction=True)
    runs = runs[runs["status"] == "rocking"]
    by_structure = runs.groupby("structure", observed=True)["required_friction"].median()
    median = {name: float(by_structure.get(name, float("nan"))) for name in STRUCTURES}
    place, ground = "Section 3.2", Verdict.OTHER_RECORDS

    def ratio(pairs: dict[str, str]) -> float:
        return min(median[one] / median[other] for one, other in pairs.items())

    name = "median of the required friction, least ratio:"
    numbers = (
        stated(
            f"{name} h*_1/B = 5 over 10", place, "lower aspect ratios are more prone to sliding",
            ratio({"#5": "#1", "#6": "#2"}), "> 1", ground=ground,
        ),
        stated(
            f"{name} T_1 = 0.5 s over 1 s", place, "shorter periods are more prone to sliding",
            ratio({"#3": "#1", "#4": "#2"}), "> 1", ground=ground,
        ),
        stated(
            f"{name} shear over flexure", place, "shear-dominant buildings are more prone to sliding",
            ratio({"#1": "#2", "#3": "#4", "#5": "#6"}), "> 1", ground=ground,
        ),
        stated(
            "runs that need more than 1.0", place, "cases higher than 1.0",
            float((runs["required_friction"] > 1.0).sum()), "> 0", ground=ground,
        ),
    )  # fmt: skip
    note = f"MDOF-S, every third record unscaled ({len(motions)} records), runs that rock and stand; Eqs. 20-22."
    return Result("sliding", TITLE, numbers, note=note)
