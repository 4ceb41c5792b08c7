"""What kernels use of numba that it does not promise to keep, and what stands in where a version has it no more.

Without them kernels compute the same, and only start or run slower. `tests/unit/test_numba_parts.py` names the versions
that were tried.
"""

from collections.abc import Callable
from contextlib import suppress
from typing import Any, cast

from numba import njit, typeof

__all__ = ["compiled", "direct"]

OPTIONS: dict[str, Any] = {"nogil": True, "fastmath": {"contract"}, "error_model": "numpy"}

# A kernel that only kernels call needs no way in from Python, which takes as long to compile as the kernel.
WITHIN: dict[str, Any] = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}


def compiled(function: Callable[..., Any], stamp: str, *, within: bool) -> Any:
    """Compile at the first call, and keep the result on disk for as long as the stamp is the same.

    With `within`, it is made for other kernels: Python can call it too, but must compile a way in.

    numba's own stamp sees a change of a kernel's own file alone, not of the kernels that were compiled into it. Where
    the stamp cannot be set, nothing is kept, for it could be out of date.
    """
    try:
        kernel = _without_counts(function, within=within, cache=True)
    except RuntimeError:  # numba finds no folder that it may write
        return _without_counts(function, within=within, cache=False)
    file: Any = getattr(getattr(kernel, "_cache", None), "_cache_file", None)
    if not hasattr(file, "_source_stamp"):
        return _without_counts(function, within=within, cache=False)
    file._source_stamp = (file._source_stamp, stamp)
    return kernel


def _without_counts(function: Callable[..., Any], *, within: bool, cache: bool) -> Any:
    """Without reference counts, whose atomic updates cost more than the arithmetic: kernels allocate nothing."""
    jit: Any = njit
    options = {**OPTIONS, **WITHIN} if within else OPTIONS
    with suppress(Exception):  # whatever a version says of an option that it does not know
        kernel = jit(_nrt=False, cache=cache, **options)(function)
        if all(
            hasattr(kernel.targetdescr.options, name) for name in ("_nrt", *options)
        ):  # today's numba complains at the first call only
            return _with_a_way_in(kernel) if within else kernel
    return jit(cache=cache, **OPTIONS)(function)


def _with_a_way_in(kernel: Any) -> Any:
    """Let Python call a kernel that was compiled for other kernels alone: which else would crash the process."""
    if not hasattr(kernel, "overloads"):  # not compiled at all
        return kernel
    kind: Any = type(kernel)

    class Within(kind):
        def __call__(self, *arguments: Any) -> Any:
            if not hasattr(self, "way_in"):
                inner, jit = self, cast("Any", njit)
                self.way_in = jit(nogil=True)(lambda *given: inner(*given))  # pyright: ignore[reportUnknownLambdaType]
            return self.way_in(*arguments)

    kernel.__class__ = Within
    return kernel


def direct(kernel: Callable[..., Any], arguments: tuple[Any, ...]) -> Callable[..., Any]:
    """The machine code for the types of these arguments; where that is not to be had, the kernel itself."""
    overloads = getattr(kernel, "overloads", {})  # without compilation there are none
    with suppress(Exception):  # whatever a version says of it
        return overloads[tuple(typeof(each) for each in arguments)].entry_point
    return kernel
