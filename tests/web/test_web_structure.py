"""The Structure tab's answers: elements, ground and cross-sections."""

import io
import math
import tomllib
from typing import Any

import numpy as np
import pandas as pd
import pytest

import rockflex as rf
from builders import frame_values
from rockflex.models import _label
from rockflex.models._rocking_model import RockingModel
from rockflex.structure.file._structure_entry import StructureEntry
from rockflex.web import _downloads
from rockflex.web._downloads import file_maker
from rockflex.web._forms import PRESETS, forms_of_structures
from rockflex.web._refusal import Refusal
from rockflex.web._response import simulate_state_models
from rockflex.web._script import response_script
from rockflex.web._state import parse_page_state
from rockflex.web._structure import structure_view
from rockflex.web._studies import common_study_content
from rockflex.web._uploads import UploadedRecords

PIER = next(each["structure"] for each in PRESETS if each["structure"]["name"] == "Pier with fuses")
BARE = {key: value for key, value in PIER.items() if key != "elements"}
FUSE = {"kind": "yielding_dissipator", "position": 1.2, "stiffness": 2e8, "yield_force": 4e5}
TENDON = {"position": -0.4, "initial_force": 8e5, "stiffness": 1e7}


def state(*elements: Any, **more: Any) -> dict[str, Any]:
    return {"structure": BARE | {"elements": list(elements)}, **more}


def refused(*elements: Any) -> dict[str, str]:
    with pytest.raises(Refusal) as caught:
        structure_view(parse_page_state(state(*elements)).structure)
    return caught.value.errors


@pytest.mark.parametrize(
    ("element", "path", "text"),
    [
        ({**FUSE, "stiffness": "stiff"}, "stiffness", "it must be the elastic stiffness, a number in N/m, but 'stiff'"),
        ({**FUSE, "yield_force": None}, "yield_force", "it must be the force at which the fuse yields, a number in N"),
        ({"kind": "friction_damper"}, "force", "it is missing: the force at which the damper slides, a number in N."),
        ({**FUSE, "coefficient": 1.0}, "coefficient", "it is not known here."),
        ({**FUSE, "tension_only": "yes"}, "tension_only", "it must be true or false: whether the fuse cannot push"),
        ({**FUSE, "kind": "spring"}, "kind", "it must be \"tendon\", \"yielding_dissipator\", \"viscous_damper\", "),
        ({"stiffness": 1.0}, "kind", "it is missing: \"tendon\", \"yielding_dissipator\", \"viscous_damper\", "),
        ({**FUSE, "yield_force": 1e16}, "yield_force", "it must be from -1e+15 to 1e+15, but 1e+16 was given."),
        ({**FUSE, "yield_force": 0.0}, "yield_force", "yield_force must be a positive, finite number in N, but 0.0"),
        ({**FUSE, "position": 2.0}, "position", "Elements must act within half_width = 1.5 m to each side"),
        ({**FUSE, "rupture_elongation": 1e-3}, "rupture_elongation", "must be beyond the elongation at yield, 0.002 m"),
        ({**FUSE, "post_yield_ratio": 2.0}, "post_yield_ratio", "post_yield_ratio must lie in [0, 1), but 2"),
        ({"kind": "viscous_damper", "coefficient": -1.0}, "coefficient", "must be a zero or positive, finite number"),
        ({"kind": "tendon", **TENDON, "post_yield_ratio": 0.1}, "yield_force", "post_yield_ratio needs the"),
    ],
)  # fmt: skip
def test_a_bad_element_is_answered_beside_its_field(element, path, text) -> None:
    (found,) = refused({"kind": "viscous_damper", "coefficient": 1e5}, element).items()
    assert found[0] == f"structure.elements.1.{path}"
    assert text in found[1]


def test_the_page_takes_twenty_elements() -> None:
    structure_view(parse_page_state(state(*[FUSE] * 20)).structure)
    assert refused(*[FUSE] * 21) == {"structure.elements": "it holds 21 values, but the page takes 20 at most."}
    assert refused("x") == {"structure.elements.0": "it must be a list of tables, each under a heading [[elements]], "
                            "but 'x' was given."}  # fmt: skip


def test_the_numbers_of_elements_are_the_librarys(client, pier_run) -> None:
    run = pier_run
    asked = client.state(structure=PIER, scale=2.0, models=["fixed", "MDOF-S"])
    answer = client.ask("/api/response", asked, focus="fixed", element=2)
    held = answer["held"]
    assert held["label"] == "MDOF-S"  # the first that lifts
    for place, row in enumerate(held["rows"]):
        assert row["force"] == run.max_element_force[place]
        assert row["elongation"] == run.max_element_elongation[place]
        assert row["energy"] == run.element_energy[place]
        assert row["yielded"] == run.element_yielded[place]
    assert [row["yielded"] for row in held["rows"]] == [False, True, True]
    assert [row["prestress"] for row in held["rows"]] == [run.remaining_prestress[0], None, None]
    assert not any(row["broken"] for row in held["rows"])
    fixed, lifting = answer["models"]
    assert "element_force" not in fixed
    drawn = [client.unpack(lifting[name]) for name in ("t", "element_elongation", "element_force")]
    nodes = np.column_stack((run.time, run.element_elongation[:, 2], run.element_force[:, 2])).astype("<f4")
    assert {tuple(row) for row in np.column_stack(drawn)} <= {tuple(row) for row in nodes.astype(float)}
    assert np.abs(drawn[2]).max() == pytest.approx(run.max_element_force[2], rel=1e-6)
    assert lifting["peaks"]["residual_rotation"] == run.residual_rotation
    # What each element takes is a part of the balance of energies.
    energy = client.ask("/api/response", asked, focus="MDOF-S")["energy"]
    assert client.unpack(energy["elements"])[-1] == pytest.approx(run.element_energy.sum(), rel=1e-6)


def test_self_centring_is_told(client, pier) -> None:
    pivot = pier.rocking().pivot(1)
    asked = client.state(structure=PIER, models=["2DOF-S"])
    view = client.ask("/api/response", asked)
    (told,) = view["self_centring"]
    at = pier.rocking().recentring_ratio_at(view["models"][0]["peaks"]["max_rotation"])
    assert told == {"side": 1, "closes": True, "ratio": pivot.recentring_ratio, "at": at}
    shown = {each["symbol"]: each["value"] for each in client.ask("/api/structure", asked)["properties"]}
    assert shown["λ"] == pivot.recentring_ratio
    strong = PIER | {"elements": [{"kind": "friction_damper", "position": 0.5, "force": 2e7}]}
    told = client.ask("/api/response", client.state(structure=strong, models=["2DOF-S"]))["self_centring"]
    assert [(each["side"], each["closes"]) for each in told] == [(1, False), (-1, False)]
    bare = client.ask("/api/response", client.state(structure=BARE, models=["2DOF-S"]))
    assert (bare["held"], bare["element"], bare["self_centring"], bare["elements"]) == (None, None, [], [])


@pytest.mark.parametrize("asked", [-1, 3, "1", None, True, 1.5, [0]])
def test_an_element_that_there_is_not_is_the_first(client, asked) -> None:
    answer = client.ask("/api/response", client.state(structure=PIER, models=["2DOF-S"]), element=asked)
    assert answer["element"] == 0


def test_an_element_that_breaks_is_told(client) -> None:
    weak = FUSE | {"rupture_elongation": 5e-3}
    asked = client.state(structure=BARE | {"elements": [weak]}, scale=2.0, models=["2DOF-S"])
    (row,) = client.ask("/api/response", asked)["held"]["rows"]
    assert row["broken"]
    assert row["elongation"] > 5e-3


@pytest.mark.slow
def test_downloads_contain_the_elements(client, tmp_path, monkeypatch, pier_run) -> None:
    monkeypatch.chdir(tmp_path)
    elements = [*PIER["elements"], {"kind": "viscous_damper", "coefficient": 1e5}]
    elements += [{"kind": "friction_damper", "position": -0.5, "force": 1e4}, FUSE | {"rupture_elongation": 0.5}]
    asked = client.state(structure=PIER | {"elements": elements}, models=["2DOF-S"])
    expected = StructureEntry.model_validate(PIER | {"elements": elements}).build()
    space = client.program("python", asked)
    assert space["structure"].elements == expected.elements
    block = {
        "block": {"slenderness": 0.2, "half_diagonal": 3.0},
        "elements": [{"kind": "friction_damper", "force": 1.0}],
    }
    space = client.program("python", client.state(structure=block, models=["rigid"]))
    assert space["structure"].elements == (rf.FrictionDamper(1.0),)
    _, content = client.download("/api/file/histories", client.state(structure=PIER, scale=2.0, models=["MDOF-S"]))
    table = pd.read_csv(io.BytesIO(content))
    assert table["element_3_force (N)"].to_numpy() == pytest.approx(pier_run.element_force[:, 2], rel=1e-8, abs=1e-3)
    assert table["element_1_elongation (m)"].to_numpy() == pytest.approx(pier_run.element_elongation[:, 0], rel=1e-8)


def test_a_search_for_a_width_keeps_the_elements(client) -> None:
    asked = client.state(structure=PIER)
    _, content = client.download("/api/file/design-study", asked)
    table = tomllib.loads(content.decode())
    assert not table.get("tendons")
    (structure,) = table["structures"]
    assert len(structure["elements"]) == 3


FRAME = {"frame": frame_values(n_stories=2, period=0.5, aspect_ratio=8.0)}
BED = {"breadth": 3.0, "n": 8}
GROUNDS = [
    {"friction": 0.3},
    {"friction": [0.3, "inf"], "base_inertia": 2e4, "springs": {"stiffness": 5e8, "damping": [1e6, 2e6]}},
    {"base_inertia": 2e4, "springs": {"positions": [-0.4, 0.4], "stiffness": 9e8, "heave_damping_ratio": 0.2}},
    {"mat_mass": 4e4, "bed": BED | {"subgrade_modulus": 9e8, "damping": 2e6, "end_zone": 0.1, "end_ratio": 2.0}},
    {"mat_mass": 4e4, "bed": BED | {"breadth": 1.0, "shear_modulus": 3e8, "poisson_ratio": 0.3}},
]


@pytest.fixture
def made(monkeypatch):
    """Return the grounds that reach a model, which is then built without them."""
    grounds = []

    def grounded(label, kept, ground, law, missing_mass, **_kind):
        grounds.append(ground)
        return RockingModel(label, kept, True, law or rf.VVELSimplified(), missing_mass)

    monkeypatch.setattr(_label, "model_on_ground", grounded)
    return grounds


def state_of(ground, **other):
    return parse_page_state(
        {"structure": FRAME, "models": ["2DOF-S"], "free_vibration": 0.0, "ground": ground, **other}
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("ground", "eccentricity"), [*((ground, None) for ground in GROUNDS), (GROUNDS[1], 0.05), (GROUNDS[3], 0.05)]
)
def test_runs_programs_and_studies_have_the_ground(made, tmp_path, monkeypatch, ground, eccentricity):
    monkeypatch.chdir(tmp_path)
    state = state_of(ground, structure=FRAME | ({"eccentricity": eccentricity} if eccentricity else {}))
    built, _, (response,) = simulate_state_models(state, UploadedRecords())
    assert made == [state.ground.under(built.properties)]
    exec(compile(response_script(state), "response.py", "exec"), space := {})
    assert made[1] == made[0]
    assert space["responses"]["2DOF-S"].max_rotation == pytest.approx(response.max_rotation, rel=1e-12)
    study = rf.CloudStudy(**common_study_content(state, UploadedRecords(), "cloud", ["2DOF-S"], "Cloud"))
    assert study.ground == state.ground


@pytest.mark.parametrize(
    ("ground", "path", "text"),
    [
        ({"friction": -1.0}, "ground.friction", "it must be from 0.001 to inf, but -1 was given."),
        ({"springs": {"stiffness": 0.0}}, "ground.springs.stiffness", "it must be from 1 to 1e+15, but 0 was given."),
        ({"bed": {}}, "ground.bed.breadth", "it is missing: the dimension of the base perpendicular to the plane"),
        ({"frction": 0.3}, "ground.frction", "it is not known here."),
    ],
)
def test_wrong_values_are_refused(ground, path, text):
    with pytest.raises(Refusal) as raised:
        state_of(ground)
    ((found, said),) = raised.value.errors.items()
    assert (found, said[: len(text)]) == (path, text)


def test_contradictions_name_their_field():
    state = state_of({"springs": {"stiffness": 5e8}})
    with pytest.raises(Refusal) as raised:
        simulate_state_models(state, UploadedRecords())
    ((path, said),) = raised.value.errors.items()
    assert path == "ground.base_inertia"
    assert said.startswith("A base without rotary inertia")


def test_friction_that_prevents_sliding_may_be_infinite():
    assert state_of({"friction": "inf"}).ground.friction == math.inf


SOFT = GROUNDS[3] | {"friction": 0.1}
RECORD = {"source": "suite", "suite": "fema-p695-far-field", "name": "FF-2-a"}


def test_histories_have_the_columns_of_the_base():
    state = state_of(SOFT, record=RECORD, scale=2.0)
    _, _, (run,) = simulate_state_models(state, UploadedRecords())
    name, content = file_maker(state, "histories", UploadedRecords())(lambda *_: None)
    table = pd.read_csv(io.BytesIO(content))
    assert name == "histories.csv"
    expected = {
        "slip (m)": run.slip, "slip_velocity (m/s)": run.slip_velocity, "heave (m)": run.heave,
        "left_edge_uplift (m)": run.edge_uplift[:, 0], "right_edge_uplift (m)": run.edge_uplift[:, 1],
    } | {f"spring_force_{k + 1} (N)": run.spring_force[:, k] for k in range(8)}  # fmt: skip
    assert list(table.columns)[-len(expected) :] == list(expected)
    for head, values in expected.items():
        np.testing.assert_allclose(table[head], values, rtol=1e-8, atol=1e-12)


def test_histories_of_too_many_springs_are_refused(monkeypatch):
    monkeypatch.setattr(_downloads, "MAX_HISTORY_VALUES", 1000)
    with pytest.raises(Refusal) as raised:
        file_maker(state_of(SOFT), "histories", UploadedRecords())(lambda *_: None)
    assert raised.value.errors["models"].startswith("the histories with the forces of all springs have ")


def test_a_structure_tells_the_springs_under_it():
    bed = {"breadth": 3.0, "n": 40, "subgrade_modulus": 9e8, "heave_damping_ratio": 0.25}
    state = state_of({"friction": 0.3, "mat_mass": 4e4, "bed": bed})
    view = structure_view(state.structure, state.ground)["ground"]
    p = state.structure.build().rocking()
    springs = state.ground.under(p).springs
    assert view["slides"]
    assert len(view["springs"]) == 9
    assert (view["springs"][0], view["springs"][-1]) == (springs.positions[0], springs.positions[-1])
    facts = {fact["symbol"]: fact["value"] for fact in view["facts"]}
    assert facts["w"] == pytest.approx(p.m_tot * 9.81 / springs.total_stiffness)
    assert facts["ζ_z"] == pytest.approx(0.25)
    assert facts["Σkx²"] == springs.rotational_stiffness
    assert structure_view(state.structure)["ground"] is None
    slides = state_of({"friction": 0.3})
    assert structure_view(slides.structure, slides.ground)["ground"] == {"slides": True, "springs": [], "facts": []}


def test_mass_that_leans_stands_not_on_the_base():
    given = PRESETS[0]["structure"] | {"leaning_masses": 60e3}
    assert structure_view(parse_page_state({"structure": given}).structure)["mass"] == pytest.approx(6 * 40e3)


def test_a_response_tells_the_peaks_of_each_story(client):
    state = client.state(models=["2DOF-S", "MDOF-S"])
    rows = client.ask("/api/response", state)["floors"]
    run = rf.simulate(rf.Frame(**frame_values()), rf.load_suite("el-centro-1940")[0], "2DOF-S", free_vibration=5.0)
    assert [row["height"] for row in rows] == [15.0, 12.0, 9.0, 6.0, 3.0]
    for name in ("story_drift", "story_shear", "floor_acceleration", "total_floor_displacement"):
        assert [row[name] for row in rows] == getattr(run.floors, name)[::-1].tolist()
    assert [row["drift_ratio"] for row in rows] == pytest.approx(run.floors.story_drift[::-1] / 3.0)
    block = client.state(structure={"block": {"slenderness": 0.2, "half_diagonal": 3.0}}, models=["rigid"])
    assert client.ask("/api/response", block)["floors"] == []


BASE = {"height": 12.0, "base_mass": 1e4, "half_width": 1.2, "damping_ratio": 0.03}
TUBE = {"shape": "tube", "diameter": 1.6, "wall": 0.1, "elastic_modulus": 30e9, "density": 2500.0}
MADE = rf.Section.tube(1.6, 0.1, elastic_modulus=30e9, density=2500.0)
KINDS = {
    "cantilever": (BASE | {"tip_mass": 5e4}, rf.CantileverWithTipMass(**BASE, tip_mass=5e4, section=MADE)),
    "beam": (BASE, rf.Beam(**BASE, section=MADE)),
}


@pytest.mark.parametrize("kind", KINDS)
def test_the_form_has_a_section_of_one_part(kind):
    (section,) = (each for each in forms_of_structures()["kinds"][kind]["fields"] if each["name"] == "section")
    assert (section["type"], section["required"]) == ("table", False)
    shape, *sizes = section["fields"]
    assert shape["choices"] == ["rectangle", "box", "circle", "tube"]
    names = ["width", "depth", "diameter", "wall", "elastic_modulus", "density", "stiffness_factor"]
    assert [each["name"] for each in sizes] == names


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_a_section_makes_the_structure_and_the_program(kind, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    given, expected = KINDS[kind]
    state = parse_page_state(
        {"structure": {kind: given | {"section": TUBE}}, "models": ["rigid"], "free_vibration": 0.0}
    )
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
        structure_view(parse_page_state({"structure": {"cantilever": BASE | {"tip_mass": 5e4} | changes}}).structure)
    assert said in refused.value.errors[path]
