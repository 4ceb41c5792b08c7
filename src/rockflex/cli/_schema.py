"""The structure file: what may stand in it, and what is said of what may not."""

import reprlib
from difflib import get_close_matches
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

__all__ = [
    "TABLES",
    "BoucWenTable",
    "FrameTable",
    "LumpedTable",
    "PropertiesTable",
    "StructureFile",
    "Table",
    "problems",
]

Vector = list[float]
Matrix = list[list[float]]


class Table(BaseModel):
    """A table of a structure file: known keys only, and no silent conversion."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


class FrameTable(Table):
    """The arguments of `Frame`."""

    n_stories: int = Field(description="the number of stories, a whole number")
    story_height: float = Field(description="the height of a story, a number in m")
    story_mass: float = Field(description="the mass of each floor, a number in kg")
    base_mass: float = Field(description="the mass of the base, a number in kg")
    stiffness_ratio: float = Field(description="the ratio of beam to column stiffness, a number from 0 to inf")
    period: float = Field(description="the first period on a fixed base, a number in s")
    aspect_ratio: float = Field(description="h*_1/B, a number")
    damping_ratio: float = Field(description="the fraction of critical damping, a number such as 0.02")


class LumpedTable(Table):
    """The arguments of `LumpedStructure`."""

    masses: Vector | Matrix = Field(description="a list of masses in kg, from the lowest up, or the mass matrix")
    stiffness: Matrix = Field(description="the stiffness matrix in N/m, a list of rows")
    heights: Vector = Field(description="a list of the heights of the masses above the base in m, from the lowest up")
    base_mass: float = Field(description="the mass of the base, a number in kg")
    half_width: float = Field(description="half the width of the base, a number in m")
    damping_ratio: float | Vector = Field(description="the fraction of critical damping, a number or one for each mode")


class PropertiesTable(Table):
    """The arguments of `RockingProperties`, but for its floors."""

    omega: Vector = Field(description="a list of circular frequencies in rad/s, one a mode")
    effective_mass: Vector = Field(description="a list of effective masses m*_n in kg")
    effective_height: Vector = Field(description="a list of effective heights h*_n in m")
    top_ordinate: Vector = Field(description="a list of the top's displacement for a unit of each mode")
    i_theta: float = Field(description="the moment of inertia about a pivot, a number in kg m²")
    l0r: float = Field(description="the sum of m_i h_i, a number in kg m")
    m_tot: float = Field(description="the total mass with the base, a number in kg")
    half_width: float = Field(description="half the width of the base, a number in m")
    zeta: float | Vector = Field(description="the fraction of critical damping, a number or one for each mode")
    translational_inertia: float | None = Field(
        None, description="the sum of m_i h_i² (default: i_theta - m_tot half_width²), a number in kg m²"
    )


class BoucWenTable(Table):
    """The arguments of `BoucWen`."""

    yield_displacement: float = Field(description="D_y of the first mode, a number in m")
    post_yield_ratio: float | None = Field(None, description="stiffness after yielding over that before, a number")
    gamma: float | None = Field(None, description="γ of the hysteresis, a number")
    beta: float | None = Field(None, description="β of the hysteresis, a number")
    exponent: float | None = Field(None, description="n of the hysteresis, a number of at least 1")


class StructureFile(Table):
    """A structure file: one structure, perhaps a name, and what `rockflex run` is to assume of it."""

    name: str = Field("", description="a name, in quotes")
    impact: Literal["simplified", "complete", "restitution"] | None = Field(
        None, description='"simplified", "complete" or "restitution"'
    )
    restitution: float | None = Field(None, description="a number from 0 to 1")
    bouc_wen: BoucWenTable | None = Field(None, description="a table")
    frame: FrameTable | None = Field(None, description="a table")
    lumped: LumpedTable | None = Field(None, description="a table")
    properties: PropertiesTable | None = Field(None, description="a table")


TABLES: dict[str, type[Table]] = {
    "frame": FrameTable,
    "lumped": LumpedTable,
    "properties": PropertiesTable,
    "bouc_wen": BoucWenTable,
}


def problems(error: ValidationError, content: dict[str, Any]) -> list[str]:
    """Say of each key at fault what is expected; the branches of a union count once."""
    sentences: dict[tuple[str, ...], str] = {}
    for problem in error.errors():
        place = [str(part) for part in problem["loc"]]
        in_table = len(place) > 1 and place[0] in TABLES
        path = tuple(place[:2] if in_table else place[:1])
        model = TABLES[place[0]] if in_table else StructureFile
        key = path[-1]
        label = f"[{path[0]}] {key}" if in_table else key
        if problem["type"] == "extra_forbidden":
            near = get_close_matches(key, model.model_fields, n=1)
            hint = f" Did you mean {near[0]}?" if near else ""
            sentences[path] = f"{label} is not known; there are {', '.join(model.model_fields)}.{hint}"
            continue
        expected = model.model_fields[key].description
        value = content[path[0]][key] if in_table and key in content[path[0]] else content.get(key)
        if problem["type"] == "missing":
            sentences[path] = f"{label} is missing: {expected}."
        else:
            sentences[path] = f"{label} must be {expected}, but {reprlib.repr(value)} was given."
    return list(sentences.values())
