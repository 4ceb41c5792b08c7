"""What studies of every kind share: specification, records, plan, and the table of their runs."""

from rockflex.study._tables import to_frame
from rockflex.study.plan._bench import Bench
from rockflex.study.plan._chunked import ChunkedPlan, map_chunks, run_plan
from rockflex.study.plan._cross import CrossPlan
from rockflex.study.plan._pivot_lifts import PivotLifts, pivot_lifts
from rockflex.study.plan._records import Records, record_groups
from rockflex.study.plan._spec import Spec, StructuresSpec

__all__ = [
    "Bench",
    "ChunkedPlan",
    "CrossPlan",
    "PivotLifts",
    "Records",
    "Spec",
    "StructuresSpec",
    "map_chunks",
    "pivot_lifts",
    "record_groups",
    "run_plan",
    "to_frame",
]
