"""Cross-sections in a real Chromium: shapes, materials and parts in the place of stiffness and mass."""

import time

import pytest

import rockflex as rf

pytestmark = pytest.mark.web

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
    page.get_by_label("Material").select_option("steel")
    wait_for_facts(visitor, rf.Section.box(3.0, 2.0, 0.25, **STEEL))
    visitor.fill("structure.cantilever.section.stiffness_factor", "0.5")
    made = rf.Section.box(3.0, 2.0, 0.25, **STEEL, stiffness_factor=0.5)
    wait_for_facts(visitor, made)
    names = ("height", "tip_mass", "base_mass", "half_width", "damping_ratio")
    whole = rf.CantileverWithTipMass(**{name: given[name] for name in names}, section=made).rocking()
    assert visitor.value("#view dl.values div:nth-child(2) dd[data-value]") == whole.m_tot
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


def test_bad_sizes_are_answered_in_the_form(visitor) -> None:
    page = visitor.page
    pier(visitor)
    page.get_by_label("Cross-section").select_option("tube")
    visitor.fill("structure.cantilever.section.wall", "9e5")
    assert "It must be from 0.0001 to 100" in visitor.error("structure.cantilever.section.wall")
    visitor.fill("structure.cantilever.section.wall", "0.9")
    assert "wall must be less than half of 1.5 m" in visitor.error("structure.cantilever.section")
    visitor.fill("structure.cantilever.section.wall", "")
    assert "it lacks wall" in visitor.error("structure.cantilever.section")
    visitor.fill("structure.cantilever.section.wall", "<b>")
    assert "'<b>' was given" in visitor.error("structure.cantilever.section.wall")
    assert "[object" not in page.locator("main").inner_text()


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
    assert "but -1 was given" in visitor.error("structure.beam.section.parts.2.depth")
    page.locator('[data-path="structure.beam.section.parts.2"]').get_by_role("button", name="Remove").click()
    wait_for_facts(visitor, rf.Section.composite([(tube, 0.0), (core, 0.1)]))
    visitor.tab("response")
    page.wait_for_selector("#peaks table")


def test_quick_choices_end_with_the_last_one(visitor) -> None:
    page = visitor.page
    pier(visitor)
    shape = page.get_by_label("Cross-section")
    page.route("**/api/structure", later)
    for name in ("rectangle", "", "box", "", "tube"):
        shape.select_option(name)
    page.wait_for_load_state("networkidle")
    wait_for_facts(visitor, rf.Section.tube(1.5, 0.2, **CONCRETE))
    given = visitor.state()["structure"]["cantilever"]
    assert given["section"]["shape"] == "tube"
    assert not {"bending_stiffness", "mass_per_length"} & set(given)


def later(route) -> None:
    time.sleep(0.1)
    route.continue_()


def test_without_an_invalid_section_the_last_valid_one_counts(visitor) -> None:
    page = visitor.page
    pier(visitor)
    page.get_by_label("Cross-section").select_option("box")
    box = rf.Section.box(2.0, 2.0, 0.25, **CONCRETE)
    wait_for_facts(visitor, box)
    visitor.fill("structure.cantilever.section.width", "x")
    visitor.error("structure.cantilever.section.width")
    page.get_by_label("Cross-section").select_option("")
    page.wait_for_selector("#section", state="detached")
    back = visitor.state()["structure"]["cantilever"]
    assert back["bending_stiffness"] == pytest.approx(box.bending_stiffness, rel=1e-5)
    assert back["mass_per_length"] == pytest.approx(box.mass_per_length, rel=1e-5)


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
