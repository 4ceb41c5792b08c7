"""Types of calls and attributes that are remembered, instead of being inferred at every place where they occur.

numba tries all forms of a function, and for operators of arrays there are dozens, whenever one is called.
"""

from collections.abc import Generator
from contextlib import contextmanager
from functools import cache
from typing import Any

from numba.core.types import Function
from numba.core.typing.context import Context

KNOWN: Any = Context
USED = (KNOWN.resolve_function_type, KNOWN.resolve_setitem, KNOWN.resolve_getattr)
MEMORIES: list[dict[Any, tuple[Any, Any]]] = []  # by identities: the objects, so that they keep them, and the answer


@contextmanager
def remembering() -> Generator[None, None, None]:
    """Remember until the end of a compilation: later, functions may have other forms."""
    MEMORIES.append({})
    try:
        yield
    finally:
        MEMORIES.pop()


class Attentive(KNOWN):
    """numba's context of types, with a memory."""

    def resolve_function_type(self, func: Any, args: Any, kws: Any) -> Any:
        """Return the signature of a call."""
        if type(func) is not Function or kws:
            return super().resolve_function_type(func, args, kws)
        return _remembered(super().resolve_function_type, (func, args, kws), (func, *args))

    def resolve_setitem(self, target: Any, index: Any, value: Any) -> Any:
        """Return the signature of an assignment to an element."""
        return _remembered(super().resolve_setitem, (target, index, value), ("setitem", target, index, value))

    def resolve_getattr(self, typ: Any, attr: str) -> Any:
        """Return the type of an attribute."""
        return _remembered(super().resolve_getattr, (typ, attr), (typ, attr))


def _remembered(infer: Any, given: tuple[Any, ...], objects: tuple[Any, ...]) -> Any:
    if not MEMORIES:
        return infer(*given)
    key = tuple(each if isinstance(each, str) else id(each) for each in objects)
    known = MEMORIES[-1]
    if key not in known:
        answer = infer(*given)
        if answer is None:
            return None
        known[key] = objects, answer
    return known[key][1]


@cache
def attentive(context: Any) -> Any:
    """Return the view of a context with a memory, and everything else in common."""
    view = object.__new__(Attentive)
    view.__dict__ = context.__dict__
    return view
