"""Records as columns of numbers in text files and Excel workbooks."""

import re
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np

from rockflex._arrays import Array
from rockflex._errors import InputError
from rockflex._shown import number_with_noun, shown
from rockflex.motion import _text
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._record_info import (
    HORIZONTAL_NAME,
    VERTICAL_NAME,
    RecordInfo,
    component_azimuth,
    component_direction,
    is_horizontal_component_name,
    unique_record_names,
)
from rockflex.motion._units import AccelerationUnit

PREFIX = r"(?:acc[a-z]*+|a)[\s_.-]++"
VERTICAL_LABEL = re.compile(
    rf"(?:{PREFIX})?+(?:ver|vert|vertical|up|ud|u-d)(?![a-z])|(?:{PREFIX}|a)[vz](?![a-z])", re.IGNORECASE
)
# The letter a alone needs the name of a component: a_x, ax, a NS.
ACCELERATION_LABEL = re.compile(
    r"(?:acc|acel|beschl)[^\W\d_]*+\.?|"
    rf"a(?=(?:[xyz]|[\s_.-]++(?:[xyz]|{HORIZONTAL_NAME.pattern}|{VERTICAL_NAME.pattern}))(?!\w))",
    re.IGNORECASE,
)
STATED_UNIT = re.compile(r"\bunits?\s*+[:=]\s*+\(?([^\s,;()]++)", re.IGNORECASE)
STATED_STEP = re.compile(rf"\bdt\s*+[:=]\s*+({_text.DECIMAL.pattern})\s*+(?:s|sec|seconds)?+\s*+$", re.IGNORECASE)
REMEDY = 'Declare the unit of the file: units="m/s2" or units="cm/s2".'
RECORD_MARK = "Record of rockflex"
NOT_WRITTEN = ("source_format", "stated_pga", "findings")  # they are about the file that was read
FIELD_TYPES: dict[Any, type[int | float]] = {int | None: int, float | None: float}
RECORD_FIELDS = {
    each.name: FIELD_TYPES.get(each.type, str) for each in fields(RecordInfo) if each.name not in NOT_WRITTEN
}


@dataclass(frozen=True)
class ColumnRoles:
    """Indices of the columns of time (None if there is none), horizontal accelerations, and the vertical one."""

    time: int | None
    horizontal: tuple[int, ...]
    vertical: int | None


def parse_columns(
    file: Path, table: _text.NumericTable, units: AccelerationUnit | None, dt: float | None, name: str
) -> list[GroundMotion]:
    """Build the motions from rows of numbers; of several accelerations, each is a motion, the vertical one too."""
    roles = _column_roles(file, table.labels, len(table.rows[0][1]))
    places = [*roles.horizontal, *([] if roles.vertical is None else [roles.vertical])]
    stated = {k: _column_unit(file, table, k, units) for k in places}
    values = {k: _column_samples(file, table, k) for k in places}
    step = _column_time_step(file, table, roles.time, dt)
    if len(roles.horizontal) == 1:
        (column,), vertical = roles.horizontal, roles.vertical
        alone = bool(table.labels) and VERTICAL_LABEL.match(table.labels[column])
        direction = "vertical" if alone else component_direction(file)
        info = RecordInfo(source=file.name, direction=direction, source_format="columns")
        info = record_info_in_csv(file, table.heads).completed(info)
        motion = _text.motion_from_samples(file, values[column], stated[column], step, info, REMEDY, name)
        if vertical is None:
            return [motion]
        upwards = _text.checked_acceleration_in_si(file, values[vertical], stated[vertical], REMEDY, info.scale)
        return [motion.with_vertical(upwards)]
    names = [_component_in_label(table.labels[k]) or str(k + 1) for k in places]
    motions: list[GroundMotion] = []
    for k, component, apart in zip(places, names, unique_record_names(names), strict=True):
        info = RecordInfo(
            source=file.name,
            component=component,
            direction="vertical" if k == roles.vertical else "horizontal",
            azimuth=None if k == roles.vertical else component_azimuth(component),
            source_format="columns",
        )
        motions.append(_text.motion_from_samples(file, values[k], stated[k], step, info, REMEDY, f"{name}-{apart}"))
    return motions


def _column_samples(file: Path, table: _text.NumericTable, k: int) -> Array:
    return np.array([_text.parse_decimal(cells[k], file, line) for line, cells in table.rows])


def _component_in_label(label: str) -> str:
    """Return the label without the words for acceleration and the unit: the name of the component."""
    end = _text.end_of_last_bracket(label)
    return ACCELERATION_LABEL.sub("", _text.BRACKET.sub("", label[:end]) + label[end:], 1).strip(" _-.")


def _column_roles(file: Path, labels: list[str], n_columns: int) -> ColumnRoles:
    """Return which columns are which."""
    times = [i for i, label in enumerate(labels) if _text.TIME_LABEL.match(label)]
    along, upwards = _component_columns(labels, times)
    if len(upwards) > 1:
        given = ", ".join(shown(labels[i]) for i in upwards)
        raise InputError(f"{file}: the header names {len(upwards)} columns as vertical, {given}. Keep one of them.")
    vertical = upwards[0] if upwards else None
    if len(along) == 1 and (len(times) == 1 or (n_columns == 2 and vertical is not None)):
        return ColumnRoles(times[0] if times else None, (along[0],), vertical)
    names = {_component_in_label(labels[i]) for i in along} - {""}
    if len(along) > 1 and len(times) <= 1 and len(names) == len(along):
        return ColumnRoles(times[0] if times else None, tuple(along), vertical)
    if n_columns <= 2:
        time = None if n_columns == 1 else 1 if times == [1] else 0
        column = 1 if time == 0 else 0
        if labels and re.match("vel|dis", labels[column], re.IGNORECASE):
            raise InputError(
                f"{file}: an acceleration is expected, but the column is labelled {shown(labels[column])}. "
                "Give the file of the acceleration."
            )
        return ColumnRoles(time, (column,), None)
    raise InputError(
        f"{file} has {n_columns} columns, and its header does not name one as time and at least one as "
        'acceleration ("time (s), acc (g), ..."). Keep the columns time and acceleration; a vertical one may be '
        'added as "vertical (g)", and further horizontal ones with names of their own, "acc NS (g), acc EW (g)".'
    )


def _component_columns(labels: list[str], times: list[int]) -> tuple[list[int], list[int]]:
    """Return the columns of horizontal and of vertical accelerations, as far as labels tell."""
    # Of two columns one is the time, unless the labels name two components.
    beside = len(labels) > 2 or (len(labels) == 2 and not times)
    upwards = [i for i, label in enumerate(labels) if VERTICAL_LABEL.match(label)] if beside else []
    others = [i for i in range(len(labels)) if i not in (*times, *upwards)]
    along = [i for i in others if ACCELERATION_LABEL.match(labels[i])]
    if along or not beside or (len(labels) == 2 and {"X", "Y"}.intersection(labels)):  # X and Y may be a curve
        return along, upwards
    names = {i: _component_in_label(labels[i]) for i in others}  # NS (gal), Z (gal)
    alone = [i for i, name in names.items() if name.upper() in ("Z", "V")]
    rest = [i for i in others if i not in alone]
    return (rest, [*upwards, *alone]) if all(is_horizontal_component_name(names[i]) for i in rest) else ([], upwards)


def _column_unit(file: Path, table: _text.NumericTable, k: int, units: AccelerationUnit | None) -> AccelerationUnit:
    """Return the unit stated by the label, a line above it, or the caller; they must agree."""
    written, where = _bracket_in_label(table.labels[k]) if table.labels else "", "column header"
    if not written:
        found = next((each for head in table.heads if (each := STATED_UNIT.search(head[:500]))), None)
        written, where = (found[1] if found else ""), "header"
    name = _text.agreed_unit_name(file, where, written, None if units is None else str(units), "g, m/s2 or cm/s2")
    if units is not None:
        return units
    if name is not None:
        return AccelerationUnit(name)
    raise InputError(
        f"{file} does not state the unit of its acceleration. Declare it: "
        'read_motion(path, units="g"), "m/s2" or "cm/s2"; or label the column "acc (g)".',
        field="units",
    )


def _column_time_step(file: Path, table: _text.NumericTable, column: int | None, dt: float | None) -> float:
    """Return the time step in s, from the column of times, the caller or the header."""
    if column is None:
        found = next((each for head in table.heads if (each := STATED_STEP.search(head[:500]))), None)
        stated = 0.0 if found is None else _text.parse_decimal(found[1], file, 1)
        if stated > 0.0 and dt not in (None, stated):
            raise InputError(
                f"{file} states DT = {stated:g} s, but dt={shown(dt)} was given. Leave dt out.", field="dt"
            )
        if stated > 0.0:
            return stated
        if dt is None:
            columns = "one column" if len(table.rows[0][1]) == 1 else f"{len(table.rows[0][1])} columns"
            raise InputError(
                f"{file} has {columns} and no times: give the sampling step, read_motion(path, dt=0.01).", field="dt"
            )
        return dt
    unit = _bracket_in_label(table.labels[column]) if table.labels else None
    if unit is not None and unit.strip().lower() not in _text.SECONDS:
        raise InputError(f"{file}: the times are in {shown(unit)}, but seconds are expected. Convert the column to s.")
    return _common_time_step(file, _column_samples(file, table, column), [line for line, _ in table.rows], dt)


def _common_time_step(file: Path, times: Array, lines: list[int], dt: float | None) -> float:
    """Return the common time step in s."""
    if times.size < 3:
        raise InputError(f"{file} has {number_with_noun(times.size, 'sample')}, but a record needs at least 3.")
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


def _bracket_in_label(label: str) -> str | None:
    bracket = _text.BRACKET.search(label, 0, _text.end_of_last_bracket(label))
    return bracket[1] if bracket else None


def record_csv(motion: GroundMotion) -> str:
    """Return a motion as the text of a CSV file, to the last bit, that `read_motion` reads with all that is known."""
    info = motion.metadata or RecordInfo()
    known = {name: value for name in RECORD_FIELDS if (value := getattr(info, name)) is not None}
    heads = [f"# {RECORD_MARK}", *(f"# {name}: {' '.join(str(value).split())}" for name, value in known.items())]
    columns = {"time (s)": motion.time, "acceleration (m/s2)": motion.acceleration}
    if motion.vertical is not None:
        columns["vertical (m/s2)"] = motion.vertical
    rows = zip(*(column.tolist() for column in columns.values()), strict=True)
    return "\n".join([*(heads if known else []), ",".join(columns), *(",".join(map(repr, row)) for row in rows), ""])


def record_info_in_csv(file: Path, heads: list[str]) -> RecordInfo:
    """Return the metadata in the first lines of a file that `record_csv` wrote; empty for other files."""
    found: dict[str, str | int | float] = {}
    lines = [head.strip("# ,;\t") for head in heads]  # as spreadsheets leave them
    for line, head in enumerate(lines if lines[:1] == [RECORD_MARK] else [], 1):
        name, _, text = (part.strip() for part in head.partition(":"))
        if name not in RECORD_FIELDS or not text:
            continue
        kind = RECORD_FIELDS[name]
        value = text if kind is str else _text.parse_optional_decimal(text)
        if value is None or value != kind(value):
            raise InputError(f"{file}, line {line}: {name} must be a number, but {shown(text)} was given.")
        found[name] = kind(value)
    if found.get("direction", "horizontal") not in ("horizontal", "vertical", "down"):
        raise InputError(
            f'{file}: direction must be "horizontal", "vertical" or "down", but {shown(found["direction"])} was given.'
        )
    return RecordInfo(**found)  # pyright: ignore[reportArgumentType]
