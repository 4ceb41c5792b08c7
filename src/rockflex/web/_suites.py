"""Suites that the studies of the page can use: embedded ones, the visitor's folder, and records chosen for a target."""

from collections.abc import Sequence

from rockflex.motion import GroundMotion
from rockflex.web._given import CHOSEN, GIVEN, OWN, GivenRecords, given_suite
from rockflex.web._refusal import Refusal, refusing
from rockflex.web._state import State
from rockflex.web._target import SELECTIONS
from rockflex.web._uploads import Uploads


def records_of(state: State, names: Sequence[str], uploads: Uploads, path: str) -> GivenRecords:
    """Return the records of the suites with these names, the choice of the field `path`.

    Raises
    ------
    Refusal
        If a suite is unknown, the server does not have the folder, or the records cannot be chosen.
    """
    try:
        motions = list[GroundMotion](given_suite(state, uploads)) if GIVEN in names else []
        motions += SELECTIONS.of(state, uploads)[0].suite if CHOSEN in names else []
    except Refusal as error:  # the field at fault is on another tab
        raise Refusal({path: next(iter(error.errors.values()))}, error.status) from error
    with refusing(path):
        return GivenRecords.of([name for name in names if name not in OWN], motions)
