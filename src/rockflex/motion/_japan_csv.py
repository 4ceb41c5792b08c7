"""Records as CSV from Japan: K-NET and KiK-net of NIED, and the network of the meteorological agency, JMA.

Both state the frequency of the samples and their unit, gal. NIED also states the offset of each component, which is
subtracted. Format of NIED: https://www.kyoshin.bosai.go.jp/kyoshin/man/knetform_en.html
"""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.motion import _text
from rockflex.motion._findings import Evidence, quoted_line
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._knet import JAPAN_OFFSET, knet_record_info
from rockflex.motion._record_info import RecordInfo, component_record_names, found_component
from rockflex.motion._recorded import recorded_motion
from rockflex.motion._units import acceleration_unit

KNET_MARK, JMA_MARK = "#K-NET CSV", "SITE CODE="
TIME_COLUMNS = 2  # of K-NET, before the components: the time, and the time since the start
# What stands two lines below these marks, by the names in K-NET's other format.
SECTIONS = {
    "#Event": ("Origin Time", "Lat.", "Lon.", "Depth (km)", "Mag."),
    "#Station": ("Station Code", "Station Lat.", "Station Lon.", "Station Height(m)"),
}
LABEL = re.compile(r"\s*+([^(]*+)\(([^)]*+)\)")  # N-S(gal)
MAX_DRIFT, ROUNDING = 0.49, 0.0051  # of a step, and in s: of a time from that by the frequency


def is_knet_csv(lines: list[str]) -> bool:
    """Return whether the lines begin as a CSV file of K-NET does."""
    return lines[0].startswith(KNET_MARK)


def is_jma_csv(lines: list[str]) -> bool:
    """Return whether the lines begin as a file of JMA does."""
    return lines[0].lstrip().startswith(JMA_MARK)


def parse_knet_csv(file: Path, lines: list[str]) -> list[GroundMotion]:
    """Build the motions of all components from the lines of a CSV file of K-NET, without the offsets in its header."""
    start = next((i for i, line in enumerate(lines) if not line.startswith("#")), len(lines))
    offset_line, offsets = _line_after(file, lines[:start], "#N-S(gal)")
    rate_line, rate = _line_after(file, lines[:start], "#SamplingFrequency")
    duration_line, duration = _line_after(file, lines[:start], "#DurationTime")
    header: dict[str, str] = {}
    for mark, names in SECTIONS.items():
        values = _line_after(file, lines[1:start], _line_after(file, lines[:start], mark)[1])[1]
        header |= zip(names, values.lstrip("#").split(","), strict=False)
    labels = lines[start - 1].split(",")[TIME_COLUMNS:]
    rows = _rows(file, lines, start, TIME_COLUMNS + len(labels), skipped=1)
    dt = _step(file, rate.lstrip("#"), f"{quoted_line(rate_line - 1, lines[rate_line - 2])}, {rate.lstrip('#')}")
    late = np.abs(rows[:, 0] - rows[0, 0] - dt.value * np.arange(len(rows))) > max(MAX_DRIFT * dt.value, ROUNDING)
    if np.any(late):
        k = int(np.argmax(late))
        raise InputError(
            f"{file}, line {start + k + 1}: the time {rows[k, 0]:g} s does not fit the frequency in line {rate_line}, "
            f"{rate.lstrip('#')} Hz. Download the record again."
        )
    seconds = _text.parse_decimal(duration.lstrip("#"), file, duration_line)
    if abs(len(rows) * dt.value - seconds) > 1.0:
        raise _text.wrong_sample_count_error(file, len(rows), seconds / dt.value, f"{seconds:g} s at {rate[1:]} Hz")
    offset = [_text.parse_decimal(each.strip(), file, offset_line) for each in offsets.lstrip("#").split(",")]
    if len(offset) != len(labels):
        raise InputError(
            f"{file}, line {offset_line}: {len(labels)} offsets are expected, but found {len(offset)}. Download the "
            "record again."
        )
    info = replace(
        knet_record_info(header),
        start_time=f"{lines[start].split(',')[0].strip().replace('/', '-').replace(' ', 'T')}{JAPAN_OFFSET}",
        source_format="K-NET CSV",
        processing="offset of the header subtracted",
    )
    said = quoted_line(start, lines[start - 1])
    return _motions(file, rows[:, TIME_COLUMNS - 1 :] - offset, labels, said, said, dt, info)


def parse_jma_csv(file: Path, lines: list[str]) -> list[GroundMotion]:
    """Build the motions of all components from the lines of a file of JMA."""
    entries = {line.partition("=")[0].strip(): i for i, line in enumerate(lines[:10]) if "=" in line}
    missing = [each for each in ("SAMPLING RATE", "UNIT") if each not in entries]
    start = max(entries.values()) + 2
    if missing or start > len(lines):
        raise InputError(f"{file} begins as a file of JMA, but lacks {' and '.join(missing) or 'its samples'}.")
    header = {name: lines[i].partition("=")[2].strip() for name, i in entries.items()}
    said = {name: quoted_line(i + 1, lines[i]) for name, i in entries.items()}
    dt = _step(file, re.sub("(?i)hz", "", header["SAMPLING RATE"]).strip(), said["SAMPLING RATE"])
    unit = header["UNIT"].partition("(")[0]
    labels = [f"{name}({unit})" for name in lines[start - 1].strip().split(",")]
    rows = _rows(file, lines, start, len(labels))
    when = re.findall(r"\d++", header.get("INITIAL TIME", ""))
    info = RecordInfo(
        year=int(when[0]) if when else None,
        station=re.sub(r"\D.*", "", header["SITE CODE"]) or None,
        network="JMA",
        start_time=f"{'-'.join(when[:3])}T{':'.join(when[3:6])}{JAPAN_OFFSET}" if len(when) >= 6 else None,
        source_format="JMA",
    )
    return _motions(file, rows, labels, quoted_line(start, lines[start - 1]), said["UNIT"], dt, info)


def _line_after(file: Path, heads: list[str], mark: str) -> tuple[int, str]:
    """Return the number and the text of the line after the first one that begins with a mark."""
    place = next((i for i, head in enumerate(heads[:-1]) if head.startswith(mark)), None)
    if place is None:
        raise InputError(f"{file} begins as a CSV file of K-NET, but has no line {shown(mark)}. Download it again.")
    return place + 2, heads[place + 1].strip()


def _rows(file: Path, lines: list[str], start: int, n_columns: int, skipped: int = 0) -> Array:
    """Return the numbers in rows of so many cells, without the first ones, which are skipped."""
    found: list[list[float]] = []
    for i, line in enumerate(lines[start:], start + 1):
        if not line.strip():
            continue
        cells = line.split(",")
        if len(cells) != n_columns:
            raise InputError(
                f"{file}, line {i}: {n_columns} columns are expected, but found {len(cells)}. Download the record "
                "again."
            )
        found.append([_text.parse_decimal(cell.strip(), file, i) for cell in cells[skipped:]])
    if not found:
        raise InputError(f"{file} is truncated: no samples follow its header. Download the record again.")
    return np.array(found)


def _step(file: Path, rate: str, said: str) -> Evidence[float]:
    frequency = _text.parse_optional_decimal(rate)
    if not frequency or frequency < 0.0:
        raise InputError(f"{file}: a frequency in Hz is expected, but found {shown(rate)} ({said}).")
    return Evidence(float(f"{1.0 / frequency:.12g}"), said)


def _motions(
    file: Path, samples: Array, labels: list[str], said: str, unit_said: str, dt: Evidence[float], info: RecordInfo
) -> list[GroundMotion]:
    """Build a motion of each column; labels are as N-S(gal)."""
    motions: list[GroundMotion] = []
    parts = [LABEL.fullmatch(label.strip()) for label in labels]
    names = component_record_names(file.stem, [part[1].strip() if part else "" for part in parts])
    for k, (label, part, name) in enumerate(zip(labels, parts, names, strict=True)):
        unit = acceleration_unit(part[2]) if part else None
        if part is None or unit is None:
            raise InputError(
                f"{file}: a component with its unit is expected, such as N-S(gal), but found {shown(label)} ({said})."
            )
        component = found_component(file, Evidence(part[1].strip(), said), several=len(labels) > 1)
        quantity, remedy = f"format {info.source_format}", "Check the unit in the header."
        stated = Evidence(unit, unit_said), dt
        motions.append(recorded_motion(file, samples[:, k], quantity, *stated, component, info, remedy, name))
    return motions
