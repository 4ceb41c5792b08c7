"""The tables of a design study in a file."""

from pydantic import Field, ValidationInfo, field_validator

from rockflex.structure.file import Table
from rockflex.study.design.search import Scaling, factors_of

_FACTORS = "a list of factors on the {} of the structure, or a range {{smallest = 0.5, largest = 2.0, count = 4}}"
_SCALING = '"size" (force and stiffness) or "force"'


class TendonLevelTable(Table):
    """The arguments of `TendonLevel`."""

    prestress_ratio: float = Field(0.0, description="the initial force over the weight m_tot g, a number")
    stiffness_ratio: float = Field(0.0, description="EA/L over L_0^r g/B², a number; 1 keeps the moment constant")
    yield_ratio: float | None = Field(None, description="the yield force over the weight m_tot g, a number")
    name: str = Field("", description="a name, in quotes")


class HazardTable(Table):
    """The arguments of `HazardCurve`."""

    im: list[float] = Field(description="a list of levels of the measure, in SI units, rising")
    rate: list[float] = Field(description="a list of annual rates at which they are exceeded, falling")
    damping: float = Field(0.05, description="the damping ratio of a spectral measure, a number")


class CostTable(Table):
    """The arguments of `DesignCost`."""

    half_width: float = Field(0.0, description="the cost of each metre of the half width B, a number")
    prestress: float = Field(0.0, description="the cost of each newton of the tendons' initial forces, a number")
    dissipator_force: float = Field(
        0.0, description="the cost of each newton of the dissipators' yield forces, a number"
    )


class SearchTable(Table):
    """The arguments of `DesignSearch` other than those of the study itself, and the unit costs."""

    cost: CostTable = Field(description="a table of half_width, prestress and dissipator_force, in cost/m and cost/N")
    tendon_factors: list[float] = Field([1.0], description=_FACTORS.format("tendons"))
    dissipator_factors: list[float] = Field([1.0], description=_FACTORS.format("dissipators"))
    tendon_scaling: Scaling = Field("size", description=_SCALING)
    dissipator_scaling: Scaling = Field("size", description=_SCALING)
    refinements: int = Field(4, description="how often the distance of neighbouring values is halved, a whole number")
    designs_per_refinement: int = Field(8, description="the largest number of designs of a refinement, a whole number")

    @field_validator("tendon_factors", "dissipator_factors", mode="before")
    @classmethod
    def _factors(cls, given: object, info: ValidationInfo) -> object:
        return list(factors_of(str(info.field_name), given)) if isinstance(given, list | dict) else given
