"""What the targets of the Makefile install."""

import shutil
import subprocess
from pathlib import Path

import pytest

import rockflex

ROOT = Path(rockflex.__file__).parents[2]
pytestmark = pytest.mark.skipif(
    shutil.which("make") is None or not (ROOT / "Makefile").exists(), reason="needs make and the repository"
)


def commands(target, folder):
    """The commands that a target would run from a clean clone."""
    done = subprocess.run(
        ["make", "--dry-run", target, f"VENV={folder / 'none'}"], cwd=ROOT, capture_output=True, text=True, check=True
    )
    return [line for line in done.stdout.splitlines() if "pip install" in line]


def test_running_needs_no_test_tools(tmp_path):
    for target in ("demo", "figures"):
        (install,) = commands(target, tmp_path)
        assert install.endswith("--editable .")


def test_testing_adds_its_tools_to_the_same_environment(tmp_path):
    first, second = commands("test", tmp_path)
    assert first.endswith("--editable .")
    assert second.endswith("--editable '.[dev]'")
