"""Compiled kernels on disk are tied to all sources that hold kernels, not to their own file alone."""

import os
import subprocess
import sys
from pathlib import Path

import rockflex
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
    environment = {**os.environ, "PYTHONPATH": str(tmp_path), "NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    done = subprocess.run([sys.executable, "-c", command], env=environment, capture_output=True, text=True, check=True)
    assert done.stdout.strip() != sources_digest()
