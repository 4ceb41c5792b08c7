"""What is no file with an end is refused by every reader before it is opened."""

import os
import signal
import socket
from pathlib import Path

import pytest
from typer.testing import CliRunner

import rockflex as rf
from rockflex.cli._app import app
from rockflex.foundation.files import check_regular_file, irregular_file_kind
from toy_study import ToyPlan, opened, run_study

pytestmark = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes here")


@pytest.fixture(autouse=True)
def _no_reader_waits():
    """A reader that opened a pipe would wait for a writer who never comes."""

    def end(*_):
        message = "a reader waited for the other end of a pipe"
        raise TimeoutError(message)

    before = signal.signal(signal.SIGALRM, end)
    signal.alarm(20)
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)


def put(kind, path):
    if kind == "a pipe":
        os.mkfifo(path)
    elif kind == "a device":
        path.symlink_to("/dev/null")
    elif kind == "a folder":
        path.mkdir()
    return path


REMEDY = {
    "a folder": "Give a file in it.",
    "a pipe": "Write its content to a file, and give that.",
    "a device": "Write its content to a file, and give that.",
}


def stiff(path):
    return rf.from_matrices([1e4, 1e4], path, [3.0, 6.0], base_mass=1e4, half_width=1.0, damping_ratio=0.02)


READERS = {
    "r.at2": rf.read_at2,
    "r.csv": rf.read_motion,
    "s.toml": rf.read_structure,
    "study.toml": rf.load_study,
    "k.csv": stiff,
    "k.mtx": stiff,
    "k.npz": stiff,
    "run.npz": rf.Response.load,
}


@pytest.mark.parametrize("kind", REMEDY)
@pytest.mark.parametrize("name", READERS)
def test_every_reader_refuses_it(tmp_path, name, kind):
    path = put(kind, tmp_path / name)
    with pytest.raises(rf.InputError) as refused:
        READERS[name](path)
    expected = f"{path} is {kind}, but a regular file is expected. {REMEDY[kind]}"
    if READERS[name] is stiff:
        expected = f"stiffness: {expected}"
    if name.startswith("r.") and kind == "a folder":
        expected = f"{path} is a directory. Read all its records with read_suite({str(path)!r})."
    assert str(refused.value) == expected


@pytest.mark.parametrize("kind", REMEDY)
@pytest.mark.parametrize("name", ["manifest.json", "spec.json"])
def test_a_study_of_it_is_refused(tmp_path, name, kind):
    plan = ToyPlan(n_chunks=2)
    run_study(str(tmp_path), plan)
    (tmp_path / name).unlink()
    put(kind, tmp_path / name)
    message = rf"{name} is {kind}, but a regular file is expected\."
    with pytest.raises(rf.InputError, match=message):
        opened(str(tmp_path), plan)
    if name == "manifest.json":
        message = r"There is no study at .*: it has no manifest\.json"
    with pytest.raises(rf.InputError, match=message):
        rf.StudyFolder.load(tmp_path)


@pytest.mark.parametrize("kind", REMEDY)
def test_it_is_no_part_of_a_study(tmp_path, kind):
    run_study(str(tmp_path), ToyPlan(n_chunks=2))
    part = tmp_path / "parts" / "part-00001.parquet"
    part.unlink()
    put(kind, part)
    study = rf.StudyFolder.load(tmp_path)
    assert [str(each) for each in study.damaged()] == [f"{part}: it is {kind}"]
    with pytest.raises(rf.InputError, match=rf"part-00001\.parquet is damaged: it is {kind}\. Run the study again"):
        study.frame()


@pytest.mark.parametrize("given", [["run", "s.toml", "el-centro-1940"], ["modes", "s.toml"], ["motion", "s.csv"]])
def test_the_command_line_says_it_too(tmp_path, monkeypatch, given):
    monkeypatch.chdir(tmp_path)
    put("a pipe", tmp_path / given[1])
    done = CliRunner().invoke(app, given)
    assert done.exit_code == 2
    assert f"{given[1]} is a pipe, but a regular file is expected." in done.stderr.replace("\n", " ")


def test_results_replace_what_is_no_summary(tmp_path):
    """`--force` reads the summary of earlier results, to remove their files."""
    put("a pipe", tmp_path / "summary.json")
    assert CliRunner().invoke(app, ["motion", "el-centro-1940", "--out", str(tmp_path), "--force"]).exit_code == 0
    assert (tmp_path / "summary.json").is_file()


def test_a_socket_and_what_is_not_there(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with socket.socket(socket.AF_UNIX) as end:
        end.bind("s")  # a long path is none for a socket
        with pytest.raises(rf.InputError, match=r"^s is a socket, but a regular file is expected\. Write its content"):
            check_regular_file(Path("s"))
    assert irregular_file_kind(tmp_path / "none") == ""
    (tmp_path / "file").touch()
    (tmp_path / "link").symlink_to("file")
    assert irregular_file_kind(tmp_path / "link") == ""
