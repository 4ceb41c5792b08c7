"""What kernels use of numba that it does not promise to keep, and what stands in where a version has it no more.

Without them kernels compute the same, and only start or run slower. `tests/unit/test_numba_parts.py` names the versions
that were tried.
"""

from collections.abc import Callable
from contextlib import suppress
from typing import Any, cast

from numba import njit, typeof

OPTIONS: dict[str, Any] = {"nogil": True, "fastmath": {"contract"}, "error_model": "numpy"}

# A kernel that only kernels call needs no way in from Python, which takes as long to compile as the kernel.
WITHIN: dict[str, Any] = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
PIPELINE: dict[str, Any] = {}
with suppress(ImportError, AttributeError):  # else every kernel is compiled on its own
    from rockflex._numba_pipeline import Intermediate

    PIPELINE["pipeline_class"] = Intermediate


def compiled(function: Callable[..., Any], stamp: str) -> Any:
    """Compile for Python at the first call, and keep the result on disk for as long as the stamp is the same.

    numba's own stamp sees a change of a kernel's own file alone, not of the kernels that were compiled into it. Where
    the stamp cannot be set, nothing is kept, for it could be out of date.
    """
    try:
        kernel = _without_counts(function, {"cache": True})
    except RuntimeError:  # numba finds no folder that it may write
        return _without_counts(function, {})
    file: Any = getattr(getattr(kernel, "_cache", None), "_cache_file", None)
    if not hasattr(file, "_source_stamp"):
        return _without_counts(function, {})
    file._source_stamp = (file._source_stamp, stamp)
    return kernel


def compiled_within(function: Callable[..., Any], *, inlined: bool) -> Any:
    """Compile for other kernels, at the first call of one that Python calls; only the whole is kept on disk.

    Python can call it too, but must compile a way in. With `inlined` its code becomes part of its callers.
    """
    options = {**WITHIN, **PIPELINE, "forceinline": inlined}
    return _with_a_way_in(_without_counts(function, options))


def _without_counts(function: Callable[..., Any], options: dict[str, Any]) -> Any:
    """Without reference counts, whose atomic updates cost more than the arithmetic: kernels allocate nothing."""
    jit: Any = njit
    with suppress(Exception):  # whatever a version says of an option that it does not know
        kernel = jit(_nrt=False, **OPTIONS, **options)(function)
        given = {"_nrt", *options} - {"cache", "pipeline_class"}
        if all(
            hasattr(kernel.targetdescr.options, name) for name in given
        ):  # today's numba complains at the first call
            return kernel
    return jit(**OPTIONS, **{name: value for name, value in options.items() if name == "cache"})(function)


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
