"""The search for the cheapest base, tendons and dissipators that meet all requirements."""

from rockflex.study.design.search._best import BestDesign, best_design
from rockflex.study.design.search._cost import DesignCost
from rockflex.study.design.search._plan import SearchPlan
from rockflex.study.design.search._requirement import Requirement, check_requirements, margins_of
from rockflex.study.design.search._run import search_design
from rockflex.study.design.search._space import DesignSearch, Scaling, factors_of
from rockflex.study.design.search._trade_off import Interpolated, trade_off

__all__ = [
    "BestDesign",
    "DesignCost",
    "DesignSearch",
    "Interpolated",
    "Requirement",
    "Scaling",
    "SearchPlan",
    "best_design",
    "check_requirements",
    "factors_of",
    "margins_of",
    "search_design",
    "trade_off",
]
