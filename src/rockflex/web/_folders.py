"""Folders of records that visitors send: unpacked, read, and reported on."""

import io
import re
import warnings
import zipfile
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import PurePosixPath
from typing import Any

from rockflex.foundation.archives import ArchiveError, ArchiveLimits, open_archive
from rockflex.foundation.errors import InputError, RecordWarning
from rockflex.foundation.json import as_json_value
from rockflex.foundation.language import translated
from rockflex.foundation.shown import first_texts_shown
from rockflex.motion._columns import record_csv
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._record_info import unique_record_names
from rockflex.motion._suite import Suite
from rockflex.motion._survey import RecordSurvey, SurveyEntry, survey_without_obspy
from rockflex.web._limits import (
    MAX_FILE_BYTES,
    MAX_FOLDER_BYTES,
    MAX_FOLDER_FILES,
    MAX_FOLDER_SAMPLES,
    check_record_length,
)
from rockflex.web._refusal import Refusal, temporary_folder
from rockflex.web._state import parse_page_json

FIELD = "record.folder"  # of the messages
MAX_STEM_LETTERS, MAX_SUFFIX_LETTERS = 70, 12  # letters of a name that are kept
MAX_NAME_BYTES = 200  # of them, because file systems count bytes: most take 255 with the suffix
MAX_LIST_BYTES = 500_000  # bytes of the list
MAX_NAMED_FILES = 6  # of those of which the same was found
FORBIDDEN = re.compile(r'[<>:"|?*\x00-\x1f\x7f-\x9f]')


@dataclass(frozen=True)
class SentRecordFile:
    """A file of a visitor; without content if it is too large, with its size in bytes."""

    name: str
    content: bytes | None
    size: int


def unpacked_record_files(body: bytes) -> list[SentRecordFile]:
    """Return the files in a request.

    Parameters
    ----------
    body
        A line of JSON, ``[{"name": "folder/a.AT2", "size": 120, "sent": true}, ...]``, and the contents in this order;
        a file that was too large to be sent has ``"sent": false`` and no content.
    """
    paths, found, work = list[str](), list[tuple[bytes | None, int]](), 0
    for path, content, size in _files_in_list(body):
        if content is not None and path.lower().endswith(".zip"):
            inside = _files_in_archive(path, content, MAX_FOLDER_BYTES - work)
        else:
            inside = [(path, content, size)]
        for name, each, length in inside:
            paths.append(name)
            found.append((each, length))
            work += _unpacked_size(each)
            if work > MAX_FOLDER_BYTES:
                raise _folder_too_large()
            if len(paths) > MAX_FOLDER_FILES:
                raise _folder_refusal(
                    f"there are more than {MAX_FOLDER_FILES} files, which is more than the page takes. Choose fewer."
                )
    if not paths:
        raise _folder_refusal("there is no file in it.")
    return [SentRecordFile(name, *each) for name, each in zip(flat_file_names(paths), found, strict=True)]


def _files_in_list(body: bytes) -> Iterator[tuple[str, bytes | None, int]]:
    head, end, _ = body[:MAX_LIST_BYTES].partition(b"\n")
    if not end:
        raise Refusal("The list of files does not end.", 400)
    place, entries = len(head) + 1, parse_page_json(head)
    for entry in entries if isinstance(entries, list) else [None]:
        name, size, sent = _listed_file_entry(entry)
        content = body[place : place + size] if sent else None
        if content is not None and len(content) < size:
            raise Refusal("The request ends before its files do.", 400)
        yield _checked_folder_path(name), content, size
        place += size if sent else 0
    if place < len(body):
        raise Refusal("The request holds more than the files of its list.", 400)


def _listed_file_entry(entry: Any) -> tuple[str, int, bool]:
    known = isinstance(entry, dict) and isinstance(entry.get("name"), str) and type(entry.get("size")) is int
    if not known or entry["size"] < 0 or not isinstance(entry.get("sent"), bool):
        raise Refusal("A list of files with name, size and sent is expected before their contents.", 400)
    large = entry["size"] > MAX_FILE_BYTES and not entry["name"].lower().endswith(".zip")
    return entry["name"], entry["size"], entry["sent"] and not large


def _files_in_archive(path: str, content: bytes, room: int) -> Iterator[tuple[str, bytes | None, int]]:
    """Yield the files of an archive, of which no more than `room` bytes are unpacked."""
    shown = flat_file_names([path])[0]
    most = ArchiveLimits(MAX_FOLDER_FILES, MAX_FILE_BYTES, max(room, 0))
    try:
        with open_archive(content, most) as archive:
            for each in archive.entries:
                inner = _checked_folder_path(each.filename)
                if each.file_size > MAX_FILE_BYTES:
                    yield inner, None, each.file_size
                else:
                    yield inner, archive.read(each), each.file_size
    except ArchiveError as error:
        if error.kind == "size":
            raise _folder_too_large() from error
        if error.kind == "members":
            raise _folder_refusal(f"{shown} {error}, which is more than the page takes. Pack fewer.") from error
        reason = str(error) if error.kind == "packed" else "is a damaged archive"
        raise _folder_refusal(f"{shown} {reason}. Unpack it, and give the folder instead.") from error


def _unpacked_size(content: bytes | None) -> int:
    """Return the number of bytes read from a file; a workbook is an archive, so its unpacked size counts."""
    if content is None or not content.startswith(b"PK"):
        return len(content or b"")
    try:
        with open_archive(content, ArchiveLimits()) as archive:
            return sum(each.file_size for each in archive.entries)
    except ArchiveError:  # is not unpacked by the reader of workbooks either
        return len(content)


def _checked_folder_path(path: str) -> str:
    """Return a path within the folder of a visitor."""
    parts = re.split(r"[/\\]", path)
    if ".." in parts or not parts[0] or re.match(r"[A-Za-z]:", path):
        raise _folder_refusal(
            f"the name {path[:80]!r} points out of its folder. Pack the records anew, without such names."
        )
    return path


def flat_file_names(paths: Iterable[str]) -> list[str]:
    """Return a different name for each path: its last part, with its folders only where two are equal."""
    names: list[str] = []
    used: set[str] = set()
    for path in paths:
        parts = [part for each in re.split(r"[/\\]", path) if (part := _clean_path_part(each))] or ["file"]
        name = _short_file_name(parts[-1])
        if name.casefold() in used:
            name = _short_file_name("_".join(parts[1:] if len(parts) > 2 else parts))
        plain, count = PurePosixPath(name), 1
        while name.casefold() in used:
            count += 1
            name = f"{plain.stem}-{count}{plain.suffix}"
        used.add(name.casefold())
        names.append(name)
    return names


def _clean_path_part(part: str) -> str:
    text = FORBIDDEN.sub("_", part.encode("utf-8", "replace").decode()).strip()
    return "" if text in (".", "..") else text


def _short_file_name(name: str) -> str:
    path = PurePosixPath(name)
    stem = path.stem[:MAX_STEM_LETTERS].encode()[:MAX_NAME_BYTES].decode("utf-8", "ignore")
    return f"{stem}{path.suffix[:MAX_SUFFIX_LETTERS]}"


def _folder_too_large() -> Refusal:
    message = (
        f"the files have more than {MAX_FOLDER_BYTES / 1e6:g} MB, which is more than the page takes. Choose fewer."
    )
    return _folder_refusal(message, 413)


def _folder_refusal(message: str, status: int = 422) -> Refusal:
    return Refusal({FIELD: message}, status)


ZIP_DATE = (1980, 1, 1, 0, 0, 0)  # the same records give the same archive


def records_as_zip(motions: Iterable[GroundMotion]) -> bytes:
    """Return a ZIP archive with a CSV file of each motion and its metadata."""
    members = list(motions)
    names = flat_file_names(f"{motion.name.replace('/', '_')}.csv" for motion in members)
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED, compresslevel=3) as archive:
        for name, motion in zip(names, members, strict=True):
            archive.writestr(zipfile.ZipInfo(name, ZIP_DATE), record_csv(motion), zipfile.ZIP_DEFLATED)
    return packed.getvalue()


@dataclass(frozen=True, eq=False)
class RecordFolder:
    """Records of a visitor, and the report of them on the page.

    Attributes
    ----------
    report
        One entry for each component or other file, and the stations, as JSON.
    along, both
        The horizontal motions, without and with the vertical components of their stations, under the same names.
    """

    report: dict[str, Any]
    along: Suite
    both: Suite

    @property
    def samples(self) -> int:
        """Number of samples in memory."""
        suites = [self.along] if self.both is self.along else [self.along, self.both]
        return sum(motion.acceleration.size for suite in suites for motion in suite)

    def suite(self, *, vertical: bool) -> Suite:
        """Return the motions, with their vertical components if `vertical`."""
        return self.both if vertical else self.along


def read_record_folder(files: Sequence[SentRecordFile], units: str | None, dt: float | None) -> RecordFolder:
    """Read the files of a visitor, as `survey_records` does, without ObsPy."""
    large = [
        SurveyEntry(
            file=each.name,
            taken=False,
            reason=translated(
                "it has {size} MB, but the page takes files of {most} MB at most",
                size=f"{each.size / 1e6:.1f}",
                most=f"{MAX_FILE_BYTES / 1e6:g}",
            ),
        )
        for each in files
        if each.content is None
    ]
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", RecordWarning)
        along, both = _folder_surveys(files, units, dt)
    samples = sum(motion.acceleration.size for motion in along.motions)
    if samples > MAX_FOLDER_SAMPLES:
        message = f"the records have {samples} samples together, but the page takes {MAX_FOLDER_SAMPLES} at most."
        raise Refusal({FIELD: f"{message} Choose fewer."}, 413)
    refused = {place: text for place, motion in enumerate(along.motions) if (text := _record_too_long_text(motion))}
    kept = [place for place in range(len(along.motions)) if place not in refused]
    if not kept:
        raise Refusal({FIELD: _no_record_in_folder_text([*large, *along.entries], refused)})
    names = unique_record_names([motion.name for motion in along.motions])
    suites = [Suite(replace(each.motions[place], name=names[place]) for place in kept) for each in (along, both)]
    report = _folder_report(along, both, names, refused)
    report["entries"] = sorted(
        [*(_folder_report_entry(each) for each in large), *report["entries"]], key=lambda entry: entry["file"]
    )
    report["notes"] = sorted({str(warning.message) for warning in caught})
    paired = any(motion.vertical is not None for motion in both.motions)
    return RecordFolder(as_json_value(report), suites[0], suites[1] if paired else suites[0])


def _folder_surveys(
    files: Sequence[SentRecordFile], units: str | None, dt: float | None
) -> tuple[RecordSurvey, RecordSurvey]:
    with temporary_folder(FIELD) as folder:
        for each in files:
            if each.content is not None:
                (folder / each.name).write_bytes(each.content)
        try:
            return survey_without_obspy(folder, units, dt)
        except InputError as error:
            raise Refusal({FIELD: str(error).replace(str(folder), "the folder")}) from error


def _record_too_long_text(motion: GroundMotion) -> str:
    try:
        check_record_length(motion, "")
    except Refusal as error:
        return error.errors[""]
    return ""


def _no_record_in_folder_text(entries: Sequence[SurveyEntry], refused: dict[int, str]) -> str:
    first = next(iter(refused.values()), "") or next((f"{e.file}: {e.reason}" for e in entries if e.reason), "")
    return f"none of the files is a horizontal record that can be used. {first}"


def _folder_report(
    along: RecordSurvey, both: RecordSurvey, names: list[str], refused: dict[int, str]
) -> dict[str, Any]:
    """Return the entries of a survey with the stations of its records.

    Both surveys have the same motions and entries in the same order; they differ in what they say of vertical ones.
    """
    station_of = {motion.name: station for station in along.stations for motion in station.horizontal}
    entries: list[dict[str, Any]] = []
    place = 0
    for entry, paired in zip(along.entries, both.entries, strict=True):
        found = _folder_report_entry(entry)
        if entry.taken:  # a horizontal one: without "pair" a survey takes no others
            motion, upright = along.motions[place], both.motions[place].vertical is not None
            station = station_of.get(motion.name)
            found |= {
                "name": names[place],
                "duration": motion.duration,
                "taken": place not in refused,
                "reason": refused.get(place, entry.reason),
                "recording": None if station is None else station.name,
                "vertical": upright,
            }
            place += 1
        elif paired.taken:
            found["reason"] = translated("vertical component, which can be used with the horizontal ones")
            found["paired"] = True
        entries.append(found)
    stations = [
        {
            "name": station.name,
            "horizontal": [motion.name for motion in station.horizontal],
            "vertical": None if station.vertical is None else station.vertical.name,
        }
        for station in along.stations
    ]
    findings = [f"{each}: {first_texts_shown(files, MAX_NAMED_FILES)}" for each, files in along.findings.items()]
    return {"entries": entries, "stations": stations, "findings": findings}


def _folder_report_entry(entry: SurveyEntry) -> dict[str, Any]:
    facts = ("file", "taken", "reason", "name", "format", "station", "component", "dt", "pga", "magnitude", "vs30")
    found: dict[str, Any] = {name: getattr(entry, name) for name in facts}
    return found | {
        "distance": entry.distance_km,
        "duration": None,
        "recording": None,
        "vertical": False,
        "paired": False,
    }
