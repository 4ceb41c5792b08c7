"""The search for the cheapest design, without a file."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal, SupportsIndex

from rockflex._checks import instance
from rockflex.modal import RockingProperties
from rockflex.models import BoucWen, ImpactLaw, Model
from rockflex.progress import ProgressChoice
from rockflex.study._arguments import WORK_LIMIT, GroundChoice, RockingStructure
from rockflex.study._subjects import Motions
from rockflex.study.design.search._cost import DesignCost
from rockflex.study.design.search._plan import SearchPlan
from rockflex.study.design.search._requirement import Requirement, check_requirements
from rockflex.study.design.search._space import DesignSearch
from rockflex.study.plan._bench import bench_of
from rockflex.study.plan._chunked import run_plan

if TYPE_CHECKING:
    import pandas as pd


def search_design(
    structure: RockingStructure | RockingProperties,
    motions: Motions,
    search: DesignSearch,
    requirements: Sequence[Requirement],
    cost: DesignCost,
    model: str | Model = "MDOF-S",
    scales: float | Sequence[float] = 1.0,
    free_vibration: float | Literal["settle"] = "settle",
    bouc_wen: BoucWen | None = None,
    impact: ImpactLaw | None = None,
    workers: SupportsIndex | None = None,
    work_limit: float | None = WORK_LIMIT,
    ground: GroundChoice = None,
    progress: ProgressChoice = None,
) -> "pd.DataFrame":
    """Search base width, tendons and dissipators together for the cheapest design that meets all requirements.

    All combinations of the values of the search are run under all motions, then the designs of each refinement; the
    same call always runs the same designs. `best_design` evaluates the table.

    Parameters
    ----------
    structure
        A structure, or its `RockingProperties`, with the elements that the factors of the search multiply.
    motions, scales, free_vibration, bouc_wen, impact, workers, work_limit, ground
        As in `run_cloud`.
    search
        The values of the variables, and the number of refinements.
    requirements
        Limits with their targets, which all must be met.
    cost
        Unit costs of the width and of the forces.
    model
        One model, as in `simulate`.
    progress
        As in `run_cloud`, counted in designs.

    Returns
    -------
    pandas.DataFrame
        One row per run, in the order of the search. The columns are those of `run_cloud`, where `structure` numbers the
        designs, and after it: `round`, 0 for the values given; `half_width` (m), `tendon_factor`, `dissipator_factor`;
        `aspect_ratio` = h*_1/B; `prestress` = ΣF_0 and `dissipator_force` = ΣF_y in N; `prestress_ratio` =
        ΣF_0/(m_tot g); `resisting_moment` (M_r in N m).

    Raises
    ------
    InputError
        If the structure lacks elements for the factors, a design cannot be built, the model's base cannot lift, or as
        in `run_cloud`.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(n_stories=3, story_height=3.0, story_mass=40e3, base_mass=40e3, stiffness_ratio=1e9,
    ...               period=0.6, aspect_ratio=6.0, damping_ratio=0.02)
    >>> held = rf.Restrained(frame, rf.Tendon(initial_force=300e3, stiffness=2e6))
    >>> pulses = {"a": rf.ricker_pulse(3.0, 0.6), "b": rf.ricker_pulse(3.0, 0.9)}
    >>> search = rf.DesignSearch([1.0, 2.0, 3.0], tendon_factors=[0.0, 1.0, 2.0], refinements=1)
    >>> targets, cost = [rf.Requirement(0.01, 0.2, at=0.5)], rf.DesignCost(half_width=1.0, prestress=5e-7)
    >>> runs = rf.search_design(held, pulses, search, targets, cost, model="2DOF-S", scales=[0.5, 1.0, 2.0, 4.0])
    >>> runs.groupby("round")["structure"].nunique().tolist()
    [9, 8]
    """
    given: Any = scales
    bench = bench_of(
        [structure], motions, [model], free_vibration, bouc_wen, impact, work_limit=work_limit, ground=ground
    )
    wanted = check_requirements(requirements)
    space, unit_costs = instance("search", search, DesignSearch), instance("cost", cost, DesignCost)
    return run_plan(SearchPlan(bench, space, wanted, unit_costs, given, runs_per_chunk=64), workers, progress)
