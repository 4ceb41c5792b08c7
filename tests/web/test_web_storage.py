"""Storage that is full or refused: the page works without that of the browser, and tells of that of the server."""

import errno
import shutil
import subprocess
from contextlib import contextmanager
from pathlib import Path

import pytest

from rockflex.report.run import _report_files
from rockflex.web import _app, _downloads, _refusal
from rockflex.web._downloads import file_maker
from rockflex.web._folders import SentRecordFile, read_record_folder
from rockflex.web._refusal import Refusal
from rockflex.web._state import parse_page_state
from rockflex.web._uploads import UploadedRecords, read_uploaded_record

FULL = OSError(errno.ENOSPC, "No space left on device", "/tmp/rockflex-secret/file")


@contextmanager
def told_without_path(field, words="disk is full"):
    with pytest.raises(Refusal, match=words) as caught:
        yield
    assert caught.value.status == 503
    assert list(caught.value.errors) == [field]
    assert "/tmp" not in str(caught.value)


def full(*_, **__):
    raise FULL


@pytest.mark.parametrize("error", [FULL, OSError(errno.EDQUOT, "Disk quota exceeded", "/tmp/x")])
def test_uploads_say_that_the_disk_is_full(monkeypatch, error) -> None:
    def write_bytes(*_):
        raise error

    monkeypatch.setattr(Path, "write_bytes", write_bytes)
    with told_without_path("record.upload"):
        read_uploaded_record("a.csv", b"1", "g", 0.01)
    with told_without_path("record.folder"):
        read_record_folder([SentRecordFile("a.csv", b"1", 1)], "g", 0.01)
    monkeypatch.setattr(_refusal, "TemporaryDirectory", full)
    with told_without_path("record.upload"):
        read_uploaded_record("a.csv", b"1", "g", 0.01)


def test_other_errors_of_the_disk_are_told_without_their_path(monkeypatch) -> None:
    def refused(*_):
        raise PermissionError(errno.EACCES, "Permission denied", "/tmp/x")

    monkeypatch.setattr(Path, "write_bytes", refused)
    with told_without_path("record.upload", "could not store"):
        read_uploaded_record("a.csv", b"1", "g", 0.01)


def test_an_animation_says_that_the_disk_is_full(client, monkeypatch) -> None:
    monkeypatch.setattr("rockflex.plot.animation._files.writing_atomically", full)
    state = parse_page_state(client.state(models=["2DOF-S"], free_vibration=0.0))
    with told_without_path("models"):
        file_maker(state, "animation", UploadedRecords())(lambda *_: None)


def test_a_print_says_that_the_disk_is_full(monkeypatch) -> None:
    monkeypatch.setattr(_report_files, "chromium", lambda: "chromium")
    monkeypatch.setattr(_report_files, "ProcessWithFolder", full)
    with told_without_path(""):
        _downloads._printed("report-pdf", "report.html", b"<p>")


@pytest.mark.skipif(shutil.which("node") is None, reason="no node, which runs the page's script here")
def test_the_page_works_where_the_browser_keeps_nothing() -> None:
    program = (
        "Object.defineProperty(globalThis, 'localStorage', { get() { throw new DOMException('denied'); } });"
        f"const {{ keep, kept }} = await import('data:text/javascript;base64,' + (await import('fs'))"
        f".readFileSync('{_app.STATIC}/kept.js').toString('base64'));"
        "keep('a', 'b'); console.log(kept('a'));"
    )
    done = subprocess.run(["node", "--input-type=module", "-e", program], capture_output=True, text=True, timeout=60)
    assert (done.stdout.strip(), done.returncode) == ("null", 0), done.stderr


def test_no_script_asks_the_browsers_storage_unguarded() -> None:
    found = {each.name for each in _app.STATIC.rglob("*.js") if "localStorage" in each.read_text("utf-8")}
    assert found == {"kept.js"}
