"""Ground motions: records, pulses, suites, intensity measures and file formats."""

from rockflex.motion._at2 import read_at2
from rockflex.motion._columns import record_csv
from rockflex.motion._ground_motion import GroundMotion, check_horizontal, is_vertical
from rockflex.motion._measures import (
    MEASURES,
    Measure,
    Shaking,
    intensities,
    intensity,
    record_measures,
    vertical_measures,
)
from rockflex.motion._pulses import (
    half_sine_pulse,
    mavroeidis_papageorgiou_pulse,
    one_cosine_pulse,
    one_sine_pulse,
    quiet_motion,
    rectangular_pulse,
    ricker_pulse,
)
from rockflex.motion._read_suite import OnError, Vertical, folder_files, read_files, read_suite
from rockflex.motion._readers import read_components, read_motion, read_plain
from rockflex.motion._record_info import RecordInfo, direction_of
from rockflex.motion._recordings import (
    Combination,
    RotatedSpectrum,
    StationRecord,
    group_stations,
    recording_names,
    rotated_spectrum,
)
from rockflex.motion._selection import Selection
from rockflex.motion._spectra import ResponseSpectrum, TargetSpectrum
from rockflex.motion._suite import Suite, load_suite, suite_names
from rockflex.motion._survey import RecordSurvey, SurveyEntry, survey_plain, survey_records
from rockflex.motion._targets import asce7_site_spectrum, asce7_spectrum, ec8_second_spectrum, ec8_spectrum, read_target
from rockflex.motion._text import UNITS, acceleration_in

__all__ = [
    "MEASURES",
    "UNITS",
    "Combination",
    "GroundMotion",
    "Measure",
    "OnError",
    "RecordInfo",
    "RecordSurvey",
    "ResponseSpectrum",
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
