"""The two ways in which a call can fail, and the one in which it goes on with less."""

from rockflex._shown import shortened

LONGEST = 1900  # characters of a message, where a path or a text of the user would make it any length


class InputError(ValueError):
    """What was given cannot be used; the message says what, what is expected, and how to mend it."""

    def __init__(self, message: str = "", longest: int = LONGEST) -> None:
        super().__init__(shortened(message, longest))


class SolverError(RuntimeError):
    """A run that cannot be solved; the message carries the time and the state where it stopped."""

    def __init__(self, message: str = "") -> None:
        super().__init__(shortened(message, LONGEST))


class RecordWarning(UserWarning):
    """Record files are left out of a suite; the message names them, and says why."""
