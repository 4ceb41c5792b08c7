"""The state of the page, and the forms that are generated for it."""

import dataclasses
import inspect
import json
import math
from contextlib import suppress
from typing import Annotated

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import rockflex as rf
from rockflex.foundation.descriptions import Described
from rockflex.foundation.json import as_json_value
from rockflex.foundation.units import QUANTITIES
from rockflex.motion import MEASURES
from rockflex.structure.file._element_tables import ELEMENTS
from rockflex.structure.file._structure_entry import KINDS
from rockflex.structure.file._toml_table import TomlTable
from rockflex.web._encoding import envelope_indices
from rockflex.web._forms import PRESETS, _form_fields, forms_of_structures
from rockflex.web._links import usable_page_state
from rockflex.web._refusal import Refusal
from rockflex.web._state import PageState, parse_page_json, parse_page_state
from rockflex.web._structure import build_page_structure, structure_view

FRAME = PRESETS[0]["structure"]


def errors(state):
    with pytest.raises(Refusal) as caught:
        parse_page_state(state)
    return caught.value.errors


def frame(**changes):
    return {"structure": {"frame": FRAME["frame"] | changes}}


@pytest.mark.parametrize("preset", PRESETS, ids=lambda preset: preset["title"])
def test_every_preset_can_be_built_and_goes_through_a_link(preset) -> None:
    state = parse_page_state({"structure": preset["structure"]})
    link = json.dumps(as_json_value(state.model_dump(exclude_none=True)), allow_nan=False)
    assert parse_page_state(parse_page_json(link.encode())) == state
    view = structure_view(state.structure)
    json.dumps(view, allow_nan=False)
    p = build_page_structure(state.structure).properties
    assert [mode["period"] for mode in view["modes"]] == pytest.approx((2 * np.pi / p.omega).tolist())
    if not p.n_modes:  # a rigid block
        assert view["shapes_known"] is False
        return
    for place, pivot in enumerate(p.pivots):
        lifted = rf.uplifted_modes(p, side=pivot.side)
        shown = [mode["uplifted"][place]["damping"] for mode in view["modes"]]
        assert shown == pytest.approx(lifted.damping_ratio.tolist())
    assert {len(mode["uplifted"]) for mode in view["modes"]} == {len(p.pivots)}
    assert view["adequacy"]["reason"]


@pytest.mark.parametrize(
    ("state", "path", "text"),
    [
        (frame(n_stories=1_000_000), "structure.frame.n_stories", "it must be from 1 to 200, but 1e+06 was given."),
        (frame(n_stories=2.5), "structure.frame.n_stories", "it must be the number of stories, a whole number, but"),
        (frame(period=math.nan), "structure.frame.period", "it must be from 0.01 to 60, but nan was given."),
        (frame(period="inf"), "structure.frame.period", "it must be from 0.01 to 60, but inf was given."),
        (frame(period="x" * 300), "structure.frame.period", "a number in s, but 'xxx"),
        (frame(story_mass=None), "structure.frame.story_mass", "it must be the mass of each floor"),
        (frame(wings=2), "structure.frame.wings", "it is not known here."),
        ({"structure": {"frame": {}}}, "structure.frame.period", "it is missing: the first period on a fixed base"),
        ({"structure": {}}, "structure", "one structure is expected"),
        ({"structure": FRAME, "scale": 1e9}, "scale", "it must be a number from 0.01 to 20, but 1000000000.0"),
        ({"structure": FRAME, "scale": math.nan}, "scale", "it must be a number from 0.01 to 20"),
        ({"structure": FRAME, "free_vibration": 36_000}, "free_vibration", "from 0 to 60, but 36000 was given."),
        (
            {"structure": FRAME | {"eccentricity": 1e4}},
            "structure.eccentricity",
            "it must be from -1000 to 1000, but 10000 was given.",
        ),
        (
            {"structure": FRAME | {"eccentricity": "left"}},
            "structure.eccentricity",
            "it must be the distance of the masses to the right of the middle of the base, a number in m, but 'left'",
        ),
        ({"structure": FRAME, "models": ["5DOF-Q"]}, "models", "Unknown model '5DOF-Q'."),
        ({"structure": FRAME, "models": ["2DOF-S"] * 2}, "models", "the same model is chosen twice."),
        ({"structure": FRAME, "models": []}, "models", "it must be a list of one to four models, but [] was given."),
        ({"structure": FRAME, "tab": "../../etc"}, "tab", "it must be the name of a tab, but '../../etc' was given."),
        ({"structure": FRAME, "record": {"upload": "../x"}}, "record.upload", "it must be the checksum of a file"),
        ({"structure": FRAME, "cloud": {"scales": [1.0] * 21}}, "cloud.scales", "one to twenty scale factors"),
        ({"structure": FRAME, "design": {"widths": 1000}}, "design.widths", "how many widths, from 3 to 20, but 1000"),
        (
            {"structure": FRAME | {"elements": [{"kind": "tendon"}]}},
            "structure.elements.0.initial_force",
            "is missing",
        ),
        ([], "", "The link does not hold a state of the page."),
        ("<script>", "", "The link does not hold a state of the page."),
    ],
)
def test_what_cannot_be_used_is_said_beside_its_field(state, path, text) -> None:
    found = errors(state)
    assert text in found[path]
    assert "Traceback" not in found[path]


@pytest.mark.parametrize(
    ("change", "kept"),
    [
        ({"scale": 500}, {"scale": 500}),
        ({"record": {"source": "nowhere"}}, {"record": {"source": "suite"}}),  # no list has it
        ({"cloud": {"scales": [0.5, 99]}, "soul": 1}, {"cloud": {"scales": [0.5, 99]}}),
        ({"structure": {"frame": {"n_stories": -3}}}, {"structure": {"frame": {"n_stories": -3}}}),
        ({"ground": {"friction": -1}}, {"ground": {"friction": -1}}),
        ({"structure": {"frame": 3}}, {"structure": PRESETS[0]["structure"]}),
        ({"alternatives": [{"name": "A"}, 7, {"name": "B", "structure": FRAME, "models": ["fixed"]}]},
         {"alternatives": [{"name": "B"}]}),
    ],
)  # fmt: skip
def test_what_a_bad_link_leaves_opens(change, kept) -> None:
    """Bad numbers stay in their fields, and nothing else is lost."""

    def holds(found, wanted):
        if isinstance(wanted, dict):
            return all(holds(found[name], each) for name, each in wanted.items())
        if isinstance(wanted, list) and wanted and isinstance(wanted[0], dict):
            return len(found) == len(wanted) and all(map(holds, found, wanted))
        return found == wanted

    content = {"structure": FRAME, "head": {"title": "Kept"}, "free_vibration": 7.0, **change}
    found = usable_page_state(content, PRESETS[0]["structure"])
    assert holds(found, kept)
    assert (found["head"], found["free_vibration"]) == ({"title": "Kept"}, 7.0)


def test_text_never_becomes_the_path_of_a_file() -> None:
    matrices = {"mass": "/etc/passwd", "stiffness": "secret.npz", "heights": [3.0], "base_mass": 1.0}
    found = errors({"structure": {"matrices": matrices | {"half_width": 1.0, "damping_ratio": 0.0}}})
    assert found["structure.matrices.mass"].startswith("it must be the masses in kg")
    assert found["structure.matrices.stiffness"].endswith("but 'secret.npz' was given.")


@pytest.mark.parametrize(
    ("change", "path"),
    [
        ({"scale": "1,234.5"}, "scale"),
        ({"scale": "1,234"}, "scale"),
        ({"cloud": {"scales": ["1,5"]}}, "cloud.scales"),
        ({"structure": {"lumped": {"heights": ["3,000", "6,000"]}}}, "structure.lumped.heights"),
        ({"structure": {"matrices": {"mass": ["1,234", "5"]}}}, "structure.matrices.mass"),
    ],
)
def test_a_comma_that_may_mean_two_things_is_explained(change, path) -> None:
    assert "write a decimal point, no thousands separators" in errors({"structure": FRAME} | change)[path]
    assert "thousands" not in errors({"structure": FRAME, "scale": "soon, 1 or 2"})["scale"]


def test_messages_about_matrices_speak_of_the_page() -> None:
    found = errors({"structure": {"matrices": {"mass": True, "heights": "x", "omega": 1}}})
    for text in found.values():
        for word in ("path", ".npz", "file", "table", "{ index"):
            assert word not in text


@pytest.mark.slow
@pytest.mark.parametrize(
    "structure",
    [FRAME | {"elements": [{"a": 1}] * 40_000}, FRAME | {f"k{n}": 1 for n in range(100_000)}],
    ids=["tables", "keys"],
)
def test_what_is_wrong_a_thousand_times_is_told_a_few_times(structure) -> None:
    assert len(errors({"structure": structure})) <= 50


def test_a_state_of_too_many_values_is_refused_unread() -> None:
    state = {"structure": FRAME | {"elements": [{"a": 1}] * 100_000}}
    assert errors(state) == {"": "The link holds more than 150000 values, which is more than the page takes."}
    whole = [[1.0] * 200] * 200
    table = {"matrices": {"mass": whole, "stiffness": whole, "heights": [1.0] * 200}}
    assert "150000" not in str(errors({"structure": table}))


def test_lists_and_matrices_are_limited() -> None:
    lumped = {"masses": [1.0] * 201, "stiffness": [[1.0]], "heights": [1.0], "base_mass": 1.0, "half_width": 1.0}
    found = errors({"structure": {"lumped": lumped | {"damping_ratio": 0.0}}})
    assert found["structure.lumped.masses"] == "it holds 201 values, but the page takes 200 at most."


LUMPED = {"stiffness": [[2.0, -1.0], [-1.0, 1.0]], "heights": [3.0, 6.0], "base_mass": 1.0, "half_width": 1.0}


TOWER = PRESETS[6]["structure"]["tapered_tower"]
OUTSIDE = {"kind": "tendon", "position": 1.6, "initial_force": 1.0, "stiffness": 1.0}


@pytest.mark.parametrize(
    ("structure", "path", "text"),
    [
        ({"tapered_tower": TOWER | {"wall": 50.0}}, "structure.tapered_tower.wall", "wall "),
        (PRESETS[8]["structure"] | {"elements": [OUTSIDE]}, "structure.elements.0.position", "Elements must act"),
        (FRAME | {"eccentricity": -1.1}, "structure.eccentricity", "eccentricity must be smaller than half_width, 1.0"),
        # The message names stiffness and heights, too, and says mass where the field is masses.
        (
            {"lumped": LUMPED | {"masses": [0.0, 1.0], "damping_ratio": 0.0}},
            "structure.lumped.masses",
            "mass must be positive, but mass[0] = 0 kg was given.",
        ),
        (
            {"lumped": LUMPED | {"masses": [1.0], "damping_ratio": 0.0}},
            "structure.lumped.masses",
            "mass must contain one mass for each of the 2 heights, but 1 were given.",
        ),
        (
            {"lumped": LUMPED | {"masses": [1.0, 1.0], "damping_ratio": [0.5, 0.98, 0.0]}},
            "structure.lumped.damping_ratio",
            "damping_ratio must be one number, or one for each of the 2 modes",
        ),
        (
            {"fish_bone": {"story_heights": [], "masses": 1.0, "column_stiffness": 1.0, "beam_stiffness": 1.0}
             | {"base_mass": 1.0, "half_width": 1.0, "damping_ratio": 0.0}},
            "structure.fish_bone.story_heights",
            "story_heights must contain at least one height in m, but none was given.",
        ),
    ],
)  # fmt: skip
def test_the_field_of_an_error_is_that_of_the_form(structure, path, text) -> None:
    with pytest.raises(Refusal) as caught:
        structure_view(parse_page_state({"structure": structure}).structure)
    (found,) = caught.value.errors.items()
    assert found[0] == path
    assert found[1].startswith(text)


def test_errors_of_the_hysteresis_stand_beside_their_field() -> None:
    yields = {"yield_displacement": 0.05, "gamma": 0.1, "beta": 0.4}
    (found,) = errors({"structure": FRAME, "bouc_wen": yields}).items()
    assert found[0] == "bouc_wen.gamma"
    assert found[1].startswith("gamma must be positive and -gamma < beta <= gamma")


def test_the_parameters_of_both_edges_are_shown() -> None:
    state = parse_page_state({"structure": PRESETS[-1]["structure"]})
    p = build_page_structure(state.structure).properties
    shown = structure_view(state.structure)
    assert (shown["eccentricity"], shown["half_width"]) == (0.3, 1.9)
    moments = {each["edge"]: each["value"] for each in shown["properties"] if each["symbol"] == "M_r"}
    assert moments == {side: p.pivot(side).resisting_moment for side in (1, -1)}
    assert {each["symbol"]: each["value"] for each in shown["properties"]}["e"] == 0.3
    plain_view = structure_view(parse_page_state({"structure": FRAME}).structure)
    symbols = [each["symbol"] for each in plain_view["properties"]]
    assert symbols == ["B", "m_tot", "M_r", "L₀ʳ", "I_θ", "a_lift", "α", "θ_nom"]
    assert plain_view["eccentricity"] == 0.0


def test_json_that_is_none_is_refused() -> None:
    for body in (b"{", b"\xff", b"[" * 100_000, b""):
        with pytest.raises(Refusal, match="not valid JSON"):
            parse_page_json(body)
    assert parse_page_json(b'{"a": ' + b"9" * 5000 + b"}")["a"] == math.inf


def test_the_forms_have_every_field_of_every_kind() -> None:
    found = forms_of_structures()
    json.dumps(found, allow_nan=False)
    assert set(found["kinds"]) == set(KINDS)
    for kind, table in KINDS.items():
        fields = {each["name"]: each for each in found["kinds"][kind]["fields"]}
        assert set(fields) == set(table.model_fields)
        assert all(each["help"] and each["label"] for each in fields.values())
    assert set(found["elements"]) == set(ELEMENTS)
    for kind, table in ELEMENTS.items():
        fields = found["elements"][kind]["fields"]
        assert {each["name"] for each in fields} == table.model_fields.keys() - {"kind"}
        assert found["elements"][kind]["title"] == table.title
    bodies = next(each for each in found["kinds"]["beam"]["fields"] if each["name"] == "lumped_masses")
    assert (bodies["type"], [each["name"] for each in bodies["fields"]]) == ("table", ["heights", "masses", "rotary"])
    assert [each["name"] for each in found["bouc_wen"]] == list(inspect.signature(rf.BoucWen).parameters)
    moved, one_sided, leaning, stories, *_ = found["whole"]
    assert [(each["name"], each["type"]) for each in one_sided["fields"]] == [
        ("restitution", "number"),
        ("side", "choice"),
    ]
    assert (leaning["name"], leaning["type"]) == ("leaning_masses", "number or list")
    assert [each["name"] for each in stories["fields"]] == ["strengths", "post_yield_ratio"]
    assert (moved["unit"], moved["required"], moved["default"], moved["type"]) == ("m", False, None, "number")
    assert moved["help"] == "The distance of the masses to the right of the middle of the base."
    period = next(each for each in found["kinds"]["frame"]["fields"] if each["name"] == "period")
    assert (period["unit"], period["low"], period["high"], period["required"]) == ("s", 0.01, 60.0, True)


values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=20),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8), inner, max_size=4),
    max_leaves=12,
)


@given(values)
def test_any_value_is_a_state_or_a_refusal(value) -> None:
    with suppress(Refusal):
        assert isinstance(parse_page_state(value), PageState)


@given(st.sampled_from(sorted(PageState.model_fields)), values)
def test_any_value_in_a_link_opens_or_not(name, value) -> None:
    """Whatever stands in place of a part of a state, the others are as they were, or nothing opens."""
    content = {"structure": FRAME, "head": {"title": "Kept"}, "free_vibration": 7.0, name: value}
    found = usable_page_state(content, FRAME)
    assert found is None or name == "head" or found["head"] == {"title": "Kept"}
    assert found is None or name == "free_vibration" or found["free_vibration"] == 7.0


def test_what_has_no_balance_says_why() -> None:
    held = FRAME | {"elements": [{"kind": "tendon", "initial_force": 1e5, "stiffness": 1e12}]}
    for structure, none in ((FRAME, None), (held, "the tendons always bring it back")):
        properties = structure_view(parse_page_state({"structure": structure}).structure)["properties"]
        (alpha,) = (each for each in properties if each["symbol"] == "α")
        assert ((alpha["value"] is None), alpha.get("none")) == (none is not None, none)


def test_units_and_helps_are_data_and_not_found_in_texts() -> None:
    class Plate(TomlTable):
        depth: Annotated[float, Described("how deep, in m below, it lies", "ft")]
        area: Annotated[float, Described("its area in m", form="a table of {}, a number in s")]

    depth, area = _form_fields(Plate)
    assert (depth["unit"], depth["help"]) == ("ft", "How deep, in m below, it lies.")
    assert (area["unit"], area["help"]) == ("", "Its area in m.")
    kinds = forms_of_structures()["kinds"]
    units = {(kind, each["name"]): each["unit"] for kind, table in kinds.items() for each in table["fields"]}
    assert units["frame", "period"] == "s"
    assert units["fish_bone", "beam_stiffness"] == "N m/rad"
    assert units["properties", "top_height"] == "m"
    shown_in_others = {named[2] for named in QUANTITIES.values()}
    assert set(units.values()) <= shown_in_others | {"N/m²", "rad/s"}
    masses = next(each for each in kinds["fish_bone"]["fields"] if each["name"] == "masses")
    assert (masses["unit"], masses["help"]) == ("kg", "The mass of each floor.")  # or in tonnes beside it
    assert units["modes", "omega"] == "rad/s"
    assert units["frame", "aspect_ratio"] == ""


FIELDS = [(kind, name) for kind, table in KINDS.items() for name in table.model_fields]


@given(st.sampled_from(FIELDS), values)
def test_any_value_in_any_field_of_a_structure_is_built_or_refused(field, value) -> None:
    kind, name = field
    first = next((p["structure"][kind] for p in PRESETS if kind in p["structure"]), {})
    with suppress(Refusal):
        structure_view(parse_page_state({"structure": {kind: first | {name: value}}}).structure)


@given(
    st.sampled_from([f for f in FIELDS if f[0] in ("frame", "tapered_tower", "cantilever", "wall_frame")]), st.floats()
)
def test_any_number_in_any_field_of_a_structure_is_built_or_refused(field, value) -> None:
    kind, name = field
    first = next(p["structure"][kind] for p in PRESETS if kind in p["structure"])
    with suppress(Refusal):
        structure_view(parse_page_state({"structure": {kind: first | {name: value}}}).structure)


def test_a_thinned_curve_keeps_its_extremes() -> None:
    rng = np.random.default_rng(1)
    curves = [rng.normal(size=50_000), np.cumsum(rng.normal(size=50_000))]
    kept = envelope_indices(curves, 1000)
    assert kept.size <= 1010
    assert kept[0] == 0
    assert kept[-1] == 49_999
    assert (np.diff(kept) > 0).all()
    for values in curves:
        assert values[kept].max() == values.max()
        assert values[kept].min() == values.min()


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


def test_the_usual_measures_are_listed_first(client) -> None:
    listed = json.loads(client.request("/api/about")[2])["measures"]
    names = "pgv pga pgd sa_t1_5 sa_avg fiv3 sa_t1 sd_t1 arias cav relative_pga relative_pgv"
    assert [each["name"] for each in listed] == names.split()
    assert {each["name"]: (each["title"], each["unit"]) for each in listed}["pgv"] == (
        "PGV, peak ground velocity", "m/s",
    )  # fmt: skip
    assert [each["name"] for each in listed if each["of_base"]] == ["relative_pga", "relative_pgv"]


@pytest.mark.usefixtures("added")
def test_an_added_measure_is_offered_taken_and_told(client) -> None:
    *_, twice, lifts = json.loads(client.request("/api/about")[2])["measures"]
    assert twice == {
        "name": "twice",
        "title": "2 PGA, twice the peak",
        "unit": "m/s²",
        "axis": "2 PGA",
        "of_base": False,
    }
    assert (lifts["axis"], lifts["of_base"]) == ("2 PGA", True)
    state = parse_page_state({"structure": FRAME} | {"cloud": {"measure": "lifts"}, "design": {"measure": "twice"}})
    assert (state.cloud.measure, state.design.measure) == ("lifts", "twice")
    told = client.ask("/api/record", client.state())["measures"]
    values = {each["help"]: each["value"] for each in told if each["unit"] == "m/s²"}
    assert values["twice the peak"] == 2.0 * values["peak ground acceleration"]


@pytest.mark.usefixtures("added")
@pytest.mark.parametrize(
    ("part", "key", "name"),
    [
        *(("cloud", "measure", name) for name in ("pgx", "d5_95")),
        *(("design", "measure", name) for name in ("pgx", "lifts")),
        *(("cloud", "limit", name) for name in ("uplift",)),
        *(("design", "limit", name) for name in ("uplift", "rocking")),
    ],
)
def test_another_measure_or_limit_is_refused(part, key, name) -> None:
    wanted = {"measure": "an intensity measure", "limit": "a limit state"}[key]
    said = errors({"structure": FRAME, part: {key: name}})
    assert said == {f"{part}.{key}": f"it must be {wanted}, but {name!r} was given."}


def test_the_limits_of_its_lists(client) -> None:
    listed = json.loads(client.request("/api/about")[2])["limit_states"]
    assert [(each["name"], each["clause"]) for each in listed] == [
        ("rocking", "it rocks (uplift with θ > 0.1 mrad)"),
        ("rotation", "the rotation exceeds …"),
        ("drift", "the top drifts, apart from the rotation, by more than …"),
        ("residual_drift", "a story keeps a drift of more than …"),
        ("ductility", "a story needs a ductility of more than …"),
        ("nominal", "the nominal limit 0.7 atan(B/h*₁)"),
        ("overturning", "it overturns"),
    ]
    assert {each["name"]: each["noun"] for each in listed if each["noun"]} == {
        "rotation": "a rotation",
        "nominal": "the nominal limit 0.7 atan(B/h*₁)",
        "overturning": "overturning",
    }
