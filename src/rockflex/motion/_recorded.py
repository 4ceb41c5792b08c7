"""Common parts of the readers of networks: a motion that says what it is, and peaks in headers."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.motion._findings import Evidence, Finding
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._record_info import FoundComponent, RecordInfo
from rockflex.motion._text import motion_from_samples
from rockflex.motion._units import AccelerationUnit, acceleration_unit

UNCORRECTED, MEAN_SUBTRACTED = "uncorrected", "mean subtracted"  # in `RecordInfo.processing`


def recorded_motion(
    file: Path,
    values: Array,
    quantity: str,
    unit: Evidence[AccelerationUnit],
    dt: Evidence[float],
    component: FoundComponent,
    info: RecordInfo,
    remedy: str,
    name: str | None = None,
) -> GroundMotion:
    """Build a motion whose metadata have the component and what says what the samples are; `quantity` is one of these.

    `info` has all else, and `remedy` is for a peak that is too high.
    """
    found = replace(
        info,
        component=component.name,
        direction=component.direction,
        azimuth=component.azimuth,
        source=file.name,
        findings=(
            Finding("quantity", "acceleration", quantity),
            unit.finding("unit"),
            dt.finding("time step", f"{dt.value:g} s"),
            *component.findings,
        ),
    )
    return motion_from_samples(file, values, unit.value, dt.value, found, remedy, name)


def printed_peak(number: str, unit: str, values: Array, values_unit: AccelerationUnit) -> float | None:
    """Return a peak that a header prints, in m/s²; that of the samples, if it rounds to the printed one.

    Few digits would otherwise look like another record. None if the unit is none of acceleration.
    """
    known = acceleration_unit(unit)
    if known is None:
        return None
    stated, half = abs(float(number)), 0.5 * 10.0 ** -len(number.partition(".")[2])
    peak = float(np.max(np.abs(values), initial=0.0)) * values_unit.si / known.si
    return (peak if abs(peak - stated) <= 1.001 * half else stated) * known.si
