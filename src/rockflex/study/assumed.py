"""What a run assumes beside its model, as it stands in a file or a link: impact law and hysteresis."""

from typing import Literal

from pydantic import Field, InstanceOf, field_validator

from rockflex._errors import InputError
from rockflex.models import BoucWen, ImpactLaw, Restitution, VVELComplete, VVELSimplified
from rockflex.structure.file import NUMBER, Table, number
from rockflex.study._arguments import check_options

LAWS = ("simplified", "complete", "restitution")


class BoucWenTable(Table):
    """The arguments of `BoucWen`."""

    yield_displacement: float = Field(description="D_y of the first mode", json_schema_extra=number("m"))
    post_yield_ratio: float = Field(
        0.01, description="stiffness after yielding over that before", json_schema_extra=NUMBER
    )
    gamma: float = Field(0.5, description="γ of the hysteresis", json_schema_extra=NUMBER)
    beta: float = Field(0.5, description="β of the hysteresis", json_schema_extra=NUMBER)
    exponent: float = Field(8.0, description="n of the hysteresis, a number of at least 1")


class Assumed(Table):
    """Keys for the impact law and the hysteresis; None of either is the model's own law, and no yielding.

    In Python `impact` may be any `ImpactLaw` too, in place of a name.
    """

    impact: Literal["simplified", "complete", "restitution"] | InstanceOf[ImpactLaw] | None = Field(
        None, description='"simplified", "complete" or "restitution"'
    )
    restitution: float | None = Field(None, description="a number from 0 to 1")
    bouc_wen: BoucWenTable | None = Field(None, description="a table")

    @field_validator("impact", mode="before")
    @classmethod
    def _law(cls, given: object) -> object:
        if not isinstance(given, str | int | float | list | dict | None):  # none of what a file holds
            check_options(None, given)  # pyright: ignore[reportArgumentType]
        return given

    def law(self) -> ImpactLaw | None:
        """Return the impact law; None for the model's own.

        Raises
        ------
        InputError
            If a coefficient of restitution is missing, out of range, or given to another law.
        """
        if (self.restitution is not None) != (self.impact == "restitution"):
            raise InputError('restitution and impact = "restitution" go together. Give both or neither.')
        if self.impact is None or isinstance(self.impact, str):
            return impact_law(self.impact, self.restitution)
        check_options(None, self.impact)  # a copy with another law was not checked
        return self.impact

    def hysteresis(self) -> BoucWen | None:
        """Return the hysteresis; None if nothing yields.

        Raises
        ------
        InputError
            If a value is out of range.
        """
        return None if self.bouc_wen is None else BoucWen(**self.bouc_wen.model_dump())


def impact_law(name: str | None, restitution: float | None = None) -> ImpactLaw | None:
    """Return the law of a name in `LAWS`, or None for None; `restitution` belongs to ``"restitution"``."""
    if name is None:
        return None
    if name not in LAWS:
        raise InputError(f"impact must be one of {', '.join(LAWS)}, but {name!r} was given.")
    if restitution is not None:
        return Restitution(restitution)
    return VVELSimplified() if name == "simplified" else VVELComplete()
