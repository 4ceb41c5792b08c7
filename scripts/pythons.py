"""Print the Pythons of this machine that the package can be compiled for, newest first; missing ones to stderr.

Looked for on the path and among the versions of pyenv. A Python counts if it runs, has venv and has its headers.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

SUPPORTED = ("3.14", "3.13", "3.12", "3.11")
USABLE = (
    "import ensurepip, os, sys, sysconfig; os.stat(os.path.join(sysconfig.get_path('include'), 'Python.h'));"
    "print('%d.%d' % sys.version_info[:2])"
)


def candidates(version: str) -> list[str]:
    """Return where a version may be; what is on the path comes first."""
    pyenv = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv")) / "versions"
    names = [f"python{version}", "python3"]
    return [found for name in names if (found := shutil.which(name))] + [
        str(folder / "bin" / "python3") for folder in sorted(pyenv.glob(f"{version}.*"), reverse=True)
    ]


def is_usable(python: str, version: str) -> bool:
    """Tell whether a command is a Python of this version that the package can be compiled for."""
    done = subprocess.run([python, "-c", USABLE], capture_output=True, text=True, check=False)
    return done.returncode == 0 and done.stdout.strip() == version


def usable_pythons() -> dict[str, str]:
    """Return the command of each supported version that was found, newest first."""
    found: dict[str, str] = {}
    for version in SUPPORTED:
        for python in candidates(version):
            if is_usable(python, version):
                found[version] = python
                break
    return found


if __name__ == "__main__":
    pythons = usable_pythons()
    missing = [version for version in SUPPORTED if version not in pythons]
    if missing:
        print(f"Not found, or without venv or headers: Python {', '.join(missing)}", file=sys.stderr)
    print(*pythons.values(), sep="\n")
