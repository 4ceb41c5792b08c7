"""One process at a time in a study's folder, and Ctrl-C."""

import functools
import gc
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
from rockflex.studies.folders import StudyFolder, _lock
from rockflex.studies.folders._lock import lock_holder, locked_folder
from toy_study import ToyPlan, opened, run_study

PLAN = ToyPlan(n_chunks=2)


def lock_of(pid: int, host: str = platform.node()) -> str:
    return f"{pid}\n{host}\n"


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


@pytest.mark.slow
def test_the_lock_goes_with_its_object(tmp_path: Path) -> None:
    study = opened(str(tmp_path), PLAN)
    assert (tmp_path / "lock").exists()
    del study
    gc.collect()
    assert not (tmp_path / "lock").exists()


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork")
def test_a_forked_child_does_not_take_the_lock_along(tmp_path: Path) -> None:
    program = (
        "import os, sys\nfrom pathlib import Path\nfrom rockflex.studies.folders._lock import *\n"
        "lock = locked_folder(Path(sys.argv[1]))\npid = os.fork()\n"
        "if not pid:\n    lock.release(); os._exit(0)\n"
        "os.waitpid(pid, 0); check_folder_locked(lock); print('held')"
    )
    done = subprocess.run(
        [sys.executable, "-c", program, str(tmp_path / "lock")], capture_output=True, text=True, check=True
    )
    assert done.stdout == "held\n"
    assert not (tmp_path / "lock").exists()  # the parent's end has released it


def test_the_lock_of_a_dead_process_is_taken_over(tmp_path: Path) -> None:
    path = tmp_path / "lock"
    path.write_text(lock_of(dead_pid()))
    assert lock_holder(path) is None
    locked_folder(path).release()
    assert list(tmp_path.iterdir()) == []


def test_the_lock_of_another_host_stands(tmp_path: Path) -> None:
    path = tmp_path / "lock"
    path.write_text(lock_of(dead_pid(), "elsewhere"))
    with pytest.raises(InputError, match=r"on elsewhere since .*\. Wait .* If it no longer runs, delete"):
        locked_folder(path)
    path.write_text(lock_of(dead_pid(), "h" * 500))
    with pytest.raises(InputError, match=r"on hhh.* \.\.\. h.* since"):
        locked_folder(path)


@pytest.mark.parametrize("content", ["", "{", "12", "{ours}", "{ours}\nhalf a na", "\0" * 40, "0\nhost\n"])
def test_a_lock_without_a_name_is_taken_over_at_once(tmp_path: Path, content: str) -> None:
    (tmp_path / "lock").write_text(
        content.replace("{ours}", f"{os.getpid()}")
    )  # of a process that was killed before it could write
    begin = time.monotonic()
    with opened(str(tmp_path), PLAN) as study:
        assert lock_holder(tmp_path / "lock").startswith(f"process {os.getpid()} on ")
        study.write(0, PLAN.chunk(0))
    assert time.monotonic() - begin < 1.0
    assert not (tmp_path / "lock").exists()


def test_the_number_of_a_dead_process_may_be_that_of_another_one(tmp_path: Path) -> None:
    path = tmp_path / "lock"
    path.write_text(lock_of(os.getpid()))  # of a container, whose first process has the number 1 each time
    assert lock_holder(path) is None
    locked_folder(path).release()


def test_a_lock_that_lost_its_name_is_not_taken_from_a_process_that_runs(tmp_path: Path) -> None:
    with opened(str(tmp_path), PLAN) as study:
        os.truncate(tmp_path / "lock", 0)
        with pytest.raises(InputError, match="in use by a process that left no name"):
            opened(str(tmp_path), PLAN)
        study.write(0, PLAN.chunk(0))


def test_without_locks_of_the_system_a_file_without_a_name_is_given_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(_lock, "_lock_file", lambda *_, **__: None)
    path = tmp_path / "lock"
    path.touch()
    with pytest.raises(InputError, match=r"no name .* taken over 60 s after its last change"):
        locked_folder(path)
    os.utime(path, (time.time() - 70.0,) * 2)
    locked_folder(path).release()
    path.write_text(lock_of(os.getpid()))
    with pytest.raises(InputError, match=f"in use by process {os.getpid()} on"):
        locked_folder(path)
    path.write_text(lock_of(dead_pid()))
    locked_folder(path).release()


def test_without_hard_links_a_lock_is_made_as_well(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*_: object) -> None:
        raise OSError(95, "Operation not supported")

    monkeypatch.setattr(os, "link", refused)
    with opened(str(tmp_path), PLAN), pytest.raises(InputError, match=f"in use by process {os.getpid()} on"):
        opened(str(tmp_path), PLAN)
    assert not (tmp_path / "lock").exists()


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork")
def test_a_killed_process_leaves_a_named_lock_or_none(tmp_path: Path) -> None:
    """At every system call of the taking: the next process gets the folder, and no temporary file stays."""
    program = (
        "import os, sys, signal\nfrom pathlib import Path\nfrom rockflex.studies.folders._lock import locked_folder\n"
        "left = int(sys.argv[2])\n"
        "def count(event, _):\n"
        "    global left\n"
        "    if event in ('open', 'os.link', 'os.remove', 'fcntl.flock'):\n"
        "        left -= 1\n"
        "        if left < 0: os.kill(os.getpid(), signal.SIGKILL)\n"
        "sys.addaudithook(count)\nlocked_folder(Path(sys.argv[1]))\nos._exit(0)"
    )
    path = tmp_path / "lock"
    codes: list[int] = []
    for calls in range(7):
        done = subprocess.run([sys.executable, "-c", program, str(path), str(calls)], check=False)
        codes.append(done.returncode)
        assert not path.exists() or path.read_text() != ""
        locked_folder(path).release()
        assert list(tmp_path.iterdir()) == []
    assert set(codes) == {-signal.SIGKILL, 0}


@pytest.mark.slow
def test_of_many_that_find_a_dead_lock_one_gets_it(tmp_path: Path) -> None:
    path = tmp_path / "lock"
    path.write_text(lock_of(dead_pid()))
    program = (
        "import sys, time\nfrom pathlib import Path\nfrom rockflex.studies.folders._lock import *\n"
        "from rockflex import InputError\nsys.stdin.readline()\n"
        "try:\n    lock = locked_folder(Path(sys.argv[1]))\n    print('mine', flush=True)\n"
        "    sys.stdin.readline(); check_folder_locked(lock)\n"
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


def test_what_is_no_lock_is_not_taken_away(tmp_path: Path) -> None:
    (tmp_path / "lock").mkdir()
    with pytest.raises(InputError, match="lock is not a file"):
        locked_folder(tmp_path / "lock")


LONG_PLAN = ToyPlan(n_chunks=30, delay=0.3)


@pytest.mark.slow
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
