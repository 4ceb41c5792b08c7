"""Records whose values follow each other, in lines of any length, under a header with their number and time step."""

import re
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import number_with_noun
from rockflex.motion import _text
from rockflex.motion._declared import Declared
from rockflex.motion._findings import Evidence, Finding, quoted_line, shown_step
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._header import MAX_STEP, Header, header_of_lines
from rockflex.motion._record_info import RecordInfo, component_azimuth
from rockflex.motion._samples import (
    check_missing_values,
    finding_of_quantity,
    remedy_of_unit,
    settled_component,
    settled_quantity,
    settled_step,
    settled_unit,
)

# Numbers may be adjacent if the next one begins with a sign; an exponent must then end before the sign.
TOKEN = re.compile(r"[+-]?+(?:\d++\.?+\d*+|\.\d++)(?:[EeDd][+-]?\d{1,3}+)?(?=[\s,;+-]|$)")
MIN_STATED = 10  # values that a first line may count; a first sample is not the number of all others by chance
MIN_COLUMNS = 5  # values a line without labels, from which on they are a sequence and not components beside each other


@dataclass(frozen=True)
class Sequence:
    """Values in the order of the file, the line of each, and what is said of them."""

    values: Array
    lines: list[int]
    header: Header
    said: str  # why the values are read as a sequence


def find_sequence(file: Path, found: _text.NumericLines, given: Declared) -> Sequence | None:
    """Return the values of a file as a sequence, or None if they stand in columns.

    They are a sequence if the caller says so; if the first line is ``npts dt``; if the header states how many values
    there are, and they fill the lines; or if five and more stand in each line, under no labels.
    """
    if given.layout == "columns":
        return None
    header = header_of_lines(file, found.head_lines)
    first = _first_line(found)
    if first is not None:
        stated, skipped, said = first
        body = found.body[skipped:]
        merged = Header(
            header.quantities, header.units, [*header.steps, *stated.steps], stated.counts, header.components
        )
        return Sequence(*_samples(file, body), merged, said)
    if given.layout == "sequence":
        return Sequence(*_samples(file, found.body), header, 'layout="sequence"')
    widths = {len(content.split()) for _, content in found.body[:-1]}
    width = len(found.body[0][1].split())
    if width == 1 or len(widths) != 1 or "," in found.body[0][1] or ";" in found.body[0][1]:
        return None
    counts = {each.value for each in header.counts}
    rows, total = len(found.body), sum(len(content.split()) for _, content in found.body)
    if len(counts) == 1 and rows not in counts and (total in counts or width >= MIN_COLUMNS):
        return Sequence(*_samples(file, found.body), header, header.counts[0].said)
    if width >= MIN_COLUMNS and not counts and not _has_labels(found, width):
        return Sequence(*_samples(file, found.body), header, f"{width} values a line without labels")
    return None


def _has_labels(found: _text.NumericLines, width: int) -> bool:
    """Return whether a line above the numbers has as many words as they have columns."""
    last = next((text for _, text in reversed(found.head_lines) if text.strip()), "")
    words = re.split(r"[,;\s]\s*", last.strip().lstrip("#%! \t"))
    return len(words) == width or len(last.split("\t")) == width


def _first_line(found: _text.NumericLines) -> tuple[Header, int, str] | None:
    """Return what first lines of numbers say of the others: npts and dt, in one line or two; and how many they are."""
    rows = [content.replace(",", " ").split() for _, content in found.body[:3]]
    following = [len(content.split()) for _, content in found.body]
    one = [[_text.parse_optional_decimal(word) for word in row] for row in rows]
    if len(one[0]) == 1 and one[0][0] == sum(following[1:]) >= MIN_STATED:
        line, content = found.body[0]
        said = quoted_line(line, content)
        return Header(counts=[Evidence(sum(following[1:]), said)]), 1, said
    for skipped, words in ((1, one[0]), (2, [*one[0], *(one[1] if len(one) > 1 else [])])):
        if len(words) != 2 or None in words or (skipped == 2 and len(one[0]) != 1):
            continue
        left = sum(following[skipped:])
        numbers = [value for value in words if value is not None]
        for count, dt in (numbers, numbers[::-1]):
            if count == left >= 3 and 0.0 < dt <= MAX_STEP:
                line, content = found.body[0]
                said = quoted_line(line, content)
                return Header(counts=[Evidence(left, said)], steps=[Evidence(dt, said)]), skipped, said
    return None


def _samples(file: Path, body: list[tuple[int, str]]) -> tuple[Array, list[int]]:
    """Return the values in lines, and the line of each."""
    try:
        rows = [(i, [float(word) for word in content.split()]) for i, content in body]
        values = np.array([value for _, row in rows for value in row])
        if np.isfinite(values).all() and not any("_" in content for _, content in body):
            return values, [i for i, row in rows for _ in row]
    except ValueError:
        pass
    # The slow way: adjacent tokens, D exponents, or an error to report.
    found: list[float] = []
    lines: list[int] = []
    for i, content in body:
        before = len(found)
        for word in re.finditer(r"[^\s,;]+", content):
            position = word.start()
            while position < word.end():
                token = TOKEN.match(content, position)
                if token is None:
                    found.append(_text.parse_decimal(content[position : word.end()], file, i))
                    break
                found.append(_text.parse_decimal(token[0], file, i))
                position = token.end()
        lines += [i] * (len(found) - before)
    return np.array(found), lines


def numbers_in_lines(file: Path, lines: list[str], start: int) -> tuple[Array, list[int]]:
    """Return all numbers from a line on, and the line of each."""
    return _samples(file, [(i, line) for i, line in enumerate(lines[start:], start + 1) if line.strip()])


def motion_of_sequence(
    file: Path, found: Sequence, given: Declared, info: RecordInfo, *, trusted: bool = False
) -> GroundMotion:
    """Build the motion from values in sequence; `info` is what else is known, and `trusted` as for `settled_step`."""
    header, values = found.header, found.values
    quantity = settled_quantity(file, [], header)
    counts = {each.value for each in header.counts}
    if len(counts) > 1:
        one, other = header.counts[0], next(each for each in header.counts if each.value != header.counts[0].value)
        raise InputError(
            f"{file} contradicts itself about the number of values: {one.said}, but {other.said}. Correct the header."
        )
    if counts and counts != {values.size}:
        stated = header.counts[0]
        raise _text.wrong_sample_count_error(file, values.size, stated.value, f"{stated.value} ({stated.said})")
    unit = settled_unit(file, [], header, given, columns=False)
    missing = f"{number_with_noun(values.size, 'value')} in sequence and no times"
    step = settled_step(file, header.steps, given, missing, trusted=trusted)
    check_missing_values(file, values, found.lines)
    way = settled_component(file, None, header.components)
    findings = [
        finding_of_quantity(quantity, unit),
        unit.finding("unit"),
        step.finding("time step", shown_step(step.value)),
    ]
    findings += info.findings or ([] if way.finding is None else [way.finding])
    findings.append(Finding("samples", f"{values.size} in sequence", found.said))
    own = RecordInfo(
        component=way.name or None,
        direction=way.direction,
        azimuth=component_azimuth(way.name),
        source=file.name,
        source_format="sequence",
        findings=tuple(findings),
    )
    known = replace(info.completed(own), findings=tuple(findings))
    return _text.motion_from_samples(file, values, unit.value, step.value, known, remedy_of_unit(unit))
