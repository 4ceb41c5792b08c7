"""Ground motions: records, pulses, suites, intensity measures and file formats."""

from rockflex.motion._at2 import read_at2
from rockflex.motion._conditional import ConditionalSpectrum, conditional_spectrum, spectral_correlation
from rockflex.motion._findings import Finding
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._measures import MEASURES, IntensityMeasure
from rockflex.motion._pulses import (
    half_sine_pulse,
    mavroeidis_papageorgiou_pulse,
    one_cosine_pulse,
    one_sine_pulse,
    quiet_motion,
    rectangular_pulse,
    ricker_pulse,
)
from rockflex.motion._read_suite import read_suite
from rockflex.motion._readers import FORMATS, RecordFormat, read_components, read_motion
from rockflex.motion._record_info import RecordInfo
from rockflex.motion._recordings import RotatedSpectrum, StationRecord, group_stations, rotated_spectrum
from rockflex.motion._spectra import TargetSpectrum
from rockflex.motion._suite import Selection, Suite, load_suite, suite_names
from rockflex.motion._survey import RecordSurvey, SurveyEntry, survey_records
from rockflex.motion._target_files import read_conditional_spectrum, read_target
from rockflex.motion._targets import asce7_site_spectrum, asce7_spectrum, ec8_second_spectrum, ec8_spectrum

__all__ = [
    "FORMATS",
    "MEASURES",
    "ConditionalSpectrum",
    "Finding",
    "GroundMotion",
    "IntensityMeasure",
    "RecordFormat",
    "RecordInfo",
    "RecordSurvey",
    "RotatedSpectrum",
    "Selection",
    "StationRecord",
    "Suite",
    "SurveyEntry",
    "TargetSpectrum",
    "asce7_site_spectrum",
    "asce7_spectrum",
    "conditional_spectrum",
    "ec8_second_spectrum",
    "ec8_spectrum",
    "group_stations",
    "half_sine_pulse",
    "load_suite",
    "mavroeidis_papageorgiou_pulse",
    "one_cosine_pulse",
    "one_sine_pulse",
    "quiet_motion",
    "read_at2",
    "read_components",
    "read_conditional_spectrum",
    "read_motion",
    "read_suite",
    "read_target",
    "rectangular_pulse",
    "ricker_pulse",
    "rotated_spectrum",
    "spectral_correlation",
    "suite_names",
    "survey_records",
]
