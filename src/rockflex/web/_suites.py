"""Suites that the studies of the page can use: embedded ones, the visitor's folder, and records chosen for a target."""

from collections.abc import Mapping, Sequence

from rockflex.motion import Suite, load_suite
from rockflex.web._given import CHOSEN, GIVEN, OWN, GivenRecords, given_suite
from rockflex.web._refusal import Refusal, refusing
from rockflex.web._state import State
from rockflex.web._target import SELECTIONS
from rockflex.web._uploads import Uploads

TITLES = {GIVEN: "your folder", CHOSEN: "the records for the target"}


def records_of(state: State, names: Sequence[str], uploads: Uploads, path: str) -> GivenRecords:
    """Return the records of the suites with these names, the choice of the field `path`.

    Raises
    ------
    Refusal
        If a suite is unknown, the server does not have the folder, the records cannot be chosen, or two suites have a
        record of the same name.
    """
    own = dict[str, Suite]()
    try:
        if GIVEN in names:
            own[GIVEN] = given_suite(state, uploads)
        if CHOSEN in names:
            own[CHOSEN] = SELECTIONS.of(state, uploads)[0].suite
    except Refusal as error:  # the field at fault is on another tab
        raise Refusal({path: next(iter(error.errors.values()))}, error.status) from error
    embedded = [name for name in names if name not in OWN]
    with refusing(path):
        _check_apart({name: load_suite(name) for name in embedded} | own if own else {}, path)
        return GivenRecords.of(embedded, [motion for suite in own.values() for motion in suite])


def _check_apart(suites: Mapping[str, Suite], path: str) -> None:
    """Refuse suites with a record of the same name: records for a target may be those of another suite, scaled."""
    found = dict[str, str]()
    for name, suite in suites.items():
        for motion in suite:
            other = found.setdefault(motion.name, name)
            if other != name:
                both = " and ".join(TITLES.get(each, each) for each in (other, name))
                message = f"{motion.name[:80]} is a record of two of these suites: {both}. Choose one of the two."
                raise Refusal({path: message})
