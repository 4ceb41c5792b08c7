"""Values: what is equal in all its fields is equal, also as a copy or back from a pickle."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import fields
from typing import Any, cast

import numpy as np


class Value:
    """Base of frozen dataclasses that hold arrays, written ``@dataclass(frozen=True, eq=False)``.

    Two are equal if they are of one class and all their fields are: arrays of the same shape entry by entry, sequences
    and mappings by what they hold, and everything else as it compares itself; functions are equal only to themselves.
    A missing number (NaN) equals a missing number, and -0.0 equals 0.0. Equal values have equal hashes; one that holds
    what cannot be hashed, such as a table, has none.

    A pickle and a copy hold the fields alone and no result that was computed from them and kept. Their arrays are
    read-only again, which NumPy forgets on the way. A class that copies or checks what it is given has an `__init__` or
    a `__post_init__` of its own; of one that is made within the package alone, the arrays become read-only as they are.
    """

    def __post_init__(self) -> None:
        _freeze(vars(self).values())

    def __eq__(self, other: object) -> bool:
        if self is other:
            return True
        if type(self) is not type(other):
            return NotImplemented
        return all(_same(one, getattr(other, name)) for name, one in _items(self))

    def __hash__(self) -> int:
        return hash((type(self), *(_key(value) for _, value in _items(self))))

    def __getstate__(self) -> dict[str, Any]:
        return dict(_items(self))

    def __setstate__(self, state: dict[str, Any]) -> None:
        _freeze(state.values())
        vars(self).update(state)


def _freeze(values: Iterable[Any]) -> None:
    for value in values:
        if isinstance(value, np.ndarray):
            value.setflags(write=False)
        elif isinstance(value, list | tuple):
            _freeze(cast("Iterable[Any]", value))


def _items(value: Any) -> Iterator[tuple[str, Any]]:
    return ((each.name, getattr(value, each.name)) for each in fields(value))


def _same(one: Any, other: Any) -> bool:
    if one is other:
        return True
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return _same_arrays(one, other)
    if isinstance(one, list | tuple) and type(one) is type(other):
        entries = cast("list[Any]", one)
        return len(entries) == len(other) and all(map(_same, entries, other))
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        first, second = cast("Mapping[Any, Any]", one), cast("Mapping[Any, Any]", other)
        return first.keys() == second.keys() and all(_same(first[key], second[key]) for key in first)
    if hasattr(one, "equals") or hasattr(other, "equals"):  # a table of pandas, of which == makes another table
        return type(one) is type(other) and bool(cast("Any", one).equals(other))
    missing = isinstance(one, float) and isinstance(other, float) and one != one and other != other
    return missing or bool(one == other)


def _same_arrays(one: Any, other: Any) -> bool:
    if not (isinstance(one, np.ndarray) and isinstance(other, np.ndarray)):
        return False
    return np.array_equal(one, other, equal_nan=one.dtype.kind == other.dtype.kind == "f")


def _key(value: Any) -> Any:
    """What stands for a value in a hash: equal for all that `_same` takes for equal."""
    if isinstance(value, np.ndarray):
        return (value.shape, *map(_key, value.ravel().tolist()))
    if isinstance(value, list | tuple):
        return tuple(map(_key, cast("list[Any]", value)))
    if isinstance(value, Mapping):
        entries = cast("Mapping[Any, Any]", value)
        return frozenset((key, _key(each)) for key, each in entries.items())
    return None if isinstance(value, float) and value != value else value
