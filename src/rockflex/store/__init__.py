"""Studies on disk: a folder of Parquet files, one per chunk, that can be interrupted and resumed."""

from rockflex.store._folder import DamagedPart, StudyFolder

__all__ = ["DamagedPart", "StudyFolder"]
