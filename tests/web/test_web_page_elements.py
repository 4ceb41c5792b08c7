"""Elements between the base and the ground in a real Chromium: their form, a run with fuses, its loops, old links."""

import json

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from rockflex.web._presets import PRESETS

pytestmark = pytest.mark.web

PIER = next(each["structure"] for each in PRESETS if each["structure"]["name"] == "Pier with fuses")
NAMES = ["1: Tendon at 0 m", "2: Yielding dissipator at −1.3 m", "3: Yielding dissipator at 1.3 m"]


def held(visitor) -> list[dict]:
    return visitor.state()["structure"].get("elements", [])


def test_elements_of_all_kinds_are_added_changed_and_removed(visitor) -> None:
    page = visitor.page
    bare = visitor.value("dd[data-value] >> nth=2")
    kinds = page.evaluate("Object.keys(rockflexPage.about.elements)")
    assert kinds == ["tendon", "yielding_dissipator", "viscous_damper", "friction_damper"]
    for place, kind in enumerate(kinds):
        page.get_by_label("Element to add").select_option(kind)
        page.get_by_role("button", name="Add an element").click()
        assert page.evaluate("document.activeElement.labels[0].textContent") == "Element"
        visitor.fill(f"structure.elements.{place}.position", str(0.2 * place))
        shown = page.locator(f'details[data-path="structure.elements.{place}"] summary').inner_text()
        title = page.evaluate("kind => rockflexPage.about.elements[kind].title", kind)
        assert shown == f"{place + 1}: {title} at {0.2 * place:g} m"
        names = page.evaluate(f"rockflexPage.about.elements.{kind}.fields.map((each) => each.name)")
        assert page.locator(f'[data-path^="structure.elements.{place}."]').count() == len(names) + 1  # and the kind
    frame = make_frame()
    elements = [
        rf.Tendon(1e5, 1e6), rf.YieldingDissipator(5e7, 1e5, position=0.2), rf.ViscousDamper(5e5, position=0.4),
        rf.FrictionDamper(5e4, position=0.6),
    ]  # fmt: skip
    expected = rf.Restrained(frame, elements).rocking()
    page.wait_for_function(
        "m => [...document.querySelectorAll('dd[data-value]')].some((e) => Number(e.dataset.value) === m)",
        arg=expected.pivot(1).resisting_moment,
    )
    assert page.locator("#base").get_attribute("aria-label").count(";") == 3
    # An element of another kind keeps what both have.
    row = page.locator('details[data-path="structure.elements.1"]')
    row.get_by_label("Element", exact=True).select_option("tendon")
    assert held(visitor)[1] == {
        "kind": "tendon", "position": 0.2, "initial_force": 1e5, "stiffness": 5e7, "yield_force": 1e5,
    }  # fmt: skip
    assert row.get_attribute("open") is not None
    page.locator('details[data-path="structure.elements.0"]').get_by_role("button", name="Remove").click()
    assert [each["kind"] for each in held(visitor)] == ["tendon", "viscous_damper", "friction_damper"]
    for _ in range(3):
        page.locator("details[data-path]:visible").first.get_by_role("button", name="Remove").click()
    assert "elements" not in visitor.state()["structure"]
    page.wait_for_selector("#base", state="detached")
    assert visitor.value("dd[data-value] >> nth=2") == bare


def test_a_bad_value_is_answered_beside_it_even_in_a_closed_row(visitor, visit, link) -> None:
    page = visitor.page
    page.get_by_role("button", name="Add an element").click()
    path = "structure.elements.0"
    for field, text, said in (
        ("position", "99", "Elements must act within half_width"),
        ("stiffness", "soft", "It must be EA/L over the unbonded length, a number in N/m, but 'soft' was given."),
        ("yield_force", "10", "initial_force must not exceed yield_force"),
    ):
        box = page.locator(f'[data-path="{path}.{field}"] input')
        before = box.input_value()
        visitor.fill(f"{path}.{field}", text)
        at = "initial_force" if field == "yield_force" else field
        assert said.lower() in visitor.error(f"{path}.{at}").lower()
        assert page.locator(f'[data-path="{path}.{at}"] input').get_attribute("aria-invalid") == "true"
        visitor.fill(f"{path}.{field}", before)
        page.wait_for_function("() => !document.querySelector('.results.stale')")
    assert page.locator(".error:visible").count() == 0
    page.get_by_role("button", name="Add an element").click()
    rows = page.locator("details[data-path]")
    page.locator("summary").first.click()
    assert rows.first.get_attribute("open") is None
    page.evaluate("rockflexPage.state.structure.elements[0].position = 50; rockflexPage.change({})")
    assert "must act within half_width" in visitor.error(f"{path}.position")
    assert rows.first.get_attribute("open") is not None


@pytest.fixture(scope="module")
def run() -> rf.Response:
    fuses = [rf.YieldingDissipator(2e8, 5e5, 0.02, position=x) for x in (-1.3, 1.3)]
    tendon = rf.Tendon(2.5e6, 25e6, yield_force=6e6, post_yield_ratio=0.02)
    pier = rf.Restrained(rf.CantileverWithTipMass(**PIER["cantilever"]), [tendon, *fuses])
    motion = rf.load_suite("el-centro-1940")[0].scaled(2.0)
    return rf.simulate(pier, motion, "MDOF-S", free_vibration=5.0, output="history")


def test_a_run_with_fuses_has_peaks_and_loops_in_step(visit, link, run) -> None:
    visitor = visit(link({"structure": PIER, "scale": 2.0, "models": ["MDOF-S", "2DOF-S", "fixed"], "tab": "response"}))
    page = visitor.page
    visitor.shown(2, ["MDOF-S", "2DOF-S", "fixed"])
    rows = page.locator("#elements tbody tr")
    assert rows.locator("th").all_inner_texts() == NAMES
    for place in range(3):
        row = f"#elements tbody tr:nth-child({place + 1})"
        assert visitor.value(f'{row} [data-name="force"]') == run.max_element_force[place]
        assert visitor.value(f'{row} [data-name="elongation"]') == run.max_element_elongation[place]
        assert visitor.value(f'{row} [data-name="energy"]') == run.element_energy[place]
    assert rows.locator('[data-name="yielded"]').all_inner_texts() == ["no", "yes", "yes"]
    assert visitor.value('[data-name="prestress"]') == run.remaining_prestress[0]
    assert visitor.peak("MDOF-S", "residual_rotation") == run.residual_rotation
    said = page.locator("#closing").inner_text()
    assert said.startswith("Weight and prestress close the base against its dissipators (λ = 9.96)")
    # The loops show the time of the animation, for another element too.
    page.get_by_label("Element for the loop").select_option("2")
    page.wait_for_function("() => rockflexStage.view().element === 2")
    assert page.evaluate("rockflexStage.charts.element.options.yLabel") == "F_3 [kN]"
    for node in np.linspace(100, run.time.size - 100, 7).astype(int):
        time = float(run.time[node])
        if np.sum(run.time == time) > 1:
            continue  # an event: two states at once
        page.evaluate("t => rockflexStage.move(t)", time)
        force, moment = page.evaluate(
            "() => ['element', 'base'].map((name) => { const { points, trails } = rockflexStage.loops[name].chart;"
            " return [points[0].x, points[0].y, points.length, trails[0].n]; })"
        )
        assert force[:2] == pytest.approx(
            [1e3 * run.element_elongation[node, 2], 1e-3 * run.element_force[node, 2]], rel=1e-3, abs=0.02
        )
        over = page.evaluate("() => rockflexStage.charts.element.points.map(({ x, y }) => [x, y])")
        assert len(over) == 2
        assert over[0] == pytest.approx([time, 1e-3 * run.element_force[node, 2]], rel=1e-3, abs=0.02)
        assert moment[0] == pytest.approx(1e3 * run.rotation[node], rel=1e-3, abs=1e-4)
        assert force[2] == moment[2] == 2  # not the fixed base
        passed = page.evaluate("t => rockflexStage.view().models[0].t.filter((each) => each <= t).length", time)
        assert abs(force[3] - passed) <= 1
    # The elements and the energy are those of one model.
    page.get_by_label("Model for the elements").select_option("2DOF-S")
    page.wait_for_function("() => rockflexStage.view().held.label === '2DOF-S'")
    assert page.get_by_label("Model for the energy").input_value() == "2DOF-S"
    assert "taken by elements" in page.locator(".pair .legend").inner_text()
    page.get_by_label("Model for the energy").select_option("fixed")
    page.wait_for_function("() => rockflexStage.view().energy.label === 'fixed'")
    assert page.get_by_label("Model for the elements").input_value() == "MDOF-S"


def test_a_structure_without_elements_shows_none_of_this(visitor) -> None:
    visitor.tab("response")
    visitor.shown(1, ["MDOF-S", "2DOF-S", "fixed"])
    page = visitor.page
    assert page.locator("#elements").is_hidden()
    assert page.get_by_label("Element for the loop").is_hidden()
    assert page.get_by_label("Force of an element over time").is_hidden()
    assert page.locator('#peaks [data-name="residual_rotation"]').count() == 0
    assert page.locator(".stage .legend").inner_text() == ""


def test_elements_are_drawn_where_they_are(visit, link) -> None:
    """A row of pixels through the fuses has their colour where they stand, and nowhere else."""
    visitor = visit(link({"structure": PIER, "models": ["2DOF-S"], "tab": "response"}))
    visitor.shown(1, ["2DOF-S"])
    seen = visitor.page.evaluate(
        """() => {
          const { stage } = rockflexStage;
          rockflexStage.move(0);
          const width = stage.canvas.clientWidth;
          const scale = stage.canvas.width / width;
          const middle = Math.round(scale * (stage.height - 44 - 20)); // above the base, through its fuses
          const { data } = stage.canvas.getContext("2d").getImageData(0, middle, stage.canvas.width, 1);
          const tone = getComputedStyle(document.documentElement).getPropertyValue("--fuse").trim().slice(1);
          const wanted = tone.match(/../g).map((part) => parseInt(part, 16));
          const found = [];
          for (let i = 0; i < data.length; i += 4)
            if (wanted.every((value, k) => Math.abs(value - data[i + k]) < 24)) found.push(i / 4 / scale - width / 2);
          const { heights } = stage.view;
          const top = heights[heights.length - 1];
          const zoom = Math.min((stage.height - 74) / (top * 1.08), width / (2.1 * Math.max(0.32 * top, 1.6 * 1.5)));
          return found.map((pixels) => pixels / zoom);
        }"""
    )
    assert {-1.3, 1.3} == {1.3 * np.sign(x) for x in seen}
    assert np.abs(seen) == pytest.approx(1.3, abs=0.1)


def test_a_link_with_tendons_of_an_earlier_version_opens(visit, link) -> None:
    old = json.loads(json.dumps(PRESETS[0]["structure"]).replace("Infinity", '"inf"'))
    tendons = [{"position": 0.0, "initial_force": 5e5, "stiffness": 2e7, "yield_force": 9e5}]
    visitor = visit(link({"structure": old | {"tendons": tendons}, "models": ["2DOF-S"], "tab": "response"}))
    visitor.shown(1, ["2DOF-S"])
    frame = rf.Restrained(make_frame(), rf.Tendon(5e5, 2e7, yield_force=9e5))
    expected = rf.simulate(frame, rf.load_suite("el-centro-1940")[0], "2DOF-S", free_vibration=5.0)
    assert visitor.peak("2DOF-S", "max_rotation") == expected.max_rotation
    assert visitor.value('#elements [data-name="force"]') == expected.max_element_force[0]
    visitor.tab("structure")
    assert visitor.page.locator("details[data-path] summary").all_inner_texts() == ["1: Tendon at 0 m"]
    assert held(visitor) == [{"kind": "tendon", **tendons[0]}]
    visitor.fill("structure.elements.0.initial_force", "6e5")
    visitor.tab("response")
    more = rf.Restrained(make_frame(), rf.Tendon(6e5, 2e7, yield_force=9e5))
    expected = rf.simulate(more, rf.load_suite("el-centro-1940")[0], "2DOF-S", free_vibration=5.0)
    visitor.wait_for_peak("2DOF-S", "max_rotation", expected.max_rotation)
