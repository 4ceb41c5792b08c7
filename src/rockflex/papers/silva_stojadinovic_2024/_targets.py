"""The targets by name, in the order of the paper, and the function that runs them."""

from collections.abc import Callable, Iterator, Sequence
from difflib import get_close_matches

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024 import _section_3_1, _section_3_2, _section_3_3, _section_3_4, _section_4
from rockflex.papers.silva_stojadinovic_2024._inputs import PaperRecords
from rockflex.report import ReproducedResult

_TARGETS: dict[str, tuple[str, Callable[[PaperRecords], ReproducedResult]]] = {
    "figure-3": (_section_3_1.FIGURE_3, _section_3_1.figure_3),
    "figure-4": (_section_3_1.FIGURE_4, _section_3_1.figure_4),
    "table-1": (_section_3_2.TABLE_1, _section_3_2.table_1),
    "figure-5": (_section_3_2.FIGURE_5, _section_3_2.figure_5),
    "figure-6": (_section_3_2.FIGURE_6, _section_3_2.figure_6),
    "figure-7": (_section_3_2.FIGURE_7, _section_3_2.figure_7),
    "sliding": (_section_3_2.SLIDING, _section_3_2.sliding),
    "figure-8": (_section_3_3.FIGURE_8, _section_3_3.figure_8),
    "figure-9": (_section_3_3.FIGURE_9, _section_3_3.figure_9),
    "figure-10": (_section_3_4.FIGURE_10, _section_3_4.figure_10),
    "figure-11": (_section_3_4.FIGURE_11, _section_3_4.figure_11),
    "figure-12": (_section_3_4.FIGURE_12, _section_3_4.figure_12),
    "figure-13": (_section_3_3.FIGURE_13, _section_3_3.figure_13),
    "table-2": (_section_3_4.TABLE_2, _section_3_4.table_2),
    "figure-14": (_section_4.FIGURE_14, _section_4.figure_14),
    "table-3": (_section_4.TABLE_3, _section_4.table_3),
    "figure-15": (_section_4.FIGURE_15, _section_4.figure_15),
    "figure-16": (_section_4.FIGURE_16, _section_4.figure_16),
    "figure-17": (_section_4.FIGURE_17, _section_4.figure_17),
}
TARGETS = tuple(_TARGETS)


def target_title(target: str) -> str:
    """Return the title of a target.

    Raises
    ------
    InputError
        If there is no such target.
    """
    return _TARGETS[_known_target(target)][0]


def reproduce_targets(
    targets: Sequence[str] = TARGETS,
    records: PaperRecords | None = None,
    progress: Callable[[str], None] | None = None,
) -> list[ReproducedResult]:
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
    wanted = [_known_target(name) for name in targets] or list(TARGETS)
    given = PaperRecords() if records is None else records
    return list(_results_of_targets(wanted, given, progress or (lambda _: None)))


def _results_of_targets(
    wanted: Sequence[str], records: PaperRecords, tell: Callable[[str], None]
) -> Iterator[ReproducedResult]:
    for name in (target for target in TARGETS if target in wanted):
        try:
            yield _TARGETS[name][1](records)
        except rf.InputError as error:
            raise rf.InputError(f"{name}: {error}") from error
        tell(name)


def _known_target(target: str) -> str:
    if target in TARGETS:
        return target
    near = get_close_matches(target.lower().replace("_", "-").replace(" ", "-"), TARGETS, n=3, cutoff=0.5)
    hint = f"The nearest are {', '.join(near)}" if near else f"There are {', '.join(TARGETS)}"
    raise rf.InputError(f"There is no target {target!r}. {hint}; rockflex reproduce --list names all.")
