"""``rockflex check``: the same values as in Python, its exit codes, and its limits file."""

import json
import math

import pytest
from typer.testing import CliRunner

import rockflex as rf
from rockflex.cli._app import app

SUITE = "fema-p695-far-field"
NAMES = [f"{SUITE}/FF-{number}-a" for number in (1, 2, 3)]
STRUCTURE = """[frame]
n_stories = 2
story_height = 3.0
story_mass = 40e3
base_mass = 40e3
stiffness_ratio = 1.0
period = 0.5
aspect_ratio = 8.0
damping_ratio = 0.02
"""


@pytest.fixture
def invoke(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "structure.toml").write_text(STRUCTURE)
    (tmp_path / "limits.toml").write_text("drift_ratio = 0.002\nfriction = 0.5\n")

    def run(*arguments, names=NAMES):
        given = ["check", "structure.toml", *names, *map(str, arguments)]
        return CliRunner().invoke(app, given, env={"COLUMNS": "120"})

    return run


def test_the_document_is_what_python_finds(invoke):
    options = ("--rule", "ec8", "--limits", "limits.toml", "--periods", "0.2,0.6", "--scale", 0.8, "--model", "2DOF-S")
    found = json.loads(invoke(*options, "--json").stdout)
    suite = rf.load_suite(SUITE)
    motions = [suite[name.rpartition("/")[2]].scaled(0.8) for name in NAMES]
    frame = rf.read_structure("structure.toml")
    expected = rf.simulate_set(frame, motions, "2DOF-S", rule="ec8", periods=(0.2, 0.6))
    table = rf.check(expected, rf.CheckLimits(drift_ratio=0.002, friction=0.5))
    assert [row["max_rotation"] for row in found["records"]] == expected.peaks["max_rotation"].tolist()
    assert found["statistics"]["max_rotation"]["design"] == expected.statistics.loc["max_rotation", "design"]
    assert {row["name"]: row["ratio"] for row in found["checks"] if row["ratio"] is not None} == {
        each.name: each.ratio for each in table.rows if each.ratio is not None
    }
    assert found["missing"] == dict(table.missing)
    assert any("periods up to 0.6" in text for text in found["warnings"])


@pytest.mark.parametrize(("options", "code"), [((), 0), (("--strict",), 1)])
def test_a_limit_that_is_exceeded_ends_with_1_only_if_strict(invoke, options, code):
    result = invoke("--limits", "limits.toml", *options)
    assert result.exit_code == code
    assert "fails" in result.stdout
    assert "story drift" in result.stdout
    assert "not checked: tendon stress" in result.stdout
    assert invoke("--strict").exit_code == 0  # the nominal limit of the rotation is kept


@pytest.mark.parametrize(
    ("content", "options", "words"),
    [
        ("drift = 1", (), ["drift", "drift_ratio"]),
        ("friction = -1", (), ["friction", "limits.toml"]),
        ("friction =", (), ["limits.toml", "TOML"]),
        ("", ("--rule", "ec9"), ["rule", "ec8"]),
        ("", ("--rule", "asce7"), ["11 records", "--rule"]),
        ("", ("--model", "2DOF-S,MDOF-S"), ["one model"]),
        ("", ("--periods", "1"), ["--periods"]),
        ("", ("--report", "page.txt"), [".html"]),
    ],
)
def test_wrong_input_ends_with_2(invoke, tmp_path, content, options, words):
    (tmp_path / "limits.toml").write_text(content)
    result = invoke("--limits", "limits.toml", *options)
    assert result.exit_code == 2
    assert all(word in result.stderr for word in words)


def test_it_writes_the_report_of_the_set(invoke, tmp_path):
    assert invoke("--report", "set.html", "--limits", "limits.toml").exit_code == 0
    assert "FF-2-a" in (tmp_path / "set.html").read_text("utf-8")
    assert invoke("--report", "set.html").exit_code == 2  # exists
    assert invoke("--report", "set.html", "--force").exit_code == 0


def test_a_rotation_limit_is_told_with_its_source(invoke):
    row = next(each for each in json.loads(invoke("--json").stdout)["checks"] if each["name"] == "rotation")
    p = rf.read_structure("structure.toml").rocking()
    assert row["limit"] == pytest.approx(0.7 * math.atan(p.half_width / p.effective_height[0]), rel=1e-14)
    assert "2024" in row["source"]
