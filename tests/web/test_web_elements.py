"""Elements between the base and the ground: what a link may hold of them, and the numbers that the page shows."""

import io
import tomllib
from typing import Any

import numpy as np
import pandas as pd
import pytest

import rockflex as rf
from rockflex.structure.file import StructureEntry
from rockflex.web._presets import PRESETS
from rockflex.web._refusal import Refusal
from rockflex.web._state import parse_state
from rockflex.web._structures import structure_view

PIER = next(each["structure"] for each in PRESETS if each["structure"]["name"] == "Pier with fuses")
BARE = {key: value for key, value in PIER.items() if key != "elements"}
FUSE = {"kind": "yielding_dissipator", "position": 1.2, "stiffness": 2e8, "yield_force": 4e5}
TENDON = {"position": -0.4, "initial_force": 8e5, "stiffness": 1e7}


def state(*elements: Any, **more: Any) -> dict[str, Any]:
    return {"structure": BARE | {"elements": list(elements)}, **more}


def refused(*elements: Any) -> dict[str, str]:
    with pytest.raises(Refusal) as caught:
        structure_view(parse_state(state(*elements)).structure)
    return caught.value.errors


@pytest.mark.parametrize(
    ("element", "path", "text"),
    [
        ({**FUSE, "stiffness": "stiff"}, "stiffness", "it must be the elastic stiffness, a number in N/m, but 'stiff'"),
        ({**FUSE, "yield_force": None}, "yield_force", "it must be the force at which the fuse yields, a number in N"),
        ({"kind": "friction_damper"}, "force", "it is missing: the force at which the damper slides, a number in N."),
        ({**FUSE, "coefficient": 1.0}, "coefficient", "it is not known here."),
        ({**FUSE, "tension_only": "yes"}, "tension_only", "it must be true or false: whether the fuse cannot push"),
        ({**FUSE, "kind": "spring"}, "kind", "it must be \"tendon\", \"yielding_dissipator\", \"viscous_damper\" or"),
        ({"stiffness": 1.0}, "kind", "it is missing: \"tendon\", \"yielding_dissipator\", \"viscous_damper\" or"),
        ({**FUSE, "yield_force": 1e16}, "yield_force", "it must be from -1e+15 to 1e+15, but 1e+16 was given."),
        ({**FUSE, "yield_force": 0.0}, "yield_force", "yield_force must be a positive, finite number in N, but 0.0"),
        ({**FUSE, "position": 2.0}, "position", "Elements must act within half_width = 1.5 m to each side"),
        ({**FUSE, "rupture_elongation": 1e-3}, "rupture_elongation", "must be beyond the elongation at yield, 0.002 m"),
        ({**FUSE, "post_yield_ratio": 2.0}, "post_yield_ratio", "post_yield_ratio must be from 0 to below 1, but 2"),
        ({"kind": "viscous_damper", "coefficient": -1.0}, "coefficient", "must be a zero or positive, finite number"),
        ({"kind": "tendon", **TENDON, "post_yield_ratio": 0.1}, "yield_force", "post_yield_ratio needs the"),
    ],
)  # fmt: skip
def test_a_bad_element_is_answered_beside_its_field(element, path, text) -> None:
    (found,) = refused({"kind": "viscous_damper", "coefficient": 1e5}, element).items()
    assert found[0] == f"structure.elements.1.{path}"
    assert text in found[1]


def test_the_page_takes_twenty_elements() -> None:
    structure_view(parse_state(state(*[FUSE] * 20)).structure)
    assert refused(*[FUSE] * 21) == {"structure.elements": "it holds 21 values, but the page takes 20 at most."}
    assert refused("x") == {"structure.elements.0": "it must be a list of tables, each under a heading [[elements]], "
                            "but 'x' was given."}  # fmt: skip


def test_tendons_of_older_links_are_the_first_elements() -> None:
    old = parse_state({"structure": BARE | {"tendons": [TENDON], "elements": [FUSE]}})
    assert old == parse_state(state({"kind": "tendon", **TENDON}, FUSE))
    built = StructureEntry.model_validate(BARE | {"tendons": [TENDON], "elements": [FUSE]}).build()
    assert old.structure.build().rocking().elements == built.rocking().elements
    empty = parse_state({"structure": BARE | {"tendons": []}})
    assert empty.structure.elements is None
    with pytest.raises(Refusal) as caught:
        parse_state({"structure": BARE | {"tendons": "two"}})
    assert "it must be a list of tables" in caught.value.errors["structure.tendons"]
    with pytest.raises(Refusal) as caught:
        parse_state({"structure": BARE | {"tendons": [TENDON], "elements": 3}})
    assert "it must be a list of tables" in caught.value.errors["structure.elements"]


@pytest.fixture(scope="module")
def pier() -> rf.Restrained:
    fuses = [rf.YieldingDissipator(2e8, 5e5, 0.02, position=x) for x in (-1.3, 1.3)]
    tendon = rf.Tendon(2.5e6, 25e6, yield_force=6e6, post_yield_ratio=0.02)
    return rf.Restrained(rf.CantileverWithTipMass(**PIER["cantilever"]), [tendon, *fuses])


@pytest.fixture(scope="module")
def run(pier) -> rf.Response:
    motion = rf.load_suite("el-centro-1940")[0].scaled(2.0)
    return rf.simulate(pier, motion, "MDOF-S", free_vibration=5.0, output="history")


def unpack(text: str) -> np.ndarray:
    import base64

    return np.frombuffer(base64.b64decode(text), "<f4").astype(float)


def test_the_numbers_of_elements_are_the_librarys(client, run) -> None:
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
    assert fixed["element_force"] is None
    drawn = [unpack(lifting[name]) for name in ("t", "element_elongation", "element_force")]
    nodes = np.column_stack((run.time, run.element_elongation[:, 2], run.element_force[:, 2])).astype("<f4")
    assert {tuple(row) for row in np.column_stack(drawn)} <= {tuple(row) for row in nodes.astype(float)}
    assert np.abs(drawn[2]).max() == pytest.approx(run.max_element_force[2], rel=1e-6)
    assert lifting["peaks"]["residual_rotation"] == run.residual_rotation
    # What each element takes is a part of the balance of energies.
    energy = client.ask("/api/response", asked, focus="MDOF-S")["energy"]
    assert unpack(energy["elements"])[-1] == pytest.approx(run.element_energy.sum(), rel=1e-6)


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


def test_downloads_contain_the_elements(client, tmp_path, monkeypatch, run) -> None:
    monkeypatch.chdir(tmp_path)
    elements = [*PIER["elements"], {"kind": "viscous_damper", "coefficient": 1e5}]
    elements += [{"kind": "friction_damper", "position": -0.5, "force": 1e4}, FUSE | {"rupture_elongation": 0.5}]
    asked = client.state(structure=PIER | {"elements": elements}, models=["2DOF-S"])
    expected = StructureEntry.model_validate(PIER | {"elements": elements}).build()
    _, lines = client.download("/api/download/python", asked)
    space: dict = {}
    exec(compile(lines, "response.py", "exec"), space)
    assert space["structure"].elements == expected.elements
    for what in ("structure", "study"):
        _, content = client.download(f"/api/download/{what}", asked)
        table = tomllib.loads(content.decode())
        entry = StructureEntry.model_validate(table if what == "structure" else table["structures"][0])
        assert entry.build().elements == expected.elements
    block = {
        "block": {"slenderness": 0.2, "half_diagonal": 3.0},
        "elements": [{"kind": "friction_damper", "force": 1.0}],
    }
    _, lines = client.download("/api/download/python", client.state(structure=block, models=["rigid"]))
    exec(compile(lines, "response.py", "exec"), space)
    assert space["structure"].elements == (rf.FrictionDamper(1.0),)
    _, content = client.download("/api/download/histories", client.state(structure=PIER, scale=2.0, models=["MDOF-S"]))
    table = pd.read_csv(io.BytesIO(content))
    assert table["element_3_force (N)"].to_numpy() == pytest.approx(run.element_force[:, 2], rel=1e-8, abs=1e-3)
    assert table["element_1_elongation (m)"].to_numpy() == pytest.approx(run.element_elongation[:, 0], rel=1e-8)


def test_a_search_for_a_width_keeps_the_elements(client) -> None:
    asked = client.state(structure=PIER)
    _, content = client.download("/api/download/design-study", asked)
    table = tomllib.loads(content.decode())
    assert not table.get("tendons")
    (structure,) = table["structures"]
    assert len(structure["elements"]) == 3
