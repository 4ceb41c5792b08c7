"""The processes that read visitors' files: they end in time, with their visitors and with their temporary files."""

import os
import tempfile
import time
from pathlib import Path
from threading import Event, Thread

import pytest

from rockflex.engine.stops import RunStoppedError, stopping_when
from rockflex.web._readers import Readers
from rockflex.web._refusal import Refusal
from rockflex.web._uploads import read_uploaded_matrices, read_uploaded_record

HANG = 60.0  # s: a guard against what never ends
CSV = b"time (s),acc (g)\n0.00,0.0\n0.01,0.1\n0.02,-0.2\n0.03,0.0\n"


@pytest.fixture(scope="module")
def readers():
    found = Readers()
    yield found
    found.close()


def test_a_file_is_read_as_without_them_and_refused_with_its_field(readers) -> None:
    found = readers.read("record.upload", read_uploaded_record, "a.csv", CSV, None, None)
    expected = read_uploaded_record("a.csv", CSV, None, None)
    assert found.acceleration.tolist() == expected.acceleration.tolist()
    assert (found.name, found.dt, found.metadata) == (expected.name, expected.dt, expected.metadata)
    with pytest.raises(Refusal) as caught:
        readers.read("structure", read_uploaded_matrices, "k.csv", b"4,x\n", "mass")
    assert list(caught.value.errors) == ["structure"]


def test_one_process_reads_one_file_after_another(readers) -> None:
    first = readers.read("", os.getpid)
    assert first != os.getpid()
    assert readers.read("", os.getpid) == first


@pytest.mark.skipif(not Path("/proc/self/oom_score_adj").exists(), reason="of Linux")
def test_where_memory_runs_out_it_ends_rather_than_the_server(readers) -> None:
    assert readers.read("", Path.read_text, Path("/proc/self/oom_score_adj")).strip() == "1000"


def test_what_takes_too_long_ends_with_its_process_and_its_files(readers) -> None:
    folder, process = Path(readers.read("", tempfile.gettempdir)), readers.read("", os.getpid)
    assert folder.is_dir()
    begun = time.monotonic()
    with pytest.raises(Refusal, match=r"more than 0\.2 s") as caught:
        readers.read("record.upload", time.sleep, 10 * HANG, seconds=0.2)
    assert time.monotonic() - begun < HANG
    assert list(caught.value.errors) == ["record.upload"]
    assert not folder.exists()
    assert readers.read("", os.getpid) != process


def test_it_ends_when_its_visitor_leaves(readers) -> None:
    gone = Event()
    Thread(target=lambda: (time.sleep(0.2), gone.set())).start()
    with stopping_when(gone.is_set), pytest.raises(RunStoppedError):
        readers.read("record.upload", time.sleep, 10 * HANG, seconds=10 * HANG)


@pytest.mark.skipif(os.name == "nt", reason="Windows has no limit of memory for a process")
def test_what_takes_too_much_memory_is_refused(readers) -> None:
    with pytest.raises(Refusal, match="memory") as caught:
        readers.read("record.upload", bytearray, 8_000_000_000)
    assert list(caught.value.errors) == ["record.upload"]


def test_they_end_with_the_server() -> None:
    own = Readers()
    folder = Path(own.read("", tempfile.gettempdir))
    own.close()
    assert not folder.exists()
