"""Values: objects are equal if all their fields are equal, also after copying or pickling."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import fields
from functools import cache
from typing import Any, TypeVar, cast

import numpy as np

V = TypeVar("V", bound="Value")


class Value:
    """Base of frozen dataclasses that contain arrays, written ``@dataclass(frozen=True, eq=False)``.

    Two objects are equal if they have the same class and equal fields. Arrays of the same shape are compared entry by
    entry, sequences and mappings by their content, everything else by its own `==`; a function is equal only to itself.
    NaN equals NaN, and -0.0 equals 0.0. Equal objects have equal hashes; an object with an unhashable field, such as a
    table, has no hash.

    Pickles and copies contain only the fields, not cached results. Their arrays are made read-only again, which NumPy
    does not preserve. A class that copies or checks its arguments has its own `__init__` or `__post_init__`; for
    classes that are built only within the package, the given arrays become read-only.
    """

    def __post_init__(self) -> None:
        _make_read_only(vars(self).values())

    def __eq__(self, other: object) -> bool:
        if self is other:
            return True
        if type(self) is not type(other):
            return NotImplemented
        return all(_same_values(one, getattr(other, name)) for name, one in _field_items(self))

    def __hash__(self) -> int:
        return hash((type(self), *(_hashable_key(value) for _, value in _field_items(self))))

    def __getstate__(self) -> dict[str, Any]:
        return dict(_field_items(self))

    def __setstate__(self, state: dict[str, Any]) -> None:
        _make_read_only(state.values())
        vars(self).update(state)


def with_changed_fields(value: V, **changes: Any) -> V:
    """Return a copy of a value with some fields changed to others that need no checks."""
    other = object.__new__(type(value))
    known = vars(value)
    values = {name: changes[name] if name in changes else known[name] for name in _field_names(type(value))}
    _make_read_only(changes.values())
    vars(other).update(values)
    return other


def _make_read_only(values: Iterable[Any]) -> None:
    for value in values:
        if isinstance(value, np.ndarray):
            value.setflags(write=False)
        elif isinstance(value, list | tuple):
            _make_read_only(cast("Iterable[Any]", value))


def _field_items(value: Any) -> Iterator[tuple[str, Any]]:
    return ((name, getattr(value, name)) for name in _field_names(type(value)))


@cache
def _field_names(kind: type) -> tuple[str, ...]:
    return tuple(each.name for each in fields(kind))


def _same_values(one: Any, other: Any) -> bool:
    if one is other:
        return True
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return _same_arrays(one, other)
    if isinstance(one, list | tuple) and type(one) is type(other):
        entries = cast("list[Any]", one)
        return len(entries) == len(other) and all(map(_same_values, entries, other))
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        first, second = cast("Mapping[Any, Any]", one), cast("Mapping[Any, Any]", other)
        return first.keys() == second.keys() and all(_same_values(first[key], second[key]) for key in first)
    if hasattr(one, "equals") or hasattr(other, "equals"):  # a pandas table, for which == returns another table
        return type(one) is type(other) and bool(cast("Any", one).equals(other))
    missing = isinstance(one, float) and isinstance(other, float) and one != one and other != other
    return missing or bool(one == other)


def _same_arrays(one: Any, other: Any) -> bool:
    if not (isinstance(one, np.ndarray) and isinstance(other, np.ndarray)):
        return False
    return np.array_equal(one, other, equal_nan=one.dtype.kind == other.dtype.kind == "f")


def _hashable_key(value: Any) -> Any:
    """Return a hashable key of a value; keys are equal for values that `_same_values` considers equal."""
    if isinstance(value, np.ndarray):
        return (value.shape, *map(_hashable_key, value.ravel().tolist()))
    if isinstance(value, list | tuple):
        return tuple(map(_hashable_key, cast("list[Any]", value)))
    if isinstance(value, Mapping):
        entries = cast("Mapping[Any, Any]", value)
        return frozenset((key, _hashable_key(each)) for key, each in entries.items())
    return None if isinstance(value, float) and value != value else value
