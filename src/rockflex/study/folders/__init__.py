"""Studies on disk: a folder of Parquet files, one per chunk, that can be interrupted and resumed."""

from rockflex.study.folders._folder import StudyFolder, explaining_write_errors
from rockflex.study.folders._lock import LOCK, lock_holder, locked_folder
from rockflex.study.folders._manifest import LEVEL, MANIFEST, listed_differences, specification_differences
from rockflex.study.folders._parts import DamagedPart, PartMaker, StudyPart

__all__ = [
    "LEVEL",
    "LOCK",
    "MANIFEST",
    "DamagedPart",
    "PartMaker",
    "StudyFolder",
    "StudyPart",
    "explaining_write_errors",
    "listed_differences",
    "lock_holder",
    "locked_folder",
    "specification_differences",
]
