"""Files as people write them: each is read right, or refused.

The generator combines spellings of units, places where they stand, separators, columns, ends of lines, encodings and
steps. A file that states all that is needed must be read; another may be read only if the caller says the rest.
"""

import random
from collections import Counter
from dataclasses import dataclass, field

import numpy as np
import pytest

import rockflex as rf
from rockflex.foundation.constants import GRAVITY

UNITS = {
    "g": (GRAVITY, ["g", "G", "g's"]),
    "%g": (0.01 * GRAVITY, ["%g", "%G"]),
    "mg": (1e-3 * GRAVITY, ["mg"]),
    "0.1 g": (0.1 * GRAVITY, ["G/10", "G*0.1", "0.1 g"]),
    "m/s2": (
        1.0,
        ["m/s2", "M/S2", "m/s^2", "m/s²", "m/s**2", "m/s/s", "M/SEC/SEC", "m/sec^2", "m s-2", "m·s^-2", "m/(s^2)"],
    ),
    "cm/s2": (0.01, ["cm/s2", "CM/SEC**2", "cm/sec^2", "CM/SEC/SEC", "cm/s/s", "gal", "Gal", "GALS", "cm s^-2"]),
    "mm/s2": (1e-3, ["mm/s2", "mm/sec/sec", "MM/S**2"]),
    "in/s2": (0.0254, ["in/s2", "IN/SEC/SEC", "in/sec^2"]),
    "ft/s2": (0.3048, ["ft/s2", "ft/sec^2"]),
}
OTHERS = {
    "velocity": ["cm/s", "CM/SEC", "m/s"],
    "displacement": ["cm", "CM", "mm"],
}
NOISE = [
    "Northridge earthquake 1994-01-17, M 6.7",
    "PGA = 0.2432 g at 4.32 s",
    "Peak velocity = 23.1 cm/s",
    "Vs30 = 356 m/s",
    "Hypocentral depth (km): 17.5",
    "Band-pass filtered 0.1 - 25 Hz, 4 poles",
    "Station 24436, 1235 points west of the river",
    "Sensor: 2 g full range",
    "Made on 2020-01-02 12:30",
    "matched to the spectrum of the site",
    "",
]
DECIMALS = {1e-3: 3, 0.002: 3, 0.004: 3, 0.005: 3, 0.01: 2, 0.02: 2, 0.05: 2, 0.008: 3, 1 / 128: 9, 1 / 200: 3}
STEPS_IN = {
    "s": (1.0, ["s", "sec", "SEC", "sec.", "seconds"]),
    "ms": (1e-3, ["ms", "msec"]),
    "us": (1e-6, ["µs", "us"]),
}


@dataclass
class Written:
    """A file, what it holds, and what its caller says; `stated` if nothing else is needed to read it."""

    text: str
    encoding: str
    suffix: str
    acceleration: np.ndarray | None  # m/s²; None if it holds something else
    dt: float
    vertical: bool | None = None
    arguments: dict[str, object] = field(default_factory=dict)
    stated: bool = True
    parts: list[str] = field(default_factory=list)


def make(seed: int) -> Written:
    """Write a file at random."""
    pick = random.Random(seed)
    kind = pick.choices(["acceleration", "velocity", "displacement"], [12, 1, 1])[0]
    name = pick.choice(list(UNITS))
    si, spellings = UNITS[name]
    spelled = pick.choice(spellings if kind == "acceleration" else OTHERS[kind])
    dt = pick.choice(list(DECIMALS))
    size = pick.choice([12, 37, 40, 64])
    peak = pick.uniform(0.05, 0.9) * GRAVITY / si
    shape = np.sin(np.arange(size) * pick.uniform(0.2, 0.9)) * np.exp(-((np.arange(size) - size / 2) ** 2) / size)
    values = np.array([float(f"{value:.6e}") for value in peak * shape / np.abs(shape).max()])
    layout = pick.choice(["time", "time", "one", "sequence", "pair", "npts"])
    vertical = pick.choice([None, None, True, False])
    written = Written("", "utf-8", "txt", values * si if kind == "acceleration" else None, dt, vertical)
    unit_place = pick.choice(["label", "units line", "bracket line", "in line", "argument", "nowhere"])
    if kind != "acceleration" and unit_place in ("argument", "nowhere"):
        unit_place = "label"
    lines = _head(pick, written, kind, spelled, name, unit_place, layout)
    _add_rows(pick, written, lines, values, spelled if unit_place == "label" else "", kind, layout)
    end = pick.choice(["\n", "\n", "\r\n", "\r"])
    written.text = end.join(written.parts) + pick.choice(["", end])
    written.encoding = pick.choice(["utf-8", "utf-8", "utf-8-sig", "utf-16"])
    return written


def _head(pick, written, kind, spelled, name, unit_place, layout):
    """Return the lines above the labels; NPTS and DT stand among them where values follow in sequence."""
    word = {"acceleration": "Acceleration", "velocity": "Velocity", "displacement": "Displacement"}[kind]
    upper = pick.choice([str.upper, str.title, str.lower])
    line = {
        "units line": pick.choice(
            [
                f"UNITS: {spelled}",
                f"Units = {spelled}",
                f"{upper(word)} time series in units of {spelled}",
                f"unit: ({spelled})",
            ]
        ),
        "bracket line": pick.choice([f"{upper(word)} ({spelled})", f"{word} [{spelled}], corrected"]),
        "in line": f"{upper(word)} IN {spelled}",
    }.get(unit_place)
    if unit_place == "units line" and kind != "acceleration":
        line = f"{upper(word)} TIME SERIES IN UNITS OF {spelled}"
    lines = [pick.choice(NOISE) for _ in range(pick.choice([0, 1, 1, 3]))]
    if line:
        lines.insert(pick.randrange(len(lines) + 1), line)
    if unit_place == "argument":
        written.arguments["units"] = name
    written.stated = written.stated and unit_place != "nowhere"
    if written.vertical is not None and pick.random() < 0.6 and layout != "pair":
        lines.insert(
            pick.randrange(len(lines) + 1),
            f"{pick.choice(['Component: ', 'Component ', 'COMP='])}{_axis(pick, written.vertical)}",
        )
    else:
        written.vertical = None
    return lines


def _axis(pick, vertical):
    return pick.choice(["UP", "Up", "Vertical", "UD", "HNZ", "Z"] if vertical else ["N38E", "090", "NS", "HNE", "EW"])


def _step_line(pick, dt):
    """Return a line that states the step."""
    unit = pick.choice(list(STEPS_IN))
    si, spellings = STEPS_IN[unit]
    number = f"{dt / si:.12g}"
    return pick.choice(
        [
            f"dt = {number} {pick.choice(spellings)}",
            f"DT: {number} {pick.choice(spellings)}",
            f"Time step ({pick.choice(spellings)}): {number}",
            f"Sampling interval = {number} {pick.choice(spellings)}",
            f"Sampling rate: {1 / dt:.12g} Hz",
            f"{1 / dt:.12g} samples per second",
            f"Sampling frequency (Hz): {1 / dt:.12g}",
        ]
    )


def _add_rows(pick, written, lines, values, unit, kind, layout):
    """Write the lines and the numbers; of two components the first is the one that is looked at."""
    mark = pick.choice(["", "# ", "% ", "! "])
    comment = [f"{mark}{line}" if line else line for line in lines]
    dt, size = written.dt, len(values)
    numbers = [pick.choice(["{:.6e}", "{!r}"]).format(float(value)) for value in values]
    if layout in ("sequence", "npts"):
        if unit:  # there is no label
            comment = [*comment, f"{mark}{kind.upper()} ({unit})"]
        width = pick.choice([1, 5, 8, 10])
        rows = ["  ".join(numbers[k : k + width]) for k in range(0, size, width)]
        if layout == "npts":
            written.parts = [*comment, f"{size} {dt:.12g}", *rows]
            return
        plain = [line.removeprefix(mark) for line in comment]
        stated = pick.choice(
            [f"NPTS= {size}, DT= {dt:.9g} SEC", f"NPTS = {size} , DT = {dt:.9g} SEC", f"{size} {dt:.9g} NPTS, DT"]
        )
        place = pick.choice([len(plain), len(plain), 0])
        plain.insert(place, stated)
        if place == 0 and len(plain) > 1:
            # Lines after NPTS are still above the numbers, where the unit may stand.
            plain, rows = plain[:1] + [line for line in plain[1:] if line], rows
        written.parts = [*plain, *rows]
        return
    separator = pick.choice([",", ";", "\t", " ", "  ", ", "])
    comma = separator not in (",", ", ") and pick.random() < 0.3
    quoted = separator in (",", ";") and pick.random() < 0.2
    label = {
        "acceleration": ["acc", "a", "Acceleration", "accel"],
        "velocity": ["vel", "Velocity"],
        "displacement": ["disp", "Displacement"],
    }[kind]
    word = pick.choice(label)
    if separator.strip() == "" and " " in unit:
        unit = unit.replace(" ", "")
    named = (
        pick.choice([f"{word} ({unit})", f"{word} [{unit}]", f"{word}({unit})"])
        if unit
        else pick.choice(label if kind == "acceleration" else [word])
    )
    named = named if named != "a" or kind != "acceleration" else "acc"
    columns, labels = [numbers], [named]
    if layout == "pair":
        other = pick.choice(["EW", "N128E", "y"])
        first = {"EW": "NS", "N128E": "N38E", "y": "x"}[other]
        labels = [f"acc_{first}" + (f" ({unit})" if unit else ""), f"acc_{other}" + (f" ({unit})" if unit else "")]
        columns = [numbers, [f"{0.5 * float(value):.6e}" for value in values]]
    if layout == "one":
        where = pick.choice(["line", "argument", "nowhere"])
        if where == "line":
            comment.append(f"{mark}{_step_line(pick, dt)}")
        elif where == "argument":
            written.arguments["dt"] = dt
        written.stated = written.stated and where != "nowhere"
    else:
        labels, columns = _with_times(pick, written, labels, columns)
    has_label = bool(unit) or layout == "pair" or pick.random() < 0.6 or kind != "acceleration"
    if (
        not has_label
        and labels
        and labels[0]
        and not written.arguments.get("dt")
        and labels[0].strip().lower() != "time (s)"
        and layout != "one"
    ):
        has_label = True
    rows = [list(row) for row in zip(*columns, strict=True)]
    if comma:
        rows = [[cell.replace(".", ",") for cell in row] for row in rows]
    if quoted:
        rows, labels = [[f'"{cell}"' for cell in row] for row in rows], [f'"{each}"' for each in labels]
    head = [f"{mark}{separator.join(labels)}"] if has_label else []
    written.parts = [*comment, *head, *(separator.join(row) for row in rows)]
    written.suffix = pick.choice(["csv", "txt", "dat"])


def _with_times(pick, written, labels, columns):
    """Return labels and columns with one of times, or of row numbers, before them."""
    dt, size = written.dt, len(columns[0])
    form = pick.choices(["s", "ms", "rows", "epoch", "unit unknown"], [6, 2, 1, 1, 1])[0]
    begin = pick.choice([0.0, 0.0, 12.0])
    decimals = DECIMALS[dt]
    times = [f"{begin + k * dt:.{decimals}f}" for k in range(size)]
    if form == "s":
        return [pick.choice(["time (s)", "t [s]", "Time [sec]", "time", "t"]), *labels], [times, *columns]
    if form == "ms":
        return [pick.choice(["time (ms)", "t_ms", "t [msec]"]), *labels], [
            [f"{1e3 * (begin + k * dt):.6f}" for k in range(size)],
            *columns,
        ]
    if pick.random() < 0.5:
        written.arguments["dt"] = dt
    else:
        written.stated = False
    if form == "rows":
        return [pick.choice(["", "Sample", "No.", "index"]), *labels], [[str(k) for k in range(size)], *columns]
    if form == "epoch":
        return ["timestamp", *labels], [[f"{1_700_000_000_000 + 1e3 * k * dt:.6f}" for k in range(size)], *columns]
    return [pick.choice(["time", "t"]), *labels], [[f"{1e3 * k * dt:.6f}" for k in range(size)], *columns]


def outcome(written: Written, folder) -> str:
    """Read a file and return "read", "wrong: ..." or "refused: ..." with the field and what it is about."""
    file = folder / f"record.{written.suffix}"
    file.write_bytes(written.text.encode(written.encoding))
    try:
        motion = rf.read_components(file, **written.arguments)[0]
    except rf.InputError as error:
        return f"refused: {error.field or type(error).__name__}"
    if written.acceleration is None:
        return "wrong: not an acceleration"
    if abs(motion.dt - written.dt) > 1e-6 * written.dt:
        return f"wrong: step {motion.dt}"
    if motion.acceleration.size != written.acceleration.size:
        return f"wrong: {motion.acceleration.size} samples"
    if not np.allclose(
        motion.acceleration, written.acceleration, rtol=1e-5, atol=1e-6 * np.abs(written.acceleration).max()
    ):
        return f"wrong: peak {motion.pga} for {np.abs(written.acceleration).max()}"
    if written.vertical is not None and motion.metadata.is_vertical != written.vertical:
        return f"wrong: {motion.metadata.direction} for vertical={written.vertical}"
    return "read"


def check(seeds, folder):
    """Read files; none is wrong, and those that state all that is needed are read."""
    counts, faults, needless = Counter[str](), [], []
    for seed in seeds:
        written = make(seed)
        found = outcome(written, folder)
        counts[found if written.acceleration is not None else f"{found} (no acceleration)"] += 1
        if found.startswith("wrong"):
            faults.append((seed, found, written.text[:300], written.arguments))
        elif found != "read" and written.stated and written.acceleration is not None:
            needless.append(seed)
    assert not faults, faults[:3]
    return counts, needless


def test_some_files(tmp_path):
    counts, needless = check(range(300), tmp_path)
    assert counts["read"] > 100
    assert not needless


@pytest.mark.slow
def test_ten_thousand_files(tmp_path):
    counts, needless = check(range(300, 10_300), tmp_path)
    print(dict(counts))
    assert counts["read"] > 3000
    assert not needless
