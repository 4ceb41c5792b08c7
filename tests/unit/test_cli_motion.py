"""`rockflex motion` and `rockflex survey`, and motions by name."""

import csv
import hashlib
import json

import numpy as np
import pytest
from typer.testing import CliRunner

import rockflex as rf
from record_samples import at2, cosmos, knet
from rockflex import InputError, RecordWarning, load_suite, read_motion
from rockflex.cli._app import app
from rockflex.cli._find_motions import embedded_suite_facts, find_motions

EL_CENTRO = rf.load_suite("el-centro-1940")[0]


def invoke(*arguments, columns=80):
    return CliRunner().invoke(app, ["motion", *map(str, arguments)], env={"COLUMNS": str(columns)})


def test_without_a_name_the_suites_are_listed():
    result = invoke()
    assert result.exit_code == 0
    for name in rf.suite_names():
        assert name in result.stdout
    found = json.loads(invoke("--json").stdout)
    assert [row["suite"] for row in found["suites"]] == list(rf.suite_names())


@pytest.mark.slow
def test_measures_are_those_of_the_motion():
    found = json.loads(invoke("el-centro-1940", "--period", 0.5, "--period", 2, "--damping", 0.02, "--json").stdout)
    (row,) = found["motions"]
    for name in ("pga", "pgv", "pgd", "arias", "cav", "d5_95", "dt", "duration", "name"):
        assert row[name] == getattr(EL_CENTRO, name)
    assert row["npts"] == EL_CENTRO.acceleration.size
    assert row["sa_0.5"] == EL_CENTRO.sa(0.5, 0.02)
    assert row["sa_2"] == EL_CENTRO.sa(2.0, 0.02)
    assert row["metadata"]["magnitude"] == 6.95
    assert found["options"] == {"periods": [0.5, 2.0], "damping_ratio": 0.02}


def record_at2(folder, name, component, peak=0.3):
    """A record file of four samples."""
    text = f"Event, 1/1/2001, Station, {component}\nUNITS OF G\nNPTS= 4, DT= .1\n0 {peak} -.2 0\n"
    (folder / name).write_text(text)
    return folder / name


@pytest.mark.slow
def test_vertical_component(tmp_path):
    along, upwards = record_at2(tmp_path, "A-000.AT2", "0", 0.4), record_at2(tmp_path, "A-UP.AT2", "UP", 0.3)
    motion = rf.read_motion(along, vertical=upwards)
    for options in ([along, "--vertical", upwards], [tmp_path, "--vertical", "pair"]):
        result = invoke(*options, "--period", 0.5, "--damping", 0.02, "--json", "--out", tmp_path / "out", "--force")
        (row,) = json.loads(result.stdout)["motions"]
        assert (row["pga"], row["pva"], row["pva_pga"]) == (motion.pga, motion.pva, motion.pva / motion.pga)
        assert row["sa_vertical_0.5"] == motion.vertical_motion.sa(0.5, 0.02)
        assert row["v_h_0.5"] == motion.vertical_ratio([0.5], 0.02)[0]
        assert row["vertical_sha256"] != row["sha256"]
        assert row["metadata"]["vertical_source"] == "A-UP"
    with (tmp_path / "out" / "motion-A-000.csv").open(newline="") as file:
        assert [float(line["vertical"]) for line in csv.DictReader(file)] == motion.vertical.tolist()
    shown = invoke(along, "el-centro-1940").stdout
    assert "Vertical" not in shown
    table = invoke(tmp_path, "el-centro-1940", "--vertical", "pair").stdout.partition("Vertical component")[2].split()
    start = table.index("A-000")
    assert table[start + 1 : start + 3] == ["0.3000", "0.7500"]
    assert table[table.index("EL-CENTRO-1940-NS") + 1 :][:4] == ["-"] * 4


def test_printed_tables():
    result = invoke("el-centro-1940", "fema-p695-near-field-pulse/NFP-1-a", columns=100)
    rows = [line.split() for line in result.stdout.splitlines()]
    assert ["EL-CENTRO-1940-NS", "Imperial", "Valley", "1940", "6.95", "-", "-", "0.02", "1560", "31.18"] in rows
    assert ["NFP-1-a", "Imperial", "Valley-06", "1979", "6.5", "1.4", "203", "0.005", "7807", "39.03"] in rows
    assert ["EL-CENTRO-1940-NS", "0.3188", "0.3620", "0.2120", "1.724", "12.37", "23.86", "0.4550"] in rows
    assert "Sa: pseudo-acceleration with 0.05 damping; g = 9.81 m/s²" in result.stdout


def test_narrow_terminal():
    result = invoke("fema-p695-far-field", "el-centro-1940")
    lines = result.stdout.splitlines()
    assert max(map(len, lines)) <= 80
    assert "…" not in result.stdout
    assert sum(line.startswith("FF-") for line in lines) == 88
    assert "Superstition" in result.stdout


def test_folder(tmp_path):
    result = invoke("el-centro-1940", "--out", tmp_path / "out")
    assert result.exit_code == 0, result.stderr
    names = sorted(path.name for path in (tmp_path / "out").iterdir())
    assert names == ["motion-EL-CENTRO-1940-NS.csv", "motion-EL-CENTRO-1940-NS.png", "motions.csv", "summary.json"]
    with (tmp_path / "out" / names[0]).open(newline="") as file:
        rows = list(csv.DictReader(file))
    for name in ("time", "acceleration", "velocity", "displacement"):
        np.testing.assert_array_equal([float(row[name]) for row in rows], getattr(EL_CENTRO, name))
    with (tmp_path / "out" / "motions.csv").open(newline="") as file:
        (row,) = csv.DictReader(file)
    assert float(row["pga"]) == EL_CENTRO.pga
    assert row["event"] == "Imperial Valley"


def test_folder_of_many_motions_and_of_unknown_ones(tmp_path):
    path = tmp_path / "plain.csv"
    np.savetxt(path, 0.1 * np.sin(np.arange(50)))
    more = ("--units", "g", "--dt", 0.01, "--figures", 1)
    result = invoke("el-centro-1940", path, *more, "--out", tmp_path / "out")
    assert "series and figures only of up to 1 motion, by --figures" in result.stderr
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["motions.csv", "summary.json"]
    with (tmp_path / "out" / "motions.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["name"] for row in rows] == ["EL-CENTRO-1940-NS", "plain"]
    assert [row["event"] for row in rows] == ["Imperial Valley", ""]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["nothing"], "'nothing' is neither a suite"),
        (["el-centro-1940", "--damping", 5], "damping_ratio must lie in [0, 1), but 5.0 was given."),
        (["el-centro-1940", "--period", "nan"], "periods must be finite"),
        (["el-centro-1940", "--dt", 0.01], "--units, --dt and --on-error are for record files, but no file was given."),
        (["--units", "g"], "No ground motion was given."),
        (["--on-error", "skip"], "No ground motion was given."),
        (["--period", 1], "No ground motion was given."),
        (["--vertical", "pair"], "No ground motion was given."),
        (["el-centro-1940", "--vertical", "pair"], "--vertical pair is for record files, but none was given"),
        (["el-centro-1940", "--vertical", "none.at2"], "none.at2 does not exist"),
        (["el-centro-1940", "--vertical", "v.at2", "--on-error", "skip"], "--on-error are for record files, but no"),
    ],
)
def test_bad_input(arguments, said, tmp_path):
    result = invoke(*arguments, "--out", tmp_path / "out", "--json")
    assert result.exit_code == 2
    assert result.stdout == ""
    assert said in result.stderr
    assert list(tmp_path.iterdir()) == []


ACCELERATION = 0.1 * np.sin(np.arange(50))


@pytest.fixture
def record(tmp_path):
    path = tmp_path / "record.csv"
    np.savetxt(path, ACCELERATION)
    return path


def names(found):
    return [item.motion.name for item in found]


def test_suites_records_and_files_in_order(record):
    found = find_motions(["fema-p695-far-field/FF-12-a", "el-centro-1940", str(record)], "g", 0.01)
    assert names(found) == ["FF-12-a", "EL-CENTRO-1940-NS", "record"]
    assert [item.origin for item in found] == ["fema-p695-far-field", "el-centro-1940", str(record)]
    np.testing.assert_allclose(found[2].motion.acceleration, 9.81 * ACCELERATION, rtol=1e-15)
    assert found[2].motion.dt == 0.01


def test_whole_suite():
    assert names(find_motions(["fema-p695-near-field-pulse"])) == list(load_suite("fema-p695-near-field-pulse").names)


def test_directory(tmp_path):
    for name, factor in (("b", 1.0), ("a", 2.0)):
        np.savetxt(tmp_path / f"{name}.txt", np.column_stack((0.02 * np.arange(50), factor * ACCELERATION)))
    assert names(find_motions([str(tmp_path)], units="m/s2")) == ["a", "b"]


def test_named_twice_is_taken_once():
    assert names(find_motions(["el-centro-1940", "el-centro-1940/EL-CENTRO-1940-NS"])) == ["EL-CENTRO-1940-NS"]


def test_checksum_is_of_the_samples():
    found = find_motions(["el-centro-1940"])[0]
    samples = found.motion.acceleration.astype("<f8").tobytes()
    assert found.describe()["sha256"] == hashlib.sha256(samples).hexdigest()
    assert found.describe()["pga"] == found.motion.pga


def test_embedded_suites():
    rows = embedded_suite_facts()
    assert rows[0] == {"suite": "fema-p695-far-field", "motions": 44, "first": "FF-1-a", "last": "FF-22-b"}
    assert [row["motions"] for row in rows] == [44, 28, 28, 1]


def test_two_motions_of_one_name(tmp_path, record):
    other = tmp_path / "other"
    other.mkdir()
    np.savetxt(other / "record.csv", 2 * ACCELERATION)
    with pytest.raises(InputError, match=r"hold different motions, both named 'record'\. Rename one of the files\."):
        find_motions([str(record), str(other / "record.csv")], "g", 0.01)


def test_unknown_names():
    with pytest.raises(InputError, match=r"'el-centro' is neither a suite \(fema.*\), nor a record in"):
        find_motions(["el-centro"])
    with pytest.raises(InputError, match=r"No motion of the suite 'el-centro-1940' is named 'EW'"):
        find_motions(["el-centro-1940/EW"])


def test_structure_among_motions():
    with pytest.raises(InputError, match=r"other\.toml is a structure file, and one structure is simulated at a time"):
        find_motions(["el-centro-1940", "other.toml"])


def test_missing_unit_and_step_name_the_options(record):
    for units, dt in ((None, 0.01), ("g", None)):
        with pytest.raises(InputError, match=r"On the command line these are --units and --dt\.$"):
            find_motions([str(record)], units, dt)


def test_other_faults_of_a_file_are_told_as_they_are(tmp_path):
    for name in ("empty.csv", "units=g, dt=0.01.csv"):
        path = tmp_path / name
        path.touch()
        with pytest.raises(InputError, match=r"\.csv is empty\."):
            find_motions([str(path)])


def test_options_are_named_where_one_of_several_files_lacks_its_unit(tmp_path, record):
    (tmp_path / "empty.csv").touch()
    told = r"2 of 2 files .*is empty\. .*unit of its acceleration.* On the command line these are --units and --dt\.$"
    with pytest.raises(InputError, match=told) as caught:
        find_motions([str(tmp_path / "empty.csv"), str(record)], dt=0.01)
    assert caught.value.field == "units"


def test_vertical_components_of_a_list_of_files_are_left_out(tmp_path):
    files = [str(record_at2(tmp_path, name, name[2:-4])) for name in ("a-000.at2", "a-090.at2", "a-UP.at2")]
    for given in (files, [str(tmp_path)]):
        with pytest.warns(RecordWarning, match=r"^Left out: 1 vertical component, a-UP\.at2\.$"):
            assert names(find_motions(given)) == ["a-000", "a-090"]
    with pytest.raises(InputError, match=r"No horizontal component was given, only 1 vertical component: a-UP\.at2\."):
        find_motions(files[2:])


def test_all_files_that_cannot_be_read_are_told(tmp_path):
    bad = [tmp_path / name for name in ("b.at2", "c.at2")]
    for file in bad:
        file.write_text("no record")
    files = [str(record_at2(tmp_path, "a.at2", "90")), *map(str, bad)]
    with pytest.raises(InputError, match=r"2 of 3 files .*b\.at2: no .*c\.at2: no .*--on-error skip") as caught:
        find_motions(files)
    assert "on_error" not in str(caught.value)
    with pytest.warns(RecordWarning, match=r"^Left out: 2 of 3 files cannot be read\."):
        assert names(find_motions(files, on_error="skip")) == ["a"]
    with pytest.raises(InputError, match="--units, --dt and --on-error are for record files"):
        find_motions(["el-centro-1940"], on_error="skip")


def test_a_vertical_file_belongs_to_one_motion(tmp_path):
    along, upwards = str(record_at2(tmp_path, "a-000.at2", "0")), str(record_at2(tmp_path, "a-UP.at2", "UP"))
    (found,) = find_motions([along], vertical=upwards)
    assert found.motion == read_motion(along, vertical=upwards)
    assert found.describe()["pva"] == found.motion.pva
    assert "pva" not in find_motions([along])[0].describe()
    other = str(record_at2(tmp_path, "a-090.at2", "90"))
    with pytest.raises(InputError, match=r"a-UP\.at2 is the vertical component of one motion, but 2 were given\. Name"):
        find_motions([along, other], vertical=upwards)
    paired = find_motions([along, other, upwards], vertical="pair")
    assert [item.motion.vertical.tolist() for item in paired] == [found.motion.vertical.tolist()] * 2


def test_a_suite_with_a_vertical_file_of_columns(tmp_path):
    np.savetxt(tmp_path / "up.txt", ACCELERATION)
    with pytest.warns(
        RecordWarning, match=r"The motion 'EL-CENTRO-1940-NS' lasts 31\.18 s, and its vertical component 0"
    ):
        (found,) = find_motions(["el-centro-1940"], "m/s2", 0.02, vertical=str(tmp_path / "up.txt"))
    assert found.motion.vertical[:50].tolist() == ACCELERATION.tolist()
    with pytest.raises(InputError, match=r"On the command line these are --units and --dt\.$"):
        find_motions(["el-centro-1940"], "m/s2", vertical=str(tmp_path / "up.txt"))


def test_motions_that_differ_only_vertically_are_two(tmp_path):
    for folder, peak in (("x", 1.0), ("y", 2.0)):
        (tmp_path / folder).mkdir()
        text = f"time (s),acc (m/s2),vertical (m/s2)\n0,0,0\n0.05,1,{peak}\n0.1,0,0\n"
        (tmp_path / folder / "a.csv").write_text(text)
    with pytest.raises(InputError, match="hold different motions, both named 'a'"):
        find_motions([str(tmp_path / "x"), str(tmp_path / "y")])


def invoke_survey(*arguments, command="survey", columns=160):
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
    result = invoke_survey(folder)
    assert result.exit_code == 0
    rows = [line.split() for line in result.stdout.splitlines()]
    assert [
        "RSN7_A090.AT2",
        "AT2",
        "Some",
        "Station",
        "90",
        "g",
        "yes",
        "0.1",
        "3",
        "0.1000",
        "6.5",
        "12.5",
        "360",
    ] in rows
    knet_row = next(row for row in rows if row[:4] == ["MYG002.EW", "K-NET", "MYG002", "E-W"])
    assert knet_row[-7:] == ["yes", "0.1", "10", "0.0001551", "5.7", "-", "-"]
    assert (
        "3 taken, 3 left out; 2 recordings: 1 with a horizontal pair, 1 with a vertical component, 1 with both"
        in result.stdout
    )
    assert "  RSN7_A-UP.AT2: vertical component\n" in result.stdout
    assert "  table.csv: a table about the records\n" in result.stdout
    assert "  notes.txt: holds no numbers" in result.stdout
    paired = invoke_survey(folder, "--vertical", "pair").stdout
    assert "4 taken, 2 left out" in paired
    assert "Taken, but:\n  MYG002.EW: without a vertical component\n" in paired


def test_what_says_so_is_told_once_for_all_files_of_which_it_is_true(tmp_path):
    for k in range(9):
        (tmp_path / f"lab-{k}.csv").write_text(f"time (s),acc (g)\n0,0\n0.01,0.{k + 1}\n0.02,0\n")
    (tmp_path / "old.txt").write_text("units: cm/s2\ndt = 0.005 s\n0\n1\n0\n1\n")
    said = [" ".join(line.split()) for line in invoke_survey(tmp_path).stdout.partition("As read:")[2].splitlines()]
    some = "lab-0.csv, lab-1.csv, lab-2.csv, lab-3.csv, lab-4.csv, lab-5.csv and 3 more"
    assert f'unit g label "acc (g)" {some}' in said
    assert f'time step 0.01 s column "time (s)" {some}' in said
    assert 'unit cm/s2 line 1: "units: cm/s2" old.txt' in said
    assert 'time step 0.005 s line 2: "dt = 0.005 s" old.txt' in said
    (tmp_path / "old.txt").unlink()
    said = [" ".join(line.split()) for line in invoke_survey(tmp_path).stdout.splitlines()]
    assert 'unit g label "acc (g)" all 9' in said


def test_many_files_of_one_reason_are_counted(tmp_path):
    for k in range(9):
        (tmp_path / f"note-{k}.md").write_text("nothing")
    (tmp_path / "A090.AT2").write_text(at2("90"))
    said = invoke_survey(tmp_path).stdout
    assert "note-4.md, note-5.md and 3 more: no record, by suffix and beginning\n" in said


def test_json(folder):
    found = json.loads(invoke_survey(folder, "--json").stdout)
    assert len(found["entries"]) == 6
    entry = next(each for each in found["entries"] if each["file"] == "RSN7_A180.AT2")
    assert (entry["taken"], entry["magnitude"], entry["pga"]) == (True, 6.5, 0.1 * 9.81)
    assert {"what": "unit", "value": "g", "evidence": 'line 2: "ACCELERATION IN UNITS OF G"'} in entry["findings"]
    assert found["stations"] == [
        {"name": "NIED MYG002 2006-01-18 23:25", "horizontal": ["MYG002-EW"], "vertical": None},
        {"name": "RSN7", "horizontal": ["RSN7_A090", "RSN7_A180"], "vertical": "RSN7_A-UP"},
    ]


def test_files_and_units(folder):
    (folder / "lab.txt").write_text("0\n0.1\n0\n")
    result = invoke_survey(folder / "lab.txt", folder / "RSN7_A090.AT2", "--units", "g", "--dt", "0.1")
    assert "2 taken, 0 left out" in result.stdout
    both = invoke_survey(folder, folder / "lab.txt")
    assert both.exit_code == 2
    assert "One folder or several files are expected, but" in both.stderr
    assert "Survey one folder at a time." in both.stderr
    assert invoke_survey(folder / "none").exit_code == 2


def test_motion_reads_what_survey_takes(folder):
    (folder / "notes.txt").unlink()
    (folder / "CE.v2c").write_text(cosmos(90) + cosmos(360) + cosmos(400))
    result = invoke_survey(folder, "--json", "--vertical", "pair", command="motion")
    found = {row["name"]: row for row in json.loads(result.stdout)["motions"]}
    assert set(found) == {"CE-090", "CE-360", "MYG002-EW", "RSN7_A090", "RSN7_A180"}
    assert found["RSN7_A090"]["metadata"]["distance_km"] == 12.5
    assert found["CE-360"]["metadata"]["vertical_source"] == "CE-UP"
    one = invoke_survey(folder / "RSN7_A090.AT2", folder / "table.csv", "--json", command="motion")
    assert json.loads(one.stdout)["motions"][0]["metadata"]["vs30"] == 360
    with pytest.warns(rf.RecordWarning, match="Without a vertical component: 1 of 5 records, MYG002-EW"):
        suite = rf.read_suite(folder, vertical="pair")
    assert suite["CE-090"].pva == found["CE-090"]["pva"]
