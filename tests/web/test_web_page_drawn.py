"""The first screen in a browser: a drawing that moves and is a form."""

import re

import numpy as np
import pytest

import rockflex as rf
from rockflex.foundation.json import as_json_value
from rockflex.web._forms import PRESETS

pytestmark = pytest.mark.web

(PIER,) = (each["structure"] for each in PRESETS if each["structure"]["name"] == "Bridge pier")
(FUSES,) = (each["structure"] for each in PRESETS if each["structure"]["name"] == "Pier with fuses")
TIME = "rockflexDrawn.player.time"


def handle(visitor, name: str):
    return visitor.page.locator(f'[data-handle="{name}"]')


def drag(visitor, name: str, across: float, up: float = 0.0) -> None:
    """Pull a handle by some pixels, in steps, and let it go."""
    box = handle(visitor, name).bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    mouse = visitor.page.mouse
    mouse.move(x, y)
    mouse.down()
    for part in np.linspace(0.2, 1.0, 5):
        mouse.move(x + part * across, y - part * up)
    mouse.up()
    visitor.wait_for_results()


def values(visitor) -> dict:
    return visitor.state()["structure"]["cantilever"]


@pytest.mark.slow
def test_the_page_begins_with_a_pier_that_moves(visit) -> None:
    visitor = visit(reduced_motion="no-preference")
    page = visitor.page
    page.wait_for_function("() => globalThis.rockflexDrawn?.player.playing")
    before = page.evaluate(TIME)
    page.wait_for_function(f"t => {TIME} > t + 0.2", arg=before)
    pier, motion = rf.CantileverWithTipMass(**PIER["cantilever"]), rf.load_suite("el-centro-1940")[0].scaled(2.0)
    run, fixed = (rf.simulate(pier, motion, label, free_vibration=5.0) for label in ("MDOF-S", "fixed"))
    visitor.wait_for('[data-three="rotation"]', run.max_rotation)
    assert visitor.value('[data-three="top"]') == run.max_total_top_displacement
    assert visitor.value('[data-three="moment"]') == run.max_base_moment / fixed.max_base_moment
    page.get_by_role("button", name="Pause").click()
    assert not page.evaluate("rockflexDrawn.player.playing")
    page.evaluate("rockflexDrawn.player.move(rockflexDrawn.view().end - 0.05); rockflexDrawn.player.toggle()")
    page.wait_for_function(f"() => {TIME} < 5")  # it begins again at the end


def test_a_line_says_whether_it_rocks(visit) -> None:
    visitor = visit()
    line = visitor.page.locator("#rocks")
    share = rf.CantileverWithTipMass(**PIER["cantilever"]).rocking().nominal_overturning_rotation
    visitor.page.wait_for_selector("#rocks[data-status=rocking]")
    visitor.wait_for_results()
    assert f"{100 * visitor.value('[data-three=rotation]') / share:.3g}" in line.inner_text()
    visitor.fill("few.scale", "0.01")
    visitor.page.wait_for_selector("#rocks.good[data-status=no_uplift]")
    visitor.fill("few.scale", "20")
    visitor.page.wait_for_selector("#rocks.bad")
    visitor.page.locator("#worst").press("Enter")  # to the check in its table
    visitor.page.wait_for_function(
        "() => document.activeElement.querySelector('[data-check=rotation]')?.checkVisibility()"
    )
    assert visitor.state()["tab"] == "response"


def test_it_stands_still_for_those_who_want_that(visit) -> None:
    visitor = visit(reduced_motion="reduce")
    page = visitor.page
    page.wait_for_function("() => globalThis.rockflexDrawn?.view()")
    time = page.evaluate(TIME)
    assert time == page.evaluate("rockflexDrawn.view().models[0].peaks.time_of_max_rotation")
    visitor.pictures()
    assert page.evaluate(TIME) == time


@pytest.mark.slow
def test_a_drag_draws_only_what_answers_bring(visit) -> None:
    visitor = visit(reduced_motion="no-preference")
    page = visitor.page
    page.wait_for_function("() => globalThis.rockflexDrawn?.player.playing")
    box = page.locator('[data-handle="B"]').bounding_box()
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.mouse.down()
    time = page.evaluate(TIME)
    visitor.pictures()
    assert page.evaluate(TIME) == time
    page.mouse.move(box["x"] + 30, box["y"])
    page.wait_for_function(f"t => {TIME} !== t", arg=time)
    page.mouse.up()
    time = page.evaluate(TIME)
    page.wait_for_function(f"t => {TIME} !== t", arg=time)


@pytest.mark.slow
def test_width_and_height_are_dragged(visit) -> None:
    visitor = visit()
    handle(visitor, "B").wait_for()
    zoom = visitor.page.evaluate("rockflexDrawn.player.stage.zoom")
    drag(visitor, "B", 20)
    wide = values(visitor)["half_width"]
    assert wide == pytest.approx(3.5 + 20 / zoom, rel=0.01)
    assert handle(visitor, "B").get_attribute("aria-valuenow") == f"{2 * wide:g}"
    assert visitor.page.locator('[data-path="structure.cantilever.half_width"] input').input_value() == f"{wide:g}"
    assert visitor.page.locator('[data-path="few.B"] input').input_value() == f"{2 * wide:g}"
    zoom = visitor.page.evaluate("rockflexDrawn.player.stage.zoom")
    drag(visitor, "H", 0, up=-30)
    assert values(visitor)["height"] == pytest.approx(24 - 30 / zoom, rel=0.01)
    assert values(visitor)["half_width"] == wide
    pier = rf.CantileverWithTipMass(**values(visitor))
    run = rf.simulate(pier, rf.load_suite("el-centro-1940")[0].scaled(2.0), "MDOF-S", free_vibration=5.0)
    visitor.wait_for('[data-three="rotation"]', run.max_rotation)
    other = visit("/" + visitor.page.evaluate("location.hash"))
    assert other.state()["structure"] == visitor.state()["structure"]


@pytest.mark.slow
def test_handles_by_the_keyboard(visit, link) -> None:
    visitor = visit(link({"structure": as_json_value(FUSES), "scale": 2.0}))
    page = visitor.page
    handle(visitor, "element 2").wait_for()
    assert page.locator(".handle").evaluate_all("all => all.map((each) => each.dataset.handle)") == [
        "B", "H", "element 0", "element 1", "element 2",
    ]  # fmt: skip
    for name in ("B", "H", "element 0", "element 2"):
        dot = handle(visitor, name)
        assert dot.get_attribute("role") == "slider"
        assert re.fullmatch(r"[−.\d]+ m", dot.get_attribute("aria-valuetext"))
        before = float(dot.get_attribute("aria-valuenow"))
        dot.focus()
        for _ in range(3):
            page.keyboard.press("ArrowRight" if name in ("B", "H") else "ArrowLeft")
        after = float(dot.get_attribute("aria-valuenow"))
        assert (after > before) == (name in ("B", "H"))
        assert page.evaluate("document.activeElement.dataset.handle") == name
        visitor.wait_for_results()
    left, right = (each["position"] for each in visitor.state()["structure"]["elements"][1:])
    assert left == -right != -1.3  # twins stay twins
    handle(visitor, "element 2").press("End")
    visitor.wait_for_results()
    edge = values(visitor)["half_width"]
    assert visitor.state()["structure"]["elements"][2]["position"] == edge
    assert page.locator(".error:visible").all_inner_texts() == []
    handle(visitor, "B").press("Home")  # not narrower than its devices are apart
    visitor.wait_for_results()
    assert values(visitor)["half_width"] == edge


@pytest.mark.slow
def test_springs_are_dragged_in_pairs(visit, link) -> None:
    ground = {"mat_mass": 2e5, "springs": {"stiffness": 2e9, "heave_damping_ratio": 0.3}}
    visitor = visit(link({"structure": as_json_value(PIER), "ground": ground, "models": ["MDOF-S"]}))
    handle(visitor, "spring 1").wait_for()
    drag(visitor, "spring 1", -12)
    left, right = visitor.state()["ground"]["springs"]["positions"]
    assert left == -right
    assert 2.0 < right < 3.5
    assert visitor.page.locator('[data-path="ground.springs.positions"] input').input_value() == f"{left:g}, {right:g}"


@pytest.mark.slow
@pytest.mark.parametrize("width", [1280, 420])
def test_handles_cover_neither_words_nor_each_other(visit, link, width) -> None:
    ground = {"mat_mass": 2e5, "springs": {"stiffness": 5e8, "heave_damping_ratio": 0.3}}
    state = {"structure": as_json_value(FUSES), "ground": ground, "models": ["MDOF-S"], "scale": 2.0}
    visitor = visit(link(state), viewport={"width": width, "height": 860})
    page = visitor.page
    page.locator('[data-handle="spring 1"]').wait_for()
    words, dots = page.evaluate(
        """() => {
          const [{ stage }, words] = [rockflexDrawn.player, []];
          const { prototype } = CanvasRenderingContext2D;
          const { fillText } = prototype;
          prototype.fillText = function (text, x, y) { words.push([x, y, this.measureText(text).width]); };
          stage.draw();
          Object.assign(prototype, { fillText });
          const { x, y } = stage.canvas.getBoundingClientRect();
          const boxes = [...stage.layer.children].map((each) => each.getBoundingClientRect());
          return [words, boxes.map((each) => [each.left - x, each.right - x, each.top - y, each.bottom - y])];
        }"""
    )
    assert (len(words), len(dots)) == (7, 7)  # state, dimensions, scale bar
    for x, y, wide in words:
        for left, right, top, bottom in dots:
            assert x + wide / 2 < left or x - wide / 2 > right or y < top or y - 10 > bottom
    # Two devices at one place and a tall building, whose base is narrower than a finger.
    places = (0.0, 0.9, -0.9, 0.9, -0.9)
    elements = [{"kind": "viscous_damper", "coefficient": 1e6, "position": x} for x in places]
    ground = {"mat_mass": 4e4, "springs": {"stiffness": 5e8, "heave_damping_ratio": 0.3}}
    frame = as_json_value(PRESETS[0]["structure"]) | {"elements": elements}
    visitor.follow(link({"structure": frame, "ground": ground, "models": ["MDOF-S"]}))
    page.locator('[data-handle="spring 1"]').wait_for()
    boxes = page.locator('.handle[data-handle*=" "]').evaluate_all(
        "all => all.map((each) => [each.dataset.handle, each.getBoundingClientRect().toJSON()])"
    )
    assert len(boxes) == 7
    for i, (_, one) in enumerate(boxes):
        for _, other in boxes[:i]:
            apart = [max(one[low], other[low]) - min(one[high], other[high]) for low, high in
                     (("left", "right"), ("top", "bottom"))]  # fmt: skip
            assert max(apart) > 0.0
    across = [box["left"] for name, box in boxes if name.startswith("element")]
    assert [across.index(x) for x in sorted(across)][2] == 0  # the middle one stays in the middle


@pytest.mark.slow
def test_on_a_phone_the_drawing_stays_in_sight(visit, link) -> None:
    visitor = visit(link({"structure": as_json_value(PIER)}), viewport={"width": 420, "height": 860})
    page = visitor.page
    for tab in ("structure", "response"):
        visitor.tab(tab)
        visitor.settle()
        page.evaluate("scrollTo(0, 900)")
        assert page.evaluate("scrollY") == 900
        assert page.locator(".pinned").bounding_box()["y"] == 0.0


@pytest.mark.slow
def test_what_is_dragged_alone_changes(client, visit) -> None:
    """Of every structure that the page has: width and height as wanted, and the others as they were."""

    def answer(structure) -> dict:
        return client.ask("/api/structure", client.state(structure=structure), quick=True)

    given = [as_json_value(preset["structure"]) for preset in PRESETS]
    before = [answer(structure) for structure in given]
    found = visit().page.evaluate(
        """async (all) => {
          const { measures } = await import("/static/drawn.js");
          const of = ([structure, view]) => Object.entries(measures(structure, view, rockflexPage.about.kinds));
          return all.map((each) => of(each).map(([name, { value, set }]) => [name, 1.1 * value, set(1.1 * value)]));
        }""",
        list(zip(given, before, strict=True)),
    )

    def measured(view) -> dict:
        return {"B": view["half_width"], "H": view["heights"][-1], "T": view["period"]}

    for view, measures in zip(before, found, strict=True):
        assert "B" in [name for name, _, _ in measures]
        for name, wanted, structure in measures:
            after = measured(answer(structure))
            assert after[name] == pytest.approx(wanted, rel=1e-4)
            rest = {key: value for key, value in measured(view).items() if key != name and value is not None}
            if name == "H" or (name == "B" and "tapered_tower" in structure):
                rest.pop(
                    "T", None
                )  # of another height, unless it is given; and the base of a tower is its lowest section
            assert {key: after[key] for key in rest} == pytest.approx(rest, rel=1e-4)


def test_where_the_height_is_in_no_field_it_has_no_handle(visit, link) -> None:
    (tower,) = (each["structure"] for each in PRESETS if each["structure"]["name"] == "Water tower")
    visitor = visit(link({"structure": as_json_value(tower)}))
    handle(visitor, "B").wait_for()
    assert handle(visitor, "H").count() == 0
    assert visitor.page.locator('[data-path="few.H"]').is_hidden()
    assert visitor.page.locator('[data-path="few.T"]').is_visible()


@pytest.mark.slow
def test_leaning_masses_and_stories_that_yield(visitor) -> None:
    visitor.fill("structure.leaning_masses", "1e4")
    visitor.wait_for_results()
    visitor.page.locator('[data-path="structure.stories"]').get_by_role("button", name="Add").click()
    state = visitor.state()["structure"]
    assert state["leaning_masses"] == 1e4
    assert state["stories"]["post_yield_ratio"] == 0.05
    assert state["stories"]["strengths"] == pytest.approx(0.3 * 9.81 * 240e3, rel=0.02)  # of the weight on the base
    visitor.wait_for_results()
    visitor.fill("structure.stories.strengths", "4e5")
    visitor.wait_for_results()
    frame = rf.Frame(5, 3.0, 40e3, 40e3, np.inf, period=1.0, aspect_ratio=10.0, damping_ratio=0.02)
    built = rf.YieldingStories(rf.Leaning(frame, 1e4), 4e5, 0.05)
    run = rf.simulate(built, rf.load_suite("el-centro-1940")[0], "MDOF-S", free_vibration=5.0)
    visitor.wait_for('[data-three="rotation"]', run.max_rotation)
    page = visitor.respond()
    for name, expected in {"ductility": run.ductility, "residual_drift": run.residual_drift}.items():
        cells = page.locator(f'#floors [data-name="{name}"]').all()
        found = [float(each.get_attribute("data-value")) for each in cells]
        assert found[::-1] == pytest.approx(expected.tolist(), rel=1e-12)
    assert page.locator("#floors tr.yields").count() == int((run.ductility > 1.0).sum())
    said = f"Story {1 + int(run.ductility.argmax())} yields most"
    assert (said in page.locator("#verdict").inner_text()) == bool(run.max_ductility > 1.0)
    visitor.tab("structure")
    visitor.page.get_by_label("Kind", exact=True).select_option("block")
    visitor.page.wait_for_function("() => 'block' in rockflexPage.state.structure")
    assert visitor.page.locator('[data-path="structure.stories"]').count() == 0


@pytest.mark.slow
def test_axe_finds_nothing(visit, link, axe) -> None:
    """On no tab: of all rules in light, and in dark of those about contrast, which alone depend on the theme."""
    ground = {"mat_mass": 2e5, "springs": {"stiffness": 2e9}, "friction": 0.5}
    state = {"structure": as_json_value(FUSES), "ground": ground, "models": ["MDOF-S", "2DOF-S"]}
    visitor = visit(link(state))
    for rules in ([], ["color-contrast"]):
        for tab in ("structure", "earthquake", "response", "fragility", "design"):
            visitor.tab(tab)
            visitor.settle()
            visitor.wait_for_results()
            assert (tab, axe(visitor.page, *rules)) == (tab, [])
        visitor.page.click("#theme")


@pytest.mark.slow
def test_braces_ties_and_leaning_columns_are_drawn(visit, link) -> None:
    held = [
        {"kind": "yielding_dissipator", "stiffness": 5e7, "yield_force": 1e5, "between": [0, 2], "cosine": 0.8},
        {"kind": "tendon", "height": 9.0, "initial_force": 1e5, "stiffness": 5e6, "cosine": -0.6},
    ]
    frame = as_json_value(PRESETS[0]["structure"])
    colors = """() => {
      const { canvas, height } = rockflexDrawn.player.stage;
      const g = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d", { willReadFrequently: true });
      g.drawImage(canvas, 0, 0);
      const { data } = g.getImageData(0, 0, canvas.width, canvas.height);
      const count = (name) => {
        const tone = getComputedStyle(document.documentElement).getPropertyValue(name).trim().slice(1);
        const wanted = tone.match(/../g).map((part) => parseInt(part, 16));
        let n = 0;
        for (let i = 0; i < data.length; i += 4) n += wanted.every((value, k) => Math.abs(value - data[i + k]) < 40);
        return n;
      };
      return [count("--fuse"), count("--tendons"), count("--structure")];
    }"""
    found, visitor = [], visit()
    for more in ({}, {"elements": held}, {"elements": held, "leaning_masses": 2e4}):
        visitor.follow(link({"structure": frame | more}))
        visitor.page.wait_for_function("() => rockflexDrawn.view()")
        visitor.page.evaluate("rockflexDrawn.player.move(0)")
        found.append(visitor.page.evaluate(colors))
    assert found[0][0] < 20  # edges of other lines
    assert found[1][0] > 100
    assert found[1][1] > found[0][1] + 100
    assert found[2][2] > found[1][2] + 100
    assert visitor.page.locator(".handle").evaluate_all("all => all.map((each) => each.dataset.handle)") == ["B", "H"]
    visitor.respond()
    assert visitor.page.locator("#elements tbody tr").count() == 2
