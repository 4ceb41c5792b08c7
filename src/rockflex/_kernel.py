"""The decorators of compiled kernels."""

import ctypes
import hashlib
import re
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar, cast

from rockflex._numba import compiled, compiled_within, direct, when_compiling

_C_CALLBACK = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_size_t, ctypes.c_int64)

_IMPORTS = re.compile(rb"^from rockflex\.([\w.]+) import", re.MULTILINE)

KERNELS: list[Any] = []  # that Python calls, of the modules imported so far
NOTICE = (
    "rockflex is compiling its kernels, which takes some fifteen seconds. This happens once after an installation or "
    "an upgrade, and `rockflex warm` does it ahead of need."
)

F = TypeVar("F", bound=Callable[..., Any])


def kernel(function: F) -> F:
    """Compile with numba for other kernels: no interpreter lock, fused multiply-adds allowed.

    A kernel writes into the arrays that it is given; it can neither create nor return an array. Python can call it,
    too, but must first compile a wrapper; see `python_kernel`.
    """
    return cast("F", compiled_within(function, inlined=False))


def inlined_kernel(function: F) -> F:
    """Compile into the few callers, because calls pass tuples of arrays element by element."""
    return cast("F", compiled_within(function, inlined=True))


def python_kernel(function: F) -> F:
    """Compile a kernel for calls from Python, with all kernels that it calls; the result is cached on disk."""
    result = compiled(function, sources_digest())
    KERNELS.append(result)
    return cast("F", result)


class Notice:
    """Tells a person, once, that the first run is slow because kernels are being compiled.

    Logs and pipes get no line.
    """

    def __init__(self) -> None:
        self.told = False

    def __call__(self, kernel: Any) -> None:
        if not self.told and any(kernel is each for each in KERNELS):
            self.told = True
            if _somebody_reads():
                print(NOTICE, file=sys.stderr, flush=True)


def _somebody_reads() -> bool:
    return "ipykernel" in sys.modules or (sys.stderr is not None and sys.stderr.isatty())  # a notebook is no terminal


notice = Notice()
when_compiling(notice)


class Entry:
    """A kernel that is always called with the same types, without checking them.

    numba inspects every argument of every call, which for nested tuples takes longer than a short run.
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        self._function = function
        self._entry: Callable[..., Any] | None = None

    def __call__(self, *arguments: Any) -> Any:
        if self._entry is not None:
            return self._entry(*arguments)
        result = self._function(*arguments)
        self._entry = direct(self._function, arguments)
        return result


class Callback:
    """A Python function of an address and a count, as an argument that kernels can call.

    A call takes the interpreter lock and some microseconds. The function must not raise: the exception would be lost.
    """

    def __new__(cls, function: Callable[[int, int], int]) -> "Callback":
        return cast("Callback", _C_CALLBACK(function))  # numba knows C functions of ctypes

    def __call__(self, address: int, count: int) -> int: ...


@cache
def sources_digest() -> str:
    """Return a digest of all compiled sources, kernels and constants, so that no outdated kernel is ever used."""
    package = Path(__file__).parent
    sources = {path: path.read_bytes() for path in package.rglob("*.py")}
    kernels = {path for path, source in sources.items() if b"_kernel import " in source}
    named = {
        package.joinpath(*name.decode().split(".")).with_suffix(".py")
        for path in kernels
        for name in _IMPORTS.findall(sources[path])
    }
    compilation = set(package.glob("_numba*.py"))
    digest = hashlib.sha256()
    for path in sorted(kernels | compilation | (named & sources.keys())):
        digest.update(sources[path])
    return digest.hexdigest()
