"""``rockflex run --friction``: required friction and where sliding would start, printed and written."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import rockflex as rf
from builders import make_frame
from rockflex.cli import _batch, app
from rockflex.study import Case

STRUCTURE = str(Path(rf.__file__).parents[2] / "examples" / "structure_1.toml")
FRAME = make_frame()
EL_CENTRO = rf.load_suite("el-centro-1940")[0]
NAMES = ["required_friction", "required_friction_excluding_impacts", "sliding_time"]


def invoke(*arguments):
    return CliRunner().invoke(app, ["run", *map(str, arguments)], env={"COLUMNS": "200"})


def rows_of(*arguments):
    result = invoke(*arguments, "--json")
    assert result.exit_code == 0, result.stderr
    return json.loads(result.stdout)["runs"]


def test_document_has_what_the_library_finds():
    models = "2DOF-C,MDOF-S,rigid,fixed"
    rows = rows_of(STRUCTURE, "el-centro-1940", "--model", models, "--friction", 0.2, "--scale", 1, "--scale", 1.5)
    for row in rows:
        run = rf.simulate(FRAME, EL_CENTRO.scaled(row["scale"]), row["model"])
        assert row["required_friction"] == run.required_friction
        assert row["required_friction_excluding_impacts"] == run.required_friction_excluding_impacts()
        assert row["sliding_time"] == run.sliding_time(0.2)
    assert {row["sliding_time"] is None for row in rows} == {True, False}


def test_without_the_option_nothing_is_said():
    row = rows_of(STRUCTURE, "el-centro-1940", "--model", "2DOF-S")[0]
    assert not set(NAMES) & set(row)
    assert "μ" not in invoke(STRUCTURE, "el-centro-1940", "--model", "2DOF-S").stdout


def test_options_name_the_coefficient():
    found = json.loads(invoke(STRUCTURE, "el-centro-1940", "--friction", 0.2, "--json").stdout)
    assert found["options"]["friction"] == 0.2
    assert found["units"]["sliding_time"] == "s"


def test_table():
    result = invoke(STRUCTURE, "el-centro-1940", "--model", "2DOF-C,rigid,fixed", "--friction", 0.2)
    lines = result.stdout.splitlines()
    last = [line.split()[1:] for line in lines if line.startswith("EL-CENTRO")][-3:]
    assert last == [
        ["2DOF-C", "0.1601", "0.1601", "no"],
        ["rigid", "0.1955", "0.1870", "no"],
        ["fixed", "0.4229", "0.4229", "2.3865"],
    ]
    assert lines[-2] == (
        "μ_req: largest |ΣF_x|/ΣF_z (Eqs. 20-22), of the whole run and without the 0.05 s after each impact; the base "
        "slides where it passes 0.2"
    )


def test_a_base_that_loses_contact():
    flags = ("--model", "2DOF-C", "--impact", "restitution", "--restitution", 0.9, "--friction", 0.5)
    row = rows_of(STRUCTURE, "el-centro-1940", *flags)[0]
    assert row["required_friction"] == "inf"
    assert row["sliding_time"] == pytest.approx(2.15035, abs=1e-4)
    assert "inf" in invoke(STRUCTURE, "el-centro-1940", *flags).stdout


def test_files(tmp_path):
    folder = tmp_path / "out"
    flags = ("--model", "2DOF-S,2DOF-S-BW", "--yield-displacement", 0.05, "--friction", 0.15)
    result = invoke(STRUCTURE, "el-centro-1940", *flags, "--out", folder)
    assert result.exit_code == 0, result.stderr
    with (folder / "results.csv").open(newline="") as file:
        table = list(csv.DictReader(file))
    assert list(table[0])[-3:] == NAMES
    run = rf.simulate(FRAME, EL_CENTRO, "2DOF-S-BW", bouc_wen=rf.BoucWen(0.05))
    assert float(table[1]["required_friction"]) == run.required_friction
    assert float(table[1]["sliding_time"]) == run.sliding_time(0.15)
    assert json.loads((folder / "summary.json").read_text("utf-8"))["runs"][1]["sliding_time"] == run.sliding_time(0.15)
    with (folder / "history-EL-CENTRO-1940-NS.csv").open(newline="") as file:
        history = [row for row in csv.DictReader(file) if row["model"] == "2DOF-S-BW"]
    for name in ("yielding", "horizontal_reaction", "vertical_reaction", "friction_demand"):
        np.testing.assert_array_equal([float(row[name]) for row in history], getattr(run, name))


def test_histories_have_no_friction_unless_asked(tmp_path):
    invoke(STRUCTURE, "el-centro-1940", "--model", "2DOF-S", "--out", tmp_path / "out")
    head = (tmp_path / "out" / "history-EL-CENTRO-1940-NS.csv").read_text("utf-8").splitlines()[0].split(",")
    assert not {"yielding", "friction_demand"} & set(head)
    assert {"total_top_displacement", "horizontal_reaction", "vertical_reaction"} <= set(head)


def test_many_runs(monkeypatch):
    scales = [item for k in range(22) for item in ("--scale", 0.5 + k / 16)]
    arguments = (STRUCTURE, "el-centro-1940", *scales, "--model", "2DOF-S,rigid,fixed", "--friction", 0.4)
    many = rows_of(*arguments)
    monkeypatch.setattr(_batch, "MAX_TIMED_RUNS", 10**6)
    few = rows_of(*arguments)
    assert len(many) == 66
    assert {row.pop("run_time") for row in many} == {None}
    assert all(row.pop("run_time") > 0.0 for row in few)
    assert many == few


def test_a_run_that_cannot_be_solved(monkeypatch):
    solved = Case.run

    def flaky(case, motion, scale=1.0):
        if case.model.label == "MDOF-S":
            message = "The motion is not finite at 1 s."
            raise rf.SolverError(message)
        return solved(case, motion, scale)

    monkeypatch.setattr(Case, "run", flaky)
    arguments = (STRUCTURE, "el-centro-1940", "--friction", 0.4)
    assert [rows_of(*arguments)[1][name] for name in NAMES] == [None, None, None]
    last = [line.split() for line in invoke(*arguments).stdout.splitlines() if "MDOF-S" in line][-1]
    assert last[2:] == ["-", "-", "-"]
