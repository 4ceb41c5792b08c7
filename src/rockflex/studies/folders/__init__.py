"""Studies on disk: a folder of Parquet files, one per chunk, that can be interrupted and resumed."""

from rockflex.studies.folders._folder import StudyFolder

__all__ = [
    "StudyFolder",
]
