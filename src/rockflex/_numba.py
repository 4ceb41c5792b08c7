"""The unofficial features of numba that kernels use, and the fallbacks for versions without them.

They are used with the versions of `TRIED` only. With any other version kernels give the same results, but start and
run more slowly, and are not cached on disk.
"""

import warnings
from collections.abc import Callable
from contextlib import suppress
from pickle import UnpicklingError
from typing import Any, cast

import numba
from numba import njit, typeof
from numba.extending import get_cython_function_address

TRIED = ("0.61", "0.62", "0.63", "0.64", "0.65", "0.66", "0.67", "0.68")  # pyproject.toml excludes later ones


def is_tried(version: str) -> bool:
    """Tell whether the unofficial features may be used with this version of numba."""
    return version.split(".")[:2] in [each.split(".") for each in TRIED]


KNOWN = is_tried(numba.__version__)
if not KNOWN:
    warnings.warn(
        f"numba {numba.__version__} has not been tried with rockflex, so every process compiles for minutes. Install "
        f"numba {TRIED[0]} to {TRIED[-1]}.",
        stacklevel=2,
    )
OPTIONS: dict[str, Any] = {"nogil": True, "fastmath": {"contract"}, "error_model": "numpy"}

# A kernel called only by kernels needs no wrapper for Python, which takes as long to compile as the kernel.
WITHIN: dict[str, Any] = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
PIPELINE: dict[str, Any] = {}
ENTRY: dict[str, Any] = {}
if KNOWN:  # otherwise every kernel is compiled separately
    from rockflex._numba_pipeline import Intermediate, Whole

    PIPELINE["pipeline_class"] = Intermediate
    ENTRY["pipeline_class"] = Whole


def compiled(function: Callable[..., Any], stamp: str) -> Any:
    """Compile for Python at the first call, and cache the result on disk as long as the stamp does not change.

    numba's own stamp detects only changes in the file of the kernel, not in kernels compiled into it. If the stamp
    cannot be set, nothing is cached, because it could become outdated.
    """
    if not KNOWN:
        return _public(function)
    try:
        kernel = _without_counts(function, {"cache": True, "no_cfunc_wrapper": True, **ENTRY})
    except RuntimeError:  # numba finds no writable folder
        return _without_counts(function, {})
    file: Any = getattr(getattr(kernel, "_cache", None), "_cache_file", None)
    if not hasattr(file, "_source_stamp"):
        return _without_counts(function, {})
    file._source_stamp = (file._source_stamp, stamp)
    _keep_intact(kernel._cache, file)
    return kernel


def _keep_intact(cache: Any, file: Any) -> None:
    """Compile anew what a full disk, a killed process or two at once left cut short, outdated, or for other types.

    numba saves the index before the code, and finds the code by a number in it.
    """
    load, save, read, write = cache.load_overload, cache.save_overload, file._load_data, file._save_data

    def read_of_these_sources(name: str) -> Any:
        stamp, data = read(name)
        if stamp != file._source_stamp:
            raise OSError  # as if the file were missing
        return data

    def write_with_stamp(name: str, data: Any) -> None:
        write(name, (file._source_stamp, data))

    def load_or_clear(signature: Any, context: Any) -> Any:
        try:
            found = load(signature, context)
        except Exception:  # whatever pickle raises for a file that was cut short
            with suppress(OSError):
                cache.flush()
            return None
        return found if found is not None and tuple(found.signature.args) == tuple(signature) else None

    def save_if_possible(signature: Any, result: Any) -> None:
        with suppress(OSError, EOFError, UnpicklingError):  # a full disk, with an index that was cut short before
            save(signature, result)

    cache.load_overload, cache.save_overload = load_or_clear, save_if_possible
    file._load_data, file._save_data = read_of_these_sources, write_with_stamp


def compiled_within(function: Callable[..., Any], *, inlined: bool) -> Any:
    """Compile for other kernels, when the kernel that calls it is first called; only that one is cached on disk.

    Python can call it, too, but must compile a wrapper. With `inlined` its code becomes part of its callers.
    """
    if not KNOWN:
        return _public(function)
    options = {**WITHIN, **PIPELINE, "forceinline": inlined}
    return _with_a_way_in(_without_counts(function, options))


def _public(function: Callable[..., Any]) -> Any:
    """Compile with the documented options of numba alone."""
    jit: Any = njit
    return jit(**OPTIONS)(function)


def _without_counts(function: Callable[..., Any], options: dict[str, Any]) -> Any:
    """Compile without reference counts, whose atomic updates cost more than the arithmetic; kernels do not allocate."""
    jit: Any = njit
    with suppress(Exception):  # whatever a version raises for an unknown option
        kernel = jit(_nrt=False, **OPTIONS, **options)(function)
        given = {"_nrt", *options} - {"cache", "pipeline_class"}
        if all(
            hasattr(kernel.targetdescr.options, name) for name in given
        ):  # current versions raise only at the first call
            return kernel
    return jit(**OPTIONS, **{name: value for name, value in options.items() if name == "cache"})(function)


def _with_a_way_in(kernel: Any) -> Any:
    """Allow calls from Python to a kernel compiled only for kernels, which would otherwise crash the process."""
    if not hasattr(kernel, "overloads"):  # not compiled
        return kernel
    kind: Any = type(kernel)

    class Within(kind):
        def __call__(self, *arguments: Any) -> Any:
            if not hasattr(self, "way_in"):
                inner = self
                self.way_in = _without_counts(lambda *given: inner(*given), ENTRY)
            return self.way_in(*arguments)

    kernel.__class__ = Within
    return kernel


def direct(kernel: Callable[..., Any], arguments: tuple[Any, ...]) -> Callable[..., Any]:
    """Return the machine code for the types of these arguments, or the kernel itself if it is not available."""
    overloads = getattr(kernel, "overloads", {}) if KNOWN else {}  # empty without compilation, too
    with suppress(Exception):  # whatever a version raises
        return overloads[tuple(typeof(each) for each in arguments)].entry_point
    return kernel


def when_compiling(tell: Callable[[Any], None]) -> None:
    """Call `tell` with every kernel that is about to be compiled, as it was not found on disk."""
    with suppress(ImportError, AttributeError):  # otherwise nothing is told
        from numba.core import event

        class Listener(event.Listener):
            def on_start(self, event: Any) -> None:
                tell(event.data["dispatcher"])

            def on_end(self, event: Any) -> None:
                pass

        event.register("numba:compile", Listener())


def folder_of(kernel: Any) -> str | None:
    """Return the folder in which a kernel is cached; None if it is not."""
    return getattr(getattr(kernel, "stats", None), "cache_path", None)


def address_in_cython(module: str, name: str) -> int:
    """Return the address of a C function that a Cython module exports."""
    return int(cast("Any", get_cython_function_address)(module, name))
