"""Records as columns of numbers: which column is what, in which unit and at which step."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import number_with_noun, shown
from rockflex.motion import _text
from rockflex.motion._declared import Declared
from rockflex.motion._findings import Evidence, Finding, NoAccelerationError, shown_step
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._header import Header, header_of_lines
from rockflex.motion._labels import Label, parse_label
from rockflex.motion._record_info import RecordInfo, component_azimuth, unique_record_names
from rockflex.motion._samples import (
    ComponentEvidence,
    check_missing_values,
    counts_need_value,
    finding_of_quantity,
    remedy_of_unit,
    settled_component,
    settled_quantity,
    settled_step,
    settled_unit,
)
from rockflex.motion._units import Quantity

RECORD_MARK = "Record of rockflex"
NOT_WRITTEN = ("source_format", "stated_pga", "findings")  # they are about the file that was read
FIELD_TYPES: dict[Any, type[int | float]] = {int | None: int, float | None: float}
RECORD_FIELDS = {
    each.name: FIELD_TYPES.get(each.type, str) for each in fields(RecordInfo) if each.name not in NOT_WRITTEN
}
# Words of labels for what was done to one acceleration, which make no component of it.
STATES = re.compile(r"raw|(?:un)?(?:corrected|filtered|processed)|filt|smoothed|baseline.*", re.IGNORECASE)
OTHERS = {
    "other": "another quantity",
    "spectrum": "a spectrum",
    "period": "a spectrum",
    "frequency": "a spectrum",
    "counts": "counts",
}
MIN_OF_ONE_SIGN = 20  # samples; fewer may have one sign by chance
# Units of columns of times that a caller who gives the step need not name, in s.
TIME_SCALES = (1.0, 1e-3, 1e-6, 1e-9, 60.0, 86400.0)


@dataclass(frozen=True)
class ColumnRoles:
    """Indices of the columns of time (None if there is none), horizontal accelerations, and the vertical one."""

    time: int | None
    horizontal: tuple[int, ...]
    vertical: int | None


def parse_columns(file: Path, table: _text.NumericTable, given: Declared, name: str) -> list[GroundMotion]:
    """Build the motions from rows of numbers; of several accelerations, each is a motion, the vertical one too."""
    labels = _with_letters_as_components([parse_label(each) for each in table.labels])
    if _is_sentence(labels):
        labels, table = [], replace(table, labels=[], label_lines=())
    header = header_of_lines(file, _lines_above(table))
    n_columns = len(table.rows[0][1])
    roles = column_roles(file, labels, n_columns)
    _check_count(file, table, header)
    places = [*roles.horizontal, *([] if roles.vertical is None else [roles.vertical])]
    units: dict[int, Evidence[Any]] = {}
    quantities: dict[int, Finding] = {}
    for k in places:
        label = labels[k] if labels else None
        # Beside other columns a header may speak of these.
        words = (
            [] if label is None or label.kind != "acceleration" else [Evidence[Quantity]("acceleration", label.said)]
        )
        quantity = settled_quantity(file, words, header if n_columns <= 2 else Header())
        units[k] = settled_unit(file, _label_unit(file, label, given), header, given, columns=True)
        quantities[k] = finding_of_quantity(quantity, units[k])
    values = {k: _column_samples(file, table, k) for k in places}
    for k in places:
        check_missing_values(file, values[k], [line for line, _ in table.rows])
    if table.gaps and roles.time is None and not _are_regular(table.gaps):
        raise InputError(
            f"{file}, line {table.gaps[0]}: a line without a number stands inside the record. A value is missing, or "
            "two records follow each other: fill the gap, or save each record on its own."
        )
    steps = (given.dt, *(each.value for each in header.steps))
    if n_columns == 1 and given.layout is None and values[0][0] in steps:
        line, (cell,) = table.rows[0]
        raise InputError(
            f"{file}, line {line}: the first value, {cell}, is the time step. Delete the line if it is no sample; if "
            'it is one, say layout="columns".',
            field="layout",
        )
    if (
        (not labels or labels[places[0]].kind == "unknown")
        and not header.quantities
        and values[places[0]].size >= MIN_OF_ONE_SIGN
        and values[places[0]].min() > 0.0
    ):
        raise NoAccelerationError(
            f"{file}: all {values[places[0]].size} values are positive, as those of a spectrum are and no acceleration "
            'is. If this is one, label its column: "time (s), acc (g)".',
            found="only positive values",
        )
    own = table.heads[:1] == [RECORD_MARK]
    step = _column_time_step(file, table, roles.time, labels, header, given, trusted=own)
    if len(places) == 1 or len(roles.horizontal) == 1:
        (column, *_) = places
        label = labels[column] if labels else None
        way = settled_component(file, _label_component(label), header.components)
        info = RecordInfo(
            source=file.name,
            component=way.name or None,
            direction=way.direction,
            azimuth=component_azimuth(way.name),
            source_format="columns",
            findings=_findings(quantities[column], units[column], step, way.finding),
        )
        info = record_info_in_csv(file, table.heads).completed(info)
        info = replace(info, findings=_findings(quantities[column], units[column], step, way.finding))
        motion = _text.motion_from_samples(
            file, values[column], units[column].value, step.value, info, remedy_of_unit(units[column]), name
        )
        if roles.vertical in (None, column):
            return [motion]
        upright = _text.checked_acceleration_in_si(
            file,
            values[roles.vertical],
            units[roles.vertical].value,
            remedy_of_unit(units[roles.vertical]),
            info.scale,
        )
        return [motion.with_vertical(upright)]
    names = [labels[k].component or str(k + 1) for k in places]
    motions: list[GroundMotion] = []
    for k, component, apart in zip(places, names, unique_record_names(names), strict=True):
        direction = "vertical" if k == roles.vertical else "horizontal"
        finding = Finding("component", component, labels[k].said)
        info = RecordInfo(
            source=file.name,
            component=component,
            direction=direction,
            azimuth=None if k == roles.vertical else component_azimuth(component),
            source_format="columns",
            findings=_findings(quantities[k], units[k], step, finding),
        )
        motions.append(
            _text.motion_from_samples(
                file, values[k], units[k].value, step.value, info, remedy_of_unit(units[k]), f"{name}-{apart}"
            )
        )
    return motions


def _findings(
    quantity: Finding, unit: Evidence[Any], step: Evidence[float], component: Finding | None
) -> tuple[Finding, ...]:
    found = (quantity, unit.finding("unit"), step.finding("time step", shown_step(step.value)))
    return found if component is None else (*found, component)


def _lines_above(table: _text.NumericTable) -> list[tuple[int, str]]:
    """Return the lines above the numbers, but those with the labels of several columns."""
    labelled = table.label_lines if len(table.labels) > 1 else ()
    return [each for each in table.head_lines if each[0] not in labelled]


def _is_sentence(labels: list[Label]) -> bool:
    """Return whether the labels of two columns are two words, as in "Acceleration [g], corrected"."""
    return len(labels) == 2 and labels[0].kind == "acceleration" and labels[1].kind == "unknown"


def _are_regular(gaps: Sequence[int]) -> bool:
    """Return whether lines without numbers stand after each row, as ends of lines of another system leave them."""
    return len(gaps) > 1 and {later - earlier for earlier, later in pairwise(gaps)} == {2}


def _check_count(file: Path, table: _text.NumericTable, header: Header) -> None:
    """Raise an InputError if the header states another number of rows."""
    counts = {each.value for each in header.counts}
    if len(counts) == 1 and counts != {len(table.rows)}:
        (stated,) = header.counts[:1]
        raise _text.wrong_sample_count_error(file, len(table.rows), stated.value, f"{stated.value} ({stated.said})")


def _column_samples(file: Path, table: _text.NumericTable, k: int) -> Array:
    return np.array([_text.parse_decimal(cells[k], file, line) for line, cells in table.rows])


def column_roles(file: Path, labels: list[Label], n_columns: int) -> ColumnRoles:
    """Return which columns are which."""
    kinds = [label.kind for label in labels]
    times = [k for k, kind in enumerate(kinds) if kind == "time"]
    if not times and {"period", "frequency"} & set(kinds):
        raise _no_acceleration(file, labels[next(k for k, each in enumerate(kinds) if each in ("period", "frequency"))])
    along, upwards = _acceleration_columns(labels, times)
    if len(upwards) > 1:
        given = ", ".join(shown(labels[k].text) for k in upwards)
        raise InputError(f"{file}: the header names {len(upwards)} columns as vertical, {given}. Keep one of them.")
    if len(times) > 1 and (along or upwards):
        given = ", ".join(shown(labels[k].text) for k in times)
        raise InputError(f"{file}: the header names {len(times)} columns as time, {given}. Keep one of them.")
    vertical = upwards[0] if upwards else None
    time = times[0] if times else None
    timed = bool(times) or "row number" in kinds or n_columns == 1
    if len(along) == 1 and (timed or (n_columns == 2 and vertical is not None)):
        return ColumnRoles(time, (along[0],), vertical)
    if not along and vertical is not None and timed:
        return ColumnRoles(time, (vertical,), None)
    names = {labels[k].component for k in along} - {""}
    states = [label for label in (labels[k] for k in along) if STATES.fullmatch(label.component.strip())]
    if len(along) > 1 and states:
        raise InputError(
            f"{file}: the label {shown(states[0].text)} names no direction, so that one component may stand here more "
            "than once. Keep the column that is to be used."
        )
    if len(along) > 1 and len(names) == len(along):
        return ColumnRoles(time, tuple(along), vertical)
    other = next((label for label in labels if label.kind in ("velocity", "displacement", "force", *OTHERS)), None)
    if other is not None and not along:
        raise _no_acceleration(file, other)
    if n_columns == 1:
        return ColumnRoles(None, (0,), None)
    if n_columns == 2:  # a label of the first column alone is a word of a sentence, unless it is one of times
        return ColumnRoles(1, (0,), None) if times == [1] else ColumnRoles(0, (1,), None)
    said = "" if not labels or along else " No label is known as that of an acceleration."
    raise InputError(
        f"{file} has {n_columns} columns, and its header does not name one as time and at least one as "
        f'acceleration ("time (s), acc (g), ...").{said} Keep the columns time and acceleration; a vertical one may be '
        'added as "vertical (g)", and further horizontal ones with names of their own, "acc NS (g), acc EW (g)". '
        'If the values follow each other line by line, say so: layout="sequence".'
    )


def _no_acceleration(file: Path, label: Label) -> NoAccelerationError:
    what = OTHERS.get(label.kind, f"a {label.kind}")
    return NoAccelerationError(
        f"{file}: an acceleration is expected, but the column is labelled {shown(label.text)}, {what}. Give the file "
        "of the acceleration.",
        found="table" if label.kind == "other" else what.removeprefix("a "),
    )


def _with_letters_as_components(labels: list[Label]) -> list[Label]:
    """Return the labels, with N, U and V as components where others are."""
    if not any(label.kind == "component" for label in labels):
        return labels
    return [
        replace(label, kind="component", component=label.text.strip())
        if label.text.strip() in ("N", "S", "U", "V") and label.unit is None
        else label
        for label in labels
    ]


def _acceleration_columns(labels: list[Label], times: list[int]) -> tuple[list[int], list[int]]:
    """Return the columns of horizontal and of vertical accelerations, as far as labels tell."""
    named = [k for k, label in enumerate(labels) if label.kind == "acceleration"]
    alone = [k for k, label in enumerate(labels) if label.kind == "component" and _may_be_acceleration(label)]
    if {label.text.strip().casefold() for label in labels} == {"x", "y"}:  # a curve
        return [], []
    measured = [
        k
        for k, label in enumerate(labels)
        if label.kind == "counts" or (label.kind == "unknown" and label.unit and label.unit.acceleration)
    ]
    if named:
        # Of components that are not said to be accelerations, the vertical one belongs to those that are.
        named += [k for k in alone if labels[k].vertical or labels[k].unit is not None]
    elif alone and len(alone) + len(times) + sum(label.kind == "row number" for label in labels) == len(labels):
        named = alone
    elif len(measured) == 1:
        named = measured
    else:
        named = [k for k in alone if labels[k].unit is not None]
    named = sorted(named)
    return [k for k in named if not labels[k].vertical], [k for k in named if labels[k].vertical]


def _may_be_acceleration(label: Label) -> bool:
    return label.unit is None or label.unit.quantity in ("acceleration", "counts")


def _label_unit(file: Path, label: Label | None, given: Declared) -> list[Evidence[Any]]:
    """Return the unit in a label as evidence; none if it states none."""
    if label is None:
        return []
    if label.unknown:
        raise InputError(
            f"{file}: the column header gives the unit {shown(label.unknown)}, which is not known. "
            "Write it as g, m/s2 or cm/s2, and convert the values if necessary.",
            field="units",
        )
    if "counts" in (label.kind, label.unit and label.unit.quantity):
        if given.units is None:
            raise counts_need_value(file, label.said)
        return []
    if label.unit is None:
        return []
    if label.unit.acceleration is None:
        raise InputError(
            f"{file} contradicts itself about the quantity: {label.said} names an acceleration in a unit of "
            f"{label.unit.quantity}. Correct the label.",
            field="units",
        )
    return [Evidence(label.unit.acceleration, label.said)]


def _label_component(label: Label | None) -> ComponentEvidence | None:
    """Return the component that a label names."""
    if label is None or not label.component or (not label.vertical and component_azimuth(label.component) is None):
        return None
    return ComponentEvidence(label.component, label.said)


def _column_time_step(
    file: Path,
    table: _text.NumericTable,
    column: int | None,
    labels: list[Label],
    header: Header,
    given: Declared,
    *,
    trusted: bool,
) -> Evidence[float]:
    """Return the time step in s, from the column of times, the header and the caller, which must agree."""
    if column is None:
        columns = "one column" if len(table.rows[0][1]) == 1 else f"{len(table.rows[0][1])} columns"
        return settled_step(file, header.steps, given, f"{columns} and no times", trusted=trusted)
    label = labels[column] if labels else None
    if label is not None and (label.unknown or (label.unit and label.unit.quantity != "time")):
        written = label.unknown or (label.unit and label.unit.quantity)
        raise InputError(
            f"{file}: the times are in {shown(written)}, but seconds are expected. Convert the column to s.", field="dt"
        )
    scale = 1.0 if label is None or label.unit is None else label.unit.si
    stated = label is not None and label.unit is not None
    if not stated and len({each.value for each in header.time_units}) == 1:
        scale, stated = header.time_units[0].value, True
    said = (
        f'column "{" ".join(label.text.split())}"'
        if label is not None and label.text.strip()
        else f"column {column + 1}"
    )
    times = _column_samples(file, table, column)
    lines = [line for line, _ in table.rows]
    if times.size < 3:
        raise InputError(f"{file} has {number_with_noun(times.size, 'sample')}, but a record needs at least 3.")
    known = given.dt if given.dt is not None else header.steps[0].value if header.steps else None
    if known is not None:
        scale = scale if stated else _scale_of_times(times, known) or scale
        _check_times(file, table, column, times, scale, known, lines, given=given.dt is not None)
        return settled_step(file, header.steps, given, said, trusted=True)
    dt = _common_time_step(file, scale * times, lines, said)
    return settled_step(file, [Evidence(dt, said)], given, said, trusted=trusted)


def _scale_of_times(times: Array, dt: float) -> float | None:
    """Return the unit, in s, of times without a stated one by a known step; row numbers count steps."""
    mean = (times[-1] - times[0]) / (times.size - 1)
    return next((scale for scale in (*TIME_SCALES, dt) if abs(mean * scale - dt) <= 1e-3 * dt), None)


def _check_times(
    file: Path,
    table: _text.NumericTable,
    column: int,
    times: Array,
    scale: float,
    dt: float,
    lines: list[int],
    *,
    given: bool,
) -> None:
    """Raise an InputError if times do not fit a step within half a step, or half the last digit in print."""
    digits = max((len(cells[column].partition(".")[2]) for _, cells in table.rows[:1000]), default=0)
    printed = 0.5 * 10.0**-digits * (1.0 + 1e-9) if digits < 16 else 0.0
    away = scale * np.abs(times - times[0]) - dt * np.arange(times.size)
    most = max(0.5 * dt, scale * 2.0 * printed if digits else 0.0)
    wrong = np.abs(away) >= most * (1.0 + 1e-9)
    mean = scale * (times[-1] - times[0]) / (times.size - 1)
    if np.any(wrong):
        k = int(np.argmax(wrong))
        source = f"dt={shown(dt)} s" if given else f"the step of {shown_step(dt)} in the header"
        remedy = "Leave dt out, or remove the column of times." if given else "Correct one of them."
        raise InputError(
            f"{file}, line {lines[k]}: the time {times[k] * scale:g} s does not fit {source}; the mean step of the "
            f"column is {mean:.6g} s. {remedy}",
            field="dt",
        )


def _common_time_step(file: Path, times: Array, lines: list[int], said: str) -> float:
    """Return the common time step in s."""
    steps = np.diff(times)
    if np.any(steps <= 0):
        k = int(np.argmax(steps <= 0))
        raise InputError(
            f"{file}, line {lines[k + 1]}: time must increase, but it goes from {times[k]:g} s to "
            f"{times[k + 1]:g} s. {said[0].upper() + said[1:]} is taken as the time. If times are printed with too few "
            "digits, give the step: dt=0.005; if they are none, delete the column.",
            field="dt",
        )
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


def record_csv(motion: GroundMotion) -> str:
    """Return a motion as the text of a CSV file, to the last bit, that `read_motion` reads with all that is known."""
    info = motion.metadata or RecordInfo()
    known = {name: value for name in RECORD_FIELDS if (value := getattr(info, name)) is not None}
    heads = [f"# {RECORD_MARK}", *(f"# {name}: {' '.join(str(value).split())}" for name, value in known.items())]
    columns = {"time (s)": motion.time, "acceleration (m/s2)": motion.acceleration}
    if motion.vertical is not None:
        columns["vertical (m/s2)"] = motion.vertical
    rows = zip(*(column.tolist() for column in columns.values()), strict=True)
    return "\n".join([*heads, ",".join(columns), *(",".join(map(repr, row)) for row in rows), ""])


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
