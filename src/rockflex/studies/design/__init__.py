"""Design of a base: its width, its tendons and its dissipators (Section 4.1)."""

from rockflex.studies.design._best_design import BestDesign, best_design, trade_off
from rockflex.studies.design._design_study import DesignStudy, run_design, search_design
from rockflex.studies.design._design_table import design_table, smallest_width
from rockflex.studies.design._designs import DesignSearch, TendonLevel
from rockflex.studies.design._requirements import DesignCost, Requirement

__all__ = [
    "BestDesign",
    "DesignCost",
    "DesignSearch",
    "DesignStudy",
    "Requirement",
    "TendonLevel",
    "best_design",
    "design_table",
    "run_design",
    "search_design",
    "smallest_width",
    "trade_off",
]
