"""Studies on disk: a folder of Parquet files, one per chunk, that can be interrupted and resumed."""

from rockflex.study.folders._folder import StudyFolder
from rockflex.study.folders._manifest import LEVEL
from rockflex.study.folders._parts import DamagedPart, PartMaker, StudyPart

__all__ = ["LEVEL", "DamagedPart", "PartMaker", "StudyFolder", "StudyPart"]
