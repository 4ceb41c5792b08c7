from . import population as population
from ._equivalents import equivalent_2hz_long_base as equivalent_2hz_long_base
from ._equivalents import equivalent_s1 as equivalent_s1
