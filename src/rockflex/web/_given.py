"""The records of a study on the page: those of embedded suites, and those that a visitor gave."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from pydantic import PrivateAttr

from rockflex.motion import GroundMotion, Suite, load_suite
from rockflex.study.plan import Records
from rockflex.web._state import State
from rockflex.web._uploads import Uploads

GIVEN = "given"  # stands for the visitor's folder among the names of suites
CHOSEN = "chosen"  # and this for the records chosen for the target spectrum
OWN = (GIVEN, CHOSEN)
FOLDER = "records"  # of a study file, next to it
WHOLE = "your-records"  # the folder of the visitor, as it was given
HEAD = f"# Unpack the records, which the page saves as {FOLDER}.zip, into the folder {FOLDER} next to this file.\n"


class GivenRecords(Records):
    """Records of suites, and motions in memory, which a study file takes from a folder."""

    _motions: tuple[GroundMotion, ...] = PrivateAttr(())

    @property
    def motions(self) -> tuple[GroundMotion, ...]:
        """The motions in memory."""
        return self._motions

    @classmethod
    def of(cls, suites: Sequence[str], motions: Sequence[GroundMotion]) -> "GivenRecords":
        """Return the records of embedded suites, and these motions."""
        content: dict[str, Any] = {"suites": list(suites)} | ({"folder": FOLDER} if motions else {})
        found = cls(**content)
        found._motions = tuple(motions)
        return found

    def load(self, base: Path) -> Suite:  # noqa: ARG002 - nothing is read from files
        """Load the records, first those of the suites.

        Raises
        ------
        InputError
            If a suite is unknown, or two records have the same name.
        """
        return Suite([*(motion for name in self.suites for motion in load_suite(name)), *self._motions])


def given_suite(state: State, uploads: Uploads) -> Suite:
    """Return the records of the visitor's folder, with vertical components if these are wanted.

    Raises
    ------
    Refusal
        If the server does not have them.
    """
    return uploads.folders.get(state.record.folder).suite(vertical=state.record.vertical)
