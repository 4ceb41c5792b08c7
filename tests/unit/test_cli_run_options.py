"""The options of `rockflex run`: laws, hysteresis, start, ground, friction and the work limit."""

import csv
import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner

import rockflex as rf
from builders import make_frame
from rockflex.cli import _batch
from rockflex.cli._app import app
from rockflex.foundation.schema import IMPACT
from rockflex.models import _label
from rockflex.models._rocking_model import RockingModel
from rockflex.studies import PreparedCase

STRUCTURE = str(Path(__file__).parents[2] / "examples" / "structure_1.toml")
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


def runs_of(*arguments):
    return document(*arguments)["runs"]


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


@pytest.mark.slow
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


def test_what_is_assumed_stands_above_the_table():
    flags = ("--impact", "restitution", "--restitution", 0.7, *YIELDING, "--initial-rotation", 0.01)
    lines = invoke(STRUCTURE, RECORD, *flags).stdout.splitlines()
    assert lines[1:4] == [
        "Impact: restitution, e = 0.7, 0.996 from one half cycle to the next",
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
        (["--impact", "elastic"], f"--impact must be {IMPACT.expected}, but 'elastic'"),
        (["--impact", "restitution"], 'The impact law "restitution" needs its coefficient. Give restitution, a number'),
        (["--restitution", 0.5], "A restitution of 0.5 was given, but the impact law is the model's own. Choose the"),
        (["--impact", "complete", "--restitution", 0.5], "but the impact law is 'complete'. Choose the impact law"),
        (["--impact", "restitution", "--restitution", 1.5], "must lie in [0, 1], but 1.5 was"),
        (["--bw-exponent", 4], "The hysteresis needs its yield displacement. Give --yield-displacement DY in m."),
        (["--yield-displacement", -1], "--yield-displacement must be a positive, finite number in m, but -1.0 was"),
        ([*YIELDING, "--bw-exponent", 0.5], "--bw-exponent must be at least 1, but 0.5 was given."),
        ([*YIELDING, "--model", "2DOF-S,MDOF-S"], "A hysteresis was given, but 2DOF-S, MDOF-S do not yield. Models"),
        ([*YIELDING, "--model", "MDOF-S-BW"], "bouc_wen applies to models with one mode, but MDOF-S-BW has 5. Use"),
        ([*YIELDING, "--model", "fixed-BW"], "bouc_wen applies to models with one mode, but fixed-BW has 5. Use"),
        ([*YIELDING, "--model", "3DOF-S-BW"], "A Bouc-Wen superstructure has one mode, but 2 were requested."),
        (["--model", "2DOF-S-BW"], "2DOF-S-BW needs its hysteresis. Give --yield-displacement, or [bouc_wen] in the"),
        ([*YIELDING, "--free-vibration", "settle"], 'free_vibration="settle" cannot tell when the hysteretic spring'),
        (["--initial-rotation", 0.1, "--model", "fixed"], "fixed has a base that cannot lift, but rotation=0.1"),
        (["--initial-rotation", 2], "--initial-rotation must be a number between -1.5708 and 1.5708 rad, but 2.0 was"),
        (["--model", "3DOF-C"], "3DOF-C has no impact law of its own: Eq. 19 is one equation for 2 velocities."),
        (["--friction", 0], "--friction must be a friction coefficient above zero, such as 0.5, but 0.0 was given."),
        (["--friction", "nan"], "--friction must be a friction coefficient above zero, such as 0.5, but nan was"),
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
    assert result.stderr.startswith("Error: A free vibration from --initial-rotation needs a ground motion or a")


@pytest.mark.parametrize(
    ("head", "tail", "said"),
    [
        ("", "[bouc_wen]\nyield_displacement = 0.05\ngama = 0.4", "[bouc_wen] gama is not known; there are yield_disp"),
        ("", "[bouc_wen]\nexponent = 4", "[bouc_wen] yield_displacement is missing: D_y of the first mode, a number"),
        ("", "[bouc_wen]\nyield_displacement = -0.05", ", [bouc_wen]: yield_displacement must be a positive, finite"),
        ('impact = "elastic"', "", f"impact must be {IMPACT.expected}, but 'elastic' was"),
        ("restitution = true", "", "restitution must be a number from 0 to 1, but True was given."),
        ('impact = "restitution"', "", "needs its coefficient. Give restitution, a number from 0 to 1."),
        ("bouc_wen = 0.05", "", "bouc_wen must be a table, but 0.05 was given."),
    ],
)
def test_bad_files(write, head, tail, said):
    result = invoke(write(head, tail), RECORD)
    assert result.exit_code == 2
    assert said in result.stderr


PROPERTIES = make_frame().rocking()
B, MASS = PROPERTIES.half_width, PROPERTIES.m_tot
BED = ("--breadth", 3, "--subgrade-modulus", 2e8)
INERTIA = ("--base-inertia", 2e4)


@pytest.fixture
def made(monkeypatch):
    """Return the grounds that reach a model, which is then built without them."""
    grounds = []

    def grounded(label, kept, ground, law, missing_mass, **_kind):
        grounds.append(ground)
        return RockingModel(label, kept, True, law or rf.VVELSimplified(), missing_mass)

    monkeypatch.setattr(_label, "model_on_ground", grounded)
    return grounds


@pytest.mark.parametrize(
    ("flags", "ground", "options"),
    [
        (["--ground-friction", 0.3], lambda: rf.Ground(0.3), {"friction": 0.3}),
        (
            [*BED, *INERTIA, "--heave-damping-ratio", 0.3],
            lambda: rf.Ground(springs=rf.winkler_bed(B, 3.0, 2e8).damped(0.3, MASS), base_inertia=2e4),
            {"base_inertia": 2e4,
             "bed": {"breadth": 3.0, "subgrade_modulus": 2e8, "heave_damping_ratio": 0.3, "n": 20}}
        ),
        (
            ["--breadth", 2, "--shear-modulus", 9e7, "--poisson-ratio", 0.3, "--mat-mass", 4e4,
             "--ground-friction", "inf"],
            lambda: rf.Ground(float("inf"), rf.asce41_bed(B, 2.0, 9e7, 0.3), 4e4 * B**2 / 3.0),
            {"friction": float("inf"), "mat_mass": 4e4,
             "bed": {"breadth": 2.0, "shear_modulus": 9e7, "poisson_ratio": 0.3, "n": 20}}
        )
    ]
)  # fmt: skip
def test_flags(made, flags, ground, options):
    found = document(STRUCTURE, RECORD, *flags)
    (given,) = set(made)
    assert (given.friction is None) == (ground().friction is None)
    assert given.springs == ground().springs
    assert given.base_inertia == (None if given.springs is None else pytest.approx(ground().base_inertia, rel=1e-15))
    assert found["options"]["models"] == ["2DOF-S", "MDOF-S"]
    if options.get("friction") != float("inf"):  # which JSON cannot write
        assert found["options"]["ground"] == options


def test_a_file_says_the_same_and_flags_come_first(made, write):
    file = write("", "[ground]\nfriction = 0.3\nbase_inertia = 2e4\nbed = { breadth = 3.0, subgrade_modulus = 2e8 }")
    by_file = document(file, RECORD, "--model", "2DOF-S")["options"]
    by_flags = document(STRUCTURE, RECORD, "--model", "2DOF-S", *BED, *INERTIA, "--ground-friction", 0.3)["options"]
    assert by_file == by_flags
    assert len(set(made)) == 1
    made.clear()
    flags = ("--mat-mass", 6e4, "--subgrade-modulus", 4e8, "--ground-friction", 0.5)
    document(file, RECORD, "--model", "2DOF-S", *flags)
    springs = rf.winkler_bed(B, 3.0, 4e8)
    assert set(made) == {rf.Ground(0.5, springs, 6e4 * (2.0 * B) ** 2 / 12.0)}


def test_the_ground_is_above_the_table(made, write):
    file = write(
        "", "[ground]\nfriction = [0.3, 0.4]\nbase_inertia = 2e4\nsprings = { stiffness = 5e8, damping = 4e6 }"
    )
    lines = invoke(file, RECORD).stdout.splitlines()
    springs = rf.Springs([-B, B], 5e8, 4e6)
    ratio = 4e6 / (1e9 * MASS) ** 0.5
    assert lines[1:3] == [
        f"Ground: 2 springs, Σk = 1e+09 N/m, Σk x² = {springs.rotational_stiffness:.4g} N m/rad, Σc = 8e+06 N s/m "
        f"({ratio:.3g} of critical in heave), I_b = 2e+04 kg m²",
        "Friction: μ = 0.3 to 0.4",
    ]
    assert made
    assert invoke(STRUCTURE, RECORD, "--ground-friction", 0.25).stdout.splitlines()[1] == "Friction: μ = 0.25"


def test_usual_models_on_a_ground(made, tmp_path):
    given = ("--ground-friction", 0.3)
    models = document(STRUCTURE, RECORD, *given, "--initial-rotation", 0.001)["options"]["models"]
    assert models == ["2DOF-S", "MDOF-S"]
    block = tmp_path / "block.toml"
    block.write_text("block = { slenderness = 0.2, half_diagonal = 2.5 }\n")
    assert document(block, RECORD, *given)["options"]["models"] == ["rigid", "rigid-C"]
    assert document(block, RECORD, "--ground-friction", "inf")["options"]["models"] == ["rigid", "rigid-C"]
    assert made


@pytest.mark.parametrize(
    ("flags", "message"),
    [
        (["--ground-friction", -0.3], "[ground]: friction must be a positive Coulomb coefficient, such as 0.4, or"),
        ([*BED], "[ground]: A base without rotary inertia on springs has no inertia"),
        (["--subgrade-modulus", 2e8, *INERTIA], "A bed of springs needs the breadth of the base. Give --breadth M in"),
        (["--breadth", 3, *INERTIA], "[ground.bed]: A bed needs its stiffness. Give subgrade_modulus in N/m³;"),
        (["--breadth", 3, "--subgrade-modulus", -1, *INERTIA], "[ground.bed]: subgrade_modulus must be a positive,"),
        ([*INERTIA], "[ground]: Ground needs friction, springs or both"),
        ([*BED, *INERTIA, "--model", "MDOF-S,fixed"], "Springs need a model whose base can lift"),
        ([*BED, *INERTIA, "--impact", "simplified"], "No impact law acts on springs"),
    ],
)  # fmt: skip
def test_messages(made, flags, message):
    result = invoke(STRUCTURE, RECORD, *flags)
    assert result.exit_code != 0
    assert message in " ".join(result.stderr.split())


def test_a_message_about_a_file_names_it(write):
    file = write("", "[ground]\nfriction = -0.4")
    assert f"{file}, [ground]: friction must be" in "".join(invoke(file, RECORD).stderr.split("\n"))


def test_springs_of_the_file_exclude_a_bed_of_flags(write):
    file = write("", "[ground]\nbase_inertia = 2e4\nsprings = { stiffness = 5e8 }")
    assert (
        "The ground of the structure file has springs, and the command line gives a bed (--breadth, "
        "--subgrade-modulus). Leave one of them out."
    ) in " ".join(invoke(file, RECORD, *BED).stderr.split())


SOFT = [*BED, *INERTIA, "--heave-damping-ratio", 0.2]


def columns(text, *wanted):
    """The numbers of some columns of the only row of a printed table."""
    lines = text.splitlines()
    (row,) = (line for line in lines if line.startswith("FF-2-a") and "MDOF-S" in line)
    cells = row.split()
    return [float(cells[place]) for place in wanted]


@pytest.mark.slow
def test_tables_show_how_the_base_moves_on_its_ground():
    arguments = (STRUCTURE, RECORD, "--model", "MDOF-S", "--scale", 2)
    (soft,) = document(*arguments, *SOFT, "--ground-friction", 0.15)["runs"]
    told = invoke(*arguments, *SOFT, "--ground-friction", 0.15).stdout
    printed = columns(told, *range(-6, 0))
    names = ("max_slip", "residual_slip", "max_edge_uplift", "max_edge_settlement")
    names += ("settlement", "max_permanent_settlement")
    assert printed == pytest.approx([1e3 * soft[name] for name in names], rel=1e-3)
    slides = invoke(*arguments, "--ground-friction", 0.15).stdout
    assert "x_end" in slides
    assert "edge up" not in slides
    usual = invoke(*arguments).stdout
    assert not {"x_max", "edge", "x_end"} & set(usual.split("\n")[3].split())
    assert "x_max:" not in usual


@pytest.mark.slow
def test_histories_have_the_columns_of_the_base(tmp_path):
    arguments = (STRUCTURE, RECORD, "--model", "MDOF-S", "--scale", 2, *SOFT, "--ground-friction", 0.15)
    result = invoke(*arguments, "--out", tmp_path / "out")
    assert result.exit_code == 0, result.stderr
    table = pd.read_csv(tmp_path / "out" / "history-FF-2-a.csv")
    motion = rf.load_suite("fema-p695-far-field")["FF-2-a"].scaled(2.0)
    bed = rf.winkler_bed(B, 3.0, 2e8).damped(0.2, MASS)
    run = rf.simulate(make_frame(), motion, "MDOF-S", ground=rf.Ground(0.15, bed, 2e4))
    for name in ("slip", "slip_velocity", "heave"):
        np.testing.assert_allclose(table[name], getattr(run, name), rtol=1e-12, atol=1e-15)
    edges = table[["left_edge_uplift", "right_edge_uplift"]].to_numpy()
    np.testing.assert_allclose(edges, run.edge_uplift, rtol=1e-12, atol=1e-15)
    forces = table[[f"spring_force_{k}" for k in range(1, 21)]].to_numpy()
    np.testing.assert_allclose(forces, run.spring_force, rtol=1e-12, atol=1e-6)
    assert "vertical_ground_acceleration" not in table
    units = json.loads((tmp_path / "out" / "summary.json").read_text())["units"]
    assert [units[name] for name in ("max_slip", "residual_slip", "max_edge_uplift", "max_edge_settlement")] == [
        "m"
    ] * 4


@pytest.mark.slow
def test_the_vertical_component_is_named(tmp_path):
    rows = "".join(f"{0.01 * i:.2f},{3 * np.sin(0.05 * i):.5f}\n" for i in range(400))
    for name, text in (("along.csv", f"time (s),acc (m/s2)\n{rows}"), ("up.csv", f"time (s),vertical (m/s2)\n{rows}")):
        (tmp_path / name).write_text(text)
    arguments = (STRUCTURE, tmp_path / "along.csv", "--vertical", tmp_path / "up.csv", "--model", "MDOF-S")
    result = invoke(*arguments, "--out", tmp_path / "out")
    assert result.exit_code == 0, result.stderr
    assert "\nVertical: up with along, PVA = 3 m/s²\n" in result.stdout
    table = pd.read_csv(tmp_path / "out" / "history-along.csv")
    assert table["vertical_ground_acceleration"].max() == pytest.approx(3.0, rel=1e-3)
    assert "Vertical" not in invoke(STRUCTURE, tmp_path / "along.csv", "--model", "MDOF-S").stdout
    both = (tmp_path / "both.csv", "time (s),acc (m/s2),vertical (m/s2)\n0,0,0\n0.01,1,.5\n0.02,0,0\n")
    both[0].write_text(both[1])
    assert "\nVertical: of both, PVA = 0.5 m/s²\n" in invoke(STRUCTURE, both[0], "--model", "MDOF-S").stdout


EL_CENTRO = rf.load_suite("el-centro-1940")[0]
NAMES = ["required_friction", "required_friction_excluding_impacts", "sliding_time"]


@pytest.mark.slow
def test_document_has_what_the_library_finds():
    models = "2DOF-C,MDOF-S,rigid,fixed"
    rows = runs_of(STRUCTURE, "el-centro-1940", "--model", models, "--friction", 0.2, "--scale", 1, "--scale", 1.5)
    for row in rows:
        run = rf.simulate(FRAME, EL_CENTRO.scaled(row["scale"]), row["model"])
        assert row["required_friction"] == run.required_friction
        assert row["required_friction_excluding_impacts"] == run.required_friction_excluding_impacts()
        assert row["sliding_time"] == run.sliding_time(0.2)
    assert {row["sliding_time"] is None for row in rows} == {True, False}


def test_without_the_option_nothing_is_said():
    row = runs_of(STRUCTURE, "el-centro-1940", "--model", "2DOF-S")[0]
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
    row = runs_of(STRUCTURE, "el-centro-1940", *flags)[0]
    assert row["required_friction"] == "inf"
    assert row["sliding_time"] == pytest.approx(2.15035, abs=1e-4)
    assert "inf" in invoke(STRUCTURE, "el-centro-1940", *flags).stdout


@pytest.mark.slow
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


@pytest.mark.slow
def test_histories_have_no_friction_unless_asked(tmp_path):
    invoke(STRUCTURE, "el-centro-1940", "--model", "2DOF-S", "--out", tmp_path / "out")
    head = (tmp_path / "out" / "history-EL-CENTRO-1940-NS.csv").read_text("utf-8").splitlines()[0].split(",")
    assert not {"yielding", "friction_demand"} & set(head)
    assert {"total_top_displacement", "horizontal_reaction", "vertical_reaction"} <= set(head)


@pytest.mark.slow
def test_many_runs(monkeypatch):
    arguments = (STRUCTURE, "el-centro-1940", "--scale", 0.5, "--scale", 1.5, "--model", "2DOF-S,rigid,fixed")
    few = runs_of(*arguments, "--friction", 0.4)
    monkeypatch.setattr(_batch, "MAX_TIMED_RUNS", 5)
    many = runs_of(*arguments, "--friction", 0.4)
    assert len(many) == 6
    assert {row.pop("run_time") for row in many} == {None}
    assert all(row.pop("run_time") > 0.0 for row in few)
    assert many == few


@pytest.mark.slow
def test_a_run_that_cannot_be_solved(monkeypatch):
    solved = PreparedCase.run

    def flaky(case, motion, scale=1.0):
        if case.model.label == "MDOF-S":
            message = "The motion is not finite at 1 s."
            raise rf.SolverError(message)
        return solved(case, motion, scale)

    monkeypatch.setattr(PreparedCase, "run", flaky)
    arguments = (STRUCTURE, "el-centro-1940", "--friction", 0.4)
    assert [runs_of(*arguments)[1][name] for name in NAMES] == [None, None, None]
    last = [line.split() for line in invoke(*arguments).stdout.splitlines() if "MDOF-S" in line][-1]
    assert last[2:] == ["-", "-", "-"]


STRUCTURE_LIMIT = """
[frame]
n_stories = 5
story_height = 3.0
story_mass = 40e3
base_mass = 40e3
stiffness_ratio = inf
period = {period}
aspect_ratio = 10.0
damping_ratio = 0.02
"""
STUDY = 'study = "{kind}"\nmodels = ["MDOF-S"]\n{head}[records]\nsuites = ["el-centro-1940"]\n[[structures]]\n'


def rockflex(*arguments):
    return CliRunner().invoke(app, [*map(str, arguments)], env={"COLUMNS": "220"})


def structure_file(folder, period=1.0):
    file = folder / "structure.toml"
    file.write_text(STRUCTURE_LIMIT.format(period=period))
    return file


def test_a_run_that_takes_too_long_is_refused(tmp_path) -> None:
    result = invoke(structure_file(tmp_path, 1e-6), "el-centro-1940", "--model", "MDOF-S")
    assert result.exit_code == 2
    assert "MDOF-S would take about" in result.stderr
    assert 'work_limit=None ("none" in a file and on the command line).' in result.stderr


def test_beside_others_it_is_a_run_that_could_not_be_solved(tmp_path) -> None:
    file = structure_file(tmp_path)
    result = invoke(file, "el-centro-1940", "--model", "MDOF-S,MDOF-C", "--work-limit", "0.0022", "--json")
    errors = {run["model"]: run["error"] for run in json.loads(result.stdout)["runs"]}
    assert errors["MDOF-S"] is None
    assert "MDOF-C would take about 0.0" in errors["MDOF-C"]


def test_in_batches_too(tmp_path, monkeypatch) -> None:
    monkeypatch.setattr(_batch, "MAX_TIMED_RUNS", 1)
    options = ["--model", "MDOF-S,2DOF-S-BW", "--yield-displacement", "0.01", "--work-limit", "0.001", "--json"]
    result = invoke(structure_file(tmp_path), "el-centro-1940", *options)
    errors = {run["model"]: run["error"] for run in json.loads(result.stdout)["runs"]}
    assert errors["MDOF-S"] is None
    assert "2DOF-S-BW would take about 0.0" in errors["2DOF-S-BW"]


def test_none_lifts_the_limit(tmp_path, monkeypatch) -> None:
    found = []
    perform = _batch.run_batch
    monkeypatch.setattr(_batch, "run_batch", lambda plan: (found.append(plan.options.work_limit), perform(plan))[1])
    file = structure_file(tmp_path)
    for given in ([], ["--work-limit", "7"], ["--work-limit", "none"]):
        assert invoke(file, "el-centro-1940", "--model", "fixed", *given).exit_code == 0
    assert found == [30.0, 7.0, None]


@pytest.mark.parametrize(("given", "shown"), [("0", "0.0"), ("-3", "-3.0"), ("soon", "'soon'"), ("nan", "nan")])
def test_a_limit_that_is_none_is_refused(tmp_path, given, shown) -> None:
    result = invoke(structure_file(tmp_path), "el-centro-1940", "--work-limit", given)
    assert result.exit_code == 2
    assert "--work-limit must be a positive number of seconds of computing for one run" in result.stderr
    assert f"but {shown} was given." in result.stderr


@pytest.mark.parametrize(
    ("command", "kind", "head"), [("cloud", "cloud", ""), ("ida", "incremental", "largest_scale = 0.2\ngrowth = 2.0\n")]
)
def test_a_study_that_takes_too_long_is_refused_and_the_limit_goes_before_the_file(
    tmp_path, command, kind, head
) -> None:
    file = tmp_path / "study.toml"
    usual = STRUCTURE_LIMIT.replace("[frame]", "[structures.frame]")
    file.write_text(STUDY.format(kind=kind, head=head) + usual.format(period=1e-6))
    for more in ([], ["--dry-run"]):
        result = rockflex(command, file, *more)
        assert result.exit_code == 2
        assert "MDOF-S would take about" in result.stderr
    file.write_text(STUDY.format(kind=kind, head="work_limit = 1e-6\n" + head) + usual.format(period=1.0))
    assert "work_limit is 1e-06 s" in rockflex(command, file).stderr
    assert rockflex(command, file, "--work-limit", "none", "--dry-run").exit_code == 0
