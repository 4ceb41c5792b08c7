"""Records in the formats that ObsPy reads: MiniSEED, SAC, GSE2, Kinemetrics EVT and others."""

import io
import warnings
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from rockflex.foundation.errors import InputError
from rockflex.motion._findings import Evidence, NoAccelerationError
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._record_info import RecordInfo, component_record_names, found_component
from rockflex.motion._recorded import MEAN_SUBTRACTED, recorded_motion
from rockflex.motion._units import AccelerationUnit

INSTALL = "For MiniSEED, SAC, GSE2 and other formats of seismology, install ObsPy: pip install 'rockflex[obspy]'."
UNSAFE_FORMATS = ("PICKLE",)  # reading it would run code that the file contains
# Formats that state the acceleration of one count, in m/s².
CALIBRATED = ("KINEMETRICS_EVT", "KNET")
VELOCITY_CODES = "HMP"  # the second letter of a channel of a velocity sensor
SAC_QUANTITIES = {6: "displacement", 7: "velocity", 8: "acceleration"}  # header field IDEP: IDISP, IVEL, IACC


class ObsPyError(InputError):
    """ObsPy takes a file for one of its formats, but cannot read it."""


def obspy_format(content: bytes) -> str | None:
    """Return the name that ObsPy has for the format of a file, or None if it knows none or is not installed."""
    if not is_obspy_installed():
        return None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # about the age of its dependencies, and about contents
        from obspy.core.util.base import ENTRY_POINTS
        from obspy.core.util.misc import buffered_load_entry_point

        for name, entry in ENTRY_POINTS["waveform"].items():
            if name in UNSAFE_FORMATS:
                continue
            try:
                group = f"obspy.plugin.waveform.{entry.name}"
                is_format: Any = buffered_load_entry_point("obspy", group, "isFormat")
                if is_format(io.BytesIO(content)):
                    return str(name)
            except Exception:  # a reader that fails does not know the file
                continue
    return None


def is_obspy_installed() -> bool:
    """Return whether ObsPy can be imported."""
    return find_spec("obspy") is not None


def parse_obspy(file: Path, content: bytes, form: str, units: AccelerationUnit | None) -> list[GroundMotion]:
    """Build the motions of all traces of a file; the mean of calibrated recorders is subtracted."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            import obspy

            stream: Any = obspy.read(io.BytesIO(content), format=form)
            stream.merge(method=0)
    except Exception as error:  # damaged files raise many kinds of errors
        raise ObsPyError(f"{file} cannot be read by ObsPy as {form}: {str(error)[:200]}.") from error
    traces = list(stream)
    if not traces:
        raise InputError(f"{file} holds no samples, according to ObsPy ({form}). Download the record again.")
    channels = [str(trace.stats.channel).strip() or "channel" for trace in traces]
    names = component_record_names(file.stem, channels)
    several = len(traces) > 1
    return [
        _motion_of_trace(file, trace, form, units, name, several=several)
        for trace, name in zip(traces, names, strict=True)
    ]


def _motion_of_trace(
    file: Path, trace: Any, form: str, units: AccelerationUnit | None, name: str, *, several: bool
) -> GroundMotion:
    channel = str(trace.stats.channel).strip().upper()
    quantity = _quantity_of_trace(file, trace, form, channel)
    if np.ma.isMaskedArray(trace.data):
        raise InputError(
            f"{file}: channel {channel} has a gap, but a record without gaps is expected. Cut it at the gap with ObsPy."
        )
    unit = _unit_of_trace(file, trace, form, units)
    # The numbers of a recorder's channels say nothing about directions.
    component = found_component(
        file, Evidence("" if channel.isdigit() else channel, f"channel {channel}"), several=several
    )
    dt = Evidence(float(f"{float(trace.stats.delta):.12g}"), f"header of {form}")
    info = RecordInfo(
        station=str(trace.stats.station).strip() or None,
        network=str(trace.stats.network).strip() or None,
        location=str(trace.stats.location).strip() or None,
        start_time=f"{trace.stats.starttime.datetime.isoformat()}+00:00",
        year=trace.stats.starttime.year,
        source_format=form,
        processing=MEAN_SUBTRACTED if form in CALIBRATED else None,
    )
    values = np.asarray(trace.data, dtype=np.float64)
    if form in CALIBRATED:
        values = values - values.mean()
    component = replace(component, name=channel or None, azimuth=component.azimuth if len(channel) == 3 else None)
    remedy = "Check the value of one count."
    return recorded_motion(file, values, quantity or unit.said, unit, dt, component, info, remedy, name)


def _quantity_of_trace(file: Path, trace: Any, form: str, channel: str) -> str:
    """Return what says that a trace is an acceleration; empty if only the unit given does."""
    if len(channel) == 3 and channel[1] in VELOCITY_CODES:
        raise NoAccelerationError(
            f"{file}: channel {channel} belongs to a velocity sensor, but an acceleration is expected. Give the "
            f"channel of the accelerometer, such as {channel[0]}N{channel[2]}.",
            found="velocity",
        )
    code = int(trace.stats.get("sac", {}).get("idep", 0))
    quantity = SAC_QUANTITIES.get(code)
    said = f"header field IDEP: {code}, {quantity}"
    if quantity not in (None, "acceleration"):
        raise NoAccelerationError(
            f"{file}: an acceleration is expected, but found a {quantity} ({said}). Give the file of the acceleration; "
            "or correct the field, if it is wrong.",
            found=str(quantity),
        )
    if quantity is not None:
        return said
    return f"format {form}" if form in CALIBRATED else f"channel {channel}" if channel[1:2] == "N" else ""


def _unit_of_trace(file: Path, trace: Any, form: str, units: AccelerationUnit | None) -> Evidence[AccelerationUnit]:
    if form in CALIBRATED:
        if units is None:
            return Evidence(AccelerationUnit("m/s2", float(trace.stats.calib)), f"calibration in the header of {form}")
        raise InputError(
            f"{file} states its own calibration ({form}), but units={str(units)!r} was given. Leave units out.",
            field="units",
        )
    if units is None:
        raise InputError(
            f"{file} ({form}) does not state the unit of its samples, which may be counts. Declare what the number 1 "
            'is: read_motion(path, units="2.4e-4 cm/s2"), or units="m/s2" if the instrument was corrected.',
            field="units",
        )
    return Evidence(units, f"units={units}")
