"""The structures, motions and models of a study in Python: one, several, or several by name."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any, TypeAlias, cast

from rockflex._errors import InputError
from rockflex.modal import RockingProperties
from rockflex.models import Model, parse_model
from rockflex.motion import GroundMotion
from rockflex.study._arguments import RockingStructure, is_structure, sequence_of

Structures: TypeAlias = (
    RockingStructure
    | RockingProperties
    | Iterable[RockingStructure | RockingProperties]
    | Mapping[str, RockingStructure]
    | Mapping[str, RockingProperties]
    | Mapping[str, RockingStructure | RockingProperties]
)
Motions: TypeAlias = GroundMotion | Iterable[GroundMotion] | Mapping[str, GroundMotion]
Models: TypeAlias = str | Model | Iterable[str | Model]


def structures_of(given: Structures) -> tuple[list[RockingStructure | RockingProperties], list[str] | None]:
    """Return the structures, and their names if they are given by name.

    Raises
    ------
    InputError
        If there is none, an item is not a structure, or a name is not text.
    """
    names, several = _named_entries("structures", given)
    return sequence_of("structures", several, is_structure, "a structure such as a Frame, or RockingProperties"), names


def motions_of(given: Motions) -> list[GroundMotion]:
    """Return the motions; a name in the mapping replaces the name of the motion.

    Raises
    ------
    InputError
        If there is none, an item is not a motion, or a name is not text.
    """
    names, several = _named_entries("motions", given)
    motions = sequence_of("motions", several, lambda each: isinstance(each, GroundMotion), "a GroundMotion")
    if names is None:
        return motions
    return [replace(motion, name=name) for name, motion in zip(names, motions, strict=True)]


def models_of(given: Models) -> list[Model]:
    """Return the models of labels.

    Raises
    ------
    InputError
        If there is none, a label is unknown, or something is neither a label nor a `Model`.
    """
    wanted = 'a label such as "2DOF-S", or a Model'
    labels = sequence_of("models", given, lambda each: isinstance(each, str | Model), wanted)
    return [parse_model(each) for each in labels]


def _named_entries(what: str, given: Any) -> tuple[list[str] | None, Any]:
    """Return the names and values of a mapping; None and `given` itself if it is not a mapping."""
    if not isinstance(given, Mapping):
        return None, given
    entries = cast("Mapping[Any, Any]", given)
    for name in entries:
        if not isinstance(name, str):
            raise InputError(
                f"The names of {what} must be texts, but {name!r} was given. Write {{{str(name)!r}: ...}}."
            )
    return list(entries), list(entries.values())
