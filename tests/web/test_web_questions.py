"""The measures and the limits that the page offers are those of the library."""

import dataclasses
import json

import pytest

from rockflex.motion import MEASURES
from rockflex.web._presets import PRESETS
from rockflex.web._refusal import Refusal
from rockflex.web._state import parse_state

STRUCTURE = {"structure": PRESETS[0]["structure"]}


@pytest.fixture
def added(monkeypatch):
    """A measure of the ground, and one of the base."""
    twice = dataclasses.replace(
        MEASURES["pga"],
        name="twice",
        label="2 PGA",
        words="twice the peak",
        of=lambda shaking: 2.0 * shaking.motion.pga,
    )
    monkeypatch.setitem(MEASURES, "twice", twice)
    monkeypatch.setitem(MEASURES, "lifts", dataclasses.replace(twice, name="lifts", unit="", words="", of_what="base"))


def test_their_list(client) -> None:
    listed = json.loads(client.request("/api/about")[2])["measures"]
    assert [(each["name"], each["title"], each["unit"]) for each in listed] == [
        ("pgv", "PGV, peak ground velocity", "m/s"),
        ("pga", "PGA, peak ground acceleration", "m/s²"),
        ("pgd", "PGD, peak ground displacement", "m"),
        ("sa_t1_5", "Sa(T₁, 5 %), spectral acceleration at 5 % damping, as in hazard curves", "m/s²"),
        ("sa_t1", "Sa(T₁, ζ₁), spectral acceleration at the structure's damping", "m/s²"),
        ("sd_t1", "Sd(T₁, ζ₁), spectral displacement at the structure's damping", "m"),
        ("arias", "Arias intensity", "m/s"),
        ("cav", "CAV, cumulative absolute velocity", "m/s"),
        ("relative_pga", "PGA/(g tan α)", ""),
        ("relative_pgv", "p PGV/(g tan α)", ""),
    ]
    assert [each["name"] for each in listed if each["of_base"]] == ["relative_pga", "relative_pgv"]


@pytest.mark.usefixtures("added")
def test_an_added_measure_is_offered_taken_and_told(client) -> None:
    *_, twice, lifts = json.loads(client.request("/api/about")[2])["measures"]
    assert twice == {
        "name": "twice",
        "title": "2 PGA, twice the peak",
        "unit": "m/s²",
        "axis": "2 PGA [m/s²]",
        "of_base": False,
    }
    assert (lifts["axis"], lifts["of_base"]) == ("2 PGA", True)
    state = parse_state(STRUCTURE | {"cloud": {"measure": "lifts"}, "design": {"measure": "twice"}})
    assert (state.cloud.measure, state.design.measure) == ("lifts", "twice")
    told = client.ask("/api/record", client.state())["measures"]
    values = {each["help"]: each["value"] for each in told if each["unit"] == "m/s²"}
    assert values["twice the peak"] == 2.0 * values["peak ground acceleration"]


@pytest.mark.usefixtures("added")
@pytest.mark.parametrize(
    ("part", "name"), [("cloud", "pgx"), ("cloud", "d5_95"), ("design", "pgx"), ("design", "lifts")]
)
def test_another_is_refused(part, name) -> None:
    with pytest.raises(Refusal) as caught:
        parse_state(STRUCTURE | {part: {"measure": name}})
    assert caught.value.errors == {f"{part}.measure": f"it must be an intensity measure, but {name!r} was given."}


def test_the_limits_of_its_lists(client) -> None:
    listed = json.loads(client.request("/api/about")[2])["limit_states"]
    assert [(each["name"], each["clause"]) for each in listed] == [
        ("rocking", "it rocks (uplift with θ > 0.1 mrad)"),
        ("rotation", "the rotation exceeds …"),
        ("nominal", "the nominal limit 0.7 atan(B/h*₁)"),
        ("overturning", "it overturns"),
    ]
    assert {each["name"]: each["noun"] for each in listed if each["noun"]} == {
        "rotation": "a rotation",
        "nominal": "the nominal limit 0.7 atan(B/h*₁)",
        "overturning": "overturning",
    }


@pytest.mark.parametrize("path", ["cloud.uplift", "design.uplift", "design.rocking"])
def test_another_limit_is_refused(path) -> None:
    part, name = path.split(".")
    with pytest.raises(Refusal) as caught:
        parse_state(STRUCTURE | {part: {"limit": name}})
    assert caught.value.errors == {f"{part}.limit": f"it must be a limit state, but {name!r} was given."}
