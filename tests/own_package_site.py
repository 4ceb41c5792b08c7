"""The package of tests/own_package, installed in a folder, and programs that run with it."""

import os
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

SOURCE = Path(__file__).parent / "own_package"


def install(folder: Path) -> None:
    """Do what an installer does: copy the package, and write what it says of itself."""
    said = tomllib.loads((SOURCE / "pyproject.toml").read_text("utf-8"))
    for package in said["tool"]["setuptools"]["packages"]:
        shutil.copytree(SOURCE / package, folder / package, ignore=shutil.ignore_patterns("__pycache__"))
    name, version = said["project"]["name"], said["project"]["version"]
    about = folder / f"{name.replace('-', '_')}-{version}.dist-info"
    about.mkdir()
    (about / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n", "utf-8")
    lines = [
        line
        for group, entries in said["project"]["entry-points"].items()
        for line in (f"[{group}]", *(f"{key} = {value}" for key, value in entries.items()))
    ]
    (about / "entry_points.txt").write_text("\n".join(lines), "utf-8")


def path_with(*folders: Path) -> str:
    """The search path for modules with more folders in front."""
    return os.pathsep.join(filter(None, (*map(str, folders), os.environ.get("PYTHONPATH"))))


def run(folder: Path, *arguments: str, site: Path | None = None, fails: bool = False) -> str:
    """What a program of Python prints in a folder, where a package of `site` is installed."""
    environment = os.environ | {"PYTHONPATH": path_with(*([] if site is None else [site]))}
    done = subprocess.run(
        [sys.executable, "-W", "error", *arguments], cwd=folder, env=environment, capture_output=True, text=True,
        encoding="utf-8", check=False,
    )  # fmt: skip
    assert (done.returncode != 0) == fails, done.stdout + done.stderr
    return done.stdout + done.stderr
