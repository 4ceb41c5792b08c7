"""One chunk as a Parquet file that records its study, its number and the checksum of its bytes."""
# pyright: reportUnknownParameterType=false
# (pyarrow comes without types)

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING
from zlib import crc32

from rockflex.foundation.files import irregular_file_kind

if TYPE_CHECKING:
    import pyarrow as pa
    from pyarrow import parquet


PARTS = "parts"  # the folder of the files

# The checksum stands in the footer, as a value of fixed length: it is taken with zeros in its own place.
MARKER, BLANK = b"rockflex-crc32:", b"00000000"


class PartError(Exception):
    """The reason why a file is not the expected part."""


@dataclass(frozen=True)
class StudyPart:
    """A chunk as the content of its file: `number` of the chunk, its number of `rows`, and the `content`."""

    number: int
    rows: int
    content: bytes


@dataclass(frozen=True)
class DamagedPart:
    """A part that cannot be used: `number` of the chunk, `path` of the file, and the `reason`."""

    number: int
    path: Path
    reason: str

    def __str__(self) -> str:
        return f"{self.path}: {self.reason}"


@dataclass(frozen=True)
class PartMaker:
    """The maker of the parts of a study: small and picklable, so that any process can make them without the folder.

    `study` is the digest of the study, `versions` are those that every part records.
    """

    study: str
    versions: Mapping[str, str]

    def make(self, number: int, table: "pa.Table") -> StudyPart:
        """Return the part of a chunk."""
        return StudyPart(number, table.num_rows, encode_part(table, self.study, number, self.versions))


def encode_part(table: "pa.Table", study: str, number: int, versions: Mapping[str, str]) -> bytes:
    """Return the content of the part's file."""
    import pyarrow as pa
    from pyarrow import parquet

    origin = {"rockflex.studies": study, "rockflex.chunk": str(number), "rockflex.versions": json.dumps(dict(versions))}
    sink = pa.BufferOutputStream()
    with parquet.ParquetWriter(sink, table.schema, compression="zstd") as writer:
        writer.write_table(table)
        writer.add_key_value_metadata({**origin, "rockflex.checksum": (MARKER + BLANK).decode()})
    content = sink.getvalue().to_pybytes()
    return _part_with_checksum(content, b"%08x" % crc32(content))


def part_at(path: Path, study: str, number: int) -> "parquet.ParquetFile":
    """Return the part in a file; raises the same errors as `part_of_content`."""
    kind = irregular_file_kind(path)
    if kind:
        raise PartError(f"it is {kind}")
    return part_of_content(path.read_bytes(), study, number)


def part_of_content(content: bytes, study: str, number: int) -> "parquet.ParquetFile":
    """Return the part in the content of its file.

    Raises
    ------
    PartError
        If it is truncated, damaged, not a part, or a part of another study or chunk.
    """
    from pyarrow import BufferReader, parquet

    if content[:4] != b"PAR1" or content[-4:] != b"PAR1" or len(content) < 12:
        raise PartError(f"it is no whole Parquet file, but {len(content)} bytes")
    place = content.rfind(MARKER)
    if place < 0:
        raise PartError("it is a Parquet file that carries no checksum, so that no study wrote it")
    recorded = content[place + len(MARKER) :][:8]
    if recorded != b"%08x" % crc32(_part_with_checksum(content, BLANK)):
        raise PartError("its bytes do not agree with their checksum")
    file = parquet.ParquetFile(BufferReader(content))
    origin: dict[bytes, bytes] = file.metadata.metadata or {}
    if origin.get(b"rockflex.studies") != study.encode():
        raise PartError("it belongs to another study")
    if origin.get(b"rockflex.chunk") != str(number).encode():
        raise PartError(f"it holds chunk {origin.get(b'rockflex.chunk', b'?').decode()}")
    return file


def _part_with_checksum(content: bytes, checksum: bytes) -> bytes:
    place = content.rindex(MARKER) + len(MARKER)
    return content[:place] + checksum + content[place + len(checksum) :]
