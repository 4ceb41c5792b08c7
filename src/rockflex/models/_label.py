"""The paper's names of models: "2DOF-S", "3DOF-S", ... "MDOF-S", "fixed", "5DOF-fixed"."""

import re
from dataclasses import dataclass

import numpy as np

from rockflex._checks import whole_number
from rockflex._errors import InputError
from rockflex.modal import RockingProperties
from rockflex.models._linear import LinearModel

__all__ = ["Model", "parse_model"]

_PATTERN = re.compile(r"(?:(?P<count>[1-9][0-9]{0,5})|(?P<all>M))DOF-(?P<kind>S|fixed)")
_EXPECTED = '"2DOF-S", "3DOF-S", ..., "MDOF-S" (all modes), "fixed" (all modes) or "5DOF-fixed"'


@dataclass(frozen=True)
class Model:
    """A choice of model, not yet tied to a structure.

    Parameters
    ----------
    n_modes
        Number of modes kept; None for all of them.
    lifts
        Whether the base can lift (Eqs. 23-25) or is fixed (Eq. 15).

    Raises
    ------
    InputError
        If `n_modes` is neither None nor a whole number of at least 1, or `lifts` is not a boolean.
    """

    n_modes: int | None = None
    lifts: bool = True

    def __post_init__(self) -> None:
        if self.n_modes is not None:
            object.__setattr__(self, "n_modes", whole_number("n_modes", self.n_modes, 1))
        if not isinstance(self.lifts, bool | np.bool_):  # pyright: ignore[reportUnnecessaryIsInstance]
            message = f"lifts must be True (the base can lift) or False (it is fixed), but {self.lifts!r} was given."
            raise InputError(message)
        object.__setattr__(self, "lifts", bool(self.lifts))

    @property
    def label(self) -> str:
        """Name in the paper's manner: degrees of freedom, the rotation counted where the base can lift."""
        if self.n_modes is None:
            return "MDOF-S" if self.lifts else "fixed"
        return f"{self.n_modes + 1}DOF-S" if self.lifts else f"{self.n_modes}DOF-fixed"

    def of(self, properties: RockingProperties) -> LinearModel:
        """Tie the model to a structure.

        Raises
        ------
        InputError
            If the structure has fewer modes than the model keeps.
        """
        if self.n_modes is not None and self.n_modes > properties.n_modes:
            message = (
                f"Model {self.label} needs {self.n_modes} modes, but the structure has {properties.n_modes}. "
                f"Give more modes, or use {Model(None, self.lifts).label} for all there are."
            )
            raise InputError(message)
        kept = properties if self.n_modes is None else properties.truncated(self.n_modes)
        return LinearModel(self.label, kept, self.lifts)


def parse_model(model: str | Model) -> Model:
    """Read a model's label; a `Model` is returned as it is.

    Raises
    ------
    InputError
        If the label is unknown.
    """
    if isinstance(model, Model):
        return model
    if model == "fixed":
        return Model(lifts=False)
    found = _PATTERN.fullmatch(model) if isinstance(model, str) else None  # pyright: ignore[reportUnnecessaryIsInstance]
    if found and not (found["all"] and found["kind"] == "fixed"):
        lifts = found["kind"] == "S"
        if found["all"]:
            return Model()
        n_modes = int(found["count"]) - lifts
        if n_modes >= 1:
            return Model(n_modes, lifts)
    message = f"Unknown model {model!r}. Expected {_EXPECTED}, or a Model."
    raise InputError(message)
