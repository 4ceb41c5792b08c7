"""Target spectra from files."""

from pathlib import Path

import numpy as np

from rockflex._checks import one_of
from rockflex._errors import InputError
from rockflex._files import path_of
from rockflex._shown import shown
from rockflex.motion._table import BRACKET, after_brackets, table_of
from rockflex.motion._target import TargetSpectrum
from rockflex.motion._text import number, read_lines
from rockflex.motion._units import UNITS, spelled

_SECONDS = ("s", "sec", "seconds")


def read_target(path: str | Path, units: str | None = None, damping_ratio: float = 0.05) -> TargetSpectrum:
    r"""Read a target spectrum from two columns of a CSV or text file: period in s, and pseudo-acceleration.

    Columns are separated by commas, semicolons, tabs or blanks; ``#``, ``%`` and ``!`` begin comments. Decimals may
    have a comma where something else separates the columns.

    Parameters
    ----------
    path : str or Path
        The file.
    units : {"g", "m/s2", "cm/s2", "mm/s2", "mg", "in/s2"}, optional
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
    table = table_of(file, read_lines(file), "a target spectrum is expected as two columns, period and S_a")
    line, cells = table.rows[0]
    if len(cells) != 2:
        raise InputError(
            f"{file}, line {line}: a target spectrum has two columns, the period in s and the pseudo-acceleration, "
            f"but {len(cells)} were found. Keep these."
        )
    values = np.array([[number(cell, file, line) for cell in cells] for line, cells in table.rows])
    unit = UNITS[_unit(file, next((head for head in reversed(table.heads) if head), ""), units)]
    try:
        return TargetSpectrum(values[:, 0], values[:, 1] * unit, damping_ratio, file.stem)
    except InputError as error:
        if error.field == "damping_ratio":
            raise
        raise InputError(f"{file}: {error}", field=error.field) from error


def _unit(file: Path, head: str, units: str | None) -> str:
    """Return the unit in the last brackets of the header, or that of the caller; both must agree."""
    found = BRACKET.findall(head[: after_brackets(head)])
    written = found[-1] if found and found[-1].strip().lower() not in _SECONDS else ""  # that of the periods
    stated = spelled(written)
    if written and stated is None:
        raise InputError(
            f"{file}: the header gives the unit {shown(written)}, which is not known. Write it as one of "
            f"{', '.join(UNITS)}."
        )
    if stated and units and stated != units:
        raise InputError(
            f"{file}: the header says {stated}, but units={shown(units)} was given. Leave units out.", field="units"
        )
    if stated or units:
        return stated or str(units)
    raise InputError(
        f'{file} does not state the unit of its acceleration. Declare it: read_target(path, units="g"), "m/s2" or '
        '"cm/s2"; or write the header "period (s), sa (g)".',
        field="units",
    )
