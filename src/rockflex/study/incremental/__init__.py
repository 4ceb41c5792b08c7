"""Incremental dynamic analysis: every record scaled until it overturns the structure, and beyond."""

from rockflex.study.incremental._study import (
    IncrementalPlan,
    IncrementalStudy,
    incremental_capacities,
    run_incremental,
)

__all__ = ["IncrementalPlan", "IncrementalStudy", "incremental_capacities", "run_incremental"]
