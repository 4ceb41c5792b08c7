"""Cross-sections on the page: the form, the structure, the program that repeats it, and refusals."""

import pytest

import rockflex as rf
from rockflex.web._forms import forms
from rockflex.web._refusal import Refusal
from rockflex.web._script import response_script
from rockflex.web._state import parse_state
from rockflex.web._structures import structure_view

BASE = {"height": 12.0, "base_mass": 1e4, "half_width": 1.2, "damping_ratio": 0.03}
TUBE = {"shape": "tube", "diameter": 1.6, "wall": 0.1, "elastic_modulus": 30e9, "density": 2500.0}
MADE = rf.Section.tube(1.6, 0.1, elastic_modulus=30e9, density=2500.0)
KINDS = {
    "cantilever": (BASE | {"tip_mass": 5e4}, rf.CantileverWithTipMass(**BASE, tip_mass=5e4, section=MADE)),
    "beam": (BASE, rf.Beam(**BASE, section=MADE)),
}


@pytest.mark.parametrize("kind", KINDS)
def test_the_form_has_a_section_of_one_part(kind):
    (section,) = (each for each in forms()["kinds"][kind]["fields"] if each["name"] == "section")
    assert (section["type"], section["required"]) == ("table", False)
    shape, *sizes = section["fields"]
    assert shape["choices"] == ["rectangle", "box", "circle", "tube"]
    names = ["width", "depth", "diameter", "wall", "elastic_modulus", "density", "stiffness_factor"]
    assert [each["name"] for each in sizes] == names


@pytest.mark.parametrize("kind", KINDS)
def test_a_section_makes_the_structure_and_the_program(kind, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    given, expected = KINDS[kind]
    state = parse_state({"structure": {kind: given | {"section": TUBE}}, "models": ["rigid"], "free_vibration": 0.0})
    assert state.structure.build() == expected
    structure_view(state.structure)
    exec(compile(response_script(state), "response.py", "exec"), space := {})
    assert space["structure"] == expected


@pytest.mark.parametrize(
    ("changes", "path", "said"),
    [
        ({"section": TUBE, "bending_stiffness": 1e9}, "structure.cantilever.bending_stiffness", "by the section"),
        ({}, "structure.cantilever.bending_stiffness", "is missing: give it, or a section"),
        ({"section": TUBE | {"wall": 0.9}}, "structure.cantilever.section", "wall must be less than half of 1.6 m"),
        ({"section": TUBE | {"wall": 1e9}}, "structure.cantilever.section.wall", "it must be from 0.0001 to 100"),
        ({"section": TUBE | {"shape": "star"}}, "structure.cantilever.section.shape", 'it must be one of "rectangle"'),
    ],
)
def test_refusals_are_at_the_field(changes, path, said):
    with pytest.raises(Refusal) as refused:
        structure_view(parse_state({"structure": {"cantilever": BASE | {"tip_mass": 5e4} | changes}}).structure)
    assert said in refused.value.errors[path]
