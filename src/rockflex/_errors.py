"""The two ways in which a call can fail, and the one in which it goes on with less."""

from rockflex._shown import shortened

LONGEST = 1900  # characters of a message, where a path or a text of the user would make it any length


class InputError(ValueError):
    """What was given cannot be used; the message says what, what is expected, and how to mend it.

    Attributes
    ----------
    field : str or None
        Name of the argument at fault, where it is one.
    said : str
        The message without the place in a file that it begins with, such as "[frame]", where it does.
    """

    def __init__(
        self, message: str = "", longest: int = LONGEST, *, field: str | None = None, place: str | None = None
    ) -> None:
        super().__init__(shortened(message if place is None else f"{place}: {message}", longest))
        self.field = field
        self.said = message if place is not None else str(self)


class SolverError(RuntimeError):
    """A run that cannot be solved; the message carries the time and the state where it stopped."""

    def __init__(self, message: str = "") -> None:
        super().__init__(shortened(message, LONGEST))


class RecordWarning(UserWarning):
    """Record files are left out of a suite; the message names them, and says why."""
