"""Studies on disk: a folder of Parquet files, one a chunk, that can be left and taken up again."""

from rockflex.store._folder import DamagedPart, StudyFolder

__all__ = ["DamagedPart", "StudyFolder"]
