"""The Response tab in a real Chromium, used as a person would."""

import math

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from rockflex.foundation.json import as_json_value
from rockflex.web._forms import PRESETS

pytestmark = pytest.mark.web

PEAKS = (
    "max_rotation", "max_top_displacement", "max_total_top_displacement", "max_base_moment", "max_base_shear",
    "max_horizontal_reaction", "min_vertical_reaction",
)  # fmt: skip


@pytest.mark.slow
def test_response_numbers_and_animation(visitor, frame, el_centro) -> None:
    page = visitor.respond()
    for model in ("MDOF-S", "2DOF-S", "fixed"):
        response = rf.simulate(frame, el_centro, model, free_vibration=5.0)
        for name in (*PEAKS, "n_impacts"):
            assert visitor.peak(model, name) == getattr(response, name)
    response = rf.simulate(frame, el_centro, "MDOF-S", free_vibration=5.0)
    shapes = np.vstack((np.zeros(5), frame.rocking().floors.displacement))
    heights, b = np.arange(6) * 3.0, frame.rocking().half_width
    for node in np.flatnonzero(
        np.isin(np.float32(response.time), page.evaluate("Array.from(rockflexStage.view().models[0].t)"))
    )[::97]:
        time, theta = float(np.float32(response.time[node])), response.rotation[node]
        if np.sum(np.float32(response.time) == np.float32(time)) > 1:
            continue  # an event: two states at once
        drawn = page.evaluate(
            "t => { const f = rockflexStage.frame(0, t, 3); return [f.theta, f.points, f.base, f.side]; }", time
        )
        assert drawn[0] == pytest.approx(theta, rel=1e-6, abs=1e-12)
        assert drawn[3] == np.sign(theta)
        pivot, turned = np.sign(theta) * b, 3.0 * theta
        dx = 3.0 * shapes @ response.modal_displacement[node] - pivot
        x = pivot + dx * np.cos(turned) + heights * np.sin(turned)
        y = heights * np.cos(turned) - dx * np.sin(turned)
        assert np.array(drawn[1]) == pytest.approx(np.column_stack((x, y)), abs=1e-4)
        assert min(drawn[2][0][1], drawn[2][1][1]) == pytest.approx(0.0, abs=1e-9)  # one edge stays on the ground


def chosen(number: int, **more) -> dict:
    """A state with one of the structures to begin with."""
    structure = as_json_value(PRESETS[number]["structure"])
    return {"structure": structure, **more}


@pytest.mark.slow
def test_the_deck_of_a_pier_moves_as_far_as_it_does(visit, link) -> None:
    """Relative to a base that turns, the deck moves a quarter of what it does; that is no reduction of anything."""
    visitor = visit(link(chosen(7, scale=3.0)))
    visitor.respond(3)
    pier = rf.CantileverWithTipMass(**PRESETS[7]["structure"]["cantilever"])
    motion = rf.load_suite("el-centro-1940")[0].scaled(3.0)
    response, fixed = (rf.simulate(pier, motion, model, free_vibration=5.0) for model in ("MDOF-S", "fixed"))
    total = response.max_total_top_displacement
    assert total > fixed.max_top_displacement > 3.0 * response.max_top_displacement
    cell = '#peaks tr[data-model="MDOF-S"] [data-name="{}"]'
    text = visitor.page.locator(cell.format("max_total_top_displacement")).inner_text()
    assert text == f"{total:.4g} ({100 * total / fixed.max_total_top_displacement:.3g} %)"
    assert (
        visitor.page.locator(cell.format("max_top_displacement")).inner_text() == f"{response.max_top_displacement:.4g}"
    )
    assert visitor.page.get_by_role("columnheader", name="relative").count() == 1
    said = visitor.page.locator("#verdict").inner_text()
    assert f"The top moves by up to {total:.3g} m relative to the ground" in said
    assert f"and {fixed.max_total_top_displacement:.3g} m for the same structure on a fixed base." in said
    assert all("1 % on the scale" in text for text in visitor.page.locator("#warnings p").all_inner_texts())
    # The plot shows either displacement.
    drawn = "Math.max(...rockflexStage.view().models[0].scaled.displacement.map(Math.abs))"
    assert visitor.page.evaluate(drawn) == pytest.approx(total, rel=1e-3)
    visitor.page.get_by_label("Plotted top displacement").select_option("relative to the rotating base")
    assert visitor.page.evaluate(drawn) == pytest.approx(response.max_top_displacement, rel=1e-2)


@pytest.mark.slow
def test_a_base_that_is_pulled_down_is_told(visit, link) -> None:
    record = {"source": "suite", "suite": "fema-p695-far-field", "name": "FF-1-a"}
    visitor = visit(link(chosen(3, scale=2.0, record=record, models=["MDOF-S", "2DOF-S", "2DOF-S-R"])))
    visitor.respond(2, ["MDOF-S", "2DOF-S", "2DOF-S-R"])
    frame = make_frame(stiffness_ratio=0.0, period=0.5)
    motion = rf.load_suite("fema-p695-far-field")["FF-1-a"].scaled(2.0)
    response = rf.simulate(frame, motion, "MDOF-S", free_vibration=5.0)
    (warning,) = response.warnings
    assert visitor.page.locator("#warnings p").all_inner_texts() == [f"MDOF-S: {warning}"]
    assert visitor.peak("MDOF-S", "min_vertical_reaction") == response.min_vertical_reaction < 0.0
    corrected = rf.simulate(frame, motion, "2DOF-S-R", free_vibration=5.0)
    assert visitor.peak("2DOF-S-R", "max_base_shear") == corrected.max_base_shear
    assert visitor.peak("2DOF-S-R", "max_rotation") == visitor.peak("2DOF-S", "max_rotation")
    visitor.fill("scale", "0.1")
    visitor.shown(0.1, ["MDOF-S", "2DOF-S", "2DOF-S-R"])
    assert visitor.page.locator("#warnings").is_hidden()


@pytest.mark.slow
def test_a_top_of_unknown_height_has_no_total_displacement(visit, link, client) -> None:
    p = make_frame().rocking()
    names = ("omega", "effective_mass", "effective_height", "top_ordinate", "i_theta", "l0r", "m_tot", "half_width")
    table = {name: np.asarray(getattr(p, name)).tolist() for name in names} | {"zeta": 0.02}
    state = client.state(structure={"name": "Bare", "properties": table}, models=["2DOF-S", "fixed"])
    visitor = visit(link(state))
    visitor.respond(1, ["2DOF-S", "fixed"])
    cell = visitor.page.locator('#peaks tr[data-model="2DOF-S"] [data-name="max_total_top_displacement"]')
    assert cell.count() == 0  # no column of what no model has
    assert visitor.page.get_by_label("Plotted top displacement").is_hidden()
    assert "relative to the ground" not in visitor.page.locator("#verdict").inner_text()
    _, content = client.download("/api/file/histories", state)
    names, first = (line.split(",") for line in content.decode().splitlines()[:2])
    place = next(k for k, name in enumerate(names) if name.startswith("total_top_displacement"))
    assert first[place] == "nan"


def test_play_pause_scrub_and_speed(visitor, frame, el_centro) -> None:
    page = visitor.respond()
    page.get_by_label("Speed", exact=True).select_option("1")
    page.get_by_role("button", name="Play").click()
    page.wait_for_function("() => rockflexStage.time() > 0.5")
    page.get_by_role("button", name="Pause").click()
    stopped = page.evaluate("rockflexStage.time()")
    visitor.pictures()
    assert page.evaluate("rockflexStage.time()") == stopped
    assert page.locator("#clock").inner_text() == f"{stopped:.2f} s"
    page.get_by_role("button", name="Largest rotation").click()
    response = rf.simulate(frame, el_centro, "MDOF-S", free_vibration=5.0)
    assert page.evaluate("rockflexStage.time()") == response.time_of_max_rotation
    assert page.evaluate("rockflexStage.frame(0, rockflexStage.time(), 1).theta") == pytest.approx(
        response.max_rotation, rel=0.02
    ) or response.rotation.min() == pytest.approx(-response.max_rotation, rel=0.02)
    scrub = page.get_by_role("slider", name="Time", exact=True)
    scrub.focus()
    for _ in range(3):
        scrub.press("ArrowRight")
    assert page.evaluate("rockflexStage.time()") > response.time_of_max_rotation
    picture = page.evaluate("document.querySelector('.stage canvas').toDataURL()")
    scrub.press("Home")
    assert page.evaluate("document.querySelector('.stage canvas').toDataURL()") != picture
    amplify = page.get_by_role("slider", name="Amplification")
    amplify.focus()
    amplify.press("End")
    assert page.evaluate("rockflexStage.stage.amplification") == 200


@pytest.mark.slow
def test_a_slider_redraws(visitor) -> None:
    page = visitor.respond()
    slider = page.get_by_role("slider", name="Scale factor")
    slider.focus()
    for _ in range(5):
        slider.press("ArrowRight")
    scale = visitor.state()["scale"]
    assert scale > 1.0
    visitor.shown(scale)
    assert page.locator('[data-path="scale"] input[type="text"]').input_value() == f"{scale:g}"
    print(f"a change of the scale is drawn after {page.locator('[data-redrawn]').get_attribute('data-redrawn')} ms")


@pytest.mark.slow
def test_models_and_overturning(visitor) -> None:
    page = visitor.page
    visitor.tab("response")
    for name in ("MDOF-S", "fixed"):
        page.get_by_label(name, exact=True).uncheck()
    page.get_by_label("Another model").fill("4DOF-S")
    page.get_by_label("Another model").press("Enter")
    visitor.shown(1, ["2DOF-S", "4DOF-S"])
    visitor.fill("scale", "15")
    visitor.shown(15, ["2DOF-S", "4DOF-S"])
    assert "the structure overturns" in page.locator("#verdict").inner_text()
    assert "overturned at" in page.locator('#peaks tr[data-model="2DOF-S"] [data-name="status"]').inner_text()
    page.evaluate("rockflexStage.move(rockflexStage.view().models[0].peaks.end_time)")
    assert abs(page.evaluate("rockflexStage.frame(0, rockflexStage.time(), 1).theta")) == pytest.approx(
        math.pi / 2, rel=1e-5
    )
    page.get_by_label("Another model").fill("77DOF-S")
    page.get_by_label("Another model").press("Enter")
    visitor.wait_for_error("models", "needs 76 modes, but the structure has 5")


@pytest.mark.slow
def test_impact_laws(visitor, frame, el_centro) -> None:
    page = visitor.respond()
    law, share = page.get_by_label("Impact law"), page.locator('[data-path="restitution"]')

    def impacts(law_: rf.ImpactLaw | None) -> rf.Response:
        return rf.simulate(frame, el_centro, "2DOF-S", free_vibration=5.0, impact=law_)

    assert "impact" not in visitor.state()
    assert share.is_hidden()
    law.select_option("complete")
    visitor.wait_for_peak("2DOF-S", "max_rotation", impacts(rf.VVELComplete()).max_rotation)
    assert visitor.state()["impact"] == "complete"
    assert page.locator('[data-path="impact"] .hint sub').all_inner_texts() == ["b", "b", "b"]
    law.select_option("restitution")
    visitor.wait_for_peak("2DOF-S", "n_impacts", impacts(rf.Restitution(0.8)).n_impacts)
    visitor.fill("restitution", "0.3")
    visitor.wait_for_peak("2DOF-S", "n_impacts", impacts(rf.Restitution(0.3)).n_impacts)
    slider = page.get_by_role("slider", name="Coefficient of restitution")
    slider.focus()
    slider.press("ArrowLeft")
    visitor.wait_for_peak("2DOF-S", "max_rotation", impacts(rf.Restitution(0.29)).max_rotation)
    visitor.fill("restitution", "1.5")
    visitor.wait_for_error("restitution", "[0, 1], but 1.5 was given")
    visitor.fill("restitution", "0")  # as the simplified law, mass by mass
    visitor.wait_for_peak("2DOF-S", "max_rotation", impacts(rf.Restitution(0.0)).max_rotation)
    law.select_option("simplified")
    assert visitor.state()["impact"] == "simplified"
    law.select_option("")
    visitor.wait_for_peak("2DOF-S", "max_rotation", impacts(None).max_rotation)
    assert not {"impact", "restitution"} & visitor.state().keys()
    assert share.is_hidden()


@pytest.mark.slow
def test_a_superstructure_that_yields(visitor, visit, frame, el_centro) -> None:
    page = visitor.respond()
    tick, offered = page.get_by_label("The superstructure yields"), page.locator('[data-label$="-BW"]')
    suggested = page.evaluate("rockflexStage.view().suggested_yield")
    assert offered.count() == 0
    tick.check()
    three = ["2DOF-S", "2DOF-S-BW", "1DOF-fixed-BW"]
    visitor.shown(1, three)
    assert offered.count() == 3
    assert visitor.state()["bouc_wen"] == {"yield_displacement": suggested}
    visitor.fill("bouc_wen.yield_displacement", "0.03")
    visitor.fill("bouc_wen.post_yield_ratio", "0.05")
    hysteresis = rf.BoucWen(0.03, 0.05)
    for label in three:
        yields = hysteresis if label.endswith("-BW") else None
        response = rf.simulate(frame, el_centro, label, free_vibration=5.0, bouc_wen=yields)
        visitor.wait_for_peak(label, "max_top_displacement", response.max_top_displacement)
        assert visitor.peak(label, "max_base_moment") == response.max_base_moment
    page.get_by_label("fixed", exact=True).check()
    visitor.shown(1, [*three, "fixed"])
    # Each is held against what yields as it does.
    for label, held in (("2DOF-S", "fixed"), ("2DOF-S-BW", "1DOF-fixed-BW")):
        share = 100 * visitor.peak(label, "max_base_moment") / visitor.peak(held, "max_base_moment")
        cell = page.locator(f'#peaks tr[data-model="{label}"] [data-name="max_base_moment"]')
        assert f"({share:.3g} %)" in cell.inner_text()
    # Two on a fixed base do not look alike.
    looks = page.evaluate("[...document.querySelectorAll('#keys canvas')].map((each) => each.toDataURL())")
    assert len(set(looks)) == 4
    other = visit("/" + page.evaluate("location.hash"))
    other.shown(1, [*three, "fixed"])
    assert other.page.get_by_label("The superstructure yields").is_checked()
    visitor.fill("bouc_wen.yield_displacement", "-1")
    visitor.wait_for_error("bouc_wen.yield_displacement", "must be")
    visitor.fill("bouc_wen.yield_displacement", "0.03")
    visitor.fill("bouc_wen.post_yield_ratio", "")
    assert visitor.state()["bouc_wen"] == {"yield_displacement": 0.03}
    tick.uncheck()
    visitor.shown(1, ["2DOF-S", "fixed"])
    assert "bouc_wen" not in visitor.state()
    assert offered.count() == 0


@pytest.mark.slow
def test_yielding_takes_its_share_of_the_energy(visitor) -> None:
    page = visitor.respond()
    page.get_by_label("The superstructure yields").check()
    visitor.fill("bouc_wen.yield_displacement", "0.03")
    page.get_by_label("Model for the energy").select_option("2DOF-S-BW")
    page.wait_for_function("() => rockflexStage.view().energy.label === '2DOF-S-BW'")
    assert "yielding" in page.locator(".pair .legend").inner_text()


@pytest.mark.slow
def test_without_a_hysteresis_nothing_yields_anywhere(visitor) -> None:
    page = visitor.respond()
    page.get_by_label("The superstructure yields").check()
    visitor.shown(1, ["2DOF-S", "2DOF-S-BW", "1DOF-fixed-BW"])
    page.get_by_label("2DOF-S", exact=True).uncheck()
    visitor.shown(1, ["2DOF-S-BW", "1DOF-fixed-BW"])
    visitor.tab("fragility")
    page.get_by_label("2DOF-S-BW").check()
    page.get_by_label("MDOF-S", exact=True).uncheck()
    visitor.tab("response")
    page.get_by_label("The superstructure yields").uncheck()
    visitor.shown()  # those that the page begins with
    assert visitor.state()["cloud"]["models"] == ["MDOF-S"]
    assert page.locator(".error:visible").count() == 0
    visitor.tab("fragility")
    assert page.locator('[data-label$="-BW"]').count() == 0


@pytest.mark.slow
def test_the_stage_turns_an_eccentric_base_about_its_edges(visit, link) -> None:
    structure = as_json_value(PRESETS[0]["structure"]) | {"eccentricity": 0.3}
    visitor = visit(link({"structure": structure, "tab": "response", "models": ["2DOF-S"]}))
    visitor.shown(1, ["2DOF-S"])
    half_width = visitor.page.evaluate("rockflexStage.stage.view.half_width")
    turned = visitor.page.evaluate(
        """() => {
          const { stage } = rockflexStage;
          const { t, rotation } = stage.view.models[0];
          const at = (found) => stage.frameAt(0, t[rotation.findIndex(found)], 20);
          return [at((r) => r > 1e-4).base[1], at((r) => r < -1e-4).base[0], stage.edges()];
        }"""
    )
    right, left = half_width - 0.3, -half_width - 0.3
    assert turned[0] == pytest.approx([right, 0.0], abs=1e-12)
    assert turned[1] == pytest.approx([left, 0.0], abs=1e-12)
    assert turned[2] == pytest.approx([left, right])


@pytest.mark.slow
def test_stage_and_charts_by_the_keyboard(visitor, frame, el_centro) -> None:
    page = visitor.respond()
    time = "rockflexStage.time()"
    page.locator(".stage canvas").focus()
    page.keyboard.press("Space")
    page.wait_for_function("() => rockflexStage.playing() && rockflexStage.time() > 0.1")
    page.keyboard.press("Space")
    assert not page.evaluate("rockflexStage.playing()")
    page.keyboard.press("Home")
    assert page.evaluate(time) == 0.0
    page.keyboard.press("ArrowRight")
    end = page.evaluate("rockflexStage.view().end")
    assert page.evaluate(time) == pytest.approx(end / 200)
    assert page.locator("#scrub").get_attribute("aria-valuetext") == f"{page.evaluate(time):.2f} s"
    # The cursor of a chart takes the animation with it, and says what it stands on.
    chart = page.get_by_role("application", name="Rotation over time")
    chart.focus()
    page.keyboard.press("End")
    assert page.evaluate(time) == pytest.approx(end, rel=1e-6)
    page.keyboard.press("Home")
    for _ in range(3):
        page.keyboard.press("Shift+ArrowRight")
    assert page.evaluate(time) == pytest.approx(0.3 * end, rel=1e-6)
    said = chart.locator("[aria-live]").inner_text()
    assert said.startswith(f"t [s] = {0.3 * end:.4g}")
    response = rf.simulate(frame, el_centro, "MDOF-S", free_vibration=5.0)
    expected = np.interp(0.3 * end, response.time, response.rotation)
    found = float(said.split("MDOF-S: ")[1].split(";")[0].replace("−", "-"))
    assert found == pytest.approx(expected, abs=5e-5)
    zoom = "rockflexStage.panel.zoom"
    page.keyboard.press("+")
    low, high = page.evaluate(zoom)
    assert (high - low, (low + high) / 2) == pytest.approx((end / 2, 0.3 * end), rel=0.1)
    page.keyboard.press("+")
    page.keyboard.press("-")
    assert page.evaluate(zoom) == [low, high]
    page.keyboard.press("Escape")
    assert page.evaluate(zoom) is None


@pytest.mark.slow
def test_a_chart_is_zoomed_and_clicked(visitor) -> None:
    page = visitor.respond()
    box = page.get_by_role("application", name="Base moment over time").bounding_box()
    middle, height = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.click(middle, height)
    picked = page.evaluate("rockflexStage.time()")
    assert 0.4 < picked / page.evaluate("rockflexStage.view().end") < 0.6
    page.mouse.move(middle - 100, height)
    page.mouse.down()
    page.mouse.move(middle, height, steps=4)
    page.mouse.move(middle + 100, height, steps=4)
    page.mouse.up()
    low, high = page.evaluate("rockflexStage.panel.zoom")  # all panels share their time
    assert low < picked < high
    page.mouse.dblclick(middle, height)
    assert page.evaluate("rockflexStage.panel.zoom") is None


@pytest.mark.slow
def test_a_long_wait_is_explained(visitor) -> None:
    page, held = visitor.page, []
    page.route("**/api/response", lambda route: held.append(route))
    visitor.tab("response")
    page.wait_for_function("() => document.querySelector('#verdict')?.textContent === 'Computing …'")
    held[0].continue_()
    page.wait_for_function("() => document.querySelector('#verdict').textContent.startsWith('MDOF-S: the base rocks')")
    page.unroute("**/api/response")
    visitor.fill("scale", "1e9")
    visitor.wait_for_error("scale", "from 0.01 to 20")
    assert page.locator("#verdict").inner_text().startswith("MDOF-S: the base rocks")
