"""The manifest of a study's folder: its specification as plain JSON, and the origin of its numbers."""

import hashlib
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Self, SupportsIndex, cast

from rockflex.foundation.checks import checked_whole_number
from rockflex.foundation.errors import InputError
from rockflex.foundation.files import check_regular_file, write_file_atomically
from rockflex.foundation.shown import number_with_noun, shortened, shown

MAX_DIFFERENCES = 10  # differences in a message
MAX_DEPTH = 50  # levels of a specification; those of studies have five
WIDTH = 60  # characters of a value in a message


def plain_json_value(name: str, value: object, depth: int = 0) -> Any:
    """Return `value` as dicts, lists, strings, numbers, booleans and None, as JSON would give it back.

    Infinities and NaN are allowed, as in Python's JSON.
    """
    if depth > MAX_DEPTH:
        raise InputError(
            f"{shortened(name)} is nested more than {MAX_DEPTH} deep, which no specification is. Give the value "
            "itself, not lists within lists, and no list that holds itself."
        )
    if value is None or isinstance(value, str | bool):
        return value
    if isinstance(value, int | float):
        return int(value) if isinstance(value, int) else float(value)
    if isinstance(value, Mapping):
        items = cast("Mapping[object, object]", value)
        for key in items:
            if not isinstance(key, str):
                raise InputError(f"The keys of {name} must be strings, but {shown(key)} was given.")
        return {str(key): plain_json_value(f"{name}.{key}", each, depth + 1) for key, each in items.items()}
    if isinstance(value, list | tuple):
        entries = cast("Sequence[object]", value)
        return [plain_json_value(f"{name}[{place}]", each, depth + 1) for place, each in enumerate(entries)]
    raise InputError(
        f"{name} is of type {type(value).__name__}, which JSON does not know. Give a number, a string, a list or a "
        "dict; a NumPy array or number by its .tolist()."
    )


def specification_differences(old: Any, new: Any, where: str = "") -> list[str]:
    """Return a line for each place where two plain values differ, by its dotted path."""
    if isinstance(old, dict) and isinstance(new, dict):
        before, now = cast("dict[str, Any]", old), cast("dict[str, Any]", new)
        found: list[str] = []
        for key in [*before, *(key for key in now if key not in before)]:
            path = f"{where}.{key}" if where else key
            if key not in now:
                found.append(f"{path}: {_shown_json_value(before[key])} in the folder, not given now")
            elif key not in before:
                found.append(f"{path}: not in the folder, {_shown_json_value(now[key])} now")
            else:
                found += specification_differences(before[key], now[key], path)
        return found
    if isinstance(old, list) and isinstance(new, list):
        first, second = cast("list[Any]", old), cast("list[Any]", new)
        if len(first) != len(second):
            return [f"{where}: {number_with_noun(len(first), 'entry', 'entries')} in the folder, {len(second)} now"]
        pairs = enumerate(zip(first, second, strict=True))
        return [
            line for place, (one, two) in pairs for line in specification_differences(one, two, f"{where}[{place}]")
        ]
    return (
        []
        if _same_json_values(old, new)
        else [f"{where}: {_shown_json_value(old)} in the folder, {_shown_json_value(new)} now"]
    )


def listed_differences(lines: Sequence[str]) -> str:
    """Return the first lines, indented, and how many more there are."""
    more = [f"and {len(lines) - MAX_DIFFERENCES} more"] if len(lines) > MAX_DIFFERENCES else []
    return "".join(f"\n  {line}" for line in [*lines[:MAX_DIFFERENCES], *more])


def _same_json_values(old: Any, new: Any) -> bool:
    if isinstance(old, float) and isinstance(new, float) and math.isnan(old) and math.isnan(new):
        return True
    return isinstance(old, bool) is isinstance(new, bool) and old == new


def _shown_json_value(value: Any) -> str:
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) <= WIDTH else f"{text[: WIDTH - 3]}..."


FORMAT = "rockflex-study-2"  # 1: without total displacements and reactions of the ground
MANIFEST, SPEC = "manifest.json", "spec.json"
COMMIT = " commit"  # versions whose name ends so tell where code came from, and are not compared
LEVEL = "vector instructions"  # the version that older manifests do not have
MAX_PARTS = 100_000  # every part is a file, whose number has five digits


@dataclass(frozen=True)
class StudyManifest:
    """Identity and origin of a study.

    `spec` is its specification as plain JSON, stored in a file of its own; `study` the digest of the specification, the
    number of chunks and the checksums, which every part records. `versions` are those of the libraries that the numbers
    depend on; those that end in " commit" only say where code came from. `checksums` are of each record, matrix from a
    file and other file that the study depends on, by name; `created` is the date and time, UTC, ISO 8601.
    """

    spec: dict[str, Any]
    study: str
    n_chunks: int
    versions: dict[str, Any]
    checksums: dict[str, Any]
    created: str

    @classmethod
    def of(
        cls, spec: Mapping[str, Any], n_chunks: SupportsIndex, versions: Mapping[str, str], checksums: Mapping[str, str]
    ) -> Self:
        for name, given in (("spec", spec), ("versions", versions), ("checksums", checksums)):
            if not isinstance(given, Mapping):  # pyright: ignore[reportUnnecessaryIsInstance]
                raise InputError(f"{name} must be a mapping, but {type(given).__name__} was given.")
        count = _part_count(n_chunks)
        content, sums = plain_json_value("spec", spec), plain_json_value("checksums", checksums)
        now = datetime.now(UTC).isoformat(timespec="seconds")
        return cls(
            content, _study_digest(content, count, sums), count, plain_json_value("versions", versions), sums, now
        )

    def write(self, folder: Path) -> None:
        """Write both files, the manifest last, because its presence marks the folder as a study."""
        origin = {"format": FORMAT, **asdict(self), "seed": self.spec.get("seed")}
        del origin["spec"]
        write_file_atomically(folder / SPEC, _encoded_manifest(self.spec))
        write_file_atomically(folder / MANIFEST, _encoded_manifest(origin))

    @classmethod
    def read(cls, folder: Path) -> Self:
        """Read what `write` wrote."""
        path = folder / MANIFEST
        for file in (path, folder / SPEC):
            check_regular_file(file)
        try:
            origin = json.loads(path.read_text("utf-8"))
            spec = plain_json_value("spec", json.loads((folder / SPEC).read_text("utf-8")))
            known = origin.pop("format")
            if known == FORMAT:
                del origin["seed"]
                _part_count(origin["n_chunks"])
                manifest = cls(spec=spec, **origin)
                datetime.fromisoformat(manifest.created)
                dict[str, Any](manifest.versions)
                intact = manifest.study == _study_digest(spec, manifest.n_chunks, manifest.checksums)
                if intact:
                    return manifest
        except (ValueError, TypeError, KeyError, AttributeError, RecursionError, FileNotFoundError) as error:
            reason = f"{type(error).__name__}: {shortened(str(error))}"
            raise InputError(
                f"{path} or the {SPEC} beside it is damaged ({reason}). Restore both from a copy, "
                f"or give another folder; the results in {folder / 'parts'} can still be read as Parquet."
            ) from error
        if known != FORMAT:
            raise InputError(
                f"{path} has the format {shown(known)}, but this version of rockflex reads {FORMAT!r}. "
                "Use the version that wrote it, or run the study again in another folder; the results in "
                f"{folder / 'parts'} can still be read as Parquet."
            )
        raise InputError(
            f"{folder / SPEC} was changed after the study started. Undo the change, or give another folder."
        )

    def accept(self, given: "StudyManifest", folder: Path, *, any_version: bool) -> None:
        """Raise an `InputError` that lists the differences if `given` is not this study."""
        changed = specification_differences(self.spec, given.spec)
        if self.n_chunks != given.n_chunks:
            changed.append(f"number of chunks: {self.n_chunks} in the folder, {given.n_chunks} now")
        if changed:
            raise InputError(
                f"{folder} holds another study. What differs:{listed_differences(changed)}\n"
                "Give another folder for this study, or the folder's own specification to resume it."
            )
        changed = specification_differences(self.checksums, given.checksums)
        if changed:
            raise InputError(
                f"{folder} holds this study with another record, matrix, source or impact law. Checksums that differ:"
                f"{listed_differences(changed)}\nUse the same files, or give another folder."
            )
        now = _compared_versions(given.versions)
        if LEVEL not in self.versions:
            now.pop(LEVEL, None)
        changed = specification_differences(_compared_versions(self.versions), now)
        if changed and not any_version:
            raise InputError(
                f"{folder} was started with other versions, whose numbers may differ in the last digits:"
                f"{listed_differences(changed)}\n"
                f"Install those versions (set ROCKFLEX_SIMD for other {LEVEL}), give another folder, or pass "
                "any_version=True to mix them."
            )


def _compared_versions(versions: Mapping[str, Any]) -> dict[str, Any]:
    return {name: version for name, version in versions.items() if not name.endswith(COMMIT)}


def _part_count(n_chunks: SupportsIndex) -> int:
    count = checked_whole_number("n_chunks", n_chunks, 1)
    if count > MAX_PARTS:
        raise InputError(
            f"n_chunks must be at most {MAX_PARTS}, because each chunk is a file, but {shown(count)} was given. "
            "Compute more runs per chunk: runs_per_chunk in a study."
        )
    return count


def _encoded_manifest(content: dict[str, Any]) -> bytes:
    return (json.dumps(content, indent=2, ensure_ascii=False) + "\n").encode()


def _study_digest(spec: dict[str, Any], n_chunks: int, checksums: dict[str, Any]) -> str:
    canonical = json.dumps([spec, n_chunks, checksums], sort_keys=True)
    return hashlib.sha256(canonical.encode()).hexdigest()[:32]
