"""``rockflex run``: the ground, by flags and by file."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner

import rockflex as rf
from builders import make_frame
from rockflex.cli import app
from rockflex.models import LinearModel, _label

STRUCTURE = str(Path(rf.__file__).parents[2] / "examples" / "structure_1.toml")
PROPERTIES = make_frame().rocking()
B, MASS = PROPERTIES.half_width, PROPERTIES.m_tot
RECORD = "fema-p695-far-field/FF-2-a"
BED = ("--breadth", 3, "--subgrade-modulus", 2e8)
INERTIA = ("--base-inertia", 2e4)


def invoke(*arguments):
    return CliRunner().invoke(app, ["run", *map(str, arguments)], env={"COLUMNS": "200"})


def document(*arguments):
    result = invoke(*arguments, "--json")
    assert result.exit_code == 0, result.stderr
    return json.loads(result.stdout)


@pytest.fixture
def made(monkeypatch):
    """Return the grounds that reach a model, which is then built without them."""
    grounds = []

    def grounded(label, kept, ground, law, missing_mass):
        grounds.append(ground)
        return LinearModel(label, kept, True, law or rf.VVELSimplified(), missing_mass)

    monkeypatch.setattr(_label, "grounded", grounded)
    return grounds


@pytest.fixture
def write(tmp_path):
    def file(tail):
        path = tmp_path / "structure.toml"
        path.write_text(f"{Path(STRUCTURE).read_text('utf-8')}\n{tail}", "utf-8")
        return path

    return file


@pytest.mark.parametrize(
    ("flags", "ground", "options"),
    [
        (["--ground-friction", 0.3], lambda: rf.Ground(0.3), {"friction": 0.3}),
        (
            [*BED, *INERTIA, "--heave-damping-ratio", 0.3],
            lambda: rf.Ground(springs=rf.winkler_bed(B, 3.0, 2e8).damped(0.3, MASS), base_inertia=2e4),
            {"base_inertia": 2e4,
             "bed": {"breadth": 3.0, "subgrade_modulus": 2e8, "heave_damping_ratio": 0.3, "n": 20}},
        ),
        (
            ["--breadth", 2, "--shear-modulus", 9e7, "--poisson-ratio", 0.3, "--mat-mass", 4e4,
             "--ground-friction", "inf"],
            lambda: rf.Ground(float("inf"), rf.asce41_bed(B, 2.0, 9e7, 0.3), 4e4 * B**2 / 3.0),
            {"friction": float("inf"), "mat_mass": 4e4,
             "bed": {"breadth": 2.0, "shear_modulus": 9e7, "poisson_ratio": 0.3, "n": 20}},
        ),
    ],
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
    file = write("[ground]\nfriction = 0.3\nbase_inertia = 2e4\nbed = { breadth = 3.0, subgrade_modulus = 2e8 }")
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
    file = write("[ground]\nfriction = [0.3, 0.4]\nbase_inertia = 2e4\nsprings = { stiffness = 5e8, damping = 4e6 }")
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


def test_usual_models(made, tmp_path):
    given = ("--ground-friction", 0.3)
    models = document(STRUCTURE, RECORD, *given, "--initial-rotation", 0.001)["options"]["models"]
    assert models == ["2DOF-S", "MDOF-S"]
    block = tmp_path / "block.toml"
    block.write_text("block = { slenderness = 0.2, half_diagonal = 2.5 }\n")
    assert document(block, RECORD, *given)["options"]["models"] == ["rigid"]
    assert document(block, RECORD, "--ground-friction", "inf")["options"]["models"] == ["rigid", "rigid-C"]
    assert made


@pytest.mark.parametrize(
    ("flags", "message"),
    [
        (["--ground-friction", -0.3], "[ground]: friction must be a positive Coulomb coefficient, such as 0.4, or "
         "infinity for no sliding, but -0.3 was given. On the command line this is --ground-friction."),
        ([*BED], "[ground]: A base without rotary inertia on springs has no inertia"),
        (["--subgrade-modulus", 2e8, *INERTIA], "A bed of springs needs the breadth of the base. Give --breadth M in "
         "m."),
        (["--breadth", 3, *INERTIA], "[ground.bed]: A bed needs its stiffness. Give subgrade_modulus in N/m³;"),
        (["--breadth", 3, "--subgrade-modulus", -1, *INERTIA], "[ground.bed]: subgrade_modulus must be a positive, "
         "finite number in N/m³, but -1.0 was given. On the command line this is --subgrade-modulus."),
        ([*INERTIA], "[ground]: Ground needs friction, springs or both"),
        ([*BED, *INERTIA, "--model", "MDOF-S,fixed"], "Springs need a simplified model"),
        ([*BED, *INERTIA, "--impact", "simplified"], "No impact law acts on springs"),
    ],
)  # fmt: skip
def test_messages(made, flags, message):
    result = invoke(STRUCTURE, RECORD, *flags)
    assert result.exit_code != 0
    assert message in " ".join(result.stderr.split())


def test_a_message_about_a_file_names_it(write):
    file = write("[ground]\nfriction = -0.4")
    assert f"{file}, [ground]: friction must be" in "".join(invoke(file, RECORD).stderr.split("\n"))


def test_springs_of_the_file_exclude_a_bed_of_flags(write):
    file = write("[ground]\nbase_inertia = 2e4\nsprings = { stiffness = 5e8 }")
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


def test_tables_show_how_the_base_moves_on_its_ground():
    arguments = (STRUCTURE, RECORD, "--model", "MDOF-S", "--scale", 2)
    (soft,) = document(*arguments, *SOFT, "--ground-friction", 0.15)["runs"]
    told = invoke(*arguments, *SOFT, "--ground-friction", 0.15).stdout
    for heading in ("slip", "x_end", "edge up", "edge down"):
        assert heading in told
    printed = columns(told, -4, -3, -2, -1)
    names = ("max_slip", "residual_slip", "max_edge_uplift", "max_edge_settlement")
    assert printed == pytest.approx([1e3 * soft[name] for name in names], rel=1e-3)
    assert "slip: largest displacement of the base along the ground; x_end: where it rests" in told
    assert "edge up, down: how far an edge of the base rises above the unloaded springs" in told
    slides = invoke(*arguments, "--ground-friction", 0.15).stdout
    assert "x_end" in slides
    assert "edge up" not in slides
    usual = invoke(*arguments).stdout
    assert not {"slip", "edge up", "x_end"} & set(usual.split("\n")[3].split())
    assert "slip:" not in usual


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
