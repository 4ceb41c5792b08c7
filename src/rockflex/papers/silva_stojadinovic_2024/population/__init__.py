"""The random population of Sections 3.3 and 3.4: its structures, its study and its statistics."""

from rockflex.papers.silva_stojadinovic_2024.population._statistics import PopulationStatistics, population_statistics
from rockflex.papers.silva_stojadinovic_2024.population._study import (
    PopulationPlan,
    PopulationStudy,
    Prototype,
    draw_prototype,
    run_population,
)

__all__ = [
    "PopulationPlan",
    "PopulationStatistics",
    "PopulationStudy",
    "Prototype",
    "draw_prototype",
    "population_statistics",
    "run_population",
]
