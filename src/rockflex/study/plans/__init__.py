"""Studies of thousands of runs: what they hold, and how they are cut into chunks."""

from rockflex.study.plans._agreement import PopulationStatistics, population_statistics
from rockflex.study.plans._cloud import CloudPlan, CloudStudy, run_cloud
from rockflex.study.plans._design import DesignPlan, DesignStudy, design_tables, run_design
from rockflex.study.plans._design_levels import TendonLevel
from rockflex.study.plans._design_table import design_table
from rockflex.study.plans._design_width import smallest_width
from rockflex.study.plans._incremental import (
    IncrementalPlan,
    IncrementalStudy,
    incremental_capacities,
    run_incremental,
)
from rockflex.study.plans._load import Study, load_study
from rockflex.study.plans._pivot_lifts import PivotLifts, pivot_lifts
from rockflex.study.plans._plan import ChunkedPlan, Plan, run_plan
from rockflex.study.plans._population import PopulationPlan, PopulationStudy, run_population
from rockflex.study.plans._prototypes import Prototype, draw_prototype
from rockflex.study.plans._records import Records, record_group
from rockflex.study.plans._stripes import StripePlan, StripeStudy, stripe_counts
from rockflex.study.plans._tables import to_frame

__all__ = [
    "ChunkedPlan",
    "CloudPlan",
    "CloudStudy",
    "DesignPlan",
    "DesignStudy",
    "IncrementalPlan",
    "IncrementalStudy",
    "PivotLifts",
    "Plan",
    "PopulationPlan",
    "PopulationStatistics",
    "PopulationStudy",
    "Prototype",
    "Records",
    "StripePlan",
    "StripeStudy",
    "Study",
    "TendonLevel",
    "design_table",
    "design_tables",
    "draw_prototype",
    "incremental_capacities",
    "load_study",
    "pivot_lifts",
    "population_statistics",
    "record_group",
    "run_cloud",
    "run_design",
    "run_incremental",
    "run_plan",
    "run_population",
    "smallest_width",
    "stripe_counts",
    "to_frame",
]
