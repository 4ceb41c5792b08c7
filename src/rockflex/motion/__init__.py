"""Ground motions: records, pulses, suites, intensity measures and file formats."""

from rockflex.motion._at2 import read_at2
from rockflex.motion._columns import record_csv
from rockflex.motion._findings import Finding
from rockflex.motion._ground_motion import GroundMotion, check_horizontal_component, is_vertical_component
from rockflex.motion._measures import (
    MEASURES,
    IntensityMeasure,
    MeasureInput,
    record_measures,
    scalable_measure,
    scalable_measures,
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
from rockflex.motion._read_suite import OnError, Vertical, read_components_by_file, read_suite, record_files_in_folder
from rockflex.motion._readers import FORMATS, RecordFormat, read_components, read_motion, read_motion_without_obspy
from rockflex.motion._record_info import RecordInfo, component_direction
from rockflex.motion._recordings import (
    Combination,
    RotatedSpectrum,
    StationRecord,
    group_stations,
    horizontal_pairs,
    recording_names,
    rotated_spectrum,
)
from rockflex.motion._spectra import ResponseSpectrum, TargetSpectrum
from rockflex.motion._suite import Selection, Suite, load_suite, suite_names
from rockflex.motion._survey import RecordSurvey, SurveyEntry, survey_records, survey_without_obspy
from rockflex.motion._target_files import read_target
from rockflex.motion._targets import asce7_site_spectrum, asce7_spectrum, ec8_second_spectrum, ec8_spectrum
from rockflex.motion._units import UNITS, acceleration_in_text

__all__ = [
    "FORMATS",
    "MEASURES",
    "UNITS",
    "Combination",
    "Finding",
    "GroundMotion",
    "IntensityMeasure",
    "MeasureInput",
    "OnError",
    "RecordFormat",
    "RecordInfo",
    "RecordSurvey",
    "ResponseSpectrum",
    "RotatedSpectrum",
    "Selection",
    "StationRecord",
    "Suite",
    "SurveyEntry",
    "TargetSpectrum",
    "Vertical",
    "acceleration_in_text",
    "asce7_site_spectrum",
    "asce7_spectrum",
    "check_horizontal_component",
    "component_direction",
    "ec8_second_spectrum",
    "ec8_spectrum",
    "group_stations",
    "half_sine_pulse",
    "horizontal_pairs",
    "is_vertical_component",
    "load_suite",
    "mavroeidis_papageorgiou_pulse",
    "one_cosine_pulse",
    "one_sine_pulse",
    "quiet_motion",
    "read_at2",
    "read_components",
    "read_components_by_file",
    "read_motion",
    "read_motion_without_obspy",
    "read_suite",
    "read_target",
    "record_csv",
    "record_files_in_folder",
    "record_measures",
    "recording_names",
    "rectangular_pulse",
    "ricker_pulse",
    "rotated_spectrum",
    "scalable_measure",
    "scalable_measures",
    "suite_names",
    "survey_records",
    "survey_without_obspy",
    "vertical_measures",
]
