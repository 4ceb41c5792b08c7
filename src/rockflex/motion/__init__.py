"""Ground motions: records, pulses, suites, intensity measures and file formats."""

from rockflex.motion._at2 import read_at2
from rockflex.motion._codes import asce7_site_spectrum, asce7_spectrum, ec8_spectrum
from rockflex.motion._direction import check_horizontal, direction_of, is_vertical
from rockflex.motion._ec8_second import ec8_second_spectrum
from rockflex.motion._embedded import load_suite, suite_names
from rockflex.motion._folder import folder_files
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._measure import Measure
from rockflex.motion._measures import MEASURES, intensities, intensity, record_measures, vertical_measures
from rockflex.motion._pairs import recording_names
from rockflex.motion._pulses import (
    half_sine_pulse,
    one_cosine_pulse,
    one_sine_pulse,
    quiet_motion,
    rectangular_pulse,
    ricker_pulse,
)
from rockflex.motion._read_suite import OnError, Vertical, read_files, read_suite
from rockflex.motion._read_target import read_target
from rockflex.motion._readers import read_components, read_motion, read_plain
from rockflex.motion._record_file import record_csv
from rockflex.motion._record_info import RecordInfo
from rockflex.motion._recordings import Combination
from rockflex.motion._rotation import RotatedSpectrum, rotated_spectrum
from rockflex.motion._selection import Selection
from rockflex.motion._shaking import Shaking
from rockflex.motion._stations import StationRecord, group_stations
from rockflex.motion._suite import Suite
from rockflex.motion._survey import RecordSurvey, SurveyEntry, survey_plain, survey_records
from rockflex.motion._target import TargetSpectrum
from rockflex.motion._units import UNITS, acceleration_in
from rockflex.motion._velocity_pulse import mavroeidis_papageorgiou_pulse

__all__ = [
    "MEASURES",
    "UNITS",
    "Combination",
    "GroundMotion",
    "Measure",
    "OnError",
    "RecordInfo",
    "RecordSurvey",
    "RotatedSpectrum",
    "Selection",
    "Shaking",
    "StationRecord",
    "Suite",
    "SurveyEntry",
    "TargetSpectrum",
    "Vertical",
    "acceleration_in",
    "asce7_site_spectrum",
    "asce7_spectrum",
    "check_horizontal",
    "direction_of",
    "ec8_second_spectrum",
    "ec8_spectrum",
    "folder_files",
    "group_stations",
    "half_sine_pulse",
    "intensities",
    "intensity",
    "is_vertical",
    "load_suite",
    "mavroeidis_papageorgiou_pulse",
    "one_cosine_pulse",
    "one_sine_pulse",
    "quiet_motion",
    "read_at2",
    "read_components",
    "read_files",
    "read_motion",
    "read_plain",
    "read_suite",
    "read_target",
    "record_csv",
    "record_measures",
    "recording_names",
    "rectangular_pulse",
    "ricker_pulse",
    "rotated_spectrum",
    "suite_names",
    "survey_plain",
    "survey_records",
    "vertical_measures",
]
