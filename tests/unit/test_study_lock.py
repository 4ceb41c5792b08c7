"""One process at a time in a study's folder, and Ctrl-C."""

import functools
import gc
import json
import os
import platform
import signal
import subprocess
import sys
import time
from pathlib import Path

import pandas as pd
import pytest

import toy_study
from rockflex import InputError
from rockflex.study.folders import StudyFolder, _lock
from rockflex.study.folders._lock import FolderLock
from toy_study import ToyPlan, opened, run_study

PLAN = ToyPlan(n_chunks=2)


def holder(**changes: object) -> str:
    living = {"pid": os.getpid(), "start": "", "host": platform.node(), "since": "noon"}
    return json.dumps(living | changes)


def dead_pid() -> int:
    with subprocess.Popen([sys.executable, "-c", ""]) as process:
        pass
    return process.pid


def test_a_second_opening_is_refused_and_reading_is_not(tmp_path: Path) -> None:
    with opened(str(tmp_path), PLAN) as first:
        message = rf"is in use by process {os.getpid()} on .* since .*delete .*lock and try again"
        with pytest.raises(InputError, match=message):
            opened(str(tmp_path), PLAN)
        assert StudyFolder.load(tmp_path).missing() == [0, 1]
        first.write(0, PLAN.chunk(0))
    with pytest.raises(InputError, match=r"lock is no longer held: the folder was closed"):
        first.write(1, PLAN.chunk(1))
    with opened(str(tmp_path), PLAN) as second:
        assert second.missing() == [1]
        first.close()  # takes nothing from the second
        second.write(1, PLAN.chunk(1))


def test_the_lock_goes_with_its_object(tmp_path: Path) -> None:
    study = opened(str(tmp_path), PLAN)
    assert (tmp_path / "lock").exists()
    del study
    gc.collect()
    assert not (tmp_path / "lock").exists()


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork")
def test_a_forked_child_does_not_take_the_lock_along(tmp_path: Path) -> None:
    program = (
        "import os, sys\nfrom pathlib import Path\nfrom rockflex.study.folders._lock import FolderLock\n"
        "lock = FolderLock.acquire(Path(sys.argv[1]))\npid = os.fork()\n"
        "if not pid:\n    lock.release(); os._exit(0)\n"
        "os.waitpid(pid, 0); lock.check(); print('held')"
    )
    done = subprocess.run(
        [sys.executable, "-c", program, str(tmp_path / "lock")], capture_output=True, text=True, check=True
    )
    assert done.stdout == "held\n"
    assert not (tmp_path / "lock").exists()  # the parent's end has released it


def test_the_lock_of_a_dead_process_is_taken_over(tmp_path: Path) -> None:
    path = tmp_path / "lock"
    path.write_text(holder(pid=dead_pid()))
    FolderLock.acquire(path).release()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="the start of a process is not known")
def test_a_number_given_to_a_new_process_is_no_life(tmp_path: Path) -> None:
    path = tmp_path / "lock"
    path.write_text(holder(start="1"))
    FolderLock.acquire(path).release()
    with subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE) as child:
        path.write_text(holder(pid=child.pid, start=_lock._process_start(child.pid)))
        with pytest.raises(InputError, match=f"process {child.pid}"):
            FolderLock.acquire(path)
        child.kill()
        os.waitid(os.P_PID, child.pid, os.WEXITED | os.WNOWAIT)  # dead, and not yet buried
        FolderLock.acquire(path).release()


def test_where_starts_are_unknown_the_number_decides(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def nothing(*_: object) -> str:
        raise FileNotFoundError

    path, dead = tmp_path / "lock", dead_pid()
    monkeypatch.setattr(Path, "read_text", nothing)
    assert _lock._process_start(dead) is None
    assert _lock._process_start(os.getpid()) == ""

    def forbidden(*_: object) -> None:
        raise PermissionError

    monkeypatch.setattr(os, "kill", forbidden)
    assert _lock._process_start(dead) == ""
    monkeypatch.undo()
    path.write_text(holder(start=""))
    with pytest.raises(InputError, match="in use by process"):
        FolderLock.acquire(path)


def test_the_lock_of_another_host_stands(tmp_path: Path) -> None:
    path = tmp_path / "lock"
    path.write_text(holder(pid=dead_pid(), host="elsewhere"))
    with pytest.raises(InputError, match=r"on elsewhere since noon\. Wait .* If it no longer runs, delete"):
        FolderLock.acquire(path)


@pytest.mark.parametrize("content", ["", "{", "[1]", "{}"])
def test_an_unreadable_lock_is_given_a_moment(tmp_path: Path, content: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(_lock, "MIN_STALE_AGE", 0.2)
    path = tmp_path / "lock"
    path.write_text(content)
    begin = time.monotonic()
    lock = FolderLock.acquire(path)
    assert time.monotonic() - begin > 0.1
    lock.release()


def test_a_lock_taken_over_by_another_in_the_meantime_is_given_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, real = tmp_path / "lock", Path.rename
    path.write_text(holder(pid=dead_pid()))
    fresh = holder(start=_lock._process_start(os.getpid()), since="just now")

    def overtaken(self: Path, target: Path) -> Path:
        monkeypatch.undo()
        self.write_text(fresh)
        return real(self, target)

    monkeypatch.setattr(Path, "rename", overtaken)
    with pytest.raises(InputError, match="since just now"):
        FolderLock.acquire(path)
    assert path.read_text() == fresh
    assert list(tmp_path.iterdir()) == [path]


def test_of_many_that_find_a_dead_lock_one_gets_it(tmp_path: Path) -> None:
    path = tmp_path / "lock"
    path.write_text(holder(pid=dead_pid()))
    program = (
        "import sys, time\nfrom pathlib import Path\nfrom rockflex.study.folders._lock import FolderLock\n"
        "from rockflex import InputError\nsys.stdin.readline()\n"
        "try:\n    lock = FolderLock.acquire(Path(sys.argv[1]))\n    print('mine', flush=True)\n"
        "    sys.stdin.readline(); lock.check()\n"
        "except InputError:\n    print('refused', flush=True)"
    )
    command = [sys.executable, "-c", program, str(path)]
    crowd = [subprocess.Popen(command, stdin=-1, stdout=-1, text=True) for _ in range(6)]
    for process in crowd:
        process.stdin.write("go\n")
        process.stdin.flush()
    answers = [process.stdout.readline() for process in crowd]
    for process in crowd:
        process.communicate("end\n")
    assert sorted(answers) == ["mine\n"] + ["refused\n"] * 5


@pytest.mark.parametrize(
    "changes", [{"pid": "x"}, {"pid": [1]}, {"pid": None}, {"pid": True}, {"pid": -1}, {"pid": 10**30}, {"host": 1}]
)
def test_a_damaged_lock_is_given_a_moment(
    tmp_path: Path, changes: dict[str, object], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(_lock, "MIN_STALE_AGE", 0.1)
    (tmp_path / "lock").write_text(holder(**changes))
    FolderLock.acquire(tmp_path / "lock").release()


@pytest.mark.parametrize("content", [b"", b"\xff\xfe", b"[" * 100_000])
def test_a_lock_from_the_future_is_not_waited_for(
    tmp_path: Path, content: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(_lock, "MIN_STALE_AGE", 0.2)
    path = tmp_path / "lock"
    path.write_bytes(content)
    os.utime(path, (time.time() + 1e6,) * 2)
    begin = time.monotonic()
    FolderLock.acquire(path).release()
    assert 0.1 < time.monotonic() - begin < 2.0


def test_what_is_no_lock_is_not_taken_away(tmp_path: Path) -> None:
    (tmp_path / "lock").mkdir()
    with pytest.raises(InputError, match=r"lock is not a file, but the study's lock belongs there\. Move it away"):
        FolderLock.acquire(tmp_path / "lock")
    path = tmp_path / "other"
    path.write_text(holder(host="h" * 10**5))
    with pytest.raises(InputError, match=r"on hhh.* \.\.\. h.* since noon\. Wait .* delete .*other and try again"):
        FolderLock.acquire(path)


def test_a_link_to_nothing_is_taken_away(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(_lock, "MIN_STALE_AGE", 0.1)
    (tmp_path / "lock").symlink_to(tmp_path / "nothing")
    FolderLock.acquire(tmp_path / "lock").release()


LONG_PLAN = ToyPlan(n_chunks=30, delay=0.3)


@pytest.mark.skipif(os.name == "nt", reason="there Ctrl-C goes to a whole group of processes")
@pytest.mark.parametrize("wait", [0.0, 0.2])
def test_an_interrupted_study_ends_soon(tmp_path: Path, wait: float) -> None:
    command = [sys.executable, toy_study.__file__, str(tmp_path), str(LONG_PLAN.n_chunks), str(LONG_PLAN.delay)]
    # A shell lets its background jobs ignore Ctrl-C, and so would the study's process.
    heed = functools.partial(signal.signal, signal.SIGINT, signal.SIG_DFL)
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True, preexec_fn=heed) as process:
        while not (tmp_path / "parts" / "part-00000.parquet").exists():
            time.sleep(0.01)
        time.sleep(wait)
        process.send_signal(signal.SIGINT)
        begin = time.monotonic()
        assert "KeyboardInterrupt" in process.communicate()[1]
    assert time.monotonic() - begin < 2.0  # all that are left would take 4.2 s
    assert not (tmp_path / "lock").exists()
    missing = StudyFolder.load(tmp_path).missing()
    assert 20 < len(missing) < 30
    assert sorted(run_study(str(tmp_path), ToyPlan(n_chunks=30))) == missing
    pd.testing.assert_frame_equal(StudyFolder.load(tmp_path).frame(), LONG_PLAN.whole())
