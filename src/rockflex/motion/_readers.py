"""Reading a record file: the content decides on the format."""

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from rockflex.foundation.checks import checked_instance
from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError, RecordWarning
from rockflex.foundation.files import checked_file_path
from rockflex.foundation.language import translated
from rockflex.foundation.registry import Catalogue
from rockflex.foundation.shown import shown
from rockflex.motion import _obspy, _text
from rockflex.motion._at2 import at2_header_end, parse_at2
from rockflex.motion._columns import parse_columns
from rockflex.motion._cosmos import is_cosmos, parse_cosmos
from rockflex.motion._csmip import is_csmip, parse_csmip
from rockflex.motion._declared import Declared, Layout, declared
from rockflex.motion._esm import is_esm, parse_esm
from rockflex.motion._excel import is_excel_workbook, parse_excel
from rockflex.motion._geonet import is_geonet, parse_geonet
from rockflex.motion._gmprocess import NETWORKS, parse_network
from rockflex.motion._ground_motion import GroundMotion, is_vertical_component, record_info_of
from rockflex.motion._japan_csv import is_jma_csv, is_knet_csv, parse_jma_csv, parse_knet_csv
from rockflex.motion._knet import is_knet, parse_knet
from rockflex.motion._record_info import RecordInfo
from rockflex.motion._recorded import MEAN_SUBTRACTED
from rockflex.motion._sequence import find_sequence, motion_of_sequence
from rockflex.motion._smc import is_smc, parse_smc


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
LIKE_GRAVITY = (0.8, 1.2)  # g; no earthquake has such a mean
MAX_PEAK_MISMATCH = 0.2  # relative difference that only a wrong scale or another record explains


def read_motion(
    path: str | Path,
    units: str | None = None,
    dt: float | None = None,
    vertical: str | Path | None = None,
    component: str | None = None,
    layout: Layout | None = None,
) -> GroundMotion:
    """Read a record; the content of the file decides on its format.

    - AT2 files of PEER, in g; see `read_at2`.
    - K-NET and KiK-net ASCII: counts times the scale factor of the header. The mean of the record is subtracted, as
      for the peak that the header states. K-NET CSV, without the offsets in its header, and CSV of JMA: three
      components.
    - ESM, ITACA (also before DYNA 1.2) and TADAS of AFAD, in the unit that the header states.
    - COSMOS (V1, V2; V0 if the header states the value of a count), CSMIP (V1, RAW, V2) and SMC of the USGS, with one
      or more channels.
    - GeoNet (V1A, V2A), with all components of an instrument, in mm/s².
    - BHRC, CWB, NSMN, RENADIC, UNAM and USC through gmprocess; needs ``rockflex[gmprocess]``.
    - CSV, and text in columns. Columns are separated by commas, semicolons, tabs or blanks, and cells may stand in
      quotes; decimals may be marked by commas where something else separates; ``#``, ``%`` and ``!`` begin comments. A
      single column is the acceleration, two columns are time and acceleration, unless a header line names them as two
      components. With more columns, a header line must name one as time and at least one as acceleration; a label
      "vertical" or "up", also after "acc", is the vertical acceleration, positive upwards. More than one horizontal
      acceleration needs names, as in "acc NS (g), acc EW (g)", "a_x (g), a_y (g), a_z (g)" or "NS (gal), EW (gal),
      UD (gal)"; z, v and UD are vertical.
    - Values in sequence, in lines of any length: under ``NPTS= 4000, DT= .005 SEC`` or another header that states how
      many there are, under a line ``npts dt``, or five and more a line without labels.
    - Excel workbooks (.xlsx), with the same columns in one or more sheets; needs openpyxl, ``rockflex[excel]``.
    - Formats that ObsPy reads, such as MiniSEED, SAC, GSE2 and Kinemetrics EVT; needs ObsPy, ``rockflex[obspy]``.

    The motion starts at the first sample, whatever its time.

    Parameters
    ----------
    path : str or Path
        The file.
    units : str, optional
        Unit of the acceleration: "g", "m/s2", "cm/s2", "mm/s2", "mg", "in/s2", or a number and one of these, such as
        "2.4e-4 cm/s2" for the value of one count. Needed unless the label of a column states it, as "acc (g)",
        "a [m/s^2]" or "acc_gal", or a line above the numbers does, or the format. It may not contradict these; where
        they contradict each other, it decides.
    dt : float, optional
        Sampling step in s; needed if the file has no times, and no line above the numbers says "dt = 0.01 s",
        "sampling rate: 100 Hz" or the like; and if the step would be below 1e-4 or above 0.1 s, since such numbers
        mostly are in another unit or count rows. For a file with a time column it replaces times that were rounded in
        print: each must lie within half a step, or one printed digit, of its nominal time.
    vertical : str or Path, optional
        The file of the vertical component, with the same time step; `units` and `dt` apply to it as well. It may be the
        same file, if that holds several components. Zeros are appended to the shorter record, and a component that is
        positive downwards is reversed; see `GroundMotion.with_vertical`, which also joins two records that are read one
        by one.
    component : str, optional
        Name of the component, for a file with several horizontal ones; see `read_components`.
    layout : {"columns", "sequence"}, optional
        Whether the lines of a text file without a known format hold columns, or values that follow each other; found
        out by default.

    Returns
    -------
    GroundMotion
        The record in m/s², named after the file without its suffix, and after the component if the file has several.
        `GroundMotion.metadata` contains the information in the header; its `findings` tell what says which quantity,
        unit, time step and component the samples have.

    Raises
    ------
    InputError
        If the file is missing, empty, of an unknown format, or needs a package that is not installed; it holds a
        velocity, displacement or spectrum; `units` or `dt` is missing, contradicts the file or is not valid; the file
        contradicts itself; a value is not a finite number; there are fewer or more values
        than the header states; rows differ in length; time steps are not equal and positive; the peak exceeds 5 g,
        which indicates a wrong unit, or differs by more than 20 % from that in the header. A file is never read in
        part. Also if there are several horizontal components and `component` names none of them. With `vertical` also
        if the time steps differ, or a component is known to have the other direction.

    Warns
    -----
    RecordWarning
        If the peak differs by 1 to 20 % from that in the header, or the mean is about 1 g.

    Examples
    --------
    >>> import rockflex as rf
    >>> import numpy as np
    >>> np.savetxt("record.txt", [[0.0, 0.0], [0.01, 0.1], [0.02, 0.0]])  # s, g
    >>> rf.read_motion("record.txt", units="g")
    GroundMotion('record', 3 samples, dt=0.01 s, duration=0.02 s, pga=0.981 m/s²)
    """
    given = declared(units, dt, layout)
    if component is not None:
        checked_instance("component", component, str)
    file = checked_file_path("path", path)
    motion = select_component(file, components_in_file(file, given), component, vertical=False)
    _warn_of_remarks(file, motion)
    if vertical is None:
        return motion
    other = checked_file_path("vertical", vertical)
    upwards = select_component(other, components_in_file(other, given), None, vertical=True)
    _warn_of_remarks(other, upwards)
    return motion.with_vertical(upwards)


def read_components(
    path: str | Path, units: str | None = None, dt: float | None = None, layout: Layout | None = None
) -> tuple[GroundMotion, ...]:
    r"""Read all components in a file: the channels of an instrument, the columns of a table, the sheets of a workbook.

    Parameters
    ----------
    path, units, dt, layout
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
    >>> text = "time (s), NS (gal), EW (gal), UD (gal)\n"
    >>> text += "0.00, 0, 0, 0\n0.01, 5, 3, 1\n0.02, -4, 6, 2\n"
    >>> _ = Path("station.csv").write_text(text)
    >>> [motion.name for motion in rf.read_components("station.csv")]
    ['station-NS', 'station-EW', 'station-UD']
    """
    given = declared(units, dt, layout)
    file = checked_file_path("path", path)
    found = components_in_file(file, given)
    for motion in found:
        _warn_of_remarks(file, motion)
    return tuple(found)


def read_motion_without_obspy(path: str | Path, units: str | None = None, dt: float | None = None) -> GroundMotion:
    """Read a record as `read_motion` does, but without ObsPy, whose readers are not made for files of strangers."""
    file = checked_file_path("path", path)
    found = components_in_file(file, declared(units, dt), use_obspy=False)
    return select_component(file, found, None, vertical=False)


def components_in_file(file: Path, given: Declared, *, use_obspy: bool = True) -> list[GroundMotion]:
    """Return all components in a file, as `read_components` does; `use_obspy` tells whether ObsPy may read it."""
    found = _read_components(file, given, use_obspy=use_obspy)
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


def _read_components(file: Path, given: Declared, *, use_obspy: bool) -> list[GroundMotion]:
    content = _text.read_file_bytes(file)
    if is_excel_workbook(content):
        return parse_excel(file, content, given)
    if use_obspy and _text.decoded_text(content) is None:
        form = _obspy.obspy_format(content)
        if form is not None:
            return _with_stated_step(file, _obspy.parse_obspy(file, content, form, given.units), given)
        if not _obspy.is_obspy_installed():
            raise InputError(f"{file} is a binary file, but a record is expected as text or .xlsx. {_obspy.INSTALL}")
    lines = _text.text_lines(file, content)
    for form in _text_formats(use_gmprocess=use_obspy):
        if form.known(lines):
            found = form.parse(file, lines)
            if given.units is not None and not given.common:
                raise InputError(
                    f"{file} is a file in the {form.name} format, which states its unit, but units="
                    f"{shown(str(given.units))} was given. Leave units out.",
                    field="units",
                )
            return found if given.common else _with_stated_step(file, found, given)
    if at2_header_end(lines) is not None or file.suffix.lower() == ".at2":
        return [parse_at2(file, lines, given)]
    return _read_numbers(file, content if use_obspy else b"", lines, given)


def _read_numbers(file: Path, content: bytes, lines: list[str], given: Declared) -> list[GroundMotion]:
    """Return the values of a text, in sequence or in columns; without any, what ObsPy finds in the content."""
    try:
        found = _text.split_numeric_lines(file, lines)
        sequence = find_sequence(file, found, given)
        if sequence is not None:
            return [motion_of_sequence(file, sequence, given, RecordInfo())]
        return parse_columns(file, _text.numeric_table(file, found), given, file.stem)
    except InputError as error:
        form = _obspy.obspy_format(content) if content and error.field is None else None
        if form is None:
            raise
        try:
            return _with_stated_step(file, _obspy.parse_obspy(file, content, form, given.units), given)
        except _obspy.ObsPyError:
            raise error from None


def _with_stated_step(file: Path, found: list[GroundMotion], given: Declared) -> list[GroundMotion]:
    """Return the components of a file that states its step, if the caller does not contradict it."""
    stated = found[0].dt
    if given.dt is not None and abs(given.dt - stated) > 1e-9 * given.dt:
        raise InputError(
            f"{file} states DT = {stated:g} s, but dt={shown(given.dt)} was given. Leave dt out.", field="dt"
        )
    return found


def _warn_of_remarks(file: Path, motion: GroundMotion) -> None:
    for text in remarks_on_samples(motion):
        warnings.warn(f"{file}: {text}.", RecordWarning, stacklevel=3)


def remarks_on_samples(motion: GroundMotion) -> list[str]:
    """Return what is odd about the samples of a record: another peak than that stated, or the weight among them."""
    _, peak = stated_peak_mismatch(motion)
    mean = float(motion.acceleration.mean())
    weight = translated(
        "the mean is {mean} m/s², about 1 g, so that the sensor seems to have measured gravity too, which doubles the "
        "weight: motion.baseline_corrected(0) takes the mean off",
        mean=f"{mean:.4g}",
    )
    return [*filter(None, [peak]), *([weight] if LIKE_GRAVITY[0] <= abs(mean) / GRAVITY <= LIKE_GRAVITY[1] else [])]


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
