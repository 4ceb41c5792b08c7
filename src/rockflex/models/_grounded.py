"""Models on springs, and models that slide."""

from rockflex._errors import InputError
from rockflex.modal import Ground, RockingProperties
from rockflex.models._impact import ImpactLaw
from rockflex.models._linear import LinearModel


def grounded(
    label: str,
    kept: RockingProperties,  # noqa: ARG001
    ground: Ground,  # noqa: ARG001
    law: ImpactLaw | None,  # noqa: ARG001
    missing_mass: bool,  # noqa: ARG001
) -> LinearModel:
    """Return the model of a structure on springs, without impact law, or of one that slides.

    Raises
    ------
    InputError
        Always.
    """
    raise InputError(f"{label} cannot be simulated on this ground yet.", field="ground")
