"""The two ways in which a call can fail, and the one in which it goes on with less."""

__all__ = ["InputError", "RecordWarning", "SolverError"]


class InputError(ValueError):
    """What was given cannot be used; the message says what, what is expected, and how to mend it."""


class SolverError(RuntimeError):
    """A run that cannot be solved; the message carries the time and the state where it stopped."""


class RecordWarning(UserWarning):
    """Record files are left out of a suite; the message names them, and says why."""
