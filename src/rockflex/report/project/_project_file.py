"""The files within a project: project.toml, structures, records and tables of results."""

import hashlib
import io
import re
import tomllib
from collections import Counter
from collections.abc import Callable, Mapping
from typing import Annotated, Any

import numpy as np
import tomli_w
from pydantic import Field, TypeAdapter, ValidationError

from rockflex.foundation.descriptions import PLAIN, Described
from rockflex.foundation.errors import InputError
from rockflex.foundation.files import unicode_text
from rockflex.foundation.shown import shortened, shown
from rockflex.models._bouc_wen import BoucWen
from rockflex.models._impact import LAW_CLASSES, LAWS
from rockflex.motion._columns import record_csv
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._record_info import RecordInfo
from rockflex.response._limit_checks import CheckLimits
from rockflex.structure.file._object_entries import entry_of_object_table
from rockflex.structure.file._object_tables import (
    CLASS,
    arguments_in_table,
    object_from_table,
    object_table,
    structure_from_table,
)
from rockflex.structure.file._toml_table import TomlTable, parse_toml_table
from rockflex.studies._arguments import InitialState

FORMAT = "rockflex-project-1"
DOCUMENT = "project.toml"
PAGE = "page.json"  # the state of the page in the browser, in projects that it saved; only the page reads it
MAX_ROWS = 100_000  # of a table of results
MAX_TABLE_BYTES = 500_000_000  # of it, unpacked
TABLES: dict[str, dict[str, type]] = {
    "runs": {"structure": str, "motion": str, "status": str},
    "statistics": {"structure": str, "demand": str, "design": float, "reason": str},
    "checks": {"structure": str, "name": str, "limit": float, "ratio": float, "ok": bool},
}
"""The tables of results, and columns that each has at least."""

_OPTIONS = ("bouc_wen", "impact", "ground", "initial")  # objects of each structure
_CLASSES: dict[str, type] = {
    **{each.__name__: each for each in (BoucWen, CheckLimits, InitialState)},
    **LAW_CLASSES,
}
_LAW_NAMES = {law.__name__: name for name, law in LAWS.items()}
_TABLE = Described("a table", form=PLAIN)
_NAME = Described("a name, in quotes", form=PLAIN)
_FILE = Described("the name of a file in the project", form=PLAIN)


class StructureRow(TomlTable):
    """A structure: its name, its file, and its options."""

    name: Annotated[str, _NAME]
    file: Annotated[str, _FILE]
    model: Annotated[str, Described("the label of a model", form=PLAIN)]
    bouc_wen: Annotated[dict[str, Any] | None, _TABLE] = None
    impact: Annotated[dict[str, Any] | None, _TABLE] = None
    ground: Annotated[dict[str, Any] | None, _TABLE] = None
    initial: Annotated[dict[str, Any] | None, _TABLE] = None


class RecordRow(TomlTable):
    """A record: its name, its file, its step, and what is known about it."""

    name: Annotated[str, _NAME]
    file: Annotated[str, _FILE]
    dt: Annotated[float, Described("the step of the samples", "s")]
    info: Annotated[dict[str, Any] | None, _TABLE] = None


class ResultsRow(TomlTable):
    """Where results come from."""

    inputs: Annotated[str, Described("the SHA-256 of what they were computed from", form=PLAIN)]
    version: Annotated[str, Described("the version of rockflex", form=PLAIN)]


class ProjectDocument(TomlTable):
    """The content of project.toml."""

    format: Annotated[str, Described(f'"{FORMAT}"', form=PLAIN)]
    head: Annotated[dict[str, str], _TABLE] = Field(default_factory=dict[str, str])
    rule: Annotated[str | None, Described("a rule of simulate_set, in quotes", form=PLAIN)] = None
    periods: Annotated[list[float] | None, Described("the smallest and the largest period in s", form=PLAIN)] = None
    free_vibration: Annotated[float | str, Described('a number of seconds or "settle"', form=PLAIN)] = 0.0
    limits: Annotated[dict[str, Any], _TABLE] = Field(default_factory=dict[str, Any])
    structures: Annotated[list[StructureRow], Described("a list of tables [[structures]]", form=PLAIN)]
    records: Annotated[list[RecordRow], Described("a list of tables [[records]]", form=PLAIN)]
    results: Annotated[ResultsRow | None, _TABLE] = None


def _member_name(folder: str, place: int, name: str, suffix: str) -> str:
    return f"{folder}/{place:03d}_{re.sub(r'[^A-Za-z0-9+-]+', '_', name)[:60]}{suffix}"


def _input_members(project: Any) -> tuple[dict[str, Any], dict[str, bytes]]:
    """Return project.toml without head and results, and the files of structures and records."""
    files = dict[str, bytes]()
    structures: list[dict[str, Any]] = []
    for place, (name, structure) in enumerate(project.structures.items(), 1):
        file = _member_name("structures", place, name, ".toml")
        files[file] = _toml(object_table(f"structures[{name!r}]", structure))
        row: dict[str, Any] = {"name": name, "file": file, "model": project.model[name]}
        given = {option: getattr(project, option) for option in _OPTIONS}
        row |= {
            option: object_table(f"{option}[{name!r}]", each[name], _CLASSES)
            for option, each in given.items()
            if name in each
        }
        structures.append(row)
    records: list[dict[str, Any]] = []
    for place, motion in enumerate(project.motions, 1):
        file = _member_name("records", place, motion.name, ".csv")
        files[file] = record_csv(motion).encode()
        known = None if motion.metadata is None else _known(vars(motion.metadata) | {"findings": None})
        info = {} if known is None else {"info": known}
        records.append({"name": motion.name, "file": file, "dt": motion.dt, **info})
    document = {
        "format": FORMAT,
        **_known({"rule": project.rule, "periods": project.periods and list(project.periods)}),
        "free_vibration": project.free_vibration,
        "limits": _known(vars(project.limits)),
        "structures": structures,
        "records": records,
    }
    return document, files


def _known(values: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in values.items() if value is not None}


def _toml(table: Mapping[str, Any]) -> bytes:
    return tomli_w.dumps(table).encode()


def input_checksum(project: Any) -> str:
    """Return the SHA-256 of everything that results depend on."""
    document, files = _input_members(project)
    return hashlib.sha256(b"\n".join([_toml(document), *files.values()])).hexdigest()


def project_members(project: Any, page: bytes | None = None) -> dict[str, bytes]:
    """Return the files of a project by name, with the state of the page if that saves it.

    Raises
    ------
    InputError
        If an object cannot be written to a file.
    """
    document, files = _input_members(project)
    document["head"] = dict(project.head)
    if (results := project.results) is not None:
        document["results"] = {"inputs": results.inputs, "version": results.version}
        for name in TABLES:
            content = io.BytesIO()
            getattr(results, name).to_parquet(content, engine="pyarrow", index=False)
            files[_result_file(name)] = content.getvalue()
    return {DOCUMENT: _toml(document), **files, **({} if page is None else {PAGE: page})}


def _result_file(name: str) -> str:
    return f"results/{name}.parquet"


def project_document(members: Mapping[str, bytes]) -> ProjectDocument:
    """Return project.toml, all of whose files are there, and no others; structures and records are not yet read.

    Raises
    ------
    InputError
        If it is missing or wrong, or its format is another one.
    """
    content = _toml_of(members, DOCUMENT)
    if content.get("format") != FORMAT:
        raise InputError(
            f"{DOCUMENT}: format must be {FORMAT!r}, but {shown(content.get('format'))} was given. Read it with the "
            "version of rockflex that wrote it, or a later one."
        )
    document = parse_toml_table(ProjectDocument, content, DOCUMENT)
    tables = [] if document.results is None else [_result_file(name) for name in TABLES]
    listed = [DOCUMENT, *(each.file for each in (*document.structures, *document.records)), *tables]
    problems = [
        *(f"{shown(name)} is listed, but not in the archive" for name in listed if name not in members),
        *(f"{shown(name)} is listed twice" for name, n in Counter(listed).items() if n > 1),
        *(f"{shown(name)} is in the archive, but not listed" for name in members if name not in (*listed, PAGE)),
    ]
    if problems:
        raise InputError(f"{DOCUMENT}: {problems[0]}. Give a file that Project.save wrote.")
    names = [each.name for each in document.structures]
    if len(set(names)) < len(names):
        raise InputError(f"{DOCUMENT}: two structures have the same name. Name each differently.")
    return document


def project_arguments(members: Mapping[str, bytes]) -> dict[str, Any]:
    """Return the arguments of `Project` in its files; `results` as those of `ProjectResults`, or None.

    Raises
    ------
    InputError
        If a file is missing, wrong or not one of a project, or its format is another one.
    """
    document = project_document(members)

    def option(row: StructureRow, name: str) -> Any:
        return object_from_table(getattr(row, name), f"{DOCUMENT}, {name} of {shown(row.name)}", _CLASSES)

    options: dict[str, dict[str, Any]] = {
        name: {row.name: option(row, name) for row in document.structures if getattr(row, name) is not None}
        for name in _OPTIONS
    }
    return {
        "structures": {
            row.name: structure_from_table(_toml_of(members, row.file), row.file) for row in document.structures
        },
        "motions": [record_of_member(members, row) for row in document.records],
        "model": {row.name: row.model for row in document.structures},
        **options,
        "rule": document.rule,
        "periods": document.periods,
        "free_vibration": document.free_vibration,
        "limits": object_from_table({"class": "CheckLimits", **document.limits}, f"{DOCUMENT}, limits", _CLASSES),
        "head": document.head,
        "results": document.results and _results(members, document.results),
    }


def structure_keys(members: Mapping[str, bytes], row: StructureRow) -> dict[str, Any]:
    """Return a structure and its options as the keys of forms and files have them; nothing is built or checked.

    Raises
    ------
    InputError
        As `entry_of_object_table`.
    """
    structure = {"name": row.name, **entry_of_object_table(_toml_of(members, row.file), row.file)}
    options = {name: getattr(row, name) for name in ("bouc_wen", "ground") if getattr(row, name) is not None}
    found: dict[str, Any] = {"structure": structure, **arguments_in_table(options)}
    springs = found.get("ground", {}).get("springs")
    if isinstance(springs, dict):
        springs.pop("area", None)  # which only checks of pressures know
    if (law := row.impact) is not None:
        name = _LAW_NAMES.get(str(law.get(CLASS)))
        found["impact"] = name or law
        given = law.get(LAWS[name].restitution_name()) if name else None
        found |= {} if given is None else {"restitution": given}
    return found


def _toml_of(members: Mapping[str, bytes], name: str) -> dict[str, Any]:
    """Return the content of a file of TOML."""
    content = members.get(name)
    if content is None:
        raise InputError(f"{name} is not in the archive. Give a file that Project.save wrote.")
    return _read(name, "TOML", lambda: tomllib.loads(unicode_text(content)))


def record_of_member(members: Mapping[str, bytes], row: RecordRow) -> GroundMotion:
    """Return the record of a row, scaled as it acts."""
    text = members[row.file]
    values = _read(row.file, "CSV with a line of labels", lambda: _columns(text.decode()))
    labels = ("time (s)", "acceleration (m/s2)", "vertical (m/s2)")
    if tuple(values) not in (labels[:2], labels):
        raise InputError(f"{row.file}: the columns must be {', '.join(labels)}, but {shown(list(values))} were given.")
    try:
        info = None if row.info is None else TypeAdapter(RecordInfo).validate_python(row.info)
    except ValidationError as error:
        raise InputError(f"{DOCUMENT}, info of {shown(row.name)}: {shortened(str(error))}.") from error
    try:
        return GroundMotion(values[labels[1]], row.dt, row.name, info, values.get(labels[2]))
    except InputError as error:
        raise InputError(str(error), place=row.file) from error


def _columns(text: str) -> dict[str, Any]:
    head, *lines = [line for line in text.splitlines() if not line.startswith("#")]
    rows = np.loadtxt(lines, delimiter=",", ndmin=2, comments=None)
    return dict(zip(head.split(","), rows.T, strict=True))


def _results(members: Mapping[str, bytes], row: ResultsRow) -> dict[str, Any]:
    tables = {name: _result_table(members, _result_file(name), needed) for name, needed in TABLES.items()}
    return {"inputs": row.inputs, "version": row.version, **tables}


def _result_table(members: Mapping[str, bytes], file: str, needed: Mapping[str, type]) -> Any:
    from pyarrow import types
    from pyarrow.parquet import ParquetFile

    def is_text(kind: Any) -> bool:
        return types.is_string(kind) or types.is_large_string(kind)

    is_kind = {str: is_text, float: types.is_floating, bool: types.is_boolean}
    content = members[file]
    opened = _read(file, "Parquet", lambda: ParquetFile(io.BytesIO(content)))
    found = {each.name: each.type for each in opened.schema_arrow}
    lacking = [name for name, kind in needed.items() if name not in found or not is_kind[kind](found[name])]
    size = sum(opened.metadata.row_group(k).total_byte_size for k in range(opened.num_row_groups))
    if lacking or opened.metadata.num_rows > MAX_ROWS or size > MAX_TABLE_BYTES:
        kinds = ", ".join(f"{name} ({kind.__name__})" for name, kind in needed.items())
        raise InputError(
            f"{file} must have the columns {kinds}, ... and at most {MAX_ROWS} rows and {MAX_TABLE_BYTES / 1e6:g} MB."
        )
    return _read(file, "Parquet", lambda: opened.read().to_pandas())


def _read(file: str, kind: str, read: Callable[[], Any]) -> Any:
    """Return what is read from a file; the libraries raise almost any exception for damaged ones."""
    try:
        return read()
    except RecursionError:
        raise
    except Exception as error:
        raise InputError(
            f"{file} is not {kind}: {type(error).__name__}: {shortened(str(error))}. Give a file that Project.save "
            "wrote."
        ) from error
