"""`rockflex run`: its tables, files and report."""

import csv
import io
import json
import sys
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console
from typer.testing import CliRunner

import rockflex as rf
from builders import make_frame
from rockflex.cli import _batch, _run_results
from rockflex.cli import _console as console
from rockflex.cli._app import app
from rockflex.response._response import PEAKS
from rockflex.studies import PreparedCase

EXAMPLES = Path(__file__).parents[2] / "examples"
STRUCTURE = str(EXAMPLES / "structure_1.toml")
FRAME = make_frame()
FLAGS = [
    *("--stories", "5", "--story-height", "3", "--story-mass", "40e3", "--base-mass", "40e3"),
    *("--stiffness-ratio", "inf", "--period", "1", "--aspect-ratio", "10", "--damping-ratio", "0.02"),
]
EL_CENTRO = rf.load_suite("el-centro-1940")[0]
FF = rf.load_suite("fema-p695-far-field")


def invoke(*arguments, columns=200):
    return CliRunner().invoke(app, ["run", *map(str, arguments)], env={"COLUMNS": str(columns)})


def document(*arguments):
    result = invoke(*arguments, "--json")
    assert result.exit_code == 0, result.stderr

    def refuse(token):
        pytest.fail(f"{token} is not JSON")

    return json.loads(result.stdout, parse_constant=refuse)


def assert_is_run(row, motion, scale, model, **more):
    response = rf.simulate(FRAME, motion.scaled(scale), model, output="peaks", **more)
    peaks = {name: None if value != value else value for name, value in response.peaks().items()}  # JSON has no NaN
    expected = peaks | {"motion": motion.name, "scale": scale, "error": None}
    assert {name: row[name] for name in expected} == expected


def test_default_models_side_by_side():
    found = document(STRUCTURE, "el-centro-1940")
    assert [row["model"] for row in found["runs"]] == ["2DOF-S", "MDOF-S", "fixed"]
    for row in found["runs"]:
        assert_is_run(row, EL_CENTRO, 1.0, row["model"])
        assert 0.0 < row["run_time"] < found["elapsed"]


def test_document_says_what_was_run():
    found = document(STRUCTURE, "fema-p695-far-field/FF-2-a", "--model", "fixed")
    props = FRAME.rocking()
    assert found["versions"]["rockflex"] == rf.__version__
    assert found["structure"]["stiffness_ratio"] == "inf"
    assert found["structure"]["name"] == "Structure 1 of Table 1"
    assert found["properties"]["omega"] == props.omega.tolist()
    assert found["properties"]["resisting_moment"] == props.resisting_moment
    assert found["motions"][0]["pga"] == FF["FF-2-a"].pga
    assert found["motions"][0]["metadata"]["event"] == "Northridge"
    assert found["options"] == {"models": ["fixed"], "scales": [1.0], "free_vibration": 0.0}


@pytest.mark.slow
def test_flags_and_options_in_the_place_of_arguments():
    by_file = document(STRUCTURE, "el-centro-1940", "--model", "MDOF-S")["runs"][0]
    by_flags = document(*FLAGS, "--motion", "el-centro-1940", "--model", "MDOF-S")["runs"][0]
    by_option = document("el-centro-1940", "--structure", STRUCTURE, "--model", "MDOF-S")["runs"][0]
    for row in (by_file, by_flags, by_option):
        del row["run_time"]
    assert by_file == by_flags == by_option


def test_motions_scales_models_in_this_order():
    names = ("fema-p695-far-field/FF-9-a", "el-centro-1940")
    found = document(STRUCTURE, *names, "--scale", 1, "--scale", 2, "--model", "2DOF-S,fixed", "--model", "3DOF-S")
    expected = list(product((FF["FF-9-a"], EL_CENTRO), (1.0, 2.0), ("2DOF-S", "fixed", "3DOF-S")))
    for row, (motion, scale, model) in zip(found["runs"], expected, strict=True):
        assert_is_run(row, motion, scale, model)


@pytest.mark.parametrize(("given", "value"), [("2.5", 2.5), ("settle", "settle")])
def test_free_vibration(given, value):
    found = document(STRUCTURE, "fema-p695-far-field/FF-2-a", "--model", "2DOF-S", "--free-vibration", given)
    assert_is_run(found["runs"][0], FF["FF-2-a"], 1.0, "2DOF-S", free_vibration=value)
    assert found["runs"][0]["end_time"] > FF["FF-2-a"].duration + 2.0


@pytest.mark.slow
@pytest.mark.parametrize("workers", [[], ["--workers", 3]])
def test_many_runs_are_those_done_one_by_one(monkeypatch, workers):
    arguments = [STRUCTURE, "fema-p695-near-field-pulse", "--scale", 1, "--scale", 0.5, "--model", "2DOF-S,fixed"]
    arguments += workers
    many = document(*arguments)["runs"]
    monkeypatch.setattr(_batch, "MAX_TIMED_RUNS", 10**6)
    few = document(*arguments)["runs"]
    assert len(many) == len(few) == 112
    assert {row.pop("run_time") for row in many} == {None}
    assert all(row.pop("run_time") > 0.0 for row in few)
    assert many == few


def test_file_with_units_and_step(tmp_path):
    path = tmp_path / "record.txt"
    np.savetxt(path, EL_CENTRO.acceleration / 9.81)
    row = document(STRUCTURE, path, "--units", "g", "--dt", "0.02", "--model", "2DOF-S")["runs"][0]
    expected = rf.simulate(FRAME, EL_CENTRO, "2DOF-S", output="peaks")
    assert row["motion"] == "record"
    assert row["max_rotation"] == pytest.approx(expected.max_rotation, rel=1e-9)


def test_table_on_a_wide_terminal():
    lines = invoke(STRUCTURE, "el-centro-1940", "--model", "MDOF-S").stdout.splitlines()
    assert lines[0] == "Structure 1 of Table 1: 5 modes, T_1 = 1 s, h*_1/B = 10, ζ_1 = 0.02"
    assert lines[2].split() == ["u_top", "u_top"]
    assert lines[3].split() == ["θ_max", "relative", "total", "M_b", "V_b", "time", "ΣF_x", "N_min"]
    units = ["[mrad]", "[mm]", "[mm]", "[kN", "m]", "[kN]", "impacts", "[ms]", "[kN]", "[kN]"]
    assert lines[4].split() == ["motion", "model", "status", *units]
    response = rf.simulate(FRAME, EL_CENTRO, "MDOF-S", output="peaks")
    row = lines[6].split()
    peaks = ["16.48", "53.71", f"{1e3 * response.max_total_top_displacement:.1f}", "3141", "502.1", "25"]
    assert row[:9] == ["EL-CENTRO-1940-NS", "MDOF-S", "rocking", *peaks]
    ground = (response.max_horizontal_reaction, response.min_vertical_reaction)
    assert list(map(float, row[10:])) == pytest.approx([each / 1e3 for each in ground], rel=1e-3)
    assert "u_top total: largest displacement of the top relative to the ground" in lines


def test_chimney_in_larger_units_reproduces_section_4_1_1():
    result = invoke(
        EXAMPLES / "structure_properties.toml", "el-centro-1940", "--scale", 2, "--model", "6DOF-S,5DOF-fixed"
    )
    rows = [line.split() for line in result.stdout.splitlines() if line.startswith("EL-CENTRO")]
    assert "[MN m]" in result.stdout
    assert rows[0][4] == "3.152"
    assert 1.0 - float(rows[0][7]) / float(rows[1][8]) == pytest.approx(0.44, abs=0.005)


def test_narrow_terminal_gets_a_table_a_motion_and_nothing_is_cut():
    arguments = (STRUCTURE, "el-centro-1940", "fema-p695-far-field/FF-9-a", "--scale", 2, "--times")
    wide, narrow, tiny = (invoke(*arguments, columns=columns).stdout for columns in (200, 80, 30))
    assert max(map(len, narrow.splitlines())) <= 80
    assert "EL-CENTRO-1940-NS × 2" in narrow.splitlines()
    assert "FF-9-a × 2" in narrow.splitlines()
    for text in (wide, narrow, tiny):
        assert "…" not in text
        for word in ("overturned †", "no uplift", "t(θ_max)", "19.159", "0.7 atan(B/h*_1)"):
            assert word in text


def test_colours_are_of_statuses_and_not_of_whatever_reads_like_one():
    written = io.StringIO()
    table = console.table(["motion", "status"], [["overturned", console.StyledCell("rocking †", "yellow")]], 2)
    Console(file=written, force_terminal=True, color_system="standard", width=60).print(table)
    assert "\noverturned  \x1b[33mrocking †\x1b[0m" in written.getvalue()


def test_times_are_those_of_the_peaks():
    response = rf.simulate(FRAME, EL_CENTRO, "MDOF-S", output="peaks")
    result = invoke(STRUCTURE, "el-centro-1940", "--model", "MDOF-S", "--times")
    last = [line for line in result.stdout.splitlines() if line.startswith("EL-CENTRO")][-1].split()
    names = ("rotation", "top_displacement", "total_top_displacement", "base_moment", "base_shear")
    times = [getattr(response, f"time_of_max_{name}") for name in (*names, "horizontal_reaction")]
    times.append(response.time_of_min_vertical_reaction)
    assert list(map(float, last[2:])) == pytest.approx([*times, response.end_time], abs=1e-3)


@pytest.mark.slow
def test_folder_of_results(tmp_path):
    folder = tmp_path / "out"
    scales = ("--scale", 1, "--scale", 2)
    result = invoke(STRUCTURE, "fema-p695-far-field/FF-2-a", *scales, "--model", "2DOF-S,fixed", "--out", folder)
    assert result.exit_code == 0, result.stderr
    assert result.stderr == f"Written to {folder}\n"
    names = ["history-FF-2-a-x1.csv", "history-FF-2-a-x1.png", "history-FF-2-a-x2.csv", "history-FF-2-a-x2.png"]
    assert sorted(path.name for path in folder.iterdir()) == [*names, "results.csv", "summary.json"]

    summary = json.loads((folder / "summary.json").read_text("utf-8"))
    assert summary["files"] == [*names, "results.csv", "summary.json"]
    with (folder / "results.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    peaks = [name for name in PEAKS if name not in ("model", "motion", "status")]
    assert list(rows[0]) == ["motion", "scale", "model", "status", "error", *peaks]
    assert [float(row["max_base_moment"]) for row in rows] == [row["max_base_moment"] for row in summary["runs"]]
    assert [row["model"] for row in rows] == ["2DOF-S", "fixed", "2DOF-S", "fixed"]

    response = rf.simulate(FRAME, FF["FF-2-a"].scaled(2.0), "2DOF-S")
    with (folder / names[2]).open(newline="") as file:
        history = [row for row in csv.DictReader(file) if row["model"] == "2DOF-S"]
    names_of = ("time", "rotation", "top_displacement", "total_top_displacement", "base_moment", "base_shear")
    for name in (*names_of, "ground_acceleration", "horizontal_reaction", "vertical_reaction"):
        np.testing.assert_array_equal([float(row[name]) for row in history], getattr(response, name))
    for name in (names[1], names[3]):
        assert (folder / name).read_bytes().startswith(b"\x89PNG")


SLENDER = [*FLAGS[:-8], "--stiffness-ratio", "0", "--period", "0.5", "--aspect-ratio", "10", "--damping-ratio", "0.02"]


def test_a_base_that_is_pulled_down_is_told_in_words():
    frame = make_frame(stiffness_ratio=0.0, period=0.5)
    response = rf.simulate(frame, FF["FF-1-a"].scaled(2.0), "MDOF-S", output="peaks")
    assert response.min_vertical_reaction < 0.0
    arguments = (*SLENDER, "fema-p695-far-field/FF-1-a", "--scale", 2, "--model", "MDOF-S,fixed")
    (warning,) = response.warnings
    assert invoke(*arguments).stderr == f"Warning: FF-1-a × 2: {warning}\n"
    assert [row["warnings"] for row in document(*arguments)["runs"]] == [[warning], []]


def test_a_tendon_beyond_its_yield_force_is_told_in_words():
    arguments = (EXAMPLES / "restrained_pier.toml", "el-centro-1940", "--scale", 3, "--model", "MDOF-S")
    row = document(*arguments)["runs"][0]
    assert row["tendon_utilisation"] > 1.0
    said = f"A tendon carries more than its yield force, up to {row['tendon_utilisation']:.4g} times it."
    assert f"Warning: EL-CENTRO-1940-NS × 3: {said}" in invoke(*arguments).stderr


@pytest.mark.slow
def test_unknown_height_of_the_top_leaves_its_total_displacement_out(tmp_path):
    content = (EXAMPLES / "structure_properties.toml").read_text("utf-8")
    file = tmp_path / "structure.toml"
    file.write_text("".join(line for line in content.splitlines(True) if not line.startswith("top_height")), "utf-8")
    result = invoke(file, "el-centro-1940", "--model", "2DOF-S", "--out", tmp_path / "out", "--json")
    assert result.exit_code == 0, result.stderr
    assert json.loads(result.stdout)["runs"][0]["max_total_top_displacement"] is None
    with (tmp_path / "out" / "history-EL-CENTRO-1940-NS.csv").open(newline="") as table:
        assert {row["total_top_displacement"] for row in csv.DictReader(table)} == {""}


def test_a_model_with_the_mass_left_out_moves_as_the_one_without():
    plain, corrected = document(STRUCTURE, "el-centro-1940", "--model", "2DOF-S,2DOF-S-R")["runs"]
    assert (plain["model"], corrected["model"]) == ("2DOF-S", "2DOF-S-R")
    for name in ("max_rotation", "max_total_top_displacement", "max_horizontal_reaction", "n_impacts"):
        assert corrected[name] == plain[name]
    assert corrected["max_base_shear"] != plain["max_base_shear"]


def test_no_histories_beyond_the_limit(tmp_path):
    folder = tmp_path / "out"
    names = ("el-centro-1940", "fema-p695-far-field/FF-2-a")
    result = invoke(STRUCTURE, *names, "--figures", 1, "--out", folder, "--json")
    assert sorted(path.name for path in folder.iterdir()) == ["results.csv", "summary.json"]
    assert "no histories and figures of more than --figures" in result.stderr
    printed, written = json.loads(result.stdout), json.loads((folder / "summary.json").read_text("utf-8"))
    del written["files"]
    assert printed == written


def test_nothing_is_written_when_a_figure_fails(tmp_path, monkeypatch):
    def fail(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("rockflex.plot._figures.save_figure", fail)
    result = invoke(STRUCTURE, "el-centro-1940", "--out", tmp_path / "out")
    assert result.exit_code == 2
    assert "Cannot write to" in result.stderr
    assert "No space left on device" in result.stderr
    assert list(tmp_path.iterdir()) == []


def test_full_folder_is_refused_before_anything_runs(tmp_path, monkeypatch):
    (tmp_path / "notes.txt").touch()
    monkeypatch.setattr(_batch, "run_batch", lambda _: pytest.fail("must not run"))
    result = invoke(STRUCTURE, "el-centro-1940", "--out", tmp_path)
    assert result.exit_code == 2
    assert "is not empty. Give another one, or --force" in result.stderr


def break_down(monkeypatch, broken):
    """Let no run with these models be solved."""
    solved = PreparedCase.run

    def run(case, motion, scale=1.0):
        if case.model.label in broken:
            message = "The motion is not finite at 1 s."
            raise rf.SolverError(message)
        return solved(case, motion, scale)

    monkeypatch.setattr(PreparedCase, "run", run)


@pytest.mark.parametrize(("more", "code"), [([], 0), (["--strict"], 1)])
def test_failed_runs_are_told_and_the_others_go_on(monkeypatch, more, code):
    break_down(monkeypatch, {"MDOF-S"})
    result = invoke(STRUCTURE, "el-centro-1940", *more)
    assert result.exit_code == code
    assert "1 of 3 runs could not be solved:" in result.stderr
    assert "MDOF-S under EL-CENTRO-1940-NS × 1: The motion is not finite at 1 s." in result.stderr
    row = next(line.split() for line in result.stdout.splitlines() if "MDOF-S" in line)
    assert row[2:] == ["failed", *"---------"]
    assert "fixed" in result.stdout


@pytest.mark.slow
def test_failed_runs_in_the_files(monkeypatch, tmp_path):
    break_down(monkeypatch, {"MDOF-S"})
    result = invoke(STRUCTURE, "el-centro-1940", "--out", tmp_path / "out", "--json")
    failed = json.loads(result.stdout)["runs"][1]
    assert failed["status"] is None
    assert failed["max_rotation"] is None
    assert failed["error"] == "The motion is not finite at 1 s."
    with (tmp_path / "out" / "results.csv").open(newline="") as file:
        row = list(csv.DictReader(file))[1]
    assert (row["status"], row["max_rotation"], row["error"]) == ("", "", "The motion is not finite at 1 s.")


def test_long_list_of_failures_is_cut(monkeypatch):
    break_down(monkeypatch, {"MDOF-S"})
    scales = [item for k in range(1, 8) for item in ("--scale", k)]
    result = invoke(STRUCTURE, "el-centro-1940", *scales)
    assert "7 of 21 runs could not be solved:" in result.stderr
    assert "and 2 more; --json and results.csv list them all" in result.stderr


@pytest.mark.parametrize("strict", [[], ["--strict"]])
def test_nothing_solved_is_a_solver_error(monkeypatch, tmp_path, strict):
    break_down(monkeypatch, {"MDOF-S", "2DOF-S", "fixed"})
    result = invoke(STRUCTURE, "el-centro-1940", "--out", tmp_path / "out", *strict)
    assert result.exit_code == 1
    assert result.stdout == ""
    assert result.stderr.startswith("Error: None of the 3 runs could be solved; 2DOF-S under EL-CENTRO-1940-NS: The")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([STRUCTURE, "el-centro"], "'el-centro' is neither a suite"),
        ([STRUCTURE], "No ground motion was given."),
        (["el-centro-1940"], "No structure was given."),
        ([STRUCTURE, "missing.csv"], "'missing.csv' is neither a suite"),
        ([STRUCTURE, "el-centro-1940", "--model", "2DOF-X"], "Unknown model '2DOF-X'. Expected \"2DOF-S\""),
        ([STRUCTURE, "el-centro-1940", "--model", ","], "No model was given. Expected labels such as"),
        ([STRUCTURE, "el-centro-1940", "--model", "9DOF-S"], "Model 9DOF-S needs 8 modes, but the structure has 5."),
        ([STRUCTURE, "el-centro-1940", "--scale", "nan"], "--scale must be one or more finite factors, but [nan] was"),
        ([STRUCTURE, "el-centro-1940", "--free-vibration", "-1"], "--free-vibration must be zero or more seconds (at"),
        ([STRUCTURE, "el-centro-1940", "--free-vibration", "soon"], "or \"settle\", but 'soon' was given."),
        ([STRUCTURE, "el-centro-1940", "--stories", "3"], "The structure was given by"),
        (["el-centro-1940", *FLAGS, "--story-mass", "-4"], "--story-mass must be a positive, finite number in kg, but"),
        (["el-centro-1940", *FLAGS, "--period", "nan"], "period must be a positive, finite number in s, but nan"),
    ],
)
def test_bad_input(arguments, said, tmp_path):
    result = invoke(*arguments, "--out", tmp_path / "out", "--json")
    assert result.exit_code == 2
    assert result.stdout == ""
    assert result.stderr.startswith("Error: ")
    assert said in result.stderr
    assert list(tmp_path.iterdir()) == []


def test_bad_usage():
    assert invoke(STRUCTURE, "el-centro-1940", "--workers", 0).exit_code == 2
    assert invoke(STRUCTURE, "el-centro-1940", "--stories", "many").exit_code == 2


def test_units_cover_every_number_of_a_run():
    dimensionless = {
        "scale",
        "n_uplifts",
        "n_impacts",
        "tendon_utilisation",
        "balance_ratio",
        "guarded_impacts",
        "leaning_push",
        "column_pull",
    }
    named = {name.removesuffix("*") for name in _run_results.UNITS}
    row = document(STRUCTURE, "el-centro-1940", "--model", "fixed")["runs"][0]
    for name, value in row.items():
        if isinstance(value, int | float) and not isinstance(value, bool) and name not in dimensionless:
            assert any(name.startswith(known) for known in named), name


def test_bar_on_a_terminal_leaves_stdout_alone():
    arguments = ["run", STRUCTURE, "fema-p695-near-field-pulse", "--model", "2DOF-S,3DOF-S,fixed", "--json"]
    result = CliRunner().invoke(app, arguments, env={"FORCE_COLOR": "1", "TERM": "xterm"})
    assert "Simulating" in result.stderr
    assert len(json.loads(result.stdout)["runs"]) == 84


def test_ctrl_c_ends_without_a_trace(tmp_path, monkeypatch):
    def interrupted(*_arguments, **_options):
        raise KeyboardInterrupt

    monkeypatch.setattr(PreparedCase, "run", interrupted)
    done = invoke(STRUCTURE, "el-centro-1940", "--out", tmp_path / "out")
    assert done.exit_code == 130
    assert done.stderr == "Stopped; nothing was written.\n"
    assert list(tmp_path.iterdir()) == []


FUSED = """
[wall_frame]
height = 20.0
mass = 400e3
stiffness_parameter = 0.0
base_mass = 40e3
period = 0.5
aspect_ratio = 6.0
damping_ratio = 0.02
n_modes = 2

[[elements]]
kind = "tendon"
initial_force = 1e6
stiffness = 2e7

[[elements]]
kind = "yielding_dissipator"
position = 0.5
stiffness = 2e8
yield_force = 4e5
"""


@pytest.fixture
def fused(tmp_path):
    path = tmp_path / "fused.toml"
    path.write_text(FUSED, "utf-8")
    return path


@pytest.mark.slow
def test_elements_are_told_with_their_forces_and_energies(fused, tmp_path):
    arguments = (fused, "fema-p695-far-field/FF-2-a", "--scale", 2, "--model", "MDOF-S")
    response = rf.simulate(rf.read_structure(fused), FF["FF-2-a"].scaled(2.0))
    forces, energies = response.max_element_force, response.element_energy
    row = document(*arguments)["runs"][0]
    assert [row["max_element_force_1"], row["max_element_force_2"]] == forces.tolist()
    assert row["max_element_elongation_2"] == response.max_element_elongation[1]
    assert row["residual_rotation"] == response.residual_rotation
    assert "element_energy_1" not in row
    printed = invoke(*arguments, "--out", tmp_path / "out").stdout
    rows = [line.split() for line in printed.splitlines()]
    assert ["2", "yielding", "dissipator", "0.5000", "200000", "-", "400.0", "0"] in rows
    assert ["FF-2-a", "2", "MDOF-S", *(console.number(each / 1e3) for each in forces)] in rows
    assert ["FF-2-a", "2", "MDOF-S", *(console.number(each / 1e3) for each in energies)] in rows
    assert "F, E: largest force of each element, and the energy that it takes (with --out)" in printed
    with (tmp_path / "out" / "results.csv").open(newline="") as table:
        (kept,) = csv.DictReader(table)
    assert float(kept["element_energy_2"]) == energies[1] > 0.0
    summary = json.loads((tmp_path / "out" / "summary.json").read_text("utf-8"))
    assert [each["kind"] for each in summary["structure"]["elements"]] == ["tendon", "yielding_dissipator"]


def test_a_base_that_does_not_close_is_told(fused):
    fused.write_text(FUSED.replace("yield_force = 4e5", "yield_force = 9e6"), "utf-8")
    arguments = (fused, "fema-p695-far-field/FF-2-a", "--scale", 4, "--model", "2DOF-S", "--free-vibration", 20)
    residual = document(*arguments)["runs"][0]["residual_rotation"]
    printed = invoke(*arguments).stdout
    assert ("θ_end" in printed.split("θ_max: ")[0]) == (residual != 0.0)
    free = invoke(STRUCTURE, "el-centro-1940", "--model", "MDOF-S").stdout
    assert not any(word in free for word in ("θ_end", "F_1", "Between base"))


def test_a_run_that_fails_has_no_forces(fused, monkeypatch):
    def fail(case, motion, scale=1.0):
        if case.model.label == "2DOF-S":
            raise rf.SolverError("no way")
        return KEPT(case, motion, scale)

    KEPT = PreparedCase.run
    monkeypatch.setattr(PreparedCase, "run", fail)
    result = invoke(fused, "el-centro-1940", "--model", "2DOF-S,MDOF-S", "--scale", 2)
    rows = [line.split() for line in result.stdout.splitlines()]
    assert ["EL-CENTRO-1940-NS", "2", "2DOF-S", "-", "-"] in rows


RUN = ["run", *FLAGS, "el-centro-1940"]


def invoke_report(*arguments):
    return CliRunner().invoke(app, [*RUN, *map(str, arguments)], env={"COLUMNS": "200"})


def refused(words, *arguments):
    result = invoke_report(*arguments)
    assert result.exit_code == 2
    assert words in " ".join(result.stderr.split())


@pytest.mark.slow
def test_the_page_has_the_peaks_of_the_runs(tmp_path, monkeypatch):
    page = tmp_path / "new" / "run.html"
    arguments = ["--scale", "1.5", "--model", "2DOF-S,fixed", "--friction", "0.4", "--report", str(page)]
    monkeypatch.setattr(sys, "argv", ["rockflex", *RUN, *arguments])
    result = invoke_report(*arguments)
    assert result.exit_code == 0, result.output
    assert f"Written to {page}" in result.stderr
    text = page.read_text("utf-8")
    motion = rf.load_suite("el-centro-1940")[0].scaled(1.5)
    for model in ("2DOF-S", "fixed"):
        response = rf.simulate(make_frame(), motion, model)
        assert f'data-of="max_base_moment" data-value="{response.max_base_moment}"' in text
        assert f'data-of="required_friction" data-value="{response.required_friction_excluding_impacts()}"' in text
    assert "<title>5-story frame under EL-CENTRO-1940-NS × 1.5</title>" in text
    assert "Command: rockflex run --stories 5" in text
    assert "≤ 0.4" in text or "&gt; 0.4" in text


def test_a_page_that_cannot_be_written_does_not_cost_the_results(tmp_path):
    (tmp_path / "file").write_text("no folder")
    result = invoke_report("--model", "2DOF-S", "--report", tmp_path / "file" / "run.html")
    assert result.exit_code == 2
    assert "EL-CENTRO-1940-NS" in result.stdout
    assert "Cannot write to" in result.stderr


@pytest.mark.slow
def test_with_out_each_has_its_own_files(tmp_path):
    page, out = tmp_path / "run.html", tmp_path / "out"
    assert invoke_report("--report", page, "--out", out, "--figures", "0").exit_code == 0
    assert page.is_file()
    assert sorted(each.name for each in out.iterdir()) == ["results.csv", "summary.json"]


@pytest.mark.slow
def test_an_earlier_page_stays_without_force(tmp_path):
    page = tmp_path / "run.html"
    page.write_text("mine")
    refused(f"--report {page} exists. Give another name, or --force to replace it.", "--report", page)
    assert page.read_text() == "mine"
    done = invoke_report("--report", page, "--force")
    assert done.exit_code == 0
    assert f"{page}, in place of an earlier file" in done.stderr
    assert page.read_text("utf-8").startswith("<!DOCTYPE html>")


@pytest.mark.parametrize(
    ("more", "words"),
    [
        (["--scale", "1", "--scale", "2"], "but there are 1 motion at 2 scales. Name one record, such as SUITE/NAME"),
        (["fema-p695-far-field/FF-1-a"], "but there are 2 motions at 1 scale."),
        (
            ["--model", "2DOF-S,3DOF-S,4DOF-S,5DOF-S,MDOF-S,fixed,rigid"],
            "--report has room for 6 models, but there are 7. Choose the ones that matter with --model.",
        ),
    ],
)
def test_what_does_not_fit_on_a_page(more, words, tmp_path):
    refused(words, *more, "--report", tmp_path / "run.html")
    assert list(tmp_path.iterdir()) == []


def test_a_path_that_is_no_page(tmp_path):
    refused("--report must end", "--report", tmp_path / "run.txt")
    refused("is a folder. Give a file in it", "--report", tmp_path)
    refused("--force was given without --out", "--force")
    assert list(tmp_path.iterdir()) == []
