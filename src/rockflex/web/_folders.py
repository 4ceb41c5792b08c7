"""Sets of records that visitors give: read in a temporary folder, reported on, and kept in memory under a checksum."""

import hashlib
import warnings
from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Lock
from typing import Any

from rockflex._errors import InputError, RecordWarning
from rockflex._json import plain
from rockflex.motion import GroundMotion, RecordSurvey, Suite, SurveyEntry, survey_plain
from rockflex.motion._record_info import unique_names
from rockflex.web._limits import FILE, SAMPLES_KEPT, SAMPLES_TOGETHER, check_motion
from rockflex.web._refusal import Refusal
from rockflex.web._unpacking import FIELD, GivenFile

GONE = (
    "the server no longer has these records: it was restarted, or others gave newer ones. Give the folder again on "
    "the Earthquake tab; a link does not contain it."
)
NONE = "no records were given yet. Choose a folder on the Earthquake tab first."


@dataclass(frozen=True, eq=False)
class Folder:
    """Records of a visitor, and what the page reports of them.

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


class Folders:
    """Sets of records by the checksum of their files; the latest ones of all visitors, as far as memory is set aside.

    The checksum is known only to those who have the files or a link with it.
    """

    def __init__(self) -> None:
        self._kept: OrderedDict[str, Folder] = OrderedDict()
        self._lock = Lock()

    def add(self, folder: Folder, files: Sequence[GivenFile], options: str) -> str:
        """Keep a set, and return its checksum."""
        digest = hashlib.sha256(options.encode())
        for each in sorted(files, key=lambda file: file.name):
            content = each.content or b""
            digest.update(f"\0{each.name}\0{each.size}\0{len(content)}\0".encode())
            digest.update(content)
        token = digest.hexdigest()
        with self._lock:
            self._kept[token] = folder
            self._kept.move_to_end(token)
            while len(self._kept) > 1 and sum(each.samples for each in self._kept.values()) > SAMPLES_KEPT:
                self._kept.popitem(last=False)
        return token

    def get(self, token: str) -> Folder:
        """Return a set.

        Raises
        ------
        Refusal
            If it is not, or no longer, kept.
        """
        with self._lock:
            found = self._kept.get(token)
            if found is not None:
                self._kept.move_to_end(token)
        if found is None:
            raise Refusal({FIELD: GONE if token else NONE}, 410)
        return found


def read_folder(files: Sequence[GivenFile], units: str | None, dt: float | None) -> Folder:
    """Read the files of a visitor, as `survey_records` does, without ObsPy.

    Raises
    ------
    Refusal
        If there is no record among them that can be used, or they have too many samples together.
    """
    large = [
        SurveyEntry(
            file=each.name,
            taken=False,
            reason=f"it has {each.size / 1e6:.1f} MB, but the page takes files of {FILE / 1e6:g} MB at most",
        )
        for each in files
        if each.content is None
    ]
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", RecordWarning)
        along, both = _surveys(files, units, dt)
    samples = sum(motion.acceleration.size for motion in along.motions)
    if samples > SAMPLES_TOGETHER:
        message = f"the records have {samples} samples together, but the page takes {SAMPLES_TOGETHER} at most."
        raise Refusal({FIELD: f"{message} Choose fewer."}, 413)
    refused = {place: text for place, motion in enumerate(along.motions) if (text := _too_long(motion))}
    kept = [place for place in range(len(along.motions)) if place not in refused]
    if not kept:
        raise Refusal({FIELD: _none_of([*large, *along.entries], refused)})
    names = unique_names([motion.name for motion in along.motions])
    suites = [Suite(replace(each.motions[place], name=names[place]) for place in kept) for each in (along, both)]
    report = _report(along, both, names, refused)
    report["entries"] = sorted([*(_entry(each) for each in large), *report["entries"]], key=lambda entry: entry["file"])
    report["notes"] = sorted({str(warning.message) for warning in caught})
    paired = any(motion.vertical is not None for motion in both.motions)
    return Folder(plain(report), suites[0], suites[1] if paired else suites[0])


def _surveys(files: Sequence[GivenFile], units: str | None, dt: float | None) -> tuple[RecordSurvey, RecordSurvey]:
    try:
        with TemporaryDirectory() as folder:
            for each in files:
                if each.content is not None:
                    (Path(folder) / each.name).write_bytes(each.content)
            try:
                return survey_plain(Path(folder), units, dt)
            except InputError as error:
                raise Refusal({FIELD: str(error).replace(folder, "the folder")}) from error
    except OSError as error:
        message = "the server could not store the files temporarily. Try again."
        raise Refusal({FIELD: message}, 503) from error


def _too_long(motion: GroundMotion) -> str:
    try:
        check_motion(motion, "")
    except Refusal as error:
        return error.errors[""]
    return ""


def _none_of(entries: Sequence[SurveyEntry], refused: dict[int, str]) -> str:
    first = next(iter(refused.values()), "") or next((f"{e.file}: {e.reason}" for e in entries if e.reason), "")
    return f"none of the files is a horizontal record that can be used. {first}"


def _report(along: RecordSurvey, both: RecordSurvey, names: list[str], refused: dict[int, str]) -> dict[str, Any]:
    """Return the entries of a survey with the stations of its records.

    Both surveys have the same motions and entries in the same order; they differ in what they say of vertical ones.
    """
    station_of = {motion.name: station for station in along.stations for motion in station.horizontal}
    entries: list[dict[str, Any]] = []
    place = 0
    for entry, paired in zip(along.entries, both.entries, strict=True):
        found = _entry(entry)
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
            found |= {"reason": "vertical component, which can be used with the horizontal ones", "paired": True}
        entries.append(found)
    stations = [
        {
            "name": station.name,
            "horizontal": [motion.name for motion in station.horizontal],
            "vertical": None if station.vertical is None else station.vertical.name,
        }
        for station in along.stations
    ]
    return {"entries": entries, "stations": stations}


def _entry(entry: SurveyEntry) -> dict[str, Any]:
    facts = ("file", "taken", "reason", "name", "format", "station", "component", "dt", "pga", "magnitude", "vs30")
    found: dict[str, Any] = {name: getattr(entry, name) for name in facts}
    return found | {
        "distance": entry.distance_km,
        "duration": None,
        "recording": None,
        "vertical": False,
        "paired": False,
    }
