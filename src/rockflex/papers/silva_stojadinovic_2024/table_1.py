"""Table 1: the six prototypes of five stories. Period and aspect ratio are given to the frames, the rest follows."""

from rockflex.papers.silva_stojadinovic_2024._records import Records
from rockflex.papers.silva_stojadinovic_2024._result import Result
from rockflex.papers.silva_stojadinovic_2024._structures import STRUCTURES, frame_of
from rockflex.papers.silva_stojadinovic_2024._verdict import Number, compared

__all__ = ["TITLE", "reproduce"]

TITLE = "Parameters of the six 5-story prototypes"
INERTIA = {"#1": "1.03", "#2": "1.05", "#3": "1.03", "#4": "1.05", "#5": "1.07", "#6": "1.10"}
MOMENT = {"shear": "1.03", "flexure": "0.90"}
MASSES = {"shear": ("0.88", "0.09", "0.02", "0.008", "0.002"), "flexure": ("0.68", "0.21", "0.07", "0.03", "0.01")}
HEIGHTS = {"shear": ("0.70", "−0.24", "0.15", "−0.12", "0.10"), "flexure": ("0.79", "0.23", "0.14", "0.10", "0.09")}


def reproduce(_: Records) -> Result:
    """Compute the modal properties of every structure."""
    numbers = [number for name in STRUCTURES for number in _row(name)]
    note = "T_1 and h*_1/B are given to the frames and so are not among the numbers."
    return Result("table-1", TITLE, tuple(numbers), note=note)


def _row(name: str) -> list[Number]:
    frame, behaviour, place = frame_of(name), STRUCTURES[name][2], f"Table 1, {name}"
    p = frame.rocking()
    mass, height = p.effective_mass, p.effective_height
    lever = mass[0] * height[0]
    mass_above, top = frame.n_stories * frame.story_mass, frame.n_stories * frame.story_height
    return [
        compared(f"{name}: I_θ/(m*_1 h*_1²)", place, INERTIA[name], p.i_theta / (lever * height[0])),
        compared(f"{name}: m*_1 h*_1/L_0^r", place, MOMENT[behaviour], lever / p.l0r),
        *(
            compared(f"{name}: m*_{n}/(5 m_i)", place, printed, value / mass_above)
            for n, (printed, value) in enumerate(zip(MASSES[behaviour], mass, strict=True), 1)
        ),
        *(
            compared(f"{name}: h*_{n}/h_5", place, printed, value / top)
            for n, (printed, value) in enumerate(zip(HEIGHTS[behaviour], height, strict=True), 1)
        ),
    ]
