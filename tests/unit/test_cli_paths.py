"""Every command with paths that cannot be used, and with an output that cannot be written: a message, no traceback."""

import builtins
import io
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from builders import frame_values
from rockflex.cli._app import main

FRAME = "\n".join(f"{name} = {value}" for name, value in frame_values(n_stories=2).items())
STRUCTURE = f"[frame]\n{FRAME}\n"
STUDY = f"""
study = "cloud"
models = ["2DOF-S"]
records.suites = ["el-centro-1940"]
[[structures]]
name = "A"
[structures.frame]
{FRAME}
"""
EC8 = ("--target", "ec8:ag=0.25g,ground=C", "--count", "3", "--periods", "0.2,2")
RUN = ("good.toml", "el-centro-1940", "--model", "2DOF-S")

# Arguments for a path; its suffix; and whether the command works long enough to be slow.
COMMANDS: dict[str, tuple[Callable[[str], list[str]], str, bool]] = {
    "run": (lambda path: ["run", path, "el-centro-1940"], ".toml", False),
    "run MOTION": (lambda path: ["run", "good.toml", path], ".AT2", False),
    "run --out": (lambda path: ["run", *RUN, "--out", path], "", True),
    "run --report": (lambda path: ["run", *RUN, "--report", path], ".html", True),
    "check": (lambda path: ["check", path, "el-centro-1940"], ".toml", False),
    "check MOTION": (lambda path: ["check", "good.toml", path], ".csv", False),
    "check --limits": (lambda path: ["check", *RUN, "--limits", path], ".toml", False),
    "compare": (lambda path: ["compare", path, "good.toml", "el-centro-1940"], ".toml", False),
    "compare --report": (
        lambda path: ["compare", "good.toml", "good.toml", "el-centro-1940", "--report", path],
        ".html",
        True,
    ),
    "project new": (lambda path: ["project", "new", path, "good.toml", "el-centro-1940"], ".rockflex", False),
    "project new A": (lambda path: ["project", "new", "new.rockflex", path, "el-centro-1940"], ".toml", False),
    "project run": (lambda path: ["project", "run", path], ".rockflex", False),
    "project report": (lambda path: ["project", "report", path, "out.html"], ".rockflex", False),
    "project show": (lambda path: ["project", "show", path], ".rockflex", False),
    "animate": (lambda path: ["animate", path, "el-centro-1940"], ".toml", False),
    "animate --out": (lambda path: ["animate", *RUN, "--out", path], ".txt", True),
    "modes": (lambda path: ["modes", path], ".toml", False),
    "modes --out": (lambda path: ["modes", "good.toml", "--out", path], "", True),
    "motion": (lambda path: ["motion", path], ".smc", False),
    "motion --out": (lambda path: ["motion", "el-centro-1940", "--out", path], "", True),
    "survey": (lambda path: ["survey", path], ".AT2", False),
    "select": (lambda path: ["select", path, *EC8], ".csv", False),
    "select --target": (lambda path: ["select", "fema-p695-far-field", "--target", path, *EC8[2:]], ".csv", True),
    "select --records": (lambda path: ["select", "fema-p695-far-field", *EC8, "--records", path], "", True),
    "cloud": (lambda path: ["cloud", path], ".toml", False),
    "cloud --out": (lambda path: ["cloud", "study.toml", "--out", path], "", True),
    "figures": (lambda path: ["figures", path], "", False),
    "figures --out": (lambda path: ["figures", "kept", "--out", path], "", True),
    "reproduce --out": (lambda path: ["reproduce", "no-such-target", "--out", path], "", False),
}
WRITING = {name for name in COMMANDS if name.split()[-1] in ("--out", "--report", "--records", "new")}
READING = set(COMMANDS) - WRITING
MAY_WORK: dict[str, set[str]] = {
    "in a locked folder": set(),
    "under a file": set(),
    "too long": set(),
    "missing": WRITING,
    "folder": {"cloud --out"},
    "unreadable": {"survey", "project new"},
    "in a circle": {"survey", *WRITING},
    "not UTF-8": set(COMMANDS),
}
PATHS = (
    "missing",
    "folder",
    "unreadable",
    "in a locked folder",
    "under a file",
    "too long",
    "not UTF-8",
    "in a circle",
)


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "good.toml").write_text(STRUCTURE)
    (tmp_path / "study.toml").write_text(STUDY)
    return tmp_path


def path_of_kind(kind: str, command: str, place: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    suffix = COMMANDS[command][1]
    name = f"caf{suffix}"
    path = place / {"in a locked folder": "locked", "under a file": "good.toml"}.get(kind, "") / name
    if kind == "folder":
        path.mkdir()
        (path / "other.bin").touch()
    elif kind == "unreadable":
        path.write_text("x")
        deny(lambda given: given.endswith(f"/{name}") or given == name, ("open",), monkeypatch)
    elif kind == "in a locked folder":
        path.parent.mkdir()
        deny(lambda given: "locked" in given, ("stat", "lstat", "open", "scandir", "listdir", "mkdir"), monkeypatch)
    elif kind == "too long":
        return "n" * 300 + suffix
    elif kind == "not UTF-8":
        odd = os.fsdecode(os.fsencode(place) + b"/caf\xe9" + suffix.encode())
        if suffix == ".toml":
            Path(odd).write_text(STUDY if command == "cloud" else STRUCTURE)
        elif command in READING and suffix:
            Path(odd).write_text("0.0 1.0\n")
        return odd
    elif kind == "in a circle":
        path.symlink_to(path)
    return str(path)


def deny(forbidden: Callable[[str], bool], calls: tuple[str, ...], monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the system refuse some paths; rights alone do not stop the superuser."""
    for module, name in [*((os, each) for each in calls), (io, "open"), (builtins, "open")]:
        real = getattr(module, name)

        def call(path, *rest, _real=real, **named):
            if isinstance(path, str | os.PathLike) and forbidden(os.fspath(path)):
                raise PermissionError(13, "Permission denied", os.fspath(path))
            return _real(path, *rest, **named)

        monkeypatch.setattr(module, name, call)


def run_main(arguments: list[str], monkeypatch: pytest.MonkeyPatch, stdout: io.TextIOWrapper | None = None):
    """Return exit code and stderr of the command line; every exception but SystemExit passes."""
    stderr = io.TextIOWrapper(io.BytesIO(), "utf-8")
    with monkeypatch.context() as patch:
        patch.setattr(sys, "argv", ["rockflex", *arguments])
        patch.setattr(sys, "stdout", stdout or io.TextIOWrapper(io.BytesIO(), "utf-8"))
        patch.setattr(sys, "stderr", stderr)
        with pytest.raises(SystemExit) as stop:
            main()
        stderr.flush()
    return stop.value.code or 0, stderr.buffer.getvalue().decode("utf-8")


@pytest.mark.skipif(os.name == "nt", reason="names are of another kind there")
@pytest.mark.parametrize("kind", MAY_WORK)
@pytest.mark.parametrize(
    "command", [pytest.param(name, marks=[pytest.mark.slow] * slow) for name, (_, _, slow) in COMMANDS.items()]
)
def test_a_path_that_cannot_be_used_is_told(command, kind, place, monkeypatch):
    arguments = COMMANDS[command][0]
    if command.startswith("figures --out"):
        assert run_main(["cloud", "study.toml", "--out", "kept"], monkeypatch)[0] == 0
    path = path_of_kind(kind, command, place, monkeypatch)
    code, stderr = run_main(arguments(path), monkeypatch)
    assert "Traceback" not in stderr
    if code == 0:  # new files, files in a folder that has others, and readable ones with an odd name
        assert command in MAY_WORK[kind]
        return
    assert code == 2
    assert sum(line.startswith("Error: ") for line in stderr.splitlines()) == 1
    assert max(map(len, stderr.splitlines())) < 2500


FULL = Path("/dev/full")
PRINTING = (
    ["modes", "good.toml"],
    ["modes", "good.toml", "--json"],
    ["motion"],
    ["run", "--help"],
    ["reproduce", "--list"],
)


@pytest.mark.skipif(not FULL.exists(), reason="there is no full device")
@pytest.mark.parametrize("arguments", PRINTING)
def test_a_full_disk_behind_the_output_is_told(arguments, place, monkeypatch):
    with FULL.open("w", encoding="utf-8") as stdout:
        code, stderr = run_main(arguments, monkeypatch, stdout)
    assert code == 2
    assert stderr.startswith("Error: ")
    assert "No space left on device" in stderr


@pytest.mark.slow
@pytest.mark.skipif(not FULL.exists(), reason="there is no full device")
@pytest.mark.parametrize("redirect", [">/dev/full", ">&-", "| true"])
@pytest.mark.parametrize("arguments", ["modes good.toml", "modes good.toml --json"])
def test_an_output_that_takes_nothing_ends_without_a_traceback(arguments, redirect, place):
    line = f"{sys.executable} -m rockflex {arguments} {redirect}"
    done = subprocess.run(["bash", "-c", line], capture_output=True, text=True, check=False)
    assert "Traceback" not in done.stderr
    assert "Exception ignored" not in done.stderr
    assert done.returncode == (2 if "full" in redirect else 0)


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="there Ctrl-C goes to a whole group of processes")
@pytest.mark.parametrize("module", ["typer", "rockflex.cli", "numpy", "rockflex.structure"])
def test_ctrl_c_during_imports_ends_without_a_traceback(module, place):
    program = (
        "import sys\n"
        "class Stop:\n"
        f"    def find_spec(self, name, *_):\n        if name == {module!r}: raise KeyboardInterrupt\n"
        "sys.meta_path.insert(0, Stop())\nsys.argv = ['rockflex', 'modes', 'good.toml']\n"
        "from rockflex.__main__ import main\nmain()"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert done.returncode == 130
    assert done.stderr == "Stopped; nothing was written.\n"


@pytest.mark.slow
def test_vector_instructions_that_are_not_there_are_told(place):
    environment = os.environ | {"ROCKFLEX_SIMD": "v9"}
    command = [sys.executable, "-m", "rockflex", "motion", "el-centro-1940"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=environment)
    assert done.returncode == 2
    assert done.stderr.startswith("Error: ROCKFLEX_SIMD='v9' is not a level")
