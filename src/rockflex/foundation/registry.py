"""Parts that other packages add to this one, by entry points of their distributions."""

import hashlib
import inspect
import sys
import warnings
from collections.abc import Iterable, Iterator, MutableMapping
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from typing import Any, Generic, TypeVar

Part = TypeVar("Part")


@cache
def registered_objects(group: str) -> dict[str, Any]:
    """Return the objects that installed packages register in the group ``rockflex.<group>``, by their names.

    An object that cannot be imported is left out, with a warning that names its package.
    """
    found = dict[str, Any]()
    for entry in entry_points(group=f"rockflex.{group}"):
        try:
            found[entry.name] = entry.load()
        except Exception as error:
            package = entry.dist.name if entry.dist else "a package"
            warnings.warn(
                f"{package} registers {entry.name!r} in rockflex.{group} as {entry.value!r}, which cannot be imported: "
                f"{type(error).__name__}: {error}",
                stacklevel=2,
            )
    return found


def source_checksum(part: Any) -> str | None:
    """Return the SHA-256 of the source of the module that defines a class or function; None for those of rockflex.

    Raises
    ------
    LookupError
        If it is not defined in a file.
    """
    module: str = part.__module__
    if module.partition(".")[0] == __name__.partition(".")[0]:
        return None
    try:
        return hashlib.sha256(inspect.getsource(sys.modules[module]).encode()).hexdigest()
    except (OSError, TypeError, KeyError) as error:
        raise LookupError(module) from error


class Catalogue(MutableMapping[str, Part], Generic[Part]):
    """Objects by their names: those of this package, then those of others, which are imported when first asked for.

    Parameters
    ----------
    own
        Objects of this package, each with a `name`; or entry points, which are loaded when first asked for.
    group
        Group of the entry points of others.
    """

    def __init__(self, own: Iterable[Part | EntryPoint], group: str) -> None:
        named: Any = own
        self._own: dict[str, Part | EntryPoint] = {each.name: each for each in named}
        self._group = group
        self._first = tuple(self._own)

    @property
    def added(self) -> dict[str, Part]:
        """The objects that are not of this package: registered by others, or entered in this session."""
        return {name: part for name, part in self.items() if name not in self._first}

    def __getitem__(self, name: str) -> Part:
        found: Any = self._own[name] if name in self._own else registered_objects(self._group)[name]
        if isinstance(found, EntryPoint):
            found = self._own[name] = found.load()
        return found

    def __setitem__(self, name: str, part: Part) -> None:
        self._own[name] = part

    def __delitem__(self, name: str) -> None:
        del self._own[name]

    def __iter__(self) -> Iterator[str]:
        return iter(dict.fromkeys((*self._own, *registered_objects(self._group))))

    def __len__(self) -> int:
        return sum(1 for _ in self)
