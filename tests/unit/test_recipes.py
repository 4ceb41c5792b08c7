"""The recipes of CONTRIBUTING.md: their code runs and prints what it says, and their files hold what they name.

Blocks that begin with a path are put into that file of a copy of the package, where the element and the format of
records that they define are then used.
"""

import re
import shutil
import sys
from pathlib import Path

import pytest

import rockflex
from doc_blocks import Block, blocks_of, run_blocks
from own_package_site import path_with, run
from rockflex.fragility import LIMIT_STATES
from rockflex.motion import FORMATS, MEASURES
from rockflex.studies._study_kind import KINDS

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "CONTRIBUTING.md").read_text("utf-8").partition("## Recipes")[2]
RECIPES = dict(re.findall(r"^### (.*?)\n(.*?)(?=^### |\Z)", TEXT, re.MULTILINE | re.DOTALL))
PLACES = ROOT, ROOT / "src" / "rockflex"
IN_FILE = re.compile(r"# ([\w/]+\.py)\n")
NAMED = re.compile(r"((?:`\w+`(?:,? and |, )?)+),? (?:of|in)\s+`([\w./-]+\.\w+)`")


@pytest.fixture
def catalogues(monkeypatch):
    """What a session enters into the catalogues is taken out again."""
    for each in (LIMIT_STATES, KINDS, FORMATS, MEASURES):
        monkeypatch.setattr(each, "_own", dict(each._own))


def test_the_recipes_run_and_print_what_they_say(tmp_path, monkeypatch, catalogues):
    monkeypatch.chdir(tmp_path)
    printed = run_blocks(blocks_of(TEXT), tmp_path, "CONTRIBUTING.md")
    printed = [(block, text) for block, text in printed if block.output is not None]
    assert len(printed) > 8
    for block, text in printed:
        assert text.splitlines() == block.output.splitlines()


@pytest.mark.parametrize("recipe", RECIPES)
def test_files_hold_what_a_recipe_names(recipe):
    found = NAMED.findall(RECIPES[recipe])
    assert found
    for names, path in found:
        file = next((place / path for place in PLACES if (place / path).is_file()), None)
        assert file is not None, path
        for name in re.findall(r"`(\w+)`", names):
            assert re.search(rf"\b{name}\b", file.read_text("utf-8")), f"{name} in {path}"


def test_names_that_are_gone_are_seen():
    assert NAMED.findall("laws of `FIXED`, in `a/b.py`; `A` and `B` of `c.js`") == [
        ("`FIXED`", "a/b.py"),
        ("`A` and `B`", "c.js"),
    ]


def blocks_of_files() -> list[tuple[str, Block]]:
    blocks = blocks_of(re.sub(r"^   ", "", TEXT, flags=re.MULTILINE))
    return [(found[1], block) for block in blocks if (found := IN_FILE.match(block.source))]


@pytest.fixture
def copied(tmp_path) -> Path:
    """A folder with a copy of the package, compiled modules and all, into which the recipes are put."""
    source = ROOT / "src" / "rockflex"
    package = tmp_path / "rockflex"
    shutil.copytree(source, package, ignore=shutil.ignore_patterns("__pycache__", "web"))
    for name, module in list(sys.modules.items()):
        file = getattr(module, "__file__", None) or ""
        if name.startswith("rockflex.") and file.endswith((".so", ".pyd")):
            shutil.copy(file, package.joinpath(*name.split(".")[1:-1]))
    for path, block in blocks_of_files():
        file = package / path
        before = file.read_text("utf-8") + "\n\n" if file.exists() else ""
        file.write_text(before + block.source, "utf-8")
    return tmp_path


USED = """
import rockflex as rf
assert rf.__file__.startswith({folder!r}), rf.__file__

held = rf.read_structure("held.toml")
run = rf.simulate(held, rf.one_sine_pulse(amplitude=3.0, period=0.8))
assert run.max_element_force[0] > 0.0
assert rf.Response.load(run.save("run")).history.model.properties.elements == held.elements

from rockflex.motion import FORMATS, RecordFormat
from rockflex.motion._tsv import is_tsv, parse_tsv
FORMATS["TSV"] = RecordFormat("TSV", is_tsv, parse_tsv)
assert [motion.pga for motion in rf.read_suite("records")] == [2.5]
"""
HELD = """
[frame]
n_stories = 2
story_height = 3.0
story_mass = 40e3
base_mass = 40e3
stiffness_ratio = 1.0
period = 0.5
aspect_ratio = 8.0
damping_ratio = 0.02

[[elements]]
kind = "buffer"
stiffness = 1e7
"""


@pytest.mark.slow
def test_an_element_and_a_reader_in_the_package(copied, monkeypatch):
    assert [path for path, _ in blocks_of_files()] == ["structure/_law_bars.py", "motion/_tsv.py"]
    (copied / "held.toml").write_text(HELD, "utf-8")
    (copied / "records").mkdir()
    (copied / "records" / "a.dat2").write_text("TSV dt=0.01 n=3\n0\n250\n-100\n", "utf-8")
    builds = (Path(rockflex.__file__).parents[2] / "build").glob("cp*")
    monkeypatch.setenv("MESONPY_EDITABLE_SKIP", path_with(*builds))
    run(copied, "-c", USED.format(folder=str(copied)), site=copied)
