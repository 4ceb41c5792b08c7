"""Structures of every kind from TOML files."""

import math
import tomllib
from inspect import signature
from pathlib import Path

import numpy as np
import pytest
import tomli_w
from pydantic import ValidationError

import rockflex as rf
from builders import PROPERTIES, frame_values
from rockflex.structure._attachment import PLACE
from rockflex.structure.file._element_tables import ELEMENTS
from rockflex.structure.file._structure_entry import KINDS, StructureEntry
from rockflex.structure.file._toml_table import TomlTable, parse_toml_table, schema_key_of_field

EXAMPLES = Path(__file__).parents[2] / "examples"
BASE = {"base_mass": 60e3, "half_width": 1.8, "damping_ratio": 0.02}
MASSES, STIFFNESS, HEIGHTS = [20e3, 90e3], [[34e6, -10.5e6], [-10.5e6, 4.2e6]], [8.0, 16.0]
LUMPED = {"masses": MASSES, "stiffness": STIFFNESS, "heights": HEIGHTS, **BASE}
TENDON = {"initial_force": 5e5, "stiffness": 2e7}
FRAME = frame_values(n_stories=3, period=0.6, aspect_ratio=8.0)
BEAM = {"height": 30.0, "half_width": 2.0, "damping_ratio": 0.02, "base_mass": 1e4, "n_elements": 40, "n_modes": 3}
Z = [0.0, 10.0, 10.0, 30.0]
FISH_BONE = {"story_heights": [4.0, 3.0], "masses": 40e3, "column_stiffness": [9e7, 8e7], "beam_stiffness": math.inf}
WALL = {"height": 32.0, "mass": 3e6, "stiffness_parameter": math.inf, "period": 0.8, "aspect_ratio": 6.0}
TOWER = {
    "height": 200.0,
    "base_radius": 8.0,
    "top_radius": 4.0,
    "wall": 1.0,
    "density": 2400.0,
    "elastic_modulus": 25e9,
    "damping_ratio": [0.02, 0.03],
    "n_modes": 2,
}
PIER = {"height": 12.0, "tip_mass": 500e3, "bending_stiffness": 4e10}


def toml(value):
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml(item)}" for key, item in value.items()) + " }"
    return str(value).lower() if isinstance(value, bool) else repr(value)


def text(table, values):
    return f"[{table}]\n" + "".join(f"{key} = {toml(value)}\n" for key, value in values.items())


def modes_of_two_masses():
    root = np.sqrt(MASSES)
    squares, vectors = np.linalg.eigh(np.array(STIFFNESS) / np.outer(root, root))
    return np.sqrt(squares), vectors / root[:, None]


def assert_same(one, other):
    one, other = (each if isinstance(each, rf.RockingProperties) else each.rocking() for each in (one, other))
    for name in (*KINDS["properties"].model_fields, "elements"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name), err_msg=name)


@pytest.fixture
def write(tmp_path):
    def file(content):
        path = tmp_path / "structure.toml"
        path.write_text(content, "utf-8")
        return path

    return file


@pytest.fixture
def failing(write):
    def message(content):
        path = write(content)
        with pytest.raises(rf.InputError) as caught:
            rf.read_structure(path)
        assert str(caught.value).startswith(str(path))
        return str(caught.value).removeprefix(str(path))

    return message


@pytest.mark.parametrize(
    ("table", "values", "make"),
    [
        ("frame", FRAME, rf.Frame),
        ("fish_bone", {**FISH_BONE, **BASE}, rf.FishBone),
        ("wall_frame", {**WALL, "base_mass": 4e5, "damping_ratio": 0.03}, rf.WallFrame),
        ("wall_frame", {**WALL, "base_mass": 4e5, "damping_ratio": [0.02, 0.05], "n_modes": 2}, rf.WallFrame),
        ("tapered_tower", TOWER, rf.TaperedTower),
        ("tapered_tower", {**TOWER, "method": "fe"}, rf.TaperedTower),
        ("cantilever", {**PIER, **BASE}, rf.CantileverWithTipMass),
        ("cantilever", {**PIER, **BASE, "mass_per_length": 1e4, "n_modes": 2}, rf.CantileverWithTipMass),
        ("cantilever", {**PIER, **BASE, "tip_inertia": 3e6}, rf.CantileverWithTipMass),
        ("lumped", LUMPED, rf.LumpedStructure),
        ("properties", PROPERTIES, rf.RockingProperties),
        ("block", {"slenderness": 0.2, "half_diagonal": 3.0}, rf.rigid_block),
        ("block", {"slenderness": 0.2, "half_diagonal": 3.0, "mass": 7.0}, rf.rigid_block),
        ("beam", {**BEAM, "mass": 2e3, "bending_stiffness": 4e9}, rf.Beam),
    ],
)
def test_keys_are_the_arguments_of_the_class(write, table, values, make):
    built = rf.read_structure(write(text(table, values)))
    assert_same(built, make(**values))
    if isinstance(make, type):
        assert type(built) is make


def test_every_kind_is_tried():
    assert set(KINDS) == {
        *("frame", "fish_bone", "wall_frame", "tapered_tower", "cantilever", "beam", "lumped"),
        *("matrices", "modes", "properties", "block", "rocking_frame"),
    }


def test_beam_with_lists_and_bodies(write):
    lists = {"mass": [3e3, 3e3, 2e3, 1e3], "shear_stiffness": [2e9, 2e9, 1e9, 1e9]}
    rest = {"bending_stiffness": 4e9, "rotary_inertia": 50.0, "rotary_in_modes": False}
    bodies = {"heights": [20.0, 30.0], "masses": [1e3, 2e4], "rotary": [0.0, 5e4]}
    built = rf.read_structure(write(text("beam", {**BEAM, "z": Z, **lists, **rest, "lumped_masses": bodies})))
    tables = {name: (Z, values) for name, values in lists.items()}
    assert_same(built, rf.Beam(**BEAM, **tables, **rest, lumped_masses=rf.LumpedMasses(**bodies)))


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"mass": [1e3, 2e3], "bending_stiffness": 4e9}, "mass is a list, but its heights are not known. Add z"),
        ({"z": Z, "mass": 1e3, "bending_stiffness": 4e9}, "z holds heights, but nothing varies along them. Give"),
        ({"z": Z, "mass": [1e3], "bending_stiffness": 4e9}, "mass must contain one value for each height of its"),
    ],
)
def test_beam_whose_lists_do_not_fit(failing, values, said):
    assert failing(text("beam", {**BEAM, **values})).startswith(f", [beam]: {said}")


def test_matrices_inline_and_from_files_beside_the_structure(write, tmp_path, monkeypatch):
    expected = rf.LumpedStructure(**LUMPED)
    np.savez(tmp_path / "both.npz", mass=MASSES, stiffness=STIFFNESS)
    (tmp_path / "h").mkdir()
    np.savetxt(tmp_path / "h" / "heights.csv", HEIGHTS, delimiter=",")
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    monkeypatch.chdir(elsewhere)
    for values in (
        {"mass": MASSES, "stiffness": STIFFNESS, "heights": HEIGHTS},
        {"mass": np.diag(MASSES).tolist(), "stiffness": STIFFNESS, "heights": {"0": 8.0, "1": 16.0}},
        {"mass": "both.npz", "stiffness": "both.npz", "heights": "h/heights.csv"},
        {"mass": str(tmp_path / "both.npz"), "stiffness": "../" + tmp_path.name + "/both.npz", "heights": HEIGHTS},
    ):
        found = rf.read_structure(write(text("matrices", {**values, **BASE}))).rocking()
        np.testing.assert_allclose(found.omega, expected.rocking().omega, rtol=1e-12)
        np.testing.assert_allclose(found.effective_height, expected.rocking().effective_height, rtol=1e-10)


def test_freedoms_that_turn(write):
    values = {"mass": [5e5, 3e6], "stiffness": [[8e7, -4e8], [-4e8, 3e9]]}
    built = rf.read_structure(write(text("matrices", {**values, "heights": {"0": 12.0}, "rotations": [1], **BASE})))
    assert_same(built, rf.from_matrices(**values, heights={0: 12.0}, rotations=[1], **BASE))


def test_modes(write, tmp_path):
    omega, shapes = modes_of_two_masses()
    np.savetxt(tmp_path / "phi.csv", shapes, delimiter=",")
    rest = {"mass": MASSES, "heights": HEIGHTS, **BASE}
    expected = rf.from_modes(omega, shapes, **rest)
    for given in (shapes.tolist(), "phi.csv"):
        assert_same(
            rf.read_structure(write(text("modes", {"omega": omega.tolist(), "shapes": given, **rest}))), expected
        )


def test_file_of_numbers_that_is_not_there(failing, tmp_path):
    message = failing(text("matrices", {"mass": "m.npz", "stiffness": STIFFNESS, "heights": HEIGHTS, **BASE}))
    assert message.startswith(f", [matrices]: mass: the file {tmp_path / 'm.npz'} does not exist")


def test_indices_of_heights_are_whole_numbers(failing):
    values = {"mass": MASSES, "stiffness": STIFFNESS, "heights": {"top": 16.0}, **BASE}
    message = failing(text("matrices", values))
    assert message.startswith(": [matrices] heights must be")
    assert "{ index = height }" in message
    assert "{'top': 16.0} was given" in message


TENDONS = "".join(
    f"[[elements]]\nkind = 'tendon'\nposition = {x}\ninitial_force = 5e5\nstiffness = 2e7\n{more}"
    for x, more in ((-0.5, ""), (0.0, "yield_force = 9e5\n"), (0.5, ""))
)


def test_tendons_hold_a_structure_down(write):
    built = rf.read_structure(write(text("frame", FRAME) + TENDONS))
    tendons = [rf.Tendon(**TENDON, position=x) for x in (-0.5, 0.5)]
    tendons.insert(1, rf.Tendon(**TENDON, yield_force=9e5))
    assert built == rf.Restrained(rf.Frame(**FRAME), tendons)
    # By hand: the weight and the three forces, about a pivot.
    p = built.rocking()
    assert p.resisting_moment == pytest.approx((160e3 * 9.81 + 1.5e6) * p.half_width)


def test_tendons_hold_properties_down(write):
    built = rf.read_structure(write(text("properties", PROPERTIES) + TENDONS))
    assert isinstance(built, rf.RockingProperties)
    assert [tendon.position for tendon in built.tendons] == [-0.5, 0.0, 0.5]


def test_an_eccentric_base(write):
    assert rf.read_structure(write("eccentricity = 0.2\n" + text("frame", FRAME))) == rf.Eccentric(
        rf.Frame(**FRAME), 0.2
    )
    assert rf.read_structure(write("eccentricity = 0\n" + text("frame", FRAME))) == rf.Frame(**FRAME)
    built = rf.read_structure(write("eccentricity = 0.2\n" + text("frame", FRAME) + TENDONS))
    assert isinstance(built, rf.Restrained)
    assert built.structure == rf.Eccentric(rf.Frame(**FRAME), 0.2)
    by_hand = rf.read_structure(write("eccentricity = -0.2\n" + text("properties", PROPERTIES) + TENDONS))
    assert isinstance(by_hand, rf.RockingProperties)
    assert by_hand.eccentricity == -0.2
    assert len(by_hand.tendons) == 3


def test_a_wrong_eccentricity(failing):
    frame = text("frame", FRAME)
    assert failing("eccentricity = 0.9\n" + frame).startswith(
        ", eccentricity must be smaller than half_width, 0.842617 m, to either side, but 0.9 m was given."
    )
    assert failing("eccentricity = nan\n" + frame) == ", eccentricity must be a finite number in m, but nan was given."
    assert failing('eccentricity = "left"\n' + frame).startswith(": eccentricity must be the distance of the masses")
    assert failing(frame + "eccentricity = 0.2\n").startswith(
        ": [frame] eccentricity is not known; there are n_stories"
    )


def test_wrong_tendons(failing):
    frame = text("frame", FRAME)
    one = "[[elements]]\nkind = 'tendon'\nposition = 0.3\ninitial_force = 5e5\nstiffness = 2e7\n"
    assert failing(frame + TENDONS + one.replace("0.3", "-1.3")).startswith(", [[elements]] no. 4: Elements must act")
    assert failing(frame + one.replace("2e7", "-1")).startswith(", [[elements]] no. 1: stiffness must be a zero")
    wrong = failing(frame + TENDONS + one.replace("2e7", '"high"').replace("initial_force = 5e5", "force = 5e5"))
    for said in (
        "initial_force is missing: the force",
        "stiffness must be EA/L",
        "force is not known; there are ",
    ):
        assert f"[[elements]] no. 4, {said}" in wrong
    assert wrong.endswith("Did you mean yield_force?")
    assert failing("elements = [3]\n" + frame).startswith(": [[elements]] no. 1")


@pytest.mark.parametrize("place", ["", "structures."])
def test_a_table_of_tendons_is_told_how_it_is_written_now(write, place):
    content = "\n".join([f"[[{place}tendons]]", *(f"{key} = {value}" for key, value in TENDON.items())])
    model = Study if place else StructureEntry
    head = f"[[structures]]\n{text('structures.frame', FRAME)}" if place else text("frame", FRAME)
    with pytest.raises(rf.InputError, match=r'tendons is not known.*\[\[elements\]\] with kind = "tendon"'):
        parse_toml_table(model, tomllib.loads(head + content))


ARGUMENTS = {
    "tendon": {
        "position": -0.3,
        "initial_force": 5e5,
        "stiffness": 2e7,
        "yield_force": 9e5,
        "post_yield_ratio": 0.02,
        "rupture_elongation": 0.2,
    },
    "yielding_dissipator": {
        "position": 0.6,
        "stiffness": 1e8,
        "yield_force": 2e5,
        "post_yield_ratio": 0.01,
        "tension_only": True,
        "rupture_elongation": 0.1,
    },
    "viscous_damper": {"position": -0.6, "coefficient": 3e5},
    "friction_damper": {"position": 0.1, "force": 1e5},
    "strand_tendon": {
        "position": 0.2,
        "n": 4,
        "strand": "Y1860S7-15.7",
        "length": 12.0,
        "prestress": 0.5,
        "post_yield_ratio": 0.02,
        "ultimate_strain": 0.02,
    },
    "bar_fuse": {
        "position": 0.5,
        "n": 2,
        "diameter": 0.02,
        "length": 0.5,
        "steel": "B500B",
        "tension_only": True,
        "ultimate_strain": 0.04,
    },
    "u_plate_fuse": {
        "position": -0.5,
        "n": 4,
        "width": 0.12,
        "thickness": 0.012,
        "diameter": 0.12,
        "steel": "S355",
        "post_yield_ratio": 0.02,
    },
    "flag_shaped_bar": {
        "position": 0.2,
        "stiffness": 1e8,
        "yield_force": 2e5,
        "post_yield_ratio": 0.05,
        "flag_depth": 0.8,
        "tension_only": True,
    },
    "gap_bar": {"position": -0.1, "stiffness": 1e8, "gap": 0.01, "both_ways": True},
    "multilinear_bar": {"position": 0.3, "elongations": [0.01, 0.03], "forces": [1e5, 2e5], "tension_only": True},
}
CLASSES = {
    "tendon": rf.Tendon,
    "yielding_dissipator": rf.YieldingDissipator,
    "viscous_damper": rf.ViscousDamper,
    "friction_damper": rf.FrictionDamper,
    "strand_tendon": rf.strand_tendon,
    "bar_fuse": rf.bar_fuse,
    "u_plate_fuse": rf.u_plate_fuse,
    "flag_shaped_bar": rf.FlagShapedBar,
    "gap_bar": rf.GapBar,
    "multilinear_bar": rf.MultilinearBar,
}


def element(kind, **changes):
    values = {name: value for name, value in (ARGUMENTS[kind] | changes).items() if value is not None}
    return "[[elements]]\n" + "".join(f"{key} = {toml(value)}\n" for key, value in {"kind": kind, **values}.items())


def test_keys_of_elements_are_the_arguments_of_their_classes(write):
    assert {kind: table.makes for kind, table in ELEMENTS.items()} == CLASSES
    for kind, table in ELEMENTS.items():
        parameters = dict(signature(CLASSES[kind]).parameters)
        if parameters.pop("place", None):  # of functions: those of the element that they return
            returned = signature(signature(CLASSES[kind]).return_annotation).parameters
            parameters |= {name: returned[name] for name in PLACE}
        assert {"kind", *parameters} == set(table.model_fields)
        for name, parameter in parameters.items():
            field = table.model_fields[name]
            assert parameter.default is parameter.empty if field.is_required() else parameter.default == field.default
    built = rf.read_structure(write(text("frame", FRAME) + "".join(map(element, ELEMENTS))))
    expected = [make(**ARGUMENTS[kind]) for kind, make in CLASSES.items()]
    assert built == rf.Restrained(rf.Frame(**FRAME), expected)
    by_hand = rf.read_structure(write(text("properties", PROPERTIES) + "".join(map(element, ELEMENTS))))
    assert by_hand == rf.RockingProperties(**PROPERTIES, elements=expected)


@pytest.mark.parametrize(
    ("kind", "changes", "said"),
    [
        ("tendon", {"yield_force": 4e5}, "initial_force must not exceed yield_force, 400000 N, but 500000 N was"),
        ("tendon", {"yield_force": None}, "post_yield_ratio needs the yield_force in N of a tendon with stiffness"),
        ("tendon", {"post_yield_ratio": None, "stiffness": 0.0}, "rupture_elongation needs a tendon with stiffness"),
        ("tendon", {"rupture_elongation": 0.01}, "rupture_elongation must be beyond the elongation at yield, 0.02 m"),
        ("yielding_dissipator", {"rupture_elongation": 0.001}, "rupture_elongation must be beyond the elongation"),
        ("yielding_dissipator", {"position": 0.9}, "Elements must act within half_width = 0.842617 m to each side"),
        ("friction_damper", {"force": -1}, "force must be a zero or positive, finite number in N, but -1.0 was given."),
    ],
)
def test_values_of_elements_out_of_range_name_the_element(failing, kind, changes, said):
    content = text("frame", FRAME) + element("viscous_damper") + element(kind, **changes)
    assert failing(content).startswith(f", [[elements]] no. 2: {said}")


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (element("friction_damper").replace("friction_", ""), 'no. 1, kind must be "tendon", "yielding_dissipator",'),
        (element("friction_damper").replace("kind = 'friction_damper'", ""), 'no. 1, kind is missing: "tendon",'),
        (element("friction_damper").replace("'friction_damper'", "[1]"), 'no. 1, kind must be "tendon",'),
        (element("yielding_dissipator", stiffness="stiff"), "no. 1, stiffness must be the elastic stiffness, a number"),
        (element("yielding_dissipator", fy=1.0), "no. 1, fy is not known; there are "),
        (element("yielding_dissipator", tension_only=1), "no. 1, tension_only must be true or false"),
        (element("viscous_damper", coefficient=None), "no. 1, coefficient is missing: the force over the velocity"),
        (
            "[elements]\nforce = 3\n",
            "elements must be a list of tables, each under a heading [[elements]], but {'force",
        ),
    ],
)
def test_wrong_keys_of_elements(failing, content, said):
    place = ": [[elements]] " if said.startswith("no.") else ": "
    assert failing(text("frame", FRAME) + content).startswith(place + said)


def test_an_entry_is_written_and_read_again(write):
    content = text("frame", FRAME) + "".join(map(element, ELEMENTS))
    entry = parse_toml_table(StructureEntry, tomllib.loads(content))
    again = tomli_w.dumps(entry.model_dump(exclude_none=True))
    assert parse_toml_table(StructureEntry, tomllib.loads(again)) == entry
    assert rf.read_structure(write(again)) == entry.build()
    described = entry.describe()
    assert described["elements"] == [{"kind": kind, **values} for kind, values in ARGUMENTS.items()]
    # An entry without elements has the document, and so the folder of its study, that it always had.
    assert "elements" not in parse_toml_table(StructureEntry, {"frame": FRAME}).model_dump(exclude_none=True)


def test_one_structure_a_file(failing):
    expected = (
        ": one structure is expected, [frame], [fish_bone], [wall_frame], [tapered_tower], [cantilever], [beam], "
        "[lumped], [matrices], [modes], [properties], [block] or [rocking_frame], but {} found."
    )
    assert failing("") == expected.format("none was")
    assert failing(text("lumped", LUMPED) + text("frame", FRAME)) == expected.format("[frame] and [lumped] were")


def test_keys_of_a_table_in_a_table(failing):
    values = {**BEAM, "mass": 1e3, "bending_stiffness": 4e9, "lumped_masses": {"height": [3.0], "masses": 5.0}}
    message = failing(text("beam", values))
    for said in ("heights is missing: a list", "masses must be a list", "height is not known", "Did you mean heights?"):
        assert f"[beam.lumped_masses] {said}" in message or (said.startswith("Did") and said in message)


def test_what_only_runs_need_is_left_to_them(write):
    more = 'impact = "complete"\n' + text("frame", FRAME) + "[bouc_wen]\nyield_displacement = 0.1\n"
    assert rf.read_structure(write(more)) == rf.Frame(**FRAME)


def test_values_out_of_range_name_file_and_table(failing):
    assert failing(text("tapered_tower", {**TOWER, "wall": 5.0})).startswith(
        ", [tapered_tower]: wall must be at most the smaller radius, top_radius = 4 m, but 5 m was given."
    )
    assert failing(text("tapered_tower", {**TOWER, "method": "exact"})) == (
        ': [tapered_tower] method must be "ritz" (shapes over the whole height) or "fe" (2000 finite elements), but '
        "'exact' was given."
    )
    assert failing(text("frame", {**FRAME, "period": math.inf})).startswith(", [frame]: period must be a positive")


def test_file_that_cannot_be_read(tmp_path):
    with pytest.raises(rf.InputError, match=r"The structure file .*x\.toml does not exist \(working directory: "):
        rf.read_structure(str(tmp_path / "x.toml"))


def test_entry_is_frozen_named_and_says_what_it_holds():
    entry = StructureEntry.model_validate({"name": "A", "lumped": LUMPED, "elements": [{"kind": "tendon", **TENDON}]})
    assert (entry.name, entry.kind) == ("A", "lumped")
    assert entry.describe() == {**LUMPED, "elements": [{"kind": "tendon", "position": 0.0, **TENDON}]}
    assert_same(entry.build(), rf.Restrained(rf.LumpedStructure(**LUMPED), rf.Tendon(**TENDON)))
    with pytest.raises(ValidationError):
        entry.name = "B"


class Study(TomlTable):
    """A file that holds several structures."""

    structures: list[StructureEntry]


def test_entries_in_another_file_are_told_by_their_number():
    good = {"lumped": LUMPED}
    bad = {
        "frame": {**FRAME, "n_stories": 2.5},
        "elements": [{"kind": "tendon", **TENDON}, {"kind": "tendon", "stiffness": 1.0}],
    }
    assert len(parse_toml_table(Study, {"structures": [good]}).structures) == 1
    with pytest.raises(rf.InputError) as caught:
        parse_toml_table(Study, {"structures": [good, bad, {}]}, "study.toml")
    first, second, third = str(caught.value).removeprefix("study.toml: ").split(". [[")
    assert first == (
        "[[structures]] no. 2, [structures.frame] n_stories must be the number of stories, a whole number, but 2.5 was "
        "given"
    )
    assert second == (
        "structures]] no. 2, [[structures.elements]] no. 2, initial_force is missing: the force while the base stands "
        "on the ground, a number in N"
    )
    assert third.startswith("structures]] no. 3: one structure is expected, [frame], ")


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("bridge_pier", rf.CantileverWithTipMass),
        ("chimney", rf.TaperedTower),
        ("restrained_pier", rf.Restrained),
        ("structure_1", rf.Frame),
        ("structure_lumped", rf.LumpedStructure),
        ("structure_properties", rf.RockingProperties),
        ("wall", rf.WallFrame),
    ],
)
def test_examples(name, kind):
    assert isinstance(rf.read_structure(EXAMPLES / f"{name}.toml"), kind)


def test_chimney_of_section_4_1_1():
    expected = rf.TaperedTower(200, 8, 4, 1, 2400, 25e9, 0.02, method="ritz", n_modes=5)
    assert_same(rf.read_structure(EXAMPLES / "chimney.toml"), expected)


@pytest.mark.parametrize("model", [*KINDS.values(), StructureEntry])
def test_every_key_is_described(model):
    for name, field in model.model_fields.items():
        key = schema_key_of_field(field)
        assert key.description, name
        assert not key.description.endswith(".")
        assert "{}" not in key.expected
        assert "{unit}" not in key.expected
        assert key.low is None or key.low < key.high


@pytest.mark.parametrize("text", ["x = " + "[" * 5000 + "]" * 5000, "x = " + "{a = " * 5000 + "1" + "}" * 5000])
def test_a_file_nested_too_deep(tmp_path, text):
    file = tmp_path / "deep.toml"
    file.write_text(text)
    with pytest.raises(rf.InputError, match=r"deep\.toml is nested too deep to be read: .* more than any structure"):
        rf.read_structure(file)


STORIES = "[stories]\nstrengths = [2e5, 1.5e5]\npost_yield_ratio = 0.05\n"


def test_leaning_mass_stories_and_elements_anywhere(write):
    content = "leaning_masses = [2e4, 1e4]\n" + text("frame", FRAME | {"n_stories": 2, "stiffness_ratio": math.inf})
    content += STORIES + "[[elements]]\nkind = 'viscous_damper'\ncoefficient = 3e5\nbetween = [0, 2]\ncosine = 0.8\n"
    content += "[[elements]]\nkind = 'gap_bar'\nstiffness = 1e7\ngap = 0.01\nheight = 3.0\n"
    built = rf.read_structure(write(content))
    frame = rf.Frame(**(FRAME | {"n_stories": 2, "stiffness_ratio": math.inf}))
    expected = rf.Restrained(
        rf.YieldingStories(rf.Leaning(frame, [2e4, 1e4]), [2e5, 1.5e5], 0.05),
        [rf.ViscousDamper(3e5, between=(0, 2), cosine=0.8), rf.GapBar(1e7, 0.01, height=3.0)],
    )
    assert built == expected


@pytest.mark.parametrize(
    ("more", "place"),
    [
        (STORIES.replace("1.5e5", "-1.0"), "[stories]"),
        ("[[elements]]\nkind = 'viscous_damper'\ncoefficient = 3e5\nbetween = [0, 9]\n", "[[elements]] no. 1"),
        ("[[elements]]\nkind = 'viscous_damper'\ncoefficient = 3e5\nheight = 99.0\n", "[[elements]] no. 1"),
    ],
)
def test_wrong_stories_and_places(failing, more, place):
    assert place in failing(text("frame", FRAME | {"stiffness_ratio": math.inf}) + more)


def test_leaning_mass_needs_floors(failing):
    assert "leaning_mass" in failing(
        "leaning_masses = 1e4\nblock = { slenderness = 0.2, half_diagonal = 2.5, mass = 5e3 }"
    )
