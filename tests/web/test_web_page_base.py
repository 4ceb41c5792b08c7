"""Elements and ground in a browser: their forms, drawings and charts."""

import math

import numpy as np
import pytest
from test_web_structure import PIER

import rockflex as rf
from builders import make_frame
from rockflex.foundation.json import as_json_value
from rockflex.structure.file._element_tables import ELEMENTS
from rockflex.studies._ground_tables import GroundTable
from rockflex.web._forms import PRESETS

pytestmark = pytest.mark.web

NAMES = ["1: Tendon at 0 m", "2: Fuse at −1.3 m", "3: Fuse at 1.3 m"]


def held(visitor) -> list[dict]:
    return visitor.state()["structure"].get("elements", [])


@pytest.mark.slow
def test_elements_of_all_kinds_are_added_changed_and_removed(visitor) -> None:
    page = visitor.page
    bare = visitor.value("[data-task=modes] dd[data-value] >> nth=2")
    kinds = page.evaluate("Object.keys(rockflexPage.about.elements)")
    assert kinds == [*ELEMENTS]
    for place, kind in enumerate(kinds):
        page.get_by_label("Element to add").select_option(kind)
        page.get_by_role("button", name="Add an element").click()
        assert page.evaluate("document.activeElement.labels[0].textContent") == "Element"
        visitor.fill(f"structure.elements.{place}.position", str(0.1 * place))
        shown = page.locator(f'details[data-path="structure.elements.{place}"] > summary').inner_text()
        title = page.evaluate("kind => rockflexPage.about.elements[kind].title", kind)
        assert shown == f"{place + 1}: {title} at {0.1 * place:g} m"
        names = page.evaluate(f"rockflexPage.about.elements.{kind}.fields.map((each) => each.name)")
        assert page.locator(f'[data-path^="structure.elements.{place}."]').count() == len(names) + 1  # and the kind
    frame = make_frame()
    weight, b = 9.81 * 240e3, frame.rocking().half_width

    def share(part: float) -> float:
        return float(f"{weight * part:.2g}")

    elements = [
        rf.Tendon(share(1 / 5), share(10 / b)), rf.YieldingDissipator(share(1 / 0.016), share(1 / 8), position=0.1),
        rf.ViscousDamper(share(1 / 2), position=0.2), rf.FrictionDamper(share(1 / 20), position=0.3),
        rf.strand_tendon(3, "Y1860S7-15.7", 15.0, 0.5, position=0.1 * kinds.index("strand_tendon")),
    ]  # fmt: skip
    given = [{**each, "position": 0} for each in held(visitor)]
    assert given[0] == {"kind": "tendon", "position": 0, "initial_force": share(1 / 5), "stiffness": share(10 / b)}
    assert [given[k][name] for k, name in ((1, "yield_force"), (2, "coefficient"), (3, "force"))] == [
        share(1 / 8), share(1 / 2), share(1 / 20),
    ]  # fmt: skip
    expected = rf.Restrained(frame, elements).rocking()
    page.wait_for_function(
        "m => [...document.querySelectorAll('dd[data-value]')].some((e) => Number(e.dataset.value) === m)",
        arg=expected.pivot(1).resisting_moment,
    )
    visitor.wait_for_results()
    page.locator(f'[data-handle="element {len(kinds) - 1}"]').wait_for()
    signs = page.locator('[data-handle^="element"]').all_inner_texts()
    assert signs == [str(place + 1) for place in range(len(kinds))]
    # An element of another kind keeps what both have.
    row = page.locator('details[data-path="structure.elements.1"]')
    row.get_by_label("Element", exact=True).select_option("tendon")
    assert held(visitor)[1] == {**given[0], "position": 0.1}
    assert row.get_attribute("open") is not None
    page.locator('details[data-path="structure.elements.0"]').get_by_role("button", name="Remove").click()
    assert [each["kind"] for each in held(visitor)] == ["tendon", *kinds[2:]]
    for _ in kinds[1:]:
        page.locator("details[data-path]:visible").first.get_by_role("button", name="Remove").click()
    assert "elements" not in visitor.state()["structure"]
    page.wait_for_selector('[data-handle^="element"]', state="detached")
    page.wait_for_function(
        "m => Number(document.querySelectorAll('[data-task=modes] dd[data-value]')[2]?.dataset.value) === m", arg=bare
    )


@pytest.mark.slow
def test_a_bad_value_is_answered_beside_it_even_in_a_closed_row(visitor, visit, link) -> None:
    page = visitor.page
    page.get_by_role("button", name="Add an element").click()
    path = "structure.elements.0"
    for field, text, said in (
        ("position", "99", "Elements must act within half width"),
        ("stiffness", "soft", "It must be EA/L over the unbonded length, a number in N/m, but 'soft' was given."),
        ("yield_force", "10", "initial force must not exceed yield force"),
    ):
        box = page.locator(f'[data-path="{path}.{field}"] input')
        before = box.input_value()
        visitor.fill(f"{path}.{field}", text)
        at = "initial_force" if field == "yield_force" else field
        visitor.wait_for_error(f"{path}.{at}", said)
        assert page.locator(f'[data-path="{path}.{at}"] input').get_attribute("aria-invalid") == "true"
        visitor.fill(f"{path}.{field}", before)
        visitor.wait_for_results()
    assert page.locator(".error:visible").count() == 0
    page.get_by_role("button", name="Add an element").click()
    rows = page.locator("details[data-path]")
    page.locator("details[data-path] > summary").first.click()
    assert rows.first.get_attribute("open") is None
    page.evaluate("rockflexPage.state.structure.elements[0].position = 50; rockflexPage.change({})")
    visitor.wait_for_error(f"{path}.position", "must act within half width")
    assert rows.first.get_attribute("open") is not None


@pytest.mark.slow
def test_a_new_device_stands_beside_those_of_other_kinds(visitor) -> None:
    for kind in ("yielding_dissipator", "viscous_damper", "viscous_damper"):
        visitor.page.get_by_label("Element to add").select_option(kind)
        visitor.page.get_by_role("button", name="Add an element").click()
    fuse, damper, twin = (each["position"] for each in held(visitor))
    assert 0 < damper < fuse
    assert twin == -damper


@pytest.mark.slow
def test_a_run_with_fuses_has_peaks_and_loops_in_step(visit, link, pier_run) -> None:
    run = pier_run
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
    assert page.evaluate("rockflexStage.charts.element.options.yLabel") == "F_3 [N]"
    for node in np.linspace(100, run.time.size - 100, 7).astype(int):
        time = float(run.time[node])
        if np.sum(run.time == time) > 1:
            continue  # an event: two states at once
        page.evaluate("t => rockflexStage.move(t)", time)
        force, moment = page.evaluate(
            "() => ['element', 'base'].map((name) => { const { points, trails } = rockflexStage.loops[name].chart;"
            " return [points[0].x, points[0].y, points.length, trails[0].n]; })"
        )
        assert force[0] == pytest.approx(run.element_elongation[node, 2], rel=1e-3, abs=2e-5)
        assert force[1] == pytest.approx(run.element_force[node, 2], rel=1e-3, abs=20.0)
        over = page.evaluate("() => rockflexStage.charts.element.points.map(({ x, y }) => [x, y])")
        assert len(over) == 2
        assert over[0] == pytest.approx([time, run.element_force[node, 2]], rel=1e-3, abs=20.0)
        assert moment[0] == pytest.approx(run.rotation[node], rel=1e-3, abs=1e-7)
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


@pytest.mark.slow
def test_without_elements_and_ground_nothing_of_them_is_shown(visitor) -> None:
    page = visitor.respond()
    assert page.locator("#elements").is_hidden()
    for label in (
        *("Element for the loop", "Force of an element over time"),
        *("Slip of the base over time", "Rise of the edges over time"),
    ):
        assert page.get_by_label(label).is_hidden()
    for name in ("residual_rotation", "max_slip"):
        assert page.locator(f'#peaks [data-name="{name}"]').count() == 0
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


@pytest.mark.slow
def test_a_link_with_a_tendon_opens(visit, link) -> None:
    old = as_json_value(PRESETS[0]["structure"])
    tendon = {"kind": "tendon", "position": 0.0, "initial_force": 5e5, "stiffness": 2e7, "yield_force": 9e5}
    visitor = visit(link({"structure": old | {"elements": [tendon]}, "models": ["2DOF-S"], "tab": "response"}))
    visitor.shown(1, ["2DOF-S"])
    frame = rf.Restrained(make_frame(), rf.Tendon(5e5, 2e7, yield_force=9e5))
    expected = rf.simulate(frame, rf.load_suite("el-centro-1940")[0], "2DOF-S", free_vibration=5.0)
    assert visitor.peak("2DOF-S", "max_rotation") == expected.max_rotation
    assert visitor.value('#elements [data-name="force"]') == expected.max_element_force[0]
    visitor.tab("structure")
    assert visitor.page.locator("details[data-path] > summary").all_inner_texts() == ["1: Tendon at 0 m"]
    assert held(visitor) == [tendon]
    visitor.fill("structure.elements.0.initial_force", "6e5")
    visitor.tab("response")
    more = rf.Restrained(make_frame(), rf.Tendon(6e5, 2e7, yield_force=9e5))
    expected = rf.simulate(more, rf.load_suite("el-centro-1940")[0], "2DOF-S", free_vibration=5.0)
    visitor.wait_for_peak("2DOF-S", "max_rotation", expected.max_rotation)


STRUCTURE = as_json_value(PRESETS[0]["structure"])
BED = {"breadth": 3.0, "subgrade_modulus": 2e8, "heave_damping_ratio": 0.2}
SOFT = {"friction": 0.15, "mat_mass": 4e4, "bed": BED}
RECORD = {"source": "suite", "suite": "fema-p695-far-field", "name": "FF-2-a"}


def simulated(ground: dict, model: str = "MDOF-S") -> rf.Response:
    frame = make_frame()
    motion = rf.load_suite("fema-p695-far-field")["FF-2-a"].scaled(2.0)
    under = GroundTable.model_validate(ground).under(frame.rocking())
    return rf.simulate(frame, motion, model, free_vibration=5.0, ground=under)


def shown(visit, link, ground: dict, models: list[str]):
    state = {"structure": STRUCTURE, "record": RECORD, "scale": 2.0, "models": models, "ground": ground}
    visitor = visit(link(state | {"tab": "response"}))
    visitor.shown(2, models)
    return visitor


@pytest.mark.slow
def test_springs_and_friction_are_chosen_and_bad_values_answered_beside_them(visitor) -> None:
    page = visitor.page
    ground, p = page.get_by_label("Ground", exact=True), make_frame().rocking()
    ground.select_option("springs")
    page.wait_for_selector("#springs")
    state = visitor.state()
    assert state["models"] == ["MDOF-S", "2DOF-S"]  # a fixed base stands on no springs
    assert state["ground"]["springs"] == {
        "stiffness": float(f"{p.m_tot * 9.81 / 0.01:.2g}"),
        "heave_damping_ratio": 0.3,
    }
    page.locator('[data-handle="spring 1"]').wait_for()
    visitor.fill("ground.springs.stiffness", "4e8")
    visitor.fill("ground.springs.positions", "-0.5 0 0.5")

    expected = p.m_tot * 9.81 / 1.2e9
    visitor.wait_for("#springs dd", expected, 1e-12)
    visitor.fill("ground.springs.stiffness", "-1")
    visitor.wait_for_error("ground.springs.stiffness", "but −1 N/m was given")
    visitor.fill("ground.springs.stiffness", "4e8")
    visitor.fill("ground.mat_mass", "")
    visitor.wait_for_error("ground.base_inertia", "A base without rotary inertia")
    visitor.fill("ground.base_inertia", "2e4")
    visitor.fill("ground.springs.positions", "0.1 0.5")
    visitor.wait_for_error("ground.springs.positions", "on both sides of the axis of the masses")
    visitor.fill("ground.springs.positions", "")
    visitor.wait_for_results()
    assert page.locator(".error:visible").count() == 0
    page.get_by_label("The base can slide").check()
    assert visitor.state()["ground"]["friction"] == 0.5
    visitor.fill("ground.friction", "0.3 0.4")
    assert visitor.state()["ground"]["friction"] == [0.3, 0.4]
    for name, keys in (("winkler", ["breadth", "heave_damping_ratio", "subgrade_modulus"]),
                       ("asce41", ["breadth", "heave_damping_ratio", "poisson_ratio", "shear_modulus"])):  # fmt: skip
        visitor.fill("ground.friction", "0.3")
        ground.select_option(name)
        now = visitor.state()["ground"]
        assert sorted(now) == ["bed", "friction", "mat_mass"]
        assert sorted(now["bed"]) == keys
        visitor.wait_for_results()
        settled = visitor.value("#springs dd")
        assert 0.002 < settled < 0.012  # m
    ground.select_option("")
    assert visitor.state()["ground"] == {"friction": 0.3}
    page.wait_for_selector("#springs", state="detached")
    page.get_by_label("The base can slide").uncheck()
    assert "ground" not in visitor.state()


@pytest.mark.slow
def test_an_impact_law_is_not_kept_on_springs_and_a_message_elsewhere_names_the_field(visitor) -> None:
    page = visitor.respond()
    page.get_by_label("Impact law").select_option("complete")
    visitor.tab("structure")
    page.get_by_label("Ground", exact=True).select_option("winkler")
    assert "impact" not in visitor.state()
    visitor.fill("ground.bed.breadth", "-3")
    visitor.wait_for_error("ground.bed.breadth", "−3 m was given.")
    visitor.tab("response")
    foot = page.locator(".foot:not(:empty)")
    foot.wait_for(state="visible")
    assert foot.inner_text().startswith("Structure, breadth: ")


@pytest.mark.slow
def test_a_base_slides_and_hops_in_step_with_its_charts(visit, link) -> None:
    models = ["MDOF-S", "2DOF-S"]
    visitor = shown(visit, link, SOFT, models)
    page, run = visitor.page, simulated(SOFT)
    for name in ("max_slip", "residual_slip", "max_edge_uplift", "max_edge_settlement", "max_rotation"):
        assert visitor.peak("MDOF-S", name) == getattr(run, name)
    assert visitor.peak("2DOF-S", "max_slip") == simulated(SOFT, "2DOF-S").max_slip
    assert run.max_slip > 0.1
    assert f"The base slides by up to {run.max_slip:.3g} m." in page.locator("#verdict").inner_text()
    b = make_frame().rocking().half_width
    kept = page.evaluate("Array.from(rockflexStage.view().models[0].t)")
    nodes = np.flatnonzero(np.isin(np.float32(run.time), kept))[::60]
    seen = set()
    for node in nodes:
        time = float(np.float32(run.time[node]))
        if np.sum(np.float32(run.time) == np.float32(time)) > 1:
            continue  # an event: two states at once
        page.evaluate("t => rockflexStage.move(t)", time)
        base, uplifted, slip, edges = page.evaluate(
            """t => { const f = rockflexStage.frame(0, t, 2); const { slip, edges } = rockflexStage.charts;
              return [f.base, f.uplifted, slip.points.map((p) => p.y), edges.points.map((p) => p.y)]; }""",
            time,
        )
        turned = 2.0 * run.rotation[node]
        middle = np.array([2.0 * run.slip[node], 2.0 * run.heave[node]])
        arm = b * np.array([math.cos(turned), -math.sin(turned)])
        assert np.array(base) == pytest.approx(np.array([middle - arm, middle + arm]), abs=1e-5)
        assert slip[0] == pytest.approx(run.slip[node], abs=1e-6)
        assert edges[:2] == pytest.approx(run.edge_uplift[node], abs=1e-6)
        assert (len(slip), len(edges)) == (2, 4)
        seen.add(bool(uplifted))
        if uplifted:
            assert run.edge_uplift[node].max() > -1e-5
    assert seen == {True, False}
    keys = page.locator(".pair .legend").inner_text()
    assert {"compressed ground", "damped by the ground", "friction of the base"} <= set(keys.split("\n"))


@pytest.mark.slow
def test_the_energies_of_a_base_on_springs_add_up_to_the_input(visit, link) -> None:
    visitor = shown(visit, link, SOFT, ["2DOF-S"])
    series = visitor.page.evaluate(
        """() => { const { energy } = rockflexStage.view(); const text = (name) => atob(energy[name]);
          const read = (name) => { const s = text(name);
            return Array.from(new Float32Array(Uint8Array.from(s, (c) => c.charCodeAt(0)).buffer)); };
          const names = ["kinetic", "strain", "gravity", "element_strain", "damped", "yielded", "lost", "soil_strain",
            "soil", "friction", "elements", "input"];
          return Object.fromEntries(names.map((name) => [name, read(name)])); }"""
    )
    supply = np.array(series.pop("input"))
    parts = {name: np.array(values) for name, values in series.items()}
    assert all(values.min() > -1e-6 * supply.max() for values in parts.values())
    assert sum(parts.values()) == pytest.approx(supply, abs=1e-5 * supply.max())
    assert min(parts[name].max() for name in ("soil", "soil_strain", "friction")) > 0.0


@pytest.mark.slow
def test_springs_that_lift_are_drawn_unloaded_and_a_mark_stays_where_the_base_stood(visit, link) -> None:
    visitor = shown(visit, link, SOFT, ["MDOF-S"])
    found = visitor.page.evaluate(
        """() => {
          const { stage } = rockflexStage;
          const model = stage.view.models[0];
          const { time_of_max_rotation: t } = model.peaks;
          rockflexStage.move(t);
          const scale = stage.canvas.width / stage.canvas.clientWidth;
          const [wide, from] = [stage.canvas.width, Math.round(scale * (stage.height - 44 - stage.depth))];
          const rows = Math.round(scale * (stage.depth + 10));
          const { data } = stage.canvas.getContext("2d").getImageData(0, from, wide, rows);
          const columns = (name, low, high) => {
            const tone = getComputedStyle(document.documentElement).getPropertyValue(name).trim().slice(1);
            const wanted = tone.match(/../g).map((part) => parseInt(part, 16));
            const found = new Set();
            for (let i = 4 * wide * Math.round(scale * low); i < 4 * wide * Math.round(scale * high); i += 4)
              if (wanted.every((value, k) => Math.abs(value - data[i + k]) < 16)) found.add(((i / 4) % wide) / scale);
            return [...found];
          };
          const { theta, slip } = stage.frameAt(0, t, 1);
          const middle = stage.canvas.clientWidth / 2;
          return {
            theta, middle, base: middle + stage.zoom * stage.amplification * slip,
            loaded: columns("--soil", 0, stage.depth), stood: columns("--muted", stage.depth + 8, stage.depth + 10),
          };
        }"""
    )
    loaded = np.array(found["loaded"])
    assert loaded.size > 0
    # The base presses on the springs of the edge about which it turns.
    assert np.sign(found["theta"]) * (loaded.mean() - found["base"]) > 0.0
    assert np.mean(found["stood"]) == pytest.approx(found["middle"], abs=4.0)


def test_a_base_that_slides_on_rigid_ground_has_no_springs(visit, link) -> None:
    ground = {"friction": 0.12}
    visitor = shown(visit, link, ground, ["MDOF-S"])
    page, run = visitor.page, simulated(ground)
    assert visitor.peak("MDOF-S", "max_slip") == run.max_slip > 0.0
    assert page.locator('#peaks [data-name="max_edge_uplift"]').count() == 0
    assert page.get_by_label("Slip of the base over time").is_visible()
    assert page.get_by_label("Rise of the edges over time").is_hidden()
    time = float(run.time[np.abs(run.slip).argmax()])
    base = page.evaluate("t => rockflexStage.frame(0, t, 1).base", time)
    middle, slip = 0.5 * (base[0][0] + base[1][0]), run.slip[np.abs(run.slip).argmax()]
    assert middle == pytest.approx(slip, abs=2e-3)


def samples(name: str, amplitude: float, dt: float = 0.02) -> bytes:
    rows = "".join(f"{dt * i:.2f},{amplitude * math.sin(0.1 * i):.4f}\n" for i in range(400))
    return f"time (s),{name} (m/s2)\n{rows}".encode()


@pytest.mark.slow
def test_a_vertical_component_is_uploaded_beside_the_record(visitor, frame) -> None:
    page = visitor.page
    visitor.tab("earthquake")
    page.get_by_label("Source").select_option("upload")
    visitor.upload("Vertical component", "up.csv", samples("vertical", 2.0))
    visitor.wait_for_error("record.vertical", "Choose the file of the horizontal component first.")
    visitor.upload("File", "mine.csv", samples("acc", 3.0))
    page.wait_for_function("() => document.querySelector('#record-title').textContent === 'mine'")
    assert page.get_by_label("Vertical ground acceleration over time").is_hidden()
    visitor.upload("Vertical component", "up.csv", samples("vertical", 2.0, 0.01))
    visitor.wait_for_error("record.vertical", "Both components need the same time step")
    visitor.upload("Vertical component", "up.csv", samples("vertical", 2.0))
    page.wait_for_selector('[data-measure="PVA"]')
    assert page.locator("#uploaded").inner_text().startswith("mine: 400 samples, PGA 3 m/s², vertical 2 m/s²")
    assert page.get_by_label("Vertical ground acceleration over time").is_visible()
    assert page.locator(".error:visible").count() == 0
    a, v = ([float(line.split(b",")[1]) for line in samples("x", size).splitlines()[1:]] for size in (3.0, 2.0))
    assert visitor.value('[data-measure="PVA"]') == max(map(abs, v))
    visitor.respond()
    expected = rf.simulate(frame, rf.GroundMotion(a, 0.02, vertical=v), "2DOF-S", free_vibration=5.0)
    visitor.wait_for_peak("2DOF-S", "max_rotation", expected.max_rotation)
    assert visitor.peak("2DOF-S", "min_vertical_reaction") == expected.min_vertical_reaction
