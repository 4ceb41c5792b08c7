"""Reading a record file: the content decides on the format."""

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from rockflex._checks import checked_instance, checked_positive
from rockflex._errors import InputError, RecordWarning
from rockflex._files import checked_file_path
from rockflex._language import translated
from rockflex._registry import Catalogue
from rockflex._shown import shown
from rockflex.motion import _obspy, _text
from rockflex.motion._at2 import find_at2_header, parse_at2
from rockflex.motion._columns import parse_columns
from rockflex.motion._cosmos import is_cosmos, parse_cosmos
from rockflex.motion._csmip import is_csmip, parse_csmip
from rockflex.motion._esm import is_esm, parse_esm
from rockflex.motion._excel import is_excel_workbook, parse_excel
from rockflex.motion._geonet import is_geonet, parse_geonet
from rockflex.motion._gmprocess import NETWORKS, parse_network
from rockflex.motion._ground_motion import GroundMotion, is_vertical_component, record_info_of
from rockflex.motion._japan_csv import is_jma_csv, is_knet_csv, parse_jma_csv, parse_knet_csv
from rockflex.motion._knet import is_knet, parse_knet
from rockflex.motion._recorded import MEAN_SUBTRACTED
from rockflex.motion._smc import is_smc, parse_smc
from rockflex.motion._units import AccelerationUnit, declared_acceleration_unit


@dataclass(frozen=True)
class RecordFormat:
    """A format of text files that states the unit and the time step, known by its first lines whatever the suffix.

    A package adds one by an entry point of the group ``rockflex.readers``; in a session, an entry of `FORMATS` does.

    Attributes
    ----------
    name : str
        Name in messages.
    known : callable
        Whether the lines of a file, which are at least one, begin as this format does and no other; folders ask with
        the lines within the first 4 KiB.
    parse : callable
        Returns all components of a file from its path and its lines, of which some may be empty, as a list of
        `GroundMotion` in m/s². It raises an `InputError` that names the file and the line if the file is not whole.

    Examples
    --------
    >>> from rockflex.motion import FORMATS
    >>> list(FORMATS)
    ['K-NET', 'K-NET CSV', 'JMA', 'ESM', 'COSMOS', 'GeoNet', 'CSMIP', 'SMC']
    """

    name: str
    known: Callable[[list[str]], bool]
    parse: Callable[[Path, list[str]], list[GroundMotion]]


FORMATS = Catalogue[RecordFormat](
    (
        RecordFormat("K-NET", is_knet, parse_knet),
        RecordFormat("K-NET CSV", is_knet_csv, parse_knet_csv),
        RecordFormat("JMA", is_jma_csv, parse_jma_csv),
        RecordFormat("ESM", is_esm, parse_esm),
        RecordFormat("COSMOS", is_cosmos, parse_cosmos),
        RecordFormat("GeoNet", is_geonet, parse_geonet),
        RecordFormat("CSMIP", is_csmip, parse_csmip),
        RecordFormat("SMC", is_smc, parse_smc),
    ),
    "readers",
)
PEAK_TOLERANCE = 0.01  # relative difference that the printing of a header explains
PRINTED_DIGIT = 1e-5  # m/s², the last digit of peaks in K-NET headers, 0.001 gal
MAX_PEAK_MISMATCH = 0.2  # relative difference that only a wrong scale or another record explains


def read_motion(
    path: str | Path,
    units: str | None = None,
    dt: float | None = None,
    vertical: str | Path | None = None,
    component: str | None = None,
) -> GroundMotion:
    """Read a record; the content of the file decides on its format.

    - AT2 files of PEER, in g; see `read_at2`.
    - K-NET and KiK-net ASCII: counts times the scale factor of the header. The mean of the record is subtracted, as
      for the peak that the header states.
    - ESM and ITACA ASCII (DYNA 1.2), in the unit that the header states.
    - COSMOS (V1, V2; V0 if the header states the value of a count), with one or more channels.
    - GeoNet (V1A, V2A), with all components of an instrument, in mm/s².
    - CSV, and text in columns. Columns are separated by commas, semicolons, tabs or blanks; decimals may be marked by
      commas where something else separates; ``#``, ``%`` and ``!`` begin comments. A single column is the
      acceleration, two columns are time (s) and acceleration, unless a header line names them as two components. With
      more columns, a header line must have exactly one label that begins with "t" or "time" and one that begins with
      "acc"; a label "vertical" or "up", also after "acc", is the vertical acceleration, positive upwards. More than one
      horizontal acceleration needs names, as in "acc NS (g), acc EW (g)", "a_x (g), a_y (g), a_z (g)" or "NS (gal),
      EW (gal), UD (gal)"; z, v and UD are vertical.
    - Excel workbooks (.xlsx), with the same columns in one or more sheets; needs openpyxl, ``rockflex[excel]``.
    - Formats that ObsPy reads, such as MiniSEED, SAC, GSE2 and Kinemetrics EVT; needs ObsPy, ``rockflex[obspy]``.

    The motion starts at the first sample, whatever its time.

    Parameters
    ----------
    path : str or Path
        The file.
    units : str, optional
        Unit of the acceleration: "g", "m/s2", "cm/s2", "mm/s2", "mg", "in/s2", or a number and one of these, such as
        "2.4e-4 cm/s2" for the value of one count. Needed unless a column header states it in brackets, as "acc (g)",
        "a [m/s^2]" or "acceleration (gal)", or a line above the numbers says "units: g", or the format does.
    dt : float, optional
        Sampling step in s; needed if the file has no times, and no line above the numbers says "dt = 0.01 s". For a
        file with a time column it replaces times that were rounded in print: each must lie within half a step of its
        nominal time.
    vertical : str or Path, optional
        The file of the vertical component, with the same time step; `units` and `dt` apply to it as well. It may be the
        same file, if that holds several components. Zeros are appended to the shorter record, and a component that is
        positive downwards is reversed; see `GroundMotion.with_vertical`, which also joins two records that are read one
        by one.
    component : str, optional
        Name of the component, for a file with several horizontal ones; see `read_components`.

    Returns
    -------
    GroundMotion
        The record in m/s², named after the file without its suffix, and after the component if the file has several.
        `GroundMotion.metadata` contains the information in the header.

    Raises
    ------
    InputError
        If the file is missing, empty, of an unknown format, or needs a package that is not installed; `units` or `dt`
        is missing, contradicts the file or is not valid; a value is not a finite number; there are fewer or more values
        than the header states; rows differ in length; time steps are not equal and positive; the peak exceeds 5 g,
        which indicates a wrong unit, or differs by more than 20 % from that in the header. A file is never read in
        part. Also if there are several horizontal components and `component` names none of them. With `vertical` also
        if the time steps differ, or a component is known to have the other direction.

    Warns
    -----
    RecordWarning
        If the peak differs by 1 to 20 % from that in the header.

    Examples
    --------
    >>> import rockflex as rf
    >>> import numpy as np
    >>> np.savetxt("record.txt", [[0.0, 0.0], [0.01, 0.1], [0.02, 0.0]])  # s, g
    >>> rf.read_motion("record.txt", units="g")
    GroundMotion('record', 3 samples, dt=0.01 s, duration=0.02 s, pga=0.981 m/s²)
    """
    unit, step = _checked_unit_and_step(units, dt)
    if component is not None:
        checked_instance("component", component, str)
    file = checked_file_path("path", path)
    motion = select_component(file, components_in_file(file, unit, step), component, vertical=False)
    _warn_of_stated_peak(file, motion)
    if vertical is None:
        return motion
    other = checked_file_path("vertical", vertical)
    upwards = select_component(other, components_in_file(other, unit, step), None, vertical=True)
    _warn_of_stated_peak(other, upwards)
    return motion.with_vertical(upwards)


def read_components(path: str | Path, units: str | None = None, dt: float | None = None) -> tuple[GroundMotion, ...]:
    r"""Read all components in a file: the channels of an instrument, the columns of a table, the sheets of a workbook.

    Parameters
    ----------
    path, units, dt
        As in `read_motion`.

    Returns
    -------
    tuple of GroundMotion
        The components, in the order of the file. ``metadata.component``, ``metadata.direction`` and
        ``metadata.azimuth`` tell them apart. A table with a single horizontal column is one motion with its vertical
        component.

    Raises
    ------
    InputError
        As for `read_motion`, except that any number of components is read.

    Warns
    -----
    RecordWarning
        As for `read_motion`.

    Examples
    --------
    >>> import rockflex as rf
    >>> from pathlib import Path
    >>> text = "time (s), NS (gal), EW (gal), UD (gal)\n0.00, 0, 0, 0\n0.01, 5, 3, 1\n0.02, -4, 6, 2\n"
    >>> _ = Path("station.csv").write_text(text)
    >>> [motion.name for motion in rf.read_components("station.csv")]
    ['station-NS', 'station-EW', 'station-UD']
    """
    unit, step = _checked_unit_and_step(units, dt)
    file = checked_file_path("path", path)
    found = components_in_file(file, unit, step)
    for motion in found:
        _warn_of_stated_peak(file, motion)
    return tuple(found)


def read_motion_without_obspy(path: str | Path, units: str | None = None, dt: float | None = None) -> GroundMotion:
    """Read a record as `read_motion` does, but without ObsPy, whose readers are not made for files of strangers."""
    file = checked_file_path("path", path)
    found = components_in_file(file, *_checked_unit_and_step(units, dt), use_obspy=False)
    return select_component(file, found, None, vertical=False)


def components_in_file(
    file: Path, units: AccelerationUnit | None, dt: float | None, *, use_obspy: bool = True, common: bool = False
) -> list[GroundMotion]:
    """Return all components in a file, as `read_components` does.

    `use_obspy` tells whether the readers of ObsPy may be used, and `common` whether `units` and `dt` are for many
    files, so that a format that states its own need not agree.
    """
    found = _read_components(file, units, dt, use_obspy=use_obspy, common=common)
    for motion in found:
        difference, text = stated_peak_mismatch(motion)
        if difference > MAX_PEAK_MISMATCH:
            raise InputError(
                f"{file}: {text}. A wrong scale or a changed file explains this: download the record again; or correct "
                "the peak in the header, if the samples are right."
            )
    return found


def is_of_a_network(lines: list[str]) -> bool:
    """Return whether lines of text begin as a file in one of `FORMATS` does, or in one of another network."""
    return any(each.known(lines) for each in _text_formats())


def _text_formats(*, use_gmprocess: bool = True) -> list[RecordFormat]:
    """Return the formats that are known by their first lines; those that gmprocess reads come last."""
    others = [
        RecordFormat(each.name, each.knows, partial(parse_network, network=each, use_gmprocess=use_gmprocess))
        for each in NETWORKS
    ]
    return [*FORMATS.values(), *others]


def _read_components(
    file: Path, units: AccelerationUnit | None, dt: float | None, *, use_obspy: bool, common: bool
) -> list[GroundMotion]:
    content = _text.read_file_bytes(file)
    if is_excel_workbook(content):
        return parse_excel(file, content, units, dt)
    if use_obspy and _text.decoded_text(content) is None:
        form = _obspy.obspy_format(content)
        if form is not None:
            return _with_stated_step(file, _obspy.parse_obspy(file, content, form, units), dt)
        if not _obspy.is_obspy_installed():
            raise InputError(f"{file} is a binary file, but a record is expected as text or .xlsx. {_obspy.INSTALL}")
    lines = _text.text_lines(file, content)
    for form in _text_formats(use_gmprocess=use_obspy):
        if form.known(lines):
            found = form.parse(file, lines)
            if units is not None and not common:
                raise InputError(
                    f"{file} is a file in the {form.name} format, which states its unit, but units="
                    f"{shown(str(units))} was given. Leave units out.",
                    field="units",
                )
            return found if common else _with_stated_step(file, found, dt)
    if find_at2_header(lines) is not None or file.suffix.lower() == ".at2":
        return _with_stated_step(file, [_read_at2_in_g(file, lines, units)], dt)
    return _read_columns(file, content if use_obspy else b"", lines, units, dt)


def _read_columns(
    file: Path, content: bytes, lines: list[str], units: AccelerationUnit | None, dt: float | None
) -> list[GroundMotion]:
    """Return the columns of a text; without any, what ObsPy finds in the content."""
    try:
        return parse_columns(file, _text.parse_numeric_table(file, lines), units, dt, file.stem)
    except InputError as error:
        form = _obspy.obspy_format(content) if content and error.field is None else None
        if form is None:
            raise
        try:
            return _with_stated_step(file, _obspy.parse_obspy(file, content, form, units), dt)
        except _obspy.ObsPyError:
            raise error from None


def _read_at2_in_g(file: Path, lines: list[str], units: AccelerationUnit | None) -> GroundMotion:
    motion = parse_at2(file, lines)
    if units not in (None, AccelerationUnit("g")):
        raise InputError(
            f"{file} is an AT2 file, in g by definition, but units={shown(str(units))} was given. Leave units out.",
            field="units",
        )
    return motion


def _with_stated_step(file: Path, found: list[GroundMotion], dt: float | None) -> list[GroundMotion]:
    """Return the components of a file that states its step, if `dt` does not contradict it."""
    stated = found[0].dt
    if dt is not None and abs(dt - stated) > 1e-9 * dt:
        raise InputError(f"{file} states DT = {stated:g} s, but dt={shown(dt)} was given. Leave dt out.", field="dt")
    return found


def _checked_unit_and_step(units: str | None, dt: float | None) -> tuple[AccelerationUnit | None, float | None]:
    step = None if dt is None else checked_positive("dt", dt, "s")
    return None if units is None else declared_acceleration_unit(units), step


def _warn_of_stated_peak(file: Path, motion: GroundMotion) -> None:
    _, text = stated_peak_mismatch(motion)
    if text:
        warnings.warn(f"{file}: {text}.", RecordWarning, stacklevel=3)


def stated_peak_mismatch(motion: GroundMotion) -> tuple[float, str]:
    """Return by how much the peak of a motion differs from that stated in its header, relative to the larger one.

    The text says both peaks, and whether they agree when the mean is subtracted; it is empty if they agree, or none is
    stated. For a mean that explains the difference, the first value is at most `MAX_PEAK_MISMATCH`.
    """
    stated, processing = record_info_of(motion).stated_pga, record_info_of(motion).processing or ""
    done = MEAN_SUBTRACTED if MEAN_SUBTRACTED in processing else ""
    if not stated:
        return 0.0, ""
    difference = _relative_difference(motion.pga, stated)
    if difference <= PEAK_TOLERANCE:
        return difference, ""
    without = float(np.max(np.abs(motion.acceleration - motion.acceleration.mean())))
    explained = not done and _relative_difference(without, stated) <= PEAK_TOLERANCE
    text = translated(
        "the header states a PGA of {stated} m/s², but the samples reach {peak} m/s² ({done})"
        if done
        else "the header states a PGA of {stated} m/s², but the samples reach {peak} m/s², and {without} m/s² when "
        "their mean is subtracted, which was not done: motion.baseline_corrected(0) is close to it"
        if explained
        else "the header states a PGA of {stated} m/s², but the samples reach {peak} m/s², and {without} m/s² when "
        "their mean is subtracted",
        stated=f"{stated:.6g}",
        peak=f"{motion.pga:.6g}",
        without=f"{without:.6g}",
        done=done,
    )
    return min(difference, MAX_PEAK_MISMATCH) if explained else difference, text


def _relative_difference(one: float, other: float) -> float:
    return 0.0 if abs(one - other) <= PRINTED_DIGIT else abs(one - other) / max(one, other)


def select_component(file: Path, found: list[GroundMotion], component: str | None, *, vertical: bool) -> GroundMotion:
    """Return the component with a name; without one, the only horizontal or, if `vertical`, the only vertical one."""
    if component is not None:
        named = [motion for motion in found if _is_component_named(motion, component)]
        if len(named) == 1:
            return named[0]
        raise InputError(
            f"{file} holds {len(named) or 'no'} components named {shown(component)}. "
            f"It holds {_component_names(found)}.",
            field="component",
        )
    fitting = [motion for motion in found if is_vertical_component(motion) == vertical] or found
    if len(fitting) == 1:
        return fitting[0]
    raise InputError(
        f"{file} holds {len(found)} components: {_component_names(found)}. Name one: "
        f"read_motion(path, component={_component_name(fitting[0])!r}); read_components and read_suite read all.",
        field="component",
    )


def _is_component_named(motion: GroundMotion, component: str) -> bool:
    azimuth = record_info_of(motion).azimuth
    wanted = component.strip().casefold()
    if azimuth is not None and wanted.isdecimal() and wanted.isascii() and len(wanted) <= 3:
        return float(wanted) % 360.0 == azimuth % 360.0
    return wanted in (_component_name(motion).casefold(), motion.name.casefold())


def _component_name(motion: GroundMotion) -> str:
    return record_info_of(motion).component or motion.name


def _component_names(found: list[GroundMotion]) -> str:
    return ", ".join(shown(_component_name(each)) + " (vertical)" * is_vertical_component(each) for each in found)
