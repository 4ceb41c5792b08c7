"""Records in the COSMOS strong-motion format: channels, each with headers of text, integers and real numbers.

Format: Consortium of Organizations for Strong-Motion Observation Systems, COSMOS Strong Motion Data Format, version
1.20 (2001).
"""

import re
from pathlib import Path

import numpy as np

from rockflex._arrays import Array
from rockflex._errors import InputError
from rockflex.motion._cosmos_header import Channel, info_of, step_of, unit_of
from rockflex.motion._direction import told_apart
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._text import build_motion, number

FIRST = re.compile(r"\(Format\s*+v[\d.]++\s*+with\s*+(\d{1,3})\s*+text lines\)", re.IGNORECASE)
BLOCK = re.compile(r"\s*+(\d{1,9})\s++(\w++(?:-header)?+)", re.IGNORECASE)
FORMAT = re.compile(r"Format\s*+=\s*+\(\s*+(\d{0,3}+)[IFEGD](\d{1,3}+)", re.IGNORECASE)


def is_cosmos(lines: list[str]) -> bool:
    """Return whether the lines begin as those of a COSMOS file."""
    return FIRST.search(lines[0][:500]) is not None


def parse_cosmos(file: Path, lines: list[str]) -> list[GroundMotion]:
    """Build the motions of all channels of acceleration in a COSMOS file; other series are passed over.

    From raw counts the mean is subtracted.
    """
    channels = [each for each in _channels(file, lines) if each.values is not None]
    if not channels:
        raise InputError(
            f"{file} is a COSMOS file without a series of acceleration. Give the file of the acceleration."
        )
    infos = [info_of(file, each) for each in channels]
    names = told_apart([info.component or "channel" for info in infos])
    motions: list[GroundMotion] = []
    for channel, info, name in zip(channels, infos, names, strict=True):
        values = np.zeros(0) if channel.values is None else channel.values
        if info.processing is not None and values.size:
            values = values - values.mean()
        unit, step = unit_of(file, channel), step_of(file, channel, values.size)
        whole = file.stem if len(channels) == 1 else f"{file.stem}-{name}"
        remedy = "Check the units in the integer header."
        motions.append(build_motion(file, values, unit, step, info, remedy, whole))
    return motions


def _channels(file: Path, lines: list[str]) -> list[Channel]:
    found: list[Channel] = []
    i = 0
    while i < len(lines):
        first = FIRST.search(lines[i][:500])
        block = BLOCK.match(lines[i])
        if first:
            found.append(Channel(lines[i : i + int(first[1])]))
            i += max(1, int(first[1]))
        elif block is None or not found:
            i += 1  # the end of the data of a channel, or a blank line
        elif block[2].lower() == "comment":
            i += 1 + int(block[1])
        else:
            i = _take(file, lines, i, block, found[-1])
    return found


def _take(file: Path, lines: list[str], i: int, block: re.Match[str], channel: Channel) -> int:
    """Store the numbers that a line announces, and return the number of the line after them."""
    form = FORMAT.search(lines[i][:500])
    if form is None or not int(form[2]):
        raise InputError(
            f'{file}, line {i + 1}: a format of numbers is expected, such as "Format=(8F10.3)". Download the record '
            "again."
        )
    count, columns = int(block[1]), int(form[1] or 1)
    end = i + 1 + -(-count // max(columns, 1))
    match block[2].lower():
        case "integer-header":
            channel.integers = _numbers(file, lines, i + 1, end, count, int(form[2]))
        case "real-header":
            channel.reals = _numbers(file, lines, i + 1, end, count, int(form[2]))
        case "acceleration":
            channel.values = _numbers(file, lines, i + 1, end, count, int(form[2]))
            channel.announced = lines[i]
        case _:
            pass  # velocity, displacement
    return end


def _numbers(file: Path, lines: list[str], begin: int, end: int, count: int, width: int) -> Array:
    """Return numbers in fields of equal width."""
    found: list[float] = []
    for i in range(begin, min(end, len(lines))):
        line = lines[i].rstrip()
        if line.startswith("End-of-data"):
            break
        found += [number(line[k : k + width].strip(), file, i + 1) for k in range(0, len(line), width)]
    if len(found) != count:
        raise InputError(
            f"{file}, line {begin}: {count} numbers are announced, but {len(found)} follow. The file is truncated or "
            "was changed: download the record again."
        )
    return np.array(found)
