"""How pytest gives tests to its workers, and that a run ends although one of them dies."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

CONFTEST = Path(__file__).parents[1] / "conftest.py"
KILLS = "import os\ndef test_kills():\n    os._exit(1)\n"
PASSES = "def test_passes():\n    pass\n"
FILES = {
    "test_a.py": PASSES + KILLS + PASSES.replace("passes", "after") + PASSES.replace("passes", "later"),
    "test_b.py": PASSES + PASSES.replace("passes", "again"),
    "test_c.py": KILLS,
    "test_d.py": PASSES,
    "web/test_e.py": PASSES + PASSES.replace("passes", "again"),
    "web/test_f.py": PASSES,
}


@pytest.fixture(scope="module")
def reported(tmp_path_factory):
    """(outcome, worker) of each test, as pytest reports them."""
    folder = tmp_path_factory.mktemp("tests")
    (folder / "web").mkdir()
    for name, text in {"conftest.py": CONFTEST.read_text("utf-8"), **FILES}.items():
        (folder / name).write_text(text, "utf-8")
    options = ["-v", "-n", "2", "--dist", "loadgroup", "-p", "no:cacheprovider", "--rootdir", folder]
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST")}
    command = [sys.executable, "-m", "pytest", *options, folder]
    # The limit guards against a run that waits for ever.
    done = subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, timeout=120, check=False
    )
    lines = re.findall(r"^\[(gw\d+)\] .*(PASSED|FAILED) (\S+)", done.stdout, re.MULTILINE)
    assert done.returncode == pytest.ExitCode.TESTS_FAILED, done.stdout
    return [(test, outcome, worker) for worker, outcome, test in lines]


@pytest.mark.slow
def test_a_test_that_kills_its_worker_fails_once_and_all_others_run(reported):
    failed = sorted(test for test, outcome, _ in reported if outcome == "FAILED")
    passed = sorted(test for test, outcome, _ in reported if outcome == "PASSED")
    assert failed == ["test_a.py::test_kills", "test_c.py::test_kills"]
    assert passed == sorted(
        f"{file}::{test}"
        for file, text in FILES.items()
        for test in re.findall(r"def (\w+)", text)
        if test != "test_kills"
    )


@pytest.mark.slow
def test_the_tests_of_a_file_and_those_of_the_page_stay_on_one_worker(reported):
    for start in ("test_b.py", "web/"):
        assert len({worker for test, _, worker in reported if test.startswith(start)}) == 1
