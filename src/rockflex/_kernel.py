"""The one decorator of every compiled kernel."""

import hashlib
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar, cast

from numba import njit

__all__ = ["kernel"]

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


@cache
def sources_digest() -> str:
    """Digest of all sources that hold kernels, so that none compiled from others is ever used again."""
    digest = hashlib.sha256()
    for path in sorted(Path(__file__).parent.rglob("*.py")):
        source = path.read_bytes()
        if b"_kernel import kernel" in source:
            digest.update(source)
    return digest.hexdigest()
