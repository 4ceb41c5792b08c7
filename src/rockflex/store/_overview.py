"""What a study's folder says of itself: one screen of text, or a table in a notebook."""
# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# (pyarrow comes without types)

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, cast

from rockflex._html import html_table
from rockflex._shown import counted, few, shortened
from rockflex.store._lock import LOCK, holder_of
from rockflex.store._manifest import Manifest
from rockflex.store._parts import PARTS

WIDTH = 100  # most characters of a line
MOST_READ = 500  # parts whose rows are counted, some tenths of a second
MOST_KEYS = 10  # of the specification


class Overview:
    """Shows a folder with a `path` and a `manifest`, as it is at the moment of asking; damage is not looked for."""

    path: Path
    manifest: Manifest

    def __repr__(self) -> str:
        found = facts(self.path, self.manifest)
        width = max(map(len, found))
        lines = [f"  {name:{width}}  {shortened(text, WIDTH - width - 4)}" for name, text in found.items()]
        return "\n".join([f"StudyFolder({str(self.path)!r})", *lines])

    def _repr_html_(self) -> str:
        return html_table("StudyFolder", {"folder": str(self.path), **facts(self.path, self.manifest)})


def facts(folder: Path, manifest: Manifest) -> dict[str, str]:
    """Return what there is to say about a study, by its heading."""
    parts = list(_parts(folder, manifest.n_chunks))
    found = {"study": _title(manifest.spec), "state": _state(folder, len(parts), manifest.n_chunks)}
    found["started"] = _instant(datetime.fromisoformat(manifest.created))
    if parts:
        seconds = max(when for _, _, when in parts)
        found["last part"] = _instant(datetime.fromtimestamp(seconds, UTC))
        found["size"] = f"{sum(size for _, size, _ in parts) / 1e6:.3g} MB in {PARTS}/*.parquet"
        found |= _counts([path for path, _, _ in parts])
    if manifest.checksums:
        found["inputs"] = f"{len(manifest.checksums)} with checksums: {few(list(manifest.checksums))}"
    if manifest.versions:
        found["versions"] = ", ".join(f"{name} {version}" for name, version in manifest.versions.items())
    return found | dict(list(_specified(manifest.spec))[:MOST_KEYS])


def _parts(folder: Path, count: int) -> Iterator[tuple[Path, int, float]]:
    """Yield the parts that are there, with their sizes in bytes and their times in s."""
    for path in sorted((folder / PARTS).glob("part-*.parquet"))[:count]:
        try:
            state = path.stat()
        except OSError:  # gone since it was listed
            continue
        yield path, state.st_size, state.st_mtime


def _title(spec: Mapping[str, Any]) -> str:
    return ", ".join(str(spec[key]) for key in ("study", "name") if spec.get(key)) or "without a name"


def _state(folder: Path, done: int, total: int) -> str:
    holder = holder_of(folder / LOCK)
    if done == total:
        return f"complete: all {counted(total, 'part')}"
    if holder is not None:
        return f"running: {done} of {total} parts, by {holder}"
    return f"stopped: {done} of {total} parts" if done else f"planned: none of {total} parts"


def _instant(when: datetime) -> str:
    return f"{when:%Y-%m-%d %H:%M} UTC"


def _counts(paths: Sequence[Path]) -> dict[str, str]:
    """Count the rows of some parts, and what their columns of results say."""
    from pyarrow import ArrowException, parquet

    rows, unreadable = 0, 0
    statuses = dict[str, Counter[str]]()
    for path in paths[:MOST_READ]:
        try:
            with parquet.ParquetFile(path) as file:
                known = Counter(file.schema_arrow.names)
                names = [each for each in known if (each.startswith("status") or each == "error") and known[each] == 1]
                table = file.read(columns=names)
                rows += cast("int", file.metadata.num_rows)
        except (ArrowException, OSError):
            unreadable += 1
            continue
        for name in names:
            values = table.column(name).drop_null().to_pylist()
            seen = ["failed"] * len(values) if name == "error" else map(str, values)
            statuses.setdefault(name, Counter()).update(seen)
    some = f" in the first {MOST_READ} parts" if len(paths) > MOST_READ else ""
    lost = f"; {counted(unreadable, 'part')} cannot be read, see damaged()" if unreadable else ""
    found = {"rows": f"{rows}{some}{lost}"}
    for name, counter in statuses.items():
        if counter:
            told = (f"{count} {str(value).replace('_', ' ')}" for value, count in counter.most_common())
            found["errors" if name == "error" else name] = ", ".join(told)
    return found


def _specified(spec: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Yield the keys of a specification that say something, shortened."""
    for key, value in spec.items():
        if value is None or value == [] or key in ("study", "name"):
            continue
        if isinstance(value, list):
            yield key, _text(value)
        elif isinstance(value, Mapping):
            yield key, "; ".join(f"{name}: {_text(each)}" for name, each in value.items())
        else:
            yield key, str(value)


def _text(value: Any) -> str:
    """Write a value; of several also how many they are."""
    if not isinstance(value, list):
        return str(value)
    values = cast("list[Any]", value)
    return f"{len(values)}: {_names(values)}" if len(values) > 2 else _names(values)


def _names(values: Sequence[Any]) -> str:
    """Write the first and the last few of some values, by name where they have one."""
    return few([str(each.get("name", "a table") if isinstance(each, Mapping) else each) for each in values])
