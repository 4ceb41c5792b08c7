"""Studies on disk: a folder of Parquet files, one per chunk, that can be interrupted and resumed."""

from rockflex.store._folder import StudyFolder
from rockflex.store._manifest import LEVEL
from rockflex.store._parts import DamagedPart, Part, PartMaker

__all__ = ["LEVEL", "DamagedPart", "Part", "PartMaker", "StudyFolder"]
