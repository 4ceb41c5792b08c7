"""What is written is read again: every structure, element and law as TOML, project, saved response and form."""

import copy
import inspect
import pickle
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tomli_w

import hostile
import rockflex as rf
from rockflex.foundation.json import as_json_value
from rockflex.models._impact import LAW_CLASSES
from rockflex.structure.file._element_tables import ELEMENTS
from rockflex.structure.file._object_tables import object_from_table, object_table
from rockflex.structure.file._structure_entry import KINDS, StructureEntry
from rockflex.web._state import parse_page_state
from rockflex.web._structure import build_page_structure

PULSE = rf.one_sine_pulse(amplitude=5.0, period=0.6, dt=0.01)
FRAME = rf.Frame(**hostile.FRAME)
MADE = {name: made(**given) for name, (made, given) in hostile.structures().items() if name not in ("pivot",)}
STRUCTURES: dict[str, Any] = {
    name: made for name, made in MADE.items() if isinstance(made, rf.RockingProperties) or hasattr(made, "rocking")
}
PARTS: dict[str, Any] = {name: made for name, made in MADE.items() if hasattr(made, "position")}
STRUCTURES |= {f"frame with {name}": rf.Restrained(FRAME, part) for name, part in PARTS.items()}
STRUCTURES |= {"leaning": rf.Leaning(FRAME, 5e3), "block": rf.rigid_block(0.2, 2.0, 1e4)}
CALLS = {made: given for made, given in reversed(hostile.structures().values()) if callable(made)}
ELEMENT_CALLS = {kind: (table.makes, CALLS[table.makes]) for kind, table in ELEMENTS.items() if table.makes in CALLS}
STRUCTURE_CALLS = {kind: (table.makes, CALLS[table.makes]) for kind, table in KINDS.items() if table.makes in CALLS}
ELSEWHERE = ("floors", "elements", "eccentricity")  # of the properties, in a file: beside the table, or not at all


def through_toml(table: Mapping[str, Any]) -> dict[str, Any]:
    """A table as a file holds it."""
    return tomllib.loads(tomli_w.dumps(as_json_value(dict(table))))


def same_properties(one: Any, other: Any) -> bool:
    """Whether two structures rock alike, to the last bit."""
    first, second = (each if isinstance(each, rf.RockingProperties) else each.rocking() for each in (one, other))
    return first == second


def plain(given: Mapping[str, Any]) -> dict[str, Any]:
    """The arguments that a table of a kind of structure holds; parts with tables of their own are left out."""
    parts = (rf.Section, rf.LumpedMasses)
    return {
        name: value
        for name, value in given.items()
        if value is not None and not isinstance(value, parts) and name not in ELSEWHERE
    }


def test_every_kind_is_tried() -> None:
    assert set(ELEMENT_CALLS) == set(ELEMENTS)
    assert set(STRUCTURE_CALLS) == set(KINDS)
    assert len(STRUCTURES) > 25


@pytest.mark.parametrize("name", STRUCTURES)
def test_a_structure_is_the_same_from_its_table(name: str) -> None:
    made = STRUCTURES[name]
    again = object_from_table(tomllib.loads(tomli_w.dumps(object_table(name, made))), name)
    assert type(again) is type(made)
    assert again == made
    assert same_properties(again, made)


@pytest.mark.parametrize("name", STRUCTURES)
def test_a_structure_is_the_same_from_a_pickle_and_a_copy(name: str) -> None:
    made = STRUCTURES[name]
    for again in (pickle.loads(pickle.dumps(made)), copy.deepcopy(made), copy.copy(made)):
        assert again == made
        assert same_properties(again, made)


@pytest.mark.parametrize("kind", ELEMENT_CALLS)
def test_an_element_is_the_same_from_a_file(kind: str) -> None:
    make, given = ELEMENT_CALLS[kind]
    held = {name: value for name, value in given.items() if value is not None}
    entry = StructureEntry(**through_toml({"frame": hostile.FRAME, "elements": [{"kind": kind, **held}]}))
    (element,) = entry.build().rocking().elements
    assert element == make(**given)
    again = StructureEntry(
        **through_toml({"frame": hostile.FRAME, "elements": [each.describe() for each in entry.elements]})
    )
    assert again.build() == entry.build()


@pytest.mark.parametrize("kind", STRUCTURE_CALLS)
def test_a_structure_is_the_same_from_a_file(kind: str) -> None:
    make, given = STRUCTURE_CALLS[kind]
    given = plain(given)
    built = StructureEntry(**through_toml({kind: given})).build()
    assert same_properties(built, make(**given))


@pytest.mark.parametrize("kind", [*STRUCTURE_CALLS, *ELEMENT_CALLS])
def test_the_page_builds_the_same_from_its_form(kind: str) -> None:
    if kind in ELEMENT_CALLS:
        make, given = ELEMENT_CALLS[kind]
        form: dict[str, Any] = {"frame": hostile.FRAME, "elements": [{"kind": kind, **given}]}
        wanted = rf.Restrained(FRAME, make(**given))
    else:
        make, given = STRUCTURE_CALLS[kind][0], plain(STRUCTURE_CALLS[kind][1])
        form, wanted = {kind: given}, make(**given)
    state = parse_page_state(as_json_value({"structure": form}))
    assert same_properties(build_page_structure(state.structure).properties, wanted)


@pytest.mark.parametrize("name", STRUCTURES)
@pytest.mark.parametrize("output", ["history", "peaks"])
def test_a_saved_response_is_the_same(name: str, output: Any, tmp_path: Path) -> None:
    made = STRUCTURES[name]
    block = (made if isinstance(made, rf.RockingProperties) else made.rocking()).n_modes == 0
    run = rf.simulate(made, PULSE, "rigid" if block else "2DOF-S", output)
    again = rf.Response.load(run.save(tmp_path / "run.npz"))
    assert again == run
    if run.history is not None:
        assert again.history is not None
        assert again.history.model.properties == run.history.model.properties
        np.testing.assert_array_equal(again.history.rotation, run.history.rotation)


def test_a_project_of_every_structure_and_law_is_the_same(tmp_path: Path) -> None:
    names = [name for name in STRUCTURES if name not in ("pivot", "truncated")]
    for first in range(0, len(names), 6):
        chosen = {name: STRUCTURES[name] for name in names[first : first + 6]}
        blocks = {name: (each if isinstance(each, rf.RockingProperties) else each.rocking()).n_modes == 0
                  for name, each in chosen.items()}  # fmt: skip
        model = {name: "rigid" if block else "2DOF-S" for name, block in blocks.items()}
        project = rf.Project(chosen, PULSE, model)
        again = rf.read_project(project.save(tmp_path / f"{first}.rockflex"))
        assert again == project
        assert all(same_properties(again.structures[name], each) for name, each in chosen.items())
    for kind in LAW_CLASSES.values():
        needed = [each for each in inspect.signature(kind).parameters.values() if each.default is each.empty]
        law = kind(*[0.9, 0.8][: len(needed)])
        label = "2DOF-C" if type(law).__name__ == "VVELComplete" else "2DOF-S"
        project = rf.Project({"frame": FRAME}, PULSE, label, impact=law)
        assert rf.read_project(project.save(tmp_path / f"{type(law).__name__}.rockflex")) == project
