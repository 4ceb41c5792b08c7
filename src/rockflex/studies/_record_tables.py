"""Records in files: embedded suites by name, a folder, single files, or motions of Python."""

import re
from collections.abc import Callable
from dataclasses import replace
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Annotated, Any, Self, cast

from pydantic import BeforeValidator, Field, InstanceOf, TypeAdapter, ValidationError, model_validator

from rockflex.foundation.descriptions import PLAIN, Described
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shortened, shown
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._read_suite import OnError, Vertical, read_suite
from rockflex.motion._readers import read_motion
from rockflex.motion._record_info import RecordInfo
from rockflex.motion._suite import Suite, load_suite
from rockflex.structure.file._toml_table import TomlTable
from rockflex.studies._objects import Given

Moved = Callable[[str], str]


class RecordFile(TomlTable):
    """A record: its file, how to read it, its name, its factor, and what is known about it."""

    file: Annotated[str, Described("the path of a record, in quotes", form=PLAIN)]
    name: Annotated[str | None, Described("a name, in quotes (default: that of the file)", form=PLAIN)] = None
    units: Annotated[str | None, Described('the unit of the samples, such as "g"', form=PLAIN)] = None
    dt: Annotated[float | None, Described("the step of the samples", "s")] = None
    component: Annotated[str | None, Described("the name of one of its components, in quotes", form=PLAIN)] = None
    vertical: Annotated[str | None, Described("the path of its vertical component, in quotes", form=PLAIN)] = None
    scale: Annotated[float | None, Described("the factor on the acceleration (default: 1)")] = None
    info: Annotated[dict[str, Any] | None, Described("a table of the fields of RecordInfo", form=PLAIN)] = None

    def load(self, folder: Path) -> GroundMotion:
        """Read the record; relative paths start from `folder`.

        Raises
        ------
        InputError
            As `read_motion`, or if the factor is not finite, or `info` has another field.
        """
        vertical = None if self.vertical is None else folder / self.vertical
        motion = read_motion(folder / self.file, self.units, self.dt, vertical, self.component)
        motion = motion if self.name is None else replace(motion, name=self.name)
        motion = motion if self.info is None else replace(motion, metadata=self.record_info(self.file))
        return motion if self.scale is None else motion.scaled(self.scale)

    def record_info(self, place: str) -> RecordInfo | None:
        """Return what is known about the record; `place` names the file in messages."""
        if self.info is None:
            return None
        try:
            return TypeAdapter(RecordInfo).validate_python(self.info)
        except ValidationError as error:
            raise InputError(f"{place}, info of {shown(self.name or self.file)}: {shortened(str(error))}.") from error

    def moved(self, path: Moved) -> Self:
        """Return the same record with its paths from another folder."""
        vertical = self.vertical if self.vertical is None else path(self.vertical)
        return self.model_copy(update={"file": path(self.file), "vertical": vertical})


def record_row(file: str, motion: GroundMotion) -> dict[str, Any]:
    """Return the keys of a `RecordFile` for a motion that a file has, with all that is known of it but the findings."""
    known = {} if motion.metadata is None else vars(motion.metadata) | {"findings": None}
    info = {name: value for name, value in known.items() if value is not None}
    return {"file": file, "name": motion.name, "dt": motion.dt, **({"info": info} if info else {})}


def numbered_file_name(place: int, name: str, suffix: str) -> str:
    """Return the name of a file for what has a place in a list and a name, which may have any letters."""
    return f"{place:03d}_{re.sub(r'[^A-Za-z0-9+-]+', '_', name)[:60]}{suffix}"


def _file_rows(given: Any) -> Any:
    if not isinstance(given, list | tuple):
        return given
    return [{"file": each} if isinstance(each, str) else each for each in cast("list[Any]", given)]


class Records(TomlTable):
    """Records by the names of embedded suites, from a folder, or single files.

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
    files: Annotated[list[RecordFile] | None, BeforeValidator(_file_rows)] = Field(
        None, description='a list of paths of records, such as ["quake.AT2"], or tables [[records.files]]'
    )
    include: list[str] = Field(["*"], description='a list of patterns of record names to keep, such as "FF-1-*"')

    @model_validator(mode="after")
    def _some(self) -> "Records":
        if not self.suites and self.folder is None and not self.files:
            raise InputError(
                'no record is named. Give suites = ["fema-p695-far-field"], folder = "...", files = ["..."], or '
                "several of them."
            )
        if self.folder is None and self.on_error != "raise":
            raise InputError("on_error is for the files of a folder, but none is named. Leave it out.")
        if self.folder is None and self.vertical is not None:
            raise InputError(
                "vertical is for the files of a folder, but none is named: the embedded suites hold no vertical "
                "components. Leave it out."
            )
        return self

    def load(self, base: Path) -> Suite:
        """Load the records, first those of the suites, then those of the folder; relative paths start from `base`.

        Raises
        ------
        InputError
            If a suite is unknown, the folder or, unless `on_error` is "skip", a file in it cannot be read, two records
            have the same name, or a pattern of `include` matches no record.
        """
        motions = [motion for name in self.suites for motion in load_suite(name)]
        if self.folder is not None:
            motions += read_suite(base / self.folder, on_error=self.on_error, vertical=self.vertical)
        motions += [each.load(base) for each in self.files or []]
        names = [motion.name for motion in motions]
        for pattern in self.include:
            if not any(fnmatchcase(name, pattern) for name in names):
                raise InputError(
                    f"[records] include: no record's name fits {shown(pattern)}. There are {len(names)}, from "
                    f"{shown(names[0])} to {shown(names[-1])}; * stands for any text and ? for one letter."
                )
        return Suite(m for m in motions if any(fnmatchcase(m.name, pattern) for pattern in self.include))

    def moved(self, path: Moved) -> Self:
        """Return the same records with their paths from another folder."""
        folder = self.folder if self.folder is None else path(self.folder)
        files = self.files if self.files is None else [each.moved(path) for each in self.files]
        return self.model_copy(update={"folder": folder, "files": files})


class GivenRecords(Records, Given):
    """Motions in the place of a table."""

    given: InstanceOf[Suite]

    def load(self, base: Path) -> Suite:  # noqa: ARG002
        """Return the motions."""
        return self.given

    def moved(self, path: Moved) -> Self:  # noqa: ARG002
        """Return the same motions."""
        return self

    def document(self) -> dict[str, Any]:
        """Return their names; the samples are among the checksums of a study."""
        return {"motions": self.given.names}
