"""``rockflex survey``, and the commands that read records of many formats."""

import json

import pytest
from typer.testing import CliRunner

import rockflex as rf
from record_samples import at2, cosmos, knet
from rockflex.cli import app


def invoke(*arguments, command="survey", columns=160):
    return CliRunner().invoke(app, [command, *map(str, arguments)], env={"COLUMNS": str(columns)})


@pytest.fixture
def folder(tmp_path):
    folder = tmp_path / "mixed"
    folder.mkdir()
    for name, component in (("RSN7_A090", "90"), ("RSN7_A180", "180"), ("RSN7_A-UP", "UP")):
        (folder / f"{name}.AT2").write_text(at2(component))
    (folder / "table.csv").write_text("RSN,Magnitude,Rrup (km),Vs30 (m/s)\n7,6.5,12.5,360\n")
    (folder / "MYG002.EW").write_text(knet("E-W"))
    (folder / "notes.txt").write_text("Downloaded in spring\n")
    return folder


def test_table_and_reasons(folder):
    result = invoke(folder)
    assert result.exit_code == 0
    rows = [line.split() for line in result.stdout.splitlines()]
    assert ["RSN7_A090.AT2", "AT2", "Some", "Station", "90", "yes", "0.1", "3", "0.1000", "6.5", "12.5", "360"] in rows
    assert ["MYG002.EW", "K-NET", "MYG002", "E-W", "yes", "0.1", "10", "0.0001551", "5.7", "-", "-"] in rows
    assert (
        "3 taken, 3 left out; 2 recordings: 1 with a horizontal pair, 1 with a vertical component, 1 with both"
        in result.stdout
    )
    assert "  RSN7_A-UP.AT2: vertical component\n" in result.stdout
    assert "  table.csv: a table about the records\n" in result.stdout
    assert "  notes.txt: notes.txt holds no numbers" in result.stdout
    paired = invoke(folder, "--vertical", "pair").stdout
    assert "4 taken, 2 left out" in paired
    assert "Taken, but:\n  MYG002.EW: without a vertical component\n" in paired


def test_many_files_of_one_reason_are_counted(tmp_path):
    for k in range(9):
        (tmp_path / f"note-{k}.md").write_text("nothing")
    (tmp_path / "A090.AT2").write_text(at2("90"))
    said = invoke(tmp_path).stdout
    assert "note-4.md, note-5.md and 3 more: no record, by suffix and beginning\n" in said


def test_json(folder):
    found = json.loads(invoke(folder, "--json").stdout)
    assert len(found["entries"]) == 6
    entry = next(each for each in found["entries"] if each["file"] == "RSN7_A180.AT2")
    assert (entry["taken"], entry["magnitude"], entry["pga"]) == (True, 6.5, 0.1 * 9.81)
    assert found["stations"] == [
        {"name": "NIED MYG002 2006-01-18 23:25", "horizontal": ["MYG002-EW"], "vertical": None},
        {"name": "RSN7", "horizontal": ["RSN7_A090", "RSN7_A180"], "vertical": "RSN7_A-UP"},
    ]


def test_files_and_units(folder):
    (folder / "lab.txt").write_text("0\n0.1\n0\n")
    result = invoke(folder / "lab.txt", folder / "RSN7_A090.AT2", "--units", "g", "--dt", "0.1")
    assert "2 taken, 0 left out" in result.stdout
    both = invoke(folder, folder / "lab.txt")
    assert both.exit_code == 2
    assert "One folder or several files are expected, but" in both.stderr
    assert "Survey one folder at a time." in both.stderr
    assert invoke(folder / "none").exit_code == 2


def test_motion_reads_what_survey_takes(folder):
    (folder / "notes.txt").unlink()
    (folder / "CE.v2c").write_text(cosmos(90) + cosmos(360) + cosmos(400))
    result = invoke(folder, "--json", "--vertical", "pair", command="motion")
    found = {row["name"]: row for row in json.loads(result.stdout)["motions"]}
    assert set(found) == {"CE-090", "CE-360", "MYG002-EW", "RSN7_A090", "RSN7_A180"}
    assert found["RSN7_A090"]["metadata"]["distance_km"] == 12.5
    assert found["CE-360"]["metadata"]["vertical_source"] == "CE-UP"
    one = invoke(folder / "RSN7_A090.AT2", folder / "table.csv", "--json", command="motion")
    assert json.loads(one.stdout)["motions"][0]["metadata"]["vs30"] == 360
    with pytest.warns(rf.RecordWarning, match="Without a vertical component: 1 of 5 records, MYG002-EW"):
        suite = rf.read_suite(folder, vertical="pair")
    assert suite["CE-090"].pva == found["CE-090"]["pva"]
