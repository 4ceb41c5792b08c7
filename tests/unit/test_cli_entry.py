"""The command line as a process: entry points, what it imports, and plain output."""

import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from typer.testing import CliRunner

import rockflex
from rockflex.cli import app

ROOT = Path(rockflex.__file__).parents[2]
HEAVY = ("matplotlib", "numba", "numpy", "pandas", "scipy")


def python(*arguments, **variables):
    environment = {**os.environ, "COLUMNS": "80", **variables}
    return subprocess.run(
        [sys.executable, *arguments], capture_output=True, text=True, encoding="utf-8", env=environment, check=False
    )


HELPS = [
    ["--help"],
    ["run", "--help"],
    ["modes", "-h"],
    ["motion", "-h"],
    ["cloud", "-h"],
    ["figures", "-h"],
    ["reproduce", "-h"],
    ["--version"],
]


@pytest.mark.parametrize("arguments", HELPS)
def test_help_imports_nothing_heavy(arguments):
    code = f"""
import sys
from rockflex.cli import main
sys.argv = ["rockflex", *{arguments!r}]
try:
    main()
except SystemExit as end:
    assert not end.code
print("\\nimported:", *[name for name in {HEAVY!r} if name in sys.modules])
"""
    done = python("-c", code)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[-1] == "imported:"


def test_module_and_version():
    done = python("-m", "rockflex", "--version")
    assert done.stdout == f"rockflex {rockflex.__version__}\n"
    assert done.returncode == 0


def test_entry_point_is_main():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    assert project["scripts"]["rockflex"] == "rockflex.cli:main"


@pytest.mark.parametrize(
    ("command", "words"),
    [
        ([], ["run", "modes", "motion", "Examples", "rockflex modes structure.toml", "Exit codes"]),
        (["run"], ["--free-vibration", "--strict", "Examples", "rockflex run structure.toml el-centro-1940"]),
        (["run"], ["--impact", "--restitution", "--yield-displacement", "(Eqs. 37-38)", "--friction 0.5"]),
        (["run"], ["2DOF-C-SI", "1DOF-fixed-BW", "rigid-C", "--initial-rotation"]),
        (["modes"], ["--modes", "--stiffness-ratio", "Examples", "rockflex modes structure.toml --modes 3 --json"]),
        (["motion"], ["--period", "Examples", "rockflex motion record.csv --units g --dt 0.01 --json"]),
    ],
)
def test_help_explains_and_gives_examples(command, words):
    result = CliRunner().invoke(app, [*command, "--help"], env={"COLUMNS": "100", "TERMINAL_WIDTH": "100"})
    assert result.exit_code == 0
    for word in words:
        assert word in result.stdout


def test_input_error_is_one_paragraph_without_traceback():
    done = python("-m", "rockflex", "modes", "nowhere.toml")
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.startswith("Error: The structure file nowhere.toml does not exist (working directory: ")
    assert len(done.stderr.splitlines()) == 1


def test_piped_output_has_no_escape_codes_and_no_bar(tmp_path):
    done = python("-m", "rockflex", "run", str(ROOT / "examples/structure_1.toml"), "el-centro-1940")
    assert done.returncode == 0
    assert "\x1b" not in done.stdout
    assert done.stderr == ""
    assert max(map(len, done.stdout.splitlines())) <= 80


def test_terminal_without_greek_letters():
    done = python("-m", "rockflex", "modes", str(ROOT / "examples/structure_1.toml"), PYTHONIOENCODING="ascii")
    assert done.returncode == 0
    assert "Total mass with the base" in done.stdout
    assert done.stdout.isascii()
