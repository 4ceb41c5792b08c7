"""The units of the page in a browser: what is shown and typed in a system, against values in SI units."""

import pytest
from scipy import constants

from rockflex.foundation.json import as_json_value
from rockflex.foundation.units import QUANTITIES
from rockflex.web._forms import PRESETS

pytestmark = pytest.mark.web

FUSES = next(each["structure"] for each in PRESETS if each["structure"]["name"] == "Pier with fuses")
KIP_IN = 1e3 * constants.lbf * constants.inch  # N m
TABLES = """async () => {
    const { eachNumber, fromSI, toSI } = await import("/static/units.js");
    const typed = [40, 0.1, 123.456, [1, [2.5, -7]], { 0: 3.5, 1: 59.0551181102 }, "inf", "soon", null, 0];
    return Object.values(rockflexPage.about.units).flatMap((system) => Object.entries(system).map(([name, unit]) => [
        name, unit.size, typed, toSI(typed, unit), fromSI(toSI(typed, unit), unit),
    ]));
}"""


def text(visitor, selector):
    return visitor.page.locator(selector).first.inner_text()


def field(visitor, path):
    return visitor.page.locator(f'[data-path="{path}"] input').first


@pytest.mark.slow
def test_what_is_typed_in_inches_and_kips_is_kept_in_si_units(visit, link):
    visitor = visit(link({"structure": as_json_value(FUSES), "units": "kip-in"}))
    half = field(visitor, "structure.cantilever.half_width")
    assert float(half.input_value()) == pytest.approx(FUSES["cantilever"]["half_width"] / constants.inch, rel=5e-4)
    assert len(half.input_value()) <= 5  # four digits of what a conversion makes long
    visitor.fill("few.B", "125")
    visitor.wait_for_results()
    assert visitor.state()["structure"]["cantilever"]["half_width"] == 1.5875
    assert (field(visitor, "few.B").input_value(), half.input_value()) == ("125", "62.5")
    visitor.fill("structure.elements.0.initial_force", "500")
    assert visitor.state()["structure"]["elements"][0]["initial_force"] == float(f"{5e5 * constants.lbf:.15g}")
    visitor.fill("structure.cantilever.half_width", "-2")
    visitor.wait_for_error("structure.cantilever.half_width", " in, but ")
    assert "−2 in was given" in text(visitor, '[data-path="structure.cantilever.half_width"] > .error')
    visitor.fill("structure.cantilever.half_width", "wide")  # no number, so no unit
    visitor.wait_for_error("structure.cantilever.half_width", "wide")
    assert "SI" not in text(visitor, '[data-path="structure.cantilever.half_width"] > .error')
    visitor.tab("response")
    visitor.page.locator(".foot:not(:empty)").filter(has_text="Structure, half width").wait_for()


@pytest.mark.slow
def test_soils_are_in_megapascals_and_rows_stay_open_in_other_units(visit, link):
    bed = {"bed": {"breadth": 4.0, "shear_modulus": 39e6, "poisson_ratio": 0.3, "method": "gazetas"}, "mat_mass": 1e5}
    visitor = visit(link({"structure": as_json_value(FUSES), "ground": bed, "models": ["2DOF-S"], "units": "kN"}))
    assert field(visitor, "ground.bed.shear_modulus").input_value() == "39"
    assert "MPa" in text(visitor, '[data-path="ground.bed.shear_modulus"]')
    rows = visitor.page.locator('details[data-path^="structure.elements."]')
    opened = "all => all.map((each) => each.open)"
    rows.nth(1).locator("summary").first.click()
    assert rows.evaluate_all(opened) == [False, True, False]
    before = rows.first.element_handle()
    visitor.page.locator("#units").select_option("kip-in")
    visitor.page.wait_for_function("row => !row.isConnected", arg=before)
    assert rows.evaluate_all(opened) == [False, True, False]
    visitor.fill("ground.bed.shear_modulus", "10")
    assert visitor.state()["ground"]["bed"]["shear_modulus"] == pytest.approx(10e3 * constants.psi, rel=1e-12)


@pytest.mark.slow
def test_forty_kilonewtons_are_forty_thousand_newtons_in_a_field(visit, link):
    springs = {"springs": {"stiffness": 4e8, "positions": [-1.0, 1.0], "heave_damping_ratio": 0.3}}
    visitor = visit(link({"structure": as_json_value(FUSES), "ground": springs, "models": ["2DOF-S"], "units": "kN"}))
    force = field(visitor, "structure.elements.0.initial_force")
    assert force.input_value() == "2500"
    visitor.fill("structure.elements.0.initial_force", "40")
    assert visitor.state()["structure"]["elements"][0]["initial_force"] == 40000
    visitor.fill("ground.springs.stiffness", "400,5 399")  # decimal commas in a list, as in SI units
    assert visitor.state()["ground"]["springs"]["stiffness"] == [400.5e6, 399e6]
    assert field(visitor, "ground.springs.stiffness").input_value() == "400.5, 399"
    visitor.page.select_option("#units", "SI")
    visitor.page.locator('[data-path="structure.elements.0.initial_force"] .unit:text-is("N")').wait_for(
        state="attached"
    )
    assert field(visitor, "structure.elements.0.initial_force").input_value() == "40000"
    assert visitor.state()["units"] == "SI"


def test_every_unit_gives_back_what_was_typed(visit):
    known = visit().page.evaluate(TABLES)
    assert {name for name, *_ in known} == set(QUANTITIES)
    for _, size, typed, si, shown in known:
        assert shown == typed
        assert si[0] == pytest.approx(40 * size, rel=1e-14)  # 15 digits
        assert si[5:] == typed[5:]


@pytest.mark.slow
def test_results_in_kips_and_inches_are_those_in_si_units(visit, link, client):
    state = client.state(structure=as_json_value(FUSES), scale=2.0, units="kip-in")
    models = client.ask("/api/response", state)["models"]
    visitor = visit(link(state | {"tab": "response"}))
    visitor.shown(2)
    for model in models:
        row = f'#peaks tr[data-model="{model["label"]}"] '
        for name, size in {
            "max_base_moment": KIP_IN,
            "max_top_displacement": constants.inch,
            "max_rotation": 1.0,
        }.items():
            shown = text(visitor, f'{row}[data-name="{name}"]').split(" ")[0]
            mantissa, _, power = shown.partition("·10⁶")
            value = float(mantissa) * (1e6 if "·" in shown else 1.0)
            assert power == ""
            assert value == pytest.approx(model["peaks"][name] / size, rel=6e-4)  # four digits
    drawn = visitor.page.evaluate(
        "rockflexStage.charts.base_moment.data.series.map((s) => Math.max(...s.y.map(Math.abs)))"
    )
    expected = [max(abs(client.unpack(model["base_moment"]))) / KIP_IN for model in models]
    assert drawn == pytest.approx(expected, rel=1e-6)  # single precision
    assert visitor.page.evaluate("rockflexStage.charts.base_moment.options.yLabel") == "M_b [kip in]"
    first = models[0]["peaks"]
    assert f"{first['max_rotation']:.3g} rad" in text(visitor, "#verdict")
    assert f"{first['max_total_top_displacement'] / constants.inch:.3g} in relative to the ground" in text(
        visitor, "#verdict"
    )
    head = text(visitor, "#elements thead")
    assert all(unit in head for unit in ("[kip]", "[in]", "[kip in]"))
    visitor.tab("earthquake")
    pga = visitor.page.locator('[data-measure="PGA"]')
    pga.wait_for()
    assert float(pga.inner_text()) == pytest.approx(float(pga.get_attribute("data-value")) / 9.81, rel=6e-4)


@pytest.mark.slow
def test_the_link_keeps_the_units_and_files_are_in_si_units(visit, client):
    visitor = visit()
    half = visitor.state()["structure"]["cantilever"]["half_width"]
    assert visitor.state()["units"] == "kN"
    visitor.page.select_option("#units", "kip-in")
    visitor.page.locator('#three dd:text-matches("rad$")').wait_for()
    address = visitor.page.evaluate("location.hash")
    other = visit(f"/{address}")
    assert other.page.locator("#units").input_value() == "kip-in"
    other.page.locator('#three dd:text-matches("rad$")').wait_for()
    assert float(field(other, "few.B").input_value()) == pytest.approx(2.0 * half / constants.inch, rel=6e-4)
    _, program = client.download("/api/file/python", other.state())
    assert f"half_width={half}" in program.decode().replace(" ", "").replace('"half_width":', "half_width=")
    _, report = client.download("/api/file/report", other.state())
    assert "kip in" in report.decode()
    assert "kN m" not in report.decode()


@pytest.mark.slow
def test_other_units_keep_the_runs_of_a_study(visit, link, client):
    visitor = visit(link(client.state(tab="fragility")))
    visitor.page.wait_for_function("() => document.querySelector('#status').textContent.includes('Done: ')")
    median = visitor.value('[data-name="median"]')
    started = []
    visitor.page.on("request", lambda r: started.append(r.url) if r.url.endswith("/api/study/cloud") else None)
    visitor.page.select_option("#units", "kip-in")
    visitor.page.locator('#fits th:has-text("[in/s]")').wait_for()
    shown = text(visitor, '[data-name="median"]')
    assert visitor.value('[data-name="median"]') == median
    assert float(shown) == pytest.approx(median / constants.inch, rel=6e-4)
    assert started == []
