"""Studies on disk: a folder of Parquet files, one per chunk, that can be interrupted and resumed."""

from rockflex.study.folders._folder import StudyFolder
from rockflex.study.folders._manifest import LEVEL
from rockflex.study.folders._parts import DamagedPart, Part, PartMaker

__all__ = ["LEVEL", "DamagedPart", "Part", "PartMaker", "StudyFolder"]
