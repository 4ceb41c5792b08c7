"""Figures of the random population, apart from its study: a study needs no matplotlib."""

from rockflex.papers.silva_stojadinovic_2024.population.plots._agreement import plot_agreement
from rockflex.papers.silva_stojadinovic_2024.population.plots._characteristics import plot_population
from rockflex.papers.silva_stojadinovic_2024.population.plots._combination import plot_modal_combination

__all__ = ["plot_agreement", "plot_modal_combination", "plot_population"]
