"""Records of networks whose files the package gmprocess of the U.S. Geological Survey reads, in cm/s².

Its readers trust that a file has the lines that they expect, so what the header states is compared with what they read.
"""

import importlib
import logging
import re
import warnings
from collections.abc import Generator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from rockflex.foundation.errors import InputError
from rockflex.motion._findings import Evidence, quoted_line
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._record_info import RecordInfo, component_record_names, found_component
from rockflex.motion._recorded import UNCORRECTED, printed_peak, recorded_motion
from rockflex.motion._units import NUMBER, AccelerationUnit

PACKAGE = "gmprocess"
HEAD_LINES, MAX_LINE = 20, 200  # that tell the network, and characters of a line
UNIT = AccelerationUnit("cm/s2")
EPOCH_YEAR = 1970  # stands for no time
MAX_STEP_MISMATCH = 1e-3  # relative; some of the readers divide a duration by one step too few
# What headers state: the number of samples, their duration and step in s, and frequency in Hz.
COUNT = re.compile(r"(?:NO\. OF POINTS\s*+=|NUMBER OF DATA\s*+:|NUM\. TOTAL DE MUESTRAS, C1-C6\s*+:\s*+/)\s*+(\d{1,9})")
DURATION = re.compile(rf"(?:DURATION|RECORD LENGTH|#RecordLength\(sec\))\s*+[=:]\s*+({NUMBER})")
STEP = re.compile(rf"(?:SAMPLING INTERVAL \(sec\)|INTERVALO DE MUESTREO, C1-C6 \(s\))\s*+:\s*+/?+({NUMBER})")
RATE = re.compile(rf"#SampleRate\(Hz\)\s*+:\s*+({NUMBER})")
# The peaks of all components in a line, or those of each in a line of its own; in g or gal.
PEAKS = re.compile(
    r"(?:#AmplitudeMAX\.\s*+[UNE]:|RAW PGA VALUES \((gal)\)\s*+:|ACEL\. MAX\.\((Gal)\), C1-C6\s*+:|\bMAX\s*+=)"
    r"([^G]*+)(G)?+"
)


@dataclass(frozen=True)
class Network:
    """A network, with its country and a pattern in the first lines of its files, and of no others."""

    name: str
    owner: str
    mark: str
    is_read: bool = True  # by gmprocess

    def knows(self, lines: list[str]) -> bool:
        """Return whether lines begin as a file of the network does."""
        head = "\n".join(line[:MAX_LINE] for line in lines[:HEAD_LINES])
        return re.search(self.mark, head, re.MULTILINE) is not None


NETWORKS = (
    Network("BHRC", "Iran's BHRC", r"\A\s*+\* VOL\w++ FILE:"),
    Network("CSMNC", "China's CSMNC", r"^(?:NO\. OF POINTS:.*EQUALLY SPACED INTERVALS OF:|CSMNC\s*+$)", is_read=False),
    Network("CWB", "Taiwan's CWB", r"\A#(?:Earthquake Information|StationCode:)"),
    Network("ISESD", "Europe's ISESD", r"\A\s*+file:.*\n\s*+earthquake code:", is_read=False),
    Network("NSMN", "Turkey's NSMN", r"\A\s*+STRONG GROUND MOTION RECORDS OF TURK"),
    Network("RENADIC", "Chile's RENADIC", r"^UNIVERSIDAD DE CHILE - RENADIC"),
    Network("SIGMA", "the SIGMA project", r"\A\s*+Event Date & Time\s*+:.*\n\s*+Station Code / Name", is_read=False),
    Network("UNAM", "Mexico's UNAM", r"^ARCHIVO EST[AÁ]NDAR DE ACELERACI[OÓ]N"),
    Network("USC", "California's USC", r"\A\s*+FILE\s++\d++ OF UNCORRECTED ACCELEROGRAM DATA|^STATION USC#"),
)


def is_of_another_network(lines: list[str]) -> bool:
    """Return whether lines begin as a file of one of these networks does."""
    return any(each.knows(lines) for each in NETWORKS)


def is_gmprocess_installed() -> bool:
    """Return whether gmprocess can be imported."""
    return find_spec(PACKAGE) is not None


def parse_network(file: Path, lines: list[str], *, network: Network, use_gmprocess: bool) -> list[GroundMotion]:
    """Build the motions of all components in a file of a network; `use_gmprocess` tells whether it may be used."""
    if not network.is_read:
        raise InputError(
            f"{file}: this is a file of {network.owner}, which is not read, nor is it by {PACKAGE}. Copy its numbers "
            'into a file of their own, one a line, and give what its header states: read_motion(path, units="cm/s2", '
            "dt=0.005)."
        )
    if not use_gmprocess or not is_gmprocess_installed():
        raise InputError(
            f"{file}: this is a file of {network.owner}. USGS's {PACKAGE} reads it: pip install 'rockflex[{PACKAGE}]', "
            "with Python 3.11 to 3.13."
        )
    traces = _traces(file, network)
    channels = [str(trace.stats.channel) for trace in traces]
    names = component_record_names(file.stem, channels)
    peaks = _stated_peaks(lines, len(traces))
    motions: list[GroundMotion] = []
    for k, (trace, channel, name) in enumerate(zip(traces, channels, names, strict=True)):
        values = np.asarray(trace.data, dtype=np.float64)
        dt = _checked_step(file, lines, trace, values.size)
        component = found_component(file, Evidence(channel, f"channel {channel}"), several=len(traces) > 1)
        azimuth = float(trace.stats.standard.horizontal_orientation)
        along = component.direction == "horizontal" and np.isfinite(azimuth)
        component = replace(component, azimuth=azimuth if along else None)
        info = replace(
            _trace_info(trace),
            source_format=network.name,
            stated_pga=printed_peak(*peaks[k], values, UNIT) if peaks else None,
        )
        quantity, remedy = f"format {network.name}", "Check the unit in the header."
        motions.append(
            recorded_motion(file, values, quantity, Evidence(UNIT, PACKAGE), dt, component, info, remedy, name)
        )
    return motions


def _traces(file: Path, network: Network) -> list[Any]:
    """Return what gmprocess reads from a file."""
    module = network.name.lower()
    try:
        with _quietly():
            reader = importlib.import_module(f"{PACKAGE}.io.{module}.core")
            streams = getattr(reader, f"read_{module}")(str(file))
        traces = [trace for stream in streams for trace in stream]
        if not traces:
            raise ValueError("it holds no samples")
        units = {str(trace.stats.standard.units).replace("^2", "2").replace("/s/s", "/s2") for trace in traces}
        if units != {str(UNIT)}:
            raise ValueError(f"samples in {', '.join(sorted(units))}, not in cm/s²")
        if not all(np.all(np.isfinite(trace.data)) for trace in traces):
            raise ValueError("values that are no numbers")
    except (KeyboardInterrupt, SystemExit):
        raise
    except BaseException as error:  # it raises errors of many kinds, and that one
        raise InputError(
            f"{file} is a file of {network.owner}, but {PACKAGE} cannot read it: {str(error)[:200]}. Download "
            "the record again."
        ) from error
    return traces


@contextmanager
def _quietly() -> Generator[None]:
    """Keep gmprocess from warnings, and from setting up the log of the process and writing there."""
    root, quiet, level = logging.getLogger(), logging.NullHandler(), logging.root.manager.disable
    root.addHandler(quiet)
    logging.disable(logging.WARNING)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    finally:
        logging.disable(level)
        root.removeHandler(quiet)


def _stated(lines: list[str], pattern: re.Pattern[str]) -> Evidence[float] | None:
    """Return the first positive number that a header states, with its line."""
    for i, line in enumerate(lines, 1):
        if (found := pattern.search(line[:MAX_LINE])) and float(found[1]) > 0.0:
            return Evidence(float(found[1]), quoted_line(i, line))
    return None


def _stated_peaks(lines: list[str], n_traces: int) -> list[tuple[str, str]]:
    """Return the peaks of the components in a header, with their units; none if they are not as many."""
    rows = [found for line in lines if (found := PEAKS.search(line[:MAX_LINE]))]
    found = [(re.findall(NUMBER, row[3]), row[1] or row[2] or row[4] or "gal") for row in rows]
    peaks = [(max(row, key=lambda each: abs(float(each))), unit) for row, unit in found if row]
    if len(found) == 1:
        peaks = [(each, unit) for row, unit in found for each in row]
    return peaks if len(peaks) == n_traces else []


def _checked_step(file: Path, lines: list[str], trace: Any, n_samples: int) -> Evidence[float]:
    """Return the step of a trace as its header states it; the number of samples must be that of the header, too."""
    read = float(trace.stats.delta)
    count, duration = _stated(lines, COUNT), _stated(lines, DURATION)
    resampled = bool(trace.get_provenance("resample"))
    dt, rate = _stated(lines, STEP), _stated(lines, RATE)
    if rate is not None:
        dt = Evidence(1.0 / rate.value, rate.said)
    if resampled:
        dt, count = Evidence(float(f"{read:.12g}"), f"{PACKAGE}, which resamples unequal steps"), None
    elif dt is None and count is not None and duration is not None:
        dt = Evidence(float(f"{duration.value / count.value:.6g}"), duration.said)
    said = count or duration
    if dt is None or said is None or abs(dt.value - read) > MAX_STEP_MISMATCH * read:
        raise InputError(f"{file}: {PACKAGE} reads a step of {read:g} s, which the header does not state.", field="dt")
    length = duration is None or abs(n_samples * dt.value - duration.value) <= 2.0 * dt.value
    if not length or (count is not None and n_samples != count.value):
        raise InputError(
            f"{file}: {PACKAGE} reads {n_samples} samples of {dt.value:g} s, which is not what the header states "
            f"({said.said}). Download the record again."
        )
    return dt


def _trace_info(trace: Any) -> RecordInfo:
    stats = trace.stats
    begin = stats.starttime.datetime
    known = begin.year > EPOCH_YEAR
    done = [
        *([UNCORRECTED] if UNCORRECTED in str(stats.standard.process_level) else []),
        *(["resampled to equal steps"] if trace.get_provenance("resample") else []),
    ]
    return RecordInfo(
        year=begin.year if known else None,
        station=str(stats.station).strip() or None,
        network=str(stats.network).strip() or None,
        start_time=f"{begin.isoformat()}+00:00" if known else None,
        processing="; ".join(done) or None,
    )
