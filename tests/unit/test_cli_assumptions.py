"""``rockflex run``: complete, rigid and yielding models, impact laws and free vibration, by flags and by file."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

import rockflex as rf
from builders import make_frame
from rockflex.cli import _batch, app

STRUCTURE = str(Path(rf.__file__).parents[2] / "examples" / "structure_1.toml")
FRAME = make_frame()
RECORD = "fema-p695-far-field/FF-2-a"
MOTION = rf.load_suite("fema-p695-far-field")["FF-2-a"]
YIELDING = ("--yield-displacement", 0.05)


def invoke(*arguments):
    return CliRunner().invoke(app, ["run", *map(str, arguments)], env={"COLUMNS": "200"})


def document(*arguments):
    result = invoke(*arguments, "--json")
    assert result.exit_code == 0, result.stderr
    return json.loads(result.stdout)


def assert_is_run(row, model, motion=MOTION, **options):
    expected = rf.simulate(FRAME, motion, model, output="peaks", **options).peaks()
    assert {name: row[name] for name in expected} == expected


@pytest.fixture
def write(tmp_path):
    def file(head="", tail=""):
        path = tmp_path / "structure.toml"
        path.write_text(head + "\n" + Path(STRUCTURE).read_text("utf-8") + "\n" + tail, "utf-8")
        return path

    return file


def test_labels_of_every_kind():
    labels = ["2DOF-C", "2DOF-C-SI", "MDOF-C", "3DOF-C-E", "MDOF-C-SI", "rigid", "rigid-C", "5DOF-fixed"]
    rows = document(STRUCTURE, RECORD, "--model", ",".join(labels))["runs"]
    for row, label in zip(rows, labels, strict=True):
        assert_is_run(row, label)


@pytest.mark.parametrize(
    ("flags", "law", "described"),
    [
        (["simplified"], rf.VVELSimplified(), {"law": "simplified"}),
        (["complete"], rf.VVELComplete(), {"law": "complete"}),
        (
            ["restitution", "--restitution", 0.7],
            rf.Restitution(0.7),
            {"law": "restitution", "e": 0.7, "shortest_excursion": 1e-4},
        ),
    ],
)
def test_impact_laws(flags, law, described):
    found = document(STRUCTURE, RECORD, "--model", "2DOF-S,2DOF-C,rigid", "--impact", *flags)
    for row in found["runs"]:
        assert_is_run(row, row["model"], impact=law)
    assert found["options"]["impact"] == described


def test_models_that_end_in_bw_yield_and_the_others_do_not():
    labels = "2DOF-S,2DOF-S-BW,2DOF-C-BW,1DOF-fixed-BW,MDOF-S"
    found = document(STRUCTURE, RECORD, "--model", labels, *YIELDING, "--post-yield-ratio", 0.1, "--bw-exponent", 4)
    bouc_wen = rf.BoucWen(0.05, post_yield_ratio=0.1, exponent=4.0)
    assert [row["model"] for row in found["runs"]] == labels.split(",")
    for row in found["runs"]:
        assert_is_run(row, row["model"], bouc_wen=bouc_wen if row["model"].endswith("-BW") else None)
    expected = {"yield_displacement": 0.05, "post_yield_ratio": 0.1, "gamma": 0.5, "beta": 0.5, "exponent": 4.0}
    assert found["options"]["bouc_wen"] == expected


def test_shape_of_the_hysteresis():
    row = document(STRUCTURE, RECORD, *YIELDING, "--bw-gamma", 0.7, "--bw-beta", 0.3, "--model", "2DOF-S-BW")["runs"][0]
    assert_is_run(row, "2DOF-S-BW", bouc_wen=rf.BoucWen(0.05, gamma=0.7, beta=0.3))


@pytest.mark.parametrize(
    ("flags", "expected"),
    [
        ([], ["2DOF-S", "MDOF-S", "fixed"]),
        (YIELDING, ["2DOF-S", "2DOF-S-BW", "1DOF-fixed-BW"]),
        (["--initial-rotation", 0.01], ["2DOF-S", "MDOF-S"]),
        ([*YIELDING, "--initial-rotation", 0.01], ["2DOF-S", "2DOF-S-BW"]),
    ],
)
def test_usual_models(flags, expected):
    assert document(STRUCTURE, RECORD, *flags)["options"]["models"] == expected


def test_free_vibration_with_and_without_a_record():
    start = rf.InitialState(rotation=0.02)
    with_record = document(STRUCTURE, RECORD, "--model", "2DOF-C", "--initial-rotation", 0.02)
    assert_is_run(with_record["runs"][0], "2DOF-C", initial=start)
    assert with_record["options"]["initial_rotation"] == 0.02
    alone = document(STRUCTURE, "--model", "2DOF-C", "--initial-rotation", 0.02, "--free-vibration", 3)
    assert_is_run(alone["runs"][0], "2DOF-C", rf.quiet_motion(3.0), initial=start)
    assert alone["motions"][0]["origin"] == "at rest"
    settled = document(STRUCTURE, "--model", "2DOF-S", "--initial-rotation", 0.02, "--free-vibration", "settle")
    assert_is_run(settled["runs"][0], "2DOF-S", rf.quiet_motion(0.01), initial=start, free_vibration="settle")
    assert settled["runs"][0]["settled"] is True


def test_many_runs_of_elastic_and_yielding_models_in_batches(monkeypatch):
    flags = ("--model", "2DOF-S-BW,2DOF-S,1DOF-fixed-BW", *YIELDING, "--scale", 1, "--scale", 0.5)
    arguments = (STRUCTURE, "fema-p695-near-field-pulse", *flags, "--impact", "complete")
    many = document(*arguments)["runs"]
    monkeypatch.setattr(_batch, "MAX_TIMED_RUNS", 10**6)
    few = document(*arguments)["runs"]
    for rows in (many, few):
        for row in rows:
            del row["run_time"]
    assert len(many) == 168
    assert many == few


def test_what_is_assumed_stands_above_the_table():
    flags = ("--impact", "restitution", "--restitution", 0.7, *YIELDING, "--initial-rotation", 0.01)
    lines = invoke(STRUCTURE, RECORD, *flags).stdout.splitlines()
    assert lines[1:4] == [
        "Impact: restitution, e = 0.7",
        "Hysteresis of -BW: D_y = 0.05 m, α = 0.01, γ = 0.5, β = 0.5, n = 8",
        "At rest at θ = 0.01 rad at t = 0",
    ]
    assert invoke(STRUCTURE, RECORD, "--impact", "complete").stdout.splitlines()[1] == "Impact: complete"
    assert invoke(STRUCTURE, RECORD, "--impact", "simplified").stdout.splitlines()[1] == "Impact: simplified"


def test_a_file_says_the_same_as_flags(write):
    file = write('impact = "restitution"\nrestitution = 0.7', "[bouc_wen]\nyield_displacement = 0.05\nexponent = 4")
    flags = ("--impact", "restitution", "--restitution", 0.7, *YIELDING, "--bw-exponent", 4)
    by_file, by_flags = document(file, RECORD), document(STRUCTURE, RECORD, *flags)
    for found in (by_file, by_flags):
        for row in found["runs"]:
            del row["run_time"]
    assert by_file["runs"] == by_flags["runs"]
    assert by_file["options"] == by_flags["options"]
    assert by_file["structure"]["bouc_wen"] == {"yield_displacement": 0.05, "exponent": 4.0}
    assert by_file["structure"]["impact"] == "restitution"


def test_flags_come_before_the_file(write):
    file = write('impact = "restitution"\nrestitution = 0.7', "[bouc_wen]\nyield_displacement = 0.05\nexponent = 4")
    found = document(file, RECORD, "--impact", "simplified", "--yield-displacement", 0.04)["options"]
    assert found["impact"] == {"law": "simplified"}
    assert (found["bouc_wen"]["yield_displacement"], found["bouc_wen"]["exponent"]) == (0.04, 4.0)
    found = document(file, RECORD, "--restitution", 0.3)["options"]
    assert (found["impact"]["law"], found["impact"]["e"]) == ("restitution", 0.3)


def test_a_hysteresis_in_the_file_that_no_model_asks_for_is_told(write):
    file = write(tail="[bouc_wen]\nyield_displacement = 0.05")
    result = invoke(file, RECORD, "--model", "MDOF-S")
    assert result.exit_code == 0
    assert result.stderr == (f"[bouc_wen] of {file} is for models that end in -BW, such as 2DOF-S-BW; none was given\n")


@pytest.mark.parametrize(
    ("flags", "said"),
    [
        (
            ["--impact", "elastic"],
            '--impact must be "simplified", "complete" or "restitution", but \'elastic\' was given.',
        ),
        (
            ["--impact", "restitution"],
            'The impact law "restitution" needs its coefficient. Give restitution, a number from 0 to 1. On the '
            "command line this is --restitution.",
        ),
        (
            ["--restitution", 0.5],
            "A restitution of 0.5 was given, but the impact law is the model's own. Choose the impact law",
        ),
        (["--impact", "complete", "--restitution", 0.5], "but the impact law is 'complete'. Choose the impact law"),
        (
            ["--impact", "restitution", "--restitution", 1.5],
            "The restitution e must lie from 0 to 1, but 1.5 was given",
        ),
        (["--bw-exponent", 4], "The hysteresis needs its yield displacement. Give --yield-displacement DY in m."),
        (
            ["--yield-displacement", -1],
            "--yield-displacement must be a positive, finite number in m, but -1.0 was given",
        ),
        ([*YIELDING, "--bw-exponent", 0.5], "--bw-exponent must be at least 1, but 0.5 was given."),
        (
            [*YIELDING, "--model", "2DOF-S,MDOF-S"],
            "A hysteresis was given, but 2DOF-S, MDOF-S do not yield. Models whose label ends in -BW do, such as "
            "2DOF-S-BW, 2DOF-C-BW or 1DOF-fixed-BW: add one, or leave --yield-displacement out.",
        ),
        (
            [*YIELDING, "--model", "MDOF-S-BW"],
            "bouc_wen applies to models with one mode, but MDOF-S-BW has 5. Use 2DOF-S-BW, or leave it out.",
        ),
        (
            [*YIELDING, "--model", "fixed-BW"],
            "bouc_wen applies to models with one mode, but fixed-BW has 5. Use 1DOF-fixed-BW, or leave it out.",
        ),
        ([*YIELDING, "--model", "3DOF-S-BW"], "A Bouc-Wen superstructure has one mode, but 2 were requested."),
        (
            ["--model", "2DOF-S-BW"],
            "2DOF-S-BW needs its hysteresis. Give --yield-displacement, or [bouc_wen] in the structure file.",
        ),
        (
            [*YIELDING, "--free-vibration", "settle"],
            'free_vibration="settle" cannot tell when the hysteretic spring of 2DOF-S-BW is at rest. Give the free '
            "vibration in seconds. On the command line this is --free-vibration.",
        ),
        (["--initial-rotation", 0.1, "--model", "fixed"], "fixed has a base that cannot lift, but rotation=0.1"),
        (
            ["--initial-rotation", 2],
            "--initial-rotation must be a number between -1.5708 and 1.5708 rad, but 2.0 was given.",
        ),
        (["--model", "3DOF-C"], "3DOF-C has no impact law of its own: Eq. 19 is one equation for 2 velocities."),
        (["--friction", 0], "--friction must be a friction coefficient above zero, such as 0.5, but 0.0 was given."),
        (
            ["--friction", "nan"],
            "--friction must be a friction coefficient above zero, such as 0.5, but nan was given.",
        ),
    ],
)
def test_bad_input(flags, said):
    result = invoke(STRUCTURE, RECORD, *flags)
    assert result.exit_code == 2
    assert result.stdout == ""
    assert result.stderr.startswith("Error: ")
    assert said in result.stderr


def test_free_vibration_of_no_length():
    result = invoke(STRUCTURE, "--initial-rotation", 0.1)
    assert result.exit_code == 2
    assert result.stderr == (
        "Error: A free vibration from --initial-rotation needs a ground motion or a length. Give --free-vibration in "
        "seconds, or settle.\n"
    )


@pytest.mark.parametrize(
    ("head", "tail", "said"),
    [
        ("", "[bouc_wen]\nyield_displacement = 0.05\ngama = 0.4", "[bouc_wen] gama is not known; there are yield_disp"),
        (
            "",
            "[bouc_wen]\nexponent = 4",
            "[bouc_wen] yield_displacement is missing: D_y of the first mode, a number in m.",
        ),
        ("", "[bouc_wen]\nyield_displacement = -0.05", ", [bouc_wen]: yield_displacement must be a positive, finite"),
        (
            'impact = "elastic"',
            "",
            'impact must be "simplified", "complete" or "restitution", but \'elastic\' was given',
        ),
        ("restitution = true", "", "restitution must be a number from 0 to 1, but True was given."),
        ('impact = "restitution"', "", "needs its coefficient. Give restitution, a number from 0 to 1."),
        ("bouc_wen = 0.05", "", "bouc_wen must be a table, but 0.05 was given."),
    ],
)
def test_bad_files(write, head, tail, said):
    result = invoke(write(head, tail), RECORD)
    assert result.exit_code == 2
    assert said in result.stderr
