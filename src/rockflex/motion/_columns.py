"""Records as columns of numbers: which is the time, which are accelerations, and in what unit."""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rockflex._arrays import Array
from rockflex._errors import InputError
from rockflex._shown import counted, shown
from rockflex.motion._direction import HORIZONTAL, VERTICAL, azimuth_of, direction_of, is_horizontal_name, told_apart
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._record_file import stated_facts
from rockflex.motion._record_info import RecordInfo
from rockflex.motion._table import BRACKET, TIME, Table, after_brackets
from rockflex.motion._text import DECIMAL, acceleration_of, build_motion, number
from rockflex.motion._units import Unit, spelled

SECONDS = ("s", "sec", "secs", "second", "seconds")
PREFIX = r"(?:acc[a-z]*+|a)[\s_.-]++"
UPWARDS = re.compile(
    rf"(?:{PREFIX})?+(?:ver|vert|vertical|up|ud|u-d)(?![a-z])|(?:{PREFIX}|a)[vz](?![a-z])", re.IGNORECASE
)
# The letter a alone needs the name of a component: a_x, ax, a NS.
ACCELERATION = re.compile(
    r"(?:acc|acel|beschl)[^\W\d_]*+\.?|"
    rf"a(?=(?:[xyz]|[\s_.-]++(?:[xyz]|{HORIZONTAL.pattern}|{VERTICAL.pattern}))(?!\w))",
    re.IGNORECASE,
)
STATED = re.compile(r"\bunits?\s*+[:=]\s*+\(?([^\s,;()]++)", re.IGNORECASE)
STEP = re.compile(rf"\bdt\s*+[:=]\s*+({DECIMAL.pattern})\s*+(?:s|sec|seconds)?+\s*+$", re.IGNORECASE)
REMEDY = 'Declare the unit of the file: units="m/s2" or units="cm/s2".'


@dataclass(frozen=True)
class Chosen:
    """The columns of a table: of times (None if there is none), of accelerations, of the vertical one beside them."""

    time: int | None
    along: tuple[int, ...]
    upwards: int | None


def parse_columns(file: Path, table: Table, units: Unit | None, dt: float | None, name: str) -> list[GroundMotion]:
    """Build the motions from rows of numbers; of several accelerations, each is a motion, the vertical one too."""
    chosen = _choose(file, table.labels, len(table.rows[0][1]))
    places = [*chosen.along, *([] if chosen.upwards is None else [chosen.upwards])]
    stated = {k: _stated_unit(file, table, k, units) for k in places}
    values = {k: _column(file, table, k) for k in places}
    step = _time_step(file, table, chosen.time, dt)
    if len(chosen.along) == 1:
        return [_single(file, table, chosen, stated, values, step, name)]
    names = [_component(table.labels[k]) or str(k + 1) for k in places]
    motions: list[GroundMotion] = []
    for k, component, apart in zip(places, names, told_apart(names), strict=True):
        info = RecordInfo(
            source=file.name,
            component=component,
            direction="vertical" if k == chosen.upwards else "horizontal",
            azimuth=None if k == chosen.upwards else azimuth_of(component),
            source_format="columns",
        )
        motions.append(build_motion(file, values[k], stated[k], step, info, REMEDY, f"{name}-{apart}"))
    return motions


def _single(
    file: Path,
    table: Table,
    chosen: Chosen,
    stated: dict[int, Unit],
    values: dict[int, Array],
    step: float,
    name: str,
) -> GroundMotion:
    """Build the motion from the only horizontal column, with the vertical one."""
    column, upwards = chosen.along[0], chosen.upwards
    alone = bool(table.labels) and UPWARDS.match(table.labels[column])
    info = RecordInfo(source=file.name, direction="vertical" if alone else direction_of(file), source_format="columns")
    info = stated_facts(file, table.heads).completed(info)
    motion = build_motion(file, values[column], stated[column], step, info, REMEDY, name)
    if upwards is None:
        return motion
    return motion.with_vertical(acceleration_of(file, values[upwards], stated[upwards], REMEDY, info.scale))


def _column(file: Path, table: Table, k: int) -> Array:
    return np.array([number(cells[k], file, line) for line, cells in table.rows])


def _component(label: str) -> str:
    """Return what a label says besides acceleration and unit."""
    return ACCELERATION.sub(
        "", BRACKET.sub("", label[: after_brackets(label)]) + label[after_brackets(label) :], 1
    ).strip(" _-.")


def _choose(file: Path, labels: list[str], n_columns: int) -> Chosen:
    """Return which columns are which."""
    times = [i for i, label in enumerate(labels) if TIME.match(label)]
    # Of two columns one is the time, unless the labels are those of two components.
    beside = len(labels) > 2 or (len(labels) == 2 and not times)
    upwards = [i for i, label in enumerate(labels) if UPWARDS.match(label)] if beside else []
    others = [i for i in range(len(labels)) if i not in (*times, *upwards)]
    along = [i for i in others if ACCELERATION.match(labels[i])]
    if not along and beside and (len(labels) > 2 or not {"X", "Y"}.intersection(labels)):  # X and Y may be a curve
        along, alone = _by_names(labels, others)
        upwards = [*upwards, *alone]
    vertical = _vertical_column(file, labels, upwards)
    if len(along) == 1 and (len(times) == 1 or (n_columns == 2 and vertical is not None)):
        return Chosen(times[0] if times else None, (along[0],), vertical)
    names = {_component(labels[i]) for i in along} - {""}
    if len(along) > 1 and len(times) <= 1 and len(names) == len(along):
        return Chosen(times[0] if times else None, tuple(along), vertical)
    if n_columns <= 2:
        time = None if n_columns == 1 else 1 if times == [1] else 0
        column = 1 if time == 0 else 0
        if labels and re.match("vel|dis", labels[column], re.IGNORECASE):
            raise InputError(
                f"{file}: an acceleration is expected, but the column is labelled {shown(labels[column])}."
            )
        return Chosen(time, (column,), None)
    raise InputError(
        f"{file} has {n_columns} columns, and its header does not name one as time and at least one as "
        'acceleration ("time (s), acc (g), ..."). Keep the columns time and acceleration; a vertical one may be '
        'added as "vertical (g)", and further horizontal ones with names of their own, "acc NS (g), acc EW (g)".'
    )


def _by_names(labels: list[str], others: list[int]) -> tuple[list[int], list[int]]:
    """Return the horizontal and the vertical columns if the labels only name components: NS (gal), Z (gal)."""
    upwards = [i for i in others if _component(labels[i]).upper() in ("Z", "V")]
    along = [i for i in others if i not in upwards]
    return (along, upwards) if all(is_horizontal_name(_component(labels[i])) for i in along) else ([], [])


def _vertical_column(file: Path, labels: list[str], found: list[int]) -> int | None:
    if len(found) > 1:
        names = ", ".join(shown(labels[i]) for i in found)
        raise InputError(f"{file}: the header names {len(found)} columns as vertical, {names}. Keep one of them.")
    return found[0] if found else None


def _stated_unit(file: Path, table: Table, k: int, units: Unit | None) -> Unit:
    """Return the unit stated by the label, a line above it, or the caller; they must agree."""
    label = table.labels[k] if table.labels else ""
    bracket = BRACKET.search(label, 0, after_brackets(label))
    written = bracket[1] if bracket else ""
    where = "column header"
    if not written:
        found = next((each for head in table.heads if (each := STATED.search(head[:500]))), None)
        written, where = (found[1] if found else ""), "header"
    stated = spelled(written)
    if written and stated is None:
        raise InputError(
            f"{file}: the {where} gives the unit {shown(written)}, which is not known. "
            "Write it as g, m/s2 or cm/s2, and convert the values if necessary."
        )
    if stated and units and Unit(stated) != units:
        raise InputError(
            f"{file}: the {where} says {stated}, but units={shown(str(units))} was given. Leave units out.",
            field="units",
        )
    if stated:
        return Unit(stated)
    if units:
        return units
    raise InputError(
        f"{file} does not state the unit of its acceleration. Declare it: "
        'read_motion(path, units="g"), "m/s2" or "cm/s2"; or label the column "acc (g)".',
        field="units",
    )


def _time_step(file: Path, table: Table, column: int | None, dt: float | None) -> float:
    """Return the time step in s, from the column of times, the caller or the header."""
    if column is None:
        found = next((each for head in table.heads if (each := STEP.search(head[:500]))), None)
        stated = None if found is None else number(found[1], file, 1)
        if stated and stated > 0.0 and dt in (None, stated):
            return stated
        if stated and stated > 0.0:
            raise InputError(
                f"{file} states DT = {stated:g} s, but dt={shown(dt)} was given. Leave dt out.", field="dt"
            )
        if dt is None:
            columns = "one column" if len(table.rows[0][1]) == 1 else f"{len(table.rows[0][1])} columns"
            raise InputError(
                f"{file} has {columns} and no times: give the sampling step, read_motion(path, dt=0.01).", field="dt"
            )
        return dt
    if table.labels:
        _check_seconds(file, table.labels[column])
    return _step(file, _column(file, table, column), [line for line, _ in table.rows], dt)


def _check_seconds(file: Path, label: str) -> None:
    bracket = BRACKET.search(label, 0, after_brackets(label))
    if bracket and bracket[1].strip().lower() not in SECONDS:
        raise InputError(
            f"{file}: the times are in {shown(bracket[1])}, but seconds are expected. Convert the column to s."
        )


def _step(file: Path, times: Array, lines: list[int], dt: float | None) -> float:
    """Return the common time step in s."""
    if times.size < 3:
        raise InputError(f"{file} has {counted(times.size, 'sample')}, but a record needs at least 3.")
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
