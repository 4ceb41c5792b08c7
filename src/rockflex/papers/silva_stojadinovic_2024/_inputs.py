"""Records and structures of the paper, the records used instead, and the pieces of the work that is done on them."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import rockflex as rf

if TYPE_CHECKING:
    import pandas as pd

BEHAVIOURS = {"shear": math.inf, "flexure": 0.0}
STRUCTURES = {
    "#1": (1.0, 10.0, "shear"),
    "#2": (1.0, 10.0, "flexure"),
    "#3": (0.5, 10.0, "shear"),
    "#4": (0.5, 10.0, "flexure"),
    "#5": (1.0, 5.0, "shear"),
    "#6": (1.0, 5.0, "flexure"),
}
"""Period in s, h*_1/B and behaviour of the structures of Table 1."""

MODELS = ("MDOF-S", "2DOF-C", "2DOF-S")  # of Section 3.2
MARK = 10.0  # h*_1/B of the gray line of Fig. 10

TOWER = rf.TaperedTower(
    height=200.0, base_radius=8.0, top_radius=4.0, wall=1.0, density=2400.0, elastic_modulus=25e9,
    damping_ratio=0.02,
)  # fmt: skip
"""The chimney of Section 4.1.1."""
PAIRS, SEEDS, MIN_POPULATIONS, SEED = 1000, 20, 10, 2024
SUITES = ("fema-p695-far-field", "fema-p695-near-field-no-pulse")


def table_1_frame(name: str) -> rf.Frame:
    """Return a structure of Table 1."""
    period, aspect_ratio, behaviour = STRUCTURES[name]
    return _frame(5, behaviour, period, aspect_ratio)


def tall_frame(behaviour: str, aspect_ratio: float = MARK) -> rf.Frame:
    """Return the 15-story building of Section 3.4; its period and base mass are assumed."""
    return _frame(15, behaviour, 1.0, aspect_ratio)


def _frame(n_stories: int, behaviour: str, period: float, aspect_ratio: float) -> rf.Frame:
    return rf.Frame(
        n_stories, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=BEHAVIOURS[behaviour],
        period=period, aspect_ratio=aspect_ratio, damping_ratio=0.02,
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class PaperRecords:
    """The records of the studies of Sections 3.2 to 3.4, and El Centro 1940 of Sections 4.1.1 and 4.2.

    Attributes
    ----------
    folder : Path or None
        Folder of other records, such as PEER's AT2 files. None for the 72 components of FEMA P-695 without pulses.
    seeds : int
        Number of populations of random pairs, at least 10, to find how much Figs. 9 and 13 depend on the draw.
    seed : int
        Seed of the first of these populations; the others have the next ones.
    pairs : int
        Number of pairs of a population, a thousand in the paper.
    workers : int or None
        Threads of studies; None for one per core.
    tables : dict
        The tables of the pieces of the work that are done, by their names; shared by all targets.
    """

    folder: Path | None = None
    seeds: int = SEEDS
    seed: int = SEED
    pairs: int = PAIRS
    workers: int | None = None
    tables: "dict[str, pd.DataFrame]" = field(default_factory=dict[str, "pd.DataFrame"], repr=False)

    def __post_init__(self) -> None:
        if self.seeds < MIN_POPULATIONS:
            raise rf.InputError(
                f"seeds must be a whole number of at least {MIN_POPULATIONS}, but {self.seeds!r} was given: of fewer "
                "random populations the spread of Figs. 9 and 13 cannot be told."
            )
        if self.seed < 0:
            raise rf.InputError(f"seed must be a whole number of at least 0, but {self.seed!r} was given.")

    @property
    def pool_size(self) -> int:
        """Number of pairs of all populations."""
        return self.seeds * self.pairs

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


@dataclass(frozen=True)
class Piece:
    """Runs that several targets share, or that take long, computed anywhere and kept as a table.

    It is number `number` of `count` in a group whose tables have the same columns. `make` is a function that another
    process can import, called with the records and the number; `cost` is the time that it takes on one core of a
    machine of 2024, in s, by which pieces and targets are weighed against each other.
    """

    group: str
    number: int
    count: int
    cost: float
    make: "Callable[[PaperRecords, int], pd.DataFrame]"

    @property
    def name(self) -> str:
        """Its name among the tables."""
        return f"{self.group} {self.number + 1} of {self.count}"

    def table(self, records: PaperRecords) -> "pd.DataFrame":
        """Return the table, computed when it is first asked for."""
        if self.name not in records.tables:
            records.tables[self.name] = self.make(records, self.number)
        return records.tables[self.name]
