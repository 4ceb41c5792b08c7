"""The Earthquake tab: the record, its spectrum and its intensity measures."""

from collections.abc import Callable, Mapping
from functools import lru_cache
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from rockflex.foundation.json import as_json_value
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._measures import MEASURES, IntensityMeasure, MeasureInput, record_measures, vertical_measures
from rockflex.motion._pulses import (
    half_sine_pulse,
    mavroeidis_papageorgiou_pulse,
    one_cosine_pulse,
    one_sine_pulse,
    rectangular_pulse,
    ricker_pulse,
)
from rockflex.motion._suite import Suite, load_suite, suite_names
from rockflex.web._encoding import envelope_indices, pack_array_as_base64
from rockflex.web._refusal import Refusal, errors_as_refusals
from rockflex.web._state import PageState, PulseChoice, RecordChoice
from rockflex.web._structure import build_page_structure
from rockflex.web._uploads import UploadedRecords

MAX_THUMBNAIL_POINTS = 120  # points of a thumbnail
MAX_CURVE_POINTS = 2000  # of a curve
PERIODS = np.geomspace(0.05, 5.0, 90)


class PulseChoices(NamedTuple):
    """A pulse: its title, the function that makes it, and the arguments besides amplitude and period."""

    title: str
    maker: Callable[..., GroundMotion]
    fields: tuple[str, ...] = ()
    fixed: Mapping[str, str] = MappingProxyType({})

    def options(self, choice: PulseChoice) -> dict[str, Any]:
        """Return the named arguments of the function."""
        return {name: getattr(choice, name) for name in self.fields} | dict(self.fixed)


PULSES = {
    "ricker_antisymmetric": PulseChoices("Ricker, antisymmetric", ricker_pulse),
    "ricker_symmetric": PulseChoices("Ricker, symmetric", ricker_pulse, fixed={"kind": "symmetric"}),
    "one_sine": PulseChoices("One sine", one_sine_pulse),
    "one_cosine": PulseChoices("One cosine", one_cosine_pulse),
    "half_sine": PulseChoices("Half a sine", half_sine_pulse),
    "rectangular": PulseChoices("Rectangle", rectangular_pulse),
    "mavroeidis": PulseChoices("Mavroeidis–Papageorgiou (velocity)", mavroeidis_papageorgiou_pulse, ("gamma", "nu")),
}


def embedded_suite_names() -> tuple[str, ...]:
    """Return the names of the embedded suites."""
    return tuple(suite_names())


@lru_cache(maxsize=8)
def _loaded_suite(name: str) -> Suite:
    with errors_as_refusals("record.suite"):
        return load_suite(name)


def chosen_motion(choice: RecordChoice, uploads: UploadedRecords) -> GroundMotion:
    """Return the chosen record, without the scale factor."""
    if choice.source == "upload":
        return uploads.get(choice.upload)
    if choice.source == "folder":
        return chosen_folder_motion(choice, uploads)
    if choice.source == "pulse":
        pulse = PULSES[choice.pulse.shape]
        with errors_as_refusals("record.pulse"):
            return pulse.maker(choice.pulse.amplitude, choice.pulse.period, **pulse.options(choice.pulse))
    suite = _loaded_suite(choice.suite)
    with errors_as_refusals("record.name"):
        return suite[choice.name]


def chosen_folder_motion(choice: RecordChoice, uploads: UploadedRecords) -> GroundMotion:
    """Return the chosen record of the folder, with its vertical component if that is wanted and there."""
    suite = uploads.folders.get(choice.folder).suite(vertical=choice.vertical)
    with errors_as_refusals("record.folder"):
        return suite[choice.given]


@lru_cache(maxsize=8)
def suite_view(name: str) -> dict[str, Any]:
    """Return the records of a suite with thumbnails and intensity measures."""
    return as_json_value({"name": name, "records": [_record_thumbnail(motion) for motion in _loaded_suite(name)]})


def _record_thumbnail(motion: GroundMotion) -> dict[str, Any]:
    kept = envelope_indices([motion.acceleration], MAX_THUMBNAIL_POINTS)
    info = motion.metadata
    event = " ".join(str(part) for part in (info.event, info.year) if part is not None) if info else ""
    return {
        "name": motion.name,
        "event": event,
        "station": (info.station if info else None) or "",
        "magnitude": info.magnitude if info else None,
        "pga": motion.pga,
        "pgv": motion.pgv,
        "duration": motion.duration,
        "t": pack_array_as_base64(motion.time[kept] / motion.duration),
        "a": pack_array_as_base64(motion.acceleration[kept] / motion.pga),
    }


def record_view(state: PageState, uploads: UploadedRecords) -> dict[str, Any]:
    """Return the history, the spectrum and the measures of the scaled record, some of which depend on the structure."""
    try:
        built = build_page_structure(state.structure)
    except Refusal:
        built = None  # the record can be shown before the structure is complete
    motion = chosen_motion(state.record, uploads).scaled(state.scale)
    velocity, displacement = motion.velocity, motion.displacement
    upwards = [] if motion.vertical is None else [motion.vertical]
    kept = envelope_indices([motion.acceleration, velocity, displacement, *upwards], MAX_CURVE_POINTS)
    spectrum = motion.spectrum(PERIODS)
    known = record_measures() + (vertical_measures() if upwards else [])
    measures: list[dict[str, Any]] = [
        *(_measure_fact(measure, measure.of(MeasureInput(motion))) for measure in known),
        {"name": "Duration", "value": motion.duration, "unit": "s", "help": "length of the record"},
        {"name": "Step", "value": motion.dt, "unit": "s", "help": "sampling step"},
    ]
    first = None
    if built is not None and built.properties.n_modes:
        first = 2.0 * np.pi / float(built.properties.omega[0])
        shaking = MeasureInput(motion, float(built.properties.omega[0]), float(built.properties.zeta[0]))
        measures += [
            _measure_fact(MEASURES[name], MEASURES[name].of(shaking)) for name in ("sa_t1", "sa_t1_5", "sa_avg", "fiv3")
        ]
    return as_json_value(
        {
            "name": motion.name,
            "title": _record_title(motion),
            "measures": measures,
            "t": pack_array_as_base64(motion.time[kept]),
            "acceleration": pack_array_as_base64(motion.acceleration[kept]),
            "vertical": pack_array_as_base64(upwards[0][kept]) if upwards else None,
            "velocity": pack_array_as_base64(velocity[kept]),
            "displacement": pack_array_as_base64(displacement[kept]),
            "periods": pack_array_as_base64(PERIODS),
            "sa": pack_array_as_base64(spectrum.sa),
            "first_period": first,
            "lifting": None if built is None else built.properties.uplift_acceleration,
        }
    )


def _measure_fact(measure: IntensityMeasure, value: float) -> dict[str, Any]:
    return {"name": measure.head, "value": value, "unit": measure.unit, "help": measure.words}


def _record_title(motion: GroundMotion) -> str:
    info = motion.metadata
    if info is None:
        return ""
    parts = (info.event, info.year, info.station, info.component)
    return ", ".join(str(part) for part in parts if part is not None)
