"""Compiled kernels on disk: tied to all sources that hold kernels, and compiled anew where a file is not intact."""

import errno
import os
import subprocess
import sys
from pathlib import Path

import numba
import numpy as np
import pytest

import another_package
import rockflex
from rockflex import _numba
from rockflex._kernel import sources_digest


def test_an_edited_callee_changes_the_stamp(tmp_path: Path) -> None:
    package = tmp_path / "rockflex"
    source = Path(rockflex.__file__).parent
    for path in source.rglob("*.py*"):
        if path.suffix in (".py", ".pyi"):
            target = package / path.relative_to(source)
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(path.read_bytes())
    callee = package / "solve" / "exact" / "series.py"
    callee.write_text(callee.read_text() + "\n# edited\n")
    command = "from rockflex._kernel import sources_digest; print(sources_digest())"
    environment = {**os.environ, **another_package.environment(tmp_path), "NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    done = subprocess.run([sys.executable, "-c", command], env=environment, capture_output=True, text=True, check=True)
    assert done.stdout.strip() != sources_digest()


@pytest.fixture
def folder(monkeypatch, tmp_path):
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))
    return tmp_path


def total(x):
    sums = 0.0
    for i in range(x.size):
        sums += PART(x[i])
    return sums


PART = _numba.compiled_within(lambda value: 2.0 * value, inlined=True)
CONTIGUOUS, STRIDED = np.arange(3.0), np.arange(6.0)[::2]


def loaded(x, stamp="stamp"):
    """The answer of a new process, and whether it found the kernel on disk."""
    kernel = _numba.compiled(total, stamp)
    answer = kernel(x)
    return answer, sum(kernel.stats.cache_hits.values()) == 1


def only(folder, pattern):
    (found,) = folder.rglob(pattern)
    return found


CACHED = pytest.mark.skipif(not _numba.KNOWN, reason="kernels are not cached with this numba")


@CACHED
@pytest.mark.parametrize("left", [0.0, 0.1, 0.5, 0.99])
@pytest.mark.parametrize("file", ["*.nbi", "*.nbc"])
def test_a_file_that_was_cut_short_is_replaced(folder, file, left):
    """As by a full disk, or a computer that lost its power."""
    assert loaded(CONTIGUOUS) == (6.0, False)
    assert loaded(CONTIGUOUS) == (6.0, True)
    cut = only(folder, file)
    cut.write_bytes(cut.read_bytes()[: int(left * cut.stat().st_size)])
    assert loaded(CONTIGUOUS) == (6.0, False)
    assert loaded(CONTIGUOUS) == (6.0, True)


@CACHED
def test_code_of_earlier_sources_is_not_used(monkeypatch, folder):
    """numba saves the index first: a process that is killed then leaves the code of the version before."""
    loaded(CONTIGUOUS, "earlier")
    code = only(folder, "*.nbc").read_bytes()
    monkeypatch.setattr(sys.modules[__name__], "PART", _numba.compiled_within(lambda value: 3.0 * value, inlined=True))
    assert loaded(CONTIGUOUS, "now") == (9.0, False)
    only(folder, "*.nbc").write_bytes(code)
    assert loaded(CONTIGUOUS, "now") == (9.0, False)
    assert loaded(CONTIGUOUS, "now") == (9.0, True)


@CACHED
def test_code_for_other_types_is_not_used(folder):
    """Two processes that compile for different types at once may give their code the same number."""
    loaded(CONTIGUOUS)
    first = only(folder, "*.nbc")
    assert loaded(STRIDED) == (12.0, False)
    (second,) = set(folder.rglob("*.nbc")) - {first}
    second.write_bytes(first.read_bytes())
    assert loaded(STRIDED) == (12.0, False)
    assert loaded(STRIDED) == loaded(STRIDED.copy()) == (12.0, True)


@CACHED
@pytest.mark.parametrize("damaged", [False, True])
def test_kernels_run_where_the_disk_is_full(monkeypatch, folder, damaged):
    loaded(CONTIGUOUS)
    index = only(folder, "*.nbi")
    if damaged:
        index.write_bytes(b"")
    kernel = _numba.compiled(total, "stamp")

    def full(_path):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(kernel._cache._cache_file, "_open_for_write", full)
    assert kernel(STRIDED) == 12.0
