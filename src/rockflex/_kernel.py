"""The one decorator of every compiled kernel."""

import ctypes
import hashlib
import importlib
import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar, cast

from numba import njit, types

__all__ = ["Callback", "Entry", "kernel"]

importlib.import_module("numba.experimental.function_type")  # lets numba's typeof know first-class functions

CALLBACK = types.int64(types.uintp, types.int64)
_C_CALLBACK = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_size_t, ctypes.c_int64)

_IMPORTS = re.compile(rb"^from rockflex\.([\w.]+) import", re.MULTILINE)

F = TypeVar("F", bound=Callable[..., Any])

# Kernels allocate nothing, so they need no reference counts, whose atomic updates would cost more than the arithmetic.
_OPTIONS: dict[str, Any] = {
    "nogil": True,
    "cache": True,
    "fastmath": {"contract"},
    "error_model": "numpy",
    "_nrt": False,
}


def kernel(function: F) -> F:
    """Compile with numba: no interpreter lock, cached on disk, fused multiply-adds allowed.

    A kernel writes into the arrays that it is given; it can neither make an array nor return one.
    """
    compiled = njit(**_OPTIONS)(function)
    # numba's cache sees a change of a kernel's own file alone, not of the kernels that were compiled into it.
    file = getattr(getattr(compiled, "_cache", None), "_cache_file", None)
    if file is not None:
        file._source_stamp = (file._source_stamp, sources_digest())
    return cast("F", compiled)


class Entry:
    """A kernel that is always given the same types, called without a look at them.

    numba looks at every argument of every call, which for nested tuples takes longer than a short run.
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        self._function = function
        self._entry: Callable[..., Any] | None = None

    def __call__(self, *arguments: Any) -> Any:
        if self._entry is not None:
            return self._entry(*arguments)
        result = self._function(*arguments)
        overloads = getattr(self._function, "overloads", {})
        if len(overloads) == 1:  # compiled for one set of types; without compilation there is none
            self._entry = next(iter(overloads.values())).entry_point
        return result


class Callback(types.WrapperAddressProtocol):
    """A Python function of an address and a count, as a value that kernels can be given and call.

    A call takes the interpreter lock and some microseconds. The function must not raise: nobody would hear it.
    """

    def __init__(self, function: Callable[[int, int], int]) -> None:
        self._function = _C_CALLBACK(function)
        self._address = int(ctypes.cast(self._function, ctypes.c_void_p).value or 0)

    def __call__(self, address: int, count: int) -> int:
        return int(self._function(address, count))

    def __wrapper_address__(self) -> int:
        return self._address

    def signature(self) -> Any:
        return CALLBACK


@cache
def sources_digest() -> str:
    """Digest of all sources that are compiled in, kernels and constants, so that no kernel is ever used out of date."""
    package = Path(__file__).parent
    sources = {path: path.read_bytes() for path in package.rglob("*.py")}
    kernels = {path for path, source in sources.items() if b"_kernel import " in source}
    named = {
        package.joinpath(*name.decode().split(".")).with_suffix(".py")
        for path in kernels
        for name in _IMPORTS.findall(sources[path])
    }
    digest = hashlib.sha256()
    for path in sorted(kernels | (named & sources.keys())):
        digest.update(sources[path])
    return digest.hexdigest()
