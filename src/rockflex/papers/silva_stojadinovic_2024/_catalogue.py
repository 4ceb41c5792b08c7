"""The targets by name, in the order of the paper, and the function that runs them."""

from collections.abc import Callable, Iterator, Sequence
from difflib import get_close_matches
from importlib import import_module
from typing import Any

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024._records import Records
from rockflex.report import Result

TARGETS = (
    *("figure-3", "figure-4", "table-1", "figure-5", "figure-6", "figure-7", "sliding", "figure-8", "figure-9"),
    *("figure-10", "figure-11", "figure-12", "figure-13", "table-2", "figure-14", "table-3", "figure-15"),
    *("figure-16", "figure-17"),
)


def title_of(target: str) -> str:
    """Return the title of a target.

    Raises
    ------
    InputError
        If there is no such target.
    """
    return _module(target).TITLE


def reproduce(
    targets: Sequence[str] = TARGETS,
    records: Records | None = None,
    progress: Callable[[str], None] | None = None,
) -> list[Result]:
    """Reproduce targets, in the order of the paper.

    Parameters
    ----------
    targets
        Their names. Default, also for an empty sequence: all.
    records
        The records of the studies. Default: the embedded records.
    progress
        Called with the name of each completed target.

    Returns
    -------
    list of Result
        One for each target.

    Raises
    ------
    InputError
        If a target is unknown, or the records cannot be read or are too few for a target.
    """
    wanted = [_known(name) for name in targets] or list(TARGETS)
    given = Records() if records is None else records
    return list(_results(wanted, given, progress or (lambda _: None)))


def _results(wanted: Sequence[str], records: Records, tell: Callable[[str], None]) -> Iterator[Result]:
    for name in (target for target in TARGETS if target in wanted):
        module = _module(name)
        try:
            yield module.reproduce(records)
        except rf.InputError as error:
            raise rf.InputError(f"{name}: {error}") from error
        tell(name)


def _module(target: str) -> Any:
    return import_module(f"{__package__}.{_known(target).replace('-', '_')}")


def _known(target: str) -> str:
    if target in TARGETS:
        return target
    near = get_close_matches(target.lower().replace("_", "-").replace(" ", "-"), TARGETS, n=3, cutoff=0.5)
    hint = f"The nearest are {', '.join(near)}" if near else f"There are {', '.join(TARGETS)}"
    raise rf.InputError(f"There is no target {target!r}. {hint}; rockflex reproduce --list names all.")
