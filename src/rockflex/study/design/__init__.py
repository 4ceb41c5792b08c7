"""Design of a base: its width and its tendons (Section 4.1)."""

from rockflex.study.design._levels import TendonLevel
from rockflex.study.design._study import DesignPlan, DesignStudy, design_tables, run_design
from rockflex.study.design._table import design_table
from rockflex.study.design._width import smallest_width

__all__ = [
    "DesignPlan",
    "DesignStudy",
    "TendonLevel",
    "design_table",
    "design_tables",
    "run_design",
    "smallest_width",
]
