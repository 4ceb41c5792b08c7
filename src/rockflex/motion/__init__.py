"""Ground motions: records, pulses, suites, intensity measures and file formats."""

from rockflex.motion._at2 import read_at2
from rockflex.motion._direction import check_horizontal, direction_of, is_vertical
from rockflex.motion._embedded import load_suite, suite_names
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._pulses import (
    half_sine_pulse,
    mavroeidis_papageorgiou_pulse,
    one_cosine_pulse,
    one_sine_pulse,
    quiet_motion,
    rectangular_pulse,
    ricker_pulse,
)
from rockflex.motion._read_suite import OnError, folder_files, read_files, read_suite
from rockflex.motion._readers import read_motion
from rockflex.motion._record_info import RecordInfo
from rockflex.motion._suite import Suite

__all__ = [
    "GroundMotion",
    "OnError",
    "RecordInfo",
    "Suite",
    "check_horizontal",
    "direction_of",
    "folder_files",
    "half_sine_pulse",
    "is_vertical",
    "load_suite",
    "mavroeidis_papageorgiou_pulse",
    "one_cosine_pulse",
    "one_sine_pulse",
    "quiet_motion",
    "read_at2",
    "read_files",
    "read_motion",
    "read_suite",
    "rectangular_pulse",
    "ricker_pulse",
    "suite_names",
]
