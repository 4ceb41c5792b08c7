"""The one decorator of every compiled kernel."""

import ctypes
import hashlib
import importlib
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar, cast

from numba import njit, types

__all__ = ["Callback", "kernel"]

importlib.import_module("numba.experimental.function_type")  # lets numba's typeof know first-class functions

CALLBACK = types.int64(types.uintp, types.int64)
_C_CALLBACK = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_size_t, ctypes.c_int64)

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


class Callback(types.WrapperAddressProtocol):
    """A Python function of an address and a count, as a value that kernels can be given and call.

    A call takes the interpreter lock and some microseconds. The function must not raise: nobody would hear it.
    """

    def __init__(self, function: Callable[[int, int], int]) -> None:
        self._function = _C_CALLBACK(function)

    def __call__(self, address: int, count: int) -> int:
        return int(self._function(address, count))

    def __wrapper_address__(self) -> int:
        return int(ctypes.cast(self._function, ctypes.c_void_p).value or 0)

    def signature(self) -> Any:
        return CALLBACK


@cache
def sources_digest() -> str:
    """Digest of all sources beside kernels, whose constants are compiled in, so that none is ever used out of date."""
    digest = hashlib.sha256()
    kernels = (path for path in Path(__file__).parent.rglob("*.py") if b"_kernel import kernel" in path.read_bytes())
    for folder in sorted({path.parent for path in kernels}):
        for path in sorted(folder.glob("*.py")):
            digest.update(path.read_bytes())
    return digest.hexdigest()
