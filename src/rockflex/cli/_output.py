"""Results as files, written completely or not at all."""

import json
import re
import shutil
import tempfile
import time
from collections.abc import Generator, Iterable, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rockflex import __version__
from rockflex.cli import _console as console
from rockflex.foundation.errors import InputError
from rockflex.foundation.files import check_regular_file
from rockflex.foundation.shown import few_texts_shown, number_with_noun
from rockflex.foundation.versions import package_versions

if TYPE_CHECKING:
    import pandas as pd

SUMMARY = "summary.json"
STAGE = ".rockflex-"  # begin of the names of temporary folders
YOUNG = 60.0  # s in which a temporary folder may not have its lock yet


def to_json(document: dict[str, Any], *, ascii_only: bool = True) -> str:
    """Return strictly valid JSON: NaN becomes null, and an infinity the string "inf" or "-inf"."""
    from rockflex.foundation.json import as_json_value

    return json.dumps(as_json_value(document), indent=2, ensure_ascii=ascii_only, allow_nan=False)


def versions() -> dict[str, str]:
    """Return the versions of the packages that the results depend on."""
    return {"rockflex": __version__, **package_versions(("numpy", "scipy"))}


def check_output_folder(folder: Path | None, *, force: bool) -> None:
    """Raise an InputError if the folder must not be written to, or --force was given without a folder."""
    if folder is None:
        if force:
            raise InputError(
                "--force was given without --out, to which it belongs. Add --out DIR, or leave --force out."
            )
        return
    if folder.exists() and not folder.is_dir():
        raise InputError(f"--out {folder} is a file. Give a folder; it is created if it does not exist.")
    if folder.is_dir() and not force and not all(_is_dead_stage(each) for each in folder.iterdir()):
        raise InputError(
            f"The folder {folder} is not empty. Give another one, or --force to replace the results in it."
        )


@contextmanager
def staged_output_folder(folder: Path, document: dict[str, Any], *, force: bool) -> Generator[Path, None, None]:
    """Yield a temporary folder; at the end its files move to `folder`, with `document` as summary.json.

    If anything fails before the end, `folder` is unchanged. Only earlier results there are removed or replaced.
    """
    check_output_folder(folder, force=force)
    home = folder if folder.is_dir() else folder.absolute().parent
    try:
        home.mkdir(parents=True, exist_ok=True)
        for left in home.glob(f"{STAGE}*"):
            if _is_dead_stage(left):
                shutil.rmtree(left, ignore_errors=True)
        with tempfile.TemporaryDirectory(prefix=STAGE, dir=home) as temporary, _held(Path(temporary)):
            stage = Path(temporary) / "results"
            stage.mkdir()
            yield stage
            names = sorted(file.name for file in stage.iterdir())
            text = to_json({**document, "files": [*names, SUMMARY]}, ascii_only=False)
            (stage / SUMMARY).write_text(text + "\n", "utf-8", newline="\n")
            _move_output_files(stage, folder, [*names, SUMMARY])
    except OSError as error:
        raise InputError(
            f"Cannot write to {folder}: {error.strerror or error}. Give a folder that can be written to."
        ) from error


@contextmanager
def _held(temporary: Path) -> Generator[None]:
    """Show other processes that this one is at work in its temporary folder."""
    from rockflex.studies.folders._lock import LOCK, locked_folder

    lock = locked_folder(temporary / LOCK)
    try:
        yield
    finally:
        lock.release()


def _is_dead_stage(path: Path) -> bool:
    """Whether a file is the temporary folder of a command that was killed."""
    if not path.name.startswith(STAGE) or path.is_symlink() or not path.is_dir():
        return False
    from rockflex.studies.folders._lock import LOCK, lock_holder

    if (path / LOCK).exists():
        return lock_holder(path / LOCK) is None
    return {each.name for each in path.iterdir()} <= {"results"} and time.time() - path.stat().st_mtime > YOUNG


def output_file_stems(names: Iterable[str]) -> list[str]:
    """Return a different file name, without its ending, for each name."""
    stems: list[str] = []
    for name in names:
        stem = plain = re.sub(r"[^\w.+-]+", "_", name).strip(".") or "motion"
        count = 1
        while stem.lower() in (used.lower() for used in stems):
            count += 1
            stem = f"{plain}-{count}"
        stems.append(stem)
    return stems


def written_remark(path: Path) -> str:
    """Return, before a file is written, that it was written, and that it replaced one if there is one now."""
    return f"Written to {path}" + (", in place of an earlier file" if path.exists() else "")


def write_table(table: "pd.DataFrame", path: Path) -> None:
    """Write a table as CSV."""
    from rockflex.foundation.csv import table_as_csv

    path.write_text(table_as_csv(table), "utf-8", newline="\n")


def remove_earlier_output(folder: Path) -> None:
    """Remove the files that an earlier summary in the folder lists as its own, and the summary; tell which."""
    names = _files_of_earlier_output(folder)
    for name in names:
        (folder / name).unlink(missing_ok=True)
    _tell_replaced(folder, names)


def _tell_replaced(folder: Path, names: Sequence[str]) -> None:
    if names:
        listed = f"{number_with_noun(len(names), 'file')}, {few_texts_shown(names)}"
        console.print_remark(f"Replaced the earlier results in {folder}: {listed}")


def _move_output_files(stage: Path, folder: Path, names: list[str]) -> None:
    if not folder.exists():
        stage.rename(folder)
        return
    # Earlier results left in the folder would look like new ones.
    earlier = _files_of_earlier_output(folder)
    others = [name for name in names if name not in earlier and (folder / name).exists()]
    for name in earlier:
        if name not in names:
            (folder / name).unlink(missing_ok=True)
    _tell_replaced(folder, [*earlier, *others])
    for name in names:
        (stage / name).replace(folder / name)


def _files_of_earlier_output(folder: Path) -> list[str]:
    """Names of the files that an earlier summary in the folder lists as its own."""
    try:
        check_regular_file(folder / SUMMARY)
        document = json.loads((folder / SUMMARY).read_text("utf-8"))
        names = document["files"] if "rockflex" in document["versions"] else []
    except (OSError, ValueError, LookupError, TypeError):
        return []
    return [name for name in names if isinstance(name, str) and name == Path(name).name and (folder / name).is_file()]
