"""The folder of a study: written chunk by chunk, interrupted at any moment, and resumed."""
# pyright: reportUnknownParameterType=false
# (pyarrow comes without types)
# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false

import errno
import shutil
from collections import Counter
from collections.abc import Generator, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self, SupportsIndex, cast

from rockflex.foundation.checks import checked_whole_number
from rockflex.foundation.errors import InputError
from rockflex.foundation.files import checked_file_path, remove_temporary_files, write_file_atomically
from rockflex.foundation.html import html_table
from rockflex.foundation.shown import few_texts_shown, number_with_noun, shortened, shown
from rockflex.studies.folders._lock import LOCK, FolderLock, check_folder_locked, lock_holder, locked_folder
from rockflex.studies.folders._manifest import MANIFEST, SPEC, StudyManifest, listed_differences
from rockflex.studies.folders._parts import (
    PARTS,
    DamagedPart,
    PartError,
    PartMaker,
    StudyPart,
    part_at,
    part_of_content,
)

if TYPE_CHECKING:
    import pandas as pd
    import pyarrow as pa


FULL = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG}


def refuse_other_part_columns(path: Path, old: "pa.Schema", new: "pa.Schema", number: int | None = None) -> None:
    """Raise an error if the columns `new`, of the chunk `number` or of the file at `path`, differ from `old`."""
    if old.equals(new):
        return
    before, now = ({field.name: str(field.type) for field in schema} for schema in (old, new))
    names = [*before, *(name for name in now if name not in before)]
    lines = [f"{name}: {before.get(name)}, {now.get(name)}" for name in names if before.get(name) != now.get(name)]
    what = f"Chunk {number} has" if number is not None else f"{path} and the first part have"
    against = f" other columns than {path}" if number is not None else " other columns"
    raise InputError(
        f"{what}{against}:{listed_differences(lines or ['the order of the columns'])}\nAll chunks must have the same "
        "columns."
    )


def refuse_foreign_files(folder: Path, own: set[str]) -> None:
    """Raise an error for a file, or a folder with anything but hidden files and the remains of a killed study."""
    if folder.exists() and not folder.is_dir():
        raise InputError(f"{folder} is a file. Give a folder for the study.")
    names = sorted(path.name for path in folder.iterdir()) if folder.exists() else []
    others = [name for name in names if name not in own and not name.startswith(".")]
    if others:
        raise InputError(
            f"{folder} is not a study, and not empty ({shown(others[0])} is in it). Give an empty or a new folder, or "
            "that of a study."
        )


@contextmanager
def explaining_write_errors(folder: Path, size: int = 0) -> Generator[None]:
    """Convert system errors while writing `size` bytes into messages with a remedy."""
    try:
        yield
    except OSError as error:
        if error.errno in FULL:
            free = f"{shutil.disk_usage(folder).free / 1e6:.1f} MB are free" if folder.exists() else "it is full"
            message = (
                f"No room on the disk of {folder}: {size / 1e6:.3f} MB were to be written, {free} ({error.strerror}). "
                "The parts already written are kept. Make room and run the study again."
            )
        else:
            message = (
                f"{folder} cannot be used: {error.strerror or error}. Give a folder that you may write into. "
                "The parts already written are kept."
            )
        raise InputError(message) from error


def arrow_table_to_dataframe(table: "pa.Table") -> "pd.DataFrame":
    """Return a table with a plain index.

    Columns from pandas keep their types; in other tables, integers and booleans become nullable types of pandas.
    """
    import pandas as pd
    import pyarrow as pa

    if b"pandas" in (table.schema.metadata or {}):
        return table.to_pandas().reset_index(drop=True)
    widths = {pa.int8(): "Int8", pa.int16(): "Int16", pa.int32(): "Int32", pa.int64(): "Int64"}
    kinds: dict[Any, Any] = {kind: pd.api.types.pandas_dtype(name) for kind, name in widths.items()}
    return table.to_pandas(types_mapper=(kinds | {pa.bool_(): pd.BooleanDtype()}).get)


MAX_LINE_WIDTH = 100  # most characters of a line
MAX_PARTS_READ = 500  # parts whose rows are counted, some tenths of a second
MAX_KEYS = 10  # of the specification


def study_folder_facts(folder: Path, manifest: StudyManifest) -> dict[str, str]:
    """Return what there is to say about a study, by its heading."""
    parts = list(_parts_in_folder(folder, manifest.n_chunks))
    title = ", ".join(str(manifest.spec[key]) for key in ("study", "name") if manifest.spec.get(key))
    found = {"study": title or "without a name", "state": _study_state_text(folder, len(parts), manifest.n_chunks)}
    found["started"] = _instant_text(datetime.fromisoformat(manifest.created))
    if parts:
        seconds = max(when for _, _, when in parts)
        found["last part"] = _instant_text(datetime.fromtimestamp(seconds, UTC))
        found["size"] = f"{sum(size for _, size, _ in parts) / 1e6:.3g} MB in {PARTS}/*.parquet"
        found |= _row_counts_of_parts([path for path, _, _ in parts])
    if manifest.checksums:
        found["inputs"] = f"{len(manifest.checksums)} with checksums: {few_texts_shown(list(manifest.checksums))}"
    if manifest.versions:
        found["versions"] = ", ".join(f"{name} {version}" for name, version in manifest.versions.items())
    return found | dict(list(_study_folder_items(manifest.spec))[:MAX_KEYS])


def _parts_in_folder(folder: Path, count: int) -> Iterator[tuple[Path, int, float]]:
    """Yield the parts that are there, with their sizes in bytes and their times in s."""
    for path in sorted((folder / PARTS).glob("part-*.parquet"))[:count]:
        try:
            state = path.stat()
        except OSError:  # gone since it was listed
            continue
        yield path, state.st_size, state.st_mtime


def _study_state_text(folder: Path, done: int, total: int) -> str:
    holder = lock_holder(folder / LOCK)
    if done == total:
        return f"complete: all {number_with_noun(total, 'part')}"
    if holder is not None:
        return f"running: {done} of {total} parts, by {holder}"
    return f"stopped: {done} of {total} parts" if done else f"planned: none of {total} parts"


def _instant_text(when: datetime) -> str:
    return f"{when:%Y-%m-%d %H:%M} UTC"


def _row_counts_of_parts(paths: Sequence[Path]) -> dict[str, str]:
    """Count the rows of some parts, and what their columns of results say."""
    from pyarrow import ArrowException, parquet

    rows, unreadable = 0, 0
    statuses = dict[str, Counter[str]]()
    for path in paths[:MAX_PARTS_READ]:
        try:
            with parquet.ParquetFile(path) as file:
                known = Counter(file.schema_arrow.names)
                names = [each for each in known if (each.startswith("status") or each == "error") and known[each] == 1]
                table = file.read(columns=names)
                rows += cast("int", file.metadata.num_rows)
        except (ArrowException, OSError):
            unreadable += 1
            continue
        for name in names:
            values = table.column(name).drop_null().to_pylist()
            seen = ["failed"] * len(values) if name == "error" else map(str, values)
            statuses.setdefault(name, Counter()).update(seen)
    some = f" in the first {MAX_PARTS_READ} parts" if len(paths) > MAX_PARTS_READ else ""
    lost = f"; {number_with_noun(unreadable, 'part')} cannot be read, see damaged()" if unreadable else ""
    found = {"rows": f"{rows}{some}{lost}"}
    for name, counter in statuses.items():
        if counter:
            counts = (f"{count} {str(value).replace('_', ' ')}" for value, count in counter.most_common())
            found["errors" if name == "error" else name] = ", ".join(counts)
    return found


def _study_folder_items(spec: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Yield the keys of a specification that say something, shortened."""
    for key, value in spec.items():
        if value is None or value == [] or key in ("study", "name"):
            continue
        if isinstance(value, Mapping):
            yield key, "; ".join(f"{name}: {_study_folder_item_text(each)}" for name, each in value.items())
        else:
            yield key, _study_folder_item_text(value)


def _study_folder_item_text(value: Any) -> str:
    """Write a value; of several the first and the last few, by name where they have one, and how many they are."""
    if not isinstance(value, list):
        return str(value)
    names = [str(each.get("name", "a table") if isinstance(each, Mapping) else each) for each in value]
    return f"{len(names)}: {few_texts_shown(names)}" if len(names) > 2 else few_texts_shown(names)


@dataclass(frozen=True, repr=False)
class StudyFolder:
    """A study on disk, one Parquet file per chunk.

    Created by `open` for writing, or by `load` for reading. Every file is complete or absent at any moment, so other
    programs that read ``parts/*.parquet`` see finished chunks only.

    Use it as a context manager, or call `close`, to let another process write. Printed, it tells its state on a screen.

    Examples
    --------
    >>> import tempfile
    >>> import pyarrow as pa
    >>> import rockflex as rf
    >>> path = tempfile.mkdtemp()
    >>> with rf.StudyFolder.open(path, {"seed": 1}, n_chunks=2,
    ...     versions={"rockflex": "1"}) as folder:
    ...     part = folder.write(0, pa.table({"run": [0, 1]}))
    >>> folder = rf.StudyFolder.load(path)
    >>> folder.finished, folder.missing()
    (False, [1])
    >>> folder.frame(partial=True)["run"].tolist()
    [0, 1]
    """

    path: Path
    manifest: StudyManifest
    lock: FolderLock | None = None
    _known: "dict[int, pa.Schema]" = field(default_factory=dict, init=False, repr=False, compare=False)

    def __repr__(self) -> str:
        found = study_folder_facts(self.path, self.manifest)
        width = max(map(len, found))
        lines = [f"  {name:{width}}  {shortened(text, MAX_LINE_WIDTH - width - 4)}" for name, text in found.items()]
        return "\n".join([f"StudyFolder({str(self.path)!r})", *lines])

    def _repr_html_(self) -> str:
        return html_table("StudyFolder", {"folder": str(self.path), **study_folder_facts(self.path, self.manifest)})

    @classmethod
    def open(
        cls,
        path: str | Path,
        spec: Mapping[str, Any],
        n_chunks: SupportsIndex,
        versions: Mapping[str, str],
        checksums: Mapping[str, str] | None = None,
        *,
        any_version: bool = False,
    ) -> Self:
        """Create the folder of a study, or open an existing one, for writing.

        Parameters
        ----------
        path
            The folder: absent, empty, or a study with the same specification.
        spec
            The study's specification: everything that its results depend on, as plain JSON values.
        n_chunks
            Number of chunks, at least 1.
        versions
            Version of each library that the numbers depend on, by name.
        checksums
            Checksum of each record, matrix from a file and other file that the study depends on, by name.
        any_version
            Resume with versions other than those the study was started with. Every part records its own.

        Raises
        ------
        InputError
            If the folder holds another study, other records or another program's files, was started with other
            versions, is in use by another process, or cannot be written.
        """
        folder = checked_file_path("path", path)
        given = StudyManifest.of(spec, n_chunks, versions, checksums or {})
        with explaining_write_errors(folder):
            if not (folder / MANIFEST).exists():
                refuse_foreign_files(folder, {PARTS, LOCK, SPEC})
            (folder / PARTS).mkdir(parents=True, exist_ok=True)
            lock = locked_folder(folder / LOCK)
            try:
                remove_temporary_files(folder, "*.json")
                remove_temporary_files(folder / PARTS, "part-*.parquet")
                if not (folder / MANIFEST).exists():
                    given.write(folder)
                stored = StudyManifest.read(folder)
                stored.accept(given, folder, any_version=any_version)
                study = cls(folder, replace(stored, versions=given.versions), lock)
                study._refuse_strays()
            except BaseException:
                lock.release()
                raise
        return study

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Open the folder of a study for reading, even while another process writes to it.

        Raises
        ------
        InputError
            If there is no study at `path`, or it is damaged.
        """
        folder = checked_file_path("path", path)
        with explaining_write_errors(folder):
            if not (folder / MANIFEST).is_file():
                raise InputError(
                    f"There is no study at {folder}: it has no {MANIFEST}. Give the folder that a study was run in."
                )
            study = cls(folder, StudyManifest.read(folder))
            study._refuse_strays()
        return study

    @property
    def spec(self) -> dict[str, Any]:
        """The study's specification."""
        return self.manifest.spec

    @property
    def n_chunks(self) -> int:
        """Number of parts of the complete study."""
        return self.manifest.n_chunks

    @property
    def finished(self) -> bool:
        """Whether every part is present and intact."""
        return not self.missing()

    def damaged(self) -> list[DamagedPart]:
        """Return the parts that are present but unusable; running the study again replaces them."""
        found: list[DamagedPart] = []
        for number in range(self.n_chunks):
            path = self._part(number)
            try:
                if path.exists():
                    part_at(path, self.manifest.study, number)
            except (PartError, OSError) as error:
                found.append(DamagedPart(number, path, str(error)))
        return found

    def missing(self) -> list[int]:
        """Return the numbers of the chunks that are absent or damaged, in order."""
        damaged = {part.number for part in self.damaged()}
        return [number for number in range(self.n_chunks) if number in damaged or not self._part(number).exists()]

    def write(self, number: SupportsIndex, table: "pa.Table") -> Path:
        """Write the table of one chunk; once this returns, the file survives a loss of power.

        Parameters
        ----------
        number
            Number of the chunk, from 0.
        table
            Its runs; names and types of the columns as in all other chunks.

        Raises
        ------
        InputError
            If the number or the columns do not fit, the folder was opened for reading, or the disk is full. The parts
            already written remain, and nothing of this one.
        """
        import pyarrow as pa

        place = checked_whole_number("number", number, 0, self.n_chunks - 1)
        if not isinstance(table, pa.Table):
            raise InputError(f"A chunk must be a pyarrow.Table, but {type(table).__name__} was given.")
        return self.add(self.maker.make(place, table))

    @property
    def maker(self) -> PartMaker:
        """The maker of the parts of this study from tables, in any process, for `add`."""
        return PartMaker(self.manifest.study, self.manifest.versions)

    def add(self, part: StudyPart) -> Path:
        """Write a part that `maker` has made, perhaps in another process; otherwise as `write`.

        Raises
        ------
        InputError
            If it is no part of this study or was damaged on its way; see also `write`.
        """
        place = checked_whole_number("number", part.number, 0, self.n_chunks - 1)
        if self.lock is None:
            raise InputError(
                f"{self.path} was opened for reading. To write, open it by StudyFolder.open with its specification."
            )
        check_folder_locked(self.lock)
        try:
            schema = part_of_content(part.content, self.manifest.study, place).schema_arrow
        except PartError as error:
            raise InputError(
                f"Chunk {place} cannot be stored in {self.path}: {error}. Make it by the maker of this folder."
            ) from error
        self._refuse_other_columns(place, schema)
        with explaining_write_errors(self.path, len(part.content)):
            path = write_file_atomically(self._part(place), part.content)
        if not self._known:
            self._known[place] = schema
        return path

    def part(self, number: SupportsIndex) -> "pa.Table | None":
        """Return the table of one chunk; None if it is absent or damaged."""
        place = checked_whole_number("number", number, 0, self.n_chunks - 1)
        path = self._part(place)
        try:
            return part_at(path, self.manifest.study, place).read() if path.exists() else None
        except (PartError, OSError):
            return None

    def table(self, *, partial: bool = False) -> "pa.Table":
        """Return all parts as one table, in the order of the chunks.

        Parameters
        ----------
        partial
            Return the parts that are present, at least one, instead of raising an error if some are missing.

        Raises
        ------
        InputError
            If a part is missing, damaged, or has other columns than the first.
        """
        import pyarrow as pa

        self._refuse_strays()
        tables: dict[int, pa.Table] = {}
        for number in range(self.n_chunks):
            path = self._part(number)
            try:
                if path.exists():
                    tables[number] = part_at(path, self.manifest.study, number).read()
            except (PartError, OSError) as error:
                raise InputError(
                    f"{path} is damaged: {error}. Run the study again in this folder, which computes this part anew "
                    "and keeps the others; or delete the file and load with partial=True."
                ) from error
        absent = self.n_chunks - len(tables)
        if not tables or (absent and not partial):
            hint = "" if not tables else ", or take what is there by partial=True"
            raise InputError(
                f"{absent} of {self.n_chunks} parts of {self.path} are missing. Run the study to its end{hint}."
            )
        first = next(iter(tables.values())).schema
        for number, table in tables.items():
            refuse_other_part_columns(self._part(number), first, table.schema)
        metadata = {key: value for key, value in (first.metadata or {}).items() if not key.startswith(b"rockflex.")}
        parts = [table.replace_schema_metadata(metadata) for table in tables.values()]
        return pa.concat_tables(parts).unify_dictionaries()

    def frame(self, *, partial: bool = False) -> "pd.DataFrame":
        """Return `table` as a pandas DataFrame with a plain index.

        Columns from pandas keep their types; in other tables, integers and booleans become nullable types of pandas.
        Raises the same errors as `table`.
        """
        return arrow_table_to_dataframe(self.table(partial=partial))

    def close(self) -> None:
        """Let another process write into the folder."""
        if self.lock is not None:
            self.lock.release()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _part(self, number: int) -> Path:
        return self.path / PARTS / f"part-{number:05d}.parquet"

    def _refuse_strays(self) -> None:
        expected = {self._part(number).name for number in range(self.n_chunks)}
        strays = sorted(path.name for path in (self.path / PARTS).glob("*.parquet") if path.name not in expected)
        if strays:
            raise InputError(
                f"{self.path / PARTS} holds files that are not parts of the study:{listed_differences(strays)}\nMove "
                "them away."
            )

    def _refuse_other_columns(self, number: int, schema: "pa.Schema") -> None:
        """Compare with an intact part other than the one to be written; it is looked for once."""
        if number in self._known:
            self._known.clear()
        for other in () if self._known else range(self.n_chunks):
            path = self._part(other)
            try:
                if other != number and path.exists():
                    self._known[other] = part_at(path, self.manifest.study, other).schema_arrow
                    break
            except (PartError, OSError):
                continue
        for other, known in self._known.items():
            refuse_other_part_columns(self._part(other), known, schema, number)
