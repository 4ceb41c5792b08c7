"""The errors that calls raise, and the warning about records that are left out."""

from rockflex._shown import shortened

LONGEST = 1900  # most characters of a message, which may quote paths and texts of any length


class InputError(ValueError):
    """An invalid input; the message states what was given, what is expected, and how to correct it.

    Attributes
    ----------
    field : str or None
        Name of the invalid argument, if there is a single one.
    said : str
        The message without the place in a file, such as "[frame]", with which it may begin.
    """

    def __init__(
        self, message: str = "", longest: int = LONGEST, *, field: str | None = None, place: str | None = None
    ) -> None:
        super().__init__(shortened(message if place is None else f"{place}: {message}", longest))
        self.field = field
        self.said = message if place is not None else str(self)


class MissingQuantityError(InputError, AttributeError):
    """A quantity that this run did not store; also an AttributeError, so that `hasattr` returns False."""


class SolverError(RuntimeError):
    """A run that cannot be solved; the message contains the time and the state at which it stopped."""

    def __init__(self, message: str = "") -> None:
        super().__init__(shortened(message, LONGEST))


class RecordWarning(UserWarning):
    """Records were left out of a suite, or a header contradicts its samples; the message says which, and why."""
