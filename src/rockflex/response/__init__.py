"""Responses: forces, displacements, energies and peaks from a solution."""

from rockflex.response._energy import EnergyLedger
from rockflex.response._floors import FloorPeaks
from rockflex.response._friction import IMPACT_WINDOW, friction_coefficient
from rockflex.response._history import History, SampledHistory
from rockflex.response._moment_rotation import (
    MomentRotation,
    MomentRotationOnSprings,
    element_resistance,
    large_resistance,
    resistance_on_springs,
    weight_resistance,
)
from rockflex.response._peaks import GLOBAL, Tracked, tracked_quantities
from rockflex.response._pushover import BilinearFit, Pushover, PushoverEvent, pushover_path
from rockflex.response._quasi_static import static_path
from rockflex.response._respond import (
    BY_STORY,
    MAX_OF_STORIES,
    NAMES,
    STATUSES,
    columns_among,
    columns_of,
    missing_values,
    respond,
    story_results,
)
from rockflex.response._response import (
    BALANCED,
    PEAKS,
    Response,
    complete_of,
    leaves_range,
    warnings_of,
    warnings_of_energy,
)
from rockflex.response._tables import UNITS_OF_GROUND, UNITS_OF_HISTORY, ground_columns, history_columns

__all__ = [
    "BALANCED",
    "BY_STORY",
    "GLOBAL",
    "IMPACT_WINDOW",
    "MAX_OF_STORIES",
    "NAMES",
    "PEAKS",
    "STATUSES",
    "UNITS_OF_GROUND",
    "UNITS_OF_HISTORY",
    "BilinearFit",
    "EnergyLedger",
    "FloorPeaks",
    "History",
    "MomentRotation",
    "MomentRotationOnSprings",
    "Pushover",
    "PushoverEvent",
    "Response",
    "SampledHistory",
    "Tracked",
    "columns_among",
    "columns_of",
    "complete_of",
    "element_resistance",
    "friction_coefficient",
    "ground_columns",
    "history_columns",
    "large_resistance",
    "leaves_range",
    "missing_values",
    "pushover_path",
    "resistance_on_springs",
    "respond",
    "static_path",
    "story_results",
    "tracked_quantities",
    "warnings_of",
    "warnings_of_energy",
    "weight_resistance",
]
