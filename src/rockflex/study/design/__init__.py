"""Design of a base: its width and its tendons (Section 4.1)."""

from rockflex.study.design._levels import TendonLevel
from rockflex.study.design._questions import design_tables, questions_of, search_of
from rockflex.study.design._study import DesignPlan, DesignStudy, run_design
from rockflex.study.design._table import design_table
from rockflex.study.design._width import smallest_width

__all__ = [
    "DesignPlan",
    "DesignStudy",
    "TendonLevel",
    "design_table",
    "design_tables",
    "questions_of",
    "run_design",
    "search_of",
    "smallest_width",
]
