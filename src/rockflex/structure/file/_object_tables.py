"""Objects as tables of TOML: the name of the class, and its arguments in SI units."""

import inspect
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from functools import cache
from typing import Any, cast, get_args, get_type_hints

import numpy as np

import rockflex.structure
from rockflex.foundation.arrays import Array
from rockflex.foundation.errors import InputError
from rockflex.foundation.registry import registered_objects
from rockflex.foundation.shown import shortened, shown
from rockflex.structure._attachment import YieldingStory
from rockflex.structure._joint import JointAbove
from rockflex.structure._participation import MassNormalisedModes
from rockflex.structure._pivot import OnColumns

CLASS = "class"


def object_table(name: str, value: Any, classes: Mapping[str, type] | None = None) -> dict[str, Any]:
    """Return a dataclass as a table from which `object_from_table` makes an equal one; `name` is its name in messages.

    Raises
    ------
    InputError
        If it depends on something that no table holds, such as a function.
    """
    table = _plain(name, value)
    try:
        same = bool(object_from_table(table, name, classes) == value)
    except (InputError, TypeError, ValueError):
        same = False
    if not same:
        raise InputError(
            f"{name} cannot be written to a file so that an equal one is read from it: {shown(type(value).__name__)} "
            "is not registered by an installed package, or holds more than its arguments. Give another kind of "
            "structure, such as its RockingProperties.",
            field=name,
        )
    return table


def _plain(name: str, value: Any) -> Any:
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    if isinstance(value, str | bool | int | float):
        return value
    if isinstance(value, list | tuple):
        return [_plain(name, each) for each in cast("list[Any]", value)]
    kind = type(value)
    if not is_dataclass(kind):
        raise InputError(
            f"{name} holds {shown(kind.__name__)}, which cannot be written to a file. Give numbers or a table of "
            "values in its place.",
            field=name,
        )
    given = {each.name: getattr(value, each.name) for each in fields(kind) if each.name in _arguments_of(kind)}
    found = {key: _plain(f"{name}.{key}", each) for key, each in given.items() if each is not None}
    return {CLASS: kind.__name__, **found}


def object_from_table(table: Any, place: str, classes: Mapping[str, type] | None = None, *, only: bool = False) -> Any:
    """Return the object of a table; `place` names the table in messages.

    Parameters
    ----------
    table
        With a key `class`, the name of one of `structure_classes` or of `classes`.
    only
        Whether it must be one of `classes`.

    Raises
    ------
    InputError
        If the class or an argument is unknown or missing, or a value is wrong.
    """
    known = {**({} if only else structure_classes()), **(classes or {})}
    if not isinstance(table, dict) or table.get(CLASS) not in known:
        given = shown(cast("dict[str, Any]", table).get(CLASS) if isinstance(table, dict) else table)
        names = ", ".join(known) if only else "the name of one of rockflex's classes"
        raise InputError(f"{place}: {CLASS} must be {names}, but {given} was given.")
    content = cast("dict[str, Any]", table)
    kind = known[content[CLASS]]
    hints, names = get_type_hints(kind), _arguments_of(kind)
    given = {key: value for key, value in content.items() if key != CLASS}
    unknown = [key for key in given if key not in names]
    if unknown:
        raise InputError(f"{place}: {unknown[0]} is not known; {kind.__name__} has {', '.join(names)}.")

    def made(key: str, value: Any) -> Any:
        if isinstance(value, dict):
            return object_from_table(value, f"{place}, {key}", classes, only=only)
        if isinstance(value, list):
            entries = cast("list[Any]", value)
            numeric = Array in (hints.get(key), *get_args(hints.get(key)))
            return np.array(entries, np.float64) if numeric else tuple(made(key, each) for each in entries)
        return value

    try:
        return kind(**{key: made(key, value) for key, value in given.items()})
    except InputError as error:
        raise error if str(error).startswith(place) else InputError(str(error), place=place) from error
    except (TypeError, ValueError, AttributeError) as error:  # an argument is missing, or of another type
        raise InputError(f"{place}: {kind.__name__} cannot be made: {shortened(str(error))}.") from error


def arguments_in_table(table: Any) -> Any:
    """Return a table and those in it without the names of their classes."""
    if isinstance(table, list):
        return [arguments_in_table(each) for each in cast("list[Any]", table)]
    if not isinstance(table, dict):
        return table
    return {key: arguments_in_table(each) for key, each in cast("dict[str, Any]", table).items() if key != CLASS}


def structure_from_table(table: Mapping[str, Any], place: str) -> Any:
    """Return the structure of a table with a key `class`.

    Raises
    ------
    InputError
        As `object_from_table`, or if it is not a structure whose modes can be found.
    """
    built = object_from_table(dict(table), place)
    try:
        if not isinstance(built, rockflex.structure.RockingProperties):
            built.rocking()
    except Exception as error:  # values that fit no structure break its formulas anywhere
        raise InputError(f"{place}: it is not a structure: {shortened(str(error))}.") from error
    return built


@cache
def structure_classes() -> dict[str, type]:
    """Return the classes of structures, their parts and their grounds by name, with those of installed packages."""
    found = [*vars(rockflex.structure).values(), MassNormalisedModes, YieldingStory, JointAbove, OnColumns]
    found += [each for group in ("structures", "elements") for each in registered_objects(group).values()]
    return {each.__name__: each for each in found if isinstance(each, type) and is_dataclass(each)}


@cache
def _arguments_of(kind: type) -> tuple[str, ...]:
    return tuple(inspect.signature(kind).parameters)
