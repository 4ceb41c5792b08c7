"""``rockflex motion``: what is in a record or a suite."""

import csv
import json

import numpy as np
import pytest
from typer.testing import CliRunner

import rockflex as rf
from rockflex.cli import app

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


def at2(folder, name, component, peak):
    """A record file of four samples."""
    text = f"Event, 1/1/2001, Station, {component}\nUNITS OF G\nNPTS= 4, DT= .1\n0 {peak} -.2 0\n"
    (folder / name).write_text(text)
    return folder / name


def test_vertical_component(tmp_path):
    along, upwards = at2(tmp_path, "A-000.AT2", "0", 0.4), at2(tmp_path, "A-UP.AT2", "UP", 0.3)
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
