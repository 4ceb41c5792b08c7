"""Design of a base: its width, its tendons and its dissipators (Section 4.1)."""

from rockflex.study.design._best import BestDesign, Interpolated, best_design, trade_off
from rockflex.study.design._designs import DesignSearch, Scaling, TendonLevel, factors_of
from rockflex.study.design._requirements import DesignCost, Requirement, check_requirements, margins_of
from rockflex.study.design._search import SearchPlan, search_design
from rockflex.study.design._study import (
    DesignPlan,
    DesignStudy,
    design_tables,
    run_design,
    stored_limits,
    stored_search,
)
from rockflex.study.design._table import design_table, smallest_width

__all__ = [
    "BestDesign",
    "DesignCost",
    "DesignPlan",
    "DesignSearch",
    "DesignStudy",
    "Interpolated",
    "Requirement",
    "Scaling",
    "SearchPlan",
    "TendonLevel",
    "best_design",
    "check_requirements",
    "design_table",
    "design_tables",
    "factors_of",
    "margins_of",
    "run_design",
    "search_design",
    "smallest_width",
    "stored_limits",
    "stored_search",
    "trade_off",
]
