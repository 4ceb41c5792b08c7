"""Archives that lie about what they hold, at every reader of archives: refused, without the memory they ask for."""

import io
import struct
import tracemalloc
import zipfile

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from rockflex.foundation.archives import ArchiveError, ArchiveLimits, archive_bytes, array_from_npy, open_archive
from rockflex.web._folders import unpacked_record_files
from rockflex.web._projects import state_of_project
from rockflex.web._refusal import Refusal
from rockflex.web._uploads import UploadedRecords, read_uploaded_matrices, read_uploaded_record

LARGE = 120_000_000  # bytes, of which no reader takes a fourth
MOST = LARGE // 4


def lying(name: str, content: bytes, packing: int, stated: int) -> bytes:
    """A ZIP whose only member states another size than it has, with the checksum of what it states."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", packing) as archive:
        archive.writestr(name, content)
    right = struct.pack("<L", zipfile.crc32(content)), struct.pack("<L", len(content))
    told = struct.pack("<L", zipfile.crc32(content[:stated])), struct.pack("<L", stated)
    found = packed.getvalue()
    for before, after in zip(right, told, strict=True):
        found = found.replace(before, after)
    return found


def long_header() -> bytes:
    """An array of version 2.0 whose header is longer than any."""
    return b"\x93NUMPY\x02\x00" + struct.pack("<L", LARGE) + b" " * LARGE


def claim() -> bytes:
    """An array whose header claims more than follows."""
    header = io.BytesIO()
    np.lib.format.write_array_header_1_0(header, {"descr": "<f8", "fortran_order": False, "shape": (200, LARGE)})
    return header.getvalue()


def folder(content: bytes, path):
    head = b'[{"name": "a.zip", "size": %d, "sent": true}]\n' % len(content)
    return unpacked_record_files(head + content)


READERS = {
    "folder": ("a.AT2", folder),
    "record": ("xl/workbook.xml", lambda content, path: read_uploaded_record("a.xlsx", content, None, None)),
    "matrices": ("stiffness.npy", lambda content, path: read_uploaded_matrices("a.npz", content, "")),
    "project": ("page.json", lambda content, path: state_of_project(content, UploadedRecords())),
    "response": ("response.npy", lambda content, path: rf.Response.load(path)),
    "from_matrices": (
        "stiffness.npy",
        lambda content, path: rf.from_matrices(
            np.eye(2), path, heights=[3.0, 6.0], base_mass=1.0, half_width=1.0, damping_ratio=0.0
        ),
    ),
}
BOMBS = {
    "bzip2": (bytes(LARGE), zipfile.ZIP_BZIP2, 30),
    "lzma": (bytes(LARGE), zipfile.ZIP_LZMA, 30),
    "deflate": (bytes(LARGE), zipfile.ZIP_DEFLATED, 30),
    "header": (long_header(), zipfile.ZIP_DEFLATED, 40_000),
}


@pytest.fixture(scope="module")
def packed():
    """The bombs, each packed once for all readers."""
    return {
        (kind, name): lying(name, *BOMBS[kind]) for kind in BOMBS for name in {name for name, _ in READERS.values()}
    }


@pytest.mark.parametrize("kind", BOMBS)
@pytest.mark.parametrize("reader", READERS)
def test_what_lies_about_its_size_takes_no_memory(packed, tmp_path, reader, kind) -> None:
    name, read = READERS[reader]
    content = packed[kind, name]
    path = tmp_path / "given.npz"
    path.write_bytes(content)
    tracemalloc.start()
    try:
        if reader == "folder" and kind in ("deflate", "header"):
            assert [each.size for each in read(content, path)] == [BOMBS[kind][2]]  # as much as it states, and no more
        else:
            with pytest.raises((Refusal, rf.InputError)):
                read(content, path)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < MOST


def test_a_header_that_claims_more_than_there_is_is_refused_before_numpy_reads_it() -> None:
    for content in (long_header(), claim(), b"\x93NUMPY\x03\x00" + bytes(80), b"\x93NUM", b""):
        with pytest.raises(ArchiveError):
            array_from_npy(content)
    saved = io.BytesIO()
    np.save(saved, np.arange(6.0).reshape(2, 3))
    assert array_from_npy(saved.getvalue()).tolist() == [[0, 1, 2], [3, 4, 5]]


@pytest.mark.parametrize(
    ("most", "kind"),
    [(ArchiveLimits(members=2), "members"), (ArchiveLimits(member_bytes=99), "size"),
     (ArchiveLimits(total_bytes=299), "size"), (ArchiveLimits(3, 100, 300), None)],
)  # fmt: skip
def test_limits_are_those_of_members_of_one_and_of_all(most, kind) -> None:
    content = archive_bytes({name: bytes(100) for name in "abc"})
    if kind is None:
        with open_archive(content, most) as archive:
            assert archive.contents() == {name: bytes(100) for name in "abc"}
        return
    with pytest.raises(ArchiveError) as caught, open_archive(content, most) as archive:
        archive.contents()
    assert caught.value.kind == kind


def test_a_long_list_is_not_opened() -> None:
    listed = archive_bytes({"a": b"1"})
    place = listed.index(b"PK\x01\x02")
    end = listed.index(b"PK\x05\x06")
    entry, count = listed[place:end], 100_000
    tail = struct.pack("<4s4H2LH", b"PK\x05\x06", 0, 0, 65_535, 65_535, count * len(entry), place, 0)
    content = listed[:place] + entry * count + tail
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        assert len(archive.infolist()) == count
    tracemalloc.start()
    with pytest.raises(ArchiveError) as caught, open_archive(content, ArchiveLimits()):
        pass
    assert caught.value.kind == "members"
    assert tracemalloc.get_traced_memory()[1] < 4 * len(content)
    tracemalloc.stop()


def test_what_is_damaged_is_told() -> None:
    whole = archive_bytes({"a": b"0123456789" * 50}, zipfile.ZIP_STORED)
    for content in (b"", whole[:-30], whole.replace(b"0123", b"0124", 1)):
        with pytest.raises(ArchiveError) as caught, open_archive(content, ArchiveLimits()) as archive:
            archive.contents()
        assert caught.value.kind == "damaged"


def test_what_is_read_is_what_was_saved(tmp_path) -> None:
    response = rf.simulate(make_frame(), rf.load_suite("el-centro-1940")[0], "MDOF-S", output="history")
    loaded = rf.Response.load(response.save(tmp_path / "a.npz"))
    assert np.array_equal(loaded.history.states, response.history.states)
