"""The wrappers of structures: each is said once, and files, cases, objects and the page's programs know all of them."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rockflex as rf
from rockflex.structure.file._object_entries import entry_of_object_table
from rockflex.structure.file._object_tables import object_table
from rockflex.structure.file._structure_entry import StructureEntry
from rockflex.structure.file._toml_table import parse_toml_table
from rockflex.structure.file._wrappers import WRAPPERS
from rockflex.web._forms import forms_of_structures
from rockflex.web._links import _can_be_drawn
from rockflex.web._script import _structure_code_lines

FRAME = {
    "n_stories": 3,
    "story_height": 3.0,
    "story_mass": 40e3,
    "base_mass": 60e3,
    "stiffness_ratio": float("inf"),
    "period": 0.5,
    "aspect_ratio": 5.0,
    "damping_ratio": 0.03,
}
VALUES: dict[str, Any] = {
    "leaning_masses": [10e3, 20e3, 0.0],
    "stories": {"strengths": [3e5, 2e5, 1e5], "post_yield_ratio": 0.05},
    "podium": {"n_columns": 4, "column_width": 0.8, "column_height": 5.0, "column_mass": 8e3},
    "joints": {"heights": [3.0, 6.0], "half_widths": [0.8, 0.7]},
    "eccentricity": 0.2,
    "one_sided": {"restitution": "sorrentino", "side": "left"},
}


@pytest.fixture(params=sorted(WRAPPERS))
def key(request: pytest.FixtureRequest) -> str:
    return request.param


def entry_with(key: str, value: Any) -> StructureEntry:
    return parse_toml_table(StructureEntry, {"name": "wall", "frame": FRAME, key: value})


def test_a_file_has_the_wrapper(key: str) -> None:
    entry, frame = entry_with(key, VALUES[key]), rf.Frame(**FRAME)
    kind, _ = WRAPPERS[key]
    built: Any = entry.build()
    assert isinstance(built, kind)
    assert built.structure == frame
    assert built.rocking() != frame.rocking()
    assert key in entry.describe()


def test_an_object_in_a_project_is_the_same_entry(key: str) -> None:
    built = entry_with(key, VALUES[key]).build()
    again = parse_toml_table(StructureEntry, entry_of_object_table(object_table("structure", built), "project"))
    assert again.build() == built


def test_the_program_of_the_page_makes_the_same_structure(key: str) -> None:
    entry = entry_with(key, VALUES[key])
    scope: dict[str, Any] = {"rf": rf, "np": np}
    exec("\n".join(_structure_code_lines(entry)), scope)
    assert scope["structure"] == entry.build()


def test_a_structure_in_another_file_takes_none_beside_it(key: str) -> None:
    with pytest.raises(rf.InputError, match=key):
        rf.Case(
            structures={"wall": {"file": "wall.toml", key: VALUES[key]}},
            records={"suites": ["el-centro-1940"]},
            models=["MDOF-S"],
        )


def test_a_block_is_refused_where_floors_are_needed_and_the_page_asks_for_none(key: str) -> None:
    block = {"block": {"width": 1.0, "height": 5.0, "mass": 1e4}, key: VALUES[key]}
    (form,) = (each for each in forms_of_structures()["whole"] if each["name"] == key)
    if form["floors"]:
        with pytest.raises(rf.InputError, match="needs floors") as caught:
            parse_toml_table(StructureEntry, block).build()
        assert caught.value.field == key
        return
    assert parse_toml_table(StructureEntry, block).build().rocking() != rf.rigid_block(**block["block"])


def test_a_link_with_something_else_in_its_place_is_not_drawn(key: str) -> None:
    drawn = {"name": "", "frame": FRAME, key: VALUES[key]}
    assert _can_be_drawn(drawn)
    if isinstance(VALUES[key], dict):
        assert not _can_be_drawn(drawn | {key: [1.0]})


def test_the_docstring_of_files_names_each(key: str) -> None:
    kind, _ = WRAPPERS[key]
    text = rf.read_structure.__doc__ or ""
    assert f"`{kind.__name__}`" in text
    assert f"``{key}``" in text or f"``[{key}]``" in text


def test_a_value_that_changes_nothing_is_no_wrapper(tmp_path: Path) -> None:
    assert entry_with("eccentricity", 0.0).build() == rf.Frame(**FRAME)
    (tmp_path / "wall.toml").write_text("eccentricity = 0.2\nblock = { width = 1.0, height = 5.0, mass = 1e4 }")
    built = rf.read_structure(tmp_path / "wall.toml")
    assert isinstance(built, rf.RockingProperties)
    assert built.eccentricity == 0.2
