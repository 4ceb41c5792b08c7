from ._statistics import PopulationStatistics as PopulationStatistics
from ._statistics import population_statistics as population_statistics
from ._study import PopulationStudy as PopulationStudy
from ._study import Prototype as Prototype
from ._study import draw_prototype as draw_prototype
from ._study import run_population as run_population
