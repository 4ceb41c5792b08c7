"""What may stand in a study's file, and what is said of what may not."""

import json
import math
import pickle
from pathlib import Path

import numpy as np
import pytest

import rockflex as rf
from rockflex.foundation.schema import IMPACT
from rockflex.papers.silva_stojadinovic_2024.population import PopulationStudy
from rockflex.studies import load_study
from rockflex.studies._run_plan import run_plan
from rockflex.studies.cloud import CloudStudy
from rockflex.studies.incremental import IncrementalStudy
from rockflex.studies.stripes import StripeStudy

EXAMPLES = Path(__file__).parents[2] / "examples"
STRUCTURE = """
[[structures]]
name = "one"
[structures.frame]
n_stories = 2
story_height = 3.0
story_mass = 40e3
base_mass = 40e3
stiffness_ratio = inf
period = 0.5
aspect_ratio = 8
damping_ratio = 0.02
"""
RECORDS = """
[records]
suites = ["el-centro-1940"]
"""
CLOUD = f'study = "cloud"\n{RECORDS}{STRUCTURE}'


@pytest.fixture
def read(tmp_path):
    def file(text):
        path = tmp_path / "study.toml"
        path.write_text(text, "utf-8")
        return load_study(path)

    return file


@pytest.fixture
def failing(read, tmp_path):
    def message(text):
        with pytest.raises(rf.InputError) as caught:
            read(text).plan()
        return str(caught.value).removeprefix(f"{tmp_path / 'study.toml'}: ")

    return message


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "kind", "runs"),
    [
        ("cloud", CloudStudy, 2592),
        ("population", PopulationStudy, 2000),
        ("incremental", IncrementalStudy, 2420),
        ("controlled_rocking_walls", rf.MonteCarloStudy, 4000),
    ],
)
def test_examples_load(name, kind, runs):
    study = load_study(EXAMPLES / f"{name}.toml")
    assert isinstance(study, kind)
    plan = study.plan()
    assert plan.n_runs == runs
    plan = study.model_copy(update={"runs_per_chunk": 1}).plan()  # the smallest chunks have the same columns
    assert plan.chunk(plan.n_chunks - 1).schema.equals(pickle.loads(pickle.dumps(plan)).chunk(0).schema)


def test_file_and_python_are_the_same(read):
    frame = {"n_stories": 2, "story_height": 3.0, "story_mass": 40e3, "base_mass": 40e3, "stiffness_ratio": math.inf}
    frame |= {"period": 0.5, "aspect_ratio": 8, "damping_ratio": 0.02}
    built = CloudStudy(records={"suites": ["el-centro-1940"]}, structures=[{"name": "one", "frame": frame}])
    assert read(CLOUD).document() == built.document()
    assert run_plan(read(CLOUD).plan()).equals(run_plan(built.plan()))
    assert pickle.loads(pickle.dumps(built)).document() == built.document()


def test_document_is_json_and_tells_studies_apart(read):
    document = read(CLOUD).document()
    assert json.loads(json.dumps(document, allow_nan=False)) == document
    assert document["structures"][0]["frame"]["stiffness_ratio"] == "inf"
    assert document["study"] == "cloud"
    assert read(CLOUD.replace("0.5", "0.6")).document() != document


def test_paths_start_from_the_file(tmp_path, monkeypatch):
    folder = tmp_path / "deep"
    (folder / "records").mkdir(parents=True)
    np.savetxt(folder / "records" / "quake.csv", np.sin(np.arange(100)), header="acc (m/s2)")
    np.save(folder / "unused.npy", np.eye(2))
    np.savetxt(folder / "k.csv", [[2e7, -1e7], [-1e7, 1e7]], delimiter=",")
    (folder / "study.toml").write_text(
        'study = "cloud"\n[records]\nfolder = "records"\n[[structures]]\n[structures.matrices]\n'
        'mass = [1e4, 1e4]\nstiffness = "k.csv"\nheights = [3.0, 6.0]\nbase_mass = 1e4\nhalf_width = 1.0\n'
        "damping_ratio = 0.02\n"
    )
    monkeypatch.chdir(tmp_path)
    with pytest.raises(rf.InputError, match="dt"):  # the folder is found, and the file has no step
        load_study("deep/study.toml").plan()
    lines = ["time (s), acc (m/s2)", *(f"{0.01 * k:.2f}, {math.sin(k):.6f}" for k in range(100))]
    (folder / "records" / "quake.csv").write_text("\n".join(lines))
    table = run_plan(load_study("deep/study.toml").plan())
    assert table["motion"].tolist() == ["quake"]
    assert table["error"].isna().all()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (RECORDS + STRUCTURE, 'study must be one of "cloud", "incremental", "stripes", "population", "monte_carlo",'),
        (CLOUD.replace('"cloud"', '"clod"'), "study must be one of "),
        (CLOUD.replace('"cloud"', "7"), "study must be one of "),
        ("scale = [1.0]\n" + CLOUD, "scale is not known; there are name, records, "),
        ("scales = 2.0\n" + CLOUD, "largest = 3.0, step = 0.25}, but 2.0 was given."),
        ("scales = []\n" + CLOUD, "largest = 3.0, step = 0.25}, but [] was given."),
        ("scales = [inf]\n" + CLOUD, "scales must be one or more finite factors, but [inf] was given."),
        ("scales = [1e308]\n" + CLOUD, "scales must keep the accelerations finite, but the factor 1e+308 was given"),
        ('models = ["2DOF-X"]\n' + CLOUD, "models: Unknown model '2DOF-X'. Expected"),
        ('models = ["2DOF-S", "2DOF-S"]\n' + CLOUD, "models: '2DOF-S' occurs more than once. Give each once."),
        ("friction = 1\n" + CLOUD, "friction must be true or false: whether to find the required friction too"),
        ("runs_per_chunk = 0\n" + CLOUD, "runs_per_chunk must be about how many runs to compute and store together"),
        ('impact = "soft"\n' + CLOUD, f"impact must be {IMPACT.expected}, but 'soft' was"),
        ('impact = "restitution"\n' + CLOUD, 'The impact law "restitution" needs its coefficient. Give restitution,'),
        ("restitution = 0.5\n" + CLOUD, "A restitution of 0.5 was given, but the impact law is the model's own."),
        ("free_vibration = -1.0\n" + CLOUD, "free_vibration must be zero or more seconds"),
        ('free_vibration = "long"\n' + CLOUD, "free_vibration must be the free vibration after the record, a number"),
        (CLOUD.replace('suites = ["el-centro-1940"]', ""), "[records]: no record is named. Give suites = "),
        (CLOUD.replace("el-centro-1940", "el-centro"), "No embedded suite is named 'el-centro'. The suites are"),
        (CLOUD.replace("[records]", '[records]\ninclude = ["X*"]'), "[records] include: no record's name fits 'X*'."),
        (CLOUD.replace("[records]", '[records]\nfolder = "none"'), ""),
        (
            CLOUD.replace("[records]", '[records]\non_error = "skip"'),
            "[records]: on_error is for the files of a folder",
        ),
        (CLOUD.replace("suites", "suite"), "[records] suite is not known; there are suites, folder, on_error,"),
        (CLOUD.replace(RECORDS, ""), "records is missing: a table of suites, a folder or files."),
        (CLOUD.replace(STRUCTURE, ""), "structures is missing: one or more tables [[structures]]."),
        (CLOUD + STRUCTURE, "the names of the structures: 'one' occurs more than once. Give each once."),
        (CLOUD.replace("period = 0.5", ""), "[[structures]] no. 1, [structures.frame] period is missing: the first"),
        (CLOUD.replace("period = 0.5", "period = -1"), "[[structures]] no. 1, 'one': [frame]: period must be a"),
        (CLOUD + "[bouc_wen]\ngamma = 1.0\n", "[bouc_wen] yield_displacement is missing: D_y of"),
        ("study = ", "is not a valid TOML file"),
    ],
)
def test_messages(failing, text, message):
    said = failing(text)
    assert message in said
    assert "pydantic" not in said
    if "clod" in text:
        assert said.endswith('Did you mean "cloud"?')
    if '"none"' in text:
        assert "none is not a directory" in said


def test_python_says_the_same():
    with pytest.raises(rf.InputError, match=r"pairs must be the number of random structures, .*, but 0 was given\."):
        PopulationStudy(records={"suites": ["el-centro-1940"]}, pairs=0)
    with pytest.raises(rf.InputError, match=r"seed must be what the draws depend on, .*, but -1 was given\."):
        PopulationStudy(records={"suites": ["el-centro-1940"]}, seed=-1)
    with pytest.raises(rf.InputError, match="structures must be one or more tables"):
        StripeStudy(records={"suites": ["el-centro-1940"]}, structures=[])


def test_missing_file_is_named(tmp_path):
    with pytest.raises(rf.InputError, match=r"The study file .*none\.toml does not exist"):
        load_study(tmp_path / "none.toml")


def test_records_in_pairs(tmp_path):
    (tmp_path / "records").mkdir()
    for name, peak in (("a-000", 1.0), ("a-UP", 0.5)):
        (tmp_path / "records" / f"{name}.csv").write_text(f"time (s),acc (m/s2)\n0,0\n0.01,{peak}\n0.02,0\n")
    records = rf.Records(folder="records", vertical="pair")
    (motion,) = records.load(tmp_path)
    assert (motion.pga, motion.pva) == (1.0, 0.5)
    named = '[records]\nfolder = "records"\nvertical = "pair"\n'
    (tmp_path / "study.toml").write_text(CLOUD.replace(RECORDS, named), "utf-8")
    study = load_study(tmp_path / "study.toml")
    assert study.document()["records"]["vertical"] == "pair"
    assert study.matrix().motions[0].vertical.tolist() == [0.0, 0.5, 0.0]
    assert "vertical" not in rf.Records(folder="records").model_dump(exclude_none=True)
    with pytest.raises(ValueError, match="vertical is for the files of a folder, but none is named"):
        rf.Records(suites=["el-centro-1940"], vertical="pair")


def test_an_eccentric_structure_of_a_study(tmp_path):
    tendon = "[[structures.elements]]\nkind = 'tendon'\nposition = 0.3\ninitial_force = 1e5\nstiffness = 1e6\n"
    (tmp_path / "plain.toml").write_text(CLOUD, "utf-8")
    (tmp_path / "moved.toml").write_text(CLOUD.replace('name = "one"', 'name = "one"\neccentricity = 0.1') + tendon)
    study, plain = load_study(tmp_path / "moved.toml"), load_study(tmp_path / "plain.toml")
    (p,) = study.matrix().structures
    assert p.eccentricity == 0.1
    assert [each.position for each in p.tendons] == [0.3]
    assert study.document()["structures"][0]["eccentricity"] == 0.1
    # A study without it has the document, and so the folder, that it always had.
    assert plain.document()["structures"][0].keys() == {"name", "frame"}


def test_elements_of_a_study(tmp_path):
    fuse = '[[structures.elements]]\nkind = "yielding_dissipator"\nstiffness = 1e7\nyield_force = 2e5\n'
    (tmp_path / "fuse.toml").write_text(CLOUD + fuse, "utf-8")
    study = load_study(tmp_path / "fuse.toml")
    (p,) = study.matrix().structures
    assert p.elements == (rf.YieldingDissipator(1e7, 2e5),)
    (element,) = study.document()["structures"][0]["elements"]
    assert element == {
        "kind": "yielding_dissipator",
        "position": 0.0,
        "stiffness": 1e7,
        "yield_force": 2e5,
        "post_yield_ratio": 0.0,
        "tension_only": False,
    }
    again = CloudStudy(**study.document() | {"structures": [entry.model_dump() for entry in study.structures]})
    assert again.document() == study.document()
    runs = run_plan(study.plan())
    alone = rf.simulate(p, study.matrix().motions[0], output="peaks")
    assert (runs["status"].item(), runs["max_rotation"].item()) == (alone.status, alone.max_rotation)
    (tmp_path / "wrong.toml").write_text(CLOUD + fuse.replace("2e5", "-2e5"), "utf-8")
    with pytest.raises(rf.InputError) as caught:
        load_study(tmp_path / "wrong.toml").plan()
    assert str(caught.value).startswith("[[structures]] no. 1, 'one': [[elements]] no. 1: yield_force must be a")
