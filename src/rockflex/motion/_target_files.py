"""Target spectra from files: which column is the period or frequency, which one the acceleration, and their units."""

import re
from collections.abc import Generator, Iterable, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_positive
from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError
from rockflex.foundation.files import checked_file_path
from rockflex.foundation.shown import few_texts_shown, shown
from rockflex.motion import _text
from rockflex.motion._conditional import ConditionalSpectrum, check_level, conditional_spectrum
from rockflex.motion._declared import Declared, declared
from rockflex.motion._findings import Evidence, quoted_line, settled
from rockflex.motion._header import MAX_LINE, units_in_line
from rockflex.motion._labels import parse_label
from rockflex.motion._spectra import TargetSpectrum, checked_spectrum_damping
from rockflex.motion._units import UNITS, AccelerationUnit, Quantity, Unit, parse_unit

Role = Literal["period", "frequency", "time", "acceleration", "velocity", "displacement"]
MAX_SA_G = 10.0  # in g; no target comes near it
MAX_PERIOD = 100.0  # s, where the spectrum of ASCE 7 ends
MAX_UNNAMED_PERIOD = 10.0  # s; a first column without a label that goes beyond may hold frequencies
# A percent sign that ends a cell; elsewhere it begins a comment.
PERCENT = re.compile(r"(?<=[\d.])(?:%(?=[\s;,\"]|$)|[ ]++%(?=[ ]*+(?:[;,\t\"]|$)))")
FRACTION = "e-2"
REMARK = re.compile(r"\d\s*+%|[=:]|damp|rot|mean|median|hor|elastic|design|[tf][n1i]?$", re.IGNORECASE)
# Words of labels in small letters, whole (S_a gives "sa") and as parts of words; those of records are in `_labels`.
WORDS: dict[Role, tuple[frozenset[str], tuple[str, ...]]] = {
    "frequency": (frozenset(("f", "fn", "hz")), ("freq", "frec", "fréq")),
    "period": (frozenset(("t", "tn", "per")), ("period", "périod", "schwing")),
    "time": (frozenset(("time", "zeit", "temps", "tempo", "tiempo")), ()),
    "velocity": (frozenset(("sv", "psv", "psrv", "prv", "vel")), ("veloc", "vitesse", "geschw")),
    "displacement": (frozenset(("sd", "psd", "sde", "dis", "disp")), ("displ", "versch", "dépl", "spost", "despl")),
    "acceleration": (frozenset(("sa", "psa", "se", "a")), ("acc", "acel", "beschl")),
}
ROLE_OF_QUANTITY: dict[Quantity, Role] = {
    "time": "period",
    "frequency": "frequency",
    "acceleration": "acceleration",
    "velocity": "velocity",
    "displacement": "displacement",
}
SPREAD = re.compile(r"(?<![^\W_])(?:sigma|σ|std|stdev|dispersion|beta)(?![^\W\d_])", re.IGNORECASE)
LABEL_AND_BRACKET = re.compile(r"[^()\[\]]++[(\[][^()\[\]]*+[)\]]")
EXPECTED = "a target spectrum is expected as two columns, period and S_a"


@dataclass(frozen=True)
class TargetColumn:
    """The label of a column: its quantity if that is known, and its unit, or one that is not known."""

    said: str = ""
    role: Role | None = None
    unit: Unit | None = None
    unknown: str = ""


def read_target(path: str | Path, units: str | None = None, damping_ratio: float = 0.05) -> TargetSpectrum:
    r"""Read a target spectrum from a CSV or text file: periods or frequencies, and pseudo-accelerations.

    Columns are separated by commas, semicolons, tabs or blanks; ``#``, ``%`` and ``!`` begin comments. Decimals may
    have a comma where something else separates the columns. Without labels the first of two columns is the period in s;
    a label names another unit, "period (ms)", or frequencies, "frequency (Hz)", whose periods are taken. Of more
    columns the labels must name one as the period or frequency and one as the acceleration. Ordinates with a percent
    sign are fractions of the unit.

    Parameters
    ----------
    path : str or Path
        The file.
    units : str, optional
        Unit of the acceleration, such as "g", "m/s2", "cm/s2" or "%g", if the header does not state it, as in
        "period (s), sa (g)".
    damping_ratio : float
        Damping ratio for which the ordinates hold.

    Returns
    -------
    TargetSpectrum
        The spectrum in m/s², named after the file without its suffix.

    Raises
    ------
    InputError
        If the file is missing, empty or binary, does not have two such columns of numbers, holds velocities or
        displacements, its unit is missing, not known, contradicts itself or `units`, a period exceeds 100 s or an
        ordinate 10 g, which indicates a wrong unit, or the values make no spectrum; see `TargetSpectrum`.

    Examples
    --------
    >>> import rockflex as rf
    >>> from pathlib import Path
    >>> _ = Path("site.csv").write_text(
    ...     "period (s), sa (g)\n0.0, 0.3\n0.1, 0.75\n0.5, 0.75\n2.0, 0.1875\n")
    >>> rf.read_target("site.csv")
    TargetSpectrum('site', 0 to 2 s, up to 7.357 m/s², ζ = 0.05)
    """
    file, _, _, periods, _, ordinates = _read_ordinates(path, units)
    with _naming_file(file, "damping_ratio"):
        return TargetSpectrum(periods, ordinates, damping_ratio, file.stem)


def read_conditional_spectrum(
    path: str | Path,
    period: float,
    *,
    sa: float | None = None,
    epsilon: float | None = None,
    units: str | None = None,
    damping_ratio: float = 0.05,
) -> ConditionalSpectrum:
    r"""Read the median and the spread of a ground-motion model from a file, and return its conditional spectrum.

    The file has a third column beside those of `read_target`, labelled sigma, std or dispersion: the standard deviation
    of ln S_a.

    Parameters
    ----------
    path, units, damping_ratio
        As in `read_target`.
    period, sa, epsilon
        As in `conditional_spectrum`.

    Raises
    ------
    InputError
        As `read_target` and `conditional_spectrum`, or if no label or more than one names a standard deviation.

    Examples
    --------
    >>> import rockflex as rf
    >>> from pathlib import Path
    >>> _ = Path("model.csv").write_text("period (s), median (g), sigma\n"
    ...     "0.05, 0.30, 0.60\n0.2, 0.52, 0.65\n"
    ...     "1.0, 0.16, 0.68\n2.0, 0.07, 0.72\n")
    >>> rf.read_conditional_spectrum("model.csv", 1.0, epsilon=1.5)
    ConditionalSpectrum('model', S_a(1 s) = 4.353 m/s², 0.05 to 2 s, ζ = 0.05)
    """
    checked_positive("period", period, "s")  # before a file is looked for
    check_level(sa, epsilon)
    checked_spectrum_damping(damping_ratio)
    file, table, columns, periods, order, ordinates = _read_ordinates(path, units)
    spread = [k for k, each in enumerate(table.labels) if SPREAD.search(each)]
    if len(spread) != 1 or columns[spread[0]].role is not None:
        raise InputError(
            f"{file}: one label must name the standard deviation of ln S_a, sigma, std or dispersion, beside period "
            f"(s) and median (g), but the labels are {few_texts_shown([shown(each) for each in table.labels])}."
        )
    with _naming_file(file, "damping_ratio", "period", "sa", "epsilon"):
        return conditional_spectrum(
            periods,
            ordinates,
            _column(file, table, spread[0])[order],
            period,
            sa=sa,
            epsilon=epsilon,
            damping_ratio=damping_ratio,
            name=file.stem,
        )


def _read_ordinates(
    path: str | Path, units: str | None
) -> tuple[Path, _text.NumericTable, list[TargetColumn], Array, slice, Array]:
    """Return the file, its table and columns, the periods in s, the order of rows, and ordinates in m/s²."""
    given = declared(units)
    file = checked_file_path("path", path)
    lines, of_hundred = _with_fractions(_text.read_text_lines(file))
    table = _text.parse_numeric_table(file, lines, EXPECTED)
    columns = _target_columns(table)
    x, y = _places(file, table, columns)
    periods, order = _target_periods(file, table, x, columns[x])
    unit = _ordinate_unit(file, table, columns[y], given)
    if of_hundred:
        unit = _unit_of_fractions(file, [cells[y] for _, cells in table.rows], unit)
    ordinates = _column(file, table, y)[order]
    peak = float(np.max(np.abs(ordinates), initial=0.0))
    if peak * unit.si > MAX_SA_G * GRAVITY:
        raise InputError(
            f"{file}: the largest ordinate is {peak:g} {unit}, above {MAX_SA_G:g} g, so that another unit is likely. "
            'Correct the unit: "sa (%g)" for percent, "sa (m/s2)", "sa (cm/s2)"; if it is right, build '
            "TargetSpectrum(periods, sa) from arrays in s and m/s².",
            field="units",
        )
    return file, table, columns, periods, order, ordinates * unit.si


@contextmanager
def _naming_file(file: Path, *arguments: str) -> Generator[None]:
    """Name the file in what is refused because of its values, and not of an argument."""
    try:
        yield
    except InputError as error:
        if error.field in arguments:
            raise
        raise InputError(f"{file}: {error}", field=error.field) from error


def _with_fractions(lines: Sequence[str]) -> tuple[list[str], bool]:
    """Return the lines with 30e-2 for 30 % in rows of numbers, and whether there is any."""
    found = list(lines)
    for place, line in enumerate(lines):
        fractions = PERCENT.sub(FRACTION, line)
        if fractions != line and all(map(_text.is_number_cell, re.findall(r"[^\s;,\"]++", fractions))):
            found[place] = fractions
    return found, found != list(lines)


def _target_columns(table: _text.NumericTable) -> list[TargetColumn]:
    """Return what the label of each column says; nothing if there are none."""
    count = len(table.rows[0][1])
    if table.labels:
        return [_target_column(text) for text in table.labels]
    # Labels that something else separates than the numbers, or of several words, told apart by the brackets after them.
    last = next((head for head in reversed(table.heads) if head), "")
    brackets = LABEL_AND_BRACKET.findall(last[: _text.end_of_last_bracket(last)])
    for texts in (re.split("[,;\t]", last), brackets):
        columns = [_target_column(text.strip(' "')) for text in texts[: count + 1]]
        if len(columns) == count and columns[0].role in ("period", "frequency"):
            return columns
    return [TargetColumn()] * count


def _target_column(text: str) -> TargetColumn:
    label = parse_label(text)
    units = [label.unit, *map(parse_unit, re.split("[,;]", label.unknown))]  # "g, 5%"
    unit = next((each for each in units if each is not None), None)
    end = _text.end_of_last_bracket(text)
    name = _text.BRACKET.sub(" ", text[:end]) + text[end:]
    unknown = "" if unit is not None or REMARK.search(label.unknown) else label.unknown
    return TargetColumn(label.said, _role(name, unit), unit, unknown)


def _role(name: str, unit: Unit | None) -> Role | None:
    """Return what a column is about: by its name, and else by its unit; S_d in g is an acceleration of Eurocode 8."""
    parts = re.findall(r"[^\W\d_]++", name.casefold())
    names = {*parts, "".join(parts)}
    named: Role | None = next((role for role, each in WORDS.items() if _speaks_of(names, each)), None)
    measured: Role | None = None if unit is None else ROLE_OF_QUANTITY.get(unit.quantity)
    if named is None or (named == "displacement" and measured == "acceleration" and "sd" in names):
        return measured
    return named


def _speaks_of(names: Iterable[str], words: tuple[frozenset[str], tuple[str, ...]]) -> bool:
    whole, parts = words
    return any(name in whole or any(part in name for part in parts) for name in names)


def _places(file: Path, table: _text.NumericTable, columns: Sequence[TargetColumn]) -> tuple[int, int]:
    """Return which columns are the periods or frequencies, and the accelerations."""
    line, cells = table.rows[0]
    along = [k for k, each in enumerate(columns) if each.role == "period"]
    along = along or [k for k, each in enumerate(columns) if each.role == "frequency"]
    upwards = [k for k, each in enumerate(columns) if each.role == "acceleration"]
    others = [each for each in columns if each.role in ("velocity", "displacement")]
    if not upwards and others:
        raise InputError(
            f"{file} holds a {others[0].role} ({others[0].said}), but a target is a pseudo-acceleration: give its "
            'file or column, labelled "sa (g)".'
        )
    times = [each for each in columns if each.role == "time"]
    if times and not along:
        raise InputError(
            f"{file}: {times[0].said} names times, so this may be a record, which read_motion reads. "
            'If it is a target, label the column "period (s)".'
        )
    if len(cells) == 2 and len(along) < 2 and len(upwards) < 2:
        x = along[0] if along else 1 - upwards[0] if upwards else 0
        if upwards != [x] and columns[x].role in ("period", "frequency", None):
            return x, 1 - x
    if len(along) == len(upwards) == 1:
        return along[0], upwards[0]
    if len(cells) > 2 and any(each.said for each in columns):
        raise InputError(
            f'{file}: one label must name the period, such as "period (s)", and one the acceleration, such as '
            f'"sa (g)", but the labels are {few_texts_shown([shown(each) for each in table.labels])}. Keep these two '
            "columns."
        )
    raise InputError(
        f"{file}, line {line}: a target spectrum has two columns, the period in s and the pseudo-acceleration, "
        f"but {len(cells)} were found. Keep these, or name them by labels, period (s) and sa (g)."
    )


def _column(file: Path, table: _text.NumericTable, k: int) -> Array:
    return np.array([_text.parse_decimal(cells[k], file, line) for line, cells in table.rows])


def _target_periods(file: Path, table: _text.NumericTable, k: int, label: TargetColumn) -> tuple[Array, slice]:
    """Return the periods in s, and the order of the rows in which those of frequencies increase."""
    values, kind = _column(file, table, k), "frequency" if label.role == "frequency" else "time"
    _check_label_unit(file, label, kind, "s, ms or, for a frequency, Hz")
    factor = 1.0 if label.unit is None else label.unit.si
    if kind == "time":
        periods = factor * values
        most = MAX_PERIOD if label.role == "period" else MAX_UNNAMED_PERIOD
        if periods.max() > most:
            what = (
                f"{label.said} names periods"
                if label.role == "period"
                else "the first column is taken for periods in s"
            )
            raise InputError(
                f"{file}: {what}, which go up to {periods.max():g} s, above {most:g} s. Another unit is likely, or "
                'frequencies: label the column "period (s)", "period (ms)" or "frequency (Hz)".',
                field="periods",
            )
        return periods, slice(None)
    if values.min(initial=np.inf) <= 0.0:
        line = table.rows[int(np.argmax(values <= 0.0))][0]
        raise InputError(
            f"{file}, line {line}: a frequency of {values.min():g} has no period. Delete the row; the peak ground "
            "acceleration belongs to a period of zero, in a table by periods.",
            field="periods",
        )
    order = slice(None, None, -1) if values[0] < values[-1] else slice(None)
    return 1.0 / (factor * values[order]), order


def _check_label_unit(file: Path, label: TargetColumn, quantity: str, units: str) -> None:
    """Refuse a label whose brackets hold no unit, or that of another quantity."""
    if label.unknown:
        raise InputError(
            f"{file}: {label.said} gives the unit {shown(label.unknown)}, which is not known. Write it as {units}, and "
            "convert the values if necessary."
        )
    if label.unit is not None and label.unit.quantity != quantity:
        raise InputError(f"{file}: {label.said} contradicts itself, its unit is none of a {label.role}. Correct it.")


def _ordinate_unit(file: Path, table: _text.NumericTable, label: TargetColumn, given: Declared) -> AccelerationUnit:
    """Return the unit that the label, a line above, or the caller states; they must agree."""
    _check_label_unit(file, label, "acceleration", f"one of {', '.join(UNITS)}, %g")
    stated = [Evidence(each, label.said) for each in [label.unit and label.unit.acceleration] if each]
    for (line, text), head in zip(table.head_lines, table.heads, strict=True):
        found = [unit.acceleration for unit in units_in_line(head[:MAX_LINE])]
        stated += [Evidence(each, quoted_line(line, text)) for each in found if each is not None]
    remedy = 'Say which one holds: units="g", "m/s2" or "cm/s2".'
    unit = settled(file, "unit", stated, given.unit_evidence, remedy, AccelerationUnit.same)
    if unit is not None:
        return unit.value
    raise InputError(
        f'{file} does not state the unit of its acceleration. Declare it: read_target(path, units="g"), "m/s2" or '
        '"cm/s2"; or write the header "period (s), sa (g)".',
        field="units",
    )


def _unit_of_fractions(file: Path, cells: Sequence[str], unit: AccelerationUnit) -> AccelerationUnit:
    """Return the unit of ordinates whose percent signs were taken for a factor of 1/100."""
    if unit.name == "g" and unit.factor in (1.0, 0.01) and all(cell.endswith(FRACTION) for cell in cells):
        return AccelerationUnit("g")  # the percent signs repeat the label "sa (%g)"
    raise InputError(
        f"{file}: some numbers have a percent sign, but only ordinates can be percent, of g and all of them; their "
        f"unit is {unit}. Write them without the sign.",
        field="units",
    )
