"""`rockflex tornado`: its ranges, table and files; and the note of a run that depends on its record by much."""

import json

import pandas as pd
import pytest
from typer.testing import CliRunner

import rockflex as rf
from builders import make_frame
from rockflex.cli._app import app
from rockflex.cli._console import number

FRAME = make_frame()
EL_CENTRO = rf.load_suite("el-centro-1940")[0]
STRUCTURE = """
[frame]
n_stories = 5
story_height = 3.0
story_mass = 40e3
base_mass = 40e3
stiffness_ratio = inf
period = 1.0
aspect_ratio = 10.0
damping_ratio = 0.02
"""


@pytest.fixture
def file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "frame.toml").write_text(STRUCTURE)
    return "frame.toml"


def invoke(*arguments, columns=160):
    return CliRunner().invoke(app, list(map(str, arguments)), env={"COLUMNS": str(columns)})


def test_the_bars_are_the_librarys(file):
    ranges = ["--parameter", "period=0.2", "--parameter", "damping_ratio=0.5:2", "--parameter", "scale"]
    result = invoke("tornado", file, "el-centro-1940", *ranges, "--scale", 1.5, "--json")
    assert result.exit_code == 0, result.stderr
    found = json.loads(result.stdout)
    wanted = {"period": 0.2, "damping_ratio": (0.5, 2.0), "scale": 0.1}
    bars = rf.tornado(FRAME, EL_CENTRO.scaled(1.5), parameters=wanted)
    assert (found["demand"], found["median"], found["options"]["scales"]) == ("max_rotation", bars.base, [1.5])
    table = pd.DataFrame(found["parameters"]).set_index("parameter")
    assert list(table.index) == list(bars.parameters)
    for name in ("factor_low", "low", "factor_high", "high"):
        assert table[name].to_numpy() == pytest.approx(bars.to_frame()[name].to_numpy(), rel=1e-12)


def test_the_table_and_the_files_of_a_suite(file, tmp_path):
    names = [f"fema-p695-far-field/FF-{k}-a" for k in (1, 2, 3)]
    given = ["tornado", file, *names, "--parameter", "story_mass", "--demand", "max_base_moment"]
    result = invoke(*given, "--model", "2DOF-S", "--free-vibration", 2, "--out", "bars")
    assert result.exit_code == 0, result.stderr
    suite = [rf.load_suite("fema-p695-far-field")[f"FF-{k}-a"] for k in (1, 2, 3)]
    bars = rf.tornado(FRAME, suite, "2DOF-S", ["story_mass"], demand="max_base_moment", free_vibration=2.0)
    assert "median of 3 records" in result.stdout
    assert number(bars.values[0, 0] / 1e3) in result.stdout  # kN m
    assert sorted(each.name for each in (tmp_path / "bars").iterdir()) == [
        "summary.json",
        "tornado.csv",
        "tornado.png",
    ]
    written = pd.read_csv(tmp_path / "bars/tornado.csv").set_index("parameter")
    assert written.loc["story_mass", "high"] == pytest.approx(bars.values[0, 1], rel=1e-12)
    assert invoke(*given, "--out", "bars").exit_code == 2  # there are results already


def test_options_of_the_runs_and_the_ground_are_parameters_too(file):
    given = ["--impact", "restitution", "--restitution", 0.9, "--initial-rotation", 0.02, "--free-vibration", 3]
    given += ["--ground-friction", 0.5]
    found = json.loads(
        invoke("tornado", file, "--model", "2DOF-S", *given, "--demand", "max_base_moment", "--json").stdout
    )
    names = {row["parameter"] for row in found["parameters"]}
    assert {"period", "impact.e", "ground.friction"} <= names
    known = rf.tornado(
        FRAME,
        rf.quiet_motion(3.0, 0.01),
        "2DOF-S",
        ["impact.e"],
        demand="max_base_moment",
        impact=rf.Restitution(0.9),
        initial=rf.InitialState(rotation=0.02),
        ground=rf.Ground(friction=0.5),
    )
    assert found["median"] == pytest.approx(known.base, rel=1e-6)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--parameter", "period=x"], "period=0.5:2"),
        (["--parameter", "period=1:2:3"], "has no range"),
        (["--parameter", "period=2"], "--parameter"),
        (["--parameter", "perod"], "perod"),
        (["--parameter", "period", "--parameter", "period=0.2"], "twice"),
        (["--demand", "status"], "--demand"),
        (["--model", "2DOF-S,fixed"], "one model"),
    ],
)
def test_wrong_commands(file, arguments, said):
    result = invoke("tornado", file, "el-centro-1940", *arguments)
    assert result.exit_code == 2
    assert said in result.stderr


def test_a_run_near_overturning_says_so(file, tmp_path):
    """A run whose sensitivity is flagged, and one that is not."""
    flagged = next(
        record
        for record in rf.load_suite("fema-p695-far-field")
        if rf.simulate(FRAME, record.scaled(2.0), "2DOF-S").sensitivity.flagged
    )
    name = f"fema-p695-far-field/{flagged.name}"
    result = invoke("run", file, name, "--scale", 2, "--model", "2DOF-S,fixed")
    assert "1 % on the scale of the record" in result.stderr
    runs = json.loads(invoke("run", file, name, "--scale", 2, "--model", "2DOF-S,fixed", "--json").stdout)["runs"]
    note = rf.simulate(FRAME, flagged.scaled(2.0), "2DOF-S").sensitivity.note
    assert [note in run["warnings"] for run in runs] == [True, False]
    report = invoke("run", file, name, "--scale", 2, "--model", "2DOF-S", "--report", "run.html")
    assert report.exit_code == 0
    assert "1 % on the scale of the record" in (tmp_path / "run.html").read_text("utf-8")
    calm = invoke("run", file, "el-centro-1940", "--scale", 1.5, "--model", "2DOF-S,2DOF-C")
    assert "1 % on the scale" not in calm.stderr
