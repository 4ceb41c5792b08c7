"""``rockflex modes``: modes and rocking parameters."""

import csv
import json
import math
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import rockflex as rf
from rockflex.cli import app

EXAMPLES = Path(rf.__file__).parents[2] / "examples"
STRUCTURE = str(EXAMPLES / "structure_1.toml")


def invoke(*arguments, columns=80):
    return CliRunner().invoke(app, ["modes", *map(str, arguments)], env={"COLUMNS": str(columns)})


def test_table_1_of_the_paper():
    result = invoke(STRUCTURE, "--json")
    found = json.loads(result.stdout)
    first, rocking = found["modes"][0], found["rocking"]
    assert [round(row["mass_share"], 3) for row in found["modes"]] == [0.880, 0.087, 0.024, 0.008, 0.002]
    assert [round(row["effective_height"] / 15.0, 2) for row in found["modes"]] == [0.70, -0.24, 0.15, -0.12, 0.10]
    assert first["period"] == pytest.approx(1.0, rel=1e-12)
    assert round(rocking["i_theta"] / (first["effective_mass"] * first["effective_height"] ** 2), 2) == 1.03
    assert round(first["effective_mass"] * first["effective_height"] / rocking["l0r"], 2) == 1.03
    # By hand: L_0^r = Σ m_i h_i, M_r = m_tot g B.
    assert rocking["l0r"] == pytest.approx(40e3 * 3.0 * 15)
    assert rocking["resisting_moment"] == pytest.approx(6 * 40e3 * 9.81 * first["effective_height"] / 10.0)


def test_printed_table():
    result = invoke(STRUCTURE)
    assert result.exit_code == 0
    rows = [line.split() for line in result.stdout.splitlines()]
    assert ["1", "1.0000", "6.283", "0.8795", "10.54", "1.252", "0.02000"] in rows
    assert ["5", "0.1483", "42.36", "0.001568", "1.563", "0.01504", "0.02000"] in rows
    assert ["Sum", "of", "m*_n/Σm", "1.000"] in rows
    assert ["Moment", "of", "inertia", "about", "a", "pivot,", "I_θ", "2.007e+07", "kg", "m²"] in rows
    assert ["Resisting", "moment,", "M_r", "=", "m_tot", "g", "B", "2482", "kN", "m"] in rows
    assert max(map(len, result.stdout.splitlines())) <= 80


@pytest.mark.parametrize("name", ["structure_1", "structure_lumped", "structure_properties"])
def test_examples(name):
    found = json.loads(invoke(EXAMPLES / f"{name}.toml", "--json").stdout)
    assert found["structure"]["kind"] in ("frame", "lumped", "properties")
    for row in found["modes"]:
        assert row["period"] * row["omega"] == pytest.approx(2.0 * math.pi, rel=1e-14)


def test_properties_by_hand_are_shares_of_all_mass():
    result = invoke(EXAMPLES / "structure_properties.toml")
    assert "m*_n/m_tot" in result.stdout
    assert "0.5113" in result.stdout  # m*_1/m_tot = 0.51 in Section 4.1.1
    assert "MN m" in result.stdout


def test_first_modes_alone():
    found = json.loads(invoke(STRUCTURE, "--modes", 2, "--json").stdout)
    full = json.loads(invoke(STRUCTURE, "--json").stdout)
    assert found["modes"] == full["modes"][:2]
    assert found["rocking"] == full["rocking"]


def test_folder(tmp_path):
    result = invoke(STRUCTURE, "--modes", 3, "--out", tmp_path / "out")
    assert result.stderr == f"Written to {tmp_path / 'out'}\n"
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == ["mode-shapes.png", "modes.csv", "summary.json"]
    with (tmp_path / "out" / "modes.csv").open(newline="") as file:
        omega = [float(row["omega"]) for row in csv.DictReader(file)]
    frame = rf.Frame(5, 3.0, 40e3, 40e3, np.inf, 1.0, 10.0, 0.02)
    np.testing.assert_array_equal(omega, frame.rocking(3).omega)
    assert (tmp_path / "out" / "mode-shapes.png").read_bytes().startswith(b"\x89PNG")


def test_no_figure_without_shapes(tmp_path):
    result = invoke(EXAMPLES / "structure_properties.toml", "--out", tmp_path / "out")
    assert "no figure, as [properties] hold no mode shapes" in result.stderr
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["modes.csv", "summary.json"]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["frame"], "frame is no structure file: a name that ends in .toml is expected."),
        ([STRUCTURE, "--modes", 7], "n_modes must be a whole number from 1 to 5, but 7 was given."),
        ([STRUCTURE, "--structure", STRUCTURE], "Two structures were given"),
        (["--stories", 5], "The frame lacks --story-height, --story-mass"),
        ([STRUCTURE, "--force"], "--force says what --out may replace, but no --out was given."),
    ],
)
def test_bad_input(arguments, said):
    result = invoke(*arguments, "--json")
    assert result.exit_code == 2
    assert result.stdout == ""
    assert said in result.stderr
