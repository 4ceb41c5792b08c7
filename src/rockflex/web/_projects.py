"""Projects on the page: its structures, record and alternatives in one file, and the forms of such a file."""

import json
from collections.abc import Mapping, Sequence
from typing import Any

from rockflex.foundation.archives import ArchiveLimits, archive_bytes
from rockflex.foundation.errors import InputError
from rockflex.foundation.json import as_json_value
from rockflex.motion._ground_motion import GroundMotion
from rockflex.report.project._archive import unpacked_members
from rockflex.report.project._project_file import (
    PAGE,
    ProjectDocument,
    project_document,
    project_members,
    record_of_member,
    structure_keys,
)
from rockflex.studies._record_tables import RecordFile
from rockflex.web._alternatives import project_of_state
from rockflex.web._folders import RecordFolder, SentRecordFile, flat_file_names, read_record_folder
from rockflex.web._limits import (
    MAX_FILE_BYTES,
    MAX_FOLDER_BYTES,
    MAX_FOLDER_FILES,
    MAX_TOML_BYTES,
    check_record_length,
)
from rockflex.web._refusal import Refusal, errors_as_refusals
from rockflex.web._state import MAX_FREE_VIBRATION, PageState, parse_page_json, parse_page_state
from rockflex.web._uploads import UploadedRecords

FIELD = "project"  # of the messages
SETTLES = f"free vibration until the structure is at rest (here {MAX_FREE_VIBRATION:g} s)"
LIMITS = ArchiveLimits(MAX_FOLDER_FILES, MAX_FILE_BYTES, MAX_FOLDER_BYTES)


def project_file(state: PageState, uploads: UploadedRecords) -> tuple[str, bytes]:
    """Return the name and the content of the project of a state, with the state itself for the page."""
    with errors_as_refusals(FIELD):
        members = project_members(project_of_state(state, uploads), _json(state).encode())
        return "project.rockflex", archive_bytes(members)


def _json(state: PageState) -> str:
    return json.dumps(as_json_value(state.model_dump(exclude_none=True)))


Records = tuple[Mapping[str, GroundMotion], Mapping[str, RecordFolder]]


def read_project(content: bytes) -> tuple[dict[str, Any], Records]:
    """Return the answer about a project's file, and the records in it, which `UploadedRecords.take` stores."""
    uploads = UploadedRecords()
    return state_of_project(content, uploads), uploads.items()


def state_of_project(content: bytes, uploads: UploadedRecords) -> dict[str, Any]:
    """Return the state of the page in a project's file, and what of it the page has no place for.

    Results are not read, and no structure is built before its numbers are checked as those of a form.
    """
    try:
        members = unpacked_members(content, "given", "project", LIMITS, MAX_TOML_BYTES)
        document = project_document(members)
        if PAGE in members:
            state = parse_page_state(parse_page_json(members[PAGE]))
            found, own = state.model_dump(exclude_none=True), state.record.source in ("upload", "folder")
        else:
            found, own = _state_of_document(members, document), True
        if own:
            found |= {"record": _record(members, document.records.files or [], uploads), "scale": 1.0}
        state = parse_page_state(found)
    except RecursionError as error:
        raise Refusal({FIELD: "it is nested too deep to be read."}) from error
    except (InputError, Refusal) as error:
        raise Refusal({FIELD: str(error)}) from error
    settles = PAGE not in members and document.free_vibration == "settle"
    left = [*["results"] * bool(document.results), *[SETTLES] * settles]
    return {"state": json.loads(_json(state)), "left": left}


def _state_of_document(members: Mapping[str, bytes], document: ProjectDocument) -> dict[str, Any]:
    """Return the state in a project that the page did not save: all of its structures are kept, the first is shown."""
    kept = [{"name": row.name, "models": row.models, **structure_keys(members, row)} for row in document.structures]
    free = MAX_FREE_VIBRATION if document.free_vibration == "settle" else document.free_vibration
    head = {name: text for name, text in document.head.items() if name != "date"}
    first = {name: value for name, value in kept[0].items() if name != "name"}
    own = {"limits": document.limits, "record_set": {"rule": document.rule or ""}}
    return {**first, **own, "alternatives": kept, "free_vibration": free, "head": head}


def _record(members: Mapping[str, bytes], rows: Sequence[RecordFile], uploads: UploadedRecords) -> dict[str, Any]:
    """Return the choice of the records of a project: one as an uploaded file, several as a folder."""
    if len(rows) == 1:
        motion = record_of_member(members, rows[0])
        check_record_length(motion, FIELD)
        return {"source": "upload", "upload": uploads.add(motion, members[rows[0].file], f"{motion.dt} {motion.name}")}
    names = flat_file_names([f"{(row.name or '').replace('/', '_')}.csv" for row in rows])
    contents = [members[row.file] for row in rows]
    files = [SentRecordFile(name, each, len(each)) for name, each in zip(names, contents, strict=True)]
    folder = read_record_folder(files, None, None)
    token = uploads.folders.add(folder, files, "project")
    return {"source": "folder", "folder": token, "given": folder.along[0].name, "vertical": True}
