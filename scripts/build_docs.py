"""Build the documentation in build/docs; warnings are errors.

What is computed, the reproduction of the paper, the examples and the drawings, is kept while the code and data behind
it are the same: a hash of both stands beside it. `--fresh` computes everything anew.
"""

import argparse
import shutil
import subprocess
import sys
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from hashlib import sha256
from importlib.metadata import version
from pathlib import Path

ROOT = Path(__file__).parents[1]
DOCS, PACKAGE = ROOT / "docs", ROOT / "src" / "rockflex"
ABOVE = {"web", "cli"}  # nothing computed depends on these layers, but for the command that reproduces
REPRODUCE = sorted([*(PACKAGE / "cli").glob("_reproduc*.py"), PACKAGE / "cli" / "_kept_work.py"])
LIBRARIES = "numpy", "scipy", "pandas", "matplotlib", "statsmodels"
STAMP = "inputs.sha256"


def package_files() -> Iterator[Path]:
    """Yield the code and data of the layers that compute."""
    for file in sorted(PACKAGE.rglob("*")):
        place = file.relative_to(PACKAGE).parts
        if file.is_file() and place[0] not in ABOVE and "__pycache__" not in place and file.suffix != ".so":
            yield file


def fingerprint(files: Iterable[Path]) -> str:
    """Return a hash of the names and contents of files, and of the versions that run them."""
    found = sha256(" ".join([sys.version, *map(version, LIBRARIES)]).encode())
    for file in files:
        found.update(str(file.relative_to(ROOT)).encode() + b"\0" + file.read_bytes())
    return found.hexdigest()


def is_kept(folder: Path, mark: str) -> bool:
    """Tell whether a folder was finished with the same inputs; otherwise remove it."""
    stamp = folder / STAMP
    if stamp.is_file() and stamp.read_text("utf-8") == mark:
        return True
    shutil.rmtree(folder, ignore_errors=True)
    return False


@contextmanager
def timed(part: str) -> Iterator[None]:
    """Print how long a part took."""
    start = time.monotonic()
    yield
    print(f"{part}: {time.monotonic() - start:.0f} s", flush=True)


def main() -> int:
    """Reproduce the paper and run the examples if need be, and write the pages."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--fresh", action="store_true", help="keep nothing that was computed before")
    parser.add_argument("--builder", default="html", help="of Sphinx: html, linkcheck; default: html")
    given = parser.parse_args()
    code = list(package_files())
    reproduced, examples = DOCS / "reproduced", DOCS / "gallery"
    mark = "" if given.fresh else fingerprint([*code, *REPRODUCE])
    if not is_kept(reproduced, mark):
        with timed("reproduction"):
            subprocess.run([sys.executable, "-m", "rockflex", "reproduce", "--out", reproduced], check=True)
        (reproduced / STAMP).write_text(fingerprint([*code, *REPRODUCE]), "utf-8")
    mark = fingerprint([*code, *sorted((DOCS / "_extensions").glob("*.py"))])
    if not is_kept(examples, "" if given.fresh else mark):
        shutil.rmtree(DOCS / "_drawings", ignore_errors=True)
    shutil.rmtree(DOCS / "api" / "generated", ignore_errors=True)
    target = ROOT / "build" / ("docs" if given.builder == "html" else given.builder)
    strict = "-W", "--keep-going", "-n", "-E", "-q", "-j", "auto"
    command = [sys.executable, "-m", "sphinx", *strict, "-b", given.builder, DOCS, target]
    with timed("pages"):
        done = subprocess.run(command, check=False).returncode
    if done == 0:
        (examples / STAMP).write_text(mark, "utf-8")
    return done


if __name__ == "__main__":
    sys.exit(main())
