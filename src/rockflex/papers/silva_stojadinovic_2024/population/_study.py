"""Random structures under random records, with one mode and with all modes (Sections 3.3 and 3.4)."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, SupportsIndex

import numpy as np
from pydantic import Field

from rockflex.foundation.checks import checked_whole_number
from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError
from rockflex.models._named_quantities import modal_displacement
from rockflex.models._rocking_model import RockingModel
from rockflex.motion._suite import Suite
from rockflex.structure._frames import Frame
from rockflex.structure._rocking import RockingProperties
from rockflex.studies._arguments import Motions, checked_motions, free_vibration_argument, free_vibration_time
from rockflex.studies._case_keys import FreeVibration
from rockflex.studies._modal_combination import COMBINED_QUANTITIES, SecondMode, second_mode_peaks
from rockflex.studies._plan import ChunkedPlan
from rockflex.studies._prepared_case import PreparedCase, peaks_of_runs
from rockflex.studies._result_tables import Columns, Row, columns_of_kind, joined_tables, result_columns
from rockflex.studies._run_matrix import record_columns, record_facts
from rockflex.studies._run_plan import run_plan
from rockflex.studies.progress import ProgressChoice
from rockflex.studies.running import WorkLimit, checked_work_limit
from rockflex.studies.spec import StudySpec

if TYPE_CHECKING:
    import pandas as pd

STORIES = (2, 15)
ASPECT_RATIOS = (5, 10)
BASE_MASSES = (1.0, 1.5, 2.0, 2.5, 3.0)  # times the mass of a story
SHEAR_COEFFICIENTS = (0.06, 0.095)  # a1 in T = a1 H^0.85
FLEXURE_COEFFICIENTS = (0.0125, 0.05)  # a2 in T = a2 H
STORY_HEIGHT, STORY_MASS, DAMPING_RATIO = 3.0, 40e3, 0.02  # m, kg
BEHAVIOURS = ("shear", "flexure")
DRAWN = "height period coefficient aspect_ratio base_mass_ratio stiffness_ratio damping_ratio"
STRUCTURE = "nominal_limit structure_mass total_mass l0r_g uplift_acceleration"
SECOND = "period_2 sd_2 sa_2 top_ordinate_2 effective_mass_2 effective_height_2"
COMBINED = "max_second_displacement_mdof srss_top_displacement srss_base_shear srss_base_moment"

SUFFIXES = "_mdof", "_2dof"  # of the results of both models, in the order of their runs
BATCH_SIZE = 256  # structures that are prepared together
MAX_PAIRS = 2**32 - 1  # pairs with different random numbers


@dataclass(frozen=True)
class Prototype:
    """A random frame and its record (Silva & Stojadinović 2024, Section 3.3).

    Attributes
    ----------
    n_stories
        2 to 15.
    aspect_ratio
        h*_1/B, a whole number from 5 to 10.
    base_mass_ratio
        Mass of the base over the mass of a story: 1, 1.5, 2, 2.5 or 3.
    stiffness_ratio
        ρ: infinite for a shear building, 0 for a flexural one.
    coefficient
        a1 in T_1 = a1 H^0.85 of a shear building, from 0.06 to 0.095, or a2 in T_1 = a2 H of a flexural one, from
        0.0125 to 0.05; s and m.
    record
        Index of the record in its suite.
    """

    n_stories: int
    aspect_ratio: int
    base_mass_ratio: float
    stiffness_ratio: float
    coefficient: float
    record: int

    @property
    def height(self) -> float:
        """H in m."""
        return self.n_stories * STORY_HEIGHT

    @property
    def period(self) -> float:
        """T_1 in s."""
        return self.coefficient * (self.height**0.85 if math.isinf(self.stiffness_ratio) else self.height)

    def frame(self) -> Frame:
        """Return the structure: stories of 3 m and 40 t, with 2 % of critical damping."""
        return Frame(
            n_stories=self.n_stories,
            story_height=STORY_HEIGHT,
            story_mass=STORY_MASS,
            base_mass=self.base_mass_ratio * STORY_MASS,
            stiffness_ratio=self.stiffness_ratio,
            period=self.period,
            aspect_ratio=float(self.aspect_ratio),
            damping_ratio=DAMPING_RATIO,
        )


def draw_prototype(seed: int, number: int, n_records: int) -> Prototype:
    """Draw the prototype of a number. It depends only on the seed, the number and the count of records.

    Every property is uniformly distributed and independent of the others.

    Raises
    ------
    InputError
        If an argument is not an integer in its range.

    Examples
    --------
    >>> import rockflex as rf
    >>> drawn = rf.draw_prototype(seed=0, number=3, n_records=44)
    >>> drawn.n_stories, drawn.aspect_ratio, drawn.record
    (14, 10, 35)
    """
    start, place = checked_whole_number("seed", seed, 0), checked_whole_number("number", number, 0, 2**32 - 1)
    records = checked_whole_number("n_records", n_records, 1, 10**9)
    bits = np.random.Philox(np.random.SeedSequence(start, spawn_key=(place,)))
    draws = np.random.Generator(bits).random(6).tolist()
    shear = draws[3] < 0.5
    low, high = SHEAR_COEFFICIENTS if shear else FLEXURE_COEFFICIENTS
    return Prototype(
        n_stories=_whole_number_of_draw(draws[0], *STORIES),
        aspect_ratio=_whole_number_of_draw(draws[1], *ASPECT_RATIOS),
        base_mass_ratio=BASE_MASSES[_whole_number_of_draw(draws[2], 0, len(BASE_MASSES) - 1)],
        stiffness_ratio=math.inf if shear else 0.0,
        coefficient=low + (high - low) * draws[4],
        record=_whole_number_of_draw(draws[5], 0, records - 1),
    )


def _whole_number_of_draw(draw: float, low: int, high: int) -> int:
    """The whole number from `low` to `high` for a draw from [0, 1)."""
    return low + int(draw * (high - low + 1))


class PopulationStudy(StudySpec):
    """Random structures under random records, each with MDOF-S and 2DOF-S (Section 3.3).

    The table has one row per pair; its columns are those of `run_population`.

    Examples
    --------
    >>> import rockflex as rf
    >>> rf.PopulationStudy(pairs=1000,
    ...     records={"suites": ["el-centro-1940"]}).plan().n_runs
    2000
    """

    study: Literal["population"] = Field("population", description='"population"')
    pairs: int = Field(
        1000, ge=1, le=MAX_PAIRS, description="the number of random structures, a whole number from 1 to 4294967295"
    )
    seed: int = Field(0, ge=0, description="what the draws depend on, a whole number of at least 0")
    free_vibration: FreeVibration = 0.0

    def plan(self) -> "PopulationPlan":
        """Load the records, and divide the study into chunks.

        Raises
        ------
        InputError
            If a record cannot be read.
        """
        free = free_vibration_time(self.free_vibration)
        return PopulationPlan(
            self.records.load(self._folder),
            self.pairs,
            self.seed,
            free,
            max(1, self.runs_per_chunk // 2),
            checked_work_limit(self.work_limit),
        )


class PopulationPlan(ChunkedPlan):
    """Pairs of runs, MDOF-S and 2DOF-S of the same random structure and record, divided into chunks.

    Pairs share no data, so a study of any size fits in memory.
    """

    units = "pairs"

    def __init__(
        self,
        motions: Suite,
        pairs: int,
        seed: int,
        free_vibration: float | None,
        pairs_per_chunk: int,
        work_limit: float | None,
    ) -> None:
        super().__init__(motions, pairs, pairs_per_chunk)
        self.seed, self.free_vibration, self.work_limit = seed, free_vibration, work_limit
        self._facts, self._record_columns = record_facts(motions), record_columns(motions)

    @property
    def n_runs(self) -> int:
        """Number of runs, two for each pair."""
        return 2 * self.n_units

    @property
    def columns(self) -> Columns:
        """Columns of every chunk's table."""
        found: dict[str, Any] = {
            "pair": int,
            "n_stories": int,
            "behaviour": BEHAVIOURS,
            **columns_of_kind(DRAWN, float),
        }
        found |= self._record_columns
        found |= columns_of_kind("pga pgv", float) | columns_of_kind(STRUCTURE, float) | columns_of_kind(SECOND, float)
        for suffix in SUFFIXES:
            found |= result_columns(suffix=suffix)
        return found | columns_of_kind(COMBINED, float) | {"error": str}

    def in_order_of_work(self, units: Sequence[int]) -> Sequence[int]:
        """Return units by stories and time step, so that those that share their preparation are in one piece.

        The highest structures, which take the longest, are the first, so that threads end together.
        """

        def kind(unit: int) -> tuple[int, float, int]:
            drawn = draw_prototype(self.seed, unit, len(self.motions))
            return -drawn.n_stories, self.motions[drawn.record].dt, unit

        return sorted(units, key=kind)

    def results(self, units: Sequence[int]) -> dict[str, list[Any]]:
        """Draw a structure a unit, and simulate it with both models; some at a time."""
        return joined_tables(
            [self._results(units[first : first + BATCH_SIZE]) for first in range(0, len(units), BATCH_SIZE)]
        )

    def _results(self, units: Sequence[int]) -> dict[str, list[Any]]:
        """Do each step for all structures before the next one, so that its code stays in the processor's cache."""
        drawn = [draw_prototype(self.seed, unit, len(self.motions)) for unit in units]
        motions = [self.motions[each.record] for each in drawn]
        structures = [each.frame().rocking() for each in drawn]
        seconds = [second_mode_peaks(*each) for each in zip(structures, motions, strict=True)]
        cases = [self._cases(properties) for properties in structures]
        runs = [(case, motion, 1.0) for both, motion in zip(cases, motions, strict=True) for case in both]
        peaks = peaks_of_runs(runs, keep=False)
        facts = [
            _prototype_facts(each, properties) | self._facts[each.record] | _second_mode_columns(properties, second)
            for each, properties, second in zip(drawn, structures, seconds, strict=True)
        ]
        found: dict[str, list[Any]] = {name: [each[name] for each in facts] for name in facts[0]}
        found |= {"pair": list(units), "pga": [each.pga for each in motions], "pgv": [each.pgv for each in motions]}
        of_runs = peaks.lists()
        errors = of_runs.pop("error")
        found["error"] = [one or other for one, other in zip(errors[::2], errors[1::2], strict=True)]
        for name, values in of_runs.items():
            for first, suffix in enumerate(SUFFIXES):  # neither has results if one of both failed
                of_model = zip(values[first::2], found["error"], strict=True)
                found[name + suffix] = [None if error else value for value, error in of_model]
        found["max_second_displacement_mdof"] = found.get("max_second_mode_mdof", [])
        for name in COMBINED_QUANTITIES:
            pairs = zip(found.get(f"max_{name}_2dof", []), seconds, strict=False)
            found[f"srss_{name}"] = [None if peak is None else second.combined(name, peak) for peak, second in pairs]
        return {name: found.get(name) or [None] * len(units) for name in self.columns}

    def _cases(self, properties: RockingProperties) -> Sequence[PreparedCase | InputError]:
        """Return the cases of both models, with the peak of the second mode (of the first, if there is only one)."""
        models = RockingModel("MDOF-S", properties), RockingModel("2DOF-S", properties.truncated(1))
        extra = [modal_displacement(model, min(model.properties.n_modes, 2) - 1) for model in models]
        try:
            return [
                PreparedCase(model, self.free_vibration, work_limit=self.work_limit, extra={"second_mode": each})
                for model, each in zip(models, extra, strict=True)
            ]
        except InputError as error:
            return error, error


def _prototype_facts(drawn: Prototype, properties: RockingProperties) -> Row:
    return {
        "n_stories": drawn.n_stories,
        "behaviour": BEHAVIOURS.index("shear" if math.isinf(drawn.stiffness_ratio) else "flexure"),
        "height": drawn.height,
        "period": drawn.period,
        "coefficient": drawn.coefficient,
        "aspect_ratio": float(drawn.aspect_ratio),
        "base_mass_ratio": drawn.base_mass_ratio,
        "stiffness_ratio": drawn.stiffness_ratio,
        "damping_ratio": float(properties.zeta[0]),
        "nominal_limit": properties.nominal_overturning_rotation,
        "structure_mass": drawn.n_stories * STORY_MASS,
        "total_mass": properties.m_tot,
        "l0r_g": properties.l0r * GRAVITY,
        "uplift_acceleration": properties.uplift_acceleration,
    }


def _second_mode_columns(properties: RockingProperties, second: SecondMode) -> Row:
    omega = float(properties.omega[1])
    return {
        "period_2": 2.0 * math.pi / omega,
        "sd_2": second.displacement,
        "sa_2": omega**2 * second.displacement,
        "top_ordinate_2": float(properties.top_ordinate[1]),
        "effective_mass_2": float(properties.effective_mass[1]),
        "effective_height_2": float(properties.effective_height[1]),
    }


def run_population(
    motions: Motions,
    pairs: int = 1000,
    seed: int = 0,
    free_vibration: float | Literal["settle"] = 0.0,
    workers: SupportsIndex | None = None,
    work_limit: WorkLimit = "default",
    progress: ProgressChoice = None,
    folder: str | Path | None = None,
    dask: str | None = None,
) -> "pd.DataFrame":
    """Simulate random structures under random records with MDOF-S and 2DOF-S (Silva & Stojadinović 2024, Section 3.3).

    Single-bay frames of 2 to 15 stories of 3 m and 40 t, with h*_1/B a whole number from 5 to 10, a base of 1, 1.5, 2,
    2.5 or 3 story masses, ρ infinite or 0, T_1 = a1 H^0.85 or a2 H, and 2 % damping; see `draw_prototype`. A pair
    depends only on `seed`, its number and the suite.

    Parameters
    ----------
    motions
        The records to draw from, with equal probability; as in `run_cloud`.
    pairs
        Number of structures.
    seed
        Seed of the draws, an integer of at least zero.
    free_vibration, workers, work_limit
        As in `run_cloud`.
    progress
        As in `run_cloud`, counted in pairs.
    folder, dask
        As in `run_study`; the folder is that of the `PopulationStudy` of these arguments.

    Returns
    -------
    pandas.DataFrame
        One row per pair. Drawn values: `pair`, `n_stories`, `behaviour` ("shear" or "flexure"), `height` (m), `period`
        (s), `coefficient`, `aspect_ratio`, `base_mass_ratio`, `stiffness_ratio`, `damping_ratio`, `motion`, `group`,
        `magnitude`, `distance_km`, `pga`, `pgv`; of the structure `nominal_limit` (rad), `structure_mass` and
        `total_mass` (kg), `l0r_g` = L_0^r g (N m), `uplift_acceleration` = M_r/L_0^r (m/s²); of its second mode on a
        fixed base `period_2`, `sd_2`, `sa_2`, `top_ordinate_2` = Γ_2 φ_top,2, `effective_mass_2`, `effective_height_2`;
        the status and every scalar of both models' `Response` with the suffixes `_mdof` and `_2dof`;
        `max_second_displacement_mdof`, the peak of D_2; the estimates `srss_top_displacement`, `srss_base_shear` and
        `srss_base_moment` of Section 3.4; `error`, a message if a run could not be solved, without results.

    Raises
    ------
    InputError
        If a value is out of range.

    Examples
    --------
    >>> import rockflex as rf
    >>> pairs = rf.run_population(rf.load_suite("el-centro-1940"), pairs=3,
    ...     seed=1)
    >>> pairs[["pair", "n_stories", "behaviour", "status_mdof", "status_2dof"]]
       pair  n_stories behaviour status_mdof status_2dof
    0     0          4   flexure     rocking     rocking
    1     1          4   flexure     rocking     rocking
    2     2          3   flexure     rocking     rocking
    """
    count, start = checked_whole_number("pairs", pairs, 1, MAX_PAIRS), checked_whole_number("seed", seed, 0)
    suite = motions if isinstance(motions, Suite) else Suite(checked_motions(motions))
    free, limit = free_vibration_time(free_vibration), checked_work_limit(work_limit)
    given: dict[str, Any] = {"records": suite, "pairs": count, "seed": start}
    given["free_vibration"] = free_vibration_argument(free)
    given["work_limit"] = "none" if limit is None else limit
    spec = PopulationStudy(**given)
    return run_plan(spec.plan(), workers, progress, dask=dask, folder=folder, study=lambda: spec)
