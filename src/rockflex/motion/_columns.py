"""Records as columns of numbers: CSV and plain text."""

import re
from pathlib import Path

import numpy as np

from rockflex._arrays import Array
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.motion._direction import direction_of
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._record_info import RecordInfo
from rockflex.motion._text import DECIMAL, acceleration_of, build_motion, number

SPELLING = re.compile(r"g|gals?|(c?m)(?:s-2|/(s|sec)(?:2|/\2))")  # with g, m or cm, and gal for cm/s²
SECONDS = ("s", "sec", "secs", "second", "seconds")
UPWARDS = re.compile(
    r"(?:acc[a-z]*+[\s_-]++)?(?:ver|vert|vertical|up|ud)(?![a-z])|acc[a-z]*+[\s_-]++[vz](?![a-z])", re.I
)
BRACKET = re.compile(r"[(\[]([^)\]]*+)[)\]]")


def parse_columns(file: Path, lines: list[str], units: str | None, dt: float | None) -> GroundMotion:
    """Build the motion from rows of numbers."""
    labels, rows = _split(file, lines)
    n_columns = len(rows[0][1])
    time_column, column = _choose(file, labels, n_columns)
    stated = _stated_unit(file, labels[column] if labels else "", units)
    values = np.array([number(cells[column], file, line) for line, cells in rows])
    if time_column is None:
        if dt is None:
            raise InputError(
                f"{file} has one column and no times: give the sampling step, read_motion(path, dt=0.01).", field="dt"
            )
        step = dt
    else:
        if labels:
            _check_seconds(file, labels[time_column])
        times = np.array([number(cells[time_column], file, line) for line, cells in rows])
        step = _step(file, times, [line for line, _ in rows], dt)
    remedy = 'Declare the unit of the file: units="m/s2" or units="cm/s2".'
    alone = bool(labels) and UPWARDS.match(labels[column])
    info = RecordInfo(source=file.name, direction="vertical" if alone else direction_of(file))
    motion = build_motion(file, values, stated, step, info, remedy)
    upwards = _vertical_column(file, labels)
    if upwards is None:
        return motion
    stated = _stated_unit(file, labels[upwards], units)
    values = np.array([number(cells[upwards], file, line) for line, cells in rows])
    return motion.with_vertical(acceleration_of(file, values, stated, remedy))


def _split(file: Path, lines: list[str]) -> tuple[list[str], list[tuple[int, list[str]]]]:
    """Return the column labels (empty if there are none) and the numbered rows of cells."""
    rows: list[tuple[int, list[str]]] = []
    heads: list[str] = []
    plain: list[tuple[int, str]] = []  # header lines that are not comments
    separator: str | None = None
    for i, line in enumerate(lines, 1):
        content = re.split("[#%!]", line, maxsplit=1)[0].strip()
        if not rows:
            if not content or not _is_number(re.split(r"[;,\s]", content, maxsplit=1)[0]):
                heads.append(line.strip().lstrip("#%! \t"))
                plain.append((i, content))
                continue
            separator = next((mark for mark in (";", ",") if mark in content), None)
        if not content:
            continue
        cells = [cell.strip() for cell in content.split(separator)]
        if separator and cells[-1] == "":
            cells.pop()
        if rows and len(cells) != len(rows[0][1]):
            raise InputError(
                f"{file}, line {i}: expected {len(rows[0][1])} columns as in line {rows[0][0]}, but found {len(cells)}."
            )
        rows.append((i, cells))
    if not rows:
        raise InputError(f"{file} holds no numbers: a record is expected as AT2, CSV or columns of text.")
    for i, content in plain:
        cells = _labels(content, separator)
        # A row of numbers with a typing error is not a header, and must not be skipped.
        if len(cells) == len(rows[0][1]) and any(re.match(r"[+-]?\.?\d", cell) for cell in cells):
            number(next(cell for cell in cells if not _is_number(cell)), file, i)
    for head in reversed(heads):
        labels = _labels(head, separator)
        if len(labels) == len(rows[0][1]) and any(re.search("[a-zA-Z]", label) for label in labels):
            return labels, rows
    return [], rows


def _labels(head: str, separator: str | None) -> list[str]:
    if separator is None:
        # There may be a blank between a label and its unit in brackets, and inside the unit.
        end = _after_brackets(head)
        head = BRACKET.sub(lambda unit: unit[0].replace(" ", ""), head[:end]) + head[end:]
        head = re.sub(r"(?<!\s)\s++(?=[(\[])", "", head)
        return re.split(r"[;,\s]\s*", head)
    cells = [cell.strip().strip('"') for cell in head.split(separator)]
    return cells[:-1] if cells[-1] == "" else cells


def _after_brackets(text: str) -> int:
    """Return the end of the last closing bracket, so that no regular expression searches beyond it in vain."""
    return max(text.rfind(")"), text.rfind("]")) + 1


def _choose(file: Path, labels: list[str], n_columns: int) -> tuple[int | None, int]:
    """Return the columns of time (None if there is none) and acceleration."""
    times = [i for i, label in enumerate(labels) if re.match(r"t(ime)?\b", label, re.IGNORECASE)]
    upwards = _vertical_columns(labels)
    accelerations = [i for i, label in enumerate(labels) if re.match("acc", label, re.I) and i not in upwards]
    if len(accelerations) == 1 and len(times) == 1:
        return times[0], accelerations[0]
    if n_columns <= 2:
        time = None if n_columns == 1 else 1 if times == [1] else 0
        column = 1 if time == 0 else 0
        if labels and re.match("vel|dis", labels[column], re.IGNORECASE):
            raise InputError(
                f"{file}: an acceleration is expected, but the column is labelled {shown(labels[column])}."
            )
        return time, column
    raise InputError(
        f"{file} has {n_columns} columns, and its header does not name one as time and exactly one as "
        'acceleration ("time (s), acc (g), ..."). Keep the columns time and acceleration; a vertical one may be '
        'added as "vertical (g)".'
    )


def _vertical_columns(labels: list[str]) -> list[int]:
    """Return the columns of vertical acceleration beside the time and a horizontal one."""
    return [i for i, label in enumerate(labels) if UPWARDS.match(label)] if len(labels) > 2 else []


def _vertical_column(file: Path, labels: list[str]) -> int | None:
    found = _vertical_columns(labels)
    if len(found) > 1:
        names = ", ".join(shown(labels[i]) for i in found)
        raise InputError(f"{file}: the header names {len(found)} columns as vertical, {names}. Keep one of them.")
    return found[0] if found else None


def _stated_unit(file: Path, label: str, units: str | None) -> str:
    """Return the unit stated by the label or the caller; both must agree."""
    bracket = BRACKET.search(label, 0, _after_brackets(label))
    written = bracket[1] if bracket else ""
    plain = re.sub(r"[\s^*·.]", "", written.lower().replace("²", "2").replace("−", "-"))
    spelling = SPELLING.fullmatch(plain)
    stated = spelling and ("g" if plain == "g" else f"{spelling[1] or 'cm'}/s2")
    if written and stated is None:
        raise InputError(
            f"{file}: the column header gives the unit {shown(written)}, which is not known. "
            "Write it as g, m/s2 or cm/s2, and convert the values if necessary."
        )
    if stated and units and stated != units:
        raise InputError(
            f"{file}: the column header says {stated}, but units={shown(units)} was given. Leave units out.",
            field="units",
        )
    if stated or units:
        return stated or str(units)
    raise InputError(
        f"{file} does not state the unit of its acceleration. Declare it: "
        'read_motion(path, units="g"), "m/s2" or "cm/s2"; or label the column "acc (g)".',
        field="units",
    )


def _check_seconds(file: Path, label: str) -> None:
    bracket = BRACKET.search(label, 0, _after_brackets(label))
    if bracket and bracket[1].strip().lower() not in SECONDS:
        raise InputError(
            f"{file}: the times are in {shown(bracket[1])}, but seconds are expected. Convert the column to s."
        )


def _step(file: Path, times: Array, lines: list[int], dt: float | None) -> float:
    """Return the common time step in s."""
    if times.size < 3:
        raise InputError(f"{file} has {times.size} samples, but a record needs at least 3.")
    steps = np.diff(times)
    if np.any(steps <= 0):
        k = int(np.argmax(steps <= 0))
        raise InputError(
            f"{file}, line {lines[k + 1]}: time must increase, but it goes from {times[k]:g} s to "
            f"{times[k + 1]:g} s. The first of two columns is taken as the time."
        )
    if dt is not None:
        away = np.abs(times - times[0] - dt * np.arange(times.size)) >= 0.5 * dt
        if np.any(away):
            k = int(np.argmax(away))
            raise InputError(
                f"{file}, line {lines[k]}: the time {times[k]:g} s does not fit dt={shown(dt)} s. "
                "Leave dt out, or remove the column of times.",
                field="dt",
            )
        return dt
    uneven = np.abs(steps - steps[0]) > 1e-3 * steps[0]
    if np.any(uneven):
        k = int(np.argmax(uneven))
        raise InputError(
            f"{file}, line {lines[k + 1]}: the time step is {steps[k]:.6g} s, but {steps[0]:.6g} s before. "
            "Equal steps are expected: resample the record, for example with numpy.interp. If the printed times are "
            "only rounded, give the step: read_motion(path, dt=...).",
            field="dt",
        )
    # The mean is better than one printed difference; twelve digits remove the rounding of the subtraction.
    return float(f"{(times[-1] - times[0]) / (times.size - 1):.12g}")


def _is_number(token: str) -> bool:
    return bool(DECIMAL.fullmatch(token)) or token.lower() in ("nan", "inf", "-inf")
