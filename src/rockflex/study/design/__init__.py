"""Design of a base: its width, its tendons and its dissipators (Section 4.1)."""

from rockflex.study.design._best_design import BestDesign, InterpolatedMargins, best_design, trade_off
from rockflex.study.design._design_search import DesignSearchPlan
from rockflex.study.design._design_study import (
    DesignPlan,
    DesignStudy,
    design_tables_by_limit,
    run_design,
    search_design,
    stored_design_limits,
    stored_design_search,
)
from rockflex.study.design._design_table import design_table, smallest_width
from rockflex.study.design._designs import DesignSearch, Scaling, TendonLevel, checked_design_factors
from rockflex.study.design._requirements import DesignCost, Requirement, checked_requirements, requirement_margins

__all__ = [
    "BestDesign",
    "DesignCost",
    "DesignPlan",
    "DesignSearch",
    "DesignSearchPlan",
    "DesignStudy",
    "InterpolatedMargins",
    "Requirement",
    "Scaling",
    "TendonLevel",
    "best_design",
    "checked_design_factors",
    "checked_requirements",
    "design_table",
    "design_tables_by_limit",
    "requirement_margins",
    "run_design",
    "search_design",
    "smallest_width",
    "stored_design_limits",
    "stored_design_search",
    "trade_off",
]
