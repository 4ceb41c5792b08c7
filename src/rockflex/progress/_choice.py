"""The check of the argument `progress`."""

from rockflex._errors import InputError
from rockflex._shown import shown


def check_progress(progress: object, arguments: str) -> None:
    """Raise an InputError unless `progress` is None, "bar" or a function, which is called with `arguments`."""
    if progress is None or progress == "bar" or callable(progress):
        return
    raise InputError(
        f'progress must be None, "bar" or a function of {arguments}, but {shown(progress)} was given. Use "bar" for a '
        "bar in a terminal or a notebook.",
        field="progress",
    )
