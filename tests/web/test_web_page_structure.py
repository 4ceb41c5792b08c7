"""The Structure tab in a browser."""

import time

import numpy as np
import pytest

import rockflex as rf
from builders import make_frame
from rockflex.foundation.json import as_json_value
from rockflex.web._forms import FIRST, PRESETS

pytestmark = pytest.mark.web

PIER = as_json_value(FIRST["structure"])

NONSENSE = (
    "", "x", "-1", "1e999", "nan", "inf", "1e300", "0", "'; drop", "<b>1</b>", "١٢", "9" * 400, "1,2,3", "[[1]]",
    "0x10", "null",
)  # fmt: skip


def test_structure_by_presets_form_and_errors(visitor, frame) -> None:
    page = visitor.page
    assert page.locator("#adequacy").inner_text() == rf.adequacy(frame.rocking(), base_mass=40e3).reason
    assert page.locator(".modes svg").count() == 5
    visitor.fill("structure.frame.n_stories", "3")
    page.wait_for_function("() => document.querySelectorAll('.modes svg').length === 3")
    three = make_frame(n_stories=3)
    assert visitor.value("#modes tbody tr:nth-child(2) td") == pytest.approx(three.modal().period[1], rel=1e-12)
    visitor.fill("structure.frame.n_stories", "1000000")
    visitor.wait_for_error("structure.frame.n_stories", "must be from 1 to 200")
    visitor.fill("structure.frame.period", "soon")
    visitor.wait_for_error("structure.frame.period", "It must be the first period on a fixed base")
    for place, preset in enumerate(PRESETS):
        page.get_by_label("Start from").select_option(str(place))
        page.wait_for_function(
            "n => document.querySelector('[data-task=modes] h2').textContent === n", arg=preset["structure"]["name"]
        )
        visitor.settle()  # the heading may have been the same before
        assert page.locator(".error:visible").all_inner_texts() == []
    begun = {each for preset in PRESETS for each in preset["structure"]} - {"frame"}
    for kind in set(visitor.page.evaluate("Object.keys(rockflexPage.about.kinds)")) - begun:
        page.get_by_label("Kind").select_option(kind)
        page.wait_for_function(
            "k => k in rockflexPage.state.structure && !document.querySelector('.results.stale')", arg=kind
        )
        assert page.locator(".error:visible").all_inner_texts() == []


@pytest.mark.slow
def test_an_eccentric_base_has_two_edges(visitor) -> None:
    page = visitor.page
    visitor.fill("structure.eccentricity", "0.25")
    page.wait_for_function(
        "() => [...document.querySelectorAll('#modes th')].some((e) => /left edge/.test(e.textContent))"
    )
    p = rf.Eccentric(make_frame(), 0.25).rocking()
    shown = page.locator("dd[data-value]").evaluate_all("all => all.map((e) => Number(e.dataset.value))")
    for side in (1, -1):
        assert p.pivot(side).resisting_moment in shown
        assert p.pivot(side).i_theta in shown
    visitor.fill("structure.eccentricity", "5")
    visitor.wait_for_error("structure.eccentricity", "must be smaller than half width")
    visitor.fill("structure.eccentricity", "")
    page.wait_for_function("() => !/edge/.test(document.querySelector('#modes').textContent)")
    assert "eccentricity" not in visitor.state()["structure"]


@pytest.mark.slow
def test_matrices_are_imported(visitor, tmp_path) -> None:
    page = visitor.page
    k = np.array([[2e7, -1e7], [-1e7, 1e7]])
    np.savez(tmp_path / "fe.npz", mass=np.diag([4e4, 4e4]), stiffness=k, heights=[3.0, 6.0])
    page.get_by_label("File of matrices").set_input_files(tmp_path / "fe.npz")
    page.wait_for_function("() => document.querySelectorAll('.modes svg').length === 2")
    expected = rf.from_matrices([4e4, 4e4], k, [3.0, 6.0], base_mass=0.0, half_width=1.0, damping_ratio=0.02)
    assert visitor.value("#modes tbody td") == pytest.approx(expected.modal().period[0], rel=1e-12)
    visitor.upload("File of matrices", "bad.npz", b"nonsense")
    visitor.wait_for_error("import", "does not hold matrices that can be read")


@pytest.mark.slow
def test_matrices_with_rotations_are_imported_and_edited(visitor, tmp_path) -> None:
    page = visitor.page
    k = np.array([[8e6, -4e6, 0.0], [-4e6, 4e6, -2e6], [0.0, -2e6, 9e6]])
    kept = {"base_mass": 0.0, "half_width": 1.0, "damping_ratio": 0.02}
    np.savez(tmp_path / "fe.npz", mass=[2e4, 2e4, 0.0], stiffness=k, heights=[3.0, 6.0], rotations=[2])
    page.get_by_label("File of matrices").set_input_files(tmp_path / "fe.npz")
    given = {"mass": [2e4, 2e4, 0.0], "stiffness": k, **kept}
    expected = rf.from_matrices(heights={0: 3.0, 1: 6.0}, rotations=[2], **given)
    visitor.wait_for("#modes tbody td", expected.modal().period[0])
    assert "2 sideways, 1 rotational. Without mass, and condensed out: 1." in page.locator("#freedoms").inner_text()
    visitor.fill("structure.matrices.heights", "0: 3,5; 1: 7")  # by index, with a decimal comma
    path = '[data-path="structure.matrices.heights"] input'
    expected = rf.from_matrices(heights={0: 3.5, 1: 7.0}, rotations=[2], **given)
    page.wait_for_function(
        "v => [...document.querySelectorAll('dd[data-value]')].some((e) => Math.abs(e.dataset.value / v - 1) < 1e-12)",
        arg=expected.rocking().l0r,
    )
    assert page.locator(path).input_value() == "0: 3.5, 1: 7"
    assert visitor.state()["structure"]["matrices"]["heights"] == {"0": 3.5, "1": 7}
    visitor.fill("structure.matrices.heights", "0: 3, tall")
    visitor.wait_for_error("structure.matrices.heights", "It must be the heights in m of the freedoms")
    assert page.locator(".error:visible").count() == 1


# Types texts in fields of the structure, and tells what the state has then, and what the field shows.
TYPE = """async ([kind, pairs, slowly]) => {
  const found = [];
  for (const [name, text] of pairs) {
    const box = document.querySelector(`[data-path="structure.${kind}.${name}"] > .row > input[type="text"]`);
    if (!box) continue;
    box.focus();
    box.value = text;
    box.dispatchEvent(new Event("change", { bubbles: true }));
    if (slowly) await new Promise(requestAnimationFrame);
    found.push([name, rockflexPage.state.structure[kind][name], box.value]);
  }
  return found;
}"""


@pytest.mark.slow
def test_decimal_commas_are_read_in_every_number_field(visitor) -> None:
    page, seen = visitor.page, 0
    kinds = page.evaluate("Object.entries(rockflexPage.about.kinds).map(([name, k]) => [name, k.fields])")
    for kind, fields in kinds:
        page.get_by_label("Kind").select_option(kind)
        page.wait_for_function("k => k in rockflexPage.state.structure", arg=kind)
        wanted = [each["name"] for each in fields if each["type"] in ("number", "number or list")]
        found = page.evaluate(TYPE, [kind, [[name, "0,5"] for name in wanted], False])
        assert found == [[name, 0.5, "0.5"] for name, *_ in found], kind
        seen += len(found)
    assert seen > 60


COMMAS = [
    ("frame", "period", "−0,75e0", -0.75),
    ("frame", "period", "1,25e-1", 0.125),
    ("frame", "period", "0,125", 0.125),
    ("frame", "period", "1,250", "1,250"),  # or a thousand and more
    ("frame", "period", "1,234.5", "1,234.5"),
    ("lumped", "heights", "3, 6, 9", [3, 6, 9]),
    ("lumped", "heights", "3,6,9", [3, 6, 9]),
    ("lumped", "heights", "3,5; 6,5", [3.5, 6.5]),
    ("lumped", "heights", "3,5 6,5", [3.5, 6.5]),
    ("lumped", "heights", "3,5, 6,5", [3.5, 6.5]),
    ("lumped", "heights", "3.5,6.5", [3.5, 6.5]),
    ("lumped", "heights", "3,6", ["3,6"]),  # one number or two
    ("lumped", "heights", "1,000 2,000", ["1,000", "2,000"]),
    ("lumped", "stiffness", "4,5; -2\n-2; 2", [[4.5, -2], [-2, 2]]),
    ("lumped", "stiffness", "4, -2; -2, 2", [[4, -2], [-2, 2]]),
    ("lumped", "stiffness", "4,2\n2,4", [[4, 2], [2, 4]]),
    ("matrices", "rotations", "1,3", [1, 3]),
    ("matrices", "heights", "0:8,5 2:16,5", {"0": 8.5, "2": 16.5}),
    ("matrices", "heights", "{0: 8.5, 2: 16}", {"0": 8.5, "2": 16}),
    ("matrices", "heights", "0:8,2:16", {"0": 8, "2": 16}),
]


@pytest.mark.slow
def test_what_commas_mean(visitor) -> None:
    page, last = visitor.page, ""
    for kind, field, text, value in COMMAS:
        if kind != last:
            page.get_by_label("Kind").select_option(kind)
            page.wait_for_function("k => k in rockflexPage.state.structure", arg=kind)
        last = kind
        control = page.locator(f'[data-path="structure.{kind}.{field}"] > .row > :is(input, textarea)')
        control.fill(text)
        control.blur()
        assert visitor.state()["structure"][kind][field] == value, text
        first = value[0] if isinstance(value, list) else value
        if isinstance(first, str):  # it stayed text
            visitor.wait_for_error(f"structure.{kind}.{field}", "write a decimal point, no thousands separators")


@pytest.mark.slow
def test_decimal_commas_on_the_other_tabs(visitor) -> None:
    page = visitor.page
    visitor.tab("response")
    visitor.fill("scale", "0,5")
    assert visitor.state()["scale"] == 0.5
    assert page.locator('[data-path="scale"] input[type="text"]').input_value() == "0.5"
    visitor.fill("scale", "1,234.5")
    visitor.wait_for_error("scale", "no thousands separators")
    visitor.fill("scale", "1")
    visitor.tab("fragility")
    visitor.fill("cloud.scales", "0,5; 1; 1,5")
    assert visitor.state()["cloud"]["scales"] == [0.5, 1, 1.5]
    visitor.fill("cloud.scales", "0,5")
    assert visitor.state()["cloud"]["scales"] == [0.5]
    visitor.tab("design")
    visitor.fill("design.at", "0,7")
    assert visitor.state()["design"]["at"] == 0.7


@pytest.mark.slow
def test_nonsense_in_any_field_is_answered_beside_it(visitor) -> None:
    page = visitor.page
    for preset, kind in ((0, "frame"), (6, "tapered_tower"), (8, "cantilever"), (10, "lumped")):
        page.get_by_label("Start from").select_option(str(preset))
        page.wait_for_function("k => k in rockflexPage.state.structure", arg=kind)
        names = page.evaluate(
            "k => rockflexPage.about.kinds[k].fields"
            ".filter(f => !['choice', 'flag', 'table', 'matrix'].includes(f.type)).map(f => f.name)",
            kind,
        )
        for place, name in enumerate(names):
            good = page.locator(f'[data-path="structure.{kind}.{name}"] input').input_value()
            texts = [*NONSENSE[place % 8 :: 8], good]
            found = page.evaluate(TYPE, [kind, [[name, text] for text in texts], True])
            assert found[-1][2] == good
        visitor.settle()  # several parts of the tab ask the server, each for itself
        visitor.wait_for_results()
        assert page.locator(".error:visible").all_inner_texts() == []
        assert "Traceback" not in page.content()


@pytest.mark.slow
def test_lumped_masses_of_a_beam_are_added_and_removed(visitor, visit) -> None:
    page = visitor.page
    page.get_by_label("Kind").select_option("beam")
    page.wait_for_function("() => 'beam' in rockflexPage.state.structure && document.querySelector('#modes')")
    path, cell = "structure.beam.lumped_masses", "#modes tbody td"
    group = page.locator(f'[data-path="{path}"]')
    given = visitor.state()["structure"]["beam"]

    def period(**bodies) -> float:
        return rf.Beam(**given, **bodies).modal().period[0]

    visitor.wait_for(cell, period())
    group.get_by_role("button", name="Add").focus()
    page.keyboard.press("Enter")
    assert page.evaluate("document.activeElement.labels[0].textContent") == "Heights"
    visitor.wait_for(cell, period(lumped_masses=rf.LumpedMasses([given["height"]], [1e4])))
    visitor.fill(f"{path}.heights", "8, 20")
    visitor.wait_for_error(path, "for each of its 2 heights")
    visitor.fill(f"{path}.masses", "15e3, 3e4")
    visitor.wait_for(cell, period(lumped_masses=rf.LumpedMasses([8.0, 20.0], [15e3, 3e4])))
    visitor.fill(f"{path}.rotary", "1e4, 2e4")
    heavy = period(lumped_masses=rf.LumpedMasses([8.0, 20.0], [15e3, 3e4], [1e4, 2e4]))
    visitor.wait_for(cell, heavy)
    assert page.locator(".error:visible").count() == 0
    other = visit("/" + page.evaluate("location.hash"))
    other.wait_for(cell, heavy)
    box = other.page.locator(f'[data-path="{path}.masses"] input')
    assert box.input_value() == "15000, 30000"
    visitor.fill(f"{path}.masses", "15e3, heavy")
    visitor.wait_for_error(f"{path}.masses", "It must be a list of the masses of the bodies in kg, but")
    group.get_by_role("button", name="Remove").click()
    visitor.wait_for(cell, period())
    assert "lumped_masses" not in visitor.state()["structure"]["beam"]
    assert page.evaluate("document.activeElement.textContent") == "Add"
    assert page.locator(".error:visible").count() == 0


@pytest.mark.slow
def test_a_block_brings_the_models_that_it_can_have(visitor) -> None:
    page, before = visitor.page, visitor.state()
    page.get_by_label("Kind").select_option("block")
    state = visitor.state()
    assert (state["models"], state["cloud"]["models"], state["design"]["model"]) == (["rigid"], ["rigid"], "rigid")
    visitor.respond(1, ["rigid"])
    block = rf.rigid_block(**state["structure"]["block"])
    expected = rf.simulate(block, rf.load_suite("el-centro-1940")[0], "rigid", free_vibration=5.0)
    assert visitor.peak("rigid", "max_rotation") == expected.max_rotation
    # Only what a block has: no other models, and neither charts nor columns of forces that bend it.
    assert page.locator("#view .chips.models input:visible").count() == 1
    assert page.locator("#peaks [data-name=max_base_moment]").count() == 0
    shown = "Object.entries(rockflexStage.charts).filter(([, each]) => each.element.checkVisibility())"
    assert page.evaluate(f"{shown}.map(([name]) => name)") == ["rotation", "displacement"]
    assert page.evaluate(f"{shown}.map(([, each]) => each.options.xLabel)") == ["", "time [s]"]
    visitor.fill("scale", "10")
    visitor.shown(10, ["rigid"])
    assert "overturned" in page.locator("#peaks [data-name=status]").inner_text()
    assert page.locator("#peaks [data-name=max_total_top_displacement]").inner_text() == "–"
    visitor.fill("scale", "1")
    visitor.tab("design")
    assert page.get_by_label("Model").locator("option").all_inner_texts() == ["rigid"]
    visitor.tab("structure")
    page.wait_for_selector("#three [data-three=share]")
    page.get_by_label("Kind").select_option("frame")
    state = visitor.state()
    assert [state[name] for name in ("models", "cloud", "design")] == [
        before[name] for name in ("models", "cloud", "design")
    ]


def test_messages_have_the_words_and_units_of_the_page(visit, link) -> None:
    visitor = visit(link({"structure": PIER, "units": "kN"}))
    visitor.fill("structure.cantilever.tip_mass", "-3")
    visitor.wait_for_error("structure.cantilever.tip_mass", "Tip mass must be positive, but −3 t was given.")
    visitor.fill("structure.cantilever.tip_mass", "900")
    visitor.fill("structure.eccentricity", "9")
    visitor.wait_for_error("structure.eccentricity", "half width")
    assert "_" not in visitor.page.locator('[data-path="structure.eccentricity"] > .error').inner_text()
    visitor.fill("structure.eccentricity", "")
    visitor.fill("few.H", "1,234.5")
    visitor.wait_for_error("few.H", "1234.5 or 1.2345")


def test_without_the_server_an_unloaded_tab_says_so(visit, server) -> None:
    visitor = visit()
    page = visitor.page
    visitor.wait_for_results()
    page.route(f"{server}/**", lambda route: route.abort())
    page.click('[data-tab="design"]')
    page.locator("#view .error", has_text="rockflex serve").wait_for()
    page.unroute_all()
    visitor.said.clear()  # the browser's own words about the requests
    assert visitor.state()["tab"] == "design"


CONCRETE = {"elastic_modulus": 3e10, "density": 2500.0}
STEEL = {"elastic_modulus": 2.1e11, "density": 7850.0}


def pier(visitor, kind: str = "cantilever") -> None:
    visitor.page.get_by_label("Kind", exact=True).select_option(kind)
    visitor.page.wait_for_selector(f'[data-path="structure.{kind}.height"]')


def wait_for_facts(visitor, section: rf.Section) -> None:
    facts = [section.area, section.second_moment, section.bending_stiffness, section.mass_per_length]
    visitor.page.wait_for_function(
        """v => { const found = [...document.querySelectorAll('#section dd[data-value]')].map((e) => +e.dataset.value);
          return found.length === 4 && found.every((x, i) => Math.abs(x / v[i] - 1) < 1e-9); }""",
        arg=facts,
    )


@pytest.mark.slow
def test_a_section_takes_the_place_of_stiffness_and_mass_and_gives_them_back(visitor) -> None:
    page = visitor.page
    pier(visitor)
    assert page.locator('[data-path="structure.cantilever.bending_stiffness"]').is_visible()
    shape = page.get_by_label("Cross-section")
    shape.select_option("box")
    wait_for_facts(visitor, rf.Section.box(2.0, 2.0, 0.25, **CONCRETE))
    assert page.locator('[data-path="structure.cantilever.bending_stiffness"]').count() == 0
    assert page.locator('[data-path="structure.cantilever.section.diameter"]').count() == 0
    given = visitor.state()["structure"]["cantilever"]
    assert given["section"] == {"shape": "box", "width": 2, "depth": 2, "wall": 0.25, **CONCRETE}
    assert not {"bending_stiffness", "mass_per_length"} & set(given)
    visitor.fill("structure.cantilever.section.width", "3")
    page.locator('[data-path="section.material"] select').select_option("steel")
    wait_for_facts(visitor, rf.Section.box(3.0, 2.0, 0.25, **STEEL))
    visitor.fill("structure.cantilever.section.stiffness_factor", "0.5")
    made = rf.Section.box(3.0, 2.0, 0.25, **STEEL, stiffness_factor=0.5)
    wait_for_facts(visitor, made)
    names = ("height", "tip_mass", "base_mass", "half_width", "damping_ratio")
    whole = rf.CantileverWithTipMass(**{name: given[name] for name in names}, section=made).rocking()
    assert visitor.value("[data-task=modes] dl.values div:nth-child(2) dd[data-value]") == whole.m_tot
    shape.select_option("tube")
    wait_for_facts(visitor, rf.Section.tube(1.5, 0.2, **STEEL, stiffness_factor=0.5))
    shape.select_option("")
    page.wait_for_selector("#section", state="detached")
    back = visitor.state()["structure"]["cantilever"]
    assert "section" not in back
    tube = rf.Section.tube(1.5, 0.2, **STEEL, stiffness_factor=0.5)
    assert back["bending_stiffness"] == pytest.approx(tube.bending_stiffness, rel=1e-5)
    assert back["mass_per_length"] == pytest.approx(tube.mass_per_length, rel=1e-5)
    assert page.locator(".error:visible").count() == 0


@pytest.mark.slow
def test_bad_sizes_are_answered_in_the_form(visitor) -> None:
    page = visitor.page
    pier(visitor)
    page.get_by_label("Cross-section").select_option("tube")
    visitor.fill("structure.cantilever.section.wall", "9e5")
    visitor.wait_for_error("structure.cantilever.section.wall", "must be from 0.0001 m to 100 m")
    visitor.fill("structure.cantilever.section.wall", "0.9")
    visitor.wait_for_error("structure.cantilever.section", "wall must be less than half of 1.5 m")
    visitor.fill("structure.cantilever.section.wall", "")
    visitor.wait_for_error("structure.cantilever.section", "it lacks wall")
    visitor.fill("structure.cantilever.section.wall", "<b>")
    visitor.wait_for_error("structure.cantilever.section.wall", "'<b>' was given")
    assert "[object" not in page.locator("main").inner_text()


@pytest.mark.slow
def test_a_composite_of_a_beam(visitor) -> None:
    page = visitor.page
    pier(visitor, "beam")
    page.get_by_label("Cross-section").select_option("composite")
    tube, core = rf.Section.tube(1.0, 0.02, **STEEL), rf.Section.circle(0.96, **CONCRETE)
    wait_for_facts(visitor, rf.Section.composite([(tube, 0.0), (core, 0.0)]))
    visitor.fill("structure.beam.section.parts.1.offset", "0.1")
    wait_for_facts(visitor, rf.Section.composite([(tube, 0.0), (core, 0.1)]))
    page.get_by_role("button", name="Add a part").click()
    wait_for_facts(visitor, rf.Section.composite([(tube, 0.0), (core, 0.1), (core, 0.1)]))
    page.locator('[data-path="structure.beam.section.parts.2.shape"] select').select_option("rectangle")
    plate = rf.Section.rectangle(1.0, 1.5, **CONCRETE)
    wait_for_facts(visitor, rf.Section.composite([(tube, 0.0), (core, 0.1), (plate, 0.1)]))
    visitor.fill("structure.beam.section.parts.2.depth", "-1")
    visitor.wait_for_error("structure.beam.section.parts.2.depth", "must be from")
    page.locator('[data-path="structure.beam.section.parts.2"]').get_by_role("button", name="Remove").click()
    wait_for_facts(visitor, rf.Section.composite([(tube, 0.0), (core, 0.1)]))
    visitor.tab("response")
    page.wait_for_selector("#peaks table")


@pytest.mark.slow
def test_quick_choices_end_with_the_last_one(visitor) -> None:
    page = visitor.page
    pier(visitor)
    shape = page.get_by_label("Cross-section")
    page.route("**/api/structure", later)
    for name in ("rectangle", "", "box", "", "tube"):
        shape.select_option(name)
    visitor.settle()
    wait_for_facts(visitor, rf.Section.tube(1.5, 0.2, **CONCRETE))
    given = visitor.state()["structure"]["cantilever"]
    assert given["section"]["shape"] == "tube"
    assert not {"bending_stiffness", "mass_per_length"} & set(given)


def later(route) -> None:
    time.sleep(0.1)
    route.continue_()


@pytest.mark.slow
def test_without_an_invalid_section_the_last_valid_one_counts(visitor) -> None:
    page = visitor.page
    pier(visitor)
    page.get_by_label("Cross-section").select_option("box")
    box = rf.Section.box(2.0, 2.0, 0.25, **CONCRETE)
    wait_for_facts(visitor, box)
    visitor.fill("structure.cantilever.section.width", "x")
    visitor.wait_for_error("structure.cantilever.section.width")
    page.get_by_label("Cross-section").select_option("")
    page.wait_for_selector("#section", state="detached")
    back = visitor.state()["structure"]["cantilever"]
    assert back["bending_stiffness"] == pytest.approx(box.bending_stiffness, rel=1e-5)
    assert back["mass_per_length"] == pytest.approx(box.mass_per_length, rel=1e-5)


@pytest.mark.slow
def test_a_change_begun_in_a_field_that_is_removed_is_dropped(visitor) -> None:
    page = visitor.page
    pier(visitor)
    shape = page.get_by_label("Cross-section")
    for name in ("", "circle"):
        shape.select_option("box")
        wait_for_facts(visitor, rf.Section.box(2.0, 2.0, 0.25, **CONCRETE))
        page.locator('[data-path="structure.cantilever.section.width"] input').focus()
        page.keyboard.type("3")
        shape.select_option(name)
        page.wait_for_selector('[data-path="structure.cantilever.section.width"]', state="detached")
        section = visitor.state()["structure"]["cantilever"].get("section")
        assert section == ({"shape": "circle", "diameter": 1.5, **CONCRETE} if name else None)
