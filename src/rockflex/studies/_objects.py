"""Objects of Python in a study or a case: what a document or a file holds of them, and checksums of their sources."""

import math
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any, cast

import numpy as np

from rockflex.foundation.errors import InputError
from rockflex.foundation.registry import source_checksum
from rockflex.models._bouc_wen import BoucWen
from rockflex.models._impact import LAW_CLASSES, ImpactLaw
from rockflex.motion._measures import MEASURES
from rockflex.structure._ground import Ground, Springs
from rockflex.structure._rocking import RockingProperties
from rockflex.structure.file._object_tables import object_from_table, object_table
from rockflex.studies._arguments import InitialState, is_structure_or_properties

PACKAGE = __name__.partition(".")[0]
OPTION_CLASSES: dict[str, dict[str, type]] = {
    "impact": LAW_CLASSES,
    "bouc_wen": {"BoucWen": BoucWen},
    "ground": {"Ground": Ground, "Springs": Springs},
    "initial": {"InitialState": InitialState},
}
"""The classes that a file may name in the place of an option, by its key."""


def object_in_file(name: str, value: Any) -> Any:
    """Return a value, or the table of an object with the name of its class; `name` is its key.

    Raises
    ------
    InputError
        If no file can hold it.
    """
    return value if isinstance(value, str | bool | int | float) else object_table(name, value, OPTION_CLASSES.get(name))


def option_of_file(key: str, table: Any) -> Any:
    """Return the object of a table with the name of its class, in the place of an option.

    Raises
    ------
    InputError
        If the class is none of the option, an argument is unknown or missing, or a value is wrong.
    """
    return object_from_table(table, key, OPTION_CLASSES[key], only=True)


class Given:
    """Something in the place of a table of a study: an object of Python, or a file."""

    def document(self) -> Any:
        """Return what determines it."""
        raise NotImplementedError


def object_document(name: str, value: Any) -> Any:
    """Return what determines an object as plain JSON; `name` is its name in messages.

    A dataclass gives the name of its class and its fields, and a structure of another package its `RockingProperties`.

    Raises
    ------
    InputError
        If it holds anything else.
    """
    if isinstance(value, float) and not math.isfinite(value):
        return f"{value:g}"
    if value is None or isinstance(value, str | bool | int | float):
        return value
    if isinstance(value, np.ndarray | np.generic):
        return object_document(name, value.tolist())
    if isinstance(value, list | tuple):
        return [object_document(name, each) for each in cast("list[Any]", value)]
    if isinstance(value, Mapping):
        entries = cast("Mapping[Any, Any]", value)
        return {str(key): object_document(f"{name}.{key}", each) for key, each in entries.items()}
    kind = type(value)
    if is_structure_or_properties(value) and kind.__module__.partition(".")[0] != PACKAGE:
        value, kind = value.rocking(), RockingProperties
    if is_dataclass(kind):
        found = {each.name: object_document(f"{name}.{each.name}", getattr(value, each.name)) for each in fields(kind)}
        return {"class": _qualified_name(kind), **found}
    raise InputError(
        f"A study's folder must record what determines its results, but {name} is of type {kind.__name__}. Let it be "
        "numbers, texts, arrays, or dataclasses of these; or run the study without a folder."
    )


def function_document(name: str, function: Any) -> str:
    """Return the module and the name of a function.

    Raises
    ------
    InputError
        If it has none: it is an object that can be called.
    """
    if not hasattr(function, "__qualname__"):
        raise InputError(
            f"A study's folder must record what determines its results, but {name} is {type(function).__name__}, which "
            "has no name. Give a function that is written in a module, or run the study without a folder."
        )
    return _qualified_name(function)


def _qualified_name(part: Any) -> str:
    own = part.__module__.partition(".")[0] == PACKAGE
    return part.__qualname__ if own else f"{part.__module__}.{part.__qualname__}"


def impact_law_document(law: ImpactLaw) -> dict[str, Any]:
    """Return the class of a law, the names of what it keeps and loses, and its values, as plain JSON."""
    kind = type(law)
    state = cast("Any", law).__getstate__()
    parts = state if isinstance(state, tuple) else (state,)  # a class with slots gives two dictionaries
    values = {
        name: object_document(f"{kind.__qualname__}.{name}", value)
        for part in parts
        if part
        for name, value in part.items()
    }
    return {"law": f"{kind.__module__}.{kind.__qualname__}", "keeps": law.keeps, "loses": law.loses, "values": values}


def object_checksum(key: str, part: Any, what: str = "") -> dict[str, str]:
    """Return the SHA-256 of the module that defines a class or a function, by its key; nothing for those of rockflex.

    Raises
    ------
    InputError
        If it is not defined in a file.
    """
    try:
        found = source_checksum(part)
    except LookupError as error:
        raise InputError(
            f"The {what or key} {getattr(part, '__qualname__', part)} is not defined in a file, so a study that is "
            "resumed cannot check that it is the same. Put it into a module (a .py file) and import it, or run the "
            "study without a folder."
        ) from error
    return {} if found is None else {f"{key}, {part.__module__}": found}


def added_checksums(study: type) -> dict[str, str]:
    """Return the SHA-256 of the sources of a class of studies and of measures that are not of rockflex."""
    parts: dict[str, Any] = {"study": study} | {f"measure {name}": each.of for name, each in MEASURES.added.items()}
    found = dict[str, str]()
    for name, part in parts.items():
        try:
            checksum = source_checksum(part)
        except LookupError:  # as in a notebook
            checksum = "not in a file"
        if checksum is not None:
            found[f"{name}, {part.__module__}"] = checksum
    return found
