"""Choice of the reader by the content of a file."""

from pathlib import Path

from rockflex._checks import one_of, positive
from rockflex._errors import InputError
from rockflex._files import path_of
from rockflex._shown import shown
from rockflex.motion._at2 import find_header, parse_at2
from rockflex.motion._columns import parse_columns
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._text import UNITS, read_lines


def read_motion(
    path: str | Path, units: str | None = None, dt: float | None = None, vertical: str | Path | None = None
) -> GroundMotion:
    """Read a record from an AT2 file, a CSV file, or text in columns; the content decides.

    Columns are separated by commas, semicolons, tabs or blanks; ``#``, ``%`` and ``!`` begin comments. A single
    column is the acceleration, two columns are time (s) and acceleration. With more columns, a header line must
    have exactly one label that begins with "t" or "time" and one that begins with "acc"; a label "vertical" or
    "up", also after "acc", is the vertical acceleration, positive upwards. The motion starts at the first sample,
    whatever its time.

    Parameters
    ----------
    path : str or Path
        The file.
    units : {"g", "m/s2", "cm/s2"}, optional
        Unit of the acceleration; needed unless a column header states it in brackets, as "acc (g)",
        "a [m/s^2]" or "acceleration (gal)". AT2 files are in g by definition.
    dt : float, optional
        Sampling step in s; needed if the file has no times. For a file with a time column it replaces
        times that were rounded in print: each must lie within half a step of its nominal time.
    vertical : str or Path, optional
        The file of the vertical component, with the same time step; `units` and `dt` apply to it as well. Zeros are
        appended to the shorter record, and a component that is positive downwards is reversed; see
        `GroundMotion.with_vertical`, which also joins two records that are read one by one.

    Returns
    -------
    GroundMotion
        The record in m/s², named after the file without its suffix.

    Raises
    ------
    InputError
        If the file is missing, empty or binary; `units` or `dt` is missing, contradicts the file or is not
        valid; a value is not a finite number; rows differ in length; time steps are not equal and positive;
        or the peak exceeds 5 g, which indicates a wrong unit. A file is never read in part. With `vertical` also
        if the time steps differ, or a component is known to have the other direction.

    Examples
    --------
    >>> import rockflex as rf
    >>> import numpy as np
    >>> np.savetxt("record.txt", [[0.0, 0.0], [0.01, 0.1], [0.02, 0.0]])  # s, g
    >>> rf.read_motion("record.txt", units="g")
    GroundMotion('record', 3 samples, dt=0.01 s, duration=0.02 s, pga=0.981 m/s²)
    """
    if units is not None and not one_of(units, UNITS):
        raise InputError(
            f"units must be one of {', '.join(map(repr, UNITS))}, but {shown(units)} was given.", field="units"
        )
    if dt is not None:
        dt = positive("dt", dt, "s")
    motion = _read(path_of("path", path), units, dt)
    return motion if vertical is None else motion.with_vertical(_read(path_of("vertical", vertical), units, dt))


def _read(file: Path, units: str | None, dt: float | None) -> GroundMotion:
    lines = read_lines(file)
    if find_header(lines) is None and file.suffix.lower() != ".at2":
        return parse_columns(file, lines, units, dt)
    motion = parse_at2(file, lines)
    if units not in (None, "g"):
        raise InputError(
            f"{file} is an AT2 file, in g by definition, but units={shown(units)} was given. Leave units out.",
            field="units",
        )
    if dt is not None and abs(dt - motion.dt) > 1e-9 * dt:
        raise InputError(f"{file} states DT = {motion.dt:g} s, but dt={shown(dt)} was given. Leave dt out.", field="dt")
    return motion
