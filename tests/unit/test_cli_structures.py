"""Structures from files and flags."""

import numpy as np
import pytest

import rockflex as rf
from builders import PROPERTIES, frame_values
from rockflex import Eccentric, Frame, InputError, read_structure
from rockflex.cli._structures import describe_rocking_properties, load_structure, split_structure_file_argument

FRAME = frame_values()
NO_FLAGS = {}


def toml(values, table="frame"):
    return f"[{table}]\n" + "".join(f"{key} = {value!r}\n" for key, value in values.items())


@pytest.fixture
def write(tmp_path):
    def file(text):
        path = tmp_path / "structure.toml"
        path.write_text(text, "utf-8")
        return path

    return file


@pytest.fixture
def failing(write):
    def message(text):
        path = write(text)
        with pytest.raises(InputError) as caught:
            load_structure(path, NO_FLAGS)
        assert str(caught.value).startswith(str(path))
        return str(caught.value).removeprefix(str(path))

    return message


def test_frame_by_file_and_by_flags_are_the_same(write):
    by_file = load_structure(write(toml(FRAME)), NO_FLAGS)
    by_flags = load_structure(None, FRAME)
    assert by_file.built == by_flags.built == Frame(**FRAME)
    assert by_file.name == "structure"
    assert by_flags.name == "5-story frame"
    assert by_file.describe() == {"name": "structure", "kind": "frame", **FRAME}


TOWER = {
    "height": 200.0,
    "base_radius": 8.0,
    "top_radius": 4.0,
    "wall": 1.0,
    "density": 2400.0,
    "elastic_modulus": 25e9,
    "damping_ratio": 0.02,
}
PIER = {
    "height": 12.0,
    "tip_mass": 500e3,
    "bending_stiffness": 4e10,
    "base_mass": 120e3,
    "half_width": 1.5,
    "damping_ratio": 0.03,
}
TENDON = "[[elements]]\nkind = 'tendon'\ninitial_force = 2e6\nstiffness = 25e6\n"


def test_mass_above_the_base_is_that_of_any_structure(write):
    tower = load_structure(write(toml(TOWER, "tapered_tower")), NO_FLAGS)
    assert tower.base_mass == 0.0
    assert tower.reference_mass == pytest.approx(2200.0 * np.pi * 2400.0)  # Eq. 35: 17 600/8 π ρ
    pier = load_structure(write(toml(PIER, "cantilever")), NO_FLAGS)
    held = load_structure(write(toml(PIER, "cantilever") + TENDON), NO_FLAGS)
    assert pier.base_mass == held.base_mass == 120e3
    assert pier.reference_mass == held.reference_mass == pytest.approx(500e3)
    assert load_structure(write(toml(PROPERTIES, "properties")), NO_FLAGS).base_mass is None


def test_tendons_are_described(write):
    held = load_structure(write(toml(PIER, "cantilever") + TENDON), NO_FLAGS)
    assert held.kind == "cantilever"
    assert held.describe()["elements"] == [{"kind": "tendon", "position": 0.0, "initial_force": 2e6, "stiffness": 25e6}]
    described = describe_rocking_properties(held.properties)
    assert described["tendons"] == held.properties.tendons
    assert described["prestress"] == 2e6
    assert described["tendon_stiffness"] == pytest.approx(25e6 * 1.5**2)
    assert "tendons" not in describe_rocking_properties(load_structure(None, FRAME).properties)


def test_an_eccentric_base_is_described(write):
    text = "eccentricity = -0.2\n" + toml(FRAME)
    moved = load_structure(write(text), NO_FLAGS)
    flags = load_structure(None, {**FRAME, "eccentricity": -0.2})
    assert moved.built == flags.built == Eccentric(Frame(**FRAME), -0.2)
    assert moved.describe() == {"name": "structure", "kind": "frame", **FRAME, "eccentricity": -0.2}
    assert {**moved.describe(), "name": ""} == {**flags.describe(), "name": ""}
    assert moved.title == "structure: 5 modes, T_1 = 1 s, h*_1/B = 10, ζ_1 = 0.02, e = -0.2 m"
    held = load_structure(write(text + TENDON), NO_FLAGS)
    assert held.base_mass == moved.base_mass == 40e3
    described = describe_rocking_properties(moved.properties)
    assert described["eccentricity"] == -0.2
    right, left = described["pivots"]
    assert (right["side"], left["side"]) == (1, -1)
    assert left["resisting_moment"] == moved.properties.resisting_moment < right["resisting_moment"]
    assert "pivots" not in describe_rocking_properties(load_structure(None, FRAME).properties)


def test_title_of_an_eccentric_rigid_block(write):
    block = load_structure(write("eccentricity = 0.25\n[block]\nslenderness = 0.2\nhalf_diagonal = 3.0\n"), NO_FLAGS)
    assert block.title == f"structure: rigid, B/h = {np.tan(0.2):.4g}, e = 0.25 m"


def test_title_tells_what_counts():
    assert load_structure(None, FRAME).title == "5-story frame: 5 modes, T_1 = 1 s, h*_1/B = 10, ζ_1 = 0.02"
    assert "1 mode," in load_structure(None, {**FRAME, "n_stories": 1}).title


def test_title_of_a_rigid_block(write):
    block = load_structure(write("[block]\nslenderness = 0.2\nhalf_diagonal = 3.0\n"), NO_FLAGS)
    assert block.title == f"structure: rigid, B/h = {np.tan(0.2):.4g}"


def test_unknown_key_is_named_with_its_neighbour(failing):
    message = failing(toml({**FRAME, "story_hieght": 3.0}))
    assert message == (
        ": [frame] story_hieght is not known; there are n_stories, story_height, story_mass, base_mass, "
        "stiffness_ratio, period, aspect_ratio, damping_ratio. Did you mean story_height?"
    )


def test_unknown_keys_of_a_table_are_listed_once(failing):
    message = failing(toml({**FRAME, "story_hieght": 3.0, "damping": 0.02, "colour": 1}))
    assert message.count("not known") == message.count("n_stories") == 1
    assert "[frame] story_hieght, damping, colour are not known" in message
    assert "story_height for story_hieght" in message


@pytest.mark.parametrize(
    ("kind", "command"), [("cloud", "cloud"), ("incremental", "ida"), ("monte_carlo", "monte-carlo")]
)
def test_the_file_of_a_study_names_its_command(write, kind, command):
    file = write(f'study = "{kind}"\nmodels = ["2DOF-S"]\nscales = [1.0]\n[records]\nsuites = []\n')
    with pytest.raises(InputError) as error:
        load_structure(file, NO_FLAGS)
    assert f"rockflex {command} {file}" in str(error.value)
    assert "not known" not in str(error.value)
    with pytest.raises(InputError, match="load_study"):
        read_structure(file)


def test_the_file_of_an_unknown_study(write):
    with pytest.raises(InputError, match="file of a study"):
        load_structure(write('study = ["cluod"]\n'), NO_FLAGS)


def test_unknown_table(failing):
    message = failing(toml(FRAME, "frmae"))
    assert message.startswith(": frmae is not known; there are name, frame, fish_bone, ")
    assert message.endswith("Did you mean frame?")


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("story_mass", "heavy", "[frame] story_mass must be the mass of each floor, a number in kg, but 'heavy'"),
        ("story_mass", "40e3", "[frame] story_mass must be the mass of each floor, a number in kg, but '40e3'"),
        ("story_mass", [1.0], "[frame] story_mass must be the mass of each floor, a number in kg, but [1.0]"),
        ("n_stories", 5.0, "[frame] n_stories must be the number of stories, a whole number, but 5.0"),
    ],
)
def test_wrong_type(failing, key, value, said):
    assert failing(toml({**FRAME, key: value})) == f": {said} was given."


def test_booleans_are_no_numbers(failing):
    text = toml(FRAME).replace("period = 1.0", "period = true")
    assert failing(text).startswith(": [frame] period must be the first period on a fixed base, a number in s, but")


def test_every_problem_is_told_once(failing):
    values = {
        "masses": "heavy",
        "stiffness": [[1.0]],
        "heights": [1.0, "top"],
        "half_width": 1.0,
        "damping_ratio": 0.02,
    }
    said = failing(toml(values, "lumped"))
    for problem in ("[lumped] masses must be", "[lumped] heights must be", "[lumped] base_mass is missing"):
        assert said.count(problem) == 1


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"story_mass": -4.0}, "story_mass must be a positive, finite number in kg, but -4.0 was given."),
        ({"period": float("nan")}, "period must be a positive, finite number in s, but nan was given."),
        ({"damping_ratio": 2.0}, "damping_ratio must lie in [0, 1), but 2.0 was given. Give the fraction"),
    ],
)
def test_values_out_of_range_name_file_and_table(failing, change, said):
    assert failing(toml({**FRAME, **change})).startswith(f", [frame]: {said}")


@pytest.mark.parametrize(
    ("text", "found"),
    [("", "none was"), (toml(FRAME) + toml(PROPERTIES, "properties"), "[frame] and [properties] were")],
)
def test_one_structure_a_file(failing, text, found):
    message = failing(text)
    assert message.startswith(": one structure is expected, [frame], [fish_bone], ")
    assert message.endswith(f"[block] or [rocking_frame], but {found} found.")


def test_a_table_is_expected(failing):
    assert failing("frame = 3\n") == ": frame must be a table, but 3 was given."
    assert failing("name = 3\n" + toml(FRAME)) == ": name must be a name, in quotes, but 3 was given."


def test_not_toml(failing, tmp_path):
    assert " is not a valid TOML file: " in failing("[frame\n")
    binary = tmp_path / "binary.toml"
    binary.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="is not a valid TOML file: "):
        load_structure(binary, NO_FLAGS)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be"])
def test_encodings_of_windows(tmp_path, encoding):
    text = "# Außenmaße\r\n" + toml(FRAME).replace("\n", "\r\n")
    (tmp_path / "a.toml").write_bytes(text.encode(encoding))
    plain = tmp_path / "b.toml"
    plain.write_text(toml(FRAME))
    assert rf.read_structure(tmp_path / "a.toml") == rf.read_structure(plain)
    (tmp_path / "a.toml").write_bytes(text.encode("latin-1"))
    with pytest.raises(InputError, match=r"is not a valid TOML file: .* Save it as UTF-8\."):
        load_structure(tmp_path / "a.toml", NO_FLAGS)


def test_file_that_cannot_be_read(tmp_path):
    with pytest.raises(InputError, match=r"The structure file .*x\.toml does not exist \(working directory: "):
        load_structure(tmp_path / "x.toml", NO_FLAGS)
    with pytest.raises(InputError, match=r" is a folder, but a regular file is expected\. Give a file in it\.$"):
        load_structure(tmp_path, NO_FLAGS)


def test_file_and_flags_exclude_each_other(write):
    with pytest.raises(InputError, match=r"was given by .* and by --stories, --period\. Give one or the other\."):
        load_structure(write(toml(FRAME)), {"n_stories": 5, "period": 1.0})


def test_missing_flags_are_named():
    with pytest.raises(InputError, match=r"The frame lacks --period, --damping-ratio\. Give a structure file"):
        load_structure(None, {name: FRAME[name] for name in FRAME if name not in ("period", "damping_ratio")})
    with pytest.raises(InputError, match=r"No structure was given\. Give a structure file, such as structure\.toml,"):
        load_structure(None, NO_FLAGS)


def test_structure_is_the_first_argument_or_an_option(tmp_path):
    path = tmp_path / "a.toml"
    assert split_structure_file_argument(None, [str(path), "m"]) == (path, ["m"])
    assert split_structure_file_argument(path, ["m", "n"]) == (path, ["m", "n"])
    assert split_structure_file_argument(None, []) == (None, [])
    with pytest.raises(InputError, match=r"Two structures were given, .*a\.toml and b\.toml\. Give one at a time\."):
        split_structure_file_argument(path, ["b.toml"])
