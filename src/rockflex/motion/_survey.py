"""A report of the records in a folder: which components are taken, which are not, and why."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, get_args

from rockflex.foundation.language import translated
from rockflex.foundation.values import Value
from rockflex.motion import _read_suite
from rockflex.motion._findings import Finding, What
from rockflex.motion._ground_motion import GroundMotion, record_info_of
from rockflex.motion._readers import stated_peak_mismatch
from rockflex.motion._record_files import FolderFiles, record_files
from rockflex.motion._recordings import StationRecord, file_names_text, group_stations
from rockflex.motion._suite import Suite

if TYPE_CHECKING:
    import pandas as pd

COPIED_FACTS = ("station", "component", "direction", "stated_pga", "magnitude", "distance_km", "vs30")  # of RecordInfo


@dataclass(frozen=True, kw_only=True)
class SurveyEntry:
    """A component in a file, or a file that holds none; None where something is unknown.

    Parameters
    ----------
    file : str
        Name of the file.
    taken : bool
        Whether `read_suite` takes the component as a horizontal motion, or as the vertical one of such a motion.
    reason : str
        Why it is not taken, or a remark on one that is; may be empty.
    name : str, optional
        Name of the motion.
    format : str, optional
        Format of the file.
    station, component : str, optional
        Recording station, and name of the component.
    direction : str, optional
        Direction of the component, as in `RecordInfo`.
    dt : float, optional
        Time step in s.
    n_samples : int, optional
        Number of samples.
    pga, stated_pga : float, optional
        Peak of the samples, and that in the header, in m/s².
    magnitude, distance_km, vs30 : float, optional
        As in `RecordInfo`, from the header or a table about the records.
    findings : tuple of Finding
        What the reader found about quantity, unit, time step and component, and what says so.

    Examples
    --------
    >>> import rockflex as rf
    >>> entry = rf.SurveyEntry(file="A-UP.AT2", taken=False,
    ...     reason="vertical component", name="A-UP")
    >>> entry.taken, entry.reason
    (False, 'vertical component')
    """

    file: str
    taken: bool
    reason: str
    name: str | None = None
    format: str | None = None
    station: str | None = None
    component: str | None = None
    direction: str | None = None
    dt: float | None = None
    n_samples: int | None = None
    pga: float | None = None
    stated_pga: float | None = None
    magnitude: float | None = None
    distance_km: float | None = None
    vs30: float | None = None
    findings: tuple[Finding, ...] = ()


@dataclass(frozen=True, eq=False, repr=False)
class RecordSurvey(Value):
    r"""The components taken from a folder of records, and the ones left out; the result of `survey_records`.

    Parameters
    ----------
    name : str
        Name of the folder; empty for a list of files.
    entries : tuple of SurveyEntry
        One for each component, or file that holds none, sorted by file.
    motions : tuple of GroundMotion
        The horizontal motions that are taken.
    stations : tuple of StationRecord
        All components that can be read, except copies, by recording; see `group_stations`.

    Examples
    --------
    >>> import rockflex as rf
    >>> from pathlib import Path
    >>> _ = Path("lab.csv").write_text(
    ...     "time (s), acc (g)\n0.00, 0.0\n0.01, 0.2\n0.02, 0.0\n")
    >>> survey = rf.survey_records(["lab.csv"])
    >>> survey.suite().names, survey.left_out
    (('lab',), ())
    """

    name: str
    entries: tuple[SurveyEntry, ...]
    motions: tuple[GroundMotion, ...]
    stations: tuple[StationRecord, ...]

    @property
    def taken(self) -> tuple[SurveyEntry, ...]:
        """Entries of the components that are taken."""
        return tuple(entry for entry in self.entries if entry.taken)

    @property
    def left_out(self) -> tuple[SurveyEntry, ...]:
        """Entries of the components and files that are not taken, with the reasons."""
        return tuple(entry for entry in self.entries if not entry.taken)

    @property
    def findings(self) -> dict[Finding, tuple[str, ...]]:
        """The findings of the readers with their evidence, each with the files that it is true of."""
        files: dict[Finding, dict[str, None]] = {}
        for entry in self.entries:
            for each in entry.findings:
                files.setdefault(each, {})[entry.file] = None
        order = get_args(What)
        return {each: tuple(files[each]) for each in sorted(files, key=lambda each: order.index(each.what))}

    def suite(self) -> Suite:
        """Return the suite of the motions that are taken, as ``read_suite(paths, on_error="skip")`` does.

        Raises
        ------
        InputError
            If there is none, or two have the same name.
        """
        return Suite(self.motions, self.name)

    def to_frame(self) -> "pd.DataFrame":
        """Return the entries as a table, with a row for each and a column for each field of `SurveyEntry`."""
        import pandas as pd

        rows = [{**vars(entry), "findings": "; ".join(map(str, entry.findings))} for entry in self.entries]
        return pd.DataFrame(rows, columns=[each.name for each in fields(SurveyEntry)])

    def __repr__(self) -> str:
        return f"RecordSurvey({self.name!r}, {len(self.taken)} taken, {len(self.left_out)} left out)"


def survey_records(
    paths: str | Path | Iterable[str | Path],
    units: str | Mapping[str, str] | None = None,
    dt: float | None = None,
    vertical: _read_suite.Vertical | None = None,
    table: str | Path | None = None,
) -> RecordSurvey:
    r"""Report the content of each file in a folder, whether `read_suite` takes it, and why not.

    No file is an error: one that cannot be read has an entry with the reason. Files that are no records by their suffix
    and their beginning have entries too, and so have folders and archives, which are not looked into.

    Parameters
    ----------
    paths, units, dt, vertical, table
        As in `read_suite`.

    Raises
    ------
    InputError
        If there is no such folder, it holds no record, `units`, `dt` or `vertical` is not valid, or `table` cannot be
        read.

    Examples
    --------
    >>> import rockflex as rf
    >>> from pathlib import Path
    >>> Path("survey").mkdir()
    >>> for name in ("ABC090", "ABC-UP"):
    ...     _ = Path("survey",
    ...     f"{name}.AT2").write_text("NPTS= 3, DT= .01 SEC\n0 .1 0\n")
    >>> _ = Path("survey", "notes.txt").write_text("Downloaded in spring\n")
    >>> survey = rf.survey_records("survey")
    >>> survey
    RecordSurvey('survey', 1 taken, 2 left out)
    >>> [(entry.file, entry.reason[:21]) for entry in survey.left_out]
    [('ABC-UP.AT2', 'vertical component'), ('notes.txt', 'holds no numbers: a r')]
    """
    _read_suite.check_vertical_option(vertical)
    folder = record_files(paths)
    return _survey_of_components(
        folder, _read_suite.read_record_files(folder.files, units, dt, table), pair=vertical is not None
    )


def survey_without_obspy(
    folder: Path, units: str | None = None, dt: float | None = None
) -> tuple[RecordSurvey, RecordSurvey]:
    """Survey a folder as `survey_records` does, but without ObsPy, whose readers are not made for files of strangers.

    The first survey has the horizontal components alone, the second the vertical ones of their stations, too.
    """
    files = record_files(folder)
    found = _read_suite.read_record_files(files.files, units, dt, use_obspy=False)
    return _survey_of_components(files, found, pair=False), _survey_of_components(files, found, pair=True)


def _survey_of_components(
    folder: FolderFiles, found: Sequence[_read_suite.RecordFileContent], *, pair: bool
) -> RecordSurvey:
    result = _read_suite.choose_components(found, pair=pair)
    names = [each.file.name for each in found]
    entries = [entry for each in found for entry in _survey_entries(each, result, names)]
    entries += [SurveyEntry(file=name, taken=False, reason=reason) for name, reason in _not_read(folder)]
    left = result.copies.keys() | result.uncorrected.keys()
    motions = [motion for each in found for path, motion in each.motions.items() if path not in left]
    return RecordSurvey(
        folder.name,
        tuple(sorted(entries, key=lambda entry: entry.file)),
        tuple(result.taken[path] for each in found for path in each.motions if path in result.taken),
        group_stations(motions),
    )


def _not_read(folder: FolderFiles) -> Iterator[tuple[str, str]]:
    """Yield the names of files and folders that are not read, and why."""
    for file in (*folder.hidden, *folder.others):
        yield file.name, translated("no record, by suffix and beginning")
    for file in folder.archives:
        yield file.name, translated("an archive, which was not unpacked")
    for path, count in folder.folders.items():
        yield (
            f"{path.name}/",
            translated(
                "a folder with {n} file, which was not entered"
                if count == 1
                else "a folder with {n} files, which was not entered",
                n=count,
            ),
        )


def _survey_entries(
    each: _read_suite.RecordFileContent, result: _read_suite.ChosenComponents, names: list[str]
) -> list[SurveyEntry]:
    if each.table is not None:
        missing = [Path(name) for name in each.table.missing(names)]
        reason = translated(
            "a table about the records"
            if not missing
            else "a table about the records; it lists {n} file that is not there: {files}"
            if len(missing) == 1
            else "a table about the records; it lists {n} files that are not there: {files}",
            n=len(missing),
            files=file_names_text(missing),
        )
        return [SurveyEntry(file=each.file.name, taken=False, reason=reason, format="table")]
    if each.fault is not None:
        # The entry names the file, and files of the same reason share a line where it is printed.
        reason = str(each.fault).replace(str(each.file), each.file.name).removeprefix(each.file.name).lstrip(" ,:")
        return [SurveyEntry(file=each.file.name, taken=False, reason=reason)]
    return [
        SurveyEntry(
            file=each.file.name,
            taken=path in result.taken or path in result.paired,
            reason="; ".join(filter(None, (_survey_reason(path, result), stated_peak_mismatch(motion)[1]))),
            name=motion.name,
            format=record_info_of(motion).source_format,
            dt=motion.dt,
            n_samples=motion.acceleration.size,
            pga=motion.pga,
            findings=record_info_of(motion).findings,
            **{name: getattr(record_info_of(motion), name) for name in COPIED_FACTS},
        )
        for path, motion in each.motions.items()
    ]


def _survey_reason(path: Path, result: _read_suite.ChosenComponents) -> str:
    """Return why a component is not taken, or has no vertical one."""
    if path in result.copies:
        return translated("a copy of {name}", name=result.copies[path].name)
    if path in result.uncorrected:
        return translated("uncorrected; {name} is the corrected record", name=result.uncorrected[path].name)
    if path in result.boreholes:
        return translated("borehole component beneath a record at the surface")
    if path in result.vertical:
        return translated("vertical component")
    return (result.unpaired[path] or translated("without a vertical component")) if path in result.unpaired else ""
