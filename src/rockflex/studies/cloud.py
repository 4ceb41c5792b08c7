"""Cloud analysis: every structure under every record, with every model, at a few scales (Section 3.2)."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal, Unpack

from pydantic import Field

from rockflex.studies._arguments import (
    Models,
    Motions,
    Structures,
    checked_scale_factors,
)
from rockflex.studies._case_keys import Factors
from rockflex.studies._plan import CrossPlan
from rockflex.studies._run_matrix import StudyMatrix
from rockflex.studies._run_plan import StudyKeywords, run_of_arguments
from rockflex.studies.spec import LimitKeys, StructuresStudySpec

if TYPE_CHECKING:
    import pandas as pd


class CloudStudy(LimitKeys, StructuresStudySpec):
    """Cloud analysis (Silva & Stojadinović 2024, Section 3.2).

    The table has one row per run, structures outermost, then records, models and scales. Its columns are those of
    `run_cloud`, whose structures, motions, models, impact law, hysteresis, ground and demands it takes, too.

    Examples
    --------
    >>> import rockflex as rf
    >>> table = {"n_stories": 2, "story_height": 3.0, "story_mass": 40e3,
    ...     "base_mass": 40e3}
    >>> table |= {"stiffness_ratio": 1.0, "period": 0.5, "aspect_ratio": 8.0,
    ...     "damping_ratio": 0.02}
    >>> study = rf.CloudStudy(
    ...     structures=[{"name": "frame", "frame": table}],
    ...     records={"suites": ["el-centro-1940"]}, scales=[1.0, 2.0]
    ... )
    >>> study.plan().n_runs
    2
    """

    study: Literal["cloud"] = Field("cloud", description='"cloud"')
    scales: Factors = Field([1.0])
    friction: bool = Field(
        False, description="true or false: whether to find the required friction too, which takes time"
    )

    def plan(self) -> "CloudPlan":
        """Build the structures, load the records, and divide the study into chunks.

        Raises
        ------
        InputError
            If a structure cannot be built or a record cannot be read; see also `run_cloud`.
        """
        plan = CloudPlan(self.matrix(friction=self.friction), self.scales, self.runs_per_chunk)
        self.check_limits(plan.columns)
        return plan


class CloudPlan(CrossPlan):
    """The cross product of structures, records, models and scales, divided into chunks."""

    def __init__(self, matrix: StudyMatrix, scales: Sequence[float], per_chunk: int) -> None:
        self.scales = checked_scale_factors(scales, max(matrix.motions, key=lambda motion: motion.pga))
        super().__init__(matrix, len(self.scales), per_chunk)

    def scale(self, structure: int, record: int, level: int) -> float:  # noqa: ARG002
        """Return the factor on the acceleration of a record, the same for all records."""
        return self.scales[level]


def run_cloud(
    structures: Structures,
    motions: Motions,
    models: Models = "MDOF-S",
    scales: float | Sequence[float] = 1.0,
    friction: bool = False,
    **options: Unpack[StudyKeywords],
) -> "pd.DataFrame":
    """Simulate every structure under every motion with every model at every scale, with intensity measures.

    Parameters
    ----------
    structures
        One, a sequence (named "S1", "S2", ...), or a mapping from names.
    motions
        One, a sequence such as a suite, a mapping from names, or a `Selection`, whose scaled records are used. All
        names must differ.
    models, scales
        As in `simulate_many`.
    friction
        Whether to find the friction that prevents sliding (Eqs. 20-22), which needs the history of every run.
    options
        `free_vibration`, `bouc_wen`, `impact`, `ground` and `work_limit` as in `simulate_many`; and these:
    workers
        Number of threads; None for one a core.
    progress
        ``"bar"`` for a bar with the time left, in a terminal or a notebook; or a function ``progress(done, total)``
        of the runs that are done and of all, called here, first with 0. What it raises ends the study.
    demands
        Functions that make a number of a `Response` with its history, by name: ``{"roof": lambda response:
        abs(response.floor_acceleration[:, -1]).max()}``. Each is a column; what one raises ends the study.
    folder
        Where the study is stored, as by `run_study`; the same call resumes one that was stopped. The folder is that of
        the `CloudStudy` of these arguments with ``runs_per_chunk=64``. With None nothing is stored.
    dask
        As in `run_study`.

    Returns
    -------
    pandas.DataFrame
        One row per run. `structure`, `motion`, `group` (shared by the components of one recording), `magnitude` and
        `distance_km` where known, `model`, `scale`; measures of the scaled motion: `pga` (m/s²), `pgv` (m/s), `pgd`
        (m), `arias` (m/s), `cav` (m/s), `pva` (m/s²; NaN without a vertical component), `sd_t1` (m) and `sa_t1` (m/s²)
        at the structure's first period and damping, `sa_t1_5` (m/s²) at 5 % damping, `sa_avg` (m/s²) and `fiv3` (m/s)
        as in `GroundMotion.sa_avg` and `GroundMotion.fiv3` for the first period,
        `relative_pga` = pga/(g tan α) and `relative_pgv` = p pgv/(g tan α) with g tan α = M_r/L_0^r and
        p² = L_0^r g/I_θ; `status` and every scalar of `Response` by its name; `nominal_limit`, the rotation in rad of
        `nominal_overturning`; the columns of stories that yield, as in
        `simulate_many`; `zeta_1`, the damping ratio of the first mode; `required_friction` if requested; the
        `demands`;
        `error`. A run that cannot be solved has a message in `error` and no results; a run whose friction cannot be
        found has a message and no friction.

    Raises
    ------
    InputError
        If a label is unknown, a sequence is empty, two motions have the same name, an argument is out of range, a
        demand has the name of another column or returns no number, or every run exceeds `work_limit`; with `folder`
        or `dask`, as in `run_study`.
    ClusterError
        As in `run_study`.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=0.8)
    >>> rf.run_cloud(frame, pulse, "2DOF-S",
    ...     scales=(0.5, 1.0))[["structure", "scale", "pga", "status"]]
      structure  scale  pga   status
    0        S1    0.5  1.5  rocking
    1        S1    1.0  3.0  rocking
    """
    keys = {"scales": scales, "friction": friction}
    return run_of_arguments(CloudStudy, structures, motions, models, keys, options)
