"""The one decorator of every compiled kernel."""

from collections.abc import Callable
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
    return cast("F", njit(**_OPTIONS)(function))
