"""The two ways in which a call can fail."""

__all__ = ["InputError", "SolverError"]


class InputError(ValueError):
    """What was given cannot be used; the message says what, what is expected, and how to mend it."""


class SolverError(RuntimeError):
    """A run that cannot be solved; the message carries the time and the state where it stopped."""
