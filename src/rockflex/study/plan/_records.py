"""The records of a study."""

import hashlib
from collections.abc import Iterable
from fnmatch import fnmatchcase
from pathlib import Path

from pydantic import Field, model_validator

from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.motion import GroundMotion, OnError, Suite, Vertical, load_suite, read_suite, recording_names
from rockflex.structure.file import Table


class Records(Table):
    """Records by the names of embedded suites, from a folder, or both.

    Examples
    --------
    >>> import rockflex as rf
    >>> records = rf.Records(suites=["fema-p695-far-field"], include=["FF-1-*"])
    >>> rf.PopulationStudy(records=records.model_dump()).records.include
    ['FF-1-*']
    """

    suites: list[str] = Field(default_factory=list, description='a list of suites, such as "fema-p695-far-field"')
    folder: str | None = Field(None, description="the path of a folder of records, in quotes")
    on_error: OnError = Field(
        "raise", description='"raise" or "skip": what to do with files of the folder that cannot be read'
    )
    vertical: Vertical | None = Field(
        None, description='"pair": each record of the folder with the vertical component of its station'
    )
    include: list[str] = Field(["*"], description='a list of patterns of record names to keep, such as "FF-1-*"')

    @model_validator(mode="after")
    def _some(self) -> "Records":
        if not self.suites and self.folder is None:
            raise InputError('no record is named. Give suites = ["fema-p695-far-field"], folder = "...", or both.')
        if self.folder is None and self.on_error != "raise":
            raise InputError("on_error is for the files of a folder, but none is named. Leave it out.")
        if self.folder is None and self.vertical is not None:
            raise InputError(
                "vertical is for the files of a folder, but none is named: the embedded suites hold no vertical "
                "components. Leave it out."
            )
        return self

    def load(self, base: Path) -> Suite:
        """Load the records, first those of the suites; relative paths start from `base`.

        Raises
        ------
        InputError
            If a suite is unknown, the folder or, unless `on_error` is "skip", a file in it cannot be read, two records
            have the same name, or a pattern of `include` matches no record.
        """
        motions = [motion for name in self.suites for motion in load_suite(name)]
        if self.folder is not None:
            motions += read_suite(base / self.folder, on_error=self.on_error, vertical=self.vertical)
        names = [motion.name for motion in motions]
        for pattern in self.include:
            if not any(fnmatchcase(name, pattern) for name in names):
                raise InputError(
                    f"[records] include: no record's name fits {shown(pattern)}. There are {len(names)}, from "
                    f"{shown(names[0])} to {shown(names[-1])}; * stands for any text and ? for one letter."
                )
        return Suite(m for m in motions if any(fnmatchcase(m.name, pattern) for pattern in self.include))


def record_groups(motions: Iterable[GroundMotion]) -> list[str]:
    """Return the name of each motion's recording, which its components share because they are not independent.

    It is the record sequence number if known, else earthquake and station, else what two names share that differ only
    in the component (ABC000 and ABC090), else the name of the motion.
    """
    members = list(motions)
    alike = recording_names([each.name for each in members])
    return [_known_recording(each) or name for each, name in zip(members, alike, strict=True)]


def _known_recording(motion: GroundMotion) -> str | None:
    info = motion.metadata
    if info is not None and info.rsn is not None:
        return f"RSN{info.rsn}"
    if info is not None and info.event is not None and info.station is not None:
        return " ".join(str(part) for part in (info.event, info.year, info.station) if part is not None)
    return None


def checksums(motions: Iterable[GroundMotion]) -> dict[str, str]:
    """SHA-256 of each record's step and samples (little-endian doubles, vertical ones last), by its name."""
    return {motion.name: _checksum(motion) for motion in motions}


def _checksum(motion: GroundMotion) -> str:
    digest = hashlib.sha256(float(motion.dt).hex().encode())
    digest.update(motion.acceleration.astype("<f8").tobytes())
    if motion.vertical is not None:
        digest.update(motion.vertical.astype("<f8").tobytes())
    return digest.hexdigest()
