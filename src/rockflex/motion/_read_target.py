"""Target spectra from files."""

from pathlib import Path

import numpy as np

from rockflex._checks import one_of
from rockflex._errors import InputError
from rockflex._files import path_of
from rockflex._shown import shown
from rockflex.motion._columns import split_columns, stated_unit
from rockflex.motion._target import TargetSpectrum
from rockflex.motion._text import UNITS, number, read_lines


def read_target(path: str | Path, units: str | None = None, damping_ratio: float = 0.05) -> TargetSpectrum:
    r"""Read a target spectrum from two columns of a CSV or text file: period in s, and pseudo-acceleration.

    Columns are separated by commas, semicolons, tabs or blanks; ``#``, ``%`` and ``!`` begin comments.

    Parameters
    ----------
    path : str or Path
        The file.
    units : {"g", "m/s2", "cm/s2"}, optional
        Unit of the acceleration, if the header does not state it, as in "period (s), sa (g)".
    damping_ratio : float
        Damping ratio for which the ordinates hold.

    Returns
    -------
    TargetSpectrum
        The spectrum in m/s², named after the file without its suffix.

    Raises
    ------
    InputError
        If the file is missing, empty or binary, does not have two columns of numbers, its unit is missing or not known,
        or the values make no spectrum; see `TargetSpectrum`.

    Examples
    --------
    >>> import rockflex as rf
    >>> from pathlib import Path
    >>> _ = Path("site.csv").write_text("period (s), sa (g)\n0.0, 0.3\n0.1, 0.75\n0.5, 0.75\n2.0, 0.1875\n")
    >>> rf.read_target("site.csv")
    TargetSpectrum('site', 0 to 2 s, up to 7.357 m/s², ζ = 0.05)
    """
    if units is not None and not one_of(units, UNITS):
        raise InputError(
            f"units must be one of {', '.join(map(repr, UNITS))}, but {shown(units)} was given.", field="units"
        )
    file = path_of("path", path)
    labels, rows = split_columns(file, read_lines(file))
    columns = len(rows[0][1])
    if columns != 2:
        raise InputError(
            f"{file} has {columns} column{'s' * (columns > 1)}, but a target spectrum has two: the period in s and the "
            "pseudo-acceleration. Keep these."
        )
    unit = stated_unit(file, labels[1] if labels else "", units, "read_target", "sa")
    values = np.array([[number(cell, file, line) for cell in cells] for line, cells in rows])
    try:
        return TargetSpectrum(values[:, 0], values[:, 1] * UNITS[unit], damping_ratio, file.stem)
    except InputError as error:
        if error.field == "damping_ratio":
            raise
        raise InputError(f"{file}: {error}", field=error.field) from error
