"""Cases, studies and projects from their files: one function reads what can be run."""

from pathlib import Path
from typing import Any, cast

from rockflex.foundation.errors import InputError
from rockflex.foundation.files import checked_file_path
from rockflex.foundation.json import with_infinite_numbers
from rockflex.report.project._project import SUFFIX, Project, read_project
from rockflex.structure.file._object_tables import CLASS
from rockflex.structure.file._structure_entry import KINDS
from rockflex.structure.file._structure_file import read_toml_file
from rockflex.studies._run_study import study_in_file
from rockflex.studies._study_kind import study_kind_named
from rockflex.studies.case import Case, case_in_file
from rockflex.studies.folders._folder import StudyFolder
from rockflex.studies.spec import StudySpec


def read_case(path: str | Path) -> Case | StudySpec | Project:
    """Return the case of a file: structures, records, models and options, which its method `run` runs.

    Parameters
    ----------
    path
        A TOML file with tables ``[[structures]]`` and ``[records]``, lists of ``models`` and ``scales``, and the
        options of `simulate`; relative paths start from its folder. With a key ``study`` it is a study. Or the file of
        a `Project`, or the folder of a study.

    Returns
    -------
    Case, Project, CloudStudy, IncrementalStudy, ...
        What was read. The `run` of a case and of a study returns a table, that of a project the project with results.

    Raises
    ------
    InputError
        If the file cannot be read, a key is unknown or missing, or a value is wrong; the message names file and key.

    Examples
    --------
    >>> import rockflex as rf
    >>> from pathlib import Path
    >>> text = '''
    ... models = ["rigid"]
    ... scales = [1.0, 2.0]
    ... records.suites = ["el-centro-1940"]
    ... [[structures]]
    ... name = "slender"
    ... block = { slenderness = 0.15, half_diagonal = 2.5, mass = 5e3 }
    ... '''
    >>> length = Path("blocks.toml").write_text(text)
    >>> rf.read_case("blocks.toml").run()[["structure", "scale", "status"]]
      structure  scale      status
    0   slender    1.0     rocking
    1   slender    2.0  overturned
    """
    file = checked_file_path("path", path)
    if file.is_dir():
        return _study_in_folder(file)
    if file.suffix == SUFFIX:
        return read_project(file)
    content = read_toml_file(file, "case")
    if "study" in content:
        return study_in_file(file, content)
    if "structures" not in content and any(key in content for key in (CLASS, *KINDS)):
        raise InputError(
            f"{file} is the file of a structure, and a case also needs records. Write a file with [[structures]] and "
            f'file = "{file.name}", and [records] with suites, a folder or files; or read it with read_structure(path).'
        )
    return case_in_file(file, content)


def _study_in_folder(folder: Path) -> StudySpec:
    """Return the study that a folder holds, from its document.

    Raises
    ------
    InputError
        If it is no study's folder, or the study was given objects of Python, of which a folder has no more than values.
    """
    document = StudyFolder.load(folder).spec
    entries = cast("list[Any]", document.get("structures") or [])
    given = ["structures"] * any("given" in each for each in entries) + ["demands"] * ("demands" in document)
    given += ["records"] * ("motions" in document["records"]) + ["ground"] * isinstance(document.get("ground"), str)
    given += [key for key in ("impact", "ground") if {"law", CLASS} & {*_keys(document.get(key))}]
    if given:
        raise InputError(
            f"{folder} is a study that was made in Python, and its {' and '.join(dict.fromkeys(given))} cannot be read "
            "from there. Read its table with StudyFolder.load(path).frame(), or give the study's own file."
        )
    try:
        return study_kind_named(document.get("study")).spec()(**with_infinite_numbers(document))
    except InputError as error:
        raise InputError(f"{folder}: {error}") from error


def _keys(value: Any) -> list[str]:
    return list(cast("dict[str, Any]", value)) if isinstance(value, dict) else []
