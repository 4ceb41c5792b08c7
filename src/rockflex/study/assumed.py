"""The assumptions of a run besides its model, as a file or a link gives them: impact law, hysteresis and ground."""

from collections.abc import Callable
from typing import Annotated

from pydantic import InstanceOf, field_validator

from rockflex._errors import InputError
from rockflex._schema import IMPACT, PLAIN, BoucWenKeys, ImpactKeys, Key, LawName
from rockflex._shown import shown
from rockflex.models import BoucWen, ImpactLaw, Restitution, VVELComplete, VVELSimplified
from rockflex.structure.file import Table
from rockflex.study._arguments import check_options
from rockflex.study._ground_table import GroundTable

_LAWS: dict[str, Callable[..., ImpactLaw]] = {
    "simplified": VVELSimplified,
    "complete": VVELComplete,
    "restitution": Restitution,
}


class BoucWenTable(BoucWenKeys, Table):
    """The arguments of `BoucWen`."""


class Assumed(ImpactKeys, Table):
    """Keys for the impact law, the hysteresis and the ground.

    By default each model has its own law, nothing yields, and the base cannot slide on rigid ground.

    In Python `impact` may also be any `ImpactLaw`, in place of a name.
    """

    impact: Annotated[LawName | InstanceOf[ImpactLaw] | None, IMPACT] = None  # pyright: ignore[reportIncompatibleVariableOverride]
    bouc_wen: Annotated[BoucWenTable | None, Key("a table", form=PLAIN)] = None
    ground: Annotated[GroundTable | None, Key("a table", form=PLAIN)] = None

    @field_validator("impact", mode="before")
    @classmethod
    def _law(cls, given: object) -> object:
        if not isinstance(given, str | int | float | list | dict | None):  # not a value that a file can hold
            check_options(None, given)  # pyright: ignore[reportArgumentType]
        return given

    def law(self) -> ImpactLaw | None:
        """Return the impact law; None for the model's own.

        Raises
        ------
        InputError
            If a coefficient of restitution is missing, out of range, or given to another law.
        """
        if self.impact == "restitution" and self.restitution is None:
            raise InputError(
                'The impact law "restitution" needs its coefficient. Give restitution, a number from 0 to 1.',
                field="restitution",
            )
        if self.restitution is not None and self.impact != "restitution":
            chosen = "the model's own" if self.impact is None else shown(self.impact)
            raise InputError(
                f"A restitution of {self.restitution:g} was given, but the impact law is {chosen}. "
                'Choose the impact law "restitution", or leave restitution out.',
                field="restitution",
            )
        if self.impact is None:
            return None
        if isinstance(self.impact, str):
            if self.impact not in _LAWS:  # a copy with another law was not checked
                raise InputError(f"impact must be {IMPACT.expected}, but {shown(self.impact)} was given.")
            return _LAWS[self.impact](*[] if self.restitution is None else [self.restitution])
        check_options(None, self.impact)
        return self.impact

    def hysteresis(self) -> BoucWen | None:
        """Return the hysteresis; None if nothing yields.

        Raises
        ------
        InputError
            If a value is out of range.
        """
        return None if self.bouc_wen is None else BoucWen(**self.bouc_wen.model_dump())


def name_of(law: ImpactLaw) -> str:
    """Return the name of an impact law of the package in a file."""
    return next(name for name, kind in _LAWS.items() if type(law) is kind)
