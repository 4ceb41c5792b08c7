"""The files within a project: project.toml, structures, records and tables of results."""

import hashlib
import io
import tomllib
from collections import Counter
from collections.abc import Callable, Mapping
from typing import Annotated, Any

import numpy as np
import tomli_w
from pydantic import Field

from rockflex.foundation.descriptions import PLAIN, Described
from rockflex.foundation.errors import InputError
from rockflex.foundation.files import unicode_text
from rockflex.foundation.shown import shortened, shown
from rockflex.models._impact import LAWS
from rockflex.motion._columns import record_csv
from rockflex.motion._ground_motion import GroundMotion
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
from rockflex.studies._arguments import rocking_properties_of
from rockflex.studies._case_keys import FreeVibration
from rockflex.studies._record_tables import RecordFile, Records, numbered_file_name, record_row
from rockflex.studies.case import OwnRunKeys

FORMAT = "rockflex-project-2"
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
_RECORD_KEYS = ("file", "name", "dt")  # that each record has, and no others but its info
_LIMITS: dict[str, type] = {"CheckLimits": CheckLimits}
_LAW_NAMES = {law.__name__: name for name, law in LAWS.items()}
_TABLE = Described("a table", form=PLAIN)
_NAME = Described("a name, in quotes", form=PLAIN)
_FILE = Described("the name of a file in the project", form=PLAIN)


class StructureRow(OwnRunKeys):
    """A structure of a case: its name, its file, its only model and its options."""

    name: Annotated[str, _NAME]
    file: Annotated[str, _FILE]


class ResultsRow(TomlTable):
    """Where results come from."""

    inputs: Annotated[str, Described("the SHA-256 of what they were computed from", form=PLAIN)]
    version: Annotated[str, Described("the version of rockflex", form=PLAIN)]


class ProjectDocument(TomlTable):
    """The content of project.toml: a case whose structures and records are files, with head, limits and results."""

    format: Annotated[str, Described(f'"{FORMAT}"', form=PLAIN)]
    head: Annotated[dict[str, str], _TABLE] = Field(default_factory=dict[str, str])
    rule: Annotated[str | None, Described("a rule of simulate_set, in quotes", form=PLAIN)] = None
    periods: Annotated[list[float] | None, Described("the smallest and the largest period in s", form=PLAIN)] = None
    free_vibration: FreeVibration = 0.0
    limits: Annotated[dict[str, Any], _TABLE] = Field(default_factory=dict[str, Any])
    structures: Annotated[list[StructureRow], Described("a list of tables [[structures]]", form=PLAIN)]
    records: Annotated[Records, Described("a list of tables [[records.files]]", form=PLAIN)]
    results: Annotated[ResultsRow | None, _TABLE] = None


def _input_members(project: Any) -> tuple[dict[str, Any], dict[str, bytes]]:
    """Return project.toml without head and results, and the files of structures and records."""
    files = dict[str, bytes]()
    structures: list[dict[str, Any]] = []
    for place, (name, structure) in enumerate(project.structures.items(), 1):
        file = f"structures/{numbered_file_name(place, name, '.toml')}"
        files[file] = _toml(object_table(f"structures[{name!r}]", structure))
        options = {option: getattr(project, option) for option in _OPTIONS}
        given = {option: each[name] for option, each in options.items() if name in each}
        row = StructureRow(name=name, file=file, models=[project.model[name]], **given)
        structures.append({"name": name, "file": file, **row.options_in_file()})
    records: list[dict[str, Any]] = []
    for place, motion in enumerate(project.motions, 1):
        file = f"records/{numbered_file_name(place, motion.name, '.csv')}"
        files[file] = record_csv(motion).encode()
        records.append(record_row(file, motion))
    document = {
        "format": FORMAT,
        **_known({"rule": project.rule, "periods": project.periods and list(project.periods)}),
        "free_vibration": project.free_vibration,
        "limits": _known(vars(project.limits)),
        "structures": structures,
        "records": {"files": records},
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
    records = document.records.files or []
    known = [{*_RECORD_KEYS} <= each.model_fields_set <= {*_RECORD_KEYS, "info"} for each in records]
    if not all(known) or document.records.model_fields_set != {"files"}:
        raise InputError(
            f"{DOCUMENT}: records must be tables [[records.files]] with {', '.join(_RECORD_KEYS)} and info."
        )
    if any(len(each.models or []) != 1 for each in document.structures):
        raise InputError(f"{DOCUMENT}: models of each structure must be one.")
    listed = [DOCUMENT, *(each.file for each in (*document.structures, *records)), *tables]
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
    rows = {row.name: row for row in document.structures}
    built = {name: structure_from_table(_toml_of(members, row.file), row.file) for name, row in rows.items()}
    found = {name: _options_of_row(row, built[name]) for name, row in rows.items()}
    return {
        "structures": built,
        "motions": [record_of_member(members, row) for row in document.records.files or []],
        "model": {name: row.models[0] for name, row in rows.items() if row.models},
        **{option: {name: each[option] for name, each in found.items() if each[option]} for option in _OPTIONS},
        "rule": document.rule,
        "periods": document.periods,
        "free_vibration": document.free_vibration,
        "limits": object_from_table({CLASS: "CheckLimits", **document.limits}, f"{DOCUMENT}, limits", _LIMITS),
        "head": document.head,
        "results": document.results and _results(members, document.results),
    }


def _options_of_row(row: StructureRow, structure: Any) -> dict[str, Any]:
    ground = None if row.ground is None else row.ground.under(rocking_properties_of(structure))
    return {"bouc_wen": row.hysteresis(), "impact": row.law(), "ground": ground, "initial": row.initial}


def structure_keys(members: Mapping[str, bytes], row: StructureRow) -> dict[str, Any]:
    """Return a structure and its options as the keys of forms and files have them; nothing is built or checked.

    Raises
    ------
    InputError
        As `entry_of_object_table`.
    """
    structure = {"name": row.name, **entry_of_object_table(_toml_of(members, row.file), row.file)}
    options = row.options_in_file()
    given = {name: options[name] for name in ("bouc_wen", "ground") if name in options}
    found: dict[str, Any] = {"structure": structure, **arguments_in_table(given)}
    springs = found.get("ground", {}).get("springs")
    if isinstance(springs, dict):
        springs.pop("area", None)  # which only checks of pressures know
    law = options.get("impact")
    if isinstance(law, str):
        found |= {name: options[name] for name in ("impact", "restitution") if name in options}
    elif law is not None:
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


def record_of_member(members: Mapping[str, bytes], row: RecordFile) -> GroundMotion:
    """Return the record of a row, scaled as it acts."""
    text = members[row.file]
    values = _read(row.file, "CSV with a line of labels", lambda: _columns(text.decode()))
    labels = ("time (s)", "acceleration (m/s2)", "vertical (m/s2)")
    if tuple(values) not in (labels[:2], labels):
        raise InputError(f"{row.file}: the columns must be {', '.join(labels)}, but {shown(list(values))} were given.")
    try:
        info = row.record_info(DOCUMENT)
        return GroundMotion(values[labels[1]], row.dt or 0.0, row.name or "", info, values.get(labels[2]))
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
