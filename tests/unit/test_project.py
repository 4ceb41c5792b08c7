"""Projects: what goes in comes out, files are readable elsewhere, and wrong or hostile ones are refused."""

import io
import json
import math
import struct
import tomllib
import zipfile
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner

import rockflex as rf
from builders import make_frame
from rockflex.cli._app import app

FRAME = make_frame(n_stories=2, period=0.5, aspect_ratio=8.0)
TIED = rf.Restrained(rf.Eccentric(FRAME, 0.1), [rf.Tendon(1e5, 5e6, yield_force=4e5), rf.GapBar(1e6, 0.01)])
BED = rf.Ground(springs=rf.Springs([-0.5, 0.5], 2e8, 1e6), base_inertia=2e4)
TIME = 0.01 * np.arange(120)
INFO = rf.RecordInfo(event="Ærø, øst", year=1990, magnitude=6.1, source='a "file", quoted')
RECORDS = {
    "one": rf.one_sine_pulse(amplitude=3.0, period=0.8),
    "two/2": rf.GroundMotion(np.sin(9.0 * TIME) * math.pi, 0.01, metadata=INFO, vertical=np.cos(TIME)).scaled(1.3),
    "dreißig": rf.one_sine_pulse(amplitude=2.0, period=1.0),
}
PROJECT = rf.Project(
    {"free": FRAME, "tied, on soil": TIED},
    RECORDS,
    {"free": "2DOF-S", "tied, on soil": "MDOF-S"},
    ground={"tied, on soil": BED},
    impact={"free": rf.Restitution(0.9)},
    rule="ec8",
    periods=(0.2, 2.0),
    limits=rf.CheckLimits(drift_ratio=0.01, friction=0.5),
    head={"title": "Two frames", "project": "Halle", "author": "A. Müller", "checker": "B", "date": "2024-05-01"},
)


@pytest.fixture(scope="module")
def done():
    return PROJECT.run()


@pytest.fixture
def file(done, tmp_path):
    return done.save(tmp_path / "a.rockflex")


def rewritten(file, changed=None, removed=(), **options):
    """The archive with other members, or without some."""
    with zipfile.ZipFile(file) as archive:
        members = {name: archive.read(name) for name in archive.namelist() if name not in removed}
    with zipfile.ZipFile(file, "w", **options) as archive:
        for name, content in (members | (changed or {})).items():
            archive.writestr(name or zipfile.ZipInfo(name), content)
    return file


def document(file):
    with zipfile.ZipFile(file) as archive:
        return archive.read("project.toml").decode()


@pytest.mark.slow
def test_a_project_comes_back_equal_and_gives_equal_results(done, tmp_path):
    for project in (PROJECT, done):
        path = project.save(tmp_path / "pier")
        assert path.name == "pier.rockflex"
        again = rf.read_project(path)
        assert again == project
        assert again.motions[1].metadata == RECORDS["two/2"].metadata  # with its factor
        assert again.save(tmp_path / "other.rockflex").read_bytes() == path.read_bytes()
    run = again.run()
    pd.testing.assert_frame_equal(run.results.runs, done.results.runs)
    assert run == done


def test_a_structure_may_start_from_a_state(tmp_path):
    start = rf.InitialState(0.01, modal_displacement=[0.02], rotation_velocity=0.1)
    structures, pulses = {"begun": FRAME, "still": FRAME}, list(RECORDS.values())[::2]
    project = rf.Project(structures, pulses, "2DOF-S", initial={"begun": start})
    again = rf.read_project(project.save(tmp_path / "begun"))
    assert again == project
    assert again.inputs != rf.Project(structures, pulses, "2DOF-S").inputs
    runs = again.run().results.runs["max_rotation"].tolist()
    rest, single = (rf.simulate_set(FRAME, pulses, "2DOF-S", initial=each).peaks for each in (None, start))
    assert runs == [*single["max_rotation"], *rest["max_rotation"]]
    assert again.comparison().runs["max_rotation"].tolist() == runs


@pytest.mark.slow
def test_results_are_those_of_the_functions_it_stands_for(done):
    found = rf.simulate_set(TIED, RECORDS, "MDOF-S", "ec8", (0.2, 2.0), ground=BED)
    runs = done.results.runs.query("structure == 'tied, on soil'")
    assert runs["max_rotation"].tolist() == found.peaks["max_rotation"].tolist()
    statistics = done.results.statistics.query("structure == 'tied, on soil'").set_index("demand")
    assert statistics["design"].to_dict() == found.statistics["design"].to_dict()
    limits = rf.CheckLimits(drift_ratio=0.01, friction=0.5)
    checks = done.results.checks.query("structure == 'tied, on soil'").set_index("name")
    assert checks["demand"].to_dict() == rf.check(found, limits).to_frame()["demand"].to_dict()
    law = rf.simulate(FRAME, RECORDS["one"], "2DOF-S", impact=rf.Restitution(0.9)).max_rotation
    assert done.results.runs["max_rotation"][0] == pytest.approx(law, rel=1e-10)  # in a batch: rounding of sums
    compared = done.comparison()
    assert compared.names == ("free", "tied, on soil")
    np.testing.assert_allclose(compared.runs["max_rotation"], done.results.runs["max_rotation"], rtol=1e-10)


@pytest.mark.parametrize(
    "structure",
    [
        FRAME.rocking(),
        rf.rigid_block(slenderness=0.2, half_diagonal=2.5),
        rf.YieldingStories(rf.Leaning(make_frame(n_stories=2, stiffness_ratio=math.inf), 1e4), [1e5, 8e4], 0.05),
        rf.from_matrices([1e4, 2e4], [[4e6, -2e6], [-2e6, 2e6]], [3.0, 6.0], base_mass=2e4, half_width=0.6,
                         damping_ratio=0.02),
        rf.Beam(height=10.0, mass=([0.0, 4.0, 10.0], [2e3, 1e3, 1e3]), bending_stiffness=1e9, half_width=1.0,
                damping_ratio=0.02, lumped_masses=rf.LumpedMasses([10.0], [500.0])),
        rf.CantileverWithTipMass(height=12.0, tip_mass=5e5, base_mass=1e5, half_width=1.5, damping_ratio=0.03,
                                 section=rf.Section.box(4.0, 2.5, 0.3, elastic_modulus=33e9, density=2500)),
        rf.FishBone([3.0, 4.0], 1e4, 1e8, math.inf, base_mass=1e4, half_width=1.0, damping_ratio=0.02),
        rf.Restrained(FRAME, [rf.MultilinearBar((0.01, 0.02), (1e5, 1.2e5)), rf.Tendon(1e5, 5e6, between=(0, 2))]),
    ],
    ids=lambda each: type(each).__name__,
)  # fmt: skip
def test_every_kind_of_structure_comes_back_equal(structure, tmp_path):
    path = rf.Project({"A": structure}, RECORDS["one"]).save(tmp_path / "a.rockflex")
    assert rf.read_project(path).structures["A"] == structure
    with zipfile.ZipFile(path) as archive:
        archive.extract("structures/001_A.toml", tmp_path)
    assert rf.read_structure(tmp_path / "structures" / "001_A.toml") == structure


@pytest.mark.slow
def test_the_unpacked_file_is_a_case_with_the_same_numbers(done, file, tmp_path):
    with zipfile.ZipFile(file) as archive:
        archive.extractall(tmp_path)
    content = tomllib.loads((tmp_path / "project.toml").read_text("utf-8"))
    own = {"format", "head", "rule", "periods", "limits", "results"}
    case = rf.Case(**{name: value for name, value in content.items() if name not in own}).read_from(tmp_path)
    table = case.run()
    assert table["max_rotation"].tolist() == done.results.runs["max_rotation"].tolist()


@dataclass(frozen=True)
class Stranger:
    """A structure that no package registers."""

    frame: rf.Frame

    def modal(self, n_modes=None):
        return self.frame.modal(n_modes)

    def rocking(self, n_modes=None):
        return self.frame.rocking(n_modes)


@pytest.mark.parametrize(
    "structure",
    [Stranger(FRAME), rf.Beam(height=9.0, mass=lambda z: 1e3 + z, bending_stiffness=1e9, half_width=1.0,
                              damping_ratio=0.02)],
    ids=["unknown", "function"],
)  # fmt: skip
def test_what_no_file_can_hold_is_refused_before_writing(structure, tmp_path):
    with pytest.raises(rf.InputError, match=r"structures\['A'\].*cannot be written"):
        rf.Project({"A": structure}, RECORDS).save(tmp_path / "a.rockflex")
    assert list(tmp_path.iterdir()) == []


def test_the_file_is_readable_without_this_software(done, file):
    with zipfile.ZipFile(file) as archive:
        head = tomllib.loads(archive.read("project.toml").decode())
        rows = pd.read_csv(archive.open(head["records"]["files"][1]["file"]), comment="#")
        runs = pd.read_parquet(io.BytesIO(archive.read("results/runs.parquet")))
        frame = tomllib.loads(archive.read(head["structures"][0]["file"]).decode())
    assert head["head"]["author"] == "A. Müller"
    assert head["records"]["files"][1]["info"]["scale"] == 1.3
    np.testing.assert_array_equal(rows["acceleration (m/s2)"], done.motions[1].acceleration)
    np.testing.assert_array_equal(rows["vertical (m/s2)"], done.motions[1].vertical)
    assert runs["max_rotation"].tolist() == done.results.runs["max_rotation"].tolist()
    assert (frame["class"], frame["period"]) == ("Frame", 0.5)


@pytest.mark.parametrize(
    ("field", "given"),
    [
        ("structures", {"structures": {}}),
        ("structures", {"structures": dict.fromkeys("ABCDEFG", FRAME)}),
        ("structures", {"structures": [FRAME]}),
        ("model", {"model": {"B": "MDOF-S"}}),
        ("model", {"model": {}}),
        ("ground", {"ground": 0.4}),
        ("impact", {"impact": rf.Restitution}),
        ("rule", {"rule": "ec9"}),
        ("periods", {"periods": (2.0, 0.2)}),
        ("periods", {"periods": 2.0}),
        ("free_vibration", {"free_vibration": -1.0}),
        ("limits", {"limits": {"friction": 0.5}}),
        ("head", {"head": {"colour": "red"}}),
        ("head", {"head": {"author": 5}}),
        ("results", {"results": 5}),
    ],
)
def test_wrong_arguments_name_their_field(field, given):
    with pytest.raises(rf.InputError, match=field):
        rf.Project(**({"structures": {"A": FRAME}, "motions": RECORDS} | given))


def test_results_of_other_inputs_are_refused(done):
    with pytest.raises(rf.InputError, match="run it again") as caught:
        replace(done, limits=rf.CheckLimits(drift_ratio=0.02))
    assert caught.value.field == "results"
    assert replace(done, head={"title": "Another"}).results == done.results  # which no result depends on


@pytest.mark.slow
def test_reports_have_head_checks_and_alternatives(done, tmp_path):
    together, one = done.report(tmp_path / "all.html"), done.report(tmp_path / "one.html", "tied, on soil")
    for page in (together, one):
        text = page.read_text("utf-8")
        assert all(part in text for part in ("Two frames", "Halle", "A. Müller", "2024-05-01"))
    assert "tied, on soil to free" in together.read_text("utf-8")
    assert "EN 1998-1:2004" in one.read_text("utf-8")
    with pytest.raises(rf.InputError, match="free, tied") as caught:
        done.report(tmp_path / "none.html", "other")
    assert caught.value.field == "structure"


@pytest.mark.parametrize("share", [0.0, 0.3, 0.98])
def test_a_truncated_file_is_refused(file, share):
    content = file.read_bytes()
    file.write_bytes(content[: int(share * len(content))])
    with pytest.raises(rf.InputError, match="not a project file, or a damaged one"):
        rf.read_project(file)


def test_a_damaged_member_is_refused(file):
    content = bytearray(file.read_bytes())
    content[len(content) // 2] ^= 0xFF
    file.write_bytes(bytes(content))
    with pytest.raises(rf.InputError, match=r"a\.rockflex"):
        rf.read_project(file)


@pytest.mark.parametrize(
    ("words", "old", "new"),
    [
        ("format.*rockflex-project-2.*rockflex-project-3", "rockflex-project-2", "rockflex-project-3"),
        ("not TOML", "[head]", "[head"),
        ("colour is not known", "[head]", "colour = 1\n[head]"),
        ("rule must be", 'rule = "ec8"', 'rule = "ec9"'),
        ("rule must be", 'rule = "ec8"', "rule = 8"),
        ("drift_ratio", "drift_ratio = 0.01", "drift_ratio = -0.01"),
        ("drift_ratio", "drift_ratio = 0.01", 'drift_ratio = "a"'),
        ("strain is not known", "drift_ratio", "strain"),
        ("twice", "structures/002_tied_on_soil.toml", "structures/001_free.toml"),
        ("same name", '"tied, on soil"', '"free"'),
        ("not in the archive", "001_free", "009_free"),
        ("dt", "dt = 0.01", "dt = -0.01"),
        ("year", "year = 1990", 'year = "long ago"'),
        ("periods must be", "2.0,", "2.0, 3.0,"),
        ("class must be", 'class = "Ground"', 'class = "Path"'),
        ("class must be", 'class = "Restitution"', 'class = "__import__"'),
        (
            "ground: class must be Ground, Springs",
            'class = "Ground"\nbase_inertia = 20000.0',
            'class = "Restitution"\ne = 0.5',
        ),
        ("run it again", "friction = 0.5", "friction = 0.6"),
        ("ground, springs: class must be Ground, Springs", 'class = "Springs"', 'class = "Frame"'),
        ("models of each structure must be one", '"2DOF-S",', '"2DOF-S", "rigid",'),
        ("records must be tables", "dt = 0.01", "dt = 0.01\nscale = 2.0"),
        (
            "records must be tables",
            '[[records.files]]\nfile = "records/001',
            '[records]\nsuites = ["x"]\n[[records.files]]\nfile = "records/001',
        ),
    ],
)
def test_wrong_values_are_named(file, words, old, new):
    text = document(file)
    assert old in text
    if "Restitution" in new:
        start = text.index("[structures.ground.springs]")
        text = text[:start] + text[text.index("[[records.files]]") :]
    rewritten(file, {"project.toml": text.replace(old, new)})
    with pytest.raises(rf.InputError, match=f"(?s)a.rockflex.*{words}"):
        rf.read_project(file)


FIRST = "records/001_one.csv"
STRUCTURE = "structures/001_free.toml"


@pytest.mark.parametrize(
    ("words", "changed"),
    [
        ("not listed", {"records/more.csv": b"1"}),
        ("CSV", {FIRST: b""}),
        ("CSV", {FIRST: b"time (s),acceleration (m/s2)\n0.0,zero\n"}),
        ("CSV", {FIRST: b"\xff\xfe"}),
        ("columns must be", {FIRST: b"t,a\n0,1\n1,2\n2,3\n"}),
        ("finite", {FIRST: b"time (s),acceleration (m/s2)\n0,1\n1,nan\n2,3\n"}),
        ("at least 3", {FIRST: b"time (s),acceleration (m/s2)\n0,1\n"}),
        ("not TOML", {STRUCTURE: b"class = "}),
        ("class must be", {STRUCTURE: b"period = 0.5"}),
        ("period is not known", {STRUCTURE: b'class = "Tendon"\nperiod = 1.0\n'}),
        ("is not a structure", {STRUCTURE: b'class = "Tendon"\ninitial_force = 1e5\nstiffness = 1e6\n'}),
        ("cannot be made", {STRUCTURE: b'class = "Frame"\nperiod = 0.5'}),
        ("results/runs.parquet is not Parquet", {"results/runs.parquet": b"PAR1"}),
    ],
)
def test_wrong_members_are_named(file, words, changed):
    rewritten(file, changed)
    with pytest.raises(rf.InputError, match=f"a.rockflex.*{words}"):
        rf.read_project(file)


@pytest.mark.parametrize(
    "table",
    [
        {"structure": ["free"]},
        {"structure": ["free"], "name": ["sliding"], "limit": ["high"], "ratio": [0.5], "ok": [True]},
        {"structure": ["free"] * 200_000, "name": "sliding", "limit": 1.0, "ratio": 0.5, "ok": True},
    ],
    ids=["few", "kind", "long"],
)
def test_a_table_of_other_columns_is_refused(file, table):
    content = io.BytesIO()
    pd.DataFrame(table).to_parquet(content)
    rewritten(file, {"results/checks.parquet": content.getvalue()})
    with pytest.raises(rf.InputError, match=r"checks\.parquet must have the columns"):
        rf.read_project(file)


@pytest.mark.parametrize("member", ["project.toml", STRUCTURE])
def test_deep_nesting_is_refused(file, member):
    deep = ".".join(["structure"] * 5_000)
    nested = f"class = 'Eccentric'\n{deep} = 1\n"
    lists = f"class = 'Eccentric'\nstructure = {'[' * 5_000}"
    for text in (nested, lists):
        rewritten(file, {member: text})
        with pytest.raises(rf.InputError, match=r"a\.rockflex"):
            rf.read_project(file)


@pytest.mark.parametrize("name", ["../evil.toml", "/etc/passwd", "a/b/c.toml", "C:\\a.toml", "records/..", ""])
def test_names_that_point_elsewhere_are_refused(file, name):
    rewritten(file, {name: b"1"})
    with pytest.raises(rf.InputError, match="no plain name"):
        rf.read_project(file)


def test_a_bomb_is_refused_unread(file):
    """A member that states more than is allowed, and one that states less than is packed."""
    rewritten(file, {"records/001_one.csv": b"0" * 10_000_000}, compression=zipfile.ZIP_DEFLATED)
    content = file.read_bytes()
    for stated, words in ((2_000_000_000, "more than"), (10, "project file")):
        file.write_bytes(content.replace(struct.pack("<L", 10_000_000), struct.pack("<L", stated)))
        with pytest.raises(rf.InputError, match=words):
            rf.read_project(file)


def test_members_packed_in_other_ways_are_refused(file):
    rewritten(file, compression=zipfile.ZIP_LZMA)
    with pytest.raises(rf.InputError, match="deflation"):
        rf.read_project(file)


def test_missing_files_and_folders_are_refused(tmp_path):
    with pytest.raises(rf.InputError, match="does not exist"):
        rf.read_project(tmp_path / "none.rockflex")
    with pytest.raises(rf.InputError, match="a folder"):
        rf.read_project(tmp_path)
    (tmp_path / "file").write_text("")
    with pytest.raises(rf.InputError, match="Cannot write"):
        PROJECT.save(tmp_path / "file" / "a.rockflex")


def invoke(*words):
    return CliRunner().invoke(app, ["project", *map(str, words)])


@pytest.mark.slow
def test_the_command_makes_runs_reports_and_shows(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    block = "block = { slenderness = 0.2, half_diagonal = 3.0, mass = 50e3 }\n"
    (tmp_path / "free.toml").write_text(f'{block}[report]\nauthor = "A"\nappendix = true\n')
    (tmp_path / "soft.toml").write_text(f"{block}[ground]\nfriction = 0.3\n")
    (tmp_path / "limits.toml").write_text("rotation_ratio = 0.1")
    made = ["a", "free.toml", "soft.toml", "el-centro-1940", "--model", "rigid", "--scale", "1.5"]
    made += ["--limits", "limits.toml", "--report-title", "Blocks"]
    assert invoke("new", *made).exit_code == 0
    project = rf.read_project("a.rockflex")
    block = rf.rigid_block(slenderness=0.2, half_diagonal=3.0, mass=50e3)
    motion = rf.load_suite("el-centro-1940")[0].scaled(1.5)
    assert project == rf.Project(
        {"free": block, "soft": block}, motion, "rigid", ground={"soft": rf.Ground(friction=0.3)},
        limits=rf.CheckLimits(rotation_ratio=0.1), head={"title": "Blocks", "author": "A"},
    )  # fmt: skip
    assert "no results" in invoke("show", "a.rockflex").output
    again = invoke("new", *made)
    assert (again.exit_code, "--force" in again.output) == (2, True)
    assert "limits exceeded" in invoke("run", "a.rockflex").output
    assert rf.read_project("a.rockflex") == project.run()
    assert invoke("run", "a.rockflex", "--strict").exit_code == 1
    told = json.loads(invoke("show", "a.rockflex", "--json").stdout)
    assert told["results"]["runs"][0]["max_rotation"] == project.run().results.runs["max_rotation"][0]
    assert invoke("report", "a.rockflex", "all.html").exit_code == 0
    assert invoke("report", "a.rockflex", "one.html", "--structure", "soft").exit_code == 0
    assert (tmp_path / "one.html").exists()
    begun = ["free.toml", "el-centro-1940", "--model", "rigid", "--initial-rotation", "0.1"]
    assert invoke("new", "begun", *begun).exit_code == 0
    assert rf.read_project("begun.rockflex").initial == {"free": rf.InitialState(0.1)}
    assert invoke("new", "b", "el-centro-1940").exit_code == 2
    assert not (tmp_path / "b.rockflex").exists()
