"""Versions of what is installed, and commits of what is in a Git repository."""

import os
import platform
import subprocess
from collections.abc import Iterable
from importlib import metadata
from pathlib import Path
from typing import Any

# Programs of the repository that compare files; files that they change, such as those of LFS, may count as changed.
FILTERS = r"^filter\..*\.(clean|process|required)$"
PATIENCE = 5.0  # s that Git may take
CHANGES = "+changes"


def package_versions(packages: Iterable[str]) -> dict[str, str]:
    """Return the version of Python and of each package; "none" for a package that is not installed."""
    found = {"python": platform.python_version()}
    for name in packages:
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            found[name] = "none"
    return found


def git_commit(file: Path, *, known: bool) -> str | None:
    """Return the commit of the Git repository that a file is in, with "+changes" if files differ from it.

    Parameters
    ----------
    file
        The file.
    known
        Whether Git must know the file: an installation below a repository of something else is no part of it. A file
        that need not be known, and is not, counts as a change.

    Returns
    -------
    str or None
        Twelve digits, perhaps with "+changes"; None without Git, a repository or a commit.
    """
    folder = file.resolve().parent
    tracked = _git_output(folder, "--literal-pathspecs", "ls-files", "--error-unmatch", "--", file.name) is not None
    commit = _git_output(folder, "rev-parse", "--short=12", "HEAD") if tracked or not known else None
    if not commit:
        return None
    names = _git_output(folder, "config", "--name-only", "--get-regexp", FILTERS) or ""
    off = [part for name in names.split() for part in ("-c", f"{name}=")]
    changed = _git_output(folder, *off, "status", "--porcelain", "--untracked-files=no")
    return f"{commit}{CHANGES}" if changed or not tracked else commit


def _git_output(folder: Path, *arguments: str) -> str | None:
    """Return what Git answers; None if it cannot. It locks nothing, and starts no program of the repository."""
    settings = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
    how: dict[str, Any] = {"cwd": folder, "env": settings | {"GIT_OPTIONAL_LOCKS": "0"}, "timeout": PATIENCE}
    try:
        command = ["git", "-c", "core.fsmonitor=false", *arguments]
        done = subprocess.run(command, capture_output=True, check=True, stdin=subprocess.DEVNULL, **how)
    except (OSError, subprocess.SubprocessError):
        return None
    return done.stdout.decode("utf-8", "replace").strip()
