"""Units of tables and reports: sizes by definition, and the same values in every system and with both decimal signs."""

import re
from pathlib import Path

import pytest
from scipy import constants
from typer.testing import CliRunner

import rockflex as rf
from report_case import FRAME, HELD, PULSE, SPRINGS, runs
from rockflex.cli._app import app
from rockflex.foundation.units import QUANTITIES, UnitSystem, named_unit, with_decimal_commas

# Exponents of force, length and time.
DIMENSIONS = {
    "force": (1, 0, 0),
    "moment": (1, 1, 0),
    "displacement": (0, 1, 0),
    "length": (0, 1, 0),
    "rotation": (0, 0, 0),
    "velocity": (0, 1, -1),
    "mass": (1, -1, 2),
    "first moment of mass": (1, 0, 2),
    "inertia": (1, 1, 2),
    "mass per length": (1, -2, 2),
    "density": (1, -4, 2),
    "stress": (1, -2, 0),
    "elastic modulus": (1, -2, 0),
    "shear modulus": (1, -2, 0),
    "stiffness": (1, -1, 0),
    "rotational stiffness": (1, 1, 0),
    "subgrade modulus": (1, -3, 0),
    "damping": (1, -1, 1),
    "area": (0, 2, 0),
    "second moment of area": (0, 4, 0),
    "bending stiffness": (1, 2, 0),
    "energy": (1, 1, 0),
    "time": (0, 0, 1),
    "ratio": (0, 0, 0),
}
EXAMPLES = Path(__file__).parents[2] / "examples"
VALUE = re.compile(r'data-of="(\w+)" data-value="([^"]+)">([^<]+)<')


def test_each_quantity_has_a_dimension_here():
    assert QUANTITIES.keys() - DIMENSIONS.keys() == {"acceleration", "share"}  # in g, and in per cent


@pytest.mark.parametrize("quantity", DIMENSIONS)
def test_sizes_follow_from_the_definitions_of_pound_and_inch(quantity):
    force, length, _ = DIMENSIONS[quantity]
    # A few products of doubles: rounding alone.
    expected = (1e3 * constants.lbf) ** force * constants.inch**length
    assert UnitSystem("kip-in").of(quantity).size == pytest.approx(expected, rel=1e-15)
    assert UnitSystem("SI").of(quantity).size == 1.0
    for name in ("kN", "MN"):
        digits = f"{UnitSystem(name).of(quantity).size:e}"
        assert digits.startswith("1.000000e")


def test_accelerations_and_shares():
    sizes = [UnitSystem(name).of("acceleration") for name in ("kN", "MN", "SI", "kip-in")]
    assert sizes == [(9.81, "g"), (9.81, "g"), (1.0, "m/s²"), (9.81, "g")]
    assert UnitSystem().of("share") == (0.01, "%")


@pytest.mark.parametrize(("largest", "unit"), [(9.99e6, "kN m"), (1e7, "MN m")])
def test_moments_in_kn_are_in_meganewtons_where_they_are_large(largest, unit):
    assert UnitSystem().of("moment", largest=largest).name == unit
    assert UnitSystem("SI").of("moment", largest=largest).name == "N m"


def test_a_table_may_have_a_usual_unit_in_the_system_kn_alone():
    assert UnitSystem().of("displacement", "m").name == "m"
    assert UnitSystem("MN").of("displacement", "m").name == "mm"
    assert named_unit("kip s²/in").heading("m") == "m [kip s²/in]"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("V_b = 1.25 kN, at 3.5 s.", "V_b = 1,25 kN, at 3,5 s."),
        ("about 0.5. Then 1.2e-05", "about 0,5. Then 1,2e-05"),
        ("12\u202f345.6", "12\u202f345,6"),
        ("Section 3.3, 4.3.3.4.3, rockflex 0.1.0, RSN6_1.5x", "Section 3.3, 4.3.3.4.3, rockflex 0.1.0, RSN6_1.5x"),
    ],
)
def test_commas_in_numbers_but_not_in_references(text, expected):
    assert with_decimal_commas(text) == expected


RESULTS = {
    "run": lambda: runs(HELD, PULSE, ["2DOF-S", "fixed"]),
    "ground": lambda: runs(HELD, PULSE, ["2DOF-S"], ground=SPRINGS),
    "set": lambda: rf.simulate_set(FRAME, [rf.one_sine_pulse(3.0, period) for period in (0.5, 0.6)], "2DOF-S"),
    "comparison": lambda: rf.compare({"a": FRAME, "b": HELD}, PULSE),
}


def units_of(text):
    return set(re.findall(r"\[([^\]]+)\]<", text)) | set(re.findall(r'<dd class="unit">([^<]+)<', text))


@pytest.mark.slow
@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize("kind", RESULTS)
def test_values_of_reports_are_the_same_in_every_system(kind, tmp_path):
    responses, options = RESULTS[kind](), {"appendix": True} if kind == "run" else {}

    def written(**given):
        text = rf.write_report(responses, tmp_path / "r.html", date="2030", **options, **given).read_text("utf-8")
        return VALUE.findall(text), units_of(text)

    (usual, units), (in_si, si_units), (in_kip, us_units) = (
        written(),
        written(units="SI"),
        written(units="kip-in", decimal=","),
    )
    assert [row[:2] for row in usual] == [row[:2] for row in in_si] == [row[:2] for row in in_kip]
    assert units & {"kN", "mm", "t", "mrad"}
    assert not si_units & {"kN", "mm", "t", "g", "mrad"}
    assert not us_units & {"kN", "mm", "m", "t", "mrad"}
    shears = [row for row in zip(usual, in_si, in_kip, strict=True) if row[0][0] in ("max_base_shear", "prestress")]
    assert shears
    for row in shears:
        for (_, value, text), size in zip(row, (1e3, 1.0, 1e3 * constants.lbf), strict=True):
            # Three digits are printed.
            assert float(text.translate({0x202F: None, ord(","): "."})) == pytest.approx(float(value) / size, rel=6e-3)
    numbers = " ".join(text for *_, text in in_kip)
    assert re.search(r"\d,\d", numbers)
    assert not re.search(r"\d\.\d", numbers)


@pytest.mark.parametrize(("option", "value"), [("units", "kips"), ("units", 3), ("decimal", ";"), ("language", "la")])
def test_unknown_units_and_signs_are_refused(tmp_path, option, value):
    with pytest.raises(rf.InputError, match=option) as caught:
        rf.write_report(runs(FRAME, PULSE, ["2DOF-S"]), tmp_path / "r.html", **{option: value})
    assert caught.value.field == option
    assert not (tmp_path / "r.html").exists()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("command", "heads"),
    [
        (["modes", "restrained_pier.toml"], ["kip s²/in", "kip in", "[kip/in]"]),
        (["run", "restrained_pier.toml", "el-centro-1940", "--model", "2DOF-S"], ["[kip]", "[kip in]", "[in]"]),
        (["check", "restrained_pier.toml", "el-centro-1940", "--model", "2DOF-S"], ["[kip]", "[kip in]", "[in]"]),
        (["compare", "restrained_pier.toml", "bridge_pier.toml", "el-centro-1940"], ["[kip]", "[kip in]", "[in]"]),
    ],
)
def test_tables_of_commands(command, heads):
    given = [str(EXAMPLES / word) if word.endswith(".toml") else word for word in command]

    def printed(*options):
        result = CliRunner().invoke(app, [*given, *options], env={"COLUMNS": "200"})
        assert result.exit_code == 0, result.stderr
        return result.stdout

    found = printed("--output-units", "kip-in", "--decimal-comma")
    flat = re.sub(r"\s+", " ", found)
    assert all(head in flat for head in heads)
    assert not re.search(r"(?<!Section )\d\.\d", found)
    assert re.search(r"\d,\d", found)
    assert "kN" not in found
    if command[0] != "run":  # whose document has the computing time
        assert printed("--json") == printed("--json", "--output-units", "kip-in", "--decimal-comma")


def test_forces_of_a_run_are_those_of_its_document_in_kips():
    command = ["run", str(EXAMPLES / "restrained_pier.toml"), "el-centro-1940", "--model", "2DOF-S"]
    result = CliRunner().invoke(app, [*command, "--output-units", "kip-in"], env={"COLUMNS": "200"})
    frame = rf.read_structure(EXAMPLES / "restrained_pier.toml")
    expected = rf.simulate(frame, rf.load_suite("el-centro-1940")[0], "2DOF-S").max_base_shear / (1e3 * constants.lbf)
    assert f"{expected:.4g}" in result.stdout


def test_unknown_units_of_a_command_are_refused():
    result = CliRunner().invoke(app, ["modes", str(EXAMPLES / "structure_1.toml"), "--output-units", "lb"])
    assert result.exit_code == 2
    assert "kip-in" in result.stderr
