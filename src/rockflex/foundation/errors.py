"""The errors that calls raise, and the warning about records that are left out."""

import errno

from rockflex.foundation.shown import path_shown, shortened

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


_REMEDIES = {
    errno.ENOENT: "Check its spelling; relative paths start from the current folder.",
    errno.EACCES: "Give one that you may use, or have its rights changed.",
    errno.EPERM: "Give one that you may use, or have its rights changed.",
    errno.ENAMETOOLONG: "Give a shorter one.",
    errno.ENOSPC: "Make room, or give another place.",
    errno.EDQUOT: "Make room, or give another place.",
    errno.EROFS: "Give a place that can be written to.",
    errno.EISDIR: "Give a file.",
    errno.ENOTDIR: "A part of it is a file, not a folder; give another one.",
    errno.ELOOP: "Links lead in a circle; give the file itself.",
}


def system_error_text(error: OSError | UnicodeError) -> str:
    """Say what the system refused, with the path as it can be printed, and how to mend it."""
    if isinstance(error, UnicodeError):
        given = getattr(error, "object", "")
        what = path_shown(given) if given else str(error)
        return f"A name or a text is not UTF-8, as is expected: {what}. Rename the file, or save the text as UTF-8."
    path = path_shown(error.filename) if error.filename else ""
    remedy = _REMEDIES.get(error.errno or 0, "Check the path and the disk, and try again.")
    return f"{path}{': ' * bool(path)}{error.strerror or error}. {remedy}"
