"""What the targets of the Makefile install."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

import rockflex

ROOT = Path(rockflex.__file__).parents[2]
pytestmark = pytest.mark.skipif(
    shutil.which("make") is None or not (ROOT / "Makefile").exists(), reason="needs make and the repository"
)


def planned(target, folder, path=os.environ["PATH"]):
    """The lines that a target would run from a clean clone, also if make runs these tests."""
    command = [shutil.which("make"), "--dry-run", target, f"VENV={folder / 'none'}"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True, env={"PATH": path})
    return done.stdout.splitlines()


def commands(target, folder):
    return [line for line in planned(target, folder) if "--editable" in line]


def test_running_needs_no_test_tools(tmp_path):
    for target in ("demo", "figures"):
        (install,) = commands(target, tmp_path)
        assert install.endswith("--editable .")


def test_each_step_of_the_first_call_is_told(tmp_path):
    lines = planned("demo", tmp_path)
    assert lines[0].startswith("echo ")
    told = [k for k, line in enumerate(lines) if line.startswith("echo ")]
    for before, step in zip(told, ("-m venv", " uv &&", "--editable", "demo.py"), strict=True):
        following = next((k for k in told if k > before), len(lines))
        assert any(step in line for line in lines[before + 1 : following])


def test_testing_adds_its_tools_to_the_same_environment(tmp_path):
    first, second = commands("test", tmp_path)
    assert first.endswith("--editable .")
    assert second.endswith("--editable '.[dev]'")


def test_without_a_compiler_that_of_a_package_is_fetched(tmp_path):
    tools = tmp_path / "tools"
    tools.mkdir()
    for name in ("make", "sh"):
        (tools / name).symlink_to(str(shutil.which(name)))
    lines = planned("demo", tmp_path, str(tools))
    assert any("pip install" in line and line.endswith(" ziglang") for line in lines)


def test_validation_keeps_what_other_programs_need_apart(tmp_path):
    lines = planned("validate", tmp_path)
    lean = [line for line in lines if "pip install" in line and "none-risk" in line]
    assert [line.split(maxsplit=6)[-1] for line in lean] == [
        "--no-compile '.[risk]'",
        "--no-compile --no-deps openquake.engine",
    ]
    for program in ("opensees", "openquake", "pelicun"):
        assert any(line.endswith(f"python validation/{program}/run.py") for line in lines)
