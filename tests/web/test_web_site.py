"""My site: the structure of a few numbers, the choice of its records, and the verdict, in eight actions."""

import math

import pytest

import rockflex as rf
from rockflex.foundation.constants import GRAVITY
from rockflex.web._site import structure_of_site
from rockflex.web._state import SiteChoice, parse_page_state
from rockflex.web._structure import build_page_structure

BLOCK = {"structure": {"block": {"width": 0.6, "height": 2.0, "mass": 250.0}}}
RIGID = BLOCK | {"models": ["rigid"], "cloud": {"models": ["rigid"]}, "design": {"model": "rigid"}}


def site(**values):
    return SiteChoice.model_validate(values)


def properties(structure):
    kind = "rigid" if "block" in structure else "MDOF-S"
    own = {"models": [kind], "cloud": {"models": [kind]}, "design": {"model": kind}}
    return build_page_structure(parse_page_state({"structure": structure, **own}).structure).properties


@pytest.mark.parametrize("material", ["concrete", "steel", "timber", "masonry"])
@pytest.mark.parametrize(
    ("kind", "width", "height", "weight"),
    [("pier", 7.0, 24.0, 15e6), ("pier", 3.0, 30.0, 2e6), ("building", 8.0, 18.0, 8e6), ("block", 0.6, 2.0, 2500.0)],
)
def test_the_structure_has_the_width_height_and_weight(kind, width, height, weight, material) -> None:
    p = properties(structure_of_site(site(kind=kind, width=width, height=height, weight=weight, material=material)))
    assert 2.0 * p.half_width == pytest.approx(width, rel=1e-3)
    assert p.m_tot * GRAVITY == pytest.approx(weight, rel=1e-2)
    if kind != "block":
        assert p.top_height == pytest.approx(height, rel=1e-3)
    if kind == "building":  # EN 1998-1:2004, 4.3.3.2.2
        factor = {"steel": 0.085, "concrete": 0.075}.get(material, 0.05)
        assert 2.0 * math.pi / p.omega[0] == pytest.approx(factor * height**0.75, rel=5e-3)


def test_a_pier_of_concrete_has_half_of_the_stiffness_of_its_section() -> None:
    given = structure_of_site(site(kind="pier"))["cantilever"]
    own = rf.CantileverWithTipMass(**{k: v for k, v in given.items() if k != "section"}, section=rf.Section.rectangle(
        given["section"]["width"], given["section"]["depth"], elastic_modulus=3e10, density=2500.0, stiffness_factor=0.5
    ))  # fmt: skip
    assert properties({"cantilever": given}).omega[0] == pytest.approx(own.rocking().omega[0], rel=1e-12)


def test_the_periods_reach_from_a_fifth_of_the_first_to_that_of_rocking_or_twice_the_first(client) -> None:
    answer = client.ask("/api/site", client.state(site={"kind": "building", "width": 8.0, "height": 18.0}))
    first = 2.0 * math.pi / properties(answer["structure"]).omega[0]
    assert answer["target"]["shortest"] == pytest.approx(0.2 * first, rel=0.01)
    assert answer["target"]["longest"] >= 2.0 * first * 0.99
    assert answer["target"]["count"] == 7


def test_a_block_that_is_wider_than_high_is_refused(client) -> None:
    said = client.refused("/api/site", client.state(site={"kind": "block", "width": 3.0, "height": 2.0}))
    assert "narrower" in said["site.width"]
    assert "0.05 to 200" in client.refused("/api/site", client.state(site={"width": 0.0}))["site.width"]


@pytest.mark.web
@pytest.mark.parametrize("kind", ["pier", "block"])
def test_the_verdict_in_eight_actions(visit, kind) -> None:
    visitor = visit(folded=True)
    page = visitor.page
    page.locator(f'#my-site [data-kind="{kind}"]').click()
    values = {"pier": ("6", "20", "12000"), "block": ("0.7", "2.2", "3")}[kind]
    for name, value in zip(("width", "height", "weight"), values, strict=True):
        visitor.fill(f"site.{name}", value)
    if kind == "pier":
        page.locator('[data-path="site.material"] select').select_option("concrete")
    visitor.fill("target.ag", "0.3")
    page.locator('[data-path="target.ground"] select').select_option("B")
    page.locator("#site").click()
    page.wait_for_selector("#record-set .answer:is(.good, .bad)")
    state = visitor.state()
    assert state["tab"] == "response"
    assert (state["target"]["ag"], state["target"]["ground"], state["record_set"]["suites"]) == (0.3, "B", ["chosen"])
    assert 2.0 * properties(state["structure"]).half_width == pytest.approx(float(values[0]), rel=1e-3)
    assert page.locator("#of-records tbody tr").count() == 7
    assert "7 records" in page.locator("#record-set .answer").first.inner_text()
    if kind == "pier":
        assert "base moment" in page.locator("#record-set .answer").first.inner_text()
    page.locator("#worst").click()
    page.wait_for_function("() => document.activeElement.querySelector('[data-check=rotation]')")
