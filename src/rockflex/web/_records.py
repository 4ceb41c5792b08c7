"""The Earthquake tab: the record, its spectrum and its intensity measures."""

from functools import lru_cache
from typing import Any

import numpy as np

from rockflex._errors import InputError
from rockflex._json import plain
from rockflex.motion import (
    MEASURES,
    GroundMotion,
    Measure,
    Shaking,
    Suite,
    half_sine_pulse,
    load_suite,
    mavroeidis_papageorgiou_pulse,
    one_cosine_pulse,
    one_sine_pulse,
    record_measures,
    rectangular_pulse,
    ricker_pulse,
    suite_names,
)
from rockflex.web._packing import envelope, pack
from rockflex.web._refusal import Refusal
from rockflex.web._state import PulseChoice, RecordChoice, State
from rockflex.web._structures import Built
from rockflex.web._uploads import Uploads

THUMBNAIL = 120  # points of a thumbnail
POINTS = 2000  # of a curve
PERIODS = np.geomspace(0.05, 5.0, 90)

PULSES: dict[str, tuple[str, str, tuple[str, ...]]] = {
    "ricker_antisymmetric": ("Ricker, antisymmetric", "ricker_pulse({a}, {T})", ("amplitude", "period")),
    "ricker_symmetric": ("Ricker, symmetric", 'ricker_pulse({a}, {T}, kind="symmetric")', ("amplitude", "period")),
    "one_sine": ("One sine", "one_sine_pulse({a}, {T})", ("amplitude", "period")),
    "one_cosine": ("One cosine", "one_cosine_pulse({a}, {T})", ("amplitude", "period")),
    "half_sine": ("Half a sine", "half_sine_pulse({a}, {T})", ("amplitude", "period")),
    "rectangular": ("Rectangle", "rectangular_pulse({a}, {T})", ("amplitude", "period")),
    "mavroeidis": (
        "Mavroeidis–Papageorgiou (velocity)",
        "mavroeidis_papageorgiou_pulse({a}, {T}, gamma={g}, nu={n})",
        ("amplitude", "period", "gamma", "nu"),
    ),
}
"""Title, call and parameters of each pulse."""


def suites() -> tuple[str, ...]:
    """Return the names of the embedded suites."""
    return tuple(suite_names())


@lru_cache(maxsize=8)
def _suite(name: str) -> Suite:
    return load_suite(name)


def motion_of(choice: RecordChoice, uploads: Uploads) -> GroundMotion:
    """Return the chosen record, without the scale factor.

    Raises
    ------
    Refusal
        If there is none.
    """
    if choice.source == "upload":
        return uploads.get(choice.upload)
    if choice.source == "pulse":
        try:
            return _pulse(choice.pulse)
        except InputError as error:
            raise Refusal({"record.pulse": str(error)}) from error
    try:
        suite = _suite(choice.suite)
    except InputError as error:
        raise Refusal({"record.suite": str(error)}) from error
    try:
        return suite[choice.name]
    except InputError as error:
        raise Refusal({"record.name": str(error)}) from error


def _pulse(p: PulseChoice) -> GroundMotion:
    if p.shape == "mavroeidis":
        return mavroeidis_papageorgiou_pulse(p.amplitude, p.period, gamma=p.gamma, nu=p.nu)
    if p.shape == "ricker_symmetric":
        return ricker_pulse(p.amplitude, p.period, kind="symmetric")
    makers = {
        "ricker_antisymmetric": ricker_pulse,
        "one_sine": one_sine_pulse,
        "one_cosine": one_cosine_pulse,
        "half_sine": half_sine_pulse,
        "rectangular": rectangular_pulse,
    }
    return makers[p.shape](p.amplitude, p.period)


@lru_cache(maxsize=8)
def suite_view(name: str) -> dict[str, Any]:
    """Return the records of a suite with thumbnails and intensity measures.

    Raises
    ------
    Refusal
        If the suite is unknown.
    """
    try:
        suite = _suite(name)
    except InputError as error:
        raise Refusal({"record.suite": str(error)}) from error
    return plain({"name": name, "records": [_thumbnail(motion) for motion in suite]})


def _thumbnail(motion: GroundMotion) -> dict[str, Any]:
    kept = envelope([motion.acceleration], THUMBNAIL)
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
        "t": pack(motion.time[kept] / motion.duration),
        "a": pack(motion.acceleration[kept] / motion.pga),
    }


def record_view(state: State, built: Built | None, uploads: Uploads) -> dict[str, Any]:
    """Return the history, the spectrum and the measures of the scaled record."""
    motion = motion_of(state.record, uploads).scaled(state.scale)
    velocity, displacement = motion.velocity, motion.displacement
    kept = envelope([motion.acceleration, velocity, displacement], POINTS)
    spectrum = motion.spectrum(PERIODS)
    first = None
    if built is not None and built.properties.n_modes:
        first = 2.0 * np.pi / float(built.properties.omega[0])
    measures: list[dict[str, Any]] = [
        *(_fact(measure, measure.of(Shaking(motion)), measure.words) for measure in record_measures()),
        {"name": "Duration", "value": motion.duration, "unit": "s", "help": "length of the record"},
        {"name": "Step", "value": motion.dt, "unit": "s", "help": "sampling step"},
    ]
    if first is not None and built is not None:
        zeta, of_mode = float(built.properties.zeta[0]), MEASURES["sa_t1"]
        words = f"{of_mode.words} at the first period and its damping, {zeta:.3g}"
        measures.append(_fact(of_mode, motion.sa(first, zeta), words))
    return plain(
        {
            "name": motion.name,
            "title": _title(motion),
            "measures": measures,
            "t": pack(motion.time[kept]),
            "acceleration": pack(motion.acceleration[kept]),
            "velocity": pack(velocity[kept]),
            "displacement": pack(displacement[kept]),
            "periods": pack(PERIODS),
            "sa": pack(spectrum.sa),
            "first_period": first,
            "lifting": _lifting(built),
        }
    )


def _fact(measure: Measure, value: float, words: str) -> dict[str, Any]:
    return {"name": measure.head, "value": value, "unit": measure.unit, "help": words}


def _lifting(built: Built | None) -> float | None:
    return None if built is None else built.properties.resisting_moment / built.properties.l0r


def _title(motion: GroundMotion) -> str:
    info = motion.metadata
    if info is None:
        return ""
    parts = (info.event, info.year, info.station, info.component)
    return ", ".join(str(part) for part in parts if part is not None)
