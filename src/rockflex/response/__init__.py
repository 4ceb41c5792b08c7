"""Responses: forces, displacements, energies and peaks from a solution."""

from rockflex.response._comparison import Comparison
from rockflex.response._energy import EnergyLedger
from rockflex.response._exports import to_matlab, to_netcdf
from rockflex.response._floors import FloorPeaks
from rockflex.response._history import History, SampledHistory
from rockflex.response._limit_checks import Check, CheckLimits, CheckTable, check
from rockflex.response._moment_rotation import MomentRotation, MomentRotationOnSprings
from rockflex.response._pushover import BilinearFit, Pushover, PushoverEvent
from rockflex.response._record_set import RecordSet
from rockflex.response._response import Response
from rockflex.response._sensitivity import Sensitivity

__all__ = [
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
    "SampledHistory",
    "Sensitivity",
    "check",
    "to_matlab",
    "to_netcdf",
]
