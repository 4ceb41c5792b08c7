"""Runs that are stopped on request, from another thread or by Ctrl-C."""

from collections.abc import Callable, Generator
from contextlib import contextmanager
from contextvars import ContextVar

_ASKED: ContextVar[Callable[[], bool] | None] = ContextVar("asked", default=None)


class RunStoppedError(Exception):
    """A run that was stopped on request: not a failure of the model, but no result either."""


@contextmanager
def stopping_when(asked: Callable[[], bool]) -> Generator[None]:
    """Stop the runs within this context, in this thread, as soon as `asked()` is true.

    `asked` is called between the slices of a run, some ten times a second; for example an event's ``is_set``.
    """
    token = _ASKED.set(asked)
    try:
        yield
    finally:
        _ASKED.reset(token)


def asked_to_stop() -> Callable[[], bool]:
    """Return the stop condition of the runs in this thread, to pass on to other threads."""
    return _ASKED.get() or _never


def _never() -> bool:
    return False


def check_interruption() -> None:
    """Check whether the present run should stop.

    Raises
    ------
    RunStoppedError
        If it should.
    """
    asked = _ASKED.get()
    if asked is not None and asked():
        raise RunStoppedError("The run was stopped before its end.")
