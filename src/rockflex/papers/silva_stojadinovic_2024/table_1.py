"""Table 1: the six prototypes of five stories. Period and aspect ratio are input; the other values follow."""

from collections.abc import Mapping

from rockflex.papers.silva_stojadinovic_2024._number import compared
from rockflex.papers.silva_stojadinovic_2024._records import Records
from rockflex.papers.silva_stojadinovic_2024._structures import STRUCTURES, frame_of
from rockflex.report import Number, Result

TITLE = "Parameters of the six 5-story prototypes"
SHEAR, FLEXURE = (tuple(name for name, row in STRUCTURES.items() if row[2] == b) for b in ("shear", "flexure"))
MASSES = {SHEAR: ("0.88", "0.09", "0.02", "0.008", "0.002"), FLEXURE: ("0.68", "0.21", "0.07", "0.03", "0.01")}
HEIGHTS = {SHEAR: ("0.70", "−0.24", "0.15", "−0.12", "0.10"), FLEXURE: ("0.79", "0.23", "0.14", "0.10", "0.09")}
PRINTED: dict[str, dict[tuple[str, ...], str]] = {
    "I_θ/(m*_1 h*_1²)": {("#1", "#3"): "1.03", ("#2", "#4"): "1.05", ("#5",): "1.07", ("#6",): "1.10"},
    "m*_1 h*_1/L_0^r": {SHEAR: "1.03", FLEXURE: "0.90"},
    **{f"m*_{n}/(5 m_i)": {names: row[n - 1] for names, row in MASSES.items()} for n in range(1, 6)},
    **{f"h*_{n}/h_5": {names: row[n - 1] for names, row in HEIGHTS.items()} for n in range(1, 6)},
}
"""Printed values and the structures that share them, because the shapes do not depend on period or aspect ratio."""


def reproduce(_: Records) -> Result:
    """Compute the modal properties of every structure."""
    ours = {name: _values(name) for name in STRUCTURES}
    numbers = [
        _farthest(quantity, text, {name: ours[name][quantity] for name in names})
        for quantity, row in PRINTED.items()
        for names, text in row.items()
    ]
    note = (
        "T_1 and h*_1/B are input, so they are not among the numbers. A value that the table repeats, because it does "
        "not depend on them, is one number; ours is the value of the structure that differs most from it."
    )
    return Result("table-1", TITLE, numbers, note=note)


def _values(name: str) -> dict[str, float]:
    """Return the quantities of the table for a structure."""
    frame = frame_of(name)
    p = frame.rocking()
    mass, height = p.effective_mass.tolist(), p.effective_height.tolist()
    lever = mass[0] * height[0]
    mass_above, top = frame.n_stories * frame.story_mass, frame.n_stories * frame.story_height
    found = {"I_θ/(m*_1 h*_1²)": p.i_theta / (lever * height[0]), "m*_1 h*_1/L_0^r": lever / p.l0r}
    for n, (its_mass, its_height) in enumerate(zip(mass, height, strict=True), 1):
        found |= {f"m*_{n}/(5 m_i)": its_mass / mass_above, f"h*_{n}/h_5": its_height / top}
    return found


def _farthest(quantity: str, printed: str, values: Mapping[str, float]) -> Number:
    """Compare the value that differs most from the printed one."""
    place = f"Table 1, {', '.join(values)}"
    lines = [compared(quantity, place, printed, value) for value in values.values()]
    return max(lines, key=lambda line: abs(line.difference or 0.0))
