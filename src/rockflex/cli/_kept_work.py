"""The finished work of ``rockflex reproduce``, kept in its output folder so that the same line goes on after a stop."""

import shutil
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Self

from rockflex.cli import _console as console
from rockflex.cli import _output as output
from rockflex.foundation.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterable

    import pandas as pd

    from rockflex.papers.silva_stojadinovic_2024._inputs import PaperRecords, Piece
    from rockflex.report._document import FinishedResult
    from rockflex.studies.folders._folder import StudyFolder

KEPT = "kept"  # the folder in the output folder
RESULTS = "results"  # the study of the targets; every group of pieces has another one


class KeptWork:
    """Finished targets and tables of pieces: `StudyFolder`s in which a target or a piece is a part.

    Without a folder nothing is kept. Use it as a context manager: until its end no other process can write there.
    """

    def __init__(self, out: Path | None, records: "PaperRecords") -> None:
        self._home = None if out is None else out / KEPT
        self._records, self._stack = records, ExitStack()
        self._folders: dict[str, StudyFolder] = {}

    def __enter__(self) -> Self:
        if self._home is not None:
            try:
                self._check_same_work(self._home / RESULTS)
                self._results()
            except BaseException:
                self._stack.close()
                raise
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def results(self) -> "dict[str, FinishedResult]":
        """Return the finished targets, in the order of the paper."""
        from rockflex.papers.silva_stojadinovic_2024._targets import TARGETS
        from rockflex.report._document import FinishedResult

        if self._home is None:
            return {}
        parts = {name: self._results().part(number) for number, name in enumerate(TARGETS)}
        return {
            name: FinishedResult.from_json(part["result"][0].as_py())
            for name, part in parts.items()
            if part is not None
        }

    def add_result(self, result: "FinishedResult") -> None:
        """Keep a finished target."""
        import pyarrow as pa

        from rockflex.papers.silva_stojadinovic_2024._targets import TARGETS

        if self._home is not None:
            row = {"target": [result.name], "result": [result.to_json()]}
            self._results().write(TARGETS.index(result.name), pa.table(row))

    def tables(self, pieces: "Iterable[Piece]") -> "dict[str, pd.DataFrame]":
        """Return the tables of those pieces that are there, by their names."""
        found: dict[str, pd.DataFrame] = {}
        for piece in pieces:
            if self._home is not None and piece.name not in found and (self._home / piece.group).exists():
                part = self._group(piece.group, piece.count).part(piece.number)
                if part is not None:
                    found[piece.name] = part.to_pandas()
        return found

    def add_table(self, piece: "Piece", table: "pd.DataFrame") -> None:
        """Keep the table of a piece."""
        import pyarrow as pa

        if self._home is not None:
            self._group(piece.group, piece.count).write(piece.number, pa.Table.from_pandas(table))

    def _results(self) -> "StudyFolder":
        from rockflex.papers.silva_stojadinovic_2024._targets import TARGETS

        return self._group(RESULTS, len(TARGETS))

    def _group(self, name: str, count: int) -> "StudyFolder":
        from rockflex.studies.folders._folder import StudyFolder

        assert self._home is not None
        if name not in self._folders:
            # Other versions were refused before, for all groups at once.
            study = StudyFolder.open(
                self._home / name, self._spec, count, _versions(), self._checksums, any_version=True
            )
            self._folders[name] = self._stack.enter_context(study)
        return self._folders[name]

    @property
    def _spec(self) -> dict[str, object]:
        records = self._records
        source = "embedded" if records.folder is None else f"folder {records.folder.resolve().name}"
        return {
            "study": "Silva & Stojadinović 2024",
            "records": source,
            "seeds": records.seeds,
            "seed": records.seed,
            "pairs": records.pairs,
        }

    @property
    def _checksums(self) -> dict[str, str]:
        from rockflex.studies._run_matrix import record_checksums

        return record_checksums(self._records.suite)

    def _check_same_work(self, folder: Path) -> None:
        """Raise an InputError that lists what differs from the reproduction in a folder, if there is one."""
        from rockflex.studies.folders._folder import StudyFolder
        from rockflex.studies.folders._manifest import MANIFEST, listed_differences, specification_differences

        if not (folder / MANIFEST).exists():
            return
        stored = StudyFolder.load(folder).manifest
        pairs = ((stored.spec, self._spec), (stored.versions, _versions()), (stored.checksums, self._checksums))
        differing = [line for old, new in pairs for line in specification_differences(dict(old), dict(new))]
        if differing:
            raise InputError(
                f"{folder.parents[1]} holds a reproduction that was begun with other options, records or versions:"
                f"{listed_differences(differing)}\nGive the options it was begun with to go on, another folder, or "
                "--force to start anew in this one."
            )


def _versions() -> dict[str, str]:
    """Return what the numbers depend on; in a working copy of the sources also their commit."""
    from rockflex.engine.loops import LEVEL as VECTOR_LEVEL
    from rockflex.foundation.versions import CHANGES, git_commit

    commit = (git_commit(Path(__file__), known=True) or "").removesuffix(CHANGES)
    return output.versions() | {"vector instructions": VECTOR_LEVEL} | ({"source": commit} if commit else {})


def prepare_folder(out: Path, *, force: bool) -> None:
    """Check that a folder is empty or of a reproduction; `force` removes earlier results of rockflex from it.

    Raises
    ------
    InputError
        If it holds other things, or another process writes into it.
    """
    from rockflex.studies.folders._lock import LOCK, lock_holder

    kept = out / KEPT
    ours = (kept / RESULTS).is_dir()
    if ours and not force:
        return
    output.check_output_folder(out, force=force)
    holder = lock_holder(kept / RESULTS / LOCK)
    if holder is not None:
        raise InputError(f"{out} is in use by {holder}. Wait until it has finished, or end it.")
    output.remove_earlier_output(out)
    if ours:
        console.print_remark(f"Removed {kept}, what an earlier reproduction had finished")
        shutil.rmtree(kept)
