"""``rockflex modes``: modes and rocking parameters."""

import csv
import json
import math
import re
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import rockflex as rf
from builders import make_frame
from rockflex.cli._app import app

EXAMPLES = Path(__file__).parents[2] / "examples"
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
    assert rocking["uplift_acceleration"] == rocking["resisting_moment"] / rocking["l0r"]
    assert (found["units"]["uplift_acceleration"], found["warnings"]) == ("m/s²", [])
    assert rocking["l0r"] == pytest.approx(40e3 * 3.0 * 15)
    assert rocking["resisting_moment"] == pytest.approx(6 * 40e3 * 9.81 * first["effective_height"] / 10.0)


def test_printed_table():
    result = invoke(STRUCTURE)
    assert result.exit_code == 0
    rows = [line.split() for line in result.stdout.splitlines()]
    assert ["1", "1.000", "6.283", "0.8795", "10.54", "1.252", "0.02000"] in rows
    assert ["5", "0.1483", "42.36", "0.001568", "1.563", "0.01504", "0.02000"] in rows
    assert ["Sum", "of", "m*_n/Σm", "1.000"] in rows
    assert ["Moment", "of", "inertia", "about", "a", "pivot,", "I_θ", "2.007e+07", "kg", "m²"] in rows
    assert ["Resisting", "moment,", "M_r", "=", "m_tot", "g", "B", "2482", "kN", "m"] in rows
    # By hand: 2482 kN m over 1800 t m.
    assert ["Static", "uplift", "at", "a_lift", "=", "M_r/L_0^r", "1.379", "m/s²"] in rows
    assert max(map(len, result.stdout.splitlines())) <= 80


@pytest.mark.parametrize("n_modes", [1, 5])
def test_uplifted_modes_and_their_damping(n_modes):
    found = json.loads(invoke(STRUCTURE, "--modes", n_modes, "--json").stdout)["uplifted"]
    expected = rf.uplifted_modes(rf.read_structure(STRUCTURE).rocking(n_modes))
    assert [row["mode"] for row in found] == list(range(1, n_modes + 1))
    assert [row["omega"] for row in found] == expected.omega.tolist()
    assert [row["ratio"] for row in found] == expected.ratio.tolist()
    assert [row["zeta"] for row in found] == expected.damping_ratio.tolist()
    assert [row["period"] * row["omega"] for row in found] == pytest.approx([2.0 * math.pi] * n_modes, rel=1e-14)


def test_damping_while_uplifted_is_printed():
    rows = [line.split() for line in invoke(STRUCTURE, "--modes", 1).stdout.splitlines()]
    assert ["1", "0.1635", "38.43", "6.116", "0.1250"] in rows
    rows = [line.split() for line in invoke(STRUCTURE).stdout.splitlines()]
    assert ["1", "0.3592", "17.49", "2.784", "0.02331"] in rows
    assert ["5", "0.1087", "57.80", "1.364", "0.1655"] in rows


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("bridge_pier", "cantilever"),
        ("chimney", "tapered_tower"),
        ("restrained_pier", "cantilever"),
        ("structure_1", "frame"),
        ("structure_lumped", "lumped"),
        ("structure_properties", "properties"),
        ("wall", "wall_frame"),
    ],
)
def test_examples(name, kind):
    found = json.loads(invoke(EXAMPLES / f"{name}.toml", "--json").stdout)
    assert found["structure"]["kind"] == kind
    for row in found["modes"]:
        assert row["period"] * row["omega"] == pytest.approx(2.0 * math.pi, rel=1e-14)


def test_properties_by_hand_are_shares_of_all_mass():
    result = invoke(EXAMPLES / "structure_properties.toml")
    assert "m*_n/m_tot" in result.stdout
    assert "0.5113" in result.stdout  # m*_1/m_tot = 0.51 in Section 4.1.1
    assert "MN m" in result.stdout


def test_tendons_are_printed():
    rows = [line.split() for line in invoke(EXAMPLES / "restrained_pier.toml").stdout.splitlines()]
    assert ["Initial", "force", "of", "the", "tendons,", "P", "3600", "kN"] in rows
    # By hand: Σ k (B - x)².
    stiffness = 25.0 * 1.5**2 + 10.0 * (2.1**2 + 0.9**2)
    assert ["Their", "stiffness", "while", "rocking", f"{stiffness:.1f}", "MN", "m/rad"] in rows
    assert ["Resisting", "moment,", "M_r", "=", "(m_tot", "g", "+", "P)", "B", "16.29", "MN", "m"] in rows


@pytest.fixture
def block(tmp_path):
    path = tmp_path / "block.toml"
    path.write_text("[block]\nslenderness = 0.2\nhalf_diagonal = 3.0\nmass = 1e6\n", "utf-8")
    return path


def test_rigid_block_has_no_modes(block, tmp_path):
    result = invoke(block, "--out", tmp_path / "out")
    assert result.exit_code == 0
    assert "ω_n" not in result.stdout
    assert "Sum of" not in result.stdout
    # By hand: 0.7 atan(B/h) is 0.7 of the slenderness.
    assert "Nominal limit, 0.7 atan(B m_tot/L_0^r)     0.1400" in result.stdout
    assert "no figure, because [block] has no mode shapes" in result.stderr
    assert json.loads(invoke(block, "--json").stdout)["modes"] == []


ECCENTRIC = """eccentricity = -0.15
[frame]
n_stories = 3
story_height = 3.0
story_mass = 40e3
base_mass = 40e3
stiffness_ratio = 0.1
period = 0.5
aspect_ratio = 6.0
damping_ratio = 0.02
"""


def test_both_edges_of_an_eccentric_base(tmp_path):
    path = tmp_path / "moved.toml"
    path.write_text(ECCENTRIC, "utf-8")
    found = json.loads(invoke(path, "--json").stdout)
    p = rf.read_structure(path).rocking()
    for side, name in ((1, "right"), (-1, "left")):
        expected = rf.uplifted_modes(p, side=side)
        rows = [row for row in found["uplifted"] if row["side"] == name]
        assert [row["omega"] for row in rows] == expected.omega.tolist()
        assert [row["mode"] for row in rows] == [1, 2, 3]
    pivots = found["rocking"]["pivots"]
    assert [each["i_theta"] for each in pivots] == [p.pivot(1).i_theta, p.pivot(-1).i_theta]
    assert found["rocking"]["eccentricity"] == -0.15
    numbers = {name for name, value in pivots[0].items() if isinstance(value, float)}
    assert numbers <= found["units"].keys()
    # By hand: 160 t on a base whose right edge is the further one.
    assert pivots[0]["resisting_moment"] == pytest.approx(160e3 * 9.81 * (p.half_width + 0.15))
    result = invoke(path)
    rows = [line.split() for line in result.stdout.splitlines()]
    assert ["Masses", "to", "the", "right", "of", "its", "middle,", "e", "-0.1500", "m"] in rows
    assert ["About", "the", "edge", "right", "left"] in rows
    moments = [f"{p.pivot(side).resisting_moment / 1e3:.4g}" for side in (1, -1)]
    assert ["Resisting", "moment,", "M_r", *moments, "kN", "m"] in rows
    assert "While uplifted about the left edge, with these modes" in result.stdout
    assert max(map(len, result.stdout.splitlines())) <= 80


def test_tendons_to_one_side_make_two_edges(tmp_path):
    path = tmp_path / "held.toml"
    tendon = "[[elements]]\nkind = 'tendon'\nposition = 0.4\ninitial_force = 2e5\nstiffness = 3e6\n"
    path.write_text(ECCENTRIC.replace("eccentricity = -0.15\n", "") + tendon, "utf-8")
    result = invoke(path)
    rows = [line.split() for line in result.stdout.splitlines()]
    p = rf.read_structure(path).rocking()
    stiffness = [f"{p.pivot(side).tendon_stiffness / 1e3:.4g}" for side in (1, -1)]
    assert ["Stiffness", "of", "the", "tendons", *stiffness, "kN", "m/rad"] in rows
    assert "Masses to the right" not in result.stdout
    by_flags = ("--stories", 3, "--story-height", 3, "--story-mass", 40e3, "--base-mass", 40e3, "--stiffness-ratio",
                0.1, "--period", 0.5, "--aspect-ratio", 6, "--damping-ratio", 0.02)  # fmt: skip
    moved = json.loads(invoke(*by_flags, "--eccentricity", 0.1, "--json").stdout)
    assert moved["structure"]["eccentricity"] == 0.1
    assert [each["side"] for each in moved["rocking"]["pivots"]] == [1, -1]


def test_adequacy_is_printed():
    result = invoke(STRUCTURE, "--adequacy")
    rows = [line.split() for line in result.stdout.splitlines()]
    assert ["1", "1.03", "4.29", "0.880", "12.0", "120", "-"] in rows
    assert ["2", "-0.0350", "0.792", "0.0872", "3.33", "0.0280", "87.8"] in rows
    assert max(map(len, result.stdout.splitlines())) <= 80
    flat = " ".join(result.stdout.split())
    assert "Use 4DOF-S: with 2 modes, the second uplifted frequency is 87.8 % too high (allowed: 25 %); with 3," in flat
    assert "Number of modes needed" not in invoke(STRUCTURE).stdout


def test_adequacy_of_the_chimney():
    found = json.loads(invoke(EXAMPLES / "chimney.toml", "--adequacy", "--modes", 1, "--json").stdout)
    need, expected = found["adequacy"], rf.adequacy(rf.read_structure(EXAMPLES / "chimney.toml").rocking(), base_mass=0)
    assert need["model"] == "3DOF-S"
    assert need["model_for_shear"] is None
    assert need["reason"] == expected.reason
    assert need["tolerance"] == {
        "base_moment": 0.12,
        "first_frequency": 0.17,
        "second_frequency": 0.25,
        "base_shear": 0.1,
    }
    assert len(found["modes"]) == 1
    assert [row["modes"] for row in need["rows"]] == [1, 2, 3, 4, 5]
    assert [row["base_moment"] for row in need["rows"]] == expected.base_moment.tolist()
    assert need["rows"][0]["frequency_error"] == [expected.frequency_error[0, 0], None]
    assert "adequacy" not in json.loads(invoke(STRUCTURE, "--json").stdout)


def test_adequacy_of_properties_is_of_all_mass():
    need = json.loads(invoke(EXAMPLES / "structure_properties.toml", "--adequacy", "--json").stdout)["adequacy"]
    assert need["base_known"] is False
    assert need["mass"] == 1.65876e7
    assert "m*_n/m_tot" in invoke(EXAMPLES / "structure_properties.toml", "--adequacy").stdout


def test_adequacy_of_a_block(block):
    result = invoke(block, "--adequacy")
    assert result.exit_code == 2
    assert "properties must have at least one mode" in result.stderr


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
        table = csv.DictReader(file)
        rows = [{name: float(value) for name, value in row.items()} for row in table]
    frame = make_frame()
    lifted = rf.uplifted_modes(frame.rocking(3))
    columns = {
        "mode": [1.0, 2.0, 3.0],
        "omega": frame.rocking(3).omega,
        "zeta": frame.rocking(3).zeta,
        "uplifted_period": 2.0 * np.pi / lifted.omega,
        "uplifted_omega": lifted.omega,
        "uplifted_ratio": lifted.ratio,
        "uplifted_zeta": lifted.damping_ratio,
    }
    for name, values in columns.items():
        np.testing.assert_array_equal([row[name] for row in rows], values)
    assert set(rows[0]) == {*columns, "period", "effective_mass", "mass_share", "effective_height", "top_ordinate"}
    assert (tmp_path / "out" / "mode-shapes.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("name", ["chimney", "bridge_pier", "restrained_pier"])
def test_figure_of_distributed_mass(name, tmp_path):
    result = invoke(EXAMPLES / f"{name}.toml", "--modes", 2, "--adequacy", "--out", tmp_path / "out")
    assert result.exit_code == 0
    assert (tmp_path / "out" / "mode-shapes.png").is_file()
    assert json.loads((tmp_path / "out" / "summary.json").read_text("utf-8"))["adequacy"]["model"]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["frame"], "frame is not a structure file: a name that ends in .toml is expected."),
        ([STRUCTURE, "--modes", 7], "--modes must be a whole number from 1 to 5, but 7 was given."),
        ([STRUCTURE, "--structure", STRUCTURE], "Two structures were given"),
        (["--stories", 5], "The frame lacks --story-height, --story-mass"),
        ([STRUCTURE, "--force"], "--force was given without --out, to which it belongs."),
    ],
)
def test_bad_input(arguments, said):
    result = invoke(*arguments, "--json")
    assert result.exit_code == 2
    assert result.stdout == ""
    assert said in result.stderr


FUSES = """
[[elements]]
kind = "tendon"
initial_force = 2e5
stiffness = 3e6

[[elements]]
kind = "yielding_dissipator"
position = {x}
stiffness = 5e7
yield_force = {strength}
post_yield_ratio = 0.1
tension_only = {only}

[[elements]]
kind = "friction_damper"
force = 1e5

[[elements]]
kind = "viscous_damper"
coefficient = 4e5
"""


LEAST = ["Least", "moment", "that", "lifts", "it", "after", "yielding,", "M_r", "-", "M_d"]


def walled(tmp_path, strength="3e5", only="false", x="0.0", eccentric=False):
    path = tmp_path / "fused.toml"
    content = ECCENTRIC if eccentric else ECCENTRIC.replace("eccentricity = -0.15\n", "")
    path.write_text(content + FUSES.format(strength=strength, only=only, x=x), "utf-8")
    return path


def test_elements_are_printed_with_what_closes_the_base(tmp_path):
    path = walled(tmp_path)
    rows = [line.split() for line in invoke(path).stdout.splitlines()]
    p = rf.read_structure(path).rocking()
    # By hand: M_r = (W + P) B, M_d = (0.9 F_y + F_0) B.
    resisting, locked = (160e3 * 9.81 + 2e5) * p.half_width, (0.9 * 3e5 + 1e5) * p.half_width
    assert ["Moment", "of", "the", "dissipators,", "M_d", f"{locked / 1e3:.1f}", "kN", "m"] in rows
    assert ["Re-centring", "ratio,", "M_r/M_d", f"{resisting / locked:.3f}"] in rows
    assert [*LEAST, f"{(resisting - locked) / 1e3:.0f}", "kN", "m"] in rows
    assert ["Self-centring", "yes"] in rows
    assert ["1", "tendon", "0", "3000", "-", "200.0", "-", "-"] in rows
    assert ["2", "yielding", "dissipator", "0", "50000", "-", "-", "300.0", "0.1000"] in rows
    assert ["3", "friction", "damper", "0", "-", "-", "-", "100.0", "-"] in rows
    assert ["4", "viscous", "damper", "0", "-", "400.0", "-", "-", "-"] in rows
    assert "breaks at" not in invoke(path).stdout
    assert max(map(len, invoke(path).stdout.splitlines())) <= 80


def test_a_base_that_its_dissipators_hold_open(tmp_path):
    rows = [line.split() for line in invoke(walled(tmp_path, strength="3e6")).stdout.splitlines()]
    assert ["Self-centring", "no:", "it", "may", "stay", "open"] in rows
    assert [*LEAST, "0", "kN", "m"] in rows
    found = json.loads(invoke(walled(tmp_path, strength="3e6"), "--json").stdout)["rocking"]
    assert found["self_centring"] is False
    assert found["recentring_ratio"] == pytest.approx((160e3 * 9.81 + 2e5) / (0.9 * 3e6 + 1e5))
    # It cannot push it open.
    assert "tension only" in invoke(walled(tmp_path, strength="3e6", only="true")).stdout
    found = json.loads(invoke(walled(tmp_path, strength="3e6", only="true"), "--json").stdout)["rocking"]
    assert found["self_centring"] is True


def test_elements_in_the_document(tmp_path):
    found = json.loads(invoke(walled(tmp_path), "--json").stdout)
    elements = found["rocking"]["elements"]
    assert [each["kind"] for each in elements] == ["tendon", "yielding_dissipator", "friction_damper", "viscous_damper"]
    assert elements[1]["yield_force"] == 3e5
    assert {name for each in elements for name in each} - {"kind", "post_yield_ratio", "tension_only"} <= found[
        "units"
    ].keys()
    assert [each["kind"] for each in found["structure"]["elements"]] == [each["kind"] for each in elements]
    free = json.loads(invoke(STRUCTURE, "--json").stdout)["rocking"]
    assert not free.keys() & {"elements", "self_centring", "recentring_ratio"}


def test_each_edge_has_its_dissipators(tmp_path):
    path = walled(tmp_path, x="0.4", eccentric=True)
    rows = [line.split() for line in invoke(path).stdout.splitlines()]
    p = rf.read_structure(path).rocking()
    locked = [f"{p.pivot(side).dissipator_moment / 1e3:.1f}" for side in (1, -1)]
    assert ["Moment", "of", "the", "dissipators,", "M_d", *locked, "kN", "m"] in rows
    assert ["Self-centring", "yes", "yes"] in rows


TONNES = """[cantilever]
height = 12.0
tip_mass = 60.0
mass_per_length = 4e3
bending_stiffness = 2e5
base_mass = 50e3
half_width = 1.5
damping_ratio = 0.02
"""


def test_what_looks_like_another_unit_is_said_and_not_refused(tmp_path):
    path = tmp_path / "tonnes.toml"
    path.write_text(TONNES, "utf-8")
    expected = rf.structure_warnings(rf.read_structure(path))
    assert len(expected) == 2
    printed = invoke(path)
    assert (printed.exit_code, printed.stderr.splitlines()) == (0, [f"Warning: {text}" for text in expected])
    assert json.loads(invoke(path, "--json").stdout)["warnings"] == list(expected)
    ran = CliRunner().invoke(app, ["run", str(path), "el-centro-1940", "--model", "rigid", "--json"])
    assert ran.exit_code == 0
    assert json.loads(ran.stdout)["warnings"] == list(expected)
    assert [f"Warning: {text}" for text in expected] == ran.stderr.splitlines()[:2]
    assert invoke(STRUCTURE).stderr == ""


@pytest.mark.parametrize(("flags", "shown"), [((), 10), (("--all",), 12), (("--modes", "11"), 11)])
def test_the_first_ten_modes_are_printed(flags, shown):
    frame = "--stories 12 --story-height 3 --story-mass 4e4 --base-mass 4e4 --stiffness-ratio inf --period 1"
    line = ["modes", *frame.split(), "--aspect-ratio", "9", "--damping-ratio", "0.02", *flags]
    done = CliRunner().invoke(app, line)
    assert done.exit_code == 0, done.output
    numbers = [int(row.split()[0]) for row in done.stdout.splitlines() if re.match(r"\d++ ", row)]
    assert numbers == [*range(1, shown + 1)] * 2
    assert ("--all prints the others" in done.stdout) == (shown == 10)
    everything = json.loads(CliRunner().invoke(app, [*line, "--json"]).stdout)
    assert len(everything["modes"]) == (11 if shown == 11 else 12)
