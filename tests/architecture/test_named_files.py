"""Source files that the notes, docs/architecture.md, docs/nomenclature.md and CONTRIBUTING.md name are there."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = [
    *sorted((ROOT / "docs" / "design").glob("*.md")),
    ROOT / "docs" / "architecture.md",
    ROOT / "docs" / "nomenclature.md",
    ROOT / "CONTRIBUTING.md",
]
PLACES = ROOT, ROOT / "src" / "rockflex", ROOT / "src" / "rockflex" / "web"
NAMED = re.compile(r"`((?:[\w.-]+/)*[\w.-]+\.(?:py|pyi|pxd|c|h|js|css|sh|toml|build|jinja))`")


def missing(text: str) -> list[str]:
    """The files in backticks that are in none of the places."""
    return [name for name in NAMED.findall(text) if not any((place / name).is_file() for place in PLACES)]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_files_that_a_page_names_exist(page):
    assert missing(page.read_text("utf-8")) == []


def test_a_file_that_is_gone_is_seen():
    assert missing("`engine/run.py`, `models/_phase.py:12` and `models/_gone.py`, `march_gone.c`") == [
        "models/_gone.py",
        "march_gone.c",
    ]
