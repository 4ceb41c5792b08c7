"""A case: what is written is read again, with the same numbers, and a wrong file says what is wrong."""

import json
import math
import tomllib
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

import rockflex as rf
from builders import frame_values, make_frame
from rockflex.cli._app import app
from rockflex.studies._arguments import ground_under_structure

FRAME = make_frame(n_stories=2, period=0.5, aspect_ratio=8.0)
PULSE = rf.one_sine_pulse(amplitude=3.0, period=0.8)
QUAKE = rf.GroundMotion(
    np.sin(0.09 * np.arange(120)) * math.pi, 0.01, "two/2", rf.RecordInfo(event="Ærø", year=1990, rsn=7)
)
SUITE = {"suites": ["el-centro-1940"]}
BLOCK = "block = { slenderness = 0.2, half_diagonal = 3.0, mass = 50e3 }\n"
CASE = f'models = ["rigid"]\n[records]\nsuites = ["el-centro-1940"]\n[[structures]]\nname = "a"\n{BLOCK}'


@pytest.fixture
def file(tmp_path):
    def written(text, name="case.toml"):
        path = tmp_path / name
        path.write_text(text, "utf-8")
        return path

    return written


@pytest.fixture
def message(file):
    def said(text):
        path = file(text)
        with pytest.raises(rf.InputError) as caught:
            rf.read_case(path).run()
        return str(caught.value)

    return said


def test_a_case_runs_what_simulate_many_runs(file):
    text = CASE.replace("[records]", "scales = [0.5, 2.0]\nfree_vibration = 3.0\n[records]")
    block = rf.rigid_block(slenderness=0.2, half_diagonal=3.0, mass=50e3)
    records = rf.load_suite("el-centro-1940")
    expected = rf.simulate_many({"a": block}, records, "rigid", scales=[0.5, 2.0], free_vibration=3.0)
    pd.testing.assert_frame_equal(rf.read_case(file(text)).run(), expected)
    whole = rf.read_case(file(text)).run("history")
    assert whole["response"][1].max_rotation == expected["max_rotation"][1] > 0.0


STRUCTURES = {
    "frame": FRAME,
    "tied, on one side": rf.Restrained(rf.Eccentric(FRAME, 0.1), [rf.Tendon(1e5, 5e6), rf.GapBar(1e6, 0.01)]),
    "leaning": rf.Leaning(FRAME, 1e4),
    "yields": rf.YieldingStories(FRAME, [4e5, 3e5], 0.05),
    "modes": FRAME.rocking(),
    "block": rf.rigid_block(slenderness=0.2, half_diagonal=3.0),
}


@pytest.mark.parametrize("name", STRUCTURES)
def test_structures_of_python_are_written_as_tables(name, tmp_path):
    case = rf.Case(structures={name: STRUCTURES[name]}, records=SUITE, models="rigid")
    again = rf.read_case(case.write(tmp_path / "case.toml"))
    assert again.document() == case.document()
    assert again.structure_names == [name]
    assert again.runs()[0].properties == case.runs()[0].properties


def test_a_structure_that_a_file_can_describe_is_a_table_as_in_its_file(tmp_path):
    case = rf.Case(structures={"tied": STRUCTURES["tied, on one side"]}, records=SUITE)
    row = tomllib.loads(case.to_toml())["structures"][0]
    assert row["frame"]["period"] == 0.5
    assert row["eccentricity"] == 0.1
    assert [each["kind"] for each in row["elements"]] == ["tendon", "gap_bar"]


def test_everything_of_python_comes_back_and_gives_the_same_numbers(tmp_path):
    case = rf.Case(
        name="all",
        structures={"free": FRAME, "tied": rf.Restrained(FRAME, rf.Tendon(1e5, 5e6))},
        records={"pulse": PULSE, "two/2": QUAKE},
        models=["2DOF-S", "MDOF-S"],
        impact=rf.Restitution(0.9),
        ground=rf.Ground(friction=0.4),
        initial=rf.InitialState(rotation=0.001),
        scales=[1.0, 1.5],
        free_vibration=1.0,
        work_limit=None,
    )
    path = case.write(tmp_path / "all.toml")
    again, expected = rf.read_case(path), case.run()
    assert len(expected) == 16
    assert expected["error"].isna().all()
    pd.testing.assert_frame_equal(again.run(), expected)
    motions = again.records.load(tmp_path)
    assert motions.names == ("pulse", "two/2")
    assert motions[1].metadata.rsn == 7
    # Written again, beside or elsewhere, it is the same.
    assert again.write(tmp_path / "again.toml").read_text() == path.read_text()
    (tmp_path / "deep").mkdir()
    pd.testing.assert_frame_equal(rf.read_case(again.write(tmp_path / "deep" / "moved.toml")).run(), expected)


options = st.fixed_dictionaries(
    {},
    optional={
        "name": st.text(st.characters(codec="utf-8", exclude_categories=["Cs", "Cc"]), max_size=20),
        "models": st.lists(st.sampled_from(["2DOF-S", "MDOF-C", "rigid", "fixed"]), min_size=1, unique=True),
        "scales": st.lists(st.floats(-10.0, 10.0), min_size=1, max_size=3),
        "free_vibration": st.floats(0.0, 100.0) | st.just("settle"),
        "work_limit": st.floats(0.1, 100.0) | st.none(),
        "impact": st.sampled_from(["simplified", "complete"]) | st.floats(0.0, 1.0).map(rf.Restitution),
        "ground": st.floats(0.1, 1.0).map(lambda mu: rf.Ground(friction=mu))
        | st.floats(0.1, 1.0).map(lambda mu: {"friction": mu}),
        "bouc_wen": st.floats(0.01, 1.0).map(rf.BoucWen),
        "initial": st.floats(-0.2, 0.2).map(rf.InitialState),
    },
)


@given(options, options)
def test_options_come_back(everything, own):
    own = {name: value for name, value in own.items() if name not in ("name", "scales", "free_vibration", "work_limit")}
    row = {"name": "x", "frame": frame_values(), **own}
    case = rf.Case(structures=[row], records=SUITE, **everything)
    again = rf.Case(**tomllib.loads(case.to_toml()))
    assert again.document() == case.document()
    (one,), (other,) = case.runs(), again.runs()
    grounds = [ground_under_structure(each.properties, each.options.pop("ground")) for each in (one, other)]
    assert grounds[0] == grounds[1]
    assert one == other
    assert again.to_toml() == case.to_toml()


def test_a_structure_may_have_options_of_its_own(file):
    file(BLOCK + 'impact = "restitution"\nrestitution = 0.5\n[ground]\nfriction = 0.3\n', "block.toml")
    text = CASE + (
        '[[structures]]\nname = "b"\nfile = "block.toml"\nmodels = ["rigid", "rigid-C"]\n'
        f'[[structures]]\n{BLOCK}impact = "restitution"\nrestitution = 0.95\ninitial = {{ rotation = 0.05 }}\n'
        '[[structures]]\nfile = "block.toml"\nimpact = "simplified"\nground = { friction = 0.9 }\n'
    )
    case = rf.read_case(file(text))
    first, second, third, fourth = case.runs()
    assert [first.options[name] for name in ("impact", "ground", "initial")] == [None, None, None]
    assert (second.name, second.models, second.options["impact"]) == ("b", ("rigid", "rigid-C"), rf.Restitution(0.5))
    assert second.options["ground"](second.properties).friction == 0.3
    assert (third.name, third.options["impact"]) == ("S3", rf.Restitution(0.95))
    assert third.options["initial"] == rf.InitialState(rotation=0.05)
    assert fourth.options["impact"] == rf.VVELSimplified()
    assert fourth.options["ground"](fourth.properties).friction == 0.9
    table = case.run()
    assert table["structure"].tolist() == ["a", "b", "b", "S3", "S4"]
    assert table["model"].tolist() == ["rigid", "rigid", "rigid-C", "rigid", "rigid"]
    alone = rf.simulate_many(first.properties, rf.load_suite("el-centro-1940"), "rigid", **third.options)
    assert table["max_rotation"][3] == alone["max_rotation"][0]
    assert rf.read_case(case.write(file("", "again.toml"))).document() == case.document()


def test_progress_counts_the_runs_of_all_structures(file):
    seen = []
    text = CASE + f'[[structures]]\n{BLOCK}models = ["rigid", "rigid-C"]\n'
    rf.read_case(file(text)).run(progress=lambda done, total: seen.append((done, total)))
    assert seen[0] == (0, 3)
    assert seen[-1] == (3, 3)


def test_single_files_of_records_have_their_names_units_and_factors(file, tmp_path):
    np.savetxt(tmp_path / "a.txt", [[0.0, 0.0], [0.01, 0.1], [0.02, 0.0]])
    (tmp_path / "b.csv").write_text("time (s),acc (g)\n0,0\n0.01,0.2\n0.02,0\n")
    text = CASE.replace(
        'suites = ["el-centro-1940"]', 'files = ["b.csv", { file = "a.txt", units = "g", scale = 2.0 }]'
    )
    loaded = rf.read_case(file(text)).records.load(tmp_path)
    assert loaded.names == ("b", "a")
    assert loaded["a"].pga == loaded["b"].pga == pytest.approx(0.2 * 9.81)
    study = rf.CloudStudy(structures=FRAME, records={"files": [str(tmp_path / "b.csv")]})
    assert study.plan().n_runs == 1


def test_a_file_with_a_question_is_a_study(file, tmp_path):
    path = file(f'study = "cloud"\n{CASE}')
    study = rf.read_case(path)
    assert isinstance(study, rf.CloudStudy)
    table = study.run()
    pd.testing.assert_frame_equal(table, rf.run_study(path))
    stored = study.run(tmp_path / "results")
    again = rf.read_case(tmp_path / "results")
    assert again.document() == study.document()
    pd.testing.assert_frame_equal(again.run(tmp_path / "results"), stored)  # it is resumed
    assert rf.read_case(study.write(tmp_path / "copy.toml")).document() == study.document()


def test_a_study_of_python_is_written_and_read(tmp_path):
    study = rf.CloudStudy(structures={"frame": FRAME}, records=[PULSE, QUAKE], models="2DOF-S", scales=[0.5, 1.0])
    again = rf.read_case(study.write(tmp_path / "cloud.toml"))
    assert again.document()["structures"] == study.document()["structures"]
    pd.testing.assert_frame_equal(again.run(), study.run())


def test_a_study_may_have_tables_beside_objects(tmp_path):
    path = rf.CloudStudy(structures={"frame": FRAME}, records=SUITE).write(tmp_path / "cloud.toml")
    path.write_text(f'{path.read_text()}\n[[structures]]\nname = "block"\n{BLOCK}')
    study = rf.read_case(path)
    assert [each["name"] for each in study.document()["structures"]] == ["frame", "block"]
    assert study.document()["structures"][1]["block"]["mass"] == 50e3
    assert rf.read_case(study.write(tmp_path / "again.toml")).document() == study.document()
    assert study.run()["structure"].tolist() == ["frame", "block"]


def test_a_study_may_name_structure_files(file, tmp_path):
    file(BLOCK, "block.toml")
    text = f'study = "cloud"\n{CASE}[[structures]]\nname = "b"\nfile = "block.toml"\n'
    study = rf.read_case(file(text, "cloud.toml"))
    table = study.run(tmp_path / "stored")
    assert table["max_rotation"][0] == table["max_rotation"][1] > 0.0
    (tmp_path / "deep").mkdir()
    assert rf.read_case(study.write(tmp_path / "deep" / "cloud.toml")).run().equals(study.run())
    file(BLOCK.replace("0.2", "0.3"), "block.toml")  # the stored results are not of this structure
    with pytest.raises(rf.InputError, match=r"structures\[1\]\.file"):
        study.run(tmp_path / "stored")
    file(f"{BLOCK}[ground]\nfriction = 0.3\n", "block.toml")
    with pytest.raises(rf.InputError, match=r"no\. 2, 'b': block\.toml has ground"):
        study.run()


def test_infinite_numbers_of_a_folder_are_numbers(tmp_path):
    study = rf.CloudStudy(structures=[{"name": "inf", "frame": frame_values()}], records=SUITE)
    study.run(tmp_path / "stored")
    again = rf.read_case(tmp_path / "stored")
    assert again.structures[0].name == "inf"
    assert again.structures[0].frame.stiffness_ratio == math.inf


def test_a_project_is_read_too(tmp_path):
    project = rf.Project({"block": STRUCTURES["block"]}, PULSE, "rigid")
    assert rf.read_case(project.save(tmp_path / "block.rockflex")) == project


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (CASE.replace("[records]", "[record]"), ["case.toml", "records is missing", "record is not known"]),
        (CASE.replace('["el-centro-1940"]', "[]"), ["[records]", "files = "]),
        (CASE.replace("suites", "suite"), ["[records] suite is not known"]),
        (CASE.replace('models = ["rigid"]', 'models = ["2DOF-X"]'), ["models", "2DOF-X"]),
        (CASE.replace("[records]", "scale = 2.0\n[records]"), ["scale is not known", "scales"]),
        (CASE.replace("name =", "nam ="), ["[[structures]] no. 1, nam is not known"]),
        (
            CASE.replace("slenderness = 0.2", "slenderness = -1.0"),
            ["[[structures]] no. 1, 'a': [block]", "slenderness"],
        ),
        (CASE.partition("[[")[0], ["structures is missing"]),
        (f"{CASE}[[structures]]\nname = 'a'\n{BLOCK}", ["names of the structures", "'a' occurs more than once"]),
        (f"{CASE}file = 'x.toml'\n", ["[[structures]] no. 1", "block was given besides file"]),
        (f"{CASE}object = 3\n", ["object", '"class"']),
        (f"{CASE}object = {{ class = 'Frames' }}\n", ["class must be the name of one of rockflex's", "Frames"]),
        (f"{CASE}[[structures]]\nfile = 'none.toml'\n", ["no. 2", "none.toml does not exist"]),
        (f"{CASE}[[structures]]\nfile = 'case.toml'\n", ["no. 2", "is a case or a study"]),
        (f"{CASE}impact = 'restitution'\n", ["no. 1, 'a'", "needs its coefficient"]),
        (f"{CASE}initial = {{ angle = 1.0 }}\n", ["initial", "angle is not known", "rotation"]),
        (f"{CASE}impact = {{ class = 'Restitution' }}\n", ["impact", "Restitution cannot be made"]),
        (CASE.replace("suites", "files = ['none.csv']\nsuites"), ["none.csv"]),
        (CASE.replace("suites", "files = [{ name = 'x' }]\nsuites"), ["[[records.files]] no. 1", "file is missing"]),
        (BLOCK, ["is the file of a structure", "[records]", "read_structure"]),
        ("models = [", ["is not a valid TOML file"]),
    ],
)
def test_what_is_wrong_is_said(message, text, words):
    said = message(text)
    for word in words:
        assert word in said


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(rf.InputError, match=r"The case file .*none\.toml does not exist"):
        rf.read_case(tmp_path / "none.toml")


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"records": PULSE}, ["records", "write(path)", "files"]),
        ({"ground": lambda properties: rf.Ground(friction=0.3)}, ["ground is a function", "friction"]),
    ],
)
def test_what_no_text_holds_is_said(given, words):
    case = rf.Case(**{"structures": FRAME, "records": SUITE, **given})
    with pytest.raises(rf.InputError) as caught:
        case.to_toml()
    for word in words:
        assert word in str(caught.value)


def test_nothing_is_written_if_something_cannot_be(tmp_path):
    study = rf.CloudStudy(structures=FRAME, records=PULSE, demands={"roof": lambda response: 1.0})
    with pytest.raises(rf.InputError, match="demands was given as a function"):
        study.write(tmp_path / "case.toml")
    assert list(tmp_path.iterdir()) == []


def test_a_folder_of_a_study_with_objects_says_so(tmp_path):
    study = rf.CloudStudy(structures=FRAME, records=PULSE, models="2DOF-S")
    study.run(tmp_path / "stored")
    with pytest.raises(rf.InputError, match="structures and records cannot be read"):
        rf.read_case(tmp_path / "stored")


def test_matrices_in_files_follow_the_case(tmp_path):
    np.savetxt(tmp_path / "k.csv", [[2e7, -1e7], [-1e7, 1e7]], delimiter=",")
    table = {"mass": [1e4, 1e4], "stiffness": "k.csv", "heights": [3.0, 6.0], "base_mass": 1e4}
    table |= {"half_width": 1.0, "damping_ratio": 0.02}
    case = rf.Case(structures=[{"matrices": table}], records=SUITE).read_from(tmp_path)
    (tmp_path / "deep").mkdir()
    path = case.write(tmp_path / "deep" / "case.toml")
    assert Path(tomllib.loads(path.read_text())["structures"][0]["matrices"]["stiffness"]) == Path("../k.csv")
    assert rf.read_case(path).runs()[0].properties == case.runs()[0].properties


def test_a_case_in_place_of_a_structure_is_told(file):
    with pytest.raises(rf.InputError, match=r"is the file of a case.*read_case"):
        rf.read_structure(file(CASE))


SEVERAL = f'{CASE}[[structures]]\nname = "b"\nmodels = ["rigid", "rigid-C"]\n{BLOCK}initial = {{ rotation = 0.05 }}\n'


def invoke(*arguments):
    return CliRunner().invoke(app, [*map(str, arguments)], env={"COLUMNS": "200"})


def test_the_command_line_runs_a_case(file):
    path = file(SEVERAL.replace("[records]", "scales = [1.0, 2.0]\n[records]"))
    result = invoke("run", path, "--json")
    assert result.exit_code == 0, result.stderr
    rows = [row for each in json.loads(result.stdout)["structures"] for row in each["runs"]]
    expected = rf.read_case(path).run()
    found = {(row["model"], row["scale"], row["max_rotation"], row["status"]) for row in rows}
    assert found == set(expected[["model", "scale", "max_rotation", "status"]].itertuples(index=False, name=None))
    assert len(rows) == len(expected) == 6


def test_the_command_line_prints_and_stores_each_structure(file, tmp_path):
    result = invoke("run", file(SEVERAL), "--out", tmp_path / "results", "--figures", 0)
    assert result.exit_code == 0, result.stderr
    assert result.stdout.count("a: rigid") == result.stdout.count("b: rigid") == 1
    assert len(pd.read_csv(tmp_path / "results" / "b" / "results.csv")) == 2
    alone = invoke("run", file(CASE), "--out", tmp_path / "alone", "--figures", 0)
    assert alone.exit_code == 0, alone.stderr
    assert (tmp_path / "alone" / "results.csv").exists()


@pytest.mark.parametrize(
    ("flags", "named"),
    [
        (["el-centro-1940"], "el-centro-1940"),
        (["--model", "rigid"], "--model"),
        (["--scale", "1"], "--scale"),
        (["--ground-friction", "0.3"], "--ground-friction"),
        (["--initial-rotation", "0.1"], "--initial-rotation"),
    ],
)
def test_what_a_case_has_is_not_given_twice(file, flags, named):
    result = invoke("run", file(CASE), *flags)
    assert result.exit_code == 2
    assert f"is a case, which has structures, records, models and options, but {named} was given" in result.stderr


def test_another_command_names_the_one_for_a_case(file):
    result = invoke("modes", file(CASE))
    assert result.exit_code == 2
    assert "is a case" in result.stderr
    assert "rockflex run" in result.stderr


def test_a_report_of_a_case_is_of_one_structure(file, tmp_path):
    assert invoke("run", file(CASE), "--report", tmp_path / "run.html").exit_code == 0
    result = invoke("run", file(SEVERAL), "--report", tmp_path / "several.html")
    assert result.exit_code == 2
    assert "of one structure, but the case has 2" in result.stderr
