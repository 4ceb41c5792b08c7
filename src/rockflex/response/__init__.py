"""Responses: forces, displacements, energies and peaks from a solution."""

from rockflex.response._comparison import STATISTICS, Comparison
from rockflex.response._demands import DEMANDS, DEMANDS_BY_RECORD
from rockflex.response._energy import EnergyLedger
from rockflex.response._exports import to_matlab, to_netcdf
from rockflex.response._floors import FloorPeaks
from rockflex.response._friction import IMPACT_WINDOW, friction_coefficient
from rockflex.response._history import History, SampledHistory
from rockflex.response._limit_checks import NO_LIMIT, Check, CheckLimits, CheckTable, check, check_in_units
from rockflex.response._moment_rotation import (
    MomentRotation,
    MomentRotationOnSprings,
    element_resistance,
    large_resistance,
    resistance_on_springs,
    weight_resistance,
)
from rockflex.response._peaks import GLOBAL, TrackedPeaks, tracked_quantities
from rockflex.response._pushover import BilinearFit, Pushover, PushoverEvent, pushover_path
from rockflex.response._quasi_static import static_path
from rockflex.response._record_set import RecordSet, Rule, checked_rule, floor_peaks
from rockflex.response._respond import (
    BY_STORY,
    MAX_OF_STORIES,
    NAMES,
    STATUSES,
    columns_of_responses,
    missing_values,
    response_columns_of_runs,
    response_of_solution,
    story_results,
)
from rockflex.response._response import (
    BALANCED,
    PEAKS,
    Response,
    complete_model_label,
    history_of,
    leaves_range,
    warnings_of_energy,
    warnings_of_response,
    warnings_of_run,
)
from rockflex.response._tables import RESULT_UNITS, UNITS_OF_GROUND, UNITS_OF_HISTORY, ground_columns, history_columns

__all__ = [
    "BALANCED",
    "BY_STORY",
    "DEMANDS",
    "DEMANDS_BY_RECORD",
    "GLOBAL",
    "IMPACT_WINDOW",
    "MAX_OF_STORIES",
    "NAMES",
    "NO_LIMIT",
    "PEAKS",
    "RESULT_UNITS",
    "STATISTICS",
    "STATUSES",
    "UNITS_OF_GROUND",
    "UNITS_OF_HISTORY",
    "BilinearFit",
    "Check",
    "CheckLimits",
    "CheckTable",
    "Comparison",
    "EnergyLedger",
    "FloorPeaks",
    "History",
    "MomentRotation",
    "MomentRotationOnSprings",
    "Pushover",
    "PushoverEvent",
    "RecordSet",
    "Response",
    "Rule",
    "SampledHistory",
    "TrackedPeaks",
    "check",
    "check_in_units",
    "checked_rule",
    "columns_of_responses",
    "complete_model_label",
    "element_resistance",
    "floor_peaks",
    "friction_coefficient",
    "ground_columns",
    "history_columns",
    "history_of",
    "large_resistance",
    "leaves_range",
    "missing_values",
    "pushover_path",
    "resistance_on_springs",
    "response_columns_of_runs",
    "response_of_solution",
    "static_path",
    "story_results",
    "to_matlab",
    "to_netcdf",
    "tracked_quantities",
    "warnings_of_energy",
    "warnings_of_response",
    "warnings_of_run",
    "weight_resistance",
]
