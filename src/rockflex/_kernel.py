"""The one decorator of every compiled kernel."""

from collections.abc import Callable
from typing import Any, TypeVar, cast

from numba import njit

__all__ = ["kernel"]

F = TypeVar("F", bound=Callable[..., Any])


def kernel(function: F) -> F:
    """Compile with numba: no interpreter lock, cached on disk, fused multiply-adds allowed."""
    return cast("F", njit(function, nogil=True, cache=True, fastmath={"contract"}, error_model="numpy", _nrt=False))
