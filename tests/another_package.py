"""Another package by the name of rockflex, in place of the one under test."""

import os
from pathlib import Path

import rockflex


def environment(folder: Path) -> dict[str, str]:
    """Variables with which Python takes the one in a folder, also where rockflex is installed in editable form."""
    builds = (Path(rockflex.__file__).parents[2] / "build").glob("cp*")
    skipped = filter(None, (*map(str, builds), os.environ.get("MESONPY_EDITABLE_SKIP")))
    return {"PYTHONPATH": str(folder), "MESONPY_EDITABLE_SKIP": os.pathsep.join(skipped)}
