"""The records used instead of the paper's, and the one record that both use."""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import rockflex as rf

SEEDS, FEWEST, SEED = 20, 10, 2024
SUITES = ("fema-p695-far-field", "fema-p695-near-field-no-pulse")


@dataclass(frozen=True, eq=False)
class Records:
    """The records of the studies of Sections 3.2 to 3.4, and El Centro 1940 of Sections 4.1.1 and 4.2.

    Attributes
    ----------
    folder : Path or None
        Folder of other records, such as PEER's AT2 files. None for the 72 components of FEMA P-695 without pulses.
    seeds : int
        Number of populations of a thousand random pairs, at least 10, to find how much Figs. 9 and 13 depend on the
        draw.
    seed : int
        Seed of the first of these populations; the others have the next ones.
    """

    folder: Path | None = None
    seeds: int = SEEDS
    seed: int = SEED

    def __post_init__(self) -> None:
        if self.seeds < FEWEST:
            raise rf.InputError(
                f"seeds must be a whole number of at least {FEWEST}, but {self.seeds!r} was given: of fewer random "
                "populations the spread of Figs. 9 and 13 cannot be told."
            )
        if self.seed < 0:
            raise rf.InputError(f"seed must be a whole number of at least 0, but {self.seed!r} was given.")

    @cached_property
    def suite(self) -> rf.Suite:
        """The records of the studies.

        Raises
        ------
        InputError
            If the folder or a file in it cannot be read.
        """
        return self.table.load(Path())

    @property
    def table(self) -> rf.Records:
        """The same records as in the specification of a study."""
        given = {"suites": list(SUITES)} if self.folder is None else {"folder": str(self.folder)}
        return rf.Records.model_validate(given)

    @cached_property
    def el_centro(self) -> rf.GroundMotion:
        """El Centro 1940, north-south, as in Chopra."""
        return rf.load_suite("el-centro-1940")[0]

    @property
    def description(self) -> str:
        """The records in words, for the report."""
        count = len(self.suite)
        studies = (
            f"{count} records of the folder {self.folder.resolve().name}"
            if self.folder is not None
            else f"{count} components of FEMA P-695, far field and near field without pulses"
        )
        return f"Sections 3.2 to 3.4: {studies}, in place of the paper's 210. Section 4: El Centro 1940, north-south."
