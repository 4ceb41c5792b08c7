"""Targets use the public front of the library and nothing behind it; the report knows no target."""

import ast
from pathlib import Path

import pytest

import rockflex
from rockflex.papers import silva_stojadinovic_2024 as paper

ROOT = Path(rockflex.__file__).parent


def imported(source):
    """Modules of ours that a source imports, wherever it does."""
    found = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            found.add("." * node.level + (node.module or ""))
    return {name for name in found if name.startswith((".", "rockflex"))}


def beyond(source, allowed):
    """What it imports of ours besides these modules and what is in them."""
    return {name for name in imported(source) if not any(name == a or name.startswith(f"{a}.") for a in allowed)}


ALLOWED = ("rockflex.papers", "rockflex.report", "rockflex._arrays")  # results are filled in, arrays only named
LIBRARY = ("population", "_equivalents")  # parts of the library that only the paper needs


def targets():
    """Modules of the papers that reproduce something, or help with it."""
    paths = sorted((ROOT / "papers").rglob("*.py"))
    return [path for path in paths if not any(part in (*path.parts, path.stem) for part in LIBRARY)]


@pytest.mark.parametrize("path", targets(), ids=lambda path: path.stem)
def test_papers_use_the_public_front_alone(path):
    others = imported(path.read_text("utf-8")) - {"rockflex"}
    assert {name for name in others if not name.startswith(ALLOWED)} == set()


@pytest.mark.parametrize("path", sorted((ROOT / "report").glob("*.py")), ids=lambda path: path.stem)
def test_the_report_of_the_paper_knows_figures_and_files(path):
    assert beyond(path.read_text("utf-8"), {"rockflex.report", "rockflex.plot", "rockflex._files"}) == set()


def test_the_walk_sees_what_is_forbidden():
    source = "import rockflex as rf\ndef f():\n    from rockflex.solve import Engine\n    from ..motion import x\n"
    assert imported(source) == {"rockflex", "rockflex.solve", "..motion"}
    assert beyond(source, {"rockflex.plot"}) == {"rockflex", "rockflex.solve", "..motion"}


def test_every_target_has_a_title_of_its_own():
    titles = [paper.title_of(target) for target in paper.TARGETS]
    assert len(set(titles)) == len(titles)
