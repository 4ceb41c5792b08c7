"""Simplified models in figures: their looks by how many modes they keep, and the structure that they are of."""

from collections.abc import Iterable
from typing import Protocol

from rockflex._errors import InputError
from rockflex.modal import RockingProperties
from rockflex.plot._style import BLACK, GREEN, LOOKS, RED, Look

__all__ = ["Rocks", "rocking_properties_of", "surrogate_looks"]

_OWN = {"2DOF-S": Look(RED, "-."), "3DOF-S": Look(GREEN, "--"), "MDOF-S": Look(BLACK, "-", 2.0)}


class Rocks(Protocol):
    """Any structure that knows its rocking properties, such as a `Frame`."""

    def rocking(self, n_modes: int | None = None) -> RockingProperties:
        """Properties of the first `n_modes` modes, or of all."""
        ...


def rocking_properties_of(structure: Rocks | RockingProperties) -> RockingProperties:
    """The properties of a structure, or those given.

    Raises
    ------
    InputError
        If the object is neither.
    """
    if isinstance(structure, RockingProperties):
        return structure
    if isinstance(structure, type) or not hasattr(structure, "rocking"):
        given = f"the class {structure.__name__}" if isinstance(structure, type) else type(structure).__name__
        message = f"A structure such as a Frame, or RockingProperties, is needed, but {given} was given."
        raise InputError(message)
    return structure.rocking()


def surrogate_looks(models: Iterable[str]) -> dict[str, Look]:
    """Give each model a look of its own, in the order in which they come; fewer modes are drawn over more.

    Raises
    ------
    InputError
        If there are more models than can be told apart.
    """
    names = list(dict.fromkeys(models))
    others = [name for name in names if name not in _OWN]
    if len(others) > len(LOOKS):
        message = f"{len(names)} models are too many to be told apart in one figure. Plot fewer at a time."
        raise InputError(message)
    looks = _OWN | dict(zip(others, LOOKS, strict=False))
    return {name: looks[name] for name in names}
