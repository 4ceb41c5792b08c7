"""The targets by name, in the order of the paper, and the functions that run them."""

from collections.abc import Callable, Generator, Sequence
from contextlib import contextmanager
from difflib import get_close_matches
from typing import NamedTuple

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024 import _section_3_1, _section_3_2, _section_3_3, _section_3_4, _section_4
from rockflex.papers.silva_stojadinovic_2024._inputs import PaperRecords, Piece
from rockflex.report._document import FinishedResult, ReproducedResult


class _Target(NamedTuple):
    title: str
    compute: Callable[[PaperRecords], ReproducedResult]
    cost: float  # s, see Piece; of everything but its pieces
    numbers_cost: float  # without remarks and figures
    pieces: Callable[[PaperRecords], list[Piece]] = lambda _: []
    remark_pieces: Callable[[PaperRecords], list[Piece]] = lambda _: []  # which only the remarks need


_TARGETS = {
    "figure-3": _Target(_section_3_1.FIGURE_3, _section_3_1.figure_3, 1.2, 0.2),
    "figure-4": _Target(_section_3_1.FIGURE_4, _section_3_1.figure_4, 6.0, 1.4),
    "table-1": _Target(_section_3_2.TABLE_1, _section_3_2.table_1, 0.1, 0.1),
    "figure-5": _Target(_section_3_2.FIGURE_5, _section_3_2.figure_5, 1.4, 1.0, _section_3_2.cloud_pieces),
    "figure-6": _Target(_section_3_2.FIGURE_6, _section_3_2.figure_6, 1.5, 0.5, _section_3_2.cloud_pieces),
    "figure-7": _Target(_section_3_2.FIGURE_7, _section_3_2.figure_7, 1.2, 0.5, _section_3_2.cloud_pieces),
    "sliding": _Target(_section_3_2.SLIDING, _section_3_2.sliding, 1.0, 0.2, _section_3_2.friction_pieces),
    "figure-8": _Target(_section_3_3.FIGURE_8, _section_3_3.figure_8, 0.4, 0.1, _section_3_3.first_population_piece),
    "figure-9": _Target(_section_3_3.FIGURE_9, _section_3_3.figure_9, 0.9, 0.4, _section_3_3.population_pieces),
    "figure-10": _Target(_section_3_4.FIGURE_10, _section_3_4.figure_10, 1.2, 0.1),
    "figure-11": _Target(_section_3_4.FIGURE_11, _section_3_4.figure_11, 0.4, 0.1),
    "figure-12": _Target(_section_3_4.FIGURE_12, _section_3_4.figure_12, 0.3, 0.1),
    "figure-13": _Target(
        _section_3_3.FIGURE_13, _section_3_3.figure_13, 0.4, 0.2, _section_3_3.population_pieces,
        _section_3_3.sampled_pieces,
    ),
    "table-2": _Target(_section_3_4.TABLE_2, _section_3_4.table_2, 0.1, 0.1),
    "figure-14": _Target(_section_4.FIGURE_14, _section_4.figure_14, 0.3, 0.1),
    "table-3": _Target(
        _section_4.TABLE_3, _section_4.table_3, 0.2, 0.1, remark_pieces=_section_4.dense_element_pieces
    ),
    "figure-15": _Target(_section_4.FIGURE_15, _section_4.figure_15, 0.5, 0.1),
    "figure-16": _Target(_section_4.FIGURE_16, _section_4.figure_16, 0.8, 0.1),
    "figure-17": _Target(_section_4.FIGURE_17, _section_4.figure_17, 0.3, 0.1),
}  # fmt: skip
TARGETS = tuple(_TARGETS)


def target_title(target: str) -> str:
    """Return the title of a target.

    Raises
    ------
    InputError
        If there is no such target.
    """
    return _TARGETS[_known_target(target)][0]


def target_cost(target: str, *, whole: bool = True) -> float:
    """Return the time that a target takes besides its pieces, in the measure of `Piece.cost`; see `finish_target`."""
    return _TARGETS[target].cost if whole else _TARGETS[target].numbers_cost


def target_pieces(target: str, records: PaperRecords, *, whole: bool = True) -> list[Piece]:
    """Return the pieces of the work that a target needs; see `finish_target`."""
    known = _TARGETS[target]
    return known.pieces(records) + (known.remark_pieces(records) if whole else [])


def finish_target(target: str, records: PaperRecords, *, whole: bool = True) -> FinishedResult:
    """Compute a target from the tables that are there, with its remarks and figures if it is to be `whole`.

    Raises
    ------
    InputError
        If the records are too few; the message begins with the target.
    """
    with _naming(target):
        return _TARGETS[target].compute(records).finished(whole=whole)


@contextmanager
def _naming(target: str) -> Generator[None]:
    try:
        yield
    except rf.InputError as error:
        raise rf.InputError(f"{target}: {error}") from error


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
    results = list[ReproducedResult]()
    for name in (target for target in TARGETS if target in wanted):
        with _naming(name):
            results.append(_TARGETS[name].compute(given))
        if progress is not None:
            progress(name)
    return results


def _known_target(target: str) -> str:
    if target in TARGETS:
        return target
    near = get_close_matches(target.lower().replace("_", "-").replace(" ", "-"), TARGETS, n=3, cutoff=0.5)
    hint = f"The nearest are {', '.join(near)}" if near else f"There are {', '.join(TARGETS)}"
    raise rf.InputError(f"There is no target {target!r}. {hint}; rockflex reproduce --list names all.")
